//! Text at memory speed: bits and times as ASCII, without a loop over bits and without a division.
//!
//! Everything is stored in whole words over a window of fixed size, of which only the first bytes count: the next text
//! is written over the rest. So there is one check of bounds a line, and none a character.

use fearless_simd::prelude::*;
use fearless_simd::{u8x32, u64x4};

/// Bytes that a line may touch: `b`, 64 digits, and a tail of 8 bytes, after any start.
pub(super) const WINDOW: usize = 144;

/// Bytes that a time may touch: `#`, 24 digits, and a tail of 8 bytes.
const STAMP: usize = 40;

/// Eight bits as eight digits, the highest first.
static OCTETS: [[u8; 8]; 256] = octets();

const fn octets() -> [[u8; 8]; 256] {
    let mut table = [[b'0'; 8]; 256];
    let mut octet = 0;
    while octet < 256 {
        let mut bit = 0;
        while bit < 8 {
            if octet >> (7 - bit) & 1 == 1 {
                table[octet][bit] = b'1';
            }
            bit += 1;
        }
        octet += 1;
    }
    table
}

/// The digits of a value, written into `out`.
#[inline]
pub(crate) fn digits(width: u32, value: u64, out: &mut [u8; 64]) -> &[u8] {
    for (text, octet) in out.chunks_exact_mut(8).zip((value << (64 - width)).to_be_bytes()) {
        text.copy_from_slice(&OCTETS[usize::from(octet)]);
    }
    &out[..width as usize]
}

/// A short text in a word, so that storing it is one instruction.
#[derive(Clone, Copy)]
pub(super) struct Tail {
    bytes: [u8; 8],
    len: usize,
}

impl Tail {
    /// A text of at most 8 bytes; the rest would be lost.
    pub(super) fn new(text: &str) -> Tail {
        assert!(text.len() <= 8, "{text}");
        let mut bytes = [0; 8];
        for (byte, &of) in bytes.iter_mut().zip(text.as_bytes()) {
            *byte = of;
        }
        Tail { bytes, len: text.len().min(8) }
    }

    /// Writes it at the start of `out`; returns its length.
    #[inline]
    pub(super) fn put(self, out: &mut [u8]) -> usize {
        out[..8].copy_from_slice(&self.bytes);
        self.len
    }
}

/// The lines that give one variable its values: `b0101 !` of a vector, `1!` of a scalar.
#[derive(Clone)]
pub(super) struct Line {
    /// Bits to shift a value up, so that its first digit is bit 63.
    shift: u32,
    /// Where the digits begin: after the `b` of a vector.
    digits: usize,
    tail: Tail,
    tail_at: usize,
    /// Bytes of every line.
    len: usize,
}

impl Line {
    pub(super) fn new(width: u32, scalar: bool, id: &str) -> Line {
        let digits = usize::from(!scalar);
        let tail = Tail::new(&if scalar { format!("{id}\n") } else { format!(" {id}\n") });
        let tail_at = digits + width as usize;
        Line { shift: 64 - width, digits, tail, tail_at, len: tail_at + tail.len }
    }

    /// Bytes of every line.
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Writes the line for `value` at the start of `out`.
    #[inline(always)]
    pub(super) fn put<S: Simd>(&self, simd: S, value: u64, out: &mut [u8; WINDOW]) {
        let value = value << self.shift;
        let digits = self.digits & 1;
        out[0] = b'b';
        spread(simd, value, &HIGH_OCTETS).store_slice(&mut out[digits..digits + 32]);
        if self.shift < 32 {
            spread(simd, value, &LOW_OCTETS).store_slice(&mut out[digits + 32..digits + 64]);
        }
        // At most 65; the mask shows it to the compiler.
        let at = self.tail_at & 127;
        out[at..at + 8].copy_from_slice(&self.tail.bytes);
    }
}

/// For each of 32 digits, the first the highest, the byte of a word that it is in: the high half of the word, or the low
/// one.
static HIGH_OCTETS: [u8; 32] = octets_of_digits(7);
static LOW_OCTETS: [u8; 32] = octets_of_digits(3);
/// The bit of that byte.
static BITS: [u8; 32] = bits_of_digits();

const fn octets_of_digits(highest: u8) -> [u8; 32] {
    let mut octets = [highest; 32];
    let mut digit = 8;
    while digit < 32 {
        octets[digit] = octets[digit - 8] - 1;
        digit += 1;
    }
    octets
}

const fn bits_of_digits() -> [u8; 32] {
    let mut bits = [0; 32];
    let mut digit = 0;
    while digit < 32 {
        bits[digit] = 0x80 >> (digit % 8);
        digit += 1;
    }
    bits
}

/// 32 digits of a value.
#[inline(always)]
fn spread<S: Simd>(simd: S, value: u64, octets: &[u8; 32]) -> u8x32<S> {
    let bytes: u8x32<S> = u64x4::splat(simd, value).bitcast();
    let bits = u8x32::from_slice(simd, &BITS);
    let set = (bytes.swizzle_dyn_within_blocks(u8x32::from_slice(simd, octets)) & bits).simd_eq(bits);
    set.select(u8x32::splat(simd, b'1'), u8x32::splat(simd, b'0'))
}

/// A time as decimal digits, one a byte, eight a word, the lowest word first; it is counted up, never divided.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
struct Digits([u64; 3]);

/// What makes a byte carry at ten: 246.
const BIAS: u64 = 0xF6F6_F6F6_F6F6_F6F6;

/// The sum of eight digits each, and the carry.
#[inline]
fn add(a: u64, b: u64, carry: bool) -> (u64, bool) {
    let (sum, first) = (a + BIAS).overflowing_add(b);
    let (sum, second) = sum.overflowing_add(u64::from(carry));
    // A byte that did not carry still has its bias, and so its top bit.
    let kept = sum >> 7 & 0x0101_0101_0101_0101;
    (sum - kept * 0xF6, first | second)
}

impl Digits {
    fn of(mut number: u64) -> Digits {
        let mut words = [0; 3];
        for index in 0..24 {
            words[index / 8] |= (number % 10) << (8 * (index % 8));
            number /= 10;
        }
        Digits(words)
    }
}

/// Time stamps at equal distances: `#5\n`, `#10\n`, …
#[derive(Clone)]
pub(super) struct Stamps {
    now: Digits,
    step: Digits,
    /// `#` and the digits above the lowest eight, if there are any.
    head: [u8; 24],
    head_len: usize,
}

impl Stamps {
    /// Stamps from 0 on, `step` apart.
    pub(super) fn new(step: u64) -> Stamps {
        let mut stamps = Stamps { now: Digits::default(), step: Digits::of(step), head: [b'#'; 24], head_len: 1 };
        stamps.set(0);
        stamps
    }

    /// Goes to a time.
    pub(super) fn set(&mut self, time: u64) {
        self.now = Digits::of(time);
        self.render_head();
    }

    /// Goes one step on.
    #[inline]
    pub(super) fn advance(&mut self) {
        let (low, carry) = add(self.now.0[0], self.step.0[0], false);
        self.now.0[0] = low;
        if carry || (self.step.0[1] | self.step.0[2]) != 0 {
            self.carry(carry);
        }
    }

    #[cold]
    fn carry(&mut self, carry: bool) {
        let (middle, carry) = add(self.now.0[1], self.step.0[1], carry);
        let (high, _) = add(self.now.0[2], self.step.0[2], carry);
        (self.now.0[1], self.now.0[2]) = (middle, high);
        self.render_head();
    }

    fn render_head(&mut self) {
        self.head_len = 1;
        for byte in [self.now.0[2], self.now.0[1]].map(u64::to_be_bytes).as_flattened() {
            if *byte != 0 || self.head_len > 1 {
                self.head[self.head_len] = b'0' + byte;
                self.head_len += 1;
            }
        }
    }

    /// Writes the stamp at the start of `out`, and `tail`, which begins with its newline; returns the length.
    #[inline]
    pub(super) fn put(&self, tail: Tail, out: &mut [u8]) -> usize {
        let out = &mut out[..STAMP];
        out[..24].copy_from_slice(&self.head);
        let low = self.now.0[0];
        let skip = if self.head_len == 1 { (low.leading_zeros() / 8).min(7) } else { 0 };
        let digits = ((low | 0x3030_3030_3030_3030) << (8 * skip)).to_be_bytes();
        out[self.head_len..self.head_len + 8].copy_from_slice(&digits);
        let at = self.head_len + 8 - skip as usize;
        at + tail.put(&mut out[at..])
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Level, dispatch};

    use super::*;

    fn text(len: usize, out: &[u8]) -> &str {
        std::str::from_utf8(&out[..len]).unwrap()
    }

    #[test]
    fn a_line_holds_the_digits_of_every_width_and_the_id() {
        let mut out = [0; WINDOW];
        let mut put = |line: &Line, value| {
            dispatch!(Level::new(), simd => line.put(simd, value, &mut out));
            text(line.len(), &out).to_owned()
        };
        for width in 1..=64 {
            for value in [0, 1, u64::MAX, 0xA5C3_0F96_1234_8001, 0x8000_0000_0000_0000, 1 << (width - 1)] {
                let value = value & (u64::MAX >> (64 - width));
                let line = Line::new(width, false, "!a");
                assert_eq!(put(&line, value), format!("b{value:0width$b} !a\n", width = width as usize));
            }
        }
        let scalar = Line::new(1, true, "~");
        for value in [0, 1] {
            assert_eq!(put(&scalar, value), format!("{value}~\n"));
        }
    }

    #[test]
    fn stamps_count_as_multiplication_does() {
        let mut out = [0; STAMP];
        let tail = Tail::new("\n0!\n");
        for step in [1, 5, 7, 10, 9_999_999, 99_999_999, 100_000_000, 123_456_789_012_345_678] {
            let mut stamps = Stamps::new(step);
            for start in [0, 3, 99_999_990, 9_999_999_999_999_990, 1_234_567_890_123_456_789] {
                stamps.set(start);
                for index in 0..100 {
                    let time = u128::from(start) + index * u128::from(step);
                    let len = stamps.put(tail, &mut out);
                    assert_eq!(text(len, &out), format!("#{time}\n0!\n"), "{start} + {index} * {step}");
                    stamps.advance();
                }
            }
        }
    }
}
