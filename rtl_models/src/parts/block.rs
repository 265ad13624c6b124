//! The block loader: inputs for the words of a block, and the registers that say how far it is.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::hardware::Hardware;
use crate::machine::input_name;
use crate::options::{ACCEL, Radix};
use crate::parts::{AxisAfter, Period, SETTLE};

/// Block loader and sequencer.
///
/// `load` = 1 at an edge takes the words on the inputs into their registers and starts the block: `busy` rises, and
/// falls with the last step, when `done` rises.
#[derive(Clone, Copy, Debug)]
pub struct Block<'m> {
    words: Scope<'m>,
    /// 1 bit: this edge loads a block.
    pub load: Signal<'m>,
    /// 1 bit: this edge presets the position counters too.
    pub preset_position: Signal<'m>,
    /// 1 bit: a block is running.
    pub busy: Signal<'m>,
    registers: [Register<'m>; 4],
    /// 1 bit: this edge takes the words into a buffer in front of the registers, if there is one.
    write: Option<Signal<'m>>,
    /// 1 bit, where blocks may be run one by one: they are.
    single: Option<Signal<'m>>,
    /// 1 bit, where it may be so: the next block must not begin yet.
    stopped: Option<Signal<'m>>,
    /// Acceleration after the interpolator, if there is one.
    after: Option<Period<'m>>,
}

impl<'m> Block<'m> {
    /// Ports, state and load words in the scope `block`.
    #[must_use]
    pub fn new(m: Scope<'m>) -> Block<'m> {
        let m = m.scope("block");
        let load = m.input("load", 1);
        let preset_position = load & m.input("preset_position", 1);
        let registers = ["busy", "done", "loaded", "stepped"].map(|name| m.reg(name, 1));
        let (write, single, stopped, after) = (None, None, None, None);
        Block { words: m, load, preset_position, busy: registers[0].q, registers, write, single, stopped, after }
    }

    /// The unsigned load word of a register.
    #[must_use]
    pub fn word(&self, register: &str, bits: u32) -> Signal<'m> {
        let input = self.words.input(&input_name(register), bits);
        self.buffered(register, input, |name| self.words.reg(name, bits))
    }

    /// The two's-complement load word of a register.
    #[must_use]
    pub fn word_signed(&self, register: &str, bits: u32) -> Signal<'m> {
        let input = self.words.input_signed(&input_name(register), bits);
        self.buffered(register, input, |name| self.words.reg_signed(name, bits))
    }

    /// The two's-complement word that presets a position counter; it is never buffered.
    #[must_use]
    pub fn position(&self, letter: &str, bits: u32) -> Signal<'m> {
        self.words.input_signed(&input_name(letter), bits)
    }

    /// The word itself, or what the buffer holds of it.
    fn buffered(&self, register: &str, input: Signal<'m>, buffer: impl FnOnce(&str) -> Register<'m>) -> Signal<'m> {
        let Some(write) = self.write else { return input };
        let next = buffer(&format!("next_{register}"));
        next.when(write, input).else_hold();
        next.q
    }

    /// The load word of a register that holds a number in this radix: decimal digits have 4 bits each.
    #[must_use]
    pub fn word_in(&self, radix: Radix, register: &str, bits: u32) -> Signal<'m> {
        match radix {
            Radix::Binary => self.word(register, bits),
            Radix::Decimal => self.words.input_decimal(&input_name(register), bits),
        }
    }

    /// A register that is loaded with its word and holds it for the whole block.
    #[must_use]
    pub fn held(&self, m: Scope<'m>, register: &str, bits: u32) -> Signal<'m> {
        let held = m.reg(register, bits);
        held.when(self.load, self.word(register, bits)).else_hold();
        held.q
    }

    /// As [`held`](Block::held), in two's complement.
    #[must_use]
    pub fn held_signed(&self, m: Scope<'m>, register: &str, bits: u32) -> Signal<'m> {
        let held = m.reg_signed(register, bits);
        held.when(self.load, self.word_signed(register, bits)).else_hold();
        held.q
    }

    /// As [`held`](Block::held), a number in this radix.
    #[must_use]
    pub fn held_in(&self, m: Scope<'m>, radix: Radix, register: &str, bits: u32) -> Signal<'m> {
        let held = match radix {
            Radix::Binary => m.reg(register, bits),
            Radix::Decimal => m.reg(register, bits).shown(Format::Decimal),
        };
        held.when(self.load, self.word_in(radix, register, bits)).else_hold();
        held.q
    }

    /// The same for registers that are loaded at other edges (`load`, 1 bit).
    #[must_use]
    pub(super) fn loaded_at(self, load: Signal<'m>) -> Block<'m> {
        Block { load, ..self }
    }

    /// 1 bit: blocks are run one by one.
    #[must_use]
    pub fn single(&self, m: Scope<'m>) -> Signal<'m> {
        self.single.unwrap_or_else(|| m.lit(1, 0))
    }

    /// 1 bit: the next block must not begin yet, as blocks are run one by one and it has not been started, or as it is to
    /// find the filters after the interpolator empty.
    #[must_use]
    pub fn stopped(&self, m: Scope<'m>) -> Signal<'m> {
        self.stopped.unwrap_or_else(|| m.lit(1, 0))
    }

    /// What the pulses of an axis go through after the interpolator, if there is anything.
    pub(crate) fn after(&self, axis: usize) -> Option<AxisAfter<'m>> {
        self.after.and_then(|after| after.axis(axis))
    }

    /// Closes the sequencer. Each is 1 bit: `ready`, the registers are loaded after this edge; `step`, a step is
    /// completed at this edge; `last`, it is the last one.
    pub fn close(self, ready: Signal<'m>, step: Signal<'m>, last: Signal<'m>) {
        self.close_after(ready, step, step & last);
    }

    /// As [`close`](Block::close), but what ends the block is an edge with `finish` = 1 (1 bit), at the last step or
    /// some clocks after it.
    pub fn close_after(self, ready: Signal<'m>, step: Signal<'m>, finish: Signal<'m>) {
        let [busy, done, loaded, stepped] = self.registers;
        let [yes, no] = [self.words.lit(1, 1), self.words.lit(1, 0)];
        busy.when(self.load, yes).when(finish, no).else_hold();
        done.when(self.load, no).when(finish, yes).else_hold();
        loaded.set(ready);
        stepped.set(step);
    }
}

/// The buffer that feeds a block loader: the host writes the words of the next block into it while the present one
/// runs, and they are loaded into the registers at the edge after the last step.
///
/// - `load` = 1 at an edge takes the words on the inputs into the buffer, which must be free: `full` rises.
/// - `more`, an input: the host has a further block. `call`: it may write it. `at_end`: all is done.
/// - A block begins, and the buffer is free again, at an edge at which it is full and nothing runs.
/// - `single`, an input of a machine that accelerates: a block begins only after `start` = 1 while nothing runs, and where it
///   accelerates after its interpolator when the filters are empty.
/// - `settle`, a word of a machine that accelerates [after its interpolator](Period): the block begins only after the filters
///   are empty. `at_end` waits for that too.
#[derive(Clone, Copy, Debug)]
pub struct Buffer<'m> {
    m: Scope<'m>,
    /// 1 bit: this edge takes the words on the inputs.
    pub write: Signal<'m>,
    preset: Signal<'m>,
    full: Register<'m>,
    registers: [Register<'m>; 4],
    more: Signal<'m>,
    /// Inputs of the operator, and whether the next block is started.
    operator: Option<([Signal<'m>; 2], Register<'m>)>,
    /// Acceleration after the interpolator, and the word of the next block for it.
    after: Option<(Period<'m>, Register<'m>)>,
}

impl<'m> Buffer<'m> {
    /// Ports and state in the scope `block`.
    #[must_use]
    pub fn new(m: Scope<'m>, hardware: &Hardware) -> Buffer<'m> {
        let after = Period::new(m, hardware);
        let m = m.scope("block");
        let write = m.input("load", 1);
        let preset = write & m.input("preset_position", 1);
        let registers = ["busy", "done", "loaded", "stepped"].map(|name| m.reg(name, 1));
        let (full, more) = (m.reg("full", 1), m.input("more", 1));
        let operator = || (["single", "start"].map(|name| m.input(name, 1)), m.reg("started", 1));
        let operator = (hardware.get(&ACCEL).is_some() || after.is_some()).then(operator);
        let after = after.map(|after| {
            let settle = m.reg(&format!("next_{}", SETTLE.name()), 1);
            settle.when(write, m.input(&input_name(SETTLE.name()), 1)).else_hold();
            (after, settle)
        });
        Buffer { m, write, preset, full, registers, more, operator, after }
    }

    /// 1 bit: the buffer holds a block.
    #[must_use]
    pub fn full(&self) -> Signal<'m> {
        self.full.q
    }

    /// A word as the host gives it, for a register of the buffer that does more than hold it.
    #[must_use]
    pub fn word(&self, register: &str, bits: u32) -> Signal<'m> {
        self.m.input(&input_name(register), bits)
    }

    /// The block loader that the buffer feeds. While `wait` (1 bit) is 1 the buffer is not ready yet.
    #[must_use]
    pub fn block(self, wait: Signal<'m>) -> Block<'m> {
        let Buffer { m, write, preset, full, registers, more, operator, after } = self;
        let busy = registers[0].q;
        let (yes, no) = (m.lit(1, 1), m.lit(1, 0));
        let single = operator.map(|([single, _], _)| single);
        let unstarted = operator.map(|([single, _], started)| single & !started.q);
        let settles = |settle: Signal<'m>| single.map_or(settle, |single| settle | single);
        let unsettled = after.map(|(after, settle)| settles(settle.q) & !after.empty());
        let stopped = unstarted.into_iter().chain(unsettled).reduce(|a, b| a | b).map(|any| m.name("stopped", any));
        let wait = stopped.map_or(wait, |stopped| wait | stopped);
        let transfer = m.name("transfer", full.q & !wait & !busy);
        if let Some(([_, start], started)) = operator {
            started.when(transfer, no).when(start & !busy, yes).else_hold();
        }
        full.when(write, yes).when(transfer, no).else_hold();
        m.name("call", more & !full.q);
        let ended = !more & !full.q & !busy;
        m.name("at_end", after.map_or(ended, |(after, _)| ended & after.empty()));
        let (write, after) = (Some(write), after.map(|(after, _)| after));
        Block { words: m, load: transfer, preset_position: preset, busy, registers, write, single, stopped, after }
    }
}
