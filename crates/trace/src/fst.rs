//! The FST writer: the names, times and samples of the VCD writer in a compressed file, through the crate `fst-writer`.
//!
//! As there, edge k is at k periods, the clock falls half a period later, and the same run gives the same bytes on
//! any machine: the header's date is empty. FST has no comment, so the file does not name model and options.

use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::ops::Range;

use ::vcd::VarType;
use fst_writer::{
    FstBodyWriter, FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalId, FstSignalType, FstVarDirection,
    FstVarType, FstWriteError,
};

use super::moves::{Moves, SPAN};
use super::probe::Probe;
use super::timescale::ClockTime;
use super::vcd::{digits, has_range, variable_type};
use super::wide::Wide;
use stepwave_netlist::Rows;

/// Bytes of changes that are gathered in memory before a section of the file is written.
const SECTION: usize = 32 << 20;
/// Type of a block that holds changes.
const CHANGES: u8 = 8;
/// Place of the time at which the file begins, in the header block.
const START_TIME: u64 = 9;

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

/// One dumped net.
struct Change {
    column: usize,
    width: u32,
    id: FstSignalId,
}

/// What the header declares.
struct Declared<W: Write + Seek> {
    body: FstBodyWriter<W>,
    clk: Option<FstSignalId>,
    changes: Vec<Change>,
    wide: Wide<FstSignalId>,
}

/// Takes samples, block by block.
pub struct FstBody<W: Write + Seek> {
    body: FstBodyWriter<W>,
    clk: Option<FstSignalId>,
    changes: Vec<Change>,
    moves: Moves,
    wide: Wide<FstSignalId>,
    /// Room for the digits of the widest word.
    digits: Vec<u8>,
    ticks: u64,
    /// Place of the first block of changes in the file.
    first_section: u64,
    /// First and last clock written.
    written: Option<(u64, u64)>,
}

fn io_error(error: FstWriteError) -> io::Error {
    match error {
        FstWriteError::Io(error) => error,
        other => io::Error::other(format!("cannot write the FST file: {other}")),
    }
}

fn fst_type(probe: &Probe) -> FstVarType {
    match variable_type(probe) {
        VarType::Integer => FstVarType::Integer,
        VarType::Parameter => FstVarType::Parameter,
        VarType::Reg => FstVarType::Reg,
        _ => FstVarType::Wire,
    }
}

impl FstHeader<'_> {
    /// Writes the header.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write<W: Write + Seek>(&self, out: W) -> io::Result<FstBody<W>> {
        // The crate does not report where the changes begin; an empty wave with the same header does.
        let empty = self.declare(Cursor::new(Vec::new())).and_then(|empty| empty.body.finish()).map_err(io_error)?;
        let first_section =
            first_section(empty.get_ref()).ok_or_else(|| io::Error::other("the FST header is broken"))?;
        let Declared { mut body, clk, changes, wide } = self.declare(out).map_err(io_error)?;
        // Only changes are handed over.
        body.set_deduplicate(false);
        let moves = Moves::new(changes.iter().map(|change| change.column).collect());
        let (ticks, written) = (self.time.ticks(), None);
        let digits = vec![0; wide.words().map(|(_, width)| width).max().unwrap_or(0)];
        Ok(FstBody { body, clk, changes, moves, wide, digits, ticks, first_section, written })
    }

    fn declare<W: Write + Seek>(&self, out: W) -> Result<Declared<W>, FstWriteError> {
        let info = FstInfo {
            start_time: 0,
            timescale_exponent: self.time.exponent(),
            version: format!("stepwave {}", env!("CARGO_PKG_VERSION")),
            date: String::new(),
            file_type: FstFileType::Verilog,
        };
        let mut head = FstHeaderWriter::new(out, &info)?;
        let mut open: Vec<&str> = Vec::new();
        let mut changes: Vec<Change> = Vec::new();
        let mut wide: Vec<(&Probe, FstSignalId)> = Vec::new();
        let mut clk = None;
        let top = self.probes.first().map_or("top", |probe| probe.scopes[0].as_str());
        if self.clk {
            head.scope(top, "", FstScopeType::Module)?;
            open.push(top);
            let bit = FstSignalType::bit_vec(1);
            clk = Some(head.var("clk", bit, FstVarType::Wire, FstVarDirection::Implicit, None)?);
        }
        for probe in self.probes {
            let common = open.iter().zip(&probe.scopes).take_while(|(a, b)| *a == b).count();
            for _ in common..open.len() {
                head.up_scope()?;
            }
            open.truncate(common);
            for scope in &probe.scopes[common..] {
                head.scope(scope, "", FstScopeType::Module)?;
                open.push(scope);
            }
            let width = probe.width;
            let name = if has_range(probe) { format!("{} [{}:0]", probe.name, width - 1) } else { probe.name.clone() };
            let narrow = |column: usize| changes.iter().find(|change| change.column == column).map(|change| change.id);
            let known = match probe.columns[..] {
                [column] => narrow(column),
                _ => wide.iter().find(|(other, _)| other.columns == probe.columns).map(|(_, id)| *id),
            };
            let bits = FstSignalType::bit_vec(width);
            let id = head.var(name, bits, fst_type(probe), FstVarDirection::Implicit, known)?;
            match probe.columns[..] {
                _ if known.is_some() => {}
                [column] => changes.push(Change { column, width, id }),
                _ => wide.push((probe, id)),
            }
        }
        for _ in 0..open.len() {
            head.up_scope()?;
        }
        Ok(Declared { body: head.finish()?, clk, changes, wide: Wide::new(wide) })
    }
}

/// Where the first block of changes begins. A block is its type in a byte, its length after that byte, and the rest.
fn first_section(file: &[u8]) -> Option<u64> {
    let mut at = 0;
    while *file.get(at)? != CHANGES {
        let length = u64::from_be_bytes(*file.get(at + 1..)?.first_chunk()?);
        at += 1 + usize::try_from(length).ok()?;
    }
    Some(at as u64)
}

impl<W: Write + Seek> FstBody<W> {
    /// Writes some rows of a block, which follow those written before.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn rows(&mut self, rows: &Rows, mut range: Range<usize>) -> io::Result<()> {
        if range.is_empty() {
            return Ok(());
        }
        let clock = |row: usize| rows.first_clock() + row as u64;
        let last = clock(range.end - 1);
        if self.written.is_none() {
            self.first(clock(range.start), rows, range.start).map_err(io_error)?;
            self.written = Some((clock(range.start), last));
            range.start += 1;
        }
        for start in range.clone().step_by(SPAN) {
            let end = range.end.min(start + SPAN);
            self.moves.scan(rows, start..end);
            self.wide.scan(rows, start..end);
            for row in start..end {
                self.row(clock(row), rows, row, row - start).map_err(io_error)?;
            }
        }
        self.written = self.written.map(|(first, _)| (first, last));
        // The crate takes the end of a section only in front of a new time.
        if self.body.size() >= SECTION { self.body.flush().map_err(io_error) } else { Ok(()) }
    }

    /// The state with which the file begins. What is given before the first time counts from the beginning, which
    /// `finish` sets.
    fn first(&mut self, clock: u64, rows: &Rows, row: usize) -> Result<(), FstWriteError> {
        if let Some(clk) = self.clk {
            self.body.signal_change(clk, if clock == 0 { b"0" } else { b"1" })?;
        }
        self.moves.start(rows, row);
        for change in &self.changes {
            let now = rows.value(change.column, row);
            self.body.signal_change(change.id, digits(change.width, now, &mut [0; 64]))?;
        }
        self.wide.start(rows, row);
        let words = self.wide.words().len();
        for word in 0..words {
            self.wide_change(word, rows, row)?;
        }
        if let (Some(clk), true) = (self.clk, clock > 0) {
            self.body.time_change(clock * self.ticks + self.ticks / 2)?;
            self.body.signal_change(clk, b"0")?;
        }
        Ok(())
    }

    /// Writes a row, the `sample`th of those scanned last.
    fn row(&mut self, clock: u64, rows: &Rows, row: usize, sample: usize) -> Result<(), FstWriteError> {
        let time = clock * self.ticks;
        let groups = self.changes.chunks(SPAN).enumerate();
        let words = 0..self.wide.words().len();
        let quiet = groups.clone().all(|(group, _)| self.moves.bits(group, sample) == 0);
        if self.clk.is_some() || !quiet || words.clone().any(|word| self.wide.moves(word, sample)) {
            self.body.time_change(time)?;
        }
        if let Some(clk) = self.clk {
            self.body.signal_change(clk, b"1")?;
        }
        for (group, changes) in groups {
            let mut bits = self.moves.bits(group, sample);
            while bits != 0 {
                let change = &changes[bits.trailing_zeros() as usize];
                bits &= bits - 1;
                let now = rows.value(change.column, row);
                self.body.signal_change(change.id, digits(change.width, now, &mut [0; 64]))?;
            }
        }
        for word in words {
            if self.wide.moves(word, sample) {
                self.wide_change(word, rows, row)?;
            }
        }
        if let Some(clk) = self.clk {
            self.body.time_change(time + self.ticks / 2)?;
            self.body.signal_change(clk, b"0")?;
        }
        Ok(())
    }

    /// Writes the value of a word of more than 64 bits.
    fn wide_change(&mut self, word: usize, rows: &Rows, row: usize) -> Result<(), FstWriteError> {
        let (id, width) = self.wide.word(word);
        let digits = &mut self.digits[..width];
        self.wide.digits(word, rows, row, digits);
        self.body.signal_change(id, digits)
    }

    /// Ends the wave with a time that makes the last cycle visible, and gives the output back.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        let (first, last) = self.written.unwrap_or_default();
        self.body.time_change((last + 1) * self.ticks).map_err(io_error)?;
        let mut out = self.body.finish().map_err(io_error)?;
        // The crate lets every file begin at 0.
        let start = (first * self.ticks).to_be_bytes();
        for place in [START_TIME, self.first_section + START_TIME] {
            out.seek(SeekFrom::Start(place))?;
            out.write_all(&start)?;
        }
        out.seek(SeekFrom::End(0))?;
        out.flush()?;
        Ok(out)
    }
}
