//! What a user may choose of the hardware, and which model takes which choice.

use std::collections::BTreeMap;
use std::fmt;

use stepwave_kernel::bits::Reading;
use stepwave_kernel::{OnOverflow, Width};

/// Value that a remainder register J_R starts from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Preset {
    /// 0.
    #[default]
    Zero,
    /// 2^(n-1): rounds to nearest.
    Half,
    /// 2^n - 1.
    Full,
    /// Any value that fits.
    Value(u64),
}

/// A choice among a few values, each with the word that a user writes.
pub trait Named: Copy + PartialEq + 'static {
    /// Every value with its word.
    const ALL: &'static [(&'static str, Self)];

    /// The word of this value.
    #[must_use]
    fn word(self) -> &'static str {
        Self::ALL.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }
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
    /// The sum of the weights before and behind the pulse: F is the exact implicit function.
    #[default]
    Mid,
    /// The weight before the pulse.
    Pre,
    /// The weight behind the pulse.
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

/// How the coarse stage of data sampling calculates the way of a period.
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

/// A length in millionths of a BLU, or whatever else is written with up to six decimals.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Millionths(pub u64);

impl Millionths {
    /// As a number of units.
    #[must_use]
    pub fn units(self) -> f64 {
        self.0 as f64 / 1e6
    }

    /// The nearest to a number of units, from 0 on, with as much as the type holds.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn saturating(units: f64) -> Millionths {
        Millionths((units * 1e6).round() as u64)
    }

    /// The nearest to a number of units from 0 on; `None` where it is beyond all measure.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn nearest(units: f64) -> Option<Millionths> {
        (0.0..1e9).contains(&units).then(|| Millionths((units * 1e6).round() as u64))
    }
}

impl fmt::Display for Millionths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (whole, rest) = (self.0 / 1_000_000, self.0 % 1_000_000);
        if rest == 0 {
            return write!(f, "{whole}");
        }
        write!(f, "{whole}.{}", format!("{rest:06}").trim_end_matches('0'))
    }
}

/// Times of a step and direction output, in clocks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct StepTiming {
    /// The step output is 1.
    pub length: u64,
    /// The step output is 0 between two steps, at least.
    pub space: u64,
    /// From a change of the direction output to the first step.
    pub setup: u64,
    /// From the end of the last step to a change of the direction output.
    pub hold: u64,
}

impl Default for StepTiming {
    fn default() -> StepTiming {
        StepTiming { length: 2, space: 2, setup: 4, hold: 4 }
    }
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
    /// `--radix`
    Radix,
    /// `--adder`
    Adder,
    /// `--end-point`
    EndPoint,
    /// `--form`
    Form,
    /// `--weights`
    Weights,
    /// `--beats`
    Beats,
    /// `--override`
    Override,
    /// `--cascade`
    Cascade,
    /// `--compare`
    Compare,
    /// `--pick-off`
    PickOff,
    /// `--timing`
    Timing,
    /// `--system`
    System,
    /// `--fraction`
    Fraction,
    /// `--step`
    Step,
    /// `--tolerance`
    Tolerance,
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
            Choice::Radix => "--radix",
            Choice::Adder => "--adder",
            Choice::EndPoint => "--end-point",
            Choice::Form => "--form",
            Choice::Weights => "--weights",
            Choice::Beats => "--beats",
            Choice::Override => "--override",
            Choice::Cascade => "--cascade",
            Choice::Compare => "--compare",
            Choice::PickOff => "--pick-off",
            Choice::Timing => "--timing",
            Choice::System => "--system",
            Choice::Fraction => "--fraction",
            Choice::Step => "--step",
            Choice::Tolerance => "--tolerance",
            Choice::OnOverflow => "--on-overflow",
        }
    }
}

impl fmt::Display for StepTiming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "length={},space={},setup={},hold={}", self.length, self.space, self.setup, self.hold)
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
    /// The value in a register that counts modulo `modulus`; `None` where it does not fit.
    #[must_use]
    pub fn value(self, modulus: u128) -> Option<u128> {
        match self {
            Preset::Zero => Some(0),
            Preset::Half => Some(modulus / 2),
            Preset::Full => Some(modulus - 1),
            Preset::Value(value) => (u128::from(value) < modulus).then_some(value.into()),
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
    /// Number system.
    pub radix: Option<Radix>,
    /// How integrators add.
    pub adder: Option<Adder>,
    /// End-point scheme.
    pub end_point: Option<EndPoint>,
    /// Form of the line's deviation.
    pub form: Option<Form>,
    /// Weight rule of comparison-integral.
    pub weights: Option<Weights>,
    /// Clocks a step.
    pub beats: Option<Beats>,
    /// Feed override in percent.
    pub feed_override: Option<u64>,
    /// Bits of each of the cascaded units of a pulse multiplier.
    pub cascade: Option<Width>,
    /// Comparison of a counter.
    pub compare: Option<Compare>,
    /// Bit of a phase accumulator whose changes are steps.
    pub pick_off: Option<u64>,
    /// Times of step and direction outputs.
    pub timing: Option<StepTiming>,
    /// How the coarse stage of data sampling calculates.
    pub system: Option<System>,
    /// Bits of the fraction of coarse points.
    pub fraction: Option<u32>,
    /// Way of a period in BLU.
    pub step: Option<Millionths>,
    /// Greatest chord error in BLU.
    pub tolerance: Option<Millionths>,
    /// Frequency of the clock in Hz, by which data sampling divides it; the least with which it keeps its period if none.
    pub clock_hz: Option<Millionths>,
    /// What a strict cell does on overflow.
    pub on_overflow: Option<OnOverflow>,
}

impl Choices {
    /// All by default, with the clock of 1 MHz that commands have where none is given.
    #[must_use]
    pub fn at_1_mhz() -> Choices {
        Choices { clock_hz: Some(Millionths::saturating(1e6)), ..Choices::default() }
    }

    /// The choices that differ from "by default".
    #[must_use]
    pub fn given(&self) -> Vec<Choice> {
        [
            (self.width.is_some() || !self.widths.is_empty(), Choice::Width),
            (self.preset.is_some() || !self.presets.is_empty(), Choice::Preset),
            (self.normalize, Choice::Normalize),
            (self.radix.is_some(), Choice::Radix),
            (self.adder.is_some(), Choice::Adder),
            (self.end_point.is_some(), Choice::EndPoint),
            (self.form.is_some(), Choice::Form),
            (self.weights.is_some(), Choice::Weights),
            (self.beats.is_some(), Choice::Beats),
            (self.feed_override.is_some(), Choice::Override),
            (self.cascade.is_some(), Choice::Cascade),
            (self.compare.is_some(), Choice::Compare),
            (self.pick_off.is_some(), Choice::PickOff),
            (self.timing.is_some(), Choice::Timing),
            (self.system.is_some(), Choice::System),
            (self.fraction.is_some(), Choice::Fraction),
            (self.step.is_some(), Choice::Step),
            (self.tolerance.is_some(), Choice::Tolerance),
            (self.on_overflow.is_some(), Choice::OnOverflow),
        ]
        .into_iter()
        .filter_map(|(given, choice)| given.then_some(choice))
        .collect()
    }

    /// The options that give these choices on the command line, in a fixed order.
    #[must_use]
    pub fn options(&self) -> Vec<String> {
        let mut words = Vec::new();
        let mut add = |choice: Choice, value: Option<String>| {
            if let Some(value) = value {
                words.push(choice.option().to_owned());
                words.extend(Some(value).filter(|value| !value.is_empty()));
            }
        };
        fn word<T: Named>(choice: Option<T>) -> Option<String> {
            choice.map(|choice| choice.word().to_owned())
        }
        fn list<T>(all: Option<String>, single: &BTreeMap<String, T>, text: impl Fn(&T) -> String) -> Option<String> {
            let single = single.iter().map(|(name, value)| format!("{name}={}", text(value)));
            let list: Vec<String> = all.into_iter().chain(single).collect();
            (!list.is_empty()).then(|| list.join(","))
        }
        let width = |width: &Width| width.get().to_string();
        add(Choice::Width, list(self.width.as_ref().map(width), &self.widths, width));
        add(Choice::Preset, list(self.preset.map(|preset| preset.to_string()), &self.presets, Preset::to_string));
        add(Choice::Normalize, self.normalize.then(String::new));
        add(Choice::Radix, word(self.radix));
        add(Choice::Adder, word(self.adder));
        add(Choice::EndPoint, word(self.end_point));
        add(Choice::Form, word(self.form));
        add(Choice::Weights, word(self.weights));
        add(Choice::Beats, word(self.beats));
        add(Choice::Override, self.feed_override.map(|percent| percent.to_string()));
        add(Choice::Cascade, self.cascade.as_ref().map(width));
        add(Choice::Compare, word(self.compare));
        add(Choice::PickOff, self.pick_off.map(|bit| bit.to_string()));
        add(Choice::Timing, self.timing.map(|timing| timing.to_string()));
        add(Choice::System, word(self.system));
        add(Choice::Fraction, self.fraction.map(|bits| bits.to_string()));
        add(Choice::Step, self.step.map(|step| step.to_string()));
        add(Choice::Tolerance, self.tolerance.map(|length| length.to_string()));
        add(Choice::OnOverflow, word(self.on_overflow));
        words
    }
}
