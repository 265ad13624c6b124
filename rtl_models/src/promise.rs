//! What a method promises of its path, and whether a path keeps it: the one place where a bound is judged.

use std::fmt;

use stepwave_nc::Curve;

/// Room for rounding when a path error is compared with a bound, in BLU.
const ROUNDING: f64 = 1e-9;

/// The greatest distance from a curve that a method promises, in BLU.
///
/// The methods promise it of curves whose ends lie on the ideal curve. Where program data was rounded an end may lie off
/// it, and no machine that comes to that end can be nearer: the promise is widened by that distance.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Promise {
    method: f64,
    ends: f64,
}

impl Promise {
    /// Of a method on a curve; `None` where the method promises nothing.
    #[must_use]
    pub fn of(method: Option<f64>, curve: &Curve) -> Option<Promise> {
        method.map(|method| Promise { method, ends: curve.ends_off() })
    }

    /// The greatest distance from the curve, in BLU.
    #[must_use]
    pub fn bound(self) -> f64 {
        self.method + self.ends
    }

    /// The part of it that is due to the ends of the curve, in BLU.
    #[must_use]
    pub fn ends(self) -> f64 {
        self.ends
    }

    /// A path that is this far off its curve, in BLU, keeps the promise.
    #[must_use]
    pub fn is_kept(self, error: f64) -> bool {
        error <= self.bound() + ROUNDING
    }

    /// The wider of two promises: of a move that is made of several curves.
    #[must_use]
    pub fn or_wider(self, other: Promise) -> Promise {
        if other.bound() > self.bound() { other } else { self }
    }
}

impl fmt::Display for Promise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Never less than is promised.
        let upwards = |bound: f64| (1000.0 * bound).ceil() / 1000.0;
        let (bound, method, ends) = (self.bound(), upwards(self.method), self.ends);
        if ends == 0.0 {
            return write!(f, "{method} BLU");
        }
        write!(f, "{bound:.3} BLU ({method} and the {ends:.3} that an end is off the curve)")
    }
}
