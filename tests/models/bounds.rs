//! The path errors that the methods promise, measured over every line of up to five bits and every lattice arc of a
//! radius below 30, and those that have no promise. `cargo test --test main models::bounds -- --nocapture` prints them.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use std::sync::Mutex;

use rayon::prelude::*;
use stepwave::testbench::{Ending, Observer, ObserverError, PathWatch, SpacingWatch, Step};
use stepwave_engine::EngineKind;
use stepwave_models::options::{BEATS, COMPARE, END_POINT, FORM, NORMALIZE, PRESET, RADIX, WEIGHTS, WIDTH};
use stepwave_models::{Beats, Compare, EndPoint, Form, Options, Preset, Radix, Weights, find};
use stepwave_nc::{Conic, Curve, Direction};
use stepwave_netlist::Width;

use super::conics::every_quarter_ellipse;
use super::dda_helix::helix;
use super::{arc, bench, every_lattice_arc, every_line, line, squares_below};

/// Greatest path error so far, where, and how many geometries were measured.
type Worst = Mutex<(f64, String, u32)>;

fn measure(worst: &Worst, model: &str, curve: &Curve, choices: &Options) {
    let bench = bench(model, curve, choices);
    let mut path = PathWatch::new(&bench, curve);
    let mut observers: [&mut dyn Observer; 1] = [&mut path];
    let outcome = bench.run(EngineKind::Word, &mut observers).unwrap();
    // Curves of the DDA may hang; what they do until then counts.
    let hangs = model.starts_with("dda-") && matches!(outcome.ending, Ending::Stalled { .. });
    assert!(hangs || outcome.ending == Ending::Done && outcome.reached == curve.to(), "{model} {curve:?} {outcome:?}");
    let error = path.worst.unwrap().error;
    let mut worst = worst.lock().unwrap();
    worst.2 += 1;
    if error > worst.0 {
        (worst.0, worst.1) = (error, format!("{:?} to {:?}", curve.from(), curve.to()));
    }
}

/// Prints the greatest path error; gives it.
#[allow(clippy::print_stdout)]
fn report(what: &str, worst: Worst) -> f64 {
    let (error, place, count) = worst.into_inner().unwrap();
    println!("{what:<24} {error:.6} BLU at {place}, of {count}");
    error
}

fn one_beat(model: &str) -> Options {
    let takes = find(model).unwrap().takes(&BEATS);
    Options::default().with(&BEATS, takes.then_some(Beats::One))
}

fn lines(model: &str) -> f64 {
    lines_with(model, "", &one_beat(model))
}

fn lines_with(model: &str, what: &str, choices: &Options) -> f64 {
    let worst = Worst::default();
    every_line(5, |to| measure(&worst, model, &line(&[0, 0], &to), choices));
    report(&format!("{model} {what}"), worst)
}

fn arcs(model: &str, choices: &Options) -> f64 {
    let worst = Worst::default();
    every_lattice_arc(&squares_below(900), |from, to, clockwise| {
        measure(&worst, model, &arc(from, to, [0, 0], clockwise), choices)
    });
    let options: Vec<String> = [
        choices.get(&WEIGHTS).copied().map(|weights| format!("{weights:?}")),
        choices.of_all(&PRESET).map(|preset| format!("{preset:?}")),
        choices.get(&END_POINT).copied().map(|end| format!("{end:?}")),
    ]
    .into_iter()
    .flatten()
    .collect();
    report(&format!("{model} {}", options.join(" ")), worst)
}

#[test]
fn lines_stay_within_the_bounds_of_their_methods() {
    for model in ["ppc-line", "dda-line", "cim-line", "vector-line"] {
        assert!(lines(model) < 1.0, "{model}");
    }
    assert!(lines("mindev-line") <= 0.5);
    // Two axes, each off by as much as five bits allow.
    assert!(lines("dpm-line") <= f64::sqrt(2.0) * (22.0 / 18.0 - 1.0 / 288.0));
}

/// Greatest deviation of any axis from its uniform rate after any step, over all coefficients of `n` bits or of that
/// many digits, in pulses times the steps of a block: six coefficients a run. What the report says must be the same.
#[allow(clippy::cast_precision_loss)]
fn worst_rate_deviation(choices: &Options, steps: i64) -> i64 {
    let worst = Mutex::new(0);
    let runs = (0..steps).step_by(6).collect::<Vec<_>>();
    runs.into_par_iter().for_each(|first| {
        let travels: Vec<i64> = (0..6).map(|axis| (first + axis).min(steps - 1)).collect();
        let curve = line(&[0; 6], &travels);
        let bench = bench("dpm-line", &curve, choices);
        let (mut rows, mut spacing) =
            (Farthest { travels: &travels, steps, worst: vec![0; 6] }, SpacingWatch::new(&bench, &curve));
        let outcome = bench.run(EngineKind::Word, &mut [&mut rows, &mut spacing]).unwrap();
        assert_eq!((outcome.ending, i64::try_from(outcome.steps).unwrap()), (Ending::Done, steps));
        for (train, off) in spacing.finish().iter().zip(&rows.worst) {
            let reported = train.deviation.unwrap().pulses * steps as f64;
            assert!((reported - *off as f64).abs() < 1e-9, "{reported} for {off} / {steps}");
            assert!(train.deviation.unwrap().pulses <= bench.hardware().rate_bound.unwrap() + 1e-12);
        }
        let mut worst = worst.lock().unwrap();
        *worst = rows.worst.into_iter().fold(*worst, i64::max);
    });
    worst.into_inner().unwrap()
}

/// How far each axis is off after any row of the step table.
struct Farthest<'a> {
    travels: &'a [i64],
    steps: i64,
    worst: Vec<i64>,
}

impl Observer for Farthest<'_> {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        let t = i64::try_from(step.number)?;
        for ((worst, travel), position) in self.worst.iter_mut().zip(self.travels).zip(&step.position) {
            *worst = (position * self.steps - travel * t).abs().max(*worst);
        }
        Ok(())
    }
}

#[test]
fn the_worst_deviation_of_a_pulse_multiplier_is_that_of_the_closed_form() {
    for n in 1..=11 {
        let steps = 1_i64 << n;
        let choices = Options::default().with_all(&WIDTH, Width::new(n).unwrap());
        let worst = worst_rate_deviation(&choices, steps);
        // Times 18·2^n: (3n + 7)/18 + (-1)^n/(9·2^n).
        let n = i64::try_from(n).unwrap();
        let closed = (3 * n + 7) * steps + if n % 2 == 0 { 2 } else { -2 };
        assert_eq!(18 * worst, closed, "n = {n}");
    }
}

#[test]
fn the_worst_deviation_of_decades_is_that_of_a_number_of_sevens() {
    // Digit 7 has all its pulses in the counts 1 to 7, so that 8 clocks bring 1.4 more than 8·0.7.
    for (digits, literal) in [(1, 14), (2, 224), (3, 3024)] {
        let (width, steps) = (Some(Width::new(4 * digits).unwrap()), 10_i64.pow(u32::try_from(digits).unwrap()));
        let choices = Options::default().with_all(&WIDTH, width).with(&RADIX, Radix::Decimal);
        let worst = worst_rate_deviation(&choices, steps);
        assert_eq!(worst, literal);
        // Times 81·10^k: 7k/9 + 56/81·(1 - 10^(-k)).
        assert_eq!(81 * worst, 63 * i64::try_from(digits).unwrap() * steps + 56 * (steps - 1));
    }
}

#[test]
fn accumulators_stay_within_a_step_of_each_axis_or_half_a_step() {
    for (what, preset, bound) in
        [("zero", Preset::Zero, SQRT_2), ("full", Preset::Full, SQRT_2), ("half", Preset::Half, FRAC_1_SQRT_2)]
    {
        let choices = Options::default().with_all(&PRESET, preset);
        let error = lines_with("stepgen", what, &choices);
        assert!(error < bound + 1e-9 && error > 0.9 * bound, "{what}");
    }
}

#[test]
fn counters_stay_within_half_a_step_with_the_right_test() {
    for (what, form, compare) in
        [("ge", Form::Magnitude, Compare::AtLeast), ("signed gt", Form::Signed, Compare::Greater)]
    {
        let choices = Options::default().with(&FORM, form).with(&COMPARE, compare);
        let error = lines_with("bresenham", what, &choices);
        assert!(error <= 0.5 && error > 0.4, "{what}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn arcs_stay_within_the_bounds_of_their_methods() {
    for end_point in [EndPoint::Total, EndPoint::PerAxis] {
        let with = |model| one_beat(model).with(&END_POINT, end_point);
        assert!(arcs("ppc-arc", &with("ppc-arc")) <= 1.0);
        assert!(arcs("mindev-arc", &with("mindev-arc")) < 0.5);
        assert!(arcs("vector-arc", &with("vector-arc")) < 1.0);
    }
}

#[test]
#[ignore = "exhaustive"]
fn comparison_integral_stays_within_one_blu_with_the_weights_of_the_middle_only() {
    let with = |weights| one_beat("cim-arc").with(&WEIGHTS, weights);
    assert!(arcs("cim-arc", &with(Weights::Mid)) <= 1.0);
    assert!(arcs("cim-arc", &with(Weights::Pre)) > 1.0);
    assert!(arcs("cim-arc", &with(Weights::Post)) > 1.0);
}

#[test]
#[ignore = "exhaustive"]
fn arcs_of_the_dda_may_leave_the_circle_by_more_than_one_blu() {
    let with = |preset| Options::default().with_all(&PRESET, preset);
    assert!(arcs("dda-arc", &with(Preset::Half)) > 1.0);
}

/// By the DDA, in the least bits and normalised in four more.
fn ellipses(preset: Preset, normalize: bool) -> f64 {
    let worst = Worst::default();
    every_quarter_ellipse(30, |case| {
        let curve = case.curve();
        let mut choices = Options::default().with_all(&PRESET, preset);
        if normalize {
            let least = find("dda-conic").unwrap().plan(&curve, &choices).unwrap().widths["jrx"];
            choices = choices.with_all(&WIDTH, Width::new(u64::from(least.get()) + 4).ok()).with(&NORMALIZE, true);
        }
        measure(&worst, "dda-conic", &curve, &choices);
    });
    report(&format!("dda-conic {preset:?}{}", if normalize { " normalised" } else { "" }), worst)
}

#[test]
#[ignore = "exhaustive"]
fn ellipses_of_the_dda_may_leave_the_curve_by_more_than_one_blu() {
    let [zero, half, full] = [Preset::Zero, Preset::Half, Preset::Full].map(|preset| ellipses(preset, false));
    assert!(zero > 2.0 && half > 1.0 && half < 1.2 && full > 1.0, "{zero} {half} {full}");
    assert_eq!(ellipses(Preset::Half, true), half);
}

#[test]
fn ellipses_of_the_dda_promise_nothing() {
    let ellipse = Conic::ellipse([6, 4], [6, 0], [0, 4], [0, 0], Direction::CounterClockwise).unwrap();
    assert_eq!(find("dda-conic").unwrap().plan(&ellipse.into(), &Options::default()).unwrap().error_bound, None);
}

#[test]
#[ignore = "exhaustive"]
fn helices_of_the_dda_may_leave_the_curve_by_more_than_one_blu_and_promise_nothing() {
    for preset in [Preset::Zero, Preset::Half, Preset::Full] {
        let worst = Worst::default();
        every_lattice_arc(&squares_below(122), |from, to, clockwise| {
            for rise in [0, 1, -5, 20, -100] {
                let curve = helix([from[0], from[1], 0], [to[0], to[1], rise], [0, 0], clockwise);
                measure(&worst, "dda-helix", &curve, &Options::default().with_all(&PRESET, preset));
            }
        });
        assert!(report(&format!("dda-helix {preset:?}"), worst) > 1.0);
    }
    let curve = helix([5, 0, 0], [0, 5, 3], [0, 0], false);
    assert_eq!(find("dda-helix").unwrap().plan(&curve, &Options::default()).unwrap().error_bound, None);
}

#[test]
fn a_line_with_unequal_presets_may_leave_by_more_than_one_blu_and_promises_nothing() {
    let presets = [("jrx".to_owned(), Preset::Full), ("jry".to_owned(), Preset::Zero)];
    let choices = Options::default().with_single(&PRESET, presets.into());
    let worst = Worst::default();
    every_line(5, |to| measure(&worst, "dda-line", &line(&[0, 0], &to), &choices));
    assert!(report("dda-line jrx=full,jry=zero", worst) > 1.0);
    assert_eq!(bench("dda-line", &line(&[0, 0], &[5, 3]), &choices).hardware().error_bound, None);
}
