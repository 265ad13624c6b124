//! A net with a reading, and the operators on it.

use std::ops::{BitAnd, BitOr, BitXor, Not};

use super::Scope;
use crate::bits::Width;
use crate::cells::{Net, Op};

/// A net, read as unsigned or two's complement. Operators keep the reading of their left operand.
#[derive(Clone, Copy, Debug)]
pub struct Signal<'m> {
    scope: Scope<'m>,
    net: Net,
    signed: bool,
}

impl<'m> Signal<'m> {
    pub(super) fn new(scope: Scope<'m>, net: Net, signed: bool) -> Signal<'m> {
        Signal { scope, net, signed }
    }

    /// The scope that the signal was made in.
    pub(super) fn scope(self) -> Scope<'m> {
        self.scope
    }

    /// The net.
    #[must_use]
    pub fn net(self) -> Net {
        self.net
    }

    /// Read as two's complement.
    #[must_use]
    pub fn is_signed(self) -> bool {
        self.signed
    }

    /// Number of bits.
    #[must_use]
    pub fn bits(self) -> u32 {
        self.width().get()
    }

    pub(super) fn width(self) -> Width {
        self.scope.module.state.borrow().netlist.width(self.net)
    }

    /// The same bits, read as two's complement.
    #[must_use]
    pub fn as_signed(self) -> Signal<'m> {
        Signal { signed: true, ..self }
    }

    /// The same bits, read as unsigned.
    #[must_use]
    pub fn as_unsigned(self) -> Signal<'m> {
        Signal { signed: false, ..self }
    }

    #[track_caller]
    fn cell(self, op: Op, bits: u32, signed: bool) -> Signal<'m> {
        Signal::new(self.scope, self.scope.module.push(op, bits), signed)
    }

    /// Another operand of the same cell, if it is of the same module; else a diagnostic and a guess.
    #[track_caller]
    pub(super) fn own(self, other: Signal<'m>) -> Signal<'m> {
        self.scope.own(other)
    }

    /// A placeholder for a signal that cannot exist, after a diagnostic.
    pub(super) fn is_guess(self) -> bool {
        self.scope.module.is_guess(self.net)
    }

    #[track_caller]
    fn same_width(self, op: Op) -> Signal<'m> {
        self.cell(op, self.bits(), self.signed)
    }

    /// An operator whose result is as wide as this.
    #[track_caller]
    fn with(self, rhs: Signal<'m>, make: fn(Net, Net) -> Op) -> Signal<'m> {
        self.same_width(make(self.net, self.own(rhs).net))
    }

    /// An operator that says yes or no of two operands.
    #[track_caller]
    fn compared(self, rhs: Signal<'m>, make: fn(Net, Net) -> Op) -> Signal<'m> {
        self.flag(make(self.net, self.own(rhs).net))
    }

    /// A yes or no, and a result as wide as both operands.
    #[track_caller]
    fn with_flag(
        self,
        rhs: Signal<'m>,
        flag: fn(Net, Net) -> Op,
        make: fn(Net, Net) -> Op,
    ) -> (Signal<'m>, Signal<'m>) {
        let rhs = self.own(rhs);
        // Operands of unequal width are reported once, of the result.
        let equally_wide = self.bits() == rhs.bits();
        let flag = if equally_wide { self.compared(rhs, flag) } else { self.scope.lit(1, 0) };
        (flag, self.with(rhs, make))
    }

    #[track_caller]
    pub(super) fn flag(self, op: Op) -> Signal<'m> {
        self.cell(op, 1, false)
    }

    /// Sum modulo 2^width, on purpose. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn wrapping_add(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Add)
    }

    /// Difference modulo 2^width, on purpose. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn wrapping_sub(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Sub)
    }

    /// Product modulo 2^width, on purpose. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn wrapping_mul(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Mul)
    }

    /// Quotient of both as unsigned numbers, without its fraction; 0 where `rhs` is 0. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn div_or_zero(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Div).as_unsigned()
    }

    /// Remainder of both as unsigned numbers; 0 where `rhs` is 0. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn rem_or_zero(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Rem).as_unsigned()
    }

    /// Shifted left by as many bits as the unsigned number `by`, of any width, says; zeros enter.
    #[track_caller]
    #[must_use]
    pub fn shift_left(self, by: Signal<'m>) -> Signal<'m> {
        self.with(by, Op::ShiftLeft)
    }

    /// Shifted right by as many bits as the unsigned number `by`, of any width, says; sign or zeros enter, as this is read.
    #[track_caller]
    #[must_use]
    pub fn shift_right(self, by: Signal<'m>) -> Signal<'m> {
        self.with(by, if self.signed { Op::ShiftArithmetic } else { Op::ShiftRight })
    }

    /// Carry (1 bit) and sum modulo 2^width. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn carrying_add(self, rhs: Signal<'m>) -> (Signal<'m>, Signal<'m>) {
        self.with_flag(rhs, Op::Carry, Op::Add)
    }

    /// Borrow (1 bit) and difference modulo 2^width. Operands are equally wide.
    #[track_caller]
    #[must_use]
    pub fn borrowing_sub(self, rhs: Signal<'m>) -> (Signal<'m>, Signal<'m>) {
        self.with_flag(rhs, Op::Borrow, Op::Sub)
    }

    /// 1 where both are equal.
    #[track_caller]
    #[must_use]
    pub fn equals(self, rhs: Signal<'m>) -> Signal<'m> {
        self.compared(rhs, Op::Equal)
    }

    /// 1 where all bits are 0.
    #[track_caller]
    #[must_use]
    pub fn is_zero(self) -> Signal<'m> {
        self.equals(self.scope.lit(self.bits(), 0))
    }

    /// 1 where any bit is 1.
    #[track_caller]
    #[must_use]
    pub fn is_nonzero(self) -> Signal<'m> {
        !self.is_zero()
    }

    /// 1 where this is less, in the reading of this signal.
    #[track_caller]
    #[must_use]
    pub fn less_than(self, rhs: Signal<'m>) -> Signal<'m> {
        self.compared(rhs, if self.signed { Op::LessSigned } else { Op::Borrow })
    }

    /// The most significant bit.
    #[track_caller]
    #[must_use]
    pub fn msb(self) -> Signal<'m> {
        self.bit(self.bits() - 1)
    }

    /// One bit, 0 the least significant.
    #[track_caller]
    #[must_use]
    pub fn bit(self, index: u32) -> Signal<'m> {
        self.slice(index, 1)
    }

    /// `bits` bits from bit `low` upwards, unsigned.
    #[track_caller]
    #[must_use]
    pub fn slice(self, low: u32, bits: u32) -> Signal<'m> {
        // A start above 255 is past the top of every net, as 255 is.
        let low = u8::try_from(low).unwrap_or(u8::MAX);
        self.cell(Op::Slice { of: self.net, low }, bits, false)
    }

    /// This above `low`; keeps the reading of this.
    #[track_caller]
    #[must_use]
    pub fn concat(self, low: Signal<'m>) -> Signal<'m> {
        let low = self.own(low);
        self.cell(Op::Concat { high: self.net, low: low.net }, self.bits() + low.bits(), self.signed)
    }

    /// The same number in `bits` bits, at least as wide: sign or zeros above, as this is read.
    #[track_caller]
    #[must_use]
    pub fn extend(self, bits: u32) -> Signal<'m> {
        if bits == self.bits() {
            return self;
        }
        let op = if self.signed { Op::SignExtend(self.net) } else { Op::ZeroExtend(self.net) };
        self.cell(op, bits, self.signed)
    }

    /// Of this select bit: 1 gives `high`, 0 gives `low`. Reading of `high`.
    #[track_caller]
    #[must_use]
    pub fn mux(self, high: Signal<'m>, low: Signal<'m>) -> Signal<'m> {
        let high = self.own(high);
        // A select of another module is reported once.
        let low = if high.is_guess() { high } else { self.own(low) };
        high.same_width(Op::Mux { select: self.net, high: high.net, low: low.net })
    }
}

impl<'m> BitAnd for Signal<'m> {
    type Output = Signal<'m>;
    #[track_caller]
    fn bitand(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::And)
    }
}

impl<'m> BitOr for Signal<'m> {
    type Output = Signal<'m>;
    #[track_caller]
    fn bitor(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Or)
    }
}

impl<'m> BitXor for Signal<'m> {
    type Output = Signal<'m>;
    #[track_caller]
    fn bitxor(self, rhs: Signal<'m>) -> Signal<'m> {
        self.with(rhs, Op::Xor)
    }
}

impl<'m> Not for Signal<'m> {
    type Output = Signal<'m>;
    #[track_caller]
    fn not(self) -> Signal<'m> {
        self.same_width(Op::Not(self.net))
    }
}
