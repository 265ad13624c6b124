//! The block loader: inputs for the words of a block, and the registers that say how far it is.

use stepwave_kernel::dsl::{Register, Scope, Signal};
use stepwave_kernel::netlist::Format;

use crate::choices::Radix;
use crate::machine::input_name;

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
}

impl<'m> Block<'m> {
    /// Ports, state and load words in the scope `block`.
    #[must_use]
    pub fn new(m: Scope<'m>) -> Block<'m> {
        let m = m.scope("block");
        let load = m.input("load", 1);
        let preset_position = load & m.input("preset_position", 1);
        let registers = ["busy", "done", "loaded", "stepped"].map(|name| m.reg(name, 1));
        Block { words: m, load, preset_position, busy: registers[0].q, registers }
    }

    /// The unsigned load word of a register.
    #[must_use]
    pub fn word(&self, register: &str, bits: u32) -> Signal<'m> {
        self.words.input(&input_name(register), bits)
    }

    /// The two's-complement load word of a register.
    #[must_use]
    pub fn word_signed(&self, register: &str, bits: u32) -> Signal<'m> {
        self.words.input_signed(&input_name(register), bits)
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

    /// Closes the sequencer. Each is 1 bit: `ready`, the registers stand loaded behind this edge; `step`, a step is
    /// completed at this edge; `last`, it is the last one.
    pub fn close(self, ready: Signal<'m>, step: Signal<'m>, last: Signal<'m>) {
        self.close_behind(ready, step, step & last);
    }

    /// As [`close`](Block::close), but what ends the block is an edge with `finish` = 1 (1 bit), at the last step or some
    /// clocks behind it.
    pub fn close_behind(self, ready: Signal<'m>, step: Signal<'m>, finish: Signal<'m>) {
        let [busy, done, loaded, stepped] = self.registers;
        let [yes, no] = [self.words.lit(1, 1), self.words.lit(1, 0)];
        busy.when(self.load, yes).when(finish, no).else_hold();
        done.when(self.load, no).when(finish, yes).else_hold();
        loaded.set(ready);
        stepped.set(step);
    }
}
