//! Code generation: a loop that records no samples, but what they come to.
//!
//! ```text
//! entry:   one edge from the sample that the caller holds; guard
//! word:    the words of all trains are 0
//! phase 0: settle; abandon at a stop or flag; a bit into the word of each train, values into the record; edge; guard
//!   …
//! phase p-1: …; after as many rounds as a word has room for: store the words, leave after the last; back to word or
//!          phase 0
//! ```
//!
//! Where anything happens that the caller would have to see (a stop net, a flag, a guard) the loop is abandoned, and
//! nothing of it counts. What is put into records, one a round, is only what extremes need: a register that counts in one
//! direction has them at the ends, one that rests or goes through known values has none, and a value that a register
//! has held since the phase before is there already.

use std::collections::{BTreeSet, HashMap};

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, BlockArg, InstBuilder, Value, types};
use cranelift_frontend::FunctionBuilder;

use super::codegen::{Generator, Phase, Plan, RegisterValues, immediate, kind, trusted};
use super::layout::{
    CLOCKS, Layout, NARROW, RangeFrom, SMALL_COUNTER, TrainFrom, WORDS, is_one, moves, only_value, stride,
};
use crate::digest::{Form, Wanted};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Op};
use stepwave_netlist::passes::Simplified;

/// A loop that is being generated.
struct Digesting<'a, 'c> {
    generator: Generator<'a, 'c>,
    plan: &'a Plan<'a>,
    wanted: &'a Wanted,
    layout: Layout,
    /// Where the loop goes when it is abandoned.
    abandoned: Block,
    /// Lanes used of the narrow and of the wide record.
    lanes: [usize; 2],
}

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
    let words = (1..=CLOCKS).map(|times| times * WORDS).find(|words| (words * span).is_multiple_of(CLOCKS))?;
    let layout = Layout { span, rounds, words, ..Layout::default() };
    let mut digesting = Digesting { generator, plan, wanted, layout, abandoned, lanes: [0; 2] };
    digesting.place();
    digesting.body(start, [narrow, wide, out])?;
    let f = digesting.generator.f;
    f.switch_to_block(abandoned);
    let none = f.ins().iconst(types::I64, 0);
    f.ins().return_(&[none]);
    Some(digesting.layout)
}

impl Digesting<'_, '_> {
    /// Decides where ranges and trains come from; lanes are given as values are recorded.
    fn place(&mut self) {
        for &(net, _) in &self.wanted.ranges {
            let from = self.range(net);
            self.layout.ranges.push(from);
        }
        for &net in &self.wanted.trains {
            let from = match self.pattern(net) {
                Some(pattern) => TrainFrom::Pattern(pattern),
                None => {
                    self.layout.stored += 1;
                    TrainFrom::Stored(self.layout.stored - 1)
                }
            };
            self.layout.trains.push(from);
        }
        self.layout.forms = vec![Vec::new(); self.wanted.forms.len()];
    }

    fn range(&self, net: Net) -> RangeFrom {
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
    fn only(&self, net: Net) -> Option<u64> {
        let each = self.plan.phases.iter().map(|Phase { logic, .. }| only_value(&logic.netlist, logic.net(net)));
        let values: BTreeSet<u64> = each.collect::<Option<_>>()?;
        let mut values = values.into_iter().filter(|&value| value != 0);
        let value = values.next()?;
        values.next().is_none().then_some(value)
    }

    /// A flag cannot be 1: it would be the overflow of a register that counts and comes to no end of its range.
    fn is_excluded(&self, logic: &Simplified, flag: Net) -> bool {
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

    /// The value of a train where it is not 0, if there is but one.
    fn known_pulse(&self, net: Net) -> Option<u64> {
        let mut ranges = self.wanted.ranges.iter().zip(&self.layout.ranges);
        ranges.find_map(|((register, _), from)| match from {
            RangeFrom::Train { value, .. } if *register == net => Some(*value),
            _ => None,
        })
    }

    fn width(&self, net: Net) -> Width {
        self.plan.entry.netlist.width(self.plan.entry.net(net))
    }

    /// The words of a train that is the same constant in each round.
    fn pattern(&self, net: Net) -> Option<u64> {
        let phases = self.plan.phases.iter();
        let bits: Option<Vec<bool>> = phases.map(|phase| Some(phase.logic.constant(net)? != 0)).collect();
        let bits = bits?;
        let set = (0..self.layout.span).filter(|sample| bits[sample % bits.len()]);
        Some(set.fold(0, |word, sample| word | 1 << sample))
    }

    /// A register is its own next value in the phase before this one.
    fn kept(&self, net: Net, phase: usize) -> bool {
        let before = &self.plan.phases[(phase + self.plan.phases.len() - 1) % self.plan.phases.len()];
        let register = self.plan.registers.iter().find(|(register, _)| *register == net);
        let changed = |&&(_, next): &&(Net, Net)| before.logic.net(net) != before.logic.net(next);
        register.is_some_and(|register| !changed(&register) && !before.fixed.contains_key(&net))
    }

    /// A register changes in the loop, and its value in the first phase is not known.
    fn is_carried(&self, index: usize) -> bool {
        let (net, next) = self.plan.registers[index];
        let holds = |Phase { logic, fixed }: &Phase| !fixed.contains_key(&net) && logic.net(net) == logic.net(next);
        !self.plan.phases[0].fixed.contains_key(&net) && !self.plan.phases.iter().all(holds)
    }

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

    /// All phases; gives the registers after the edge of the last one, and leaves in `sample` those before it.
    fn round(&mut self, sample: &mut RegisterValues, now: &mut Carried, widths: &[Width]) -> Option<RegisterValues> {
        let plan = self.plan;
        let mut pending = vec![0; self.layout.stored];
        let mut after = None;
        for (number, phase) in plan.phases.iter().enumerate() {
            if let Some(next) = after.take() {
                *sample = next;
            }
            self.generator.pin(sample, phase, widths);
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

    /// Puts the values of registers and forms that may be new in this phase into the records.
    fn record(&mut self, number: usize, phase: &Phase, values: &HashMap<Net, Value>, [narrow, wide]: [Value; 2]) {
        for (index, &(net, _)) in self.wanted.ranges.iter().enumerate() {
            let recorded = matches!(self.layout.ranges[index], RangeFrom::Narrow(_) | RangeFrom::Wide(_));
            if !recorded || self.kept(net, number) {
                continue;
            }
            let value = self.generator.wide(values[&phase.logic.net(net)]);
            let is_narrow = matches!(self.layout.ranges[index], RangeFrom::Narrow(_));
            let lane = if is_narrow { self.narrow_lane(narrow, value) } else { self.wide_lane(wide, value) };
            if let RangeFrom::Narrow(lanes) | RangeFrom::Wide(lanes) = &mut self.layout.ranges[index] {
                lanes.push(lane);
            }
        }
        for (index, form) in self.wanted.forms.iter().enumerate() {
            if !form.terms().iter().all(|term| self.kept(term.net, number)) {
                let value = self.form(form, &phase.logic, values);
                let lane = self.wide_lane(wide, value);
                self.layout.forms[index].push(lane);
            }
        }
    }

    fn narrow_lane(&mut self, record: Value, value: Value) -> usize {
        let lane = self.lanes[0];
        self.lanes[0] += 1;
        let value = self.generator.f.ins().ireduce(types::I32, value);
        self.generator.f.ins().store(trusted(), value, record, i32::try_from(4 * lane).unwrap_or(i32::MAX));
        lane
    }

    fn wide_lane(&mut self, record: Value, value: Value) -> usize {
        let lane = self.lanes[1];
        self.lanes[1] += 1;
        self.generator.f.ins().store(trusted(), value, record, i32::try_from(8 * lane).unwrap_or(i32::MAX));
        lane
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

    /// Counts the round; after the last of a word stores the words, and after the last word leaves.
    fn end_of_round(&mut self, sample: &RegisterValues, now: Carried, [word, round]: [Block; 2], next: Vec<Value>) {
        (self.layout.narrow, self.layout.wide) = (stride(self.lanes[0]), stride(self.lanes[1]));
        let (full, finished, further) = {
            let f = &mut *self.generator.f;
            (f.create_block(), f.create_block(), f.create_block())
        };
        let [narrow_bytes, wide_bytes, word_bytes] =
            [4 * self.layout.narrow, 8 * self.layout.wide, 8 * self.layout.stored].map(|bytes| bytes as i64);
        let f = &mut *self.generator.f;
        let narrow = f.ins().iadd_imm(now.narrow, narrow_bytes);
        let wide = f.ins().iadd_imm(now.wide, wide_bytes);
        let rounds = f.ins().iadd_imm(now.rounds, -1);
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
            let value = self.generator.wide(value);
            self.generator.store_state(index, value);
        }
        let whole = self.constant(1);
        self.generator.f.ins().return_(&[whole]);

        self.generator.f.switch_to_block(further);
        self.jump(word, next.into_iter().chain([narrow, wide, out, left]));
    }

    fn constant(&mut self, value: u64) -> Value {
        self.generator.f.ins().iconst(types::I64, immediate(value))
    }

    fn jump(&mut self, block: Block, values: impl Iterator<Item = Value>) {
        let arguments: Vec<BlockArg> = values.map(BlockArg::from).collect();
        self.generator.f.ins().jump(block, &arguments);
    }
}
