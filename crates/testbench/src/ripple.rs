//! How evenly the tool moves.

/// Pulses over which a speed is measured.
const WINDOW: u64 = 32;

/// How evenly the tool moves: its speed over 32 pulses each, from the first place to the last and the clocks between.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ripple {
    pulses: u64,
    from: [i64; 3],
    clock: u64,
    windows: u64,
    least: f64,
    greatest: f64,
    sum: f64,
}

impl Ripple {
    pub(super) fn new(from: [i64; 3], clock: u64) -> Ripple {
        Ripple { pulses: 0, from, clock, windows: 0, least: f64::INFINITY, greatest: 0.0, sum: 0.0 }
    }

    pub(super) fn pulses(&mut self, count: u64, position: [i64; 3], clock: u64) {
        self.pulses += count;
        if self.pulses < WINDOW {
            return;
        }
        let square: f64 = (0..3).map(|axis| ((position[axis] - self.from[axis]) as f64).powi(2)).sum();
        let speed = square.sqrt() / (clock - self.clock).max(1) as f64;
        self.windows += 1;
        (self.least, self.greatest) = (self.least.min(speed), self.greatest.max(speed));
        self.sum += speed;
        (self.pulses, self.from, self.clock) = (0, position, clock);
    }

    /// The greatest less the least speed, over the mean; `None` of less than two times 32 pulses.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        (self.windows >= 2).then(|| (self.greatest - self.least) / (self.sum / self.windows as f64))
    }
}
