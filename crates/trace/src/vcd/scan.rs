//! What changes in samples, looked for in the columns of a block, and gathered from them. What is gathered is a fraction of
//! the samples, lies together, and can be handed to a thread while the engine fills the columns anew.

use std::ops::Range;

use stepwave_netlist::Rows;

use crate::moves::{Moves, SPAN};
use crate::probe::Probe;
use crate::wide::Wide;

/// Words of 64 bits after which a batch is full.
const BATCH: usize = 1 << 15;

/// Up to [`SPAN`] samples.
#[derive(Clone, Copy)]
pub(super) struct Span {
    /// Clock of the first.
    pub(super) clock: u64,
    /// How many; at least one.
    pub(super) samples: usize,
    /// Samples between them were passed over: each has its own clock.
    pub(super) is_sparse: bool,
}

/// Looks for the changes of some nets of at most 64 bits, and of some words of more.
pub(super) struct Scan {
    /// Those of the nets, and then those of the words, the lowest 64 bits first.
    columns: Vec<usize>,
    moves: Moves,
    wide: Wide<()>,
    /// For every net and then for every word, a bit for each sample in which it changes, the first the lowest.
    bits: Vec<u64>,
    /// The first sample is taken.
    begun: bool,
}

impl Scan {
    /// Of nets in these columns, and of these words.
    pub(super) fn new(nets: Vec<usize>, words: Vec<&Probe>) -> Scan {
        let bits = vec![0; nets.len() + words.len()];
        let parts = words.iter().flat_map(|word| word.columns.iter().copied());
        let columns = nets.iter().copied().chain(parts).collect();
        let wide = Wide::new(words.into_iter().map(|word| (word, ())).collect());
        Scan { columns, moves: Moves::new(nets), wide, bits, begun: false }
    }

    /// Cuts rows into spans. The first sample of all is one by itself, in which everything changes.
    pub(super) fn spans(&self, mut range: Range<usize>) -> impl Iterator<Item = Range<usize>> + use<> {
        let first = (!self.begun && !range.is_empty()).then(|| range.start..range.start + 1);
        range.start += first.iter().len();
        first.into_iter().chain(range.clone().step_by(SPAN).map(move |start| start..range.end.min(start + SPAN)))
    }

    /// Looks at a span.
    pub(super) fn scan(&mut self, rows: &Rows, range: &Range<usize>) -> Span {
        self.moves.scan_nets(rows, range.clone());
        self.wide.scan_nets(rows, range.clone());
        let nets = self.bits.len() - self.wide.words().len();
        let (of_nets, of_words) = self.bits.split_at_mut(nets);
        of_nets.iter_mut().enumerate().for_each(|(net, bits)| *bits = self.moves.net(net));
        of_words.iter_mut().enumerate().for_each(|(word, bits)| *bits = self.wide.changes(word));
        if !self.begun {
            self.begun = true;
            self.bits.fill(1);
        }
        Span { clock: rows.clock(range.start), samples: range.len(), is_sparse: rows.is_sparse() }
    }

    /// The changes of the span: a word for every net and then for every word.
    pub(super) fn bits(&self) -> &[u64] {
        &self.bits
    }

    /// The columns of the nets, and then those of the words, the lowest 64 bits first.
    pub(super) fn columns(&self) -> &[usize] {
        &self.columns
    }
}

/// Columns of a word of this many bits.
pub(super) fn parts(width: usize) -> usize {
    width.div_ceil(64)
}

/// The changes of every column, where there is a word of bits for every net, and then for every word of these numbers of
/// columns.
pub(super) fn by_column(bits: &[u64], words: impl ExactSizeIterator<Item = usize>) -> impl Iterator<Item = u64> {
    let (of_nets, of_words) = bits.split_at(bits.len() - words.len());
    let of_words = of_words.iter().zip(words).flat_map(|(&bits, parts)| std::iter::repeat_n(bits, parts));
    of_nets.iter().copied().chain(of_words)
}

/// The changes of spans with their values, to be read in order.
#[derive(Default)]
pub(super) struct Batch {
    pub(super) spans: Vec<Span>,
    /// The clocks of the samples of sparse spans.
    pub(super) clocks: Vec<u64>,
    /// Those of every span, as [`Scan::bits`].
    pub(super) bits: Vec<u64>,
    /// Span by span, column by column, sample by sample.
    pub(super) values: Vec<u64>,
    samples: usize,
}

impl Batch {
    /// Adds the span that was looked at last.
    pub(super) fn add(&mut self, span: Span, scan: &Scan, rows: &Rows, range: &Range<usize>) {
        self.spans.push(span);
        self.samples += span.samples;
        self.clocks.extend_from_slice(rows.clocks(range.clone()));
        self.bits.extend_from_slice(&scan.bits);
        let words = scan.wide.words().map(|(_, width)| parts(width));
        for (&column, changes) in scan.columns.iter().zip(by_column(&scan.bits, words)) {
            if changes != 0 {
                self.take(&rows.column(column)[range.clone()], changes);
            }
        }
    }

    /// Appends those of at most 64 values that are new.
    #[inline]
    fn take(&mut self, values: &[u64], mut changes: u64) {
        if changes == u64::MAX {
            return self.values.extend_from_slice(values);
        }
        let from = self.values.len();
        self.values.resize(from + changes.count_ones() as usize, 0);
        for place in &mut self.values[from..] {
            *place = values[changes.trailing_zeros() as usize % SPAN];
            changes &= changes - 1;
        }
    }

    /// Nothing more should be added. The two time stamps of a sample are as much text as two values.
    pub(super) fn is_full(&self) -> bool {
        self.values.len() + self.bits.len() + 2 * self.samples >= BATCH
    }

    pub(super) fn clear(&mut self) {
        self.samples = 0;
        self.spans.clear();
        [&mut self.clocks, &mut self.bits, &mut self.values].into_iter().for_each(Vec::clear);
    }
}
