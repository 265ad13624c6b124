//! Values on the command line, each with the sentence that says what is wrong with a bad one.

use std::collections::BTreeMap;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use stepwave::kernel::Width;
use stepwave::kernel::engine::EngineKind;
use stepwave::models::{
    Adder, Beats, Choice, Choices, Compare, EndPoint, Form, Millionths, ModelError, Named, OnOverflow, Preset, Radix,
    StepTiming, System, Weights,
};
use stepwave::nc::Opens;
use stepwave::study::proof::ProofError;

use super::names::{all_widths, listed};
use crate::failure::Failure;

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
            _ => format!("'{word}' is no coordinate: give whole numbers of BLU, such as 8,6"),
        })
    };
    text.split(',').map(coordinate).collect::<Result<_, _>>().map(Point)
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

/// One `--width`: `N`, or `REGISTER=N`, or several with commas.
#[derive(Clone, Debug)]
pub(crate) struct WidthArg(Vec<(Option<String>, Width)>);

fn parse_width(text: &str) -> Result<WidthArg, String> {
    let one = |part: &str| {
        let (name, bits) = match part.split_once('=') {
            Some((name, bits)) => (Some(name.trim().to_owned()), bits.trim()),
            None => (None, part.trim()),
        };
        let bits: u64 = bits
            .parse()
            .map_err(|_| format!("'{bits}' is no width: give a number of bits from 1 to 64, such as 8 or f=9"))?;
        let width = Width::new(bits).map_err(|error| error.to_string())?;
        Ok((name, width))
    };
    text.split(',').map(one).collect::<Result<_, String>>().map(WidthArg)
}

/// One `--preset`: a preset for all, or `REGISTER=PRESET` with commas.
#[derive(Clone, Debug)]
pub(crate) struct PresetArg(Vec<(Option<String>, Preset)>);

fn parse_preset(text: &str) -> Result<PresetArg, String> {
    let preset = |word: &str| match word {
        "zero" => Ok(Preset::Zero),
        "half" => Ok(Preset::Half),
        "full" => Ok(Preset::Full),
        number => number
            .parse()
            .map(Preset::Value)
            .map_err(|_| format!("'{number}' is no preset: give zero, half, full or a number from 0 on")),
    };
    let one = |part: &str| match part.split_once('=') {
        Some((name, value)) => Ok((Some(name.trim().to_owned()), preset(value.trim())?)),
        None => Ok((None, preset(part.trim())?)),
    };
    text.split(',').map(one).collect::<Result<_, String>>().map(PresetArg)
}

/// The clock frequency in Hz.
fn parse_clock(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("'{text}' is no frequency: give Hz, such as 1000000 or 1e6"))
}

/// One BLU in millimetres.
pub(super) fn parse_blu(text: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 4] = [("mm", 1.0), ("um", 1e-3), ("µm", 1e-3), ("in", 25.4)];
    let way_out = || format!("'{text}' is no length: give one such as 0.001mm, 1um or 0.0001in");
    let (unit, scale) = UNITS.iter().find(|(unit, _)| text.ends_with(unit)).ok_or_else(way_out)?;
    let number = text.strip_suffix(unit).unwrap_or_default().trim();
    let length: f64 = number.parse().map_err(|_| way_out())?;
    if length.is_finite() && length > 0.0 { Ok(length * scale) } else { Err(way_out()) }
}

/// A choice among named values.
pub(super) fn one_of<T: Clone + Send + Sync + 'static>(
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

/// A hardware choice by its words.
fn named<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    one_of(T::ALL)
}

/// Feed override in percent.
fn parse_override(text: &str) -> Result<u64, String> {
    let number = text.strip_suffix('%').unwrap_or(text).trim();
    let percent = number.parse().ok().filter(|percent| (1..=99).contains(percent));
    percent.ok_or_else(|| {
        format!("'{text}' is no feed override: give a percentage from 1 to 99, or leave --override out for 100")
    })
}

/// Bits of a unit.
fn parse_bits(text: &str) -> Result<Width, String> {
    let bits = text.parse().map_err(|_| format!("'{text}' is no number of bits: give one from 1 to 64"))?;
    Width::new(bits).map_err(|error| error.to_string())
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
            _ => Err(format!("'{part}' is no register with a number of bits from 1 to 63: give f=1")),
        }
    };
    text.split(',').map(one).collect::<Result<_, _>>().map(Narrower)
}

/// Times of step and direction outputs: `length=2,space=2,setup=4,hold=4`, any of them.
pub(super) fn parse_timing(text: &str) -> Result<StepTiming, String> {
    let way_out = "give clocks such as length=2,space=2,setup=4,hold=4";
    let (mut timing, mut named) = (StepTiming::default(), Vec::new());
    for part in text.split(',') {
        let (name, clocks) = part.split_once('=').ok_or_else(|| format!("'{part}' is no time: {way_out}"))?;
        let least = u64::from(matches!(name.trim(), "length" | "space"));
        let number = clocks.trim().parse().ok().filter(|clocks| (least..=1 << 20).contains(clocks));
        let number = number.ok_or_else(|| format!("'{clocks}' is no time from {least} to {}: {way_out}", 1 << 20))?;
        if named.contains(&name.trim()) {
            return Err(format!("'{}' is given two times: leave one of them out", name.trim()));
        }
        named.push(name.trim());
        match name.trim() {
            "length" => timing.length = number,
            "space" => timing.space = number,
            "setup" => timing.setup = number,
            "hold" => timing.hold = number,
            name => return Err(format!("there is no time '{name}': {way_out}")),
        }
    }
    Ok(timing)
}

/// A length in BLU with up to six decimals.
pub(super) fn parse_millionths(text: &str) -> Result<Millionths, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| *number > 0.0);
    number
        .and_then(Millionths::nearest)
        .filter(|length| length.0 > 0)
        .ok_or_else(|| format!("'{text}' is no length: give BLU from 0.000001 to 1e9, such as 80 or 102.4"))
}

/// A speed in mm/min.
fn parse_feed(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| format!("'{text}' is no feed: give mm/min, such as 600"))
}

#[derive(Debug, Args)]
#[command(next_help_heading = "Hardware (each model takes some; `stepwave list` tells which)")]
pub(crate) struct HardwareArgs {
    /// Width of all magnitude registers, or of single ones by name [default: the least that holds the geometry]
    #[arg(long, value_name = "N|REGISTER=N,…", hide_possible_values = true)]
    #[arg(value_parser = listed(parse_width, all_widths()))]
    width: Vec<WidthArg>,
    /// Start value of the remainder registers: zero, half, full, a number, or jrx=…,jry=…
    #[arg(long, value_name = "PRESET", hide_possible_values = true)]
    #[arg(value_parser = listed(parse_preset, ["zero", "half", "full"].map(str::to_owned).into()))]
    preset: Vec<PresetArg>,
    /// Left-shift normalisation of the integrands
    #[arg(long)]
    normalize: bool,
    /// Number system of the integrators: binary, or decimal digits of 4 bits
    #[arg(long, value_parser = named::<Radix>())]
    radix: Option<Radix>,
    /// How integrators add: all bits in a clock, or one bit a clock
    #[arg(long, value_parser = named::<Adder>())]
    adder: Option<Adder>,
    /// What ends a block
    #[arg(long, value_parser = named::<EndPoint>())]
    end_point: Option<EndPoint>,
    /// How the deviation of a line is kept
    #[arg(long, value_parser = named::<Form>())]
    form: Option<Form>,
    /// Interval weight that counts for a pulse: of the middle, before it, or behind it
    #[arg(long, value_parser = named::<Weights>())]
    weights: Option<Weights>,
    /// Clocks of a step
    #[arg(long, value_parser = named::<Beats>())]
    beats: Option<Beats>,
    /// Feed override: a pulse multiplier of two decades in front of the clock
    #[arg(long = "override", value_name = "PERCENT", value_parser = parse_override)]
    feed_override: Option<u64>,
    /// Bits of each unit of a cascaded pulse multiplier [default: one unit]
    #[arg(long, value_name = "BITS", value_parser = parse_bits)]
    cascade: Option<Width>,
    /// Comparison that makes a counter step: ge (>=), or gt (>) as early firmware does
    #[arg(long, value_parser = named::<Compare>())]
    compare: Option<Compare>,
    /// Bit of the phase accumulator whose changes are steps
    #[arg(long, value_name = "BIT", value_parser = clap::value_parser!(u64).range(1..=62))]
    pick_off: Option<u64>,
    /// Clocks of step length and space, direction set-up and hold: length=…,space=…,setup=…,hold=…
    #[arg(long, value_name = "NAME=CLOCKS,…", value_parser = parse_timing)]
    timing: Option<StepTiming>,
    /// How the coarse stage of data sampling calculates, and its period: 7m in 8 ms, 7360 in 10.24 ms
    #[arg(long, value_parser = named::<System>())]
    system: Option<System>,
    /// Bits of the fraction of coarse points
    #[arg(long, value_name = "BITS")]
    fraction: Option<u32>,
    /// Way of a period of data sampling, in BLU
    #[arg(long, value_name = "BLU", value_parser = parse_millionths, conflicts_with = "feed")]
    step: Option<Millionths>,
    /// Feed in mm/min, which with --system and --blu gives the way of a period
    #[arg(long, value_name = "MM/MIN", value_parser = parse_feed)]
    feed: Option<f64>,
    /// How far an arc may be left, in BLU: by the chords of a coarse stage, and by an end point, whose radius may differ from
    /// that of the start by so much more than rounding makes
    #[arg(long, value_name = "BLU", value_parser = parse_millionths)]
    tolerance: Option<Millionths>,
    /// Length of one BLU, which gives --feed its way, and lengths of the report theirs
    #[arg(long, value_name = "LENGTH", default_value = "0.001mm", value_parser = parse_blu)]
    pub(crate) blu: f64,
    /// What a cell does that must not overflow
    #[arg(long, value_parser = named::<OnOverflow>())]
    on_overflow: Option<OnOverflow>,
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
    #[arg(long, value_name = "CLOCKS", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) max_clocks: Option<u64>,
}

/// Splits values for all from values for single registers.
///
/// # Errors
/// Two values were given for the same: neither may be ignored.
fn split<T>(
    option: &str,
    given: impl Iterator<Item = (Option<String>, T)>,
) -> Result<(Option<T>, BTreeMap<String, T>), Failure> {
    let (mut all, mut single) = (None, BTreeMap::new());
    for (name, value) in given {
        let whose = name.as_ref().map_or_else(|| "all registers".to_owned(), |name| format!("'{name}'"));
        let before = match name {
            Some(name) => single.insert(name, value),
            None => all.replace(value),
        };
        if before.is_some() {
            return Err(Failure::Trouble(format!("{option} gives {whose} two values: leave one of them out")));
        }
    }
    Ok((all, single))
}

impl HardwareArgs {
    /// A model's error in the words of this command line: a feed gives the way of a period, which is a choice of its own.
    pub(crate) fn told(&self, error: ModelError) -> Failure {
        match error {
            ModelError::NotTaken { model, choice: Choice::Step, takes } if self.feed.is_some() => {
                Failure::Trouble(format!("{model} does not take --feed; it takes {takes}"))
            }
            error @ ModelError::Value { choice: Choice::Step, .. } if self.feed.is_some() => {
                let feed = self.feed.unwrap_or_default();
                Failure::Trouble(format!("--feed {feed} gives the way of a period, as --step does: {error}"))
            }
            other => other.into(),
        }
    }

    /// As [`told`](Self::told), of a study of the model.
    pub(crate) fn told_of_study(&self, error: ProofError) -> Failure {
        match error {
            ProofError::Model(error) => self.told(error),
            other => other.into(),
        }
    }

    /// The choices made, for a clock of this frequency in Hz.
    pub(crate) fn choices_at(&self, clock_hz: f64) -> Result<Choices, Failure> {
        Ok(Choices { clock_hz: Some(Millionths::saturating(clock_hz)), ..self.choices()? })
    }

    /// How far the two radii of an arc may differ beyond what rounding makes, in BLU.
    pub(crate) fn radii(&self) -> f64 {
        self.tolerance.map_or(0.0, Millionths::units)
    }

    /// The choices made.
    ///
    /// # Errors
    /// One of them was made twice.
    pub(crate) fn choices(&self) -> Result<Choices, Failure> {
        let (width, widths) = split("--width", self.width.iter().flat_map(|arg| arg.0.iter().cloned()))?;
        let (preset, presets) = split("--preset", self.preset.iter().flat_map(|arg| arg.0.iter().cloned()))?;
        // What is beyond all measure is refused by its length.
        let of_feed = |feed: f64| {
            let way = feed / 60.0 * self.system.unwrap_or_default().period() / self.blu;
            Millionths::nearest(way).unwrap_or(Millionths(1 << 60))
        };
        Ok(Choices {
            width,
            widths,
            preset,
            presets,
            normalize: self.normalize,
            radix: self.radix,
            adder: self.adder,
            end_point: self.end_point,
            form: self.form,
            weights: self.weights,
            beats: self.beats,
            feed_override: self.feed_override,
            cascade: self.cascade,
            compare: self.compare,
            pick_off: self.pick_off,
            timing: self.timing,
            system: self.system,
            fraction: self.fraction,
            step: self.step.or_else(|| self.feed.map(of_feed)),
            tolerance: self.tolerance,
            clock_hz: None,
            on_overflow: self.on_overflow,
        })
    }
}
