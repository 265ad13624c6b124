//! Proofs for all widths at once: what must be proved is, what is false is not, and what was proved holds where it was
//! not learnt from.

mod certificates;
mod command;
mod counted;
mod crossings;
mod fixed;
mod induction;
mod invariants;
mod modes;
mod netlists;
mod ramps;
mod sat;
mod truth;
mod widths;

use std::collections::BTreeMap;

use rayon::prelude::*;
use stepwave::study::proof::{Counterexample, Fault, Narrower, Subject, search};
use stepwave_models::options::{BEATS, COMPARE, END_POINT, FORM, PRESET, WEIGHTS, WIDTH};
use stepwave_models::{
    Beats, Claims, EndPoint, Form, Interpolates, Kind, Method, Model, Options, Preset, Weights, find,
};
use stepwave_netlist::formula::{Clause, name};
use stepwave_prove::{Certificate, Proof};

/// Attempts at every kind of geometry, each checked again from its certificate alone.
fn proofs(subject: &Subject) -> Vec<(Kind, Proof)> {
    let prove = |kind: Kind| {
        let (proof, certificate) = subject.prove(&kind).unwrap();
        assert_eq!(subject.check(&kind, &certificate).unwrap(), proof, "{}", kind.name);
        (kind, proof)
    };
    subject.kinds().into_par_iter().map(prove).collect()
}

fn subject(model: &str, choices: &Options) -> Subject {
    Subject::new(find(model).unwrap(), choices, &Narrower::new()).unwrap()
}

/// Everything is proved for every kind: no overflow, the exact end, and, if `ends`, that it is reached.
fn assert_proved(model: &str, subject: &Subject, ends: bool) {
    let (least, greatest) = subject.ks();
    assert!(least == 3 && greatest == 52, "{model}: {least} to {greatest}");
    for (kind, proof) in proofs(subject) {
        let what = format!("{model}, {}: {proof:#?}", kind.name);
        assert!(proof.is_safe(), "{what}");
        assert_eq!(proof.endless.is_none(), ends, "{what}");
        assert!(proof.contradictions > 10 && !proof.invariants.is_empty(), "{what}");
    }
}

fn beats() -> [Options; 2] {
    [Beats::Four, Beats::One].map(|beats| Options::default().with(&BEATS, beats))
}

#[test]
fn lines_are_proved_for_every_width_in_four_beats_and_in_one() {
    for choices in beats() {
        for model in ["ppc-line", "cim-line", "mindev-line", "vector-line"] {
            assert_proved(model, &subject(model, &choices), true);
        }
        assert_proved("bresenham", &subject("bresenham", &Options::default()), true);
        for form in [Form::Magnitude, Form::Signed] {
            for end_point in [EndPoint::Total, EndPoint::PerAxis, EndPoint::Longest] {
                let choices = choices.clone().with(&FORM, form).with(&END_POINT, end_point);
                assert_proved("ppc-line", &subject("ppc-line", &choices), true);
            }
        }
    }
}

#[test]
fn arcs_inside_a_quadrant_are_proved_for_every_width_in_both_directions() {
    for (choices, weights) in beats().into_iter().zip([Weights::Mid, Weights::Post]) {
        assert_proved("ppc-arc", &subject("ppc-arc", &choices).of_box(), true);
        assert_proved("cim-arc", &subject("cim-arc", &choices.with(&WEIGHTS, weights)), true);
    }
    for (choices, end_point) in beats().into_iter().zip([EndPoint::Total, EndPoint::PerAxis]) {
        assert_diagonal_steps_are_proved(&choices.with(&END_POINT, end_point));
    }
}

#[test]
#[ignore = "exhaustive"]
fn arcs_are_proved_with_weights_of_every_kind_in_four_beats_and_in_one() {
    for choices in beats() {
        for weights in [Weights::Mid, Weights::Pre, Weights::Post] {
            assert_proved("cim-arc", &subject("cim-arc", &choices.clone().with(&WEIGHTS, weights)), true);
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn arcs_with_diagonal_steps_are_proved_by_both_counters_in_four_beats_and_in_one() {
    for (choices, end_point) in beats().into_iter().zip([EndPoint::PerAxis, EndPoint::Total]) {
        assert_diagonal_steps_are_proved(&choices.with(&END_POINT, end_point));
    }
}

fn assert_diagonal_steps_are_proved(choices: &Options) {
    for model in DIAGONAL {
        assert_proved(model, &subject(model, choices).of_box(), true);
    }
}

/// Arcs with diagonal steps.
const DIAGONAL: [&str; 2] = ["mindev-arc", "vector-arc"];

/// With one pulse left of both axes a diagonal step would count one too many.
#[test]
fn an_end_point_is_not_proved_without_what_diagonal_steps_need_of_it() {
    for model in DIAGONAL {
        let model = find(model).unwrap();
        let claims = Claims { guesses: |_, _| Vec::new(), ..model.claims.unwrap() };
        let Interpolates::Arcs(Method { plan, load }) = model.interpolates else { panic!("{model:?}") };
        let interpolates = Interpolates::Arcs(Method { plan, load });
        let without = Box::leak(Box::new(Model { claims: Some(claims), interpolates, ..*model }));
        let subject = Subject::new(without, &Options::default(), &Narrower::new()).unwrap();
        let (proof, _) = subject.prove(&subject.kinds()[0]).unwrap();
        assert!(proof.violated.iter().any(|(claim, _)| subject.claim(*claim).ends_with(".e")), "{proof:#?}");
    }
}

/// With a clause less, and with one that says 9 more, which is wrong of small circles.
#[test]
fn a_changed_certificate_of_diagonal_steps_is_refused() {
    for model in DIAGONAL {
        let (subject, text) = certified(model);
        let kind = subject.kinds().remove(0);
        let is_safe = |text: &str| subject.check(&kind, &text.parse::<Certificate>().unwrap()).unwrap().is_safe();
        assert!(is_safe(&text), "{model}");
        let clauses: Vec<&str> = text.lines().filter(|line| line.starts_with("clause")).collect();
        assert!(clauses.len() > 6, "{model}: {clauses:?}");
        for clause in clauses {
            let tighter = clause.replace(" | ", " - 9 | ") + " - 9";
            assert!(!is_safe(&text.replacen(clause, &tighter, 1)), "{model}: {clause}");
            let gone = text.replacen(&format!("{clause}\n"), "", 1);
            assert!(!is_safe(&gone), "{model} without {clause}");
        }
        assert!(!is_safe(&text.replacen("\nanswer (", "\nanswer -\nanswer (", 1)), "{model}");
    }
}

/// What the weights of the pulses sum up to is half of what a polynomial gives.
#[test]
#[ignore = "exhaustive"]
fn weights_on_one_side_of_a_pulse_need_one_bit_less_than_those_of_its_middle() {
    for weights in [Weights::Pre, Weights::Post] {
        let choices = Options::default().with(&WEIGHTS, weights);
        let narrow = |bits| BTreeMap::from([("f".to_owned(), bits)]);
        let subject = |bits| Subject::new(find("cim-arc").unwrap(), &choices, &narrow(bits)).unwrap();
        assert_proved("cim-arc", &subject(1), true);
        let found = refuted("cim-arc", &choices, &narrow(2));
        assert_eq!(found.map(|example| example.fault), Some(Fault::Overflow), "{weights:?}");
        let kind = subject(2).kinds().remove(0);
        assert!(!subject(2).prove(&kind).unwrap().0.is_safe(), "{weights:?}");
    }
    let mid = Options::default();
    assert!(refuted("cim-arc", &mid, &narrower("f")).is_some() && refuted("cim-arc", &mid, &Narrower::new()).is_none());
}

#[test]
fn integrators_are_proved_for_every_width_and_every_preset() {
    assert_integrators_are_proved(Preset::Half);
    assert_proved("dda-line", &subject("dda-line", &Options::default()).with_any_preset(), true);
    assert_proved("dda-arc", &subject("dda-arc", &Options::default()).with_any_preset(), false);
}

#[test]
#[ignore = "exhaustive"]
fn integrators_are_proved_with_remainders_that_begin_empty_or_full() {
    assert_integrators_are_proved(Preset::Zero);
    assert_integrators_are_proved(Preset::Full);
}

fn assert_integrators_are_proved(preset: Preset) {
    let choices = Options::default().with_all(&PRESET, preset);
    assert_proved("dda-line", &subject("dda-line", &choices), true);
    // Of an arc whose remainders begin at their greatest the end is not claimed.
    assert_proved("dda-arc", &subject("dda-arc", &choices), preset != Preset::Full);
}

#[test]
#[ignore = "exhaustive"]
fn lines_of_integrators_end_exactly_by_counters_of_pulses_too() {
    let of = |end_point, preset| Options::default().with(&END_POINT, end_point).with_all(&PRESET, preset);
    for end_point in [EndPoint::PerAxis, EndPoint::Total, EndPoint::Longest] {
        for preset in [Preset::Zero, Preset::Full] {
            assert_proved("dda-line", &subject("dda-line", &of(end_point, preset)), true);
        }
    }
    for end_point in [EndPoint::PerAxis, EndPoint::Total] {
        let any = subject("dda-line", &of(end_point, Preset::Zero)).with_any_preset();
        assert_proved("dda-line", &any, true);
    }
    // The long axis may end early with a preset of its own, but the block always ends.
    let any = subject("dda-line", &of(EndPoint::Longest, Preset::Zero)).with_any_preset();
    for (kind, proof) in proofs(&any) {
        assert!(proof.holds() && !proof.missed.is_empty() && proof.endless.is_none(), "{}: {proof:#?}", kind.name);
    }
    let presets = [("jrx", 3), ("jry", 0)].map(|(name, value)| (name.to_owned(), Preset::Value(value)));
    let apart = of(EndPoint::Longest, Preset::Zero).with_single(&PRESET, presets.into());
    let found = refuted("dda-line", &apart, &Narrower::new()).unwrap();
    assert_eq!((found.fault, found.curve.to()), (Fault::Missed, &[1, 1][..]));
    // Of an arc the total of both axes determines no end.
    assert!(refuted("dda-arc", &of(EndPoint::Total, Preset::Half), &Narrower::new()).is_some());
}

fn narrower(register: &str) -> Narrower {
    BTreeMap::from([(register.to_owned(), 1)])
}

fn refuted(model: &str, choices: &Options, narrower: &Narrower) -> Option<Counterexample> {
    let model = find(model).unwrap();
    let claims = model.claims.unwrap();
    search(model, &claims, choices, narrower, 2..=5, |_| true).found
}

#[test]
fn a_deviation_one_bit_narrower_is_refuted_by_a_run_and_never_proved() {
    for model in
        ["ppc-line", "ppc-arc", "cim-line", "cim-arc", "mindev-line", "vector-line"].into_iter().chain(DIAGONAL)
    {
        let found = refuted(model, &Options::default(), &narrower("f"));
        assert_eq!(found.map(|example| example.fault), Some(Fault::Overflow), "{model}");
    }
    // The counters of early firmware: too narrow, and the wrong test.
    let found = refuted("bresenham", &Options::default(), &narrower("cnt"));
    assert_eq!(found.map(|example| example.fault), Some(Fault::Overflow));
    let gt = Options::default().with(&COMPARE, stepwave_models::Compare::Greater);
    let model = find("bresenham").unwrap();
    let found = search(model, &model.claims.unwrap(), &gt, &Narrower::new(), 1..=2, |_| true).found.unwrap();
    assert_eq!((found.fault, found.curve.to()), (Fault::Missed, &[0, 1][..]));
    let signed = Options::default().with(&FORM, Form::Signed);
    let longest = signed.clone().with(&END_POINT, EndPoint::Longest);
    for choices in [&signed, &longest] {
        let found = refuted("ppc-line", choices, &narrower("f"));
        assert_eq!(found.map(|example| example.fault), Some(Fault::Overflow));
    }
    // The proof itself refuses too.
    let default = Options::default();
    for (model, choices) in
        [("ppc-line", &default), ("mindev-line", &default), ("ppc-line", &signed), ("ppc-line", &longest)]
    {
        let subject = Subject::new(find(model).unwrap(), choices, &narrower("f")).unwrap();
        for (kind, proof) in proofs(&subject) {
            assert!(proof.violated.iter().any(|(claim, _)| subject.claim(*claim).ends_with(".f")), "{}", kind.name);
        }
    }
}

#[test]
fn a_position_counter_without_its_sign_is_never_proved() {
    // Its adder reports an overflow by its own flag, not by a wider sum.
    let two_less = BTreeMap::from([("x".to_owned(), 2)]);
    let subject = Subject::new(find("ppc-line").unwrap(), &Options::default(), &two_less).unwrap();
    for (kind, proof) in proofs(&subject) {
        assert!(proof.violated.iter().any(|(claim, _)| subject.claim(*claim).ends_with(".x")), "{}", kind.name);
    }
}

#[test]
fn nothing_is_refuted_at_the_widths_that_are_proved() {
    let others = ["ppc-line", "ppc-arc", "cim-line", "cim-arc", "mindev-line", "vector-line", "dda-line", "dda-arc"];
    for model in others.into_iter().chain(DIAGONAL) {
        assert_eq!(refuted(model, &Options::default(), &Narrower::new()), None, "{model}");
    }
}

#[test]
fn an_end_point_that_is_one_off_is_not_proved() {
    let default = Options::default();
    let signed = Options::default().with(&FORM, Form::Signed).with(&END_POINT, EndPoint::Longest);
    let pre = Options::default().with(&WEIGHTS, Weights::Pre);
    let total = Options::default().with(&END_POINT, EndPoint::Total);
    for (model, symbol, choices) in [
        ("ppc-line", "|dx|", &default),
        ("ppc-line", "|dx|", &signed),
        ("dda-line", "|dx|", &default),
        ("dda-line", "|dx|", &total),
        ("ppc-arc", "xt", &default),
        ("cim-arc", "xt", &default),
        ("cim-arc", "xt", &pre),
        ("mindev-arc", "xt", &default),
        ("vector-arc", "xt", &default),
    ] {
        let subject = subject(model, choices);
        let mut kind = subject.kinds().remove(0);
        kind.goals = vec![Clause::at_least_zero("x ends beyond", name("x") - name(symbol) - 1)];
        let (proof, certificate) = subject.prove(&kind).unwrap();
        assert!(proof.holds() && !proof.is_safe() && proof.missed.len() == 1, "{model}: {proof:#?}");
        // The certificate of the wrong goal does not do for it either.
        assert!(!subject.check(&kind, &certificate).unwrap().is_safe(), "{model}");
    }
}

/// What is not proved of a model's first kind of arcs whose ends need not be on one circle.
fn off_its_circle(model: &str, choices: &Options) -> Proof {
    let subject = subject(model, choices);
    let mut kind = subject.kinds().remove(0);
    let before = kind.premises.len();
    kind.premises.retain(|premise| premise.name != "both ends are on one circle");
    assert_eq!(kind.premises.len(), before - 2);
    subject.prove(&kind).unwrap().0
}

#[test]
#[ignore = "exhaustive"]
fn an_arc_that_ends_off_its_circle_is_not_proved_with_one_counter() {
    let total = Options::default().with(&END_POINT, EndPoint::Total);
    let proof = off_its_circle("ppc-arc", &total);
    assert!(!proof.is_safe(), "{proof:#?}");
}

#[test]
fn weights_on_one_side_of_a_pulse_are_not_bounded_off_the_circle() {
    let proof = off_its_circle("cim-arc", &Options::default().with(&WEIGHTS, Weights::Pre));
    assert!(!proof.is_safe(), "{proof:#?}");
}

#[test]
fn a_line_along_y_is_what_the_bare_form_cannot_do() {
    let bare = Options::default().with(&FORM, Form::Bare);
    let example = refuted("ppc-line", &bare, &Narrower::new()).unwrap();
    assert_eq!((example.fault, example.curve.to()), (Fault::Missed, &[0, 1][..]));
    assert!(proofs(&subject("ppc-line", &bare)).iter().all(|(_, proof)| !proof.missed.is_empty()));
}

#[test]
fn unequal_presets_bring_an_arc_to_a_stand() {
    let presets = [("jrx", 12), ("jry", 0)].map(|(name, value)| (name.to_owned(), Preset::Value(value)));
    let choices = Options::default().with_single(&PRESET, presets.into());
    let model = find("dda-arc").unwrap();
    let example =
        search(model, &model.claims.unwrap(), &choices, &Narrower::new(), 4..=4, |fault| fault == Fault::Endless);
    let example = example.found.unwrap();
    assert_eq!(example.k, 4);
    // The one of the literature is among them, by the simulator.
    let arc = crate::models::arc([3, 4], [0, 5], [0, 0], false);
    let wide = choices.with_all(&WIDTH, stepwave_netlist::Width::new(4).ok());
    let bench = stepwave::testbench::Testbench::new(model, &arc, &wide).unwrap();
    let outcome = bench.run(stepwave_engine::EngineKind::Word, &mut []).unwrap();
    assert!(matches!(outcome.ending, stepwave::testbench::Ending::Stalled { .. }), "{outcome:?}");
    assert_eq!(outcome.reached, [0, 4]);
}

/// A model with the certificate of its first kind of geometry.
fn certified(model: &str) -> (Subject, String) {
    let subject = subject(model, &Options::default());
    let (proof, certificate) = subject.prove(&subject.kinds()[0]).unwrap();
    assert!(proof.is_safe(), "{proof:#?}");
    (subject, certificate.to_string())
}

#[test]
fn a_certificate_that_was_changed_is_refused() {
    let (subject, text) = certified("ppc-line");
    let kind = subject.kinds().remove(0);
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let certificate: Certificate = text.replacen(from, to, 1).parse().unwrap();
        subject.check(&kind, &certificate).unwrap()
    };
    // An answer left out, one that shows nothing, an invariant that does not hold.
    assert!(!changed("\nanswer (", "\nanswer -\nanswer (").is_safe());
    assert!(!changed("answer (1*", "answer (2*").is_safe());
    let clause = text.lines().find(|line| line.starts_with("clause")).unwrap();
    assert!(!changed(clause, &format!("{clause} - 1")).is_safe());
    let equal = text.lines().find(|line| line.starts_with("equal")).unwrap();
    assert!(!changed(equal, &format!("{equal} + 1")).is_safe());
    assert!(!subject.check(&kind, &Certificate::default()).unwrap().holds());
    assert!(!changed("equal v", "equal v999 0\nequal v").holds());
}

#[test]
fn a_deviation_that_is_twice_a_polynomial_is_not_taken_for_another() {
    let pre = Options::default().with(&WEIGHTS, Weights::Pre);
    let subject = subject("cim-arc", &pre);
    let kind = subject.kinds().remove(0);
    let (proof, certificate) = subject.prove(&kind).unwrap();
    assert!(proof.is_safe(), "{proof:#?}");
    let text = certificate.to_string();
    let twice: Vec<&str> = text.lines().filter(|line| line.starts_with("clause") && line.contains("2*")).collect();
    // 2f from below and from above, with either base axis.
    assert_eq!(twice.len(), 4, "{twice:?}");
    for line in twice {
        let changed: Certificate = text.replacen(line, &format!("{line} - 1"), 1).parse().unwrap();
        assert!(!subject.check(&kind, &changed).unwrap().is_safe(), "{line}");
    }
}
