//! Cascaded integrators: an axis of a curve whose coordinates are polynomials.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, magnitude};
use crate::hardware::Hardware;
use crate::per_axis;
use crate::registers::{N, PerAxis, Reg, Rule};

const AS_THE_CURVE: Rule = Rule::Planned("as the curve needs");
/// First differences.
pub const FIRST_DIFFERENCE: PerAxis = Reg::each(per_axis!("p"), N, "first difference of each axis in 1/M BLU").signed();
/// Second differences.
pub const SECOND_DIFFERENCE: PerAxis =
    Reg::each(per_axis!("q"), AS_THE_CURVE, "second difference of each axis").signed();
/// Third differences.
pub const THIRD_DIFFERENCE: PerAxis =
    Reg::each(per_axis!("r"), AS_THE_CURVE, "third difference of each axis, constant").signed();

/// M, of which a BLU is made: a number that hardware with [cascades](cascade) is built with.
pub const MODULUS: &str = "m";
/// The net that is M, from which abs(p) is taken.
pub const ONE_PULSE: &str = "one_pulse";

/// Cascaded integrators of one axis: at an edge with `step` = 1 (1 bit) {pulse, `rest`} := `rest` + p, p += q and q += r, all with the old
/// values. Returns the pulse, and whether it is negative, 1 bit each.
///
/// - `rest`, as many bits as numbers below M have, unsigned: what is left over of a pulse, by this name.
/// - p, q and r, the [first](FIRST_DIFFERENCE), second and third difference, in two's complement, in 1/M BLU: a step owes a pulse at
///   most, abs(p) <= M, else `one_pulse` - abs(p) is below 0.
pub fn cascade<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    hardware: &Hardware,
    (axis, rest): (usize, Reg),
    step: Signal<'m>,
) -> [Signal<'m>; 2] {
    let r = hardware.held(m, block, THIRD_DIFFERENCE.of(axis));
    let q = accumulator(m, block, hardware, SECOND_DIFFERENCE.of(axis), r, step);
    let p = accumulator(m, block, hardware, FIRST_DIFFERENCE.of(axis), q, step);
    remainder(m, block, (rest, hardware.constant(MODULUS)), p, step)
}

/// A difference, which the one after it in the cascade is added to in every step.
fn accumulator<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    hardware: &Hardware,
    register: Reg,
    next: Signal<'m>,
    step: Signal<'m>,
) -> Signal<'m> {
    let accumulator = hardware.reg(m, register);
    let sum = accumulator.q.strict_add(next, step);
    accumulator.when(block.load, hardware.word(block, register)).when(step, sum).else_hold();
    accumulator.q
}

/// The remainder: the first difference is added, modulo M.
fn remainder<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    (rest, modulus): (Reg, i128),
    p: Signal<'m>,
    step: Signal<'m>,
) -> [Signal<'m>; 2] {
    let (name, bits) = (rest.name(), remainder_bits(modulus));
    let rest = m.reg(name, bits);
    // A step owes one pulse at most.
    let one_pulse = m.name(ONE_PULSE, constant(m, bits + 2, modulus).slice(0, bits + 1));
    let _ = one_pulse.strict_sub(magnitude(m, p), step);

    let wide = bits.max(p.bits()) + 2;
    let sum = m.name("sum", rest.q.extend(wide).as_signed().wrapping_add(p.extend(wide)));
    let below = sum.msb();
    let (over, less) = if modulus.unsigned_abs().is_power_of_two() {
        // The bits above those of the remainder are carry and borrow.
        (!below & sum.slice(bits, wide - bits).is_nonzero(), sum.slice(0, bits))
    } else {
        let over = !sum.less_than(constant(m, wide, modulus));
        let taken = over.mux(constant(m, wide, -modulus), below.mux(constant(m, wide, modulus), constant(m, wide, 0)));
        (over, sum.wrapping_add(taken).slice(0, bits))
    };
    rest.when(block.load, block.word(name, bits)).when(step, less).else_hold();
    [m.name("pulse", step & (below | over)), below]
}

/// Bits of the numbers below M.
fn remainder_bits(modulus: i128) -> u32 {
    Width::needed_unsigned((modulus - 1).unsigned_abs())
}

/// A constant of two's complement; M and the numbers below it have 63 bits at most.
fn constant<'m>(m: Scope<'m>, bits: u32, value: i128) -> Signal<'m> {
    m.lit_signed(bits, i64::try_from(value).unwrap_or(i64::MAX))
}
