//! Lines of 3 axes and more.

use rayon::prelude::*;
use stepwave::testbench::{Ending, PathWatch};
use stepwave_engine::EngineKind;
use stepwave_models::options::{BEATS, END_POINT, FORM};
use stepwave_models::{Beats, EndPoint, Form, Options, find};

use super::{bench, check, line, run, widths};
use crate::reference::{Table, cim_space_line, mindev_space_line, ppc_space_line};

type InSpace = fn(&[i64], &[i64]) -> Table;
const MODELS: [(&str, InSpace, f64); 3] =
    [("ppc-line", ppc_space_line, 1.0), ("cim-line", cim_space_line, 1.0), ("mindev-line", mindev_space_line, 0.5)];

fn check_line(from: &[i64], to: &[i64], beats: Beats, engine: EngineKind) {
    for (model, table, _) in MODELS {
        check(model, &line(from, to), &Options::default().with(&BEATS, beats), engine, &table(from, to));
    }
}

#[test]
fn every_line_of_three_axes_of_up_to_three_bits() {
    (-7..=7i64).into_par_iter().for_each(|x| {
        for to in (-7..=7).flat_map(|y| (-7..=7).map(move |z| [x, y, z])).filter(|to| *to != [0; 3]) {
            check_line(&[0; 3], &to, Beats::One, EngineKind::Word);
        }
    });
}

#[test]
fn lines_of_up_to_six_axes_on_every_engine_from_a_translated_start() {
    for engine in EngineKind::ALL {
        for beats in [Beats::One, Beats::Four] {
            check_line(&[3, -2, 7], &[8, 1, 9], beats, engine);
            check_line(&[0; 3], &[-1, 100, -100], beats, engine);
            check_line(&[1, 2, 3, 4], &[1, -17, 40, 3], beats, engine);
            check_line(&[0; 5], &[0, 0, 0, 0, -9], beats, engine);
            check_line(&[5, 0, -5, 0, 5, 0], &[25, -31, 26, 31, 4, -7], beats, engine);
        }
    }
}

#[test]
fn a_path_stays_as_near_to_the_line_as_is_promised() {
    let far = [[40, 1, 1], [1, 40, 1], [13, 12, 11], [100, 99, 1], [1, 100, 100]];
    for (model, _, axis) in MODELS {
        for to in far {
            let curve = line(&[0; 3], &to);
            let bench = bench(model, &curve, &Options::default());
            let mut path = PathWatch::new(&bench, &curve);
            bench.run(EngineKind::Compiled, &mut [&mut path]).unwrap();
            let (worst, promised) = (path.worst.unwrap().error, bench.hardware().error_bound.unwrap());
            assert!((promised - axis * 2f64.sqrt()).abs() < 1e-12 && worst <= promised, "{model} {to:?}: {worst}");
            assert!(to != [40, 1, 1] || worst > 0.97 * promised, "{model}: {worst}");
        }
    }
}

/// One bit less than the default, where the line reaches the greatest values, traps at every model's deviation.
#[test]
fn a_deviation_one_bit_narrower_traps_in_the_register_of_its_axis() {
    for (model, _, _) in MODELS {
        let curve = line(&[0; 3], &[63, 62, 1]);
        let default = find(model).unwrap().plan(&curve, &Options::default()).unwrap();
        for axis in ["fy", "fz"] {
            let ran = run(model, &curve, &widths(&[(axis, default.bits_of(axis) - 1)]), EngineKind::Word);
            assert_eq!(ran.outcome.ending, Ending::Trapped, "{model} {axis}");
        }
    }
}

#[test]
fn what_a_line_in_space_has_not_is_refused_with_the_remedy() {
    let curve = line(&[0; 3], &[5, 3, 2]);
    let refused = |options: Options| find("ppc-line").unwrap().plan(&curve, &options).unwrap_err().to_string();
    for form in [Form::Signed, Form::Bare] {
        let said = refused(Options::default().with(&FORM, form));
        assert!(said.contains("3 axes") && said.contains("leave --form out"), "{said}");
    }
    for end in [EndPoint::PerAxis, EndPoint::Longest] {
        let said = refused(Options::default().with(&END_POINT, end));
        assert!(said.contains("3 axes") && said.contains("leave --end-point out"), "{said}");
    }
}
