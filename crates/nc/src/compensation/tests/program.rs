//! Whole contours: start-up, cancel, stops, moves along the third axis, changes of side and radius, full circles,
//! planes.

use super::*;

const LINE: SegmentShape = SegmentShape::Line;
const LEFT: Side = Side::Left(2.0);

fn lines(start: Vector, ends: &[Vector], side: Side) -> Vec<Move> {
    contour(start, &ends.iter().map(|&end| (end, LINE)).collect::<Vec<_>>(), side)
}

fn causes(moves: &[ToolMove]) -> Vec<Cause> {
    moves.iter().map(|tool| tool.cause).collect()
}

#[track_caller]
fn assert_ends(moves: &[ToolMove], expected: &[Vector]) {
    assert_eq!(moves.len(), expected.len(), "{:?}", ends(moves));
    for (found, &expected) in ends(moves).into_iter().zip(expected) {
        assert_near(found, expected, 1e-9);
    }
}

#[test]
fn a_square_is_cut_outside_with_start_up_and_cancel() -> Outcome {
    use Cause::{Cancel, Programmed, StartUp};
    // Counter-clockwise about the square, the tool on its right.
    let mut moves =
        lines([-10.0, -10.0], &[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0], [0.0, 0.0]], Side::Right(2.0));
    moves.push(block(6, [0.0, 0.0], [-10.0, -10.0], LINE, Side::On));
    moves.push(block(7, [-10.0, -10.0], [-20.0, -10.0], LINE, Side::On));
    for scheme in [Scheme::B, Scheme::C] {
        let tool = run(scheme, Corner::Straight, &moves)?;
        assert_joined(&tool);
        if scheme == Scheme::C {
            let expected =
                [[0.0, -2.0], [22.0, -2.0], [22.0, 22.0], [-2.0, 22.0], [-2.0, 0.0], [-10.0, -10.0], [-20.0, -10.0]];
            assert_ends(&tool, &expected);
            assert_eq!(causes(&tool), [StartUp, Programmed, Programmed, Programmed, Programmed, Cancel, Programmed]);
            let sides = [Side::Right(2.0); 5].into_iter().chain([Side::On; 2]);
            assert!(tool.iter().map(|tool| tool.side).eq(sides));
            let programmed = moves.iter().map(|block| (block.place, block.segment, block.feed));
            assert!(tool.iter().map(|tool| (tool.place, tool.programmed, tool.feed)).eq(programmed));
        } else {
            let expected = [
                [0.0, -2.0],
                [20.0, -2.0],
                [22.0, 0.0],
                [22.0, 20.0],
                [20.0, 22.0],
                [0.0, 22.0],
                [-2.0, 20.0],
                [-2.0, 0.0],
                [-10.0, -10.0],
                [-20.0, -10.0],
            ];
            assert_ends(&tool, &expected);
        }
    }
    Ok(())
}

#[test]
fn one_block_of_the_contour_is_held_back_by_scheme_c_and_none_by_scheme_b() -> Outcome {
    let moves = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0], [0.0, 10.0], [10.0, 10.0]], LEFT);
    for (scheme, counts) in [(Scheme::C, [0, 1, 2, 3]), (Scheme::B, [0, 2, 4, 6])] {
        let (mut compensator, mut out) = (Compensator::new(scheme, Corner::Straight), Vec::new());
        for (&block, count) in moves.iter().zip(counts) {
            compensator.push(block, &mut out)?;
            assert_eq!(out.len(), count);
        }
    }
    Ok(())
}

#[test]
fn inside_corners_are_overcut_by_scheme_b() -> Outcome {
    let tool = run(Scheme::B, Corner::Straight, &lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0], [0.0, 10.0]], LEFT))?;
    assert_ends(&tool, &[[-10.0, 2.0], [0.0, 2.0], [-2.0, 0.0], [-2.0, 10.0]]);
    Ok(())
}

#[test]
fn a_program_without_compensation_passes_as_it_is() -> Outcome {
    let steps = [([10.0, 0.0], LINE), ([0.0, 10.0], arc([0.0; 2], Direction::CounterClockwise)), ([0.0, 10.0], LINE)];
    let moves = contour([0.0; 2], &steps, Side::On);
    for scheme in [Scheme::B, Scheme::C] {
        let tool = run(scheme, Corner::Straight, &moves)?;
        assert!(tool.iter().map(|tool| tool.segment).eq(moves.iter().map(|block| block.segment)));
    }
    Ok(())
}

#[test]
fn moves_along_the_third_axis_are_done_at_the_corner_without_losing_sight_of_the_next_block() -> Outcome {
    let mut moves = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0], [0.0, 20.0]], LEFT);
    let mut down = block(9, [0.0; 2], [0.0; 2], LINE, LEFT);
    down.segment.to[2] = -5.0;
    moves.insert(2, down);
    moves[3].segment.from[2] = -5.0;
    moves[3].segment.to[2] = -6.0;
    let tool = run(Scheme::C, Corner::Straight, &moves)?;
    assert_joined(&tool);
    assert_ends(&tool, &[[-10.0, 2.0], [-2.0, 2.0], [-2.0, 2.0], [-2.0, 20.0]]);
    assert_eq!(tool.iter().map(|tool| tool.segment.to[2]).collect::<Vec<_>>(), [0.0, 0.0, -5.0, -6.0]);
    assert_eq!((tool[2].place.line, tool[2].programmed), (9, down.segment));
    // Outside it goes down before it goes round.
    moves.iter_mut().for_each(|of| of.side = Side::Right(2.0));
    moves[3].segment.to[0] = -20.0;
    let tool = run(Scheme::C, Corner::Straight, &moves)?;
    assert_eq!(causes(&tool)[2..4], [Cause::Programmed, Cause::Inserted]);
    assert_eq!(tool.iter().map(|tool| tool.segment.to[2]).collect::<Vec<_>>(), [0.0, 0.0, -5.0, -5.0, -6.0]);
    Ok(())
}

#[test]
fn side_words_in_moves_along_the_third_axis_take_effect_on_the_next_move_in_the_plane() -> Outcome {
    let mut down = block(1, [-20.0, 0.0], [-20.0, 0.0], LINE, LEFT);
    down.segment.to[2] = -5.0;
    let mut up = block(8, [0.0; 2], [0.0; 2], LINE, Side::On);
    up.segment.to[2] = 5.0;
    let mut moves = vec![down];
    moves.extend(lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0]], LEFT));
    moves.push(up);
    moves.push(block(9, [0.0; 2], [10.0, 0.0], LINE, Side::On));
    for scheme in [Scheme::B, Scheme::C] {
        let tool = run(scheme, Corner::Straight, &moves)?;
        assert_ends(&tool, &[[-20.0, 0.0], [-10.0, 2.0], [0.0, 2.0], [0.0, 2.0], [10.0, 0.0]]);
        assert_eq!(causes(&tool)[1..2], [Cause::StartUp]);
        assert_eq!(causes(&tool)[4..], [Cause::Cancel]);
    }
    Ok(())
}

#[test]
fn after_a_stop_the_tool_goes_round_outside_corners_and_straight_at_inside_corners() -> Outcome {
    let stopped = |degrees: f64, side, round| {
        let (mut compensator, mut out) = (Compensator::new(Scheme::C, round), Vec::new());
        let moves = turned(degrees, side);
        for &block in &moves[..2] {
            compensator.push(block, &mut out)?;
        }
        compensator.flush(&mut out)?;
        assert_near(ends(&out)[1], [10.0, if side == LEFT { 2.0 } else { -2.0 }], 1e-9);
        compensator.push(moves[2], &mut out)?;
        compensator.flush(&mut out)?;
        assert_joined(&out);
        Ok(out)
    };
    let inside = stopped(90.0, LEFT, Corner::Circular)?;
    assert_ends(&inside, &[[-10.0, 2.0], [10.0, 2.0], [8.0, 0.0], [8.0, 20.0]]);
    let right = Side::Right(2.0);
    let square = stopped(90.0, right, Corner::Straight)?;
    assert_ends(&square, &[[-10.0, -2.0], [10.0, -2.0], [12.0, -2.0], [12.0, 0.0], [12.0, 20.0]]);
    let round = stopped(90.0, right, Corner::Circular)?;
    assert_eq!(round[2].segment.shape, arc([10.0, 0.0], Direction::CounterClockwise));
    let back = stopped(180.0, right, Corner::Straight)?;
    let reach = [[-10.0, -2.0], [10.0, -2.0], [12.0, -2.0], [12.0, 2.0], [10.0, 2.0], [-10.0, 2.0]];
    assert_ends(&back, &reach);
    Ok(())
}

#[test]
fn changes_of_radius_and_side_join_the_normals() -> Outcome {
    let mut moves = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0], [0.0, 10.0]], LEFT);
    moves[2].side = Side::Left(3.0);
    let radius = run(Scheme::C, Corner::Circular, &moves)?;
    assert_ends(&radius, &[[-10.0, 2.0], [0.0, 2.0], [-3.0, 0.0], [-3.0, 10.0]]);
    moves[2].side = Side::Right(2.0);
    let side = run(Scheme::C, Corner::Circular, &moves)?;
    assert_ends(&side, &[[-10.0, 2.0], [0.0, 2.0], [2.0, 0.0], [2.0, 10.0]]);
    // Back on the same line on the other side, the tool stays on its line.
    let mut moves = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0], [-8.0, 0.0]], LEFT);
    moves[2].side = Side::Right(2.0);
    let back = run(Scheme::C, Corner::Circular, &moves)?;
    assert_ends(&back, &[[-10.0, 2.0], [0.0, 2.0], [-8.0, 2.0]]);
    Ok(())
}

#[test]
fn a_full_circle_with_tangent_ends_stays_a_full_circle() -> Outcome {
    // A centre that binary fractions do not meet exactly.
    let (center, angle) = ([0.1, 0.7], 0.3_f64);
    let start = [center[0] + 10.3 * angle.cos(), center[1] + 10.3 * angle.sin()];
    let tangent = [-angle.sin(), angle.cos()];
    let at = |along: f64| [start[0] + along * tangent[0], start[1] + along * tangent[1]];
    let circle = arc(center, Direction::CounterClockwise);
    for side in [LEFT, Side::Right(2.0)] {
        for scheme in [Scheme::B, Scheme::C] {
            let steps = [(at(-20.0), LINE), (start, LINE), (start, circle), (at(20.0), LINE)];
            let tool = run(scheme, Corner::Straight, &contour(at(-30.0), &steps, side))?;
            assert_joined(&tool);
            let round = tool.iter().find(|tool| tool.segment.shape == circle).map(|tool| tool.segment);
            let round = round.unwrap_or_else(|| panic!("no circle"));
            assert_eq!(round.from, round.to);
            let radius = if side == LEFT { 8.3 } else { 12.3 };
            assert!((distance(flat(round.from), center) - radius).abs() < 1e-9);
        }
    }
    Ok(())
}

#[test]
fn a_full_circle_between_walls_is_cut_short_at_both_ends() -> Outcome {
    let circle = arc([0.0, 10.0], Direction::CounterClockwise);
    let steps = [([-8.0, 8.0], LINE), ([0.0, 0.0], LINE), ([0.0, 0.0], circle), ([8.0, 8.0], LINE)];
    let moves = contour([-8.0, 12.0], &steps, LEFT);
    let tool = run(Scheme::C, Corner::Circular, &moves)?;
    assert_joined(&tool);
    let round = tool.iter().find(|tool| tool.segment.shape == circle).map(|tool| tool.segment);
    let round = round.unwrap_or_else(|| panic!("no circle"));
    let (from, to) = (flat(round.from), flat(round.to));
    // Lines at 45° through the corner, moved by 2 towards the middle: y = 2·√2 - x before the circle, y = 2·√2 + x
    // after it.
    for ([x, y], sign) in [(from, -1.0), (to, 1.0)] {
        assert!((distance([x, y], [0.0, 10.0]) - 8.0).abs() < 1e-9);
        assert!((y - (sign * x + 2.0 * SQRT_2)).abs() < 1e-9, "{x} {y}");
    }
    Ok(())
}

#[test]
fn every_plane_is_compensated_seen_from_its_third_axis() -> Outcome {
    let circle = |plane| SegmentShape::Arc { plane, center: [10.0, 10.0], direction: Direction::CounterClockwise };
    let flat_path = {
        let steps = [([0.0, 0.0], LINE), ([10.0, 0.0], LINE), ([20.0, 10.0], circle(Plane::Xy)), ([0.0, 10.0], LINE)];
        run(Scheme::C, Corner::Circular, &contour([-9.0, 0.0], &steps, LEFT))?
    };
    for plane in [Plane::Zx, Plane::Yz] {
        let point = |[x, y]: Vector, third: f64| plane.point([x, y, third]);
        let steps = [([0.0, 0.0], LINE), ([10.0, 0.0], LINE), ([20.0, 10.0], circle(plane)), ([0.0, 10.0], LINE)];
        let moves: Vec<Move> = contour([-9.0, 0.0], &steps, LEFT)
            .into_iter()
            .zip(0_i32..)
            .map(|(of, index)| {
                let (from, to) =
                    (point(flat(of.segment.from), f64::from(index)), point(flat(of.segment.to), f64::from(index + 1)));
                Move { segment: Segment { from, to, shape: of.segment.shape }, plane, ..of }
            })
            .collect();
        let tool = run(Scheme::C, Corner::Circular, &moves)?;
        assert_joined_in_space(&tool);
        let seen: Vec<[f64; 3]> = tool.iter().map(|tool| plane.of(tool.segment.to)).collect();
        let expected: Vec<[f64; 3]> =
            ends(&flat_path).into_iter().zip([1.0, 2.0, 3.0, 4.0]).map(|([u, v], third)| [u, v, third]).collect();
        assert_eq!(seen, expected);
        assert!(tool.iter().any(|tool| tool.segment.shape == circle(plane)));
    }
    Ok(())
}

fn assert_joined_in_space(moves: &[ToolMove]) {
    assert!(moves.windows(2).all(|pair| pair[0].segment.to == pair[1].segment.from));
}

#[test]
fn a_radius_of_0_keeps_the_contour() -> Outcome {
    for degrees in [0.0, 60.0, 150.0, -60.0, -150.0, 180.0] {
        for scheme in [Scheme::B, Scheme::C] {
            for round in [Corner::Straight, Corner::Circular] {
                let moves = turned(degrees, Side::Left(0.0));
                let tool = run(scheme, round, &moves)?;
                assert_ends(&tool, &moves.iter().map(|of| flat(of.segment.to)).collect::<Vec<_>>());
            }
        }
    }
    Ok(())
}

#[test]
fn an_arc_whose_corners_leave_nothing_of_it_does_not_become_a_full_circle() -> Outcome {
    // Walls along the radii at ±α inside a circle of radius 10; 2 off them the offset circle of radius 8 is met at 0°
    // where sin α = 2/8.
    for alpha in [0.25_f64.asin(), 0.25_f64.asin() + 1e-9, 0.25_f64.asin() - 1e-9] {
        let at = |radius: f64, sign: f64| [radius * alpha.cos(), sign * radius * alpha.sin()];
        let circle = arc([0.0; 2], Direction::CounterClockwise);
        let steps = [(at(5.0, -1.0), LINE), (at(10.0, -1.0), LINE), (at(10.0, 1.0), circle), (at(5.0, 1.0), LINE)];
        let tool = run(Scheme::C, Corner::Straight, &contour(at(1.0, -1.0), &steps, LEFT))?;
        assert_joined(&tool);
        assert!(tool.iter().all(|tool| tool.segment.shape == LINE));
        assert_near(ends(&tool)[1], [8.0, 0.0], 1e-7);
    }
    Ok(())
}
