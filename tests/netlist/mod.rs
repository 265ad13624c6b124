//! What netlists promise, tested through their public face: strict arithmetic, simpler netlists of the same behaviour,
//! diagnostics, and the text form. What the tests of engines use too is here.

#![cfg(test)]

mod diagnostics;
mod files;
mod memories;
mod mistakes;
mod one_mistake;
mod simplified;
mod strict;
mod text_form;

use stepwave_engine::{Engine, EngineKind, Rows, Watch};
use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Module, Scope};
use stepwave_netlist::{Design, Net, OnOverflow, Width, elaborate, text};

pub(crate) fn design(describe: impl FnOnce(Scope<'_>)) -> Design {
    design_with(OnOverflow::Trap, describe)
}

pub(crate) fn design_with(on_overflow: OnOverflow, describe: impl FnOnce(Scope<'_>)) -> Design {
    let module = Module::with_overflow("m", on_overflow);
    describe(module.top());
    elaborate(module.finish().unwrap()).unwrap()
}

pub(crate) fn design_of_text(netlist: &str) -> Design {
    elaborate(text::parse(netlist).unwrap()).unwrap()
}

pub(crate) fn net(design: &Design, name: &str) -> Net {
    design.netlist().find(name).unwrap_or_else(|| panic!("there is no net '{name}'")).net
}

pub(crate) fn width(bits: u32) -> Width {
    Width::new(u64::from(bits)).unwrap()
}

/// Bits of a number in two's complement.
pub(crate) fn encode(number: i128, bits: u32) -> u64 {
    u64::try_from(number.rem_euclid(1 << bits)).unwrap()
}

/// The number that these bits mean.
pub(crate) fn decode(value: u64, bits: u32, signed: bool) -> i128 {
    let value = i128::from(value);
    if signed && value >= 1 << (bits - 1) { value - (1 << bits) } else { value }
}

/// All values of a width.
pub(crate) fn values(bits: u32) -> std::ops::Range<u64> {
    0..1 << bits
}

/// An engine whose inputs are set and whose nets are read, sample by sample; nothing is recorded.
pub(crate) struct Probe {
    engine: Box<dyn Engine>,
    rows: Rows,
}

impl Probe {
    pub(crate) fn new(design: &Design, kind: EngineKind) -> Probe {
        Probe { engine: kind.build(design, &Watch::default()), rows: Rows::new(0, 0) }
    }

    /// One clock, after whose edge the inputs have these values.
    pub(crate) fn clock(&mut self, inputs: &[(Net, u64)]) {
        for &(input, value) in inputs {
            self.engine.set_input(input, value);
        }
        self.engine.run(1, &mut self.rows);
    }

    pub(crate) fn value(&self, net: Net) -> u64 {
        self.engine.value(net)
    }
}

/// Every named net of a design that is an output of interest: its name and net.
pub(crate) fn outputs(design: &Design) -> Vec<(String, Net)> {
    let netlist = design.netlist();
    let named = netlist.names.iter().filter(|named| !design.inputs().contains(&named.net));
    named.map(|named| (named.name.clone(), named.net)).collect()
}

/// Read as two's complement in a wave.
pub(crate) fn is_signed(design: &Design, name: &str) -> bool {
    matches!(design.netlist().find(name).unwrap().format, Format::Signed | Format::Analog)
}
