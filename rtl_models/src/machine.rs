//! A machine: a design with the ports that a test bench needs, found by their names.

use std::collections::BTreeMap;

use stepwave_kernel::bits::Reading;
use stepwave_kernel::prove::Strobes;
use stepwave_kernel::{Design, Net, Netlist, Width, elaborate};

use crate::error::ModelError;
use crate::hardware::Hardware;

/// A net as a number: its width and reading.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Port {
    /// The net.
    pub net: Net,
    /// Number of bits.
    pub width: Width,
    /// What number its bits mean.
    pub reading: Reading,
}

/// The words that the block loader puts on a machine's inputs for one block (a line, or one sector of an arc): the
/// register meant, and its value.
pub type Words = Vec<(&'static str, i128)>;

/// A design and its ports.
#[derive(Clone, Debug)]
pub struct Machine {
    /// The checked netlist.
    pub design: Design,
    /// 1 for one clock loads a block.
    pub load: Port,
    /// 1 together with `load` presets the position counters too: the first block.
    pub preset_position: Port,
    /// 1 from the end of a block until the next is loaded.
    pub done: Port,
    /// 1 for one clock after a block was loaded: row 0 of a step table.
    pub loaded: Port,
    /// 1 for one clock after a step was completed: a row of a step table.
    pub stepped: Port,
    /// Signed pulse of each axis: -1, 0, +1.
    pub pulses: Vec<Port>,
    /// Machine position of each axis in BLU.
    pub positions: Vec<Port>,
    /// Registers of a step table, in order.
    pub table: Vec<(String, Port)>,
    /// Load inputs by the register that they load.
    pub inputs: BTreeMap<String, Port>,
}

/// What an input is called for the register that it loads.
pub(crate) fn input_name(register: &str) -> String {
    format!("{register}_in")
}

fn port(netlist: &Netlist, name: &str) -> Result<Port, ModelError> {
    let named = netlist.find(name).ok_or_else(|| ModelError::MissingPort(name.to_owned()))?;
    Ok(Port { net: named.net, width: netlist.width(named.net), reading: named.format.reading() })
}

impl Machine {
    /// Elaborates a netlist and finds its ports.
    pub(crate) fn new(netlist: Netlist, hardware: &Hardware) -> Result<Machine, ModelError> {
        let find = |name: &str| port(&netlist, name);
        let letters = hardware.letters().iter();
        let inputs = netlist.names.iter().filter_map(|named| named.name.strip_suffix("_in"));
        let inputs = inputs.map(|register| Ok((register.to_owned(), find(&input_name(register))?)));
        let table = hardware.table.iter().map(|name| Ok((name.clone(), find(name)?)));
        Ok(Machine {
            load: find("load")?,
            preset_position: find("preset_position")?,
            done: find("done")?,
            loaded: find("loaded")?,
            stepped: find("stepped")?,
            pulses: letters.clone().map(|axis| find(&format!("d{axis}"))).collect::<Result<_, ModelError>>()?,
            positions: letters.map(|axis| find(axis)).collect::<Result<_, ModelError>>()?,
            table: table.collect::<Result<_, ModelError>>()?,
            inputs: inputs.collect::<Result<_, ModelError>>()?,
            design: elaborate(netlist)?,
        })
    }

    /// The nets by which a proof follows a block.
    #[must_use]
    pub fn strobes(&self) -> Strobes {
        let [load, preset_position, loaded, stepped, done] =
            [self.load, self.preset_position, self.loaded, self.stepped, self.done].map(|port| port.net);
        Strobes { load, preset_position, loaded, stepped, done }
    }

    /// The bits of every word of every block, checked against the inputs.
    ///
    /// # Errors
    /// A value does not fit in its register.
    pub fn encode(&self, hardware: &Hardware, blocks: &[Words]) -> Result<Vec<Vec<(Net, u64)>>, ModelError> {
        let encode = |&(register, value): &(&'static str, i128)| {
            let port = self.inputs.get(register).ok_or_else(|| ModelError::MissingPort(register.to_owned()))?;
            let bits = port.reading.bits(port.width, value);
            Ok((port.net, bits.ok_or_else(|| does_not_fit(register, port, hardware, blocks))?.value()))
        };
        blocks.iter().map(|words| words.iter().map(encode).collect()).collect()
    }
}

/// The refusal of a register that cannot hold one of its load values: it names the one that needs most, and a width
/// with which all blocks can be loaded into it.
fn does_not_fit(register: &str, port: &Port, hardware: &Hardware, blocks: &[Words]) -> ModelError {
    let words = || blocks.iter().flatten().copied();
    let need = |value| port.reading.needed(value);
    let own = words().filter(|&(name, _)| name == register).map(|(_, value)| value);
    let value = own.max_by_key(|&value| need(value)).unwrap_or_default();
    let integrators = words().filter(|(name, _)| hardware.shares_a_scale(name));
    // Registers with a fraction are that much wider than the width that is given for all.
    let all = integrators.map(|(name, value)| need(value).saturating_sub(hardware.fraction(name))).max().unwrap_or(1);
    ModelError::DoesNotFit {
        register: register.to_owned(),
        value,
        width: port.width,
        needed: need(value),
        option: hardware.widening(register, need(value), all),
    }
}
