//! Corners of a machine that accelerates after its interpolator: which blocks wait until the filters are empty.
//!
//! After G61, a dwell, a stop and at the end of a program a block does. After G64 the next one enters at once, and the corner is
//! rounded; after G64 P where it comes as near to the corner as P says.

use stepwave_models::options::Smooth;
use stepwave_models::program::After;
use stepwave_nc::{Cause, Coordinates, Curve, PathControl, PulseBlock, ToolMove};

use super::feed::{Pace, Paced};

/// Places at which the way round a corner is looked at.
const PLACES: u32 = 256;

/// What was before the next part of a block.
pub(super) struct Corners {
    after: After,
    /// Seconds of a period.
    period: f64,
    /// The block before, where it ends in motion: how its end is passed, its direction and its speed in BLU/s.
    before: Option<(PathControl, Coordinates, f64)>,
    /// The move whose parts are being taken, by its place in the program and on the contour.
    of: Option<ToolMove>,
}

impl Corners {
    pub(super) fn new(after: After, pace: Pace) -> Corners {
        Corners { after, period: after.period as f64 / pace.clock_hz, before: None, of: None }
    }

    /// The machine stops here.
    pub(super) fn stop(&mut self) {
        (self.before, self.of) = (None, None);
    }

    /// Whether the next part, of this block, begins only after the filters are empty.
    pub(super) fn settles(&mut self, block: &PulseBlock, part: &Paced) -> bool {
        let of = &block.of;
        let hz = part.source.map_or(0.0, |(_, hz)| hz);
        let speed = part.block.length * hz / part.block.steps;
        let [start, end] = of.directions().unwrap_or([[0.0; 9]; 2]);
        // A free curve that is not cut is run evenly in its parameter.
        let curve = of.segment.bezier().filter(|_| matches!(block.curve, Curve::Spline(_)));
        let [entry, exit] = curve.map_or([1.0; 2], |curve| curve.ends_to_mean()).map(|part| part * speed);
        let before = self.before.replace((of.path, end, exit));
        if self.of.replace(*of) == Some(*of) {
            return false;
        }
        let Some((path, direction, was)) = before else { return true };
        // What compensation puts in belongs to the block before it.
        match if of.cause == Cause::Inserted { of.path } else { path } {
            PathControl::Exact => true,
            PathControl::Continuous => false,
            PathControl::Within(off) => {
                let along = |direction: Coordinates, speed: f64| direction.map(|part| part * speed * self.period);
                rounding(self.after.smooth, along(direction, was), along(start, entry)) > off
            }
        }
    }
}

/// How far the output passes a corner at, in BLU, with these displacements of a period before and after it.
///
/// A moving sum of k is the mean of the last k periods, an exponential that of all before, whose weights are less by 1 - 2^-s
/// from period to period.
fn rounding(smooth: Smooth, before: Coordinates, after: Coordinates) -> f64 {
    let apart = |[gone, left]: [f64; 2]| {
        let offsets = before.iter().zip(after).map(|(before, after)| after * gone - before * left);
        offsets.map(|offset| offset * offset).sum::<f64>().sqrt()
    };
    // What has come out of the motion after the corner, and what has not come out of that before it, in periods.
    let at = |place: u32| match smooth {
        Smooth::Sum(k) => {
            let (all, passed) = (k as f64, k as f64 * f64::from(place) / f64::from(PLACES));
            [passed * passed / (2.0 * all), (all - passed).powi(2) / (2.0 * all)]
        }
        Smooth::Exponential(s) => {
            let scale = 2f64.powi(i32::try_from(s).unwrap_or(0));
            let passed = 4.0 * scale * f64::from(place) / f64::from(PLACES);
            let left = (-passed / scale).exp();
            [passed - scale * (1.0 - left), scale * left]
        }
    };
    (0..=PLACES).map(|place| apart(at(place))).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(x: f64, y: f64) -> Coordinates {
        let mut all = [0.0; 9];
        (all[0], all[1]) = (x, y);
        all
    }

    /// A square corner of a moving sum of k at f a period is passed at k·f·sqrt(2)/8, a reversal at k·f/4, straight on at 0.
    #[test]
    fn corners_are_passed_at_what_the_integrals_say() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-3 * b.max(0.1);
        let of = |after| rounding(Smooth::Sum(8), along(10.0, 0.0), after);
        assert!(near(of(along(0.0, 10.0)), 80.0 * 2f64.sqrt() / 8.0), "{}", of(along(0.0, 10.0)));
        assert!(near(of(along(-10.0, 0.0)), 20.0), "{}", of(along(-10.0, 0.0)));
        assert!(near(of(along(10.0, 0.0)), 0.0), "{}", of(along(10.0, 0.0)));
        // Of an exponential the way round a square corner is [t - 1 + e^-t, -e^-t] times 2^s·f; it is nearest at t = 0.7145.
        let of = rounding(Smooth::Exponential(3), along(10.0, 0.0), along(0.0, 10.0));
        let t: f64 = (0..40_000)
            .map(|t| f64::from(t) / 1e4)
            .map(|t| f64::hypot(t - 1.0 + (-t).exp(), (-t).exp()))
            .fold(9.0, f64::min);
        assert!(near(of, 80.0 * t), "{of} {t}");
    }
}
