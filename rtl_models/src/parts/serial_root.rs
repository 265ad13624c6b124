//! The sequential square root: restoring, one bit of the root a clock.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{Long, LongRegister, Timer, operand};

/// The whole part of the square root of an unsigned number of 2k bits: two bits of the radicand a clock are taken into
/// the remainder, and four times the root so far, plus 1, is taken away where it fits. It takes k clocks.
///
/// - `radicand`, 2k bits: shifts left. `remainder`, k+2 bits; `root`, k bits. `left`: clocks left.
#[derive(Clone, Copy, Debug)]
pub struct SerialRoot<'m> {
    m: Scope<'m>,
    radicand: LongRegister<'m>,
    remainder: LongRegister<'m>,
    root: LongRegister<'m>,
    left: Timer<'m>,
}

impl<'m> SerialRoot<'m> {
    /// The registers in the scope `square_root`, for a root of `k` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, k: u32) -> SerialRoot<'m> {
        let m = m.scope("square_root");
        let radicand = LongRegister::new(m, "radicand", 2 * k);
        let remainder = LongRegister::new(m, "remainder", k + 2);
        let root = LongRegister::new(m, "root", k);
        SerialRoot { m, radicand, remainder, root, left: Timer::new(m, "left", k.into()) }
    }

    /// 1 bit: it works; when it is 0 again, the root is valid.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.left.running()
    }

    /// The root, k bits, which are 64 at most.
    #[must_use]
    pub fn root(&self) -> Signal<'m> {
        self.root.q.net()
    }

    /// The root, k bits.
    #[must_use]
    pub fn long_root(&self) -> Long<'m> {
        self.root.q
    }

    /// Closes it: at an edge where a condition (1 bit) is 1 it begins with that radicand.
    pub fn close(self, radicands: &[(Signal<'m>, Long<'m>)]) {
        let k = self.root.q.bits();
        let (begin, radicand) = operand(self.m, 2 * k, radicands);
        let taken = self.remainder.q.slice(0, k).concat(self.radicand.q.slice(2 * k - 2, 2));
        let (borrow, rest) = taken.borrowing_sub(self.root.q.concat(self.m.lit(2, 1)));
        let running = self.running();
        let shifted = self.radicand.q.concat(self.m.lit(2, 0)).slice(0, 2 * k);
        self.radicand.close([(begin, radicand), (running, shifted)]);
        self.remainder.close([(begin, Long::zero(self.m, k + 2)), (running, Long::select(borrow, taken, rest))]);
        let root = self.root.q.concat(!borrow).slice(0, k);
        self.root.close([(begin, Long::zero(self.m, k)), (running, root)]);
        self.left.close(begin);
    }
}
