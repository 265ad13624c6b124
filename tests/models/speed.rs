//! Speed along the path, against what the rows of the step table say one by one.

use proptest::prelude::*;
use stepwave::testbench::{Observer, ObserverError, PathWatch, Speed, SpeedWatch, SpeedWindow, Step};
use stepwave_engine::EngineKind;
use stepwave_models::options::{ADDER, BEATS, NORMALIZE, ON_OVERFLOW, OVERRIDE, PRESET, RADIX, SYSTEM, TIMING, WIDTH};
use stepwave_models::{Adder, Beats, Options, Preset, Radix, StepTiming, System, catalogue};
use stepwave_nc::Curve;
use stepwave_netlist::{OnOverflow, Width};

use super::{arc, bench, line};

/// What the rows say: windows of 32 steps, or of all of them where there are less, the first slowest and fastest one.
fn plain(rows: &[Step]) -> Option<Speed> {
    let window = (rows.len() - 1).min(32);
    if window == 0 {
        return None;
    }
    let speeds = (window..rows.len()).map(|k| {
        let (from, to) = (&rows[k - window], &rows[k]);
        let apart = from.position.iter().zip(&to.position).map(|(from, to)| u128::from(from.abs_diff(*to)).pow(2));
        SpeedWindow { square: apart.sum(), clocks: to.clock - from.clock, step: k as u64 }
    });
    let slower = |a: &SpeedWindow, b: &SpeedWindow| {
        a.square * u128::from(b.clocks).pow(2) < b.square * u128::from(a.clocks).pow(2)
    };
    let least = speeds.clone().reduce(|least, next| if slower(&next, &least) { next } else { least })?;
    let greatest = speeds.reduce(|greatest, next| if slower(&greatest, &next) { next } else { greatest })?;
    Some(Speed { clocks: rows.last()?.clock - rows[0].clock, least, greatest })
}

/// Keeps the whole step table.
struct Keep(Vec<Step>);

impl Observer for Keep {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.0.push(step.clone());
        Ok(())
    }
}

/// The rows of a run, and what the watch says where it sees samples, and where it may see digests of many.
fn both(model: &str, curve: &Curve, choices: &Options, engine: EngineKind) -> (Vec<Step>, [Option<Speed>; 2]) {
    let bench = bench(model, curve, choices);
    let (mut keep, mut watch) = (Keep(Vec::new()), SpeedWatch::new(&bench));
    bench.run(EngineKind::Word, &mut [&mut keep, &mut watch]).unwrap();
    let (mut ahead, mut path) = (SpeedWatch::new(&bench), PathWatch::new(&bench, curve));
    bench.run(engine, &mut [&mut ahead as &mut dyn Observer, &mut path]).unwrap();
    (keep.0, [watch.finish(), ahead.finish()])
}

fn check(model: &str, curve: &Curve, choices: &Options, engine: EngineKind) -> Vec<Step> {
    let (rows, [watch, ahead]) = both(model, curve, choices, engine);
    let what = format!("{model} {curve:?} {choices:?} on {}", engine.name());
    assert_eq!(watch, plain(&rows), "{what}");
    assert_eq!(ahead, watch, "{what}, many samples at once");
    rows
}

/// Fewest clocks from a row to the next.
fn least_apart(rows: &[Step]) -> Option<u64> {
    rows.windows(2).map(|pair| pair[1].clock - pair[0].clock).min()
}

fn half() -> Options {
    Options::default().with_all(&PRESET, Preset::Half)
}

#[test]
fn the_worked_line_of_point_by_point_comparison() {
    let choices = Options::default().with(&BEATS, Beats::One);
    for engine in EngineKind::ALL {
        let (_, speeds) = both("ppc-line", &line(&[0, 0], &[100, 62]), &choices, engine);
        // X 19 or 20 of 32 steps: 19² + 13² = 530, 20² + 12² = 544.
        let least = SpeedWindow { square: 530, clocks: 32, step: 33 };
        let greatest = SpeedWindow { square: 544, clocks: 32, step: 32 };
        assert_eq!(speeds, [Some(Speed { clocks: 162, least, greatest }); 2]);
        let [least, mean, greatest] = [least.speed(), 100f64.hypot(62.0) / 162.0, greatest.speed()];
        let round = |number: f64| (number * 1e4).round() / 1e4;
        assert_eq!([least, mean, greatest, (greatest - least) / mean].map(round), [0.7194, 0.7263, 0.7289, 0.0130]);
    }
}

#[test]
fn less_than_32_steps_are_one_window() {
    for (to, steps) in [([3, 1], 4), ([20, 11], 31), ([20, 12], 32), ([-20, 13], 33)] {
        let rows = check("ppc-line", &line(&[0, 0], &to), &Options::default(), EngineKind::Compiled);
        assert_eq!(rows.len(), steps + 1);
    }
    let (_, [speed, _]) = both("ppc-line", &line(&[5, 5], &[8, 6]), &Options::default(), EngineKind::Word);
    let all = SpeedWindow { square: 10, clocks: 16, step: 4 };
    assert_eq!(speed, Some(Speed { clocks: 16, least: all, greatest: all }));
}

#[test]
fn steps_of_a_model_take_the_clocks_that_it_declares() {
    let usual = Options::default();
    let each = [usual.clone(), usual.clone().with(&BEATS, Beats::One), usual.clone().with(&ADDER, Adder::Serial)];
    let more = [half().with(&NORMALIZE, true), usual.with(&RADIX, Radix::Decimal)];
    let curves = [line(&[0, 0], &[200, 93]), line(&[0, 0, 0], &[30, -200, 77]), arc([60, 0], [0, 60], [0, 0], false)];
    let mut seen = 0;
    for model in catalogue().iter().filter(|model| !model.name.starts_with("sampled")) {
        for (curve, choices) in curves.iter().flat_map(|curve| each.iter().chain(&more).map(move |all| (curve, all))) {
            let takes = choices.given().iter().all(|value| model.takes(value.option()));
            let Ok(hardware) = model.plan(curve, choices) else { continue };
            if takes {
                let rows = check(model.name, curve, choices, EngineKind::Compiled);
                #[allow(clippy::cast_precision_loss)]
                let apart = least_apart(&rows).map(|clocks| clocks as f64);
                assert_eq!(apart, hardware.clocks_of_step(), "{} {curve:?} {choices:?}", model.name);
                seen += 1;
            }
        }
    }
    assert!(seen > 60, "{seen}");
}

#[test]
fn additions_of_data_sampling_take_the_clocks_of_a_period_over_their_number() {
    for system in [System::StepFactor, System::Direction] {
        let choices = Options::default().with(&SYSTEM, system);
        let curve = line(&[0, 0], &[400, 93]);
        let rows = check("sampled-line", &curve, &choices, EngineKind::Compiled);
        let hardware = bench("sampled-line", &curve, &choices).hardware().clone();
        let sampling = hardware.sampling.unwrap();
        let additions = 1 << hardware.widths["jrx"].get();
        assert_eq!(hardware.clocks_of_step(), Some(sampling.period_clocks() / f64::from(additions)));
        assert!(rows.len() > 34);
    }
}

#[test]
fn counters_that_wrap_do_not_move_the_tool() {
    let narrow = |name: &str, bits: u64| {
        let width = Width::new(bits).unwrap();
        Options::default().with_single(&WIDTH, [(name.to_owned(), width)].into()).with(&ON_OVERFLOW, OnOverflow::Wrap)
    };
    for engine in EngineKind::ALL {
        check("ppc-line", &line(&[0, 0], &[300, 200]), &narrow("f", 6), engine);
        check("dda-line", &line(&[0, 0], &[300, 200]), &narrow("x", 6), engine);
    }
}

#[test]
fn k_v_of_point_by_point_comparison_is_the_root_of_two() {
    let mean = |[x, y]: [i64; 2]| {
        let choices = Options::default().with(&BEATS, Beats::One);
        let (_, [speed, _]) = both("ppc-line", &line(&[0, 0], &[x, y]), &choices, EngineKind::Word);
        #[allow(clippy::cast_precision_loss)]
        let [length, clocks] = [(x as f64).hypot(y as f64), speed.unwrap().clocks as f64];
        length / clocks
    };
    // Lines of about 1000 BLU in all directions, 24 degrees apart, and those along an axis and between two.
    let around = (0..360).step_by(24).map(|degrees| {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        #[allow(clippy::cast_possible_truncation)]
        [cosine, sine].map(|part| (1000.0 * part).round() as i64)
    });
    let means: Vec<f64> = around.chain([[1000, 0], [0, -1000], [707, 707], [-707, 707]]).map(mean).collect();
    let [least, greatest] = [f64::min, f64::max].map(|of| means.iter().copied().reduce(of).unwrap());
    assert!((greatest / least - 2f64.sqrt()).abs() < 1e-9, "{greatest} / {least}");
}

#[test]
fn arcs_turn_cross_axes_and_are_loaded_in_parts() {
    for model in ["ppc-arc", "dda-arc", "cim-arc", "mindev-arc", "vector-arc", "ppc-machine", "dda-machine"] {
        for (from, to, clockwise) in
            [([5, 0], [0, 5], false), ([-300, 400], [-300, 400], true), ([3000, 0], [3000, 0], false)]
        {
            let choices = if model.starts_with("dda") { half() } else { Options::default() };
            for engine in [EngineKind::Word, EngineKind::Compiled] {
                check(model, &arc(from, to, [0, 0], clockwise), &choices, engine);
            }
        }
    }
}

#[test]
fn a_normalised_line_is_as_much_faster_as_its_integrands_are_shifted() {
    let curve = line(&[0, 0], &[100, 62]);
    let clocks = |normalize, bits: u64| {
        let choices = half().with(&NORMALIZE, normalize).with_all(&WIDTH, Width::new(bits).unwrap());
        let (rows, [speed, ahead]) = both("dda-line", &curve, &choices, EngineKind::Compiled);
        assert_eq!([speed, ahead], [plain(&rows); 2]);
        speed.unwrap().clocks
    };
    // 2^7 iterations hold the line; a register of 10 bits takes 2^10, normalised 2^7 again. The shifts are before row 0.
    assert_eq!([clocks(false, 7), clocks(false, 10), clocks(true, 10)], [128, 1024, 128]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn lines_in_any_direction(to in prop::array::uniform2(-40_000i64..40_000), short in 0u32..12, one: bool) {
        let to = to.map(|travel| travel >> short);
        prop_assume!(to != [0, 0]);
        let beats = Options::default().with(&BEATS, if one { Beats::One } else { Beats::Four });
        for model in ["ppc-line", "cim-line", "mindev-line", "vector-line"] {
            check(model, &line(&[0, 0], &to), &beats, EngineKind::Compiled);
        }
        for model in ["dda-line", "dpm-line", "bresenham", "stepgen"] {
            check(model, &line(&[0, 0], &to), &Options::default(), EngineKind::Compiled);
        }
    }

    #[test]
    fn lines_of_several_axes(to in prop::collection::vec(-1_500i64..1_500, 3..=6), percent in prop::option::of(1u64..100)) {
        prop_assume!(to.iter().any(|&travel| travel != 0));
        let from = vec![3; to.len()];
        let to: Vec<i64> = to.iter().map(|travel| travel + 3).collect();
        for model in ["ppc-line", "dda-line", "bresenham", "stepgen"] {
            check(model, &line(&from, &to), &Options::default(), EngineKind::Compiled);
        }
        check("dpm-line", &line(&from, &to), &Options::default().with(&OVERRIDE, percent), EngineKind::Compiled);
    }

    #[test]
    fn arcs_of_any_size(from in prop::array::uniform2(-3_000i64..3_000), turns in 1usize..4, clockwise: bool, short in 0u32..8) {
        let from = from.map(|place| place >> short);
        prop_assume!(from != [0, 0]);
        let to = (0..turns).fold(from, |[x, y], _| [-y, x]);
        for model in ["ppc-arc", "dda-arc", "cim-arc", "mindev-arc", "vector-arc"] {
            let choices = if model == "dda-arc" { half() } else { Options::default() };
            check(model, &arc(from, to, [0, 0], clockwise), &choices, EngineKind::Compiled);
        }
    }

    #[test]
    fn steps_that_are_not_evenly_spread(to in prop::array::uniform2(-900i64..900), length in 1u64..40, setup in 0u64..40) {
        prop_assume!(to != [0, 0]);
        let timing = StepTiming { length, space: 3, setup, hold: 2 };
        check("stepgen", &line(&[0, 0], &to), &Options::default().with(&TIMING, timing), EngineKind::Compiled);
        check("sampled-line", &line(&[0, 0], &to), &Options::default(), EngineKind::Compiled);
    }
}
