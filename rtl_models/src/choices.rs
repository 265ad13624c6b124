//! What a user may choose of the hardware, and which model takes which choice.

use std::collections::BTreeMap;
use std::fmt;

use stepwave_kernel::{OnOverflow, Width};

/// Value that a remainder register J_R starts from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Preset {
    /// 0.
    Zero,
    /// 2^(n-1): rounds to nearest.
    Half,
    /// 2^n - 1.
    Full,
    /// Any value that fits.
    Value(u64),
}

/// What ends a block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EndPoint {
    /// One down-counter of the steps of all axes.
    Total,
    /// A down-counter for each axis.
    PerAxis,
    /// A down-counter of the longest axis.
    Longest,
    /// A down-counter of iterations.
    Iterations,
}

/// How the deviation of a line is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Form {
    /// Registers hold |dx| and |dy|; all quadrants look like the first.
    #[default]
    Magnitude,
    /// Registers hold dx and dy; F = dx·y - dy·x.
    Signed,
}

/// Clocks of a point-by-point step.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Beats {
    /// Judge, feed, compute and compare, one clock each.
    #[default]
    Four,
    /// All at one edge.
    One,
}

/// A hardware choice, as a user names it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Choice {
    /// `--width`
    Width,
    /// `--preset`
    Preset,
    /// `--normalize`
    Normalize,
    /// `--end-point`
    EndPoint,
    /// `--form`
    Form,
    /// `--beats`
    Beats,
    /// `--on-overflow`
    OnOverflow,
}

impl Choice {
    /// The option on the command line.
    #[must_use]
    pub fn option(self) -> &'static str {
        match self {
            Choice::Width => "--width",
            Choice::Preset => "--preset",
            Choice::Normalize => "--normalize",
            Choice::EndPoint => "--end-point",
            Choice::Form => "--form",
            Choice::Beats => "--beats",
            Choice::OnOverflow => "--on-overflow",
        }
    }
}

impl fmt::Display for EndPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            EndPoint::Total => "total",
            EndPoint::PerAxis => "per-axis",
            EndPoint::Longest => "longest",
            EndPoint::Iterations => "iterations",
        })
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Preset::Zero => f.write_str("zero"),
            Preset::Half => f.write_str("half"),
            Preset::Full => f.write_str("full"),
            Preset::Value(value) => write!(f, "{value}"),
        }
    }
}

impl Preset {
    /// The value in a register of this width; `None` where it does not fit.
    #[must_use]
    pub fn value(self, width: Width) -> Option<u64> {
        match self {
            Preset::Zero => Some(0),
            Preset::Half => Some(width.sign_bit()),
            Preset::Full => Some(width.mask()),
            Preset::Value(value) => (value <= width.mask()).then_some(value),
        }
    }
}

/// Choices made by the user; `None`, `false` or empty is "as the model does by default".
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Choices {
    /// Width of all magnitude registers.
    pub width: Option<Width>,
    /// Widths of single registers by name, or of all registers of a kind (`jr` is `jrx`, `jry`, …).
    pub widths: BTreeMap<String, Width>,
    /// Preset of every remainder register.
    pub preset: Option<Preset>,
    /// Presets of single remainder registers by name.
    pub presets: BTreeMap<String, Preset>,
    /// Left-shift normalisation.
    pub normalize: bool,
    /// End-point scheme.
    pub end_point: Option<EndPoint>,
    /// Form of the line's deviation.
    pub form: Option<Form>,
    /// Clocks a step.
    pub beats: Option<Beats>,
    /// What a strict cell does on overflow.
    pub on_overflow: Option<OnOverflow>,
}

impl Choices {
    /// The choices that differ from "by default".
    #[must_use]
    pub fn given(&self) -> Vec<Choice> {
        [
            (self.width.is_some() || !self.widths.is_empty(), Choice::Width),
            (self.preset.is_some() || !self.presets.is_empty(), Choice::Preset),
            (self.normalize, Choice::Normalize),
            (self.end_point.is_some(), Choice::EndPoint),
            (self.form.is_some(), Choice::Form),
            (self.beats.is_some(), Choice::Beats),
            (self.on_overflow.is_some(), Choice::OnOverflow),
        ]
        .into_iter()
        .filter_map(|(given, choice)| given.then_some(choice))
        .collect()
    }
}
