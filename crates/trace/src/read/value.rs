//! The value of a signal at one moment: what counts as the same, and how a person reads it.

use std::fmt::{self, Display, Formatter, Write};

/// Vectors wider than this are shown as they are written in Verilog: `300'b1x`, with the fewest digits.
const SHOWN_WHOLE: u32 = 256;

/// The value of a signal at one moment.
///
/// `Display` shows a bit vector as binary digits, most significant first, with its decimal value in parentheses where
/// every bit is 0 or 1 and the width is at most 128 (two's complement for an `integer`); a real as the shortest decimal
/// that reads back the same; a string in quotes.
#[derive(Clone, Copy, Debug)]
pub enum Value<'w> {
    /// Nothing has been written yet. In a bit vector that means `x` in every bit.
    Unset,
    /// A bit vector.
    Bits(Vector<'w>),
    /// A real number.
    Real(f64),
    /// A text.
    Text(&'w str),
    /// How often an event has happened so far.
    Count(usize),
}

impl Value<'_> {
    /// Whether the two are the same value: bit vectors of equal width with the same state in every bit (`x` is only
    /// `x`, `z` only `z`; a vector not yet set is all `x`), reals of equal value (not-a-number is itself), equal
    /// texts.
    #[must_use]
    pub fn same(self, other: Value<'_>) -> bool {
        match (self, other) {
            (Value::Unset, Value::Unset) => true,
            (Value::Unset, Value::Bits(bits)) | (Value::Bits(bits), Value::Unset) => {
                bits.width == 0 || bits.shortest() == Some(b"x")
            }
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
            Value::Bits(bits) if bits.width() > 16 => bits.decimal().unwrap_or_else(|| bits.to_string()),
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
    pub(super) width: u32,
    pub(super) signed: bool,
    pub(super) content: Content<'w>,
}

/// What a vector holds. Equal vectors of one width have equal content: digits are used only where a number cannot be,
/// and are the fewest that extend to the value, in lower case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content<'w> {
    Number(u128),
    Digits(&'w [u8]),
}

impl<'w> Vector<'w> {
    /// Number of bits.
    #[must_use]
    pub fn width(self) -> u32 {
        self.width
    }

    /// The bits as lower-case characters, most significant first: `0 1 x z`, and `h u w l -` from VHDL.
    pub fn digits(self) -> impl Iterator<Item = char> + use<'w> {
        let Self { width, content, .. } = self;
        let (number, written) = match content {
            Content::Number(number) => (Some(number), &[] as &[u8]),
            Content::Digits(digits) => (None, digits),
        };
        let bit = move |bit: u32| number.map(|number| if number >> bit & 1 == 1 { '1' } else { '0' });
        let numbers = (0..if number.is_some() { width } else { 0 }).rev().filter_map(bit);
        let left = if number.is_some() { 0 } else { (width as usize).saturating_sub(written.len()) };
        numbers
            .chain(std::iter::repeat_n(extension(written), left))
            .chain(written.iter().map(|digit| char::from(*digit)))
    }

    /// The fewest digits that extend to the value, of a vector that is not a number.
    pub(crate) fn shortest(self) -> Option<&'w [u8]> {
        if let Content::Digits(digits) = self.content { Some(digits) } else { None }
    }

    /// The bits as a number without a sign, if every bit is 0 or 1 and there are at most 128.
    #[must_use]
    pub fn to_u128(self) -> Option<u128> {
        if let Content::Number(number) = self.content { Some(number) } else { None }
    }

    /// The number in decimal, two's complement if the variable is an `integer`; under the conditions of
    /// [`to_u128`](Self::to_u128).
    #[must_use]
    pub fn decimal(self) -> Option<String> {
        self.decimal_as(self.signed)
    }

    /// The number in decimal, in two's complement or not, however the variable is declared; under the conditions of
    /// [`to_u128`](Self::to_u128).
    #[must_use]
    pub fn decimal_as(self, signed: bool) -> Option<String> {
        let number = self.to_u128().filter(|_| self.width > 0)?;
        let unused = 128 - self.width;
        Some(if signed { ((number << unused).cast_signed() >> unused).to_string() } else { number.to_string() })
    }

    fn same(self, other: Vector<'_>) -> bool {
        self.width == other.width && self.content == other.content
    }
}

/// The digit that extends a value with fewer digits than bits.
pub(crate) fn extension(digits: &[u8]) -> char {
    match digits.first() {
        Some(b'x') => 'x',
        Some(b'z') => 'z',
        _ => '0',
    }
}

impl Display for Vector<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(digits) = self.shortest().filter(|_| self.width > SHOWN_WHOLE) {
            return write!(f, "{}'b{}", self.width, String::from_utf8_lossy(digits));
        }
        self.digits().try_for_each(|digit| f.write_char(digit))?;
        // One bit is its own decimal.
        match self.decimal() {
            Some(number) if self.width > 1 => write!(f, " ({number})"),
            _ => Ok(()),
        }
    }
}
