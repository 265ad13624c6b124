//! The changes of one signal in memory. Their size follows the size of what was written, not the declared width: a
//! vector up to [`PACKED`] bits wide takes its bytes, a wider one the digits that were written.

use super::ValueKind;
use super::value::{Content, Value, Vector};

/// The widest vector whose values are kept as numbers, in bits.
pub(super) const PACKED: u32 = 128;

/// The changes of one signal: their time indices, not decreasing, and the value after each.
#[derive(Debug)]
pub(crate) struct Changes {
    times: Vec<u32>,
    values: Values,
}

#[derive(Debug)]
enum Values {
    Events,
    Reals(Vec<f64>),
    Texts(Written),
    /// Numbers in `width.div_ceil(8)` bytes each, the least significant first. A change with other digits than 0 and 1
    /// has a 0 there, its number in `odd` and its digits in `digits`.
    Packed {
        width: u32,
        numbers: Vec<u8>,
        odd: Vec<u32>,
        digits: Written,
    },
    Wide {
        width: u32,
        digits: Written,
    },
}

/// Byte strings one after the other.
#[derive(Debug, Default)]
struct Written {
    ends: Vec<usize>,
    bytes: Vec<u8>,
}

impl Written {
    fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
        self.ends.push(self.bytes.len());
    }

    fn get(&self, index: usize) -> &[u8] {
        let start = index.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        self.ends.get(index).and_then(|end| self.bytes.get(start..*end)).unwrap_or_default()
    }
}

/// Why a value does not fit a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Misfit {
    /// A character that is not a state of a bit.
    Digit(u8),
    /// No digit at all.
    Empty,
    /// More significant digits than bits.
    TooLong,
    /// Fewer digits than bits, and the first is one that no rule extends.
    NotExtended(u8),
    /// A real for a vector, and the like.
    Kind,
}

impl Changes {
    /// None yet; of a vector with this width, or of another kind.
    pub(super) fn new(kind: ValueKind, width: u32) -> Self {
        let values = match kind {
            ValueKind::Event => Values::Events,
            ValueKind::Real => Values::Reals(Vec::new()),
            ValueKind::Text => Values::Texts(Written::default()),
            _ if width <= PACKED => {
                Values::Packed { width, numbers: Vec::new(), odd: Vec::new(), digits: Written::default() }
            }
            _ => Values::Wide { width, digits: Written::default() },
        };
        Self { times: Vec::new(), values }
    }

    /// The kind, a vector as unsigned, and the width of a vector.
    pub(super) fn kind(&self) -> (ValueKind, u32) {
        match self.values {
            Values::Events => (ValueKind::Event, 0),
            Values::Reals(_) => (ValueKind::Real, 64),
            Values::Texts(_) => (ValueKind::Text, 0),
            Values::Packed { width, .. } | Values::Wide { width, .. } => (ValueKind::Unsigned, width),
        }
    }

    /// The kind is another one after all; nothing may be stored yet.
    pub(super) fn becomes(&mut self, kind: ValueKind) {
        assert!(self.times.is_empty());
        *self = Self::new(kind, self.kind().1);
    }

    pub(crate) fn times(&self) -> &[u32] {
        &self.times
    }

    /// The bytes that they take.
    pub(super) fn size(&self) -> u64 {
        let written = |written: &Written| written.bytes.len() + written.ends.len() * size_of::<usize>();
        let values = match &self.values {
            Values::Events => 0,
            Values::Reals(reals) => reals.len() * size_of::<f64>(),
            Values::Packed { numbers, odd, digits, .. } => {
                numbers.len() + odd.len() * size_of::<u32>() + written(digits)
            }
            Values::Texts(digits) | Values::Wide { digits, .. } => written(digits),
        };
        (self.times.len() * size_of::<u32>() + values) as u64
    }

    /// The value after the change with this number.
    pub(super) fn value(&self, change: usize, signed: bool) -> Value<'_> {
        match &self.values {
            Values::Events => Value::Count(change + 1),
            Values::Reals(reals) => reals.get(change).map_or(Value::Unset, |real| Value::Real(*real)),
            Values::Texts(texts) => Value::Text(std::str::from_utf8(texts.get(change)).unwrap_or_default()),
            Values::Packed { width, numbers, odd, digits } => {
                let content = match u32::try_from(change).ok().and_then(|change| odd.binary_search(&change).ok()) {
                    Some(place) => Content::Digits(digits.get(place)),
                    None => Content::Number(unpack(numbers, *width, change)),
                };
                Value::Bits(Vector { width: *width, signed, content })
            }
            Values::Wide { width, digits } => {
                Value::Bits(Vector { width: *width, signed, content: Content::Digits(digits.get(change)) })
            }
        }
    }

    /// An event happens.
    pub(super) fn event(&mut self, time: u32) -> Result<(), Misfit> {
        match self.values {
            Values::Events => self.times.push(time),
            _ => return Err(Misfit::Kind),
        }
        Ok(())
    }

    /// A real number; one equal to the last is not a change.
    pub(super) fn real(&mut self, time: u32, real: f64) -> Result<(), Misfit> {
        let Values::Reals(reals) = &mut self.values else { return Err(Misfit::Kind) };
        if reals.last().is_none_or(|last| last.to_bits() != real.to_bits()) {
            reals.push(real);
            self.times.push(time);
        }
        Ok(())
    }

    /// A text; one equal to the last is not a change.
    pub(super) fn text(&mut self, time: u32, text: &str) -> Result<(), Misfit> {
        let Values::Texts(texts) = &mut self.values else { return Err(Misfit::Kind) };
        if self.times.is_empty() || texts.get(self.times.len() - 1) != text.as_bytes() {
            texts.push(text.as_bytes());
            self.times.push(time);
        }
        Ok(())
    }

    /// The digits of a vector, the most significant first; equal to the last ones they are not a change.
    pub(super) fn bits(&mut self, time: u32, written: &[u8]) -> Result<(), Misfit> {
        let (ValueKind::Unsigned, width) = self.kind() else { return Err(Misfit::Kind) };
        let mut lower = Vec::new();
        let digits = shortest(written, width, &mut lower)?;
        let last = self.times.len().checked_sub(1).map(|last| self.value(last, false));
        let content = match number(digits).filter(|_| width <= PACKED) {
            Some(number) => Content::Number(number),
            None => Content::Digits(digits),
        };
        if last.is_some_and(|last| matches!(last, Value::Bits(last) if last.content == content)) {
            return Ok(());
        }
        match (&mut self.values, content) {
            (Values::Packed { numbers, width, .. }, Content::Number(number)) => pack(numbers, *width, number),
            (Values::Packed { numbers, width, odd, digits }, Content::Digits(written)) => {
                pack(numbers, *width, 0);
                odd.push(u32::try_from(self.times.len()).unwrap_or(u32::MAX));
                digits.push(written);
            }
            (Values::Wide { digits, .. }, Content::Digits(written)) => digits.push(written),
            _ => return Err(Misfit::Kind),
        }
        self.times.push(time);
        Ok(())
    }
}

fn pack(numbers: &mut Vec<u8>, width: u32, number: u128) {
    let bytes = number.to_le_bytes();
    numbers.extend_from_slice(&bytes[..(width.div_ceil(8) as usize).min(bytes.len())]);
}

fn unpack(numbers: &[u8], width: u32, change: usize) -> u128 {
    let stride = width.div_ceil(8) as usize;
    let bytes = numbers.get(change * stride..(change + 1) * stride).unwrap_or_default();
    bytes.iter().rev().fold(0, |number, byte| number << 8 | u128::from(*byte))
}

/// The number that digits 0 and 1 make, up to 128 of them.
fn number(digits: &[u8]) -> Option<u128> {
    let plain = digits.len() <= 128 && digits.iter().all(|digit| matches!(digit, b'0' | b'1'));
    plain.then(|| digits.iter().fold(0, |number, digit| number << 1 | u128::from(digit & 1)))
}

/// The fewest digits, in lower case, that the rules of VCD extend to the value: a leading 0 or 1 by zeros, `x` by `x`,
/// `z` by `z`. Equal values have equal shortest digits. More digits than bits are read if those in excess say nothing.
fn shortest<'d>(written: &'d [u8], width: u32, lower: &'d mut Vec<u8>) -> Result<&'d [u8], Misfit> {
    // Some writers prefix every vector of several bits by `0b`.
    let written = if width > 1 { written.strip_prefix(b"0b").unwrap_or(written) } else { written };
    let first = match written.first() {
        Some(first) => *first,
        None if width == 0 => return Ok(b"0"),
        None => return Err(Misfit::Empty),
    };
    let digits = if written.iter().all(|digit| matches!(digit, b'0' | b'1')) {
        let zeros = written.iter().take_while(|digit| **digit == b'0').count();
        &written[zeros.min(written.len() - 1)..]
    } else {
        lower.extend(written.iter().map(u8::to_ascii_lowercase));
        if let Some(other) = lower.iter().find(|digit| !b"01xzhuwl-".contains(digit)) {
            return Err(Misfit::Digit(*other));
        }
        let says_nothing = |pair: &[u8]| matches!(pair, [b'x', b'x'] | [b'z', b'z'] | [b'0', b'0' | b'1']);
        let spare = lower.windows(2).take_while(|pair| says_nothing(pair)).count();
        &lower[spare..]
    };
    let extended = || matches!(first, b'0' | b'1' | b'x' | b'X' | b'z' | b'Z');
    match digits.len() as u64 {
        // A vector without bits can only be zero.
        1 if width == 0 && digits == b"0" => Ok(digits),
        length if length > width.into() => Err(Misfit::TooLong),
        _ if written.len() < width as usize && !extended() => Err(Misfit::NotExtended(first)),
        _ => Ok(digits),
    }
}

#[cfg(test)]
mod tests {
    use super::{Changes, Misfit, ValueKind};

    fn read(width: u32, written: &str) -> Result<String, Misfit> {
        let mut changes = Changes::new(ValueKind::Unsigned, width);
        changes.bits(0, written.as_bytes())?;
        Ok(changes.value(0, false).cell())
    }

    #[test]
    fn a_vector_reads_as_the_rules_extend_it_or_not_at_all() {
        for (width, written, value) in [
            (4, "1", "0001"),
            (4, "X", "xxxx"),
            (4, "z1", "zzz1"),
            (4, "0x1", "00x1"),
            (4, "x01", "xx01"),
            (4, "00001", "0001"),
            (4, "xxxxx", "xxxx"),
            (4, "0b101", "0101"),
            (4, "uuuu", "uuuu"),
            (1, "-", "-"),
            (0, "", ""),
            (0, "0", ""),
        ] {
            assert_eq!(read(width, written).as_deref(), Ok(value), "{width} bits: {written}");
        }
        for (width, written, misfit) in [
            (4, "10000", Misfit::TooLong),
            (4, "1xxxx", Misfit::TooLong),
            (1, "10", Misfit::TooLong),
            (4, "", Misfit::Empty),
            (4, "2", Misfit::Digit(b'2')),
            (4, "u1", Misfit::NotExtended(b'u')),
            (0, "1", Misfit::TooLong),
        ] {
            assert_eq!(read(width, written), Err(misfit), "{width} bits: {written}");
        }
    }

    #[test]
    fn wide_vectors_keep_their_digits_and_narrow_ones_their_numbers() {
        let ones = "1".repeat(128);
        assert_eq!(read(128, &ones).as_deref(), Ok(u128::MAX.to_string().as_str()));
        assert_eq!(read(130, &ones).as_deref(), Ok(format!("00{ones}").as_str()));
        let mut changes = Changes::new(ValueKind::Unsigned, 3);
        for (time, digits) in (0..).zip(["1", "001", "x", "XXX", "11", "0z1", "0"]) {
            changes.bits(time, digits.as_bytes()).expect("a value");
        }
        assert_eq!(changes.times(), [0, 2, 4, 5, 6]);
        let cells: Vec<String> = (0..5).map(|change| changes.value(change, false).cell()).collect();
        assert_eq!(cells, ["001", "xxx", "011", "0z1", "000"]);
    }
}
