//! The account of all moves of a program.

use stepwave_models::CutWord;

use super::speeds::Speeds;
use crate::testbench::{BlockReport, Observer, ObserverError, missed};

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
    /// The line of the program whose block runs, or ran last; 0 before the first.
    pub line: u64,
    /// Moves.
    pub moves: u64,
    /// Clocks while a block ran.
    pub clocks: u64,
    /// Steps of the interpolator.
    pub steps: u64,
    /// Pulses of each axis.
    pub pulses: Vec<u64>,
    /// Moves that did not end at their end point.
    pub missed: u64,
    /// Moves whose path error, or distance from the compensated contour, was beyond what is promised.
    pub beyond: u64,
    /// Greatest distance from the commanded curve, in BLU.
    pub error: Greatest,
    /// Greatest distance from the compensated contour, in BLU.
    pub off_compensated: Greatest,
    /// Greatest distance from the programmed contour, in BLU.
    pub off_programmed: Greatest,
    /// How fast they were.
    pub speeds: Speeds,
    /// Moves that asked the pulse source for more than it can give.
    pub limited: u64,
    /// Sentences about what is wrong; the first few.
    pub failures: Vec<String>,
}

/// Load words that are kept.
const CUT_WORDS: usize = 100;
/// Sentences that are kept.
const FAILURES: usize = 8;

/// Moves to which standing still was nearer than any pulse.
#[derive(Clone, Copy, Debug, Default)]
pub struct LeftOut {
    /// How many.
    pub moves: u64,
    /// The farthest that such a move goes from there, in BLU.
    pub farthest: Greatest,
}

impl LeftOut {
    pub(super) fn take(&mut self, apart: f64, line: u64) {
        self.moves += 1;
        self.farthest.take(apart, line);
    }
}

/// Load words that did not fit in their registers.
#[derive(Clone, Debug, Default)]
pub struct CutWords {
    /// How many.
    pub count: u64,
    /// The first of a program, each with its line; all of a curve, with line 0.
    pub first: Vec<(u64, CutWord)>,
}

impl CutWords {
    /// Those of a curve.
    pub(crate) fn of_curve(words: &[CutWord]) -> CutWords {
        CutWords { count: words.len() as u64, first: words.iter().map(|word| (0, *word)).collect() }
    }

    /// Takes in those of a block of this line.
    pub(super) fn take(&mut self, line: u64, words: &[CutWord]) {
        self.count += words.len() as u64;
        let room = CUT_WORDS.saturating_sub(self.first.len());
        self.first.extend(words.iter().take(room).map(|word| (line, *word)));
    }
}

impl Observer for Totals {
    fn wants_steps(&self) -> bool {
        false
    }

    fn block_begun(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        self.line = block.of.place.line;
        Ok(())
    }

    fn block_ended(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        self.add(block);
        Ok(())
    }
}

impl Totals {
    fn add(&mut self, report: &BlockReport) {
        let line = report.of.place.line;
        self.moves += 1;
        self.clocks += report.clocks;
        self.steps += report.steps;
        self.pulses.resize(report.pulses.len(), 0);
        for (all, pulses) in self.pulses.iter_mut().zip(&report.pulses) {
            *all += pulses;
        }
        self.error.take(report.error, line);
        self.off_compensated.take(report.off_compensated, line);
        if let Some(off) = report.off_programmed {
            self.off_programmed.take(off, line);
        }
        self.limited += u64::from(report.limited);
        self.speeds.take(report);
        let mut fail = |what: String| {
            if self.failures.len() < FAILURES {
                self.failures.push(what);
            }
        };
        if !report.end_exact() {
            self.missed += 1;
            fail(format!("line {line}: {}", missed(&report.wanted, &report.reached)));
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
    use stepwave_models::find;
    use stepwave_nc::{Corner, Integers, Reading, Scheme};

    #[test]
    fn a_tool_beyond_what_is_promised_of_its_contour_fails() {
        let reading = Reading {
            blu: 0.01,
            degrees: 0.01,
            integers: Integers::Units,
            tools: BTreeMap::new(),
            tolerance: 0.0,
            chords: 0.5,
            whole: true,
            home: None,
        };
        let preparation = Preparation { reading, scheme: Scheme::B, corner: Corner::Straight };
        let text = "G21 G90 G1 X1 F100\n".as_bytes();
        let moves = find("ppc-machine").and_then(|model| model.moves()).expect("a machine");
        let mut stream = Stream::new(text, moves, &preparation).expect("a program");
        let Some(Ok(Item::Move(of, _))) = stream.next() else { panic!("no move") };
        let mut totals = Totals::default();
        let mut report = BlockReport::new(of, 0, &[0; 3]);
        (report.contour_bound, report.off_compensated) = (Some(1.5), 1.5);
        totals.add(&report);
        assert_eq!((totals.beyond, totals.failures.len()), (0, 0));
        report.off_compensated = 1.75;
        totals.add(&report);
        let said = "line 1: the tool's centre is 1.750 BLU off the contour, where method and rounding promise 1.500 BLU: \
                    choose a smaller --blu";
        assert_eq!((totals.beyond, totals.failures), (1, vec![said.to_owned()]));
    }
}
