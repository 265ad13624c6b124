//! What number the bits of a net mean.

use super::{Bits, Width, number};

/// How the bits of a net are read as a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Reading {
    /// Unsigned.
    Unsigned,
    /// Two's complement.
    Signed,
    /// Binary-coded decimal: a digit in every 4 bits, the lowest digit in the lowest.
    Decimal,
}

impl Reading {
    /// Negative numbers have bits too.
    #[must_use]
    pub fn is_signed(self) -> bool {
        self == Reading::Signed
    }

    /// The number that the bits mean. A group of 4 bits beyond 9 counts as what it holds.
    #[must_use]
    pub fn number(self, width: Width, bits: u64) -> i128 {
        match self {
            Reading::Decimal => {
                let digits = (0..width.get().div_ceil(4)).rev().map(|digit| i128::from(bits >> (4 * digit) & 15));
                digits.fold(0, |number, digit| 10 * number + digit)
            }
            _ => number(width, bits, self.is_signed()),
        }
    }

    /// The bits that mean this number, or `None` where it does not fit.
    #[must_use]
    pub fn bits(self, width: Width, number: i128) -> Option<Bits> {
        if self != Reading::Decimal {
            return Bits::exact(width, number, self.is_signed());
        }
        let (mut rest, mut bits) = (u64::try_from(number).ok()?, 0);
        for digit in 0..width.get() / 4 {
            bits |= (rest % 10) << (4 * digit);
            rest /= 10;
        }
        (rest == 0).then(|| Bits::truncated(width, bits))
    }

    /// The bits that a register takes of a number that does not fit: its lowest bits, or of a decimal register its lowest
    /// digits. A negative number is in two's complement, or in ten's complement.
    #[must_use]
    pub fn wrapped(self, width: Width, number: i128) -> Bits {
        if self == Reading::Decimal {
            let rest = number.rem_euclid(10_i128.pow(width.get() / 4));
            return self.bits(width, rest).unwrap_or(Bits::truncated(width, 0));
        }
        // The lowest 64 bits, of which the width takes its own.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the lowest bits are meant")]
        let lowest = number as u64;
        Bits::truncated(width, lowest)
    }

    /// The bits of the number nearest to this one that fits.
    #[must_use]
    pub fn saturated(self, width: Width, number: i128) -> Bits {
        let (least, greatest) = match self {
            Reading::Decimal => (0, 10_i128.pow(width.get() / 4) - 1),
            _ => width.range(self.is_signed()),
        };
        self.bits(width, number.clamp(least, greatest)).unwrap_or(Bits::truncated(width, 0))
    }

    /// Bits that a number needs; a negative one needs a sign in any case, a decimal one whole digits.
    #[must_use]
    pub fn needed(self, number: i128) -> u32 {
        match (self, u128::try_from(number)) {
            (Reading::Decimal, Ok(number)) => 4 * (number.checked_ilog10().unwrap_or(0) + 1),
            _ => Width::needed(number, self.is_signed()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn width(bits: u64) -> Width {
        Width::new(bits).unwrap()
    }

    #[test]
    fn decimal_numbers_have_a_digit_in_every_four_bits() {
        let decimal = Reading::Decimal;
        for value in 0..1000u32 {
            let bits = decimal.bits(width(12), i128::from(value)).unwrap().value();
            assert_eq!(format!("{bits:03x}"), format!("{value:03}"));
            assert_eq!(decimal.number(width(12), bits), i128::from(value));
            assert_eq!(decimal.needed(i128::from(value)), 4 * u32::try_from(value.to_string().len()).unwrap());
        }
        for beyond in [-1, 1000, i128::MAX] {
            assert_eq!(decimal.bits(width(12), beyond), None);
        }
        // Sixteen digits fill the widest register.
        let greatest = 9_999_999_999_999_999;
        assert_eq!(decimal.number(Width::MAX, decimal.bits(Width::MAX, greatest).unwrap().value()), greatest);
        assert_eq!(decimal.bits(Width::MAX, greatest + 1), None);
    }

    #[test]
    fn what_does_not_fit_is_cut_to_the_lowest_bits_or_digits_or_held_at_an_end() {
        let number = |reading: Reading, bits: Bits| reading.number(bits.width(), bits.value());
        for (reading, bits, given, wrapped, saturated) in [
            (Reading::Unsigned, 8, 300, 44, 255),
            (Reading::Unsigned, 8, -1, 255, 0),
            (Reading::Signed, 7, 100, -28, 63),
            (Reading::Signed, 7, -65, 63, -64),
            (Reading::Signed, 7, -64, -64, -64),
            (Reading::Decimal, 8, 123, 23, 99),
            (Reading::Decimal, 8, -1, 99, 0),
            (Reading::Unsigned, 64, i128::from(u64::MAX) + 6, 5, i128::from(u64::MAX)),
        ] {
            assert_eq!(number(reading, reading.wrapped(width(bits), given)), wrapped, "{reading:?} {given}");
            assert_eq!(number(reading, reading.saturated(width(bits), given)), saturated, "{reading:?} {given}");
        }
    }

    #[test]
    fn binary_readings_are_those_of_the_widths() {
        for reading in [Reading::Unsigned, Reading::Signed] {
            for value in -20..20 {
                let bits = reading.bits(width(4), value);
                assert_eq!(bits, Bits::exact(width(4), value, reading.is_signed()));
                assert!(bits.is_none_or(|bits| reading.number(width(4), bits.value()) == value));
                assert_eq!(reading.needed(value), Width::needed(value, reading.is_signed()));
            }
        }
    }
}
