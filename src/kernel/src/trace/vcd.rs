//! The VCD writer: a header through the crate `vcd`, then value changes written by hand, since they are the hot path.
//!
//! Edge k stands at k periods; the clock falls half a period later. Only changes are written, apart from the first
//! sample, which holds every variable. There is no date: the same run gives the same bytes on any machine.

use std::io::{self, Write};

use ::vcd::{IdCode, ReferenceIndex, VarType, Writer};

use super::probe::{Probe, Role};
use super::timescale::ClockTime;

/// Bytes gathered before they go to the output.
const BUFFER: usize = 64 * 1024;

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
}

/// One dumped net.
struct Change {
    column: usize,
    /// Width of a vector, or `None` for a scalar.
    vector: Option<u32>,
    /// The id and a newline.
    tail: Vec<u8>,
    last: u64,
}

/// Takes samples, one after another.
pub struct VcdBody<W: Write> {
    out: W,
    buffer: Vec<u8>,
    changes: Vec<Change>,
    /// Value lines of the clock, high and low, if it is dumped.
    clk: Option<[Vec<u8>; 2]>,
    ticks: u64,
    last_clock: Option<u64>,
}

fn variable_type(probe: &Probe) -> VarType {
    match (probe.role, probe.format.is_signed()) {
        (Role::Constant, _) => VarType::Parameter,
        // Viewers show an integer of any width as signed decimal without being told.
        (_, true) => VarType::Integer,
        (Role::Register, false) => VarType::Reg,
        (Role::Input | Role::Wire | Role::Flag, false) => VarType::Wire,
    }
}

/// A bit range stands behind vectors, except where viewers want the bare name.
pub(super) fn has_range(probe: &Probe) -> bool {
    probe.width.get() > 1 && probe.role != Role::Constant && !probe.format.is_signed()
}

impl VcdHeader<'_> {
    /// Writes the header.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn write<W: Write>(&self, mut out: W) -> io::Result<VcdBody<W>> {
        let mut head = Writer::new(Vec::new());
        // The crate spreads these two over three lines, which some readers do not take.
        writeln!(head.writer(), "$version stepwave {} $end", env!("CARGO_PKG_VERSION"))?;
        writeln!(head.writer(), "$comment schema 1; clock {} Hz; {} $end", self.time.hz(), self.comment)?;
        head.timescale(self.time.magnitude(), self.time.unit())?;
        let mut open: Vec<String> = Vec::new();
        let mut changes: Vec<Change> = Vec::new();
        let mut next = IdCode::FIRST;
        let mut ids: Vec<(usize, IdCode)> = Vec::new();
        let mut clk = None;
        let top = self.probes.first().map_or_else(|| "top".to_owned(), |probe| probe.scopes[0].clone());
        if self.clk {
            head.add_module(&top)?;
            open.push(top);
            head.var_def(VarType::Wire, 1, next, "clk", None)?;
            clk = Some([format!("1{next}\n").into_bytes(), format!("0{next}\n").into_bytes()]);
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
            let width = probe.width.get();
            let known = ids.iter().find(|(column, _)| *column == probe.column).map(|(_, id)| *id);
            let id = known.unwrap_or(next);
            let top_bit = i32::try_from(width).unwrap_or(64) - 1;
            let index = has_range(probe).then_some(ReferenceIndex::Range(top_bit, 0));
            head.var_def(variable_type(probe), width, id, &probe.name, index)?;
            if known.is_none() {
                ids.push((probe.column, id));
                next = next.next();
                let scalar = width == 1 && !probe.format.is_signed();
                let (vector, tail) = if scalar { (None, format!("{id}\n")) } else { (Some(width), format!(" {id}\n")) };
                changes.push(Change { column: probe.column, vector, tail: tail.into_bytes(), last: 0 });
            }
        }
        for _ in 0..open.len() {
            head.upscope()?;
        }
        head.enddefinitions()?;
        out.write_all(head.writer())?;
        let buffer = Vec::with_capacity(BUFFER + 4096);
        Ok(VcdBody { out, buffer, changes, clk, ticks: self.time.ticks(), last_clock: None })
    }
}

impl<W: Write> VcdBody<W> {
    /// Writes the sample of `clock`, which is one more than that of the sample before; `row` holds every column of the
    /// probes.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn sample(&mut self, clock: u64, row: &[u64]) -> io::Result<()> {
        if self.last_clock.is_none() {
            self.first(clock, row);
        } else {
            self.next(clock, row);
        }
        self.last_clock = Some(clock);
        if self.buffer.len() >= BUFFER {
            self.out.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }

    fn first(&mut self, clock: u64, row: &[u64]) {
        timestamp(&mut self.buffer, clock * self.ticks);
        self.buffer.extend_from_slice(b"$dumpvars\n");
        if let Some([high, low]) = &self.clk {
            self.buffer.extend_from_slice(if clock == 0 { low } else { high });
        }
        for change in &mut self.changes {
            change.last = row[change.column];
            value(&mut self.buffer, change);
        }
        self.buffer.extend_from_slice(b"$end\n");
        self.fall(clock);
    }

    fn next(&mut self, clock: u64, row: &[u64]) {
        let start = self.buffer.len();
        timestamp(&mut self.buffer, clock * self.ticks);
        let changed = self.buffer.len();
        if let Some([high, _]) = &self.clk {
            self.buffer.extend_from_slice(high);
        }
        for change in &mut self.changes {
            let now = row[change.column];
            if now != change.last {
                change.last = now;
                value(&mut self.buffer, change);
            }
        }
        if self.buffer.len() == changed {
            self.buffer.truncate(start);
        }
        self.fall(clock);
    }

    /// The clock's falling edge; before the first rising one it is low anyway.
    fn fall(&mut self, clock: u64) {
        if let (Some([_, low]), true) = (&self.clk, clock > 0) {
            timestamp(&mut self.buffer, clock * self.ticks + self.ticks / 2);
            self.buffer.extend_from_slice(low);
        }
    }

    /// Ends the wave with a time that makes the last cycle visible, and gives the output back.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        let end = self.last_clock.map_or(0, |clock| clock + 1);
        timestamp(&mut self.buffer, end * self.ticks);
        self.out.write_all(&self.buffer)?;
        self.out.flush()?;
        Ok(self.out)
    }
}

fn timestamp(buffer: &mut Vec<u8>, time: u64) {
    buffer.push(b'#');
    let mut digits = [0u8; 20];
    let mut start = digits.len();
    let mut rest = time;
    loop {
        start -= 1;
        digits[start] = b'0' + (rest % 10).to_le_bytes()[0];
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    buffer.extend_from_slice(&digits[start..]);
    buffer.push(b'\n');
}

fn value(buffer: &mut Vec<u8>, change: &Change) {
    let digit = |bit: u32| b'0' + (change.last >> bit & 1).to_le_bytes()[0];
    match change.vector {
        None => buffer.push(digit(0)),
        Some(width) => {
            buffer.push(b'b');
            buffer.extend((0..width).rev().map(digit));
        }
    }
    buffer.extend_from_slice(&change.tail);
}
