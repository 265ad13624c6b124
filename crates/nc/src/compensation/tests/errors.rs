//! What cannot be compensated, and that nothing is put out then.

use super::CompensationErrorKind as Kind;
use super::*;

const LEFT: Side = Side::Left(2.0);
const LINE: SegmentShape = SegmentShape::Line;
const CCW: Direction = Direction::CounterClockwise;

/// The error of the last of these blocks, and that it put out nothing.
#[track_caller]
fn refused(moves: &[Move]) -> CompensationError {
    let (last, before) = moves.split_last().expect("blocks");
    let mut compensator = Compensator::new(Scheme::C, Corner::Straight);
    let mut out = Vec::new();
    for &block in before {
        compensator.push(block, &mut out).expect("good");
    }
    let put_out = out.len();
    let error = compensator.push(*last, &mut out).expect_err("refused");
    assert_eq!(out.len(), put_out);
    // Nothing has changed: it is refused again, for the same reason.
    assert_eq!(compensator.push(*last, &mut out).map_err(|error| error.place), Err(error.place));
    assert_eq!(out.len(), put_out);
    error
}

fn lines(start: Vector, ends: &[Vector]) -> Vec<Move> {
    contour(start, &ends.iter().map(|&end| (end, LINE)).collect::<Vec<_>>(), LEFT)
}

#[test]
fn a_block_that_would_run_backwards_is_named_with_the_next() {
    // A slot 3 wide with a tool of 4 across.
    let moves = lines([-20.0, 0.0], &[[-10.0, 0.0], [10.0, 0.0], [10.0, 3.0], [-10.0, 3.0]]);
    let error = refused(&moves);
    assert_eq!(error.kind, Kind::Reversed { radius: 2.0, length: 3.0, taken: 4.0 });
    assert_eq!((error.place.line, error.second.map(|place| place.line)), (3, Some(4)));
    assert_eq!(
        error.to_string(),
        "line 3 (N30) with line 4 (N40): tool radius of 2.000 BLU too large: the block is 3.000 BLU long and its corners \
         take 4.000 BLU from the tool's path, so that it would run backwards: take a smaller tool or leave the block out"
    );
    // One BLU wider, it turns on the spot.
    let wide = lines([-20.0, 0.0], &[[-10.0, 0.0], [10.0, 0.0], [10.0, 4.0], [-10.0, 4.0]]);
    assert!(run(Scheme::C, Corner::Straight, &wide).is_ok());
    // Without a next block the one before is named.
    let mut compensator = Compensator::new(Scheme::C, Corner::Straight);
    let mut out = Vec::new();
    for block in lines([-20.0, 0.0], &[[-10.0, 0.0], [10.0, 0.0], [10.0, 1.0]]) {
        compensator.push(block, &mut out).expect("good");
    }
    let put_out = out.len();
    let error = compensator.flush(&mut out).expect_err("refused");
    assert_eq!((error.place.line, error.second.map(|place| place.line), out.len()), (3, Some(2), put_out));
}

#[test]
fn an_arc_that_would_run_backwards_is_named() {
    // An eighth of a circle of radius 10 about (0, 10), with walls inside at both ends.
    let (sin, cos) = 0.3_f64.sin_cos();
    let end = [10.0 * sin, 10.0 - 10.0 * cos];
    let inwards = [end[0] - 9.0 * sin, end[1] + 9.0 * cos];
    let steps = [([0.0, 9.0], LINE), ([0.0, 0.0], LINE), (end, arc([0.0, 10.0], CCW)), (inwards, LINE)];
    let error = refused(&contour([-3.0, 9.0], &steps, LEFT));
    assert!(matches!(error.kind, Kind::Reversed { length, .. } if (length - 2.4).abs() < 1e-9), "{error}");
    assert_eq!((error.place.line, error.second.map(|place| place.line)), (3, Some(4)));
}

#[test]
fn a_tool_as_large_as_the_arc_around_it_is_refused_in_both_schemes() {
    let steps = [([10.0, 0.0], LINE), ([12.0, 2.0], arc([10.0, 2.0], CCW))];
    let moves = contour([0.0, 0.0], &steps, LEFT);
    let error = refused(&moves);
    assert_eq!(error.kind, Kind::InsideArc { arc: 2.0, radius: 2.0 });
    assert!(run(Scheme::B, Corner::Straight, &moves).is_err());
    assert_eq!(
        error.to_string(),
        "line 2 (N20): tool radius of 2.000 BLU too large: the tool is inside an arc of radius 2.000 BLU, which must be \
         larger than the tool: take a smaller tool or a larger arc"
    );
    // Outside there is room for every tool.
    let outside: Vec<Move> = moves.iter().map(|of| Move { side: Side::Right(2.0), ..*of }).collect();
    assert!(run(Scheme::C, Corner::Straight, &outside).is_ok());
}

#[test]
fn paths_that_do_not_meet_at_an_inside_corner_name_both_blocks() {
    // The offset circle has radius 0.5 about (2.5, 0), the offset line is y = -2.
    let steps = [([20.0, 0.0], LINE), ([0.0, 0.0], LINE), ([2.5, -2.5], arc([2.5, 0.0], CCW))];
    let error = refused(&contour([30.0, 0.0], &steps, LEFT));
    assert_eq!(error.kind, Kind::NoMeeting { radius: 2.0 });
    assert_eq!((error.place.line, error.second.map(|place| place.line)), (2, Some(3)));
    // Offset circles of radius 0.5 about (-2.5, 0) and (0, -2.5), which are 3.5 apart.
    let steps = [
        ([-20.0, -2.5], LINE),
        ([-2.5, -2.5], LINE),
        ([0.0, 0.0], arc([-2.5, 0.0], CCW)),
        ([-2.5, 2.5], arc([-2.5, 0.0], CCW)),
    ];
    assert!(run(Scheme::C, Corner::Straight, &contour([-30.0, -2.5], &steps, LEFT)).is_ok());
    let steps = [steps[0], steps[1], steps[2], ([0.0, -5.0], arc([0.0, -2.5], CCW))];
    let moves = contour([-30.0, -2.5], &steps, LEFT);
    let error = refused(&moves);
    assert_eq!(error.kind, Kind::NoMeeting { radius: 2.0 });
    assert_eq!((error.place.line, error.second.map(|place| place.line)), (3, Some(4)));
}

#[test]
fn a_cusp_that_closes_on_the_tool_is_refused_and_one_that_opens_is_rounded() {
    // Back from the origin above the line, where the tool is; or below it.
    let cusp = |center, direction, to| {
        contour([-40.0, 0.0], &[([-30.0, 0.0], LINE), ([0.0, 0.0], LINE), (to, arc(center, direction))], LEFT)
    };
    let error = refused(&cusp([0.0, 10.0], Direction::Clockwise, [-10.0, 10.0]));
    assert_eq!(error.kind, Kind::NoMeeting { radius: 2.0 });
    assert_eq!((error.place.line, error.second.map(|place| place.line)), (2, Some(3)));
    assert_eq!(
        error.to_string(),
        "line 2 (N20) with line 3 (N30): tool radius of 2.000 BLU too large: the paths of the tool's centre beside the \
         two blocks do not meet: take a smaller tool or open the corner"
    );
    let open = run(Scheme::C, Corner::Circular, &cusp([0.0, -10.0], CCW, [-10.0, -10.0])).expect("open");
    assert_eq!(open[2].segment.shape, arc([0.0, 0.0], Direction::Clockwise));
}

#[test]
fn compensation_starts_and_ends_on_straight_moves_of_at_least_the_radius() {
    let on_arc = refused(&[block(7, [10.0, 0.0], [0.0, 10.0], arc([0.0; 2], CCW), LEFT)]);
    assert_eq!((on_arc.place.line, on_arc.kind), (7, Kind::StartOnArc));
    let short = refused(&[block(7, [0.0; 2], [1.9, 0.0], LINE, LEFT)]);
    assert_eq!(short.kind, Kind::StartTooShort { length: 1.9, radius: 2.0 });
    assert_eq!(
        short.to_string(),
        "line 7 (N70): compensation starts on a move of 1.900 BLU in the plane, but at least the tool radius of 2.000 BLU \
         is needed: start farther off"
    );
    let on = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0]]);
    let with = |last: Move| refused(&[on.clone(), vec![last]].concat()).kind;
    assert_eq!(with(block(3, [0.0; 2], [0.0, 8.0], arc([0.0, 4.0], CCW), Side::On)), Kind::CancelOnArc);
    assert_eq!(with(block(3, [0.0; 2], [1.5, 0.0], LINE, Side::On)), Kind::CancelTooShort { length: 1.5, radius: 2.0 });
    assert!(run(Scheme::C, Corner::Straight, &[block(7, [0.0; 2], [2.0, 0.0], LINE, LEFT)]).is_ok());
}

#[test]
fn what_a_contour_cannot_be_is_refused() {
    let on = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0]]);
    let with = |last: Move| refused(&[on.clone(), vec![last]].concat()).kind;
    let line = block(3, [0.0; 2], [10.0, 0.0], LINE, LEFT);
    assert_eq!(with(Move { plane: Plane::Zx, ..line }), Kind::PlaneChange);
    assert_eq!(with(block(3, [0.0, 0.5], [10.0, 0.0], LINE, LEFT)), Kind::Apart { gap: 0.5 });
    assert_eq!(with(block(3, [0.0; 2], [10.0, 0.0], arc([0.0; 2], CCW), LEFT)), Kind::ArcOfNoRadius);
    let other = SegmentShape::Arc { plane: Plane::Yz, center: [0.0, 5.0], direction: CCW };
    assert_eq!(with(block(3, [0.0; 2], [0.0, 0.0], other, LEFT)), Kind::ArcInOtherPlane);
    let bent = block(3, [0.0; 2], [0.0, 10.0], arc([0.0, 5.0], CCW), Side::Right(2.0));
    assert_eq!(with(bent), Kind::SideChangeOnArc);
    for radius in [-1.0, f64::NAN, f64::INFINITY, 1e17] {
        let wrong = with(Move { side: Side::Left(radius), ..line });
        assert!(matches!(wrong, Kind::Radius { .. }), "{wrong}");
    }
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        for wrong in [
            block(3, [0.0; 2], [value, 0.0], LINE, LEFT),
            block(3, [0.0; 2], [0.0, 10.0], arc([0.0, value], CCW), LEFT),
            block(3, [0.0, value], [10.0, 0.0], LINE, Side::On),
        ] {
            assert!(matches!(with(wrong), Kind::Coordinate { .. }));
        }
    }
}

#[test]
fn a_circle_that_would_need_more_than_a_turn_is_refused() {
    // The tool is outside the circle, and both corners are outside corners: the path would overlap itself.
    let steps = [
        ([-20.0, 10.0], LINE),
        ([0.0, 0.0], LINE),
        ([0.0, 0.0], arc([0.0, 10.0], Direction::CounterClockwise)),
        ([20.0, 10.0], LINE),
    ];
    let moves = contour([-40.0, 20.0], &steps, Side::Right(2.0));
    let result = run(Scheme::C, Corner::Straight, &moves);
    assert!(matches!(result.map_err(|error| error.kind), Err(Kind::MoreThanATurn { turns }) if turns > 1.0));
}

#[test]
fn more_moves_along_the_third_axis_than_fit_are_refused() {
    let mut moves = lines([-20.0, 0.0], &[[-10.0, 0.0], [0.0, 0.0]]);
    for depth in 0..8 {
        let mut down = block(3, [0.0; 2], [0.0; 2], LINE, LEFT);
        down.segment.from[2] = -f64::from(depth);
        down.segment.to[2] = -f64::from(depth + 1);
        moves.push(down);
    }
    assert!(run(Scheme::C, Corner::Straight, &moves).is_ok());
    moves.push(moves[9]);
    assert_eq!(refused(&moves).kind, Kind::TooManyWithoutMotion);
}
