//! The recipe of a run without a geometry: netlist and stimulus in; wave and report out.

use std::io::Write as _;
use std::path::PathBuf;

use serde_json::json;

use crate::Error;
use crate::engine::{EngineKind, Rows, Stop, Watch};
use crate::netlist::cells::{Claim, Property};
use crate::netlist::{Design, Netlist, elaborate};
use crate::output::Outputs;
use crate::report::json::{event, joined, tally as tally_json};
use crate::report::page::{self, Facts, RunRecord};
use crate::testbench::{CHUNK, Columns, Observer, ObserverError, OverflowEvent, OverflowTally, OverflowWatch};
use crate::trace::timescale::ClockTime;
use crate::waves::{Shown, Sinks, WaveOptions, Waves};

use super::printed::Printed;
use super::{Stimulus, announce, matching};

/// A run of a netlist by a stimulus.
#[derive(Clone, Debug)]
#[must_use = "nothing is simulated before `run`"]
pub struct Sim {
    design: Design,
    stimulus: Stimulus,
    clocks: u64,
    engine: EngineKind,
    clock_hz: f64,
    strict: Vec<String>,
    waves: WaveOptions,
    json: Option<PathBuf>,
}

/// What a run came to.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SimReport {
    /// Edges of the clock.
    pub clocks: u64,
    /// The strict property at whose violation it ended before.
    pub trap: Option<String>,
    /// The violations of each property that had some.
    pub tallies: Vec<OverflowTally>,
    /// Assumptions of the source that the stimulus violates, with the first clock of each.
    pub assumptions: Vec<(String, u64)>,
    /// Covers of the source, with the first clock in which each is reached.
    pub covers: Vec<(String, Option<u64>)>,
    /// The value of each named net in the last sample, in binary, by its path.
    pub last: Vec<(String, String)>,
}

impl Sim {
    /// A run over this many edges of the clock, with a clock of 1 MHz, on the compiled engine.
    pub fn new(design: Design, stimulus: Stimulus, clocks: u64) -> Sim {
        let (engine, waves) = (EngineKind::Compiled, WaveOptions::default());
        Sim { design, stimulus, clocks, engine, clock_hz: 1e6, strict: Vec::new(), waves, json: None }
    }

    /// On this engine. All give the same samples.
    pub fn engine(self, engine: EngineKind) -> Sim {
        Sim { engine, ..self }
    }

    /// With a clock of this frequency in Hz: the time axis of waves.
    pub fn clock_hz(self, hz: f64) -> Sim {
        Sim { clock_hz: hz, ..self }
    }

    /// Ended at the first violation of a property whose path matches one of these globs.
    pub fn strict(self, globs: Vec<String>) -> Sim {
        Sim { strict: globs, ..self }
    }

    /// What the operators lose whose path matches one of these globs is announced: it is shown as a flag, and not reported.
    ///
    /// # Errors
    /// A glob matches none of them, or [`strict`](Self::strict) has it too.
    pub fn wraps(mut self, globs: &[String]) -> Result<Sim, Error> {
        let mut netlist = self.design.netlist().clone();
        announce(&mut netlist, globs).map_err(|(glob, why)| Error::Invalid(format!("--wraps {glob}: {why}")))?;
        self.design = elaborate(netlist)?;
        Ok(self)
    }

    /// With these waves.
    pub fn waves(self, waves: WaveOptions) -> Sim {
        Sim { waves, ..self }
    }

    /// With the report as JSON in this file.
    pub fn json(self, path: Option<PathBuf>) -> Sim {
        Sim { json: path, ..self }
    }

    /// Simulates, and writes every file that is asked for: all of them or none. What the hardware prints goes nowhere.
    ///
    /// # Errors
    /// A glob matches nothing, or a file cannot be written.
    pub fn run(&self) -> Result<SimReport, Error> {
        self.run_printing(&mut std::io::sink())
    }

    /// As [`run`](Self::run); what the hardware prints, by `$display` of Verilog for example, is written while it runs.
    ///
    /// # Errors
    /// As those of [`run`](Self::run), or the text cannot be written.
    pub fn run_printing(&self, to: &mut dyn std::io::Write) -> Result<SimReport, Error> {
        let mut outputs = Outputs::default();
        let report = self.staged(&mut outputs, to)?;
        outputs.commit()?;
        Ok(report)
    }

    pub(crate) fn staged(&self, outputs: &mut Outputs, to: &mut dyn std::io::Write) -> Result<SimReport, Error> {
        let time = ClockTime::from_hz(self.clock_hz)?;
        let columns = Columns::of_design(&self.design);
        let shown = Shown { design: &self.design, columns: &columns, steps: None, running: None };
        let sinks = Sinks::open(&self.waves, outputs)?;
        let json = self.json.as_deref().map(|path| outputs.open(path)).transpose()?;
        let title = format!("{}; {} clocks", self.design.netlist().scopes[0].name, self.clocks);
        let mut waves = sinks.map(|sinks| Waves::new(shown, &self.waves, sinks, time, &title, None)).transpose()?;
        let page = page::open(&self.waves, outputs)?;
        let record = |out| Ok::<_, Error>((out, RunRecord::of_design(shown, &self.waves, page::limit(&self.waves))?));
        let mut page = page.map(record).transpose()?;
        let mut overflow = OverflowWatch::of(self.design.netlist(), &columns);
        let mut firsts = Firsts::of(self.design.netlist(), &columns);
        let mut printed = Printed::of(self.design.netlist(), &columns, time, to);
        let mut observers: Vec<&mut dyn Observer> = vec![&mut overflow, &mut firsts, &mut printed];
        observers.extend(waves.iter_mut().flat_map(Waves::observers));
        observers.extend(page.iter_mut().map(|(_, record)| record as &mut dyn Observer));
        let Run { clocks, trap, last } = self.clocked(&columns, &mut observers)?;
        drop(observers);
        if let Some(waves) = waves {
            waves.finish(&overflow.events(), clocks, outputs)?;
        }
        let (assumptions, covers) = (firsts.assumptions(), firsts.covers());
        let report = SimReport { clocks, trap, tallies: overflow.tallies(), assumptions, covers, last };
        if let Some(mut sink) = json {
            writeln!(sink, "{:#}", self.report_json(&report))?;
            sink.flush()?;
        }
        if let Some((out, record)) = page {
            page::write(out, record, &self.facts(&report, title))?;
        }
        Ok(report)
    }

    /// What a page says of the run.
    fn facts(&self, report: &SimReport, title: String) -> Facts {
        Facts {
            headline: self.design.netlist().scopes[0].name.clone(),
            title,
            summary: report.summary(),
            failures: report.failures(),
            warnings: report.events(),
            clock_hz: self.clock_hz,
            clocks: report.clocks,
            events: report.tallies.iter().map(|tally| tally.first.clone()).collect(),
            ..Facts::default()
        }
    }

    /// Properties that end the run.
    fn stops(&self) -> Result<Vec<&Property>, Error> {
        let mut stops = Vec::new();
        for glob in &self.strict {
            let all = self
                .design
                .netlist()
                .properties
                .iter()
                .filter(|property| !matches!(property.claim, Claim::Cover | Claim::Print { .. }));
            let found = matching(glob, all).map_err(|why| Error::Invalid(format!("--strict {glob}: {why}")))?;
            if let Some(announced) = found.iter().find(|property| property.claim.is_announced()) {
                return Err(Error::Invalid(format!(
                    "--strict {glob}: {} is announced to lose its carry: leave out --wraps, its attribute stepwave_wraps, or \
                     --strict",
                    announced.name
                )));
            }
            stops.extend(found);
        }
        Ok(stops)
    }

    /// Runs the clock.
    fn clocked(&self, columns: &Columns, observers: &mut [&mut dyn Observer]) -> Result<Run, Error> {
        let strict = self.stops()?;
        let stops = strict.iter().map(|property| property.never).collect();
        let watch = Watch { columns: columns.nets().to_vec(), stops };
        let mut engine = self.engine.build(&self.design, &watch);
        let mut rows = Rows::new(watch.columns.len(), CHUNK);
        let stimulus = &self.stimulus;
        stimulus.held().chain(stimulus.row(0)).for_each(|(net, value)| engine.set_input(net, value));
        engine.reset(&mut rows);
        let mut stop = watch.stops.iter().position(|&net| engine.value(net) == 1);
        while engine.clock() < self.clocks && stop.is_none() {
            let next = usize::try_from(engine.clock() + 1).unwrap_or(usize::MAX);
            let left = self.clocks - engine.clock();
            let burst = if next < stimulus.rows() {
                stimulus.row(next).for_each(|(net, value)| engine.set_input(net, value));
                1
            } else {
                left
            };
            if rows.is_full() {
                drain(&mut rows, observers)?;
            }
            if let Stop::Net(index) = engine.run(burst, &mut rows) {
                stop = Some(index);
            }
        }
        drain(&mut rows, observers)?;
        let netlist = self.design.netlist();
        let digits = |named| netlist.digits(named, |net| engine.value(net));
        let last = netlist.names.iter().map(|named| (netlist.path(named), digits(named)));
        let trap = stop.and_then(|index| strict.get(index)).map(|property| property.name.clone());
        Ok(Run { clocks: engine.clock(), trap, last: last.collect() })
    }

    fn report_json(&self, report: &SimReport) -> serde_json::Value {
        let events = report.tallies.iter().map(|tally| {
            let more = json!({ "first": event(&tally.first), "source": tally.source, "text": tally.first.to_string() });
            joined(tally_json(tally), more)
        });
        let firsts = |all: &mut dyn Iterator<Item = (&String, Option<u64>)>| {
            all.map(|(name, clock)| json!({ "name": name, "clock": clock })).collect::<Vec<_>>()
        };
        json!({
            "schema": 1,
            "design": self.design.netlist().scopes[0].name,
            "engine": self.engine.name(),
            "clock_hz": self.clock_hz,
            "clocks": report.clocks,
            "ending": if report.trap.is_some() { "trapped" } else { "done" },
            "events": events.collect::<Vec<_>>(),
            "assumptions": firsts(&mut report.assumptions.iter().map(|(name, clock)| (name, Some(*clock)))),
            "covers": firsts(&mut report.covers.iter().map(|(name, clock)| (name, *clock))),
            "last": report.last.iter().map(|(path, bits)| (path.clone(), json!(bits))).collect::<serde_json::Map<_, _>>(),
        })
    }
}

/// When assumptions and covers are 1 for the first time.
struct Firsts(Vec<First>);

struct First {
    name: String,
    is_cover: bool,
    column: usize,
    clock: Option<u64>,
}

impl Firsts {
    fn of(netlist: &Netlist, columns: &Columns) -> Firsts {
        let watched = |property: &&Property| matches!(property.claim, Claim::Assumption | Claim::Cover);
        let first = |property: &Property| First {
            name: property.name.clone(),
            is_cover: property.claim == Claim::Cover,
            column: columns.index(property.never),
            clock: None,
        };
        Firsts(netlist.properties.iter().filter(watched).map(first).collect())
    }

    fn assumptions(&self) -> Vec<(String, u64)> {
        let assumed = self.0.iter().filter(|first| !first.is_cover);
        assumed.filter_map(|first| Some((first.name.clone(), first.clock?))).collect()
    }

    fn covers(&self) -> Vec<(String, Option<u64>)> {
        self.0.iter().filter(|first| first.is_cover).map(|first| (first.name.clone(), first.clock)).collect()
    }
}

impl Observer for Firsts {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for first in self.0.iter_mut().filter(|first| first.clock.is_none() && rows.any(first.column)) {
            let found = (0..rows.len()).find(|&row| rows.value(first.column, row) == 1);
            first.clock = found.map(|row| rows.clock(row));
        }
        Ok(())
    }
}

/// How a run ended: after how many edges, by which strict property, and what every name had then, in binary.
struct Run {
    clocks: u64,
    trap: Option<String>,
    last: Vec<(String, String)>,
}

fn drain(rows: &mut Rows, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
    for observer in observers.iter_mut() {
        observer.samples(rows)?;
    }
    rows.clear();
    Ok(())
}

impl SimReport {
    /// How long it ran and what was violated, as a terminal shows it.
    #[must_use]
    pub fn summary(&self) -> String {
        let mut text = match self.tallies.len() {
            0 => format!("{} clocks; no property was violated\n", self.clocks),
            1 => format!("{} clocks; 1 property was violated\n", self.clocks),
            count => format!("{} clocks; {count} properties were violated\n", self.clocks),
        };
        for event in self.events() {
            text += &format!("warning: {event}\n");
        }
        for note in self.notes() {
            text += &format!("note: {note}\n");
        }
        text
    }

    /// Sentences about what the hardware did wrong: properties that were violated.
    #[must_use]
    pub fn events(&self) -> Vec<String> {
        self.tallies.iter().map(OverflowTally::sentence).collect()
    }

    /// Sentences about assumptions that the stimulus violates, and about covers.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let violated = |(name, clock): &(String, u64)| {
            format!(
                "{name} does not hold at clock {clock}: the stimulus does what the source excludes, and what follows counts for nothing"
            )
        };
        let reached = |(name, clock): &(String, Option<u64>)| match clock {
            Some(clock) => format!("{name} is reached at clock {clock}"),
            None => format!("{name} is never reached"),
        };
        self.assumptions.iter().map(violated).chain(self.covers.iter().map(reached)).collect()
    }

    /// Sentences that say what is wrong with the hardware: a trap, an assertion that did not hold.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let ends = |tally: &&OverflowTally| {
            matches!(tally.first, OverflowEvent::Invariant { .. })
                || self.trap.as_deref() == Some(tally.first.component())
        };
        self.tallies.iter().filter(ends).map(OverflowTally::placed).collect()
    }
}
