//! The command line of `program`.

use std::path::PathBuf;

use clap::Args;
use stepwave::models::program::{FAMILIES, Family};
use stepwave::nc::{Corner, Integers, Scheme};

use super::values::{ClockArgs, HardwareArgs, SimulationArgs, one_of, parse_blu};
use super::{OutputArgs, TraceArgs};

/// The radius of a tool: `1=4mm`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tool {
    /// The D number.
    pub(crate) number: u64,
    /// Radius in mm.
    pub(crate) radius: f64,
}

fn parse_tool(text: &str) -> Result<Tool, String> {
    let way_out = || format!("'{text}' is no tool: give its D number and radius, such as 1=4mm");
    let (number, radius) = text.split_once('=').ok_or_else(way_out)?;
    let number = number.trim().trim_start_matches(['D', 'd']).parse().map_err(|_| way_out())?;
    Ok(Tool { number, radius: parse_blu(radius.trim()).map_err(|_| way_out())? })
}

fn parse_feed(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|feed: &f64| feed.is_finite() && *feed > 0.0);
    number.ok_or_else(|| format!("'{text}' is no feed: give mm/min, such as 3000"))
}

fn parse_chords(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|off: &f64| (0.01..=1e6).contains(off));
    number.ok_or_else(|| format!("'{text}' is no distance of a chord from its arc: give BLU from 0.01 on, such as 0.5"))
}

/// A family by its name.
fn families() -> Vec<(&'static str, &'static Family)> {
    FAMILIES.into_iter().map(|family| (family.name, family)).collect()
}

#[derive(Debug, Args)]
#[command(
    after_help = "Compensation: G41 Dn and G42 Dn take the radius that --tool n=RADIUS gives. The feed word F is that \
    of the tool's centre.\n\n\
    Examples:\n  \
    stepwave program part.ngc --method ppc --tool 1=4mm --plot part.svg\n  \
    stepwave program part.ngc --method dda --normalize --clock-hz 5e6 --json - \n  \
    stepwave program book.nc --method cim --integers pulses --vcd book.vcd"
)]
pub(crate) struct ProgramArgs {
    /// The NC program
    pub(crate) file: PathBuf,
    /// Family of the machine
    #[arg(long, value_parser = one_of(&families()))]
    pub(crate) method: &'static Family,
    /// Radius of the tool with a D number: 1=4mm (may be repeated)
    #[arg(long, value_name = "D=RADIUS", value_parser = parse_tool)]
    pub(crate) tool: Vec<Tool>,
    /// Tool radius compensation: B, each block alone, or C, with a look at the next block
    #[arg(long, value_name = "SCHEME", default_value = "C", value_parser = one_of(&[("B", Scheme::B), ("C", Scheme::C)]))]
    pub(crate) compensation: Scheme,
    /// How an outside corner is gone round where a block is inserted
    #[arg(long, default_value = "straight",
        value_parser = one_of(&[("straight", Corner::Straight), ("circular", Corner::Circular)]))]
    pub(crate) corner: Corner,
    /// What a coordinate without decimal point counts: mm or inch as RS-274 says, or pulses as textbooks write them
    #[arg(long, default_value = "units",
        value_parser = one_of(&[("units", Integers::Units), ("pulses", Integers::Pulses)]))]
    pub(crate) integers: Integers,
    /// Feed of G00 in mm/min [default: a pulse of the source every second clock]
    #[arg(long, value_name = "MM/MIN", value_parser = parse_feed)]
    pub(crate) rapid: Option<f64>,
    /// How far a chord may be off its arc, in BLU, for machines that draw lines only
    #[arg(long, value_name = "BLU", default_value = "0.5", value_parser = parse_chords)]
    pub(crate) chords: f64,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    #[command(flatten)]
    pub(crate) clock: ClockArgs,
    #[command(flatten)]
    pub(crate) simulation: SimulationArgs,
    #[command(flatten)]
    pub(crate) trace: TraceArgs,
    #[command(flatten)]
    pub(crate) outputs: OutputArgs,
}
