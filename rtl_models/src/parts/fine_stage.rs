//! The fine stage of data sampling: DDA integrators that follow the travel of a period while the next one is
//! calculated.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Block, Iteration, JR, JV, SIGN, axis_scope, integrator, magnitude};
use crate::hardware::Hardware;
use crate::per_axis;
use crate::registers::{PerAxis, Reg, Rule};

/// The coarse point of the period.
pub const POINT: PerAxis =
    Reg::each(per_axis!("c"), Rule::Planned("n+2+q"), "coarse point of the period, in 2^-q BLU, signed")
        .signed()
        .follows(|_| true);
/// The displacement of a period, in 2^-q BLU.
pub const DISPLACEMENT: Reg = Reg::new("f", Rule::Planned("as it needs"), "displacement of a period");
/// The whole pulses handed over so far, as a position.
pub const TARGET: PerAxis =
    Reg::each(per_axis!("t"), Rule::Planned("n+2"), "whole pulses handed over so far").signed().hidden();
/// The integrators of a burst.
pub const BURST: (PerAxis, PerAxis) = (
    JV.width(Rule::Planned("as f needs")).about("whole pulses of the period, double buffered"),
    JR.width(Rule::Planned("as jv")).about("remainder of the fine stage, from the preset"),
);

/// Two integrators whose integrands are double buffered. The coarse stage hands over a point of the curve, with
/// a fraction, relative to the start or centre of the block; what whole pulses of it are still to be made goes into the
/// buffer. When the period before is over, the buffer is taken, and a burst of 2^n additions, spread over the clocks of
/// a period, makes just those pulses: J_R is the preset again after it.
///
/// - `next_full`, `next_last`, 1 bit each: the buffer holds a period; it is the last one. `last`: of the burst.
/// - `e`, n+1 bits: additions of the burst left.
/// - `phase`: the divider of the clock. 2^n is added each clock and the clocks of a period are taken away at each addition
///   (both times the denominator, where a period is not a whole number of clocks), so that periods are exact in the mean.
///   `going`, 1 bit: it runs, from the first period on. `tick`, 1 bit: an addition at this edge.
/// - Per axis, the buffer `jvx_next`, `sx_next`, `cx_next`, and the burst's `jvx`, `sx`, `cx`: whole pulses, their sign,
///   and the coarse point. `tx`: the whole pulses handed over so far, as a position.
#[derive(Clone, Copy, Debug)]
pub struct FineStage<'m> {
    m: Scope<'m>,
    full: Register<'m>,
    next_last: Register<'m>,
    last: Register<'m>,
    e: Register<'m>,
}

impl<'m> FineStage<'m> {
    /// The registers of its control, for integrators of `bits` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, bits: u32) -> FineStage<'m> {
        let [full, next_last, last] = ["next_full", "next_last", "last"].map(|name| m.reg(name, 1));
        FineStage { m, full, next_last, last, e: m.reg("e", bits + 1) }
    }

    /// 1 bit: a period can be handed over.
    #[must_use]
    pub fn free(&self) -> Signal<'m> {
        !self.full.q
    }

    /// Closes it and the block. At an edge with `hand` = 1 (1 bit), which must find it free, it takes the points of
    /// both axes, two's complement with `fraction` bits of fraction, or, with `last` = 1, the `ends`, whole. After the
    /// burst of the last point the block is done.
    pub fn close(
        self,
        block: Block<'m>,
        hardware: &Hardware,
        [hand, last]: [Signal<'m>; 2],
        points: [Signal<'m>; 2],
        fraction: u32,
        ends: [Signal<'m>; 2],
    ) {
        let m = self.m;
        let [yes, no] = [m.lit(1, 1), m.lit(1, 0)];
        let burst = m.name("burst", self.e.q.is_nonzero());
        let take = m.name("take", self.full.q & !burst);
        let one = m.lit(self.e.q.bits(), 1);
        let tick = self.ticks(&block, hardware, take) & burst;
        let over = tick & self.e.q.equals(one);
        let clocks = m.lit(1, 1).concat(m.lit(self.e.q.bits() - 1, 0));
        self.e
            .when(block.load, m.lit(self.e.q.bits(), 0))
            .when(take, clocks)
            .when(tick, self.e.q.wrapping_sub(one))
            .else_hold();
        self.full.when(block.load, no).when(hand, yes).when(take, no).else_hold();
        self.next_last.when(hand, last).else_hold();
        self.last.when(block.load, no).when(take, self.next_last.q).else_hold();

        for axis in 0..2 {
            let scope = axis_scope(m, axis);
            let (point, end) = (points[axis], ends[axis].extend(points[axis].bits() - fraction));
            let whole_bits = end.bits();
            // Rounded to the nearest pulse.
            let half = m.lit(point.bits(), 1 << (fraction - 1)).as_signed();
            let rounded = point.wrapping_add(half).slice(fraction, whole_bits).as_signed();
            let target = scope.reg_signed(TARGET.of(axis).name(), whole_bits);
            let goal = last.mux(end, rounded);
            let fine = |whole: Signal<'m>| whole.concat(m.lit(fraction, 0)).as_signed();
            let start = block.word_signed(TARGET.of(axis).name(), whole_bits);
            target.when(block.load, start).when(hand, goal).else_hold();
            let travel = goal.wrapping_sub(target.q);

            let bits = hardware.bits(JV.of(axis));
            let next = scope.reg(&format!("{}_next", JV.of(axis).name()), bits);
            // An emptied buffer is 0.
            let ahead = next.q.strict_add(magnitude(m, travel), hand & !block.load);
            next.when(block.load, m.lit(bits, 0)).when(hand, ahead).when(take, m.lit(bits, 0)).else_hold();
            let jv = scope.reg(JV.of(axis).name(), bits);
            jv.when(block.load, m.lit(bits, 0)).when(take, next.q).else_hold();
            let buffered = |name: &str, value: Signal<'m>| {
                let buffer = scope.reg(name, value.bits());
                buffer.when(hand, value).else_hold();
                buffer.q
            };
            let next_sign = buffered(&format!("{}_next", SIGN.of(axis).name()), travel.msb());
            let sign = scope.reg(SIGN.of(axis).name(), 1);
            sign.when(take, next_sign).else_hold();
            let next_point = scope.reg_signed(&format!("{}_next", POINT.of(axis).name()), point.bits());
            next_point.when(hand, last.mux(fine(end), point)).else_hold();
            let drawn = scope.reg_signed(POINT.of(axis).name(), point.bits());
            drawn.when(block.load, fine(start)).when(take, next_point.q).else_hold();

            let pulse = integrator(scope, &block, hardware, axis, jv.q, Iteration { add: tick, complete: tick });
            hardware.axis(scope, &block, axis, pulse, sign.q);
        }
        block.close(block.load, over, self.last.q);
    }

    /// The divider of the clock, which begins with the first period that is taken (`take` = 1, 1 bit). Returns 1 bit:
    /// one of the 2^n additions of a period is due at this edge. Two are never next to each other.
    fn ticks(&self, block: &Block<'m>, hardware: &Hardware, take: Signal<'m>) -> Signal<'m> {
        let m = self.m;
        let [clocks, of] = hardware.sampling.map_or([1, 1], |sampling| sampling.clocks);
        let additions = u128::from(of) << (self.e.q.bits() - 1);
        let bits = Width::needed_unsigned(u128::from(clocks) + additions);
        // The plan leaves two clocks for an addition at least, and 60 bits for the clocks.
        let additions = m.lit(bits, u64::try_from(additions).unwrap_or(u64::MAX));
        let (going, phase) = (m.reg("going", 1), m.reg("phase", bits));
        let sum = phase.q.wrapping_add(additions);
        let all = m.lit(bits, clocks);
        let tick = m.name("tick", going.q & !sum.less_than(all));
        going.when(block.load, m.lit(1, 0)).when(take, m.lit(1, 1)).else_hold();
        phase.when(block.load, m.lit(bits, 0)).when(tick, sum.wrapping_sub(all)).when(going.q, sum).else_hold();
        tick
    }
}
