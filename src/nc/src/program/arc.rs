//! The centre of an arc, from the words I, J and K or from its radius R.

use super::error::ProgramErrorKind;
use crate::Direction;

/// How far two radii of an arc may lie apart, in BLU: the largest of 2 BLU, 0.005 mm (programs are written to 0.001 mm
/// or 0.0001 inch, however fine the BLU is) and 0.1 % of the radius, the last at most 0.5 mm; but never more than half
/// of the radius.
pub(super) fn tolerance(radius: f64, blu: f64) -> f64 {
    (radius / 1000.0).min(0.5 / blu).max(0.005 / blu).max(2.0).min(radius / 2.0)
}

/// Checks that an arc about a centre has a radius, and that its end is on its circle.
pub(super) fn check(from: [f64; 2], to: [f64; 2], center: [f64; 2], blu: f64) -> Result<(), ProgramErrorKind> {
    let [start, end] = [from, to].map(|point| f64::hypot(point[0] - center[0], point[1] - center[1]));
    if start == 0.0 {
        return Err(ProgramErrorKind::ZeroRadius);
    }
    let tolerance = tolerance(start, blu);
    if (end - start).abs() > tolerance {
        return Err(ProgramErrorKind::EndOffCircle { start, end, tolerance });
    }
    Ok(())
}

/// The centre of an arc of a radius: of at most half a turn where the radius is positive, of more where it is negative.
/// A radius that misses half of the chord by no more than the tolerance makes half a turn about the chord's middle.
///
/// The ends differ, and the radius is not 0.
pub(super) fn center(
    from: [f64; 2],
    to: [f64; 2],
    radius: f64,
    direction: Direction,
    blu: f64,
) -> Result<[f64; 2], ProgramErrorKind> {
    let chord = [to[0] - from[0], to[1] - from[1]];
    let half = f64::hypot(chord[0], chord[1]) / 2.0;
    let size = radius.abs();
    let tolerance = tolerance(size, blu);
    if half - size > tolerance {
        return Err(ProgramErrorKind::RadiusTooSmall { radius: size, half, tolerance });
    }
    // Left of the chord, in parts of the half chord; a short arc against the clock has its centre there.
    let height = ((size - half) * (size + half)).max(0.0).sqrt() / half;
    let left = (direction == Direction::CounterClockwise) == (radius > 0.0);
    let height = if left { height } else { -height };
    Ok([from[0] + (chord[0] - height * chord[1]) / 2.0, from[1] + (chord[1] + height * chord[0]) / 2.0])
}
