//! What a bench file says of every run, also of one without a geometry: reset, constants, assumptions, and carries that are
//! meant to be lost.

use std::path::Path;

use super::resolve::{Resolver, read_form};
use super::{BenchError, geometry};
use crate::netlist::cells::{Cell, Claim, Op, Property};
use crate::netlist::{Net, Netlist};
use crate::own::announce;

/// An input that a bench file fixes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Fixed {
    /// Its nets, the lowest first, each with its value in the first clocks and after them.
    nets: Vec<(Net, [u64; 2])>,
    /// How many clocks are the first ones.
    pub(crate) clocks: u64,
    /// It in words.
    pub(crate) about: String,
}

impl Fixed {
    /// It fixes this net.
    pub(crate) fn has(&self, net: Net) -> bool {
        self.nets.iter().any(|(own, _)| *own == net)
    }

    /// The values in the first clocks, or after them.
    pub(crate) fn values(&self, first: bool) -> impl Iterator<Item = (Net, u64)> + '_ {
        self.nets.iter().map(move |(net, [early, late])| (*net, if first { *early } else { *late }))
    }
}

/// What holds in every run of a netlist.
#[derive(Clone, Debug)]
pub(crate) struct Conditions {
    /// The netlist, with a property for each assumption.
    pub(crate) netlist: Netlist,
    pub(crate) fixed: Vec<Fixed>,
    /// Globs of the operators whose carries are meant to be lost.
    pub(crate) wraps: Vec<String>,
}

impl Conditions {
    /// What a bench file says of a netlist; what it says of geometries is not looked at.
    ///
    /// # Errors
    /// The file cannot be read, or what it says does not fit the netlist.
    pub(crate) fn read(netlist: &Netlist, file: &Path) -> Result<Conditions, BenchError> {
        let (text, form) = read_form(file)?;
        let resolver = Resolver { netlist, names: geometry::names(), file: file.display().to_string(), text: &text };
        let mut driven = Vec::new();
        let mut fixed = Vec::new();
        if let Some(given) = &form.reset {
            let reset = resolver.reset(given, &mut driven)?;
            let (port, [on, off]) = (given.port.get_ref(), [reset.active, !reset.active].map(u64::from));
            let about = match reset.clocks {
                0 => format!("{port} = {off}"),
                clocks => format!("{port} = {on} up to clock {}, then {off}", clocks - 1),
            };
            fixed.push(Fixed { nets: vec![(reset.input, [on, off])], clocks: reset.clocks, about });
        }
        for (name, value) in resolver.constants(&form, &mut driven)? {
            let nets = value.into_iter().map(|(net, value)| (net, [value; 2])).collect();
            fixed.push(Fixed { nets, clocks: 0, about: format!("{name} = {}", form.set[name].get_ref().text()) });
        }
        let mut with = netlist.clone();
        for (text, wire) in resolver.assumed(&form)? {
            let never = if wire.inverted { wire.net } else { inverse(&mut with, wire.net) };
            with.properties.push(Property { name: format!("assume {text}"), never, claim: Claim::Assumption });
        }
        announce(&mut with, &form.wraps)
            .map_err(|(glob, why)| resolver.missing(&format!("wraps = [\"{glob}\"]: {why}")))?;
        Ok(Conditions { netlist: with, fixed, wraps: form.wraps })
    }
}

/// The complement of a net of 1 bit.
fn inverse(netlist: &mut Netlist, net: Net) -> Net {
    let own = Net(u32::try_from(netlist.cells.len()).unwrap_or(u32::MAX));
    netlist.cells.push(Cell { op: Op::Not(net), width: netlist.width(net) });
    netlist.sources.push(None);
    own
}
