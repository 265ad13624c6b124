//! Code generation: a loop over clocks in which registers are SSA values.
//!
//! The loop body holds one or more *phases*, one clock each. In a phase some registers are fixed to known values (a
//! beat of a ring counter, `busy` = 1), so that the logic that they drive folds away; wherever a fixed register's next
//! value is not known to be the one that the next phase expects, a guard compares them and leaves the loop.
//!
//! ```text
//! entry:   one edge from the sample that the caller holds; guard
//! phase 0: settle; record a row; leave at a stop net; edge, at which memories are written; guard
//!   …
//! phase p-1: …; leave if less than a whole round is left; edge; guard; back to phase 0
//! ```
//!
//! It ends at one of two points: *after a recorded sample* (a stop net, or the budget), or *after an edge* whose sample
//! is not recorded yet (a guard failed), which the last word of the state says.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, BlockArg, InstBuilder, MemFlags, Type, Value, types};
use cranelift_frontend::FunctionBuilder;

use crate::memories::Place;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Op};
use stepwave_netlist::passes::Simplified;

/// One clock of the loop body.
pub(super) struct Phase {
    /// The netlist with the fixed registers folded in.
    pub(super) logic: Simplified,
    /// Fixed registers and their values in the sample of this phase.
    pub(super) fixed: HashMap<Net, u64>,
}

/// What the loop is generated from. Nets are those of the design.
pub(super) struct Plan<'a> {
    /// The netlist with nothing but inputs folded in.
    pub(super) entry: &'a Simplified,
    pub(super) phases: &'a [Phase],
    /// Each register and the net of its next value; the state begins with them.
    pub(super) registers: &'a [(Net, Net)],
    /// Where each memory is among the words of all.
    pub(super) memories: &'a [Place],
    /// Inputs, after the registers in the state.
    pub(super) inputs: &'a [Net],
    pub(super) columns: &'a [Net],
    /// Rows from one column to the next.
    pub(super) stride: usize,
    pub(super) stops: &'a [Net],
    /// Where there are some, samples are [passed over](super::passing) in which nothing but these registers changes.
    pub(super) running: &'a [Net],
    /// Nets that are never passed over while they are 1.
    pub(super) flags: &'a [Net],
    /// Where the machine is large: [branches](super::branching) instead of several phases.
    pub(super) branches: Option<Branches>,
}

/// How a large machine is compiled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branches {
    /// Work in the two branches of a select, in cells, from which on one of them is taken, rather than both evaluated.
    pub(super) worth: u32,
    /// The code will run for long: it is made with care.
    pub(super) lasting: bool,
}

impl Plan<'_> {
    /// Words of all memories.
    pub(super) fn memory_words(&self) -> usize {
        self.memories.last().map_or(0, |place| place.index(place.size) + 1)
    }

    /// The register is its own next value in every phase, and fixed in none.
    pub(super) fn is_held(&self, index: usize) -> bool {
        let (net, next) = self.registers[index];
        let holds = |logic: &Simplified| logic.net(net) == logic.net(next);
        holds(self.entry) && self.phases.iter().all(|phase| !phase.fixed.contains_key(&net) && holds(&phase.logic))
    }

    /// The columns, by index, whose nets have in every sample of the loop the value that they had in the sample before
    /// it: they depend on inputs, held registers and memories that nothing writes alone, or are the same constant in all phases.
    pub(super) fn resting(&self) -> Vec<usize> {
        let netlist = &self.entry.netlist;
        let held = (0..self.registers.len()).filter(|&index| self.is_held(index));
        let held: HashSet<Net> = held.map(|index| self.entry.net(self.registers[index].0)).collect();
        let mut rests: Vec<bool> = Vec::with_capacity(netlist.cells.len());
        for (net, cell) in netlist.nets().zip(&netlist.cells) {
            let mut all = true;
            cell.op.visit_inputs(|input| all &= rests[input.index()]);
            rests.push(match cell.op {
                Op::Register { .. } => held.contains(&net),
                Op::Read { memory, .. } => all && netlist.memories[memory as usize].writes.is_empty(),
                _ => all,
            });
        }
        let constant = |net: Net| {
            let mut values = self.phases.iter().map(|phase| phase.logic.constant(net));
            let first = values.next().flatten();
            first.is_some() && values.all(|value| value == first)
        };
        let resting = |&column: &usize| {
            let net = self.columns[column];
            rests[self.entry.net(net).index()] || constant(net)
        };
        (0..self.columns.len()).filter(resting).collect()
    }
}

/// Register values in one sample, by index into `Plan::registers`.
pub(super) type RegisterValues = Vec<Value>;

pub(super) struct Generator<'a, 'c> {
    pub(super) plan: &'a Plan<'a>,
    pub(super) f: &'a mut FunctionBuilder<'c>,
    state: Value,
    /// The words of all memories.
    pub(super) memories: Value,
    inputs: Vec<Value>,
    /// Columns that are stored in every row, by index.
    pub(super) busy: Vec<usize>,
    /// Sums and differences that are known not to leave their width.
    pub(super) exact: HashSet<Net>,
    /// Nets of 2 to 32 bits are words of 32 bits.
    pub(super) narrow: bool,
    /// Words that bits were taken from, which are 0 or 1 too.
    pub(super) words: HashMap<Value, Value>,
    /// Sums of this block, in narrow code: an adder and its carry have one.
    pub(super) sums: HashMap<[Value; 2], Value>,
}

/// Type of the value of a net.
pub(super) fn kind(width: Width) -> Type {
    if width == Width::ONE { types::I8 } else { types::I64 }
}

/// Memory of the caller: aligned, present.
pub(super) fn trusted() -> MemFlags {
    MemFlags::trusted()
}

pub(super) fn offset(word: usize) -> i32 {
    i32::try_from(word * 8).unwrap_or(i32::MAX)
}

/// A value as an immediate operand.
pub(super) fn immediate(value: u64) -> i64 {
    value.cast_signed()
}

/// Generates the body of `fn(state, rows, clocks, memories) -> recorded`, `rows` being the place of the next row in the first
/// column; the builder is in the entry block with those parameters. `clocks` is at least the number of phases.
/// Columns that are `resting` are not stored.
pub(super) fn generate(plan: &Plan<'_>, resting: &[usize], f: &mut FunctionBuilder<'_>, entry: Block) {
    let parameters = f.block_params(entry).to_vec();
    let [state, rows, clocks, memories] = parameters[..] else { return };
    let (mut generator, start) = Generator::begin(plan, resting, f, [state, memories]);
    let widths: Vec<Width> =
        plan.registers.iter().map(|&(net, _)| plan.entry.netlist.width(plan.entry.net(net))).collect();

    // Registers that keep their value throughout are read once and not carried.
    let carried: Vec<usize> = (0..plan.registers.len()).filter(|&index| !plan.is_held(index)).collect();
    let zero = generator.f.ins().iconst(types::I64, 0);
    let values = generator.settle(plan.entry, &start, &[]);
    let first = generator.edge(plan.entry, &values, &start);
    let header = generator.f.create_block();
    for &index in &carried {
        generator.f.append_block_param(header, kind(widths[index]));
    }
    for _ in 0..3 {
        generator.f.append_block_param(header, types::I64);
    }
    generator.guard(&first, None, &plan.phases[0], zero);
    let mut arguments: Vec<BlockArg> = carried.iter().map(|&index| first[index].into()).collect();
    arguments.extend([rows, clocks, zero].map(BlockArg::from));
    generator.f.ins().jump(header, &arguments);

    generator.f.switch_to_block(header);
    let parameters = generator.f.block_params(header).to_vec();
    let mut sample = start;
    for (&index, &value) in carried.iter().zip(&parameters) {
        sample[index] = value;
    }
    let [mut row, left, mut recorded] = parameters[carried.len()..] else { return };
    let rounds = i64::try_from(plan.phases.len()).unwrap_or(i64::MAX);
    for (number, phase) in plan.phases.iter().enumerate() {
        generator.pin(&mut sample, phase, &widths);
        let observed: Vec<Net> = generator.busy.iter().map(|&column| plan.columns[column]).collect();
        let values = generator.settle(&phase.logic, &sample, &[&observed, plan.stops].concat());
        row = generator.record(&phase.logic, &values, row);
        recorded = generator.f.ins().iadd_imm(recorded, 1);
        if let Some(stop) = generator.any_stop(&phase.logic, &values) {
            generator.leave_if(stop, &sample, recorded, false);
        }
        let last = number + 1 == plan.phases.len();
        let mut left_after = left;
        if last {
            left_after = generator.f.ins().iadd_imm(left, -rounds);
            let ended = generator.f.ins().icmp_imm(IntCC::SignedLessThan, left_after, rounds);
            generator.leave_if(ended, &sample, recorded, false);
        }
        let next = generator.edge(&phase.logic, &values, &sample);
        let following = &plan.phases[(number + 1) % plan.phases.len()];
        generator.guard(&next, Some(&phase.logic), following, recorded);
        sample = next;
        if last {
            let mut arguments: Vec<BlockArg> = carried.iter().map(|&index| sample[index].into()).collect();
            arguments.extend([row, left_after, recorded].map(BlockArg::from));
            generator.f.ins().jump(header, &arguments);
        }
    }
}

impl<'a, 'c> Generator<'a, 'c> {
    /// A generator whose inputs are loaded, and the registers of the sample that the caller holds.
    pub(super) fn begin(
        plan: &'a Plan<'a>,
        resting: &[usize],
        f: &'a mut FunctionBuilder<'c>,
        [state, memories]: [Value; 2],
    ) -> (Generator<'a, 'c>, RegisterValues) {
        let busy = (0..plan.columns.len()).filter(|column| !resting.contains(column)).collect();
        let mut generator = Generator { busy, ..Generator::narrow(plan, f, [state, memories]) };
        generator.narrow = false;
        let nets = plan.registers.iter().map(|&(net, _)| net).chain(plan.inputs.iter().copied());
        let width = |net: Net| plan.entry.netlist.width(plan.entry.net(net));
        let mut words: RegisterValues =
            nets.enumerate().map(|(word, net)| generator.load(word, kind(width(net)))).collect();
        generator.inputs = words.split_off(plan.registers.len());
        (generator, words)
    }

    /// A generator of narrow code that loads what it needs where it needs it.
    pub(super) fn narrow(
        plan: &'a Plan<'a>,
        f: &'a mut FunctionBuilder<'c>,
        [state, memories]: [Value; 2],
    ) -> Generator<'a, 'c> {
        let (inputs, busy) = (Vec::new(), Vec::new());
        let (exact, words, sums) = (HashSet::default(), HashMap::default(), HashMap::default());
        Generator { plan, f, state, memories, inputs, busy, exact, narrow: true, words, sums }
    }

    /// A word of the state.
    pub(super) fn load(&mut self, word: usize, kind: Type) -> Value {
        let value = self.f.ins().load(types::I64, trusted(), self.state, offset(word));
        if kind == types::I8 { self.f.ins().ireduce(types::I8, value) } else { value }
    }

    pub(super) fn store_state(&mut self, word: usize, value: Value) {
        self.f.ins().store(trusted(), value, self.state, offset(word));
    }

    pub(super) fn wide(&mut self, value: Value) -> Value {
        self.converted(value, types::I64)
    }

    /// Type of the value of a net.
    pub(super) fn kind(&self, width: Width) -> Type {
        if self.narrow && (2..=32).contains(&width.get()) { types::I32 } else { kind(width) }
    }

    /// Fixed registers are constants in this phase.
    pub(super) fn pin(&mut self, sample: &mut RegisterValues, phase: &Phase, widths: &[Width]) {
        for (index, (net, _)) in self.plan.registers.iter().enumerate() {
            if let Some(&value) = phase.fixed.get(net) {
                sample[index] = self.f.ins().iconst(kind(widths[index]), immediate(value));
            }
        }
    }

    /// Values of all nets that the next values, the ports of memories and `observed` depend on.
    pub(super) fn settle(
        &mut self,
        logic: &Simplified,
        sample: &RegisterValues,
        observed: &[Net],
    ) -> HashMap<Net, Value> {
        let mut roots: Vec<Net> = observed.iter().map(|&net| logic.net(net)).collect();
        roots.extend(self.plan.registers.iter().map(|&(_, next)| logic.net(next)));
        roots.extend(logic.netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets()));
        self.settle_roots(logic, sample, roots)
    }

    /// Values of some nets of `logic`, and of all that they depend on.
    pub(super) fn settle_roots(
        &mut self,
        logic: &Simplified,
        sample: &RegisterValues,
        roots: Vec<Net>,
    ) -> HashMap<Net, Value> {
        self.settle_each(logic, sample, roots, |_, _, value| value)
    }

    /// The same, where `each` may put another value in the place of a net's, in the order of evaluation.
    pub(super) fn settle_each(
        &mut self,
        logic: &Simplified,
        sample: &RegisterValues,
        mut pending: Vec<Net>,
        mut each: impl FnMut(&mut FunctionBuilder<'_>, Net, Value) -> Value,
    ) -> HashMap<Net, Value> {
        let netlist = &logic.netlist;
        let mut needed = vec![false; netlist.cells.len()];
        while let Some(net) = pending.pop() {
            if !std::mem::replace(&mut needed[net.index()], true) {
                netlist.cell(net).op.visit_inputs(|input| pending.push(input));
            }
        }
        let mut values: HashMap<Net, Value> = HashMap::default();
        for (index, &(net, _)) in self.plan.registers.iter().enumerate() {
            if matches!(netlist.cell(logic.net(net)).op, Op::Register { .. }) {
                values.insert(logic.net(net), sample[index]);
            }
        }
        for (index, &net) in self.plan.inputs.iter().enumerate() {
            if matches!(netlist.cell(logic.net(net)).op, Op::Input) {
                values.insert(logic.net(net), self.inputs[index]);
            }
        }
        for net in netlist.nets().filter(|net| needed[net.index()]) {
            let value = match values.get(&net) {
                Some(&value) => value,
                None if self.exact.contains(&net) => self.unmasked(netlist.cell(net).op, &values),
                None => self.operation(netlist, &netlist.cell(net), |net| values[&net]),
            };
            let value = each(self.f, net, value);
            values.insert(net, value);
        }
        values
    }

    /// A sum or a difference that needs no cutting to its width.
    fn unmasked(&mut self, op: Op, values: &HashMap<Net, Value>) -> Value {
        match op {
            Op::Add(a, b) => self.f.ins().iadd(values[&a], values[&b]),
            Op::Sub(a, b) => self.f.ins().isub(values[&a], values[&b]),
            _ => self.f.ins().iconst(types::I64, 0),
        }
    }

    /// The memories are written; the next values of all registers.
    pub(super) fn edge(
        &mut self,
        logic: &Simplified,
        values: &HashMap<Net, Value>,
        sample: &RegisterValues,
    ) -> RegisterValues {
        self.write_memories(&logic.netlist, values);
        self.next(logic, values, sample)
    }

    /// Next values of all registers.
    pub(super) fn next(
        &self,
        logic: &Simplified,
        values: &HashMap<Net, Value>,
        sample: &RegisterValues,
    ) -> RegisterValues {
        let next = self.plan.registers.iter().enumerate();
        next.map(|(index, &(_, next))| values.get(&logic.net(next)).copied().unwrap_or(sample[index])).collect()
    }

    /// Leaves after an edge if a register is not as the phase expects.
    fn guard(&mut self, next: &RegisterValues, logic: Option<&Simplified>, phase: &Phase, recorded: Value) {
        if let Some(unequal) = self.unexpected(next, logic, phase) {
            self.leave_if(unequal, next, recorded, true);
        }
    }

    /// Not 0 where a register is not as the phase expects after an edge; `None` where none can be. With `logic` the next
    /// values that are constants in it need no comparison.
    pub(super) fn unexpected(
        &mut self,
        next: &RegisterValues,
        logic: Option<&Simplified>,
        phase: &Phase,
    ) -> Option<Value> {
        let mut unequal: Option<Value> = None;
        for (index, &(net, source)) in self.plan.registers.iter().enumerate() {
            let Some(&wanted) = phase.fixed.get(&net) else { continue };
            if logic.and_then(|logic| logic.constant(source)) == Some(wanted) {
                continue;
            }
            let differs = self.f.ins().icmp_imm(IntCC::NotEqual, next[index], immediate(wanted));
            unequal = Some(unequal.map_or(differs, |others| self.f.ins().bor(others, differs)));
        }
        unequal
    }

    pub(super) fn record(&mut self, logic: &Simplified, values: &HashMap<Net, Value>, row: Value) -> Value {
        for index in 0..self.busy.len() {
            let column = self.busy[index];
            let value = self.wide(values[&logic.net(self.plan.columns[column])]);
            self.f.ins().store(trusted(), value, row, offset(column * self.plan.stride));
        }
        self.f.ins().iadd_imm(row, i64::from(offset(1)))
    }

    pub(super) fn any_stop(&mut self, logic: &Simplified, values: &HashMap<Net, Value>) -> Option<Value> {
        let possible = self.plan.stops.iter().filter(|&&net| logic.constant(net) != Some(0));
        let nets: Vec<Value> = possible.map(|&net| values[&logic.net(net)]).collect();
        nets.into_iter().reduce(|a, b| self.f.ins().bor(a, b))
    }

    /// Where `condition` is not 0: writes the registers back and returns the number of samples recorded.
    fn leave_if(&mut self, condition: Value, sample: &RegisterValues, recorded: Value, unrecorded_edge: bool) {
        let stay = self.leaving(condition, sample);
        let flag = self.f.ins().iconst(types::I64, i64::from(unrecorded_edge));
        self.store_state(self.plan.registers.len() + self.plan.inputs.len(), flag);
        self.f.ins().return_(&[recorded]);
        self.f.switch_to_block(stay);
    }

    /// Leaves where `condition` is not 0, with the registers written back; the block returned is the other branch.
    pub(super) fn leaving(&mut self, condition: Value, sample: &RegisterValues) -> Block {
        let (exit, stay) = (self.f.create_block(), self.f.create_block());
        self.f.set_cold_block(exit);
        self.f.ins().brif(condition, exit, &[], stay, &[]);
        self.f.switch_to_block(exit);
        for (word, &value) in sample.iter().enumerate() {
            let value = self.wide(value);
            self.store_state(word, value);
        }
        stay
    }
}
