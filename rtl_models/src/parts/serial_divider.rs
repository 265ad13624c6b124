//! The sequential divider: restoring, one bit of the quotient a clock.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{Long, LongRegister, Timer, operand};

/// Divides an unsigned number by another: the remainder takes in the dividend bit by bit, and the divisor is taken away
/// where it fits. It takes as many clocks as the dividend has bits. Of a divisor 0 the quotient is all ones.
///
/// - `quotient`, n bits: begins as the dividend, whose bits leave at the top as those of the quotient come in.
/// - `remainder`, `divisor`, d bits. `left`: clocks left.
#[derive(Clone, Copy, Debug)]
pub struct SerialDivider<'m> {
    m: Scope<'m>,
    quotient: LongRegister<'m>,
    remainder: LongRegister<'m>,
    divisor: LongRegister<'m>,
    left: Timer<'m>,
}

impl<'m> SerialDivider<'m> {
    /// The registers in the scope `divider`, for a dividend of `n` and a divisor of `d` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, n: u32, d: u32) -> SerialDivider<'m> {
        let m = m.scope("divider");
        let [remainder, divisor] = ["remainder", "divisor"].map(|name| LongRegister::new(m, name, d));
        let quotient = LongRegister::new(m, "quotient", n);
        SerialDivider { m, quotient, remainder, divisor, left: Timer::new(m, "left", n.into()) }
    }

    /// 1 bit: it works; when it is 0 again, quotient and remainder are valid.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.left.running()
    }

    /// The quotient, n bits, which are 64 at most.
    #[must_use]
    pub fn quotient(&self) -> Signal<'m> {
        self.quotient.q.net()
    }

    /// The quotient, n bits.
    #[must_use]
    pub fn long_quotient(&self) -> Long<'m> {
        self.quotient.q
    }

    /// The remainder, d bits, which are 64 at most.
    #[must_use]
    pub fn remainder(&self) -> Signal<'m> {
        self.remainder.q.net()
    }

    /// Closes it: at an edge where a condition (1 bit) is 1 it begins with that dividend and divisor.
    pub fn close(self, operands: &[(Signal<'m>, Long<'m>, Long<'m>)]) {
        let (n, d) = (self.quotient.q.bits(), self.divisor.q.bits());
        let dividends: Vec<_> = operands.iter().map(|&(begin, dividend, _)| (begin, dividend)).collect();
        let divisors: Vec<_> = operands.iter().map(|&(begin, _, divisor)| (begin, divisor)).collect();
        let (begin, dividend) = operand(self.m, n, &dividends);
        let (_, divisor) = operand(self.m, d, &divisors);
        self.divisor.close([(begin, divisor)]);

        let taken = self.remainder.q.concat(self.quotient.q.bit(n - 1));
        let (borrow, rest) = taken.borrowing_sub(self.divisor.q.extend(self.m, d + 1));
        let restored = Long::select(borrow, taken, rest).slice(0, d);
        let shifted = self.quotient.q.concat(!borrow).slice(0, n);
        let running = self.running();
        self.remainder.close([(begin, Long::zero(self.m, d)), (running, restored)]);
        self.quotient.close([(begin, dividend), (running, shifted)]);
        self.left.close(begin);
    }
}
