//! The path errors that the methods promise, measured over every line of up to five bits and every lattice arc of a
//! radius below 30. `cargo test --test main models::bounds -- --nocapture` prints them.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use std::sync::Mutex;

use stepwave::testbench::{Ending, Observer, PathWatch};
use stepwave_kernel::engine::EngineKind;
use stepwave_models::{Beats, Choices, Compare, EndPoint, Form, Preset, Weights, find};
use stepwave_nc::Curve;

use super::{arc, bench, every_lattice_arc, every_line, line};

/// Greatest path error so far, where, and how many geometries were measured.
type Worst = Mutex<(f64, String, u32)>;

fn measure(worst: &Worst, model: &str, curve: &Curve, choices: &Choices) {
    let bench = bench(model, curve, choices);
    let mut path = PathWatch::new(&bench, curve);
    let mut observers: [&mut dyn Observer; 1] = [&mut path];
    let outcome = bench.run(EngineKind::Word, &mut observers).unwrap();
    // Arcs of the DDA may hang; what they do until then counts.
    let hangs = model == "dda-arc" && matches!(outcome.ending, Ending::Stalled { .. });
    assert!(hangs || outcome.ending == Ending::Done && outcome.reached == curve.to(), "{model} {curve:?} {outcome:?}");
    let error = path.worst.unwrap().error;
    let mut worst = worst.lock().unwrap();
    worst.2 += 1;
    if error > worst.0 {
        (worst.0, worst.1) = (error, format!("{:?} to {:?}", curve.from(), curve.to()));
    }
}

/// Prints the greatest path error; gives it.
fn report(what: &str, worst: Worst) -> f64 {
    let (error, place, count) = worst.into_inner().unwrap();
    println!("{what:<24} {error:.6} BLU at {place}, of {count}");
    error
}

fn one_beat(model: &str) -> Choices {
    let takes = find(model).unwrap().choices.iter().any(|doc| doc.choice.option() == "--beats");
    Choices { beats: takes.then_some(Beats::One), ..Choices::default() }
}

fn lines(model: &str) -> f64 {
    lines_with(model, "", &one_beat(model))
}

fn lines_with(model: &str, what: &str, choices: &Choices) -> f64 {
    let worst = Worst::default();
    every_line(|to| measure(&worst, model, &line(&[0, 0], &to), choices));
    report(&format!("{model} {what}"), worst)
}

fn arcs(model: &str, choices: &Choices) -> f64 {
    let worst = Worst::default();
    every_lattice_arc(900, |from, to, clockwise| measure(&worst, model, &arc(from, to, [0, 0], clockwise), choices));
    let options: Vec<String> = [
        choices.weights.map(|weights| format!("{weights:?}")),
        choices.preset.map(|preset| format!("{preset:?}")),
        choices.end_point.map(|end| format!("{end:?}")),
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
}

#[test]
fn accumulators_stay_within_a_step_of_each_axis_or_half_a_step() {
    for (what, preset, bound) in
        [("zero", Preset::Zero, SQRT_2), ("full", Preset::Full, SQRT_2), ("half", Preset::Half, FRAC_1_SQRT_2)]
    {
        let choices = Choices { preset: Some(preset), ..Choices::default() };
        let error = lines_with("stepgen", what, &choices);
        assert!(error < bound + 1e-9 && error > 0.9 * bound, "{what}");
    }
}

#[test]
fn counters_stay_within_half_a_step_with_the_right_test() {
    for (what, form, compare) in
        [("ge", Form::Magnitude, Compare::AtLeast), ("signed gt", Form::Signed, Compare::Greater)]
    {
        let choices = Choices { form: Some(form), compare: Some(compare), ..Choices::default() };
        let error = lines_with("bresenham", what, &choices);
        assert!(error <= 0.5 && error > 0.4, "{what}");
    }
}

#[test]
fn arcs_stay_within_the_bounds_of_their_methods() {
    for end_point in [EndPoint::Total, EndPoint::PerAxis] {
        let with = |model| Choices { end_point: Some(end_point), ..one_beat(model) };
        assert!(arcs("ppc-arc", &with("ppc-arc")) <= 1.0);
        assert!(arcs("mindev-arc", &with("mindev-arc")) < 0.5);
        assert!(arcs("vector-arc", &with("vector-arc")) < 1.0);
    }
}

#[test]
fn comparison_integral_stays_within_one_blu_with_the_weights_of_the_middle_only() {
    let with = |weights| Choices { weights: Some(weights), ..one_beat("cim-arc") };
    assert!(arcs("cim-arc", &with(Weights::Mid)) <= 1.0);
    assert!(arcs("cim-arc", &with(Weights::Pre)) > 1.0);
    assert!(arcs("cim-arc", &with(Weights::Post)) > 1.0);
}

#[test]
fn arcs_of_the_dda_may_leave_the_circle_by_more_than_one_blu() {
    let with = |preset| Choices { preset: Some(preset), ..Choices::default() };
    assert!(arcs("dda-arc", &with(Preset::Half)) > 1.0);
}
