//! `stepwave run`.

use crate::report::{Report, TEXTBOOK_STEPS, TextbookTable};
use crate::simulation::{Onlookers, Simulation};
use crate::testbench::Observer;
use crate::trace::timescale::ClockTime;

use super::geometry::{self, curve};
use super::progress::RunProgress;
use super::view::View;
use crate::Error;
use crate::cli::{MachineRun, RunArgs};
use crate::nc::Curve;
use crate::output::{self, Outputs};
use crate::waves::WaveOptions;

/// Models of which textbooks print the integrands that a step used.
pub(crate) const TEXTBOOK_MODELS: [&str; 3] = ["dda-arc", "dda-conic", "dda-helix"];

/// Runs a model and writes what was asked for.
pub(crate) fn run(args: &RunArgs) -> Result<(), Error> {
    // States that exist are read; else they are an output.
    let own = args.of.files(&args.model);
    let mut outputs = Outputs::reading(args.checkpoints.iter().filter(|path| path.exists()).chain(&own));
    let view = View::new(&args.by_ending, &args.trace, args.outputs.plot.as_ref())?;
    simulate(args, &mut outputs)?.print(outputs, &view)
}

/// A run whose outputs are staged.
pub(crate) struct Finished {
    /// Step table and summary for the terminal.
    pub(crate) text: String,
    /// What is wrong with the simulated hardware.
    pub(crate) failures: Vec<String>,
}

impl Finished {
    /// Puts the outputs under their names, and prints and shows what there is, as the view says.
    ///
    /// # Errors
    /// An output cannot be written, or the simulated hardware failed a check.
    pub(super) fn print(self, outputs: Outputs, view: &View) -> Result<(), Error> {
        let quiet = view.quiet || outputs.uses_stdout();
        outputs.commit()?;
        if !quiet {
            output::print(&self.text)?;
        }
        view.show()?;
        if self.failures.is_empty() { Ok(()) } else { Err(Error::Check(self.failures)) }
    }
}

/// What a terminal shows of a run.
pub(super) struct Terminal<T> {
    pub(super) table: T,
    pub(super) progress: RunProgress,
}

impl<T: Observer> Onlookers for Terminal<T> {
    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        vec![&mut self.table, &mut self.progress]
    }
}

/// Simulates and stages every output.
///
/// # Errors
/// Bad input, or an output cannot be written; nothing has got its final name.
pub(crate) fn simulate(args: &RunArgs, outputs: &mut Outputs) -> Result<Finished, Error> {
    let of = &args.of;
    let model = of.bench.model(&args.model)?;
    if args.textbook && !TEXTBOOK_MODELS.contains(&model.name) {
        let (name, models) = (model.name, TEXTBOOK_MODELS.join(", "));
        return Err(Error::Invalid(format!(
            "textbooks print the registers of {name} as the step table does: leave --textbook out; it is for {models}"
        )));
    }
    let (simulation, curve) = simulation(&args.model, of)?;
    let simulation = simulation
        .waves(WaveOptions { speed: args.trace_speed, ..args.trace.clone() })
        .files(args.outputs.clone(), args.checkpoints.clone());
    let bench = simulation.prepare().map_err(|error| of.hardware.explain(error))?.bench;
    let ran = simulation.run_on(bench, outputs, |bench, outputs| {
        if outputs.uses_stdout() {
            no_table(args)?;
        }
        let table = TextbookTable::new(bench, args.bits, args.textbook);
        Ok(Terminal { table, progress: RunProgress::new(bench, &curve) })
    })?;
    let report = ran.report;
    let mut text = text(&report, &ran.onlookers.table);
    text += &geometry::moved_center(&curve, &of.geometry).unwrap_or_default();
    if let Some(clock) = ran.begun {
        text += &format!("begun from the state at clock {clock}; the report is that of the whole run\n");
    }
    Ok(Finished { text, failures: report.failures() })
}

/// The run of a model that these options describe, with its curve, without outputs.
///
/// # Errors
/// The model is unknown, or the curve or the clock is invalid.
pub(super) fn simulation(model: &str, of: &MachineRun) -> Result<(Simulation, Curve), Error> {
    let model = of.bench.model(model)?;
    let curve = curve(model.name, model.curve(), &of.geometry, of.hardware.radii())?;
    let options = geometry::choices(model, &curve, &of.hardware, of.clock.clock_hz);
    // A clock that is not possible is refused as such, before a model finds it too slow.
    ClockTime::from_hz(of.clock.clock_hz)?;
    let simulation = Simulation::new(model, curve.clone())
        .options(options)
        .engine(of.simulation.engine)
        .max_clocks(of.simulation.max_clocks)
        .events(of.simulation.event.clone())
        .clock_hz(of.clock.clock_hz)
        .blu_mm(of.hardware.blu);
    Ok((simulation, curve))
}

/// Refuses what is about the printed table, where a file is printed in its place.
fn no_table(args: &RunArgs) -> Result<(), Error> {
    let given = [(args.textbook, "--textbook"), (args.bits, "--bits")].into_iter().find(|(given, _)| *given);
    given.map_or(Ok(()), |(_, option)| {
        Err(Error::Invalid(format!(
            "{option} is for the printed table, but a file goes to standard output (-) in its place: leave one of them out"
        )))
    })
}

fn text(report: &Report, table: &TextbookTable) -> String {
    let table = table.render().unwrap_or_else(|| {
        format!("more than {TEXTBOOK_STEPS} steps: --steps FILE writes the step table, --plot FILE draws the path\n")
    });
    format!("{table}\n{}", report.summary())
}
