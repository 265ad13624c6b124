//! The sequential multiplier: shift and add, one bit a clock.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{Long, LongRegister, Timer, operand};

/// Multiplies two unsigned numbers: the multiplicand is added above the product where its lowest bit, which is the next
/// bit of the multiplier, is 1; then the product shifts right. It takes as many clocks as the multiplier has bits.
///
/// - `multiplicand`, a bits; `product`, a+b bits: begins as the multiplier.
/// - `left`: clocks left.
#[derive(Clone, Copy, Debug)]
pub struct SerialMultiplier<'m> {
    m: Scope<'m>,
    multiplicand: LongRegister<'m>,
    product: LongRegister<'m>,
    left: Timer<'m>,
}

impl<'m> SerialMultiplier<'m> {
    /// The registers in the scope `multiplier`, for a multiplicand of `a` and a multiplier of `b` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, a: u32, b: u32) -> SerialMultiplier<'m> {
        let m = m.scope("multiplier");
        let multiplicand = LongRegister::new(m, "multiplicand", a);
        let product = LongRegister::new(m, "product", a + b);
        SerialMultiplier { m, multiplicand, product, left: Timer::new(m, "left", b.into()) }
    }

    /// 1 bit: it works; when it is 0 again, the product is valid.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.left.running()
    }

    /// The product, a+b bits, which are 64 at most.
    #[must_use]
    pub fn product(&self) -> Signal<'m> {
        self.product.q.net()
    }

    /// The product, a+b bits.
    #[must_use]
    pub fn long_product(&self) -> Long<'m> {
        self.product.q
    }

    /// Closes it: at an edge where a condition (1 bit) is 1 it begins with that multiplicand and multiplier.
    pub fn close(self, operands: &[(Signal<'m>, Long<'m>, Long<'m>)]) {
        let a = self.multiplicand.q.bits();
        let b = self.product.q.bits() - a;
        let list = |part: fn(&(Signal<'m>, Long<'m>, Long<'m>)) -> Long<'m>, bits| {
            let list: Vec<_> = operands.iter().map(|operands| (operands.0, part(operands))).collect();
            operand(self.m, bits, &list)
        };
        let (begin, first) = list(|operands| operands.1, a);
        let (_, second) = list(|operands| operands.2, b);
        self.multiplicand.close([(begin, first)]);

        let high = self.product.q.slice(b, a);
        let addend = Long::select(self.product.q.bit(0), self.multiplicand.q, Long::zero(self.m, a));
        let (carry, sum) = high.carrying_add(addend);
        let low = self.product.q.slice(0, b);
        let shifted = Long::from(carry).concat(sum).concat(low).slice(1, a + b);
        self.product.close([(begin, Long::zero(self.m, a).concat(second)), (self.running(), shifted)]);
        self.left.close(begin);
    }
}
