//! A machine that runs a whole program: the host keeps its block buffer full.

use stepwave_engine::{Engine, EngineKind, Idle, Rows, Stop, Watch};
use stepwave_models::ModelError;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::bits::to_signed;
use stepwave_netlist::{Net, OnOverflow};

use super::load::CUT_CLOCKS;
use super::steps::StepColumns;
use super::{CHUNK, Ending, Observer, ObserverError, Outcome, Testbench};

/// What the host gives the machine next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// The words of a block, on the inputs.
    Block(Vec<(Net, u64)>),
    /// Nothing for so many clocks, once the machine has come to a stand.
    Wait(u64),
    /// The program is at its end.
    End,
}

/// The control behind a machine: it gives blocks, and looks on while they run.
pub trait Host {
    /// The next block; asked for while the one before runs.
    ///
    /// # Errors
    /// Whatever keeps the control from it; the run ends.
    fn next(&mut self) -> Result<Next, ObserverError>;

    /// Load words so far that did not fit in their registers, of all blocks that were asked for.
    fn cut_words(&self) -> u64 {
        0
    }

    /// The machine has begun with the next of the blocks that it was given.
    ///
    /// # Errors
    /// As [`next`](Self::next).
    fn begun(&mut self, sample: &Sample<'_>) -> Result<(), ObserverError>;

    /// The machine has taken a step of its block.
    ///
    /// # Errors
    /// As [`next`](Self::next).
    fn stepped(&mut self, sample: &Sample<'_>) -> Result<(), ObserverError>;
}

/// A sample of a machine that runs a program.
#[derive(Clone, Copy)]
pub struct Sample<'a> {
    bench: &'a Testbench,
    columns: &'a StepColumns,
    rows: &'a Rows,
    row: usize,
    place: [i64; 3],
}

impl Sample<'_> {
    /// Clocks since reset.
    #[must_use]
    pub fn clock(&self) -> u64 {
        self.rows.clock(self.row)
    }

    /// Pulses of x, y and z at the edge before: -1, 0 or +1.
    #[must_use]
    pub fn pulses(&self) -> [i64; 3] {
        self.signed(&self.columns.pulses, 2)
    }

    /// Where the pulses of x, y and z led, in BLU.
    #[must_use]
    pub fn position(&self) -> [i64; 3] {
        self.place
    }

    /// What the position counters of x, y and z show, in BLU: where one overflowed, not where the pulses led.
    #[must_use]
    pub fn counters(&self) -> [i64; 3] {
        self.signed(&self.columns.positions, 64)
    }

    /// Registers of the machine's table, in its order.
    pub fn registers(&self) -> impl Iterator<Item = i128> {
        let table = self.columns.table.iter().zip(&self.bench.machine().table);
        table.map(|(&column, (_, port))| port.reading.number(port.width, self.rows.value(column, self.row)))
    }

    fn signed(&self, columns: &[usize], most: u32) -> [i64; 3] {
        let machine = self.bench.machine();
        let ports = if most == 2 { &machine.pulses } else { &machine.positions };
        let mut values = [0; 3];
        for ((value, &column), port) in values.iter_mut().zip(columns).zip(ports) {
            *value = to_signed(port.width, self.rows.value(column, self.row));
        }
        values
    }
}

/// The stop nets of a run, by their index.
const CALL: usize = 0;
const AT_END: usize = 1;

struct Run<'a, 'o> {
    bench: &'a Testbench,
    engine: Box<dyn Engine>,
    rows: Rows,
    columns: StepColumns,
    more: Net,
    host: &'a mut dyn Host,
    observers: &'a mut [&'o mut dyn Observer],
    pulses: [u64; 3],
    place: [i64; 3],
    steps: u64,
    /// Clock at which the run is given up.
    limit: u64,
    /// Load words that were cut so far.
    cut: u64,
}

impl Testbench {
    /// Runs the blocks that a host gives, from reset. What an observer wants of steps the host is told.
    ///
    /// # Errors
    /// The host or an observer fails, or the machine has no block buffer.
    pub fn run_program(
        &self,
        engine: EngineKind,
        host: &mut dyn Host,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Outcome, ObserverError> {
        let netlist = self.design().netlist();
        let find = |name: &str| netlist.find(name).ok_or_else(|| ModelError::MissingPort(name.to_owned()));
        let mut stops = vec![find("call")?.net, find("at_end")?.net];
        if self.hardware().get(&ON_OVERFLOW) == OnOverflow::Trap {
            stops.extend(netlist.properties.iter().map(|property| property.never));
        }
        let watch = Watch { columns: self.columns().nets().to_vec(), stops };
        let columns = watch.columns.len();
        let (engine, rows) = if self.every_sample {
            (engine.build(self.design(), &watch), Rows::new(columns, CHUNK))
        } else {
            let flags = netlist.properties.iter().map(|property| property.never).collect();
            let idle = Idle { running: vec![find("phase")?.net], flags };
            (engine.build_passing(self.design(), &watch, &idle), Rows::sparse(columns, CHUNK))
        };
        let mut run = Run {
            bench: self,
            engine,
            rows,
            columns: StepColumns::of(self),
            more: find("more")?.net,
            host,
            observers,
            pulses: [0; 3],
            place: [0; 3],
            steps: 0,
            limit: self.limit,
            cut: 0,
        };
        let ending = run.whole()?;
        run.drain()?;
        let position = self.machine().positions.iter();
        Ok(Outcome {
            ending,
            clocks: run.engine.clock(),
            load_clocks: 0,
            steps: run.steps,
            pulses: run.pulses.to_vec(),
            reached: run.place.to_vec(),
            counters: position.map(|port| to_signed(port.width, run.engine.value(port.net))).collect(),
        })
    }
}

impl Run<'_, '_> {
    fn whole(&mut self) -> Result<Ending, ObserverError> {
        let machine = self.bench.machine();
        let (load, more) = (machine.load.net, self.more);
        let mut next = self.ask()?;
        self.engine.set_input(more, u64::from(matches!(next, Next::Block(_))));
        self.engine.reset(&mut self.rows);
        loop {
            match next {
                Next::Block(words) => {
                    self.engine.set_input(more, 1);
                    if let Some(ending) = self.until(CALL)? {
                        return Ok(ending);
                    }
                    for (input, value) in words {
                        self.engine.set_input(input, value);
                    }
                    self.engine.set_input(load, 1);
                    self.clock()?;
                    self.engine.set_input(load, 0);
                    next = self.ask()?;
                    self.engine.set_input(more, u64::from(matches!(next, Next::Block(_))));
                    self.clock()?;
                }
                Next::Wait(clocks) => {
                    self.engine.set_input(more, 0);
                    if let Some(ending) = self.until(AT_END)? {
                        return Ok(ending);
                    }
                    for _ in 0..clocks {
                        if self.left() == 0 {
                            return Ok(Ending::Limit);
                        }
                        self.clock()?;
                    }
                    next = self.ask()?;
                }
                Next::End => {
                    self.engine.set_input(more, 0);
                    return Ok(self.until(AT_END)?.unwrap_or(Ending::Done));
                }
            }
        }
    }

    /// Runs until a stop net is 1; an ending if the machine traps before.
    fn until(&mut self, wanted: usize) -> Result<Option<Ending>, ObserverError> {
        loop {
            if self.left() == 0 {
                return Ok(Some(Ending::Limit));
            }
            match self.engine.run(self.left(), &mut self.rows) {
                Stop::Net(net) if net > AT_END => return Ok(Some(Ending::Trapped)),
                // The first of several that are 1 is told: a trap may hide behind another.
                Stop::Net(net) => {
                    if self.trapped() {
                        return Ok(Some(Ending::Trapped));
                    }
                    if net == wanted {
                        return Ok(None);
                    }
                    if self.rows.is_full() {
                        self.drain()?;
                    }
                }
                Stop::RowsFull | Stop::Clocks => self.drain()?,
            }
        }
    }

    /// What the host gives next. A block with a word that was cut need not come to an end: where no limit was given it
    /// has [`CUT_CLOCKS`].
    fn ask(&mut self) -> Result<Next, ObserverError> {
        let next = self.host.next()?;
        let cut = self.host.cut_words();
        if self.bench.limit == u64::MAX && cut > self.cut {
            (self.cut, self.limit) = (cut, self.engine.clock().saturating_add(CUT_CLOCKS));
        }
        Ok(next)
    }

    /// Clocks that the run may still take.
    fn left(&self) -> u64 {
        self.limit.saturating_sub(self.engine.clock())
    }

    fn trapped(&self) -> bool {
        let properties = &self.bench.design().netlist().properties;
        let traps = self.bench.hardware().get(&ON_OVERFLOW) == OnOverflow::Trap;
        traps && properties.iter().any(|property| self.engine.value(property.never) == 1)
    }

    /// One clock, whatever the machine says.
    fn clock(&mut self) -> Result<(), ObserverError> {
        if self.rows.is_full() {
            self.drain()?;
        }
        self.engine.run(1, &mut self.rows);
        Ok(())
    }

    /// Shows the rows to observers and host, and makes room.
    fn drain(&mut self) -> Result<(), ObserverError> {
        for observer in self.observers.iter_mut() {
            observer.samples(&self.rows)?;
        }
        let (loaded, stepped) = (self.rows.column(self.columns.loaded), self.rows.column(self.columns.stepped));
        for row in 0..self.rows.len() {
            if loaded[row] | stepped[row] == 0 {
                continue;
            }
            let mut sample =
                Sample { bench: self.bench, columns: &self.columns, rows: &self.rows, row, place: self.place };
            if stepped[row] == 1 {
                self.steps += 1;
                for ((count, place), pulse) in self.pulses.iter_mut().zip(&mut self.place).zip(sample.pulses()) {
                    *count += pulse.unsigned_abs();
                    *place = place.saturating_add(pulse);
                }
                sample.place = self.place;
                self.host.stepped(&sample)?;
            }
            if loaded[row] == 1 {
                self.host.begun(&sample)?;
            }
        }
        self.rows.clear();
        Ok(())
    }
}
