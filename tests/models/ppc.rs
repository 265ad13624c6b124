//! Point-by-point comparison.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::options::{BEATS, END_POINT, FORM};
use stepwave_models::{Beats, EndPoint, Form, Options};

use super::{arc, check, every_lattice_arc, every_line, lattice, line, some_below_30, squares_below};
use crate::reference::{self, ppc_arc, ppc_line};

const END_POINTS: [(EndPoint, reference::EndPoint); 3] = [
    (EndPoint::Total, reference::EndPoint::Total),
    (EndPoint::PerAxis, reference::EndPoint::PerAxis),
    (EndPoint::Longest, reference::EndPoint::Longest),
];
const FORMS: [(Form, reference::Form); 2] =
    [(Form::Magnitude, reference::Form::Magnitude), (Form::Signed, reference::Form::Signed)];

fn choices(end_point: EndPoint, form: Option<Form>, beats: Beats) -> Options {
    Options::default().with(&END_POINT, end_point).with(&FORM, form).with(&BEATS, beats)
}

/// Every form and end-point scheme of one line.
fn check_line(from: [i64; 2], to: [i64; 2], beats: Beats, engine: EngineKind) {
    for (end_point, end_reference) in END_POINTS {
        for (form, form_reference) in FORMS {
            let table = ppc_line(from, to, form_reference, end_reference);
            check("ppc-line", &line(&from, &to), &choices(end_point, Some(form), beats), engine, &table);
        }
    }
}

fn check_arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool, beats: Beats, engine: EngineKind) {
    for (end_point, end_reference) in &END_POINTS[..2] {
        let table = ppc_arc(from, to, center, clockwise, *end_reference);
        check("ppc-arc", &arc(from, to, center, clockwise), &choices(*end_point, None, beats), engine, &table);
    }
}

#[test]
fn every_line_of_up_to_five_bits_in_every_quadrant_form_and_scheme() {
    every_line(5, |to| check_line([0, 0], to, Beats::One, EngineKind::Word));
}

#[test]
fn every_line_of_up_to_three_bits_in_four_beats_on_every_engine_from_a_translated_start() {
    for x in -7..=7 {
        for y in -7..=7 {
            if [x, y] != [0, 0] {
                check_line([3, -2], [3 + x, y - 2], Beats::Four, EngineKind::Word);
                if x.rem_euclid(3) == 0 {
                    check_line([3, -2], [3 + x, y - 2], Beats::Four, EngineKind::Gates);
                }
            }
        }
    }
}

fn check_lattice_arcs(squares: &[i64]) {
    every_lattice_arc(squares, |from, to, clockwise| {
        check_arc(from, to, [0, 0], clockwise, Beats::One, EngineKind::Word);
    });
}

#[test]
fn every_lattice_arc_and_full_circle_of_a_radius_below_14_and_of_some_below_30_in_both_directions() {
    check_lattice_arcs(&some_below_30());
}

#[test]
#[ignore = "exhaustive"]
fn every_lattice_arc_and_full_circle_of_a_radius_below_30_in_both_directions() {
    check_lattice_arcs(&squares_below(900));
}

#[test]
fn arcs_in_four_beats_about_a_translated_centre_on_every_engine() {
    for r2 in [1, 2, 5, 25, 34] {
        let points = lattice(r2);
        for (index, &[x, y]) in points.iter().enumerate() {
            let [tx, ty] = points[(index * 5 + 3) % points.len()];
            for engine in EngineKind::ALL {
                let (from, to) = ([x + 40, y - 7], [tx + 40, ty - 7]);
                check_arc(from, to, [40, -7], index % 2 == 0, Beats::Four, engine);
            }
        }
    }
}

#[test]
fn an_end_point_off_the_circle_is_reached_with_a_counter_for_each_axis() {
    let mut off_circle = 0;
    for from in lattice(50) {
        for x in -8..=8i64 {
            for y in -8..=8i64 {
                let radius = f64::from(i32::try_from(x * x + y * y).unwrap()).sqrt();
                let near = (radius - 50f64.sqrt()).abs() <= 1.0;
                if near && x * x + y * y != 50 {
                    off_circle += 1;
                    let table = ppc_arc(from, [x, y], [0, 0], true, reference::EndPoint::PerAxis);
                    let choices = Options::default().with(&BEATS, Beats::One);
                    check("ppc-arc", &arc(from, [x, y], [0, 0], true), &choices, EngineKind::Word, &table);
                }
            }
        }
    }
    assert!(off_circle > 500, "{off_circle}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lines_of_any_size(from in prop::array::uniform2(-100_000i64..100_000), d in prop::array::uniform2(-3000i64..3000)) {
        prop_assume!(d != [0, 0]);
        let to = [from[0] + d[0], from[1] + d[1]];
        check_line(from, to, Beats::One, EngineKind::Word);
    }

    #[test]
    fn full_circles_of_any_size(start in prop::array::uniform2(-400i64..400), clockwise: bool) {
        prop_assume!(start != [0, 0]);
        check_arc(start, start, [0, 0], clockwise, Beats::Four, EngineKind::Word);
    }
}
