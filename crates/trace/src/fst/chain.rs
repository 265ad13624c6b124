//! The changes of one signal in a section: each a step in the time table and the new value, packed as they come.

use super::lz4::{Packed, Packer};
use crate::numbers;

/// Bytes that the changes of 64 samples may touch, if a value has at most 64 bits: 13 bytes each, after any start.
const SPAN_BYTES: usize = 1024;
const WINDOW: usize = SPAN_BYTES + 16;
/// Bytes that the step of a change may take.
const STEP_BYTES: usize = 8;
/// Bytes of the first room for changes: most signals hardly ever change.
const FIRST_ROOM: usize = 2 * WINDOW;
/// Changes shorter than this, in bytes, are not worth packing.
const SHORT: usize = 32;

/// The changes of a signal.
pub(super) struct Chain {
    width: u32,
    /// Index in the time table of the last change.
    last: u32,
    /// Changes that wait to be packed, and room for more.
    raw: Vec<u8>,
    filled: usize,
    packed: Packed,
    /// Bytes of all changes.
    length: usize,
}

/// What packs the changes of all signals.
pub(super) struct Press {
    packer: Packer,
    /// Bytes that are packed together.
    piece: usize,
}

impl Press {
    /// Packs the changes of a signal when there are `piece` bytes of them.
    pub(super) fn new(piece: usize) -> Press {
        Press { packer: Packer::new(), piece: piece.max(FIRST_ROOM) }
    }
}

impl Chain {
    /// Of a signal of `width` bits.
    pub(super) fn new(width: u32) -> Chain {
        Chain { width, last: 0, raw: Vec::new(), filled: 0, packed: Packed::default(), length: 0 }
    }

    /// Bits of the signal.
    pub(super) fn width(&self) -> u32 {
        self.width
    }

    /// Bytes of all changes.
    pub(super) fn length(&self) -> usize {
        self.length
    }

    /// Takes the changes of a signal of at most 64 bits in up to 64 samples: those that have a bit in `changes`.
    /// `index` gives the place of a sample in the time table.
    #[inline]
    pub(super) fn span(&mut self, values: &[u64], changes: u64, index: impl Fn(u32) -> u32, press: &mut Press) {
        let (width, last) = (self.width, self.last);
        let window = self.room(WINDOW, press).first_chunk_mut().expect("the room that was asked for");
        let (written, last) = if width == 1 {
            bits(values, changes, index, last, window)
        } else {
            words(values, changes, index, last, width, window)
        };
        self.last = last;
        self.filled += written;
        self.length += written;
    }

    /// Takes the edges of a clock that rises and falls in each of up to 64 samples; `index` is the place of the first
    /// edge in the time table, in which the others follow.
    pub(super) fn clock(&mut self, samples: u32, index: u32, press: &mut Press) {
        let (step, bytes) = numbers::packed(u64::from(index - self.last) << 2 | 0b10);
        let edges = 2 * samples;
        let length = bytes + edges as usize - 1;
        let room = self.room(WINDOW, press);
        room[..8].copy_from_slice(&step.to_le_bytes());
        for edges in room[bytes..length + 1].chunks_exact_mut(2) {
            edges.copy_from_slice(&[0b100, 0b110]);
        }
        self.last = index + edges - 1;
        self.filled += length;
        self.length += length;
    }

    /// Takes a change of a signal of any width: its value as words, the lowest first.
    pub(super) fn change(&mut self, value: impl DoubleEndedIterator<Item = u64>, index: u32, press: &mut Press) {
        let bytes = self.width.div_ceil(8) as usize;
        let step = u64::from(index - self.last) << 1;
        let shift = self.width.next_multiple_of(8) - self.width;
        let room = self.room(bytes + STEP_BYTES, press);
        let (word, length) = numbers::packed(step);
        room[..8].copy_from_slice(&word.to_le_bytes());
        let mut below = 0;
        // The bits begin at the highest of the first byte.
        for (word, out) in value.zip(room[length..length + bytes].rchunks_mut(8)) {
            let shifted = word << shift | below;
            below = word.checked_shr(64 - shift).unwrap_or(0);
            out.copy_from_slice(&shifted.to_be_bytes()[8 - out.len()..]);
        }
        self.last = index;
        self.filled += length + bytes;
        self.length += length + bytes;
    }

    /// Room for more bytes.
    #[inline]
    fn room(&mut self, bytes: usize, press: &mut Press) -> &mut [u8] {
        if self.filled + bytes > self.raw.len() {
            self.make_room(bytes, press);
        }
        &mut self.raw[self.filled..]
    }

    #[cold]
    fn make_room(&mut self, bytes: usize, press: &mut Press) {
        if self.raw.len() >= press.piece {
            press.packer.pack(&self.raw[..self.filled], &mut self.packed);
            self.filled = 0;
        }
        let wanted = (2 * self.raw.len()).clamp(FIRST_ROOM, press.piece);
        self.raw.resize(wanted.max(self.filled + bytes), 0);
    }

    /// Appends what a section holds of the changes.
    pub(super) fn end(&mut self, press: &mut Press, out: &mut Vec<u8>) {
        let raw = &self.raw[..self.filled];
        if self.length < SHORT {
            out.push(0);
            out.extend_from_slice(raw);
        } else {
            press.packer.pack(raw, &mut self.packed);
            numbers::push(if self.packed.end() { self.length as u64 } else { 0 }, out);
            out.extend_from_slice(self.packed.bytes());
        }
        self.packed.clear();
        (self.last, self.filled, self.length) = (0, 0, 0);
    }
}

/// Changes of one bit: the step and the bit in one number.
#[inline]
fn bits(
    values: &[u64],
    mut changes: u64,
    index: impl Fn(u32) -> u32,
    mut last: u32,
    out: &mut [u8; WINDOW],
) -> (usize, u32) {
    let mut at = 0;
    while changes != 0 {
        let sample = changes.trailing_zeros();
        changes &= changes - 1;
        let now = index(sample);
        let (word, bytes) = numbers::packed(u64::from(now - last) << 2 | values[sample as usize] << 1);
        put(word, at, out);
        at += bytes;
        last = now;
    }
    (at, last)
}

/// Changes of 2 to 64 bits: the step, and a value whose bits begin at the highest of its first byte.
#[inline]
fn words(
    values: &[u64],
    mut changes: u64,
    index: impl Fn(u32) -> u32,
    mut last: u32,
    width: u32,
    out: &mut [u8; WINDOW],
) -> (usize, u32) {
    let (bytes, shift) = (width.div_ceil(8) as usize, 64 - width);
    let mut at = 0;
    while changes != 0 {
        let sample = changes.trailing_zeros();
        changes &= changes - 1;
        let now = index(sample);
        let (step, step_bytes) = numbers::packed(u64::from(now - last) << 1);
        put(step, at, out);
        at += step_bytes;
        put((values[sample as usize] << shift).swap_bytes(), at, out);
        at += bytes;
        last = now;
    }
    (at, last)
}

/// Stores eight bytes, the lowest first. The mask shows the compiler that they fit.
#[inline]
fn put(word: u64, at: usize, out: &mut [u8; WINDOW]) {
    let at = at & (SPAN_BYTES - 1);
    out[at..at + 8].copy_from_slice(&word.to_le_bytes());
}
