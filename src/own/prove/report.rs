//! Verdicts about a netlist: in lines, as sentences, as JSON.

use num_bigint::BigInt;
use serde_json::{Value, json};

use super::SecondOpinion;
use crate::netlist::cells::{Claim, Property};
use crate::prove::sat::Limit;
use crate::report::json::{event, joined, large};
use crate::testbench::OverflowEvent;

/// Verdicts about a netlist.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct ProveReport {
    /// Name of the design.
    pub design: String,
    /// Of each property that is to be proved.
    pub goals: Vec<Goal>,
    /// Inputs that are free in some sample.
    pub free: Vec<String>,
    /// The bench file that says which runs are looked at, if there is one.
    pub bench: Option<BenchReport>,
    /// Assumptions of the source and the bench file: runs that violate one are not looked at.
    pub assumed: Vec<String>,
    /// The last clock in which a violation was looked for of every goal that was open then, if there is one.
    pub bound: Option<u64>,
    /// Clocks in a row of the longest induction that was tried; `None` where none was.
    pub induction: Option<usize>,
    /// What ended the search before all goals were decided.
    pub limit: Option<Limit>,
    /// Why goals are open, if some are.
    pub open: Option<String>,
    /// What another solver says, if one was asked.
    pub second: Option<SecondOpinion>,
}

/// What a bench file says of all runs.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct BenchReport {
    /// The file.
    pub file: String,
    /// In words: inputs that it fixes, and what may lose carries.
    pub says: Vec<String>,
}

/// A property and its verdict.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Goal {
    /// Path of the component that it is about.
    pub name: String,
    /// What is claimed, in words.
    pub claim: String,
    /// `file:line` of its source, of imported hardware.
    pub source: Option<String>,
    /// What is known of it.
    pub verdict: Verdict,
}

/// What is known of a property.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// No run violates it.
    Proved {
        /// Clocks in a row without a violation that exclude one in the next.
        induction: usize,
    },
    /// A run violates it, as the simulator has shown.
    Counterexample(Counterexample),
    /// It is open.
    Unknown {
        /// The last clock up to which no run violates it, if there is one.
        clean: Option<u64>,
    },
}

/// A run with a violation; no run has one in an earlier clock.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Counterexample {
    /// The clock of the violation.
    pub clock: u64,
    /// What the simulator says of it.
    pub event: String,
    /// The same with its numbers.
    pub violation: OverflowEvent,
    /// The values of all inputs as CSV, a row a clock from clock 0 on: a [stimulus](crate::own::Stimulus::table).
    pub stimulus: String,
}

pub(super) fn clocks(count: u64) -> String {
    if count == 1 { "1 clock".to_owned() } else { format!("{count} clocks") }
}

impl ProveReport {
    /// The counterexamples, in the order of the goals.
    pub fn counterexamples(&self) -> impl Iterator<Item = &Counterexample> {
        self.goals.iter().filter_map(|goal| match &goal.verdict {
            Verdict::Counterexample(example) => Some(example),
            _ => None,
        })
    }

    /// Every goal is proved.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.goals.iter().all(|goal| matches!(goal.verdict, Verdict::Proved { .. }))
    }

    /// The report as JSON: `docs/own_hardware.md` has its fields.
    #[must_use]
    pub fn json(&self) -> Value {
        let is_open = |goal: &Goal| matches!(goal.verdict, Verdict::Unknown { .. });
        let verdict = match self.counterexamples().next() {
            Some(_) => "counterexample",
            None if self.goals.iter().any(is_open) => "unknown",
            None => "proved",
        };
        let limit = self.limit.map(|limit| match limit {
            Limit::Time => "time",
            Limit::Memory => "memory",
            Limit::Clock => "bound",
        });
        json!({
            "schema": 1,
            "design": self.design,
            "verdict": verdict,
            "bound": self.bound,
            "induction": self.induction,
            "limit": limit,
            "free": self.free,
            "assumptions": self.assumed,
            "bench": self.bench.as_ref().map(|BenchReport { file, says }| json!({ "file": file, "says": says })),
            "goals": self.goals.iter().map(Goal::json).collect::<Vec<_>>(),
            "solver": self.second.as_ref().map(SecondOpinion::json),
            "failures": self.failures(),
        })
    }

    /// Sentences that say what is wrong with the hardware or not known of it.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let refuted = |goal: &Goal| match &goal.verdict {
            Verdict::Counterexample(example) => Some(placed(goal, &example.event)),
            _ => None,
        };
        let open: Vec<&str> = self
            .goals
            .iter()
            .filter(|goal| matches!(goal.verdict, Verdict::Unknown { .. }))
            .map(|goal| goal.claim.as_str())
            .collect();
        let open = (!open.is_empty()).then(|| match &self.open {
            Some(why) => format!("not decided: {}; {why}", open.join(", ")),
            None => format!("not decided: {}", open.join(", ")),
        });
        let second = self.second.as_ref().and_then(SecondOpinion::failure);
        self.goals.iter().filter_map(refuted).chain(open).chain(second).collect()
    }
}

/// A sentence with the line of the source, where it does not name it anyway.
fn placed(goal: &Goal, sentence: &str) -> String {
    match &goal.source {
        Some(source) if !sentence.contains(source.as_str()) => format!("{source}: {sentence}"),
        _ => sentence.to_owned(),
    }
}

/// A value of a stimulus, decimal or with 0x, as JSON.
fn value(text: &str) -> Value {
    let digits = text.strip_prefix("0x").map_or((text, 10), |digits| (digits, 16));
    large(&BigInt::parse_bytes(digits.0.as_bytes(), digits.1).unwrap_or_default())
}

impl Counterexample {
    /// The inputs with their values, a row a clock.
    fn rows(&self) -> Value {
        let mut lines = self.stimulus.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let inputs = lines.next().unwrap_or_default();
        let rows = lines.map(|row| row.into_iter().map(value).collect::<Vec<_>>());
        json!({ "inputs": inputs, "rows": rows.collect::<Vec<_>>() })
    }
}

impl Goal {
    /// The goal and its verdict as JSON.
    fn json(&self) -> Value {
        let (verdict, more) = match &self.verdict {
            Verdict::Proved { induction } => ("proved", json!({ "induction": induction })),
            Verdict::Unknown { clean } => ("unknown", json!({ "bound": clean })),
            Verdict::Counterexample(example) => {
                let Counterexample { clock, event: text, violation, .. } = example;
                let event = event(violation);
                ("counterexample", json!({ "clock": clock, "event": event, "text": text, "stimulus": example.rows() }))
            }
        };
        let head = json!({ "name": self.name, "claim": self.claim, "source": self.source, "verdict": verdict });
        joined(head, more)
    }

    /// The verdict in a line.
    #[must_use]
    pub fn line(&self) -> String {
        match &self.verdict {
            Verdict::Proved { induction } => {
                let how = match induction {
                    0 => "in any state".to_owned(),
                    before => format!("by induction over {}", clocks(*before as u64)),
                };
                format!("PROVED at these widths: {}", placed(self, &format!("{} ({how})", self.claim)))
            }
            Verdict::Counterexample(example) => format!("COUNTEREXAMPLE: {}", placed(self, &example.event)),
            Verdict::Unknown { clean } => {
                let clean = clean.map_or_else(String::new, |clean| format!(" (no violation up to clock {clean})"));
                format!("UNKNOWN: {}", placed(self, &(self.claim.clone() + &clean)))
            }
        }
    }
}

/// What a property claims, in words.
pub(super) fn claimed(property: &Property) -> String {
    match property.claim {
        Claim::Invariant => format!("{} holds", property.name),
        Claim::Defined { undefined, .. } => format!("{}: no {}", property.name, undefined.description()),
        _ => format!("{} does not overflow", property.name),
    }
}
