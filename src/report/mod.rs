//! What a run came to, for people and for programs: summary, step table, JSON, picture.

mod command;
pub mod heat;
mod json;

pub mod plot;
mod png;
mod program;
mod summary;
mod table;
mod workpiece;

use stepwave_engine::EngineKind;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_models::{CutWord, Hardware, Model, Preset, Promise};
use stepwave_nc::Curve;
use stepwave_netlist::OnOverflow;

use crate::testbench::{
    CoarseError, Ending, Outcome, OverflowEvent, OverflowTally, PulseTrain, RegisterRange, WorstError,
};

pub use command::{geometry_options, run_command};
pub use program::{ProgramHead, ProgramJson, ProgramTable, ProgramTail, TABLE_MOVES};
pub use summary::{choices, geometry, title};
pub use table::{CsvTable, TEXTBOOK_STEPS, TextbookTable};
pub use workpiece::Workpiece;

/// Everything known about a finished run.
#[derive(Debug)]
#[non_exhaustive]
pub struct Report {
    /// The model.
    pub model: &'static Model,
    /// What was to be interpolated.
    pub curve: Curve,
    /// The hardware, with every choice made.
    pub hardware: Hardware,
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
    /// Load words that did not fit in their registers, and what these took.
    pub cut: Vec<CutWord>,
    /// Blocks that the curve was loaded in.
    pub blocks: usize,
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

impl Report {
    /// The end point was reached exactly.
    #[must_use]
    pub fn end_exact(&self) -> bool {
        self.outcome.reached == self.curve.to()
    }

    /// Sentences about position counters that do not show where the pulses led.
    fn wrong_counters(&self) -> Vec<String> {
        wrong_counters(&self.outcome, &self.hardware)
    }

    /// What the method promises of the path, if it promises anything.
    #[must_use]
    pub fn promise(&self) -> Option<Promise> {
        Promise::of(self.hardware.error_bound, &self.curve)
    }

    /// The path error stayed within what the method promises.
    #[must_use]
    pub fn path_within_bound(&self) -> bool {
        self.worst.as_ref().zip(self.promise()).is_none_or(|(worst, promise)| promise.is_kept(worst.error))
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
        let mut warnings: Vec<String> = self.cut.iter().map(|word| self.of_block(word)).collect();
        let clocks = self.outcome.clocks;
        let cut = |why: &str| format!("ranges and bits needed are those up to clock {clocks} alone, where {why}");
        match self.outcome.ending {
            Ending::Trapped => {
                warnings.push(cut("the run was stopped"));
                return warnings;
            }
            Ending::Stalled { .. } | Ending::Endless { .. } | Ending::Limit => {
                warnings.push(cut("the machine was given up"));
                return warnings;
            }
            Ending::Done => {}
        }
        warnings.extend(self.tallies.iter().map(|tally| self.went_on(tally)));
        let since = self.tallies.first().map(|tally| format!("after clock {}", tally.first.clock()));
        if let Some(since) = if self.cut.is_empty() { since } else { Some("from the load on".to_owned()) } {
            warnings.push(format!(
                "what registers held {since} is not what the method makes of this curve, so ranges and bits needed say \
                 little about it",
            ));
        }
        warnings
    }

    /// A load word that was cut, with its block where there are several.
    fn of_block(&self, word: &CutWord) -> String {
        let word_of = if self.blocks > 1 { format!("block {}: ", word.block + 1) } else { String::new() };
        format!("{word_of}{word}")
    }

    /// How often a component overflowed while the run went on.
    fn went_on(&self, tally: &OverflowTally) -> String {
        let (component, clock) = (tally.first.component(), tally.first.clock());
        let times = if tally.count == 1 { "once".to_owned() } else { format!("{} times", tally.count) };
        let did = match (&tally.first, self.hardware.get(&ON_OVERFLOW)) {
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
                    failures.push(event.to_string() + &way_out(event, &self.hardware));
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
                failures
                    .push(format!("stalled at {position}: no pulse for {clocks} clocks, and none will come{way_out}"));
            }
            Ending::Endless { since } => {
                let position = summary::point(&self.outcome.reached);
                let clock = self.outcome.clocks;
                let way_out = if self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap {
                    ""
                } else {
                    "; --on-overflow trap shows where it first went wrong"
                };
                failures.push(format!(
                    "the motion never ends: at clock {clock}, at {position}, every register is what it was at clock \
                     {since}{way_out}"
                ));
                return failures;
            }
            Ending::Limit => {
                let cut = if self.cut.is_empty() { "" } else { ", with a load word that was cut" };
                failures.push(format!(
                    "not done after {} clocks{cut}, at {}: give a greater --max-clocks",
                    self.outcome.clocks,
                    summary::point(&self.outcome.reached)
                ));
                return failures;
            }
            Ending::Done => {}
        }
        failures.extend(self.wrong_counters());
        if !self.end_exact() {
            let (wanted, reached) = (summary::point(self.curve.to()), summary::point(&self.outcome.reached));
            failures.push(format!("the end point {wanted} was missed: the machine is at {reached}"));
        }
        if let (false, Some(worst), Some(promise)) = (self.path_within_bound(), &self.worst, self.promise()) {
            let curve = match self.curve {
                Curve::Line(_) => "line",
                Curve::Arc(_) => "arc",
                Curve::Conic(_) => "conic",
                Curve::Helix(_) => "helix",
            };
            failures.push(format!(
                "the path left the {curve}: {:.3} BLU off at {} after step {}, where the method promises at most {promise}",
                worst.error,
                summary::point(&worst.position),
                worst.step,
            ));
        }
        failures
    }
}

/// A sentence for each position counter that does not show where the pulses led.
fn wrong_counters(outcome: &Outcome, hardware: &Hardware) -> Vec<String> {
    let shown = outcome.counters.iter().zip(&outcome.reached).zip(&outcome.pulses).zip(hardware.letters());
    let wrong = shown.filter(|(((counter, place), _), _)| counter != place);
    wrong
        .map(|(((counter, place), pulses), axis)| {
            format!(
                "the counter {axis} shows {counter}, {pulses} pulses were given: it is wrong, the pulses led to {place}"
            )
        })
        .collect()
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
