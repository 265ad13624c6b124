//! The comparison-integral part.

use stepwave_nc::{Arc, Curve, Direction};
use stepwave_netlist::dsl::Scope;

use super::super::{Block, Change, Side, comparison_integral};
use super::bench::on_every_engine;
use crate::options::{BEATS, WEIGHTS};
use crate::{Beats, Hardware, Options, Weights, find};

fn hardware(weights: Weights) -> Hardware {
    let arc = Curve::Arc(Arc::new([7, 0], [0, 7], [0, 0], Direction::CounterClockwise).unwrap());
    let options = Options::default().with(&WEIGHTS, weights).with(&BEATS, Beats::One);
    find("cim-arc").unwrap().plan(&arc, &options).unwrap()
}

/// In the first quadrant, counter-clockwise: the weight of x shrinks, that of y grows.
fn part(m: Scope<'_>, weights: Weights) {
    let block = Block::new(m);
    let change = |grows| Some(Change { grows: m.lit(1, grows), unit: m.lit(1, 1) });
    let sides = [Side { negative: m.lit(1, 1), change: change(0) }, Side { negative: m.lit(1, 0), change: change(1) }];
    comparison_integral(m, block, &hardware(weights), sides);
}

#[test]
fn the_base_axis_steps_always_and_changes_with_the_sign_of_f() {
    // From (5, 0) to (0, 5): A 5 4 4 4 3 2 1 0, B 0 1 2 3 4 5 5 5 in each.
    let columns: [(Weights, &[i128]); 3] = [
        // 0; XY +1 -9; Y +3; Y +5; XY +7 -7, then F := -F; X +5, Y -9; X +3; X +1.
        (Weights::Mid, &[0, 0, -8, -5, 0, 0, -4, -1, 0]),
        // 0; XY 0 -5; Y +1; Y +2; Y +3.
        (Weights::Pre, &[0, 0, -5, -4, -2, 1]),
        // 0; XY +1 -4; Y +2; Y +3; XY +4 -3.
        (Weights::Post, &[0, 0, -3, -1, 2]),
    ];
    for (weights, deviations) in columns {
        on_every_engine(
            |m| part(m, weights),
            |bench| {
                bench.play(&[
                    ("load", "1000_0000_0000"),
                    ("a_in", "5555_5555_5555"),
                    ("b_in", "0000_0000_0000"),
                    ("ex_in", "5555_5555_5555"),
                    ("ey_in", "5555_5555_5555"),
                ]);
                assert_eq!(bench.numbers("f")[..deviations.len()], *deviations, "{weights:?}");
                if weights == Weights::Mid {
                    assert_eq!(bench.row("a"), "0544_4321_0000");
                    assert_eq!(bench.row("b"), "0012_3455_5555");
                    assert_eq!(bench.row("base"), "0111_1000_0000");
                    assert_eq!(bench.row("ey"), "0543_2100_0000");
                }
            },
        );
    }
}

#[test]
fn a_tie_at_the_load_takes_y_and_an_exhausted_base_axis_is_inhibited() {
    on_every_engine(
        |m| part(m, Weights::Pre),
        |bench| {
            bench.play(&[
                ("load", "1000_0000"),
                ("a_in", "3333_3333"),
                ("b_in", "3333_3333"),
                ("ex_in", "3333_3333"),
                ("ey_in", "1111_1111"),
            ]);
            // X and Y at the first step, then X alone, though Y had been the base axis.
            assert_eq!(bench.row("base"), "0100_0000");
            assert_eq!(bench.row("ex"), "0321_0000");
            assert_eq!(bench.row("ey"), "0100_0000");
            assert_eq!(bench.row("done"), "0000_1111");
        },
    );
}
