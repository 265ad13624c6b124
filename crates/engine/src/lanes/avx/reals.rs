//! Distances of circles in floating point, by the same steps as [`root_gap`](crate::lanes::root_gap), so with the same bits.

use super::assembler::{
    ADD_64, ADD_REAL, AND, DIV_REAL, EVEN, EXTEND, EXTEND_SIGNED, GREATEST_REAL, MUL_REAL, OR, Opcode, ROOT, SUB_REAL,
    SWAP_HALVES, SWAP_MIDDLE, TRUNCATE,
};
use super::flow::{Flow, Value};
use crate::lanes::watch::ROOT_GAP_UNIT;

/// Bits of the widest numbers that become real numbers here.
pub(super) const MOST_BITS: u32 = 52;

/// 2^52: the bits of a sum with a number below it are those of the number, after these.
const WHOLE: f64 = (1u64 << 52) as f64;

fn real(flow: &mut Flow, number: f64) -> Value {
    flow.constant(number.to_bits())
}

/// The gaps of numbers of 64 bits, the second with a sign.
pub(super) fn root_gaps(flow: &mut Flow, base: Value, offset: Value) -> Value {
    let whole = real(flow, WHOLE);
    let base = flow.two(OR, base, whole);
    let base = flow.two(SUB_REAL, base, whole);
    let middle = real(flow, WHOLE * 1.5);
    let offset = flow.two(ADD_64, offset, middle);
    let offset = flow.two(SUB_REAL, offset, middle);
    let sum = flow.two(ADD_REAL, base, offset);
    let (a, b) = (flow.one(ROOT, sum), flow.one(ROOT, base));
    let (roots, least) = (flow.two(ADD_REAL, a, b), real(flow, f64::MIN_POSITIVE));
    let roots = flow.two(GREATEST_REAL, roots, least);
    let positive = flow.constant(u64::MAX >> 1);
    let distance = flow.two(AND, offset, positive);
    let gap = flow.two(DIV_REAL, distance, roots);
    let unit = real(flow, ROOT_GAP_UNIT);
    let gap = flow.two(MUL_REAL, gap, unit);
    let gap = flow.two(ADD_REAL, gap, whole);
    let fraction = flow.constant((1 << 52) - 1);
    flow.two(AND, gap, fraction)
}

/// The gaps of numbers of 32 bits, of which the low 32 bits are wanted.
pub(super) fn root_gaps_narrow(flow: &mut Flow, base: Value, offset: Value) -> Value {
    halves(flow, [(EXTEND, base), (EXTEND_SIGNED, offset)], |flow, [base, offset]| root_gaps(flow, base, offset))
}

/// Quotients of numbers of 32 bits without a sign: the fraction of one that is not whole is further from 1 than the
/// rounding of a real number. Nothing of use where the divisor is 0.
pub(super) fn quotients_narrow(flow: &mut Flow, a: Value, b: Value) -> Value {
    halves(flow, [(EXTEND, a), (EXTEND, b)], |flow, numbers| {
        let whole = real(flow, WHOLE);
        let [a, b] = numbers.map(|number| {
            let number = flow.two(OR, number, whole);
            flow.two(SUB_REAL, number, whole)
        });
        let quotient = flow.two(DIV_REAL, a, b);
        let quotient = flow.one(TRUNCATE, quotient);
        flow.two(ADD_REAL, quotient, whole)
    })
}

/// The low 32 bits of what `of` makes of numbers of 32 bits that are extended to 64, half of them at a time.
fn halves(flow: &mut Flow, numbers: [(Opcode, Value); 2], of: impl Fn(&mut Flow, [Value; 2]) -> Value) -> Value {
    let low = numbers.map(|(extend, number)| flow.one(extend, number));
    let low = of(flow, low);
    let high = numbers.map(|(extend, number)| {
        let number = flow.one(SWAP_HALVES, number);
        flow.one(extend, number)
    });
    let high = of(flow, high);
    let even = flow.two(EVEN, low, high);
    flow.one(SWAP_MIDDLE, even)
}
