//! Range watch: the least and greatest value that each register held.

use serde_json::json;
use stepwave_kernel::Width;
use stepwave_kernel::bits::Reading;
use stepwave_kernel::engine::Rows;
use stepwave_kernel::netlist::Op;

use super::checkpoint::{Memory, recalled};
use super::{Observer, ObserverError, Testbench};

/// What a register held during a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisterRange {
    /// Name without path.
    pub name: String,
    /// Dotted path.
    pub path: String,
    /// Its width.
    pub width: Width,
    /// What number its bits mean.
    pub reading: Reading,
    /// Least value seen.
    pub least: i128,
    /// Greatest value seen.
    pub greatest: i128,
}

impl RegisterRange {
    /// Width that the values seen need, in bits.
    #[must_use]
    pub fn needed(&self) -> u32 {
        self.reading.needed(self.least).max(self.reading.needed(self.greatest))
    }
}

struct Watched {
    column: usize,
    least: u64,
    greatest: u64,
}

/// Watches every named register.
pub struct RangeWatch {
    registers: Vec<RegisterRange>,
    watched: Vec<Watched>,
}

impl RangeWatch {
    /// All named registers of a machine, in the order of the wave.
    #[must_use]
    pub fn new(bench: &Testbench) -> RangeWatch {
        let netlist = bench.design().netlist();
        let mut watch = RangeWatch { registers: Vec::new(), watched: Vec::new() };
        for named in &netlist.names {
            let cell = netlist.cell(named.net);
            if matches!(cell.op, Op::Register { .. }) {
                watch.watched.push(Watched { column: bench.columns().index(named.net), least: u64::MAX, greatest: 0 });
                watch.registers.push(RegisterRange {
                    name: named.name.clone(),
                    path: netlist.path(named),
                    width: cell.width,
                    reading: named.format.reading(),
                    least: 0,
                    greatest: 0,
                });
            }
        }
        watch
    }

    /// The ranges seen so far.
    #[must_use]
    pub fn finish(mut self) -> Vec<RegisterRange> {
        for (range, watched) in self.registers.iter_mut().zip(&self.watched) {
            if watched.least <= watched.greatest {
                let number = |value| range.reading.number(range.width, value ^ turned(range));
                (range.least, range.greatest) = (number(watched.least), number(watched.greatest));
            }
        }
        self.registers
    }
}

/// What makes both readings sort alike: two's complement has its sign bit turned over.
fn turned(range: &RegisterRange) -> u64 {
    if range.reading.is_signed() { range.width.sign_bit() } else { 0 }
}

impl Observer for RangeWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        let extremes: Vec<_> = self.watched.iter().map(|watched| (watched.least, watched.greatest)).collect();
        memory.insert("ranges".to_owned(), json!(extremes));
    }

    fn recall(&mut self, memory: &Memory) {
        let extremes: Vec<(u64, u64)> = recalled(memory, "ranges").unwrap_or_default();
        for (watched, extremes) in self.watched.iter_mut().zip(extremes) {
            (watched.least, watched.greatest) = extremes;
        }
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for (watched, range) in self.watched.iter_mut().zip(&self.registers) {
            if let Some((least, greatest)) = rows.extremes(watched.column, turned(range)) {
                watched.least = watched.least.min(least);
                watched.greatest = watched.greatest.max(greatest);
            }
        }
        Ok(())
    }
}
