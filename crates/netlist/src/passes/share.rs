//! The builder of a simplified netlist: equal cells become one.

use rustc_hash::FxHashMap as HashMap;

use super::constant;
use super::identity::{self, Rewrite};
use crate::bits::Width;
use crate::cells::{Cell, Net, Op};

/// Builds cells, each in its simplest form, none twice.
#[derive(Default)]
pub(super) struct Builder {
    cells: Vec<Cell>,
    made: HashMap<Cell, Net>,
}

impl Builder {
    /// The operator that drives a net.
    pub(super) fn op(&self, net: Net) -> Op {
        self.cells[net.index()].op
    }

    /// Width of a net.
    pub(super) fn width(&self, net: Net) -> Width {
        self.cells[net.index()].width
    }

    /// Value of a net that is a constant.
    pub(super) fn known(&self, net: Net) -> Option<u64> {
        match self.op(net) {
            Op::Const(value) => Some(value),
            _ => None,
        }
    }

    /// A cell that is itself: an input or a register.
    pub(super) fn leaf(&mut self, cell: Cell) -> Net {
        // The original had at most 2^32 cells.
        let net = Net(u32::try_from(self.cells.len()).unwrap_or(u32::MAX));
        self.cells.push(cell);
        net
    }

    /// A constant.
    pub(super) fn constant(&mut self, value: u64, width: Width) -> Net {
        self.shared(Cell { op: Op::Const(value), width })
    }

    /// A combinational cell on nets of this builder.
    pub(super) fn make(&mut self, op: Op, width: Width) -> Net {
        let known = |net: Net| self.known(net).map(|value| (value, self.width(net)));
        if let Some(value) = constant::value(op, width, known) {
            return self.constant(value, width);
        }
        match identity::rewrite(self, op, width) {
            Some(Rewrite::Same(net)) => net,
            Some(Rewrite::Constant(value)) => self.constant(value, width),
            Some(Rewrite::As(op)) => self.make(op, width),
            None => self.shared(Cell { op: ordered(op), width }),
        }
    }

    fn shared(&mut self, cell: Cell) -> Net {
        if let Some(&net) = self.made.get(&cell) {
            return net;
        }
        let net = self.leaf(cell);
        self.made.insert(cell, net);
        net
    }

    /// The cells built.
    pub(super) fn into_cells(self) -> Vec<Cell> {
        self.cells
    }
}

/// Operands of a commutative operator in the order of their nets.
fn ordered(op: Op) -> Op {
    match op {
        Op::And(a, b) if b < a => Op::And(b, a),
        Op::Or(a, b) if b < a => Op::Or(b, a),
        Op::Xor(a, b) if b < a => Op::Xor(b, a),
        Op::Add(a, b) if b < a => Op::Add(b, a),
        Op::Mul(a, b) if b < a => Op::Mul(b, a),
        Op::Carry(a, b) if b < a => Op::Carry(b, a),
        Op::AddOverflow(a, b) if b < a => Op::AddOverflow(b, a),
        Op::Equal(a, b) if b < a => Op::Equal(b, a),
        op => op,
    }
}
