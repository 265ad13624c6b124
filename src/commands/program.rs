//! `stepwave program`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Write};
use std::path::Path;

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
use crate::cli::{ProgramArgs, Tool};
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

/// How the options want the program prepared.
///
/// # Errors
/// A tool has two radii.
pub(super) fn preparation(args: &ProgramArgs) -> Result<Preparation, Error> {
    Ok(Preparation {
        reading: Reading {
            blu: args.hardware.blu,
            integers: args.integers,
            tools: tools(&args.tool)?,
            tolerance: args.hardware.radii(),
            home: args.home.0,
        },
        scheme: args.compensation,
        corner: args.corner,
        chords: args.chords,
    })
}

/// Simulates; the wave shows the operands of a trap that is known.
fn once(args: &ProgramArgs, outputs: &mut Outputs, trap: Option<&OverflowEvent>) -> Result<Finished, Error> {
    let family = args.method;
    let file = args.file.display().to_string();
    let told = |error: &dyn std::fmt::Display| Error::Invalid(format!("{file}: {error}"));
    let preparation = preparation(args)?;
    let survey = Survey::of(open(&args.file)?, family, &preparation).map_err(|error| told(&error))?;
    // How far the radii of an arc may differ is not the machine's concern.
    let choices = args.hardware.choices().without(&TOLERANCE);
    let hardware = family.plan(&survey.size, &choices).map_err(|error| args.hardware.told(error))?;
    let machine = family.machine(&hardware)?;
    let bench = Testbench::of_machine(hardware, machine)
        .as_hardware_loads()
        .limited(args.simulation.max_clocks.unwrap_or(u64::MAX));
    let bench = if args.trace.wanted() { bench } else { bench.without_wave() };
    let bench = trap.and_then(|event| bench.showing(event)).unwrap_or(bench);
    let time = ClockTime::from_hz(args.clock.clock_hz)?;
    let pace = Pace { clock_hz: args.clock.clock_hz, blu_mm: args.hardware.blu, rapid: args.rapid };
    let head = ProgramHead { file: &file, family, hardware: bench.hardware(), engine: args.simulation.engine, pace };

    if args.trace.wanted() {
        let text = open(&args.file)?;
        let estimate =
            Estimate::of(text, family, &preparation, bench.hardware(), pace).map_err(|error| told(&error))?;
        Size::of(&bench, &args.trace, time)?.check(&args.trace, args.simulation.max_clocks, &estimate)?;
    }
    // All are opened before the first is written: where one is refused, nothing stands on standard output.
    let options = args.trace.options();
    let sinks = Sinks::open(&options, outputs)?;
    let mut sink = |path: &Option<std::path::PathBuf>| path.as_deref().map(|path| outputs.open(path)).transpose();
    let (steps, json, plot) = (sink(&args.outputs.steps)?, sink(&args.outputs.json)?, sink(&args.outputs.plot)?);
    let waves = sinks.map(|sinks| Waves::new(&bench, &options, sinks, time, &head.title())).transpose()?;
    let mut waves = waves.map(|waves| waves.beginning_with(&LEADING));
    let mut steps = steps.map(|sink| CsvTable::new(&bench, sink)).transpose()?;
    let mut json = json.map(|sink| ProgramJson::new(head, sink)).transpose()?;
    let mut picture = plot.map(|sink| (Workpiece::new(&head.headline()), sink));
    let mut table = ProgramTable::new(head);
    let (mut totals, mut progress) = (Totals::default(), Progress::of(survey.moves, "moves"));
    let (mut overflow, mut ranges) = (OverflowWatch::new(&bench), RangeWatch::new(&bench));

    let mut observers: Vec<&mut dyn Observer> =
        vec![&mut overflow, &mut ranges, &mut totals, &mut table, &mut progress];
    observers.extend(waves.iter_mut().flat_map(Waves::observers));
    observers.extend(steps.as_mut().map(|table| table as &mut dyn Observer));
    observers.extend(json.as_mut().map(|json| json as &mut dyn Observer));
    observers.extend(picture.as_mut().map(|(picture, _)| picture as &mut dyn Observer));
    let stream = Stream::new(open(&args.file)?, family, &preparation).map_err(|error| told(&error))?;
    let mut control = Control::new(stream, family, &bench, pace);
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
