//! One variable of the merged file, followed through time.

use crate::diverge::{Frame, Frames, Walk};
use crate::read::{Signal, Value, ValueKind, extension};
use std::io::{self, Write};
use vcd::IdCode;

/// What a variable shows.
#[derive(Clone, Copy)]
pub(super) enum Source<'w> {
    /// A's clock with its own times, not sampled.
    Clock(&'w Signal),
    /// A signal of A.
    A(&'w Signal),
    /// A signal of B.
    B(&'w Signal),
    /// Where a vector of A and one of B, equally wide, differ.
    Xor(&'w Signal, &'w Signal),
}

impl Source<'_> {
    pub(super) fn kind(self) -> ValueKind {
        match self {
            Source::Clock(signal) | Source::A(signal) | Source::B(signal) => signal.kind,
            Source::Xor(..) => ValueKind::Unsigned,
        }
    }

    pub(super) fn width(self) -> u32 {
        match self {
            Source::Clock(signal) | Source::A(signal) | Source::B(signal) | Source::Xor(signal, _) => signal.width,
        }
    }

    /// Equal for two names of the same changes.
    pub(super) fn key(self) -> (u8, usize, usize) {
        match self {
            Source::Clock(clock) => (0, clock.stored, 0),
            Source::A(a) => (1, a.stored, 0),
            Source::B(b) => (2, b.stored, 0),
            Source::Xor(a, b) => (3, a.stored, b.stored),
        }
    }
}

/// A source with its id code and the place it has got to.
pub(super) struct Track<'f, 'w> {
    /// The id code and the line break after it.
    id: Vec<u8>,
    kind: ValueKind,
    width: u32,
    clock: bool,
    main: Walk<'f, 'w>,
    other: Option<Walk<'f, 'w>>,
    written: Vec<u8>,
    line: Vec<u8>,
}

impl<'f, 'w> Track<'f, 'w> {
    pub(super) fn new(source: Source<'w>, id: IdCode, frames: &'f Frames<'w>, raw: &'f Frame<'w>) -> Self {
        let (main, other) = match source {
            Source::Clock(clock) => (raw.walk(clock), None),
            Source::A(a) => (frames.a.walk(a), None),
            Source::B(b) => (frames.b.walk(b), None),
            Source::Xor(a, b) => (frames.a.walk(a), Some(frames.b.walk(b))),
        };
        let clock = matches!(source, Source::Clock(_));
        let (kind, width) = (source.kind(), source.width());
        let id = format!("{id}\n").into_bytes();
        Self { id, kind, width, clock, main, other, written: Vec::new(), line: Vec::new() }
    }

    /// Whether its positions are times of A.
    pub(super) fn is_clock(&self) -> bool {
        self.clock
    }

    /// The position of the next change of any of its signals.
    pub(super) fn next_change(&mut self) -> Option<i128> {
        let other = self.other.as_mut().and_then(Walk::next_change);
        self.main.next_change().into_iter().chain(other).min()
    }

    /// Moves to a position, not before that of an earlier call, and hands the line of VCD that shows the value there to
    /// `out`, unless it is the last one again or there is no value.
    pub(super) fn write(&mut self, position: i128, out: &mut dyn FnMut(&[u8]) -> io::Result<()>) -> io::Result<()> {
        let value = self.main.value_at(position);
        let other = self.other.as_mut().map(|walk| walk.value_at(position));
        self.line.clear();
        self.format(value, other)?;
        // An event is the same line each time that it happens.
        if self.line == self.written && self.kind != ValueKind::Event {
            return Ok(());
        }
        out(&self.line)?;
        std::mem::swap(&mut self.line, &mut self.written);
        Ok(())
    }

    fn format(&mut self, value: Value<'_>, other: Option<Value<'_>>) -> io::Result<()> {
        let Self { id, width, line, .. } = self;
        match value {
            Value::Unset if !matches!(self.kind, ValueKind::Unsigned | ValueKind::Signed) => Ok(()),
            Value::Unset | Value::Bits(_) => {
                let width = *width;
                if width > 1 {
                    line.push(b'b');
                }
                // Nearly all values are plain numbers; the others are taken bit by bit. Wide vectors are never written
                // whole.
                match (number(value), other.map(|other| (other, number(other)))) {
                    (None, other) if width > WIDE => push_wide(line, value, other.map(|(other, _)| other), width),
                    (Some(a), None) => push_number(line, a, width),
                    (Some(a), Some((_, Some(b)))) => push_number(line, a ^ b, width),
                    (None, None) => line.extend(digits(value, width).map(four_state)),
                    (_, Some((other, _))) => {
                        line.extend(digits(value, width).zip(digits(other, width)).map(exclusive_or))
                    }
                }
                if width > 1 {
                    line.push(b' ');
                }
                line.extend_from_slice(id);
                Ok(())
            }
            Value::Real(real) => {
                write!(line, "r{real:?} ")?;
                line.extend_from_slice(id);
                Ok(())
            }
            Value::Text(text) => {
                line.push(b's');
                for byte in text.bytes() {
                    match byte {
                        b'\\' => line.extend(br"\\"),
                        b'!'..=b'~' | 0x80.. => line.push(byte),
                        _ => write!(line, "\\x{byte:02x}")?,
                    }
                }
                line.push(b' ');
                line.extend_from_slice(id);
                Ok(())
            }
            Value::Count(0) => Ok(()),
            Value::Count(_) => {
                line.push(b'1');
                line.extend_from_slice(id);
                Ok(())
            }
        }
    }
}

/// Vectors wider than this never come as numbers.
const WIDE: u32 = 128;

/// The fewest digits that extend to a wide vector, or to where two of them differ.
fn push_wide(line: &mut Vec<u8>, value: Value<'_>, other: Option<Value<'_>>, width: u32) {
    let shortest = |value| if let Value::Bits(bits) = value { bits.shortest().unwrap_or(b"x") } else { b"x" };
    let a = shortest(value);
    let Some(b) = other.map(shortest) else {
        line.extend(a.iter().map(|digit| four_state(char::from(*digit))));
        return;
    };
    let length = a.len().max(b.len());
    // One digit more represents all those that neither has.
    let from = if length < width as usize { length + 1 } else { length };
    let digit = |digits: &[u8], place: usize| {
        digits
            .len()
            .checked_sub(place)
            .and_then(|at| digits.get(at))
            .map_or(extension(digits), |digit| char::from(*digit))
    };
    line.extend((1..=from).rev().map(|place| exclusive_or((digit(a, place), digit(b, place)))));
}

fn number(value: Value<'_>) -> Option<u128> {
    if let Value::Bits(bits) = value { bits.to_u128() } else { None }
}

fn push_number(line: &mut Vec<u8>, number: u128, width: u32) {
    line.extend((0..width).rev().map(|bit| if number >> bit & 1 == 1 { b'1' } else { b'0' }));
}

/// The digits of a vector; one not yet set is `x` in every bit.
fn digits(value: Value<'_>, width: u32) -> impl Iterator<Item = char> {
    let bits = if let Value::Bits(bits) = value { Some(bits) } else { None };
    let unset = std::iter::repeat_n('x', if bits.is_none() { width as usize } else { 0 });
    bits.into_iter().flat_map(|bits| bits.digits()).chain(unset)
}

/// VHDL's weak states as the states that VCD has.
fn four_state(digit: char) -> u8 {
    match digit {
        '0' | 'l' => b'0',
        '1' | 'h' => b'1',
        'z' => b'z',
        _ => b'x',
    }
}

fn exclusive_or((a, b): (char, char)) -> u8 {
    match (a, b) {
        ('0', '1') | ('1', '0') => b'1',
        _ if a == b => b'0',
        _ => b'x',
    }
}
