//! Digital pulse multiplier.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::options::{CASCADE, NORMALIZE, OVERRIDE, RADIX, WIDTH};
use stepwave_models::{ModelError, Options, Radix, find};
use stepwave_netlist::Width;

use super::{check, line, run};
use crate::reference::{dpm_line, dpm_line_cascade, dpm_line_decade, dpm_line_override};

const NAME: &str = "dpm-line";

fn width(bits: u32) -> Option<Width> {
    Some(Width::new(u64::from(bits)).unwrap())
}

fn check_line(n: u32, from: &[i64], to: &[i64], engine: EngineKind) {
    let choices = Options::default().with_all(&WIDTH, width(n));
    check(NAME, &line(from, to), &choices, engine, &dpm_line(n, from, to));
}

fn check_cascade(units: u32, bits: u32, from: &[i64], to: &[i64], engine: EngineKind) {
    let choices = Options::default().with_all(&WIDTH, width(units * bits)).with(&CASCADE, width(bits));
    check(NAME, &line(from, to), &choices, engine, &dpm_line_cascade(units, bits, from, to));
}

fn check_decades(digits: u32, from: &[i64], to: &[i64], engine: EngineKind) {
    let choices = Options::default().with_all(&WIDTH, width(4 * digits)).with(&RADIX, Radix::Decimal);
    check(NAME, &line(from, to), &choices, engine, &dpm_line_decade(digits, from, to));
}

/// The columns `clock` and `o` of the reference are compared too.
fn check_override(n: u32, from: &[i64], to: &[i64], percent: u64, engine: EngineKind) {
    let choices = Options::default().with_all(&WIDTH, width(n)).with(&OVERRIDE, Some(percent));
    let table = dpm_line_override(n, from, to, i64::try_from(percent).unwrap());
    check(NAME, &line(from, to), &choices, engine, &table);
}

/// Every end point in the plane with coordinates below `limit`, but the start.
fn every_end(limit: i64, check: impl Fn([i64; 2])) {
    let ends = (1 - limit..limit).flat_map(|x| (1 - limit..limit).map(move |y| [x, y]));
    ends.filter(|&end| end != [0, 0]).for_each(check);
}

/// Numbers of the steps with a pulse of this column.
fn pulses(rows: &[Vec<i64>], columns: &[String], name: &str) -> Vec<usize> {
    let column = columns.iter().position(|column| column == name).unwrap();
    (0..rows.len()).filter(|&row| rows[row][column] != 0).collect()
}

#[test]
fn every_line_in_every_quadrant_in_1_to_5_bits() {
    for n in 1..=5 {
        every_end(1 << n, |to| check_line(n, &[0, 0], &to, EngineKind::Word));
    }
}

#[test]
fn the_worked_line_on_every_engine() {
    for engine in EngineKind::ALL {
        let choices = Options::default().with_all(&WIDTH, width(3));
        let ran = run(NAME, &line(&[0, 0], &[5, 3]), &choices, engine);
        assert_eq!(pulses(&ran.rows, &ran.columns, "dx"), [1, 3, 4, 5, 7]);
        assert_eq!(pulses(&ran.rows, &ran.columns, "dy"), [2, 4, 6]);
        assert_eq!((ran.outcome.steps, ran.outcome.clocks), (8, 9));
    }
}

#[test]
fn lines_of_up_to_six_axes_on_every_engine() {
    for engine in EngineKind::ALL {
        check_line(3, &[4, -1], &[-1, 5], engine);
        check_line(4, &[1, -1, 5], &[4, -8, -10], engine);
        check_line(4, &[0; 4], &[15, -15, 0, 1], engine);
        check_line(3, &[0; 6], &[1, -2, 3, -4, 5, -6], engine);
    }
}

#[test]
fn every_cascade_of_up_to_5_bits_in_all() {
    for (units, bits) in [(1, 4), (2, 1), (3, 1), (5, 1), (2, 2)] {
        every_end(1 << (units * bits), |to| check_cascade(units, bits, &[0, 0], &to, EngineKind::Word));
    }
    for engine in EngineKind::ALL {
        check_cascade(3, 2, &[2, 0, -7], &[61, -33, -8], engine);
        check_cascade(2, 4, &[0, 0], &[171, -86], engine);
        check_cascade(1, 4, &[0, 0], &[11, 6], engine);
    }
}

#[test]
fn every_line_of_one_decade_and_some_of_more_on_every_engine() {
    every_end(10, |to| check_decades(1, &[0, 0], &to, EngineKind::Word));
    for engine in EngineKind::ALL {
        check_decades(1, &[3, 3], &[11, -3], engine);
        check_decades(2, &[0, 0, 0], &[42, -99, 10], engine);
        check_decades(3, &[-4, 0], &[995, -705], engine);
    }
}

#[test]
fn every_feed_override_of_a_line() {
    for percent in 1..=99 {
        check_override(3, &[0, 0], &[5, -3], percent, EngineKind::Word);
    }
    for engine in EngineKind::ALL {
        for percent in [1, 10, 50, 99] {
            check_override(4, &[1, 2, 3], &[12, -13, 3], percent, engine);
        }
    }
}

#[test]
fn the_feed_override_comes_before_decades_and_cascades_as_before_one_unit() {
    for (choices, to) in [
        (Options::default().with(&RADIX, Radix::Decimal), [74, -38]),
        (Options::default().with(&CASCADE, width(3)), [51, -8]),
    ] {
        let usual = run(NAME, &line(&[0, 0], &to), &choices, EngineKind::Word);
        let choices = choices.with(&OVERRIDE, Some(30));
        for engine in EngineKind::ALL {
            let slow = run(NAME, &line(&[0, 0], &to), &choices, engine);
            for name in ["dx", "dy"] {
                assert_eq!(
                    pulses(&slow.rows, &slow.columns, name),
                    pulses(&usual.rows, &usual.columns, name),
                    "{choices:?}"
                );
            }
            // Thirty of a hundred clocks, in the counts 2, 4 and 6 of ten.
            let clocks: Vec<i64> = slow.rows[1..].iter().map(|row| row[0]).collect();
            let expected: Vec<i64> =
                (0..).flat_map(|ten| [3, 5, 7].map(|slot| 10 * ten + slot)).take(clocks.len()).collect();
            assert_eq!(clocks, expected);
        }
    }
}

#[test]
fn a_line_takes_the_least_whole_units_that_hold_it() {
    let bits = |choices: &Options| {
        let hardware = find(NAME).unwrap().plan(&line(&[0, 0], &[37, -1]), choices).unwrap();
        (hardware.widths["mx"].get(), hardware.widths["my"].get())
    };
    assert_eq!(bits(&Options::default()), (6, 6));
    for (unit, all) in [(1, 6), (2, 6), (3, 6), (4, 8), (5, 10), (6, 6), (7, 7)] {
        assert_eq!(bits(&Options::default().with(&CASCADE, width(unit))), (all, all), "units of {unit}");
    }
    assert_eq!(bits(&Options::default().with(&RADIX, Radix::Decimal)), (8, 8));
}

#[test]
fn choices_that_do_not_go_together_are_refused_with_a_remedy() {
    let refused = |choices: Options, hint: &str| {
        let error = find(NAME).unwrap().plan(&line(&[0, 0], &[37, 5]), &choices).unwrap_err();
        assert!(!matches!(error, ModelError::Netlist(_)) && error.to_string().contains(hint), "{error}");
    };
    let widths = |name: &str, bits| [(name.to_owned(), width(bits).unwrap())].into();
    let (usual, decimal) = (Options::default(), Some(Radix::Decimal));
    for percent in [0, 100, u64::MAX] {
        refused(usual.clone().with(&OVERRIDE, Some(percent)), "leave it out");
    }
    refused(usual.clone().with(&RADIX, decimal).with(&CASCADE, width(4)), "leave --cascade or --radix 10 out");
    refused(usual.clone().with(&RADIX, decimal).with_all(&WIDTH, width(10)), "give --width 12");
    refused(usual.clone().with(&CASCADE, width(5)).with_all(&WIDTH, width(12)), "give --width 15");
    refused(usual.clone().with(&CASCADE, width(40)).with_all(&WIDTH, width(50)), "give --width 40");
    refused(usual.clone().with_single(&WIDTH, widths("my", 7)), "my of 7 bits, but the counter has 6");
    refused(usual.clone().with(&CASCADE, width(3)).with_single(&WIDTH, widths("q2", 4)), "each unit has 3");
    refused(usual.with(&NORMALIZE, true), "does not take --normalize");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn lines_of_any_size(
        n in 6u32..11,
        from in prop::collection::vec(-100_000i64..100_000, 3),
        share in prop::collection::vec(-1000i64..=1000, 3),
    ) {
        let to = ends(&from, &share, 1 << n);
        check_line(n, &from, &to, EngineKind::Compiled);
    }

    #[test]
    fn cascades_of_any_size(
        (units, bits) in (2u32..5, 1u32..4).prop_filter("not too long", |(units, bits)| units * bits < 11),
        share in prop::collection::vec(-1000i64..=1000, 2),
    ) {
        let to = ends(&[0, 0], &share, 1 << (units * bits));
        check_cascade(units, bits, &[0, 0], &to, EngineKind::Word);
    }

    #[test]
    fn decades_of_any_size(digits in 2u32..4, share in prop::collection::vec(-1000i64..=1000, 2)) {
        let to = ends(&[7, -9], &share, 10_i64.pow(digits));
        check_decades(digits, &[7, -9], &to, EngineKind::Word);
    }

    #[test]
    fn feed_overrides_of_any_line(percent in 1u64..100, share in prop::collection::vec(-1000i64..=1000, 2)) {
        let to = ends(&[0, 0], &share, 1 << 7);
        check_override(7, &[0, 0], &to, percent, EngineKind::Compiled);
    }
}

/// An end point whose ways are these thousandths of `limit`, below it, and not all 0.
fn ends(from: &[i64], thousandths: &[i64], limit: i64) -> Vec<i64> {
    let mut to: Vec<i64> =
        from.iter().zip(thousandths).map(|(from, share)| from + (limit - 1) * share / 1000).collect();
    if to == from {
        to[0] += 1;
    }
    to
}
