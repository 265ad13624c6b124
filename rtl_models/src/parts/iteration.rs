//! The iteration of integrators: one clock, or one clock for each digit where they add serially.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, JR};
use crate::hardware::Hardware;
use crate::options::{ADDER, Adder, RADIX};
use crate::registers::{Reg, Rule, With};

/// The digit that serial integrators add next.
pub const PLACE: Reg =
    Reg::new("place", Rule::Planned("as it needs"), "digit that is added next, 0 the lowest").inner().when(&SERIAL);
static SERIAL: With<Adder> = With(&ADDER, |adder| *adder == Adder::Serial);

/// When integrators add; 1 bit each.
#[derive(Clone, Copy, Debug)]
pub struct Iteration<'m> {
    /// They add at this edge: all digits, or the next one.
    pub add: Signal<'m>,
    /// With this edge all digits are added: the iteration is complete.
    pub complete: Signal<'m>,
}

impl<'m> Iteration<'m> {
    /// Iterations while `run` is 1 (1 bit). Serial integrators have a counter for it: `place`, the digit that is added at
    /// the next edge, from 0, the lowest.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware, run: Signal<'m>) -> Iteration<'m> {
        if hardware.get(&ADDER) == Adder::Parallel {
            return Iteration { add: run, complete: run };
        }
        let highest = (hardware.bits(JR.of(0)) / hardware.get(&RADIX).digit_bits()).saturating_sub(1);
        let bits = Width::needed_unsigned(highest.into());
        let place = m.reg(PLACE.name(), bits);
        let complete = run & place.q.equals(m.lit(bits, highest.into()));
        let zero = m.lit(bits, 0);
        let next = place.q.wrapping_add(m.lit(bits, 1));
        place.when(block.load, zero).when(complete, zero).when(run, next).else_hold();
        Iteration { add: run, complete }
    }

    /// The same for an integrator that takes part while `running` is 1 (1 bit).
    #[must_use]
    pub fn only(self, running: Signal<'m>) -> Iteration<'m> {
        Iteration { add: self.add & running, complete: self.complete & running }
    }
}
