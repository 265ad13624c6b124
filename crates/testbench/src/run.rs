//! The one run loop: loads the blocks of a feeder, runs the clock, and shows samples, steps and blocks to the
//! observers.

use stepwave_engine::{self as engine, Engine, EngineKind, Idle, Rows, Stop, Watch};
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::{Net, OnOverflow};

use super::ahead::Lookout;
use super::block::Account;
use super::checkpoint::{self, Checkpoint, Checkpoints, Memory};
use super::feeder::{Feeder, Next};
use super::load::CUT_CLOCKS;
use super::steps::StepReader;
use super::{CHUNK, Ending, Observer, ObserverError, Outcome, Testbench};

/// A sample that a run may come back to.
pub(super) struct Anchor {
    pub(super) clock: u64,
    /// Values of the design's registers, in its order.
    pub(super) registers: Vec<u64>,
}

/// A run in progress.
pub(super) struct Run<'a, 'o> {
    pub(super) bench: &'a Testbench,
    pub(super) engine: Box<dyn Engine>,
    rows: Rows,
    feeder: &'a mut dyn Feeder,
    pub(super) observers: &'a mut [&'o mut dyn Observer],
    pub(super) steps: StepReader<'a>,
    pub(super) account: Account,
    /// Where no observer must see every sample.
    pub(super) lookout: Option<Lookout>,
    /// Somebody wants the rows of the step table.
    pub(super) wants_steps: bool,
    /// Blocks loaded so far.
    loaded: usize,
    /// They are of one geometry, and not of a program.
    alone: bool,
    /// The first sample has been taken.
    is_reset: bool,
    /// A sample of the block that runs, not before half of its clocks.
    pub(super) anchor: Option<Anchor>,
    /// Takes states of the run.
    states: Option<&'a mut Checkpoints>,
    /// Clock at which the run is given up.
    limit: u64,
    /// Load words that were cut so far.
    cut: u64,
    /// Events that have been, of those of the bench.
    events: usize,
}

/// Index among the stop nets of that by which a machine takes a block: `call`, or `done` without a buffer.
const READY: usize = 0;

impl<'a, 'o> Run<'a, 'o> {
    pub(super) fn new(
        bench: &'a Testbench,
        kind: EngineKind,
        feeder: &'a mut dyn Feeder,
        observers: &'a mut [&'o mut dyn Observer],
    ) -> Run<'a, 'o> {
        let machine = bench.machine();
        let flags: Vec<Net> = bench.design().netlist().properties.iter().map(|property| property.never).collect();
        let mut stops = machine.buffer.map_or(vec![machine.done.net], |ports| vec![ports.call, ports.at_end]);
        if bench.traps() {
            stops.extend(&machine.traps);
        }
        let watch = Watch { columns: bench.columns().nets().to_vec(), stops };
        let columns = watch.columns.len();
        let mut steps = StepReader::new(bench);
        let (lookout, wanted) = Lookout::of(bench, &mut steps, observers).unzip();
        let (mut engine, rows) = match machine.buffer.filter(|_| !bench.every_sample) {
            None => (kind.build_digesting(bench.design(), &watch, wanted.as_ref()), Rows::new(columns, CHUNK)),
            Some(_) => {
                let idle = Idle { running: machine.running(), flags };
                let idle = bench.running().map_or(idle.clone(), |running| running.idle(idle));
                (kind.build_passing(bench.design(), &watch, &idle), Rows::sparse(columns, CHUNK))
            }
        };
        engine.expect(bench.least_clocks.min(bench.limit));
        Run {
            bench,
            engine,
            rows,
            feeder,
            observers,
            steps,
            account: Account::default(),
            lookout,
            wants_steps: true,
            loaded: 0,
            alone: true,
            is_reset: false,
            anchor: None,
            states: None,
            limit: bench.limit,
            cut: 0,
            events: 0,
        }
    }

    /// The same run, of which states are kept.
    pub(super) fn keeping(self, states: &'a mut Checkpoints) -> Self {
        Run { states: Some(states), ..self }
    }

    /// The same run from a state on, whose block is loaded and running.
    pub(super) fn from(mut self, state: &Checkpoint) -> Self {
        self.engine.restore(state.clock, &state.registers, &state.inputs, &state.memories);
        self.steps.recall(&state.memory);
        for observer in self.observers.iter_mut() {
            observer.recall(&state.memory);
        }
        let anchor: Option<(u64, Vec<u64>)> = checkpoint::recalled(&state.memory, "anchor");
        self.anchor = anchor.map(|(clock, registers)| Anchor { clock, registers });
        self.events = self.bench.events.partition_point(|event| event.clock <= state.clock);
        Run { loaded: state.block + 1, is_reset: true, ..self }
    }

    /// Runs to the end of the last block.
    pub(super) fn whole(mut self) -> Result<Outcome, ObserverError> {
        let ending = self.blocks()?;
        self.drain()?;
        self.account.end(self.observers)?;
        Ok(self.steps.outcome(ending, self.engine.clock()))
    }

    fn is_buffered(&self) -> bool {
        self.bench.machine().buffer.is_some()
    }

    fn blocks(&mut self) -> Result<Ending, ObserverError> {
        let over = usize::from(self.is_buffered());
        let mut next = self.ask()?;
        if self.is_buffered() && self.loaded == 0 {
            self.reset();
        }
        loop {
            match next {
                Next::Block(words, part) => {
                    if let Some(ending) = self.until(READY)? {
                        return Ok(ending);
                    }
                    self.alone = part.is_none();
                    self.load(&words)?;
                    // The block before runs on while a buffer takes the next.
                    if self.is_buffered() && self.trapped() {
                        return Ok(Ending::Trapped);
                    }
                    self.account.give(part);
                    next = self.ask()?;
                    // The edge that loads; `done` of the block before falls with it.
                    self.clock()?;
                }
                Next::Wait(clocks) => {
                    if let Some(ending) = self.until(over)? {
                        return Ok(ending);
                    }
                    self.wait()?;
                    for _ in 0..clocks {
                        if self.is_over() {
                            return Ok(Ending::Limit);
                        }
                        self.clock()?;
                    }
                    next = self.ask()?;
                }
                Next::End => return Ok(self.until(over)?.unwrap_or(Ending::Done)),
            }
        }
    }

    /// What the feeder gives next; a buffer learns whether that is a block. A block with a word that was cut need not
    /// end: where no limit was given it has [`CUT_CLOCKS`].
    fn ask(&mut self) -> Result<Next, ObserverError> {
        let next = self.feeder.next()?;
        if let Some(ports) = self.bench.machine().buffer {
            self.engine.set_input(ports.more, u64::from(matches!(next, Next::Block(..))));
        }
        let cut = self.feeder.cut_words();
        if self.bench.limit == u64::MAX && cut > self.cut {
            (self.cut, self.limit) = (cut, self.engine.clock().saturating_add(CUT_CLOCKS));
        }
        Ok(next)
    }

    /// Puts a block on the inputs for a clock. A machine without a buffer is loaded from its reset on. The first block of a
    /// geometry presets the position counters.
    fn load(&mut self, words: &[(Net, u64)]) -> Result<(), ObserverError> {
        let machine = self.bench.machine();
        self.anchor = None;
        for &(input, value) in words {
            self.engine.set_input(input, value);
        }
        let first = self.loaded == 0;
        self.engine.set_input(machine.load.net, 1);
        // A program begins at the origin, where reset puts the counters.
        self.engine.set_input(machine.preset_position.net, u64::from(first && self.alone));
        if self.is_reset {
            self.clock()?;
        } else {
            self.reset();
        }
        self.limit_block();
        self.engine.set_input(machine.load.net, 0);
        self.engine.set_input(machine.preset_position.net, 0);
        self.loaded += 1;
        Ok(())
    }

    /// The first sample.
    fn reset(&mut self) {
        self.act(0);
        self.engine.reset(&mut self.rows);
        self.is_reset = true;
    }

    /// Begins a dwell where all blocks before have ended: one without a block before it begins at reset.
    fn wait(&mut self) -> Result<(), ObserverError> {
        if self.is_buffered() {
            return Ok(());
        }
        if !self.has_stall_clocks() {
            self.limit = self.bench.limit;
        }
        match (self.loaded, self.is_reset) {
            (0, true) => self.clock(),
            (0, false) => {
                self.reset();
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Of hardware of which nothing is known, each block of a program has [`CUT_CLOCKS`] where no limit was given.
    fn limit_block(&mut self) {
        if !self.alone && self.bench.limit == u64::MAX && !self.has_stall_clocks() {
            self.limit = self.engine.clock().saturating_add(CUT_CLOCKS);
        }
    }

    fn has_stall_clocks(&self) -> bool {
        self.bench.hardware().has_stall_clocks()
    }

    /// Sets the inputs of the events that come up to the next sample, which is that of this clock.
    fn act(&mut self, next: u64) {
        while let Some(event) = self.bench.events.get(self.events).filter(|event| event.clock <= next) {
            self.engine.set_input(event.input, event.value);
            self.events += 1;
            // From here it may differ from what followed the anchor.
            self.anchor = None;
        }
    }

    /// One clock, regardless of the machine's outputs.
    fn clock(&mut self) -> Result<(), ObserverError> {
        self.act(self.engine.clock() + 1);
        if self.rows.is_full() {
            self.drain()?;
        }
        self.engine.run(1, &mut self.rows);
        Ok(())
    }

    /// Runs until a stop net is 1; an ending if the run is over before.
    fn until(&mut self, wanted: usize) -> Result<Option<Ending>, ObserverError> {
        let buffered = self.is_buffered();
        if !buffered && self.loaded == 0 {
            return Ok(None);
        }
        // A trap may be seen in the very sample after the load already.
        if self.trapped() {
            return Ok(Some(Ending::Trapped));
        }
        loop {
            if self.is_over() {
                return Ok(Some(Ending::Limit));
            }
            self.act(self.engine.clock() + 1);
            if self.rows.is_empty() && self.look_ahead() {
                self.keep_state();
                continue;
            }
            match self.engine.run(self.left().min(self.patience()), &mut self.rows) {
                Stop::Net(net) if net > usize::from(buffered) => return Ok(Some(Ending::Trapped)),
                // The first of several that are 1 is reported: a trap may hide another.
                Stop::Net(_) if buffered && self.trapped() => return Ok(Some(Ending::Trapped)),
                Stop::Net(net) if net == wanted => return Ok(None),
                Stop::Net(_) if !self.rows.is_full() => continue,
                Stop::Net(_) | Stop::RowsFull | Stop::Clocks => self.drain()?,
            }
            // A machine with a buffer waits for its pulse source in a program, or for a dwell to pass.
            let may_hang = self.alone || !buffered || !self.bench.events.is_empty();
            if let Some(ending) = if may_hang { self.hangs() } else { None } {
                return Ok(Some(ending));
            }
            self.keep_state();
        }
    }

    /// The ending of a machine of which nothing new will come.
    fn hangs(&mut self) -> Option<Ending> {
        let last_event = self.last_event()?;
        let quiet = self.engine.clock().saturating_sub(self.steps.last_pulse.max(last_event));
        // The clock of a sampling period runs while all that is after the interpolator is empty.
        let after = self.bench.machine().after.as_ref();
        let emptied = after.is_none_or(|after| self.engine.value(after.empty) == 1);
        let running = after.map_or(&[][..], |after| &after.running);
        let at_rest = || emptied && engine::at_rest(self.engine.as_ref(), self.bench.design(), running);
        if !self.alone {
            return (quiet >= CHUNK as u64 && at_rest()).then_some(Ending::Stalled { clocks: quiet });
        }
        if quiet > self.bench.hardware.stall_clocks || quiet >= CHUNK as u64 && at_rest() {
            return Some(Ending::Stalled { clocks: quiet });
        }
        let since = self.came_back()?;
        let pulsed = self.steps.last_pulse > since;
        Some(if pulsed { Ending::Endless { since } } else { Ending::Stalled { clocks: quiet } })
    }

    /// The clock of the last event; `None` while further ones are to come.
    fn last_event(&self) -> Option<u64> {
        let events = &self.bench.events;
        (self.events == events.len()).then(|| events.last().map_or(0, |event| event.clock))
    }

    /// The clock of the anchor, if the machine is in the state that it had there: inputs stay, so it will do the same
    /// again. The anchor moves on whenever the clocks have doubled, so that no loop escapes it.
    fn came_back(&mut self) -> Option<u64> {
        let (engine, registers) = (&self.engine, self.bench.design().registers());
        let clock = engine.clock();
        if let Some(anchor) = &self.anchor {
            // The contents of memories are not compared.
            let mut values = registers.iter().zip(&anchor.registers);
            let comparable = self.bench.design().netlist().memories.is_empty();
            let pulsed = self.steps.last_pulse > anchor.clock || !self.has_stall_clocks();
            if comparable && pulsed && values.all(|(&net, value)| engine.value(net) == *value) {
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
    fn keep_state(&mut self) {
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
        states.keep(Checkpoint::of(self.engine.as_ref(), self.bench, self.loaded.saturating_sub(1), memory));
    }

    /// Clocks that the run may still take, at most up to the sample before the next event.
    pub(super) fn left(&self) -> u64 {
        let event = self.bench.events.get(self.events).map_or(u64::MAX, |event| event.clock - 1);
        self.limit.min(event).saturating_sub(self.engine.clock())
    }

    /// Clocks after which a machine that an operator may have stopped for ever is looked at.
    fn patience(&self) -> u64 {
        if self.bench.events.is_empty() { u64::MAX } else { 1 << 16 }
    }

    /// The run has taken all clocks that it may.
    fn is_over(&self) -> bool {
        self.limit <= self.engine.clock()
    }

    /// A property is violated in the present sample, and that ends the run.
    fn trapped(&self) -> bool {
        self.bench.traps() && self.bench.machine().traps.iter().any(|&flag| self.engine.value(flag) == 1)
    }

    /// Shows the rows to the observers and makes room.
    fn drain(&mut self) -> Result<(), ObserverError> {
        for observer in self.observers.iter_mut() {
            observer.samples(&self.rows)?;
        }
        self.wants_steps &= self.observers.iter().any(|observer| observer.wants_steps());
        if self.wants_steps || self.account.is_kept() {
            self.show_steps()?;
        } else {
            self.steps.count(&self.rows);
        }
        self.rows.clear();
        Ok(())
    }

    fn show_steps(&mut self) -> Result<(), ObserverError> {
        for first in (0..self.rows.len()).step_by(64) {
            let mut eventful = self.steps.eventful(&self.rows, first);
            while eventful != 0 {
                self.show_step(first + eventful.trailing_zeros() as usize)?;
                eventful &= eventful - 1;
            }
        }
        self.steps.end_rows(&self.rows);
        Ok(())
    }

    fn show_step(&mut self, row: usize) -> Result<(), ObserverError> {
        let (rows, steps) = (&self.rows, &mut self.steps);
        if steps.is_loaded(rows, row) && self.account.begin(rows, row, steps, self.observers)? {
            steps.begin_block();
        }
        if !steps.sample(rows, row, self.wants_steps) {
            return Ok(());
        }
        self.account.step(&steps.step);
        if self.wants_steps {
            for observer in self.observers.iter_mut().filter(|observer| observer.wants_steps()) {
                observer.step(&steps.step)?;
            }
        }
        Ok(())
    }
}

impl Testbench {
    /// A property that is violated ends the run.
    fn traps(&self) -> bool {
        self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap
    }
}
