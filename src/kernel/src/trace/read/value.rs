//! The value of a signal at one moment: what counts as the same, and how a person reads it.

use std::fmt::{self, Display, Formatter, Write};
use wellen::{BitVecRef, SignalValueRef};

/// The value of a signal at one moment.
///
/// `Display` shows a bit vector as binary digits, most significant first, with its decimal value in parentheses where
/// every bit is 0 or 1 and the width is at most 128 (two's complement for an `integer`); a real as the shortest decimal
/// that reads back the same; a string in quotes.
#[derive(Clone, Copy, Debug)]
pub enum Value<'w> {
    /// Nothing has been written yet. In a bit vector that means `x` in every bit.
    Unset,
    /// A bit vector of at least one bit.
    Bits(Vector<'w>),
    /// A real number.
    Real(f64),
    /// A text.
    Text(&'w str),
    /// How often an event has happened so far.
    Count(usize),
}

impl<'w> Value<'w> {
    pub(super) fn new(raw: SignalValueRef<'w>, signed: bool, change: usize) -> Self {
        match raw {
            SignalValueRef::Event => Value::Count(change + 1),
            SignalValueRef::BitVec(bits) => Value::Bits(Vector { bits, signed }),
            SignalValueRef::String(text) => Value::Text(text),
            SignalValueRef::Real(real) => Value::Real(real),
        }
    }

    /// Whether the two are the same value: bit vectors of equal width with the same state in every bit (`x` is only
    /// `x`, `z` only `z`; a vector not yet set is all `x`), reals of equal value (not-a-number is itself), equal
    /// texts.
    #[must_use]
    pub fn same(self, other: Value<'_>) -> bool {
        match (self, other) {
            (Value::Unset, Value::Unset) => true,
            (Value::Unset, Value::Bits(bits)) | (Value::Bits(bits), Value::Unset) => bits.digits().all(|d| d == 'x'),
            (Value::Bits(a), Value::Bits(b)) => a.same(b),
            (Value::Real(a), Value::Real(b)) => a == b || (a.is_nan() && b.is_nan()),
            (Value::Text(a), Value::Text(b)) => a == b,
            (Value::Count(a), Value::Count(b)) => a == b,
            _ => false,
        }
    }

    /// The value in few columns, for a table: a bit vector of up to 16 bits in binary, a wider one in decimal where
    /// that exists.
    #[must_use]
    pub fn cell(self) -> String {
        match self {
            Value::Unset => "x".into(),
            Value::Bits(bits) if bits.width() > 16 => bits.decimal().unwrap_or_else(|| bits.digits().collect()),
            Value::Bits(bits) => bits.digits().collect(),
            other => other.to_string(),
        }
    }
}

impl Display for Value<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Value::Unset => f.write_str("no value yet"),
            Value::Bits(bits) => bits.fmt(f),
            Value::Real(real) => real.fmt(f),
            Value::Text(text) => write!(f, "\"{}\"", text.escape_debug()),
            Value::Count(count) => write!(f, "event no. {count}"),
        }
    }
}

/// A bit vector whose bits may also be `x`, `z` or one of VHDL's other states.
#[derive(Clone, Copy, Debug)]
pub struct Vector<'w> {
    bits: BitVecRef<'w>,
    signed: bool,
}

impl<'w> Vector<'w> {
    /// Number of bits, at least 1.
    #[must_use]
    pub fn width(self) -> u32 {
        self.bits.width()
    }

    /// The bits as lower-case characters, most significant first: `0 1 x z`, and `h u w l -` from VHDL.
    pub fn digits(self) -> impl Iterator<Item = char> + use<'w> {
        let Self { bits, .. } = self;
        (0..bits.width()).rev().map(move |bit| bits.get_bit(bit).as_ascii())
    }

    /// The bits as a number without a sign, if every bit is 0 or 1 and there are at most 128.
    #[must_use]
    pub fn to_u128(self) -> Option<u128> {
        let bytes = self.bits.be_bytes().filter(|_| self.width() <= 128)?;
        Some(bytes.iter().fold(0, |number, byte| number << 8 | u128::from(*byte)))
    }

    /// The number in decimal, two's complement if the variable is an `integer`; under the conditions of
    /// [`to_u128`](Self::to_u128).
    #[must_use]
    pub fn decimal(self) -> Option<String> {
        let number = self.to_u128()?;
        let unused = 128 - self.width();
        Some(if self.signed { ((number << unused).cast_signed() >> unused).to_string() } else { number.to_string() })
    }

    // Not `BitVecRef`'s own comparison: its bytes carry state tags in unused bits when a vector also has x or z values.
    fn same(self, other: Vector<'_>) -> bool {
        match (self.bits.be_bytes(), other.bits.be_bytes()) {
            _ if self.width() != other.width() => false,
            (Some(a), Some(b)) => a == b,
            _ => self.digits().eq(other.digits()),
        }
    }
}

impl Display for Vector<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.digits().try_for_each(|digit| f.write_char(digit))?;
        // One bit is its own decimal.
        match self.decimal() {
            Some(number) if self.width() > 1 => write!(f, " ({number})"),
            _ => Ok(()),
        }
    }
}
