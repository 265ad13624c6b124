//! Digital differential analyser along conics.

use stepwave::testbench::Ending;
use stepwave_engine::EngineKind;
use stepwave_models::{EndPoint, Options, Preset, find};

use super::conics::{Case, every_quarter_ellipse, various};
use super::dda::{PRESETS, check_hang, choices, preset_value};
use super::{assert_equal, check, run};
use crate::reference::{self, Opens, Shape, Table, dda_conic};

/// The least bits of an integrand, and this many more.
fn bits(case: &Case, spare: u32) -> u32 {
    find("dda-conic").unwrap().plan(&case.curve(), &Options::default()).unwrap().widths["jrx"].get() + spare
}

fn table(case: &Case, n: u32, preset: Preset, normalize: bool, end: reference::EndPoint) -> Table {
    let preset = [preset_value(preset, n); 2];
    dda_conic(n, case.shape, case.from, case.to, case.center, case.clockwise, preset, normalize, end)
}

/// Compares, hang for hang, and says whether the curve hung.
fn check_conic(case: &Case, spare: u32, preset: Preset, normalize: bool, engine: EngineKind) -> bool {
    let n = bits(case, spare);
    let table = table(case, n, preset, normalize, reference::EndPoint::PerAxis);
    let choices = choices(n, preset, normalize, EndPoint::PerAxis);
    if table.finished {
        check("dda-conic", &case.curve(), &choices, engine, &table);
    } else {
        check_hang("dda-conic", &case.curve(), &choices, engine, &table);
    }
    !table.finished
}

fn check_quarter_ellipses(limit: i64) {
    every_quarter_ellipse(limit, |case| {
        for normalize in [false, true] {
            let spare = if normalize { 3 } else { 0 };
            for preset in [Preset::Zero, Preset::Half] {
                assert!(!check_conic(case, spare, preset, normalize, EngineKind::Word), "{case:?} hangs");
            }
            check_conic(case, spare, Preset::Full, normalize, EngineKind::Word);
        }
    });
}

#[test]
fn every_quarter_ellipse_with_semi_axes_below_14() {
    check_quarter_ellipses(14);
}

#[test]
#[ignore = "exhaustive"]
fn every_quarter_ellipse_with_semi_axes_below_30() {
    check_quarter_ellipses(30);
}

/// One in `every` cases; how many stalled with each preset.
fn check_various(every: usize) -> [u32; 4] {
    let mut hangs = [0; 4];
    for case in various().into_iter().step_by(every) {
        for (hangs, preset) in hangs.iter_mut().zip(PRESETS) {
            for (spare, normalize) in [(0, false), (1, false), (0, true), (4, true)] {
                *hangs += u32::from(check_conic(&case, spare, preset, normalize, EngineKind::Word));
            }
        }
    }
    hangs
}

#[test]
fn conics_of_every_shape_and_orientation() {
    println!("of every tenth conic with the presets zero, half, full, 1 stalled: {:?}", check_various(10));
}

#[test]
#[ignore = "exhaustive"]
fn all_conics_of_every_shape_and_orientation() {
    println!("of {} conics with the presets zero, half, full, 1 stalled: {:?}", various().len(), check_various(1));
}

#[test]
fn conics_on_every_engine_about_a_translated_centre() {
    for engine in EngineKind::ALL {
        for case in various().iter().step_by(23) {
            check_conic(&case.moved([-40, 13]), 0, Preset::Half, false, engine);
            check_conic(&case.moved([9, -70]), 2, Preset::Zero, true, engine);
        }
    }
}

#[test]
fn a_full_preset_comes_to_a_stand_where_the_recurrence_does_on_every_engine() {
    let case = Case { shape: Shape::Ellipse([1, 2]), from: [1, 0], to: [0, 2], center: [0, 0], clockwise: false };
    for engine in EngineKind::ALL {
        assert!(check_conic(&case, 0, Preset::Full, false, engine));
    }
}

#[test]
fn one_counter_for_both_axes_follows_the_recurrence_and_misses_or_traps_where_it_does() {
    let (mut exact, mut missed, mut trapped) = (0, 0, 0);
    let quarter = |[a, b]: [i64; 2]| Case {
        shape: Shape::Ellipse([a, b]),
        from: [a, 0],
        to: [0, b],
        center: [0, 0],
        clockwise: false,
    };
    let parabola =
        |opens, from, to| Case { shape: Shape::Parabola(4, opens), from, to, center: [0, 0], clockwise: false };
    let mut cases: Vec<Case> = (1..12).flat_map(|a| (1..12).map(move |b| [a, b])).map(quarter).collect();
    cases.push(parabola(Opens::PlusX, [0, 0], [9, 6]));
    cases.push(parabola(Opens::MinusY, [6, -9], [2, -1]));
    for case in &cases {
        for preset in [Preset::Zero, Preset::Half] {
            for normalize in [false, true] {
                let n = bits(case, 1);
                let table = table(case, n, preset, normalize, reference::EndPoint::Total);
                let choices = choices(n, preset, normalize, EndPoint::Total);
                let ran = run("dda-conic", &case.curve(), &choices, EngineKind::Word);
                assert_equal(|| format!("{case:?} {choices:?}"), &ran, &table);
                let ending = if table.overflow { Ending::Trapped } else { Ending::Done };
                assert_eq!(ran.outcome.ending, ending, "{case:?} {choices:?}");
                assert_eq!(table.finished, ending == Ending::Done, "{case:?} {choices:?}");
                match (ending, ran.outcome.reached == case.to) {
                    (Ending::Done, true) => exact += 1,
                    (Ending::Done, false) => missed += 1,
                    _ => trapped += 1,
                }
            }
        }
    }
    println!("{exact} exact, {missed} missed, {trapped} trapped");
    assert!(exact > 0 && missed > 0 && trapped > 0);
}

#[test]
fn the_quarter_of_the_ellipse_6_4_to_the_digit_from_every_engine() {
    // 16x² + 36y² = 576 in eight bits: J_VX = 36y and J_VY = 16x, worked by hand.
    let case = Case { shape: Shape::Ellipse([6, 4]), from: [6, 0], to: [0, 4], center: [0, 0], clockwise: false };
    for engine in EngineKind::ALL {
        let ran = run("dda-conic", &case.curve(), &choices(8, Preset::Zero, false, EndPoint::PerAxis), engine);
        let column = |name: &str| -> Vec<i64> {
            let index = ran.columns.iter().position(|column| column == name).unwrap();
            ran.rows.iter().map(|row| row[index]).collect()
        };
        assert_eq!(column("jvx"), [0, 0, 0, 36, 36, 36, 72, 72, 108, 108, 108, 144, 144, 144, 144, 144, 144, 144, 144]);
        assert_eq!(column("jvy"), [96, 96, 96, 96, 96, 96, 96, 96, 96, 80, 80, 64, 64, 48, 48, 32, 16, 16, 0]);
        assert_eq!(column("jry")[..9], [0, 96, 192, 32, 128, 224, 64, 160, 0]);
        assert_eq!(column("jrx")[3..12], [0, 36, 72, 108, 180, 252, 104, 212, 64]);
        assert_eq!(ran.outcome.reached, [0, 4]);
    }
}
