//! Acceleration after the interpolator of the machines that run programs: a filter of the pulses of each axis, planned.

use stepwave_netlist::Width;

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::options::{ACCEL, Gains, JERK, Millionths, Options, PERIOD, Quantity, RAMP, RampAt, SMOOTH, Smooth, Taken};
use crate::plan::Plan;

/// The filter after the interpolator of a machine.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct After {
    /// Clocks of a sampling period.
    pub period: u64,
    /// What the displacements of periods go through.
    pub smooth: Smooth,
}

fn is_after(options: &Options) -> bool {
    options.value(&RAMP) == RampAt::After
}

const FOR_AFTER: &str = "this is of an acceleration after the interpolator: give --ramp after too, or leave it out";
const FOR_BEFORE: &str = "with --ramp after the filter accelerates, from 0 to f BLU a period in K periods of sum=K: choose --smooth and \
                          --period by that, and leave this out, or leave out --ramp after";

/// Acceleration and jerk in front of the pulse source.
pub(super) static PATH_ACCEL: Taken<Option<Gains>> = ACCEL.counts(|options| !is_after(options), FOR_BEFORE);
pub(super) static PATH_JERK: Taken<Option<Quantity>> = JERK.counts(|options| !is_after(options), FOR_BEFORE);
/// Filter and period after the interpolator.
pub(super) static OUTPUT_SMOOTH: Taken<Smooth> = SMOOTH.counts(is_after, FOR_AFTER);
pub(super) static OUTPUT_PERIOD: Taken<Option<u64>> = PERIOD.counts(is_after, FOR_AFTER);

/// Plans the filter of a machine, if it has one.
pub(super) fn plan(plan: &mut Plan) -> Result<(), ModelError> {
    if plan.get(&RAMP) == RampAt::Before {
        return Ok(());
    }
    let options = plan.options().clone();
    let hz = options.clock_hz.map_or(1e6, Millionths::units);
    let period = plan.get(&PERIOD).unwrap_or_else(|| usual(hz));
    let after = After { period, smooth: plan.get(&SMOOTH) };
    if 1 << after.bits() > period {
        let reason = format!(
            "an axis may have {} pulses in as many clocks, whose fine line takes {} additions: give {} or {}",
            after.most(),
            1_u64 << after.bits(),
            period + 1,
            period - 1
        );
        let (model, option, value) = (plan.model(), PERIOD.name, period.to_string());
        return Err(ModelError::Value { model, option, value, reason });
    }
    plan.fix(&PERIOD, Some(period));
    plan.fix(&SMOOTH, after.smooth);
    plan.stall_clocks = plan.stall_clocks.saturating_add(after.longest());
    Ok(())
}

/// The clocks of 1 ms, for which there is a fine line.
fn usual(hz: f64) -> u64 {
    // Beyond all that can be simulated the cast saturates.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let clocks = ((hz / 1e3).round() as u64).clamp(2, 1 << 30);
    clocks + u64::from((clocks + 1).is_power_of_two())
}

impl After {
    /// That of a machine; `None` of one that has its acceleration in front of the interpolator, or none.
    #[must_use]
    pub fn of(hardware: &Hardware) -> Option<After> {
        let period = hardware.get(&PERIOD).filter(|_| hardware.get(&RAMP) == RampAt::After)?;
        Some(After { period, smooth: hardware.get(&SMOOTH) })
    }

    /// The most pulses of an axis in a period: one every second clock.
    #[must_use]
    pub fn most(&self) -> u64 {
        self.period.div_ceil(2)
    }

    /// n: a period has 2^n additions of the fine line, and fewer pulses.
    #[must_use]
    pub fn bits(&self) -> u32 {
        Width::needed_unsigned(self.most().into())
    }

    /// Periods after which all of a displacement has come out, whatever was before: K of a moving sum. An exponential loses half of
    /// what is inside in 2^s periods, and from 2^s on a pulse in each.
    #[must_use]
    pub fn periods(&self) -> u64 {
        match self.smooth {
            Smooth::Sum(k) => k,
            Smooth::Exponential(s) => (u64::from(Width::needed_unsigned(self.most().into())) + 2) << s,
        }
    }

    /// The most clocks from a pulse of the interpolator until all that it does has come out.
    #[must_use]
    pub fn longest(&self) -> u64 {
        // That in which the pulse is counted, and that of the fine line.
        self.period.saturating_mul(self.periods() + 2)
    }

    /// Clocks from the end of a displacement of f BLU a period until what is left of its acceleration is less than a tenth of
    /// a BLU.
    #[must_use]
    pub fn settling(&self, f: f64) -> u64 {
        let periods = match self.smooth {
            Smooth::Sum(k) => k,
            Smooth::Exponential(s) => {
                let scale = 2f64.powi(i32::try_from(s).unwrap_or(0));
                // At most those of a displacement of 2^30 BLU.
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let periods = (scale * (10.0 * f * scale + 1.0).ln()).ceil() as u64;
                periods.min(self.periods())
            }
        };
        self.period.saturating_mul(periods + 2)
    }

    /// The radius that a circle of radius `radius` loses with f BLU a period: (k²-1)·f²/(24·R) of a moving sum,
    /// (4^s-2^s)·f²/(2·R) of an exponential, in BLU.
    #[must_use]
    pub fn radius_loss(&self, f: f64, radius: f64) -> f64 {
        let part = match self.smooth {
            Smooth::Sum(k) => ((k * k) as f64 - 1.0) / 24.0,
            Smooth::Exponential(s) => {
                let two = 2f64.powi(i32::try_from(s).unwrap_or(0));
                (two * two - two) / 2.0
            }
        };
        part * f * f / radius
    }
}
