//! The VCD writer: a header through the crate `vcd`, then value changes written by hand, since they are the hot path.
//!
//! Edge k is at k periods; the clock falls half a period later. Only changes are written, apart from the first
//! sample, which holds every variable. There is no date: the same run gives the same bytes on any machine.
//!
//! What changes in a block of samples is gathered, and written at once or by a thread; a row costs what changes in it.

mod background;
mod buffer;
mod cores;
mod samples;
mod scan;
#[cfg(test)]
mod tests;
mod text;
mod turn;

use std::io::{self, Write};
use std::ops::Range;

use ::vcd::{IdCode, ReferenceIndex, VarType, Writer as Header};

use super::WaveBody;
use super::probe::{Probe, Role};
use super::timescale::ClockTime;
use background::{Background, Output, Writer};
use samples::{Lines, Samples};
use scan::Scan;
use stepwave_netlist::Rows;
use stepwave_netlist::cells::Format;
use text::{Line, Tail};

pub(super) use text::digits;

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

/// Takes samples, one after another. Where there is a second core a long text is written by a thread.
pub struct VcdBody<W: Write + Send + 'static> {
    scan: Scan,
    out: Background<W>,
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
        let mut head = Header::new(Vec::new());
        // The crate spreads these two over three lines, which some readers do not take.
        writeln!(head.writer(), "$version stepwave {} $end", env!("CARGO_PKG_VERSION"))?;
        writeln!(head.writer(), "$comment schema 1; clock {} Hz; {} $end", self.time.hz(), self.comment)?;
        if self.states {
            self.probes.iter().try_for_each(|probe| states(probe, head.writer()))?;
        }
        head.timescale(self.time.magnitude(), self.time.unit())?;
        let (scan, lines) = self.declarations(&mut head)?;
        head.enddefinitions()?;
        let mut writer = Writer { samples: Samples::new(lines), out: Output::new(out) };
        writer.samples.append(head.writer(), &mut writer.out)?;
        Ok(VcdBody { scan, out: Background::new(writer), last_clock: None })
    }

    /// Declares the clock and every probe in its scope.
    fn declarations(&self, head: &mut Header<Vec<u8>>) -> io::Result<(Scan, Lines)> {
        let mut open: Vec<String> = Vec::new();
        let mut lines = Lines { clk: None, nets: Vec::new(), words: Vec::new(), ticks: self.time.ticks() };
        let (mut columns, mut words) = (Vec::new(), Vec::new());
        let mut next = IdCode::FIRST;
        let mut ids: Vec<(&[usize], IdCode)> = Vec::new();
        let top = self.probes.first().map_or_else(|| "top".to_owned(), |probe| probe.scopes[0].clone());
        if self.clk {
            head.add_module(&top)?;
            open.push(top);
            head.var_def(VarType::Wire, 1, next, "clk", None)?;
            lines.clk = Some([Tail::new(&format!("\n1{next}\n")), Tail::new(&format!("\n0{next}\n"))]);
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
                if let [column] = probe.columns[..] {
                    columns.push(column);
                    lines.nets.push(Line::new(width, scalar, &id.to_string()));
                } else {
                    words.push(probe);
                    lines.words.push((width as usize, Tail::new(&format!(" {id}\n"))));
                }
            }
        }
        for _ in 0..open.len() {
            head.upscope()?;
        }
        Ok((Scan::new(columns, words), lines))
    }
}

impl<W: Write + Send + 'static> WaveBody for VcdBody<W> {
    /// The output.
    type Output = W;

    /// A row holds every column of the probes. Where the clock is not dumped, samples in which no probe changes may be missing.
    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()> {
        for range in self.scan.spans(range) {
            let span = self.scan.scan(rows, &range);
            self.out.take(span, &self.scan, rows, &range)?;
            self.last_clock = Some(rows.clock(range.end - 1));
        }
        Ok(())
    }

    fn rest(&mut self, clock: u64) {
        self.last_clock = Some(clock);
    }

    /// Ends the wave with a time that makes the last cycle visible, and gives the output back.
    fn finish(mut self) -> io::Result<W> {
        let Writer { mut samples, out: Output { mut out, .. } } = self.out.writer()?;
        samples.end(self.last_clock);
        out.write_all(samples.buffer.text())?;
        out.flush()?;
        Ok(out)
    }
}
