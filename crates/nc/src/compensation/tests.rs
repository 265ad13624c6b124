use std::f64::consts::{SQRT_2, TAU};

use super::*;
use crate::{
    Cause, Direction, Feed, Move, Others, PathControl, Place, Plane, Point, Segment, SegmentShape, Side, ToolMove,
};

mod corners;
mod errors;
mod program;
mod random;

type Vector = [f64; 2];
type Outcome = Result<(), CompensationError>;

const RADIUS: f64 = 2.0;
/// The two sides: left and right.
const SIDES: [fn(f64) -> Side; 2] = [Side::Left, Side::Right];

fn flat(point: Point) -> Vector {
    [point[0], point[1]]
}

fn distance(a: Vector, b: Vector) -> f64 {
    f64::hypot(a[0] - b[0], a[1] - b[1])
}

#[track_caller]
fn assert_near(found: Vector, expected: Vector, tolerance: f64) {
    assert!(distance(found, expected) <= tolerance, "{found:?} is not {expected:?}");
}

fn block(line: u64, from: Vector, to: Vector, shape: SegmentShape, side: Side) -> Move {
    let segment = Segment { from: [from[0], from[1], 0.0], to: [to[0], to[1], 0.0], shape };
    let place = Place { line, number: Some(10 * line) };
    Move {
        place,
        segment,
        feed: Feed::PerMinute(100.0),
        plane: Plane::Xy,
        side,
        path: PathControl::default(),
        others: Others::default(),
        chord: false,
    }
}

fn arc(center: Vector, direction: Direction) -> SegmentShape {
    SegmentShape::Arc { plane: Plane::Xy, center, direction }
}

/// The blocks one after another from a point, the first as start-up.
fn contour(start: Vector, steps: &[(Vector, SegmentShape)], side: Side) -> Vec<Move> {
    let mut from = start;
    let mut moves = Vec::new();
    for (line, &(to, shape)) in (1..).zip(steps) {
        moves.push(block(line, from, to, shape, side));
        from = to;
    }
    moves
}

fn run(scheme: Scheme, corner: Corner, moves: &[Move]) -> Result<Vec<ToolMove>, CompensationError> {
    let mut compensator = Compensator::new(scheme, corner);
    let mut out = Vec::new();
    moves.iter().try_for_each(|&block| compensator.push(block, &mut out))?;
    compensator.flush(&mut out)?;
    Ok(out)
}

fn ends(moves: &[ToolMove]) -> Vec<Vector> {
    moves.iter().map(|tool| flat(tool.segment.to)).collect()
}

/// Points of a segment, from end to end.
fn samples(segment: &Segment) -> Vec<Vector> {
    let (from, to) = (flat(segment.from), flat(segment.to));
    let part = |index: i32| f64::from(index) / 100.0;
    match segment.shape {
        SegmentShape::Line | SegmentShape::Bezier(_) => (0..=100)
            .map(|index| {
                let part = part(index);
                [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]
            })
            .collect(),
        SegmentShape::Arc { center, direction, .. } => {
            let angle = |point: Vector| f64::atan2(point[1] - center[1], point[0] - center[0]);
            let (start, end) = (angle(from), angle(to));
            let sweep = match direction {
                Direction::CounterClockwise => (end - start).rem_euclid(TAU),
                Direction::Clockwise => -(start - end).rem_euclid(TAU),
            };
            let sweep = if from == to { TAU } else { sweep };
            let radius = distance(from, center);
            (0..=100)
                .map(|index| {
                    let angle = start + sweep * part(index);
                    [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
                })
                .collect()
        }
    }
}

/// How far a point is from a segment.
fn clearance(point: Vector, segment: &Segment) -> f64 {
    let (from, to) = (flat(segment.from), flat(segment.to));
    let at_ends = distance(point, from).min(distance(point, to));
    match segment.shape {
        SegmentShape::Line | SegmentShape::Bezier(_) => {
            let chord = [to[0] - from[0], to[1] - from[1]];
            let square = chord[0] * chord[0] + chord[1] * chord[1];
            let part = ((point[0] - from[0]) * chord[0] + (point[1] - from[1]) * chord[1]) / square;
            let part = part.clamp(0.0, 1.0);
            distance(point, [from[0] + part * chord[0], from[1] + part * chord[1]])
        }
        SegmentShape::Arc { center, direction, .. } => {
            let angle = |of: Vector| f64::atan2(of[1] - center[1], of[0] - center[0]);
            let (first, last) = match direction {
                Direction::CounterClockwise => (angle(from), angle(to)),
                Direction::Clockwise => (angle(to), angle(from)),
            };
            let within = from == to || (angle(point) - first).rem_euclid(TAU) <= (last - first).rem_euclid(TAU);
            let radial = (distance(point, center) - distance(from, center)).abs();
            if within { radial } else { at_ends }
        }
    }
}

#[track_caller]
fn assert_joined(moves: &[ToolMove]) {
    for pair in moves.windows(2) {
        assert_eq!(pair[0].segment.to, pair[1].segment.from);
    }
    for tool in moves {
        if let SegmentShape::Arc { center, .. } = tool.segment.shape {
            let [start, end] = [tool.segment.from, tool.segment.to].map(|point| distance(flat(point), center));
            assert!((start - end).abs() < 1e-6, "an arc from radius {start} to {end}");
        }
    }
}

/// The contour of section 7: along x to (10, 0), then 20 BLU at an angle.
fn turned(degrees: f64, side: Side) -> Vec<Move> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let steps = [[-10.0, 0.0], [10.0, 0.0], [10.0 + 20.0 * cos, 20.0 * sin]].map(|to| (to, SegmentShape::Line));
    contour([-20.0, 0.0], &steps, side)
}

#[test]
fn a_turn_by_60_degrees_is_cut_short_inside_and_prolonged_outside() -> Outcome {
    for corner in [Corner::Straight, Corner::Circular] {
        let inside = run(Scheme::C, corner, &turned(60.0, Side::Left(2.0)))?;
        assert_eq!(inside.len(), 3);
        assert_near(ends(&inside)[1], [8.8453, 2.0], 1e-4);
        let outside = run(Scheme::C, corner, &turned(60.0, Side::Right(2.0)))?;
        assert_eq!(outside.len(), 3);
        assert_near(ends(&outside)[1], [11.1547, -2.0], 1e-4);
    }
    Ok(())
}

#[test]
fn a_turn_by_150_degrees_gets_a_straight_move_inserted() -> Outcome {
    let moves = run(Scheme::C, Corner::Straight, &turned(150.0, Side::Right(2.0)))?;
    assert_eq!(moves.len(), 4);
    assert_near(ends(&moves)[1], [12.0, -2.0], 1e-9);
    assert_near(ends(&moves)[2], [12.7321, 0.7321], 1e-4);
    assert_eq!(moves[2].cause, Cause::Inserted);
    assert_eq!((moves[2].place, moves[2].side), (Place { line: 2, number: Some(20) }, Side::Right(2.0)));
    let corner = [10.0, 0.0, 0.0];
    assert_eq!(moves[2].programmed, Segment { from: corner, to: corner, shape: SegmentShape::Line });
    Ok(())
}

#[test]
fn a_turn_by_150_degrees_gets_an_arc_about_the_corner_inserted() -> Outcome {
    let moves = run(Scheme::C, Corner::Circular, &turned(150.0, Side::Right(2.0)))?;
    assert_eq!(moves.len(), 4);
    assert_near(ends(&moves)[1], [10.0, -2.0], 1e-9);
    // The normal of 150° on the right is 60°: 2 cos 60° = 1, 2 sin 60° = 1.7321.
    assert_near(ends(&moves)[2], [11.0, 1.7321], 1e-4);
    assert_eq!(moves[2].segment.shape, arc([10.0, 0.0], Direction::CounterClockwise));
    let left = run(Scheme::C, Corner::Circular, &turned(-150.0, Side::Left(2.0)))?;
    assert_eq!(left[2].segment.shape, arc([10.0, 0.0], Direction::Clockwise));
    Ok(())
}

#[test]
fn an_arc_gets_a_larger_or_smaller_radius_by_its_turn_and_the_side() -> Outcome {
    use Direction::{Clockwise, CounterClockwise};
    for (direction, side, radius) in [
        (CounterClockwise, Side::Left(2.0), 8.0),
        (CounterClockwise, Side::Right(2.0), 12.0),
        (Clockwise, Side::Left(2.0), 12.0),
        (Clockwise, Side::Right(2.0), 8.0),
    ] {
        let far = if direction == Clockwise { [0.0, -10.0] } else { [0.0, 10.0] };
        let steps = [([10.0, 0.0], SegmentShape::Line), (far, arc([0.0, 0.0], direction))];
        for scheme in [Scheme::B, Scheme::C] {
            let moves = run(scheme, Corner::Straight, &contour([20.0, 0.0], &steps, side))?;
            assert_near(ends(&moves)[0], [radius, 0.0], 1e-9);
            assert_near(ends(&moves)[1], [0.0, far[1].signum() * radius], 1e-9);
            assert_eq!(moves[1].segment.shape, arc([0.0, 0.0], direction));
        }
    }
    Ok(())
}
