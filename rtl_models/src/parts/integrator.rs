//! The DDA integrator.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::{Block, Iteration, decimal_adder, digit_adder};
use crate::hardware::Hardware;
use crate::options::{ADDER, Adder, RADIX, Radix};
use crate::per_axis;
use crate::registers::{N, PerAxis, Reg};

/// Integrands.
pub const JV: PerAxis = Reg::each(per_axis!("jv"), N, "integrand J_V of each axis, |d|").scaled();
/// Remainders.
pub const JR: PerAxis = Reg::each(per_axis!("jr"), N, "remainder J_R of each axis, from the preset").preset().scaled();

/// One DDA integrator: in every iteration it adds the integrand J_V into the remainder register J_R of its axis (at
/// least as wide as the integrand); returns the carry (1 bit), which is the axis's pulse.
///
/// Added in parallel, the carry comes with the sum, in radix 10 from BCD digit adders. A serial integrator adds the
/// lowest digits of J_V and J_R and the carry that it kept (`carry`, 1 bit); J_R shifts right and takes in the digit of
/// the sum. J_V, as wide as J_R, must [rotate](rotated) meanwhile. After the last digit J_R is the sum, and the carry
/// the pulse.
pub fn integrator<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    hardware: &Hardware,
    axis: usize,
    integrand: Signal<'m>,
    step: Iteration<'m>,
) -> Signal<'m> {
    let (name, bits) = (JR.of(axis).name(), hardware.bits(JR.of(axis)));
    let remainder = m.reg(name, bits).shown(digits(hardware));
    let word = block.word_in(hardware.get(&RADIX), name, bits);
    if hardware.get(&ADDER) == Adder::Serial {
        let carry = m.reg("carry", 1);
        let low = |register: Signal<'m>| register.slice(0, hardware.get(&RADIX).digit_bits());
        let [a, b] = [m.name("jv_low", low(integrand)), m.name("jr_low", low(remainder.q))];
        let (over, sum) = digit_adder(m, hardware.get(&RADIX), a, b, carry.q);
        let sum = m.name("sum_low", sum);
        remainder.when(block.load, word).when(step.add, shifted_in(remainder.q, sum)).else_hold();
        let no = m.lit(1, 0);
        carry.when(block.load, no).when(step.complete, no).when(step.add, over).else_hold();
        return m.name("pulse", over & step.complete);
    }
    let integrand = integrand.extend(bits);
    let (carry, sum) = match hardware.get(&RADIX) {
        Radix::Binary => remainder.q.carrying_add(integrand),
        Radix::Decimal => decimal_adder(m, remainder.q, integrand),
    };
    remainder.when(block.load, word).when(step.add, sum).else_hold();
    m.name("carry", carry & step.add)
}

/// A remainder register that begins at 0 and is never loaded, of a fine line: at an edge with `add` = 1 (1 bit) it adds the
/// integrand, as wide. Returns the carry, 1 bit. After 2^n additions of n bits there were as many carries as the integrand
/// says, and it is 0 again.
pub(super) fn fine_line<'m>(
    m: Scope<'m>,
    remainder: Register<'m>,
    integrand: Signal<'m>,
    add: Signal<'m>,
) -> Signal<'m> {
    let (carry, sum) = remainder.q.carrying_add(integrand);
    remainder.when(add, sum).else_hold();
    m.name("carry", carry & add)
}

/// How the registers of integrators are shown: decimal digits in radix 10, bits where they shift, else a number.
#[must_use]
pub fn digits(hardware: &Hardware) -> Format {
    match (hardware.get(&RADIX), hardware.get(&ADDER)) {
        (Radix::Decimal, _) => Format::Decimal,
        (Radix::Binary, Adder::Serial) => Format::Binary,
        (Radix::Binary, Adder::Parallel) => Format::Unsigned,
    }
}

/// The integrand of a serial integrator one digit on: its lowest digit comes in again at the top.
#[must_use]
pub fn rotated<'m>(hardware: &Hardware, integrand: Signal<'m>) -> Signal<'m> {
    shifted_in(integrand, integrand.slice(0, hardware.get(&RADIX).digit_bits()))
}

/// Shifted right by a digit, which comes in at the top; the lowest is lost.
fn shifted_in<'m>(value: Signal<'m>, digit: Signal<'m>) -> Signal<'m> {
    let rest = value.bits().saturating_sub(digit.bits());
    if rest == 0 { digit } else { digit.concat(value.slice(digit.bits(), rest)) }
}
