//! End-point down-counters.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Block, shifted_right};

/// A register that is loaded with a number of steps and counts them down. At an edge that loads, nothing is counted, so
/// that neither an overflow nor a 0 is reported there.
#[derive(Clone, Copy, Debug)]
pub struct DownCounter<'m> {
    m: Scope<'m>,
    register: Register<'m>,
    word: Signal<'m>,
    load: Signal<'m>,
}

impl<'m> DownCounter<'m> {
    /// The register of this name, `bits` bits wide.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, name: &str, bits: u32) -> DownCounter<'m> {
        let register = m.reg(name, bits);
        DownCounter { m, register, word: block.word(name, bits), load: block.load }
    }

    /// 1 bit: steps are left.
    #[must_use]
    pub fn running(&self) -> Signal<'m> {
        self.register.q.is_nonzero()
    }

    /// Steps that are left, unsigned.
    #[must_use]
    pub fn left(&self) -> Signal<'m> {
        self.register.q
    }

    /// Closes the counter: at an edge with `count` = 1 it goes down by one, which must not take it below 0. Returns 1
    /// bit: it is counted or held at this edge and is 0 after it.
    #[must_use]
    pub fn count(self, count: Signal<'m>) -> Signal<'m> {
        let less = self.less(count);
        self.close(count.mux(less, self.register.q))
    }

    /// As [`count`](DownCounter::count), but goes down by a number of pulses at once.
    #[must_use]
    pub fn count_by(self, count: Signal<'m>, pulses: Signal<'m>) -> Signal<'m> {
        let less = self.register.q.strict_sub(pulses, count & !self.load);
        self.close(count.mux(less, self.register.q))
    }

    /// As [`count`](DownCounter::count), but goes down by a number of pulses at once and stops at 0.
    #[must_use]
    pub fn count_pulses(self, pulses: Signal<'m>) -> Signal<'m> {
        self.close(self.register.q.saturating_sub(pulses))
    }

    /// As [`count`](DownCounter::count), and halved at an edge with `halve` = 1.
    #[must_use]
    pub fn count_or_halve(self, count: Signal<'m>, halve: Signal<'m>) -> Signal<'m> {
        let less = self.less(count);
        let half = shifted_right(self.m, self.register.q);
        self.close(count.mux(less, halve.mux(half, self.register.q)))
    }

    /// One less, which must fit where it is taken.
    fn less(&self, count: Signal<'m>) -> Signal<'m> {
        self.register.q.strict_sub(self.m.lit(1, 1), count & !self.load)
    }

    fn close(self, next: Signal<'m>) -> Signal<'m> {
        self.register.when(self.load, self.word).otherwise(next);
        next.is_zero() & !self.load
    }
}

/// How many of the bits are 1, as a number of `bits` bits.
pub fn population_count<'m>(m: Scope<'m>, bits: u32, ones: &[Signal<'m>]) -> Signal<'m> {
    ones.iter().fold(m.lit(bits, 0), |count, one| count.wrapping_add(one.extend(bits)))
}
