//! `stepwave program`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::models::Model;
use crate::nc::Reading;
use crate::program::Preparation;
use crate::report::{MoveTable, TABLE_MOVES};
use crate::simulation::{Prepared, Simulation};
use crate::trace::timescale::ClockTime;

use super::progress::RunProgress;
use super::run::{Finished, Terminal};
use super::size::Size;
use super::view::View;
use crate::Error;
use crate::cli::{HardwareArgs, ProgramArgs, TextArgs, Tool};
use crate::output::Outputs;
use crate::waves::WaveOptions;

/// Runs a whole program and writes what was asked for.
pub(crate) fn program(args: &ProgramArgs) -> Result<(), Error> {
    let own = args.bench.files_of(Some(&args.method));
    let mut outputs = Outputs::reading([&args.file].into_iter().chain(&own));
    let view = View::new(&args.by_ending, &args.trace, args.outputs.plot.as_ref())?;
    simulate(args, &mut outputs)?.print(outputs, &view)
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

/// The run of a program on such hardware.
///
/// # Errors
/// A tool has two radii.
pub(super) fn simulation(
    file: &Path,
    model: &'static Model,
    text: &TextArgs,
    hardware: &HardwareArgs,
    clock_hz: f64,
) -> Result<Simulation, Error> {
    let default = Preparation::default();
    let (tools, home) = (tools(&text.tool)?, text.home.0);
    let reading = Reading {
        integers: text.integers,
        degrees: text.blu_rotary,
        tools,
        home,
        chords: text.chords.unwrap_or(default.reading.chords),
        whole: text.chords.is_none(),
        ..default.reading
    };
    let preparation = Preparation { reading, scheme: text.compensation, corner: text.corner };
    let simulation = Simulation::program(model, file).preparation(preparation).rapid(text.rapid).jump(text.jump);
    Ok(simulation.options(hardware.choices()).clock_hz(clock_hz).blu_mm(hardware.blu))
}

/// The waves that a command line wants.
fn waves(args: &ProgramArgs) -> WaveOptions {
    WaveOptions { every_clock: args.every_clock, ..args.trace.clone() }
}

/// The run that a command line wants.
pub(super) fn asked(args: &ProgramArgs) -> Result<Simulation, Error> {
    let ProgramArgs { file, method, bench, text, hardware, clock, simulation: how, outputs, .. } = args;
    let simulation = simulation(file, bench.machine(method)?, text, hardware, clock.clock_hz)?;
    let simulation = simulation.engine(how.engine).max_clocks(how.max_clocks).events(how.event.clone());
    let simulation = simulation.waves(waves(args));
    Ok(simulation.files(outputs.clone(), None))
}

/// Simulates and stages every output.
///
/// # Errors
/// Bad input, or an output cannot be written; nothing has got its final name.
pub(crate) fn simulate(args: &ProgramArgs, outputs: &mut Outputs) -> Result<Finished, Error> {
    let simulation = asked(args)?;
    let Prepared { bench, moves } = simulation.prepare().map_err(|error| args.hardware.explain(error))?;
    let bench = simulation.lean(bench);
    let time = ClockTime::from_hz(args.clock.clock_hz)?;
    if args.trace.wanted() {
        let waves = waves(args);
        let (size, estimate) = (Size::of(&bench, &waves, time)?, simulation.estimate(&bench)?);
        if let Some(estimate) = estimate {
            size.check(&waves, args.simulation.max_clocks, &estimate)?;
        }
    }
    let ran = simulation.run_on(bench, outputs, |_, _| {
        let table = MoveTable::new(args.clock.clock_hz, args.hardware.blu, args.text.blu_rotary);
        Ok(Terminal { table, progress: RunProgress::of_moves(moves) })
    })?;
    let table = ran.onlookers.table.render();
    let long = || format!("more than {TABLE_MOVES} moves: --json FILE writes the report of each\n");
    let text = format!("{}\n{}", table.unwrap_or_else(long), ran.report.summary());
    Ok(Finished { text, failures: ran.report.failures() })
}
