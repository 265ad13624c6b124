//! The deviation accumulator F of point-by-point comparison.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::Block;
use crate::hardware::Hardware;
use crate::registers::{N, Reg};

/// The deviation F.
pub const F: Reg = Reg::new("f", N.plus(2), "deviation F, two's complement, from 0").signed();

/// Register `f`, two's complement, and the adder before it.
#[derive(Clone, Copy, Debug)]
pub struct DeviationAccumulator<'m> {
    f: Register<'m>,
    name: &'static str,
}

impl<'m> DeviationAccumulator<'m> {
    /// The register, `bits` bits wide.
    #[must_use]
    pub fn new(m: Scope<'m>, bits: u32) -> DeviationAccumulator<'m> {
        DeviationAccumulator { f: m.reg_signed(F.name(), bits), name: F.name() }
    }

    /// The same for another register than `f`, as wide as the hardware has it.
    #[must_use]
    pub fn of(m: Scope<'m>, register: Reg, hardware: &Hardware) -> DeviationAccumulator<'m> {
        DeviationAccumulator { f: hardware.reg(m, register), name: register.name() }
    }

    /// 1 bit: F >= 0, the tool is outside the curve or on it.
    #[must_use]
    pub fn not_negative(&self) -> Signal<'m> {
        !self.f.q.msb()
    }

    /// The deviation.
    #[must_use]
    pub fn value(&self) -> Signal<'m> {
        self.f.q
    }

    /// Closes the accumulator: loaded with its word; at an edge with `compute` = 1 the operand is added. A load wins;
    /// the exact result must fit where it does not. The operand may have any width and either reading.
    pub fn close_adding(self, block: &Block<'m>, compute: Signal<'m>, operand: Signal<'m>) {
        let sum = self.f.q.strict_add(operand, compute & !block.load);
        let word = block.word_signed(self.name, self.f.q.bits());
        self.f.when(block.load, word).when(compute, sum).else_hold();
    }

    /// Closes the accumulator: loaded with its word; at an edge with `compute` = 1 the operand is subtracted where
    /// `subtract` is 1, else added. A load wins; the exact result must fit where it does not. The operand may have any
    /// width and either reading.
    pub fn close(self, block: &Block<'m>, compute: Signal<'m>, subtract: Signal<'m>, operand: Signal<'m>) {
        let f = self.f;
        let (plus, minus) = (compute & !subtract, compute & subtract);
        let counts = !block.load;
        let (sum, difference) = (f.q.strict_add(operand, plus & counts), f.q.strict_sub(operand, minus & counts));
        let word = block.word_signed(self.name, f.q.bits());
        f.when(block.load, word).when(plus, sum).when(minus, difference).else_hold();
    }
}
