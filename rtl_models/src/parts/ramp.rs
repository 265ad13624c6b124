//! Acceleration and deceleration of a pulse source.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::Block;
use super::s_curve::{SCurve, SCurveBits};
use super::wide::Wide;
use crate::hardware::Hardware;
use crate::options::{BRAKE, Brake};
use crate::registers::{AS_NEEDED, N, Reg, With};

/// Phase of the pulses.
pub const PHASE: Reg = Reg::new("phase", N, "phase of the pulses, from --preset").preset();
/// Speed.
pub const V: Reg = Reg::new("v", N, "speed, in 2^-n pulses a tick");
/// Start, drive and stop speed.
pub const LIMITS: Reg<3> =
    Reg::each(["vs", "vc", "ve"], N, "start, drive and stop speed, as wide as v").hidden().as_wide_as(V);
/// Acceleration and deceleration.
pub const GAINS: Reg<2> =
    Reg::each(["a", "d"], AS_NEEDED, "acceleration and deceleration, in 2^-n pulses a tick each tick").hidden();
/// The same of a machine that runs programs, whose methods have an `a` of their own.
pub const PATH_GAINS: Reg<2> = Reg::each(["accel", "decel"], AS_NEEDED, "acceleration and deceleration").hidden();
/// Pulses of the acceleration.
pub const RISEN: Reg = Reg::new("r", AS_NEEDED, "pulses of the acceleration").when(&BY_COUNT);

static BY_COUNT: With<Brake> = With(&BRAKE, |brake| *brake == Brake::Count);

/// Speed after a stop between blocks.
pub const RESTART: Reg = Reg::new("vr", N, "speed after a stop between blocks").hidden();

/// Widths of the registers of a ramp, in bits.
#[derive(Clone, Copy, Debug)]
pub struct RampBits {
    /// The phase.
    pub phase: u32,
    /// The speed and its limits; at most those of the phase.
    pub v: u32,
    /// The greatest speed, whatever the override.
    pub most: u64,
    /// Acceleration and deceleration: the names of their registers, and their widths.
    pub gains: [(&'static str, u32); 2],
    /// Those of S curves.
    pub curve: Option<SCurveBits>,
}

impl RampBits {
    /// Of hardware that has these registers in its list.
    pub(crate) fn of(hardware: &Hardware) -> RampBits {
        let v = hardware.bits(V);
        RampBits {
            phase: hardware.bits(PHASE),
            v,
            most: u64::MAX >> (64 - v),
            gains: [0, 1].map(|index| GAINS.of(index)).map(|gain| (gain.name(), hardware.bits(gain))),
            curve: SCurveBits::of(hardware),
        }
    }
}

/// Override of 100 %, in the units of its input.
pub const WHOLE_OVERRIDE: u32 = 128;

/// A pulse source that accelerates and brakes: a second-order DDA. At every tick {pulse, phase} := phase + v, while v goes
/// towards its target by `a` or `d`, and to the stop speed in time for the end of the block.
///
/// - `phase`, n bits: continues from block to block.
/// - `v`, up to n bits: loaded with `vs`.
/// - `vs`, `vc`, `ve`, `a`, `d`: held for the whole block.
/// - `hold`, an input of 1 bit in the scope `operator`: the target is 0. `trim`, an input of 9 bits in two's complement: the override in 128ths beyond
///   100 %.
///
/// **Braking.** `square` brakes when the ramp down from the speed of the next tick would be longer than what remains:
/// 2d·(e·2^n - phase) <= w² - ve² + 2d·(v + w), where w is the speed without braking. `count` has in `r` how many pulses
/// the ramp up took, and brakes when one more than that remain: the middle one of an odd number.
#[derive(Clone, Copy, Debug)]
pub struct Ramp<'m> {
    m: Scope<'m>,
    block: Block<'m>,
    bits: RampBits,
    phase: Register<'m>,
    v: Register<'m>,
    sum: Signal<'m>,
    limits: [Signal<'m>; 3],
    gains: [Signal<'m>; 2],
    /// Speeds at which it starts after a hold, and stops for one.
    rest: [Signal<'m>; 2],
    /// 1 bit: the block ends for a stop.
    single: Option<Signal<'m>>,
    by: Operator<'m>,
}

/// What an operator does to a speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operator<'m> {
    /// 1 bit: it is 0 whatever else is wanted.
    hold: Signal<'m>,
    /// Override beyond 100 %, in two's complement.
    trim: Signal<'m>,
}

impl<'m> Operator<'m> {
    /// The inputs, in the scope `operator`.
    pub(super) fn new(operator: Scope<'m>) -> Operator<'m> {
        Operator { hold: operator.input("hold", 1), trim: operator.input_signed("trim", 9) }
    }

    /// 1 bit: something is in force.
    pub(super) fn acts(&self) -> Signal<'m> {
        self.hold | self.trim.is_nonzero()
    }

    /// The speed to go to: this one times the override, at most `most`; 0 on hold.
    pub(super) fn target(&self, m: Scope<'m>, speed: Signal<'m>, most: u64) -> Signal<'m> {
        let bits = speed.bits();
        let wide = bits + 10;
        let whole = m.lit_signed(10, i64::from(WHOLE_OVERRIDE));
        let share = whole.wrapping_add(self.trim.extend(10)).as_unsigned().slice(0, 9);
        let product = speed.extend(wide).wrapping_mul(share.extend(wide));
        let scaled = product.slice(WHOLE_OVERRIDE.trailing_zeros(), bits + 1);
        let most = m.lit(bits + 1, most);
        m.name("target", self.hold.mux(m.lit(bits, 0), least(scaled, most).slice(0, bits)))
    }
}

impl<'m> Ramp<'m> {
    /// The registers and inputs.
    #[must_use]
    pub fn new(m: Scope<'m>, bits: RampBits, block: &Block<'m>) -> Ramp<'m> {
        Ramp::operated(m, bits, block, None)
    }

    /// The same with inputs that there are already.
    pub(super) fn operated(m: Scope<'m>, bits: RampBits, block: &Block<'m>, by: Option<Operator<'m>>) -> Ramp<'m> {
        let n = bits.phase;
        let (phase, v) = (m.reg(PHASE.name(), n), m.reg(V.name(), bits.v).shown(Format::Level));
        let sum = m.name("sum", phase.q.extend(n + 1).wrapping_add(v.q.extend(n + 1)));
        let limits = [0, 1, 2].map(|index| block.held(m, LIMITS.of(index).name(), bits.v));
        Ramp {
            m,
            block: *block,
            bits,
            phase,
            v,
            sum,
            limits,
            rest: [limits[0], limits[2]],
            single: None,
            gains: bits.gains.map(|(name, bits)| block.held(m, name, bits)),
            by: by.unwrap_or_else(|| Operator::new(m.scope("operator"))),
        }
    }

    /// 1 bit: a pulse comes at this edge, where the phase counts: `runs` = 1 (1 bit).
    #[must_use]
    pub fn pulse(&self, runs: Signal<'m>) -> Signal<'m> {
        self.m.name("pulse", runs & self.sum.msb())
    }

    /// The same ramp in front of blocks that follow each other at speed: from a hold it starts, and to one it stops, at
    /// `rest`; at an edge with `single` = 1 (1 bit) it ends its block for a stop.
    #[must_use]
    pub fn between_blocks(mut self, rest: Signal<'m>, single: Signal<'m>) -> Ramp<'m> {
        (self.rest, self.single) = ([rest; 2], Some(single));
        self.limits[2] = self.m.name("end", single.mux(rest, self.limits[2]));
        self
    }

    /// 1 bit: a hold, an override or a stop after the block is in force.
    #[must_use]
    pub fn event(&self) -> Signal<'m> {
        let event = self.by.acts();
        self.single.map_or(event, |single| event | single)
    }

    /// The speed, unsigned.
    #[must_use]
    pub fn speed(&self) -> Signal<'m> {
        self.v.q
    }

    /// Closes it. At a load the phase takes its word, if there is a `preset`, and the speed its own, `first`; an edge with `runs` =
    /// 1 (1 bit) counts; at one with `tick` = 1 (1 bit) the speed changes, with `left` pulses of the block before it.
    pub fn close(self, by: RampEdge<'m>, brake: Brake, risen: Option<Register<'m>>) {
        let (m, block, RampEdge { preset, first, by_hand, runs, tick, left }) = (self.m, &self.block, by);
        let remaining = Remaining::new(&self, left);
        let target = self.by.target(m, self.limits[1], self.bits.most);
        let wanted = m.name("wanted", self.towards(target));
        let braked = least(wanted, self.slower(self.limits[2]));
        let brake = match (brake, risen) {
            (Brake::Count, Some(risen)) => self.brake_by_count(risen, tick, left, [wanted, braked]),
            _ => self.brake_by_square(&remaining, wanted),
        };
        let trapezoid = m.name("brake", brake).mux(braked, wanted);
        let next = match self.bits.curve {
            None => trapezoid,
            Some(bits) => {
                let curve = SCurve::new(m.scope("s_curve"), bits, block);
                let down = remaining.is_within(&self, curve.length());
                let single = self.single.unwrap_or_else(|| m.lit(1, 0));
                curve.close(tick, [self.v.q, self.limits[2]], down, [by_hand, self.event(), single], trapezoid)
            }
        };
        self.v.when(block.load, first).when(tick, next).else_hold();
        let sum = self.sum.slice(0, self.bits.phase);
        match preset {
            Some(preset) => self.phase.when(block.load, preset).when(runs, sum).else_hold(),
            None => self.phase.when(runs, sum).else_hold(),
        }
    }

    /// The speed of the next tick without braking.
    fn towards(&self, target: Signal<'m>) -> Signal<'m> {
        let (v, bits) = (self.v.q, self.v.q.bits());
        let [a, _] = self.gains;
        let wide = bits.max(a.bits()) + 1;
        let faster = least(v.extend(wide).wrapping_add(a.extend(wide)), target.extend(wide)).slice(0, bits);
        let rising = v.is_zero().mux(least(self.rest[0], target), faster);
        // Below the stop speed there is nothing but to stand.
        let stops = target.is_zero() & self.falls_below(self.rest[1]);
        let falling = stops.mux(self.m.lit(bits, 0), self.slower(target));
        v.less_than(target).mux(rising, target.less_than(v).mux(falling, v))
    }

    /// 1 bit: v - d is less than a speed.
    fn falls_below(&self, speed: Signal<'m>) -> Signal<'m> {
        let wide = self.v.q.bits().max(self.gains[1].bits()) + 1;
        self.v.q.extend(wide).less_than(speed.extend(wide).wrapping_add(self.gains[1].extend(wide)))
    }

    /// v - d, but not less than a speed.
    fn slower(&self, speed: Signal<'m>) -> Signal<'m> {
        let (bits, d) = (self.v.q.bits(), self.gains[1]);
        let wide = bits.max(d.bits());
        let difference = self.v.q.extend(wide).wrapping_sub(d.extend(wide)).slice(0, bits);
        self.falls_below(speed).mux(speed, difference)
    }

    fn brake_by_square(&self, remaining: &Remaining<'m>, wanted: Signal<'m>) -> Signal<'m> {
        let wide = &remaining.wide;
        let twice = self.gains[1].concat(self.m.lit(1, 0));
        let square = |speed: Signal<'m>| wide.product(&wide.of(speed), speed);
        let next = wide.product(&wide.sum(&wide.of(self.v.q), &wide.of(wanted)), twice);
        let owed = wide.sum(&wide.product(&remaining.distance, twice), &square(self.limits[2]));
        wide.at_most(&owed, &wide.sum(&square(wanted), &next))
    }

    fn brake_by_count(
        &self,
        risen: Register<'m>,
        tick: Signal<'m>,
        left: Signal<'m>,
        [wanted, braked]: [Signal<'m>; 2],
    ) -> Signal<'m> {
        let bits = left.bits().max(risen.q.bits()) + 1;
        let one = self.m.lit(bits, 1);
        let brake = !risen.q.extend(bits).wrapping_add(one).less_than(left.extend(bits));
        let next = brake.mux(braked, wanted);
        let carry = self.sum.msb().extend(risen.q.bits());
        let up = tick & self.v.q.less_than(next);
        let down = tick & next.less_than(self.v.q);
        let none = self.m.lit(risen.q.bits(), 0);
        let rising = risen.q.strict_add(carry, up & !self.block.load);
        risen.when(self.block.load, none).when(up, rising).when(down, risen.q.saturating_sub(carry)).else_hold();
        brake
    }
}

/// What acts on a ramp at an edge.
#[derive(Clone, Copy, Debug)]
pub struct RampEdge<'m> {
    /// The phase that a load sets, if it does.
    pub preset: Option<Signal<'m>>,
    /// The speed that a load sets.
    pub first: Signal<'m>,
    /// 1 bit: a load begins a block that is a trapezoid whatever else is planned.
    pub by_hand: Signal<'m>,
    /// 1 bit: the phase counts.
    pub runs: Signal<'m>,
    /// 1 bit: the speed changes.
    pub tick: Signal<'m>,
    /// Pulses of the block that are left, unsigned.
    pub left: Signal<'m>,
}

/// The lesser of two unsigned numbers.
fn least<'m>(a: Signal<'m>, b: Signal<'m>) -> Signal<'m> {
    a.less_than(b).mux(a, b)
}

/// What remains of a block, in 2^-n pulses.
struct Remaining<'m> {
    wide: Wide<'m>,
    /// e·2^n - phase, or 0 after the last pulse.
    distance: Vec<Signal<'m>>,
}

impl<'m> Remaining<'m> {
    fn new(ramp: &Ramp<'m>, left: Signal<'m>) -> Remaining<'m> {
        let (n, v, d) = (ramp.phase.q.bits(), ramp.v.q.bits(), ramp.gains[1].bits());
        // Of 2d·(e·2^n - phase) + ve², and of w² + 2d·(v + w).
        let wide = Wide::new(ramp.m, (n + left.bits() + d + 1).max(2 * v).max(v + d + 2) + 1);
        let gone = left.is_zero().mux(ramp.m.lit(n, 0), ramp.phase.q);
        let distance = wide.difference(&wide.shifted(left, n), &wide.of(gone));
        Remaining { wide, distance }
    }

    /// 1 bit: it is less than v and the `length` (unsigned).
    fn is_within(&self, ramp: &Ramp<'m>, length: Signal<'m>) -> Signal<'m> {
        let wide = &self.wide;
        !wide.at_most(&wide.sum(&wide.of(ramp.v.q), &wide.of(length)), &self.distance)
    }
}
