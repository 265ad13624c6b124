//! Random contours.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::corners::{LONG, Piece, assert_clear, corner};
use super::*;

fn config() -> ProptestConfig {
    let rng_seed = RngSeed::Fixed(0x57e9);
    ProptestConfig { failure_persistence: None, rng_seed, ..ProptestConfig::with_cases(2000) }
}

fn piece() -> impl Strategy<Value = Piece> {
    let bend = prop_oneof![Just(0.0), Just(1.0), Just(-1.0)];
    (bend, 15.0..60.0, 0.2..0.5).prop_map(|(bend, radius, sweep)| Piece { bend, radius, sweep })
}

/// Lines and arcs of any size, some of them senseless.
fn any_block() -> impl Strategy<Value = (Vector, f64, Option<Direction>, Side, f64)> {
    let number = || prop_oneof![-50.0..50.0, Just(0.0), Just(10.0), -1e15..1e15, Just(f64::NAN), Just(f64::MAX)];
    let ordinary = || prop_oneof![8 => (-5_i32..5).prop_map(f64::from), 1 => number()];
    let direction = prop_oneof![Just(None), Just(Some(Direction::Clockwise)), Just(Some(Direction::CounterClockwise))];
    let side = prop_oneof![
        2 => Just(Side::On),
        8 => Just(Side::Left(0.5)),
        2 => Just(Side::Right(0.5)),
        1 => number().prop_map(Side::Left)
    ];
    ([ordinary(), ordinary()], ordinary(), direction, side, ordinary())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_random_corner_keeps_the_tool_off_both_blocks(
        leaving in piece(), entering in piece(), turn in -1.5..2.1_f64,
        left: bool, radius in 0.01..1.0_f64, circular: bool,
    ) {
        // A positive turn is outside. With both arcs it stays below half a turn, so that the far ends keep apart.
        let (turn, side) = if left { (-turn, Side::Left(radius)) } else { (turn, Side::Right(radius)) };
        let moves = corner(leaving, entering, turn, side);
        let round = if circular { Corner::Circular } else { Corner::Straight };
        match run(Scheme::C, round, &moves) {
            Ok(tool) => {
                assert_joined(&tool);
                assert_clear(&tool[1..], &moves[1..], radius);
                // No farther off than a corner of a quarter turn leads, but for arcs that bend away under the tool.
                for point in tool[1..].iter().flat_map(|tool| samples(&tool.segment)) {
                    let off = moves[1..].iter().map(|of| clearance(point, &of.segment)).fold(LONG, f64::min);
                    prop_assert!(off < 1.6 * radius, "{} off", off / radius);
                }
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn whatever_comes_in_finite_numbers_come_out_joined(
        blocks in prop::collection::vec(any_block(), 1..12), circular: bool, c: bool,
    ) {
        let round = if circular { Corner::Circular } else { Corner::Straight };
        let mut compensator = Compensator::new(if c { Scheme::C } else { Scheme::B }, round);
        let (mut out, mut from) = (Vec::new(), [0.0, 0.0, 0.0]);
        for (to, third, direction, side, bend) in blocks {
            let shape = direction.map_or(SegmentShape::Line, |direction| arc([from[0] + bend, from[1] + 1.0], direction));
            let to = [to[0], to[1], third];
            let mut of = block(1, [0.0; 2], [0.0; 2], shape, side);
            of.segment = Segment { from, to, shape };
            let count = out.len();
            if compensator.push(of, &mut out).is_ok() {
                from = to;
            } else {
                prop_assert_eq!(out.len(), count);
            }
        }
        let _ = compensator.flush(&mut out);
        for tool in &out {
            prop_assert!(tool.segment.from.iter().chain(&tool.segment.to).all(|value| value.is_finite()));
        }
        prop_assert!(out.windows(2).all(|pair| pair[0].segment.to == pair[1].segment.from));
    }
}
