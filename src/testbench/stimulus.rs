//! The loading of blocks as data, for a test bench in another language.

use stepwave_kernel::export::{Stall, Step, Stimulus};
use stepwave_kernel::{Net, OnOverflow};

use super::Testbench;

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
        let never = if self.hardware.on_overflow == OnOverflow::Trap { self.properties() } else { Vec::new() };
        let pulses = machine.pulses.iter().map(|port| port.net).collect();
        let stall = Stall { nets: pulses, clocks: self.hardware.stall_clocks };
        Stimulus { steps, done: Some(machine.done.net), never, stall: Some(stall) }
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
