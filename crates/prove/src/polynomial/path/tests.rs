//! The walk against an engine: random netlists of every operator, whose registers hold random numbers that the walk
//! does not know. A judge who knows them lets it take only decisions that hold for them.

use std::collections::HashMap;

use super::super::decisions::Oracle;
use super::super::poly::Var;
use super::super::random::{Dice, netlist};
use super::super::refute::Effort;
use super::*;
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_netlist::dsl::Module;
use stepwave_netlist::elaborate;

/// What the judge knows of unknowns.
struct Judge(HashMap<Var, i128>);

impl Judge {
    /// A condition in numbers, if all of its unknowns are known.
    fn value(&self, poly: &Poly) -> Option<i128> {
        let known = poly.vars().iter().all(|var| self.0.contains_key(var));
        known.then(|| poly.value(|var| self.0[&var])).flatten()
    }

    /// The parts into which a slice takes a number are three unknowns in a row: inside, below and above.
    fn learn(&mut self, rows: &[Poly]) {
        for row in rows {
            let mut open: Vec<Var> = row.vars().into_iter().filter(|var| !self.0.contains_key(var)).collect();
            open.sort_unstable();
            let [inside, below, above] = open[..] else { continue };
            let factor = |var| row.linear_in(var).unwrap_or(0);
            if factor(below) != 1 || above.index() != inside.index() + 2 {
                continue;
            }
            let known = |var: Var| self.0.get(&var).copied().unwrap_or(0);
            let number = -row.value(known).unwrap();
            let (low, whole) = (factor(inside), factor(above));
            self.0.extend([(below, number % low), (inside, number % whole / low), (above, number / whole)]);
        }
    }
}

impl Oracle for Judge {
    fn refutes(&mut self, rows: &[Poly], _: usize, _: &[Vec<Poly>], _: Effort) -> bool {
        self.learn(rows);
        rows.iter().any(|row| self.value(row).is_some_and(|value| value < 0))
    }
}

#[test]
fn what_the_walk_says_of_every_net_is_what_the_engine_has_a_clock_later_too() {
    let mut dice = Dice(0x57e9);
    let mut compared: HashMap<String, usize> = HashMap::new();
    for _ in 0..400 {
        let netlist = netlist(&mut dice);
        let design = elaborate(netlist.clone()).unwrap();
        let family = Family::single(&design, 4);
        let mut variables = Variables::new("scale".to_owned(), 1);
        let mut known = HashMap::from([(Family::SCALE, 1)]);
        let mut first = vec![Poly::from(0); netlist.cells.len()];
        let mut held = Vec::new();
        for register in design.registers() {
            let mask = i128::from(netlist.width(*register).mask());
            let var = variables.add(format!("r{}", register.index()), Some(Poly::from(0)), Some(Poly::from(mask)));
            let value = dice.below(usize::try_from(mask).unwrap() + 1);
            known.insert(var.unwrap(), value as i128);
            held.push(value as u64);
            first[register.index()] = Poly::from(var.unwrap());
        }
        let watch = Watch::default();
        let mut engine = EngineKind::Gates.build(&design, &watch);
        engine.restore(0, &held, &[], &[]);
        for clock in 0..2 {
            for net in netlist.nets() {
                let wanted = i128::from(engine.value(net));
                let mut judge = Judge(known.clone());
                let mut found: Vec<Poly> = Vec::new();
                let mut rows: Vec<Vec<Poly>> = Vec::new();
                let explored = Decisions::new(&mut judge, Vec::new(), Vec::new()).explore(|decisions| {
                    let mut path = Path::new(&family, &variables, &first, &[], decisions);
                    found.push(path.unsigned(net, clock)?);
                    rows.push(path.facts().to_vec());
                    Ok(())
                });
                let what = netlist.describe(net);
                assert!(explored.is_ok() || matches!(explored, Err(Stop::Unsupported(_))), "{what}: {explored:?}");
                // A path on which an unknown is not settled may be one that is not taken.
                let mut compared_paths = 0;
                for (poly, rows) in found.iter().zip(rows) {
                    let mut judge = Judge(known.clone());
                    judge.learn(&rows);
                    let settled = rows.iter().all(|row| judge.value(row).is_some_and(|value| value >= 0));
                    if let Some(value) = judge.value(poly).filter(|_| settled) {
                        assert_eq!(value, wanted, "clock {clock}: {what}\n{netlist}");
                        compared_paths += 1;
                    }
                }
                let op = format!("{:?}", netlist.cell(net).op);
                *compared.entry(op.split(['(', ' ']).next().unwrap_or_default().to_owned()).or_default() +=
                    compared_paths;
            }
            engine.run(1, &mut Rows::new(0, 1));
        }
    }
    for op in [
        "Register",
        "Not",
        "And",
        "Or",
        "Xor",
        "Mux",
        "Add",
        "Sub",
        "Mul",
        "Carry",
        "Borrow",
        "AddOverflow",
        "SubOverflow",
        "Equal",
        "LessSigned",
        "Slice",
        "Concat",
        "ZeroExtend",
        "SignExtend",
    ] {
        assert!(compared.get(op).is_some_and(|count| *count > 100), "{op}: {compared:?}");
    }
}

/// Refutes nothing: every decision goes both ways.
struct Open;

impl Oracle for Open {
    fn refutes(&mut self, _: &[Poly], _: usize, _: &[Vec<Poly>], _: Effort) -> bool {
        false
    }
}

#[test]
fn an_input_that_may_change_at_any_clock_is_another_unknown_at_each_and_a_bit_of_it_is_0_or_1() {
    let module = Module::new("free");
    let m = module.top();
    let (word, bit) = (m.input("word", 4).net(), m.input("bit", 1).net());
    let design = elaborate(module.finish().unwrap()).unwrap();
    let family = Family::single(&design, 4);
    let variables = Variables::new("scale".to_owned(), 1);
    let first = vec![Poly::lost(); design.netlist().cells.len()];
    let mut truths = Vec::new();
    let mut open = Open;
    Decisions::new(&mut open, Vec::new(), Vec::new())
        .explore(|decisions| {
            let mut path = Path::new(&family, &variables, &first, &[], decisions);
            let words = [0, 1, 0].map(|clock| path.unsigned(word, clock).unwrap());
            assert!(words[0] != words[1] && words[0] == words[2] && !words[0].is_lost(), "{words:?}");
            truths.push([path.truth(bit, 0)?, path.truth(bit, 1)?, path.truth(bit, 0)?]);
            Ok(())
        })
        .unwrap();
    truths.sort_unstable();
    truths.dedup();
    let [no, yes] = [false, true];
    assert_eq!(truths, [[no, no, no], [no, yes, no], [yes, no, yes], [yes, yes, yes]]);
}
