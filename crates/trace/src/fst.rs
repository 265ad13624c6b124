//! The FST writer: the names, times and samples of the VCD writer in a compressed file.
//!
//! As there, edge k is at k periods, the clock falls half a period later, and the same run gives the same bytes on
//! any machine: the header's date is empty. FST has no comment, so the file does not name model and options.
//!
//! A file is a header and sections. A section has the changes of each signal by themselves, as the columns of the
//! samples do: a column is turned into packed changes without a look at the others.

mod chain;
mod header;
mod lz4;
mod section;
#[cfg(test)]
mod tests;

use std::io::{self, Seek, Write};
use std::ops::Range;

use super::WaveBody;
use super::moves::{Moves, SPAN};
use super::probe::Probe;
use super::timescale::ClockTime;
use super::vcd::digits;
use super::wide::Wide;
use chain::{Chain, Press};
use header::Declared;
use section::Times;
use stepwave_netlist::Rows;

/// Bytes of changes and times, before they are packed, after which a section ends.
const SECTION: usize = 8 << 20;
/// Bytes of changes of all signals that wait to be packed, and of those of one signal.
const WAITING: usize = 4 << 20;
const PIECE: usize = 1 << 16;

/// What the header says.
#[derive(Clone, Debug)]
pub struct FstHeader<'a> {
    /// Names to dump, grouped by scope, all below one top scope.
    pub probes: &'a [Probe],
    /// Time of a clock.
    pub time: ClockTime,
    /// Dump the clock as `clk` in the top scope.
    pub clk: bool,
}

/// Takes samples, block by block.
pub struct FstBody<W: Write + Seek> {
    out: W,
    sections: Sections,
}

/// The sections of the file, which are the same whatever they are written to: compiled once, with this crate.
struct Sections {
    clk: bool,
    /// The changes of every signal; those of the clock first, if it is dumped.
    chains: Vec<Chain>,
    /// The signals of at most 64 bits: column and place among the chains.
    narrow: Vec<(usize, usize)>,
    moves: Moves,
    wide: Wide<usize>,
    press: Press,
    times: Times,
    /// The values with which the section begins, a digit a byte, and its first time.
    frame: Vec<u8>,
    begin: u64,
    count: u64,
    /// Bytes after which a section ends.
    limit: usize,
    ticks: u64,
    /// First and last clock written.
    written: Option<(u64, u64)>,
}

impl FstHeader<'_> {
    /// Writes the header.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write<W: Write + Seek>(&self, mut out: W) -> io::Result<FstBody<W>> {
        let declared = Declared::new(self);
        out.write_all(&declared.blocks(self.time.exponent()))?;
        let Declared { widths, narrow, wide, .. } = declared;
        let sections = Sections {
            clk: self.clk,
            press: Press::new((WAITING / widths.len().max(1)).min(PIECE)),
            // No value is known without a sample.
            frame: vec![b'x'; widths.iter().map(|&width| width as usize).sum()],
            chains: widths.into_iter().map(Chain::new).collect(),
            moves: Moves::new(narrow.iter().map(|(column, _)| *column).collect()),
            narrow,
            wide: Wide::new(wide),
            times: Times::default(),
            begin: 0,
            count: 0,
            limit: SECTION,
            ticks: self.time.ticks(),
            written: None,
        };
        Ok(FstBody { out, sections })
    }
}

impl<W: Write + Seek> WaveBody for FstBody<W> {
    /// The output.
    type Output = W;

    /// Where the clock is not dumped, samples in which no probe changes may be missing.
    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()> {
        if self.sections.rows(rows, range) {
            self.out.write_all(&self.sections.section())?;
        }
        Ok(())
    }

    fn rest(&mut self, clock: u64) {
        self.sections.written = self.sections.written.map(|(first, _)| (first, clock));
    }

    /// Ends the wave with a time that makes the last cycle visible, and gives the output back.
    fn finish(mut self) -> io::Result<W> {
        let (last, times) = self.sections.end();
        self.out.write_all(&last)?;
        header::finish(&mut self.out, times, self.sections.count)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

impl Sections {
    /// Takes rows; true where a section is full.
    fn rows(&mut self, rows: &Rows, mut range: Range<usize>) -> bool {
        if range.is_empty() {
            return false;
        }
        let (first, last) = (rows.clock(range.start), rows.clock(range.end - 1));
        if self.written.is_none() {
            self.first(first, rows, range.start);
            self.written = Some((first, last));
            range.start += 1;
        }
        for start in range.clone().step_by(SPAN) {
            self.span(rows, start..range.end.min(start + SPAN));
        }
        self.written = self.written.map(|(first, _)| (first, last));
        let changes: usize = self.chains.iter().map(Chain::length).sum();
        changes + self.times.length() >= self.limit
    }

    /// The sample with which the file begins.
    fn first(&mut self, clock: u64, rows: &Rows, row: usize) {
        self.moves.start(rows, row);
        self.wide.start(rows, row);
        self.begin = clock * self.ticks;
        self.set_frame();
        if let (true, Some(clk)) = (self.clk, self.frame.first_mut()) {
            *clk = if clock == 0 { b'0' } else { b'1' };
            if clock > 0 {
                self.times.push(clock * self.ticks + self.ticks / 2);
                self.chains[0].span(&[0], 1, |_| 0, &mut self.press);
            }
        }
    }

    /// Takes up to [`SPAN`] samples.
    fn span(&mut self, rows: &Rows, range: Range<usize>) {
        self.moves.scan_nets(rows, range.clone());
        self.wide.scan_nets(rows, range.clone());
        #[allow(clippy::cast_possible_truncation)]
        let samples = range.len() as u32;
        let base = self.times.count();
        if self.clk {
            let (mut rise, half) = (rows.clock(range.start) * self.ticks, self.ticks / 2);
            for _ in 0..samples {
                self.times.push(rise);
                self.times.push(rise + half);
                rise += self.ticks;
            }
            self.chains[0].clock(samples, base, &mut self.press);
            self.changes(rows, range, |sample| base + 2 * sample);
        } else {
            let mut any = self.moves.any() | self.wide.any();
            let moved = any;
            while any != 0 {
                self.times.push(rows.clock(range.start + any.trailing_zeros() as usize) * self.ticks);
                any &= any - 1;
            }
            self.changes(rows, range, |sample| base + (moved & ((1 << sample) - 1)).count_ones());
        }
    }

    /// Hands the changes of samples to the chains of their signals.
    fn changes(&mut self, rows: &Rows, range: Range<usize>, index: impl Fn(u32) -> u32) {
        for (net, &(column, signal)) in self.narrow.iter().enumerate() {
            let changes = self.moves.net(net);
            if changes != 0 {
                self.chains[signal].span(&rows.column(column)[range.clone()], changes, &index, &mut self.press);
            }
        }
        for word in 0..self.wide.words().len() {
            let mut changes = self.wide.changes(word);
            while changes != 0 {
                let sample = changes.trailing_zeros();
                changes &= changes - 1;
                let row = range.start + sample as usize;
                let parts = self.wide.columns(word).iter().map(|&column| rows.value(column, row));
                self.chains[self.wide.word(word).0].change(parts, index(sample), &mut self.press);
            }
        }
    }

    /// Takes the values of the last sample as those with which a section begins.
    fn set_frame(&mut self) {
        let mut parts: Vec<&mut [u8]> = Vec::with_capacity(self.chains.len());
        let mut rest = &mut self.frame[..];
        for chain in &self.chains {
            let (part, after) = rest.split_at_mut(chain.width() as usize);
            parts.push(part);
            rest = after;
        }
        if self.clk {
            // It falls after every sample.
            parts[0].copy_from_slice(b"0");
        }
        for (net, &(_, signal)) in self.narrow.iter().enumerate() {
            let width = self.chains[signal].width();
            parts[signal].copy_from_slice(digits(width, self.moves.last(net), &mut [0; 64]));
        }
        for word in 0..self.wide.words().len() {
            let signal = self.wide.word(word).0;
            self.wide.last_digits(word, parts[signal]);
        }
    }

    /// Ends a section; the next one begins at its last time. Its bytes.
    fn section(&mut self) -> Vec<u8> {
        let Self { begin, frame, times, chains, press, .. } = self;
        let end = times.last();
        let block = section::block(*begin, frame, times, chains, press);
        self.count += 1;
        self.begin = end;
        self.set_frame();
        block
    }

    /// The last section, and the first and last time of the wave.
    fn end(&mut self) -> (Vec<u8>, [u64; 2]) {
        let (first, last) = self.written.unwrap_or_default();
        let end = (last + 1) * self.ticks;
        self.times.push(end);
        (self.section(), [first * self.ticks, end])
    }
}
