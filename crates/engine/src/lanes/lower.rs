//! From a simplified netlist to operations on lanes. Each cell becomes one operation or less: where two cells read as
//! one (a sum under a condition, a comparison with a constant), `fuse` makes them one.

use rustc_hash::FxHashMap as HashMap;

use super::code::LaneOp;
use super::fuse;
use super::lane::pattern;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Netlist, Op};

/// A value while code is built.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct Value(pub(super) usize);

/// What makes a value.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Node {
    /// A constant, as a pattern.
    Constant(u64),
    /// An input.
    Input(Net),
    /// A register.
    Register(Net),
    /// An accumulator, by its index.
    Accumulator(usize),
    /// An operation.
    Operation(LaneOp<Value>),
}

/// Lowers nets of one netlist; equal operations become one.
pub(super) struct Lowering<'n> {
    netlist: &'n Netlist,
    pub(super) nodes: Vec<Node>,
    /// Of each node: it is of one bit, so that its word is all ones or all zeros.
    single: Vec<bool>,
    made: HashMap<Node, Value>,
    of_net: Vec<Option<Value>>,
}

/// The pattern of all ones in this width.
fn ones(width: Width) -> u64 {
    pattern(width, width.mask())
}

impl<'n> Lowering<'n> {
    pub(super) fn new(netlist: &'n Netlist) -> Lowering<'n> {
        let of_net = vec![None; netlist.cells.len()];
        Lowering { netlist, nodes: Vec::new(), single: Vec::new(), made: HashMap::default(), of_net }
    }

    /// The value of a net.
    pub(super) fn net(&mut self, root: Net) -> Value {
        let mut pending = vec![root];
        while let Some(&net) = pending.last() {
            let ready = pending.len();
            self.netlist.cell(net).op.visit_inputs(|input| {
                if self.of_net[input.index()].is_none() {
                    pending.push(input);
                }
            });
            if pending.len() == ready {
                pending.pop();
                if self.of_net[net.index()].is_none() {
                    self.of_net[net.index()] = Some(self.cell(net));
                }
            }
        }
        self.of(root)
    }

    /// The width of a net.
    pub(super) fn width(&self, net: Net) -> Width {
        self.netlist.width(net)
    }

    /// Not zero where one of the nets is not.
    pub(super) fn any_set(&mut self, nets: &[Net]) -> Value {
        let values: Vec<Value> = nets.iter().map(|&net| self.net(net)).collect();
        self.any(values)
    }

    /// The bits that one of the values has.
    pub(super) fn any(&mut self, values: impl IntoIterator<Item = Value>) -> Value {
        let mut any = self.leaf(Node::Constant(0));
        for value in values {
            any = self.make(LaneOp::Or(any, value));
        }
        any
    }

    /// A value that is read, not computed.
    pub(super) fn leaf(&mut self, node: Node) -> Value {
        if let Some(&value) = self.made.get(&node) {
            return value;
        }
        let value = self.unshared(node);
        self.made.insert(node, value);
        value
    }

    /// A value of its own, even if there is an equal one.
    pub(super) fn unshared(&mut self, node: Node) -> Value {
        self.single.push(match node {
            Node::Constant(pattern) => pattern == 0 || pattern == u64::MAX,
            Node::Input(net) | Node::Register(net) => self.netlist.width(net) == Width::ONE,
            Node::Accumulator(_) => false,
            Node::Operation(what) => what.gives_single(|value| self.is_single(value)),
        });
        self.nodes.push(node);
        Value(self.nodes.len() - 1)
    }

    /// The word of a value is all ones or all zeros.
    pub(super) fn is_single(&self, value: Value) -> bool {
        self.single[value.0]
    }

    /// The result of an operation, in its simplest form.
    pub(super) fn make(&mut self, what: LaneOp<Value>) -> Value {
        match fuse::rewrite(self, what) {
            Some(fuse::Rewrite::Same(value)) => value,
            Some(fuse::Rewrite::As(what)) => self.make(what),
            None => self.leaf(Node::Operation(what)),
        }
    }

    /// The operation that computes a value, if there is one.
    pub(super) fn what(&self, value: Value) -> Option<LaneOp<Value>> {
        match self.nodes[value.0] {
            Node::Operation(what) => Some(what),
            _ => None,
        }
    }

    /// The pattern of a constant.
    pub(super) fn constant(&self, value: Value) -> Option<u64> {
        match self.nodes[value.0] {
            Node::Constant(pattern) => Some(pattern),
            _ => None,
        }
    }

    fn of(&self, net: Net) -> Value {
        // `net` visits operands first.
        self.of_net[net.index()].unwrap_or(Value(0))
    }

    fn cell(&mut self, net: Net) -> Value {
        let cell = self.netlist.cell(net);
        let width = cell.width;
        let of = |net: Net| self.netlist.width(net);
        let single = |net: Net| of(net) == Width::ONE;
        let v = |net: Net| self.of(net);
        let what = match cell.op {
            Op::Input => return self.leaf(Node::Input(net)),
            Op::Register { .. } => return self.leaf(Node::Register(net)),
            Op::Const(value) => return self.leaf(Node::Constant(pattern(width, value))),
            Op::Read { memory, address } => LaneOp::Read(v(address), of(address).get(), memory as usize),
            Op::Not(a) => LaneOp::Invert(v(a), ones(width)),
            Op::And(a, b) => LaneOp::And(v(a), v(b)),
            Op::Or(a, b) => LaneOp::Or(v(a), v(b)),
            Op::Xor(a, b) => LaneOp::Xor(v(a), v(b)),
            Op::Mux { select, high, low } => LaneOp::Select(v(select), v(high), v(low)),
            // One bit fills its word, so that arithmetic on it is logic.
            Op::Add(a, b) | Op::Sub(a, b) if single(a) => LaneOp::Xor(v(a), v(b)),
            Op::Carry(a, b) | Op::AddOverflow(a, b) if single(a) => LaneOp::And(v(a), v(b)),
            Op::Borrow(a, b) | Op::SubOverflow(a, b) if single(a) => LaneOp::AndNot(v(b), v(a)),
            Op::LessSigned(a, b) if single(a) => LaneOp::AndNot(v(a), v(b)),
            // Counting by one leaves the range at its end only.
            Op::Carry(a, b) | Op::AddOverflow(a, b) | Op::Borrow(a, b) | Op::SubOverflow(a, b)
                if self.constant(v(b)) == Some(pattern(of(b), 1)) =>
            {
                let last = match cell.op {
                    Op::Carry(..) => of(a).mask(),
                    Op::Borrow(..) => 0,
                    Op::AddOverflow(..) => of(a).mask() >> 1,
                    _ => of(a).sign_bit(),
                };
                LaneOp::EqualTo(v(a), pattern(of(a), last))
            }
            Op::Add(a, b) => LaneOp::Add(v(a), v(b)),
            Op::Sub(a, b) => LaneOp::Sub(v(a), v(b)),
            Op::Mul(a, b) | Op::Div(a, b) if single(a) => LaneOp::And(v(a), v(b)),
            Op::Rem(a, _) if single(a) => return self.leaf(Node::Constant(0)),
            Op::ShiftLeft(a, by) | Op::ShiftRight(a, by) if single(a) => LaneOp::EqualIf(v(by), 0, v(a)),
            Op::ShiftArithmetic(a, _) if single(a) => return v(a),
            Op::Mul(a, b) => LaneOp::Mul(v(a), v(b), width.get()),
            Op::Div(a, b) => LaneOp::Div(v(a), v(b), width.get()),
            Op::Rem(a, b) => LaneOp::Rem(v(a), v(b)),
            Op::ShiftLeft(a, by) => LaneOp::ShiftLeft(v(a), v(by), of(by).get()),
            Op::ShiftRight(a, by) => LaneOp::ShiftRight(v(a), v(by), of(by).get(), ones(width)),
            Op::ShiftArithmetic(a, by) => LaneOp::ShiftArithmetic(v(a), v(by), of(by).get(), ones(width)),
            Op::Carry(a, b) => LaneOp::Carry(v(a), v(b)),
            Op::Borrow(a, b) => LaneOp::Less(v(a), v(b)),
            Op::AddOverflow(a, b) => LaneOp::AddOverflow(v(a), v(b)),
            Op::SubOverflow(a, b) => LaneOp::SubOverflow(v(a), v(b)),
            Op::Equal(a, b) => LaneOp::Equal(v(a), v(b)),
            Op::LessSigned(a, b) => LaneOp::LessSigned(v(a), v(b)),
            Op::Slice { of: a, .. } if single(a) => return v(a),
            Op::Slice { of: a, low } => {
                let left = of(a).get() - u32::from(low) - width.get();
                // Below the lowest bit of a net there is nothing to clear.
                let mask = if low == 0 { u64::MAX } else { ones(width) };
                if width == Width::ONE { LaneOp::Bit(v(a), left) } else { LaneOp::Left(v(a), left, mask) }
            }
            Op::Concat { high, low } => {
                let (high_width, low_width) = (of(high), of(low));
                let high_part = if single(high) { 1 << 63 } else { u64::MAX };
                let (right, low_part) =
                    if single(low) { (0, 1 << (63 - high_width.get())) } else { (high_width.get(), u64::MAX) };
                assert_eq!(high_width.get() + low_width.get(), width.get());
                LaneOp::Concat(v(high), v(low), right, high_part, low_part)
            }
            Op::ZeroExtend(a) | Op::SignExtend(a) if of(a) == width => return v(a),
            Op::ZeroExtend(a) if single(a) => LaneOp::Mask(v(a), pattern(width, 1)),
            Op::SignExtend(a) if single(a) => LaneOp::Mask(v(a), ones(width)),
            Op::ZeroExtend(a) => LaneOp::Right(v(a), width.get() - of(a).get()),
            Op::SignExtend(a) => LaneOp::RightSigned(v(a), width.get() - of(a).get()),
        };
        self.make(what)
    }
}
