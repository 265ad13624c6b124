//! Speed over the speed that the hardware has along an axis, v/v_max.

use super::{Speed, Window};

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
        let over = |window: Window| (step_clocks * window.speed(), window.step);
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
}

impl Speed {
    /// The greatest less the least, over the mean, whatever v_max is; `None` where the curve, of this length in BLU, was not
    /// run to its end.
    #[must_use]
    pub fn ripple(&self, length: Option<f64>) -> Option<f64> {
        RelativeSpeed::new(self, 1.0, length).ripple()
    }
}
