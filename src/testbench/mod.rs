//! The test bench: the one place where geometry, model, engine and observers meet. It loads the blocks, runs the clock
//! until the machine says `done`, and hands every sample and every step to the observers.

mod checkpoint;
mod coarse;
mod columns;
mod instruments;
mod lanes;
mod load;
mod measure;
mod names;
mod overflow;
mod path;
mod program;
mod ranges;
mod recording;
mod spacing;
mod steps;
mod stimulus;
mod tool;
mod wave;

use stepwave_engine::{self as engine, Engine, EngineKind, Rows, Stop, Watch};
use stepwave_models::options::ON_OVERFLOW;
use stepwave_models::{CutWord, Hardware, Machine, Model, ModelError};
use stepwave_netlist::{Design, Net, OnOverflow};

pub use checkpoint::{CheckpointError, Checkpoints, Memory, State};
pub use coarse::{CoarseError, CoarseWatch};
pub use columns::Columns;
pub use lanes::{LaneOutcome, Lanes};
pub use measure::Measured;
pub(crate) use names::net_named;
pub use overflow::{OverflowEvent, OverflowTally, OverflowWatch};
pub use path::{PathWatch, WorstError};
pub use program::{Host, Next, Sample};
pub use ranges::{RangeWatch, RegisterRange, StuckBits};
pub use recording::{Recording, Trace};
pub use spacing::{PulseTrain, RateDeviation, SpacingWatch};
pub use steps::Step;
use steps::{StepColumns, StepReader};
pub use wave::{Taken, Trigger, WaveBody, WaveWriter, Window};

/// Samples held between engine and observers.
const CHUNK: usize = 256;

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

    /// Writes down what this observer has gathered, under a name of its own, for [`recall`](Self::recall) of a run that
    /// goes on from here.
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
}

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ending {
    /// The machine said `done`.
    Done,
    /// A property was violated and the run stopped there.
    Trapped,
    /// No pulse came for so many clocks that none will.
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
    /// Those of them in which blocks were loaded: the others the machine was moving, or had the time to.
    pub load_clocks: u64,
    /// Steps completed.
    pub steps: u64,
    /// Pulses of each axis, in either direction.
    pub pulses: Vec<u64>,
    /// Where the pulses led, in BLU.
    pub reached: Vec<i64>,
    /// What the position counters show in the last sample, in BLU: where one overflowed, not where the pulses led.
    pub counters: Vec<i64>,
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
    /// Every sample is shown, for a wave; otherwise those of a program in which its machine is idle are passed over.
    every_sample: bool,
    /// Clocks after which a run is given up.
    limit: u64,
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

    /// A machine that runs whole programs, for [`run_program`](Self::run_program).
    #[must_use]
    pub fn of_machine(hardware: Hardware, machine: Machine) -> Testbench {
        let columns = Columns::of(&machine);
        let (blocks, cut, start) = (Vec::new(), Vec::new(), vec![0; hardware.axes]);
        let (cuts, every_sample, limit) = (false, true, u64::MAX);
        Testbench { hardware, machine, blocks, start, cuts, cut, columns, every_sample, limit }
    }

    /// The same machine where nobody writes a wave of its programs: much faster, but columns are those of
    /// [`Columns::without_wave`], and samples in which the machine is idle may be passed over.
    #[must_use]
    pub fn without_wave(self) -> Testbench {
        Testbench { columns: Columns::without_wave(&self.machine), every_sample: false, ..self }
    }

    /// The same bench, whose runs are given up after so many clocks.
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

    /// Runs all blocks from reset.
    ///
    /// # Errors
    /// An observer fails.
    pub fn run(&self, engine: EngineKind, observers: &mut [&mut dyn Observer]) -> Result<Outcome, ObserverError> {
        self.begin(engine, observers).all_blocks()
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
        let mut run = self.begin(engine, observers);
        run.states = Some(states);
        run.all_blocks()
    }

    /// Goes on from a state of a run of this bench to its end. Samples up to the state are not seen again; the outcome
    /// and what observers have gathered is that of the whole run.
    ///
    /// # Errors
    /// An observer fails.
    pub fn run_from(
        &self,
        engine: EngineKind,
        observers: &mut [&mut dyn Observer],
        state: &State,
    ) -> Result<Outcome, ObserverError> {
        let mut run = self.begin(engine, observers);
        run.restore(state);
        run.all_blocks()
    }

    /// Shows a machine over some clocks from any state, whether a run comes to it or not. The state is sample 0; nothing is
    /// loaded, and nothing ends it before.
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
        engine.restore(0, &start.registers, &start.inputs);
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

    fn begin<'a, 'o>(&'a self, engine: EngineKind, observers: &'a mut [&'o mut dyn Observer]) -> Run<'a, 'o> {
        let properties = &self.design().netlist().properties;
        let mut stops = vec![self.machine.done.net];
        if self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap {
            stops.extend(properties.iter().map(|property| property.never));
        }
        let watch = Watch { columns: self.columns.nets().to_vec(), stops };
        Run {
            bench: self,
            engine: engine.build(self.design(), &watch),
            rows: Rows::new(watch.columns.len(), CHUNK),
            steps: StepReader::new(self),
            wants_steps: true,
            observers,
            first_block: 0,
            goes_on: false,
            anchor: None,
            states: None,
        }
    }
}

/// A sample that a run may come back to.
struct Anchor {
    clock: u64,
    /// Values of the design's registers, in its order.
    registers: Vec<u64>,
}

/// A run in progress.
struct Run<'a, 'o> {
    bench: &'a Testbench,
    engine: Box<dyn Engine>,
    rows: Rows,
    steps: StepReader<'a>,
    /// Somebody wants the rows of the step table.
    wants_steps: bool,
    observers: &'a mut [&'o mut dyn Observer],
    /// The block that the run begins with.
    first_block: usize,
    /// That block is loaded and running.
    goes_on: bool,
    /// A sample of the block that runs, not before half of its clocks.
    anchor: Option<Anchor>,
    /// Takes states of the run.
    states: Option<&'a mut Checkpoints>,
}

impl Run<'_, '_> {
    fn all_blocks(&mut self) -> Result<Outcome, ObserverError> {
        let (mut ending, mut loaded) = (Ending::Done, self.first_block);
        for (index, words) in self.bench.blocks.iter().enumerate().skip(self.first_block) {
            if !std::mem::take(&mut self.goes_on) {
                self.load(index, words)?;
            }
            loaded = index + 1;
            ending = self.finish_block(index)?;
            if ending != Ending::Done {
                break;
            }
        }
        self.drain()?;
        // One clock from reset to the first block, and two for each block behind another.
        let load_clocks = (2 * loaded as u64).saturating_sub(1);
        Ok(self.steps.outcome(ending, self.engine.clock(), load_clocks))
    }

    /// Loads a block: sets the inputs, and does the clock behind which the machine runs.
    fn load(&mut self, index: usize, words: &[(Net, u64)]) -> Result<(), ObserverError> {
        let machine = &self.bench.machine;
        self.anchor = None;
        for &(input, value) in words {
            self.engine.set_input(input, value);
        }
        self.engine.set_input(machine.load.net, 1);
        self.engine.set_input(machine.preset_position.net, u64::from(index == 0));
        if index == 0 {
            self.engine.reset(&mut self.rows);
        } else {
            self.clock()?;
        }
        self.engine.set_input(machine.load.net, 0);
        self.engine.set_input(machine.preset_position.net, 0);
        // The edge that loads; `done` of the block before falls with it.
        self.clock()
    }

    /// One clock, whatever the machine says.
    fn clock(&mut self) -> Result<(), ObserverError> {
        if self.rows.is_full() {
            self.drain()?;
        }
        self.engine.run(1, &mut self.rows);
        Ok(())
    }

    fn finish_block(&mut self, index: usize) -> Result<Ending, ObserverError> {
        let stall = self.bench.hardware.stall_clocks;
        // A trap may be seen in the very sample behind the load already.
        if let Some(ending) = self.ended() {
            return Ok(ending);
        }
        loop {
            let left = self.bench.limit.saturating_sub(self.engine.clock());
            if left == 0 {
                return Ok(Ending::Limit);
            }
            let stop = self.engine.run(left, &mut self.rows);
            match stop {
                Stop::Net(0) => return Ok(Ending::Done),
                Stop::Net(_) => return Ok(Ending::Trapped),
                Stop::RowsFull | Stop::Clocks => self.drain()?,
            }
            let quiet = self.engine.clock().saturating_sub(self.steps.last_pulse);
            let at_rest = || engine::at_rest(self.engine.as_ref(), self.bench.design());
            if quiet > stall || quiet >= CHUNK as u64 && at_rest() {
                return Ok(Ending::Stalled { clocks: quiet });
            }
            if let Some(since) = self.came_back() {
                return Ok(Ending::Endless { since });
            }
            self.keep_state(index);
        }
    }

    /// The clock of the anchor, if the machine is in the state that it had there and has pulsed since: inputs stay, so it
    /// will do the same again. The anchor moves on whenever the clocks have doubled, so that no loop escapes it.
    fn came_back(&mut self) -> Option<u64> {
        let (engine, registers) = (&self.engine, self.bench.design().registers());
        let clock = engine.clock();
        if let Some(anchor) = &self.anchor {
            let mut values = registers.iter().zip(&anchor.registers);
            if self.steps.last_pulse > anchor.clock && values.all(|(&net, value)| engine.value(net) == *value) {
                return Some(anchor.clock);
            }
            if clock / 2 < anchor.clock {
                return None;
            }
        }
        self.anchor = Some(Anchor { clock, registers: registers.iter().map(|&net| engine.value(net)).collect() });
        None
    }

    /// Keeps the present state, if one is wanted. All samples up to it have been shown.
    fn keep_state(&mut self, block: usize) {
        let clock = self.engine.clock();
        let Some(states) = self.states.as_mut().filter(|states| !self.wants_steps && states.wants(clock)) else {
            return;
        };
        let mut memory = Memory::new();
        self.steps.remember(&mut memory);
        if let Some(Anchor { clock, registers }) = &self.anchor {
            memory.insert("anchor".to_owned(), serde_json::json!([clock, registers]));
        }
        for observer in self.observers.iter() {
            observer.remember(&mut memory);
        }
        states.keep(State::of(self.engine.as_ref(), self.bench, block, memory));
    }

    fn restore(&mut self, state: &State) {
        self.engine.restore(state.clock, &state.registers, &state.inputs);
        self.steps.recall(&state.memory);
        for observer in self.observers.iter_mut() {
            observer.recall(&state.memory);
        }
        let anchor: Option<(u64, Vec<u64>)> = checkpoint::recalled(&state.memory, "anchor");
        self.anchor = anchor.map(|(clock, registers)| Anchor { clock, registers });
        (self.first_block, self.goes_on) = (state.block, true);
    }

    /// What the present sample says by itself.
    fn ended(&self) -> Option<Ending> {
        if self.bench.hardware.get(&ON_OVERFLOW) != OnOverflow::Trap {
            return None;
        }
        let mut properties = self.bench.design().netlist().properties.iter();
        properties.any(|property| self.engine.value(property.never) == 1).then_some(Ending::Trapped)
    }

    /// Shows the rows to the observers and makes room.
    fn drain(&mut self) -> Result<(), ObserverError> {
        for observer in self.observers.iter_mut() {
            observer.samples(&self.rows)?;
        }
        self.wants_steps &= self.observers.iter().any(|observer| observer.wants_steps());
        if self.wants_steps {
            self.show_steps()?;
        } else {
            self.steps.count(&self.rows);
        }
        self.rows.clear();
        Ok(())
    }

    fn show_steps(&mut self) -> Result<(), ObserverError> {
        for row in 0..self.rows.len() {
            if self.steps.sample(&self.rows, row) {
                for observer in self.observers.iter_mut().filter(|observer| observer.wants_steps()) {
                    observer.step(&self.steps.step)?;
                }
            }
        }
        Ok(())
    }
}
