//! A number after every step, in bounded memory: the least and the greatest of spans of steps.

use super::{Pair, union};

/// Spans that are kept; when they are full, neighbours merge.
pub(super) const SPAN_LIMIT: usize = 1024;

/// The ranges of a number over spans of steps.
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    /// Step of the first number.
    pub(super) first: u64,
    /// Of `span` steps each.
    pub(super) spans: Vec<Pair>,
    pub(super) span: u64,
    count: u64,
}

impl Envelope {
    /// Without numbers, the first of which is that of this step.
    pub(super) fn new(first: u64) -> Envelope {
        Envelope { first, spans: Vec::new(), span: 1, count: 0 }
    }

    /// Takes the number of the next step.
    pub(super) fn take(&mut self, number: f64) {
        if self.spans.len() == SPAN_LIMIT && self.count.is_multiple_of(self.span) {
            self.spans = self.spans.chunks(2).filter_map(|pair| pair.iter().copied().reduce(union)).collect();
            self.span *= 2;
        }
        match self.spans.last_mut() {
            Some(span) if !self.count.is_multiple_of(self.span) => *span = union(*span, [number; 2]),
            _ => self.spans.push([number; 2]),
        }
        self.count += 1;
    }

    /// The least and the greatest number.
    pub(super) fn range(&self) -> Option<Pair> {
        self.spans.iter().copied().reduce(union)
    }

    /// From which step to which the n-th span goes, half a step more at both ends, and not beyond the last of `steps`.
    pub(super) fn place(&self, number: usize, steps: f64) -> Pair {
        let from = self.first as f64 + number as f64 * self.span as f64 - 0.5;
        [from, (from + self.span as f64).min(steps + 0.5)]
    }
}
