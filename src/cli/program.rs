//! The command line of `program`.

use std::ffi::OsStr;
use std::path::PathBuf;

use crate::models::{Model, installed};
use crate::nc::{Corner, Integers, Scheme};
use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Args, Command};

use super::values::{ClockArgs, SimulationArgs, one_of, parse_blu, parse_feed, parse_speed};
use super::{BenchArgs, HardwareArgs, ShownArgs};
use crate::own::is_netlist;
use crate::simulation::FileOptions;
use crate::waves::WaveOptions;

/// The radius of a tool: `1=4mm`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tool {
    /// The D number.
    pub(crate) number: u64,
    /// Radius in mm.
    pub(crate) radius: f64,
}

fn parse_tool(text: &str) -> Result<Tool, String> {
    let remedy = || format!("invalid tool '{text}': give its D number and radius, such as 1=4mm");
    let (number, radius) = text.split_once('=').ok_or_else(remedy)?;
    let number = number.trim().trim_start_matches(['D', 'd']).parse().map_err(|_| remedy())?;
    let radius = parse_length(radius.trim()).filter(|radius| *radius >= 0.0).ok_or_else(remedy)?;
    Ok(Tool { number, radius })
}

/// Where the machine's zero is in the program, in mm; none where G28 and G53 do not move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Home(pub(crate) Option<[f64; 3]>);

fn parse_home(text: &str) -> Result<Home, String> {
    let remedy = || format!("'{text}' is not a home: give X,Y,Z such as 0,0,50mm, or ignore");
    if text == "ignore" {
        return Ok(Home(None));
    }
    let coordinates = text.split(',').map(|word| parse_length(word.trim()).ok_or_else(remedy));
    let coordinates = coordinates.collect::<Result<Vec<f64>, String>>()?;
    coordinates.try_into().map(|home| Home(Some(home))).map_err(|_| remedy())
}

/// A length in mm of either sign or 0, with its unit or, in mm, without one.
fn parse_length(text: &str) -> Option<f64> {
    if let Ok(length) = text.parse::<f64>() {
        return length.is_finite().then_some(length);
    }
    let size = text.strip_prefix('-');
    let number = size.unwrap_or(text).trim_end_matches(|c: char| !c.is_ascii_digit() && c != '.');
    if number.parse() == Ok(0.0) && parse_blu(&format!("1{}", &size.unwrap_or(text)[number.len()..])).is_ok() {
        return Some(0.0);
    }
    let length = parse_blu(size.unwrap_or(text)).ok()?;
    Some(if size.is_some() { -length } else { length })
}

/// An angle in degrees, more than 0.
fn parse_angle(text: &str) -> Result<f64, String> {
    let number = text.trim_end_matches("deg").trim_end_matches('°').trim().parse();
    let angle = number.ok().filter(|angle: &f64| angle.is_finite() && *angle > 0.0);
    angle.ok_or_else(|| format!("invalid angle '{text}': give degrees above 0, such as 0.001deg"))
}

fn parse_chords(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|off: &f64| (0.01..=1e6).contains(off));
    number
        .ok_or_else(|| format!("invalid distance of a chord from its arc '{text}': give BLU from 0.01 on, such as 0.5"))
}

/// Every machine that runs programs, by the name of its method.
fn machines() -> Vec<(&'static str, &'static Model)> {
    installed().machines().map(|model| (model.method_name(), model)).collect()
}

/// What runs a program.
#[derive(Clone, Debug)]
pub(crate) enum Method {
    /// The machine of a family of the catalogue.
    Family(&'static Model),
    /// A netlist of one's own at this path.
    Netlist(String),
}

/// The name of a family, or the path of a netlist.
#[derive(Clone)]
pub(super) struct MethodParser;

impl TypedValueParser for MethodParser {
    type Value = Method;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<Method, clap::Error> {
        match value.to_str().filter(|word| is_netlist(word)) {
            Some(path) => Ok(Method::Netlist(path.to_owned())),
            None => one_of(&machines()).parse_ref(command, arg, value).map(Method::Family),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(machines().into_iter().map(|(name, _)| PossibleValue::new(name))))
    }
}

/// How the text of a program becomes blocks.
#[derive(Debug, Args)]
pub(crate) struct TextArgs {
    /// Radius of the tool with a D number: 1=4mm (may be repeated)
    #[arg(long, requires = "program", value_name = "D=RADIUS", value_parser = parse_tool)]
    pub(crate) tool: Vec<Tool>,
    /// One pulse of a rotary axis (A, B, C), such as 0.001deg
    #[arg(long, requires = "program", value_name = "ANGLE", default_value = "0.001deg", value_parser = parse_angle)]
    pub(crate) blu_rotary: f64,
    /// Tool radius compensation: B, each block alone, or C, with a look at the next block
    #[arg(long, requires = "program", value_name = "SCHEME", default_value = "C", value_parser = one_of(&[("B", Scheme::B), ("C", Scheme::C)]))]
    pub(crate) compensation: Scheme,
    /// How an outside corner is gone round where a block is inserted
    #[arg(long, requires = "program", default_value = "straight",
        value_parser = one_of(&[("straight", Corner::Straight), ("circular", Corner::Circular)]))]
    pub(crate) corner: Corner,
    /// What a coordinate without decimal point counts: mm or inch as RS-274 says, or pulses as textbooks write them
    #[arg(long, requires = "program", default_value = "units",
        value_parser = one_of(&[("units", Integers::Units), ("pulses", Integers::Pulses)]))]
    pub(crate) integers: Integers,
    /// Where the machine's zero is in the program, to which G28 and G53 move, or ignore: they do not move
    #[arg(long, requires = "program", value_name = "X,Y,Z", default_value = "0,0,0", allow_hyphen_values = true, value_parser = parse_home)]
    pub(crate) home: Home,
    /// Feed of G00 in mm/min [default: a pulse of the source every second clock, or as fast as hardware of one's own can]
    #[arg(long, requires = "program", value_name = "MM/MIN", value_parser = parse_feed)]
    pub(crate) rapid: Option<f64>,
    /// Speed at which an axis can start and stop, and by which it can change at a corner, with --accel [default: the least with
    /// which no pulse is waited for, the square root of the acceleration in BLU]
    #[arg(long, requires = "accel", value_name = "V", value_parser = parse_speed)]
    pub(crate) jump: Option<f64>,
    /// How far a chord may be off its curve, in BLU: of free curves, of arcs for machines that draw lines only, and of helices
    /// whose third axis is too steep for others. With it, or with --accel, dda gets chords of G5 and G5.1 too, which it else
    /// interpolates itself [default: 0.5]
    #[arg(long, requires = "program", value_name = "BLU", value_parser = parse_chords)]
    pub(crate) chords: Option<f64>,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Compensation: G41 Dn and G42 Dn take the radius that --tool n=RADIUS gives. The feed word F is that \
    of the tool's centre.\n\n\
    Examples:\n  \
    stepwave program part.ngc --method ppc --tool 1=4mm --plot part.svg\n  \
    stepwave program part.ngc --method dda --normalize --clock-hz 5e6 --json - \n  \
    stepwave program book.nc --method cim --integers pulses --vcd book.vcd\n  \
    stepwave program part.ngc --method dda.net --bench dda.toml"
)]
pub(crate) struct ProgramArgs {
    /// The NC program
    #[arg(id = "program", value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Family of the machine, or a netlist of one's own: F.net
    #[arg(long, value_parser = MethodParser)]
    pub(crate) method: Method,
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    #[command(flatten)]
    pub(crate) text: TextArgs,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    #[command(flatten)]
    pub(crate) clock: ClockArgs,
    #[command(flatten)]
    pub(crate) simulation: SimulationArgs,
    #[command(flatten)]
    pub(crate) trace: WaveOptions,
    /// Dump also what changes at every clock: clk, and the phase of the pulse source and its sum (--trace phase dumps
    /// these alone); some hundred times as large
    #[arg(long, requires = "wave", help_heading = "Wave")]
    pub(crate) every_clock: bool,
    #[command(flatten)]
    pub(crate) outputs: FileOptions,
    #[command(flatten)]
    pub(crate) by_ending: ShownArgs,
}
