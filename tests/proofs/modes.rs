//! Modes of a machine that come to the same value again: what holds in each, and how often they have changed.

use stepwave::netlist::dsl::Module;
use stepwave::netlist::{Design, elaborate};
use stepwave_netlist::formula::{ByMode, Clause, Symbol, name, number};
use stepwave_prove::{Case, CaseError, Certificate, Family, Proof, Row, Strobes, check, prove};

/// A walk round four sides: each step goes to the next side and counts down from 4 to 7.
fn walk() -> (Design, Strobes) {
    let module = Module::new("walk");
    let m = module.top();
    let (load, preset_position, start) = (m.input("load", 1), m.input("preset_position", 1), m.input("start", 3));
    let (side, count) = (m.reg("side", 2), m.reg("count", 3));
    let (loaded, stepped) = (m.reg("loaded", 1), m.reg("stepped", 1));
    let step = !count.q.is_zero() & !load;
    count.when(load, start).when(step, count.q.strict_sub(m.lit(3, 1), step)).else_hold();
    side.when(load, m.lit(2, 0)).when(step, side.q.wrapping_add(m.lit(2, 1))).else_hold();
    loaded.set(load);
    stepped.set(step);
    let done = m.name("done", count.q.is_zero());
    m.between_steps("running", [name("count") - 1]);
    m.between_steps("on_its_side", [name("side") - name("number")]);
    let strobes = Strobes {
        load: load.net(),
        preset_position: preset_position.net(),
        loaded: loaded.q.net(),
        stepped: stepped.q.net(),
        done: done.net(),
    };
    (elaborate(module.finish().unwrap()).unwrap(), strobes)
}

/// That n steps end four sides before n.
fn case() -> Case {
    Case {
        name: "any walk".to_owned(),
        symbols: vec![Symbol { name: "n".to_owned(), least: number(4), greatest: number(7) }],
        words: vec![("start".to_owned(), name("n"))],
        goals: Clause::zero("the side", name("side") + 4 - name("n")).to_vec(),
        rank: Some(name("count")),
        modes: vec!["side".to_owned()],
        by_mode: vec![ByMode { name: "number".to_owned(), register: "side".to_owned(), values: vec![0, 1, 2, 3] }],
        counts_changes: true,
        // Each holds after as many steps, and is left out elsewhere.
        guesses: (0..7).flat_map(|taken| Clause::zero("steps", name("count") - name("n") + taken)).collect(),
        ..Case::default()
    }
}

/// Side, count, loaded and stepped of all walks, but for their ends.
fn rows() -> Vec<Row> {
    let row = |n: i128, taken: i128| Row {
        k: 3,
        symbols: vec![n],
        registers: vec![taken % 4, n - taken, i128::from(taken == 0), i128::from(taken > 0)],
        steps: taken,
    };
    (4..=7).flat_map(|n| (0..n).map(move |taken| row(n, taken))).collect()
}

fn attempt(case: &Case) -> Result<(Proof, Certificate), CaseError> {
    let (design, strobes) = walk();
    prove(&Family::single(&design, 3), strobes, case, &rows())
}

fn checked(text: &str) -> Proof {
    let (design, strobes) = walk();
    check(&Family::single(&design, 3), strobes, &case(), &text.parse().unwrap()).unwrap()
}

#[test]
fn a_mode_that_comes_again_is_another_one_where_its_changes_are_counted() {
    let (proof, certificate) = attempt(&case()).unwrap();
    assert!(proof.is_safe() && proof.endless.is_none(), "{proof:#?}");
    for wanted in ["side = 0: changes = 0: count = n", "side = 0: changes = 4: count = n - 4"] {
        assert!(proof.invariants.iter().any(|own| own == wanted), "{wanted}: {:#?}", proof.invariants);
    }
    let text = certificate.to_string();
    assert_eq!(checked(&text), proof);
    for (from, to) in [
        ("modes 0 4\n", "modes 0\n"),
        ("modes 0 4\n", "modes 0 0\n"),
        ("modes 0 4\n", "modes 0 5\n"),
        ("modes 0 4\n", "modes 1 4\n"),
        ("modes 0 0\n", "modes 0 170141183460469231731687303715884105727\n"),
    ] {
        assert!(text.contains(from) && !checked(&text.replacen(from, to, 1)).holds(), "{from} {to}");
    }
    // From walks of four and five steps, longer ones come to modes of which nothing is known.
    let (design, strobes) = walk();
    let short: Vec<Row> = rows().into_iter().filter(|row| row.symbols[0] < 6).collect();
    let (proof, _) = prove(&Family::single(&design, 3), strobes, &case(), &short).unwrap();
    assert!(!proof.holds() && proof.astray.as_ref().is_some_and(|why| why.contains("never seen")), "{proof:#?}");
    // Where changes are not counted, what holds on each side is too little for the end.
    let (proof, _) = attempt(&Case { counts_changes: false, ..case() }).unwrap();
    assert!(proof.holds() && !proof.is_safe(), "{proof:#?}");
}

#[test]
fn a_number_that_is_another_in_other_modes_is_that_of_the_mode() {
    let of = |register: &str, values: &[i128]| {
        let (name, register) = ("number".to_owned(), register.to_owned());
        Case { by_mode: vec![ByMode { name, register, values: values.to_vec() }], ..case() }
    };
    let (proof, _) = attempt(&of("side", &[0, 1, 3, 2])).unwrap();
    assert!(!proof.holds() && proof.not_inductive[0].contains("on_its_side"), "{proof:#?}");
    // A value or the mode itself is missing, and a goal is of no mode.
    let unknown = |case: Case| {
        assert!(matches!(attempt(&case), Err(CaseError::UnknownName { name, .. }) if name == "number"), "{case:?}");
    };
    unknown(of("side", &[0, 1, 2]));
    unknown(of("count", &[0, 1, 2, 3]));
    unknown(Case { goals: vec![Clause::at_least_zero("a goal", name("number"))], ..case() });
    // A register of three bits cannot be a mode.
    let wide = Case { modes: vec!["side".to_owned(), "count".to_owned()], ..case() };
    assert!(matches!(attempt(&wide), Err(CaseError::UnknownName { name, .. }) if name == "count"));
}
