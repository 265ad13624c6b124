//! Comparison-integral.

use stepwave_engine::EngineKind;
use stepwave_models::options::{BEATS, WEIGHTS};
use stepwave_models::{Beats, Options, Weights};

use super::{arc, check, conics, every_lattice_arc, every_line, line, squares_below};
use crate::reference::{self, cim_arc, cim_conic, cim_line};

const RULES: [(Weights, reference::Weights); 3] = [
    (Weights::Mid, reference::Weights::Mid),
    (Weights::Pre, reference::Weights::Pre),
    (Weights::Post, reference::Weights::Post),
];

pub(super) fn check_line(from: [i64; 2], to: [i64; 2], beats: Beats, engine: EngineKind) {
    for (weights, _) in RULES {
        let choices = Options::default().with(&WEIGHTS, weights).with(&BEATS, beats);
        check("cim-line", &line(&from, &to), &choices, engine, &cim_line(from, to));
    }
}

pub(super) fn check_arc(
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    beats: Beats,
    engine: EngineKind,
) {
    for (weights, rule) in RULES {
        let choices = Options::default().with(&WEIGHTS, weights).with(&BEATS, beats);
        let table = cim_arc(from, to, center, clockwise, rule);
        check("cim-arc", &arc(from, to, center, clockwise), &choices, engine, &table);
    }
}

fn check_conic(case: &conics::Case, beats: Beats, engine: EngineKind) {
    for (weights, rule) in RULES {
        let choices = Options::default().with(&WEIGHTS, weights).with(&BEATS, beats);
        let table = cim_conic(case.shape, case.from, case.to, case.center, case.clockwise, rule);
        check("cim-conic", &case.curve(), &choices, engine, &table);
    }
}

#[test]
fn every_line_of_up_to_five_bits_in_every_quadrant() {
    every_line(5, |to| check_line([0, 0], to, Beats::One, EngineKind::Word));
}

#[test]
#[ignore = "exhaustive"]
fn every_lattice_arc_and_full_circle_of_a_radius_below_30_by_every_weight_rule() {
    every_lattice_arc(&squares_below(900), |from, to, clockwise| {
        check_arc(from, to, [0, 0], clockwise, Beats::One, EngineKind::Word);
    });
}

#[test]
fn every_quarter_ellipse_with_semi_axes_below_14() {
    conics::every_quarter_ellipse(14, |case| check_conic(case, Beats::One, EngineKind::Word));
}

#[test]
#[ignore = "exhaustive"]
fn every_quarter_ellipse_with_semi_axes_below_30() {
    conics::every_quarter_ellipse(30, |case| check_conic(case, Beats::One, EngineKind::Word));
}

#[test]
fn conics_of_every_shape_and_orientation() {
    conics::various().iter().for_each(|case| check_conic(case, Beats::One, EngineKind::Word));
}

#[test]
#[ignore = "exhaustive"]
fn lines_arcs_and_conics_in_four_beats_on_every_engine_from_a_translated_start() {
    for engine in EngineKind::ALL {
        for to in [[5, 3], [-3, 7], [-6, -6], [4, 0], [0, -5]] {
            check_line([3, -2], [3 + to[0], to[1] - 2], Beats::Four, engine);
        }
        for (from, to) in [([5, 0], [0, 5]), ([3, 4], [-4, 3]), ([5, 5], [5, 5])] {
            let moved = |[x, y]: [i64; 2]| [x + 40, y - 7];
            check_arc(moved(from), moved(to), [40, -7], from[1] == 0, Beats::Four, engine);
        }
        conics::various().iter().step_by(5).for_each(|case| check_conic(&case.moved([9, -30]), Beats::Four, engine));
    }
}

#[test]
fn an_end_point_off_the_circle_is_reached() {
    for clockwise in [true, false] {
        for to in [[0, 6], [4, 4], [-3, 5], [-6, 0], [-4, -4], [2, -5], [6, 0], [5, 2]] {
            check_arc([5, 1], to, [0, 0], clockwise, Beats::One, EngineKind::Word);
        }
    }
}
