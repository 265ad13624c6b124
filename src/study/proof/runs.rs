//! Recorded runs: what every net holds between two steps.

use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_models::Machine;
use stepwave_netlist::Net;

/// What every net holds in a row of a block that runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State(Vec<u64>);

impl State {
    /// The number that a net means, by the reading of its name.
    #[must_use]
    pub fn number(&self, machine: &Machine, net: Net) -> i128 {
        number(machine, net, self.0.get(net.index()).copied().unwrap_or(0))
    }

    /// The number of this name, as formulas between steps use it: the leaf name of a net.
    #[must_use]
    pub fn value(&self, machine: &Machine, name: &str) -> Option<i128> {
        machine.design.netlist().find(name).map(|named| self.number(machine, named.net))
    }
}

/// The number that these bits of a net mean, by the reading of its name.
pub(super) fn number(machine: &Machine, net: Net, bits: u64) -> i128 {
    let netlist = machine.design.netlist();
    let width = netlist.width(net);
    netlist.name_of(net).map_or(i128::from(bits), |named| named.format.reading().number(width, bits))
}

/// Rows of one run at most: a block that stalls may continue to complete steps.
const MOST_ROWS: usize = 2000;
/// Clocks without a row after which none is waited for.
const LONGEST: u32 = 4096;

/// The rows of a block, but for the last: the samples in which it is loaded or a step was completed.
#[must_use]
pub fn states(machine: &Machine, words: &[(Net, u64)]) -> Vec<State> {
    let design = &machine.design;
    let watch = Watch { columns: design.netlist().nets().collect(), stops: Vec::new() };
    let mut engine = EngineKind::Word.build(design, &watch);
    let mut samples = Rows::new(watch.columns.len(), 64);
    for (input, value) in words {
        engine.set_input(*input, *value);
    }
    let strobes = [machine.load.net, machine.preset_position.net];
    strobes.iter().for_each(|strobe| engine.set_input(*strobe, 1));
    engine.reset(&mut samples);
    strobes.iter().for_each(|strobe| engine.set_input(*strobe, 0));
    let (mut rows, mut quiet) = (Vec::new(), 0);
    while quiet < LONGEST && rows.len() < MOST_ROWS {
        samples.clear();
        engine.run(64, &mut samples);
        for sample in 0..samples.len() {
            let values = samples.row(sample);
            let is = |net: Net| values[net.index()] == 1;
            if is(machine.done.net) {
                return rows;
            }
            quiet += 1;
            if is(machine.loaded.net) || is(machine.stepped.net) {
                quiet = 0;
                rows.push(State(values));
            }
        }
    }
    rows
}
