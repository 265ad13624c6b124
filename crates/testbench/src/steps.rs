//! The step table, read out of samples: row 0 is the state after load, row k that after step k.

use fearless_simd::{Level, dispatch};
use stepwave_engine::{Digest, Rows};
use stepwave_netlist::bits::to_signed;

use serde_json::json;

use super::ahead::{self, StepTrains};
use super::checkpoint::{GREATEST, Memory, recalled};
use super::tool::signed;
use super::{Ending, Outcome, Testbench};

/// A row of the step table.
#[derive(Clone, Debug)]
pub struct Step {
    /// Number of the step, from 0.
    pub number: u64,
    /// Clock of the sample.
    pub clock: u64,
    /// Registers of the machine's table, in its order.
    pub registers: Vec<i128>,
    /// The same in the sample before: what the step began with, of a machine that takes a step a clock.
    pub used: Vec<i128>,
    /// Pulses of the step: -1, 0 or +1 of each axis.
    pub pulses: Vec<i64>,
    /// Where the pulses led after the step, in BLU.
    pub position: Vec<i64>,
    /// What the position counters show after the step, in BLU.
    pub counters: Vec<i64>,
}

/// Columns of the nets that make the step table.
#[derive(Clone, Debug)]
pub(super) struct StepColumns {
    pub(super) loaded: usize,
    pub(super) stepped: usize,
    pub(super) pulses: Vec<usize>,
    pub(super) positions: Vec<usize>,
    pub(super) table: Vec<usize>,
}

impl StepColumns {
    pub(super) fn of(bench: &Testbench) -> StepColumns {
        let machine = bench.machine();
        let at = |net| bench.columns().index(net);
        StepColumns {
            loaded: at(machine.loaded.net),
            stepped: at(machine.stepped.net),
            pulses: machine.pulses.iter().map(|port| at(port.net)).collect(),
            positions: machine.positions.iter().map(|port| at(port.net)).collect(),
            table: machine.table.iter().map(|(_, port)| at(port.net)).collect(),
        }
    }

    /// A sample completes a row of the table; `first` if there was none before.
    #[inline]
    pub(super) fn completes(&self, rows: &Rows, row: usize, first: bool) -> bool {
        rows.value(self.stepped, row) == 1 || first && rows.value(self.loaded, row) == 1
    }

    /// Number of steps that a block completes.
    pub(super) fn count(&self, rows: &Rows) -> u64 {
        rows.column(self.stepped).iter().sum()
    }
}

/// What the pulses of an axis in a block come to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Pulses {
    /// In either direction.
    pulses: u64,
    /// Forward less backward.
    moved: i64,
    /// Samples up to the last pulse.
    last: u64,
}

#[inline(always)]
fn count_pulses(values: &[u64]) -> Pulses {
    let mut counted = Pulses::default();
    let (mut samples, mut last) = (0_i64, 0);
    // Blocks are short: nothing wraps, and without checks and branches several samples are taken at once.
    for &pulse in values {
        samples = samples.wrapping_add(1);
        counted.pulses = counted.pulses.wrapping_add(pulse & 1);
        counted.moved = counted.moved.wrapping_add(signed(pulse));
        last = last.max(if pulse == 0 { 0 } else { samples });
    }
    counted.last = last.cast_unsigned();
    counted
}

/// What is written down: rows, pulses, clock of the last, where they led, and what the counters show.
type Gathered = (u64, Vec<u64>, u64, Vec<i64>, Vec<i64>);

/// Counts steps and pulses, and makes the rows of the table where somebody wants them.
pub(super) struct StepReader<'a> {
    bench: &'a Testbench,
    columns: StepColumns,
    /// Where a digest has them.
    digested: StepTrains,
    pub(super) step: Step,
    /// Rows of the table so far, and how many of them were the first of their block.
    rows: u64,
    first_rows: u64,
    /// Rows before the block that runs.
    before_block: u64,
    /// The block that runs has no row yet.
    fresh: bool,
    /// The sample before completed a row: the pulses of the next step are counted anew.
    row_complete: bool,
    /// Bits of the registers of the table in the sample before.
    before: Vec<u64>,
    pulses: Vec<u64>,
    pub(super) last_pulse: u64,
    level: Level,
    /// Where the pulses led, and what the counters show.
    position: Vec<i64>,
    counters: Vec<i64>,
}

impl<'a> StepReader<'a> {
    pub(super) fn new(bench: &'a Testbench) -> StepReader<'a> {
        let machine = bench.machine();
        let axes = machine.pulses.len();
        let step = Step {
            number: 0,
            clock: 0,
            registers: vec![0; machine.table.len()],
            used: vec![0; machine.table.len()],
            pulses: vec![0; axes],
            position: vec![0; axes],
            counters: vec![0; axes],
        };
        StepReader {
            bench,
            columns: StepColumns::of(bench),
            digested: StepTrains::default(),
            step,
            rows: 0,
            first_rows: 0,
            before_block: 0,
            fresh: true,
            row_complete: false,
            before: vec![0; machine.table.len()],
            pulses: vec![0; axes],
            last_pulse: 0,
            level: Level::new(),
            position: bench.start.clone(),
            counters: vec![0; axes],
        }
    }

    /// Counts what a block of samples holds.
    pub(super) fn count(&mut self, rows: &Rows) {
        let axes = self.pulses.iter_mut().zip(&mut self.position);
        for ((pulses, place), &column) in axes.zip(&self.columns.pulses) {
            let values = rows.column(column);
            let counted = dispatch!(self.level, _simd => count_pulses(values));
            *pulses += counted.pulses;
            *place = place.saturating_add(counted.moved);
            if counted.last > 0 {
                self.last_pulse = self.last_pulse.max(rows.first_clock() + counted.last - 1);
            }
        }
        let mut from = 0;
        if self.fresh {
            let first = (0..rows.len()).find(|&row| self.columns.completes(rows, row, true));
            self.first_row(first.is_some());
            from = first.map_or(rows.len(), |row| row + 1);
        }
        self.rows += rows.column(self.columns.stepped)[from..].iter().sum::<u64>();
        if !rows.is_empty() {
            self.show(rows, rows.len() - 1);
        }
    }

    fn show(&mut self, rows: &Rows, row: usize) {
        self.show_columns(|column| rows.value(column, row));
    }

    fn show_columns(&mut self, value: impl Fn(usize) -> u64) {
        let ports = &self.bench.machine().positions;
        for ((place, &column), port) in self.counters.iter_mut().zip(&self.columns.positions).zip(ports) {
            *place = to_signed(port.width, value(column));
        }
    }

    /// Says where digests have steps and pulses.
    pub(super) fn want(&mut self, trains: StepTrains) {
        self.digested = trains;
    }

    /// The block that runs has a row.
    pub(super) fn has_row(&self) -> bool {
        !self.fresh
    }

    /// Counts what many samples hold, in none of which the machine is loaded and none of whose counters overflows; `last`
    /// are the columns of the last one.
    pub(super) fn digest(&mut self, digest: &Digest, last: &[u64]) {
        for (pulses, &train) in self.pulses.iter_mut().zip(&self.digested.pulses) {
            let train = &digest.trains[train];
            *pulses += ahead::count(train);
            if let Some(word) = train.iter().rposition(|&word| word != 0) {
                let clock = digest.first_clock + (word * digest.span) as u64 + u64::from(train[word].ilog2());
                self.last_pulse = self.last_pulse.max(clock);
            }
        }
        let before = self.counters.clone();
        self.rows += ahead::count(&digest.trains[self.digested.stepped]);
        self.show_columns(|column| last[column]);
        for ((place, before), now) in self.position.iter_mut().zip(before).zip(&self.counters) {
            *place = place.saturating_add(now - before);
        }
    }

    /// The machine has been loaded in this sample.
    pub(super) fn is_loaded(&self, rows: &Rows, row: usize) -> bool {
        rows.value(self.columns.loaded, row) == 1
    }

    /// A bit for each of 64 samples from `first` on, the first the lowest: 1 where the machine is loaded, pulses, or
    /// has completed a step.
    pub(super) fn eventful(&self, rows: &Rows, first: usize) -> u64 {
        let strobes = [self.columns.loaded, self.columns.stepped];
        strobes.iter().chain(&self.columns.pulses).fold(0, |seen, &column| seen | rows.nonzero(column, first))
    }

    /// Where the pulses led, in BLU.
    pub(super) fn position(&self) -> &[i64] {
        &self.position
    }

    /// The next row is row 0 of a block.
    pub(super) fn begin_block(&mut self) {
        (self.fresh, self.before_block) = (true, self.rows);
    }

    fn first_row(&mut self, complete: bool) {
        self.fresh &= !complete;
        self.first_rows += u64::from(complete);
        self.rows += u64::from(complete);
    }

    /// Takes a sample; true if it completes a row of the table, which is then in `step`, with its `registers` if they
    /// are wanted. In the place of [`count`](Self::count), for every [eventful](Self::eventful) sample from the first
    /// on.
    pub(super) fn sample(&mut self, rows: &Rows, row: usize, registers: bool) -> bool {
        if std::mem::take(&mut self.row_complete) || self.rows == 0 {
            self.step.pulses.fill(0);
        }
        for (axis, &column) in self.columns.pulses.iter().enumerate() {
            let pulse = signed(rows.value(column, row));
            if pulse == 0 {
                continue;
            }
            self.step.pulses[axis] += pulse;
            self.position[axis] = self.position[axis].saturating_add(pulse);
            self.pulses[axis] += 1;
            self.last_pulse = rows.clock(row);
        }
        if !self.columns.completes(rows, row, self.fresh) {
            return false;
        }
        if registers {
            self.registers(rows, row);
        }
        self.show(rows, row);
        self.step.position.copy_from_slice(&self.position);
        self.step.counters.copy_from_slice(&self.counters);
        self.step.number = self.rows - self.before_block;
        self.step.clock = rows.clock(row);
        if self.fresh {
            self.first_row(true);
        } else {
            self.rows += 1;
        }
        self.row_complete = true;
        true
    }

    fn registers(&mut self, rows: &Rows, row: usize) {
        let table = self.columns.table.iter().zip(&self.bench.machine().table);
        let values = self.step.registers.iter_mut().zip(&mut self.step.used).zip(&self.before);
        for (((value, used), &before), (&column, (_, port))) in values.zip(table) {
            let before = row.checked_sub(1).map_or(before, |row| rows.value(column, row));
            *value = port.reading.number(port.width, rows.value(column, row));
            *used = port.reading.number(port.width, before);
        }
    }

    /// All samples of the block have been taken one by one.
    pub(super) fn end_rows(&mut self, rows: &Rows) {
        let Some(last) = rows.len().checked_sub(1) else { return };
        self.show(rows, last);
        for (before, &column) in self.before.iter_mut().zip(&self.columns.table) {
            *before = rows.value(column, last);
        }
    }

    pub(super) fn remember(&self, memory: &mut Memory) {
        memory
            .insert("steps".to_owned(), json!([self.rows, self.pulses, self.last_pulse, self.position, self.counters]));
    }

    pub(super) fn recall(&mut self, memory: &Memory) {
        let gathered: Option<Gathered> = recalled(memory, "steps");
        let Some((rows, pulses, last_pulse, position, counters)) = gathered else { return };
        let axes = self.pulses.len();
        let counts = pulses.iter().chain([&rows, &last_pulse]).all(|&count| count <= GREATEST);
        if counts && pulses.len() == axes && position.len() == axes && counters.len() == axes {
            (self.rows, self.pulses, self.last_pulse) = (rows, pulses, last_pulse);
            (self.position, self.counters) = (position, counters);
            (self.fresh, self.first_rows) = (rows == 0, u64::from(rows > 0));
        }
    }

    pub(super) fn outcome(&self, ending: Ending, clocks: u64) -> Outcome {
        Outcome {
            ending,
            clocks,
            steps: self.rows - self.first_rows,
            pulses: self.pulses.clone(),
            reached: self.position.clone(),
            counters: self.counters.clone(),
        }
    }
}
