//! The walk against an engine: random netlists of every operator, whose registers hold random numbers that the walk does
//! not know. A judge who knows them lets it take only decisions that hold for them.

use std::collections::HashMap;

use super::*;
use crate::bits::Width;
use crate::elaborate::elaborate;
use crate::engine::{EngineKind, Rows, Watch};
use crate::netlist::{Cell, Netlist};
use crate::prove::decisions::Oracle;
use crate::prove::poly::Var;
use crate::prove::refute::Effort;

/// Numbers that look random.
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit
    }
}

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

/// Four registers of each width from 1 to 4, and cells of every operator on them.
fn netlist(dice: &mut Dice) -> Netlist {
    let mut netlist = Netlist::new("random");
    let mut add = |op, bits: usize| {
        netlist.cells.push(Cell { op, width: Width::new(bits as u64).unwrap() });
        (Net(u32::try_from(netlist.cells.len() - 1).unwrap()), bits)
    };
    let mut nets: Vec<(Net, usize)> = Vec::new();
    for place in 0..16 {
        nets.push(add(Op::Register { next: None, reset: 0 }, place / 4 + 1));
    }
    let constant = dice.below(16) as u64;
    nets.push(add(Op::Const(constant), 4));
    for _ in 0..40 {
        let (a, bits) = nets[dice.below(nets.len())];
        let alike: Vec<Net> = nets.iter().filter(|(_, other)| *other == bits).map(|(net, _)| *net).collect();
        let narrow: Vec<Net> = nets.iter().filter(|(_, bits)| *bits == 1).map(|(net, _)| *net).collect();
        let (b, select) = (alike[dice.below(alike.len())], narrow[dice.below(narrow.len())]);
        let (other, others) = nets[dice.below(nets.len())];
        let low = dice.below(bits);
        let (op, bits) = match dice.below(17) {
            0 => (Op::Not(a), bits),
            1 => (Op::And(a, b), bits),
            2 => (Op::Or(a, b), bits),
            3 => (Op::Xor(a, b), bits),
            4 => (Op::Mux { select, high: a, low: b }, bits),
            5 => (Op::Add(a, b), bits),
            6 => (Op::Sub(a, b), bits),
            7 => (Op::Carry(a, b), 1),
            8 => (Op::Borrow(a, b), 1),
            9 => (Op::AddOverflow(a, b), 1),
            10 => (Op::SubOverflow(a, b), 1),
            11 => (Op::Equal(a, b), 1),
            12 => (Op::LessSigned(a, b), 1),
            13 => (Op::Slice { of: a, low: u8::try_from(low).unwrap() }, 1 + dice.below(bits - low)),
            14 if bits + others <= 6 => (Op::Concat { high: a, low: other }, bits + others),
            15 if bits < 6 => (Op::ZeroExtend(a), bits + 1),
            16 if bits < 6 => (Op::SignExtend(a), bits + 1),
            _ => continue,
        };
        nets.push(add(op, bits));
    }
    for place in 0..16 {
        let alike: Vec<Net> = nets.iter().filter(|(_, bits)| *bits == place / 4 + 1).map(|(net, _)| *net).collect();
        let next = Some(alike[dice.below(alike.len())]);
        netlist.cells[place].op = Op::Register { next, reset: 0 };
    }
    netlist
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
        engine.restore(0, &held, &[]);
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
                let mut told = 0;
                for (poly, rows) in found.iter().zip(rows) {
                    let mut judge = Judge(known.clone());
                    judge.learn(&rows);
                    let settled = rows.iter().all(|row| judge.value(row).is_some_and(|value| value >= 0));
                    if let Some(value) = judge.value(poly).filter(|_| settled) {
                        assert_eq!(value, wanted, "clock {clock}: {what}\n{netlist}");
                        told += 1;
                    }
                }
                let op = format!("{:?}", netlist.cell(net).op);
                *compared.entry(op.split(['(', ' ']).next().unwrap_or_default().to_owned()).or_default() += told;
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
