//! Options that are one of a few words: the types of their values.

use std::fmt;

use stepwave_netlist::OnOverflow;
use stepwave_netlist::bits::Reading;

use super::Named;

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

impl Named for EndPoint {
    const ALL: &'static [(&'static str, EndPoint)] = &[
        ("total", EndPoint::Total),
        ("per-axis", EndPoint::PerAxis),
        ("longest", EndPoint::Longest),
        ("iterations", EndPoint::Iterations),
    ];
}

/// How the deviation of a line is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Form {
    /// Registers hold |dx| and |dy|; all quadrants look like the first.
    #[default]
    Magnitude,
    /// Registers hold dx and dy; F = dx·y - dy·x.
    Signed,
    /// As `Magnitude`, but F >= 0 steps X whatever the line, as textbooks print it: wrong where the line runs along y.
    Bare,
}

impl Named for Form {
    const ALL: &'static [(&'static str, Form)] =
        &[("magnitude", Form::Magnitude), ("signed", Form::Signed), ("bare", Form::Bare)];
}

/// Clocks of a step that is judged.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Beats {
    /// Judge, feed, compute and compare, one clock each.
    #[default]
    Four,
    /// All at one edge.
    One,
}

impl Beats {
    /// Clocks of a step.
    #[must_use]
    pub fn clocks(self) -> u64 {
        match self {
            Beats::Four => 4,
            Beats::One => 1,
        }
    }
}

impl Named for Beats {
    const ALL: &'static [(&'static str, Beats)] = &[("4", Beats::Four), ("1", Beats::One)];
}

/// Number system of the registers that are added.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Radix {
    /// Binary.
    #[default]
    Binary,
    /// Binary-coded decimal, 4 bits a digit.
    Decimal,
}

impl Radix {
    /// Bits of a digit.
    #[must_use]
    pub fn digit_bits(self) -> u32 {
        match self {
            Radix::Binary => 1,
            Radix::Decimal => 4,
        }
    }
}

impl Named for Radix {
    const ALL: &'static [(&'static str, Radix)] = &[("2", Radix::Binary), ("10", Radix::Decimal)];
}

impl Radix {
    /// How registers of this radix are read.
    #[must_use]
    pub fn reading(self) -> Reading {
        match self {
            Radix::Binary => Reading::Unsigned,
            Radix::Decimal => Reading::Decimal,
        }
    }
}

/// How an integrator adds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Adder {
    /// All bits in one clock.
    #[default]
    Parallel,
    /// One bit a clock, the lowest first.
    Serial,
}

impl Named for Adder {
    const ALL: &'static [(&'static str, Adder)] = &[("parallel", Adder::Parallel), ("serial", Adder::Serial)];
}

/// The interval weight with which comparison-integral counts a pulse.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Weights {
    /// The sum of the weights before and after the pulse: F is the exact implicit function.
    #[default]
    Mid,
    /// The weight before the pulse.
    Pre,
    /// The weight after the pulse.
    Post,
}

impl Named for Weights {
    const ALL: &'static [(&'static str, Weights)] =
        &[("mid", Weights::Mid), ("pre", Weights::Pre), ("post", Weights::Post)];
}

/// What a counter is compared with to give a pulse.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Compare {
    /// At least the number of steps (`>=`).
    #[default]
    AtLeast,
    /// More than the number of steps (`>`), as early firmware does.
    Greater,
}

impl Named for Compare {
    const ALL: &'static [(&'static str, Compare)] = &[("ge", Compare::AtLeast), ("gt", Compare::Greater)];
}

impl Named for OnOverflow {
    const ALL: &'static [(&'static str, OnOverflow)] =
        &[("trap", OnOverflow::Trap), ("saturate", OnOverflow::Saturate), ("wrap", OnOverflow::Wrap)];
}

/// How the coarse stage of data sampling calculates the travel of a period.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum System {
    /// By the direction in the middle of the period: tangent, cosine, square root.
    #[default]
    Direction,
    /// The extended DDA: by the step factor λ.
    StepFactor,
}

impl Named for System {
    const ALL: &'static [(&'static str, System)] = &[("7m", System::Direction), ("7360", System::StepFactor)];
}

impl System {
    /// The period T in seconds.
    #[must_use]
    pub fn period(self) -> f64 {
        let [seconds, of] = self.period_ratio();
        seconds as f64 / of as f64
    }

    /// The period T as a ratio of whole numbers of seconds: 8 ms, or 10.24 ms.
    pub(crate) fn period_ratio(self) -> [u64; 2] {
        match self {
            System::Direction => [1, 125],
            System::StepFactor => [32, 3125],
        }
    }
}

/// How a ramp finds where to brake.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Brake {
    /// By the square of the speed.
    #[default]
    Square,
    /// By the pulses of the acceleration.
    Count,
}

impl Named for Brake {
    const ALL: &'static [(&'static str, Brake)] = &[("square", Brake::Square), ("count", Brake::Count)];
}

/// Where a machine that runs programs has its acceleration.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum RampAt {
    /// A ramp in front of the pulse source, if it has any.
    #[default]
    Before,
    /// A filter of the pulses of each axis, after the interpolator.
    After,
}

impl Named for RampAt {
    const ALL: &'static [(&'static str, RampAt)] = &[("before", RampAt::Before), ("after", RampAt::After)];
}

/// What displacements of periods go through after the interpolator.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Smooth {
    /// The mean of the last periods, 1 to 64.
    Sum(u64),
    /// 2^-s of what has not come out, s from 1 to 16.
    Exponential(u64),
}

impl Smooth {
    /// `sum=4`, `exp=2`
    pub(super) fn parse(text: &str) -> Result<Smooth, String> {
        let number = |text: &str, most| text.trim().parse().ok().filter(|number| (1..=most).contains(number));
        let of = match text.split_once('=') {
            Some(("sum", periods)) => number(periods, 64).map(Smooth::Sum),
            Some(("exp", shift)) => number(shift, 16).map(Smooth::Exponential),
            _ => None,
        };
        of.ok_or_else(|| format!("'{text}' is not a filter: give sum=1 to sum=64 periods, or exp=1 to exp=16"))
    }
}

impl fmt::Display for Smooth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Smooth::Sum(periods) => write!(f, "sum={periods}"),
            Smooth::Exponential(shift) => write!(f, "exp={shift}"),
        }
    }
}
