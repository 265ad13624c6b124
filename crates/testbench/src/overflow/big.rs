//! Numbers of any width: operands of more than 64 bits, and exact results of them.

use num_bigint::{BigInt, BigUint, Sign};
use stepwave_netlist::cells::Operator;

/// Bits of an exact result, at most.
pub(super) const MOST_BITS: u64 = 1 << 16;

/// The number that some bits mean, given as numbers of 64 bits, the lowest first.
pub(super) fn number(values: &[u64], bits: u32, signed: bool) -> BigInt {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let unsigned = BigInt::from_bytes_le(Sign::Plus, &bytes);
    let negative = signed && bits > 0 && unsigned.bit(u64::from(bits) - 1);
    if negative { unsigned - (BigInt::from(1) << bits) } else { unsigned }
}

/// The exact result; `None` where it may have more than [`MOST_BITS`].
pub(super) fn exact(operator: Operator, left: &BigInt, right: &BigInt) -> Option<BigInt> {
    Some(match operator {
        Operator::Add => left + right,
        Operator::Sub => left - right,
        Operator::Neg => -left,
        Operator::Mul => left * right,
        Operator::ShiftLeft if *left == BigInt::ZERO => BigInt::ZERO,
        Operator::Power if left.bits() <= 1 => {
            left.pow(u32::from(right.bit(0)) + 2 * u32::from(*right > BigInt::from(1)))
        }
        Operator::Power => {
            let exponent = u32::try_from(right).ok().filter(|by| u64::from(*by) * left.bits() <= MOST_BITS)?;
            left.pow(exponent)
        }
        Operator::ShiftLeft => left << u64::try_from(right).ok().filter(|by| by + left.bits() <= MOST_BITS)?,
    })
}

/// Bits that a number needs; `None` of a negative one without a sign.
pub(super) fn needed(number: &BigInt, signed: bool) -> Option<u64> {
    let magnitude = if number.sign() == Sign::Minus { (-number - 1u8).bits() } else { number.bits() };
    match (signed, number.sign()) {
        (true, _) => Some(magnitude + 1),
        (false, Sign::Minus) => None,
        (false, _) => Some(magnitude.max(1)),
    }
}

/// Least and greatest number of some bits.
pub(super) fn range(bits: u32, signed: bool) -> [BigInt; 2] {
    let count = |bits: u32| BigInt::from(BigUint::from(1u8) << bits);
    if signed { [-count(bits - 1), count(bits - 1) - 1] } else { [BigInt::ZERO, count(bits) - 1] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stepwave_netlist::{Width, bits};

    #[test]
    fn numbers_of_up_to_64_bits_are_those_of_the_widths() {
        for width in [1, 5, 63, 64] {
            let of = Width::new(u64::from(width)).unwrap();
            for value in [0, 1, 3, 1 << (width - 1), of.mask()] {
                let value = value & of.mask();
                for signed in [false, true] {
                    let want = bits::number(of, value, signed);
                    let got = number(&[value], width, signed);
                    assert_eq!(got, BigInt::from(want), "{value:#x} {width} {signed}");
                    assert_eq!(needed(&got, signed), Some(u64::from(Width::needed(want, signed))), "{want} {signed}");
                    let (least, greatest) = of.range(signed);
                    assert_eq!(range(width, signed), [least, greatest].map(BigInt::from));
                }
            }
        }
    }

    #[test]
    fn exact_results_are_those_of_the_operators_where_they_have_127_bits() {
        for operator in Operator::ALL {
            for (left, right) in
                [(0, 5), (7, 3), (-4, 1), (-9, 60), (1 << 62, 40), (-1, 41), (0, 0), (1, 200), (0, 3), (-7, 1)]
            {
                let got = exact(operator, &BigInt::from(left), &BigInt::from(right));
                let got = got.filter(|number| number.bits() < 128);
                assert_eq!(got, operator.exact(left, right).map(BigInt::from), "{operator:?} {left} {right}");
            }
        }
        let large = number(&[0, 0, 1], 130, false);
        assert_eq!(exact(Operator::Mul, &large, &large).unwrap().bits(), 257);
        assert_eq!(exact(Operator::ShiftLeft, &large, &BigInt::from(MOST_BITS)), None);
        assert_eq!(needed(&BigInt::from(-1), false), None);
    }
}
