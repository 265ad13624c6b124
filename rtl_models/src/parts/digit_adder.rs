//! Adders made of digits: the binary full adder, and the decimal digit adder with its correction.

use stepwave_netlist::dsl::{Scope, Signal};

use crate::options::Radix;

/// Adds two digits and a carry of 1 bit; returns the carry to the next digit (1 bit) and the digit of the sum. A digit
/// is 1 bit wide in radix 2, 4 bits (BCD) in radix 10.
#[must_use]
pub fn digit_adder<'m>(
    m: Scope<'m>,
    radix: Radix,
    a: Signal<'m>,
    b: Signal<'m>,
    carry: Signal<'m>,
) -> (Signal<'m>, Signal<'m>) {
    match radix {
        Radix::Binary => {
            let half = a ^ b;
            (a & b | half & carry, half ^ carry)
        }
        Radix::Decimal => {
            let binary = a.extend(5).wrapping_add(b.extend(5)).wrapping_add(carry.extend(5));
            let binary = m.name("binary_sum", binary);
            // Beyond 9: 16 and more, or 8 with a 4 or a 2. The correction by 6 skips what 4 bits have beyond 9.
            let beyond = binary.bit(4) | binary.bit(3) & (binary.bit(2) | binary.bit(1));
            let beyond = m.name("correct", beyond);
            let correction = m.lit(1, 0).concat(beyond).concat(beyond).concat(m.lit(1, 0));
            (beyond, binary.slice(0, 4).wrapping_add(correction))
        }
    }
}

/// Adds two equally wide BCD numbers, a whole number of digits of 4 bits; returns the carry (1 bit) and the sum. The
/// adder of each digit is in a scope `digit_` and its number, 0 for the lowest.
#[must_use]
pub fn decimal_adder<'m>(m: Scope<'m>, a: Signal<'m>, b: Signal<'m>) -> (Signal<'m>, Signal<'m>) {
    let add = |digit: u32, carry: Signal<'m>| {
        let place = 4 * digit;
        let scope = m.scope(&format!("digit_{digit}"));
        digit_adder(scope, Radix::Decimal, a.slice(place, 4), b.slice(place, 4), carry)
    };
    let lowest = add(0, m.lit(1, 0));
    (1..a.bits() / 4).fold(lowest, |(carry, sum), digit| {
        let (carry, high) = add(digit, carry);
        (carry, high.concat(sum))
    })
}
