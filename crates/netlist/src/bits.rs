//! Widths, bit vectors, and the meaning of every operator, defined once.
//!
//! A value is held in the low bits of a `u64`; all bits above the width are 0. The functions below take and give
//! such values; the word-level engines and constant evaluation call them, and nothing else defines an operator.
//! (The `gates` engine deliberately does not: it is the independent judge.)

mod reading;

use std::fmt;

pub use reading::Reading;

/// Number of bits of a net: 1 to 64.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Width(u8);

/// A width outside 1 to 64 was asked for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a width of {0} bits is not possible: a register holds 1 to 64 bits")]
pub struct WidthError(pub u64);

impl Width {
    /// One bit.
    pub const ONE: Width = Width(1);
    /// The widest net: 64 bits.
    pub const MAX: Width = Width(64);

    /// A width of `bits` bits.
    ///
    /// # Errors
    /// `bits` is 0 or more than 64.
    pub fn new(bits: u64) -> Result<Width, WidthError> {
        match u8::try_from(bits) {
            Ok(bits @ 1..=64) => Ok(Width(bits)),
            _ => Err(WidthError(bits)),
        }
    }

    /// The number of bits.
    #[inline]
    #[must_use]
    pub fn get(self) -> u32 {
        u32::from(self.0)
    }

    /// All ones in this width; also the greatest unsigned value.
    #[inline]
    #[must_use]
    pub fn mask(self) -> u64 {
        u64::MAX >> (64 - self.0)
    }

    /// The sign bit of this width.
    #[inline]
    #[must_use]
    pub fn sign_bit(self) -> u64 {
        1 << (self.0 - 1)
    }

    /// Bits that an unsigned number needs: 0 needs 1, 8 needs 4.
    #[must_use]
    pub fn needed_unsigned(value: u128) -> u32 {
        (128 - value.leading_zeros()).max(1)
    }

    /// Bits that a number needs in two's complement: 0 and -1 need 1, 7 and -8 need 4.
    #[must_use]
    pub fn needed_signed(value: i128) -> u32 {
        129 - if value < 0 { value.leading_ones() } else { value.leading_zeros() }
    }

    /// Bits that `value` needs, in two's complement if `signed`. A negative number needs a sign in any case.
    #[must_use]
    pub fn needed(value: i128, signed: bool) -> u32 {
        match u128::try_from(value) {
            Ok(value) if !signed => Width::needed_unsigned(value),
            _ => Width::needed_signed(value),
        }
    }

    /// Least and greatest number of this width.
    #[must_use]
    pub fn range(self, signed: bool) -> (i128, i128) {
        if signed {
            (-(i128::from(self.sign_bit())), i128::from(self.sign_bit()) - 1)
        } else {
            (0, i128::from(self.mask()))
        }
    }
}

impl fmt::Display for Width {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 == 1 { f.write_str("1 bit") } else { write!(f, "{} bits", self.0) }
    }
}

/// A bit vector of 1 to 64 bits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Bits {
    width: Width,
    value: u64,
}

impl Bits {
    /// The low bits of `value`; what does not fit is cut off.
    #[inline]
    #[must_use]
    pub fn truncated(width: Width, value: u64) -> Bits {
        Bits { width, value: value & width.mask() }
    }

    /// `value` as unsigned or two's-complement number, or `None` where it does not fit.
    #[must_use]
    pub fn exact(width: Width, value: i128, signed: bool) -> Option<Bits> {
        let (least, greatest) = width.range(signed);
        // The low 64 bits of the two's complement are the value's bits, for either sign.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let low = value as u64;
        (least..=greatest).contains(&value).then(|| Bits::truncated(width, low))
    }

    /// The width.
    #[must_use]
    pub fn width(self) -> Width {
        self.width
    }

    /// The bits as an unsigned number.
    #[inline]
    #[must_use]
    pub fn value(self) -> u64 {
        self.value
    }

    /// The bits as a number, in two's complement if `signed`.
    #[must_use]
    pub fn number(self, signed: bool) -> i128 {
        number(self.width, self.value, signed)
    }
}

/// Binary, most significant bit first, in full width: `0110`.
impl fmt::Display for Bits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:0width$b}", self.value, width = self.width.get() as usize)
    }
}

/// The number that the bits mean, in two's complement if `signed`.
#[must_use]
pub fn number(width: Width, value: u64, signed: bool) -> i128 {
    if signed { i128::from(to_signed(width, value)) } else { i128::from(value) }
}

/// Two's-complement reading of a value of this width.
#[inline]
#[must_use]
pub fn to_signed(width: Width, value: u64) -> i64 {
    let unused = 64 - width.get();
    (value << unused).cast_signed() >> unused
}

/// Sum modulo 2^width.
#[inline]
#[must_use]
pub fn add(width: Width, a: u64, b: u64) -> u64 {
    a.wrapping_add(b) & width.mask()
}

/// Difference modulo 2^width.
#[inline]
#[must_use]
pub fn sub(width: Width, a: u64, b: u64) -> u64 {
    a.wrapping_sub(b) & width.mask()
}

/// Carry out of the most significant bit of `a + b`.
#[inline]
#[must_use]
pub fn carry(width: Width, a: u64, b: u64) -> bool {
    // In 64 bits the carry shows as a sum below an operand, in fewer as a bit above the width; this is both.
    add(width, a, b) < a
}

/// Borrow of `a - b`, that is `a < b` unsigned.
#[inline]
#[must_use]
pub fn borrow(a: u64, b: u64) -> bool {
    a < b
}

/// `a + b` in two's complement leaves the range of the width.
#[inline]
#[must_use]
pub fn add_overflow(width: Width, a: u64, b: u64) -> bool {
    let sum = add(width, a, b);
    (a ^ sum) & (b ^ sum) & width.sign_bit() != 0
}

/// `a - b` in two's complement leaves the range of the width.
#[inline]
#[must_use]
pub fn sub_overflow(width: Width, a: u64, b: u64) -> bool {
    let difference = sub(width, a, b);
    (a ^ b) & (a ^ difference) & width.sign_bit() != 0
}

/// `a < b` in two's complement.
#[inline]
#[must_use]
pub fn less_signed(width: Width, a: u64, b: u64) -> bool {
    to_signed(width, a) < to_signed(width, b)
}

/// Product modulo 2^width.
#[inline]
#[must_use]
pub fn mul(width: Width, a: u64, b: u64) -> u64 {
    a.wrapping_mul(b) & width.mask()
}

/// Quotient of unsigned numbers, without its fraction; 0 where the divisor is 0.
#[inline]
#[must_use]
pub fn div(a: u64, b: u64) -> u64 {
    a.checked_div(b).unwrap_or(0)
}

/// Remainder of unsigned numbers; 0 where the divisor is 0.
#[inline]
#[must_use]
pub fn rem(a: u64, b: u64) -> u64 {
    a.checked_rem(b).unwrap_or(0)
}

/// `a` shifted left by `by` bits, zeros below; 0 from `by` = width on.
#[inline]
#[must_use]
pub fn shift_left(width: Width, a: u64, by: u64) -> u64 {
    if by < 64 { a << by & width.mask() } else { 0 }
}

/// `a` shifted right by `by` bits, zeros above; 0 from `by` = width on.
#[inline]
#[must_use]
pub fn shift_right(a: u64, by: u64) -> u64 {
    if by < 64 { a >> by } else { 0 }
}

/// `a` shifted right by `by` bits, its sign bit above; all sign bits from `by` = width - 1 on.
#[inline]
#[must_use]
pub fn shift_arithmetic(width: Width, a: u64, by: u64) -> u64 {
    (to_signed(width, a) >> by.min(63)).cast_unsigned() & width.mask()
}

/// `value` of width `from`, its sign bit repeated up to width `to`.
#[inline]
#[must_use]
pub fn sign_extend(from: Width, to: Width, value: u64) -> u64 {
    to_signed(from, value).cast_unsigned() & to.mask()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widths() -> impl Iterator<Item = Width> {
        (1..=4).map(|bits| Width::new(bits).unwrap())
    }

    #[test]
    fn every_operator_agrees_with_exact_integers_for_all_operands_of_up_to_four_bits() {
        for w in widths() {
            let modulus = 1i128 << w.get();
            for a in 0..=w.mask() {
                for b in 0..=w.mask() {
                    let (ua, ub) = (i128::from(a), i128::from(b));
                    let (sa, sb) = (number(w, a, true), number(w, b, true));
                    let (least, greatest) = w.range(true);
                    assert_eq!(i128::from(add(w, a, b)), (ua + ub) % modulus);
                    assert_eq!(i128::from(sub(w, a, b)), (ua - ub).rem_euclid(modulus));
                    assert_eq!(carry(w, a, b), ua + ub >= modulus, "{a} + {b} in {w}");
                    assert_eq!(borrow(a, b), ua < ub);
                    assert_eq!(add_overflow(w, a, b), !(least..=greatest).contains(&(sa + sb)));
                    assert_eq!(sub_overflow(w, a, b), !(least..=greatest).contains(&(sa - sb)));
                    assert_eq!(less_signed(w, a, b), sa < sb);
                    assert_eq!(i128::from(mul(w, a, b)), ua * ub % modulus);
                    assert_eq!(i128::from(div(a, b)), if ub == 0 { 0 } else { ua / ub });
                    assert_eq!(i128::from(rem(a, b)), if ub == 0 { 0 } else { ua % ub });
                    assert_eq!(i128::from(shift_left(w, a, b)), ua * (1 << ub) % modulus);
                    assert_eq!(i128::from(shift_right(a, b)), ua / (1 << ub));
                    assert_eq!(i128::from(shift_arithmetic(w, a, b)), sa.div_euclid(1 << ub).rem_euclid(modulus));
                }
            }
        }
    }

    #[test]
    fn the_operators_hold_at_64_bits() {
        let w = Width::MAX;
        assert!(carry(w, u64::MAX, 1));
        assert!(!carry(w, u64::MAX, 0));
        assert!(add_overflow(w, i64::MAX.cast_unsigned(), 1));
        assert_eq!(add(w, u64::MAX, 2), 1);
        assert_eq!(mul(w, u64::MAX, u64::MAX), 1);
        for by in [64, 65, 127, 128, 1 << 32, u64::MAX] {
            assert_eq!(shift_left(w, u64::MAX, by), 0, "by {by}");
            assert_eq!(shift_right(u64::MAX, by), 0, "by {by}");
            assert_eq!(shift_arithmetic(w, 1 << 63, by), u64::MAX, "by {by}");
            assert_eq!(shift_arithmetic(w, u64::MAX >> 1, by), 0, "by {by}");
        }
        assert_eq!(shift_arithmetic(w, 1 << 63, 62), u64::MAX << 1);
        assert_eq!(number(w, u64::MAX, true), -1);
    }

    #[test]
    fn needed_widths_are_the_least_that_hold_the_number() {
        for value in -70i128..=70 {
            for signed in [false, true] {
                if value < 0 && !signed {
                    continue;
                }
                let bits = u64::from(Width::needed(value, signed));
                let holds = |bits: u64| Width::new(bits).is_ok_and(|w| Bits::exact(w, value, signed).is_some());
                assert!(holds(bits), "{value} in {bits} bits");
                assert!(!holds(bits - 1), "{value} in {} bits", bits - 1);
            }
        }
    }

    #[test]
    fn widths_of_0_and_65_are_refused() {
        assert!(Width::new(0).is_err());
        assert_eq!(
            Width::new(65).unwrap_err().to_string(),
            "a width of 65 bits is not possible: a register holds 1 to 64 bits"
        );
    }

    #[test]
    fn sign_extension_keeps_the_number() {
        for from in widths() {
            for value in 0..=from.mask() {
                let wide = Width::new(7).unwrap();
                assert_eq!(number(wide, sign_extend(from, wide, value), true), number(from, value, true));
            }
        }
    }
}
