//! What ramps are loaded with: speeds, accelerations and jerks in the units of their registers, and S curves.

use stepwave_netlist::Width;

use crate::options::Quantity;

/// Least value of an acceleration, or of a jerk, that is given with a unit: rounding changes it by less than half a percent.
const LEAST_GAIN: f64 = 128.0;
/// Most bits of a phase: a speed times an override has 10 more.
pub(crate) const MOST_BITS: u32 = 54;

/// How lengths and times become pulses and ticks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Scale {
    /// Ticks a second.
    pub hz: f64,
    /// Pulses of a millimetre.
    pub per_mm: f64,
}

impl Scale {
    /// A quantity with this power of time, in 2^-n pulses and ticks, not rounded.
    #[must_use]
    pub fn exact(self, mm: f64, power: i32, n: u32) -> f64 {
        mm * self.per_mm * 2f64.powi(n.cast_signed()) / self.hz.powi(power)
    }

    /// The same as a register holds it: a word as it is, else rounded.
    #[must_use]
    pub fn word(self, quantity: Quantity, power: i32, n: u32) -> u64 {
        match quantity {
            Quantity::Word(word) => word,
            Quantity::Physical { .. } => rounded(self.exact(quantity.mm().unwrap_or(0.0), power, n)),
        }
    }

    /// The least n with which each of these quantities is 128 or more.
    #[must_use]
    pub fn least_bits(self, quantities: &[Quantity], power: i32) -> Option<u32> {
        let least = quantities.iter().filter_map(|quantity| quantity.mm()).min_by(f64::total_cmp)?;
        // One half less is rounded up.
        (1..=MOST_BITS + 1).find(|&n| self.exact(least, power, n).round() >= LEAST_GAIN).or(Some(MOST_BITS + 1))
    }
}

/// The nearest whole number; beyond all that a register holds the greatest.
#[must_use]
pub fn rounded(number: f64) -> u64 {
    // 0 for what is not a number.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let word = number.round() as u64;
    word
}

/// A speed from which every other can be started or stopped without a pulse that is waited for: v² = 2^n · gain.
#[must_use]
pub fn usual_start(gain: u64, n: u32, drive: u64) -> u64 {
    let square = u128::from(gain) << n;
    u64::try_from(square.isqrt()).unwrap_or(u64::MAX).clamp(1, drive.max(1))
}

/// A ramp along an S: 2m + h ticks.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct SRamp {
    /// Ticks in which the acceleration grows, and in which it falls.
    pub m: u64,
    /// Ticks in which it stays.
    pub h: u64,
    /// By how much it changes in a tick.
    pub j: u64,
    /// What is left of the difference of speeds: the lower of the two is that much greater.
    pub rest: u64,
}

impl SRamp {
    /// A ramp between two speeds within these limits of jerk and acceleration, both at least 1.
    #[must_use]
    pub fn between(low: u64, high: u64, jerk: u64, most: u64) -> SRamp {
        let difference = high.saturating_sub(low);
        if difference == 0 {
            return SRamp::default();
        }
        let (wide, jerk) = (u128::from(difference), u128::from(jerk));
        let root = wide.div_ceil(jerk).isqrt();
        let all = if root * root * jerk >= wide { root } else { root + 1 };
        let m = (u128::from(most) / jerk).min(all).max(1);
        let h = wide.div_ceil(jerk * m).saturating_sub(m);
        let j = wide / (m * (m + h));
        // With ticks that are rounded up even a jerk of 1 may be too much: rounded down it is not.
        let shorter = m.min(wide.isqrt());
        let (m, h, j) = if j > 0 { (m, h, j) } else { (shorter, wide / shorter - shorter, 1) };
        // None is greater than the difference.
        let [m, h, j, rest] = [m, h, j, wide - j * m * (m + h)].map(|number| u64::try_from(number).unwrap_or(u64::MAX));
        SRamp { m, h, j, rest }
    }

    /// Ticks of it.
    #[must_use]
    pub fn ticks(self) -> u64 {
        2 * self.m + self.h
    }

    /// The greatest acceleration.
    #[must_use]
    pub fn most(self) -> u64 {
        self.j * self.m
    }

    /// The sum of the speeds of its ticks, upwards from `low` and downwards to it, where `low` has the rest.
    #[must_use]
    pub fn lengths(self, low: u64, high: u64) -> [u128; 2] {
        let mean = u128::from(self.ticks()) * (u128::from(low) + u128::from(high)) / 2;
        let difference = u128::from(high - low);
        [mean.saturating_sub(difference), if self.ticks() == 0 { 0 } else { mean + difference }]
    }
}

/// A block along S curves: its greatest speed, and both ramps.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SBlock {
    /// Speed from which it starts, with what the ramp has left of the difference.
    pub start: u64,
    /// Its greatest speed.
    pub drive: u64,
    /// Speed at which it ends, likewise.
    pub stop: u64,
    /// The ramp up.
    pub up: SRamp,
    /// The ramp down.
    pub down: SRamp,
    /// The sum of the speeds of the ramp down.
    pub length: u128,
}

impl SBlock {
    /// The block of this length in 2^-n pulses, of these speeds at most and within these limits: as fast as both ramps
    /// let it be.
    #[must_use]
    pub fn new([start, drive, stop]: [u64; 3], jerk: u64, most: u64, length: u128) -> SBlock {
        let at = |drive: u64| {
            let [up, down] = [start, stop].map(|low| SRamp::between(low, drive, jerk, most));
            let [start, stop] = [start + up.rest, stop + down.rest];
            let [[up_length, _], [_, down_length]] = [up.lengths(start, drive), down.lengths(stop, drive)];
            (SBlock { start, drive, stop, up, down, length: down_length }, up_length + down_length <= length)
        };
        let (whole, fits) = at(drive);
        if fits {
            return whole;
        }
        let (mut low, mut high) = (start.max(stop), drive);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if at(middle).1 { low = middle } else { high = middle }
        }
        at(low).0
    }
}

/// Bits of an unsigned number, 1 at least.
#[must_use]
pub(crate) fn bits(value: u64) -> u32 {
    Width::needed_unsigned(value.into())
}
