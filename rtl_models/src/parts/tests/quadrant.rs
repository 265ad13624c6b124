//! Quadrant logic against the sign tables of the textbooks, typed in as printed.

use stepwave_netlist::cells::Format;

use super::super::{ArcKind, next_quadrant, quadrant_register, x_grows};
use super::bench::{Bench, on_every_engine};

/// Point-by-point comparison: the move where F >= 0, towards the centre, and where F < 0, away from it.
const MOVES: [(&str, &str, &str); 8] = [
    ("SR1", "-Y", "+X"),
    ("SR2", "+X", "+Y"),
    ("SR3", "+Y", "-X"),
    ("SR4", "-X", "-Y"),
    ("NR1", "-X", "+Y"),
    ("NR2", "-Y", "-X"),
    ("NR3", "+X", "-Y"),
    ("NR4", "+Y", "+X"),
];

/// Digital differential analyser: the kinds, and below them correction of J_VX (which is |y|) on a Y pulse, correction
/// of J_VY (which is |x|) on an X pulse, direction of X, direction of Y.
const INTEGRANDS: [[&str; 8]; 5] = [
    ["SR1", "SR2", "SR3", "SR4", "NR1", "NR2", "NR3", "NR4"],
    ["-1", "+1", "-1", "+1", "+1", "-1", "+1", "-1"],
    ["+1", "-1", "+1", "-1", "-1", "+1", "-1", "+1"],
    ["+", "+", "-", "-", "-", "-", "+", "+"],
    ["-", "+", "+", "-", "+", "-", "-", "+"],
];

/// Puts each kind on the inputs and hands over its textbook name.
fn for_every_kind(check: impl Fn(&Bench, &str)) {
    on_every_engine(
        |m| {
            let (quadrant, counter_clockwise) = (m.input("quadrant", 2), m.input("ccw", 1));
            let _ = ArcKind::decode(m, quadrant, counter_clockwise);
            m.name("next", next_quadrant(m, quadrant, counter_clockwise));
            m.name("grows", x_grows(quadrant, counter_clockwise));
        },
        |bench| {
            for (ccw, letter) in [(0, 'S'), (1, 'N')] {
                for quadrant in 0..4 {
                    bench.clock(&[("quadrant", quadrant), ("ccw", ccw)]);
                    check(bench, &format!("{letter}R{}", quadrant + 1));
                }
            }
        },
    );
}

/// What the wave shows of a net with named states.
fn shown<'b>(bench: &'b Bench, name: &str) -> &'b str {
    let Format::States(states) = &bench.design().netlist().find(name).unwrap().format else { panic!("{name}") };
    let state = states.iter().find(|(value, _)| i128::from(*value) == bench.value(name));
    &state.unwrap().1
}

#[test]
fn every_kind_moves_as_the_table_of_point_by_point_comparison_says() {
    for_every_kind(|bench, kind| {
        let (_, inwards, outwards) = MOVES.iter().find(|(name, ..)| *name == kind).unwrap();
        assert_eq!(bench.value("x_grows"), i128::from(outwards.ends_with('X')), "{kind}");
        assert_eq!(bench.value("grows"), bench.value("x_grows"), "{kind}");
        let axis = |letter| if inwards.ends_with(letter) { inwards } else { outwards };
        assert_eq!(bench.value("x_negative"), i128::from(axis('X').starts_with('-')), "{kind}");
        assert_eq!(bench.value("y_negative"), i128::from(axis('Y').starts_with('-')), "{kind}");
    });
}

#[test]
fn every_kind_corrects_and_moves_as_the_table_of_the_analyser_says() {
    for_every_kind(|bench, kind| {
        let column = INTEGRANDS[0].iter().position(|name| *name == kind).unwrap();
        let [jvx, jvy, x, y] = [1, 2, 3, 4].map(|row| INTEGRANDS[row][column]);
        assert_eq!(bench.value("x_grows"), i128::from(jvy == "+1"), "{kind}");
        assert_eq!(bench.value("x_grows"), i128::from(jvx == "-1"), "{kind}");
        assert_eq!(bench.value("x_negative"), i128::from(x == "-"), "{kind}");
        assert_eq!(bench.value("y_negative"), i128::from(y == "-"), "{kind}");
    });
}

#[test]
fn the_wave_shows_every_kind_by_its_textbook_name() {
    for_every_kind(|bench, kind| assert_eq!(shown(bench, "kind"), kind));
}

#[test]
fn the_quadrant_register_holds_a_quadrant_and_the_wave_shows_it_by_its_number() {
    on_every_engine(
        |m| quadrant_register(m).set(m.input("quadrant", 2)),
        |bench| {
            for (quadrant, name) in (0..).zip(["Q1", "Q2", "Q3", "Q4"]) {
                bench.clock(&[("quadrant", quadrant)]);
                bench.clock(&[]);
                assert_eq!((bench.value("quad"), shown(bench, "quad")), (quadrant, name));
            }
        },
    );
}

#[test]
fn a_clockwise_arc_goes_back_through_the_quadrants_and_the_other_forwards() {
    for_every_kind(|bench, kind| {
        let next = match kind {
            "NR1" | "SR3" => 2,
            "NR2" | "SR4" => 3,
            "NR3" | "SR1" => 4,
            _ => 1,
        };
        assert_eq!(bench.value("next") + 1, next, "after {kind}");
    });
}
