//! The comparison-integral interpolator between its load words and its axes.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{BeatRing, Block, DeviationAccumulator, EndCounters, F, axis_scope, negated};
use crate::hardware::Hardware;
use crate::options::{BEATS, WEIGHTS, Weights};
use crate::registers::{N, Reg, Rule};

/// Interval weights of an X and of a Y pulse.
pub const A_B: Reg<2> = Reg::each(["a", "b"], N, "interval weights A of an X, B of a Y pulse");
/// The base axis.
pub const BASE: Reg = Reg::new("base", Rule::Bits(1), "base axis, X = 0, Y = 1");

/// What is particular to one axis of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Side<'m> {
    /// 1 bit: the motion is negative.
    pub negative: Signal<'m>,
    /// How a pulse changes the interval weight; it is constant on a line.
    pub change: Option<Change<'m>>,
}

/// The change of an interval weight by a pulse of its axis.
#[derive(Clone, Copy, Debug)]
pub struct Change<'m> {
    /// 1 bit: it grows.
    pub grows: Signal<'m>,
    /// By how much, unsigned.
    pub unit: Signal<'m>,
}

/// Comparison-integral in two axes: the axis of the smaller interval is the base axis and steps always, the other
/// steps where F >= 0.
///
/// - `ex`, `ey`: end-point counters; an exhausted axis is inhibited, and the other forced.
/// - What [`Weighing`] has.
pub fn comparison_integral<'m>(m: Scope<'m>, block: Block<'m>, hardware: &Hardware, sides: [Side<'m>; 2]) {
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let weighing = Weighing::new(m, hardware, A_B);
    let end = EndCounters::new(m, &block, hardware);

    // Judge.
    let taken = end.redirected(weighing.judged());
    let taken = [beat.decided("take_x", taken[0]), beat.decided("take_y", taken[1])];

    // Feed.
    for ((axis, side), taken) in sides.into_iter().enumerate().zip(taken) {
        hardware.axis(axis_scope(m, axis), &block, axis, beat.feed & taken, side.negative);
    }

    // Compute.
    weighing.close(&block, hardware.get(&WEIGHTS), beat.compute, taken, sides.map(|side| side.change));

    // Compare.
    let last = end.count(beat.compare, taken);
    beat.close(block, last);
}

/// What comparison-integral weighs its pulses with.
///
/// - `a`, `b`, unsigned: interval weights of an X and of a Y pulse.
/// - `f`, two's complement: what the pulses of the base axis weigh, less those of the other.
/// - `base`, 1 bit, X or Y: the base axis. Where a and b change places, it changes and F := -F.
#[derive(Clone, Copy, Debug)]
pub struct Weighing<'m> {
    m: Scope<'m>,
    f: DeviationAccumulator<'m>,
    weights: [Register<'m>; 2],
    names: Reg<2>,
    base: Register<'m>,
}

impl<'m> Weighing<'m> {
    /// The registers, with these names of the weights.
    #[must_use]
    pub fn new(m: Scope<'m>, hardware: &Hardware, names: Reg<2>) -> Weighing<'m> {
        let f = DeviationAccumulator::new(m, hardware.bits(F));
        let weights = [0, 1].map(|axis| hardware.reg(m, names.of(axis)));
        let states = vec![(0, "X".to_owned()), (1, "Y".to_owned())];
        let base = hardware.reg(m, BASE).shown(Format::States(states));
        let [a, b] = [0, 1].map(|axis| move || names.of(axis).value());
        m.between_steps("x_is_base", [b() - a(), BASE.value() - 1]);
        m.between_steps("y_is_base", [a() - b(), -BASE.value()]);
        Weighing { m, f, weights, names, base }
    }

    /// 1 bit each: x and y step, but for the end point.
    #[must_use]
    pub fn judged(&self) -> [Signal<'m>; 2] {
        [!self.base.q | self.f.not_negative(), self.base.q | self.f.not_negative()]
    }

    /// Closes it: at an edge with `compute` = 1 the axes taken (1 bit each) have pulses, which change their weights.
    pub fn close(
        self,
        block: &Block<'m>,
        rule: Weights,
        compute: Signal<'m>,
        taken: [Signal<'m>; 2],
        changes: [Option<Change<'m>>; 2],
    ) {
        let Weighing { m, f, weights: [a, b], names, base } = self;
        let base_x = !base.q;
        let bits = |register: Register<'m>| register.q.bits();
        // The weights after the pulses, and F with the weight that the rule selects.
        let wide = bits(a).max(bits(b)) + 3;
        let [word_a, word_b] =
            [(0, a), (1, b)].map(|(axis, register)| block.word(names.of(axis).name(), bits(register)));
        let intervals = [(a, word_a, taken[0], changes[0]), (b, word_b, taken[1], changes[1])];
        let [(a_after, a_weight), (b_after, b_weight)] = intervals.map(|(register, word, taken, change)| {
            let after = moved(block, compute, register, taken, change);
            register.when(block.load, word).when(compute, after).else_hold();
            let zero = m.lit(wide, 0);
            let weight = if change.is_some() { weight(rule, register.q, after, wide) } else { register.q.extend(wide) };
            (after, taken.mux(weight, zero).as_signed())
        });
        let change = m.name("change", base_x.mux(a_weight.wrapping_sub(b_weight), b_weight.wrapping_sub(a_weight)));
        let wide = bits(a).max(bits(b));
        let [a_after, b_after] = [a_after.extend(wide), b_after.extend(wide)];
        let turn = m.name("turn", base_x.mux(b_after.less_than(a_after), a_after.less_than(b_after)));
        // F + (-2F - change) is -(F + change).
        let wide = change.bits().max(f.value().bits() + 1) + 1;
        let [change, twice] = [change.extend(wide), f.value().concat(m.lit(1, 0)).extend(wide)];
        let operand = turn.mux(negated(m, twice.wrapping_add(change)), change);
        f.close_adding(block, compute, m.name("operand", operand));
        let wide = word_a.bits().max(word_b.bits());
        let starts_with_y = !word_a.extend(wide).less_than(word_b.extend(wide));
        base.when(block.load, starts_with_y).when(compute & turn, !base.q).else_hold();
    }
}

/// An interval weight after a step.
fn moved<'m>(
    block: &Block<'m>,
    compute: Signal<'m>,
    weight: Register<'m>,
    taken: Signal<'m>,
    change: Option<Change<'m>>,
) -> Signal<'m> {
    let Some(Change { grows, unit }) = change else { return weight.q };
    let counts = compute & taken & !block.load;
    let sum = weight.q.strict_add(unit, counts & grows);
    let difference = weight.q.strict_sub(unit, counts & !grows);
    taken.mux(grows.mux(sum, difference), weight.q)
}

/// The weight of a pulse, from the interval weights before and after it.
fn weight<'m>(rule: Weights, before: Signal<'m>, after: Signal<'m>, bits: u32) -> Signal<'m> {
    let [before, after] = [before.extend(bits), after.extend(bits)];
    match rule {
        Weights::Mid => before.wrapping_add(after),
        Weights::Pre => before,
        Weights::Post => after,
    }
}
