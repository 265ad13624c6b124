//! What a loop takes for granted: which inputs and registers are folded in, and with which values.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap as HashMap;

use super::codegen::Phase;
use super::layout::{SMALL_COUNTER, moves};
use stepwave_netlist::cells::{Net, Netlist, Op};
use stepwave_netlist::passes::{Simplified, simplify};

/// Widest register that is considered for being fixed.
const FEW_BITS: u32 = 4;
/// Longest period considered.
const LONGEST_PERIOD: usize = 8;
/// Numbers up to this one are the end of a counter that goes down.
pub(super) const END: u64 = 15;
/// Inputs that are folded in at most: each takes a pass over the netlist, and its other value another loop.
const MOST_INPUTS: usize = 16;

/// Values that registers of few bits had in recent clocks.
pub(super) struct History {
    registers: Vec<Net>,
    /// One sample after another.
    samples: Vec<u8>,
    /// Clocks to look back on.
    window: u64,
}

/// A register and its values, one a phase.
pub(super) type Periodic = Vec<(Net, Vec<u64>)>;

impl History {
    /// Remembers the registers of few bits that the machine itself reads. One that is only looked at from outside, such
    /// as a pulse, would be guarded for nothing.
    pub(super) fn new(netlist: &Netlist, registers: &[(Net, Net)], window: u64) -> History {
        let read = read_by_the_machine(netlist, registers);
        let few = |net: &Net| netlist.width(*net).get() <= FEW_BITS && read[net.index()];
        History {
            registers: registers.iter().map(|&(net, _)| net).filter(|net| few(net)).collect(),
            samples: Vec::new(),
            window,
        }
    }

    /// Of no register.
    pub(super) fn none() -> History {
        History { registers: Vec::new(), samples: Vec::new(), window: 0 }
    }

    pub(super) fn window(&self) -> u64 {
        self.window
    }

    pub(super) fn clear(&mut self) {
        self.samples.clear();
    }

    pub(super) fn is_full(&self) -> bool {
        self.len() as u64 >= self.window
    }

    fn len(&self) -> usize {
        self.samples.len().checked_div(self.registers.len()).unwrap_or(usize::MAX)
    }

    /// Takes a sample; when full, the older half goes.
    pub(super) fn remember(&mut self, value: impl Fn(Net) -> u64) {
        if self.len() as u64 >= 2 * self.window.max(1) {
            self.samples.drain(..self.samples.len() / 2);
        }
        // At most four bits.
        self.samples.extend(self.registers.iter().map(|&net| u8::try_from(value(net)).unwrap_or(0)));
    }

    /// The shortest period in which most registers went round, and those registers with their values, the last one
    /// being that of the present sample.
    pub(super) fn period(&self) -> Option<Periodic> {
        let len = self.len();
        let width = self.registers.len();
        let at = |sample: usize, index: usize| self.samples[sample * width + index];
        let goes_round =
            |index: usize, period: usize| (period..len).all(|sample| at(sample, index) == at(sample - period, index));
        let best = (1..=LONGEST_PERIOD)
            .map(|period| (period, (0..width).filter(|&index| goes_round(index, period)).collect::<Vec<_>>()))
            // The first of the greatest: `max_by_key` would give the last.
            .rev()
            .max_by_key(|(_, indices)| indices.len());
        let (period, indices) = best.filter(|(period, indices)| !indices.is_empty() && *period <= len)?;
        let values = |index: usize| (len - period..len).map(|sample| u64::from(at(sample, index))).collect();
        Some(indices.into_iter().map(|index| (self.registers[index], values(index))).collect())
    }
}

/// The nets that a port of a memory depends on, or the next value of a register, of another one than the net itself.
fn read_by_the_machine(netlist: &Netlist, registers: &[(Net, Net)]) -> Vec<bool> {
    let mut read = vec![false; netlist.cells.len()];
    let written = netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets());
    let written: Vec<Net> = written.collect();
    let roots = registers.iter().map(|&(register, next)| (Some(register), vec![next]));
    for (register, mut pending) in roots.chain([(None, written)]) {
        let mut seen = vec![false; netlist.cells.len()];
        while let Some(net) = pending.pop() {
            if !std::mem::replace(&mut seen[net.index()], true) {
                read[net.index()] |= Some(net) != register;
                netlist.cell(net).op.visit_inputs(|input| pending.push(input));
            }
        }
    }
    read
}

/// Netlists with everything folded in that a loop takes for granted.
pub(super) struct Specialised {
    pub(super) inputs: HashMap<Net, u64>,
    pub(super) entry: Simplified,
    pub(super) phases: Vec<Phase>,
}

impl Specialised {
    /// Folds in the inputs of one bit that matter, at their present values, and the registers of `period`. `watched`
    /// adds the observed nets to the registers.
    pub(super) fn new(
        netlist: &Netlist,
        inputs: &[Net],
        registers: &[(Net, Net)],
        period: Option<Periodic>,
        value: impl Fn(Net) -> u64,
        watched: impl Fn(&mut Vec<Net>),
    ) -> Specialised {
        let mut roots: Vec<Net> = registers.iter().map(|&(_, next)| next).collect();
        roots.extend(netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets()));
        watched(&mut roots);
        let mut fixed: HashMap<Net, u64> = HashMap::default();
        let mut entry = simplify(netlist, &fixed);
        // The input with most readers first: `load` makes all others idle.
        while fixed.len() < MOST_INPUTS
            && let Some(input) = busiest_input(&entry, inputs, &roots, netlist, &fixed)
        {
            fixed.insert(input, value(input));
            entry = simplify(netlist, &fixed);
        }
        let period = period.unwrap_or_default();
        let phases = period.first().map_or(1, |(_, values)| values.len());
        let phase = |number: usize| {
            let here: HashMap<Net, u64> = period.iter().map(|(net, values)| (*net, values[number])).collect();
            let mut all = fixed.clone();
            all.extend(&here);
            Phase { logic: simplify(netlist, &all), fixed: here }
        };
        let phases = (0..phases).map(phase).collect();
        Specialised { inputs: fixed, entry, phases }
    }
}

impl Specialised {
    /// Fixes further registers in the phases: those that would end a digest, at 0, and those that take a constant in the
    /// phase before. Counters that go down are never compared with what they come to at their end: gives those, which have
    /// to be greater than [`END`] in all samples.
    pub(super) fn settle(&mut self, netlist: &Netlist, registers: &[(Net, Net)], never: &[Net]) -> Vec<Net> {
        let counters = self.counters(netlist, registers);
        let ends: Vec<Vec<(Net, Net)>> = self.phases.iter().map(|phase| phase.ends(netlist, &counters)).collect();
        let none = registers.iter().map(|&(net, _)| net).filter(|net| never.contains(net));
        let mut found: Vec<Vec<(Net, u64)>> = vec![none.map(|net| (net, 0)).collect(); self.phases.len()];
        let mut is_new = ends.iter().any(|ends| !ends.is_empty());
        while std::mem::take(&mut is_new) || found.iter().any(|nets| !nets.is_empty()) {
            for ((phase, nets), ends) in self.phases.iter_mut().zip(found).zip(&ends) {
                nets.into_iter().for_each(|(net, value)| {
                    phase.fixed.entry(net).or_insert(value);
                });
                let mut all = self.inputs.clone();
                all.extend(&phase.fixed);
                all.extend(ends.iter().map(|&(_, comparison)| (comparison, 0)));
                phase.logic = simplify(netlist, &all);
            }
            let after = |(number, phase): (usize, &Phase)| {
                let before = &self.phases[(number + self.phases.len() - 1) % self.phases.len()];
                let unknown = registers.iter().filter(|(net, _)| !phase.fixed.contains_key(net));
                unknown.filter_map(|&(net, next)| Some((net, before.logic.constant(next)?))).collect()
            };
            found = self.phases.iter().enumerate().map(after).collect();
        }
        ends.into_iter().flatten().map(|(counter, _)| counter).collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// Counters that go down by at most one at a time.
    fn counters(&self, netlist: &Netlist, registers: &[(Net, Net)]) -> Vec<Net> {
        let counts_down = |&(net, next): &(Net, Net)| {
            let directions = |Phase { logic, fixed }: &Phase| {
                let own = moves(&logic.netlist, logic.net(net), logic.net(next))?;
                (!fixed.contains_key(&net)).then_some(own)
            };
            let each: Option<Vec<[bool; 2]>> = self.phases.iter().map(directions).collect();
            // One that rests would stay near its end for ever.
            let each = each.filter(|each| each.iter().any(|[down, _]| *down) && each.iter().all(|[_, up]| !up));
            netlist.width(net).get() > SMALL_COUNTER && each.is_some()
        };
        registers.iter().filter(|register| counts_down(register)).map(|register| register.0).collect()
    }
}

impl Phase {
    /// Nets that are 0 while a counter is greater than [`END`], with that counter: what compares it, or the number a few
    /// below it that it goes down to, with a number that it comes to at its end.
    fn ends(&self, netlist: &Netlist, counters: &[Net]) -> Vec<(Net, Net)> {
        let new = &self.logic.netlist;
        let counter = |net: Net| counters.iter().copied().find(|&counter| self.logic.net(counter) == net);
        let below = |net: Net| match new.cell(net).op {
            Op::Sub(a, b) => Some((counter(a)?, most(new, b))),
            _ => Some((counter(net)?, 0)),
        };
        let compared = |a: Net, b: Net| {
            let (counter, less) = below(a)?;
            (most(new, b).saturating_add(less) <= END).then_some(counter)
        };
        let ends = netlist.nets().filter_map(|net| match new.cell(self.logic.net(net)).op {
            Op::Equal(a, b) => Some((compared(a, b).or_else(|| compared(b, a))?, net)),
            _ => None,
        });
        ends.collect()
    }
}

/// A number that a net is never greater than.
fn most(netlist: &Netlist, net: Net) -> u64 {
    match netlist.cell(net).op {
        Op::Const(value) => value,
        Op::ZeroExtend(part) => netlist.width(part).mask(),
        _ => netlist.width(net).mask(),
    }
}

/// The input of one bit that most live cells read, among those not fixed yet.
fn busiest_input(
    logic: &Simplified,
    inputs: &[Net],
    roots: &[Net],
    netlist: &Netlist,
    fixed: &HashMap<Net, u64>,
) -> Option<Net> {
    let new = &logic.netlist;
    let mut live = vec![false; new.cells.len()];
    let mut readers = vec![0u32; new.cells.len()];
    let mut pending: Vec<Net> = roots.iter().map(|&net| logic.net(net)).collect();
    while let Some(net) = pending.pop() {
        if !std::mem::replace(&mut live[net.index()], true) {
            new.cell(net).op.visit_inputs(|input| {
                readers[input.index()] += 1;
                pending.push(input);
            });
        }
    }
    let candidates = inputs.iter().copied().filter(|net| netlist.width(*net).get() == 1 && !fixed.contains_key(net));
    let read = candidates
        .filter(|&net| matches!(new.cell(logic.net(net)).op, Op::Input) && readers[logic.net(net).index()] > 0);
    read.max_by_key(|&net| readers[logic.net(net).index()])
}
