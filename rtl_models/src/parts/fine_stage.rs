//! The fine stage of data sampling: DDA integrators that follow the travel of a period while the next one is
//! calculated.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Block, Iteration, JR, JV, POSITION, SIGN, axis_scope, integrator, magnitude};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::options::{END_POINT, EndPoint, STEP, TOLERANCE};
use crate::per_axis;
use crate::plan::Plan;
use crate::registers::{PerAxis, Reg, Rule};
use crate::sampling::{Sampling, whole};

/// Most bits of the clocks of a period, so that the divider of the clock adds within 64 bits.
const MOST_CLOCK_BITS: u32 = 60;

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
    /// Plans a fine stage of two axes after this coarse stage: its integrators hold the greatest way of a period:
    /// f, rounded to whole pulses, and `more` BLU by which the last way may be longer. The coarse stage takes `coarse`
    /// clocks a period.
    ///
    /// # Errors
    /// A register is too wide, or the clock leaves a period too few clocks.
    pub fn plan(
        sampling: Sampling,
        plan: &mut Plan,
        more: f64,
        coarse: u32,
        positions: impl IntoIterator<Item = impl IntoIterator<Item = i64>>,
    ) -> Result<(), ModelError> {
        let n = plan.bits_or(Width::needed_unsigned(whole(sampling.step.units() + 1.0 + more)));
        plan.set_each(JV, n).set_each(JR, n).positions(positions);
        plan.fix(&END_POINT, EndPoint::Iterations);
        plan.integrators(1)?;
        let coarse = u64::from(coarse);
        // Additions at least two clocks apart leave one for the integrands of the next period.
        let burst = 1_u64.checked_shl(plan.bits(JR.of(0)) + 1).unwrap_or(u64::MAX);
        let needs = [(coarse, "the coarse calculation takes"), (burst, "the additions of the fine stage take")];
        let clocks = period(&sampling, plan.model(), needs[usize::from(burst > coarse)])?;
        // The calculation once a block; and periods without a pulse.
        let periods = u64::try_from(whole((4.0 / sampling.step.units()).min(1e9))).unwrap_or(u64::MAX >> 32) + 4;
        let period = (clocks[0] / clocks[1]).saturating_add(2);
        plan.stall_clocks = coarse.saturating_mul(2).saturating_add(period.saturating_mul(periods));
        plan.fix(&STEP, Some(sampling.step));
        plan.fix(&TOLERANCE, Some(sampling.tolerance));
        plan.sampling = Some(Sampling { clocks, ..sampling });
        Ok(())
    }

    /// The registers of its control, for integrators of `bits` bits.
    #[must_use]
    pub fn new(m: Scope<'m>, bits: u32) -> FineStage<'m> {
        let [full, next_last, last] = ["next_full", "next_last", "last"].map(|name| m.reg(name, 1));
        FineStage { m, full, next_last, last, e: m.reg("e", bits + 1) }
    }

    /// These load words and its own: the preset of every remainder, and where a block starts, in the coordinates of its points
    /// and in those of the machine.
    #[must_use]
    pub fn words(words: Words, hardware: &Hardware, start: [i128; 2], from: [i128; 2]) -> Vec<Words> {
        let presets = [0, 1].map(|axis| hardware.preset(JR.of(axis)));
        vec![words.set_each(TARGET.pair(), start).set_each(JR.pair(), presets).set_each(POSITION.pair(), from)]
    }

    /// 1 bit: a period can be handed over.
    #[must_use]
    pub fn free(&self) -> Signal<'m> {
        !self.full.q
    }

    /// 1 bit: the burst that runs is the last one.
    #[must_use]
    pub fn last(&self) -> Signal<'m> {
        self.last.q
    }

    /// Closes it and the block: see [`draw`](FineStage::draw). After the burst of the last point the block is done.
    pub fn close(
        self,
        block: Block<'m>,
        hardware: &Hardware,
        hands: [Signal<'m>; 2],
        points: [Signal<'m>; 2],
        fraction: u32,
        ends: [Signal<'m>; 2],
    ) {
        let (over, _) = self.draw(&block, hardware, hands, points, fraction, ends);
        block.close(block.load, over, self.last.q);
    }

    /// Closes it. At an edge with `hand` = 1 (1 bit), which must find it free, it takes the points of both axes, two's
    /// complement with `fraction` bits of fraction, or, with `last` = 1, the `ends`, whole. Returns 1 bit each: a burst is
    /// over at this edge; what was handed over is taken.
    #[must_use]
    pub fn draw(
        &self,
        block: &Block<'m>,
        hardware: &Hardware,
        [hand, last]: [Signal<'m>; 2],
        points: [Signal<'m>; 2],
        fraction: u32,
        ends: [Signal<'m>; 2],
    ) -> (Signal<'m>, Signal<'m>) {
        let m = self.m;
        let [yes, no] = [m.lit(1, 1), m.lit(1, 0)];
        let burst = m.name("burst", self.e.q.is_nonzero());
        let take = m.name("take", self.full.q & !burst);
        let one = m.lit(self.e.q.bits(), 1);
        let tick = self.ticks(block, hardware, take) & burst;
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
            // From one side of the origin to the other it may be longer than any coordinate.
            let [to, from] = [goal, target.q].map(|place| place.extend(whole_bits + 1));
            let travel = to.wrapping_sub(from);

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

            let pulse = integrator(scope, block, hardware, axis, jv.q, Iteration { add: tick, complete: tick });
            hardware.axis(scope, block, axis, pulse, sign.q);
        }
        (over, take)
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

/// Clocks of a period T at the clock that was chosen, or else the least that hold `least` clocks.
///
/// # Errors
/// The clock leaves fewer clocks in a period than `least`, which `why` needs.
fn period(sampling: &Sampling, model: &'static str, (least, why): (u64, &str)) -> Result<[u64; 2], ModelError> {
    let [seconds, of] = sampling.system.period_ratio().map(u128::from);
    let Some(hz) = sampling.clock_hz else { return Ok([least, 1]) };
    let (clocks, of) = (u128::from(hz.0) * seconds, of * 1_000_000);
    let period = sampling.system.period() * 1e3;
    if clocks < u128::from(least) * of {
        let enough = (u128::from(least) * of).div_ceil(seconds * 1_000_000);
        return Err(ModelError::Widths(format!(
            "{model}: a clock of {hz} Hz has {} clocks in the period of {period} ms, but {why} {least}: give --clock-hz \
             {enough} or more",
            clocks / of
        )));
    }
    let common = common_divisor(clocks, of);
    match [clocks / common, of / common].map(u64::try_from) {
        [Ok(clocks), Ok(of)] if clocks >> MOST_CLOCK_BITS == 0 => Ok([clocks, of]),
        _ => Err(ModelError::Widths(format!(
            "{model}: a clock of {hz} Hz is more than the divider of the clock can count in the period of {period} ms: \
             give a lower --clock-hz, or one in whole Hz"
        ))),
    }
}

fn common_divisor(a: u128, b: u128) -> u128 {
    if b == 0 { a.max(1) } else { common_divisor(b, a % b) }
}
