//! `stepwave run`.

use std::io::Write;
use std::path::PathBuf;

use crate::models::find;
use crate::report::plot::Plot;
use crate::report::{self, CsvTable, Report, TEXTBOOK_STEPS, TextbookTable};
use crate::testbench::{
    CoarseWatch, Ending, Observer, ObserverError, OverflowEvent, OverflowWatch, PathWatch, RangeWatch, SpacingWatch,
    Step, Testbench,
};
use crate::trace::timescale::ClockTime;

use super::geometry::{self, curve};
use super::progress::RunProgress;
use super::states::{Begin, States};
use super::wave::{Sinks, Waves, shows_trap};
use crate::cli::RunArgs;
use crate::failure::Failure;
use crate::output::{self, Outputs};

/// Models of which textbooks print the integrands that a step used.
const TEXTBOOK_MODELS: [&str; 3] = ["dda-arc", "dda-conic", "dda-helix"];

/// Runs a model and writes what was asked for.
pub(crate) fn run(args: &RunArgs) -> Result<(), Failure> {
    // States that exist are read; else they are an output.
    let mut outputs = Outputs::reading(args.checkpoints.iter().filter(|path| path.exists()));
    simulate(args, &mut outputs)?.tell(outputs)
}

/// A run whose outputs are staged.
pub(crate) struct Finished {
    /// Step table and summary for the terminal.
    pub(crate) text: String,
    /// What is wrong with the simulated hardware.
    pub(crate) failures: Vec<String>,
    /// What stopped the run.
    pub(crate) trap: Option<OverflowEvent>,
}

impl Finished {
    /// Puts the outputs under their names, and tells what there is to tell.
    ///
    /// # Errors
    /// An output cannot be written, or the simulated hardware failed a check.
    pub(super) fn tell(self, outputs: Outputs) -> Result<(), Failure> {
        let quiet = outputs.uses_stdout();
        outputs.commit()?;
        if !quiet {
            output::print(&self.text)?;
        }
        if self.failures.is_empty() { Ok(()) } else { Err(Failure::Check(self.failures)) }
    }
}

/// Simulates and stages every output.
///
/// # Errors
/// Bad input, or an output cannot be written; nothing stands under a final name.
pub(crate) fn simulate(args: &RunArgs, outputs: &mut Outputs) -> Result<Finished, Failure> {
    let finished = once(args, outputs, None)?;
    match &finished.trap {
        Some(event) if args.checkpoints.is_none() && shows_trap(&args.trace, &args.outputs, event) => {
            *outputs = Outputs::default();
            once(args, outputs, Some(event))
        }
        _ => Ok(finished),
    }
}

/// Simulates; the wave shows the operands of a trap that is known.
fn once(args: &RunArgs, outputs: &mut Outputs, trap: Option<&OverflowEvent>) -> Result<Finished, Failure> {
    let model = find(&args.model)?;
    if args.textbook && !TEXTBOOK_MODELS.contains(&model.name) {
        let (name, models) = (model.name, TEXTBOOK_MODELS.join(", "));
        return Err(Failure::Trouble(format!(
            "textbooks print the registers of {name} as the step table does: leave --textbook out; it is for {models}"
        )));
    }
    let time = ClockTime::from_hz(args.clock.clock_hz)?;
    let curve = curve(model.name, model.curve(), &args.geometry, args.hardware.radii())?;
    let choices = geometry::choices(model, &curve, &args.hardware, args.clock.clock_hz);
    let bench = Testbench::loading(model, &curve, &choices).map_err(|error| args.hardware.told(error))?;
    let bench = bench.limited_to(args.simulation.max_clocks);
    let bench = trap.and_then(|event| bench.showing(event)).unwrap_or(bench);
    let title = report::title(model, bench.hardware(), &curve);

    let states = States::of(args, &bench)?;
    // All are opened before the first is written: where one is refused, nothing stands on standard output.
    let sinks = Sinks::open(&args.trace, outputs)?;
    let mut open = |path: &Option<PathBuf>| path.as_deref().map(|path| outputs.open(path)).transpose();
    let (steps, mut json, plot) = (open(&args.outputs.steps)?, open(&args.outputs.json)?, open(&args.outputs.plot)?);
    let mut states = states.map(|states| states.open(outputs)).transpose()?;
    if outputs.uses_stdout() {
        no_table(args)?;
    }
    let mut waves = sinks.map(|sinks| Waves::new(&bench, &args.trace, sinks, time, &title)).transpose()?;
    let mut csv = steps.map(|sink| CsvTable::new(&bench, sink)).transpose()?;
    let mut picture = plot.map(|sink| (Picture(Plot::new(&curve)), sink));
    let (mut overflow, mut ranges) = (OverflowWatch::new(&bench), RangeWatch::new(&bench));
    let (mut path, mut table) = (PathWatch::new(&bench, &curve), TextbookTable::new(&bench, args.bits, args.textbook));
    let mut coarse = CoarseWatch::new(&bench, &curve);
    let (mut spacing, mut progress) = (SpacingWatch::new(&bench, &curve), RunProgress::new(&bench, &curve));

    let mut observers: Vec<&mut dyn Observer> = vec![&mut overflow, &mut ranges, &mut path, &mut spacing];
    observers.extend([&mut table as &mut dyn Observer, &mut progress]);
    observers.extend(coarse.as_mut().map(|coarse| coarse as &mut dyn Observer));
    observers.extend(waves.iter_mut().flat_map(Waves::observers));
    observers.extend(csv.as_mut().map(|csv| csv as &mut dyn Observer));
    observers.extend(picture.as_mut().map(|(picture, _)| picture as &mut dyn Observer));
    let engine = args.simulation.engine;
    let outcome = match &mut states {
        Some(Begin::New { states, .. }) => bench.run_keeping(engine, &mut observers, states)?,
        Some(Begin::At(state)) => bench.run_from(engine, &mut observers, state)?,
        None => bench.run(engine, &mut observers)?,
    };
    drop(observers);
    drop(progress);

    let report = Report {
        model,
        curve: &curve,
        hardware: bench.hardware(),
        engine: args.simulation.engine,
        outcome,
        ranges: ranges.finish(),
        worst: path.worst,
        coarse: coarse.and_then(|coarse| coarse.worst),
        trains: spacing.finish(),
        cut: bench.cut_words().to_vec(),
        blocks: bench.blocks(),
        overflows: overflow.events(),
        overflow_count: overflow.count,
        tallies: overflow.tallies(),
        clock_hz: args.clock.clock_hz,
        blu_mm: args.hardware.blu,
    };
    let begun = states.as_ref().and_then(Begin::clock);
    if let Some(states) = states {
        states.finish()?;
    }
    if let Some(waves) = waves {
        waves.finish(&report.overflows, report.outcome.clocks, outputs)?;
    }
    if let Some(csv) = csv {
        csv.finish()?;
    }
    if let Some(sink) = &mut json {
        writeln!(sink, "{:#}", report.json())?;
        sink.flush()?;
    }
    if let Some((Picture(mut plot), mut sink)) = picture {
        if let Some(event) = report.overflows.first() {
            plot.mark(&format!("overflow of {}", event.component()));
        }
        sink.write_all(plot.svg(&title_of_picture(&report)).as_bytes())?;
        sink.flush()?;
    }
    let mut text = text(&report, &table);
    text += &geometry::moved_center(&curve, &args.geometry).unwrap_or_default();
    if let Some(clock) = begun {
        text += &format!("begun from the state at clock {clock}; the report is that of the whole run\n");
    }
    let trap = report.overflows.first().filter(|_| report.outcome.ending == Ending::Trapped);
    Ok(Finished { text, failures: report.failures(), trap: trap.cloned() })
}

/// Refuses what is about the printed table, where a file is printed in its place.
fn no_table(args: &RunArgs) -> Result<(), Failure> {
    let given = [(args.textbook, "--textbook"), (args.bits, "--bits")].into_iter().find(|(given, _)| *given);
    given.map_or(Ok(()), |(_, option)| {
        Err(Failure::Trouble(format!(
            "{option} is for the printed table, but a file goes to standard output (-) in its place: leave one of them out"
        )))
    })
}

fn title_of_picture(report: &Report<'_>) -> String {
    format!("{}: {}", report.model.name, report::geometry(report.curve))
}

fn text(report: &Report<'_>, table: &TextbookTable) -> String {
    let table = table.render().unwrap_or_else(|| {
        format!("more than {TEXTBOOK_STEPS} steps: --steps FILE writes the step table, --plot FILE draws the path\n")
    });
    format!("{table}\n{}", report.summary())
}

/// Hands every position to the picture.
struct Picture(Plot);

impl Observer for Picture {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.0.point(&step.position);
        Ok(())
    }
}
