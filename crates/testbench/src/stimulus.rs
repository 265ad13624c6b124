//! The loading of blocks as data, for a test bench in another language, and as hardware, for model checkers.

use stepwave_engine::{EngineKind, Rows};
use stepwave_export::{Driven, Stall, Step, Stimulus, driven};
use stepwave_models::ModelError;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::{Design, Diagnostics, Net, OnOverflow};

use super::{Feeder, Next, Observer, ObserverError, Testbench};

impl Testbench {
    /// What [`run`](Testbench::run) does to the machine: each block is put on the inputs together with `load` for one
    /// clock, then the clock runs until `done`. A run without pulses ends too, though at another clock than here, where
    /// it is looked for now and then only.
    #[must_use]
    pub fn stimulus(&self) -> Stimulus {
        // The blocks of a geometry cannot fail.
        self.stimulus_fed(&mut self.geometry(0)).unwrap_or_else(|_| self.sequence(Vec::new(), true))
    }

    /// What [`run_fed`](Testbench::run_fed) does to the machine with these blocks.
    ///
    /// # Errors
    /// The feeder fails.
    pub fn stimulus_fed(&self, feeder: &mut dyn Feeder) -> Result<Stimulus, ObserverError> {
        let machine = &self.machine;
        let more = |next: &Next| {
            let block = u64::from(matches!(next, Next::Block(..)));
            machine.buffer.map(|ports| (ports.more, block))
        };
        let mut steps: Vec<Step> = Vec::new();
        let mut next = feeder.next()?;
        // What comes before the next block: a machine without a buffer takes the first at once.
        let mut wait = more(&next).map(|more| Step { set: vec![more], clocks: None });
        let mut first = true;
        let mut alone = true;
        loop {
            steps.extend(wait.take());
            match next {
                Next::Block(mut words, part) => {
                    // A program begins at the origin, where reset puts the counters.
                    alone = part.is_none();
                    let preset = |first| alone.then_some((machine.preset_position.net, first));
                    words.push((machine.load.net, 1));
                    words.extend(preset(u64::from(std::mem::take(&mut first))));
                    steps.push(Step { set: words, clocks: Some(1) });
                    next = feeder.next()?;
                    let set = [Some((machine.load.net, 0)), preset(0), more(&next)].into_iter().flatten().collect();
                    wait = Some(Step { set, clocks: None });
                }
                Next::Wait(clocks) => {
                    steps.extend((clocks > 0).then(|| Step { set: Vec::new(), clocks: Some(clocks) }));
                    next = feeder.next()?;
                    // Nothing runs: what is waited for is there at the next clock.
                    wait = Some(Step { set: more(&next).into_iter().collect(), clocks: Some(1) });
                }
                Next::End => return Ok(self.sequence(steps, alone)),
            }
        }
    }

    /// These steps, and what ends one of them and a run of this machine, `alone` if it is of one geometry.
    fn sequence(&self, steps: Vec<Step>, alone: bool) -> Stimulus {
        let machine = &self.machine;
        let never =
            if self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap { machine.traps.clone() } else { Vec::new() };
        let done = machine.buffer.map_or(vec![machine.done.net], |ports| vec![ports.call, ports.at_end]);
        let nets = machine.pulses.iter().map(|port| port.net).collect();
        let stall = alone.then_some(Stall { nets, clocks: self.hardware.stall_clocks });
        Stimulus { steps, done, never, always: machine.buffer.is_some(), stall }
    }

    /// The machine with a loader next to it, which loads each block as [`run`](Testbench::run) does: without inputs.
    ///
    /// # Errors
    /// None that a machine gives.
    pub fn driven(&self) -> Result<Design, Diagnostics> {
        self.driven_by(&self.stimulus())
    }

    /// The machine with a loader that does what this stimulus says: without inputs.
    ///
    /// # Errors
    /// The stimulus is not one of this machine.
    pub fn driven_by(&self, stimulus: &Stimulus) -> Result<Design, Diagnostics> {
        Ok(driven(self.design(), stimulus, &[])?.design)
    }

    /// The machine with a loader next to it that loads one block in the first clock, with any words for these
    /// registers: the words are its inputs, and given next to it. All other words are those of the first block.
    ///
    /// # Errors
    /// No load word has this name.
    pub fn driven_by_any(&self, registers: &[String]) -> Result<(Design, Vec<Net>), ModelError> {
        let (driven, words) = self.driven_open(registers)?;
        Ok((driven.design, words))
    }

    /// As [`driven_by_any`](Self::driven_by_any), and returns where the nets of the machine went.
    pub fn driven_open(&self, registers: &[String]) -> Result<(Driven, Vec<Net>), ModelError> {
        let port = |register: &String| match self.machine.inputs.get(register) {
            Some(port) => Ok(port.net),
            None => Err(ModelError::MissingPort(format!("{register}_in"))),
        };
        let words = registers.iter().map(port).collect::<Result<Vec<Net>, ModelError>>()?;
        let mut stimulus = self.stimulus();
        // Up to the end of the first block.
        let load = stimulus.steps.iter().position(|step| step.clocks.is_some());
        stimulus.steps.truncate(load.map_or(0, |load| load + 2));
        let driven = driven(self.design(), &stimulus, &words)?;
        let words = words.into_iter().map(|word| driven.net(word)).collect();
        Ok((driven, words))
    }

    /// The registers that a block is loaded into.
    pub fn load_words(&self) -> impl Iterator<Item = &str> {
        self.machine.inputs.keys().map(String::as_str)
    }

    /// Clock of the last sample of a run, or `None` where a run continues beyond `most`.
    #[must_use]
    pub fn clocks_within(&self, most: u64) -> Option<u64> {
        self.clocks_within_fed(most, &mut self.geometry(0))
    }

    /// The same of a run with the blocks of a feeder; `None` too where that fails.
    #[must_use]
    pub fn clocks_within_fed(&self, most: u64, feeder: &mut dyn Feeder) -> Option<u64> {
        let outcome = self.run_fed(EngineKind::Compiled, feeder, &mut [&mut Until(most)]).ok()?;
        (outcome.clocks <= most).then_some(outcome.clocks)
    }

    /// The nets that a user of the machine connects: its strobes, pulses and positions, and the flags of its
    /// properties.
    #[must_use]
    pub fn outputs(&self) -> Vec<Net> {
        self.ports().into_iter().chain(self.properties()).collect()
    }

    /// The same without the flags of its properties.
    #[must_use]
    pub fn ports(&self) -> Vec<Net> {
        let machine = &self.machine;
        let strobes = [machine.done, machine.loaded, machine.stepped];
        let ports = strobes.iter().chain(&machine.pulses).chain(&machine.positions);
        let buffer = machine.buffer.into_iter().flat_map(|ports| [ports.call, ports.at_end]);
        ports.map(|port| port.net).chain(buffer).collect()
    }

    fn properties(&self) -> Vec<Net> {
        self.design().netlist().properties.iter().map(|property| property.never).collect()
    }
}

/// Ends a run beyond this clock.
struct Until(u64);

impl Observer for Until {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let next = rows.first_clock() + rows.len() as u64;
        if next > self.0.saturating_add(1) { Err("it takes too long".into()) } else { Ok(()) }
    }
}
