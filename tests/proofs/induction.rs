//! Steps that keep a proof from being one: shown where something is not proved, and never where everything is.

use stepwave::study::proof::{CounterexampleToInduction, InductionSearch, Narrower, Subject};
use stepwave::testbench::Start;
use stepwave_engine::{Engine, EngineKind, Rows, Watch};
use stepwave_models::{Kind, Machine, Options, find};
use stepwave_netlist::formula::{Clause, name};

use super::{beats, narrower, subject};

/// What keeps an attempt at a kind of geometry from being a proof.
fn searched(subject: &Subject, kind: &Kind) -> InductionSearch {
    let (proof, certificate) = subject.prove(kind).unwrap();
    assert!(proof.holds(), "{}: {proof:#?}", kind.name);
    subject.counterexample_to_induction(&[(kind, &certificate)]).unwrap()
}

/// The machine of coordinates of k bits, some registers narrower.
fn machine(model: &str, k: u32, narrower: &Narrower) -> Machine {
    let model = find(model).unwrap();
    let claims = model.claims.unwrap();
    let choices = stepwave::study::proof::choices_at(model, &claims, &Options::default(), narrower, k).unwrap();
    model.machine(&model.plan(&claims.geometries.largest(k).unwrap(), &choices).unwrap()).unwrap()
}

/// The judge of engines, put in a state.
fn gates(machine: &Machine, start: &Start) -> Box<dyn Engine> {
    let mut engine = EngineKind::Gates.build(&machine.design, &Watch::default());
    engine.restore(0, &start.registers, &start.inputs, &[]);
    engine
}

fn held(step: &CounterexampleToInduction, register: &str) -> i128 {
    step.state.iter().find(|(name, _)| name == register).unwrap().1
}

#[test]
fn no_state_that_the_invariants_of_a_proof_allow_shows_anything_wrong() {
    for choices in beats() {
        for model in ["ppc-line", "ppc-arc", "cim-line", "mindev-line", "vector-line", "mindev-arc", "vector-arc"] {
            let subject = subject(model, &choices);
            let kind = subject.kinds().remove(0);
            let InductionSearch { found, tried } = searched(&subject, &kind);
            assert!(found.is_none() && tried > 100, "{model}, {tried}: {found:?}");
        }
    }
    let any = subject("dda-line", &Options::default()).with_any_preset();
    let InductionSearch { found, tried } = searched(&any, &any.kinds()[0]);
    assert!(found.is_none() && tried > 50, "{tried}: {found:?}");
}

#[test]
fn a_goal_that_is_one_off_is_missed_by_a_step_that_ends_before_it() {
    for (model, symbol) in [("ppc-line", "|dx|"), ("ppc-arc", "xt"), ("cim-arc", "xt")] {
        let subject = subject(model, &Options::default());
        let mut kind = subject.kinds().remove(0);
        kind.goals = vec![Clause::at_least_zero("x ends beyond", name("x") - name(symbol) - 1)];
        let step = searched(&subject, &kind).found.unwrap();
        assert_eq!((step.wrong.as_str(), step.k), ("the block ends, but x ends beyond does not hold", 3), "{model}");
        let machine = machine(model, 3, &Narrower::new());
        let mut engine = gates(&machine, &step.start);
        for clock in 1..=step.clocks {
            assert_eq!(engine.value(machine.done.net), 0, "{model} at clock {}", clock - 1);
            engine.run(1, &mut Rows::new(0, 0));
        }
        assert_eq!(engine.value(machine.done.net), 1, "{model}");
        let x = machine.positions[0];
        let reached = x.reading.number(x.width, engine.value(x.net));
        assert_eq!(reached, i128::from(step.curve.to()[0]), "{model}");
    }
}

#[test]
fn an_overflow_comes_from_a_state_that_satisfies_the_textbook() {
    let subject = Subject::new(find("ppc-line").unwrap(), &Options::default(), &narrower("f")).unwrap();
    let mut kind = subject.kinds().remove(0);
    // Ends are missed too.
    kind.goals.clear();
    let step = searched(&subject, &kind).found.unwrap();
    assert_eq!(step.wrong, "ppc_line.f overflows");
    // F = xe·y - ye·x, and E counts the steps that are left.
    let [x, y, f, e] = ["x", "y", "f", "e"].map(|register| held(&step, register));
    let [xe, ye] = [0, 1].map(|axis| i128::from(step.curve.to()[axis]));
    assert_eq!((f, e), (xe * y - ye * x, xe + ye - x - y), "{step:?}");
    let machine = machine("ppc-line", step.k, &narrower("f"));
    let mut engine = gates(&machine, &step.start);
    let violated = |engine: &dyn Engine| {
        let mut properties = machine.design.netlist().properties.iter();
        properties.any(|property| engine.value(property.never) == 1)
    };
    for clock in 1..=step.clocks {
        assert!(!violated(engine.as_ref()), "clock {}", clock - 1);
        engine.run(1, &mut Rows::new(0, 0));
    }
    assert!(violated(engine.as_ref()));
}
