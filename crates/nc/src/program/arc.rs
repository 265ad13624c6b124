//! The centre of an arc, from the words I, J and K or from its radius R.

use std::f64::consts::TAU;

use super::Reading;
use super::error::ProgramErrorKind;
use crate::{Direction, Segment, SegmentShape, swept};

/// How far two radii of an arc may lie apart, in BLU: the largest of 2 BLU, 0.005 mm (programs are written to 0.001 mm
/// or 0.0001 inch, however fine the BLU is) and 0.1 % of the radius, the last at most 0.5 mm; and what `--tolerance`
/// gives beyond. But never more than half of the radius.
pub(super) fn tolerance(radius: f64, reading: &Reading) -> f64 {
    let blu = reading.blu;
    ((radius / 1000.0).min(0.5 / blu).max(0.005 / blu).max(2.0) + reading.tolerance).min(radius / 2.0)
}

/// What `--tolerance` is, and may be at most for a radius, in BLU.
fn more(radius: f64, reading: &Reading) -> [f64; 2] {
    [reading.tolerance, reading.tolerance + radius / 2.0 - tolerance(radius, reading)]
}

/// Checks that an arc about a centre has a radius, and that its end is on its circle.
pub(super) fn check(from: [f64; 2], to: [f64; 2], center: [f64; 2], reading: &Reading) -> Result<(), ProgramErrorKind> {
    let [start, end] = [from, to].map(|point| f64::hypot(point[0] - center[0], point[1] - center[1]));
    if start == 0.0 {
        return Err(ProgramErrorKind::ZeroRadius);
    }
    let tolerance = tolerance(start, reading);
    if (end - start).abs() > tolerance {
        return Err(ProgramErrorKind::EndOffCircle { start, end, tolerance, more: more(start, reading) });
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
    reading: &Reading,
) -> Result<[f64; 2], ProgramErrorKind> {
    let chord = [to[0] - from[0], to[1] - from[1]];
    let half = f64::hypot(chord[0], chord[1]) / 2.0;
    let size = radius.abs();
    let tolerance = tolerance(size, reading);
    if half - size > tolerance {
        return Err(ProgramErrorKind::RadiusTooSmall { radius: size, half, tolerance, more: more(size, reading) });
    }
    // Left of the chord, in parts of the half chord; a short arc against the clock has its centre there.
    let height = ((size - half) * (size + half)).max(0.0).sqrt() / half;
    let left = (direction == Direction::CounterClockwise) == (radius > 0.0);
    let height = if left { height } else { -height };
    Ok([from[0] + (chord[0] - height * chord[1]) / 2.0, from[1] + (chord[1] + height * chord[0]) / 2.0])
}

/// What P may belong to.
pub(super) const TURNS_OWNER: &str = "G02, G03, G04 or G64";

/// The turns of an arc as segments, each with the parts of the whole path at which it starts and ends: full circles, and the
/// arc itself after them. The third axis moves evenly over all. All but an arc is one segment.
pub(super) fn turns(segment: Segment, turns: u64) -> impl Iterator<Item = (Segment, [f64; 2])> {
    let (angle, plane) = match segment.shape {
        SegmentShape::Arc { plane, center, direction } => (swept(&segment, plane, center, direction), plane),
        SegmentShape::Line | SegmentShape::Bezier(_) => (TAU, crate::Plane::Xy),
    };
    let [u, v, low] = plane.of(segment.from);
    let high = plane.of(segment.to)[2];
    // A program says at most 10,000 turns.
    let full = turns.saturating_sub(1);
    let whole = full as f64 * TAU + angle;
    let part = move |turn: u64| turn as f64 * TAU / whole;
    let after = move |turn: u64| plane.point([u, v, low + (high - low) * part(turn)]);
    let circle = move |turn: u64| {
        let circle = Segment { from: after(turn), to: after(turn + 1), shape: segment.shape };
        (circle, [part(turn), part(turn + 1)])
    };
    let last = Segment { from: if full == 0 { segment.from } else { after(full) }, ..segment };
    (0..full).map(circle).chain([(last, [part(full), 1.0])])
}
