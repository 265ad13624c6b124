//! The comparison-integral interpolator between its load words and its axes.

use stepwave_kernel::dsl::{Register, Scope, Signal};
use stepwave_kernel::formula::name;
use stepwave_kernel::netlist::Format;

use super::{BeatRing, Block, DeviationAccumulator, EndCounters, axis_counter, negated};
use crate::choices::Weights;
use crate::hardware::Hardware;

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
/// - `a`, `b`, unsigned: interval weights of an X and of a Y pulse.
/// - `f`, two's complement: what the pulses of the base axis weigh, less those of the other.
/// - `base`, 1 bit, X or Y: the base axis. Where a and b change places, it changes and F := -F.
/// - `ex`, `ey`: end-point counters; an exhausted axis is inhibited, and the other forced.
pub fn comparison_integral<'m>(m: Scope<'m>, block: Block<'m>, hardware: &Hardware, sides: [Side<'m>; 2]) {
    let bits = |name: &str| hardware.bits(name);
    let beat = BeatRing::new(m, hardware.beats, block.busy);
    let f = DeviationAccumulator::new(m, bits("f"));
    let [a, b] = ["a", "b"].map(|name| m.reg(name, bits(name)));
    let names = vec![(0, "X".to_owned()), (1, "Y".to_owned())];
    let base = m.reg("base", 1).shown(Format::States(names));
    let end = EndCounters::new(m, &block, hardware);

    let y_is_base = || name("base");
    m.between_steps("x_is_base", [name("b") - name("a"), y_is_base() - 1]);
    m.between_steps("y_is_base", [name("a") - name("b"), -y_is_base()]);

    // Judge.
    let [base_x, base_y] = [!base.q, base.q];
    let taken = end.redirected([base_x | f.not_negative(), base_y | f.not_negative()]);
    let taken = [beat.decided("take_x", taken[0]), beat.decided("take_y", taken[1])];

    // Feed.
    for ((letter, side), taken) in ["x", "y"].into_iter().zip(sides).zip(taken) {
        axis_counter(
            m.scope(&format!("axis_{letter}")),
            &block,
            letter,
            bits(letter),
            beat.feed & taken,
            side.negative,
        );
    }

    // Compute: the weights behind the pulses, and F with the weight that the rule says.
    let wide = bits("a").max(bits("b")) + 3;
    let [word_a, word_b] = ["a", "b"].map(|name| block.word(name, bits(name)));
    let intervals = [(a, word_a, taken[0], sides[0]), (b, word_b, taken[1], sides[1])];
    let [(a_behind, a_weight), (b_behind, b_weight)] = intervals.map(|(register, word, taken, side)| {
        let behind = moved(&block, beat.compute, register, taken, side.change);
        register.when(block.load, word).when(beat.compute, behind).else_hold();
        let zero = m.lit(wide, 0);
        let weight = if side.change.is_some() {
            weight(hardware.weights, register.q, behind, wide)
        } else {
            register.q.extend(wide)
        };
        (behind, taken.mux(weight, zero).as_signed())
    });
    let change = m.name("change", base_x.mux(a_weight.wrapping_sub(b_weight), b_weight.wrapping_sub(a_weight)));
    let wide = bits("a").max(bits("b"));
    let [a_behind, b_behind] = [a_behind.extend(wide), b_behind.extend(wide)];
    let turn = m.name("turn", base_x.mux(b_behind.less_than(a_behind), a_behind.less_than(b_behind)));
    // F + (-2F - change) is -(F + change).
    let wide = change.bits().max(f.value().bits() + 1) + 1;
    let [change, twice] = [change.extend(wide), f.value().concat(m.lit(1, 0)).extend(wide)];
    let operand = turn.mux(negated(m, twice.wrapping_add(change)), change);
    f.close_adding(&block, beat.compute, m.name("operand", operand));
    let wide = word_a.bits().max(word_b.bits());
    let starts_with_y = !word_a.extend(wide).less_than(word_b.extend(wide));
    base.when(block.load, starts_with_y).when(beat.compute & turn, !base.q).else_hold();

    // Compare.
    let last = end.count(beat.compare, taken);
    beat.close(&block, last);
    block.close(block.load, beat.compare, last);
}

/// An interval weight behind a step.
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

/// What a pulse counts, of the interval weights before and behind it.
fn weight<'m>(rule: Weights, before: Signal<'m>, behind: Signal<'m>, bits: u32) -> Signal<'m> {
    let [before, behind] = [before.extend(bits), behind.extend(bits)];
    match rule {
        Weights::Mid => before.wrapping_add(behind),
        Weights::Pre => before,
        Weights::Post => behind,
    }
}
