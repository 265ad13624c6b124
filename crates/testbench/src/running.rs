//! What changes while a machine is idle: the phase of its pulse source, what runs after the interpolator, and what is made of
//! both.

use stepwave_engine::Idle;
use stepwave_models::Machine;
use stepwave_netlist::Net;

use super::Columns;

/// What runs with the phase of a pulse source, and after the interpolator, in the columns of a wave.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Running {
    /// Columns that may take another value at any clock: the phase and what else [runs](Machine::running), and sums of it.
    pub nets: Vec<Net>,
    /// Columns of 1 bit that do: pulses. All other columns depend on what runs through these alone.
    flags: Vec<Net>,
}

impl Running {
    /// Of a machine with a buffer; of hardware whose pulse source is not known, `None`.
    pub(super) fn of(machine: &Machine, columns: &Columns) -> Option<Running> {
        machine.buffer?;
        let roots = machine.running();
        let netlist = machine.design.netlist();
        let (mut running, mut found) = (vec![false; netlist.cells.len()], Running::default());
        // In the order of creation operands come first.
        for net in netlist.nets() {
            let is_root = roots.contains(&net);
            let mut runs = is_root;
            netlist.cell(net).op.visit_inputs(|operand| runs |= running[operand.index()]);
            let shown = runs && columns.nets().contains(&net);
            if shown && !is_root && netlist.width(net).get() == 1 {
                found.flags.push(net);
            } else {
                running[net.index()] = runs;
                found.nets.extend(shown.then_some(net));
            }
        }
        Some(found)
    }

    /// When the machine is idle: in samples in which no other column of a wave changes.
    pub(super) fn idle(&self, idle: Idle) -> Idle {
        let flags = self.flags.iter().copied().filter(|flag| !idle.flags.contains(flag));
        Idle { flags: idle.flags.iter().copied().chain(flags).collect(), ..idle }
    }
}
