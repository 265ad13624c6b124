//! The plan of data sampling: the way of a period in fixed point, and the widths of the coarse stage.

use stepwave_kernel::Width;

use crate::choices::{Choice, Choices, Millionths, System};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::registers::Registers;

/// The coarse stage of data sampling: all that fixes it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sampling {
    /// How it calculates.
    pub system: System,
    /// Bits q of the fraction of coarse points.
    pub fraction: u32,
    /// Way f of a period.
    pub step: Millionths,
    /// The same as the hardware holds it, in 2^-q BLU.
    pub word: u64,
    /// Bits n of the whole part of a magnitude.
    pub whole: u32,
    /// Greatest distance of a chord from the arc, f²/(8R), in BLU; 0 of a line.
    pub chord_error: f64,
    /// Greatest chord error that is taken.
    pub tolerance: Millionths,
}

/// The way of a period in BLU where none is chosen.
const STEP: u64 = 8;
/// Bits of the fraction where none are chosen.
const FRACTION: u32 = 10;
/// Least bits of a fraction.
const LEAST_FRACTION: u32 = 8;
/// Most bits of a magnitude: the square root takes its square.
const MOST: u32 = 31;

impl Sampling {
    /// Bits of the word of f.
    pub(crate) fn word_bits(&self) -> u32 {
        Width::needed_unsigned(self.word.into())
    }

    /// Bits M of a magnitude with its fraction.
    pub(crate) fn magnitude(&self) -> u32 {
        self.whole + self.fraction
    }

    /// Fixes the coarse stage for a curve of this length, and of this radius if it is an arc. Magnitudes are up to
    /// `greatest` BLU and what an arc needs beyond its radius.
    pub(crate) fn plan(
        model: &'static str,
        choices: &Choices,
        greatest: f64,
        radius: Option<f64>,
    ) -> Result<Sampling, ModelError> {
        let refused =
            |choice: Choice, value: String, reason: String| Err(ModelError::Value { model, choice, value, reason });
        let fraction = choices.fraction.unwrap_or(FRACTION);
        if !(LEAST_FRACTION..=MOST - 1).contains(&fraction) {
            let reason = format!("a coarse point has {LEAST_FRACTION} to {} bits of fraction", MOST - 1);
            return refused(Choice::Fraction, fraction.to_string(), reason);
        }
        let tolerance = choices.tolerance.unwrap_or(Millionths(1_000_000));
        // On an arc the direction turns by less than the angle of a period, which a step of R/2 keeps below 30 degrees.
        let most = radius.map(|radius| (8.0 * radius * tolerance.units()).sqrt().min(radius / 2.0));
        let default = most.map_or(STEP as f64, |most| most.min(STEP as f64));
        // Down, so that it is none too great.
        let down = |length: f64| Millionths::nearest((length * 1e3).floor() / 1e3).unwrap_or(Millionths(0));
        let step = choices.step.unwrap_or_else(|| down(default));
        if let Some((radius, most)) = radius.zip(most).filter(|(_, most)| step.units() > *most) {
            let chord = step.units() * step.units() / (8.0 * radius);
            let why = if chord > tolerance.units() {
                format!(
                    "its chords would be up to {chord:.3} BLU off the radius {radius:.3}, but --tolerance is {tolerance}"
                )
            } else {
                format!("it is more than half the radius {radius:.3}")
            };
            let reason = format!("{why}: give --step {} or less, or a lower --feed", down(most));
            return refused(Choice::Step, step.to_string(), reason);
        }
        let word = (u128::from(step.0) << fraction).saturating_add(500_000) / 1_000_000;
        if word == 0 {
            let least = Millionths((1_000_000_u64 >> fraction) + 1);
            let reason = format!("it is 0 with {fraction} bits of fraction: give --step {least} or more");
            return refused(Choice::Step, step.to_string(), reason);
        }
        // What lies in front of the middle of a step, and room for the way that the path may be off.
        let room = radius.map_or(greatest.max(step.units()) + 2.0, |_| greatest * 1.25 + 8.0);
        let whole = Width::needed_unsigned(whole(room));
        if whole + fraction > MOST {
            let fits = MOST.saturating_sub(whole);
            let way_out = if fits >= LEAST_FRACTION {
                format!("give --fraction {fits} or less")
            } else {
                "give a smaller geometry, or a greater BLU".to_owned()
            };
            return Err(ModelError::Widths(format!(
                "{model}: magnitudes of {whole} bits and a fraction of {fraction} make {} bits, but the square root takes \
                 {MOST} at most: {way_out}",
                whole + fraction
            )));
        }
        let chord_error = radius.map_or(0.0, |radius| step.units() * step.units() / (8.0 * radius));
        // It is below 2^31: a step beyond does not get here.
        let word = u64::try_from(word).unwrap_or(u64::MAX);
        Ok(Sampling { system: choices.system.unwrap_or_default(), fraction, step, word, whole, chord_error, tolerance })
    }

    /// Hardware of a coarse stage and a fine stage of two axes, whose integrators hold the greatest way of a period:
    /// f, rounded to whole pulses, and `more` BLU by which the last way may be longer.
    pub(crate) fn hardware(
        self,
        registers: &mut Registers<'_>,
        choices: &Choices,
        more: f64,
        positions: impl IntoIterator<Item = Vec<i64>>,
    ) -> Result<Hardware, ModelError> {
        let n = choices.width.map_or_else(|| Width::needed_unsigned(whole(self.step.units() + 1.0 + more)), Width::get);
        registers.shown("cx").shown("cy");
        for axis in ["x", "y"] {
            registers.register(format!("jv{axis}"), n).register(format!("jr{axis}"), n);
        }
        registers.positions(positions);
        let hardware = registers.integrators(2, crate::choices::EndPoint::Iterations, 1)?;
        // Clocks of all units of a period, and of those in front of the first; and periods without a pulse.
        let coarse = u64::from(self.magnitude()) * 32 + 64;
        let periods = u64::try_from(whole((4.0 / self.step.units()).min(1e9))).unwrap_or(u64::MAX >> 32) + 4;
        let burst = hardware.stall_clocks;
        let stall_clocks = coarse.saturating_add(burst).saturating_mul(periods);
        Ok(Hardware { sampling: Some(self), stall_clocks, ..hardware })
    }
}

/// The whole number not below a length.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn whole(length: f64) -> u128 {
    length.max(0.0).ceil() as u128
}
