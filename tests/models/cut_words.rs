//! Load words that do not fit in their registers: refused where overflows trap, cut or held at an end of the range
//! otherwise, for every model and register; position counters that overflow, and the pulses that do not.

use stepwave::testbench::{Ending, PathWatch, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::{ON_OVERFLOW, WIDTH};
use stepwave_models::{CurveKind, ModelError, OnOverflow, Options, catalogue, find};
use stepwave_nc::{Arc, Conic, Curve, Direction, Helix, Nurbs, Spline, SplineForm};
use stepwave_netlist::Width;

use super::{line, widths};

fn with(mode: OnOverflow, choices: Options) -> Options {
    choices.with(&ON_OVERFLOW, mode)
}

/// A curve of some pulses that the model takes.
fn curve(kind: CurveKind) -> Curve {
    let ccw = Direction::CounterClockwise;
    match kind {
        CurveKind::Axis => line(&[5], &[42]),
        CurveKind::Line { .. } => line(&[5, -2], &[42, 21]),
        CurveKind::Arc | CurveKind::Move => Arc::new([25, 0], [-7, 24], [0, 0], ccw).unwrap().into(),
        CurveKind::Conic => Conic::ellipse([12, 7], [12, 0], [-12, 0], [0, 0], ccw).unwrap().into(),
        CurveKind::Spline => Spline::new(SplineForm::Bezier, &[[5, -2], [40, 0], [3, 31], [42, 21]]).unwrap().into(),
        CurveKind::Nurbs => Nurbs::bezier(&[[5, -2], [40, 0], [3, 31], [42, 21]]).unwrap().into(),
        CurveKind::Helix => Helix::new([25, 0, 3], [-7, 24, -9], [0, 0], ccw).unwrap().into(),
    }
}

#[test]
fn a_word_that_does_not_fit_is_refused_cut_or_held_at_the_end_of_the_range() {
    for (model, to, register, bits, wrapped, saturated, value) in [
        ("bresenham", [300, 3], "e", 8, 44, 255, 300),
        ("stepgen", [100, 62], "ratex", 7, -28, 63, 100),
        ("ppc-line", [9, 5], "xe", 3, 1, 7, 9),
        ("dda-line", [9, 5], "jvx", 3, 1, 7, 9),
        ("cim-line", [9, 5], "ex", 3, 1, 7, 9),
    ] {
        let (model, curve) = (find(model).unwrap(), line(&[0, 0], &to));
        let narrow = || widths(&[(register, bits)]);
        let refused = Testbench::loading(model, &curve, &with(OnOverflow::Trap, narrow()));
        assert!(matches!(refused, Err(ModelError::DoesNotFit { .. })), "{}", model.name);
        for (mode, expected) in [(OnOverflow::Wrap, wrapped), (OnOverflow::Saturate, saturated)] {
            // Statements about all geometries get no cut word.
            let strict = Testbench::new(model, &curve, &with(mode, narrow()));
            assert!(matches!(strict, Err(ModelError::DoesNotFit { .. })), "{}", model.name);
            let bench = Testbench::loading(model, &curve, &with(mode, narrow())).unwrap();
            let cut = bench.cut_words();
            let word = cut.iter().find(|word| word.register == register).unwrap();
            assert_eq!((word.value, word.loaded), (value, expected), "{}", model.name);
        }
    }
}

#[test]
fn words_that_fit_are_never_listed() {
    for model in catalogue().iter() {
        let bench = Testbench::loading(model, &curve(model.curve()), &with(OnOverflow::Wrap, Options::default()));
        assert_eq!(bench.unwrap().cut_words(), [], "{}", model.name);
    }
}

/// Every register of every model, one bit to all but one too narrow: the hardware is refused for what it is, or it runs
/// and ends or is given up, alone and in lanes alike.
#[test]
fn whatever_register_is_too_narrow_the_machine_runs_and_lanes_agree() {
    let (mut ran, mut cut) = (0, 0);
    for model in catalogue().iter() {
        let curve = curve(model.curve());
        let own = model.plan(&curve, &Options::default()).unwrap().widths;
        for (register, width) in &own {
            for bits in [1, width.get() / 2, width.get().saturating_sub(1)].into_iter().filter(|&bits| bits > 0) {
                for mode in [OnOverflow::Wrap, OnOverflow::Saturate] {
                    let narrow = [((*register).to_owned(), Width::new(bits.into()).unwrap())];
                    let choices = with(mode, Options::default().with_single(&WIDTH, narrow.into()));
                    let what = format!("{} {register}={bits} {mode:?}", model.name);
                    let bench = match Testbench::loading(model, &curve, &choices) {
                        Ok(bench) => bench,
                        Err(ModelError::DoesNotFit { .. }) => panic!("{what}: refused"),
                        Err(_) => continue,
                    };
                    ran += 1;
                    cut += u32::from(!bench.cut_words().is_empty());
                    let limit = 3000;
                    let alone = bench.measure(&curve, limit).unwrap();
                    assert_eq!(alone.cut, bench.cut_words(), "{what}");
                    let lanes = bench.measuring_lanes(limit).unwrap();
                    let Some(lanes) = lanes else { continue };
                    lanes.measure([&curve].into_iter(), |measured| {
                        if let Some(measured) = measured.unwrap() {
                            assert_eq!(measured, alone, "{what}");
                        }
                    });
                }
            }
        }
    }
    assert!(ran > 200 && cut > 60, "{ran} {cut}");
}

#[test]
fn pulses_say_where_the_tool_is_when_a_position_counter_overflows() {
    // Three bits hold -4 to 3: five pulses wrap to -3, or stay at 3.
    for (mode, shown) in [(OnOverflow::Wrap, -3), (OnOverflow::Saturate, 3)] {
        for model in ["ppc-line", "dda-line", "dpm-line", "cim-line", "mindev-line", "vector-line", "bresenham"] {
            let curve = line(&[0, 0], &[5, 0]);
            let choices = with(mode, widths(&[("x", 3)]));
            for engine in [EngineKind::Gates, EngineKind::Word, EngineKind::Compiled] {
                let bench = Testbench::loading(find(model).unwrap(), &curve, &choices).unwrap();
                let mut path = PathWatch::new(&bench, &curve);
                let outcome = bench.run(engine, &mut [&mut path]).unwrap();
                assert_eq!((outcome.ending, &outcome.reached[..]), (Ending::Done, &[5, 0][..]), "{model}");
                assert_eq!((outcome.counters, outcome.pulses), (vec![shown, 0], vec![5, 0]), "{model}");
                assert_eq!(path.worst.unwrap().error, 0.0, "{model}");
            }
            let bench = Testbench::loading(find(model).unwrap(), &curve, &choices).unwrap();
            let lanes = bench.run_many(std::slice::from_ref(&curve), 1000).unwrap();
            assert_eq!(lanes[0].as_ref().unwrap().reached, [5, 0], "{model}");
            let alone = bench.measure(&curve, 1000).unwrap();
            assert_eq!((alone.reached, alone.greatest, alone.mean), (vec![5, 0], Some(0.0), Some(0.0)), "{model}");
        }
    }
}

#[test]
fn the_tool_starts_where_the_curve_does_though_the_counter_cannot_hold_it() {
    let curve = line(&[9, 2], &[12, 2]);
    let choices = with(OnOverflow::Wrap, widths(&[("x", 3)]));
    let bench = Testbench::loading(find("ppc-line").unwrap(), &curve, &choices).unwrap();
    assert_eq!(bench.cut_words().iter().map(|word| (word.register, word.loaded)).collect::<Vec<_>>(), [("x", 1)]);
    let outcome = bench.run(EngineKind::Word, &mut []).unwrap();
    assert_eq!((outcome.reached, outcome.counters), (vec![12, 2], vec![-4, 2]));
}
