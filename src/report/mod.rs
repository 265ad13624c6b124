//! What a run came to, for people and for programs: summary, step table, JSON, picture.

mod after;
mod curve;
mod file;
mod geometry;
pub mod heat;
pub(crate) mod json;
mod output_path;
pub(crate) mod page;
pub mod plot;
mod png;
mod program;
mod speed;
mod speed_chart;
mod summary;
mod table;
mod workpiece;

use stepwave_engine::EngineKind;
use stepwave_models::events::Timed;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_models::{CutWord, Hardware, Model, Preset};
use stepwave_netlist::OnOverflow;

use crate::output::Sink;
use crate::program::CutWords;
use crate::testbench::{
    CUT_CLOCKS, Ending, Outcome, OutputTrack, OverflowEvent, OverflowTally, RegisterRange, Sent, Testbench,
};

pub use curve::OfCurve;
pub use file::{JsonFile, PathPicture, RunFile};
pub use geometry::{export_command, geometry, geometry_options, run_command, title};
pub use program::{MoveTable, OfProgram, TABLE_MOVES};
pub use speed::RelativeSpeed;
pub use table::{CsvTable, TEXTBOOK_STEPS, TextbookTable};
pub use workpiece::Workpiece;

use crate::testbench::point;

/// Most load words that were cut that a program's summary shows.
const SHOWN_CUTS: usize = 8;

/// Everything known about a finished run.
#[derive(Debug)]
#[non_exhaustive]
pub struct Report {
    /// The model.
    pub model: &'static Model,
    /// What was run, and what is known of that kind of run alone.
    pub subject: Subject,
    /// The hardware, with every choice made.
    pub hardware: Hardware,
    /// What simulated it.
    pub engine: EngineKind,
    /// How it ended.
    pub outcome: Outcome,
    /// What each register held.
    pub ranges: Vec<RegisterRange>,
    /// Load words that did not fit in their registers, and what these took.
    pub cut: CutWords,
    /// The first overflows in full.
    pub overflows: Vec<OverflowEvent>,
    /// Number of overflows.
    pub overflow_count: u64,
    /// The overflows of each component.
    pub tallies: Vec<OverflowTally>,
    /// Paths of the properties that end a run where overflows trap.
    pub traps: Vec<String>,
    /// Clock in Hz.
    pub clock_hz: f64,
    /// One BLU in millimetres.
    pub blu_mm: f64,
    /// What the operator did.
    pub events: Vec<Timed>,
    /// What went out after the filters of acceleration after the interpolator, where there are any.
    pub sent: Option<Sent>,
}

/// What a run is of.
#[derive(Debug)]
pub enum Subject {
    /// A curve of a model.
    Curve(Box<OfCurve>),
    /// A whole program.
    Program(Box<OfProgram>),
}

impl Report {
    /// A report whose results are still empty.
    pub(crate) fn new(model: &'static Model, subject: Subject, bench: &Testbench) -> Report {
        let (pulses, reached, counters) = (Vec::new(), Vec::new(), Vec::new());
        let properties = bench.design().netlist().properties.iter();
        let traps = properties.filter(|property| bench.machine().traps.contains(&property.never));
        Report {
            model,
            subject,
            hardware: bench.hardware().clone(),
            engine: EngineKind::Compiled,
            outcome: Outcome { ending: Ending::Done, clocks: 0, steps: 0, pulses, reached, counters },
            ranges: Vec::new(),
            cut: CutWords::default(),
            overflows: Vec::new(),
            overflow_count: 0,
            tallies: Vec::new(),
            traps: traps.map(|property| property.name.clone()).collect(),
            clock_hz: 0.0,
            blu_mm: 0.0,
            events: Vec::new(),
            sent: None,
        }
    }

    /// The curve, of a run of one.
    #[must_use]
    pub fn curve(&self) -> Option<&OfCurve> {
        match &self.subject {
            Subject::Curve(of) => Some(of),
            Subject::Program(_) => None,
        }
    }

    /// The program, of a run of one.
    #[must_use]
    pub fn program(&self) -> Option<&OfProgram> {
        match &self.subject {
            Subject::Curve(_) => None,
            Subject::Program(of) => Some(of),
        }
    }

    /// One line for the wave's header: what was run, and the choices made.
    #[must_use]
    pub fn title(&self) -> String {
        let title = match &self.subject {
            Subject::Curve(of) => title(self.model, &self.hardware, &of.curve),
            Subject::Program(of) => of.title(self),
        };
        let events = self.events.iter().map(|event| format!("; event {event}"));
        title + &events.collect::<String>()
    }

    /// What was run and by which method, for people.
    #[must_use]
    pub fn headline(&self) -> String {
        match &self.subject {
            Subject::Curve(of) => format!("{}: {}", self.model.name, geometry(&of.curve)),
            Subject::Program(of) if self.model.is_described() => format!("{} by {}", of.file_name(), self.model.title),
            Subject::Program(of) => format!("{} by {}", of.file_name(), self.model.title.to_lowercase()),
        }
    }

    /// The picture of the run, still without points.
    pub(crate) fn picture(&self, bench: &Testbench, out: Sink) -> Box<dyn RunFile> {
        match &self.subject {
            Subject::Curve(of) => Box::new(PathPicture::new(of, self.hardware.clocks_of_step(), out)),
            Subject::Program(of) => {
                let picture = Workpiece::new(&self.headline(), out);
                let picture = picture.with_speed(self.clock_hz, self.blu_mm, of.blu_degrees);
                Box::new(picture.with_output(OutputTrack::of(bench)))
            }
        }
    }

    /// The end point was reached exactly; that of every move of a program.
    #[must_use]
    pub fn end_exact(&self) -> bool {
        match &self.subject {
            Subject::Curve(of) => self.outcome.ends(&of.curve),
            Subject::Program(of) => of.totals.missed == 0,
        }
    }

    /// Bits that a register needs: for the values that it held, and on a curve for the results that did not fit.
    #[must_use]
    pub fn needed_bits(&self, range: &RegisterRange) -> u32 {
        let of_range = |tally: &&OverflowTally| tally.first.component() == range.path;
        let own = self.curve().and_then(|_| self.tallies.iter().find(of_range));
        own.and_then(|tally| tally.needed).unwrap_or(1).max(range.needed())
    }

    /// Sentences for who chooses widths: how far ranges and bits needed can be trusted, and what did not fit; of a
    /// program also how many feeds were out of reach. They come from values that were reached: neither bits to spare nor a
    /// register that was just wide enough gives one.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.cut_sentences();
        if let Subject::Program(of) = &self.subject {
            warnings.extend(of.limited(self));
            warnings.extend(self.announced());
            return warnings;
        }
        let clocks = self.outcome.clocks;
        let cut = |why: &str| format!("ranges and bits needed are those up to clock {clocks} alone, where {why}");
        match self.outcome.ending {
            Ending::Trapped => {
                warnings.push(cut("the run was stopped"));
                let others = self.tallies.iter().filter(|tally| !self.is_trap(tally));
                warnings.extend(others.map(OverflowTally::sentence));
                return warnings;
            }
            Ending::Stalled { .. } | Ending::Endless { .. } | Ending::Limit => {
                warnings.push(cut("the machine was given up"));
                return warnings;
            }
            Ending::Done => {}
        }
        if self.model.is_described() {
            warnings.extend(self.announced());
            return warnings;
        }
        warnings.extend(self.tallies.iter().map(|tally| self.went_on(tally)));
        let since = self.tallies.first().map(|tally| format!("after clock {}", tally.first.clock()));
        if let Some(since) = if self.cut.count == 0 { since } else { Some("from the load on".to_owned()) } {
            warnings.push(format!(
                "what registers held {since} is not what the method makes of this curve, so ranges and bits needed say \
                 little about it",
            ));
        }
        warnings
    }

    /// What operators of own hardware lost, whose author decides what that means.
    fn announced(&self) -> impl Iterator<Item = String> {
        let own = self.tallies.iter().filter(|tally| self.model.is_described() && !tally.is_assertion());
        own.filter(|tally| self.outcome.ending != Ending::Trapped || !self.is_trap(tally)).map(OverflowTally::sentence)
    }

    /// The component is one at whose first violation a run ends.
    fn is_trap(&self, tally: &OverflowTally) -> bool {
        self.traps.iter().any(|trap| trap == tally.first.component())
    }

    /// Load words that were cut, each with its line of a program, or its block of several of a curve.
    fn cut_sentences(&self) -> Vec<String> {
        let shown = if self.program().is_some() { SHOWN_CUTS } else { usize::MAX };
        let several = self.curve().is_some_and(|of| of.blocks > 1);
        let sentence = |(line, word): &(u64, CutWord)| match line {
            0 if several => format!("block {}: {word}", word.block + 1),
            0 => word.to_string(),
            line => format!("line {line}: {word}"),
        };
        let mut sentences: Vec<String> = self.cut.first.iter().take(shown).map(sentence).collect();
        if self.cut.count > shown as u64 {
            sentences.push(format!("{} load words did not fit; --json FILE lists more", self.cut.count));
        }
        sentences
    }

    /// How often a component overflowed while the run went on.
    fn went_on(&self, tally: &OverflowTally) -> String {
        let (component, clock) = (tally.first.component(), tally.first.clock());
        let times = if tally.count == 1 { "once".to_owned() } else { format!("{} times", tally.count) };
        let did = match (&tally.first, self.hardware.get(&ON_OVERFLOW)) {
            (OverflowEvent::Undefined { undefined, .. }, _) => {
                return format!("{}: {component} {times}, first at clock {clock}", undefined.description());
            }
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
        let (clocks, position) = (self.outcome.clocks, point(&self.outcome.reached));
        // Of a program, where in it.
        // Before the first block there is no line.
        let line = self.program().filter(|of| of.totals.line > 0);
        let line = line.map(|of| format!("line {}: ", of.totals.line)).unwrap_or_default();
        let mut failures = Vec::new();
        match self.outcome.ending {
            Ending::Trapped => {
                if self.model.is_described() {
                    let trap = self.tallies.iter().find(|tally| self.is_trap(tally));
                    return trap.map(|tally| format!("{line}{}", tally.placed())).into_iter().collect();
                }
                let event = self.overflows.last();
                return event
                    .map(|event| format!("{line}{event}{}", remedy(event, &self.hardware)))
                    .into_iter()
                    .collect();
            }
            Ending::Limit => {
                let cut = if self.cut.count > 0 { ", with a load word that was cut" } else { "" };
                return vec![match &self.subject {
                    Subject::Curve(_) => {
                        format!("not done after {clocks} clocks{cut}, at {position}: give a greater --max-clocks")
                    }
                    Subject::Program(_) if self.model.is_described() => format!(
                        "{line}given up at clock {clocks}{cut}: a block has {CUT_CLOCKS} clocks, or the program as many as \
                         --max-clocks says"
                    ),
                    Subject::Program(_) => {
                        format!("{line}given up at clock {clocks}{cut}: give a greater --max-clocks, or leave it out")
                    }
                }];
            }
            Ending::Endless { since } => {
                let remedy = if self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap {
                    ""
                } else {
                    "; --on-overflow trap shows where it first went wrong"
                };
                return vec![format!(
                    "{line}the motion never ends: at clock {clocks}, at {position}, every register is what it was at clock \
                     {since}{remedy}"
                )];
            }
            Ending::Stalled { clocks } => {
                let is_other = self.hardware.presets.iter().any(|preset| *preset != Preset::Half);
                let remedy = if is_other && self.model.name == "dda-arc" {
                    "; give --preset half, with which no arc inside a quadrant stalls whose ends lie on its circle"
                } else if is_other && matches!(self.model.name, "dda-conic" | "dda-helix") {
                    "; give --preset half, with which curves whose ends lie on them exactly were never seen to stall"
                } else if !self.events.is_empty() {
                    "; the operator has held it, or not started the next block: give --event CLOCK:resume or CLOCK:start"
                } else {
                    ""
                };
                failures.push(format!(
                    "{line}stalled at {position}: no pulse for {clocks} clocks, and none will come{remedy}"
                ));
            }
            Ending::Done => {}
        }
        if self.model.is_described() {
            let broken = self.tallies.iter().filter(|tally| tally.is_assertion());
            failures.extend(broken.map(OverflowTally::sentence));
        }
        match &self.subject {
            Subject::Curve(of) => {
                failures.extend(self.wrong_counters());
                failures.extend(of.failures(self));
            }
            Subject::Program(of) => {
                failures.extend(of.totals.failures.iter().cloned());
                failures.extend(self.wrong_counters());
            }
        }
        failures.extend(self.after_failures());
        failures
    }

    /// A sentence for each position counter that does not show where the pulses led.
    fn wrong_counters(&self) -> Vec<String> {
        let outcome = &self.outcome;
        let shown = outcome.counters.iter().zip(&outcome.reached).zip(&outcome.pulses).zip(self.hardware.letters());
        let wrong = shown.filter(|(((counter, place), _), _)| counter != place);
        wrong
            .map(|(((counter, place), pulses), axis)| {
                format!(
                    "the counter {axis} shows {counter}, {pulses} pulses were given: it is wrong, the pulses led to {place}"
                )
            })
            .collect()
    }
}

fn remedy(event: &OverflowEvent, hardware: &Hardware) -> String {
    let leaf = event.component().rsplit('.').next().unwrap_or_default();
    if let Some(remedy) = hardware.remedy(leaf) {
        return format!(": {remedy}, or go on with --on-overflow wrap");
    }
    match (event, event.exact()) {
        (OverflowEvent::Overflow { signed, .. }, Some((exact, needed))) if *signed || exact >= 0 => {
            let width = hardware.widening(leaf, needed, needed);
            format!(": give --width {width}, or go on with --on-overflow wrap or saturate")
        }
        (OverflowEvent::Overflow { .. } | OverflowEvent::Wide { .. }, _) => {
            "; go on with --on-overflow wrap or saturate".to_owned()
        }
        (OverflowEvent::Undefined { .. }, _) => String::new(),
        (OverflowEvent::Invariant { .. }, _) => ": the model is wrong, please report this".to_owned(),
    }
}
