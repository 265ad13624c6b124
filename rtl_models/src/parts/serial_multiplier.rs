//! The sequential multiplier: shift and add, one bit a clock.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Timer, operand};

/// Multiplies two unsigned numbers: the multiplicand is added above the product where its lowest bit, which is the next
/// bit of the multiplier, is 1; then the product shifts right. It takes as many clocks as the multiplier has bits.
///
/// - `multiplicand`, a bits; `product`, a+b bits: begins as the multiplier.
/// - `left`: clocks left.
#[derive(Clone, Copy, Debug)]
pub struct SerialMultiplier<'m> {
    m: Scope<'m>,
    multiplicand: Register<'m>,
    product: Register<'m>,
    left: Timer<'m>,
}

impl<'m> SerialMultiplier<'m> {
    /// The registers in the scope `multiplier`, for a multiplicand of `a` and a multiplier of `b` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, a: u32, b: u32) -> SerialMultiplier<'m> {
        let m = m.scope("multiplier");
        let (multiplicand, product) = (m.reg("multiplicand", a), m.reg("product", a + b));
        SerialMultiplier { m, multiplicand, product, left: Timer::new(m, "left", b.into()) }
    }

    /// 1 bit: it works; when it is 0 again, the product is valid.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.left.running()
    }

    /// The product, a+b bits.
    #[must_use]
    pub fn product(&self) -> Signal<'m> {
        self.product.q
    }

    /// Closes it: at an edge where a condition (1 bit) is 1 it begins with that multiplicand and multiplier.
    pub fn close(self, operands: &[(Signal<'m>, Signal<'m>, Signal<'m>)]) {
        let a = self.multiplicand.q.bits();
        let b = self.product.q.bits() - a;
        let list = |part: fn(&(Signal<'m>, Signal<'m>, Signal<'m>)) -> Signal<'m>, bits| {
            let list: Vec<_> = operands.iter().map(|operands| (operands.0, part(operands))).collect();
            operand(self.m, bits, &list)
        };
        let (begin, first) = list(|operands| operands.1, a);
        let (_, second) = list(|operands| operands.2, b);
        self.multiplicand.when(begin, first).else_hold();

        let high = self.product.q.slice(b, a);
        let addend = self.product.q.bit(0).mux(self.multiplicand.q, self.m.lit(a, 0));
        let (carry, sum) = high.carrying_add(addend);
        let low = self.product.q.slice(0, b);
        let shifted = carry.concat(sum).concat(low).slice(1, a + b);
        self.product.when(begin, self.m.lit(a, 0).concat(second)).when(self.running(), shifted).else_hold();
        self.left.close(begin);
    }
}
