//! What a value may be: a word, a length, times, or something for every register.

use std::collections::BTreeMap;
use std::fmt;

/// One of a few values, each with the word that a user writes.
pub trait Named: Copy + PartialEq + 'static {
    /// Every value with its word.
    const ALL: &'static [(&'static str, Self)];

    /// The word of this value.
    #[must_use]
    fn word(self) -> &'static str {
        Self::ALL.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }
}

/// A value for all registers, and values for single ones.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct PerRegister<T> {
    /// For all registers.
    pub all: Option<T>,
    /// For single registers by name, or for all registers of a kind (`jr` is `jrx`, `jry`, …).
    pub single: BTreeMap<String, T>,
}

impl<T> PerRegister<T> {
    /// For no register.
    pub(super) const NONE: PerRegister<T> = PerRegister { all: None, single: BTreeMap::new() };

    /// The values of a text such as `8,f=9`; none may be given twice.
    pub(super) fn parse(
        option: &str,
        text: &str,
        value: impl Fn(&str) -> Result<T, String>,
    ) -> Result<PerRegister<T>, String> {
        let mut given = PerRegister::NONE;
        for part in text.split(',') {
            let (name, word) = part.split_once('=').map_or((None, part), |(name, word)| (Some(name.trim()), word));
            let value = value(word.trim())?;
            let before = match name {
                Some(name) => given.single.insert(name.to_owned(), value),
                None => given.all.replace(value),
            };
            if before.is_some() {
                let whose = name.map_or_else(|| "all registers".to_owned(), |name| format!("'{name}'"));
                return Err(format!("--{option} gives {whose} two values: leave one of them out"));
            }
        }
        Ok(given)
    }

    /// `8,f=9`
    pub(super) fn text(&self, word: impl Fn(&T) -> String) -> String {
        let all = self.all.as_ref().map(&word);
        let single = self.single.iter().map(|(name, value)| format!("{name}={}", word(value)));
        all.into_iter().chain(single).collect::<Vec<_>>().join(",")
    }
}

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

/// A length in millionths of a BLU, or another number with up to six decimals.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Millionths(pub u64);

impl Millionths {
    /// The length of a text in BLU with up to six decimals.
    pub(super) fn parse(text: &str) -> Result<Millionths, String> {
        let number = text.trim().parse().ok().filter(|number: &f64| *number > 0.0);
        number
            .and_then(Millionths::nearest)
            .filter(|length| length.0 > 0)
            .ok_or_else(|| format!("invalid length '{text}': give BLU from 0.000001 to 1e9, such as 80 or 102.4"))
    }

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
        StepTiming::USUAL
    }
}

impl StepTiming {
    /// Where nothing is given.
    pub(super) const USUAL: StepTiming = StepTiming { length: 2, space: 2, setup: 4, hold: 4 };

    /// The times of `length=2,space=2,setup=4,hold=4`, or of some of them.
    pub(super) fn parse(text: &str) -> Result<StepTiming, String> {
        let remedy = "give clocks such as length=2,space=2,setup=4,hold=4";
        let (mut timing, mut named) = (StepTiming::default(), Vec::new());
        for part in text.split(',') {
            let (name, clocks) = part.split_once('=').ok_or_else(|| format!("invalid time '{part}': {remedy}"))?;
            let least = u64::from(matches!(name.trim(), "length" | "space"));
            let number = clocks.trim().parse().ok().filter(|clocks| (least..=1 << 20).contains(clocks));
            let number = number
                .ok_or_else(|| format!("invalid time '{clocks}': it must be from {least} to {}: {remedy}", 1 << 20))?;
            if named.contains(&name.trim()) {
                return Err(format!("'{}' is given two times: leave one of them out", name.trim()));
            }
            named.push(name.trim());
            match name.trim() {
                "length" => timing.length = number,
                "space" => timing.space = number,
                "setup" => timing.setup = number,
                "hold" => timing.hold = number,
                name => return Err(format!("there is no time '{name}': {remedy}")),
            }
        }
        Ok(timing)
    }
}

impl fmt::Display for StepTiming {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "length={},space={},setup={},hold={}", self.length, self.space, self.setup, self.hold)
    }
}

/// A speed, an acceleration or a jerk.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Quantity {
    /// In the units of the registers: 2^-n pulses a tick, or that much more each tick.
    Word(u64),
    /// In a unit of length and of time.
    Physical {
        /// How many of the unit.
        number: f64,
        /// The unit as it is written.
        unit: &'static str,
        /// The unit in mm, and seconds to the power of the quantity.
        mm: f64,
    },
}

/// Units of a speed, an acceleration and a jerk, in mm and seconds.
const UNITS: [&[(&str, f64)]; 3] = [
    &[("mm/min", 1.0 / 60.0), ("in/min", 25.4 / 60.0), ("mm/s", 1.0), ("m/min", 1000.0 / 60.0)],
    &[("mm/s2", 1.0), ("mm/s^2", 1.0), ("in/s2", 25.4), ("m/s2", 1000.0)],
    &[("mm/s3", 1.0), ("mm/s^3", 1.0), ("in/s3", 25.4), ("m/s3", 1000.0)],
];

impl Quantity {
    /// What a text says, of a quantity with this power of time: 1 a speed, 2 an acceleration, 3 a jerk.
    ///
    /// # Errors
    /// A sentence that says what is wrong with it.
    pub fn parse(text: &str, power: usize) -> Result<Quantity, String> {
        let text = text.trim();
        let units = UNITS[(power - 1).min(2)];
        let example = ["144 or 2400mm/min", "16 or 500mm/s2", "4 or 20000mm/s3"][(power - 1).min(2)];
        let wrong = || {
            let units = units.iter().map(|(unit, _)| *unit).collect::<Vec<_>>().join(", ");
            format!(
                "'{text}' is not {}: give a whole number from 1 on of the register, or one with a unit ({units}), such as \
                 {example}",
                ["a speed", "an acceleration", "a jerk"][(power - 1).min(2)]
            )
        };
        let Some((unit, mm)) = units.iter().find(|(unit, _)| text.ends_with(unit)) else {
            return text.parse().ok().filter(|word| (1..=1 << 62).contains(word)).map(Quantity::Word).ok_or_else(wrong);
        };
        let number = text.strip_suffix(unit).and_then(|number| number.trim().parse().ok());
        let number = number.filter(|number: &f64| number.is_finite() && *number > 0.0).ok_or_else(wrong)?;
        Ok(Quantity::Physical { number, unit, mm: *mm })
    }

    /// In mm and seconds; `None` in units of registers.
    #[must_use]
    pub fn mm(self) -> Option<f64> {
        match self {
            Quantity::Word(_) => None,
            Quantity::Physical { number, mm, .. } => Some(number * mm),
        }
    }
}

/// `500mm/s2`
impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Quantity::Word(word) => write!(f, "{word}"),
            Quantity::Physical { number, unit, .. } => write!(f, "{number}{unit}"),
        }
    }
}

/// Acceleration and deceleration.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Gains {
    /// Acceleration.
    pub up: Quantity,
    /// Deceleration, where it is another one.
    pub down: Option<Quantity>,
}

impl Gains {
    /// `16`, `16,8`, `500mm/s2,300mm/s2`
    pub(super) fn parse(text: &str) -> Result<Gains, String> {
        let mut parts = text.split(',');
        let up = Quantity::parse(parts.next().unwrap_or_default(), 2)?;
        let down = parts.next().map(|down| Quantity::parse(down, 2)).transpose()?;
        if parts.next().is_some() {
            return Err(format!("'{text}' is more than an acceleration and a deceleration: give one or two"));
        }
        Ok(Gains { up, down })
    }

    /// Both.
    #[must_use]
    pub fn both(self) -> [Quantity; 2] {
        [self.up, self.down.unwrap_or(self.up)]
    }
}

impl fmt::Display for Gains {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.down {
            None => write!(f, "{}", self.up),
            Some(down) => write!(f, "{},{down}", self.up),
        }
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
    /// The preset of a word.
    pub(super) fn parse(word: &str) -> Result<Preset, String> {
        match word {
            "zero" => Ok(Preset::Zero),
            "half" => Ok(Preset::Half),
            "full" => Ok(Preset::Full),
            number => number
                .parse()
                .map(Preset::Value)
                .map_err(|_| format!("invalid preset '{number}': give zero, half, full or a number from 0 on")),
        }
    }

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
