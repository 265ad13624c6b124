//! Proofs at a netlist's own widths: every verdict about small random netlists is that of an exhaustive exploration by the
//! `gates` engine.

mod explored;
mod recipe;

use std::time::Duration;

use proptest::prelude::*;
use stepwave::engine::{EngineKind, Rows, Watch};
use stepwave::netlist::dsl::Module;
use stepwave::netlist::{Design, Net, elaborate, text};
use stepwave::prove::sat::{Decision, Inputs, Limit, Limits, Question, TooLarge, Verdict, decide};

use crate::engine::random::config;
use explored::{Explored, explore};
use recipe::{Asked, asked};

/// Enough for all that is asked here.
const LIMITS: Limits = Limits { time: Duration::from_secs(20), memory: 8 << 30, clock: Some(70) };

fn decided(question: &Question<'_>) -> Decision {
    decide(question, &LIMITS, &mut |_| {}).expect("small memories")
}

/// The inputs found make the simulator violate the property in that clock, and no assumption up to it.
fn assert_replayed(question: &Question<'_>, goal: usize, clock: u64, inputs: &[Vec<(Net, u64)>]) {
    let design = question.design;
    let property = |index: usize| design.netlist().properties[index].never;
    let mut engine = EngineKind::Gates.build(design, &Watch::default());
    let mut rows = Rows::new(0, 1);
    for (sample, row) in inputs.iter().enumerate() {
        let fixed = question.inputs.rows.get(sample).unwrap_or(&question.inputs.later);
        fixed.iter().chain(row).for_each(|&(net, value)| engine.set_input(net, value));
        if sample == 0 {
            engine.reset(&mut rows)
        } else {
            _ = engine.run(1, &mut rows)
        }
        assert!(question.assumptions.iter().all(|&index| engine.value(property(index)) == 0));
        assert_eq!(engine.value(property(goal)) == 1, sample as u64 == clock);
        for &(net, value) in fixed {
            assert_eq!(engine.value(net), value);
        }
    }
    assert_eq!(inputs.len() as u64, clock + 1);
}

/// What verdicts there were: proved, violated, unknown, and unknown because no run meets the assumptions.
fn assert_agrees(asked: &Asked) -> Result<[usize; 4], TestCaseError> {
    let design = elaborate(asked.netlist.clone()).expect("a netlist");
    let question = asked.question(&design);
    let Explored { first, contradiction } = explore(&question);
    let decision = decided(&question);
    let text = || format!("{:?} {}", asked.inputs, text::print(design.netlist()));
    let mut counts = [0; 4];
    for (number, verdict) in decision.verdicts.iter().enumerate() {
        let first = first[number];
        match verdict {
            Verdict::Proved { .. } => {
                counts[0] += 1;
                prop_assert_eq!(first, None, "goal {} is not to be proved\n{}", number, text());
            }
            Verdict::Violated { clock, inputs } => {
                counts[1] += 1;
                prop_assert_eq!(first, Some(*clock), "goal {}\n{}", number, text());
                assert_replayed(&question, question.goals[number], *clock, inputs);
            }
            Verdict::Unknown { clean } => {
                counts[if decision.contradiction.is_some() { 3 } else { 2 }] += 1;
                prop_assert!(first.is_none_or(|first| first >= *clean), "goal {} {}\n{}", number, clean, text());
                prop_assert!(decision.limit.is_some() || decision.contradiction.is_some());
            }
        }
    }
    if let Some(clock) = decision.contradiction {
        prop_assert_eq!(contradiction, Some(clock), "{}", text());
    }
    Ok(counts)
}

#[test]
fn every_verdict_about_random_netlists_is_that_of_an_exhaustive_exploration() {
    let mut runner = proptest::test_runner::TestRunner::new(config(600));
    let counts = std::cell::Cell::new([0; 4]);
    let run = runner.run(&asked(), |asked| {
        let more = assert_agrees(&asked)?;
        let before = counts.get();
        counts.set([0, 1, 2, 3].map(|kind| before[kind] + more[kind]));
        Ok(())
    });
    run.unwrap_or_else(|error| panic!("{error}"));
    let [proved, violated, unknown, _] = counts.get();
    assert!(proved > 100 && violated > 100 && unknown * 20 < proved, "{:?}", counts.get());
}

/// A counter from 0 to `last` and back to 0, in some bits; goals: it is at most `last`, it is less.
fn counter(bits: u32, last: u64) -> Design {
    let module = Module::new("counter");
    let m = module.top();
    let count = m.reg("count", bits);
    let ends = count.q.equals(m.lit(bits, last));
    count.when(ends, m.lit(bits, 0)).otherwise(count.q.wrapping_add(m.lit(bits, 1)));
    m.invariant("at_most", !m.lit(bits, last).less_than(count.q));
    m.invariant("less", count.q.less_than(m.lit(bits, last)));
    elaborate(module.finish().expect("described")).expect("a netlist")
}

#[test]
fn a_bound_of_a_counter_is_proved_and_one_less_is_violated_at_its_clock() {
    for (bits, last) in [(4, 9), (5, 20), (8, 40), (64, 12)] {
        let design = counter(bits, last);
        let question = Question { design: &design, goals: vec![0, 1], assumptions: vec![], inputs: Inputs::default() };
        let verdicts = decided(&question).verdicts;
        assert!(matches!(verdicts[0], Verdict::Proved { .. }), "{bits} {last}: {verdicts:?}");
        assert!(matches!(verdicts[1], Verdict::Violated { clock, .. } if clock == last), "{bits} {last}: {verdicts:?}");
    }
}

#[test]
fn goals_that_are_inductive_only_together_are_proved() {
    // Two equal counters: each equality of bits needs the others.
    let module = Module::new("twins");
    let m = module.top();
    let step = m.input("step", 12);
    let [a, b] = ["a", "b"].map(|name| m.reg(name, 12));
    a.set(a.q.wrapping_add(step));
    b.set(b.q.wrapping_add(step));
    for bit in 0..12 {
        m.invariant(&format!("bit{bit}"), a.q.bit(bit).equals(b.q.bit(bit)));
    }
    m.invariant("never_5", !a.q.equals(m.lit(12, 5)));
    let design = elaborate(module.finish().expect("described")).expect("a netlist");
    let question =
        Question { design: &design, goals: (0..13).collect(), assumptions: vec![], inputs: Inputs::default() };
    let verdicts = decided(&question).verdicts;
    assert!(verdicts[..12].iter().all(|verdict| *verdict == Verdict::Proved { depth: 1 }), "{verdicts:?}");
    assert!(matches!(verdicts[12], Verdict::Violated { clock: 1, .. }), "{verdicts:?}");
}

#[test]
fn a_search_ends_at_its_limits_and_says_how_far_it_came() {
    let design = counter(32, 1 << 20);
    let question = Question { design: &design, goals: vec![1], assumptions: vec![], inputs: Inputs::default() };
    let limits = Limits { clock: Some(12), ..LIMITS };
    let decision = decide(&question, &limits, &mut |_| {}).expect("no memory");
    assert_eq!((decision.limit, &decision.verdicts[0]), (Some(Limit::Clock), &Verdict::Unknown { clean: 13 }));
    let limits = Limits { time: Duration::from_millis(300), clock: None, ..LIMITS };
    let decision = decide(&question, &limits, &mut |_| {}).expect("no memory");
    assert_eq!(decision.limit, Some(Limit::Time));
    let limits = Limits { memory: 1, ..LIMITS };
    let decision = decide(&question, &limits, &mut |_| {}).expect("no memory");
    assert_eq!((decision.limit, &decision.verdicts[0]), (Some(Limit::Memory), &Verdict::Unknown { clean: 0 }));
}

#[test]
fn a_memory_that_is_too_large_is_refused_only_where_a_goal_depends_on_it() {
    let text = "netlist m\nmemory 0 in 0 \"ram\" width 64 words 1025\n%0:11 = input\n%1:64 = read 0 %0\n\
                %2:1 = slice %1 0\n%3:1 = slice %0 0\n%4:1 = not %3\n%5:1 = and %3 %4\n\
                property \"low\" never %2 invariant\nproperty \"none\" never %5 invariant\n";
    let design = elaborate(text::parse(text).expect("text")).expect("a netlist");
    let question = |goals| Question { design: &design, goals, assumptions: vec![], inputs: Inputs::default() };
    let refused = decide(&question(vec![0]), &LIMITS, &mut |_| {});
    assert_eq!(refused, Err(TooLarge { memory: "m.ram".to_owned(), bits: 65600 }));
    assert_eq!(decided(&question(vec![1])).verdicts, [Verdict::Proved { depth: 0 }]);
}

#[test]
fn a_goal_that_is_looked_at_only_now_and_then_is_proved_by_the_order_of_registers() {
    // A counter up to a limit; whether it is beyond is asked at any time, perhaps long after it went wrong.
    let described = |steps: u64| {
        let module = Module::new("limited");
        let m = module.top();
        let (load, step, ask) = (m.input("load", 1), m.input("step", 1), m.input("ask", 1));
        let (limit, count) = (m.reg("limit", 16), m.reg("count", 16));
        limit.when(load, m.input("wanted", 16)).else_hold();
        let runs = step & !count.q.equals(limit.q);
        count.when(load, m.lit(16, 0)).when(runs, count.q.wrapping_add(m.lit(16, steps))).else_hold();
        m.invariant("within", !(ask & limit.q.less_than(count.q)));
        elaborate(module.finish().expect("described")).expect("a netlist")
    };
    let verdict = |design: &Design| {
        let question = Question { design, goals: vec![0], assumptions: vec![], inputs: Inputs::default() };
        decided(&question).verdicts.remove(0)
    };
    assert!(matches!(verdict(&described(1)), Verdict::Proved { depth: 0..=2 }), "{:?}", verdict(&described(1)));
    // By twos it passes an odd limit.
    assert!(matches!(verdict(&described(2)), Verdict::Violated { clock: 2, .. }), "{:?}", verdict(&described(2)));
}
