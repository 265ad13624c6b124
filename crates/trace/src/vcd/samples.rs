//! The text of samples: value changes between time stamps, written by hand, since they are the hot path.

use std::io;
use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};

use super::buffer::{BUFFER, Buffer};
use super::scan::{Batch, Scan, Span, by_column, parts};
use super::text::{Line, Stamps, Tail, WINDOW};
use super::turn::turn_over_all;
use crate::moves::SPAN;
use crate::wide::digits_of;
use stepwave_netlist::Rows;

/// Takes text, part by part.
pub(super) trait Parts {
    /// Takes from a buffer in which there are [`BUFFER`] bytes or more as much as leaves room for them.
    ///
    /// # Errors
    /// It cannot be written.
    fn part(&mut self, buffer: &mut Buffer) -> io::Result<()>;
}

/// What samples are written with: as declared in the header.
#[derive(Clone)]
pub(super) struct Lines {
    /// Value lines of the clock, high and low, if it is dumped.
    pub(super) clk: Option<[Tail; 2]>,
    /// Those of the nets of at most 64 bits.
    pub(super) nets: Vec<Line>,
    /// Of the other ones, number of bits, and what follows the digits.
    pub(super) words: Vec<(usize, Tail)>,
    /// Units of time in a clock.
    pub(super) ticks: u64,
}

impl Lines {
    /// Most bytes that a sample may touch. Two stamps and `$dumpvars` fit into a window too.
    pub(super) fn longest(&self) -> usize {
        // A `b`, the digits, and a tail.
        let words: usize = self.words.iter().map(|(width, _)| width + WINDOW).sum();
        self.nets.iter().map(Line::len).sum::<usize>() + words + 3 * WINDOW
    }
}

/// The text of samples, which is the same whatever it is written to: compiled once, with this crate.
pub(super) struct Samples {
    lines: Lines,
    /// What waits to be written, and room for the longest sample after it.
    pub(super) buffer: Buffer,
    level: Level,
    /// The changes of a span: for every 64 nets a word for each sample.
    groups: Vec<[u64; SPAN]>,
    /// The samples in which each word changes.
    words: Vec<u64>,
    /// For every column of nets and words, where its value in the first sample is, or the next one that was gathered.
    next: Vec<usize>,
    /// Times of the next rising edge and of the falling one after it.
    rise: Stamps,
    fall: Stamps,
    last_clock: Option<u64>,
}

/// Values, and the clocks of the samples of a sparse span.
#[derive(Clone, Copy)]
struct Values<'a> {
    clocks: &'a [u64],
    values: &'a [u64],
}

impl Samples {
    /// From the first sample on.
    pub(super) fn new(lines: Lines) -> Samples {
        Samples {
            buffer: Buffer::new(BUFFER + lines.longest()),
            level: Level::new(),
            groups: vec![[0; SPAN]; lines.nets.len().div_ceil(SPAN)],
            words: vec![0; lines.words.len()],
            next: vec![0; lines.nets.len() + lines.words.iter().map(|(width, _)| parts(*width)).sum::<usize>()],
            rise: Stamps::new(lines.ticks),
            fall: Stamps::new(lines.ticks),
            lines,
            last_clock: None,
        }
    }

    /// For samples after those that were taken, with a buffer of their own.
    pub(super) fn later(&self) -> Samples {
        let Samples { rise, fall, last_clock, .. } = self;
        Samples { rise: rise.clone(), fall: fall.clone(), last_clock: *last_clock, ..Samples::new(self.lines.clone()) }
    }

    /// Writes text that is made.
    pub(super) fn append(&mut self, mut text: &[u8], out: &mut dyn Parts) -> io::Result<()> {
        while !text.is_empty() {
            let (now, later) = text.split_at(text.len().min(BUFFER - self.buffer.filled));
            self.buffer.push(now);
            self.spill(out)?;
            text = later;
        }
        Ok(())
    }

    /// Writes the span that was looked at last.
    pub(super) fn span(
        &mut self,
        span: Span,
        scan: &Scan,
        rows: &Rows,
        range: &Range<usize>,
        out: &mut dyn Parts,
    ) -> io::Result<()> {
        for (next, &column) in self.next.iter_mut().zip(scan.columns()) {
            *next = rows.place(column, range.start);
        }
        self.changed(scan.bits());
        let values = Values { clocks: rows.clocks(range.clone()), values: rows.values() };
        dispatch!(self.level, simd => self.turned::<_, false>(simd, span, values, out))
    }

    /// Writes what was gathered.
    pub(super) fn batch(&mut self, batch: &Batch, out: &mut dyn Parts) -> io::Result<()> {
        let (mut bits, mut clocks, mut from) = (&batch.bits[..], &batch.clocks[..], 0);
        for &span in &batch.spans {
            let (of_span, more_bits) = bits.split_at(self.lines.nets.len() + self.lines.words.len());
            let (sparse, more_clocks) = clocks.split_at(if span.is_sparse { span.samples } else { 0 });
            let words = self.lines.words.iter().map(|(width, _)| parts(*width));
            for (next, bits) in self.next.iter_mut().zip(by_column(of_span, words)) {
                *next = from;
                from += bits.count_ones() as usize;
            }
            self.changed(of_span);
            let values = Values { clocks: sparse, values: &batch.values };
            dispatch!(self.level, simd => self.turned::<_, true>(simd, span, values, out))?;
            (bits, clocks) = (more_bits, more_clocks);
        }
        Ok(())
    }

    /// Takes the changes of a span.
    fn changed(&mut self, bits: &[u64]) {
        let (of_nets, of_words) = bits.split_at(self.lines.nets.len());
        for (group, bits) in self.groups.iter_mut().zip(of_nets.chunks(SPAN)) {
            group[..bits.len()].copy_from_slice(bits);
            group[bits.len()..].fill(0);
        }
        self.words.copy_from_slice(of_words);
    }

    #[inline(always)]
    fn turned<S: Simd, const GATHERED: bool>(
        &mut self,
        simd: S,
        span: Span,
        values: Values<'_>,
        out: &mut dyn Parts,
    ) -> io::Result<()> {
        turn_over_all(&mut self.groups);
        self.seek(span.clock);
        if self.last_clock.is_none() {
            self.first::<S, GATHERED>(simd, span.clock, values);
            self.last_clock = Some(span.clock);
            return self.spill(out);
        }
        // Calls in this loop would have all constants loaded again.
        for sample in 0..span.samples {
            if span.is_sparse {
                let clock = values.clocks[sample];
                self.seek(clock);
                self.last_clock = Some(clock);
            }
            self.row::<S, GATHERED>(simd, sample, values);
            if self.buffer.filled >= BUFFER {
                self.spill(out)?;
            }
        }
        if !span.is_sparse {
            self.last_clock = Some(span.clock + span.samples as u64 - 1);
        }
        Ok(())
    }

    /// Sets the stamps to a clock, where they are not there yet.
    fn seek(&mut self, clock: u64) {
        if self.last_clock.is_some_and(|last| clock == last + 1) {
            return;
        }
        let ticks = self.lines.ticks;
        self.rise.set(clock * ticks);
        if self.lines.clk.is_some() {
            self.fall.set(clock * ticks + ticks / 2);
        }
    }

    /// Writes the first sample, which holds every variable.
    #[inline(always)]
    fn first<S: Simd, const GATHERED: bool>(&mut self, simd: S, clock: u64, values: Values<'_>) {
        self.buffer.filled += self.rise.put(Tail::new("\n"), self.buffer.free());
        self.buffer.push(b"$dumpvars\n");
        if let Some([high, low]) = self.lines.clk {
            // Without its newline, which ends the line of the time elsewhere.
            let line = if clock == 0 { low } else { high };
            self.buffer.filled -= 1;
            self.buffer.filled += line.put(self.buffer.free());
        }
        self.buffer.filled = self.changes::<S, GATHERED>(simd, 0, values, self.buffer.filled);
        self.buffer.push(b"$end\n");
        self.rise.advance();
        // Before the first rising edge the clock is low anyway.
        if let (Some([_, low]), true) = (self.lines.clk, clock > 0) {
            self.buffer.filled += self.fall.put(low, self.buffer.free());
        }
        self.fall.advance();
    }

    /// Writes a sample of the span.
    #[inline(always)]
    fn row<S: Simd, const GATHERED: bool>(&mut self, simd: S, sample: usize, values: Values<'_>) {
        let start = self.buffer.filled;
        let stamp = self.lines.clk.map_or_else(|| Tail::new("\n"), |[high, _]| high);
        let changed = start + self.rise.put(stamp, &mut self.buffer[start..]);
        let mut at = self.changes::<S, GATHERED>(simd, sample, values, changed);
        match self.lines.clk {
            Some([_, low]) => at += self.fall.put(low, &mut self.buffer[at..]),
            // Nothing happens at this time.
            None if at == changed => at = start,
            None => {}
        }
        self.buffer.filled = at;
        self.rise.advance();
        self.fall.advance();
    }

    /// Writes what changes in a sample of the span, from `at` on; returns where it ends.
    #[inline(always)]
    fn changes<S: Simd, const GATHERED: bool>(
        &mut self,
        simd: S,
        sample: usize,
        values: Values<'_>,
        mut at: usize,
    ) -> usize {
        let Samples { lines: Lines { nets, words, .. }, buffer, next, groups, .. } = self;
        let (text, all, next) = (&mut buffer[..], values.values, &mut next[..]);
        for ((lines, next), group) in nets.chunks(SPAN).zip(next.chunks_mut(SPAN)).zip(groups) {
            let mut bits = group[sample % SPAN];
            while bits != 0 {
                let net = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let (line, next) = (&lines[net], &mut next[net]);
                let value = if GATHERED { all[*next] } else { all[*next + sample] };
                *next += usize::from(GATHERED);
                line.put(simd, value, window(text, at));
                at += line.len();
            }
        }
        if words.is_empty() { at } else { self.words::<GATHERED>(sample, all, at) }
    }

    /// The same of words.
    #[cold]
    fn words<const GATHERED: bool>(&mut self, sample: usize, all: &[u64], mut at: usize) -> usize {
        let text = &mut self.buffer[..];
        let mut columns = &mut self.next[self.lines.nets.len()..];
        for (&(width, tail), changes) in self.lines.words.iter().zip(&self.words) {
            let (parts, others) = columns.split_at_mut(parts(width));
            if changes >> (sample % SPAN) & 1 == 1 {
                text[at] = b'b';
                let values = parts.iter().map(|&next| if GATHERED { all[next] } else { all[next + sample] });
                digits_of(values, &mut text[at + 1..=at + width]);
                at += 1 + width;
                at += tail.put(&mut text[at..]);
                parts.iter_mut().for_each(|next| *next += usize::from(GATHERED));
            }
            columns = others;
        }
        at
    }

    #[cold]
    fn spill(&mut self, out: &mut dyn Parts) -> io::Result<()> {
        if self.buffer.filled >= BUFFER { out.part(&mut self.buffer) } else { Ok(()) }
    }

    /// Writes a time that makes the cycle of the last clock visible.
    pub(super) fn end(&mut self, last_clock: Option<u64>) {
        self.rise.set(last_clock.map_or(0, |clock| clock + 1) * self.lines.ticks);
        self.buffer.filled += self.rise.put(Tail::new("\n"), self.buffer.free());
    }
}

/// Room for a line. The buffer holds the longest sample after any place where one may begin.
#[inline]
fn window(text: &mut [u8], at: usize) -> &mut [u8; WINDOW] {
    text[at..].first_chunk_mut().expect("the buffer holds the longest sample")
}
