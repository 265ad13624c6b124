//! The command line of `machine`.

use crate::models::options::{ACCEL, AnyOption, JERK};
use clap::{Args, ValueEnum};

use super::names::model_name;
use super::values::{parse_blu, parse_clock, parse_speed, parse_travel};

/// The axes of a machine, in mm.
#[derive(Clone, Debug)]
pub(crate) struct Travel(pub(crate) Vec<f64>);

/// A family of devices that hardware is synthesized for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Family {
    /// Lattice iCE40, by Yosys and nextpnr
    Ice40,
}

/// The text of an option of ramps, if it has such values.
fn of_ramp(option: &'static dyn AnyOption, text: &str) -> Result<String, String> {
    option.parse(text).map(|_| text.to_owned())
}

#[derive(Debug, Args)]
#[command(
    after_help = "A row for each method: the bits of every register, the clock with which the slowest corner of the travel\n\
    reaches --feed, the feeds reached at that clock, and the greatest path error of the runs at the corners. Corners are\n\
    the lines from the origin to the ends of the travel, along each axis and with two axes equally long, and quarters of the\n\
    greatest circle; shorter lines may be slower, such as those of integrators. The travel is rounded up to whole BLU.\n\
    Below the table every register, how its width is known, and the run that one bit less does not hold.\n\n\
    Widths are known as `stepwave widths` knows them over the box of the travel; where neither a proof nor all of its\n\
    geometries are to be had, they are those that the corners need: sampled.\n\n\
    Data sampling has its feed by the displacement of a period, at the clock of --clock-hz; a higher clock leaves it.\n\n\
    --synth ice40 takes the Verilog of `stepwave export --no-flags` at these widths. LUTs and flip-flops are those that\n\
    `yosys synth_ice40` makes of it; load words are inputs, which nothing is counted for. The highest clock is that of\n\
    nextpnr-ice40 in an hx8k, package ct256, seed 1, with `export --harness` around it, as the package has fewer pins than\n\
    the machine has ports. Other seeds are some per cent off; one is taken where the router comes to no end. Next to it the same of\n\
    the machine that runs programs by the method, with block buffer, pulse source and at least three axes. With --accel its ramp\n\
    too, counted in the smallest of these machines: it is the same in all. Its multipliers take Yosys a minute or more.\n\
    Debian packages: yosys, nextpnr-ice40.\n\n\
    --accel runs one move as `stepwave program --accel` does at --clock-hz: a line from the origin to the end of the travel,\n\
    or of an arc a quarter of the greatest circle. Shown are the registers of the ramp, the greatest feed along the path,\n\
    time and length from the start to the end of the ramp up and from the ramp down to the last step, and the time of the\n\
    move. Families that take F along an axis are slower along a path between the axes.\n\n\
    --pareto leaves out what another row of the same curve beats: nowhere worse and somewhere better in the clock for the\n\
    feed, the greatest error, and the bits of all registers; with --synth in the feed at the highest clock, the error,\n\
    and LUTs and flip-flops together.\n\n\
    Examples:\n  \
    stepwave machine --travel 300mm,200mm --blu 1um --feed 2400mm/min\n  \
    stepwave machine --travel 300mm,200mm --blu 1um --feed 2400mm/min --synth ice40 --pareto\n  \
    stepwave machine dda-line ppc-arc --travel 300mm,200mm --feed 2400mm/min --accel 500mm/s2 --jerk 20000mm/s3\n  \
    stepwave machine ppc-line dda-line --travel 100mm,100mm,50mm --blu 0.01mm --feed 600 --markdown"
)]
pub(crate) struct MachineArgs {
    /// Methods [default: all of lines and arcs]
    #[arg(value_parser = model_name(), hide_possible_values = true)]
    pub(crate) models: Vec<String>,
    /// How far each axis goes from the origin, each way: 300mm,200mm; in mm without a unit
    #[arg(long, value_name = "X,Y[,Z]", value_parser = parse_travel)]
    pub(crate) travel: Travel,
    /// Length of one BLU
    #[arg(long, value_name = "LENGTH", default_value = "0.001mm", value_parser = parse_blu)]
    pub(crate) blu: f64,
    /// Feed along the path that every corner must reach: 2400mm/min, 40mm/s; in mm/min without a unit
    #[arg(long, value_name = "SPEED", value_parser = parse_speed)]
    pub(crate) feed: f64,
    /// Clock frequency in Hz of data sampling, and of the ramps of --accel
    #[arg(long, value_name = "HZ", default_value = "1e6", value_parser = parse_clock)]
    pub(crate) clock_hz: f64,
    /// Acceleration along the path, or A,D with a deceleration of its own: 500mm/s2; adds the ramp of every method that runs
    /// programs, and one move across the travel with it
    #[arg(long, value_name = "A[,D]", value_parser = |text: &str| of_ramp(&ACCEL, text))]
    pub(crate) accel: Option<String>,
    /// Jerk, for ramps along an S: 20000mm/s3
    #[arg(long, value_name = "J", requires = "accel", value_parser = |text: &str| of_ramp(&JERK, text))]
    pub(crate) jerk: Option<String>,
    /// What the hardware costs: LUTs, flip-flops and the highest clock, by the tools of the Debian packages yosys and
    /// nextpnr-ice40
    #[arg(long, value_name = "FAMILY")]
    pub(crate) synth: Option<Family>,
    /// Only rows that no other row beats, and which were left out
    #[arg(long)]
    pub(crate) pareto: bool,
    /// The table in Markdown
    #[arg(long, conflicts_with = "json")]
    pub(crate) markdown: bool,
    /// As JSON
    #[arg(long)]
    pub(crate) json: bool,
}
