//! `Netlist` → `Design`: checked, levelled, immutable. Engines take nothing else.
//!
//! Checked are, for every cell: operands exist and come before their user (registers excepted); widths obey
//! [`Netlist::check_cell`]; every register has a next value; properties are one bit and their operands exist; names of
//! nets and scopes fit and are unique in their scope. All mistakes are reported at once; only where a name belongs to
//! nothing are such names reported alone.

use rustc_hash::FxHashMap as HashMap;
use std::sync::Arc;

use crate::bits::Width;
use crate::cells::{Claim, HasMemories, NamedNet, Net, Netlist, Op, ScopeId, Word};
use crate::diag::{Code, Diagnostic, Diagnostics, Place};
use crate::dsl::is_identifier;

/// A netlist that any engine can run. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Design {
    inner: Arc<Inner>,
}

#[derive(Debug)]
struct Inner {
    netlist: Netlist,
    registers: Vec<Net>,
    inputs: Vec<Net>,
    order: Vec<Net>,
    levels: usize,
}

impl Design {
    /// The netlist.
    #[must_use]
    pub fn netlist(&self) -> &Netlist {
        &self.inner.netlist
    }

    /// All registers in creation order.
    #[must_use]
    pub fn registers(&self) -> &[Net] {
        &self.inner.registers
    }

    /// Nothing, where the design has no memory.
    ///
    /// # Errors
    /// It has one; `tool`, in the plural, cannot take it.
    pub fn without_memories(&self, tool: &'static str) -> Result<(), HasMemories> {
        let netlist = self.netlist();
        let first = netlist.memories.first().map(|memory| netlist.memory_path(memory));
        first.map_or(Ok(()), |memory| Err(HasMemories { tool, memory }))
    }

    /// Bits of all registers together.
    #[must_use]
    pub fn register_bits(&self) -> u32 {
        self.registers().iter().map(|&register| self.netlist().width(register).get()).sum()
    }

    /// All inputs in creation order.
    #[must_use]
    pub fn inputs(&self) -> &[Net] {
        &self.inner.inputs
    }

    /// The combinational cells that a register, a property or a name depends on, level by level: a cell comes after
    /// all its operands.
    #[must_use]
    pub fn order(&self) -> &[Net] {
        &self.inner.order
    }

    /// Depth of the combinational logic in cells.
    #[must_use]
    pub fn levels(&self) -> usize {
        self.inner.levels
    }
}

/// Checks and levels a netlist.
///
/// # Errors
/// Every mistake found; see the module's list.
pub fn elaborate(netlist: Netlist) -> Result<Design, Diagnostics> {
    let diagnostics = check(&netlist);
    if !diagnostics.is_empty() {
        return Err(Diagnostics(diagnostics));
    }
    let live = live_cells(&netlist);
    let mut level = vec![0usize; netlist.cells.len()];
    let mut order = Vec::new();
    for net in netlist.nets() {
        let op = netlist.cell(net).op;
        let mut above = 0;
        op.visit_inputs(|input| above = above.max(level[input.index()]));
        if !matches!(op, Op::Input | Op::Const(_) | Op::Register { .. }) {
            level[net.index()] = above + 1;
            if live[net.index()] {
                order.push(net);
            }
        }
    }
    order.sort_by_key(|net| level[net.index()]);
    let levels = order.last().map_or(0, |net| level[net.index()]);
    let of_kind = |wanted: fn(&Op) -> bool| netlist.nets().filter(|&net| wanted(&netlist.cell(net).op)).collect();
    let registers = of_kind(|op| matches!(op, Op::Register { .. }));
    let inputs = of_kind(|op| matches!(op, Op::Input));
    Ok(Design { inner: Arc::new(Inner { registers, inputs, order, levels, netlist }) })
}

fn check(netlist: &Netlist) -> Vec<Diagnostic> {
    let count = netlist.cells.len();
    let nowhere =
        |named: &&NamedNet| named.nets().any(|net| net.index() >= count) || named.scope.index() >= netlist.scopes.len();
    let mut ghosts: Vec<Diagnostic> = netlist.names.iter().filter(nowhere).map(ghost).collect();
    for memory in &netlist.memories {
        let mut nets = memory.writes.iter().flat_map(|port| port.nets());
        if memory.scope.index() >= netlist.scopes.len() || nets.any(|net| net.index() >= count) {
            let message = format!("the memory '{}' is in a scope or written by a net that does not exist", memory.name);
            ghosts.push(Diagnostic { code: Code::Order, place: Place::Component(memory.name.clone()), message });
        }
    }
    if !ghosts.is_empty() {
        // The messages below look nets up by their names, which would fail.
        return ghosts;
    }
    let mut found = Vec::new();
    let mut report = |code, place, message| found.push(Diagnostic { code, place, message });
    check_cells(netlist, &mut report);
    check_names(netlist, &mut report);
    check_properties(netlist, &mut report);
    found
}

/// Every cell comes after what it reads, and obeys the rule of its operator.
fn check_cells(netlist: &Netlist, report: &mut impl FnMut(Code, Place, String)) {
    let count = netlist.cells.len();
    let place = |net: Net| match netlist.sources.get(net.index()) {
        Some(Some(source)) => Place::Source(source.clone()),
        _ => Place::Component(format!("net %{}", net.index())),
    };
    for (net, cell) in netlist.nets().zip(&netlist.cells) {
        let mut in_order = true;
        cell.op.visit_inputs(|input| in_order &= input.index() < net.index());
        let next_exists = match cell.op {
            Op::Register { next: Some(next), .. } => next.index() < count,
            _ => true,
        };
        if !in_order || !next_exists {
            let message = format!("net %{} reads a net that does not come before it", net.index());
            report(Code::Order, place(net), message);
        } else if matches!(cell.op, Op::Register { next: None, .. }) {
            report(Code::UndrivenRegister, place(net), format!("register %{} never gets a next value", net.index()));
        } else if let Err((code, message)) = netlist.check_cell(cell) {
            report(code, place(net), message);
        }
    }
    for memory in &netlist.memories {
        for (code, message) in netlist.memory_mistakes(memory) {
            report(code, Place::Component(netlist.memory_path(memory)), message);
        }
    }
}

/// Every name is an identifier, and is given once in its scope.
fn check_names(netlist: &Netlist, report: &mut impl FnMut(Code, Place, String)) {
    let memories = netlist.memories.iter().enumerate();
    let memories =
        memories.map(|(index, memory)| (Some(memory.scope), memory.name.as_str(), format!("memory {index}")));
    let scopes = netlist.scopes.iter().enumerate();
    let scopes = scopes.map(|(index, scope)| (scope.parent, scope.name.as_str(), format!("scope {index}")));
    let nets = netlist.names.iter();
    let nets = nets.map(|named| {
        let all: Vec<String> = named.nets().map(|net| net.to_string()).collect();
        (Some(named.scope), named.name.as_str(), format!("net {}", all.join(" ")))
    });
    for named in &netlist.names {
        let nets: Vec<Net> = named.nets().collect();
        if let Some(message) = netlist.word_mistake(&nets) {
            report(Code::WidthMismatch, Place::Component(netlist.path(named)), message);
        }
    }
    // The scope or net of each name.
    let mut used: HashMap<(Option<ScopeId>, &str), String> = HashMap::default();
    for (scope, name, bearer) in scopes.chain(nets).chain(memories) {
        let place = Place::Component(name.to_owned());
        if !is_identifier(name) {
            report(Code::BadName, place.clone(), format!("invalid name for a wave '{name}'"));
        }
        if let Some(first) = used.get(&(scope, name)) {
            let path = scope.map_or_else(String::new, |scope| netlist.scope_path(scope) + ".");
            report(Code::DuplicateName, place, format!("'{path}{name}' is given to {first} and to {bearer}"));
        } else {
            used.insert((scope, name), bearer);
        }
    }
}

/// Every property is one existing bit about existing operands.
fn check_properties(netlist: &Netlist, report: &mut impl FnMut(Code, Place, String)) {
    let count = netlist.cells.len();
    for property in &netlist.properties {
        let place = Place::Component(property.name.clone());
        if property.never.index() >= count {
            report(Code::Order, place.clone(), "the property's net does not exist".to_owned());
        } else if netlist.width(property.never) != Width::ONE {
            report(Code::NotOneBit, place.clone(), "a property is 1 bit wide".to_owned());
        }
        if property.claim.nets().iter().any(|net| net.index() >= count) {
            report(Code::Order, place, "an operand of the property does not exist".to_owned());
        } else {
            let words = match &property.claim {
                Claim::Fits { left, right, .. } => vec![left, right],
                Claim::Defined { operand, .. } => vec![operand],
                Claim::Print { numbers, .. } => numbers.iter().collect(),
                Claim::NoOverflow { .. } | Claim::Invariant | Claim::Assumption | Claim::Cover => Vec::new(),
            };
            if let Claim::Print { message, numbers, .. } = &property.claim {
                let bits = |word: &Word| netlist.bits(word.nets.iter().copied());
                if !message.numbers().eq(numbers.iter().map(bits)) {
                    report(
                        Code::WidthMismatch,
                        place.clone(),
                        "the text shows other widths than its numbers have".to_owned(),
                    );
                }
            }
            for message in words.into_iter().filter_map(|word| netlist.word_mistake(&word.nets)) {
                report(Code::WidthMismatch, place.clone(), message);
            }
        }
    }
}

fn ghost(named: &NamedNet) -> Diagnostic {
    let message = format!("the name '{}' is given to a net or in a scope that does not exist", named.name);
    Diagnostic { code: Code::Order, place: Place::Component(named.name.clone()), message }
}

/// Marks what a register, a memory, a property or a name depends on.
fn live_cells(netlist: &Netlist) -> Vec<bool> {
    let mut live = vec![false; netlist.cells.len()];
    let mut pending: Vec<Net> = netlist.names.iter().flat_map(NamedNet::nets).collect();
    pending.extend(netlist.properties.iter().map(|property| property.never));
    // Operands of operators are read by them; the numbers of a text by nothing else.
    pending.extend(netlist.properties.iter().flat_map(|property| property.claim.nets()));
    pending.extend(netlist.memories.iter().flat_map(|memory| &memory.writes).flat_map(|port| port.nets()));
    for cell in &netlist.cells {
        if let Op::Register { next: Some(next), .. } = cell.op {
            pending.push(next);
        }
    }
    while let Some(net) = pending.pop() {
        if !std::mem::replace(&mut live[net.index()], true) {
            netlist.cell(net).op.visit_inputs(|input| pending.push(input));
        }
    }
    live
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsl::Module;

    #[test]
    fn cells_that_nothing_depends_on_are_left_out_and_operands_come_first() {
        let module = Module::new("m");
        let m = module.top();
        let a = m.input("a", 4);
        let b = m.input("b", 4);
        let _unused = a.wrapping_add(b);
        let difference = a.wrapping_sub(b);
        let sum = m.name("sum", difference.wrapping_add(b));
        let [a, b, difference, sum] = [a, b, difference, sum].map(|signal| signal.net());
        let design = elaborate(module.finish().unwrap()).unwrap();
        assert_eq!(design.order(), [difference, sum]);
        assert_eq!(design.levels(), 2);
        assert_eq!(design.inputs(), [a, b]);
    }

    #[test]
    fn a_combinational_loop_cannot_be_elaborated() {
        let text = "netlist m\n%0:1 = not %1\n%1:1 = not %0\n";
        let errors = elaborate(crate::text::parse(text).unwrap()).unwrap_err();
        assert_eq!(errors.0[0].code, Code::Order);
    }

    #[test]
    fn all_mistakes_are_reported_at_once() {
        let text = "netlist m\n%0:3 = input\n%1:4 = not %0\n%2:4 = register reset 0x0\nname %0 in 0 \"a b\" unsigned\n";
        let codes: Vec<Code> =
            elaborate(crate::text::parse(text).unwrap()).unwrap_err().0.iter().map(|d| d.code).collect();
        assert_eq!(codes, [Code::WidthMismatch, Code::UndrivenRegister, Code::BadName]);
    }
}
