//! The pulse source of a whole machine: a rate generator on the clock.

use stepwave_netlist::dsl::{Scope, Signal};

use super::Block;
use crate::registers::{Reg, Rule};

/// Bits of the phase of a pulse source: a pulse comes `rate` / 2^32 times a clock.
pub const RATE_BITS: u32 = 32;
/// The rate of a pulse source, in 2^-32 pulses a clock.
pub const PULSE_RATE: Reg = Reg::new("rate", Rule::Bits(RATE_BITS + 1), "pulses a clock, in 2^-32");

/// The greatest rate: a pulse every second clock.
pub const FASTEST_RATE: u64 = 1 << (RATE_BITS - 1);

/// The pulse source f_g, a DDA on the clock: at every edge `rate` is added to `phase`, and the carry is its pulse.
///
/// - `rate`, 33 bits: held for the whole block; at most 2^31, which is a pulse every second clock.
/// - `phase`, 32 bits: continues from block to block, so that pulses keep their distance across the blocks.
///
/// It does not count while no block runs and none waits, so that a pulse never meets a machine without a block: the
/// invariant `no_pulse_is_lost`. Returns the pulse, 1 bit.
#[must_use]
pub fn pulse_source<'m>(m: Scope<'m>, block: &Block<'m>, waiting: Signal<'m>) -> Signal<'m> {
    source(m, block, || block.busy | waiting)
}

/// The same pulse source for an interpolator that is not always ready for a pulse: it does not count while `ready` (1
/// bit) is 0, so that none is lost.
#[must_use]
pub fn pulse_source_while<'m>(m: Scope<'m>, block: &Block<'m>, ready: Signal<'m>) -> Signal<'m> {
    source(m, block, || ready)
}

fn source<'m>(m: Scope<'m>, block: &Block<'m>, runs: impl FnOnce() -> Signal<'m>) -> Signal<'m> {
    let m = m.scope("pulse_source");
    let rate = block.held(m, PULSE_RATE.name(), RATE_BITS + 1);
    let phase = m.reg("phase", RATE_BITS);
    let runs = runs();
    let sum = m.name("sum", phase.q.extend(RATE_BITS + 1).wrapping_add(rate));
    phase.when(runs, sum.slice(0, RATE_BITS)).else_hold();
    let pulse = m.name("tick", runs & sum.msb());
    m.invariant("no_pulse_is_lost", !pulse | block.busy);
    pulse
}
