//! The flat code of a machine: operations on rows, in an order in which operands come first, and the rows they use.

use stepwave_netlist::bits::Width;

/// What an operation does with the words of each lane. `V` is a value while code is built, then the row that holds it.
///
/// Patterns are 64-bit, of which a lane takes the top bits; a 1-bit value fills its word (see [`super::lane`]).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum LaneOp<V> {
    /// a
    Copy(V),
    /// a ^ pattern
    Invert(V, u64),
    /// a & pattern
    Mask(V, u64),
    /// a & b
    And(V, V),
    /// a & !b
    AndNot(V, V),
    /// a | b
    Or(V, V),
    /// a ^ b
    Xor(V, V),
    /// Select, high, low: `high` where the first is ones.
    Select(V, V, V),
    /// a + b
    Add(V, V),
    /// a - b
    Sub(V, V),
    /// a + (pattern where the second is ones)
    AddWhere(V, V, u64),
    /// a + (pattern where the second is ones) + (pattern where the third is)
    AddEither(V, V, u64, V, u64),
    /// a + (b where the third is ones)
    AddIf(V, V, V),
    /// a - (b where the third is ones)
    SubIf(V, V, V),
    /// a * b, of this many bits.
    Mul(V, V, u32),
    /// a / b of this many bits, unsigned; 0 where b is 0.
    Div(V, V, u32),
    /// a mod b, unsigned; 0 where b is 0.
    Rem(V, V),
    /// a << b; b is of this many bits.
    ShiftLeft(V, V, u32),
    /// (a >> b) & pattern; b is of this many bits.
    ShiftRight(V, V, u32, u64),
    /// (a >> b) & pattern, the top bit repeated; b is of this many bits.
    ShiftArithmetic(V, V, u32, u64),
    /// Carry of a + b.
    Carry(V, V),
    /// a < b, unsigned.
    Less(V, V),
    /// a < b, in two's complement.
    LessSigned(V, V),
    /// a < (b where the third is ones), unsigned.
    LessIf(V, V, V),
    /// a = b
    Equal(V, V),
    /// a = pattern
    EqualTo(V, u64),
    /// a = pattern where the second is ones, else zeros.
    EqualIf(V, u64, V),
    /// a = pattern where the second is ones, or the third.
    EqualIfOr(V, u64, V, V),
    /// Ones where a is a pattern and the value next to the pattern is ones, for one of two; or where the last is ones.
    EqualEitherOr(V, [(u64, V); 2], V),
    /// a + b leaves the range in two's complement.
    AddOverflow(V, V),
    /// a - b leaves the range in two's complement.
    SubOverflow(V, V),
    /// (a << by) & pattern
    Left(V, u32, u64),
    /// a >> by
    Right(V, u32),
    /// a >> by, the top bit repeated
    RightSigned(V, u32),
    /// The bit that `a << by` has at the top, in all bits.
    Bit(V, u32),
    /// (high & pattern) | (low >> by & pattern)
    Concat(V, V, u32, u64, u64),
    /// The top `by` + 1 bits of a are equal: what is left of it after a shift by `by` is still the same number.
    Fits(V, u32),
    /// a does not fit, where the second is ones; or the third is.
    UnfitIfOr(V, u32, V, V),
    /// The word at address a, of this many bits, of the memory with this index.
    Read(V, u32, usize),
    /// Accumulator: clocks where the second is not zero.
    Count(V, V),
    /// Accumulator: clocks since the second or the third was not zero.
    Idle(V, V, V),
    /// Accumulator: least value, unsigned.
    Least(V, V),
    /// Accumulator: greatest value, unsigned.
    Greatest(V, V),
    /// Accumulator: least value in two's complement.
    LeastSigned(V, V),
    /// Accumulator: greatest value in two's complement.
    GreatestSigned(V, V),
    /// Accumulator: sum of numbers of this many bits.
    Sum(V, V, u32),
    /// Accumulator: sum of the gaps of roots; base and offset with their numbers of bits.
    RootGaps(V, [(V, u32); 2]),
    /// Accumulator: least of the second where the third is not zero.
    LeastWhere(V, V, V),
    /// Accumulator: greatest of the second, in two's complement, where the third is not zero.
    GreatestWhere(V, V, V),
    /// Accumulator: clocks since the second was not zero.
    Since(V, V),
}

impl<V: Copy> LaneOp<V> {
    /// The same operation on other values: the only list of operands.
    pub(super) fn map<W>(self, mut go: impl FnMut(V) -> W) -> LaneOp<W> {
        match self {
            LaneOp::Copy(a) => LaneOp::Copy(go(a)),
            LaneOp::Invert(a, p) => LaneOp::Invert(go(a), p),
            LaneOp::Mask(a, p) => LaneOp::Mask(go(a), p),
            LaneOp::And(a, b) => LaneOp::And(go(a), go(b)),
            LaneOp::AndNot(a, b) => LaneOp::AndNot(go(a), go(b)),
            LaneOp::Or(a, b) => LaneOp::Or(go(a), go(b)),
            LaneOp::Xor(a, b) => LaneOp::Xor(go(a), go(b)),
            LaneOp::Select(a, b, c) => LaneOp::Select(go(a), go(b), go(c)),
            LaneOp::Add(a, b) => LaneOp::Add(go(a), go(b)),
            LaneOp::Sub(a, b) => LaneOp::Sub(go(a), go(b)),
            LaneOp::AddWhere(a, b, p) => LaneOp::AddWhere(go(a), go(b), p),
            LaneOp::AddEither(a, b, p, c, q) => LaneOp::AddEither(go(a), go(b), p, go(c), q),
            LaneOp::AddIf(a, b, c) => LaneOp::AddIf(go(a), go(b), go(c)),
            LaneOp::SubIf(a, b, c) => LaneOp::SubIf(go(a), go(b), go(c)),
            LaneOp::Mul(a, b, bits) => LaneOp::Mul(go(a), go(b), bits),
            LaneOp::Div(a, b, bits) => LaneOp::Div(go(a), go(b), bits),
            LaneOp::Rem(a, b) => LaneOp::Rem(go(a), go(b)),
            LaneOp::ShiftLeft(a, b, bits) => LaneOp::ShiftLeft(go(a), go(b), bits),
            LaneOp::ShiftRight(a, b, bits, p) => LaneOp::ShiftRight(go(a), go(b), bits, p),
            LaneOp::ShiftArithmetic(a, b, bits, p) => LaneOp::ShiftArithmetic(go(a), go(b), bits, p),
            LaneOp::Carry(a, b) => LaneOp::Carry(go(a), go(b)),
            LaneOp::Less(a, b) => LaneOp::Less(go(a), go(b)),
            LaneOp::LessSigned(a, b) => LaneOp::LessSigned(go(a), go(b)),
            LaneOp::LessIf(a, b, c) => LaneOp::LessIf(go(a), go(b), go(c)),
            LaneOp::Equal(a, b) => LaneOp::Equal(go(a), go(b)),
            LaneOp::EqualTo(a, p) => LaneOp::EqualTo(go(a), p),
            LaneOp::EqualIf(a, p, b) => LaneOp::EqualIf(go(a), p, go(b)),
            LaneOp::EqualIfOr(a, p, b, c) => LaneOp::EqualIfOr(go(a), p, go(b), go(c)),
            LaneOp::EqualEitherOr(a, [(p, b), (q, c)], d) => {
                LaneOp::EqualEitherOr(go(a), [(p, go(b)), (q, go(c))], go(d))
            }
            LaneOp::AddOverflow(a, b) => LaneOp::AddOverflow(go(a), go(b)),
            LaneOp::SubOverflow(a, b) => LaneOp::SubOverflow(go(a), go(b)),
            LaneOp::Left(a, by, p) => LaneOp::Left(go(a), by, p),
            LaneOp::Right(a, by) => LaneOp::Right(go(a), by),
            LaneOp::RightSigned(a, by) => LaneOp::RightSigned(go(a), by),
            LaneOp::Bit(a, by) => LaneOp::Bit(go(a), by),
            LaneOp::Concat(a, b, by, p, q) => LaneOp::Concat(go(a), go(b), by, p, q),
            LaneOp::Fits(a, by) => LaneOp::Fits(go(a), by),
            LaneOp::UnfitIfOr(a, by, b, c) => LaneOp::UnfitIfOr(go(a), by, go(b), go(c)),
            LaneOp::Read(a, bits, memory) => LaneOp::Read(go(a), bits, memory),
            LaneOp::Count(a, b) => LaneOp::Count(go(a), go(b)),
            LaneOp::Idle(a, b, c) => LaneOp::Idle(go(a), go(b), go(c)),
            LaneOp::Least(a, b) => LaneOp::Least(go(a), go(b)),
            LaneOp::Greatest(a, b) => LaneOp::Greatest(go(a), go(b)),
            LaneOp::LeastSigned(a, b) => LaneOp::LeastSigned(go(a), go(b)),
            LaneOp::GreatestSigned(a, b) => LaneOp::GreatestSigned(go(a), go(b)),
            LaneOp::Sum(a, b, bits) => LaneOp::Sum(go(a), go(b), bits),
            LaneOp::RootGaps(a, [(b, p), (c, q)]) => LaneOp::RootGaps(go(a), [(go(b), p), (go(c), q)]),
            LaneOp::LeastWhere(a, b, c) => LaneOp::LeastWhere(go(a), go(b), go(c)),
            LaneOp::GreatestWhere(a, b, c) => LaneOp::GreatestWhere(go(a), go(b), go(c)),
            LaneOp::Since(a, b) => LaneOp::Since(go(a), go(b)),
        }
    }
}

impl<V> LaneOp<V> {
    /// The result is all ones or all zeros, given which operands are.
    pub(super) fn gives_single(self, of: impl Fn(V) -> bool) -> bool {
        match self {
            LaneOp::Carry(..) | LaneOp::Less(..) | LaneOp::LessSigned(..) | LaneOp::LessIf(..) => true,
            LaneOp::Equal(..) | LaneOp::EqualTo(..) | LaneOp::Fits(..) | LaneOp::Bit(..) => true,
            LaneOp::AddOverflow(..) | LaneOp::SubOverflow(..) => true,
            LaneOp::Copy(a) | LaneOp::Invert(a, u64::MAX) | LaneOp::EqualIf(_, _, a) => of(a),
            LaneOp::And(a, b)
            | LaneOp::AndNot(a, b)
            | LaneOp::Or(a, b)
            | LaneOp::Xor(a, b)
            | LaneOp::Select(_, a, b) => of(a) && of(b),
            LaneOp::EqualIfOr(_, _, a, b) | LaneOp::UnfitIfOr(_, _, a, b) => of(a) && of(b),
            LaneOp::EqualEitherOr(_, [(_, a), (_, b)], c) => of(a) && of(b) && of(c),
            _ => false,
        }
    }
}

/// A row of words in the machine.
pub(super) type Slot = usize;

/// An operation and the row that takes its result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operation {
    pub(super) target: Slot,
    pub(super) what: LaneOp<Slot>,
}

/// A register of the machine, and the row that holds its next value after the operations; none if it keeps its value.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegisterRow {
    pub(super) width: Width,
    pub(super) reset: u64,
    pub(super) row: Slot,
    pub(super) next: Option<Slot>,
}

/// A port that writes a memory, and the rows that hold its nets after the operations, and still after an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct PortRows {
    pub(super) memory: usize,
    pub(super) enable: Slot,
    pub(super) address: Slot,
    /// Bits of the address.
    pub(super) bits: u32,
    pub(super) data: Slot,
    pub(super) mask: Option<Slot>,
}

/// Code for one netlist. Rows of registers, inputs and accumulators keep their meaning from clock to clock.
#[derive(Clone, Debug, Default)]
pub(super) struct Code {
    /// Rows needed.
    pub(super) rows: usize,
    /// Rows with a constant, and its pattern.
    pub(super) constants: Vec<(Slot, u64)>,
    /// Inputs that the code reads, by their place among all inputs.
    pub(super) inputs: Vec<(usize, Slot)>,
    /// Registers, in the order that the builder was given.
    pub(super) registers: Vec<RegisterRow>,
    /// Ports of memories, in the order in which they write.
    pub(super) writes: Vec<PortRows>,
    /// Accumulators, in the order that the builder was given.
    pub(super) accumulators: Vec<Slot>,
    /// All operations; those from `observers` on update the accumulators.
    pub(super) operations: Vec<Operation>,
    /// Index of the first accumulator's operation.
    pub(super) observers: usize,
    /// Rows of the outputs, in the order that the builder was given.
    pub(super) outputs: Vec<Slot>,
}
