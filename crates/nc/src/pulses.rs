//! From real numbers to pulses: the blocks that a machine gets for a move, in whole BLU.

use std::f64::consts::{PI, TAU};

use bow::Bow;
use nearest::{Nearest, nearest};

use crate::contour::coordinates;
use crate::{
    AXES_MAX, Arc, Bezier, Cause, Controls, Coordinates, Curve, Direction, Feed, GeometryError, Helix, Line, OTHERS,
    Others, PathControl, Place, Plane, Point, Position, Segment, SegmentShape, Side, Spline, SplineForm, SplineSegment,
    ToolMove,
};

/// The largest distance between the curve that a machine gets and the move in real numbers, in BLU, in both directions:
/// of a tiny circle, whose start and centre both round. The radii of an arc may differ by more, and it is off by as
/// much more.
pub const ROUNDING_LIMIT: f64 = 1.5;

/// A block as a machine gets it: one curve in whole BLU.
#[derive(Debug, Clone, PartialEq)]
pub struct PulseBlock {
    /// The move that it comes from.
    pub of: ToolMove,
    /// The axes of the machine that the curve has, in its order: first the two that the machine interpolates, whose pulses all
    /// others follow. Of an arc they are those of its [plane](Plane::axes), of a line the two that travel farthest, of a free curve
    /// x and y.
    pub axes: Vec<usize>,
    /// The curve: a line, a helix of three axes, an arc of two, or a Bézier curve.
    pub curve: Curve,
    /// Where it starts, in BLU.
    pub from: Position,
    /// Where it ends, in BLU.
    pub to: Position,
}

impl PulseBlock {
    /// The block of a curve by itself, as fast as a machine can run it: a line, an arc, a helix or a Bézier curve; `None` for any
    /// other curve.
    #[must_use]
    pub fn alone(curve: &Curve) -> Option<PulseBlock> {
        let place = |point: &[i64]| std::array::from_fn(|axis| point.get(axis).copied().unwrap_or(0));
        let [from, to]: [Position; 2] = [curve.from(), curve.to()].map(place);
        let (axes, curve) = match curve {
            Curve::Line(_) => straight(from, to).ok()?,
            Curve::Spline(_) => (vec![0, 1], curve.clone()),
            _ => curve.arc().map(|_| (in_plane(Plane::Xy, curve), curve.clone()))?,
        };
        // Within 2^53, as every coordinate is.
        let arc = curve.arc().map(|arc| SegmentShape::Arc {
            plane: Plane::Xy,
            center: arc.center().map(|c| c as f64),
            direction: arc.direction(),
        });
        let shape = match &curve {
            Curve::Spline(spline) => SegmentShape::Bezier(controls(spline)?),
            _ => arc.unwrap_or(SegmentShape::Line),
        };
        let [start, end] = [from, to].map(|point| point.map(|c| c as f64));
        let [(from_point, from_others), (to_point, to_others)] = [start, end].map(split);
        let segment = Segment { from: from_point, to: to_point, shape };
        let (place, cause) = (Place { line: 1, number: None }, Cause::Programmed);
        let of = ToolMove {
            place,
            segment,
            feed: Feed::Rapid,
            cause,
            programmed: segment,
            side: Side::On,
            path: PathControl::default(),
            others: Others { from: from_others, to: to_others },
            chord: false,
        };
        Some(PulseBlock { of, axes, curve, from, to })
    }

    /// The place of the block in its program.
    #[must_use]
    pub fn place(&self) -> Place {
        self.of.place
    }

    /// How fast it is to be run.
    #[must_use]
    pub fn feed(&self) -> Feed {
        self.of.feed
    }

    /// Why the tool moves.
    #[must_use]
    pub fn cause(&self) -> Cause {
        self.of.cause
    }

    /// The length of the path that the feed is along, in BLU: that of [these axes](ToolMove::path_axes). Of a chord that rounding
    /// has left no travel along them it is the length along all axes.
    #[must_use]
    pub fn length(&self) -> f64 {
        if let Curve::Line(_) = self.curve {
            let along = |axes: std::ops::Range<usize>| {
                let travels = axes.map(|axis| self.from[axis].abs_diff(self.to[axis]));
                let squared: u128 = travels.map(|travel| u128::from(travel).pow(2)).sum();
                (squared as f64).sqrt()
            };
            let length = along(self.of.path_axes());
            return if length > 0.0 { length } else { along(0..AXES_MAX) };
        }
        self.curve.length()
    }

    /// How far an axis travels, with its sign, in BLU.
    #[must_use]
    pub fn travel(&self, axis: usize) -> i64 {
        // Both are within 2^52.
        self.to[axis] - self.from[axis]
    }

    /// An axis other than x, y and z moves.
    #[must_use]
    pub fn moves_others(&self) -> bool {
        self.from[3..] != self.to[3..]
    }

    /// An axis moves that the feed is not along: in this block or, as the pieces of an arc are at one feed, in another of its
    /// move.
    #[must_use]
    pub fn carries_others(&self) -> bool {
        let along = self.of.feed_axes().axes();
        (0..AXES_MAX).any(|axis| !along.contains(&axis) && (self.travel(axis) != 0 || !self.of.rests(axis)))
    }

    /// The distance of a position from the curve commanded to the machine, in BLU; the axes of the machine that the curve has
    /// not are passed over.
    #[must_use]
    pub fn deviation(&self, position: &Position) -> f64 {
        let mut along = [0; AXES_MAX];
        along.iter_mut().zip(&self.axes).for_each(|(along, &axis)| *along = position[axis]);
        self.curve.deviation(&along[..self.axes.len()])
    }

    /// The positions of each axis of the machine between which the block runs, in BLU: of an arc the whole circle, of a free curve
    /// those of its control points.
    #[must_use]
    pub fn reach(&self) -> [[i64; 2]; AXES_MAX] {
        let ends = |axis: usize| [self.from[axis].min(self.to[axis]), self.from[axis].max(self.to[axis])];
        let mut reach = std::array::from_fn(ends);
        if let Some(arc) = self.curve.arc() {
            #[allow(clippy::cast_possible_truncation)]
            let radius = arc.radius().ceil() as i64 + 1;
            for (&axis, center) in self.axes.iter().zip(arc.center()) {
                let [low, high] = reach[axis];
                reach[axis] = [low.min(center - radius), high.max(center + radius)];
            }
        }
        if let Curve::Spline(spline) = &self.curve {
            for (&axis, of) in self.axes.iter().zip(0..) {
                let [low, high] = reach[axis];
                let along = |point: &[i64; 2]| point[of];
                let points = || spline.points().iter().map(along);
                reach[axis] = [points().fold(low, i64::min), points().fold(high, i64::max)];
            }
        }
        reach
    }
}

/// Rounds moves to pulses, one after the other: each starts where the one before it ends, so that no rounding adds up.
#[derive(Debug, Clone)]
pub struct Rounder {
    at: Position,
    /// Arcs become chords that are at most this many BLU off them.
    chords: Option<f64>,
}

impl Rounder {
    /// From the origin; with `chords` arcs become lines that are at most this many BLU off them.
    #[must_use]
    pub fn new(chords: Option<f64>) -> Rounder {
        Rounder { at: [0; AXES_MAX], chords }
    }

    /// The blocks of a move, none where no pulse is nearest to it; and how far they and the move are apart, in BLU: the
    /// two-sided distance, not including a chord's own distance from its arc.
    ///
    /// # Errors
    /// A coordinate is beyond [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT).
    pub fn blocks(&mut self, of: &ToolMove, out: &mut Vec<PulseBlock>) -> Result<f64, GeometryError> {
        if let Some(curve) = of.segment.bezier() {
            return self.curve(of, &curve, out);
        }
        let SegmentShape::Arc { plane, center, direction } = of.segment.shape else {
            return self.line(of, of.ends()[1], out);
        };
        if let Some(tolerance) = self.chords {
            return self.chords(of, tolerance, out);
        }
        let angle = swept(&of.segment, plane, center, direction);
        let climb = plane.of(of.segment.to)[2] - plane.of(of.segment.from)[2];
        let parts = pieces(angle, climb.abs().max(of.others.farthest()));
        let (mut from, mut apart) = (of.segment.from, 0.0_f64);
        for part in 1..=parts {
            let to = on_arc(&of.segment, plane, center, direction, [part, parts]);
            let segment = Segment { from, to, shape: of.segment.shape };
            let end = coordinates(to, of.others.after(part as f64 / parts as f64));
            let ends = [self.at, rounded(end)?];
            let (curve, off) = arc(&segment, plane, center, direction, ends.map(|end| [end[0], end[1], end[2]]));
            apart = apart.max(off);
            match curve {
                Some(curve) => {
                    let axes = in_plane(plane, &curve);
                    out.push(PulseBlock { of: *of, axes, curve, from: ends[0], to: ends[1] });
                    self.at = ends[1];
                }
                None => apart = apart.max(self.line(of, end, out)?),
            }
            from = to;
        }
        Ok(apart)
    }

    /// The blocks of a move whose arc or free curve becomes chords that are at most this many BLU off it, as
    /// [`blocks`](Self::blocks).
    ///
    /// # Errors
    /// As [`blocks`](Self::blocks).
    pub fn chords(&mut self, of: &ToolMove, tolerance: f64, out: &mut Vec<PulseBlock>) -> Result<f64, GeometryError> {
        let mut apart = 0.0_f64;
        if let Some(curve) = of.segment.bezier() {
            let [.., third] = of.segment.to;
            for [x, y] in curve.chords(tolerance) {
                apart = apart.max(self.line(of, coordinates([x, y, third], of.others.to), out)?);
            }
            return Ok(apart);
        }
        let SegmentShape::Arc { plane, center, direction } = of.segment.shape else {
            return self.line(of, of.ends()[1], out);
        };
        let points = chords(&of.segment, plane, center, direction, tolerance);
        let parts = points.len() as f64;
        for (part, point) in (1_u32..).zip(points) {
            apart = apart.max(self.line(of, coordinates(point, of.others.after(f64::from(part) / parts)), out)?);
        }
        Ok(apart)
    }

    /// A free curve, whose control points are rounded; also returns how far these are off the wanted ones at most, and so how far
    /// the curve may be; of one that is left out, as it takes no pulse, how far it goes.
    fn curve(&mut self, of: &ToolMove, curve: &Bezier, out: &mut Vec<PulseBlock>) -> Result<f64, GeometryError> {
        let [.., third] = of.segment.to;
        let place = |[x, y]: [f64; 2]| rounded(coordinates([x, y, third], of.others.to));
        let points = curve.points().iter().map(|point| place(*point)).collect::<Result<Vec<_>, _>>()?;
        // Its start is the end of the block before it.
        let (from, to) = (self.at, points.last().copied().unwrap_or(self.at));
        let rest = points.iter().skip(1).map(|point| [point[0], point[1]]);
        let whole: Vec<[i64; 2]> = std::iter::once([from[0], from[1]]).chain(rest).collect();
        let off = |([x, y], to): ([f64; 2], [i64; 2])| f64::hypot(x - to[0] as f64, y - to[1] as f64);
        let most = |of: &mut dyn Iterator<Item = f64>| of.fold(0.0, f64::max);
        match Spline::new(SplineForm::Bezier, &whole) {
            Ok(spline) if !rests(&spline) => {
                out.push(PulseBlock { of: *of, axes: vec![0, 1], curve: Curve::Spline(spline), from, to });
                self.at = to;
                Ok(most(&mut curve.points().iter().copied().zip(whole).map(off)))
            }
            _ => Ok(most(&mut places().map(|u| off((curve.at(u), whole[0]))))),
        }
    }

    /// A straight block; also returns how far its end is off the wanted one.
    fn line(&mut self, of: &ToolMove, end: Coordinates, out: &mut Vec<PulseBlock>) -> Result<f64, GeometryError> {
        let (from, to) = (self.at, rounded(end)?);
        let off = end.iter().zip(to).map(|(end, to)| (end - to as f64).powi(2)).sum::<f64>().sqrt();
        if from == to {
            return Ok(off);
        }
        let (axes, curve) = straight(from, to)?;
        out.push(PulseBlock { of: *of, axes, curve, from, to });
        self.at = to;
        Ok(off)
    }
}

/// Places of a tiny curve that are looked at.
const PLACES: u32 = 64;

fn places() -> impl Iterator<Item = f64> {
    (0..=PLACES).map(|place| f64::from(place) / f64::from(PLACES))
}

/// It takes no pulse: it ends where it begins, and all of it is rounded to there. Of a closed Bézier curve with whole control
/// points the places are enough: it stays within 4/9 BLU of its start, goes just half a BLU away at its middle, or farther at a
/// half, a quarter or three quarters.
fn rests(curve: &Spline) -> bool {
    let here = curve.from();
    let near = |at: f64, here: i64| (-0.5..0.5).contains(&(at - here as f64));
    let of_segment =
        |segment: &SplineSegment| places().all(|u| segment.at(u).iter().zip(here).all(|(at, here)| near(*at, here)));
    here == curve.to() && curve.segments().iter().all(of_segment)
}

/// The control points of a Bézier curve between its ends; none of another free curve.
fn controls(spline: &Spline) -> Option<Controls> {
    let real = |point: [i64; 2]| point.map(|c| c as f64);
    match (spline.form(), spline.points()) {
        (SplineForm::Bezier, &[_, control, _]) => Some(Controls::One(real(control))),
        (SplineForm::Bezier, &[_, first, second, _]) => Some(Controls::Two([first, second].map(real))),
        _ => None,
    }
}

fn split([x, y, z, a, b, c, u, v, w]: Coordinates) -> (Point, [f64; OTHERS]) {
    ([x, y, z], [a, b, c, u, v, w])
}

/// A line through x, y, z and the other axes that move, those two first that travel farthest.
fn straight(from: Position, to: Position) -> Result<(Vec<usize>, Curve), GeometryError> {
    let travel = |axis: &usize| from[*axis].abs_diff(to[*axis]);
    let mut axes: Vec<usize> = (0..AXES_MAX).filter(|axis| *axis < 3 || travel(axis) > 0).collect();
    axes.sort_by_key(|axis| std::cmp::Reverse(travel(axis)));
    axes[..2].sort_unstable();
    axes[2..].sort_unstable();
    if axes[..2] == [0, 2] {
        // As in the plane of G18.
        axes[..2].reverse();
    }
    let along = |point: Position| axes.iter().map(|axis| point[*axis]).collect();
    let line = Line::new(along(from), along(to))?;
    Ok((axes, Curve::Line(line)))
}

/// The axes of an arc or a helix in a plane.
fn in_plane(plane: Plane, curve: &Curve) -> Vec<usize> {
    let axes = plane.axes();
    if let Curve::Arc(_) = curve { axes[..2].to_vec() } else { axes.to_vec() }
}

/// The nearest whole point.
fn rounded(point: Coordinates) -> Result<Position, GeometryError> {
    // Beyond the limit if it is not finite or does not fit: the cast saturates.
    #[allow(clippy::cast_possible_truncation)]
    let whole = point.map(|c| if c.is_nan() { i64::MAX } else { c.round() as i64 });
    crate::limit::check_coordinates(&whole)?;
    Ok(whole)
}

/// The arc or helix in whole BLU that is nearest to a segment, and the two-sided distance between them in the plane, in
/// BLU; no curve where the straight line between the ends is nearer.
fn arc(
    segment: &Segment,
    plane: Plane,
    center: [f64; 2],
    direction: Direction,
    ends: [[i64; 3]; 2],
) -> (Option<Curve>, f64) {
    let along = |point: [i64; 3]| plane.axes().map(|axis| point[axis]);
    let [from, to] = ends.map(along);
    let flat = [[from[0], from[1]], [to[0], to[1]]];
    let real = [segment.from, segment.to].map(|point| {
        let [u, v, _] = plane.of(point);
        [u, v]
    });
    let ideal = Bow::spiral(real, center, swept(segment, plane, center, direction), direction);
    // Of a short arc the ends say where the centre is, of a longer one the programmed centre does.
    let seeds = [center, through(segment, plane, center, direction, flat)];
    let Nearest { arc, apart } = nearest(&ideal, seeds, flat, direction);
    let curve = arc.and_then(|arc| match from[2] == to[2] {
        true => Some(Curve::Arc(arc)),
        false => Helix::new(from, to, arc.center(), direction).ok().map(Curve::Helix),
    });
    (curve, apart)
}

/// The arc between two whole points that is nearest to one about a centre with another radius at its end than at its
/// start.
pub(crate) fn arc_between(from: [i64; 2], to: [i64; 2], center: [i64; 2], direction: Direction) -> Option<Arc> {
    // Within 2^53, as every coordinate is.
    let real = |[x, y]: [i64; 2]| [x as f64, y as f64, 0.0];
    let [x, y, _] = real(center);
    let shape = SegmentShape::Arc { plane: Plane::Xy, center: [x, y], direction };
    let segment = Segment { from: real(from), to: real(to), shape };
    let ends = [from, to].map(|[x, y]| [x, y, 0]);
    match arc(&segment, Plane::Xy, [x, y], direction, ends) {
        (Some(Curve::Arc(arc)), _) => Some(arc),
        _ => None,
    }
}

/// The centre of an arc of the programmed radius through both rounded ends: on the perpendicular bisector of their
/// chord, on the side where the programmed one is.
fn through(
    segment: &Segment,
    plane: Plane,
    center: [f64; 2],
    direction: Direction,
    [start, end]: [[i64; 2]; 2],
) -> [f64; 2] {
    let [u, v, _] = plane.of(segment.from);
    let radius = f64::hypot(u - center[0], v - center[1]);
    let [start, end] = [start, end].map(|point| point.map(|c| c as f64));
    let chord = [end[0] - start[0], end[1] - start[1]];
    let length = f64::hypot(chord[0], chord[1]);
    if length == 0.0 {
        return center;
    }
    let height = (radius.powi(2) - (length / 2.0).powi(2)).max(0.0).sqrt();
    // Less than half a turn has its centre on the left of the chord where it turns to the left.
    let left = (direction == Direction::CounterClockwise) == (swept(segment, plane, center, direction) < PI);
    let height = if left { height } else { -height };
    let middle = [(start[0] + end[0]) / 2.0, (start[1] + end[1]) / 2.0];
    [middle[0] - chord[1] / length * height, middle[1] + chord[0] / length * height]
}

/// The angle through which an arc turns, in radians: more than 0, up to 2π.
#[must_use]
pub fn swept(segment: &Segment, plane: Plane, center: [f64; 2], direction: Direction) -> f64 {
    let [from, to] = [segment.from, segment.to].map(|point| {
        let [u, v, _] = plane.of(point);
        [u - center[0], v - center[1]]
    });
    if from == to {
        return TAU;
    }
    let turn = (from[0] * to[1] - from[1] * to[0]).atan2(from[0] * to[0] + from[1] * to[1]);
    let turn = if direction == Direction::Clockwise { -turn } else { turn };
    if turn <= 0.0 { turn + TAU } else { turn }
}

/// Into how many pieces an arc goes, so that its third axis may follow the pulses of the plane: they come up to 41 %
/// more often between the axes than along them. A piece of an angle a strays by less than a/8 of its climb, here half a
/// BLU.
fn pieces(angle: f64, climb: f64) -> usize {
    if climb == 0.0 {
        return 1;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let pieces = (angle / (2.0 * (angle / climb.abs()).sqrt())).ceil() as usize;
    pieces.clamp(1, 1 << 20)
}

/// Ends of chords of an arc, in order; the middle of each is at most `tolerance` BLU off the arc.
fn chords(segment: &Segment, plane: Plane, center: [f64; 2], direction: Direction, tolerance: f64) -> Vec<Point> {
    let [u, v, _] = plane.of(segment.from);
    let radius = f64::hypot(u - center[0], v - center[1]);
    // The sagitta of a chord over an angle a is r (1 - cos(a/2)).
    let most = 2.0 * (1.0 - (tolerance / radius.max(tolerance)).min(1.0)).acos();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let parts = ((swept(segment, plane, center, direction) / most.max(1e-6)).ceil() as usize).clamp(1, 1 << 20);
    (1..=parts).map(|part| on_arc(segment, plane, center, direction, [part, parts])).collect()
}

/// The point after this many of the equal parts of an arc; the last is its end. The radius goes evenly from that of the
/// start to that of the end.
fn on_arc(segment: &Segment, plane: Plane, center: [f64; 2], direction: Direction, [part, parts]: [usize; 2]) -> Point {
    if part == parts {
        return segment.to;
    }
    let [u, v, from] = plane.of(segment.from);
    let [end_u, end_v, to] = plane.of(segment.to);
    let start = [u - center[0], v - center[1]];
    let radius = f64::hypot(start[0], start[1]);
    let end_radius = f64::hypot(end_u - center[0], end_v - center[1]);
    let sign = if direction == Direction::Clockwise { -1.0 } else { 1.0 };
    let part = part as f64 / parts as f64;
    let (sin, cos) = (sign * swept(segment, plane, center, direction) * part).sin_cos();
    let scale = 1.0 + (end_radius / radius - 1.0) * part;
    let [x, y] = [start[0] * cos - start[1] * sin, start[0] * sin + start[1] * cos];
    plane.point([center[0] + x * scale, center[1] + y * scale, from + (to - from) * part])
}

mod bow;
mod nearest;
#[cfg(test)]
mod tests;
