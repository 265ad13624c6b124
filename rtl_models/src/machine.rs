//! A machine: a design with the ports that a test bench needs, found by their names.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Deref;

use stepwave_netlist::bits::Reading;
use stepwave_netlist::{Design, Net, Netlist, OnOverflow, Width, elaborate};

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::options::ON_OVERFLOW;
use crate::program::After;
use crate::registers::Reg;

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
/// name of the register, and its value.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Words(Vec<(&'static str, i128)>);

impl Words {
    /// None.
    #[must_use]
    pub fn new() -> Words {
        Words::default()
    }

    /// With one more, for this register.
    #[must_use]
    pub fn set(mut self, register: Reg, value: impl Into<i128>) -> Words {
        self.0.push((register.name(), value.into()));
        self
    }

    /// With one more, for the input of this name.
    #[must_use]
    pub fn set_input(mut self, input: &'static str, value: i128) -> Words {
        self.0.push((input, value));
        self
    }

    /// With a word for each of these registers.
    #[must_use]
    pub fn set_each<const K: usize>(self, registers: Reg<K>, values: [impl Into<i128>; K]) -> Words {
        values.into_iter().enumerate().fold(self, |words, (index, value)| words.set(registers.of(index), value))
    }

    /// With others.
    #[must_use]
    pub fn and(mut self, others: Words) -> Words {
        self.0.extend(others.0);
        self
    }

    /// The word for a register.
    #[must_use]
    pub fn get(&self, register: Reg) -> Option<i128> {
        self.0.iter().find(|(name, _)| *name == register.name()).map(|(_, value)| *value)
    }
}

impl Deref for Words {
    type Target = [(&'static str, i128)];

    fn deref(&self) -> &[(&'static str, i128)] {
        &self.0
    }
}

impl IntoIterator for Words {
    type Item = (&'static str, i128);
    type IntoIter = std::vec::IntoIter<(&'static str, i128)>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

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
    pub table: Vec<(&'static str, Port)>,
    /// Load inputs by the register that they load.
    pub inputs: BTreeMap<String, Port>,
    /// Ports of the block buffer, of a machine that runs whole programs.
    pub buffer: Option<BufferPorts>,
    /// What its pulses go through after the interpolator, with `--ramp after`.
    pub after: Option<AfterPorts>,
    /// Flags that end a run where overflows trap; 1 bit each.
    pub traps: Vec<Net>,
}

/// Ports of a machine that takes the next block while the present one runs; 1 bit each but the last.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct BufferPorts {
    /// An input: the loader has a further block.
    pub more: Net,
    /// 1 where that block may be loaded.
    pub call: Net,
    /// 1 where every block has ended and there is no further one.
    pub at_end: Net,
    /// The phase of the pulse source, which runs freely.
    pub phase: Net,
}

/// Ports of what the pulses of a machine go through after its interpolator.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct AfterPorts {
    /// Signed pulse of each axis for its drive: -1, 0, +1.
    pub pulses: Vec<Port>,
    /// Position of each axis in BLU after these.
    pub positions: Vec<Port>,
    /// What runs freely: the clock of the period, the divider of the fine lines, and their remainders.
    pub running: Vec<Net>,
    /// 1: every pulse of the interpolator has come out.
    pub empty: Net,
}

/// What an input is called for the register that it loads.
pub(crate) fn input_name(register: &str) -> String {
    format!("{register}_in")
}

impl Port {
    /// The net of this name, given as leaf name or as dotted path.
    ///
    /// # Errors
    /// There is none.
    pub fn of(netlist: &Netlist, name: &str) -> Result<Port, ModelError> {
        let named = netlist.find(name).ok_or_else(|| ModelError::MissingPort(name.to_owned()))?;
        Ok(Port { net: named.net, width: netlist.width(named.net), reading: named.format.reading() })
    }
}

impl Machine {
    /// What changes at every clock while a program runs, whatever else it does: the phase of the pulse source, and what runs
    /// after the interpolator; nothing without a buffer.
    #[must_use]
    pub fn running(&self) -> Vec<Net> {
        let after = self.after.iter().flat_map(|ports| &ports.running).copied();
        self.buffer.iter().map(|ports| ports.phase).chain(after).collect()
    }

    /// Elaborates a netlist and finds its ports.
    pub(crate) fn new(netlist: Netlist, hardware: &Hardware) -> Result<Machine, ModelError> {
        let find = |name: &str| Port::of(&netlist, name);
        let letters = hardware.letters().iter();
        let inputs = netlist.names.iter().filter_map(|named| named.name.strip_suffix("_in"));
        let inputs = inputs.map(|register| Ok((register.to_owned(), find(&input_name(register))?)));
        let table = hardware.table.iter().map(|name| Ok((*name, find(name)?)));
        let net = |name: &str| find(name).map(|port| port.net);
        let ports = |more: Port| {
            let (call, at_end, phase) = (net("call")?, net("at_end")?, net("phase")?);
            Ok::<_, ModelError>(BufferPorts { more: more.net, call, at_end, phase })
        };
        let of_axes = |name: &dyn Fn(&str) -> String| {
            hardware.letters().iter().map(|axis| find(&name(axis))).collect::<Result<Vec<Port>, ModelError>>()
        };
        let after = |_| {
            let running = ["sample_clock".to_owned(), "spread".to_owned()].into_iter();
            let running = running.chain(hardware.letters().iter().map(|axis| format!("fr{axis}")));
            Ok::<_, ModelError>(AfterPorts {
                pulses: of_axes(&|axis| format!("d{axis}_out"))?,
                positions: of_axes(&|axis| format!("{axis}_out"))?,
                running: running.map(|name| net(&name)).collect::<Result<_, _>>()?,
                empty: net("empty")?,
            })
        };
        Ok(Machine {
            after: After::of(hardware).map(after).transpose()?,
            buffer: find("more").ok().map(ports).transpose()?,
            load: find("load")?,
            preset_position: find("preset_position")?,
            done: find("done")?,
            loaded: find("loaded")?,
            stepped: find("stepped")?,
            pulses: letters.clone().map(|axis| find(&format!("d{axis}"))).collect::<Result<_, ModelError>>()?,
            positions: letters.map(|axis| find(axis)).collect::<Result<_, ModelError>>()?,
            table: table.collect::<Result<_, ModelError>>()?,
            inputs: inputs.collect::<Result<_, ModelError>>()?,
            traps: netlist.properties.iter().map(|property| property.never).collect(),
            design: elaborate(netlist)?,
        })
    }

    /// The bits of every word of every block, each of which must fit: for statements about all geometries.
    ///
    /// # Errors
    /// A value does not fit in its register.
    pub fn encode(&self, hardware: &Hardware, blocks: &[Words]) -> Result<Vec<Vec<(Net, u64)>>, ModelError> {
        self.loaded(hardware, blocks, OnOverflow::Trap).map(|loaded| loaded.blocks)
    }

    /// The bits of every word of every block as the hardware takes them. What does not fit is refused where overflows
    /// trap; else it is cut to the lowest bits as a bus cuts it, or held at an end of the range, and listed.
    ///
    /// # Errors
    /// Where overflows trap: a value does not fit in its register.
    pub fn load(&self, hardware: &Hardware, blocks: &[Words]) -> Result<Loaded, ModelError> {
        self.loaded(hardware, blocks, hardware.get(&ON_OVERFLOW))
    }

    fn loaded(&self, hardware: &Hardware, blocks: &[Words], mode: OnOverflow) -> Result<Loaded, ModelError> {
        let mut loaded = Loaded::default();
        for (index, words) in blocks.iter().enumerate() {
            let mut block = Vec::with_capacity(words.len());
            for &(register, value) in words.iter() {
                let port = self.inputs.get(register).ok_or_else(|| ModelError::MissingPort(register.to_owned()))?;
                let bits = match (port.reading.bits(port.width, value), mode) {
                    (Some(bits), _) => bits,
                    (None, OnOverflow::Trap) => return Err(does_not_fit(register, port, hardware, blocks)),
                    (None, OnOverflow::Wrap) => port.reading.wrapped(port.width, value),
                    (None, OnOverflow::Saturate) => port.reading.saturated(port.width, value),
                };
                let taken = port.reading.number(port.width, bits.value());
                if taken != value {
                    loaded.cut.push(CutWord { register, block: index, value, loaded: taken, width: port.width });
                }
                block.push((port.net, bits.value()));
            }
            loaded.blocks.push(block);
        }
        Ok(loaded)
    }
}

/// What the inputs of a machine are set to, block by block.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// Each input and its bits.
    pub blocks: Vec<Vec<(Net, u64)>>,
    /// The words that did not fit in their registers.
    pub cut: Vec<CutWord>,
}

/// A load word that did not fit in its register, and what the register took of it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CutWord {
    /// The register.
    pub register: &'static str,
    /// Index of the block, from 0.
    pub block: usize,
    /// The word.
    pub value: i128,
    /// What was loaded.
    pub loaded: i128,
    /// Width of the register.
    pub width: Width,
}

/// `e = 300 does not fit in its 8 bits: 44 was loaded`
impl fmt::Display for CutWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let CutWord { register, value, loaded, width, .. } = self;
        write!(f, "{register} = {value} does not fit in its {width}: {loaded} was loaded")
    }
}

/// The refusal of a register that cannot hold one of its load values: it names the one that needs most, and a width
/// with which all blocks can be loaded into it.
fn does_not_fit(register: &str, port: &Port, hardware: &Hardware, blocks: &[Words]) -> ModelError {
    let words = || blocks.iter().flat_map(|words| words.iter().copied());
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
