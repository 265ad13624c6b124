//! Hardware of one's own: the word-level cells that Yosys writes as JSON (`write_json`) become a netlist.
//!
//! Widths and operators are what the author wrote. A word of more than 64 bits becomes parts of 64, the least significant
//! first, under one name. The design has one clock, whose edge the netlist's own clock is; a bit that is unknown (x) is 0 unless the
//! [`Options`] say otherwise.

mod cells;
mod clock;
mod design;
mod error;
mod json;
mod memory;
mod names;
mod overflow;
mod properties;
mod registers;
mod undefined;
mod word;

use stepwave_netlist::cells::{Netlist, Op};

pub use clock::Clock;
pub use error::{CellPlace, ImportError};

use design::{Design, Part};
use names::Scopes;
use word::Builder;

/// What a bit is taken for that Verilog leaves unknown: an x, a z, or a register without an initial value.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Unknown {
    /// 0.
    #[default]
    Zero,
    /// 1.
    One,
    /// 0 or 1, by a generator with this seed.
    Random(u64),
}

/// How a design is imported.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// Name of the module; by default the one that is marked as top, or the only one.
    pub top: Option<String>,
    /// What unknown bits are taken for.
    pub unknown: Unknown,
}

/// A design that has been imported.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Imported {
    /// The netlist; its top scope has the name of the module.
    pub netlist: Netlist,
    /// The clock; `None` of a design without registers.
    pub clock: Option<Clock>,
    /// What is not in the source but was assumed, a sentence each.
    pub notes: Vec<String>,
}

/// The netlist of a flat module in the JSON of Yosys.
///
/// # Errors
/// The text is something else, or the design has a cell that cannot be simulated on one clock; see [`ImportError`].
pub fn import(text: &str, options: &Options) -> Result<Imported, ImportError> {
    let (name, module) = json::top(text, options.top.as_deref())?;
    let mut scopes = Scopes::new();
    let top = scopes.place(&mut Vec::new(), &name.replace('.', "_")).1;
    let mut design = Design::new(&module, options, Builder::new(Netlist::new(&top)));
    let clock = design.clock()?;
    design.inputs(clock.as_ref().map(|(_, net)| *net))?;
    let pending = design.registers()?;
    design.memories(&mut scopes)?;
    for node in design.ordered(design.nodes()?)? {
        design.at(node.cell);
        let word = match node.part {
            Part::Whole => design.logic(node.name, node.cell, None)?,
            Part::Lane(lane) => design.logic(node.name, node.cell, Some(lane))?,
            Part::Output => design.output(&node),
            Part::Port(port) => design.read(&node, port),
        };
        design.drive(node.outputs(), &word);
    }
    for register in &pending {
        design.clocked(register);
    }
    design.clock_memories();
    design.name_nets(&mut scopes, clock.as_ref().map(|(_, net)| *net));
    design.assertions(clock.as_ref().map(|(_, net)| *net));
    let mut readers = design.readers();
    design.overflows(&mut scopes, &mut readers);
    design.undefined(&mut scopes, &mut readers);
    let Design { builder, notes, .. } = design;
    Ok(Imported { netlist: builder.netlist, clock: clock.map(|(clock, _)| clock), notes })
}

impl Design<'_> {
    /// The input ports but the clock, part by part.
    fn inputs(&mut self, clock: Option<u32>) -> Result<(), ImportError> {
        for (name, port) in &self.module.ports {
            match port.direction.as_str() {
                "input" => {}
                "output" => continue,
                _ => return Err(ImportError::Inout { port: name.clone() }),
            }
            if clock.is_some_and(|net| port.bits == [json::Wire::Net(net)]) || port.bits.is_empty() {
                continue;
            }
            let width = u32::try_from(port.bits.len()).unwrap_or(u32::MAX);
            let word = self.builder.each(width, |_| Op::Input);
            self.drive(&port.bits, &word);
        }
        Ok(())
    }
}
