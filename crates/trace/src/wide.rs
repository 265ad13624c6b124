//! Words of more than 64 bits in a wave: several columns of a row, one variable.

use std::ops::Range;

use super::moves::Moves;
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

    /// Takes the next samples, at most [`SPAN`], to be asked for changes [word by word](Self::changes).
    pub(super) fn scan_nets(&mut self, rows: &Rows, range: Range<usize>) {
        if !self.words.is_empty() {
            self.moves.scan_nets(rows, range);
        }
    }

    /// The samples in which a word changes: a bit each, the first the lowest.
    pub(super) fn changes(&self, word: usize) -> u64 {
        let Word { columns, first, .. } = &self.words[word];
        (*first..first + columns.len()).fold(0, |changes, net| changes | self.moves.net(net))
    }

    /// The samples in which some word changes, after [`scan_nets`](Self::scan_nets).
    pub(super) fn any(&self) -> u64 {
        self.moves.any()
    }

    /// Columns of a word, the lowest 64 bits first.
    pub(super) fn columns(&self, word: usize) -> &[usize] {
        &self.words[word].columns
    }

    /// Writes the digits that a word has in the sample looked at last into `out`, which has one byte for each.
    pub(super) fn last_digits(&self, word: usize, out: &mut [u8]) {
        let Word { columns, first, .. } = &self.words[word];
        digits_of((*first..first + columns.len()).map(|net| self.moves.last(net)), out);
    }
}

/// Writes the digits of a word whose lowest 64 bits come first.
pub(super) fn digits_of(parts: impl Iterator<Item = u64>, out: &mut [u8]) {
    for (value, part) in parts.zip(out.rchunks_mut(PART)) {
        let width = u32::try_from(part.len()).unwrap_or(64);
        part.copy_from_slice(digits(width, value, &mut [0; PART]));
    }
}
