//! What every sample of a run holds: the named nets, and what overflow reports need in addition.

use std::collections::HashMap;

use stepwave_models::Machine;
use stepwave_netlist::cells::{NamedNet, Op};
use stepwave_netlist::{Design, Net, Netlist};

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
        Columns::of_design(&machine.design)
    }

    /// Every named net of a design, and what its properties are about.
    #[must_use]
    pub fn of_design(design: &Design) -> Columns {
        let netlist = design.netlist();
        Columns::of_nets(netlist, netlist.names.iter().flat_map(NamedNet::nets))
    }

    /// What is looked at where no wave is written: every named register, the ports of the step table, and the operands
    /// and flags of strict cells.
    #[must_use]
    pub fn without_wave(machine: &Machine) -> Columns {
        let netlist = machine.design.netlist();
        let names = netlist.names.iter().flat_map(NamedNet::nets);
        let registers = names.filter(|&net| matches!(netlist.cell(net).op, Op::Register { .. }));
        let table = machine.table.iter().map(|(_, port)| port);
        let strobes = [&machine.loaded, &machine.stepped].into_iter();
        let ports = strobes.chain(&machine.pulses).chain(&machine.positions).chain(table);
        Columns::of_nets(netlist, registers.chain(ports.map(|port| port.net)))
    }

    /// These nets, and those of the properties.
    fn of_nets(netlist: &Netlist, nets: impl Iterator<Item = Net>) -> Columns {
        let mut columns = Columns { nets: Vec::new(), index: HashMap::new() };
        nets.for_each(|net| columns.add(net));
        for property in &netlist.properties {
            columns.add(property.never);
            property.claim.nets().into_iter().for_each(|net| columns.add(net));
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
    /// If the net is not one of them.
    #[must_use]
    pub fn index(&self, net: Net) -> usize {
        self.index[&net]
    }
}
