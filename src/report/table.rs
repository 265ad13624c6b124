//! Step tables: CSV for programs, and as a textbook prints them.

use std::io::Write;

use stepwave_engine::Wanted;
use stepwave_models::Port;

use super::{Report, RunFile};
use crate::testbench::{BlockReport, Memory, Observer, ObserverError, Step, Testbench};

/// Most steps that a textbook table shows.
pub const TEXTBOOK_STEPS: u64 = 64;

/// Writes the step table as CSV: step, clock, registers, pulses, position counters; signed decimal. The table of a
/// program has the number of the block in front.
pub struct CsvTable<W: Write> {
    out: W,
    /// What every line begins with.
    front: String,
}

impl<W: Write> CsvTable<W> {
    /// Writes the heading. A bench without blocks of its own is one of a program.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn new(bench: &Testbench, mut out: W) -> std::io::Result<CsvTable<W>> {
        let front = if bench.blocks() == 0 { "block," } else { "" };
        let letters = bench.hardware().letters();
        let mut names = vec!["step".to_owned(), "clock".to_owned()];
        names.extend(bench.machine().table.iter().map(|(name, _)| (*name).to_owned()));
        names.extend(letters.iter().map(|axis| format!("d{axis}")));
        names.extend(letters.iter().map(|axis| (*axis).to_owned()));
        writeln!(out, "{front}{}", names.join(","))?;
        Ok(CsvTable { out, front: String::new() })
    }
}

impl<W: Write> RunFile for CsvTable<W> {
    fn finish(&mut self, _: &Report) -> std::io::Result<()> {
        self.out.flush()
    }
}

impl<W: Write> Observer for CsvTable<W> {
    fn block_begun(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        self.front = format!("{},", block.number());
        Ok(())
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        write!(self.out, "{}{},{}", self.front, step.number, step.clock)?;
        for value in &step.registers {
            write!(self.out, ",{value}")?;
        }
        for value in step.pulses.iter().chain(&step.counters) {
            write!(self.out, ",{value}")?;
        }
        writeln!(self.out)?;
        Ok(())
    }
}

/// Rows as lines, each column aligned to the right.
pub(super) fn aligned(rows: &[Vec<String>]) -> Vec<String> {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |cells: &Vec<String>| {
        let padded: Vec<_> = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        padded.join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// Keeps the first steps for a table as a textbook prints it.
pub struct TextbookTable {
    heading: Vec<String>,
    letters: &'static [&'static str],
    ports: Vec<Port>,
    bits: bool,
    /// Of these registers a row shows what its step used.
    used: Vec<bool>,
    rows: Vec<Step>,
    complete: bool,
}

impl TextbookTable {
    /// A table of a machine's registers, in binary if `bits`. As textbooks print arcs of the DDA if `textbook`: row k
    /// holds the integrands that step k used, not those after it.
    #[must_use]
    pub fn new(bench: &Testbench, bits: bool, textbook: bool) -> TextbookTable {
        let letters = bench.hardware().letters();
        let mut heading = vec!["step".to_owned()];
        heading.extend(bench.machine().table.iter().map(|(name, _)| (*name).to_owned()));
        heading.push("pulse".to_owned());
        heading.extend(letters.iter().map(|axis| (*axis).to_owned()));
        let ports = bench.machine().table.iter().map(|(_, port)| *port).collect();
        let integrand = |(name, _): &(&'static str, Port)| textbook && name.starts_with("jv");
        let used = bench.machine().table.iter().map(integrand).collect();
        TextbookTable { heading, letters, ports, bits, used, rows: Vec::new(), complete: true }
    }

    fn cells(&self, step: &Step) -> Vec<String> {
        let mut cells = vec![step.number.to_string()];
        let registers = step.registers.iter().zip(&step.used).zip(&self.used);
        // Row 0 is before every step.
        let shown = registers.map(|((after, before), &used)| if used && step.number > 0 { before } else { after });
        for (value, port) in shown.zip(&self.ports) {
            let bits = port.reading.bits(port.width, *value);
            cells.push(match bits {
                Some(bits) if self.bits => bits.to_string(),
                _ => value.to_string(),
            });
        }
        let pulses = step.pulses.iter().zip(self.letters).filter(|(pulse, _)| **pulse != 0);
        let one = |(pulse, axis): (&i64, &&str)| match (*pulse, axis.to_uppercase()) {
            (1, axis) => format!("+{axis}"),
            (-1, axis) => format!("-{axis}"),
            (pulses, axis) => format!("{pulses:+}{axis}"),
        };
        cells.push(pulses.map(one).collect());
        cells.extend(step.counters.iter().map(ToString::to_string));
        cells
    }

    /// The table, or `None` if there were more than [`TEXTBOOK_STEPS`] steps.
    #[must_use]
    pub fn render(&self) -> Option<String> {
        if !self.complete {
            return None;
        }
        let rows = std::iter::once(self.heading.clone()).chain(self.rows.iter().map(|step| self.cells(step)));
        let rows: Vec<Vec<String>> = rows.collect();
        let mut lines = aligned(&rows);
        let rule = lines.iter().map(|line| line.trim_end().chars().count()).max().unwrap_or(0);
        lines.insert(1, "─".repeat(rule) + "\n");
        Some(lines.concat())
    }
}

impl Observer for TextbookTable {
    fn wants_steps(&self) -> bool {
        self.complete
    }

    fn want(&mut self, _: &Testbench, _: &mut Wanted) -> bool {
        true
    }

    fn recall(&mut self, _: &Memory) {
        // The run began elsewhere: its first steps are not to be seen.
        self.complete = false;
    }

    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        if step.number > TEXTBOOK_STEPS {
            self.complete = false;
            self.rows.clear();
        } else if self.complete {
            self.rows.push(step.clone());
        }
        Ok(())
    }
}
