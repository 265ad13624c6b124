//! The netlist: cells in one arena, and side tables for names, scopes, properties and source lines.
//!
//! A [`Net`] is the index of the cell that drives it. Only registers may refer to a net created later, so creation
//! order is evaluation order and a combinational loop cannot be written. `Op::visit_inputs` is the only place that
//! lists the operands of each operator.

mod check;
mod memory;
mod name;
mod source;
mod undefined;

use crate::bits::Width;
use crate::formula::Clause;
use crate::message::Message;
pub use crate::operator::Operator;

pub use memory::{HasMemories, Memory, WritePort};
pub use name::{Format, NamedNet, Word};
pub use source::Source;
pub use undefined::Undefined;

/// A net, named by the cell that drives it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Net(
    /// Index of the cell in the arena.
    pub u32,
);

impl Net {
    /// Index of the driving cell in the arena.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a cell does. Unless said otherwise operands and result are equally wide.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Op {
    /// Set by the test bench.
    Input,
    /// A constant.
    Const(u64),
    /// A clocked register: takes `next` at every edge; `reset` before the first.
    Register {
        /// Net of the next value; `None` only while the netlist is being built.
        next: Option<Net>,
        /// Value before the first edge.
        reset: u64,
    },
    /// Bitwise complement.
    Not(Net),
    /// Bitwise and.
    And(Net, Net),
    /// Bitwise or.
    Or(Net, Net),
    /// Bitwise exclusive or.
    Xor(Net, Net),
    /// `select` (1 bit) = 1 gives `high`, 0 gives `low`.
    Mux {
        /// One bit.
        select: Net,
        /// Result where `select` is 1.
        high: Net,
        /// Result where `select` is 0.
        low: Net,
    },
    /// Sum modulo 2^width.
    Add(Net, Net),
    /// Difference modulo 2^width.
    Sub(Net, Net),
    /// Product modulo 2^width.
    Mul(Net, Net),
    /// Quotient of unsigned numbers; 0 where the divisor is 0.
    Div(Net, Net),
    /// Remainder of unsigned numbers; 0 where the divisor is 0.
    Rem(Net, Net),
    /// The first shifted left by the second, an unsigned number of any width; zeros enter.
    ShiftLeft(Net, Net),
    /// The first shifted right by the second, an unsigned number of any width; zeros enter.
    ShiftRight(Net, Net),
    /// The first shifted right by the second, an unsigned number of any width; the sign bit enters.
    ShiftArithmetic(Net, Net),
    /// Carry out of the sum of two equally wide operands; 1 bit.
    Carry(Net, Net),
    /// Borrow of the difference (first < second, unsigned); 1 bit.
    Borrow(Net, Net),
    /// The sum leaves the two's-complement range of the operands; 1 bit.
    AddOverflow(Net, Net),
    /// The difference leaves the two's-complement range of the operands; 1 bit.
    SubOverflow(Net, Net),
    /// Equal; 1 bit.
    Equal(Net, Net),
    /// First < second in two's complement; 1 bit.
    LessSigned(Net, Net),
    /// Bits `low .. low + width` of a net.
    Slice {
        /// The net that is cut.
        of: Net,
        /// Its lowest bit in the result.
        low: u8,
    },
    /// `high` above `low`; the widths add up.
    Concat {
        /// Most significant part.
        high: Net,
        /// Least significant part.
        low: Net,
    },
    /// Zeros above a net that is at most as wide.
    ZeroExtend(Net),
    /// The sign bit repeated above a net that is at most as wide.
    SignExtend(Net),
    /// The word of a memory at an address; 0 outside of it.
    Read {
        /// Index into [`Netlist::memories`].
        memory: u32,
        /// Unsigned, of any width.
        address: Net,
    },
}

impl Op {
    /// The same operator on other nets: `go` is called with every combinational operand, in order. The next value of a
    /// register is not one. This is the only list of operands.
    #[must_use]
    pub fn map_inputs(self, mut go: impl FnMut(Net) -> Net) -> Op {
        match self {
            Op::Input | Op::Const(_) | Op::Register { .. } => self,
            Op::Not(a) => Op::Not(go(a)),
            Op::And(a, b) => Op::And(go(a), go(b)),
            Op::Or(a, b) => Op::Or(go(a), go(b)),
            Op::Xor(a, b) => Op::Xor(go(a), go(b)),
            Op::Mux { select, high, low } => Op::Mux { select: go(select), high: go(high), low: go(low) },
            Op::Add(a, b) => Op::Add(go(a), go(b)),
            Op::Sub(a, b) => Op::Sub(go(a), go(b)),
            Op::Mul(a, b) => Op::Mul(go(a), go(b)),
            Op::Div(a, b) => Op::Div(go(a), go(b)),
            Op::Rem(a, b) => Op::Rem(go(a), go(b)),
            Op::ShiftLeft(a, by) => Op::ShiftLeft(go(a), go(by)),
            Op::ShiftRight(a, by) => Op::ShiftRight(go(a), go(by)),
            Op::ShiftArithmetic(a, by) => Op::ShiftArithmetic(go(a), go(by)),
            Op::Carry(a, b) => Op::Carry(go(a), go(b)),
            Op::Borrow(a, b) => Op::Borrow(go(a), go(b)),
            Op::AddOverflow(a, b) => Op::AddOverflow(go(a), go(b)),
            Op::SubOverflow(a, b) => Op::SubOverflow(go(a), go(b)),
            Op::Equal(a, b) => Op::Equal(go(a), go(b)),
            Op::LessSigned(a, b) => Op::LessSigned(go(a), go(b)),
            Op::Slice { of, low } => Op::Slice { of: go(of), low },
            Op::Concat { high, low } => Op::Concat { high: go(high), low: go(low) },
            Op::ZeroExtend(a) => Op::ZeroExtend(go(a)),
            Op::SignExtend(a) => Op::SignExtend(go(a)),
            Op::Read { memory, address } => Op::Read { memory, address: go(address) },
        }
    }

    /// Calls `visit` with every combinational operand, in order.
    pub fn visit_inputs(&self, mut visit: impl FnMut(Net)) {
        let _ = self.map_inputs(|net| {
            visit(net);
            net
        });
    }
}

/// One cell: an operator and the width of its result.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Cell {
    /// What it does.
    pub op: Op,
    /// Width of the net that it drives.
    pub width: Width,
}

/// Index of a scope; 0 is the top.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ScopeId(
    /// Index into [`Netlist::scopes`].
    pub u32,
);

impl ScopeId {
    /// The top scope, which has the netlist's own name.
    pub const TOP: ScopeId = ScopeId(0);

    /// Index into [`Netlist::scopes`].
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A level of the hierarchy: an instance of a part.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ScopeData {
    /// The scope around this one; `None` for the top.
    pub parent: Option<ScopeId>,
    /// Its own name.
    pub name: String,
}

/// What a strict cell does when its exact result does not fit.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum OnOverflow {
    /// The run stops at that clock.
    #[default]
    Trap,
    /// The result is the nearest value that fits.
    Saturate,
    /// The result is taken modulo 2^width.
    Wrap,
}

/// Addition or subtraction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Arithmetic {
    /// left + right
    Add,
    /// left - right
    Sub,
}

/// An operand of a strict cell, with the reading that makes it a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Operand {
    /// The net.
    pub net: Net,
    /// Two's complement.
    pub signed: bool,
}

/// Where a property comes from.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Claim {
    /// A strict cell: the exact result fits in the register that `left` stands for.
    NoOverflow {
        /// Operator.
        operation: Arithmetic,
        /// The register; its width and sign are those of the result.
        left: Operand,
        /// What is added or subtracted.
        right: Operand,
    },
    /// An operator of imported hardware: what is kept of its exact result shows all of it, whenever the result is taken.
    Fits {
        /// Operator.
        operator: Operator,
        /// First operand.
        left: Word,
        /// Second operand; constant 0 of a negation.
        right: Word,
        /// Bits that are kept.
        bits: u32,
        /// They are read as two's complement.
        signed: bool,
        /// The author announces that what does not fit is meant to be lost.
        wraps: bool,
    },
    /// Imported hardware never takes the result of an operation that has none by the rules of its language.
    Defined {
        /// The operation.
        undefined: Undefined,
        /// The dividend, or the address.
        operand: Word,
    },
    /// An invariant that the model's author claims.
    Invariant,
    /// What the author assumes of the inputs: nothing is claimed of a run from the sample on in which it is 1.
    Assumption,
    /// What the author wants to see in some run: 1 in a sample that shows it, and no violation.
    Cover,
    /// A text of the author's: printed at the edge after a sample in which the net is 1, and no violation.
    Print {
        /// The text.
        message: Message,
        /// The numbers in it.
        numbers: Vec<Word>,
        /// It is printed once, before the first edge, if the net is 1 in sample 0.
        once: bool,
    },
}

impl Claim {
    /// The net must never be 1, so that a run in which it is 1 shows a mistake: neither an assumption, nor a cover, nor a
    /// text, nor what is announced to be lost.
    #[must_use]
    pub fn is_goal(&self) -> bool {
        !self.is_announced() && !matches!(self, Claim::Assumption | Claim::Cover | Claim::Print { .. })
    }

    /// What an operator of imported hardware loses is announced: it is shown, and not reported.
    #[must_use]
    pub fn is_announced(&self) -> bool {
        matches!(self, Claim::Fits { wraps: true, .. })
    }

    /// The same claim about other nets. This is the only list of its nets.
    #[must_use]
    pub fn map(self, mut go: impl FnMut(Net) -> Net) -> Claim {
        match self {
            Claim::NoOverflow { operation, mut left, mut right } => {
                (left.net, right.net) = (go(left.net), go(right.net));
                Claim::NoOverflow { operation, left, right }
            }
            Claim::Fits { operator, left, right, bits, signed, wraps } => {
                let (left, right) = (left.map(&mut go), right.map(go));
                Claim::Fits { operator, left, right, bits, signed, wraps }
            }
            Claim::Defined { undefined, operand } => Claim::Defined { undefined, operand: operand.map(go) },
            Claim::Print { message, numbers, once } => {
                Claim::Print { message, numbers: numbers.into_iter().map(|word| word.map(&mut go)).collect(), once }
            }
            same @ (Claim::Invariant | Claim::Assumption | Claim::Cover) => same,
        }
    }

    /// All nets that it is about.
    #[must_use]
    pub fn nets(&self) -> Vec<Net> {
        let mut nets = Vec::new();
        let _ = self.clone().map(|net| {
            nets.push(net);
            net
        });
        nets
    }
}

/// A net that must never be 1, if its claim is a [goal](Claim::is_goal). The simulator watches it, a prover proves it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Property {
    /// Path of the component that it is about.
    pub name: String,
    /// One bit; 1 is a violation.
    pub never: Net,
    /// What is claimed.
    pub claim: Claim,
}

/// A netlist, complete or while it is being built.
#[derive(Clone, Debug, Default)]
pub struct Netlist {
    /// All cells in creation order.
    pub cells: Vec<Cell>,
    /// The hierarchy; index 0 is the top.
    pub scopes: Vec<ScopeData>,
    /// All memories, in creation order.
    pub memories: Vec<Memory>,
    /// Names of nets, in the order in which a wave shows them.
    pub names: Vec<NamedNet>,
    /// What must never happen.
    pub properties: Vec<Property>,
    /// What holds of registers between two steps of a block, in formulas of their leaf names: for tests and proofs. No
    /// hardware comes of it.
    pub invariants: Vec<Clause>,
    /// Source line of each cell, where it is known; same index as `cells`.
    pub sources: Vec<Option<Source>>,
}

/// Equal in all but source lines, of which the text form carries those of files alone.
impl PartialEq for Netlist {
    fn eq(&self, other: &Netlist) -> bool {
        self.cells == other.cells
            && self.scopes == other.scopes
            && self.memories == other.memories
            && self.names == other.names
            && self.properties == other.properties
            && self.invariants == other.invariants
    }
}

impl Netlist {
    /// An empty netlist with its top scope.
    #[must_use]
    pub fn new(name: &str) -> Netlist {
        Netlist { scopes: vec![ScopeData { parent: None, name: name.to_owned() }], ..Netlist::default() }
    }

    /// The cell that drives a net.
    #[must_use]
    pub fn cell(&self, net: Net) -> Cell {
        self.cells[net.index()]
    }

    /// Width of a net.
    #[must_use]
    pub fn width(&self, net: Net) -> Width {
        self.cell(net).width
    }

    /// All nets in creation order.
    pub fn nets(&self) -> impl Iterator<Item = Net> + use<> {
        (0..u32::try_from(self.cells.len()).unwrap_or(u32::MAX)).map(Net)
    }

    /// The same netlist with a further scope `trap` that shows the operands of a strict cell, `left` and `right`, and
    /// the exact result, `exact`, at every clock; `None` where the property is of no strict cell, or the result of
    /// operands of 63 bits and more would need more than 64. The nets that were there keep their numbers.
    #[must_use]
    pub fn showing_operands(&self, property: &Property) -> Option<Netlist> {
        let Claim::NoOverflow { operation, left, right } = property.claim else { return None };
        // A bit for the carry, and one for the sign of a difference.
        let bits = self.width(left.net).max(self.width(right.net)).get() + 2;
        let width = Width::new(u64::from(bits)).ok()?;
        let mut netlist = self.clone();
        let mut add = |op: Op, width: Width| {
            netlist.cells.push(Cell { op, width });
            netlist.sources.push(None);
            u32::try_from(netlist.cells.len() - 1).ok().map(Net)
        };
        let mut wide = |operand: Operand| {
            add(if operand.signed { Op::SignExtend(operand.net) } else { Op::ZeroExtend(operand.net) }, width)
        };
        let (a, b) = (wide(left)?, wide(right)?);
        let exact = match operation {
            Arithmetic::Add => Op::Add(a, b),
            Arithmetic::Sub => Op::Sub(a, b),
        };
        let exact = add(exact, width)?;
        // Nets of their own: a register keeps the one name that reports know it by.
        let mut copy = |of: Net| add(Op::ZeroExtend(of), self.width(of));
        let (left_shown, right_shown) = (copy(left.net)?, copy(right.net)?);
        let scope = ScopeId(u32::try_from(netlist.scopes.len()).ok()?);
        netlist.scopes.push(ScopeData { parent: Some(ScopeId::TOP), name: "trap".to_owned() });
        let shown = |signed: bool| if signed { Format::Signed } else { Format::Unsigned };
        let names = [("left", left_shown, left.signed), ("right", right_shown, right.signed), ("exact", exact, true)];
        netlist.names.extend(names.map(|(name, net, signed)| NamedNet::new(net, scope, name, shown(signed))));
        Some(netlist)
    }

    /// Dotted path of a scope, beginning with the netlist's name.
    #[must_use]
    pub fn scope_path(&self, scope: ScopeId) -> String {
        let data = &self.scopes[scope.index()];
        match data.parent {
            Some(parent) => format!("{}.{}", self.scope_path(parent), data.name),
            None => data.name.clone(),
        }
    }

    /// Dotted path of a name.
    #[must_use]
    pub fn path(&self, named: &NamedNet) -> String {
        format!("{}.{}", self.scope_path(named.scope), named.name)
    }

    /// Dotted path of a memory.
    #[must_use]
    pub fn memory_path(&self, memory: &Memory) -> String {
        format!("{}.{}", self.scope_path(memory.scope), memory.name)
    }

    /// The first name given to a net, of those that are given to no other.
    #[must_use]
    pub fn name_of(&self, net: Net) -> Option<&NamedNet> {
        self.names.iter().find(|named| named.net == net && !named.is_wide())
    }

    /// The name itself, given as leaf name or as dotted path.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&NamedNet> {
        self.names.iter().find(|named| named.name == name || self.path(named) == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_stays_small() {
        assert_eq!(size_of::<Net>(), 4);
        assert!(size_of::<Cell>() <= 32, "{}", size_of::<Cell>());
    }
}
