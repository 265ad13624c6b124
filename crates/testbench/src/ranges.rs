//! Range watch: the least and greatest value that each register held, and the bits of it that never changed.

use std::fmt;

use serde_json::json;
use stepwave_engine::{Digest, Extremes, Rows, Wanted};
use stepwave_netlist::bits::Reading;
use stepwave_netlist::cells::{Arithmetic, Claim, Netlist, Op};
use stepwave_netlist::{Net, Width};

use super::checkpoint::{Memory, recalled};
use super::{Observer, ObserverError, Testbench};

/// What a register held during a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisterRange {
    /// Name without path; with it where hardware has several registers of the name.
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
    /// Bits that were both 0 and 1.
    pub toggled: u64,
    /// What the other bits were in every sample; 0 where a bit toggled.
    pub stuck: u64,
    /// It takes a word where a block is loaded and keeps it up to the next: an operand.
    pub held: bool,
    /// Ends of its range that it reached and beyond which a strict cell may carry it, one unit from an overflow. The 0
    /// of an unsigned register does not count, as counters are meant to reach it.
    pub limits: Vec<i128>,
}

/// Neighbouring bits of a register that were the same, and alike, in every sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StuckBits {
    /// The highest of them.
    pub high: u32,
    /// The lowest of them.
    pub low: u32,
    /// Each of them was 1; otherwise 0.
    pub ones: bool,
}

/// As an index: `[5:3] at 0`.
impl fmt::Display for StuckBits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}", self.high)?;
        if self.low < self.high {
            write!(f, ":{}", self.low)?;
        }
        write!(f, "] at {}", u8::from(self.ones))
    }
}

impl RegisterRange {
    /// Width that the values seen need, in bits.
    #[must_use]
    pub fn needed(&self) -> u32 {
        self.reading.needed(self.least).max(self.reading.needed(self.greatest))
    }

    /// Every bit, most significant first: `0` or `1` where it was that in every sample, `-` where it toggled.
    #[must_use]
    pub fn stuck_bits(&self) -> String {
        let bit = |bit: u32| match (self.toggled >> bit & 1, self.stuck >> bit & 1) {
            (0, 0) => '0',
            (0, _) => '1',
            _ => '-',
        };
        (0..self.width.get()).rev().map(bit).collect()
    }

    /// The bits that never toggled among the lowest `bits`, the highest first.
    #[must_use]
    pub fn stuck_below(&self, bits: u32) -> Vec<StuckBits> {
        let mut found: Vec<StuckBits> = Vec::new();
        for bit in (0..bits.min(self.width.get())).rev().filter(|bit| self.toggled >> bit & 1 == 0) {
            let ones = self.stuck >> bit & 1 == 1;
            match found.last_mut().filter(|last| last.low == bit + 1 && last.ones == ones) {
                Some(last) => last.low = bit,
                None => found.push(StuckBits { high: bit, low: bit, ones }),
            }
        }
        found
    }
}

struct Watched {
    net: Net,
    column: usize,
    /// With the bits of [`turned`] turned over; `None` before the first sample.
    seen: Option<Extremes>,
    /// Strict cells move it down, up.
    moved: [bool; 2],
}

impl Watched {
    fn see(&mut self, later: Extremes) {
        self.seen = Some(self.seen.map_or(later, |seen| seen.and(later)));
    }
}

/// Watches every named register.
pub struct RangeWatch {
    registers: Vec<RegisterRange>,
    watched: Vec<Watched>,
    /// Index of the first of them in a digest.
    first: usize,
}

impl RangeWatch {
    /// All named registers of a machine, in the order of the wave.
    #[must_use]
    pub fn new(bench: &Testbench) -> RangeWatch {
        let netlist = bench.design().netlist();
        let widths = &bench.hardware().widths;
        let mut watch = RangeWatch { registers: Vec::new(), watched: Vec::new(), first: 0 };
        for named in &netlist.names {
            let cell = netlist.cell(named.net);
            // The extremes of a word of several columns are not known.
            if matches!(cell.op, Op::Register { .. }) && !named.is_wide() {
                let (column, moved) = (bench.columns().index(named.net), moved(netlist, named.net));
                watch.watched.push(Watched { net: named.net, column, seen: None, moved });
                // Where another register has its name, or it is known by its path, that is its name here.
                let (leaf, path) = (&named.name, netlist.path(named));
                let known = |name: &str| widths.contains_key(name);
                let taken = known(leaf) && watch.registers.iter().any(|other| other.name == *leaf);
                let name = if known(&path) || taken { path.clone() } else { leaf.clone() };
                watch.registers.push(RegisterRange {
                    name,
                    path,
                    width: cell.width,
                    reading: named.format.reading(),
                    least: 0,
                    greatest: 0,
                    toggled: 0,
                    stuck: 0,
                    held: holds(netlist, named.net, bench.machine().load.net),
                    limits: Vec::new(),
                });
            }
        }
        watch
    }

    /// The ranges seen so far.
    #[must_use]
    pub fn finish(mut self) -> Vec<RegisterRange> {
        for (range, Watched { seen, moved, .. }) in self.registers.iter_mut().zip(&self.watched) {
            let Some(seen) = seen else { continue };
            let number = |value| range.reading.number(range.width, value ^ turned(range));
            (range.least, range.greatest) = (number(seen.least), number(seen.greatest));
            range.toggled = seen.toggled;
            range.stuck = (seen.first ^ turned(range)) & !seen.toggled;
            let (least, greatest) = range.width.range(range.reading.is_signed());
            let [down, up] = *moved;
            range.limits.extend((down && least < 0 && range.least == least).then_some(least));
            range.limits.extend((up && range.greatest == greatest).then_some(greatest));
        }
        self.registers
    }
}

/// What makes both readings sort alike: two's complement has its sign bit turned over.
fn turned(range: &RegisterRange) -> u64 {
    if range.reading.is_signed() { range.width.sign_bit() } else { 0 }
}

/// A register changes where a block is loaded, and nowhere else.
fn holds(netlist: &Netlist, register: Net, load: Net) -> bool {
    let Op::Register { next: Some(mut next), .. } = netlist.cell(register).op else { return false };
    // The arms of `when`; one whose condition is the constant 0 counts for nothing.
    while let Op::Mux { select, low, .. } = netlist.cell(next).op
        && (select == load || matches!(netlist.cell(select).op, Op::Const(0)))
    {
        next = low;
    }
    next == register
}

/// A strict cell makes a register less, greater.
fn moved(netlist: &Netlist, register: Net) -> [bool; 2] {
    let mut moved = [false; 2];
    for property in &netlist.properties {
        if let Claim::NoOverflow { operation, left, right } = property.claim
            && left.net == register
        {
            moved[0] |= operation == Arithmetic::Sub || right.signed;
            moved[1] |= operation == Arithmetic::Add || right.signed;
        }
    }
    moved
}

impl Observer for RangeWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        let of = |seen: Extremes| (seen.least, seen.greatest, seen.first, seen.toggled);
        let extremes: Vec<_> = self.watched.iter().map(|watched| watched.seen.map(of)).collect();
        memory.insert("ranges".to_owned(), json!(extremes));
    }

    fn recall(&mut self, memory: &Memory) {
        let extremes: Vec<Option<(u64, u64, u64, u64)>> = recalled(memory, "ranges").unwrap_or_default();
        for (watched, extremes) in self.watched.iter_mut().zip(extremes) {
            watched.seen =
                extremes.map(|(least, greatest, first, toggled)| Extremes { least, greatest, first, toggled });
        }
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for (watched, range) in self.watched.iter_mut().zip(&self.registers) {
            if let Some(later) = rows.extremes(watched.column, turned(range)) {
                watched.see(later);
            }
        }
        Ok(())
    }

    fn want(&mut self, _: &Testbench, wanted: &mut Wanted) -> bool {
        self.first = wanted.ranges.len();
        wanted
            .ranges
            .extend(self.watched.iter().zip(&self.registers).map(|(watched, range)| (watched.net, turned(range))));
        true
    }

    fn digest(&mut self, digest: &Digest, _: &[u64]) {
        for (watched, later) in self.watched.iter_mut().zip(&digest.ranges[self.first..]) {
            watched.see(*later);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stuck_bits_are_reported_one_by_one_and_in_runs_of_the_same_value() {
        let range = RegisterRange {
            name: "r".to_owned(),
            path: "m.r".to_owned(),
            width: Width::new(8).unwrap(),
            reading: Reading::Unsigned,
            least: 0,
            greatest: 0,
            toggled: 0b0001_0010,
            stuck: 0b0110_0001,
            held: false,
            limits: Vec::new(),
        };
        assert_eq!(range.stuck_bits(), "011-00-1");
        let words = |bits| range.stuck_below(bits).iter().map(ToString::to_string).collect::<Vec<_>>();
        assert_eq!(words(8), ["[7] at 0", "[6:5] at 1", "[3:2] at 0", "[0] at 1"]);
        assert_eq!(words(3), ["[2] at 0", "[0] at 1"]);
        assert_eq!(words(0), [""; 0]);
        assert_eq!(words(99), words(8));
    }
}
