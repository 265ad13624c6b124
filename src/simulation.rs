//! The recipe of a run: a curve or an NC program, and options, in; report, wave, table and picture out.

mod source;
mod states;
mod watches;

use std::path::PathBuf;

use self::source::{NcProgram, Source};
use self::states::Begin;
use self::watches::Watches;
#[cfg(feature = "cli")]
use crate::cli::{Format, file_of};
use crate::engine::EngineKind;
use crate::models::events::Timed;
use crate::models::{Model, Options};
use crate::nc::Curve;
use crate::output::{self, Outputs};
use crate::program::Preparation;
use crate::report::page::{self, Facts, RunRecord};
use crate::report::{CsvTable, JsonFile, Report, RunFile, Subject};
use crate::testbench::{Ending, Observer, OverflowEvent, Recording, SpeedRow, Testbench};
use crate::trace::timescale::ClockTime;
use crate::waves::{Sinks, WaveOptions, Waves};
use crate::{Error, Trace};

pub(crate) use self::source::Prepared;

/// A run of a model over a curve, or of a machine over a whole NC program, with everything that is to come of it.
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
///
/// A program is a file, and its machine the model of a method for whole programs:
///
/// ```
/// # use stepwave::{Simulation, models::find};
/// # let folder = tempfile::tempdir()?;
/// # let part = folder.path().join("part.ngc");
/// std::fs::write(&part, "G21 G90 G1 X3 Y0.9 F300\nG2 X5 Y2.9 I0 J2\n")?;
/// let report = Simulation::program(find("ppc-machine")?, &part).blu_mm(0.01).run()?;
/// assert!(report.failures().is_empty());
/// assert_eq!(report.outcome.reached, [500, 290, 0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is simulated before `run`"]
pub struct Simulation {
    model: &'static Model,
    source: Source,
    options: Options,
    engine: EngineKind,
    max_clocks: Option<u64>,
    clock_hz: f64,
    blu_mm: f64,
    waves: WaveOptions,
    files: FileOptions,
    checkpoints: Option<PathBuf>,
    events: Vec<Timed>,
}

/// Files of a run besides its waves; on the command line, options of its outputs.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
#[cfg_attr(feature = "cli", command(next_help_heading = "Outputs (- is standard output)"))]
pub(crate) struct FileOptions {
    /// Write the step table as CSV
    #[cfg_attr(feature = "cli", arg(long, value_name = "FILE", value_parser = file_of(&[Format::Csv])))]
    pub(crate) steps: Option<PathBuf>,
    /// Write the report as JSON
    #[cfg_attr(feature = "cli", arg(long, value_name = "FILE", value_parser = file_of(&[Format::Json])))]
    pub(crate) json: Option<PathBuf>,
    /// Draw the path over the ideal curve, and its error, or the contour of a program, as SVG
    #[cfg_attr(feature = "cli", arg(long, value_name = "FILE", value_parser = file_of(&[Format::Svg])))]
    pub(crate) plot: Option<PathBuf>,
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
        Simulation::of(model, Source::Curve(curve))
    }

    /// A run of the NC program in a file by a machine for whole programs, otherwise as [`new`](Self::new).
    pub fn program(model: &'static Model, file: impl Into<PathBuf>) -> Simulation {
        Simulation::of(model, Source::Program(Box::new(NcProgram::new(file.into()))))
    }

    fn of(model: &'static Model, source: Source) -> Simulation {
        Simulation {
            model,
            source,
            options: Options::default(),
            engine: EngineKind::Compiled,
            max_clocks: None,
            clock_hz: 1e6,
            blu_mm: 1e-3,
            waves: WaveOptions::default(),
            files: FileOptions::default(),
            checkpoints: None,
            events: Vec::new(),
        }
    }

    /// With these options of the hardware.
    pub fn options(self, options: Options) -> Simulation {
        Simulation { options, ..self }
    }

    /// With the text of the program read and prepared so; of a curve it does nothing. The BLU is that of
    /// [`blu_mm`](Self::blu_mm), and how far the radii of an arc may differ that of the option `tolerance`.
    pub fn preparation(mut self, preparation: Preparation) -> Simulation {
        if let Source::Program(program) = &mut self.source {
            program.preparation = preparation;
        }
        self
    }

    /// With this feed of G00 of a program in mm/min, in place of the fastest that the pulse source has.
    pub fn rapid(mut self, feed: impl Into<Option<f64>>) -> Simulation {
        if let Source::Program(program) = &mut self.source {
            program.rapid = feed.into();
        }
        self
    }

    /// With this speed in mm/min at which an axis can start and stop, and by which it can change at a corner, of a program
    /// with acceleration; else the least with which no pulse is waited for, sqrt(a).
    pub fn jump(mut self, speed: impl Into<Option<f64>>) -> Simulation {
        if let Source::Program(program) = &mut self.source {
            program.jump = speed.into();
        }
        self
    }

    /// On this engine. All give the same samples.
    pub fn engine(self, engine: EngineKind) -> Simulation {
        Simulation { engine, ..self }
    }

    /// Ended after this many clocks.
    pub fn max_clocks(self, clocks: impl Into<Option<u64>>) -> Simulation {
        Simulation { max_clocks: clocks.into(), ..self }
    }

    /// With what the operator does, and when.
    pub fn events(self, events: impl Into<Vec<Timed>>) -> Simulation {
        Simulation { events: events.into(), ..self }
    }

    /// With a clock of this frequency in Hz: the time axis of waves, and the feed.
    pub fn clock_hz(self, hz: f64) -> Simulation {
        Simulation { clock_hz: hz, ..self }
    }

    /// With a BLU of this many millimetres.
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

    /// With a page for a browser in this file: path, wave and step table under one cursor.
    pub fn html(mut self, path: impl Into<PathBuf>) -> Simulation {
        self.waves.html = Some(path.into());
        self
    }

    /// With the step table as CSV in this file.
    pub fn steps(mut self, path: impl Into<PathBuf>) -> Simulation {
        self.files.steps = Some(path.into());
        self
    }

    /// With the report as JSON in this file.
    pub fn json(mut self, path: impl Into<PathBuf>) -> Simulation {
        self.files.json = Some(path.into());
        self
    }

    /// With the path over the ideal curve, and its error, or the contour of a program, as SVG in this file.
    pub fn plot(mut self, path: impl Into<PathBuf>) -> Simulation {
        self.files.plot = Some(path.into());
        self
    }

    /// With states of the run in this file; where it exists, a wave of a late window begins at the last state before it.
    pub fn checkpoints(self, path: impl Into<PathBuf>) -> Simulation {
        Simulation { checkpoints: Some(path.into()), ..self }
    }

    /// With the files of a command line.
    #[cfg(feature = "cli")]
    pub(crate) fn files(self, files: FileOptions, checkpoints: Option<PathBuf>) -> Simulation {
        Simulation { files, checkpoints, ..self }
    }

    /// Simulates, and writes every file that is asked for: all of them or none.
    ///
    /// # Errors
    /// The model does not take the curve or the options, the program is wrong, a load word does not fit, or a file cannot be
    /// read or written. What the hardware does wrong is not an error: [`Report::failures`] names it.
    pub fn run(&self) -> Result<Report, Error> {
        let mut outputs = self.outputs();
        let ran = self.run_on(self.lean(self.prepare()?.bench), &mut outputs, |_, _| Ok(()))?;
        outputs.commit()?;
        Ok(ran.report)
    }

    /// As [`run`](Self::run), with the samples of every named signal, for tests that show the wave they expect.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_traced(&self) -> Result<(Report, Trace), Error> {
        let mut outputs = self.outputs();
        let bench = self.leaving_out(self.prepare()?.bench);
        let ran = self.run_on(bench, &mut outputs, |bench, _| Ok(Recording::new(bench)))?;
        outputs.commit()?;
        Ok((ran.report, ran.onlookers.into_trace()))
    }

    /// The outputs of the run: a program, and states that exist, are read.
    pub(crate) fn outputs(&self) -> Outputs {
        let states = self.checkpoints.as_ref().filter(|path| path.exists());
        Outputs::reading(states.into_iter().chain(self.source.file()))
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
                outputs.begun_again();
                self.once(&bench, outputs, &onlookers)
            }
            None => Ok(ran),
        }
    }

    /// A wave is to show the operands of the cell that stopped the run. Not where one of its files is a stream, which has
    /// gone out already, nor where the window leaves the clock of the overflow out.
    fn shows_trap(&self, event: &OverflowEvent) -> bool {
        let WaveOptions { vcd, fst, html, from, to, .. } = &self.waves;
        let window = *from..=to.unwrap_or(u64::MAX);
        let files = [vcd, fst, html, &self.files.steps, &self.files.json, &self.files.plot];
        let streams = files.into_iter().flatten().any(|path| output::is_stream(path));
        self.checkpoints.is_none() && self.waves.wanted() && window.contains(&event.clock()) && !streams
    }

    /// Refuses a row with the speed where it would be another one, or none.
    fn check_speed(&self) -> Result<(), Error> {
        let WaveOptions { vcd, fst, html, speed, .. } = &self.waves;
        let reason = match &self.source {
            _ if !speed => return Ok(()),
            Source::Program(_) => "is of runs along a curve: in a program look at pulse_source.v and at --plot",
            Source::Curve(_) if [vcd, fst, html].into_iter().all(Option::is_none) => {
                "is a row of a wave: give --vcd, --fst or --html"
            }
            Source::Curve(_) if self.checkpoints.is_some() => {
                "needs the steps from the beginning, which --checkpoints leaves out: leave one of both out"
            }
            Source::Curve(_) => return Ok(()),
        };
        Err(Error::Invalid(format!("--trace-speed {reason}")))
    }

    fn once<L: Onlookers>(
        &self,
        bench: &Testbench,
        outputs: &mut Outputs,
        onlookers: impl Fn(&Testbench, &Outputs) -> Result<L, Error>,
    ) -> Result<Ran<L>, Error> {
        self.check_speed()?;
        let time = ClockTime::from_hz(self.clock_hz)?;
        let mut report = self.report(bench);
        let mut states = Begin::of(self, bench)?;
        // All are opened before the first is written: where one is refused, nothing has gone to standard output.
        let sinks = Sinks::open(&self.waves, outputs)?;
        let mut open = |path: &Option<PathBuf>| path.as_deref().map(|path| outputs.open(path)).transpose();
        let [steps, json, plot] = [open(&self.files.steps)?, open(&self.files.json)?, open(&self.files.plot)?];
        states.iter_mut().try_for_each(|states| states.open(outputs))?;
        let page = page::open(&self.waves, outputs)?;
        let mut onlookers = onlookers(bench, outputs)?;
        let speed = self.waves.speed.then(|| SpeedRow::new(bench));
        let waves = |sinks| Waves::new(bench, &self.waves, sinks, time, &report.title(), speed);
        let waves = sinks.map(waves).transpose()?;
        let mut waves = waves.map(|waves| waves.beginning_with(self.source.leading()));
        let mut files: Vec<Box<dyn RunFile>> = Vec::new();
        if let Some(sink) = steps {
            files.push(Box::new(CsvTable::new(bench, sink)?));
        }
        if let Some(sink) = json {
            files.push(Box::new(JsonFile::new(&report, sink)?));
        }
        files.extend(plot.map(|sink| report.picture(bench, sink)));
        let record = |out| {
            let degrees = report.program().map_or(0.0, |program| program.blu_degrees);
            let units = [self.clock_hz, self.blu_mm, degrees];
            let record = RunRecord::of_bench(bench, &self.waves, units, page::limit(&self.waves))?;
            Ok::<_, Error>((out, record.beginning_with(self.source.leading())))
        };
        let mut page = page.map(record).transpose()?;
        let mut watches = Watches::new(bench, &self.source);

        let mut observers = watches.observers(&mut report.subject);
        observers.extend(onlookers.observers());
        observers.extend(waves.iter_mut().flat_map(Waves::observers));
        observers.extend(page.iter_mut().map(|(_, record)| record as &mut dyn Observer));
        observers.extend(files.iter_mut().map(|file| &mut **file as &mut dyn Observer));
        let mut control = self.control(bench)?;
        let outcome = match (&mut states, &mut control) {
            (_, Some(control)) => bench.run_fed(self.engine, control, &mut observers)?,
            (Some(Begin::New { states, .. }), None) => bench.run_keeping(self.engine, &mut observers, states)?,
            (Some(Begin::At(state)), None) => bench.run_from(self.engine, &mut observers, state)?,
            (None, None) => bench.run(self.engine, &mut observers)?,
        };
        drop(observers);
        watches.finish(&mut report, outcome);
        if let (Some(control), Subject::Program(of)) = (control, &mut report.subject) {
            (of.left_out, report.cut) = (control.left_out, control.cut);
        }

        let begun = states.as_ref().and_then(Begin::clock);
        if let Some(states) = states {
            states.finish()?;
        }
        if let Some(waves) = waves {
            waves.finish(&report.overflows, report.outcome.clocks, outputs)?;
        }
        files.iter_mut().try_for_each(|file| file.finish(&report))?;
        if let Some((out, record)) = page {
            page::write(out, record, &Facts::from(&report))?;
        }
        Ok(Ran { report, onlookers, begun })
    }
}
