//! The distance of a place of the tool from a contour in real numbers.

use stepwave_nc::{AXES_MAX, Cause, Coordinates, Point, Segment, SegmentShape, Side, ToolMove, swept};

/// The distance of a place from the infinite line, the whole circle or the free curve of a segment, in BLU: of an arc in its plane.
#[must_use]
pub(super) fn off_segment(segment: &Segment, at: Point) -> f64 {
    if let Some(curve) = segment.bezier() {
        return f64::hypot(curve.distance([at[0], at[1]]), at[2] - segment.from[2]);
    }
    match segment.shape {
        SegmentShape::Line | SegmentShape::Bezier(_) => off_line(segment.from, segment.to, at),
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

/// How far the two radii of an arc are apart, in BLU; 0 of all else.
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

/// A move from end to end in all axes, for distances from it.
#[derive(Clone, Debug)]
pub(super) struct Outline {
    of: ToolMove,
    ends: [Coordinates; 2],
    /// Least and greatest coordinate of each axis.
    within: [Coordinates; 2],
}

impl Outline {
    pub(super) fn of(of: &ToolMove) -> Outline {
        let ends = of.ends();
        let mut within = [
            std::array::from_fn(|axis| ends[0][axis].min(ends[1][axis])),
            std::array::from_fn(|axis| ends[0][axis].max(ends[1][axis])),
        ];
        if let SegmentShape::Arc { plane, center, .. } = of.segment.shape {
            let radius = radius_of(of, of.segment.from).max(radius_of(of, of.segment.to));
            for (axis, center) in plane.axes().into_iter().zip(center) {
                (within[0][axis], within[1][axis]) = (center - radius, center + radius);
            }
        }
        if let Some(curve) = of.segment.bezier() {
            for (axis, [low, high]) in curve.bounds().into_iter().enumerate() {
                (within[0][axis], within[1][axis]) = (low, high);
            }
        }
        Outline { of: *of, ends, within }
    }

    /// The radius at its start, in BLU; 0 of a line.
    pub(super) fn radius(&self) -> f64 {
        radius_of(&self.of, self.of.segment.from)
    }

    /// How far a place is from the centre of an arc, in its plane, in BLU; 0 of a line.
    pub(super) fn radius_at(of: &ToolMove, at: &Coordinates) -> f64 {
        radius_of(of, [at[0], at[1], at[2]])
    }

    /// What a place is at least off it, in BLU.
    pub(super) fn at_least(&self, at: &Coordinates) -> f64 {
        let [low, high] = &self.within;
        let beyond = at.iter().zip(low).zip(high).map(|((at, low), high)| (low - at).max(at - high).max(0.0));
        beyond.map(|off| off * off).sum::<f64>().sqrt()
    }

    /// How far a place is off it, in BLU, a pulse of every axis as one: from the nearest place of a line, and of an arc from the one
    /// at the same angle or from an end.
    pub(super) fn off(&self, at: &Coordinates) -> f64 {
        let [from, to] = &self.ends;
        if let Some(curve) = self.of.segment.bezier() {
            let aside = curve.distance([at[0], at[1]]);
            return apart((2..AXES_MAX).map(|axis| at[axis] - from[axis]).chain([aside]));
        }
        let SegmentShape::Arc { plane, center, direction } = self.of.segment.shape else {
            let square: f64 = from.iter().zip(to).map(|(from, to)| (to - from).powi(2)).sum();
            let along: f64 = from.iter().zip(to).zip(at).map(|((from, to), at)| (to - from) * (at - from)).sum();
            let part = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
            return apart((0..AXES_MAX).map(|axis| at[axis] - from[axis] - part * (to[axis] - from[axis])));
        };
        let ends = self.ends.iter().map(|end| apart((0..AXES_MAX).map(|axis| at[axis] - end[axis])));
        let nearest = ends.fold(f64::INFINITY, f64::min);
        let segment = &self.of.segment;
        let place = [at[0], at[1], at[2]];
        let part = swept(&Segment { to: place, ..*segment }, plane, center, direction)
            / swept(segment, plane, center, direction);
        if part > 1.0 {
            return nearest;
        }
        let [start, end, here] = [segment.from, segment.to, place].map(|point| radius_of(&self.of, point));
        let [u, v, _] = plane.axes();
        let others = (0..AXES_MAX).filter(|axis| ![u, v].contains(axis));
        let others = others.map(|axis| at[axis] - from[axis] - part * (to[axis] - from[axis]));
        apart(others.chain([here - start - part * (end - start)])).min(nearest)
    }
}

fn apart(offsets: impl Iterator<Item = f64>) -> f64 {
    offsets.map(|off| off * off).sum::<f64>().sqrt()
}

/// How far a place is from the centre of an arc, in its plane; 0 of a line.
fn radius_of(of: &ToolMove, at: Point) -> f64 {
    let SegmentShape::Arc { plane, center, .. } = of.segment.shape else { return 0.0 };
    let [u, v, _] = plane.of(at);
    f64::hypot(u - center[0], v - center[1])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use stepwave_nc::{Direction, Feed, Others, PathControl, Place, Plane};

    use super::*;

    fn tool_move(from: Point, to: Point, shape: SegmentShape, others: Others) -> ToolMove {
        let segment = Segment { from, to, shape };
        ToolMove {
            place: Place { line: 1, number: None },
            segment,
            feed: Feed::Rapid,
            cause: Cause::Programmed,
            programmed: segment,
            side: Side::On,
            path: PathControl::Continuous,
            others,
            chord: false,
        }
    }

    /// Against many places along the move; and a box is never farther than that.
    #[test]
    fn distances_are_those_of_the_nearest_place() {
        let arc = |plane, center, direction| SegmentShape::Arc { plane, center, direction };
        let (cw, ccw) = (Direction::Clockwise, Direction::CounterClockwise);
        let turning = Others { from: [0.0; 6], to: [20.0, 0.0, 0.0, 0.0, -5.0, 0.0] };
        let moves = [
            tool_move([0.0; 3], [30.0, -10.0, 5.0], SegmentShape::Line, turning),
            tool_move([10.0, 0.0, 3.0], [0.0, 10.0, 3.0], arc(Plane::Xy, [0.0, 0.0], ccw), Others::default()),
            tool_move([10.0, 0.0, 3.0], [0.0, 10.0, 3.0], arc(Plane::Xy, [0.0, 0.0], cw), Others::default()),
            tool_move([10.0, 0.0, 3.0], [10.0, 0.0, 3.0], arc(Plane::Xy, [2.0, 1.0], cw), Others::default()),
        ];
        for of in moves {
            let (outline, [from, to]) = (Outline::of(&of), of.ends());
            let along = |part: f64| -> Coordinates {
                let mut at: Coordinates = std::array::from_fn(|axis| from[axis] + part * (to[axis] - from[axis]));
                if let SegmentShape::Arc { plane, center, direction } = of.segment.shape {
                    let [x, y] = [from[0] - center[0], from[1] - center[1]];
                    let angle = part * swept(&of.segment, plane, center, direction);
                    let angle = if direction == cw { -angle } else { angle };
                    let (sin, cos) = angle.sin_cos();
                    (at[0], at[1]) = (center[0] + x * cos - y * sin, center[1] + x * sin + y * cos);
                }
                at
            };
            for index in 0..200 {
                let angle = TAU * f64::from(index) / 37.0;
                let mut at = along(f64::from(index % 11) / 10.0);
                (at[0], at[1]) = (at[0] + 4.0 * angle.cos(), at[1] + 4.0 * angle.sin() * f64::from(index % 3));
                at[2] += f64::from(index % 4);
                at[3] += f64::from(index % 5);
                let nearest = (0..=5000).map(|part| along(f64::from(part) / 5000.0));
                let nearest = nearest.map(|on| apart((0..AXES_MAX).map(|axis| at[axis] - on[axis])));
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                let off = outline.off(&at);
                assert!((off - nearest).abs() < 0.01, "{of:?} {at:?}: {off}, not {nearest}");
                assert!(outline.at_least(&at) <= off + 1e-9);
            }
        }
    }
}
