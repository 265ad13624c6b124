//! What a run is of: a curve of a model, or a whole NC program.

use std::fmt::Display;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::Simulation;
use crate::models::Model;
use crate::models::options::{ACCEL, TOLERANCE};
use crate::models::program::Pacing;
use crate::nc::Curve;
use crate::program::{Control, CutWords, Estimate, Pace, Preparation, ProgramFailure, Stream, Survey};
use crate::report::{OfCurve, OfProgram, Report, Subject};
use crate::testbench::Testbench;
use crate::waves::{probes, runs};

/// What the wave of a program begins with: where the machine is, how fast it is to be, and in which block.
const LEADING: [&str; 9] = [
    "axis_x.x",
    "axis_y.y",
    "program.feed",
    "program.block",
    "axis_z.z",
    "pulse_source.v",
    "after_x.x_out",
    "after_y.y_out",
    "after_z.z_out",
];

#[derive(Clone, Debug)]
pub(super) enum Source {
    Curve(Curve),
    Program(Box<NcProgram>),
}

/// A program, and how it is prepared for the machine.
#[derive(Clone, Debug)]
pub(super) struct NcProgram {
    file: PathBuf,
    pub(super) preparation: Preparation,
    /// Feed of G00 in mm/min.
    pub(super) rapid: Option<f64>,
    /// Speed in mm/min at which an axis can start and stop.
    pub(super) jump: Option<f64>,
}

/// A machine that is ready to run.
pub(crate) struct Prepared {
    pub(crate) bench: Testbench,
    /// Moves of the program; 0 of a curve.
    pub(crate) moves: u64,
}

impl Source {
    /// The file that it is read from.
    pub(super) fn file(&self) -> Option<&PathBuf> {
        match self {
            Source::Curve(_) => None,
            Source::Program(program) => Some(&program.file),
        }
    }

    /// Signals that its wave begins with.
    pub(super) fn leading(&self) -> &'static [&'static str] {
        match self {
            Source::Curve(_) => &[],
            Source::Program(_) => &LEADING,
        }
    }
}

impl NcProgram {
    pub(super) fn new(file: PathBuf) -> NcProgram {
        NcProgram { file, preparation: Preparation::default(), rapid: None, jump: None }
    }

    /// An error of the text, with the file.
    fn named(&self, error: &ProgramFailure) -> ProgramFailure {
        ProgramFailure::File(format!("{}: {error}", self.file.display()))
    }

    /// Opens the program; it is read twice.
    fn open(&self) -> Result<BufReader<File>, ProgramFailure> {
        let path: &Path = &self.file;
        let trouble = |error: &dyn Display| ProgramFailure::File(format!("cannot read {}: {error}", path.display()));
        let found = path.metadata().map_err(|error| trouble(&error))?;
        if !found.is_file() {
            return Err(trouble(&"a program is read twice, which needs a file: save it in one"));
        }
        Ok(BufReader::new(File::open(path).map_err(|error| trouble(&error))?))
    }

    /// How the program is prepared at this BLU, with these options.
    fn prepared(&self, simulation: &Simulation) -> Preparation {
        let mut preparation = self.preparation.clone();
        preparation.reading.blu = simulation.blu_mm;
        // A ramp in front of the interpolator is along a path that has as many pulses everywhere.
        preparation.reading.whole &= simulation.options.value(&ACCEL).is_none();
        preparation.reading.tolerance = simulation.options.value(&TOLERANCE).map_or(0.0, |radii| radii.units());
        preparation
    }

    /// Refuses a feed of G00 where nothing takes it.
    fn check_rapid(&self, model: &Model) -> Result<(), ProgramFailure> {
        match (self.rapid, model.moves()?.pacing()) {
            (Some(rapid), Pacing::Hardware { reads_speed: false }) => {
                Err(ProgramFailure::Rapid { rapid, bench: model.name })
            }
            _ => Ok(()),
        }
    }

    fn pace(&self, simulation: &Simulation) -> Pace {
        let &Simulation { clock_hz, blu_mm, .. } = simulation;
        let &NcProgram { rapid, jump, .. } = self;
        Pace { clock_hz, blu_mm, blu_degrees: self.preparation.reading.degrees, rapid, jump }
    }
}

impl Simulation {
    /// The machine, loaded with the curve, or ready for the program, which is read once for it.
    ///
    /// # Errors
    /// The program is wrong, or the machine cannot be as the options want it.
    pub(crate) fn prepare(&self) -> Result<Prepared, ProgramFailure> {
        let (bench, moves) = match &self.source {
            Source::Curve(curve) => (Testbench::loading(self.model, curve, &self.options)?, 0),
            Source::Program(program) => {
                program.check_rapid(self.model)?;
                let survey = Survey::of(program.open()?, self.model.moves()?, &program.prepared(self));
                let survey = survey.map_err(|error| program.named(&error))?;
                // How far the radii of an arc may differ is not the machine's concern.
                let options = self.options.clone().without(&TOLERANCE).at_clock(self.clock_hz).in_blu(self.blu_mm);
                let hardware = self.model.plan_program(&survey.size, &options)?;
                let machine = self.model.machine(&hardware)?;
                (Testbench::of_machine(hardware, machine).as_hardware_loads(), survey.moves)
            }
        };
        Ok(Prepared { bench: bench.limited_to(self.max_clocks).with_events(&self.events)?, moves })
    }

    /// The same bench where nobody looks at its samples but a report and waves: a program runs much faster where these do
    /// not show the phase of the pulse source.
    pub(crate) fn lean(&self, bench: Testbench) -> Testbench {
        match &self.source {
            Source::Curve(_) => bench,
            Source::Program(_) if !self.waves.wanted() => bench.without_wave(),
            Source::Program(_) => {
                let bench = self.leaving_out(bench);
                let shown = probes(&bench, &self.waves).unwrap_or_default();
                let running = bench.running();
                let shows = |running| shown.iter().any(|probe| runs(probe, bench.columns(), running));
                if running.is_some_and(shows) { bench } else { bench.passing_over() }
            }
        }
    }

    /// The same bench, whose waves leave out what they leave out by default.
    pub(super) fn leaving_out(&self, bench: Testbench) -> Testbench {
        let all = self.waves.every_clock || matches!(self.source, Source::Curve(_));
        if all { bench } else { bench.leaving_out_phase() }
    }

    /// Reads the program anew, and feeds its machine; `None` of a curve, whose blocks the bench has.
    ///
    /// # Errors
    /// It can no longer be read.
    pub(crate) fn control<'a>(
        &self,
        bench: &'a Testbench,
    ) -> Result<Option<Control<'a, BufReader<File>>>, ProgramFailure> {
        let Source::Program(program) = &self.source else { return Ok(None) };
        let moves = self.model.moves()?;
        let stream = Stream::new(program.open()?, moves, &program.prepared(self));
        let stream = stream.map_err(|error| program.named(&error))?;
        Ok(Some(Control::new(stream, moves, bench, program.pace(self))))
    }

    /// What a run of the program comes to; `None` of a curve, and of hardware that sets its own feed.
    ///
    /// # Errors
    /// The program is wrong.
    pub(crate) fn estimate(&self, bench: &Testbench) -> Result<Option<Estimate>, ProgramFailure> {
        let Source::Program(program) = &self.source else { return Ok(None) };
        let (preparation, pace) = (program.prepared(self), program.pace(self));
        let estimate = Estimate::of(program.open()?, self.model.moves()?, &preparation, bench.hardware(), pace);
        estimate.map_err(|error| program.named(&error))
    }

    /// The report of a run, before it.
    pub(crate) fn report(&self, bench: &Testbench) -> Report {
        let subject = match &self.source {
            Source::Curve(curve) => Subject::Curve(Box::new(OfCurve::new(curve.clone(), bench.blocks()))),
            Source::Program(program) => {
                Subject::Program(Box::new(OfProgram::new(&program.file, program.preparation.reading.degrees)))
            }
        };
        let Simulation { model, engine, clock_hz, blu_mm, .. } = *self;
        let cut = CutWords::of_curve(bench.cut_words());
        let events = self.events.clone();
        Report { engine, cut, clock_hz, blu_mm, events, ..Report::new(model, subject, bench) }
    }
}
