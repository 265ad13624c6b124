//! How far a place of the tool lies off a contour in real numbers.

use stepwave_nc::{Cause, Point, Segment, Side, ToolMove, Way};

/// The distance of a place from the infinite line or the whole circle of a segment, in BLU: of an arc in its plane.
#[must_use]
pub(super) fn off_segment(segment: &Segment, at: Point) -> f64 {
    match segment.way {
        Way::Line => off_line(segment.from, segment.to, at),
        Way::Arc { plane, center, .. } => {
            let [start, place] = [segment.from, at].map(|point| {
                let [u, v, _] = plane.of(point);
                f64::hypot(u - center[0], v - center[1])
            });
            (place - start).abs()
        }
    }
}

/// The distance from a line through two points, or from the point that both are.
fn off_line(from: Point, to: Point, at: Point) -> f64 {
    let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
    let gone = [0, 1, 2].map(|axis| at[axis] - from[axis]);
    let square: f64 = way.iter().map(|c| c * c).sum();
    let along = way.iter().zip(gone).map(|(a, b)| a * b).sum::<f64>() / square;
    let along = if along.is_finite() { along } else { 0.0 };
    [0, 1, 2].map(|axis| gone[axis] - along * way[axis]).iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// How far the edge of the tool is off the programmed contour while its centre is at a place, in BLU; `None` on the ways
/// onto the contour and off it. Round a corner only what it would cut into it counts.
#[must_use]
pub(super) fn off_programmed(of: &ToolMove, at: Point) -> Option<f64> {
    let radius = match of.side {
        Side::On => 0.0,
        Side::Left(radius) | Side::Right(radius) => radius,
    };
    match of.cause {
        Cause::StartUp | Cause::Cancel => None,
        Cause::Programmed => {
            let aside = off_segment(&of.programmed, at);
            Some((aside - radius).abs())
        }
        Cause::Inserted => Some((radius - off_segment(&of.programmed, at)).max(0.0)),
    }
}
