//! Digital differential analyser with serial adders: the step table of the parallel ones.

use proptest::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::Adder;
use stepwave_models::options::ADDER;

use super::dda::{END_POINTS, PRESETS, choices, preset_value};
use super::{check, every_line, line, run};
use crate::reference::dda_line;

/// One of every scheme, with the other choices that `which` says.
fn check_serial(n: u32, from: &[i64], to: &[i64], which: usize, engine: EngineKind) {
    for (end_point, end_reference) in END_POINTS {
        let (preset, normalize) = (PRESETS[which % 4], which / 4 % 2 == 1);
        let presets = vec![preset_value(preset, n); from.len()];
        let table = dda_line(n, from, to, &presets, normalize, end_reference);
        let choices = choices(n, preset, normalize, end_point).with(&ADDER, Adder::Serial);
        check("dda-line", &line(from, to), &choices, engine, &table);
    }
}

#[test]
fn every_line_of_up_to_four_bits_in_every_scheme() {
    check_lines_in_every_scheme(4);
}

#[test]
#[ignore = "exhaustive"]
fn every_line_of_up_to_five_bits_in_every_scheme() {
    check_lines_in_every_scheme(5);
}

fn check_lines_in_every_scheme(bits: u32) {
    every_line(bits, |[x, y]| {
        // The eight pairs of preset and normalisation: all for lines of three bits, else one a line.
        let short = x.abs() < 8 && y.abs() < 8;
        let one = usize::try_from((5 * x + 3 * y).rem_euclid(8)).unwrap();
        for which in if short { 0..8 } else { one..one + 1 } {
            check_serial(bits, &[0, 0], &[x, y], which, EngineKind::Word);
            if short {
                check_serial(3, &[0, 0], &[x, y], which, EngineKind::Word);
            }
        }
    });
}

#[test]
fn serial_lines_of_up_to_six_axes_on_every_engine() {
    for engine in EngineKind::ALL {
        for which in 0..8 {
            check_serial(1, &[7, 7], &[8, 6], which % 4 / 3 * 3, engine);
            check_serial(3, &[1, -1, 5], &[4, -8, 5], which, engine);
            check_serial(3, &[0; 6], &[1, -2, 3, -4, 5, -6], which, engine);
        }
    }
}

#[test]
fn an_iteration_takes_as_many_clocks_as_there_are_bits() {
    for n in 4..=9 {
        let clocks = |adder| {
            let line = line(&[0, 0], &[8, -6]);
            let choices = choices(n, PRESETS[0], false, stepwave_models::EndPoint::Iterations).with(&ADDER, adder);
            run("dda-line", &line, &choices, EngineKind::Compiled).outcome.clocks
        };
        assert_eq!([clocks(Adder::Parallel), clocks(Adder::Serial)], [1 + (1 << n), 1 + (u64::from(n) << n)]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn serial_lines_of_any_size(d in prop::collection::vec(-1000i64..1000, 3), which in 0..8usize) {
        prop_assume!(d.iter().any(|&d| d != 0));
        check_serial(10, &[0, 0, 0], &d, which, EngineKind::Word);
    }
}
