//! What a machine made of one move of the tool, and of all of them.

use stepwave_models::{CutWord, Promise};
use stepwave_nc::{Cause, Curve, Feed, PulseBlock, ROUNDING_LIMIT, ToolMove, Way};

use super::deviation::{off_programmed, off_segment, radii_apart};
use super::feed::Ripple;

/// What a machine made of one move.
#[derive(Clone, Debug)]
pub struct MoveReport {
    /// The move.
    pub of: ToolMove,
    /// Clock behind which it began.
    pub begun: u64,
    /// Clocks from there to the end of its last step.
    pub clocks: u64,
    /// Steps of the interpolator.
    pub steps: u64,
    /// Pulses of each axis.
    pub pulses: [u64; 3],
    /// End point wanted, in BLU.
    pub wanted: [i64; 3],
    /// End point reached, in BLU.
    pub reached: [i64; 3],
    /// Length of the way in whole BLU.
    pub length: f64,
    /// Commanded feed in BLU per second; `None` where the machine runs as fast as it can.
    pub commanded: Option<f64>,
    /// Frequency of the pulse source in Hz.
    pub source_hz: f64,
    /// The pulse source was asked for more than it can give.
    pub limited: bool,
    /// Greatest distance from the curve that the machine was told, in BLU.
    pub error: f64,
    /// What its method promises of it.
    pub promise: Option<Promise>,
    /// Greatest distance of the tool's centre from the compensated contour, in BLU.
    pub off_compensated: f64,
    /// What the method, the rounding to pulses and chords promise of that together, in BLU.
    pub contour_bound: Option<f64>,
    /// The method promises nothing of one of its blocks.
    free: bool,
    /// Greatest distance of the tool's edge from the programmed contour, in BLU.
    pub off_programmed: Option<f64>,
    /// How evenly it went.
    pub ripple: Ripple,
}

impl MoveReport {
    /// Before its first step.
    #[must_use]
    pub(super) fn new(of: ToolMove, begun: u64, from: [i64; 3]) -> MoveReport {
        MoveReport {
            of,
            begun,
            clocks: 0,
            steps: 0,
            pulses: [0; 3],
            wanted: from,
            reached: from,
            length: 0.0,
            commanded: None,
            source_hz: 0.0,
            limited: false,
            error: 0.0,
            promise: None,
            off_compensated: 0.0,
            contour_bound: None,
            free: false,
            off_programmed: None,
            ripple: Ripple::new(from, begun),
        }
    }

    /// A step that ended at a place.
    pub(super) fn step(&mut self, block: &PulseBlock, clock: u64, pulses: [i64; 3], position: [i64; 3]) {
        self.steps += 1;
        self.clocks = clock - self.begun;
        self.reached = position;
        let count: u64 = pulses.iter().map(|pulse| pulse.unsigned_abs()).sum();
        if count == 0 {
            return;
        }
        for (all, pulse) in self.pulses.iter_mut().zip(pulses) {
            *all += pulse.unsigned_abs();
        }
        self.ripple.pulses(count, position, clock);
        self.error = self.error.max(block.deviation(position));
        // Within 2^52, as every position of a block is.
        let at = position.map(|c| c as f64);
        self.off_compensated = self.off_compensated.max(off_segment(&self.of.segment, at));
        self.off_programmed = match (self.off_programmed, off_programmed(&self.of, at)) {
            (Some(most), Some(off)) => Some(most.max(off)),
            (most, off) => off.or(most),
        };
    }

    /// It ended where it should.
    #[must_use]
    pub fn end_exact(&self) -> bool {
        self.reached == self.wanted
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

    /// Takes what the method promises of a block of the machine; `chords` is what a chord of an arc may be off it.
    pub(super) fn keep(&mut self, block: &PulseBlock, promise: Option<Promise>, chords: f64) {
        let Some(promise) = promise.filter(|_| !self.free) else {
            // One block without a promise leaves the move without one.
            (self.free, self.promise, self.contour_bound) = (true, None, None);
            return;
        };
        self.promise = Some(self.promise.map_or(promise, |before| promise.or_wider(before)));
        let drawn = matches!((&block.curve, self.of.segment.way), (Curve::Line(_), Way::Arc { .. }));
        let allowed = ROUNDING_LIMIT + radii_apart(&self.of.segment) + if drawn { chords } else { 0.0 };
        let bound = promise.bound() + allowed;
        self.contour_bound = Some(self.contour_bound.map_or(bound, |before| before.max(bound)));
    }

    /// Mean speed in BLU per second.
    #[must_use]
    pub fn reached_feed(&self, clock_hz: f64) -> f64 {
        self.length * clock_hz / self.clocks.max(1) as f64
    }

    /// `line`, `arc`, and why where it was not programmed.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match (self.of.cause, self.of.segment.way, self.of.feed) {
            (Cause::StartUp, ..) => "start-up",
            (Cause::Cancel, ..) => "cancel",
            (Cause::Inserted, Way::Line, _) => "inserted line",
            (Cause::Inserted, Way::Arc { .. }, _) => "inserted arc",
            (Cause::Programmed, _, Feed::Rapid) => "rapid",
            (Cause::Programmed, Way::Line, _) => "line",
            (Cause::Programmed, Way::Arc { .. }, _) => "arc",
        }
    }
}

/// The greatest of a number, and the line of the program where it was.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Greatest {
    /// The number.
    pub value: f64,
    /// The line, from 1; 0 before anything was seen.
    pub line: u64,
}

impl Greatest {
    fn take(&mut self, value: f64, line: u64) {
        if self.line == 0 || value > self.value {
            *self = Greatest { value, line };
        }
    }
}

/// All moves of a program.
#[derive(Clone, Debug, Default)]
pub struct Totals {
    /// Moves.
    pub moves: u64,
    /// Clocks while a block ran.
    pub clocks: u64,
    /// Steps of the interpolator.
    pub steps: u64,
    /// Pulses of each axis.
    pub pulses: [u64; 3],
    /// Moves that did not end at their end point.
    pub missed: u64,
    /// Moves whose path error, or distance from the compensated contour, was beyond what is promised.
    pub beyond: u64,
    /// Moves to which standing still was nearer than any pulse.
    pub left_out: u64,
    /// The farthest that such a move goes from there, in BLU.
    pub off_left_out: Greatest,
    /// Greatest distance from the curve that the machine was told, in BLU.
    pub error: Greatest,
    /// Greatest distance from the compensated contour, in BLU.
    pub off_compensated: Greatest,
    /// Greatest distance from the programmed contour, in BLU.
    pub off_programmed: Greatest,
    /// Moves that asked the pulse source for more than it can give.
    pub limited: u64,
    /// Load words that did not fit in their registers.
    pub cut_words: u64,
    /// The first of them, each with its line of the program.
    pub cut: Vec<(u64, CutWord)>,
    /// Sentences about what is wrong; the first few.
    pub failures: Vec<String>,
}

/// Load words that are kept.
const CUT_WORDS: usize = 100;
/// Sentences that are kept.
const FAILURES: usize = 8;

impl Totals {
    /// Takes the load words of a block of this line that were cut.
    pub(super) fn cut(&mut self, line: u64, words: &[CutWord]) {
        self.cut_words += words.len() as u64;
        let room = CUT_WORDS.saturating_sub(self.cut.len());
        self.cut.extend(words.iter().take(room).map(|word| (line, *word)));
    }

    pub(super) fn leave_out(&mut self, apart: f64, line: u64) {
        self.left_out += 1;
        self.off_left_out.take(apart, line);
    }

    pub(super) fn add(&mut self, report: &MoveReport) {
        let line = report.of.place.line;
        self.moves += 1;
        self.clocks += report.clocks;
        self.steps += report.steps;
        for (all, pulses) in self.pulses.iter_mut().zip(report.pulses) {
            *all += pulses;
        }
        self.error.take(report.error, line);
        self.off_compensated.take(report.off_compensated, line);
        if let Some(off) = report.off_programmed {
            self.off_programmed.take(off, line);
        }
        self.limited += u64::from(report.limited);
        let mut fail = |what: String| {
            if self.failures.len() < FAILURES {
                self.failures.push(what);
            }
        };
        if !report.end_exact() {
            self.missed += 1;
            let ([x, y, z], [a, b, c]) = (report.wanted, report.reached);
            fail(format!(
                "line {line}: the end point ({x}, {y}, {z}) was missed: the machine stands at ({a}, {b}, {c})"
            ));
        }
        if let (false, Some(promise)) = (report.within_bound(), report.promise) {
            self.beyond += 1;
            let error = report.error;
            fail(format!(
                "line {line}: the path is {error:.3} BLU off its curve, where the method promises at most {promise}"
            ));
        } else if let (false, Some(bound)) = (report.within_contour(), report.contour_bound) {
            self.beyond += 1;
            let off = report.off_compensated;
            fail(format!(
                "line {line}: the tool's centre is {off:.3} BLU off the contour, where method and rounding promise \
                 {bound:.3} BLU: choose a smaller --blu"
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::program::stream::{Item, Preparation, Stream};
    use stepwave_models::program::FAMILIES;
    use stepwave_nc::{Corner, Integers, Reading, Scheme};

    #[test]
    fn a_tool_beyond_what_is_promised_of_its_contour_fails() {
        let reading =
            Reading { blu: 0.01, integers: Integers::Units, tools: BTreeMap::new(), tolerance: 0.0, home: None };
        let preparation = Preparation { reading, scheme: Scheme::B, corner: Corner::Straight, chords: 0.5 };
        let text = "G21 G90 G1 X1 F100\n".as_bytes();
        let mut stream = Stream::new(text, FAMILIES[0], &preparation).expect("a program");
        let Some(Ok(Item::Move(of, _))) = stream.next() else { panic!("no move") };
        let mut totals = Totals::default();
        let report = MoveReport { contour_bound: Some(1.5), off_compensated: 1.5, ..MoveReport::new(of, 0, [0; 3]) };
        totals.add(&report);
        assert_eq!((totals.beyond, totals.failures.len()), (0, 0));
        totals.add(&MoveReport { off_compensated: 1.75, ..report });
        let told = "line 1: the tool's centre is 1.750 BLU off the contour, where method and rounding promise 1.500 BLU: \
                    choose a smaller --blu";
        assert_eq!((totals.beyond, totals.failures), (1, vec![told.to_owned()]));
    }
}
