//! Code generation of large machines: one clock after another, registers in the state, what is not needed in branches
//! that are not taken.
//!
//! ```text
//! header: what is observed; in any clock but the first: record a row; leave at a stop net or with no clocks left
//! edge:   all that the next values need, in the order of `steps`; leave where a guard has failed; header
//! ```
//!
//! The first clock is that of the caller's sample, which is recorded already. Words of the state after registers, inputs,
//! the flag of a guard and that of a stop: nets that are used outside of the branch that they are evaluated in, and values of
//! registers that wait for the end of the clock.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, BlockArg, InstBuilder, Type, Value, types};
use cranelift_frontend::FunctionBuilder;

use super::codegen::{Branches, Generator, Plan, immediate, offset, trusted};
use super::regions::{Next, Regions};
use super::steps::{Planner, Step, is_leaf};
use stepwave_netlist::cells::{Cell, Net, Netlist, Op};
use stepwave_netlist::passes::Simplified;

/// Steps after which a value is loaded again rather than kept.
const NEAR: usize = 16;
/// Words that the register of the state follows: from those that a byte of an address does not reach, to where it would
/// come back soon.
const NEXT: usize = 16;
const FURTHER: usize = 48;

struct Branching<'a, 'c> {
    generator: Generator<'a, 'c>,
    netlist: &'a Netlist,
    regions: &'a Regions<'a>,
    state: Value,
    /// The state is in a register of its own: code that is made in one pass would load it for every access.
    is_pinned: bool,
    /// The word that this register points to, and the branches around this place.
    at: usize,
    depth: usize,
    /// Word that a failed guard sets; the next one says that a stop net is 1.
    flag: usize,
    /// Values that dominate this place, and their nets in the order in which they came.
    scoped: HashMap<Net, Value>,
    log: Vec<Net>,
    /// Values of this block, with the step that they were loaded in.
    near: HashMap<Net, (Value, usize)>,
    step: usize,
    /// Words of nets in the state, and of registers that change late.
    words: HashMap<Net, usize>,
    late: BTreeMap<usize, usize>,
    next_word: usize,
}

/// What is looked at in every sample.
struct Observed {
    /// Columns that are stored, by index.
    busy: Vec<usize>,
    stops: Vec<Net>,
    /// The nets of those columns, and the stops.
    nets: Vec<Net>,
}

impl Observed {
    fn of(plan: &Plan<'_>, logic: &Simplified, resting: &[usize]) -> Observed {
        let busy: Vec<usize> = (0..plan.columns.len()).filter(|column| !resting.contains(column)).collect();
        let stops = plan.stops.iter().copied().filter(|&net| logic.constant(net) != Some(0));
        let stops: Vec<Net> = stops.map(|net| logic.net(net)).collect();
        let columns = busy.iter().map(|&column| logic.net(plan.columns[column]));
        let nets = columns.chain(stops.iter().copied()).collect();
        Observed { busy, stops, nets }
    }
}

/// As [`codegen::generate`](super::codegen::generate), for a large machine; gives the words of the state.
pub(super) fn generate(plan: &Plan<'_>, resting: &[usize], f: &mut FunctionBuilder<'_>, entry: Block) -> Option<usize> {
    let [state, rows, clocks, memories] = f.block_params(entry).to_vec()[..] else { return None };
    let ([phase], Some(Branches { worth, lasting })) = (plan.phases, plan.branches) else { return None };
    let logic = &phase.logic;
    let netlist = &Regions::with_constants(&logic.netlist);
    let observed = Observed::of(plan, logic, resting);
    let registers = plan.registers.iter().enumerate().map(|(index, &(net, next))| {
        let fixed = phase.fixed.get(&net).copied();
        Next { index, register: logic.net(net), next: logic.net(next), fixed }
    });
    let registers: Vec<Next> = registers.collect();
    let regions = Regions::new(netlist, &registers, &observed.nets, worth);
    let mut planner = Planner::new(netlist, &regions, worth);
    let (first, rest) = (planner.observe(&observed.nets), planner.clock());

    let inputs = plan.inputs.iter().enumerate();
    let inputs = inputs.map(|(index, &net)| (logic.net(net), plan.registers.len() + index));
    let mut words: HashMap<Net, usize> = registers.iter().map(|next| (next.register, next.index)).collect();
    words.extend(inputs);
    let flag = plan.registers.len() + plan.inputs.len();
    let mut branching = Branching {
        generator: Generator::narrow(plan, f, [state, memories]),
        netlist,
        regions: &regions,
        state,
        is_pinned: !lasting,
        at: 0,
        depth: 0,
        flag,
        scoped: HashMap::default(),
        log: Vec::new(),
        near: HashMap::default(),
        step: 0,
        words,
        late: BTreeMap::new(),
        next_word: flag + 2,
    };
    branching.place([&first, &rest], &observed.nets);
    branching.body(plan, [&first, &rest], &observed, [rows, clocks]);
    Some(branching.next_word)
}

impl Branching<'_, '_> {
    fn body(&mut self, plan: &Plan<'_>, [first, rest]: [&[Step]; 2], observed: &Observed, [rows, clocks]: [Value; 2]) {
        let [header, record, edge, exit] = [(); 4].map(|()| self.generator.f.create_block());
        let done = self.generator.f.append_block_param(header, types::I64);
        let result = self.generator.f.append_block_param(exit, types::I64);
        let callers = self.is_pinned.then(|| self.generator.f.ins().get_pinned_reg(types::I64));
        if self.is_pinned {
            self.generator.f.ins().set_pinned_reg(self.state);
        }
        // A register that changes late does so in every clock: to what it was, where nothing else is stored.
        for (index, word) in self.late.clone() {
            self.copy(index, word);
        }
        self.point_to(0);
        let before = self.generator.f.ins().iconst(types::I64, -1);
        self.generator.f.ins().jump(header, &[before.into()]);
        self.enter(header);
        self.steps(first);
        self.point_to(0);
        let now = self.generator.f.ins().iadd_imm(done, 1);
        self.generator.f.ins().brif(now, record, &[], edge, &[]);

        self.enter(record);
        let leaves = self.record(plan, observed, [rows, done]);
        let ended = self.generator.f.ins().icmp(IntCC::Equal, now, clocks);
        let leaves = leaves.map_or(ended, |stop| self.generator.f.ins().bor(ended, stop));
        self.point_to(0);
        self.generator.f.ins().brif(leaves, exit, &[now.into()], edge, &[]);

        self.enter(edge);
        self.steps(rest);
        for (index, word) in self.late.clone() {
            self.copy(word, index);
        }
        self.point_to(0);
        let again: [BlockArg; 1] = [now.into()];
        if plan.phases.iter().all(|phase| phase.fixed.is_empty()) {
            self.generator.f.ins().jump(header, &again);
        } else {
            let failed = self.load(types::I8, self.flag);
            self.point_to(0);
            self.generator.f.ins().brif(failed, exit, &again, header, &again);
        }
        self.generator.f.switch_to_block(exit);
        if let Some(callers) = callers {
            self.generator.f.ins().set_pinned_reg(callers);
        }
        self.generator.f.ins().return_(&[result]);
    }

    /// A row, and whether a stop net is 1, which the state says too.
    fn record(&mut self, plan: &Plan<'_>, observed: &Observed, [rows, done]: [Value; 2]) -> Option<Value> {
        if !observed.busy.is_empty() {
            let bytes = self.generator.f.ins().ishl_imm(done, 3);
            let row = self.generator.f.ins().iadd(rows, bytes);
            for (&column, &net) in observed.busy.iter().zip(&observed.nets) {
                let value = self.value(net);
                let value = self.generator.wide(value);
                self.generator.f.ins().store(trusted(), value, row, offset(column * plan.stride));
            }
        }
        let stops: Vec<Value> = observed.stops.iter().map(|&stop| self.value(stop)).collect();
        let stop = stops.into_iter().reduce(|a, b| self.generator.f.ins().bor(a, b))?;
        self.store(self.flag + 1, stop);
        Some(stop)
    }

    /// Gives words to the nets that are used where they are not evaluated, and to registers that change late.
    fn place(&mut self, parts: [&[Step]; 2], observed: &[Net]) {
        let mut scopes = Scopes {
            netlist: self.netlist,
            regions: self.regions,
            of: HashMap::default(),
            chosen: HashSet::default(),
            open: vec![true],
            far: HashSet::default(),
            late: HashSet::default(),
            uses: HashMap::default(),
            passed: HashMap::default(),
        };
        scopes.walk(parts[0], 0);
        observed.iter().for_each(|&net| scopes.used(net));
        scopes.walk(parts[1], 0);
        let Scopes { far, late, uses, passed, .. } = scopes;
        let (mut far, mut late): (Vec<Net>, Vec<usize>) = (far.into_iter().collect(), late.into_iter().collect());
        far.sort_unstable();
        late.sort_unstable();
        // Users come first. A multiplexer that is nothing but the arm of another one is evaluated in its word.
        for net in far.into_iter().rev() {
            let shared = passed.get(&net).filter(|_| uses[&net] == 1).and_then(|mux| self.words.get(mux).copied());
            let word = shared.unwrap_or(self.next_word);
            self.words.insert(net, word);
            self.next_word += usize::from(word == self.next_word);
        }
        for index in late {
            self.late.insert(index, self.next_word);
            self.next_word += 1;
        }
    }

    fn enter(&mut self, block: Block) {
        self.generator.f.switch_to_block(block);
        self.near.clear();
        self.generator.sums.clear();
    }

    fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            self.step += 1;
            match *step {
                Step::Cell(net) => self.cell(net),
                Step::If(condition, ref arms) => self.branch(condition, arms),
                Step::Arm { mux, value } => {
                    let word = self.words[&mux];
                    if self.words.get(&value) != Some(&word) {
                        let value = self.value(value);
                        self.store(word, value);
                    }
                }
                Step::Commit { index, value, .. } => {
                    let value = self.value(value);
                    // In all branches, if in one.
                    let word = self.late.get(&index).copied().unwrap_or(index);
                    self.store(word, value);
                }
                Step::Guard { index, value, wanted } => self.guard(index, value, wanted),
                Step::Write { memory, port } => {
                    let values: Vec<(Net, Value)> = port.nets().into_iter().map(|net| (net, self.value(net))).collect();
                    self.generator.write(memory, port, |net| found(&values, net));
                    self.near.clear();
                }
            }
        }
    }

    fn cell(&mut self, net: Net) {
        let op = match (self.netlist.cell(net).op, self.regions.op(net)) {
            // A gate that is not branched on after all.
            (Op::And(..), Op::Mux { select, high, .. }) => Op::And(select, high),
            (Op::Or(..), Op::Mux { select, low, .. }) => Op::Or(select, low),
            (_, op) => op,
        };
        let cell = Cell { op, width: self.netlist.width(net) };
        let mut values = Vec::with_capacity(3);
        cell.op.visit_inputs(|input| values.push((input, self.value(input))));
        let value = self.generator.operation(self.netlist, &cell, |net| found(&values, net));
        if let Some(&word) = self.words.get(&net) {
            self.store(word, value);
        }
        self.scoped.insert(net, value);
        self.log.push(net);
    }

    fn branch(&mut self, condition: Net, [low, high]: &[Vec<Step>; 2]) {
        let condition = self.value(condition);
        let [with, without, after] = [(); 3].map(|()| self.generator.f.create_block());
        let [to_high, to_low] =
            [(high, with), (low, without)].map(|(steps, block)| if steps.is_empty() { after } else { block });
        self.generator.f.ins().brif(condition, to_high, &[], to_low, &[]);
        for (steps, block) in [(low, without), (high, with)] {
            if steps.is_empty() {
                continue;
            }
            self.enter(block);
            let kept = self.log.len();
            self.depth += 1;
            self.steps(steps);
            self.depth -= 1;
            self.generator.f.ins().jump(after, &[]);
            for net in self.log.drain(kept..) {
                self.scoped.remove(&net);
            }
        }
        self.enter(after);
    }

    fn guard(&mut self, index: usize, value: Net, wanted: u64) {
        let value = self.value(value);
        let differs = self.generator.f.ins().icmp_imm(IntCC::NotEqual, value, immediate(wanted));
        let [other, after] = [(); 2].map(|()| self.generator.f.create_block());
        self.generator.f.set_cold_block(other);
        self.generator.f.ins().brif(differs, other, &[], after, &[]);
        self.generator.f.switch_to_block(other);
        self.depth += 1;
        self.store(index, value);
        let one = self.generator.f.ins().iconst(types::I8, 1);
        self.store(self.flag, one);
        self.depth -= 1;
        self.generator.f.ins().jump(after, &[]);
        self.enter(after);
    }

    /// A word of the state becomes another one.
    fn copy(&mut self, from: usize, to: usize) {
        let value = self.load(types::I64, from);
        self.store(to, value);
    }

    /// Where a word of the state is: an address and bytes from it. The register of the state follows the words, which lie
    /// in the order of their use, so that a byte holds most distances: shorter code of a machine that no cache holds.
    fn place_of(&mut self, word: usize) -> (Value, i32) {
        if !self.is_pinned {
            return (self.state, offset(word));
        }
        if self.depth == 0 && (NEXT..FURTHER).contains(&word.abs_diff(self.at)) {
            self.point_to(word);
        }
        (self.generator.f.ins().get_pinned_reg(types::I64), offset(word) - offset(self.at))
    }

    /// The register of the state points to a word.
    fn point_to(&mut self, word: usize) {
        if self.is_pinned && word != self.at {
            let pinned = self.generator.f.ins().get_pinned_reg(types::I64);
            let bytes = offset(word) - offset(self.at);
            let pinned = self.generator.f.ins().iadd_imm(pinned, i64::from(bytes));
            self.generator.f.ins().set_pinned_reg(pinned);
            self.at = word;
        }
    }

    fn load(&mut self, kind: Type, word: usize) -> Value {
        let (base, bytes) = self.place_of(word);
        self.generator.f.ins().load(kind, trusted(), base, bytes)
    }

    fn store(&mut self, word: usize, value: Value) {
        let (base, bytes) = self.place_of(word);
        self.generator.f.ins().store(trusted(), value, base, bytes);
    }

    /// The value of a net in this place.
    fn value(&mut self, net: Net) -> Value {
        if let Some(&value) = self.scoped.get(&net) {
            return value;
        }
        if let Some(&(value, step)) = self.near.get(&net)
            && self.step - step <= NEAR
        {
            return value;
        }
        let cell = self.netlist.cell(net);
        let kind = self.generator.kind(cell.width);
        let value = match cell.op {
            Op::Const(value) => self.generator.f.ins().iconst(kind, immediate(value)),
            _ => self.load(kind, self.words[&net]),
        };
        self.near.insert(net, (value, self.step));
        value
    }
}

fn found(values: &[(Net, Value)], net: Net) -> Value {
    values.iter().find(|(other, _)| *other == net).expect("all operands have values").1
}

/// Finds the nets that are used outside of the branch that they are evaluated in.
struct Scopes<'a> {
    netlist: &'a Netlist,
    regions: &'a Regions<'a>,
    /// Where a net is evaluated.
    of: HashMap<Net, usize>,
    /// Multiplexers that have their value from an arm.
    chosen: HashSet<Net>,
    open: Vec<bool>,
    far: HashSet<Net>,
    late: HashSet<usize>,
    uses: HashMap<Net, usize>,
    /// Multiplexers that are an arm of another one.
    passed: HashMap<Net, Net>,
}

impl Scopes<'_> {
    fn walk(&mut self, steps: &[Step], scope: usize) {
        for step in steps {
            match *step {
                Step::Cell(net) => {
                    self.regions.op(net).visit_inputs(|input| self.used(input));
                    self.of.insert(net, scope);
                }
                Step::If(condition, ref arms) => {
                    self.used(condition);
                    for arm in arms {
                        self.open.push(true);
                        let inner = self.open.len() - 1;
                        self.walk(arm, inner);
                        self.open[inner] = false;
                    }
                }
                Step::Arm { mux, value } => {
                    self.used(value);
                    if self.regions.fork_of(value).is_some() && self.far.contains(&value) {
                        self.passed.insert(value, mux);
                    }
                    self.far.insert(mux);
                    self.chosen.insert(mux);
                }
                Step::Commit { index, value, late, .. } => {
                    self.used(value);
                    if late {
                        self.late.insert(index);
                    }
                }
                Step::Guard { value, .. } => self.used(value),
                Step::Write { port, .. } => port.nets().into_iter().for_each(|net| self.used(net)),
            }
        }
    }

    fn used(&mut self, net: Net) {
        *self.uses.entry(net).or_default() += 1;
        if is_leaf(self.netlist.cell(net).op) {
            return;
        }
        let of = self.of.get(&net);
        // A word that nothing has stored would be a false answer.
        assert!(of.is_some() || self.chosen.contains(&net), "{net:?} is used before it is evaluated");
        if !of.is_some_and(|&scope| self.open[scope]) {
            self.far.insert(net);
        }
    }
}
