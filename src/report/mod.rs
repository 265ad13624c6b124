//! What a run came to, for people and for programs: summary, step table, JSON, picture.

mod command;
pub mod heat;
mod json;
mod part;
pub mod plot;
mod png;
mod program;
mod summary;
mod table;

use stepwave_kernel::OnOverflow;
use stepwave_kernel::engine::EngineKind;
use stepwave_models::{Hardware, Model, Preset};
use stepwave_nc::Curve;

use crate::testbench::{
    CoarseError, Ending, Outcome, OverflowEvent, OverflowTally, PulseTrain, RegisterRange, WorstError,
};

pub use command::{geometry_options, run_command};
pub use part::Part;
pub use program::{ProgramHead, ProgramJson, ProgramTable, ProgramTail, TABLE_MOVES};
pub use summary::{choices, geometry, title};
pub use table::{CsvTable, TEXTBOOK_STEPS, TextbookTable};

/// Room for rounding when a path error is compared with the method's bound, in BLU.
const ROUNDING: f64 = 1e-9;

/// Everything known about a finished run.
#[derive(Debug)]
pub struct Report<'a> {
    /// The model.
    pub model: &'static Model,
    /// What was to be interpolated.
    pub curve: &'a Curve,
    /// The hardware, with every choice made.
    pub hardware: &'a Hardware,
    /// What simulated it.
    pub engine: EngineKind,
    /// How it ended.
    pub outcome: Outcome,
    /// What each register held.
    pub ranges: Vec<RegisterRange>,
    /// Greatest path error.
    pub worst: Option<WorstError>,
    /// How far coarse points lie off the curve, of a machine that has such.
    pub coarse: Option<CoarseError>,
    /// The pulses of each axis.
    pub trains: Vec<PulseTrain>,
    /// The first overflows in full.
    pub overflows: Vec<OverflowEvent>,
    /// Number of overflows.
    pub overflow_count: u64,
    /// The overflows of each component.
    pub tallies: Vec<OverflowTally>,
    /// Clock in Hz.
    pub clock_hz: f64,
    /// One BLU in millimetres.
    pub blu_mm: f64,
}

impl Report<'_> {
    /// The end point was reached exactly.
    #[must_use]
    pub fn end_exact(&self) -> bool {
        self.outcome.reached == self.curve.to()
    }

    /// The path error stayed within the method's bound, where it has one.
    #[must_use]
    pub fn path_within_bound(&self) -> bool {
        match (&self.worst, self.hardware.error_bound) {
            (Some(worst), Some(bound)) => worst.error <= bound + ROUNDING,
            _ => true,
        }
    }

    /// Bits that a register needs: for the values that it held, and for the results that did not fit.
    #[must_use]
    pub fn needed_bits(&self, range: &RegisterRange) -> u32 {
        let own = self.tallies.iter().find(|tally| tally.first.component() == range.path);
        own.and_then(|tally| tally.needed).unwrap_or(1).max(range.needed())
    }

    /// Sentences for who chooses widths: how far ranges and bits needed can be trusted, and what did not fit. They come
    /// from values that were reached: neither bits to spare nor a register that was just wide enough gives one.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let clocks = self.outcome.clocks;
        let cut = |why: &str| vec![format!("ranges and bits needed are those up to clock {clocks} alone, where {why}")];
        match self.outcome.ending {
            Ending::Trapped => return cut("the run was stopped"),
            Ending::Stalled { .. } | Ending::Endless { .. } | Ending::Limit => {
                return cut("the machine was given up");
            }
            Ending::Done => {}
        }
        let mut warnings: Vec<String> = self.tallies.iter().map(|tally| self.went_on(tally)).collect();
        if let Some(tally) = self.tallies.first() {
            warnings.push(format!(
                "what registers held behind clock {} is not what the method makes of this curve, so ranges and bits \
                 needed say little about it",
                tally.first.clock()
            ));
        }
        warnings
    }

    /// How often a component overflowed while the run went on.
    fn went_on(&self, tally: &OverflowTally) -> String {
        let (component, clock) = (tally.first.component(), tally.first.clock());
        let times = if tally.count == 1 { "once".to_owned() } else { format!("{} times", tally.count) };
        let did = match (&tally.first, self.hardware.on_overflow) {
            (OverflowEvent::Invariant { .. }, _) => {
                return format!("invariant {component} did not hold {times}, first at clock {clock}");
            }
            (_, OnOverflow::Saturate) => "was held at an end of its range",
            _ => "wrapped around",
        };
        let held = match tally.needed {
            Some(needed) => format!("{needed} bits would have held every result"),
            None => "no unsigned width would have held every result".to_owned(),
        };
        format!("{component} {did} {times}, first at clock {clock}; {held}")
    }

    /// Sentences that say what is wrong with the simulated hardware; none if all is good.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        match self.outcome.ending {
            Ending::Trapped => {
                if let Some(event) = self.overflows.last() {
                    failures.push(event.to_string() + &way_out(event, self.hardware));
                }
                return failures;
            }
            Ending::Stalled { clocks } => {
                let position = summary::point(&self.outcome.reached);
                let by_curve = matches!(self.model.name, "dda-arc" | "dda-conic" | "dda-helix");
                let way_out = if by_curve && self.hardware.presets.iter().any(|preset| *preset != Preset::Half) {
                    "; give --preset half, with which curves whose ends lie on them exactly were never seen to"
                } else {
                    ""
                };
                failures.push(format!(
                    "the motion came to a stand at {position}: no pulse for {clocks} clocks, and none will come{way_out}"
                ));
            }
            Ending::Endless { since } => {
                let position = summary::point(&self.outcome.reached);
                let clock = self.outcome.clocks;
                let way_out = if self.hardware.on_overflow == OnOverflow::Trap {
                    ""
                } else {
                    "; --on-overflow trap shows where it lost its way"
                };
                failures.push(format!(
                    "the motion never ends: at clock {clock}, at {position}, every register is what it was at clock \
                     {since}{way_out}"
                ));
                return failures;
            }
            Ending::Limit => {
                failures.push(format!(
                    "not done after {} clocks, at {}: give a greater --max-clocks",
                    self.outcome.clocks,
                    summary::point(&self.outcome.reached)
                ));
                return failures;
            }
            Ending::Done => {}
        }
        if !self.end_exact() {
            let (wanted, reached) = (summary::point(self.curve.to()), summary::point(&self.outcome.reached));
            failures.push(format!("the end point {wanted} was missed: the machine stands at {reached}"));
        }
        if let (false, Some(worst), Some(bound)) = (self.path_within_bound(), &self.worst, self.hardware.error_bound) {
            let curve = match self.curve {
                Curve::Line(_) => "line",
                Curve::Arc(_) => "arc",
                Curve::Conic(_) => "conic",
                Curve::Helix(_) => "helix",
            };
            failures.push(format!(
                "the path left the {curve}: {:.3} BLU off at {} after step {}, where the method promises at most {bound} BLU",
                worst.error,
                summary::point(&worst.position),
                worst.step,
            ));
        }
        failures
    }
}

fn way_out(event: &OverflowEvent, hardware: &Hardware) -> String {
    let leaf = event.component().rsplit('.').next().unwrap_or_default();
    match (event, event.exact()) {
        (OverflowEvent::Overflow { signed, .. }, Some((exact, needed))) if *signed || exact >= 0 => {
            let width = hardware.widening(leaf, needed, needed);
            format!(": give --width {width}, or go on with --on-overflow wrap or saturate")
        }
        (OverflowEvent::Overflow { .. }, _) => "; go on with --on-overflow wrap or saturate".to_owned(),
        (OverflowEvent::Invariant { .. }, _) => ": the model is wrong, please report this".to_owned(),
    }
}
