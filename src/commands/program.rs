//! `stepwave program`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Write};
use std::path::Path;

use crate::engine::EngineKind;
use crate::models::Model;
use crate::models::options::TOLERANCE;
use crate::nc::Reading;
use crate::program::{Control, Estimate, Pace, Preparation, Stream, Survey, Totals};
use crate::report::{CsvTable, ProgramHead, ProgramJson, ProgramTable, ProgramTail, Workpiece};
use crate::testbench::{Ending, Observer, OverflowEvent, OverflowWatch, RangeWatch, Testbench};
use crate::trace::timescale::ClockTime;

use super::progress::Progress;
use super::run::Finished;
use super::size::Size;
use crate::Error;
use crate::cli::{HardwareArgs, ProgramArgs, TextArgs, Tool};
use crate::output::Outputs;
use crate::waves::{Sinks, Waves};

/// What the wave of a program begins with: where the machine is, how fast it is to be, and in which block.
const LEADING: [&str; 5] = ["axis_x.x", "axis_y.y", "program.feed", "program.block", "axis_z.z"];

/// Runs a whole program and writes what was asked for.
pub(crate) fn program(args: &ProgramArgs) -> Result<(), Error> {
    let mut outputs = Outputs::reading([&args.file]);
    simulate(args, &mut outputs)?.print(outputs)
}

/// Simulates and stages every output.
///
/// # Errors
/// Bad input, or an output cannot be written; nothing stands under a final name.
pub(crate) fn simulate(args: &ProgramArgs, outputs: &mut Outputs) -> Result<Finished, Error> {
    let finished = once(args, outputs, None)?;
    match &finished.trap {
        Some(event) if args.trace.options().shows_trap(event, args.outputs.files(&args.trace)) => {
            *outputs = Outputs::default();
            once(args, outputs, Some(event))
        }
        _ => Ok(finished),
    }
}

/// The tool table: radii in mm by D number.
fn tools(given: &[Tool]) -> Result<BTreeMap<u64, f64>, Error> {
    let mut tools = BTreeMap::new();
    for Tool { number, radius } in given {
        if let Some(before) = tools.insert(*number, *radius) {
            return Err(Error::Invalid(format!(
                "--tool gives D{number} two radii, {before} mm and {radius} mm: leave one of them out"
            )));
        }
    }
    Ok(tools)
}

/// A program, and what its machine is to be.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) file: &'a Path,
    pub(super) model: &'static Model,
    pub(super) text: &'a TextArgs,
    pub(super) hardware: &'a HardwareArgs,
    pub(super) clock_hz: f64,
}

impl<'a> Source<'a> {
    pub(super) fn of(args: &'a ProgramArgs) -> Source<'a> {
        let ProgramArgs { file, method, text, hardware, clock, .. } = args;
        Source { file, model: method, text, hardware, clock_hz: clock.clock_hz }
    }

    /// How the options want the program prepared.
    ///
    /// # Errors
    /// A tool has two radii.
    pub(super) fn preparation(&self) -> Result<Preparation, Error> {
        let text = self.text;
        Ok(Preparation {
            reading: Reading {
                blu: self.hardware.blu,
                integers: text.integers,
                tools: tools(&text.tool)?,
                tolerance: self.hardware.radii(),
                home: text.home.0,
            },
            scheme: text.compensation,
            corner: text.corner,
            chords: text.chords,
        })
    }

    /// Reads the program once and makes its machine.
    ///
    /// # Errors
    /// The program is wrong, or the machine cannot be as the options want it.
    pub(super) fn machine(self) -> Result<Prepared<'a>, Error> {
        let (model, preparation) = (self.model, self.preparation()?);
        let survey = Survey::of(open(self.file)?, model.moves()?, &preparation).map_err(|error| self.told(&error))?;
        // How far the radii of an arc may differ is not the machine's concern.
        let choices = self.hardware.choices().without(&TOLERANCE);
        let hardware = model.plan_program(&survey.size, &choices).map_err(|error| self.hardware.explain(error))?;
        let bench = Testbench::of_machine(hardware.clone(), model.machine(&hardware)?).as_hardware_loads();
        let pace = Pace { clock_hz: self.clock_hz, blu_mm: self.hardware.blu, rapid: self.text.rapid };
        Ok(Prepared { source: self, preparation, survey, bench, pace, name: self.file.display().to_string() })
    }

    fn told(&self, error: &dyn std::fmt::Display) -> Error {
        Error::Invalid(format!("{}: {error}", self.file.display()))
    }
}

/// The machine of a program.
pub(super) struct Prepared<'a> {
    source: Source<'a>,
    preparation: Preparation,
    survey: Survey,
    pub(super) bench: Testbench,
    pace: Pace,
    name: String,
}

impl Prepared<'_> {
    pub(super) fn head(&self, engine: EngineKind) -> ProgramHead<'_> {
        let (model, pace) = (self.source.model, self.pace);
        ProgramHead { file: &self.name, model, hardware: self.bench.hardware(), engine, pace }
    }

    /// Reads the program anew, and feeds its machine.
    ///
    /// # Errors
    /// It can no longer be read.
    pub(super) fn control(&self) -> Result<Control<'_, BufReader<File>>, Error> {
        let source = self.source;
        let moves = source.model.moves()?;
        let stream = Stream::new(open(source.file)?, moves, &self.preparation);
        let stream = stream.map_err(|error| source.told(&error))?;
        Ok(Control::new(stream, moves, &self.bench, self.pace))
    }

    /// What a run of it comes to.
    ///
    /// # Errors
    /// The program is wrong.
    fn estimate(&self) -> Result<Estimate, Error> {
        let (source, hardware) = (self.source, self.bench.hardware());
        let estimate = Estimate::of(open(source.file)?, source.model.moves()?, &self.preparation, hardware, self.pace);
        estimate.map_err(|error| source.told(&error))
    }
}

/// Simulates; the wave shows the operands of a trap that is known.
fn once(args: &ProgramArgs, outputs: &mut Outputs, trap: Option<&OverflowEvent>) -> Result<Finished, Error> {
    let mut prepared = Source::of(args).machine()?;
    let bench = prepared.bench.limited(args.simulation.max_clocks.unwrap_or(u64::MAX));
    let bench = if args.trace.wanted() { bench } else { bench.without_wave() };
    prepared.bench = trap.and_then(|event| bench.showing(event)).unwrap_or(bench);
    let (bench, head) = (&prepared.bench, prepared.head(args.simulation.engine));
    let time = ClockTime::from_hz(args.clock.clock_hz)?;
    if args.trace.wanted() {
        let size = Size::of(bench, &args.trace, time)?;
        size.check(&args.trace, args.simulation.max_clocks, &prepared.estimate()?)?;
    }
    // All are opened before the first is written: where one is refused, nothing stands on standard output.
    let options = args.trace.options();
    let sinks = Sinks::open(&options, outputs)?;
    let mut sink = |path: &Option<std::path::PathBuf>| path.as_deref().map(|path| outputs.open(path)).transpose();
    let (steps, json, plot) = (sink(&args.outputs.steps)?, sink(&args.outputs.json)?, sink(&args.outputs.plot)?);
    let waves = sinks.map(|sinks| Waves::new(bench, &options, sinks, time, &head.title())).transpose()?;
    let mut waves = waves.map(|waves| waves.beginning_with(&LEADING));
    let mut steps = steps.map(|sink| CsvTable::new(bench, sink)).transpose()?;
    let mut json = json.map(|sink| ProgramJson::new(head, sink)).transpose()?;
    let mut picture = plot.map(|sink| (Workpiece::new(&head.headline()), sink));
    let mut table = ProgramTable::new(head);
    let (mut totals, mut progress) = (Totals::default(), Progress::of(prepared.survey.moves, "moves"));
    let (mut overflow, mut ranges) = (OverflowWatch::new(bench), RangeWatch::new(bench));

    let mut observers: Vec<&mut dyn Observer> =
        vec![&mut overflow, &mut ranges, &mut totals, &mut table, &mut progress];
    observers.extend(waves.iter_mut().flat_map(Waves::observers));
    observers.extend(steps.as_mut().map(|table| table as &mut dyn Observer));
    observers.extend(json.as_mut().map(|json| json as &mut dyn Observer));
    observers.extend(picture.as_mut().map(|(picture, _)| picture as &mut dyn Observer));
    let mut control = prepared.control()?;
    let outcome = bench.run_fed(args.simulation.engine, &mut control, &mut observers)?;
    drop(observers);
    drop(progress);

    let (ranges, overflows, tallies) = (ranges.finish(), overflow.events(), overflow.tallies());
    let tail = ProgramTail {
        outcome: &outcome,
        totals: &totals,
        losses: &control.losses,
        ranges: &ranges,
        overflows: &overflows,
        tallies: &tallies,
    };
    let failures = tail.failures(bench.hardware());
    if let Some(waves) = waves {
        waves.finish(&overflows, outcome.clocks, outputs)?;
    }
    if let Some(steps) = steps {
        steps.finish()?;
    }
    if let Some(json) = json {
        json.finish(&tail, &failures)?;
    }
    if let Some((picture, mut sink)) = picture {
        sink.write_all(picture.svg().as_bytes())?;
        sink.flush()?;
    }
    let trap = overflows.first().filter(|_| outcome.ending == Ending::Trapped).cloned();
    Ok(Finished { text: table.text(&tail), failures, trap })
}

/// Opens the program; it is read twice.
fn open(path: &Path) -> Result<BufReader<File>, Error> {
    let trouble = |error: &dyn std::fmt::Display| Error::Invalid(format!("cannot read {}: {error}", path.display()));
    let found = path.metadata().map_err(|error| trouble(&error))?;
    if !found.is_file() {
        return Err(trouble(&"a program is read twice, which needs a file: save it in one"));
    }
    Ok(BufReader::new(File::open(path).map_err(|error| trouble(&error))?))
}
