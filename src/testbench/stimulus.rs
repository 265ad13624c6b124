//! The loading of blocks as data, for a test bench in another language, and as hardware, for model checkers.

use stepwave_engine::{EngineKind, Rows};
use stepwave_export::{Driven, Stall, Step, Stimulus, driven};
use stepwave_models::ModelError;
use stepwave_models::options::ON_OVERFLOW;
use stepwave_netlist::{Design, Diagnostics, Net, OnOverflow};

use super::{Observer, ObserverError, Testbench};

impl Testbench {
    /// What [`run`](Testbench::run) does to the machine: each block is put on the inputs together with `load` for one
    /// clock, then the clock runs until `done`. A run without pulses ends too, though at another clock than here, where
    /// it is looked for now and then only.
    #[must_use]
    pub fn stimulus(&self) -> Stimulus {
        let machine = &self.machine;
        let mut steps = Vec::new();
        for (index, words) in self.blocks.iter().enumerate() {
            let mut load = words.clone();
            load.push((machine.load.net, 1));
            load.push((machine.preset_position.net, u64::from(index == 0)));
            steps.push(Step { set: load, clocks: Some(1) });
            steps.push(Step { set: vec![(machine.load.net, 0), (machine.preset_position.net, 0)], clocks: None });
        }
        let never = if self.hardware.get(&ON_OVERFLOW) == OnOverflow::Trap { self.properties() } else { Vec::new() };
        let pulses = machine.pulses.iter().map(|port| port.net).collect();
        let stall = Stall { nets: pulses, clocks: self.hardware.stall_clocks };
        Stimulus { steps, done: Some(machine.done.net), never, stall: Some(stall) }
    }

    /// The machine with a loader beside it, which loads each block as [`run`](Testbench::run) does: without inputs.
    ///
    /// # Errors
    /// None that a machine gives.
    pub fn driven(&self) -> Result<Design, Diagnostics> {
        Ok(driven(self.design(), &self.stimulus(), &[])?.design)
    }

    /// The machine with a loader beside it that loads one block in the first clock, with any words for these registers: the
    /// words are its inputs, and given beside it. All other words are those of the first block.
    ///
    /// # Errors
    /// No load word bears such a name.
    pub fn driven_by_any(&self, registers: &[String]) -> Result<(Design, Vec<Net>), ModelError> {
        let (driven, words) = self.driven_open(registers)?;
        Ok((driven.design, words))
    }

    /// As [`driven_by_any`](Self::driven_by_any), and tells where the nets of the machine went.
    pub(crate) fn driven_open(&self, registers: &[String]) -> Result<(Driven, Vec<Net>), ModelError> {
        let port = |register: &String| match self.machine.inputs.get(register) {
            Some(port) => Ok(port.net),
            None => Err(ModelError::MissingPort(format!("{register}_in"))),
        };
        let words = registers.iter().map(port).collect::<Result<Vec<Net>, ModelError>>()?;
        let mut stimulus = self.stimulus();
        stimulus.steps.truncate(2);
        let driven = driven(self.design(), &stimulus, &words)?;
        let words = words.into_iter().map(|word| driven.net(word)).collect();
        Ok((driven, words))
    }

    /// The registers that a block is loaded into.
    pub fn load_words(&self) -> impl Iterator<Item = &str> {
        self.machine.inputs.keys().map(String::as_str)
    }

    /// Clock of the last sample of a run, or `None` where a run goes on beyond `most`.
    #[must_use]
    pub fn clocks_within(&self, most: u64) -> Option<u64> {
        let outcome = self.run(EngineKind::Compiled, &mut [&mut Until(most)]).ok()?;
        (outcome.clocks <= most).then_some(outcome.clocks)
    }

    /// The nets that a user of the machine connects: its strobes, pulses and positions, and the flags of its properties.
    #[must_use]
    pub fn outputs(&self) -> Vec<Net> {
        let machine = &self.machine;
        let strobes = [machine.done, machine.loaded, machine.stepped];
        let ports = strobes.iter().chain(&machine.pulses).chain(&machine.positions);
        ports.map(|port| port.net).chain(self.properties()).collect()
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
