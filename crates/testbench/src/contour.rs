//! The distance of a place of the tool from a contour in real numbers.

use stepwave_nc::{Cause, Point, Segment, SegmentShape, Side, ToolMove, swept};

/// The distance of a place from the infinite line or the whole circle of a segment, in BLU: of an arc in its plane.
#[must_use]
pub(super) fn off_segment(segment: &Segment, at: Point) -> f64 {
    match segment.shape {
        SegmentShape::Line => off_line(segment.from, segment.to, at),
        SegmentShape::Arc { plane, center, direction } => {
            let radius = |point: Point| {
                let [u, v, _] = plane.of(point);
                f64::hypot(u - center[0], v - center[1])
            };
            let (start, end) = (radius(segment.from), radius(segment.to));
            let off = |wanted: f64| (radius(at) - wanted).abs();
            if (start - end).abs() < 1e-6 {
                return off(start);
            }
            // The radius goes evenly from that of the start to that of the end.
            let to_place = Segment { to: at, ..*segment };
            let part = swept(&to_place, plane, center, direction) / swept(segment, plane, center, direction);
            if part <= 1.0 { off(start + (end - start) * part) } else { off(start).min(off(end)) }
        }
    }
}

/// How far the two radii of an arc are apart, in BLU; 0 of a line.
#[must_use]
pub(super) fn radii_apart(segment: &Segment) -> f64 {
    let SegmentShape::Arc { plane, center, .. } = segment.shape else { return 0.0 };
    let [start, end] = [segment.from, segment.to].map(|point| {
        let [u, v, _] = plane.of(point);
        f64::hypot(u - center[0], v - center[1])
    });
    (end - start).abs()
}

/// The distance from a line through two points, or from the point that both are.
fn off_line(from: Point, to: Point, at: Point) -> f64 {
    let delta = [0, 1, 2].map(|axis| to[axis] - from[axis]);
    let gone = [0, 1, 2].map(|axis| at[axis] - from[axis]);
    let square: f64 = delta.iter().map(|c| c * c).sum();
    let along = delta.iter().zip(gone).map(|(a, b)| a * b).sum::<f64>() / square;
    let along = if along.is_finite() { along } else { 0.0 };
    [0, 1, 2].map(|axis| gone[axis] - along * delta[axis]).iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// How far the edge of the tool is off the programmed contour while its centre is at a place, in BLU; `None` on the
/// paths onto the contour and off it. Round a corner only what it would cut into it counts.
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
