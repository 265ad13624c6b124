//! Invariants that were proved or claimed, looked at in runs.

use stepwave::study::proof::{Subject, states};
use stepwave_models::options::{BEATS, END_POINT, FORM, PRESET, WEIGHTS};
use stepwave_models::{Beats, EndPoint, Form, Model, Options, Preset, Weights, catalogue};
use stepwave_nc::Curve;
use stepwave_netlist::formula::Clause;

use super::subject;
use crate::models::{arc, line};

/// Geometries of a model whose author claims something between steps.
fn curves(model: &Model) -> Vec<Curve> {
    let ends = [[9, 4], [4, 9], [0, 7], [7, 0], [5, 5], [1, 0], [0, 1], [31, 30], [17, 2]];
    match model.name {
        name if name.ends_with("line") => {
            let quadrants = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
            let to = |[x, y]: [i64; 2]| quadrants.map(|[sx, sy]| line(&[0, 0], &[sx * x, sy * y]));
            ends.into_iter().flat_map(to).collect()
        }
        name if name.ends_with("arc") => {
            let mut points =
                vec![[5, 0], [4, 3], [3, 4], [0, 5], [-3, 4], [-5, 0], [0, -5], [25, 0], [15, 20], [7, 24], [1, 0]];
            if ["ppc-arc", "mindev-arc", "vector-arc"].contains(&name) {
                // Circles that cross no axis on a whole number.
                points.extend([[1, 1], [-1, 1], [2, 2], [-2, -2], [2, 3], [-3, 2], [3, 3], [1, -4], [4, 1], [7, 8]]);
            }
            let pair = |from: [i64; 2]| {
                let on_one_circle =
                    |to: &[i64; 2]| to[0] * to[0] + to[1] * to[1] == from[0] * from[0] + from[1] * from[1];
                let to = points.iter().copied().filter(on_one_circle);
                to.flat_map(move |to| [true, false].map(|clockwise| arc(from, to, [0, 0], clockwise)))
                    .collect::<Vec<_>>()
            };
            points.iter().copied().flat_map(pair).collect()
        }
        _ => Vec::new(),
    }
}

fn assert_hold(
    what: &str,
    clauses: &[Clause],
    machine: &stepwave_models::Machine,
    blocks: &[Vec<(stepwave_netlist::Net, u64)>],
) -> u32 {
    let mut looked_at = 0;
    for words in blocks {
        for state in states(machine, words) {
            let value = |name: &str| state.value(machine, name);
            for clause in clauses {
                assert_eq!(clause.holds(value), Some(true), "{what}: {} in {:?}", clause.name, clause.any);
                looked_at += 1;
            }
        }
    }
    looked_at
}

#[test]
fn what_authors_claim_between_steps_holds_in_every_row_of_runs() {
    for model in catalogue().iter() {
        let mut looked_at = 0;
        let mut claimed = false;
        for curve in curves(model) {
            for choices in [
                Options::default(),
                Options::default().with(&BEATS, Beats::One).with(&END_POINT, EndPoint::PerAxis),
                Options::default().with(&WEIGHTS, Weights::Pre),
                Options::default().with(&WEIGHTS, Weights::Post),
                Options::default().with(&FORM, Form::Signed).with(&END_POINT, EndPoint::Longest),
                Options::default().with_all(&PRESET, Preset::Half),
            ] {
                let Ok(hardware) = model.plan(&curve, &choices) else { continue };
                let machine = model.machine(&hardware).unwrap();
                let clauses = machine.design.netlist().invariants.clone();
                claimed |= !clauses.is_empty();
                let blocks = machine.encode(&hardware, &model.words(&hardware, &curve).unwrap()).unwrap();
                looked_at += assert_hold(&format!("{} {curve:?}", model.name), &clauses, &machine, &blocks);
            }
        }
        assert!(!claimed || looked_at > 500, "{}: {looked_at}", model.name);
    }
}

#[test]
fn what_was_proved_holds_in_runs_of_widths_that_nothing_was_learnt_from() {
    assert_hold_in_runs(["ppc-line", "ppc-arc", "dda-line", "mindev-line"].map(|model| (model, Options::default())));
}

#[test]
#[ignore = "exhaustive"]
fn what_was_proved_of_other_arcs_and_other_forms_holds_in_runs() {
    let signed = Options::default().with(&FORM, Form::Signed);
    let post = Options::default().with(&WEIGHTS, Weights::Post);
    let total = Options::default().with(&END_POINT, EndPoint::Total);
    assert_hold_in_runs(["cim-arc", "mindev-arc", "vector-arc"].map(|model| (model, Options::default())));
    assert_hold_in_runs([("ppc-line", signed), ("cim-arc", post), ("dda-line", total)]);
}

fn assert_hold_in_runs(models: impl IntoIterator<Item = (&'static str, Options)>) {
    for (model, choices) in models {
        // Arcs across axes are looked at by themselves.
        let subject: Subject = subject(model, &choices).of_box();
        let mut looked_at = 0;
        for kind in subject.kinds() {
            let (proof, certificate) = subject.prove(&kind).unwrap();
            assert!(proof.is_safe());
            looked_at += subject.holds_in_runs(&kind, &certificate, 7, 12).unwrap();
        }
        assert!(looked_at > 1000, "{model}: {looked_at}");
    }
}
