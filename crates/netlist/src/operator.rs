//! Operators whose exact result may not fit in the bits that are kept of it.

use crate::cells::Arithmetic;

/// An operator whose exact result may not fit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Operator {
    /// left + right
    Add,
    /// left - right
    Sub,
    /// -left
    Neg,
    /// left * right
    Mul,
    /// left * 2^right
    ShiftLeft,
    /// left^right, of an exponent that is not negative
    Power,
}

impl From<Arithmetic> for Operator {
    fn from(operation: Arithmetic) -> Operator {
        match operation {
            Arithmetic::Add => Operator::Add,
            Arithmetic::Sub => Operator::Sub,
        }
    }
}

impl Operator {
    /// Every operator.
    pub const ALL: [Operator; 6] =
        [Operator::Add, Operator::Sub, Operator::Neg, Operator::Mul, Operator::ShiftLeft, Operator::Power];

    /// Its word in the text form and in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Operator::Add => "add",
            Operator::Sub => "sub",
            Operator::Neg => "neg",
            Operator::Mul => "mul",
            Operator::ShiftLeft => "shift-left",
            Operator::Power => "power",
        }
    }

    /// Its sign between two operands.
    #[must_use]
    pub fn sign(self) -> &'static str {
        match self {
            Operator::Add => "+",
            Operator::Sub | Operator::Neg => "-",
            Operator::Mul => "*",
            Operator::ShiftLeft => "<<",
            Operator::Power => "**",
        }
    }

    /// The exact result; `None` where it has more than 127 bits.
    #[must_use]
    pub fn exact(self, left: i128, right: i128) -> Option<i128> {
        match self {
            Operator::Add => left.checked_add(right),
            Operator::Sub => left.checked_sub(right),
            Operator::Neg => left.checked_neg(),
            Operator::Mul => left.checked_mul(right),
            Operator::ShiftLeft if left == 0 => Some(0),
            Operator::ShiftLeft => {
                let factor =
                    u32::try_from(right).ok().and_then(|bits| 1i128.checked_shl(bits)).filter(|factor| *factor > 0);
                left.checked_mul(factor?)
            }
            // Of larger exponents: 0, 1 and -1 by whether it is odd; of all others the result has more bits.
            Operator::Power if right > 128 => left.checked_pow(128 + u32::from(right % 2 == 1)),
            Operator::Power => u32::try_from(right).ok().and_then(|exponent| left.checked_pow(exponent)),
        }
    }

    /// Least and greatest exact result of operands in these ranges; `None` where one has more than 127 bits.
    #[must_use]
    pub fn range(self, left: [i128; 2], right: [i128; 2]) -> Option<(i128, i128)> {
        let (mut left, mut right) = (left.to_vec(), right.to_vec());
        if self == Operator::Power {
            // Even powers are least at 0, and of negative numbers the greatest exponent that is odd counts, too.
            left.extend((left[0] < 0 && left[1] > 0).then_some(0));
            right.extend((right[0] < right[1]).then_some(right[1] - 1));
        }
        let corners = left.iter().flat_map(|&left| right.iter().map(move |&right| self.exact(left, right)));
        let corners: Vec<i128> = corners.collect::<Option<_>>()?;
        Some((corners.iter().copied().min()?, corners.iter().copied().max()?))
    }
}

#[cfg(test)]
mod tests {
    use super::Operator;

    #[test]
    fn the_range_of_an_operator_holds_every_result_and_both_ends_are_reached() {
        for operator in Operator::ALL {
            for (left, right) in [([-4, 3], [0, 2]), ([0, 7], [0, 3]), ([2, 2], [1, 3]), ([-8, -8], [0, 1])] {
                let all = (left[0]..=left[1]).flat_map(|l| (right[0]..=right[1]).map(move |r| operator.exact(l, r)));
                let all: Vec<i128> = all.flatten().collect();
                let ends = (*all.iter().min().unwrap(), *all.iter().max().unwrap());
                assert_eq!(operator.range(left, right), Some(ends), "{operator:?} {left:?} {right:?}");
            }
        }
    }

    #[test]
    fn a_result_of_more_than_127_bits_is_none() {
        assert_eq!(Operator::ShiftLeft.exact(1, 126), Some(1 << 126));
        assert_eq!(Operator::ShiftLeft.exact(1, 127), None);
        assert_eq!(Operator::Mul.exact(i128::MAX, 2), None);
        assert_eq!(Operator::Power.exact(-2, 126), Some(1 << 126));
        assert_eq!((Operator::Power.exact(2, 127), Operator::Power.exact(-3, 1 << 40)), (None, None));
        assert_eq!((Operator::Power.exact(-1, (1 << 40) + 1), Operator::Power.exact(0, 0)), (Some(-1), Some(1)));
        assert_eq!(Operator::ShiftLeft.exact(0, 1 << 40), Some(0));
    }
}
