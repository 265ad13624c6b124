//! Speed over the speed that the hardware has along an axis, v/v_max.

use serde_json::{Value, json};

use crate::testbench::{Speed, SpeedWindow};

/// Speeds of a run, each over v_max: one BLU in each step that nothing delays.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RelativeSpeed {
    /// The least over 32 steps, and the last of them.
    pub least: (f64, u64),
    /// Length of the curve over the time from the first row of the step table to the last; `None` where the curve was not
    /// run to its end.
    pub mean: Option<f64>,
    /// The greatest over 32 steps, and the last of them.
    pub greatest: (f64, u64),
}

impl RelativeSpeed {
    /// Of hardware whose steps take so long, in clocks, and of a curve of this length in BLU that was run.
    #[must_use]
    pub fn new(speed: &Speed, step_clocks: f64, length: Option<f64>) -> RelativeSpeed {
        let over = |window: SpeedWindow| (step_clocks * window.speed(), window.step);
        RelativeSpeed {
            least: over(speed.least),
            mean: length.map(|length| step_clocks * length / speed.clocks as f64),
            greatest: over(speed.greatest),
        }
    }

    /// The greatest less the least, over the mean.
    #[must_use]
    pub fn ripple(&self) -> Option<f64> {
        let mean = self.mean.filter(|&mean| mean > 0.0)?;
        Some((self.greatest.0 - self.least.0) / mean)
    }

    /// For a summary: `0.7194 (step 152) to 0.7289 (step 32), mean 0.7263, ripple 1.30 %`.
    pub(super) fn words(&self) -> String {
        let [least, greatest] = [self.least, self.greatest].map(|(speed, step)| format!("{speed:.4} (step {step})"));
        let mean = self.mean.map(|mean| format!(", mean {mean:.4}")).unwrap_or_default();
        let ripple = self.ripple().map(|ripple| format!(", ripple {:.2} %", ripple * 100.0)).unwrap_or_default();
        format!("{least} to {greatest}{mean}{ripple}")
    }

    /// Adds its numbers to an object of the JSON report; without one they are null.
    pub(super) fn put(of: Option<RelativeSpeed>, report: &mut Value) {
        let end = |(speed, step): (f64, u64)| json!({ "value": speed, "step": step });
        report["least"] = json!(of.map(|of| end(of.least)));
        report["mean"] = json!(of.and_then(|of| of.mean));
        report["greatest"] = json!(of.map(|of| end(of.greatest)));
    }
}

/// The greatest less the least speed, over the mean, whatever v_max is; `None` where the curve, of this length in BLU, was not
/// run to its end.
pub(super) fn ripple(speed: Option<&Speed>, length: Option<f64>) -> Option<f64> {
    RelativeSpeed::new(speed?, 1.0, length).ripple()
}
