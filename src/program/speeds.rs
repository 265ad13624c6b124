//! How fast a program ran, over all of its moves.

use crate::testbench::{BlockReport, SpeedWindow};

/// The slowest or the fastest 32 steps of a program.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SpeedAt {
    /// Seconds of v_max, one BLU in each pulse of the pulse source, that the same length takes, for each clock.
    seconds: f64,
    /// Line of the program.
    pub line: u64,
    /// Last of these steps in its move, from 1.
    pub step: u64,
}

impl SpeedAt {
    /// Speed over v_max at this clock.
    #[must_use]
    pub fn over(self, clock_hz: f64) -> f64 {
        self.seconds * clock_hz
    }
}

/// Speeds of the moves of a program over v_max, that of each move being the one of its pulse source.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Speeds {
    /// The first slowest 32 steps of a move.
    pub least: Option<SpeedAt>,
    /// The first fastest 32 steps of a move.
    pub greatest: Option<SpeedAt>,
    /// Seconds that all moves take at their v_max.
    seconds: f64,
    /// Clocks at which the first move began and the last one ended.
    begun: Option<u64>,
    ended: u64,
    /// A move did not reach its end.
    is_short: bool,
}

impl Speeds {
    /// Takes a move; one without steps, or of hardware that sets its own feed, counts with its clocks alone.
    pub(super) fn take(&mut self, report: &BlockReport) {
        self.begun.get_or_insert(report.begun);
        self.ended = report.begun + report.clocks;
        self.is_short |= !report.end_exact();
        let (Some(source), Some(speed)) = (report.source_hz, report.speed()) else { return };
        self.seconds += report.length / source;
        let line = report.of.place.line;
        let at = |window: SpeedWindow| SpeedAt { seconds: window.speed() / source, line, step: window.step };
        let (least, greatest) = (at(speed.least), at(speed.greatest));
        if self.least.is_none_or(|before| least.seconds < before.seconds) {
            self.least = Some(least);
        }
        if self.greatest.is_none_or(|before| greatest.seconds > before.seconds) {
            self.greatest = Some(greatest);
        }
    }

    /// Mean speed over v_max at this clock, from the first row of the step table to the last, waits between moves included;
    /// `None` where a move missed its end, or the speed of none is known.
    #[must_use]
    pub fn mean(&self, clock_hz: f64) -> Option<f64> {
        let clocks = self.ended - self.begun?;
        (!self.is_short && clocks > 0 && self.least.is_some()).then(|| self.seconds * clock_hz / clocks as f64)
    }
}
