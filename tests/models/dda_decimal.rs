//! Digital differential analyser in radix 10.

use std::ops::RangeInclusive;

use rayon::prelude::*;
use stepwave::testbench::Ending;
use stepwave_engine::EngineKind;
use stepwave_models::options::{ADDER, RADIX};
use stepwave_models::{Adder, EndPoint, Options, Preset, Radix};

use super::dda::{END_POINTS, choices};
use super::{check, line, run};
use crate::reference::{self, dda_line_decimal};

const PRESETS: [Preset; 4] = [Preset::Zero, Preset::Half, Preset::Full, Preset::Value(7)];

fn preset_value(preset: Preset, digits: u32) -> i64 {
    match preset {
        Preset::Zero => 0,
        Preset::Half => 5 * 10_i64.pow(digits - 1),
        Preset::Full => 10_i64.pow(digits) - 1,
        Preset::Value(value) => i64::try_from(value).unwrap(),
    }
}

/// Radix 10 with this many digits, 4 bits each.
fn decimal(digits: u32, preset: Preset, end_point: EndPoint, adder: Adder) -> Options {
    let radix = Some(Radix::Decimal);
    choices(4 * digits, preset, false, end_point).with(&RADIX, radix).with(&ADDER, adder)
}

fn check_decimal(
    digits: u32,
    [from, to]: [&[i64]; 2],
    preset: Preset,
    (end_point, end_reference): (EndPoint, reference::EndPoint),
    adder: Adder,
    engine: EngineKind,
) {
    let presets = vec![preset_value(preset, digits); from.len()];
    let table = dda_line_decimal(digits, from, to, &presets, end_reference);
    check("dda-line", &line(from, to), &decimal(digits, preset, end_point, adder), engine, &table);
}

#[test]
fn the_worked_line_in_one_digit_to_the_digit_from_every_engine() {
    for engine in EngineKind::ALL {
        for adder in [Adder::Parallel, Adder::Serial] {
            let choices = Options::default().with(&ADDER, adder).with(&RADIX, Radix::Decimal);
            let ran = run("dda-line", &line(&[0, 0], &[8, 6]), &choices, engine);
            assert_eq!((ran.outcome.ending, &ran.outcome.reached[..]), (Ending::Done, &[8, 6][..]));
            let column = |name: &str| -> Vec<i64> {
                let index = ran.columns.iter().position(|column| column == name).unwrap();
                ran.rows.iter().map(|row| row[index]).collect()
            };
            let pulses = |name: &str| -> Vec<usize> {
                let column = column(name);
                (0..column.len()).filter(|&step| column[step] == 1).collect()
            };
            assert_eq!(column("jrx")[1..], [8, 6, 4, 2, 0, 8, 6, 4, 2, 0]);
            assert_eq!(column("jry")[1..], [6, 2, 8, 4, 0, 6, 2, 8, 4, 0]);
            assert_eq!(pulses("dx"), [2, 3, 4, 5, 7, 8, 9, 10]);
            assert_eq!(pulses("dy"), [2, 4, 5, 7, 9, 10]);
            assert_eq!(column("e"), [10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0]);
        }
    }
}

#[test]
fn every_line_of_one_digit_of_a_quadrant_with_every_preset_scheme_and_adder() {
    check_lines_of_one_digit(0..=9);
}

#[test]
#[ignore = "exhaustive"]
fn every_line_of_one_digit_with_every_preset_scheme_and_adder() {
    check_lines_of_one_digit(-9..=9);
}

fn check_lines_of_one_digit(places: RangeInclusive<i64>) {
    places.clone().into_par_iter().for_each(|x| {
        for y in places.clone().filter(|&y| [x, y] != [0, 0]) {
            for (ends, preset) in END_POINTS.into_iter().flat_map(|ends| PRESETS.map(|preset| (ends, preset))) {
                for adder in [Adder::Parallel, Adder::Serial] {
                    check_decimal(1, [&[0, 0], &[x, y]], preset, ends, adder, EngineKind::Word);
                }
            }
        }
    });
}

#[test]
fn every_fifth_column_of_lines_of_two_digits() {
    check_lines_of_two_digits(5);
}

#[test]
#[ignore = "exhaustive"]
fn every_line_of_two_digits() {
    check_lines_of_two_digits(1);
}

fn check_lines_of_two_digits(every: usize) {
    let columns: Vec<i64> = (-99..=99).step_by(every).collect();
    columns.into_par_iter().for_each(|x| {
        for y in (-99..=99).filter(|&y| [x, y] != [0, 0]) {
            // Each scheme and each preset with every fourth line.
            let which = |of: i64| usize::try_from(of.rem_euclid(4)).unwrap();
            let (ends, preset) = (END_POINTS[which(x + y)], PRESETS[which(x + 2 * y)]);
            check_decimal(2, [&[0, 0], &[x, y]], preset, ends, Adder::Parallel, EngineKind::Word);
            if y % 9 == 0 {
                check_decimal(2, [&[0, 0], &[x, y]], preset, ends, Adder::Serial, EngineKind::Word);
            }
        }
    });
}

#[test]
fn decimal_lines_of_up_to_six_axes_on_every_engine() {
    for engine in EngineKind::ALL {
        for (ends, adder) in END_POINTS.into_iter().zip([Adder::Parallel, Adder::Serial].into_iter().cycle()) {
            check_decimal(1, [&[1, -1, 5], &[4, -8, 5]], Preset::Zero, ends, adder, engine);
            check_decimal(2, [&[0; 6], &[10, -29, 38, -47, 56, -65]], Preset::Half, ends, adder, engine);
            check_decimal(3, [&[-400, 7], &[500, 128]], Preset::Full, ends, adder, engine);
        }
    }
}
