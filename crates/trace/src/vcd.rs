//! The VCD writer: a header through the crate `vcd`, then value changes written by hand, since they are the hot path.
//!
//! Edge k is at k periods; the clock falls half a period later. Only changes are written, apart from the first
//! sample, which holds every variable. There is no date: the same run gives the same bytes on any machine.
//!
//! Samples come in blocks, in which `Moves` finds the nets that change; a row costs what changes in it.

mod background;
#[cfg(test)]
mod tests;
mod text;

use std::io::{self, Write};
use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch};

use ::vcd::{IdCode, ReferenceIndex, VarType, Writer};

use super::WaveBody;
use super::moves::{Moves, SPAN};
use super::probe::{Probe, Role};
use super::timescale::ClockTime;
use super::wide::Wide;
use background::{Background, Buffer, Parts};
use stepwave_netlist::Rows;
use stepwave_netlist::cells::Format;
use text::{Line, Stamps, Tail, WINDOW};

pub(super) use text::digits;

/// Bytes of every part that goes to the output, but the last: whole pages of a file.
const BUFFER: usize = 512 * 1024;

/// What the header says.
#[derive(Clone, Debug)]
pub struct VcdHeader<'a> {
    /// One line for people: model, geometry, choices. Must not hold `$end`.
    pub comment: &'a str,
    /// Names to dump, grouped by scope, all below one top scope.
    pub probes: &'a [Probe],
    /// Time of a clock.
    pub time: ClockTime,
    /// Dump the clock as `clk` in the top scope.
    pub clk: bool,
    /// The names of states are in comments, for a wave that no files lie next to.
    pub states: bool,
}

/// One dumped net.
struct Change {
    column: usize,
    line: Line,
}

/// What the header declares: the lines of the clock's edges, the variables of at most 64 bits, and the others.
struct Declared {
    clk: Option<[Tail; 2]>,
    changes: Vec<Change>,
    wide: Wide<Tail>,
}

/// Takes samples, one after another. Where there is a second core a long text is written by a thread.
pub struct VcdBody<W: Write + Send + 'static> {
    out: Background<W>,
    text: Text,
}

/// The text of samples, which is the same whatever it is written to: compiled once, with this crate.
struct Text {
    /// Room for `BUFFER` bytes and the longest row after them; the first `filled` bytes wait to be written.
    buffer: Buffer,
    filled: usize,
    /// What is left of a row when its part goes to the output.
    rest: Vec<u8>,
    changes: Vec<Change>,
    level: Level,
    moves: Moves,
    wide: Wide<Tail>,
    /// Value lines of the clock, high and low, if it is dumped.
    clk: Option<[Tail; 2]>,
    /// Times of the next rising edge and of the falling one after it.
    rise: Stamps,
    fall: Stamps,
    ticks: u64,
    last_clock: Option<u64>,
}

pub(super) fn variable_type(probe: &Probe) -> VarType {
    match (probe.role, probe.format.is_signed()) {
        (Role::Constant, _) => VarType::Parameter,
        // Viewers show an integer of any width as signed decimal by default.
        (_, true) => VarType::Integer,
        (Role::Register, false) => VarType::Reg,
        (Role::Input | Role::Wire | Role::Flag, false) => VarType::Wire,
    }
}

/// A bit range follows the name of a vector, except where viewers want the bare name.
pub(super) fn has_range(probe: &Probe) -> bool {
    probe.width > 1 && probe.role != Role::Constant && !probe.format.is_signed()
}

/// A comment for each state of a probe: the leaf name, the bits and the name.
fn states(probe: &Probe, out: &mut impl Write) -> io::Result<()> {
    let Format::States(names) = &probe.format else { return Ok(()) };
    // A name that would end the comment, or that is blank, is left out.
    let fits = |name: &str| !name.contains("$end") && !name.contains(char::is_control) && !name.trim().is_empty();
    names.iter().filter(|(_, name)| fits(name)).try_for_each(|(value, name)| {
        let bits = &format!("{value:064b}")[64usize.saturating_sub(probe.width as usize)..];
        writeln!(out, "$comment state {} {bits} {name} $end", probe.name)
    })
}

impl VcdHeader<'_> {
    /// Writes the header.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write<W: Write + Send + 'static>(&self, out: W) -> io::Result<VcdBody<W>> {
        let mut head = Writer::new(Vec::new());
        // The crate spreads these two over three lines, which some readers do not take.
        writeln!(head.writer(), "$version stepwave {} $end", env!("CARGO_PKG_VERSION"))?;
        writeln!(head.writer(), "$comment schema 1; clock {} Hz; {} $end", self.time.hz(), self.comment)?;
        if self.states {
            self.probes.iter().try_for_each(|probe| states(probe, head.writer()))?;
        }
        head.timescale(self.time.magnitude(), self.time.unit())?;
        let Declared { clk, changes, wide } = self.declarations(&mut head)?;
        head.enddefinitions()?;
        let longest: usize = changes.iter().map(|change| change.line.len()).sum();
        // A `b`, the digits, and a tail.
        let longest = longest + wide.words().map(|(_, width)| width + WINDOW).sum::<usize>();
        let ticks = self.time.ticks();
        let mut text = Text {
            // Two stamps and `$dumpvars` fit into a window too.
            buffer: Buffer::new(BUFFER + longest + 3 * WINDOW),
            filled: 0,
            rest: Vec::new(),
            level: Level::new(),
            moves: Moves::new(changes.iter().map(|change| change.column).collect()),
            changes,
            wide,
            clk,
            rise: Stamps::new(ticks),
            fall: Stamps::new(ticks),
            ticks,
            last_clock: None,
        };
        let mut out = Background::new(out);
        for part in head.writer().chunks(WINDOW) {
            text.text(part);
            text.spill(&mut out)?;
        }
        Ok(VcdBody { out, text })
    }

    /// Declares the clock and every probe in its scope.
    fn declarations(&self, head: &mut Writer<Vec<u8>>) -> io::Result<Declared> {
        let mut open: Vec<String> = Vec::new();
        let mut changes: Vec<Change> = Vec::new();
        let mut next = IdCode::FIRST;
        let mut wide: Vec<(&Probe, Tail)> = Vec::new();
        let mut ids: Vec<(&[usize], IdCode)> = Vec::new();
        let mut clk = None;
        let top = self.probes.first().map_or_else(|| "top".to_owned(), |probe| probe.scopes[0].clone());
        if self.clk {
            head.add_module(&top)?;
            open.push(top);
            head.var_def(VarType::Wire, 1, next, "clk", None)?;
            clk = Some([Tail::new(&format!("\n1{next}\n")), Tail::new(&format!("\n0{next}\n"))]);
            next = next.next();
        }
        for probe in self.probes {
            let common = open.iter().zip(&probe.scopes).take_while(|(a, b)| a == b).count();
            for _ in common..open.len() {
                head.upscope()?;
            }
            open.truncate(common);
            for scope in &probe.scopes[common..] {
                head.add_module(scope)?;
                open.push(scope.clone());
            }
            let width = probe.width;
            let known = ids.iter().find(|(columns, _)| *columns == probe.columns).map(|(_, id)| *id);
            let id = known.unwrap_or(next);
            let top_bit = i32::try_from(width).unwrap_or(i32::MAX) - 1;
            let index = has_range(probe).then_some(ReferenceIndex::Range(top_bit, 0));
            head.var_def(variable_type(probe), width, id, &probe.name, index)?;
            if known.is_none() {
                ids.push((&probe.columns, id));
                next = next.next();
                let scalar = width == 1 && !probe.format.is_signed();
                match probe.columns[..] {
                    [column] => changes.push(Change { column, line: Line::new(width, scalar, &id.to_string()) }),
                    _ => wide.push((probe, Tail::new(&format!(" {id}\n")))),
                }
            }
        }
        for _ in 0..open.len() {
            head.upscope()?;
        }
        Ok(Declared { clk, changes, wide: Wide::new(wide) })
    }
}

impl<W: Write + Send + 'static> WaveBody for VcdBody<W> {
    /// The output.
    type Output = W;

    /// A row holds every column of the probes. Where the clock is not dumped, samples in which no probe changes may be missing.
    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()> {
        self.text.rows(rows, range, &mut self.out)
    }

    fn rest(&mut self, clock: u64) {
        self.text.last_clock = Some(clock);
    }

    /// Ends the wave with a time that makes the last cycle visible, and gives the output back.
    fn finish(mut self) -> io::Result<W> {
        self.text.end();
        self.out.part(&mut self.text.buffer, self.text.filled)?;
        self.out.finish()
    }
}

impl Text {
    fn rows(&mut self, rows: &Rows, mut range: Range<usize>, out: &mut dyn Parts) -> io::Result<()> {
        if range.is_empty() {
            return Ok(());
        }
        let (first, last) = (rows.clock(range.start), rows.clock(range.end - 1));
        if self.seek(first) {
            self.first(first, rows, range.start);
            self.spill(out)?;
            (self.last_clock, range.start) = (Some(first), range.start + 1);
        }
        for start in range.clone().step_by(SPAN) {
            let end = range.end.min(start + SPAN);
            self.moves.scan(rows, start..end);
            self.wide.scan(rows, start..end);
            dispatch!(self.level, simd => self.scanned(simd, rows, start..end, out))?;
        }
        self.last_clock = Some(last);
        Ok(())
    }

    /// Writes the rows scanned last.
    #[inline(always)]
    fn scanned<S: Simd>(&mut self, simd: S, rows: &Rows, range: Range<usize>, out: &mut dyn Parts) -> io::Result<()> {
        // Calls in this loop would have all constants loaded again.
        let sparse = rows.is_sparse();
        for row in range.clone() {
            if sparse {
                let clock = rows.clock(row);
                self.seek(clock);
                self.last_clock = Some(clock);
            }
            self.row(simd, rows, row, row - range.start);
            if self.filled >= BUFFER {
                self.spill(out)?;
            }
        }
        Ok(())
    }

    /// Sets the stamps to a clock, where they are not there yet; true before the first sample.
    fn seek(&mut self, clock: u64) -> bool {
        if self.last_clock.is_none_or(|last| clock != last + 1) {
            self.rise.set(clock * self.ticks);
            if self.clk.is_some() {
                self.fall.set(clock * self.ticks + self.ticks / 2);
            }
        }
        self.last_clock.is_none()
    }

    fn first(&mut self, clock: u64, rows: &Rows, row: usize) {
        self.filled += self.rise.put(Tail::new("\n"), &mut self.buffer[self.filled..]);
        self.text(b"$dumpvars\n");
        if let Some([high, low]) = self.clk {
            // Without its newline, which ends the line of the time elsewhere.
            let line = if clock == 0 { low } else { high };
            self.filled -= 1;
            self.filled += line.put(&mut self.buffer[self.filled..]);
        }
        self.moves.start(rows, row);
        let (level, buffer, filled) = (self.level, &mut self.buffer, &mut self.filled);
        for change in &self.changes {
            let value = rows.value(change.column, row);
            dispatch!(level, simd => change.line.put(simd, value, window(buffer, *filled)));
            *filled += change.line.len();
        }
        self.wide.start(rows, row);
        for word in 0..self.wide.words().len() {
            self.filled += wide_line(&self.wide, word, rows, row, &mut self.buffer[self.filled..]);
        }
        self.text(b"$end\n");
        self.rise.advance();
        // Before the first rising edge the clock is low anyway.
        if let (Some([_, low]), true) = (self.clk, clock > 0) {
            self.filled += self.fall.put(low, &mut self.buffer[self.filled..]);
        }
        self.fall.advance();
    }

    /// Writes a row, the `sample`th of those scanned last.
    #[inline(always)]
    fn row<S: Simd>(&mut self, simd: S, rows: &Rows, row: usize, sample: usize) {
        let start = self.filled;
        let buffer = &mut self.buffer[..];
        let stamp = self.clk.map_or_else(|| Tail::new("\n"), |[high, _]| high);
        let mut at = start + self.rise.put(stamp, &mut buffer[start..]);
        let changed = at;
        for (group, changes) in self.changes.chunks(SPAN).enumerate() {
            let mut bits = self.moves.bits(group, sample);
            while bits != 0 {
                let change = &changes[bits.trailing_zeros() as usize];
                bits &= bits - 1;
                change.line.put(simd, rows.value(change.column, row), window(buffer, at));
                at += change.line.len();
            }
        }
        for word in 0..self.wide.words().len() {
            if self.wide.moves(word, sample) {
                at += wide_line(&self.wide, word, rows, row, &mut buffer[at..]);
            }
        }
        match self.clk {
            Some([_, low]) => at += self.fall.put(low, &mut buffer[at..]),
            // Nothing happens at this time.
            None if at == changed => at = start,
            None => {}
        }
        self.filled = at;
        self.rise.advance();
        self.fall.advance();
    }

    fn text(&mut self, text: &[u8]) {
        self.buffer[self.filled..self.filled + text.len()].copy_from_slice(text);
        self.filled += text.len();
    }

    /// Writes as much of the buffer as are whole parts.
    #[cold]
    fn spill(&mut self, out: &mut dyn Parts) -> io::Result<()> {
        while self.filled >= BUFFER {
            self.rest.clear();
            self.rest.extend_from_slice(&self.buffer[BUFFER..self.filled]);
            out.part(&mut self.buffer, BUFFER)?;
            self.filled = self.rest.len();
            self.buffer[..self.filled].copy_from_slice(&self.rest);
        }
        Ok(())
    }

    /// Appends a time that makes the last cycle visible.
    fn end(&mut self) {
        let end = self.last_clock.map_or(0, |clock| clock + 1);
        self.rise.set(end * self.ticks);
        self.filled += self.rise.put(Tail::new("\n"), &mut self.buffer[self.filled..]);
    }
}

/// Writes the line of a word of more than 64 bits at the start of `out`; returns its length.
fn wide_line(wide: &Wide<Tail>, word: usize, rows: &Rows, row: usize, out: &mut [u8]) -> usize {
    let (tail, width) = wide.word(word);
    out[0] = b'b';
    wide.digits(word, rows, row, &mut out[1..=width]);
    1 + width + tail.put(&mut out[1 + width..])
}

/// Room for a line. The buffer holds the longest row after any place where a row may begin.
#[inline]
fn window(buffer: &mut [u8], at: usize) -> &mut [u8; WINDOW] {
    buffer[at..].first_chunk_mut().expect("the buffer holds the longest row")
}
