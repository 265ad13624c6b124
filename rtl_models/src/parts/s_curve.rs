//! Speed along an S: acceleration that rises and falls.

use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::Block;
use crate::hardware::Hardware;
use crate::options::{JERK, Quantity};
use crate::registers::{AS_NEEDED, Reg, With};

/// Acceleration of this tick.
pub const CHANGE: Reg = Reg::new("av", AS_NEEDED, "acceleration, from 0 up and down again").when(&BY_JERK);
/// Ticks left of a ramp.
pub const TICKS: Reg = Reg::new("k", AS_NEEDED, "ticks left of the ramp").when(&BY_JERK);
/// Jerk of the ramp up and of the ramp down.
pub const GROWTH: Reg<2> =
    Reg::each(["ju", "jd"], AS_NEEDED, "jerk, of the ramp up and of the ramp down").hidden().when(&BY_JERK);
/// Ticks in which the acceleration grows, and in which it stays, of each ramp.
pub const PARTS: Reg<4> =
    Reg::each(["mu", "hu", "md", "hd"], AS_NEEDED, "ticks of growing and of constant acceleration, of each ramp")
        .hidden()
        .when(&BY_JERK);
/// Length of the ramp down.
pub const LENGTH: Reg =
    Reg::new("length", AS_NEEDED, "length of the ramp down, in 2^-n pulses").hidden().when(&BY_JERK);

static BY_JERK: With<Option<Quantity>> = With(&JERK, Option::is_some);

/// Widths of the registers of S curves, in bits.
#[derive(Clone, Copy, Debug)]
pub struct SCurveBits {
    /// Acceleration of a tick.
    pub change: u32,
    /// Ticks of a ramp.
    pub ticks: u32,
    /// Jerks.
    pub growth: [u32; 2],
    /// Ticks of the parts of both ramps.
    pub parts: [u32; 4],
    /// Length of the ramp down.
    pub length: u32,
}

impl SCurveBits {
    /// Of hardware that has these registers in its list; `None` without a jerk.
    pub(super) fn of(hardware: &Hardware) -> Option<SCurveBits> {
        hardware.get(&JERK)?;
        Some(SCurveBits {
            change: hardware.bits(CHANGE),
            ticks: hardware.bits(TICKS),
            growth: [0, 1].map(|ramp| hardware.bits(GROWTH.of(ramp))),
            parts: [0, 1, 2, 3].map(|part| hardware.bits(PARTS.of(part))),
            length: hardware.bits(LENGTH),
        })
    }
}

/// A third-order DDA in front of a speed: a ramp is 2m + h ticks, in the first m of which `av` grows by the jerk, stays for
/// h, and in the last m falls again, while v goes by `av`.
///
/// - `av`: 0 where no ramp runs.
/// - `k`: ticks left of a ramp; a block begins with the ramp up.
/// - `falling`, 1 bit: it is the ramp down. `manual`, 1 bit: an event came while no ramp ran, and the rest of the block is a
///   trapezoid.
#[derive(Clone, Copy, Debug)]
pub(super) struct SCurve<'m> {
    m: Scope<'m>,
    block: Block<'m>,
    av: Register<'m>,
    k: Register<'m>,
    falling: Register<'m>,
    manual: Register<'m>,
    growth: [Signal<'m>; 2],
    parts: [Signal<'m>; 4],
    first: Signal<'m>,
    length: Signal<'m>,
}

impl<'m> SCurve<'m> {
    pub(super) fn new(m: Scope<'m>, bits: SCurveBits, block: &Block<'m>) -> SCurve<'m> {
        SCurve {
            m,
            block: *block,
            av: m.reg(CHANGE.name(), bits.change),
            k: m.reg(TICKS.name(), bits.ticks),
            falling: m.reg("falling", 1),
            manual: m.reg("manual", 1),
            growth: [0, 1].map(|ramp| block.held(m, GROWTH.of(ramp).name(), bits.growth[ramp])),
            parts: [0, 1, 2, 3].map(|part| block.held(m, PARTS.of(part).name(), bits.parts[part])),
            first: block.word(TICKS.name(), bits.ticks),
            length: block.held(m, LENGTH.name(), bits.length),
        }
    }

    /// Length of the ramp down, unsigned, in 2^-n pulses.
    pub(super) fn length(&self) -> Signal<'m> {
        self.length
    }

    /// Closes it, with `speed` as v and ve, `near` (1 bit) where the ramp down must begin, `event` (1 bit) while a hold or an
    /// override is in force, `loaded_by_hand` (1 bit) where a block begins as a trapezoid, `stop` (1 bit) where it is to end for a stop, and the speed of the next tick that the `trapezoid` would have. Returns that speed.
    pub(super) fn close(
        self,
        tick: Signal<'m>,
        [v, ve]: [Signal<'m>; 2],
        near: Signal<'m>,
        [loaded_by_hand, event, stop]: [Signal<'m>; 3],
        trapezoid: Signal<'m>,
    ) -> Signal<'m> {
        let SCurve { m, block, av, k, falling, manual, growth, parts, .. } = self;
        let (yes, no) = (m.lit(1, 1), m.lit(1, 0));
        let running = k.q.is_nonzero();
        let by_hand = m.name("by_hand", manual.q | event & !running | stop);
        let begins = m.name("down", !by_hand & !running & ve.less_than(v) & near);
        let down = falling.q | begins;
        manual.when(block.load, loaded_by_hand).when(tick & by_hand, yes).else_hold();
        falling.when(block.load, no).when(tick & begins, yes).else_hold();

        // Ticks of the ramp from this one on.
        let bits = k.q.bits();
        let [mu, hu, md, hd] = parts.map(|part| part.extend(bits));
        let (grows, stays) = (down.mux(md, mu), down.mux(hd, hu));
        let whole = md.wrapping_add(md).wrapping_add(hd);
        let left = begins.mux(whole, k.q);
        let one = m.lit(bits, 1);
        let ramp = m.name("ramping", left.is_nonzero() & !by_hand);
        k.when(block.load, self.first).when(tick & ramp, left.wrapping_sub(one)).else_hold();

        let wide = av.q.bits().max(growth[0].bits()).max(growth[1].bits());
        let jerk = down.mux(growth[1].extend(wide), growth[0].extend(wide));
        let up = tick & ramp & grows.wrapping_add(stays).less_than(left);
        let back = tick & ramp & !grows.less_than(left);
        let more = av.q.strict_add(jerk, up & !block.load);
        let less = av.q.strict_sub(jerk, back & !block.load);
        av.when(block.load, m.lit(av.q.bits(), 0)).when(up, more).when(back, less).else_hold();

        let moves = tick & !by_hand & !block.load;
        let faster = v.strict_add(av.q, moves & !down);
        let slower = v.strict_sub(av.q, moves & down);
        by_hand.mux(trapezoid, down.mux(slower, faster))
    }
}
