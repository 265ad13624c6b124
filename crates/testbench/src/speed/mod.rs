//! Speed: how fast the tool is along its path, from the rows of the step table.
//!
//! The speed after row k is |p_k - p_(k-32)| over the clocks between these two rows; where there are less than 32 steps,
//! that of all of them. Lengths are compared as squares of whole BLU, times squares of whole clocks, so that what is slowest
//! and what is fastest is exact.

mod even;
mod kernel;
mod relative;
mod row;
mod stream;
mod windows;

use fearless_simd::{Level, dispatch};
use num_bigint::BigUint;
use serde::{Deserialize, Serialize};
use serde_json::json;
use stepwave_engine::{Digest, Rows, Wanted};
use stepwave_models::Port;
use stepwave_netlist::bits::to_signed;

use super::ahead::{StepTrains, count};
use super::checkpoint::{Memory, recalled};
use super::tool::signed;
use super::{Observer, ObserverError, StepColumns, Testbench};
pub use relative::RelativeSpeed;
pub use row::SpeedRow;
use stream::{Many, Span, Stream};
pub(crate) use windows::Windows;

/// Samples looked at together.
const SPAN: usize = 64;

/// Some steps after one another: from where to where they led, and how long they took.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Window {
    /// Square of the distance of the two ends, in BLU².
    #[serde(with = "digits")]
    pub square: u128,
    /// Clocks between the rows of the two ends; at least 1.
    pub clocks: u64,
    /// Number of the last of the steps, from 1.
    pub step: u64,
}

impl Window {
    /// Speed in BLU a clock.
    #[must_use]
    pub fn speed(self) -> f64 {
        (self.square as f64).sqrt() / self.clocks as f64
    }

    /// The speed is less than another, exactly.
    fn is_slower(self, than: Window) -> bool {
        if self.clocks == than.clocks {
            return self.square < than.square;
        }
        let sides = [(self.square, than.clocks), (than.square, self.clocks)];
        let [a, b] = sides.map(|(square, clocks)| square.checked_mul(u128::from(clocks) * u128::from(clocks)));
        if let (Some(a), Some(b)) = (a, b) {
            return a < b;
        }
        let [a, b] = sides.map(|(square, clocks)| BigUint::from(square) * clocks * clocks);
        a < b
    }
}

/// A number beyond 64 bits as text.
mod digits {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(number: &u128, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(number)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<u128, D::Error> {
        String::deserialize(from)?.parse().map_err(D::Error::custom)
    }
}

/// How fast the tool was.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Speed {
    /// Clocks from row 0 of the step table to its last row; what loaded the first block is not among them.
    pub clocks: u64,
    /// The first slowest 32 steps.
    pub least: Window,
    /// The first fastest 32 steps.
    pub greatest: Window,
}

impl Windows {
    /// The speed so far; `None` without a step.
    pub(crate) fn speed(&self) -> Option<Speed> {
        let [least, greatest] = self.extremes()?;
        Some(Speed { clocks: self.elapsed(), least, greatest })
    }
}

/// The speed after each row of a step table, for who draws it.
#[derive(Clone, Debug)]
pub struct SpeedTrack(Windows);

impl SpeedTrack {
    /// Steps of a window.
    pub const STEPS: u64 = windows::WINDOW as u64;

    /// Before row 0, of this many axes.
    #[must_use]
    pub fn new(axes: usize) -> SpeedTrack {
        SpeedTrack(Windows::new(axes))
    }

    /// Takes the place of the tool in BLU after the next row, and its clock; gives the window that ends there.
    pub fn row(&mut self, place: &[i64], clock: u64) -> Option<Window> {
        self.0.row(place, clock)
    }
}

/// A position counter of the machine.
#[derive(Clone, Copy, Debug)]
struct Counter {
    column: usize,
    port: Port,
    /// Index of its range in a digest.
    range: usize,
    /// What it shows in the last sample.
    shown: i64,
}

/// Watches how fast the tool is.
pub struct SpeedWatch {
    columns: StepColumns,
    counters: Vec<Counter>,
    digested: StepTrains,
    windows: Windows,
    stream: Stream,
    /// Where the pulses led from the place of the first sample, in BLU.
    place: Vec<i64>,
    /// Every row was seen.
    is_whole: bool,
    /// Of a span.
    pulses: Vec<u64>,
    signs: Vec<i64>,
    level: Level,
}

impl SpeedWatch {
    /// Of a machine.
    #[must_use]
    pub fn new(bench: &Testbench) -> SpeedWatch {
        let columns = StepColumns::of(bench);
        let axes = columns.pulses.len();
        let ports = columns.positions.iter().zip(&bench.machine().positions);
        let counters = ports.map(|(&column, &port)| Counter { column, port, range: 0, shown: 0 }).collect();
        SpeedWatch {
            columns,
            counters,
            digested: StepTrains::default(),
            windows: Windows::new(axes),
            stream: Stream::new(axes),
            place: vec![0; axes],
            is_whole: true,
            pulses: vec![0; axes],
            signs: vec![1; axes],
            level: Level::new(),
        }
    }

    /// The speed so far; `None` without a step, or where some were not seen.
    #[must_use]
    pub fn finish(mut self) -> Option<Speed> {
        self.stream.end(&mut self.windows, &mut self.place);
        self.windows.speed().filter(|_| self.is_whole)
    }

    /// Takes some samples, whose pulses are in `pulses` and `signs`.
    #[inline(always)]
    fn span(&mut self, clock: u64, samples: usize, stepped: u64) {
        let SpeedWatch { windows, stream, place, pulses, signs, .. } = self;
        let span = Span { clock, samples, stepped, pulses, signs };
        if !stream.take(&span, windows, place) {
            one_by_one(&span, windows, place);
        }
    }

    /// Takes the words of a digest.
    #[inline(always)]
    fn words(&mut self, digest: &Digest) {
        let (trains, stepped) = (&digest.trains, &digest.trains[self.digested.stepped]);
        let many = Many { clock: digest.first_clock, stepped, trains, axes: &self.digested.pulses, signs: &self.signs };
        if digest.span == SPAN && self.stream.take_many(&many, &mut self.windows, &mut self.place) {
            return;
        }
        let clocks = (digest.first_clock..).step_by(digest.span);
        for ((word, &stepped), clock) in stepped.iter().enumerate().zip(clocks) {
            for (pulses, &train) in self.pulses.iter_mut().zip(&self.digested.pulses) {
                *pulses = trains[train][word];
            }
            self.span(clock, digest.span, stepped);
        }
    }

    /// Takes samples that are recorded, at most [`SPAN`] from `first` on, but for the first `done` of them.
    fn recorded(&mut self, rows: &Rows, first: usize, done: usize) {
        let samples = (rows.len() - first).min(SPAN);
        let kept = u64::MAX << done;
        let stepped = rows.nonzero(self.columns.stepped, first) & kept;
        let mut is_even = true;
        for (axis, &column) in self.columns.pulses.iter().enumerate() {
            self.pulses[axis] = rows.nonzero(column, first) & kept;
            let values = &rows.column(column)[first + done..first + samples];
            let moved = dispatch!(self.level, _simd => moved(values));
            self.signs[axis] = moved.signum();
            is_even &= moved.unsigned_abs() == u64::from(self.pulses[axis].count_ones());
        }
        let clock = rows.first_clock() + first as u64;
        if is_even {
            return self.span(clock, samples, stepped);
        }
        // An axis turns: sample by sample.
        for row in done..samples {
            for (axis, &column) in self.columns.pulses.iter().enumerate() {
                let pulse = signed(rows.value(column, first + row));
                (self.pulses[axis], self.signs[axis]) = (u64::from(pulse != 0), pulse);
            }
            self.span(clock + row as u64, 1, stepped >> row & 1);
        }
    }
}

/// Pulses forward, less those backward.
#[inline(always)]
fn moved(pulses: &[u64]) -> i64 {
    pulses.iter().fold(0, |sum, &pulse| sum.wrapping_add(signed(pulse)))
}

/// Takes a span row by row.
fn one_by_one(span: &Span<'_>, windows: &mut Windows, place: &mut [i64]) {
    let (mut before, mut rest) = (0, span.stepped);
    let advance = |place: &mut [i64], samples: u64| {
        for (place, (pulses, sign)) in place.iter_mut().zip(span.pulses.iter().zip(span.signs)) {
            *place += sign * i64::from((pulses & samples).count_ones());
        }
    };
    while rest != 0 {
        // Up to the one that completes the step.
        let so_far = rest ^ (rest - 1) | before;
        advance(place, so_far & !before);
        windows.row(place, span.clock + u64::from(rest.trailing_zeros()));
        (before, rest) = (so_far, rest & (rest - 1));
    }
    advance(place, !before);
}

/// What is written down: the rows, and where the pulses led.
type Gathered = (Windows, Vec<i64>);

impl Observer for SpeedWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        let (mut windows, mut place) = (self.windows.clone(), self.place.clone());
        self.stream.clone().end(&mut windows, &mut place);
        memory.insert("speed".to_owned(), json!((windows, place)));
    }

    fn recall(&mut self, memory: &Memory) {
        let gathered: Option<Gathered> = recalled(memory, "speed");
        let axes = self.place.len();
        let sound = gathered.filter(|(windows, place)| windows.is_sound(axes, place));
        self.is_whole = sound.is_some();
        if let Some((windows, place)) = sound {
            (self.windows, self.place) = (windows, place);
        }
    }

    fn want(&mut self, bench: &Testbench, wanted: &mut Wanted) -> bool {
        self.digested = StepTrains::want(bench, wanted);
        for counter in &mut self.counters {
            counter.range = wanted.range(counter.port.net, counter.port.width.sign_bit());
        }
        true
    }

    fn suffices(&self, digest: &Digest) -> bool {
        self.windows.row.is_some() && (0..self.place.len()).all(|axis| self.direction(digest, axis).is_some())
    }

    fn digest(&mut self, digest: &Digest, last: &[u64]) {
        for (sign, counter) in self.signs.iter_mut().zip(&mut self.counters) {
            let shown = to_signed(counter.port.width, last[counter.column]);
            // All pulses have one direction: else the digest was not taken.
            *sign = (shown - counter.shown).signum();
            counter.shown = shown;
        }
        dispatch!(self.level, _simd => self.words(digest));
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let mut done = 0;
        if self.windows.row.is_none() {
            let Some(first) = (0..rows.len()).find(|&row| self.columns.completes(rows, row, true)) else {
                return Ok(());
            };
            self.windows.row(&self.place, rows.clock(first));
            done = first + 1;
        }
        while done < rows.len() {
            let first = done - done % SPAN;
            self.recorded(rows, first, done % SPAN);
            done = first + SPAN;
        }
        if let Some(last) = rows.len().checked_sub(1) {
            for counter in &mut self.counters {
                counter.shown = to_signed(counter.port.width, rows.value(counter.column, last));
            }
        }
        Ok(())
    }
}

impl SpeedWatch {
    /// The direction of all pulses of an axis in a digest, 1 or -1; `None` where it may have turned. As many pulses lead as
    /// far as the counter went to one side only where none led back.
    fn direction(&self, digest: &Digest, axis: usize) -> Option<i64> {
        let Counter { port, range, shown, .. } = self.counters[axis];
        let train = &digest.trains[self.digested.pulses[axis]];
        let pulses = count(train);
        let number = |bits: u64| to_signed(port.width, bits ^ port.width.sign_bit());
        let [least, greatest] = [digest.ranges[range].least, digest.ranges[range].greatest].map(number);
        match (greatest.abs_diff(shown), least.abs_diff(shown)) {
            (up, _) if up == pulses && greatest >= shown => Some(1),
            (_, down) if down == pulses && least <= shown => Some(-1),
            _ => None,
        }
    }
}
