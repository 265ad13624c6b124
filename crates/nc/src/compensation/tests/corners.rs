//! Corners of two blocks: every transition, both sides, every angle.

use super::*;

/// A block that ends (or starts) in the origin with a tangent of an angle: straight, or an arc with its centre on the
/// left (1) or on the right (-1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub(super) bend: f64,
    pub(super) radius: f64,
    pub(super) sweep: f64,
}

const LINE: Piece = Piece { bend: 0.0, radius: 0.0, sweep: 0.0 };
pub(super) const LONG: f64 = 25.0;
const LEFT: Piece = Piece { bend: 1.0, radius: 20.0, sweep: 0.6 };
const RIGHT: Piece = Piece { bend: -1.0, radius: 20.0, sweep: 0.6 };

impl Piece {
    /// The far end, the tangent there and the shape, of the block that leaves the origin at an angle.
    fn leave_origin(self, angle: f64) -> (Vector, f64, SegmentShape) {
        if self.bend == 0.0 {
            return ([LONG * angle.cos(), LONG * angle.sin()], angle, SegmentShape::Line);
        }
        let normal = angle + self.bend * TAU / 4.0;
        let center = [self.radius * normal.cos(), self.radius * normal.sin()];
        let end = normal + TAU / 2.0 + self.bend * self.sweep;
        let far = [center[0] + self.radius * end.cos(), center[1] + self.radius * end.sin()];
        let direction = if self.bend > 0.0 { Direction::CounterClockwise } else { Direction::Clockwise };
        (far, angle + self.bend * self.sweep, arc(center, direction))
    }

    /// The far end, the tangent there and the shape, of the block that comes to the origin along x.
    fn reach_origin(self) -> (Vector, f64, SegmentShape) {
        let back = Piece { bend: -self.bend, ..self };
        let (far, tangent, shape) = back.leave_origin(TAU / 2.0);
        (far, tangent + TAU / 2.0, reversed(shape))
    }
}

fn reversed(shape: SegmentShape) -> SegmentShape {
    match shape {
        other @ (SegmentShape::Line | SegmentShape::Bezier(_)) => other,
        SegmentShape::Arc { plane, center, direction } => {
            SegmentShape::Arc { plane, center, direction: direction.reversed() }
        }
    }
}

/// A start-up and two blocks about the origin.
pub(super) fn corner(leaving: Piece, entering: Piece, turn: f64, side: Side) -> Vec<Move> {
    let (start, tangent, first) = leaving.reach_origin();
    let (end, _, second) = entering.leave_origin(turn);
    let before = [start[0] - 10.0 * tangent.cos(), start[1] - 10.0 * tangent.sin()];
    contour(before, &[(start, SegmentShape::Line), ([0.0, 0.0], first), (end, second)], side)
}

fn every_corner() -> impl Iterator<Item = (Piece, Piece, f64, bool)> {
    let pieces = [LINE, LEFT, RIGHT];
    let pairs = pieces.into_iter().flat_map(move |first| pieces.map(|second| (first, second)));
    pairs.flat_map(|(first, second)| {
        // 100° inside to 150° outside; sharper inside, the far ends of the arcs come near one another.
        (-10..=15).flat_map(move |tens| {
            [true, false].map(|left| (first, second, f64::from(if left { -10 } else { 10 } * tens), left))
        })
    })
}

fn on(left: bool) -> Side {
    SIDES[usize::from(!left)](RADIUS)
}

/// Without the start-up.
fn kept(moves: &[ToolMove]) -> &[ToolMove] {
    &moves[1..]
}

#[track_caller]
pub(super) fn assert_clear(tool: &[ToolMove], programmed: &[Move], radius: f64) {
    for point in tool.iter().flat_map(|tool| samples(&tool.segment)) {
        for block in programmed {
            let found = clearance(point, &block.segment);
            assert!(found >= radius - 1e-7, "{point:?} is {found} off line {}", block.place.line);
        }
    }
}

#[test]
fn scheme_c_never_comes_nearer_than_the_radius_and_leaves_no_gap() -> Outcome {
    let mut judged = 0;
    for (leaving, entering, turn, left) in every_corner() {
        for round in [Corner::Straight, Corner::Circular] {
            let moves = corner(leaving, entering, turn.to_radians(), on(left));
            let tool = run(Scheme::C, round, &moves)?;
            assert_joined(&tool);
            if !bends_back(&moves) {
                judged += 1;
                assert_clear(kept(&tool), &moves[1..], RADIUS);
            }
        }
    }
    assert!(judged > 850, "{judged} of {}", 2 * every_corner().count());
    Ok(())
}

/// Whether the far ends of two blocks come together again, which one block of look-ahead cannot see.
fn bends_back(moves: &[Move]) -> bool {
    let far = |of: usize, to: usize| {
        let away = samples(&moves[of].segment).into_iter().filter(|&point| distance(point, [0.0; 2]) > 8.0);
        away.map(|point| clearance(point, &moves[to].segment)).fold(f64::INFINITY, f64::min)
    };
    far(1, 2).min(far(2, 1)) < 2.0 * RADIUS
}

#[test]
fn classes_show_in_what_is_inserted_and_how_far_it_goes() -> Outcome {
    for (leaving, entering, turn, left) in every_corner() {
        let outward = if left { -turn } else { turn };
        let moves = corner(leaving, entering, turn.to_radians(), on(left));
        let straight = run(Scheme::C, Corner::Straight, &moves)?;
        let circular = run(Scheme::C, Corner::Circular, &moves)?;
        let case = format!("{leaving:?} {entering:?} {turn} {left}");
        let inserted: Vec<_> = kept(&circular).iter().filter(|tool| tool.cause == Cause::Inserted).collect();
        if outward <= 90.0 {
            assert_eq!(straight, circular, "{case}");
            assert!(inserted.is_empty(), "{case}");
            // One point, at the radius from both paths, taken as an endless line and a whole circle.
            let point = flat(tool_corner(&straight));
            for (block, tip) in moves[1..].iter().zip([0.0, turn.to_radians()]) {
                let off = match block.segment.shape {
                    SegmentShape::Line | SegmentShape::Bezier(_) => (point[1] * tip.cos() - point[0] * tip.sin()).abs(),
                    SegmentShape::Arc { center, .. } => (distance(point, center) - 20.0).abs(),
                };
                assert!((off - RADIUS).abs() < 1e-9, "{case}: {off}");
            }
            // Outside nearer than 3 r to the corner; on lines r / cos(half the turn).
            let reach = distance(point, [0.0, 0.0]);
            assert!(outward < 0.0 || reach < 3.0 * RADIUS, "{case}: {reach}");
            if leaving == LINE && entering == LINE {
                assert!((reach - RADIUS / (turn / 2.0).to_radians().cos()).abs() < 1e-9, "{case}: {reach}");
            }
        } else {
            assert_eq!(inserted.len(), 1, "{case}");
            let turn = if left { Direction::Clockwise } else { Direction::CounterClockwise };
            assert_eq!(inserted[0].segment.shape, arc([0.0, 0.0], turn));
            for point in samples(&inserted[0].segment) {
                assert!((distance(point, [0.0, 0.0]) - RADIUS).abs() < 1e-9, "{case}");
            }
            let extra = usize::from(leaving != LINE) + usize::from(entering != LINE);
            assert_eq!(straight.len(), 4 + extra, "{case}");
            for tool in straight.iter().filter(|tool| tool.cause == Cause::Inserted) {
                for point in samples(&tool.segment) {
                    let reach = distance(point, [0.0, 0.0]);
                    assert!(reach < SQRT_2 * RADIUS + 1e-9, "{case}: {reach}");
                }
            }
        }
    }
    Ok(())
}

/// Where the first block after the start-up ends.
fn tool_corner(tool: &[ToolMove]) -> Point {
    tool[1].segment.to
}

#[test]
fn a_mirrored_program_gives_the_mirrored_path() -> Outcome {
    let mirror = |segment: Segment| Segment {
        from: [segment.from[0], -segment.from[1], 0.0],
        to: [segment.to[0], -segment.to[1], 0.0],
        shape: match segment.shape {
            other @ (SegmentShape::Line | SegmentShape::Bezier(_)) => other,
            SegmentShape::Arc { plane, center, direction } => {
                SegmentShape::Arc { plane, center: [center[0], -center[1]], direction: direction.reversed() }
            }
        },
    };
    for (leaving, entering, turn, left) in every_corner() {
        for (scheme, round) in
            [(Scheme::B, Corner::Straight), (Scheme::C, Corner::Straight), (Scheme::C, Corner::Circular)]
        {
            let moves = corner(leaving, entering, turn.to_radians(), on(left));
            let mirrored: Vec<Move> =
                moves.iter().map(|of| Move { segment: mirror(of.segment), side: on(!left), ..*of }).collect();
            let (plain, mirrored) = (run(scheme, round, &moves)?, run(scheme, round, &mirrored)?);
            assert_eq!(plain.len(), mirrored.len());
            for (plain, mirrored) in plain.iter().zip(&mirrored) {
                assert_same(mirror(plain.segment), mirrored.segment);
            }
        }
    }
    Ok(())
}

#[track_caller]
fn assert_same(a: Segment, b: Segment) {
    assert_near(flat(a.from), flat(b.from), 1e-7);
    assert_near(flat(a.to), flat(b.to), 1e-7);
    match (a.shape, b.shape) {
        (SegmentShape::Arc { center: a, direction: c, .. }, SegmentShape::Arc { center: b, direction: d, .. }) => {
            assert_near(a, b, 1e-9);
            assert_eq!(c, d);
        }
        shapes => assert_eq!(shapes.0, shapes.1),
    }
}

#[test]
fn a_program_run_backwards_on_the_other_side_gives_the_path_backwards() -> Outcome {
    let back = |segment: Segment| Segment { from: segment.to, to: segment.from, shape: reversed(segment.shape) };
    for (leaving, entering, turn, left) in every_corner() {
        for (scheme, round) in
            [(Scheme::B, Corner::Straight), (Scheme::C, Corner::Straight), (Scheme::C, Corner::Circular)]
        {
            let moves = corner(leaving, entering, turn.to_radians(), on(left));
            let end = flat(moves[2].segment.to);
            let mut backwards = vec![block(1, [end[0], end[1] + 10.0], end, SegmentShape::Line, on(!left))];
            backwards.extend([moves[2], moves[1]].map(|of| Move { segment: back(of.segment), side: on(!left), ..of }));
            let (plain, backwards) = (run(scheme, round, &moves)?, run(scheme, round, &backwards)?);
            assert_eq!(plain.len(), backwards.len());
            for (plain, backwards) in kept(&plain).iter().zip(kept(&backwards).iter().rev()) {
                assert_same(back(plain.segment), backwards.segment);
            }
        }
    }
    Ok(())
}

#[test]
fn scheme_b_joins_the_normals_by_a_straight_move() -> Outcome {
    for (leaving, entering, turn, left) in every_corner().filter(|case| case.2 != 0.0) {
        let moves = corner(leaving, entering, turn.to_radians(), on(left));
        let tool = run(Scheme::B, Corner::Circular, &moves)?;
        assert_joined(&tool);
        assert_eq!(tool.len(), 4);
        assert_eq!((tool[2].cause, tool[2].segment.shape), (Cause::Inserted, SegmentShape::Line));
        let side = if left { 1.0 } else { -1.0 };
        let (sin, cos) = turn.to_radians().sin_cos();
        assert_near(flat(tool[2].segment.from), [0.0, side * RADIUS], 1e-9);
        assert_near(flat(tool[2].segment.to), [-side * RADIUS * sin, side * RADIUS * cos], 1e-9);
    }
    Ok(())
}

#[test]
fn a_path_back_on_itself_is_rounded_at_its_end() -> Outcome {
    let moves = turned(180.0, Side::Left(2.0));
    let straight = run(Scheme::C, Corner::Straight, &moves)?;
    assert_eq!(straight.len(), 4);
    assert_near(ends(&straight)[1], [12.0, 2.0], 1e-9);
    assert_near(ends(&straight)[2], [12.0, -2.0], 1e-9);
    let circular = run(Scheme::C, Corner::Circular, &moves)?;
    assert_eq!(circular[2].segment.shape, arc([10.0, 0.0], Direction::Clockwise));
    assert_near(ends(&circular)[2], [10.0, -2.0], 1e-9);
    Ok(())
}

#[test]
fn an_outside_corner_whose_offset_paths_do_not_meet_gets_an_insertion() -> Outcome {
    // Right of an arc that bends to the right, of radius 3: the offset circle has radius 1 and cannot reach back to the
    // line 2 below.
    let steps = [
        ([-10.0, 0.0], SegmentShape::Line),
        ([0.0, 0.0], SegmentShape::Line),
        ([3.0, 3.0], arc([3.0, 0.0], Direction::Clockwise)),
    ];
    let moves = contour([-20.0, 0.0], &steps, Side::Right(2.0));
    for (round, inserted) in [(Corner::Straight, 1), (Corner::Circular, 1)] {
        let tool = run(Scheme::C, round, &moves)?;
        assert_joined(&tool);
        assert_eq!(tool.iter().filter(|tool| tool.cause == Cause::Inserted).count(), inserted);
        assert_near(flat(tool.last().map_or([0.0; 3], |tool| tool.segment.from)), [2.0, 0.0], 1e-9);
        assert_near(flat(tool.last().map_or([0.0; 3], |tool| tool.segment.to)), [3.0, 1.0], 1e-9);
        assert_clear(&tool[1..], &moves[1..], 2.0);
    }
    Ok(())
}
