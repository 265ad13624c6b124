//! A design that drives itself: a loader next to it sets its inputs as a test bench would, so that a model checker sees
//! the very run that an engine would show, and nothing is left to assume.
//!
//! The loader counts steps of the stimulus and the clocks of a step. Both are registers of a scope of their own, and
//! every input becomes what the step at hand sets it to. After the last step nothing changes any more.

use std::collections::{HashMap, HashSet};

use super::testbench::{Step, Stimulus};
use super::verilog::names::claim;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Cell, Format, NamedNet, Net, Netlist, Op, ScopeData, ScopeId};
use stepwave_netlist::diag::Diagnostics;
use stepwave_netlist::passes::move_property;
use stepwave_netlist::{Design, elaborate};

/// A design with a loader.
#[derive(Clone, Debug)]
pub struct Driven {
    /// The design.
    pub design: Design,
    shift: usize,
}

impl Driven {
    /// Where a net of the original went.
    #[must_use]
    pub fn net(&self, old: Net) -> Net {
        shifted(old, self.shift)
    }
}

fn shifted(net: Net, by: usize) -> Net {
    Net(u32::try_from(net.index() + by).unwrap_or(u32::MAX))
}

/// The design with a loader that sets its inputs step by step. What else ends a run in a test bench (`never`, `stall`)
/// does not end it here. Inputs in `open` stay inputs.
///
/// # Errors
/// The stimulus is not one of this design.
pub fn driven(design: &Design, stimulus: &Stimulus, open: &[Net]) -> Result<Driven, Diagnostics> {
    let old = design.netlist();
    let mut loader = Loader::new(old, &stimulus.steps);
    let inputs = design.inputs().iter().filter(|input| !open.contains(input));
    let values: HashMap<Net, Net> = inputs.map(|&input| (input, loader.input(old, input))).collect();
    let shift = loader.cells.len();
    for (net, cell) in old.nets().zip(&old.cells) {
        let go = |net| shifted(net, shift);
        let op = match (values.get(&net), cell.op) {
            // As wide, so that it is the value itself.
            (Some(&value), _) => Op::ZeroExtend(value),
            (None, Op::Register { next, reset }) => Op::Register { next: next.map(go), reset },
            (None, op) => op.map_inputs(go),
        };
        loader.cell(op, cell.width);
    }
    let done = stimulus.done.iter().map(|&done| shifted(done, shift)).collect::<Vec<_>>();
    let done = done.into_iter().reduce(|a, b| loader.cell(Op::Or(a, b), Width::ONE));
    loader.close(done);
    Ok(Driven { design: elaborate(loader.netlist(old, shift))?, shift })
}

/// When a step is over.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Over {
    /// With the sample of this age, the first being of age 0.
    Counted(u64),
    /// Where it is done, from the second sample on.
    Done,
    Never,
}

struct Loader<'a> {
    steps: &'a [Step],
    cells: Vec<Cell>,
    constants: HashMap<(Width, u64), Net>,
    /// Those of [`Loader::before`].
    before: HashMap<usize, Net>,
    /// Index of the step at hand.
    step: Net,
    /// Samples of it so far; stays at its greatest value.
    age: Net,
}

/// A width that holds every number up to this one.
fn width_of(greatest: u64) -> Width {
    Width::new(u64::from(Width::needed_unsigned(greatest.into()))).unwrap_or(Width::MAX)
}

impl<'a> Loader<'a> {
    fn new(netlist: &Netlist, steps: &'a [Step]) -> Loader<'a> {
        let register = Op::Register { next: None, reset: 0 };
        let (step, age) = (Net(0), Net(1));
        let cells = Vec::with_capacity(netlist.cells.len() + 4 * steps.len());
        let mut loader = Loader { steps, cells, constants: HashMap::new(), before: HashMap::new(), step, age };
        let longest = steps.iter().filter_map(|step| step.clocks).max().unwrap_or(1);
        loader.cell(register, width_of(steps.len().saturating_sub(1) as u64));
        loader.cell(register, width_of(longest.saturating_sub(1)));
        loader
    }

    fn cell(&mut self, op: Op, width: Width) -> Net {
        let net = shifted(Net(0), self.cells.len());
        self.cells.push(Cell { op, width });
        net
    }

    fn width(&self, net: Net) -> Width {
        self.cells[net.index()].width
    }

    fn constant(&mut self, width: Width, value: u64) -> Net {
        let value = value & width.mask();
        if let Some(&net) = self.constants.get(&(width, value)) {
            return net;
        }
        let net = self.cell(Op::Const(value), width);
        self.constants.insert((width, value), net);
        net
    }

    /// 1 while the step at hand comes before that of the index.
    fn before(&mut self, index: usize) -> Net {
        if let Some(&before) = self.before.get(&index) {
            return before;
        }
        let end = self.constant(self.width(self.step), index as u64);
        let before = self.cell(Op::Borrow(self.step, end), Width::ONE);
        self.before.insert(index, before);
        before
    }

    /// One of these, by the step at hand: each holds from the step of its index to the next one.
    fn select(&mut self, values: &[(usize, Net)]) -> Net {
        let Some((&(mut since, mut selected), earlier)) = values.split_last() else {
            return self.constant(Width::ONE, 0);
        };
        for &(index, value) in earlier.iter().rev() {
            let before = self.before(since);
            let mux = Op::Mux { select: before, high: value, low: selected };
            selected = self.cell(mux, self.width(value));
            since = index;
        }
        selected
    }

    /// What an input is set to.
    fn input(&mut self, netlist: &Netlist, input: Net) -> Net {
        let width = netlist.width(input);
        let mut values = Vec::new();
        let mut last = 0;
        for (index, step) in self.steps.iter().enumerate() {
            let set = step.set.iter().rev().find(|(net, _)| *net == input);
            let value = set.map_or(last, |(_, value)| *value);
            if index == 0 || value != last {
                values.push((index, self.constant(width, value)));
            }
            last = value;
        }
        if values.is_empty() {
            return self.constant(width, 0);
        }
        self.select(&values)
    }

    /// The logic of the loader's registers, after the design, whose `done` it reads.
    fn close(&mut self, done: Option<Net>) {
        let (step, age) = (self.step, self.age);
        let (step_width, age_width) = (self.width(step), self.width(age));
        let mut overs: Vec<(usize, Over)> = Vec::new();
        for (index, step) in self.steps.iter().enumerate() {
            let over = match step.clocks {
                _ if index + 1 == self.steps.len() => Over::Never,
                Some(clocks) => Over::Counted(clocks.max(1) - 1),
                None => Over::Done,
            };
            if overs.last().is_none_or(|(_, last)| *last != over) {
                overs.push((index, over));
            }
        }
        let first = self.constant(age_width, 0);
        let conditions: Vec<(usize, Net)> = overs
            .into_iter()
            .map(|(index, over)| {
                let net = match (over, done) {
                    (Over::Counted(last), _) => {
                        let last = self.constant(age_width, last);
                        self.cell(Op::Equal(age, last), Width::ONE)
                    }
                    (Over::Done, Some(done)) => {
                        let young = self.cell(Op::Equal(age, first), Width::ONE);
                        let old = self.cell(Op::Not(young), Width::ONE);
                        self.cell(Op::And(old, done), Width::ONE)
                    }
                    (Over::Done, None) | (Over::Never, _) => self.constant(Width::ONE, 0),
                };
                (index, net)
            })
            .collect();
        let over = self.select(&conditions);
        let mut count = |register: Net, width: Width| {
            let one = self.constant(width, 1);
            self.cell(Op::Add(register, one), width)
        };
        let (next_step, older) = (count(step, step_width), count(age, age_width));
        let oldest = self.constant(age_width, age_width.mask());
        let stays = self.cell(Op::Equal(age, oldest), Width::ONE);
        let older = self.cell(Op::Mux { select: stays, high: age, low: older }, age_width);
        let next_age = self.cell(Op::Mux { select: over, high: first, low: older }, age_width);
        let next_step = self.cell(Op::Mux { select: over, high: next_step, low: step }, step_width);
        for (register, next) in [(step, next_step), (age, next_age)] {
            self.cells[register.index()].op = Op::Register { next: Some(next), reset: 0 };
        }
    }

    /// The netlist with the names and properties of the old one.
    fn netlist(self, old: &Netlist, shift: usize) -> Netlist {
        let go = |net| shifted(net, shift);
        let mut names: Vec<NamedNet> = old.names.iter().map(|named| named.map(go)).collect();
        let in_top = old.names.iter().filter(|named| named.scope == ScopeId::TOP).map(|named| named.name.clone());
        let inner =
            old.scopes.iter().filter(|scope| scope.parent == Some(ScopeId::TOP)).map(|scope| scope.name.clone());
        let name = claim(&mut in_top.chain(inner).collect::<HashSet<String>>(), "loader");
        let scope = ScopeId(u32::try_from(old.scopes.len()).unwrap_or(u32::MAX));
        for (name, net) in [("step", self.step), ("age", self.age)] {
            names.push(NamedNet::new(net, scope, name, Format::Unsigned));
        }
        let mut scopes = old.scopes.clone();
        scopes.push(ScopeData { parent: Some(ScopeId::TOP), name });
        let mut properties = old.properties.clone();
        for property in &mut properties {
            move_property(property, go);
        }
        let mut sources = vec![None; shift];
        sources.extend(old.sources.iter().cloned());
        sources.resize(self.cells.len(), None);
        let mut memories = old.memories.clone();
        for port in memories.iter_mut().flat_map(|memory| &mut memory.writes) {
            *port = port.map(go);
        }
        Netlist { cells: self.cells, memories, scopes, names, properties, invariants: Vec::new(), sources }
    }
}
