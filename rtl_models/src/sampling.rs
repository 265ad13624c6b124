//! The plan of data sampling: the way of a period in fixed point, and the widths of the coarse stage.

use stepwave_netlist::Width;

use crate::error::ModelError;
use crate::options::{END_POINT, EndPoint, FRACTION, Millionths, STEP, SYSTEM, System, TOLERANCE};
use crate::parts::{JR, JV};
use crate::plan::Plan;

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
    /// Frequency of the clock in Hz; `None` for the least with which the period is kept.
    pub clock_hz: Option<Millionths>,
    /// Clocks of a period T, as a ratio of whole numbers without a common divisor.
    pub clocks: [u64; 2],
}

/// Most bits of the clocks of a period, so that the divider of the clock adds within 64 bits.
const MOST_CLOCK_BITS: u32 = 60;

/// The way of a period in BLU where none is chosen.
const USUAL_STEP: u64 = 8;
/// Least bits of a fraction.
const LEAST_FRACTION: u32 = 8;
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
    pub(crate) fn plan(plan: &Plan, greatest: f64, radius: Option<f64>) -> Result<Sampling, ModelError> {
        let model = plan.model();
        let refused = |option, value: String, reason: String| Err(ModelError::Value { model, option, value, reason });
        let fraction = plan.get(&FRACTION);
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
            return refused(STEP.name, step.to_string(), reason);
        }
        let word = (u128::from(step.0) << fraction).saturating_add(500_000) / 1_000_000;
        if word == 0 {
            let least = Millionths((1_000_000_u64 >> fraction) + 1);
            let reason =
                format!("it is 0 with {fraction} bits of fraction: give --step {least} or more, or a higher --feed");
            return refused(STEP.name, step.to_string(), reason);
        }
        // What lies in front of the middle of a step, and room for the way that the path may be off.
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
        let chord_error = radius.map_or(0.0, |radius| step.units() * step.units() / (8.0 * radius));
        // It is below 2^31: a step beyond does not get here.
        let word = u64::try_from(word).unwrap_or(u64::MAX);
        let (system, clock_hz, clocks) = (plan.get(&SYSTEM), plan.options().clock_hz, [1, 1]);
        Ok(Sampling { system, fraction, step, word, whole, chord_error, tolerance, clock_hz, clocks })
    }

    /// Clocks of a period T at the clock that was chosen, or else the least that hold `least` clocks.
    ///
    /// # Errors
    /// The clock leaves fewer clocks in a period than `least`, which `why` needs.
    fn period(&self, model: &'static str, least: u64, why: &str) -> Result<[u64; 2], ModelError> {
        let [seconds, of] = self.system.period_ratio().map(u128::from);
        let Some(hz) = self.clock_hz else { return Ok([least, 1]) };
        let (clocks, of) = (u128::from(hz.0) * seconds, of * 1_000_000);
        let period = self.system.period() * 1e3;
        if clocks < u128::from(least) * of {
            let enough = (u128::from(least) * of).div_ceil(seconds * 1_000_000);
            return Err(ModelError::Widths(format!(
                "{model}: a clock of {hz} Hz has {} clocks in the period of {period} ms, but {why} {least}: give --clock-hz \
                 {enough} or more",
                clocks / of
            )));
        }
        let common = common_divisor(clocks, of);
        let ratio = [clocks / common, of / common].map(u64::try_from);
        match ratio {
            [Ok(clocks), Ok(of)] if clocks >> MOST_CLOCK_BITS == 0 => Ok([clocks, of]),
            _ => Err(ModelError::Widths(format!(
                "{model}: a clock of {hz} Hz is more than the divider of the clock can count in the period of {period} ms: \
                 give a lower --clock-hz, or one in whole Hz"
            ))),
        }
    }

    /// Plans hardware of a coarse stage and a fine stage of two axes, whose integrators hold the greatest way of a period:
    /// f, rounded to whole pulses, and `more` BLU by which the last way may be longer. The coarse stage takes `coarse`
    /// clocks a period.
    pub(crate) fn hardware(
        self,
        plan: &mut Plan,
        [more, coarse]: [f64; 2],
        positions: impl IntoIterator<Item = impl IntoIterator<Item = i64>>,
    ) -> Result<(), ModelError> {
        let n = plan.bits_or(Width::needed_unsigned(whole(self.step.units() + 1.0 + more)));
        plan.set_each(JV, n).set_each(JR, n).positions(positions);
        plan.fix(&END_POINT, EndPoint::Iterations);
        plan.integrators(1)?;
        let coarse = u64::try_from(whole(coarse)).unwrap_or(u64::MAX);
        // Additions at least two clocks apart leave one for the integrands of the next period.
        let burst = 1_u64.checked_shl(plan.bits(JR.of(0)) + 1).unwrap_or(u64::MAX);
        let (least, why) = if burst > coarse {
            (burst, "the additions of the fine stage take")
        } else {
            (coarse, "the coarse calculation takes")
        };
        let clocks = self.period(plan.model(), least, why)?;
        // The calculation once a block; and periods without a pulse.
        let periods = u64::try_from(whole((4.0 / self.step.units()).min(1e9))).unwrap_or(u64::MAX >> 32) + 4;
        let period = (clocks[0] / clocks[1]).saturating_add(2);
        plan.stall_clocks = coarse.saturating_mul(2).saturating_add(period.saturating_mul(periods));
        plan.fix(&STEP, Some(self.step));
        plan.fix(&TOLERANCE, Some(self.tolerance));
        plan.sampling = Some(Sampling { clocks, ..self });
        Ok(())
    }
}

fn common_divisor(a: u128, b: u128) -> u128 {
    if b == 0 { a.max(1) } else { common_divisor(b, a % b) }
}

/// The whole number not below a length.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn whole(length: f64) -> u128 {
    length.max(0.0).ceil() as u128
}
