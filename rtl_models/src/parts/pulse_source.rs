//! The pulse source of a whole machine: a rate generator on the clock.

use stepwave_netlist::dsl::{Scope, Signal};

use super::ramp::Operator;
use super::wide::Wide;
use super::{Block, DownCounter, RESTART, Ramp, RampEdge, V};
use crate::hardware::Hardware;
use crate::options::Brake;
use crate::program::{Acceleration, After};
use crate::registers::{Reg, Rule};

/// Bits of the phase of a pulse source: a pulse comes `rate` / 2^32 times a clock.
pub const RATE_BITS: u32 = 32;
/// The rate of a pulse source, in 2^-32 pulses a clock.
pub const PULSE_RATE: Reg = Reg::new("rate", Rule::Bits(RATE_BITS + 1), "pulses a clock, in 2^-32");

/// The greatest rate: a pulse every second clock.
pub const FASTEST_RATE: u64 = 1 << (RATE_BITS - 1);

/// Pulses of a block that accelerates.
pub const PULSES: Reg =
    Reg::new("pulses", Rule::Planned("as the blocks need"), "pulses of the source left of the block");

/// Pulses of the block itself, where its ramp may be that of several blocks.
pub const OWN_PULSES: Reg =
    Reg::new("own_pulses", Rule::Planned("as the blocks need"), "pulses of the block left, without those after it");
/// The ramp of the block before goes over this one too.
pub const CARRY: Reg = Reg::new("carry", Rule::Bits(1), "the ramp of the block before goes over this one too");

/// Bits of a ratio of scales, and of its fraction.
pub const RATIO_BITS: u32 = 32;
/// Those of its fraction.
pub const RATIO_FRACTION: u32 = 16;
/// How many pulses a BLU has, to those in the block before.
pub const RATIO: Reg =
    Reg::new("ratio", Rule::Bits(RATIO_BITS), "pulses of a BLU, to those of the block before, in 2^-16");

/// The pulse source f_g, a DDA on the clock: at every edge `rate` is added to `phase`, and the carry is its pulse.
///
/// - `rate`, 33 bits: held for the whole block; at most 2^31, which is a pulse every second clock.
/// - `phase`, 32 bits: continues from block to block, so that pulses keep their distance across the blocks.
///
/// It does not count while no block runs and none waits, so that a pulse never meets a machine without a block: the
/// invariant `no_pulse_is_lost`. With `--accel` it is a [`Ramp`]; with `--ramp after` the inputs `hold` and `trim` of a ramp act on
/// its rate. Returns the pulse, 1 bit.
#[must_use]
pub fn pulse_source<'m>(m: Scope<'m>, hardware: &Hardware, block: &Block<'m>, waiting: Signal<'m>) -> Signal<'m> {
    source(m, hardware, block, || block.busy | waiting & !block.stopped(m))
}

/// The same pulse source for an interpolator that is not always ready for a pulse: it does not count while `ready` (1
/// bit) is 0, so that none is lost.
#[must_use]
pub fn pulse_source_while<'m>(m: Scope<'m>, hardware: &Hardware, block: &Block<'m>, ready: Signal<'m>) -> Signal<'m> {
    source(m, hardware, block, || ready)
}

fn source<'m>(m: Scope<'m>, hardware: &Hardware, block: &Block<'m>, runs: impl FnOnce() -> Signal<'m>) -> Signal<'m> {
    let m = m.scope("pulse_source");
    let pulse = match Acceleration::of(hardware) {
        None => constant(m, block, After::of(hardware).is_some(), runs),
        Some(acceleration) => accelerating(m, &acceleration, block, runs()),
    };
    m.invariant("no_pulse_is_lost", !pulse | block.busy);
    pulse
}

/// At one rate for a whole block; where an operator acts at 0 in a hold, and at the override's share of it: what is after the
/// interpolator brakes and accelerates.
fn constant<'m>(m: Scope<'m>, block: &Block<'m>, by_hand: bool, runs: impl FnOnce() -> Signal<'m>) -> Signal<'m> {
    let rate = block.held(m, PULSE_RATE.name(), RATE_BITS + 1);
    let rate = if by_hand { Operator::new(m.scope("operator")).target(m, rate, FASTEST_RATE) } else { rate };
    let phase = m.reg("phase", RATE_BITS);
    let runs = runs();
    let sum = m.name("sum", phase.q.extend(RATE_BITS + 1).wrapping_add(rate));
    phase.when(runs, sum.slice(0, RATE_BITS)).else_hold();
    m.name("tick", runs & sum.msb())
}

/// Along a ramp. `pulses` counts those of the block down to 0: a block of which they are an estimate ends by itself.
///
/// After a block with a hold or an override the next one does not begin at the speed that was planned, but at the one that
/// there is, in its own scale: the speed times `ratio`, in 2^-16.
///
/// Along S curves one ramp goes over several blocks of one direction: what follows the first of them has `carry` = 1, and loads
/// nothing of the ramp. A hold, an override or a stop ends that (`broken`, 1 bit): from the next block on each is a trapezoid up to
/// the end of the ramp.
fn accelerating<'m>(m: Scope<'m>, by: &Acceleration, block: &Block<'m>, runs: Signal<'m>) -> Signal<'m> {
    let chain = by.jerk.map(|_| Chain::new(m, by, block));
    let whole = block;
    let block = &chain.as_ref().map_or(*block, |chain| block.loaded_at(chain.load));
    let bits = by.bits();
    // Each block says anew what is left of the ramp: one of which the pulses are an estimate may have had fewer.
    let pulses = DownCounter::new(m, whole, PULSES.name(), by.pulse_bits());
    let [planned, after_stop] = [V, RESTART].map(|register| block.word(register.name(), bits.v));
    let restart = m.reg(RESTART.name(), bits.v);
    restart.when(block.load, after_stop).else_hold();
    let single = block.single(m);
    let ramp = match &chain {
        None => Ramp::new(m, bits, block),
        Some(chain) => Ramp::operated(m, bits, block, Some(chain.operator)),
    };
    let ramp = ramp.between_blocks(restart.q, single);

    let by_hand = match &chain {
        Some(chain) => chain.by_hand,
        None => disturbed(m, ramp.event(), block.load),
    };
    let present = scaled(m, ramp.speed(), block.word(RATIO.name(), RATIO_BITS), planned);
    let first = single.mux(after_stop, by_hand.mux(present, planned));

    let pulse = ramp.pulse(runs);
    // Where a ramp goes over a block, it moves on at the edge that loads this.
    let moves = if chain.is_some() { block.busy | whole.load } else { block.busy };
    let tick = runs & moves & !block.load;
    // For a stop, and where each block is a ramp again, it is the end of the block that counts.
    let left =
        chain.as_ref().map_or(pulses.left(), |chain| (single | chain.broken).mux(chain.own.left(), pulses.left()));
    ramp.close(RampEdge { preset: None, first, by_hand, runs, tick, left }, Brake::Square, None);
    let _ = pulses.count_pulses(pulse);
    if let Some(chain) = chain {
        let _ = chain.own.count_pulses(pulse);
    }
    pulse
}

/// Blocks over which one ramp goes.
#[derive(Debug)]
struct Chain<'m> {
    operator: Operator<'m>,
    own: DownCounter<'m>,
    /// 1 bit: this edge loads the ramp.
    load: Signal<'m>,
    /// 1 bit: a block that begins at this edge is run by hand.
    by_hand: Signal<'m>,
    /// 1 bit: the present block is one over which a ramp would go.
    broken: Signal<'m>,
}

impl<'m> Chain<'m> {
    fn new(m: Scope<'m>, by: &Acceleration, block: &Block<'m>) -> Chain<'m> {
        let operator = Operator::new(m.scope("operator"));
        let own = DownCounter::new(m, block, OWN_PULSES.name(), by.pulse_bits());
        let carry = block.word(CARRY.name(), 1);
        let event = operator.acts() | block.single(m);
        let disturbed = disturbed(m, event, block.load);
        let broken = m.reg("broken", 1);
        let by_hand = m.name("loaded_by_hand", disturbed | broken.q);
        broken.when(block.load, carry & by_hand).else_hold();
        Chain { operator, own, load: m.name("ramp_load", block.load & (!carry | by_hand)), by_hand, broken: broken.q }
    }
}

/// 1 bit: an operator has acted (`event`) in the present block, or does now.
fn disturbed<'m>(m: Scope<'m>, event: Signal<'m>, load: Signal<'m>) -> Signal<'m> {
    let disturbed = m.reg("disturbed", 1);
    disturbed.when(event, m.lit(1, 1)).when(load, m.lit(1, 0)).else_hold();
    disturbed.q | event
}

/// A speed times a ratio in 2^-16, at most another speed.
fn scaled<'m>(m: Scope<'m>, speed: Signal<'m>, ratio: Signal<'m>, most: Signal<'m>) -> Signal<'m> {
    let wide = Wide::new(m, speed.bits() + RATIO_BITS);
    let product = wide.product(&wide.of(speed), ratio);
    let fits = wide.at_most(&product, &wide.shifted(most, RATIO_FRACTION));
    fits.mux(wide.slice(&product, RATIO_FRACTION, speed.bits()), most)
}
