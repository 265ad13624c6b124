//! Arcs that cross axes: the kinds hold each of them once, the machine does what is proved of it, and what is false is not
//! proved.

use std::collections::BTreeSet;

use rayon::prelude::*;
use stepwave::study::proof::{Narrower, Subject, choices_at, search};
use stepwave::testbench::{Ending, Testbench};
use stepwave_models::options::END_POINT;
use stepwave_models::{Claims, EndPoint, Kind, Options, Region, find};
use stepwave_nc::{Crossing, Curve};
use stepwave_netlist::formula::{Clause, name};
use stepwave_prove::{Certificate, Proof};

use super::{assert_proved, beats, narrower, subject};
use crate::models::arc;
use crate::reference;

/// One kind of each number of axes, of both directions and from every quadrant.
const SOME: [&str; 4] = ["SR3 over 1 axis", "NR4 over 2 axes", "SR2 over 3 axes", "NR1 over 4 axes"];

/// From, to, clockwise.
type Ends = ([i64; 2], [i64; 2], bool);

/// From, to, centre, clockwise.
type Recurrence = fn([i64; 2], [i64; 2], [i64; 2], bool, reference::EndPoint) -> reference::Table;

/// A model that crosses axes by itself.
#[derive(Clone, Copy)]
struct Arcs {
    model: &'static str,
    crossing: Crossing,
    reference: Recurrence,
}

const PPC: Arcs = Arcs { model: "ppc-arc", crossing: Crossing::PathExtreme, reference: reference::ppc_arc };
const MINDEV: Arcs = Arcs { model: "mindev-arc", crossing: Crossing::RoundedRadius, reference: reference::mindev_arc };
const VECTOR: Arcs = Arcs { model: "vector-arc", crossing: Crossing::PathExtreme, reference: reference::vector_arc };
const ALL: [Arcs; 3] = [PPC, MINDEV, VECTOR];

impl Arcs {
    fn region(self) -> Region {
        Region::Arcs(self.crossing)
    }

    /// What is claimed of the hardware of every k with one counter of all pulses.
    fn claims(self) -> Claims {
        Claims { geometries: self.region(), ..find(self.model).unwrap().claims.unwrap() }
    }

    /// The greatest coordinate of the path of an arc, and where it crosses axes, by the recurrence of the reference.
    fn course(self, (from, to, clockwise): Ends) -> (i64, Vec<i64>) {
        let table = (self.reference)(from, to, [0, 0], clockwise, reference::EndPoint::Total);
        let quadrants = table.column("quad");
        let farthest: Vec<i64> = table.path().iter().map(|[x, y]| x.abs().max(y.abs())).collect();
        let turns = (1..quadrants.len()).filter(|row| quadrants[*row] != quadrants[row - 1]);
        (farthest.iter().copied().max().unwrap(), turns.map(|row| farthest[row - 1]).collect())
    }

    /// Those arcs whose path stays within k bits.
    fn within(self, k: u32) -> Vec<Ends> {
        let most = (1 << k) - 1;
        every_arc(most).into_iter().filter(|ends| self.course(*ends).0 <= most).collect()
    }
}

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

fn curve((from, to, clockwise): Ends) -> Curve {
    arc(from, to, [0, 0], clockwise)
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

fn assert_kinds_hold_each_arc_once(arcs: Arcs, k: u32) {
    let most = (1 << k) - 1;
    let kinds = arcs.region().kinds();
    assert_eq!(kinds.iter().map(|kind| &kind.name).collect::<BTreeSet<_>>().len(), 40);
    let own = |ends: Ends| {
        let (farthest, crossed) = arcs.course(ends);
        let arc = curve(ends);
        let all = kinds.iter().filter_map(|kind| Some((kind, arcs.region().symbols(kind, &arc)?)));
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
    let listed = arcs.region().curves(k, usize::MAX);
    let written = |curve: &Curve| format!("{curve:?}");
    let all: BTreeSet<String> = arcs.within(k).into_iter().map(|ends| written(&curve(ends))).collect();
    assert!(arcs.region().is_whole(k) && listed.len() == all.len(), "{} of {}", listed.len(), all.len());
    assert_eq!(listed.iter().map(written).collect::<BTreeSet<_>>(), all);
}

#[test]
fn kinds_of_arcs_hold_every_arc_of_few_bits_once() {
    ALL.iter().for_each(|arcs| (1..=3).for_each(|k| assert_kinds_hold_each_arc_once(*arcs, k)));
}

#[test]
#[ignore = "exhaustive"]
fn kinds_of_arcs_hold_every_arc_of_four_bits_once() {
    [PPC, MINDEV].iter().for_each(|arcs| assert_kinds_hold_each_arc_once(*arcs, 4));
}

fn assert_arcs_end_exactly(arcs: Arcs, k: u32) {
    let model = find(arcs.model).unwrap();
    let survey = search(model, &arcs.claims(), &Options::default(), &Narrower::new(), k..=k, |_| true);
    assert_eq!(survey.found, None);
    let all: Vec<Curve> = arcs.within(k).into_iter().map(curve).collect();
    let [tried] = &survey.tried[..] else { panic!("{survey:?}") };
    assert!(tried.is_whole() && tried.geometries == all.len(), "{tried:?}, {} arcs", all.len());
    // The same by hardware for the quarter circle, by whose widths the proof goes.
    let box_claims = model.claims.unwrap();
    let choices = choices_at(model, &box_claims, &Options::default(), &Narrower::new(), k).unwrap();
    let hardware = model.plan(&box_claims.geometries.largest(k).unwrap(), &choices).unwrap();
    assert_eq!(hardware.get(&END_POINT), EndPoint::Total);
    let bench = Testbench::of_hardware(model, hardware).unwrap();
    for (curve, outcome) in all.iter().zip(bench.run_many(&all, 1 << 12).unwrap()) {
        let outcome = outcome.unwrap();
        assert_eq!((outcome.ending, outcome.overflows), (Some(Ending::Done), 0), "{}: {curve:?}", arcs.model);
        assert_eq!(outcome.reached, curve.to(), "{}: {curve:?}", arcs.model);
    }
}

#[test]
fn arcs_across_axes_end_exactly_on_the_machine_that_is_proved() {
    (1..=4).for_each(|k| assert_arcs_end_exactly(PPC, k));
    [MINDEV, VECTOR].iter().for_each(|arcs| (1..=3).for_each(|k| assert_arcs_end_exactly(*arcs, k)));
}

#[test]
#[ignore = "exhaustive"]
fn arcs_of_diagonal_steps_across_axes_end_exactly_on_the_machine_that_is_proved() {
    [MINDEV, VECTOR].iter().for_each(|arcs| assert_arcs_end_exactly(*arcs, 4));
}

fn assert_is_proved(arcs: Arcs, names: &[&str]) {
    let subject = subject(arcs.model, &Options::default());
    assert_eq!((subject.ks(), subject.is_whole()), ((3, 52), true));
    names.par_iter().for_each(|name| {
        let kind = kind(&subject, name);
        let (proof, certificate) = proved(&subject, &kind);
        let what = format!("{}, {name}: {proof:#?}", arcs.model);
        assert!(proof.is_safe() && proof.endless.is_none() && proof.contradictions > 100, "{what}");
        // In runs of a width that nothing was learnt from.
        assert!(subject.holds_in_runs(&kind, &certificate, 7, 4).unwrap() > 150, "{what}");
    });
}

#[test]
fn arcs_across_axes_are_proved_for_every_width() {
    assert_is_proved(PPC, &SOME);
    assert_is_proved(MINDEV, &SOME[..1]);
    assert_is_proved(VECTOR, &SOME[1..2]);
}

/// From (g, s), which grow and shrink, to (g', s') there are s - g + 2 m pulses for each of four axes + g' - s'.
fn assert_pulses_left_are_known(arcs: Arcs) {
    let subject = subject(arcs.model, &Options::default());
    let (proof, _) = proved(&subject, &kind(&subject, "NR1 over 4 axes"));
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
fn the_pulses_left_of_a_full_circle_are_known_in_every_quadrant() {
    assert_pulses_left_are_known(PPC);
}

#[test]
#[ignore = "exhaustive"]
fn the_pulses_left_are_known_where_steps_are_diagonal() {
    [MINDEV, VECTOR].into_iter().for_each(assert_pulses_left_are_known);
    [MINDEV, VECTOR].into_iter().for_each(|arcs| assert_is_proved(arcs, &SOME));
}

#[test]
#[ignore = "exhaustive"]
fn arcs_of_every_kind_are_proved_for_every_width_in_four_beats_and_in_one() {
    let [four, one] = beats();
    for (arcs, choices) in [(PPC, &four), (PPC, &one), (MINDEV, &one), (VECTOR, &four)] {
        let subject = subject(arcs.model, choices);
        assert_eq!(subject.kinds().len(), 40);
        assert_proved(arcs.model, &subject, true);
    }
}

fn assert_is_not_proved_without(arcs: Arcs, premises: &[&str]) {
    let all = subject(arcs.model, &Options::default());
    let is_safe = |subject: &Subject, kind: &Kind| proved(subject, kind).0.is_safe();
    // Both ends are on the circle, and an axis is crossed where the path does.
    for premise in premises {
        let mut kind = kind(&all, SOME[0]);
        let before = kind.premises.len();
        kind.premises.retain(|clause| clause.name != *premise);
        assert!(kind.premises.len() < before, "{premise}");
        assert!(!is_safe(&all, &kind), "{} without {premise}", arcs.model);
    }
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
    assert!(!proof.holds(), "{proof:#?}");
}

const SHARED: &str = "both ends are on one circle";

#[test]
fn an_arc_across_axes_is_not_proved_without_what_it_needs() {
    assert_is_not_proved_without(PPC, &[SHARED, "an axis is crossed as soon as that"]);
}

#[test]
#[ignore = "exhaustive"]
fn an_arc_of_diagonal_steps_is_not_proved_without_what_it_needs() {
    assert_is_not_proved_without(VECTOR, &[SHARED, "an axis is crossed as soon as that"]);
    let rounded = ["an axis is crossed no farther in", "an axis is crossed no farther out"];
    assert_is_not_proved_without(MINDEV, &[&[SHARED], &rounded[..]].concat());
}

#[test]
fn a_register_one_bit_too_narrow_is_refuted_by_an_arc_across_axes() {
    for arcs in ALL {
        let model = find(arcs.model).unwrap();
        let crossing = Claims { geometries: Region::CrossingArcs(arcs.crossing), ..arcs.claims() };
        for register in ["f", "e", "xi"] {
            let found = search(model, &crossing, &Options::default(), &narrower(register), 1..=3, |_| true).found;
            let found = found.unwrap_or_else(|| panic!("{}, {register}", arcs.model));
            assert!(matches!(&found.curve, Curve::Arc(arc) if arc.crossings() > 0), "{register}: {found:?}");
        }
    }
    let narrow = Subject::new(find("ppc-arc").unwrap(), &Options::default(), &narrower("f")).unwrap();
    let (proof, _) = proved(&narrow, &kind(&narrow, SOME[0]));
    assert!(proof.violated.iter().any(|(claim, _)| narrow.claim(*claim).ends_with(".f")), "{proof:#?}");
}

#[test]
fn a_changed_certificate_of_an_arc_across_axes_is_refused() {
    assert_changed_certificates_are_refused(PPC);
}

#[test]
#[ignore = "exhaustive"]
fn a_changed_certificate_of_a_circle_of_diagonal_steps_is_refused() {
    [MINDEV, VECTOR].into_iter().for_each(assert_changed_certificates_are_refused);
}

fn assert_changed_certificates_are_refused(arcs: Arcs) {
    let subject = subject(arcs.model, &Options::default());
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
