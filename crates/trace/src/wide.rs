//! Words of more than 64 bits in a wave: several columns of a row, one variable.

use std::ops::Range;

use super::moves::{Moves, SPAN};
use super::probe::Probe;
use super::vcd::digits;
use stepwave_netlist::Rows;

/// Bits of every column of a word but the highest.
const PART: usize = 64;

/// One of the words.
struct Word<I> {
    /// What the writer knows it by.
    id: I,
    width: usize,
    /// The lowest 64 bits first.
    columns: Vec<usize>,
    /// The first of them among those of all words.
    first: usize,
}

/// Some words, and their changes in up to [`SPAN`] samples.
pub(super) struct Wide<I> {
    words: Vec<Word<I>>,
    moves: Moves,
}

impl<I: Copy> Wide<I> {
    /// Of these signals.
    pub(super) fn new(probes: Vec<(&Probe, I)>) -> Wide<I> {
        let mut first = 0;
        let mut words = Vec::with_capacity(probes.len());
        for (probe, id) in probes {
            words.push(Word { id, width: probe.width as usize, columns: probe.columns.clone(), first });
            first += probe.columns.len();
        }
        let columns = words.iter().flat_map(|word| word.columns.iter().copied()).collect();
        Wide { words, moves: Moves::new(columns) }
    }

    /// Each word with its number of bits.
    pub(super) fn words(&self) -> impl ExactSizeIterator<Item = (I, usize)> + '_ {
        self.words.iter().map(|word| (word.id, word.width))
    }

    /// A word with its number of bits.
    pub(super) fn word(&self, word: usize) -> (I, usize) {
        (self.words[word].id, self.words[word].width)
    }

    /// Takes the first sample: changes are relative to it.
    pub(super) fn start(&mut self, rows: &Rows, row: usize) {
        self.moves.start(rows, row);
    }

    /// Takes the next samples, at most [`SPAN`].
    pub(super) fn scan(&mut self, rows: &Rows, range: Range<usize>) {
        if !self.words.is_empty() {
            self.moves.scan(rows, range);
        }
    }

    /// A part of a word changes in a sample of those scanned last.
    pub(super) fn moves(&self, word: usize, sample: usize) -> bool {
        let Word { columns, first, .. } = &self.words[word];
        (*first..first + columns.len()).any(|net| self.moves.bits(net / SPAN, sample) >> (net % SPAN) & 1 == 1)
    }

    /// Writes the digits of a word, the highest first, into `out`, which has one byte for each.
    pub(super) fn digits(&self, word: usize, rows: &Rows, row: usize, out: &mut [u8]) {
        let columns = &self.words[word].columns;
        for (column, part) in columns.iter().zip(out.rchunks_mut(PART)) {
            let width = u32::try_from(part.len()).unwrap_or(64);
            part.copy_from_slice(digits(width, rows.value(*column, row), &mut [0; PART]));
        }
    }
}
