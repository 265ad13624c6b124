//! The command line of `machine`.

use clap::Args;

use super::names::model_name;
use super::values::{parse_blu, parse_clock, parse_speed, parse_travel};

/// The axes of a machine, in mm.
#[derive(Clone, Debug)]
pub(crate) struct Travel(pub(crate) Vec<f64>);

#[derive(Debug, Args)]
#[command(
    after_help = "A row for each method: the bits of every register, the clock with which the slowest corner of the travel\n\
    reaches --feed, the feeds reached at that clock, and the greatest path error of the runs at the corners. Corners are\n\
    the lines from the origin to the ends of the travel, along each axis and with two axes equally long, and quarters of the\n\
    greatest circle; shorter lines may be slower, such as those of integrators. The travel is rounded up to whole BLU.\n\
    Below the table every register, how its width is known, and the run that one bit less does not hold.\n\n\
    Widths are known as `stepwave widths` knows them over the box of the travel; where neither a proof nor all of its\n\
    geometries are to be had, they are those that the corners need: sampled.\n\n\
    Data sampling has its feed by the displacement of a period, at the clock of --clock-hz.\n\n\
    Examples:\n  \
    stepwave machine --travel 300mm,200mm --blu 1um --feed 2400mm/min\n  \
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
    /// Clock frequency in Hz of data sampling
    #[arg(long, value_name = "HZ", default_value = "1e6", value_parser = parse_clock)]
    pub(crate) clock_hz: f64,
    /// The table in Markdown
    #[arg(long, conflicts_with = "json")]
    pub(crate) markdown: bool,
    /// As JSON
    #[arg(long)]
    pub(crate) json: bool,
}
