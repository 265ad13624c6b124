//! Arcs that cross axes: the kinds hold each of them once, the machine does what is proved of it, and what is false is not
//! proved.

use std::collections::BTreeSet;

use rayon::prelude::*;
use stepwave::study::proof::{Narrower, Subject, choices_at, search};
use stepwave::testbench::{Ending, Testbench};
use stepwave_models::options::END_POINT;
use stepwave_models::{Claims, EndPoint, Kind, Options, Region, find};
use stepwave_nc::Curve;
use stepwave_netlist::formula::{Clause, name};
use stepwave_prove::{Certificate, Proof};

use super::{assert_proved, beats, narrower, subject};
use crate::models::arc;
use crate::reference;

/// One kind of each number of axes, of both directions and from every quadrant.
const SOME: [&str; 4] = ["SR3 over 1 axis", "NR4 over 2 axes", "SR2 over 3 axes", "NR1 over 4 axes"];

/// From, to, clockwise.
type Ends = ([i64; 2], [i64; 2], bool);

/// Every arc about the origin between two points of one circle with coordinates up to this, both ways round.
fn every_arc(most: i64) -> Vec<Ends> {
    let points = || (-most..=most).flat_map(|x| (-most..=most).map(move |y| [x, y])).filter(|point| *point != [0, 0]);
    let square = |[x, y]: [i64; 2]| x * x + y * y;
    let from = |from: [i64; 2]| {
        let ends = points().filter(move |to| square(*to) == square(from));
        ends.flat_map(move |to| [true, false].map(|clockwise| (from, to, clockwise)))
    };
    points().flat_map(from).collect()
}

/// The greatest coordinate of the path of an arc, and where it crosses axes, by the recurrence of the reference.
fn course((from, to, clockwise): Ends) -> (i64, Vec<i64>) {
    let table = reference::ppc_arc(from, to, [0, 0], clockwise, reference::EndPoint::Total);
    let quadrants = table.column("quad");
    let farthest: Vec<i64> = table.path().iter().map(|[x, y]| x.abs().max(y.abs())).collect();
    let turns = (1..quadrants.len()).filter(|row| quadrants[*row] != quadrants[row - 1]);
    (farthest.iter().copied().max().unwrap(), turns.map(|row| farthest[row - 1]).collect())
}

/// Those of them whose path stays within k bits.
fn arcs_within(k: u32) -> Vec<Ends> {
    let most = (1 << k) - 1;
    every_arc(most).into_iter().filter(|ends| course(*ends).0 <= most).collect()
}

fn curve((from, to, clockwise): Ends) -> Curve {
    arc(from, to, [0, 0], clockwise)
}

/// What is claimed of the hardware of every k with one counter of all pulses.
fn claims() -> Claims {
    Claims { geometries: Region::Arcs, ..find("ppc-arc").unwrap().claims.unwrap() }
}

fn kind(subject: &Subject, name: &str) -> Kind {
    subject.kinds().into_iter().find(|kind| kind.name == name).unwrap()
}

/// An attempt, which the certificate alone must come to as well.
fn proved(subject: &Subject, kind: &Kind) -> (Proof, Certificate) {
    let (proof, certificate) = subject.prove(kind).unwrap();
    if proof.holds() {
        assert_eq!(subject.check(kind, &certificate).unwrap(), proof, "{}", kind.name);
    }
    (proof, certificate)
}

fn assert_kinds_hold_each_arc_once(k: u32) {
    let most = (1 << k) - 1;
    let kinds = Region::Arcs.kinds();
    assert_eq!(kinds.iter().map(|kind| &kind.name).collect::<BTreeSet<_>>().len(), 40);
    let own = |ends: Ends| {
        let (farthest, crossed) = course(ends);
        let arc = curve(ends);
        let all = kinds.iter().filter_map(|kind| Some((kind, Region::Arcs.symbols(kind, &arc)?)));
        let [(kind, numbers)] = &all.collect::<Vec<_>>()[..] else { panic!("{ends:?} is of no kind, or of two") };
        let over = format!(" over {} ax", crossed.len());
        assert!(
            if crossed.is_empty() { kind.name.len() == 3 } else { kind.name.contains(&over) },
            "{ends:?}: {kind:?}"
        );
        let (from, to, clockwise) = ends;
        assert!(kind.name.starts_with(if clockwise { "SR" } else { "NR" }), "{ends:?}: {}", kind.name);
        let magnitudes = [from[0], from[1], to[0], to[1]].map(|c| i128::from(c.abs()));
        assert_eq!(numbers[..4], magnitudes, "{ends:?}");
        // Every axis is crossed at one distance, the fifth number.
        assert!(crossed.iter().all(|axis| numbers[4] == i128::from(*axis)), "{ends:?}: {numbers:?} {crossed:?}");
        // The numbers are within k bits where the path is.
        assert_eq!(numbers.iter().all(|number| *number <= most.into()), farthest <= most, "{ends:?}: {numbers:?}");
    };
    every_arc(most).into_par_iter().for_each(own);
    // What is simulated of k bits are these arcs, each once.
    let listed = Region::Arcs.curves(k, usize::MAX);
    let written = |curve: &Curve| format!("{curve:?}");
    let all: BTreeSet<String> = arcs_within(k).into_iter().map(|ends| written(&curve(ends))).collect();
    assert!(Region::Arcs.is_whole(k) && listed.len() == all.len(), "{} of {}", listed.len(), all.len());
    assert_eq!(listed.iter().map(written).collect::<BTreeSet<_>>(), all);
}

#[test]
fn kinds_of_arcs_hold_every_arc_of_few_bits_once() {
    (1..=3).for_each(assert_kinds_hold_each_arc_once);
}

#[test]
#[ignore = "exhaustive"]
fn kinds_of_arcs_hold_every_arc_of_four_bits_once() {
    assert_kinds_hold_each_arc_once(4);
}

#[test]
fn arcs_across_axes_end_exactly_on_the_machine_that_is_proved() {
    let model = find("ppc-arc").unwrap();
    let survey = search(model, &claims(), &Options::default(), &Narrower::new(), 1..=4, |_| true);
    assert_eq!(survey.found, None);
    for (k, tried) in (1..).zip(survey.tried) {
        let all: Vec<Curve> = arcs_within(k).into_iter().map(curve).collect();
        assert!(tried.is_whole() && tried.geometries == all.len(), "{tried:?}, {} arcs", all.len());
        // The same by hardware for the quarter circle, by whose widths the proof goes.
        let box_claims = model.claims.unwrap();
        let choices = choices_at(model, &box_claims, &Options::default(), &Narrower::new(), k).unwrap();
        let hardware = model.plan(&box_claims.geometries.largest(k).unwrap(), &choices).unwrap();
        assert_eq!(hardware.get(&END_POINT), EndPoint::Total);
        let bench = Testbench::of_hardware(model, hardware).unwrap();
        for (curve, outcome) in all.iter().zip(bench.run_many(&all, 1 << 12).unwrap()) {
            let outcome = outcome.unwrap();
            assert_eq!((outcome.ending, outcome.overflows), (Some(Ending::Done), 0), "{curve:?}");
            assert_eq!(outcome.reached, curve.to(), "{curve:?}");
        }
    }
}

#[test]
fn arcs_across_axes_are_proved_for_every_width() {
    let subject = subject("ppc-arc", &Options::default());
    assert_eq!((subject.ks(), subject.is_whole()), ((3, 52), true));
    SOME.par_iter().for_each(|name| {
        let kind = kind(&subject, name);
        let (proof, certificate) = proved(&subject, &kind);
        assert!(proof.is_safe() && proof.endless.is_none() && proof.contradictions > 100, "{name}: {proof:#?}");
        // In runs of a width that nothing was learnt from.
        assert!(subject.holds_in_runs(&kind, &certificate, 7, 4).unwrap() > 200, "{name}");
    });
    let (proof, _) = proved(&subject, &kind(&subject, "NR1 over 4 axes"));
    // From (g, s), which grow and shrink, to (g', s') there are s - g + 2 m for each of four axes + g' - s' steps.
    for invariant in [
        "quad = 0: changes = 0: e = -y + x + 8*axis + yt - xt",
        "quad = 1: changes = 1: e = y + x + 6*axis + yt - xt",
        "quad = 2: changes = 2: e = y - x + 4*axis + yt - xt",
        "quad = 3: changes = 3: e = -y - x + 2*axis + yt - xt",
        "quad = 0: changes = 4: e = -y + x + yt - xt",
    ] {
        assert!(proof.invariants.iter().any(|own| own == invariant), "{invariant}: {:#?}", proof.invariants);
    }
}

#[test]
#[ignore = "exhaustive"]
fn arcs_of_every_kind_are_proved_for_every_width_in_four_beats_and_in_one() {
    for choices in beats() {
        let subject = subject("ppc-arc", &choices);
        assert_eq!(subject.kinds().len(), 40);
        assert_proved("ppc-arc", &subject, true);
    }
}

#[test]
fn an_arc_across_axes_is_not_proved_without_what_it_needs() {
    let all = subject("ppc-arc", &Options::default());
    let is_safe = |subject: &Subject, kind: &Kind| proved(subject, kind).0.is_safe();
    let without = |name: &str, premise: &str| {
        let mut kind = kind(&all, name);
        let before = kind.premises.len();
        kind.premises.retain(|clause| clause.name != premise);
        assert!(kind.premises.len() < before, "{premise}");
        kind
    };
    // Both ends are on the circle, and an axis is crossed where the path does.
    assert!(!is_safe(&all, &without(SOME[0], "both ends are on one circle")));
    assert!(!is_safe(&all, &without(SOME[0], "an axis is crossed as soon as that")));
    // The end point is what it is.
    let mut beyond = kind(&all, SOME[3]);
    beyond.goals = vec![Clause::at_least_zero("x ends beyond", name("x") - name("xt") - 1)];
    let (proof, certificate) = proved(&all, &beyond);
    assert!(proof.holds() && proof.missed.len() == 1, "{proof:#?}");
    assert!(!all.check(&beyond, &certificate).unwrap().is_safe());
    // One quadrant less, and the coordinate that grows is another.
    let mut other = kind(&all, SOME[1]);
    other.by_mode[0].values = other.by_mode[0].values.iter().map(|grows| 1 - grows).collect();
    let (proof, _) = proved(&all, &other);
    assert!(!proof.holds() && !proof.not_inductive.is_empty(), "{proof:#?}");
}

#[test]
fn a_register_one_bit_too_narrow_is_refuted_by_an_arc_across_axes() {
    let model = find("ppc-arc").unwrap();
    let crossing = Claims { geometries: Region::CrossingArcs, ..claims() };
    for register in ["f", "e", "xi"] {
        let found = search(model, &crossing, &Options::default(), &narrower(register), 1..=3, |_| true).found;
        let found = found.unwrap_or_else(|| panic!("{register}"));
        assert!(matches!(&found.curve, Curve::Arc(arc) if arc.crossings() > 0), "{register}: {found:?}");
    }
    let narrow = Subject::new(model, &Options::default(), &narrower("f")).unwrap();
    let (proof, _) = proved(&narrow, &kind(&narrow, SOME[0]));
    assert!(proof.violated.iter().any(|(claim, _)| narrow.claim(*claim).ends_with(".f")), "{proof:#?}");
}

#[test]
fn a_changed_certificate_of_an_arc_across_axes_is_refused() {
    let subject = subject("ppc-arc", &Options::default());
    let kind = kind(&subject, SOME[3]);
    let (proof, certificate) = proved(&subject, &kind);
    assert!(proof.is_safe());
    let text = certificate.to_string();
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let certificate: Certificate = text.replacen(from, to, 1).parse().unwrap();
        subject.check(&kind, &certificate).unwrap()
    };
    // In the first quadrant again after four changes; without the count, with another one, as another quadrant, twice.
    for (from, to) in [
        ("modes 0 4\n", "modes 0\n"),
        ("modes 0 4\n", "modes 0 5\n"),
        ("modes 0 4\n", "modes 2 4\n"),
        ("modes 0 4\n", "modes 0 0\n"),
        ("modes 1 1\n", "modes 3 1\n"),
    ] {
        assert!(!changed(from, to).holds(), "{from} {to}");
    }
    // The first pass takes what is proved of the last, which has fewer steps to go.
    let first = text.lines().find(|line| line.starts_with("equal") && line.contains(" + 8*")).unwrap();
    let (_, last) = text.split_once("modes 0 4\n").unwrap();
    let register = first.split(' ').nth(1).unwrap();
    let last = last.lines().find(|line| line.starts_with(&format!("equal {register} "))).unwrap();
    assert!(!last.contains('8') && !changed(first, last).is_safe(), "{first} {last}");
    for line in text.lines().filter(|line| line.starts_with("clause")).take(4) {
        assert!(!changed(line, &(line.replace(" | ", " - 1 | ") + " - 1")).is_safe(), "{line}");
    }
    assert!(!changed("\nanswer (", "\nanswer -\nanswer (").is_safe());
}
