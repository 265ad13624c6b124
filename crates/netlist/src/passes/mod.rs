//! Passes over netlists: the same behaviour from fewer and simpler cells.
//!
//! [`simplify`] walks the cells once in creation order and builds them anew. Each cell goes through three short steps:
//! `constant` computes it if its operands are known, `identity` replaces it by an operand or a simpler operator,
//! `share` finds an equal cell that exists already.

mod concat;
pub mod constant;
mod equal;
mod identity;
mod share;

use std::collections::HashMap;
use std::hash::BuildHasher;

use crate::cells::{Cell, Claim, Net, Netlist, Op, Property};
use share::Builder;

/// A simplified netlist, and where each net of the original one went.
#[derive(Clone, Debug)]
pub struct Simplified {
    /// The new netlist, with all names, properties and invariants.
    pub netlist: Netlist,
    /// New net of each old one.
    pub map: Vec<Net>,
}

impl Simplified {
    /// Where a net of the original went.
    #[must_use]
    pub fn net(&self, old: Net) -> Net {
        self.map[old.index()]
    }

    /// The value of a net of the original, if it is always the same.
    #[must_use]
    pub fn constant(&self, old: Net) -> Option<u64> {
        match self.netlist.cell(self.net(old)).op {
            Op::Const(value) => Some(value),
            _ => None,
        }
    }
}

/// Simplifies an elaborated netlist. Nets in `fixed` are taken to have the given values: the result
/// behaves as the original only while they do.
#[must_use]
pub fn simplify(netlist: &Netlist, fixed: &HashMap<Net, u64, impl BuildHasher>) -> Simplified {
    let mut builder = Builder::default();
    let mut map: Vec<Net> = Vec::with_capacity(netlist.cells.len());
    for (net, cell) in netlist.nets().zip(&netlist.cells) {
        let new = match (fixed.get(&net), cell.op) {
            (Some(&value), _) => builder.constant(value, cell.width),
            (None, Op::Input | Op::Register { .. }) => builder.leaf(*cell),
            (None, op) => builder.make(op.map_inputs(|old| map[old.index()]), cell.width),
        };
        map.push(new);
    }
    let mut new = Netlist {
        cells: builder.into_cells(),
        scopes: netlist.scopes.clone(),
        memories: netlist.memories.clone(),
        names: netlist.names.clone(),
        properties: netlist.properties.clone(),
        invariants: netlist.invariants.clone(),
        sources: Vec::new(),
    };
    new.sources = vec![None; new.cells.len()];
    // The first of cells that became one.
    for (source, &new_net) in netlist.sources.iter().zip(&map) {
        let place = &mut new.sources[new_net.index()];
        if place.is_none() {
            place.clone_from(source);
        }
    }
    for (old, cell) in netlist.nets().zip(&netlist.cells) {
        if let Op::Register { next: Some(next), reset } = cell.op
            && !fixed.contains_key(&old)
        {
            let op = Op::Register { next: Some(map[next.index()]), reset };
            new.cells[map[old.index()].index()] = Cell { op, width: cell.width };
        }
    }
    for port in new.memories.iter_mut().flat_map(|memory| &mut memory.writes) {
        *port = port.map(|net| map[net.index()]);
    }
    for named in &mut new.names {
        *named = named.map(|net| map[net.index()]);
    }
    for property in &mut new.properties {
        move_property(property, |net| map[net.index()]);
    }
    Simplified { netlist: new, map }
}

/// A property about other nets.
pub fn move_property(property: &mut Property, go: impl Fn(Net) -> Net) {
    property.never = go(property.never);
    property.claim = std::mem::replace(&mut property.claim, Claim::Invariant).map(go);
}
