//! The sequential square root: restoring, one bit of the root a clock.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Timer, operand};

/// The whole part of the square root of an unsigned number of 2k bits: two bits of the radicand a clock are taken into
/// the remainder, and four times the root so far, plus 1, is taken away where it fits. It takes k clocks.
///
/// - `radicand`, 2k bits: shifts left. `remainder`, k+2 bits; `root`, k bits. `left`: clocks left.
#[derive(Clone, Copy, Debug)]
pub struct SerialRoot<'m> {
    m: Scope<'m>,
    radicand: Register<'m>,
    remainder: Register<'m>,
    root: Register<'m>,
    left: Timer<'m>,
}

impl<'m> SerialRoot<'m> {
    /// The registers in the scope `square_root`, for a root of `k` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, k: u32) -> SerialRoot<'m> {
        let m = m.scope("square_root");
        let (radicand, remainder) = (m.reg("radicand", 2 * k), m.reg("remainder", k + 2));
        SerialRoot { m, radicand, remainder, root: m.reg("root", k), left: Timer::new(m, "left", k.into()) }
    }

    /// 1 bit: it works; when it is 0 again, the root is valid.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.left.running()
    }

    /// The root, k bits.
    #[must_use]
    pub fn root(&self) -> Signal<'m> {
        self.root.q
    }

    /// Closes it: at an edge where a condition (1 bit) is 1 it begins with that radicand.
    pub fn close(self, radicands: &[(Signal<'m>, Signal<'m>)]) {
        let k = self.root.q.bits();
        let (begin, radicand) = operand(self.m, 2 * k, radicands);
        let taken = self.remainder.q.slice(0, k).concat(self.radicand.q.slice(2 * k - 2, 2));
        let (borrow, rest) = taken.borrowing_sub(self.root.q.concat(self.m.lit(2, 1)));
        let running = self.running();
        let shifted = self.radicand.q.concat(self.m.lit(2, 0)).slice(0, 2 * k);
        self.radicand.when(begin, radicand).when(running, shifted).else_hold();
        self.remainder.when(begin, self.m.lit(k + 2, 0)).when(running, borrow.mux(taken, rest)).else_hold();
        let root = self.root.q.concat(!borrow).slice(0, k);
        self.root.when(begin, self.m.lit(k, 0)).when(running, root).else_hold();
        self.left.close(begin);
    }
}
