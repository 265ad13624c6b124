//! Minimum deviation and vector discrimination.

use stepwave_engine::EngineKind;
use stepwave_models::options::{BEATS, END_POINT};
use stepwave_models::{Beats, EndPoint, Options};

use super::{arc, check, every_lattice_arc, every_line, line, some_below_30, squares_below};
use crate::reference::{self, Table, mindev_arc, mindev_line, vector_arc, vector_line};

type LineTable = fn([i64; 2], [i64; 2]) -> Table;
type ArcTable = fn([i64; 2], [i64; 2], [i64; 2], bool, reference::EndPoint) -> Table;

const LINES: [(&str, LineTable); 2] = [("mindev-line", mindev_line), ("vector-line", vector_line)];
const ARCS: [(&str, ArcTable); 2] = [("mindev-arc", mindev_arc), ("vector-arc", vector_arc)];
const ENDS: [(EndPoint, reference::EndPoint); 2] =
    [(EndPoint::Total, reference::EndPoint::Total), (EndPoint::PerAxis, reference::EndPoint::PerAxis)];

pub(super) fn check_line(from: [i64; 2], to: [i64; 2], beats: Beats, engine: EngineKind) {
    for (model, table) in LINES {
        let choices = Options::default().with(&BEATS, beats);
        check(model, &line(&from, &to), &choices, engine, &table(from, to));
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
    for (model, table) in ARCS {
        for (end_point, end_reference) in ENDS {
            let choices = Options::default().with(&END_POINT, end_point).with(&BEATS, beats);
            let table = table(from, to, center, clockwise, end_reference);
            check(model, &arc(from, to, center, clockwise), &choices, engine, &table);
        }
    }
}

#[test]
fn every_line_of_up_to_five_bits_in_every_quadrant() {
    every_line(5, |to| check_line([0, 0], to, Beats::One, EngineKind::Word));
}

fn check_lattice_arcs(squares: &[i64]) {
    every_lattice_arc(squares, |from, to, clockwise| {
        check_arc(from, to, [0, 0], clockwise, Beats::One, EngineKind::Word);
    });
}

#[test]
fn every_lattice_arc_and_full_circle_of_a_radius_below_14_and_of_some_below_30() {
    check_lattice_arcs(&some_below_30());
}

#[test]
#[ignore = "exhaustive"]
fn every_lattice_arc_and_full_circle_of_a_radius_below_30() {
    check_lattice_arcs(&squares_below(900));
}

#[test]
fn lines_and_arcs_in_four_beats_on_every_engine_from_a_translated_start() {
    for engine in EngineKind::ALL {
        for to in [[5, 3], [-3, 7], [-6, -6], [4, 0], [0, -5], [1, -9]] {
            check_line([3, -2], [3 + to[0], to[1] - 2], Beats::Four, engine);
        }
        for (from, to) in [([5, 0], [0, 5]), ([3, 4], [-4, 3]), ([1, 0], [0, -1]), ([5, 5], [5, 5])] {
            let moved = |[x, y]: [i64; 2]| [x + 40, y - 7];
            check_arc(moved(from), moved(to), [40, -7], from[1] == 0, Beats::Four, engine);
        }
    }
}

#[test]
fn an_end_point_off_the_circle_is_reached_with_a_counter_for_each_axis() {
    for (model, table) in ARCS {
        for clockwise in [true, false] {
            for to in [[0, 6], [4, 4], [-3, 5], [-6, 0], [-4, -4], [2, -5], [6, 0], [5, 2]] {
                let table = table([5, 1], to, [0, 0], clockwise, reference::EndPoint::PerAxis);
                let choices = Options::default().with(&BEATS, Beats::One);
                check(model, &arc([5, 1], to, [0, 0], clockwise), &choices, EngineKind::Word, &table);
            }
        }
    }
}
