//! The coarse stage of data sampling: the travel of a period in fixed point, and its widths.

use stepwave_netlist::Width;

use crate::error::ModelError;
use crate::options::{FRACTION, Millionths, STEP, SYSTEM, System, TOLERANCE};
use crate::plan::Plan;
use crate::registers::With;

/// With the coarse stage that calculates by the step factor.
pub(crate) static BY_STEP_FACTOR: With<System> = With(&SYSTEM, |system| *system == System::StepFactor);

/// The coarse stage of data sampling: all that fixes it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Sampling {
    /// How it calculates.
    pub system: System,
    /// Bits q of the fraction of coarse points.
    pub fraction: u32,
    /// Travel f of a period.
    pub step: Millionths,
    /// The same as the hardware holds it, in 2^-q BLU.
    pub word: u64,
    /// Bits n of the whole part of a magnitude.
    pub whole: u32,
    /// Greatest distance of a chord from the arc, f²/(8R), in BLU; 0 of a line.
    pub chord_error: f64,
    /// Greatest chord error that is taken.
    pub tolerance: Millionths,
    /// Frequency of the clock in Hz; `None` for the least with which the period is kept.
    pub clock_hz: Option<Millionths>,
    /// Clocks of a period T, as a ratio of whole numbers without a common divisor.
    pub clocks: [u64; 2],
}

/// The travel of a period in BLU where none is chosen.
const USUAL_STEP: u64 = 8;
/// Least bits of a fraction.
const LEAST_FRACTION: u32 = 8;
const USUAL_FRACTION: u32 = 10;
/// Most bits of a magnitude: the square root takes its square.
const MOST: u32 = 31;

impl Sampling {
    /// Clocks of a period T, in the mean.
    #[must_use]
    pub fn period_clocks(&self) -> f64 {
        self.clocks[0] as f64 / self.clocks[1] as f64
    }

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
    pub(crate) fn plan(plan: &mut Plan, greatest: f64, radius: Option<f64>) -> Result<Sampling, ModelError> {
        let model = plan.model();
        let refused = |option, value: String, reason: String| Err(ModelError::Value { model, option, value, reason });
        let fraction = plan.decide(&FRACTION, Some(USUAL_FRACTION)).unwrap_or(USUAL_FRACTION);
        if !(LEAST_FRACTION..=MOST - 1).contains(&fraction) {
            let reason = format!("a coarse point has {LEAST_FRACTION} to {} bits of fraction", MOST - 1);
            return refused(FRACTION.name, fraction.to_string(), reason);
        }
        let tolerance = plan.get(&TOLERANCE).unwrap_or(Millionths(1_000_000));
        // On an arc the direction turns by less than the angle of a period, which a step of R/2 keeps below 30 degrees.
        let most = radius.map(|radius| (8.0 * radius * tolerance.units()).sqrt().min(radius / 2.0));
        let default = most.map_or(USUAL_STEP as f64, |most| most.min(USUAL_STEP as f64));
        // Down, so that it is none too great.
        let down = |length: f64| Millionths::nearest((length * 1e3).floor() / 1e3).unwrap_or(Millionths(0));
        let step = plan.get(&STEP).unwrap_or_else(|| down(default));
        let chord_error = radius.map_or(0.0, |radius| step.units() * step.units() / (8.0 * radius));
        if let Some((radius, most)) = radius.zip(most).filter(|(_, most)| step.units() > *most) {
            let why = if chord_error > tolerance.units() {
                let off = format!("its chords would be up to {chord_error:.3} BLU off the radius {radius:.3}");
                format!("{off}, but --tolerance is {tolerance}")
            } else {
                format!("it is more than half the radius {radius:.3}")
            };
            let reason = format!("{why}: give --step {} or less, or a lower --feed", down(most));
            return refused(STEP.name, step.to_string(), reason);
        }
        let word = (u128::from(step.0) << fraction).saturating_add(500_000) / 1_000_000;
        if word == 0 {
            let least = Millionths((1_000_000_u64 >> fraction) + 1);
            let reason =
                format!("it is 0 with {fraction} bits of fraction: give --step {least} or more, or a higher --feed");
            return refused(STEP.name, step.to_string(), reason);
        }
        // What lies in front of the middle of a step, and room for how far the path may be off.
        let room = radius.map_or(greatest.max(step.units()) + 2.0, |_| greatest * 1.25 + 8.0);
        let whole = Width::needed_unsigned(whole(room));
        if whole + fraction > MOST {
            let fits = MOST.saturating_sub(whole);
            let remedy = if fits >= LEAST_FRACTION {
                format!("give --fraction {fits} or less")
            } else if radius.is_none() && step.units() > greatest {
                "give a smaller --step, or a lower --feed".to_owned()
            } else {
                "give a smaller geometry, or a greater BLU".to_owned()
            };
            return Err(ModelError::Widths(format!(
                "{model}: magnitudes of {whole} bits and a fraction of {fraction} make {} bits, but the square root takes \
                 {MOST} at most: {remedy}",
                whole + fraction
            )));
        }
        // It is below 2^31: a step beyond does not get here.
        let word = u64::try_from(word).unwrap_or(u64::MAX);
        let (system, clock_hz, clocks) = (plan.get(&SYSTEM), plan.options().clock_hz, [1, 1]);
        Ok(Sampling { system, fraction, step, word, whole, chord_error, tolerance, clock_hz, clocks })
    }
}

/// The whole number not below a length.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(crate) fn whole(length: f64) -> u128 {
    length.max(0.0).ceil() as u128
}
