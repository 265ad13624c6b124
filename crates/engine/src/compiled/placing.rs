//! Code generation of digests: where each thing that is wanted comes from, decided before the loop is generated.

use std::collections::BTreeSet;

use rustc_hash::FxHashSet as HashSet;

use super::codegen::Phase;
use super::digesting::{Digesting, Put};
use super::layout::{
    FormFrom, NARROW, RangeFrom, SMALL_COUNTER, TrainFrom, bit_of, counting, is_const_one, is_one, moves, moves_with,
    only_value,
};
use crate::digest::{Form, Term};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Op};
use stepwave_netlist::passes::Simplified;

impl Digesting<'_, '_> {
    /// Decides where ranges and trains come from; lanes are given as values are put into them.
    pub(super) fn place(&mut self) {
        for &(net, _) in &self.wanted.ranges {
            let from = self.range(net);
            self.layout.ranges.push(from);
        }
        for form in &self.wanted.forms {
            let from = if self.is_paired(form) { FormFrom::Pairs(Vec::new()) } else { FormFrom::Wide(Vec::new()) };
            self.layout.forms.push(from);
        }
        for &net in &self.wanted.trains {
            let known = self.pattern(net).or_else(|| self.moved(net)).or_else(|| self.inverted(net));
            let from = known.unwrap_or_else(|| {
                self.layout.stored += 1;
                TrainFrom::Stored(self.layout.stored - 1)
            });
            self.layout.trains.push(from);
        }
    }

    /// A form that is evaluated outside of the loop, many values at once: of two registers, and small factors.
    pub(super) fn is_paired(&self, form: &Form) -> bool {
        let small = |term: &Term| {
            self.width(term.net).get() <= NARROW && i32::try_from(term.linear).is_ok() && [0, 1].contains(&term.square)
        };
        form.terms().len() == 2 && form.terms().iter().all(small)
    }

    /// A train of pulses with each of which a counter of a form moves.
    pub(super) fn moved(&self, net: Net) -> Option<TrainFrom> {
        let [Phase { logic, .. }] = self.plan.phases else { return None };
        let next = |net: Net| self.plan.registers.iter().position(|(register, _)| *register == net);
        let index = next(net)?;
        let after = logic.net(self.plan.registers[index].1);
        let (bit, value) = (bit_of(&logic.netlist, after)?, only_value(&logic.netlist, after)?);
        let paired = self.wanted.forms.iter().filter(|form| self.is_paired(form));
        let counter = paired.flat_map(Form::terms).find_map(|term| {
            let after = logic.net(self.plan.registers[next(term.net)?].1);
            moves_with(&logic.netlist, logic.net(term.net), after, bit).then_some(term.net)
        })?;
        Some(TrainFrom::Moved { counter, lane: 0, register: (!self.is_read(logic, net)).then_some((index, value)) })
    }

    /// A train that is an earlier one, or its opposite, in each phase: of two axes one of which steps in every round.
    fn inverted(&self, net: Net) -> Option<TrainFrom> {
        let stored = self.wanted.trains.iter().zip(&self.layout.trains).enumerate();
        let stored = stored.filter(|(_, (_, from))| matches!(from, TrainFrom::Stored(_)));
        stored.into_iter().find_map(|(of, (&other, _))| {
            let each: Option<Vec<bool>> =
                (0..self.plan.phases.len()).map(|phase| self.differs(net, other, phase)).collect();
            let each = each?;
            let set = (0..self.layout.span).filter(|sample| each[sample % each.len()]);
            Some(TrainFrom::Inverted { of, bits: set.fold(0, |word, sample| word | 1 << sample) })
        })
    }

    /// Whether of two registers one is 0 and one is not in all samples of a phase, or both are alike in all; `None` where
    /// it is not known.
    fn differs(&self, net: Net, other: Net, phase: usize) -> Option<bool> {
        let logic = &self.plan.phases[phase].logic;
        if let (Some(net), Some(other)) = (logic.constant(net), logic.constant(other)) {
            return Some((net != 0) != (other != 0));
        }
        let before = &self.plan.phases[(phase + self.plan.phases.len() - 1) % self.plan.phases.len()].logic;
        let [net, other] = [net, other].map(|net| {
            let (_, next) = self.plan.registers.iter().find(|(register, _)| *register == net)?;
            bit_of(&before.netlist, before.net(*next))
        });
        let (net, other) = (net?, other?);
        let is_not = |a: Net, b: Net| before.netlist.cell(a).op == Op::Not(b);
        if net == other { Some(false) } else { (is_not(net, other) || is_not(other, net)).then_some(true) }
    }

    /// How far a register counts in a round, whatever happens: it need not be evaluated where nothing else depends on it.
    pub(super) fn counted(&self, index: usize) -> Option<i64> {
        let (net, next) = self.plan.registers[index];
        let step = |Phase { logic, fixed }: &Phase| {
            let (register, next) = (logic.net(net), logic.net(next));
            let is_one = |by: Net| is_const_one(&logic.netlist, by);
            let step = match logic.netlist.cell(next).op {
                _ if next == register => 0,
                Op::Add(a, b) if a == register && is_one(b) || b == register && is_one(a) => 1,
                Op::Sub(a, b) if a == register && is_one(b) => -1,
                _ => return None,
            };
            (!fixed.contains_key(&net) && !self.is_read(logic, net)).then_some(step)
        };
        let round = self.plan.phases.iter().map(step).sum::<Option<i64>>()?;
        let is_train = self.wanted.trains.contains(&net);
        (round != 0 && !is_train && matches!(self.layout_of(net), None | Some(RangeFrom::Counter { .. })))
            .then_some(round)
    }

    /// Where the extremes of a register come from, if they are wanted.
    fn layout_of(&self, net: Net) -> Option<&RangeFrom> {
        let place = self.wanted.ranges.iter().position(|(register, _)| *register == net)?;
        self.layout.ranges.get(place)
    }

    /// Something other than its own train depends on a net.
    pub(super) fn is_read(&self, logic: &Simplified, net: Net) -> bool {
        let others = self.plan.registers.iter().filter(|(register, _)| *register != net).map(|(_, next)| *next);
        let trains = self.wanted.trains.iter().copied().filter(|&train| train != net);
        let forms = self.wanted.forms.iter().flat_map(Form::terms).map(|term| term.net);
        let flags = self.wanted.never.iter().chain(self.plan.stops).copied();
        let flags = flags.filter(|&flag| !self.is_excluded(logic, logic.net(flag)));
        let mut pending: Vec<Net> = others.chain(trains).chain(forms).chain(flags).map(|net| logic.net(net)).collect();
        let mut seen = vec![false; logic.netlist.cells.len()];
        while let Some(net) = pending.pop() {
            if !std::mem::replace(&mut seen[net.index()], true) {
                logic.netlist.cell(net).op.visit_inputs(|input| pending.push(input));
            }
        }
        seen[logic.net(net).index()]
    }

    /// Fills in the lanes of counters, once they are known.
    pub(super) fn moved_lanes(&mut self) {
        for from in &mut self.layout.trains {
            if let TrainFrom::Moved { counter, lane, .. } = from {
                *lane = self.lanes.get(&(Put::Net(*counter), 0)).copied().unwrap_or(0);
            }
        }
    }

    pub(super) fn range(&self, net: Net) -> RangeFrom {
        let phases = &self.plan.phases;
        let constants: Option<BTreeSet<u64>> = phases.iter().map(|phase| phase.logic.constant(net)).collect();
        if let Some(values) = constants {
            return RangeFrom::Values(values);
        }
        let next = self.plan.registers.iter().find(|(register, _)| *register == net).map_or(net, |(_, next)| *next);
        let moved = phases.iter().map(|Phase { logic, .. }| moves(&logic.netlist, logic.net(net), logic.net(next)));
        let directions = moved.reduce(|a, b| {
            let ([down, up], [further_down, further_up]) = (a?, b?);
            Some([down | further_down, up | further_up])
        });
        match directions.flatten() {
            Some([false, false]) => return RangeFrom::Values(BTreeSet::new()),
            Some([down, up]) if down != up && self.width(net).get() > SMALL_COUNTER => {
                return RangeFrom::Counter { up };
            }
            _ => {}
        }
        if let (Some(train), Some(value)) = (self.wanted.trains.iter().position(|&train| train == net), self.only(next))
        {
            return RangeFrom::Train { train, value };
        }
        if self.width(net).get() <= NARROW { RangeFrom::Narrow(Vec::new()) } else { RangeFrom::Wide(Vec::new()) }
    }

    /// The only value but 0 of a net in all phases.
    pub(super) fn only(&self, net: Net) -> Option<u64> {
        let each = self.plan.phases.iter().map(|Phase { logic, .. }| only_value(&logic.netlist, logic.net(net)));
        let values: BTreeSet<u64> = each.collect::<Option<_>>()?;
        let mut values = values.into_iter().filter(|&value| value != 0);
        let value = values.next()?;
        values.next().is_none().then_some(value)
    }

    /// A flag cannot be 1: it would be the overflow of a register that counts and comes to no end of its range.
    pub(super) fn is_excluded(&self, logic: &Simplified, flag: Net) -> bool {
        let netlist = &logic.netlist;
        let counter = |register: Net, by: Net, up: bool, signed: bool| {
            let counts = |(&(net, turned), from): (&(Net, u64), &RangeFrom)| {
                logic.net(net) == register
                    && matches!(from, RangeFrom::Counter { up: counts_up } if *counts_up == up)
                    && (turned != 0) == signed
            };
            is_one(netlist, by) && self.wanted.ranges.iter().zip(&self.layout.ranges).any(counts)
        };
        match netlist.cell(flag).op {
            Op::Const(0) => true,
            Op::And(a, b) => self.is_excluded(logic, a) || self.is_excluded(logic, b),
            Op::Or(a, b) => self.is_excluded(logic, a) && self.is_excluded(logic, b),
            Op::AddOverflow(a, b) => counter(a, b, true, true) || counter(b, a, true, true),
            Op::SubOverflow(a, b) => counter(a, b, false, true),
            Op::Carry(a, b) => counter(a, b, true, false) || counter(b, a, true, false),
            Op::Borrow(a, b) => counter(a, b, false, false),
            _ => false,
        }
    }

    /// Sums and differences that do not leave the width of an unsigned counter, since it comes to no end of its range.
    pub(super) fn exact(&self, logic: &Simplified) -> HashSet<Net> {
        let mut found = HashSet::default();
        for (&(net, turned), from) in self.wanted.ranges.iter().zip(&self.layout.ranges) {
            let next = self.plan.registers.iter().find(|(register, _)| *register == net).map(|(_, next)| *next);
            if let (RangeFrom::Counter { .. }, 0, Some(next)) = (from, turned, next) {
                counting(&logic.netlist, logic.net(net), logic.net(next), &mut found);
            }
        }
        found
    }

    /// The value of a train where it is not 0, if there is but one.
    pub(super) fn known_pulse(&self, net: Net) -> Option<u64> {
        let mut ranges = self.wanted.ranges.iter().zip(&self.layout.ranges);
        ranges.find_map(|((register, _), from)| match from {
            RangeFrom::Train { value, .. } if *register == net => Some(*value),
            _ => None,
        })
    }

    pub(super) fn width(&self, net: Net) -> Width {
        self.plan.entry.netlist.width(self.plan.entry.net(net))
    }

    /// A train that is the same constants in each round.
    pub(super) fn pattern(&self, net: Net) -> Option<TrainFrom> {
        let phases = self.plan.phases.iter();
        let bits: Option<Vec<bool>> = phases.map(|phase| Some(phase.logic.constant(net)? != 0)).collect();
        let bits = bits?;
        let set = (0..self.layout.span).filter(|sample| bits[sample % bits.len()]);
        Some(TrainFrom::Pattern(set.fold(0, |word, sample| word | 1 << sample)))
    }

    /// A register is its own next value in the phase before this one.
    pub(super) fn kept(&self, net: Net, phase: usize) -> bool {
        let before = &self.plan.phases[(phase + self.plan.phases.len() - 1) % self.plan.phases.len()];
        let register = self.plan.registers.iter().find(|(register, _)| *register == net);
        let changed = |&&(_, next): &&(Net, Net)| before.logic.net(net) != before.logic.net(next);
        register.is_some_and(|register| !changed(&register) && !before.fixed.contains_key(&net))
    }

    /// A register changes in the loop, and its value in the first phase is not known.
    pub(super) fn is_carried(&self, index: usize) -> bool {
        let (net, next) = self.plan.registers[index];
        let holds = |Phase { logic, fixed }: &Phase| !fixed.contains_key(&net) && logic.net(net) == logic.net(next);
        let is_unknown =
            |from: &TrainFrom| matches!(from, TrainFrom::Moved { register: Some((moved, _)), .. } if *moved == index);
        !self.plan.phases[0].fixed.contains_key(&net)
            && !self.plan.phases.iter().all(holds)
            && !self.layout.trains.iter().any(is_unknown)
            && self.counted(index).is_none()
    }
}
