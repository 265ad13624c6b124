//! The order of evaluation: cells, branches, and what happens at the edge as soon as it may.
//!
//! A register takes its next value in place once nothing will read its old one any more, so that hardly any value is
//! held back; where registers depend on each other in a ring, the value waits until the end of the clock.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use super::regions::{Fork, ROOT, Regions, Sink};
use stepwave_netlist::cells::{Net, Netlist, Op, WritePort};

/// Forks of a region up to which the best order is looked for.
const FEW_FORKS: usize = 256;

/// One step of a clock.
#[derive(Debug)]
pub(super) enum Step {
    /// A cell is evaluated.
    Cell(Net),
    /// One of two branches, by a net of 1 bit: where it is 0, and 1.
    If(Net, [Vec<Step>; 2]),
    /// In a branch: the value of a multiplexer.
    Arm { mux: Net, value: Net },
    /// A register takes a value, in place or at the end of the clock.
    Commit { index: usize, register: Net, value: Net, late: bool },
    /// A register that is taken for a constant: leaves the loop where the value is another one.
    Guard { index: usize, value: Net, wanted: u64 },
    /// A port of a memory.
    Write { memory: usize, port: WritePort },
}

/// Puts steps into order.
pub(super) struct Planner<'a> {
    netlist: &'a Netlist,
    regions: &'a Regions<'a>,
    /// Cells in two branches below which both are evaluated after all.
    flat: usize,
    done: Vec<bool>,
    /// What will still read a register before it changes.
    readers: Vec<u32>,
    /// Registers that nothing reads any more, since it was last looked.
    freed: Vec<Net>,
    mark: Vec<u32>,
    marks: u32,
    /// Place of a net in the level that is being set up.
    place: Vec<u32>,
}

/// The cells of one region that are to be put into order.
#[derive(Default)]
struct Level {
    nets: Vec<Net>,
    /// How many each waits for, and who waits for it.
    waits: Vec<u32>,
    users: Vec<Vec<u32>>,
    ready: BinaryHeap<Reverse<u32>>,
    /// Multiplexers that could be branched on now, by their fork, and how many there will be. Selects that differ may come
    /// to the same net here, and have branches of their own all the same.
    members: BTreeMap<Fork, Vec<u32>>,
    remaining: HashMap<Fork, usize>,
    /// What waits for a cell of this level.
    by_value: HashMap<u32, Vec<Sink>>,
    /// What waits until a register is not read any more.
    blocked: BTreeMap<Net, Sink>,
    steps: Vec<Step>,
}

impl<'a> Planner<'a> {
    pub(super) fn new(netlist: &'a Netlist, regions: &'a Regions<'a>, worth: u32) -> Planner<'a> {
        let count = netlist.cells.len();
        let mut planner = Planner {
            netlist,
            regions,
            flat: worth as usize / 2,
            done: netlist.cells.iter().map(|cell| is_leaf(cell.op)).collect(),
            readers: vec![0; count],
            freed: Vec::new(),
            mark: vec![0; count],
            marks: 0,
            place: vec![0; count],
        };
        let needed = netlist.nets().filter(|&net| regions.is_needed(net));
        for net in needed {
            regions.op(net).visit_inputs(|input| planner.readers[input.index()] += 1);
        }
        for region in regions.inside(ROOT) {
            for net in regions.sinks(region).iter().flat_map(Sink::nets) {
                planner.readers[net.index()] += 1;
            }
            for fork in regions.forks(region) {
                planner.readers[fork.condition.index()] += 1;
            }
        }
        planner
    }

    /// What is looked at in every sample.
    pub(super) fn observe(&mut self, observed: &[Net]) -> Vec<Step> {
        self.plan(ROOT, observed, false)
    }

    /// All that is left of a clock.
    pub(super) fn clock(&mut self) -> Vec<Step> {
        self.plan(ROOT, &[], true)
    }

    /// Steps of a region: the cells that the goals depend on, and what happens at the edge if it is asked for.
    fn plan(&mut self, region: u32, goals: &[Net], sinks: bool) -> Vec<Step> {
        let mut level = self.level(region, goals, sinks);
        let mut foreign = Vec::new();
        if sinks {
            for &sink in self.regions.sinks(region) {
                match sink {
                    Sink::Commit { value, .. } | Sink::Guard { value, .. } if !self.done[value.index()] => {
                        level.by_value.entry(self.place[value.index()]).or_default().push(sink);
                    }
                    Sink::Write { .. } => {}
                    _ => self.settle(&mut level, sink),
                }
            }
        }
        loop {
            self.release(&mut level, &mut foreign);
            if let Some(Reverse(item)) = level.ready.pop() {
                level.steps.push(Step::Cell(level.nets[item as usize]));
                self.finish(&mut level, item);
            } else if let Some(fork) = best(&level) {
                self.branch(&mut level, fork);
            } else {
                break;
            }
        }
        if sinks {
            self.edge(&mut level, region, &mut foreign);
        }
        self.freed.append(&mut foreign);
        if sinks { near_uses(self.netlist, self.regions, level.steps) } else { level.steps }
    }

    /// Gathers the cells of a region and what they wait for.
    fn level(&mut self, region: u32, goals: &[Net], sinks: bool) -> Level {
        let mut pending = goals.to_vec();
        if sinks {
            for region in self.regions.inside(region) {
                pending.extend(self.regions.sinks(region).iter().flat_map(Sink::nets));
                pending.extend(self.regions.forks(region).map(|fork| fork.condition));
            }
        }
        let mut level = Level { nets: self.cells_of(region, pending, true), ..Level::default() };
        level.nets.sort_unstable();
        level.waits = vec![0; level.nets.len()];
        level.users = vec![Vec::new(); level.nets.len()];
        for (item, &net) in level.nets.iter().enumerate() {
            self.place[net.index()] = u32::try_from(item).unwrap_or(u32::MAX);
        }
        for item in 0..level.nets.len() {
            let net = level.nets[item];
            let mut inputs = Vec::new();
            self.regions.op(net).visit_inputs(|input| inputs.push(input));
            let needs = self.cells_of(region, inputs, false);
            level.waits[item] = u32::try_from(needs.len()).unwrap_or(u32::MAX);
            for need in needs {
                level.users[self.place[need.index()] as usize].push(u32::try_from(item).unwrap_or(u32::MAX));
            }
            if let Some(fork) = self.regions.fork_of(net) {
                *level.remaining.entry(fork).or_default() += 1;
            }
            if level.waits[item] == 0 {
                self.wake(&mut level, u32::try_from(item).unwrap_or(u32::MAX));
            }
        }
        level
    }

    /// The cells of a region that these nets depend on and that are not done: all, or up to the first of each path.
    fn cells_of(&mut self, region: u32, mut pending: Vec<Net>, all: bool) -> Vec<Net> {
        self.marks += 1;
        let mut found = Vec::new();
        while let Some(net) = pending.pop() {
            if self.done[net.index()] || std::mem::replace(&mut self.mark[net.index()], self.marks) == self.marks {
                continue;
            }
            let is_here = self.regions.of(net) == region;
            if is_here {
                found.push(net);
            }
            if is_here && !all {
                continue;
            }
            self.regions.op(net).visit_inputs(|input| pending.push(input));
        }
        found
    }

    /// All that a cell waits for is done.
    fn wake(&self, level: &mut Level, item: u32) {
        let net = level.nets[item as usize];
        if let Some(fork) = self.regions.fork_of(net) {
            level.members.entry(fork).or_default().push(item);
        } else {
            level.ready.push(Reverse(item));
        }
    }

    fn finish(&mut self, level: &mut Level, item: u32) {
        let net = level.nets[item as usize];
        self.done[net.index()] = true;
        self.regions.op(net).visit_inputs(|input| self.unread(input));
        for user in std::mem::take(&mut level.users[item as usize]) {
            level.waits[user as usize] -= 1;
            if level.waits[user as usize] == 0 {
                self.wake(level, user);
            }
        }
        for sink in level.by_value.remove(&item).unwrap_or_default() {
            self.settle(level, sink);
        }
    }

    /// One that read a net is done.
    fn unread(&mut self, net: Net) {
        self.readers[net.index()] -= 1;
        if self.readers[net.index()] == 0 && matches!(self.netlist.cell(net).op, Op::Register { .. }) {
            self.freed.push(net);
        }
    }

    /// The value of a sink is there.
    fn settle(&mut self, level: &mut Level, sink: Sink) {
        match sink {
            Sink::Commit { register, value, .. } if self.readers[register.index()] > u32::from(register == value) => {
                level.blocked.insert(register, sink);
            }
            _ => self.take(level, sink),
        }
    }

    fn take(&mut self, level: &mut Level, sink: Sink) {
        for net in sink.nets() {
            self.unread(net);
        }
        level.steps.push(match sink {
            Sink::Commit { index, register, value } => {
                Step::Commit { index, register, value, late: self.readers[register.index()] > 0 }
            }
            Sink::Guard { index, value, wanted } => Step::Guard { index, value, wanted },
            Sink::Write { memory, port } => Step::Write { memory, port },
        });
    }

    /// Registers that have come to be read no more take their values.
    fn release(&mut self, level: &mut Level, foreign: &mut Vec<Net>) {
        while let Some(register) = self.freed.pop() {
            match level.blocked.remove(&register) {
                Some(sink) => self.take(level, sink),
                None => foreign.push(register),
            }
        }
    }

    /// All multiplexers of a fork that are there.
    fn branch(&mut self, level: &mut Level, fork: Fork) {
        let members = level.members.remove(&fork).unwrap_or_default();
        if let Some(remaining) = level.remaining.get_mut(&fork) {
            *remaining -= members.len();
        }
        let muxes: Vec<Net> = members.iter().map(|&item| level.nets[item as usize]).collect();
        let mut flat = 0;
        let arms = [0, 1].map(|arm| {
            let values = muxes.iter().map(|&mux| match self.regions.op(mux) {
                Op::Mux { high, low, .. } => [low, high][arm],
                _ => mux,
            });
            let values: Vec<Net> = values.collect();
            let mut steps = self.plan(fork.branches[arm], &values, false);
            let only_cells = steps.iter().all(|step| matches!(step, Step::Cell(_)));
            flat += if only_cells { steps.len() } else { usize::MAX / 2 };
            steps.extend(muxes.iter().zip(values).map(|(&mux, value)| Step::Arm { mux, value }));
            near_uses(self.netlist, self.regions, steps)
        });
        if flat < self.flat {
            // Evaluated anyway: selected.
            level.steps.extend(arms.into_iter().flatten().filter(|step| matches!(step, Step::Cell(_))));
            level.steps.extend(muxes.into_iter().map(Step::Cell));
        } else {
            level.steps.push(Step::If(fork.condition, arms));
        }
        members.into_iter().for_each(|item| self.finish(level, item));
    }

    /// What happens at the edge and has not happened yet.
    fn edge(&mut self, level: &mut Level, region: u32, foreign: &mut Vec<Net>) {
        for &sink in self.regions.sinks(region) {
            if matches!(sink, Sink::Write { .. }) {
                self.take(level, sink);
            }
        }
        self.release(level, foreign);
        let mut forks: Vec<Fork> = self.regions.forks(region).collect();
        if forks.len() <= FEW_FORKS {
            let mut own: Vec<Vec<(Net, u32)>> = forks.iter().map(|&fork| self.own(fork)).collect();
            while !forks.is_empty() {
                let free = |own: &Vec<(Net, u32)>| own.iter().all(|&(net, count)| self.readers[net.index()] <= count);
                let next = own.iter().position(free).unwrap_or(0);
                own.remove(next);
                let fork = forks.remove(next);
                self.take_fork(level, fork, foreign);
            }
        }
        for fork in forks {
            self.take_fork(level, fork, foreign);
        }
        while let Some((_, sink)) = level.blocked.pop_first() {
            self.take(level, sink);
            self.release(level, foreign);
        }
    }

    fn take_fork(&mut self, level: &mut Level, fork: Fork, foreign: &mut Vec<Net>) {
        self.unread(fork.condition);
        let arms = fork.branches.map(|branch| self.plan(branch, &[], true));
        level.steps.push(Step::If(fork.condition, arms));
        self.release(level, foreign);
    }

    /// The registers that take a value in a fork, and how often it reads each itself.
    fn own(&mut self, fork: Fork) -> Vec<(Net, u32)> {
        let regions = self.regions;
        let inside: Vec<u32> = fork.branches.iter().flat_map(|&branch| regions.inside(branch)).collect();
        let mut reads: HashMap<Net, u32> = HashMap::default();
        let mut pending = vec![];
        let mut read = |net: Net| *reads.entry(net).or_default() += 1;
        read(fork.condition);
        for &region in &inside {
            for net in regions.sinks(region).iter().flat_map(Sink::nets) {
                read(net);
                pending.push(net);
            }
            for fork in regions.forks(region) {
                read(fork.condition);
                pending.push(fork.condition);
            }
        }
        self.marks += 1;
        while let Some(net) = pending.pop() {
            if !self.done[net.index()] && std::mem::replace(&mut self.mark[net.index()], self.marks) != self.marks {
                regions.op(net).visit_inputs(|input| {
                    read(input);
                    pending.push(input);
                });
            }
        }
        let sinks = inside.iter().flat_map(|&region| regions.sinks(region));
        let registers = sinks.filter_map(|sink| match sink {
            Sink::Commit { register, .. } => Some(*register),
            _ => None,
        });
        registers.map(|register| (register, reads.get(&register).copied().unwrap_or(0))).collect()
    }
}

/// The fork to take next: one whose multiplexers are all there, or else that of most.
fn best(level: &Level) -> Option<Fork> {
    let whole = |fork: &Fork, members: &Vec<u32>| level.remaining.get(fork) == Some(&members.len());
    let best = level.members.iter().max_by_key(|(fork, members)| (whole(fork, members), members.len()));
    best.map(|(&fork, _)| fork)
}

/// Puts each cell right before the first step that uses it, or changes what it reads.
fn near_uses(netlist: &Netlist, regions: &Regions<'_>, steps: Vec<Step>) -> Vec<Step> {
    let mut near = Near { netlist, regions, waiting: HashSet::default(), readers: HashMap::default(), out: Vec::new() };
    let mut cells = Vec::new();
    for step in steps {
        if let Step::Cell(net) = step {
            near.wait(net);
            cells.push(net);
        } else {
            near.before(&step);
            near.out.push(step);
        }
    }
    cells.into_iter().for_each(|net| near.put(net));
    near.out
}

struct Near<'a> {
    netlist: &'a Netlist,
    regions: &'a Regions<'a>,
    waiting: HashSet<Net>,
    /// Waiting cells that read a register; a memory, in the place of which there is none.
    readers: HashMap<Option<Net>, Vec<Net>>,
    out: Vec<Step>,
}

impl Near<'_> {
    fn wait(&mut self, net: Net) {
        self.waiting.insert(net);
        let op = self.regions.op(net);
        op.visit_inputs(|input| {
            if matches!(self.netlist.cell(input).op, Op::Register { .. }) {
                self.readers.entry(Some(input)).or_default().push(net);
            }
        });
        if matches!(op, Op::Read { .. }) {
            self.readers.entry(None).or_default().push(net);
        }
    }

    /// A cell, after all that it depends on.
    fn put(&mut self, net: Net) {
        let mut pending = vec![(net, false)];
        while let Some((net, is_ready)) = pending.pop() {
            if is_ready {
                if self.waiting.remove(&net) {
                    self.out.push(Step::Cell(net));
                }
            } else if self.waiting.contains(&net) {
                pending.push((net, true));
                self.regions.op(net).visit_inputs(|input| pending.push((input, false)));
            }
        }
    }

    /// All that has to come before a step.
    fn before(&mut self, step: &Step) {
        match *step {
            Step::Cell(net) => {
                let mut inputs = Vec::new();
                self.regions.op(net).visit_inputs(|input| inputs.push(input));
                inputs.into_iter().for_each(|input| self.put(input));
            }
            Step::If(condition, ref arms) => {
                self.put(condition);
                arms.iter().flatten().for_each(|step| self.before(step));
            }
            Step::Arm { value, .. } => self.put(value),
            Step::Guard { value, .. } => self.put(value),
            Step::Commit { register, value, .. } => {
                self.put(value);
                self.read(Some(register));
            }
            Step::Write { port, .. } => {
                port.nets().into_iter().for_each(|net| self.put(net));
                self.read(None);
            }
        }
    }

    fn read(&mut self, of: Option<Net>) {
        for net in self.readers.remove(&of).unwrap_or_default() {
            self.put(net);
        }
    }
}

/// Inputs, constants and registers are there before the clock.
pub(super) fn is_leaf(op: Op) -> bool {
    matches!(op, Op::Input | Op::Const(_) | Op::Register { .. })
}
