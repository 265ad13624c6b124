//! What a knot vector must be.

use std::fmt;

use super::{NURBS_MOST, NURBS_UNIT};
use crate::GeometryError;

/// What is wrong with a knot vector; places count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KnotFault {
    /// It has too few knots or too many.
    Count {
        /// Knots given.
        given: usize,
        /// Knots that are needed.
        needed: usize,
    },
    /// A knot is less than the one before it.
    Decreases {
        /// Place of the lesser one.
        place: usize,
    },
    /// The first or last degree+1 knots are not equal.
    Ends {
        /// How many of them there have to be.
        equal: usize,
    },
    /// A knot between the ends is repeated too often.
    Repeated {
        /// Place of the first one.
        place: usize,
        /// How often it may be given.
        most: usize,
    },
    /// The last is too far from the first.
    Far,
}

impl fmt::Display for KnotFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            KnotFault::Count { given, needed } => {
                write!(f, "{given} knots were given, but points + degree + 1 = {needed} are needed: give as many")
            }
            KnotFault::Decreases { place } => {
                write!(f, "knot {place} is less than the one before it: give knots that do not decrease")
            }
            KnotFault::Ends { equal } => write!(
                f,
                "the first {equal} knots must be equal, and the last {equal} too, so that the curve leads from its first \
                 control point to its last: repeat them"
            ),
            KnotFault::Repeated { place, most } => {
                write!(
                    f,
                    "knot {place} is repeated more than {most} times, where the curve would break: give it less often"
                )
            }
            KnotFault::Far => write!(f, "the knots span more than {NURBS_MOST}: scale them down"),
        }
    }
}

/// Checks the knots of a curve of this degree and number of points, in [`NURBS_UNIT`]s.
pub(super) fn knots(degree: usize, points: usize, knots: &[i64]) -> Result<(), GeometryError> {
    let fault = |fault| Err(GeometryError::Knots { fault });
    let needed = points + degree + 1;
    if knots.len() != needed {
        return fault(KnotFault::Count { given: knots.len(), needed });
    }
    if let Some(index) = knots.windows(2).position(|pair| pair[1] < pair[0]) {
        return fault(KnotFault::Decreases { place: index + 2 });
    }
    let (first, last) = (knots[0], knots[needed - 1]);
    if last.checked_sub(first).is_none_or(|span| span > NURBS_MOST * NURBS_UNIT) {
        return fault(KnotFault::Far);
    }
    let (low, high) = (&knots[..=degree], &knots[needed - degree - 1..]);
    if low.iter().any(|&knot| knot != first) || high.iter().any(|&knot| knot != last) {
        return fault(KnotFault::Ends { equal: degree + 1 });
    }
    // Also where all knots are one.
    let inner = &knots[1..needed - 1];
    match inner.windows(degree + 1).position(|some| some[0] == some[degree]) {
        Some(index) => fault(KnotFault::Repeated { place: index + 2, most: degree }),
        None => Ok(()),
    }
}
