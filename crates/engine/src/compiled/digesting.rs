//! Code generation: a loop that records no samples, but what they come to.
//!
//! ```text
//! entry:   one edge from the sample that the caller holds; guard
//! word:    the words of all trains are 0
//! phase 0: settle; abandon at a stop or flag; a bit into the word of each train, values into lanes; edge; guard
//!   …
//! phase p-1: …; after as many rounds as a word has room for: store the words, leave after the last; back to word or
//!          phase 0
//! ```
//!
//! A short round is laid out several times, one after another, so that the counting of rounds is shared.
//!
//! Where anything happens that the caller would have to see (a stop net, a flag, a guard) the loop is abandoned, and
//! nothing of it counts. What is put into lanes, a value a round, is only what extremes need: a register that counts in one
//! direction has them at the ends, one that rests or goes through known values has none, and a value that a register
//! has held since the phase before is there already.

use std::collections::BTreeSet;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, BlockArg, InstBuilder, Value, types};
use cranelift_frontend::FunctionBuilder;

use super::codegen::{Generator, Phase, Plan, RegisterValues, immediate, kind, trusted};
use super::layout::{CLOCKS, FormFrom, Layout, ROUNDS, RangeFrom, TrainFrom};
use crate::digest::{Form, Wanted};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::Net;
use stepwave_netlist::passes::Simplified;

/// A loop that is being generated.
pub(super) struct Digesting<'a, 'c> {
    pub(super) generator: Generator<'a, 'c>,
    pub(super) plan: &'a Plan<'a>,
    pub(super) wanted: &'a Wanted,
    pub(super) layout: Layout,
    /// Where the loop goes when it is abandoned.
    pub(super) abandoned: Block,
    /// The lane of a value in a phase.
    pub(super) lanes: HashMap<(Put, usize), usize>,
    /// Those that have the value of this repetition.
    put: HashSet<(Put, usize)>,
    /// How often the round is laid out, and which of these it is.
    repetitions: usize,
    repetition: usize,
}

/// What is put into a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Put {
    Net(Net),
    /// The value of a form, by its index.
    Form(usize),
}

/// Clocks up to which a round is laid out again.
const REPEATED: usize = 4;

/// Loop-carried values other than the registers.
struct Carried {
    /// Words of the trains that are stored.
    words: Vec<Value>,
    narrow: Value,
    wide: Value,
    /// Rounds left of the word.
    rounds: Value,
    /// Place of the next words, and words left.
    out: Value,
    left: Value,
}

impl Carried {
    fn of(parameters: &[Value], words: usize) -> Option<Carried> {
        let (words, rest) = parameters.split_at(words);
        let [narrow, wide, rounds, out, left] = *rest else { return None };
        Some(Carried { words: words.to_vec(), narrow, wide, rounds, out, left })
    }

    fn arguments(&self) -> impl Iterator<Item = BlockArg> {
        let rest = [self.narrow, self.wide, self.rounds, self.out, self.left];
        self.words.iter().copied().chain(rest).map(BlockArg::from)
    }
}

/// Generates the body of `fn(state, narrow, wide, out, memories) -> 1, or 0 where it was abandoned`; the builder is in
/// the entry block with those parameters.
pub(super) fn generate(plan: &Plan<'_>, wanted: &Wanted, f: &mut FunctionBuilder<'_>, entry: Block) -> Option<Layout> {
    let [state, narrow, wide, out, memories] = *f.block_params(entry) else { return None };
    let abandoned = f.create_block();
    f.set_cold_block(abandoned);
    let phases = plan.phases.len();
    let rounds = 64usize.checked_div(phases)?;
    let (generator, start) = Generator::begin(plan, &[], f, [state, memories]);
    let span = rounds * phases;
    let fits = |words: &usize| words * rounds >= ROUNDS && (words * span).is_multiple_of(CLOCKS);
    let words = (1..=CLOCKS * ROUNDS).find(fits)?;
    let layout = Layout { span, rounds, words, ..Layout::default() };
    let repeats = |&times: &usize| rounds.is_multiple_of(times) && times * phases <= REPEATED;
    let repetitions = (1..=REPEATED).rev().find(repeats).unwrap_or(1);
    let (lanes, put) = (HashMap::default(), HashSet::default());
    let mut digesting =
        Digesting { generator, plan, wanted, layout, abandoned, lanes, put, repetitions, repetition: 0 };
    digesting.place();
    digesting.body(start, [narrow, wide, out])?;
    digesting.moved_lanes();
    let f = digesting.generator.f;
    f.switch_to_block(abandoned);
    let none = f.ins().iconst(types::I64, 0);
    f.ins().return_(&[none]);
    Some(digesting.layout)
}

impl Digesting<'_, '_> {
    fn body(&mut self, start: RegisterValues, [narrow, wide, out]: [Value; 3]) -> Option<()> {
        let plan = self.plan;
        let widths: Vec<Width> = plan.registers.iter().map(|&(net, _)| self.width(net)).collect();
        let carried: Vec<usize> = (0..plan.registers.len()).filter(|&index| self.is_carried(index)).collect();
        // The sample that the caller holds is one of the last phase.
        let before = plan.phases.last()?;
        let mut held = start.clone();
        self.generator.pin(&mut held, before, &widths);
        let values = self.generator.settle(&before.logic, &held, &[]);
        let first = self.generator.next(&before.logic, &values, &held);
        self.guard(&first, &before.logic, &plan.phases[0]);

        let [word, round] = [(); 2].map(|()| self.generator.f.create_block());
        for (block, others) in [(word, 4), (round, 5 + self.layout.stored)] {
            for &index in &carried {
                self.generator.f.append_block_param(block, kind(widths[index]));
            }
            for _ in 0..others {
                self.generator.f.append_block_param(block, types::I64);
            }
        }
        let left = self.constant(self.layout.words as u64);
        let others = [narrow, wide, out, left];
        self.jump(word, carried.iter().map(|&index| first[index]).chain(others));

        // A new word.
        self.generator.f.switch_to_block(word);
        let parameters = self.generator.f.block_params(word).to_vec();
        let (registers, others) = parameters.split_at(carried.len());
        let [narrow, wide, out, left] = *others else { return None };
        let zero = self.constant(0);
        let rounds = self.constant(self.layout.rounds as u64);
        let empty = vec![zero; self.layout.stored];
        self.jump(round, registers.iter().copied().chain(empty).chain([narrow, wide, rounds, out, left]));

        self.generator.f.switch_to_block(round);
        let parameters = self.generator.f.block_params(round).to_vec();
        let (registers, others) = parameters.split_at(carried.len());
        let mut sample = start;
        for (&index, &value) in carried.iter().zip(registers) {
            sample[index] = value;
        }
        let mut now = Carried::of(others, self.layout.stored)?;
        let next = self.round(&mut sample, &mut now, &widths)?;
        self.end_of_round(&sample, now, [word, round], carried.iter().map(|&index| next[index]).collect());
        Some(())
    }

    /// All phases, and that as often as it is laid out; gives the registers after the edge of the last one, and leaves in
    /// `sample` those before it.
    fn round(&mut self, sample: &mut RegisterValues, now: &mut Carried, widths: &[Width]) -> Option<RegisterValues> {
        let plan = self.plan;
        let mut pending = vec![0; self.layout.stored];
        let mut after = None;
        for (clock, phase) in plan.phases.iter().cycle().take(self.repetitions * plan.phases.len()).enumerate() {
            let number = clock % plan.phases.len();
            if let Some(next) = after.take() {
                *sample = next;
            }
            if number == 0 {
                self.repetition = clock / plan.phases.len();
                self.put.clear();
            }
            self.generator.pin(sample, phase, widths);
            self.generator.exact = self.exact(&phase.logic);
            let values = self.generator.settle(&phase.logic, sample, &self.observed());
            self.abandon_at(&phase.logic, &values);
            self.trains(&phase.logic, &values, &mut now.words, &mut pending);
            self.record(number, phase, &values, [now.narrow, now.wide]);
            let next = self.generator.next(&phase.logic, &values, sample);
            self.guard(&next, &phase.logic, &plan.phases[(number + 1) % plan.phases.len()]);
            after = Some(next);
        }
        for (word, pending) in now.words.iter_mut().zip(pending) {
            *word = self.generator.f.ins().ishl_imm(*word, pending);
        }
        after
    }

    fn observed(&self) -> Vec<Net> {
        let wanted = self.wanted;
        let ranges = wanted.ranges.iter().map(|(net, _)| *net);
        let forms = wanted.forms.iter().flat_map(Form::terms).map(|term| term.net);
        let flags = wanted.never.iter().chain(self.plan.stops).copied();
        wanted.trains.iter().copied().chain(ranges).chain(forms).chain(flags).collect()
    }

    /// Abandons the loop where a stop net or a flag is 1.
    fn abandon_at(&mut self, logic: &Simplified, values: &HashMap<Net, Value>) {
        let flags = self.plan.stops.iter().chain(&self.wanted.never);
        let flags: BTreeSet<Net> = flags.map(|&net| logic.net(net)).collect();
        let possible: Vec<Net> = flags.into_iter().filter(|&net| !self.is_excluded(logic, net)).collect();
        let all = possible.iter().map(|net| values[net]);
        if let Some(any) = all.reduce(|a, b| self.generator.f.ins().bor(a, b)) {
            self.abandon_if(any);
        }
    }

    fn abandon_if(&mut self, condition: Value) {
        let stay = self.generator.f.create_block();
        self.generator.f.ins().brif(condition, self.abandoned, &[], stay, &[]);
        self.generator.f.switch_to_block(stay);
    }

    fn guard(&mut self, next: &RegisterValues, logic: &Simplified, phase: &Phase) {
        if let Some(unequal) = self.generator.unexpected(next, Some(logic), phase) {
            self.abandon_if(unequal);
        }
    }

    /// Puts a bit into the word of each train, at its lower end: the first sample comes to be the highest.
    fn trains(&mut self, logic: &Simplified, values: &HashMap<Net, Value>, words: &mut [Value], pending: &mut [i64]) {
        let stored = self.wanted.trains.iter().zip(&self.layout.trains);
        for (&net, from) in stored {
            let &TrainFrom::Stored(index) = from else { continue };
            pending[index] += 1;
            let f = &mut *self.generator.f;
            let bit = match logic.constant(net) {
                Some(0) => continue,
                Some(_) => f.ins().iconst(types::I64, 1),
                None => {
                    let value = values[&logic.net(net)];
                    let is_bit = f.func.dfg.value_type(value) == types::I8;
                    let is_known = matches!(self.known_pulse(net), Some(1));
                    let f = &mut *self.generator.f;
                    match (is_bit, is_known) {
                        (true, _) => f.ins().uextend(types::I64, value),
                        (false, true) => value,
                        (false, false) => {
                            let bit = f.ins().icmp_imm(IntCC::NotEqual, value, 0);
                            f.ins().uextend(types::I64, bit)
                        }
                    }
                }
            };
            let f = &mut *self.generator.f;
            let shifted = f.ins().ishl_imm(words[index], pending[index]);
            words[index] = f.ins().bor(shifted, bit);
            pending[index] = 0;
        }
    }

    /// Puts the values of registers and forms that may be new in this phase into lanes.
    fn record(&mut self, number: usize, phase: &Phase, values: &HashMap<Net, Value>, [narrow, wide]: [Value; 2]) {
        let Phase { logic, .. } = phase;
        for (index, &(net, _)) in self.wanted.ranges.iter().enumerate() {
            if self.kept(net, number) {
                continue;
            }
            match self.layout.ranges[index] {
                RangeFrom::Narrow(_) => self.narrow_lane(narrow, net, number, values[&logic.net(net)]),
                RangeFrom::Wide(_) => self.wide_lane(wide, Put::Net(net), number, values[&logic.net(net)]),
                _ => continue,
            }
            let lane = self.lanes[&(Put::Net(net), number)];
            if let (RangeFrom::Narrow(lanes) | RangeFrom::Wide(lanes), 0) =
                (&mut self.layout.ranges[index], self.repetition)
            {
                lanes.push(lane);
            }
        }
        for (index, form) in self.wanted.forms.iter().enumerate() {
            if form.terms().iter().all(|term| self.kept(term.net, number)) {
                continue;
            }
            if let ([a, b], FormFrom::Pairs(_)) = (form.terms(), &self.layout.forms[index]) {
                for net in [a.net, b.net] {
                    self.narrow_lane(narrow, net, number, values[&logic.net(net)]);
                }
                let lanes = [a, b].map(|term| self.lanes[&(Put::Net(term.net), number)]);
                if let (FormFrom::Pairs(pairs), 0) = (&mut self.layout.forms[index], self.repetition) {
                    pairs.push(lanes);
                }
                continue;
            }
            let value = self.form(form, logic, values);
            self.wide_lane(wide, Put::Form(index), number, value);
            let lane = self.lanes[&(Put::Form(index), number)];
            if let (FormFrom::Wide(lanes), 0) = (&mut self.layout.forms[index], self.repetition) {
                lanes.push(lane);
            }
        }
    }

    /// Puts the value of a net in a phase into its narrow lane.
    fn narrow_lane(&mut self, place: Value, net: Net, phase: usize, value: Value) {
        let what = (Put::Net(net), phase);
        let lane = *self.lanes.entry(what).or_insert(self.layout.narrow);
        self.layout.narrow = self.layout.narrow.max(lane + 1);
        if self.put.insert(what) {
            let offset = i32::try_from(4 * (lane * self.layout.region() + self.repetition)).unwrap_or(i32::MAX);
            let value = self.generator.wide(value);
            self.generator.f.ins().istore32(trusted(), value, place, offset);
        }
    }

    /// Puts a value of a phase into its wide lane.
    fn wide_lane(&mut self, place: Value, what: Put, phase: usize, value: Value) {
        let lane = *self.lanes.entry((what, phase)).or_insert(self.layout.wide);
        self.layout.wide = self.layout.wide.max(lane + 1);
        if self.put.insert((what, phase)) {
            let offset = i32::try_from(8 * (lane * self.layout.region() + self.repetition)).unwrap_or(i32::MAX);
            let value = self.generator.wide(value);
            self.generator.f.ins().store(trusted(), value, place, offset);
        }
    }

    /// The value of a form.
    fn form(&mut self, form: &Form, logic: &Simplified, values: &HashMap<Net, Value>) -> Value {
        let mut sum = self.constant(0);
        for term in form.terms() {
            let width = logic.netlist.width(logic.net(term.net));
            let bits = self.generator.wide(values[&logic.net(term.net)]);
            let f = &mut *self.generator.f;
            let turned = f.ins().bxor_imm(bits, immediate(width.sign_bit()));
            let number = f.ins().iadd_imm(turned, immediate(width.sign_bit()).wrapping_neg());
            // linear · v + square · v² = (linear + square · v) · v
            let mut factor = f.ins().iconst(types::I64, term.linear);
            if term.square != 0 {
                let square = f.ins().imul_imm(number, term.square);
                factor = f.ins().iadd(square, factor);
            }
            let product = f.ins().imul(number, factor);
            sum = f.ins().iadd(sum, product);
        }
        sum
    }

    /// Counts the rounds; after the last of a word stores the words, and after the last word leaves.
    fn end_of_round(&mut self, sample: &RegisterValues, now: Carried, [word, round]: [Block; 2], next: Vec<Value>) {
        let (full, finished, further) = {
            let f = &mut *self.generator.f;
            (f.create_block(), f.create_block(), f.create_block())
        };
        let word_bytes = 8 * self.layout.stored as i64;
        let rounds = i64::try_from(self.repetitions).unwrap_or(1);
        let [narrow_bytes, wide_bytes] = [(self.layout.narrow, 4), (self.layout.wide, 8)]
            .map(|(lanes, bytes)| if lanes > 0 { bytes * rounds } else { 0 });
        let f = &mut *self.generator.f;
        let mut advance = |place: Value, bytes: i64| if bytes > 0 { f.ins().iadd_imm(place, bytes) } else { place };
        let (narrow, wide) = (advance(now.narrow, narrow_bytes), advance(now.wide, wide_bytes));
        let f = &mut *self.generator.f;
        let rounds = f.ins().iadd_imm(now.rounds, -rounds);
        let after = Carried { narrow, wide, rounds, ..now };
        let again: Vec<BlockArg> = next.iter().map(|&value| value.into()).chain(after.arguments()).collect();
        f.ins().brif(rounds, round, &again, full, &[]);

        f.switch_to_block(full);
        for (index, &word) in after.words.iter().enumerate() {
            f.ins().store(trusted(), word, after.out, i32::try_from(8 * index).unwrap_or(i32::MAX));
        }
        let out = f.ins().iadd_imm(after.out, word_bytes);
        let left = f.ins().iadd_imm(after.left, -1);
        f.ins().brif(left, further, &[], finished, &[]);

        f.switch_to_block(finished);
        for (index, &value) in sample.iter().enumerate() {
            let value = match self.counted(index) {
                Some(step) => self.counted_on(index, step),
                None => self.generator.wide(value),
            };
            self.generator.store_state(index, value);
        }
        let whole = self.constant(1);
        self.generator.f.ins().return_(&[whole]);

        self.generator.f.switch_to_block(further);
        self.jump(word, next.into_iter().chain([narrow, wide, out, left]));
    }

    /// The value after all rounds of a register that counts so far in each.
    fn counted_on(&mut self, index: usize, step: i64) -> Value {
        let rounds = i64::try_from(self.layout.records()).unwrap_or(0);
        let before = self.generator.load(index, types::I64);
        let after = self.generator.f.ins().iadd_imm(before, step.wrapping_mul(rounds));
        let mask = self.constant(self.width(self.plan.registers[index].0).mask());
        self.generator.f.ins().band(after, mask)
    }

    fn constant(&mut self, value: u64) -> Value {
        self.generator.f.ins().iconst(types::I64, immediate(value))
    }

    fn jump(&mut self, block: Block, values: impl Iterator<Item = Value>) {
        let arguments: Vec<BlockArg> = values.map(BlockArg::from).collect();
        self.generator.f.ins().jump(block, &arguments);
    }
}
