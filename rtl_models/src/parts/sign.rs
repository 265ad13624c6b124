//! Signs: negation and magnitude in two's complement.

use stepwave_netlist::dsl::{Scope, Signal};

/// The negative of a number in two's complement; the least number stays what it is.
#[must_use]
pub fn negated<'m>(m: Scope<'m>, value: Signal<'m>) -> Signal<'m> {
    m.lit_signed(value.bits(), 0).wrapping_sub(value)
}

/// The magnitude of a number in two's complement, unsigned, as wide.
#[must_use]
pub fn magnitude<'m>(m: Scope<'m>, value: Signal<'m>) -> Signal<'m> {
    value.msb().mux(negated(m, value), value).as_unsigned()
}

/// The unsigned number in two's complement of `bits` bits, which are enough for it, with the sign that `negative` (1 bit)
/// gives it.
#[must_use]
pub fn with_sign<'m>(m: Scope<'m>, value: Signal<'m>, bits: u32, negative: Signal<'m>) -> Signal<'m> {
    let value = value.as_unsigned().extend(bits).as_signed();
    negative.mux(negated(m, value), value)
}

/// |a - b| of two unsigned numbers of the same width.
#[must_use]
pub fn magnitude_of_difference<'m>(m: Scope<'m>, a: Signal<'m>, b: Signal<'m>) -> Signal<'m> {
    let (borrow, difference) = a.borrowing_sub(b);
    borrow.mux(negated(m, difference.as_signed()).as_unsigned(), difference)
}
