//! What a machine made of a block of a program, and the account that is kept of it while it runs.

use std::collections::VecDeque;
use std::ops::Range;

use stepwave_engine::Rows;
use stepwave_models::Promise;
use stepwave_nc::{Cause, Curve, Feed, Position, PulseBlock, ROUNDING_LIMIT, SegmentShape, Side, ToolMove};

use super::contour;
use super::speed::{Speed, Windows};
use super::steps::StepReader;
use super::{Observer, ObserverError, Step};

/// What is loaded at once of a block of a program: all of it, a sector of its arc, or a chord.
#[derive(Clone, Debug)]
pub struct Part {
    /// Number of the block in the program, from 1. Parts with the same number make up one block.
    pub index: u64,
    /// The block: a move of the tool, and what it became in whole BLU.
    pub block: PulseBlock,
    /// Length of that in BLU with its first part; 0 with the others.
    pub length: f64,
    /// Commanded feed in BLU per second; `None` where the machine runs as fast as it can.
    pub commanded: Option<f64>,
    /// Frequency of our pulse source in Hz; `None` where the hardware sets its own feed.
    pub source_hz: Option<f64>,
    /// The feed was out of reach of what sets it.
    pub limited: bool,
    /// What the method promises of it.
    pub promise: Option<Promise>,
    /// How far a chord may be off its arc or free curve, in BLU.
    pub chords: f64,
}

impl Part {
    /// A part that runs as fast as the machine can, of a method that promises nothing.
    #[must_use]
    pub fn new(index: u64, block: PulseBlock) -> Part {
        Part { index, block, length: 0.0, commanded: None, source_hz: None, limited: false, promise: None, chords: 0.0 }
    }
}

/// What a machine made of one block of a program: a move of the tool.
#[derive(Clone, Debug)]
pub struct BlockReport {
    /// The move.
    pub of: ToolMove,
    /// Clock after which it began.
    pub begun: u64,
    /// Clocks from there to the end of its last step.
    pub clocks: u64,
    /// Steps of the interpolator.
    pub steps: u64,
    /// Pulses of each axis.
    pub pulses: Vec<u64>,
    /// End point wanted, in BLU.
    pub wanted: Vec<i64>,
    /// End point reached, in BLU.
    pub reached: Vec<i64>,
    /// Length of the path in whole BLU.
    pub length: f64,
    /// Commanded feed in BLU per second; `None` where the machine runs as fast as it can.
    pub commanded: Option<f64>,
    /// Frequency of our pulse source in Hz; `None` where the hardware sets its own feed.
    pub source_hz: Option<f64>,
    /// The feed was out of reach of what sets it.
    pub limited: bool,
    /// Greatest distance from the commanded curve, in BLU.
    pub error: f64,
    /// Clock of the step after which that was seen first; 0 where it is 0.
    pub error_clock: u64,
    /// What its method promises of it.
    pub promise: Option<Promise>,
    /// Greatest distance of the tool's centre from the compensated contour, in BLU.
    pub off_compensated: f64,
    /// What the method, the rounding to pulses and chords promise of that together, in BLU.
    pub contour_bound: Option<f64>,
    /// The method promises nothing of one of its blocks.
    pub free: bool,
    /// Greatest distance of the tool's edge from the programmed contour, in BLU.
    pub off_programmed: Option<f64>,
    /// The axes along which its path is counted, and where it was along them after each step.
    along: Range<usize>,
    windows: Windows,
}

impl BlockReport {
    /// Before its first step.
    #[must_use]
    pub fn new(of: ToolMove, begun: u64, from: &[i64]) -> BlockReport {
        // x, y and z are always reported, as they are where the machine has two axes.
        let (place, axes, along) = (place_of(from), from.len().max(3), of.path_axes());
        BlockReport {
            of,
            begun,
            clocks: 0,
            steps: 0,
            pulses: vec![0; axes],
            wanted: place[..axes].to_vec(),
            reached: place[..axes].to_vec(),
            length: 0.0,
            commanded: None,
            source_hz: None,
            limited: false,
            error: 0.0,
            error_clock: 0,
            promise: None,
            off_compensated: 0.0,
            contour_bound: None,
            free: false,
            off_programmed: None,
            windows: Windows::begun(&place[along.clone()], begun),
            along,
        }
    }

    /// A step that ended at a place.
    fn step(&mut self, block: &PulseBlock, step: &Step) {
        let (clock, position) = (step.clock, place_of(&step.position));
        self.steps += 1;
        self.windows.row(&position[self.along.clone()], clock);
        self.clocks = clock - self.begun;
        self.reached.iter_mut().zip(position).for_each(|(reached, at)| *reached = at);
        if step.pulses.iter().all(|pulse| *pulse == 0) {
            return;
        }
        for (all, pulse) in self.pulses.iter_mut().zip(&step.pulses) {
            *all += pulse.unsigned_abs();
        }
        let error = block.deviation(&position);
        if error > self.error {
            (self.error, self.error_clock) = (error, step.clock);
        }
        // Within 2^52, as every position of a block is.
        let at = [0, 1, 2].map(|axis| position[axis] as f64);
        let off = contour::off_segment(&self.of.segment, at);
        self.off_compensated = self.off_compensated.max(off);
        let off_programmed = match self.of.cause {
            Cause::Programmed if self.of.side == Side::On && self.of.programmed == self.of.segment => Some(off),
            _ => contour::off_programmed(&self.of, at),
        };
        self.off_programmed = match (self.off_programmed, off_programmed) {
            (Some(most), Some(off)) => Some(most.max(off)),
            (most, off) => off.or(most),
        };
    }

    /// It ended where it should; a closed curve without a pulse was not run at all.
    #[must_use]
    pub fn end_exact(&self) -> bool {
        self.reached == self.wanted && (self.length == 0.0 || self.pulses.iter().any(|pulses| *pulses > 0))
    }

    /// The method kept what it promises.
    #[must_use]
    pub fn within_bound(&self) -> bool {
        self.promise.is_none_or(|promise| promise.is_kept(self.error))
    }

    /// The contour is as near as it is promised.
    #[must_use]
    pub fn within_contour(&self) -> bool {
        self.contour_bound.is_none_or(|bound| self.off_compensated <= bound + 1e-9)
    }

    /// Takes in what is known of a part before it runs.
    fn take(&mut self, part: &Part) {
        self.wanted.copy_from_slice(&part.block.to[..self.reached.len()]);
        self.length += part.length;
        self.commanded = part.commanded;
        self.source_hz = part.source_hz.map(|source| self.source_hz.map_or(source, |before| before.max(source)));
        self.limited |= part.limited;
        let Some(promise) = part.promise.filter(|_| !self.free) else {
            // One block without a promise leaves the move without one.
            (self.free, self.promise, self.contour_bound) = (true, None, None);
            return;
        };
        self.promise = Some(self.promise.map_or(promise, |before| promise.or_wider(before)));
        let drawn = matches!(part.block.curve, Curve::Line(_)) && self.of.segment.shape != SegmentShape::Line;
        let allowed = ROUNDING_LIMIT + contour::radii_apart(&self.of.segment) + if drawn { part.chords } else { 0.0 };
        let bound = promise.bound() + allowed;
        self.contour_bound = Some(self.contour_bound.map_or(bound, |before| before.max(bound)));
    }

    /// Number of the block: its N word, or its line where it has none.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.of.place.number.unwrap_or(self.of.place.line)
    }

    /// Mean speed in BLU per second; `None` of a block that was not run to its end point.
    #[must_use]
    pub fn reached_feed(&self, clock_hz: f64) -> Option<f64> {
        self.end_exact().then(|| self.length * clock_hz / self.clocks.max(1) as f64)
    }

    /// How fast it was, from its row 0 to its last; `None` without a step.
    #[must_use]
    pub fn speed(&self) -> Option<Speed> {
        self.windows.speed()
    }

    /// `line`, `arc`, `curve`, `chord` of a curve, and why where it was not programmed.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match (self.of.cause, self.of.segment.shape, self.of.feed) {
            (Cause::StartUp, ..) => "start-up",
            (Cause::Cancel, ..) => "cancel",
            (Cause::Inserted, SegmentShape::Line, _) => "inserted line",
            (Cause::Inserted, SegmentShape::Arc { .. }, _) => "inserted arc",
            (Cause::Programmed, _, Feed::Rapid) => "rapid",
            (Cause::Programmed, SegmentShape::Line, _) if self.of.chord => "chord",
            (Cause::Programmed, SegmentShape::Line, _) => "line",
            (Cause::Programmed, SegmentShape::Arc { .. }, _) => "arc",
            (_, SegmentShape::Bezier(_), _) => "curve",
        }
    }
}

/// A place, 0 along an axis that the machine has not.
fn place_of(values: &[i64]) -> Position {
    std::array::from_fn(|axis| values.get(axis).copied().unwrap_or(0))
}

/// The parts that the machine was given, and the account of the block that runs.
#[derive(Default)]
pub(super) struct Account {
    /// Parts that it has not begun with.
    given: VecDeque<Box<Part>>,
    running: Option<(Box<Part>, BlockReport)>,
}

impl Account {
    pub(super) fn give(&mut self, part: Option<Box<Part>>) {
        self.given.extend(part);
    }

    /// There is a block to be reported.
    pub(super) fn is_kept(&self) -> bool {
        self.running.is_some() || !self.given.is_empty()
    }

    /// The machine has begun with the next part in this sample; true if that is the first of its block.
    pub(super) fn begin(
        &mut self,
        rows: &Rows,
        row: usize,
        steps: &StepReader<'_>,
        observers: &mut [&mut dyn Observer],
    ) -> Result<bool, ObserverError> {
        let Some(part) = self.given.pop_front() else { return Ok(false) };
        if let Some((running, report)) = self.running.as_mut().filter(|(running, _)| running.index == part.index) {
            report.take(&part);
            *running = part;
            return Ok(false);
        }
        self.end(observers)?;
        let mut report = BlockReport::new(part.block.of, rows.clock(row), steps.position());
        report.take(&part);
        observers.iter_mut().try_for_each(|observer| observer.block_begun(&report))?;
        self.running = Some((part, report));
        Ok(true)
    }

    /// Takes in a row of the step table.
    pub(super) fn step(&mut self, step: &Step) {
        if let Some((part, report)) = self.running.as_mut().filter(|_| step.number > 0) {
            report.step(&part.block, step);
        }
    }

    /// Reports the block that ran last.
    pub(super) fn end(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), ObserverError> {
        let Some((_, report)) = self.running.take() else { return Ok(()) };
        observers.iter_mut().try_for_each(|observer| observer.block_ended(&report))
    }
}
