//! What every sample of a run holds: the named nets, and what overflow reports need beside them.

use std::collections::HashMap;

use stepwave_kernel::Net;
use stepwave_kernel::netlist::Claim;
use stepwave_models::Machine;

/// Nets in the order of a row, each once.
#[derive(Clone, Debug)]
pub struct Columns {
    nets: Vec<Net>,
    index: HashMap<Net, usize>,
}

impl Columns {
    /// Every named net of a machine, and the operands and flags of its strict cells.
    #[must_use]
    pub fn of(machine: &Machine) -> Columns {
        let netlist = machine.design.netlist();
        let mut columns = Columns { nets: Vec::new(), index: HashMap::new() };
        for named in &netlist.names {
            columns.add(named.net);
        }
        for property in &netlist.properties {
            columns.add(property.never);
            if let Claim::NoOverflow { left, right, .. } = property.claim {
                columns.add(left.net);
                columns.add(right.net);
            }
        }
        columns
    }

    fn add(&mut self, net: Net) {
        let next = self.nets.len();
        if *self.index.entry(net).or_insert(next) == next {
            self.nets.push(net);
        }
    }

    /// The nets, one a column.
    #[must_use]
    pub fn nets(&self) -> &[Net] {
        &self.nets
    }

    /// Column of a net.
    ///
    /// # Panics
    /// If the net is neither named nor an operand of a strict cell.
    #[must_use]
    pub fn index(&self, net: Net) -> usize {
        self.index[&net]
    }
}
