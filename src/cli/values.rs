//! Values on the command line, each with the sentence that says what is wrong with a bad one.

use std::ops::{Bound, RangeBounds};

use super::Travel;
use stepwave_import::Unknown;

use crate::engine::EngineKind;
use crate::models::Millionths;
use crate::models::events::Timed;
use crate::nc::{NURBS_MOST, Opens};
use crate::study::units;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// A whole number in this range.
pub(crate) fn whole<T: TryFrom<u64>>(
    range: impl RangeBounds<u64> + Clone,
) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| range.contains(number));
        number.and_then(|number| T::try_from(number).ok()).ok_or_else(|| {
            let least = match range.start_bound() {
                Bound::Included(least) => *least,
                Bound::Excluded(below) => below.saturating_add(1),
                Bound::Unbounded => 0,
            };
            let most = match range.end_bound() {
                Bound::Included(most) => format!("to {most}"),
                Bound::Excluded(above) => format!("to {}", above.saturating_sub(1)),
                Bound::Unbounded => "on".to_owned(),
            };
            format!("give a whole number from {least} {most}")
        })
    }
}

/// Coordinates of a point in BLU.
#[derive(Clone, Debug)]
pub(crate) struct Point(pub(crate) Vec<i64>);

pub(crate) fn parse_point(text: &str) -> Result<Point, String> {
    let coordinate = |word: &str| {
        let word = word.trim();
        word.parse::<i64>().map_err(|error| match error.kind() {
            std::num::IntErrorKind::PosOverflow | std::num::IntErrorKind::NegOverflow => {
                format!("'{word}' is too large for a coordinate: give whole BLU within ±2^52")
            }
            _ => format!("invalid coordinate '{word}': give whole numbers of BLU, such as 8,6"),
        })
    };
    text.split(',').map(coordinate).collect::<Result<_, _>>().map(Point)
}

/// Decimal numbers in units of 10^-9, to which they are rounded.
pub(crate) fn parse_decimals(text: &str) -> Result<Vec<i64>, String> {
    let number = |word: &str| {
        units(word).ok_or_else(|| {
            format!("invalid number '{}': give one within ±{NURBS_MOST}, such as 0.707106781", word.trim())
        })
    };
    text.split(',').map(number).collect()
}

/// Two whole numbers of BLU.
pub(crate) fn parse_pair(text: &str) -> Result<[i64; 2], String> {
    let Point(numbers) = parse_point(text)?;
    numbers.try_into().map_err(|_| format!("'{text}' is not two numbers: give A,B such as 6,4"))
}

/// Where an open curve opens to.
pub(crate) fn opens() -> impl TypedValueParser<Value = Opens> {
    one_of(&[("+x", Opens::PlusX), ("-x", Opens::MinusX), ("+y", Opens::PlusY), ("-y", Opens::MinusY)])
}

/// The clock frequency in Hz.
pub(super) fn parse_clock(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("invalid frequency '{text}': give Hz above 0, such as 1000000 or 1e6"))
}

/// One BLU in millimetres.
pub(super) fn parse_blu(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 4] = [("mm", 1.0), ("um", 1e-3), ("µm", 1e-3), ("in", 25.4)];
    let remedy = || format!("invalid length '{text}': give one above 0, such as 0.001mm, 1um or 0.0001in");
    let (unit, scale) = UNITS.iter().find(|(unit, _)| text.ends_with(unit)).ok_or_else(remedy)?;
    let number = text.strip_suffix(unit).unwrap_or_default().trim();
    let length: f64 = number.parse().map_err(|_| remedy())?;
    if length.is_finite() && length > 0.0 { Ok(length * scale) } else { Err(remedy()) }
}

/// A choice among named values.
pub(crate) fn one_of<T: Clone + Send + Sync + 'static>(
    values: &[(&'static str, T)],
) -> impl TypedValueParser<Value = T> + use<T> {
    let values = values.to_vec();
    let names: Vec<&'static str> = values.iter().map(|(name, _)| *name).collect();
    PossibleValuesParser::new(names).map(move |given| {
        let chosen = values.iter().find(|(name, _)| *name == given).map(|(_, value)| value.clone());
        // The parser before it lets only known names through.
        chosen.unwrap_or_else(|| values[0].1.clone())
    })
}

/// `--narrower`: registers, and by how many bits.
#[derive(Clone, Debug)]
pub(crate) struct Narrower(pub(crate) Vec<(String, u32)>);

/// `REGISTER=BITS`, or several with commas.
pub(super) fn parse_narrower(text: &str) -> Result<Narrower, String> {
    let one = |part: &str| {
        let pair = part.split_once('=').map(|(name, bits)| (name.trim().to_owned(), bits.trim().parse()));
        match pair {
            Some((name, Ok(bits @ 1..=63))) => Ok((name, bits)),
            _ => Err(format!("invalid register and bits '{part}': give a register and 1 to 63 bits, such as f=1")),
        }
    };
    text.split(',').map(one).collect::<Result<_, _>>().map(Narrower)
}

/// A length in BLU with up to six decimals.
pub(super) fn parse_millionths(text: &str) -> Result<Millionths, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| *number > 0.0);
    number
        .and_then(Millionths::nearest)
        .filter(|length| length.0 > 0)
        .ok_or_else(|| format!("invalid length '{text}': give BLU from 0.000001 to 1e9, such as 80 or 102.4"))
}

/// A speed in mm/min.
pub(super) fn parse_feed(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| format!("invalid feed '{text}': give mm/min above 0, such as 600"))
}

/// A speed in mm/min, with its unit or without one.
pub(super) fn parse_speed(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 4] = [("mm/min", 1.0), ("mm/s", 60.0), ("in/min", 25.4), ("m/min", 1000.0)];
    let unit = UNITS.iter().find(|(unit, _)| text.ends_with(unit));
    let (number, scale) = unit.map_or((text, 1.0), |(unit, scale)| (text.trim_end_matches(unit).trim(), *scale));
    parse_feed(number)
        .map(|speed| speed * scale)
        .map_err(|_| format!("invalid feed '{text}': give a speed above 0, such as 2400mm/min, 40mm/s or 95in/min"))
}

/// The travel of two or three axes in mm, with units or without.
pub(super) fn parse_travel(text: &str) -> Result<Travel, String> {
    let length = |word: &str| {
        let word = word.trim();
        let mm = word.parse().ok().filter(|mm: &f64| mm.is_finite() && *mm > 0.0);
        mm.map_or_else(|| parse_blu(word), Ok)
            .map_err(|_| format!("invalid travel '{word}': give lengths above 0 in mm, um or in, such as 300mm,200mm"))
    };
    let axes: Vec<f64> = text.split(',').map(length).collect::<Result<_, _>>()?;
    match axes.len() {
        2..=3 => Ok(Travel(axes)),
        1 => Err("a machine of one axis: give the travel of two or three, such as 300mm,200mm".to_owned()),
        count => Err(format!("a machine of {count} axes: give the travel of two or three, such as 300mm,200mm")),
    }
}

/// The clock frequency, for commands that write waves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Time")]
pub(crate) struct ClockArgs {
    /// Clock frequency in Hz, for the time axis, the feed and the period of data sampling
    #[arg(long, value_name = "HZ", default_value = "1e6", value_parser = parse_clock)]
    pub(crate) clock_hz: f64,
}

/// How a run is simulated and reported.
#[derive(Debug, Args)]
#[command(next_help_heading = "Simulation")]
pub(crate) struct SimulationArgs {
    /// What simulates the netlist
    #[arg(long, default_value = "auto", value_parser = one_of(&[
        ("auto", EngineKind::Compiled), ("compiled", EngineKind::Compiled), ("word", EngineKind::Word),
        ("gates", EngineKind::Gates)]))]
    pub(crate) engine: EngineKind,
    /// A run that is not done after so many clocks is given up; one that comes back to an earlier state always is
    #[arg(long, value_name = "CLOCKS", value_parser = whole::<u64>(1..))]
    pub(crate) max_clocks: Option<u64>,
    /// What the operator does right after a clock: CLOCK:hold, resume, override=PERCENT, single, start or continuous (may be
    /// repeated; of hardware with acceleration)
    #[arg(long, value_name = "CLOCK:EVENT", value_parser = Timed::parse)]
    pub(crate) event: Vec<Timed>,
}

/// A name and a value with `=` between them.
pub(super) fn parse_setting(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.trim().to_owned())),
        _ => Err("expected NAME=VALUE".to_owned()),
    }
}

/// What unknown bits are taken for.
pub(super) fn parse_unknown(text: &str) -> Result<Unknown, String> {
    match (text, text.strip_prefix("random:").map(str::parse)) {
        ("0", _) => Ok(Unknown::Zero),
        ("1", _) => Ok(Unknown::One),
        (_, Some(Ok(seed))) => Ok(Unknown::Random(seed)),
        _ => Err("expected 0, 1 or random:SEED, with a whole number as the seed".to_owned()),
    }
}
