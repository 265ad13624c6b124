//! The recipe of a run: model, curve and options in; report, wave, table and picture out.

mod states;

use std::io::Write;
use std::path::PathBuf;

use self::states::{Begin, States};
use crate::engine::EngineKind;
use crate::models::{Model, ModelError, Options};
use crate::nc::Curve;
use crate::output::{Outputs, Sink};
use crate::report::plot::Plot;
use crate::report::{self, CsvTable, Report};
use crate::testbench::{
    CoarseWatch, Ending, Observer, ObserverError, Outcome, OverflowEvent, OverflowWatch, PathWatch, RangeWatch,
    Recording, SpacingWatch, Step, Testbench,
};
use crate::trace::timescale::ClockTime;
use crate::waves::{Sinks, WaveOptions, Waves};
use crate::{Error, Trace};

/// A run of a model over a curve, with everything that is to come of it.
///
/// ```
/// use stepwave::Simulation;
/// use stepwave::models::{find, options::{Options, WIDTH}};
/// use stepwave::nc::{Curve, Line};
///
/// let model = find("dda-line")?;
/// let curve = Curve::Line(Line::new(vec![0, 0], vec![8, 6])?);
/// let report = Simulation::new(model, curve)
///     .options(Options::parse(["--width", "4"])?)
///     .run()?;
/// assert!(report.end_exact());
/// assert_eq!(report.outcome.clocks, 17);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is simulated before `run`"]
pub struct Simulation {
    model: &'static Model,
    curve: Curve,
    options: Options,
    engine: EngineKind,
    max_clocks: Option<u64>,
    clock_hz: f64,
    blu_mm: f64,
    waves: WaveOptions,
    steps: Option<PathBuf>,
    json: Option<PathBuf>,
    plot: Option<PathBuf>,
    checkpoints: Option<PathBuf>,
}

/// What looks on besides what a report needs.
pub(crate) trait Onlookers {
    /// Those that observe the run.
    fn observers(&mut self) -> Vec<&mut dyn Observer>;
}

impl Onlookers for () {
    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        Vec::new()
    }
}

impl Onlookers for Recording {
    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        vec![self]
    }
}

/// A run that is over, whose files are not yet under their names.
pub(crate) struct Ran<L> {
    pub(crate) report: Report,
    pub(crate) onlookers: L,
    /// Clock of the state that it went on from.
    pub(crate) begun: Option<u64>,
}

impl Simulation {
    /// A run with the model's own options, a clock of 1 MHz and a BLU of 1 µm, of the compiled engine.
    pub fn new(model: &'static Model, curve: Curve) -> Simulation {
        Simulation {
            model,
            curve,
            options: Options::default(),
            engine: EngineKind::Compiled,
            max_clocks: None,
            clock_hz: 1e6,
            blu_mm: 1e-3,
            waves: WaveOptions::default(),
            steps: None,
            json: None,
            plot: None,
            checkpoints: None,
        }
    }

    /// With these options of the hardware.
    pub fn options(self, options: Options) -> Simulation {
        Simulation { options, ..self }
    }

    /// On this engine. All give the same samples.
    pub fn engine(self, engine: EngineKind) -> Simulation {
        Simulation { engine, ..self }
    }

    /// Ended after this many clocks.
    pub fn max_clocks(self, clocks: impl Into<Option<u64>>) -> Simulation {
        Simulation { max_clocks: clocks.into(), ..self }
    }

    /// With a clock of this frequency in Hz: the time axis of waves, and the feed.
    pub fn clock_hz(self, hz: f64) -> Simulation {
        Simulation { clock_hz: hz, ..self }
    }

    /// With a BLU of so many millimetres.
    pub fn blu_mm(self, mm: f64) -> Simulation {
        Simulation { blu_mm: mm, ..self }
    }

    /// With these waves.
    pub fn waves(self, waves: WaveOptions) -> Simulation {
        Simulation { waves, ..self }
    }

    /// With the whole wave as VCD in this file, and GTKWave's files next to it.
    pub fn vcd(mut self, path: impl Into<PathBuf>) -> Simulation {
        self.waves.vcd = Some(path.into());
        self
    }

    /// With the whole wave as FST in this file, and GTKWave's files next to it.
    pub fn fst(mut self, path: impl Into<PathBuf>) -> Simulation {
        self.waves.fst = Some(path.into());
        self
    }

    /// With the step table as CSV in this file.
    pub fn steps(self, path: impl Into<PathBuf>) -> Simulation {
        Simulation { steps: Some(path.into()), ..self }
    }

    /// With the report as JSON in this file.
    pub fn json(self, path: impl Into<PathBuf>) -> Simulation {
        Simulation { json: Some(path.into()), ..self }
    }

    /// With the path over the ideal curve, and its error, as SVG in this file.
    pub fn plot(self, path: impl Into<PathBuf>) -> Simulation {
        Simulation { plot: Some(path.into()), ..self }
    }

    /// With states of the run in this file; where it exists, a wave of a late window begins at the last state before it.
    pub fn checkpoints(self, path: impl Into<PathBuf>) -> Simulation {
        Simulation { checkpoints: Some(path.into()), ..self }
    }

    /// With the files of a command line.
    #[cfg(feature = "cli")]
    pub(crate) fn files(
        self,
        steps: &Option<PathBuf>,
        json: &Option<PathBuf>,
        plot: &Option<PathBuf>,
        checkpoints: &Option<PathBuf>,
    ) -> Simulation {
        let (steps, json) = (steps.clone(), json.clone());
        Simulation { steps, json, plot: plot.clone(), checkpoints: checkpoints.clone(), ..self }
    }

    /// Simulates, and writes every file that is asked for: all of them or none.
    ///
    /// # Errors
    /// The model does not take the curve or the options, a load word does not fit, or a file cannot be written. What the
    /// hardware does wrong is no error: [`Report::failures`] names it.
    pub fn run(&self) -> Result<Report, Error> {
        let mut outputs = self.outputs();
        let ran = self.run_on(self.bench()?, &mut outputs, |_, _| Ok(()))?;
        outputs.commit()?;
        Ok(ran.report)
    }

    /// As [`run`](Self::run), with the samples of every named signal, for tests that show the wave they expect.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_traced(&self) -> Result<(Report, Trace), Error> {
        let mut outputs = self.outputs();
        let ran = self.run_on(self.bench()?, &mut outputs, |bench, _| Ok(Recording::new(bench)))?;
        outputs.commit()?;
        Ok((ran.report, ran.onlookers.into_trace()))
    }

    /// The outputs of the run: states that exist are read.
    pub(crate) fn outputs(&self) -> Outputs {
        Outputs::reading(self.checkpoints.iter().filter(|path| path.exists()))
    }

    /// The machine, loaded with the curve.
    pub(crate) fn bench(&self) -> Result<Testbench, ModelError> {
        Ok(Testbench::loading(self.model, &self.curve, &self.options)?.limited_to(self.max_clocks))
    }

    /// Simulates on a bench and stages every output. A run that an overflow stopped is simulated a second time where its
    /// wave can show the operands of the cell.
    pub(crate) fn run_on<L: Onlookers>(
        &self,
        bench: Testbench,
        outputs: &mut Outputs,
        onlookers: impl Fn(&Testbench, &Outputs) -> Result<L, Error>,
    ) -> Result<Ran<L>, Error> {
        let ran = self.once(&bench, outputs, &onlookers)?;
        let trapped = (ran.report.outcome.ending == Ending::Trapped).then(|| ran.report.overflows.first()).flatten();
        match trapped.filter(|event| self.shows_trap(event)).and_then(|event| bench.showing(event)) {
            Some(bench) => {
                *outputs = Outputs::default();
                self.once(&bench, outputs, &onlookers)
            }
            None => Ok(ran),
        }
    }

    /// Not where an output has gone to a stream already, nor where the window leaves the trap out.
    fn shows_trap(&self, event: &OverflowEvent) -> bool {
        let files = [&self.waves.vcd, &self.waves.fst, &self.steps, &self.json, &self.plot];
        self.checkpoints.is_none() && self.waves.shows_trap(event, files)
    }

    fn once<L: Onlookers>(
        &self,
        bench: &Testbench,
        outputs: &mut Outputs,
        onlookers: impl Fn(&Testbench, &Outputs) -> Result<L, Error>,
    ) -> Result<Ran<L>, Error> {
        let time = ClockTime::from_hz(self.clock_hz)?;
        let title = report::title(self.model, bench.hardware(), &self.curve);
        let states = States::of(self, bench)?;
        // All are opened before the first is written: where one is refused, nothing has gone to standard output.
        let sinks = Sinks::open(&self.waves, outputs)?;
        let mut open = |path: &Option<PathBuf>| path.as_deref().map(|path| outputs.open(path)).transpose();
        let [steps, json, plot] = [open(&self.steps)?, open(&self.json)?, open(&self.plot)?];
        let mut states = states.map(|states| states.open(outputs)).transpose()?;
        let mut onlookers = onlookers(bench, outputs)?;
        let mut files = Files {
            table: steps.map(|sink| CsvTable::new(bench, sink)).transpose()?,
            picture: plot.map(|sink| (Picture(Plot::new(&self.curve)), sink)),
            json,
        };
        let mut waves = sinks.map(|sinks| Waves::new(bench, &self.waves, sinks, time, &title)).transpose()?;
        let mut watches = Watches::new(bench, &self.curve);

        let mut observers = watches.observers();
        observers.extend(onlookers.observers());
        observers.extend(waves.iter_mut().flat_map(Waves::observers));
        observers.extend(files.observers());
        let outcome = match &mut states {
            Some(Begin::New { states, .. }) => bench.run_keeping(self.engine, &mut observers, states)?,
            Some(Begin::At(state)) => bench.run_from(self.engine, &mut observers, state)?,
            None => bench.run(self.engine, &mut observers)?,
        };
        drop(observers);
        let report = watches.report(self, bench, outcome);

        let begun = states.as_ref().and_then(Begin::clock);
        if let Some(states) = states {
            states.finish()?;
        }
        if let Some(waves) = waves {
            waves.finish(&report.overflows, report.outcome.clocks, outputs)?;
        }
        files.finish(&report)?;
        Ok(Ran { report, onlookers, begun })
    }
}

/// What a report is put together from.
struct Watches<'a> {
    overflow: OverflowWatch,
    ranges: RangeWatch,
    path: PathWatch<'a>,
    spacing: SpacingWatch,
    coarse: Option<CoarseWatch<'a>>,
}

impl<'a> Watches<'a> {
    fn new(bench: &Testbench, curve: &'a Curve) -> Watches<'a> {
        Watches {
            overflow: OverflowWatch::new(bench),
            ranges: RangeWatch::new(bench),
            path: PathWatch::new(bench, curve),
            spacing: SpacingWatch::new(bench, curve),
            coarse: CoarseWatch::new(bench, curve),
        }
    }

    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        let Watches { overflow, ranges, path, spacing, coarse } = self;
        let mut all: Vec<&mut dyn Observer> = vec![overflow, ranges, path, spacing];
        all.extend(coarse.as_mut().map(|coarse| coarse as &mut dyn Observer));
        all
    }

    fn report(self, simulation: &Simulation, bench: &Testbench, outcome: Outcome) -> Report {
        Report {
            model: simulation.model,
            curve: simulation.curve.clone(),
            hardware: bench.hardware().clone(),
            engine: simulation.engine,
            outcome,
            ranges: self.ranges.finish(),
            worst: self.path.worst,
            coarse: self.coarse.and_then(|coarse| coarse.worst),
            trains: self.spacing.finish(),
            cut: bench.cut_words().to_vec(),
            blocks: bench.blocks(),
            overflows: self.overflow.events(),
            overflow_count: self.overflow.count,
            tallies: self.overflow.tallies(),
            clock_hz: simulation.clock_hz,
            blu_mm: simulation.blu_mm,
        }
    }
}

/// The files of a run but for its waves.
struct Files {
    table: Option<CsvTable<Sink>>,
    picture: Option<(Picture, Sink)>,
    json: Option<Sink>,
}

impl Files {
    fn observers(&mut self) -> impl Iterator<Item = &mut dyn Observer> {
        let table = self.table.iter_mut().map(|table| table as &mut dyn Observer);
        table.chain(self.picture.iter_mut().map(|(picture, _)| picture as &mut dyn Observer))
    }

    fn finish(self, report: &Report) -> Result<(), Error> {
        if let Some(table) = self.table {
            table.finish()?;
        }
        if let Some(mut sink) = self.json {
            writeln!(sink, "{:#}", report.json())?;
            sink.flush()?;
        }
        if let Some((Picture(mut plot), mut sink)) = self.picture {
            if let Some(event) = report.overflows.first() {
                plot.mark(&format!("overflow of {}", event.component()));
            }
            let title = format!("{}: {}", report.model.name, report::geometry(&report.curve));
            sink.write_all(plot.svg(&title).as_bytes())?;
            sink.flush()?;
        }
        Ok(())
    }
}

/// Hands every position to the picture.
struct Picture(Plot);

impl Observer for Picture {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.0.point(&step.position);
        Ok(())
    }
}
