//! The test bench: the one place where geometry, model, engine and observers meet. It loads the blocks, runs the clock
//! until the machine says `done`, and hands every sample and every step to the observers.

mod ahead;
mod block;
mod checkpoint;
mod coarse;
mod columns;
mod contour;
mod event;
mod feeder;
mod instruments;
mod lanes;
mod load;
mod measure;
mod names;
mod output;
mod overflow;
mod path;
mod ranges;
mod recording;
mod run;
mod running;
mod spacing;
mod speed;
mod steps;
mod stimulus;
mod tool;
mod wave;

use stepwave_engine::{Digest, EngineKind, Rows, Wanted, Watch};
use stepwave_models::{CutWord, Hardware, Machine, Model, ModelError};
use stepwave_netlist::{Design, Net};

pub use block::{BlockReport, Part};
pub use checkpoint::{Checkpoint, CheckpointError, Checkpoints, Memory};
pub use coarse::{CoarseError, CoarseWatch};
pub use columns::Columns;
pub use event::Event;
pub use feeder::{Feeder, Next};
pub use lanes::{LaneOutcome, Lanes};
pub use load::CUT_CLOCKS;
pub use measure::Measured;
pub use names::{SignalError, net_named};
pub use output::{ArcLoss, OffContour, OutputPlace, OutputTrack, OutputWatch, Sent};
pub use overflow::{OverflowEvent, OverflowTally, OverflowWatch};
pub use path::{PathWatch, WorstError};
pub use ranges::{RangeWatch, RegisterRange, StuckBits};
pub use recording::{Recording, Trace};
use run::Run;
pub use running::Running;
pub use spacing::{PulseTrain, RateDeviation, SpacingWatch};
pub use speed::{RelativeSpeed, Speed, SpeedRow, SpeedTrack, SpeedWatch, Window as SpeedWindow};
pub use steps::Step;
use steps::StepColumns;
pub use wave::{Taken, Trigger, WaveWriter, Window};

/// Samples held between engine and observers.
pub const CHUNK: usize = 256;

/// Trouble while running: what an observer could not do.
pub type ObserverError = Box<dyn std::error::Error + Send + Sync>;

/// Looks on while a machine runs.
pub trait Observer {
    /// Samples, in order, each seen once. Columns are those of [`Testbench::columns`].
    ///
    /// # Errors
    /// Whatever keeps the observer from its work; the run ends.
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let _ = rows;
        Ok(())
    }

    /// Says what this observer must know of samples that it does not see; false if it must see every one.
    fn want(&mut self, bench: &Testbench, wanted: &mut Wanted) -> bool {
        let _ = (bench, wanted);
        false
    }

    /// What these samples came to is enough for an observer that can [do without them](Self::want).
    fn suffices(&self, digest: &Digest) -> bool {
        let _ = digest;
        true
    }

    /// Takes what samples came to in their place; `last` are the columns of the last of them.
    fn digest(&mut self, digest: &Digest, last: &[u64]) {
        let _ = (digest, last);
    }

    /// Writes down what this observer has gathered, under a name of its own, for [`recall`](Self::recall) of a run that
    /// continues from here.
    fn remember(&self, memory: &mut Memory) {
        let _ = memory;
    }

    /// Takes over what [`remember`](Self::remember) wrote down; what is missing or cannot be read counts as nothing.
    fn recall(&mut self, memory: &Memory) {
        let _ = memory;
    }

    /// This observer wants the rows of the step table: a run without anybody who does is much faster. Asked before
    /// every block of samples; who wants no more gets no more.
    fn wants_steps(&self) -> bool {
        true
    }

    /// A row of the step table, for those that want them.
    ///
    /// # Errors
    /// Whatever keeps the observer from its work; the run ends.
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        let _ = step;
        Ok(())
    }

    /// The machine has begun with a block of a program: row 0 of its step table is next. Parts of a block, such as the
    /// sectors of an arc, follow each other without a word. A single geometry is one block, which
    /// [`Testbench::run`] does not report.
    ///
    /// # Errors
    /// Whatever keeps the observer from its work; the run ends.
    fn block_begun(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        let _ = block;
        Ok(())
    }

    /// That block has ended, or the run in the middle of it: what the machine made of it.
    ///
    /// # Errors
    /// Whatever keeps the observer from its work; the run ends.
    fn block_ended(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        let _ = block;
        Ok(())
    }
}

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ending {
    /// The machine said `done`.
    Done,
    /// A property was violated and the run stopped there.
    Trapped,
    /// No pulse came for this many clocks, so none will.
    Stalled {
        /// Clocks without a pulse.
        clocks: u64,
    },
    /// It pulses, but came back to the very state of an earlier sample of its block: it will do so for ever.
    Endless {
        /// Clock of that sample.
        since: u64,
    },
    /// As many clocks as were allowed were not enough.
    Limit,
}

/// A state in which a machine is put by hand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Start {
    /// Values of the design's registers, in its order.
    pub registers: Vec<u64>,
    /// Values of the design's inputs, in its order.
    pub inputs: Vec<u64>,
}

/// What a run came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// How it ended.
    pub ending: Ending,
    /// Clocks since reset: the clock of the last sample.
    pub clocks: u64,
    /// Steps completed.
    pub steps: u64,
    /// Pulses of each axis, in either direction.
    pub pulses: Vec<u64>,
    /// Where the pulses led, in BLU.
    pub reached: Vec<i64>,
    /// What the position counters show in the last sample, in BLU: where one overflowed, not where the pulses led.
    pub counters: Vec<i64>,
}

impl Outcome {
    /// The machine is where the curve ends, and has run it.
    #[must_use]
    pub fn ends(&self, curve: &stepwave_nc::Curve) -> bool {
        is_ended(&curve.description(), &self.reached, &self.pulses)
    }
}

/// A run along this curve ended where it does. A closed one without a pulse was not run at all, but for a small free curve, which
/// may need none: the path error shows one that was not run.
pub fn is_ended(curve: &stepwave_nc::Description, reached: &[i64], pulses: &[u64]) -> bool {
    let may_rest = curve.drawn.is_spline() || curve.from != curve.to;
    reached == curve.to && (may_rest || pulses.iter().any(|&count| count > 0))
}

/// A place in BLU: `(8, 6)`.
pub fn point(place: &[i64]) -> String {
    format!("({})", place.iter().map(i64::to_string).collect::<Vec<_>>().join(", "))
}

/// The sentence about a run that did not end where it should.
pub fn missed(wanted: &[i64], reached: &[i64]) -> String {
    if reached == wanted {
        return format!("the closed curve from {} was not run: the machine gave no pulse", point(wanted));
    }
    format!("the end point {} was missed: the machine is at {}", point(wanted), point(reached))
}

/// A machine with the blocks of one geometry, ready to run.
#[derive(Clone, Debug)]
pub struct Testbench {
    hardware: Hardware,
    machine: Machine,
    blocks: Vec<Vec<(Net, u64)>>,
    /// Where the tool is before the first block, in BLU.
    start: Vec<i64>,
    /// Load words that do not fit are cut as the hardware cuts them; otherwise they are refused.
    cuts: bool,
    /// Those of the blocks that were.
    cut: Vec<CutWord>,
    columns: Columns,
    /// Every sample is shown; otherwise those of a program in which its machine is idle are passed over.
    every_sample: bool,
    /// What waves of its programs leave out.
    running: Option<Running>,
    /// Clocks after which a run is given up.
    limit: u64,
    /// Clocks that its geometry takes at least; 0 without one.
    least_clocks: u64,
    /// Inputs that change while it runs, by their clocks.
    events: Vec<Event>,
}

impl Testbench {
    /// A machine of this hardware, as yet without blocks: [`of`](Self::of) and [`lanes`](Self::lanes) give it some.
    ///
    /// # Errors
    /// The model itself is wrong, or registers are too wide to be added.
    pub fn of_hardware(model: &Model, hardware: Hardware) -> Result<Testbench, ModelError> {
        let machine = model.machine(&hardware)?;
        Ok(Testbench::of_machine(hardware, machine))
    }

    /// A machine that runs whole programs, for [`run_fed`](Self::run_fed).
    #[must_use]
    pub fn of_machine(hardware: Hardware, machine: Machine) -> Testbench {
        let columns = Columns::of(&machine);
        let (blocks, cut, start) = (Vec::new(), Vec::new(), vec![0; hardware.axes]);
        let (cuts, every_sample, running, limit, least_clocks) = (false, true, None, u64::MAX, 0);
        let events = Vec::new();
        Testbench {
            hardware,
            machine,
            blocks,
            start,
            cuts,
            cut,
            columns,
            every_sample,
            running,
            limit,
            least_clocks,
            events,
        }
    }

    /// The same machine where nobody writes a wave of its programs: much faster, but columns are those of
    /// [`Columns::without_wave`], and samples in which the machine is idle may be passed over.
    #[must_use]
    pub fn without_wave(self) -> Testbench {
        Testbench { columns: Columns::without_wave(&self.machine), every_sample: false, ..self }
    }

    /// The same machine for waves of its programs that leave out, if nobody names it, what changes at every clock: the
    /// clock itself, and what runs with the phase of the pulse source. Of hardware without a buffer nothing is left out.
    pub fn leaving_out_phase(self) -> Testbench {
        Testbench { running: Running::of(&self.machine, &self.columns), ..self }
    }

    /// What waves of its programs leave out.
    pub fn running(&self) -> Option<&Running> {
        self.running.as_ref()
    }

    /// The same machine, whose idle samples are passed over: waves that [leave out](Self::leaving_out_phase) what
    /// changes in these are the same, and much faster.
    pub fn passing_over(self) -> Testbench {
        Testbench { every_sample: self.running.is_none(), ..self }
    }

    /// The same bench, whose runs are aborted after this many clocks.
    #[must_use]
    pub fn limited(self, clocks: u64) -> Testbench {
        Testbench { limit: clocks, ..self }
    }

    /// The hardware.
    #[must_use]
    pub fn hardware(&self) -> &Hardware {
        &self.hardware
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Its design.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.machine.design
    }

    /// What every sample holds.
    #[must_use]
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// Runs all blocks of its geometry from reset.
    ///
    /// # Errors
    /// An observer fails.
    pub fn run(&self, engine: EngineKind, observers: &mut [&mut dyn Observer]) -> Result<Outcome, ObserverError> {
        self.run_fed(engine, &mut self.geometry(0), observers)
    }

    /// Runs the blocks that a feeder gives, from reset.
    ///
    /// # Errors
    /// The feeder or an observer fails.
    pub fn run_fed(
        &self,
        engine: EngineKind,
        feeder: &mut dyn Feeder,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Outcome, ObserverError> {
        Run::new(self, engine, feeder, observers).whole()
    }

    /// Runs as [`run`](Self::run) does and keeps states of the run, once no observer wants rows of the step table.
    ///
    /// # Errors
    /// An observer fails.
    pub fn run_keeping(
        &self,
        engine: EngineKind,
        observers: &mut [&mut dyn Observer],
        states: &mut Checkpoints,
    ) -> Result<Outcome, ObserverError> {
        Run::new(self, engine, &mut self.geometry(0), observers).keeping(states).whole()
    }

    /// Continues from a state of a run of this bench to its end. Samples up to the state are not seen again; the
    /// outcome and what observers have gathered is that of the whole run.
    ///
    /// # Errors
    /// An observer fails.
    pub fn run_from(
        &self,
        engine: EngineKind,
        observers: &mut [&mut dyn Observer],
        state: &Checkpoint,
    ) -> Result<Outcome, ObserverError> {
        Run::new(self, engine, &mut self.geometry(state.block + 1), observers).from(state).whole()
    }

    /// Shows a machine over some clocks from any state, whether a run comes to it or not. The state is sample 0;
    /// nothing is loaded, and nothing ends it before.
    ///
    /// # Errors
    /// An observer fails.
    ///
    /// # Panics
    /// If the state has not as many values as the design has registers and inputs.
    pub fn show(&self, start: &Start, clocks: u64, observers: &mut [&mut dyn Observer]) -> Result<(), ObserverError> {
        let watch = Watch { columns: self.columns.nets().to_vec(), stops: Vec::new() };
        let mut engine = EngineKind::Word.build(self.design(), &watch);
        let mut rows = Rows::new(watch.columns.len(), CHUNK);
        engine.restore(0, &start.registers, &start.inputs, &[]);
        rows.push(0, |column| engine.value(watch.columns[column]));
        loop {
            engine.run(clocks.saturating_sub(engine.clock()), &mut rows);
            observers.iter_mut().try_for_each(|observer| observer.samples(&rows))?;
            rows.clear();
            if engine.clock() >= clocks {
                return Ok(());
            }
        }
    }
}
