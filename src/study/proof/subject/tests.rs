//! Machines with a mistake in them, of which nothing must be proved.

use stepwave_models::find;
use stepwave_netlist::cells::{Net, Op};
use stepwave_netlist::formula::Clause;
use stepwave_netlist::{Netlist, elaborate};

use super::*;

/// The same machines, each changed; rows are recorded of them.
fn changed(mut subject: Subject, change: impl Fn(&mut Netlist)) -> Subject {
    for (_, _, machine) in &mut subject.members {
        let mut netlist = machine.design.netlist().clone();
        change(&mut netlist);
        machine.design = elaborate(netlist).expect("a netlist");
    }
    let designs: Vec<(u32, Design)> =
        subject.members.iter().map(|(k, _, machine)| (*k, machine.design.clone())).collect();
    subject.family = Family::of(&designs).expect("a family");
    subject
}

fn arcs() -> Subject {
    let model = find("ppc-arc").expect("a model");
    Subject::new(model, &Options::default(), &Narrower::new()).expect("a subject")
}

/// Turns the multiplexer of these operands over: the one of which this is true.
fn turn_over(netlist: &mut Netlist, is_it: impl Fn(&Netlist, Net) -> bool) {
    let all: Vec<Net> = netlist.nets().filter(|net| is_it(netlist, *net)).collect();
    let [net] = all[..] else { panic!("{} such cells", all.len()) };
    let Op::Mux { select, high, low } = netlist.cell(net).op else { panic!("no multiplexer") };
    netlist.cells[net.index()].op = Op::Mux { select, high: low, low: high };
}

#[test]
fn an_arc_that_is_turned_to_the_wrong_quadrant_is_not_proved() {
    let right = arcs();
    let kind = |name: &str| right.kinds().into_iter().find(|kind| kind.name == name).expect("a kind");
    let [one, three] = ["NR2 over 1 axis", "SR4 over 3 axes"].map(kind);
    let (proof, certificate) = changed(arcs(), |_| {}).prove(&one).expect("an attempt");
    assert!(proof.is_safe(), "{proof:#?}");
    // Clockwise the next quadrant is one less, counter-clockwise one more; or the wrong coordinate is waited for.
    let reversed = changed(arcs(), |netlist| {
        let ccw = netlist.find("ccw").map(|named| named.net);
        turn_over(netlist, |netlist, net| match netlist.cell(net).op {
            Op::Mux { select, .. } => Some(select) == ccw && netlist.width(net).get() == 2,
            _ => false,
        });
    });
    let wrong_axis = changed(arcs(), |netlist| {
        let cross = netlist.find("cross").map(|named| named.net);
        turn_over(netlist, |_, net| Some(net) == cross);
    });
    for subject in [&reversed, &wrong_axis] {
        // Nor does the certificate of the right machine do for it.
        assert!(!subject.check(&one, &certificate).expect("a check").is_safe());
    }
    let unsafe_on = |subject: &Subject, kind: &Kind| {
        let (proof, _) = subject.prove(kind).expect("an attempt");
        assert!(!proof.is_safe(), "{}: {proof:#?}", kind.name);
    };
    unsafe_on(&reversed, &one);
    unsafe_on(&reversed, &three);
    // With what the right machine does as an example.
    unsafe_on(&Subject { members: arcs().members, ..reversed }, &three);
    unsafe_on(&Subject { members: arcs().members, ..wrong_axis }, &three);
}

#[test]
fn what_an_author_claims_of_an_arc_and_does_not_hold_proves_nothing() {
    for name in ["f_from_below", "f_from_above", "f_after_an_axis", "f_on_an_axis"] {
        let wrong = changed(arcs(), |netlist| {
            let own = netlist.invariants.iter_mut().find(|clause| clause.name.ends_with(name)).expect("a clause");
            *own = Clause::either(&own.name, own.any.iter().map(|formula| formula.clone() - 1));
        });
        let kind = wrong.kinds().into_iter().find(|kind| kind.name == "NR3 over 2 axes").expect("a kind");
        let (proof, _) = wrong.prove(&kind).expect("an attempt");
        assert!(!proof.holds() && proof.not_inductive[0].contains(name), "{name}: {proof:#?}");
    }
}
