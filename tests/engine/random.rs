//! Random netlists: every engine agrees with `gates` on every net at every clock, and the text form loses nothing.

pub(crate) mod recipe;

use std::collections::{BTreeMap, HashMap};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use stepwave_engine::{Engine, EngineKind, Rows, Stop, Watch, branching_after, compiled_after, contents};
use stepwave_netlist::cells::{NamedNet, Op};
use stepwave_netlist::passes::simplify;
use stepwave_netlist::{Design, Net, elaborate, text};

use recipe::{build, choosing, recipe, recipe_of, value};

/// What a test bench does to an engine.
#[derive(Clone, Debug)]
enum Action {
    /// Sets one of the inputs.
    Set(u16, u64),
    /// Runs, and then makes room if asked to.
    Run { clocks: u64, clear: bool },
    /// Resets in the middle.
    Reset,
    /// Goes back to the state after an earlier action.
    Restore(u16),
}

fn action() -> impl Strategy<Value = Action> {
    prop_oneof![
        4 => (any::<u16>(), value()).prop_map(|(input, value)| Action::Set(input, value)),
        4 => (0u64..9, prop::bool::weighted(0.8)).prop_map(|(clocks, clear)| Action::Run { clocks, clear }),
        1 => Just(Action::Reset),
        1 => any::<u16>().prop_map(Action::Restore),
    ]
}

/// What a run is watched for, and what happens in it.
#[derive(Clone, Debug)]
struct Script {
    /// Stop nets, taken from the one-bit nets.
    stops: Vec<u16>,
    /// Rows between engine and observer.
    room: usize,
    actions: Vec<Action>,
}

fn script() -> impl Strategy<Value = Script> {
    (prop::collection::vec(any::<u16>(), 0..3), 1usize..12, prop::collection::vec(action(), 1..16))
        .prop_map(|(stops, room, actions)| Script { stops, room, actions })
}

/// Everything that an engine shows after one action.
#[derive(Debug, PartialEq)]
struct Seen {
    stop: Option<Stop>,
    clock: u64,
    rows: Vec<(u64, Vec<u64>)>,
    values: Vec<u64>,
    memories: Vec<Vec<u64>>,
}

/// The nets that something depends on, in creation order: those in the design's order, and in any case what names,
/// properties and registers refer to.
fn live(design: &Design) -> Vec<Net> {
    let netlist = design.netlist();
    let mut live = [design.inputs(), design.registers(), design.order()].concat();
    live.extend(netlist.names.iter().flat_map(NamedNet::nets));
    live.extend(netlist.properties.iter().map(|property| property.never));
    live.extend(netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets()));
    live.extend(design.registers().iter().filter_map(|&register| match netlist.cell(register).op {
        Op::Register { next, .. } => next,
        _ => None,
    }));
    live.sort();
    live.dedup();
    live
}

fn play(design: &Design, kind: EngineKind, script: &Script) -> Vec<Seen> {
    play_on(design, |watch| kind.build(design, watch), script)
}

fn play_on(design: &Design, engine: impl Fn(&Watch) -> Box<dyn Engine>, script: &Script) -> Vec<Seen> {
    // Those too that nothing depends on.
    play_watching(design, design.netlist().nets().collect(), engine, script)
}

/// The same, with these nets in the rows.
fn play_watching(
    design: &Design,
    columns: Vec<Net>,
    engine: impl Fn(&Watch) -> Box<dyn Engine>,
    script: &Script,
) -> Vec<Seen> {
    let nets: Vec<Net> = design.netlist().nets().collect();
    let flags: Vec<Net> = nets.iter().copied().filter(|&net| design.netlist().width(net).get() == 1).collect();
    let stops = script.stops.iter().filter_map(|&stop| flags.get(usize::from(stop) % flags.len().max(1)).copied());
    let watch = Watch { columns: columns.clone(), stops: stops.collect() };
    let mut engine = engine(&watch);
    let mut rows = Rows::new(columns.len(), script.room);
    engine.reset(&mut rows);
    let mut seen: Vec<Seen> = Vec::new();
    for action in &script.actions {
        let (mut stop, mut clear_after) = (None, false);
        match *action {
            Action::Set(input, value) => {
                let inputs = design.inputs();
                engine.set_input(inputs[usize::from(input) % inputs.len()], value);
            }
            Action::Run { clocks, clear } => {
                stop = Some(engine.run(clocks, &mut rows));
                clear_after = clear;
            }
            Action::Reset => {
                rows.clear();
                engine.reset(&mut rows);
            }
            Action::Restore(index) => {
                rows.clear();
                if let Some(earlier) = seen.get(usize::from(index) % seen.len().max(1)) {
                    let of = |nets: &[Net]| nets.iter().map(|net| earlier.values[net.index()]).collect::<Vec<_>>();
                    let (registers, inputs) = (of(design.registers()), of(design.inputs()));
                    engine.restore(earlier.clock, &registers, &inputs, &earlier.memories);
                }
            }
        }
        seen.push(Seen {
            stop,
            clock: engine.clock(),
            rows: rows.iter().map(|(clock, row)| (clock, row.to_vec())).collect(),
            values: nets.iter().map(|&net| engine.value(net)).collect(),
            memories: contents(engine.as_ref(), design),
        });
        if clear_after {
            rows.clear();
        }
    }
    seen
}

/// Fails with the first action after which the two differ, and the netlist.
fn assert_same(design: &Design, script: &Script, want: &[Seen], got: &[Seen], what: &str) -> Result<(), TestCaseError> {
    for (index, (want, got)) in want.iter().zip(got).enumerate() {
        let before = &script.actions[..=index];
        prop_assert_eq!(want, got, "{} after {:?}\n{}", what, before, design.netlist());
    }
    prop_assert_eq!(want.len(), got.len());
    Ok(())
}

/// This many cases, or what the variable PROPTEST_CASES says.
pub(crate) fn config(cases: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok());
    let cases = asked.unwrap_or(cases);
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(0x57e9), ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn every_engine_agrees_with_gates_on_every_net_at_every_clock(recipe in recipe(), script in script()) {
        let design = elaborate(build(&recipe)).unwrap();
        let gates = play(&design, EngineKind::Gates, &script);
        for kind in EngineKind::ALL {
            assert_same(&design, &script, &gates, &play(&design, kind, &script), kind.name())?;
        }
    }
}

proptest! {
    // Each takes as long as a hundred of the others: `.ci/run` leaves them out where it asks for 10,000.
    #![proptest_config(config(2))]

    #[test]
    fn netlists_of_a_thousand_cells_are_the_same_in_every_engine(
        recipe in recipe_of(800..1200), script in script(), warm_up in 0u64..4,
    ) {
        let design = elaborate(build(&recipe)).unwrap();
        let gates = play(&design, EngineKind::Gates, &script);
        assert_same(&design, &script, &gates, &play(&design, EngineKind::Word, &script), "word")?;
        let compiled = play_on(&design, |watch| compiled_after(&design, watch, warm_up), &script);
        assert_same(&design, &script, &gates, &compiled, "native code")?;
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn native_code_compiled_after_a_few_clocks_agrees_with_gates(
        recipe in recipe(), script in script(), warm_up in 0u64..6,
    ) {
        let design = elaborate(build(&recipe)).unwrap();
        let gates = play(&design, EngineKind::Gates, &script);
        let compiled = play_on(&design, |watch| compiled_after(&design, watch, warm_up), &script);
        assert_same(&design, &script, &gates, &compiled, "native code")?;
    }

    #[test]
    fn branches_of_large_machines_evaluate_all_that_is_looked_at(
        recipe in recipe().prop_map(choosing),
        script in script(),
        warm_up in 0u64..6,
        worth in 0u32..4,
        watched in prop::collection::vec(any::<u16>(), 0..4),
    ) {
        let design = elaborate(build(&recipe)).unwrap();
        let nets: Vec<Net> = design.netlist().nets().collect();
        let columns: Vec<Net> = watched.iter().map(|&pick| nets[usize::from(pick) % nets.len()]).collect();
        let gates = play_watching(&design, columns.clone(), |watch| EngineKind::Gates.build(&design, watch), &script);
        let native = |watch: &Watch| branching_after(&design, watch, warm_up, worth);
        let branching = play_watching(&design, columns, native, &script);
        assert_same(&design, &script, &gates, &branching, "native code with branches")?;
    }

    #[test]
    fn simplified_netlists_behave_as_the_original(recipe in recipe(), script in script()) {
        let netlist = build(&recipe);
        let simplified = simplify(&netlist, &HashMap::new());
        let (before, after) = (elaborate(netlist).unwrap(), elaborate(simplified.netlist.clone()).unwrap());
        // The same names, each of the nets that its own became.
        let watch = |design: &Design| {
            Watch { columns: design.netlist().names.iter().flat_map(NamedNet::nets).collect(), stops: Vec::new() }
        };
        let (old, new) = (watch(&before), watch(&after));
        let (mut a, mut b) = (EngineKind::Gates.build(&before, &old), EngineKind::Word.build(&after, &new));
        let (mut a_rows, mut b_rows) = (Rows::new(old.columns.len(), 200), Rows::new(new.columns.len(), 200));
        for action in &script.actions {
            match *action {
                Action::Set(input, value) => {
                    let input = before.inputs()[usize::from(input) % before.inputs().len()];
                    a.set_input(input, value);
                    b.set_input(simplified.net(input), value);
                }
                Action::Run { clocks, .. } => {
                    a.run(clocks, &mut a_rows);
                    b.run(clocks, &mut b_rows);
                }
                Action::Reset | Action::Restore(_) => {}
            }
        }
        for (a, b) in a_rows.iter().zip(b_rows.iter()) {
            prop_assert_eq!(a, b, "{}\n{}", before.netlist(), after.netlist());
        }
    }
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn a_netlist_printed_and_parsed_is_the_same_and_behaves_the_same(recipe in recipe(), script in script()) {
        let netlist = build(&recipe);
        let printed = text::print(&netlist);
        let parsed = text::parse(&printed).unwrap();
        prop_assert_eq!(&parsed, &netlist);
        prop_assert_eq!(text::print(&parsed), printed);
        let (design, again) = (elaborate(netlist).unwrap(), elaborate(parsed).unwrap());
        prop_assert_eq!(design.order(), again.order());
        for kind in EngineKind::ALL {
            let described = play(&design, kind, &script);
            assert_same(&design, &script, &described, &play(&again, kind, &script), "parsed")?;
        }
    }
}

/// A kind of cell, as the text form spells it.
fn word(op: Op) -> String {
    op.to_string().split(' ').next().unwrap_or_default().to_owned()
}

#[test]
fn the_random_netlists_use_every_operator_where_an_engine_has_to_evaluate_it() {
    let mut runner = TestRunner::new(config(1));
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    let (mut full_width, mut properties, mut feedback) = (0, 0, 0);
    for _ in 0..200 {
        let design = elaborate(build(&recipe().new_tree(&mut runner).unwrap().current())).unwrap();
        let netlist = design.netlist();
        for net in live(&design) {
            let op = netlist.cell(net).op;
            if !matches!(op, Op::Const(_)) {
                *used.entry(word(op)).or_default() += 1;
            }
            full_width += usize::from(netlist.width(net).get() == 64);
        }
        properties += netlist.properties.len();
        let registers = design.registers().iter().map(|&register| (register, netlist.cell(register).op));
        feedback += registers.filter(|(q, op)| matches!(op, Op::Register { next: Some(d), .. } if d > q)).count();
    }
    let all = [
        "input",
        "register",
        "not",
        "and",
        "or",
        "xor",
        "mux",
        "add",
        "sub",
        "mul",
        "div",
        "rem",
        "shift-left",
        "shift-right",
        "shift-arithmetic",
        "carry",
        "borrow",
        "add-overflow",
        "sub-overflow",
        "equal",
        "less-signed",
        "slice",
        "concat",
        "zero-extend",
        "sign-extend",
        "read",
    ];
    for operator in all {
        assert!(used.get(operator).is_some_and(|&count| count >= 20), "'{operator}' is rare: {used:?}");
    }
    assert_eq!(used.len(), all.len(), "{used:?}");
    assert!(full_width >= 100 && properties >= 50 && feedback >= 50, "{full_width} {properties} {feedback}");
}

#[test]
fn the_random_scripts_meet_every_reason_to_stop() {
    let mut runner = TestRunner::new(config(1));
    let mut reasons = [0; 3];
    for _ in 0..60 {
        let design = elaborate(build(&recipe().new_tree(&mut runner).unwrap().current())).unwrap();
        let script = script().new_tree(&mut runner).unwrap().current();
        for seen in play(&design, EngineKind::Word, &script) {
            match seen.stop {
                None => {}
                Some(Stop::Clocks) => reasons[0] += 1,
                Some(Stop::RowsFull) => reasons[1] += 1,
                Some(Stop::Net(_)) => reasons[2] += 1,
            }
        }
    }
    assert!(reasons.iter().all(|&count| count >= 20), "{reasons:?}");
}
