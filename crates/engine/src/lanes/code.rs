//! The flat code of a machine: operations on rows, in an order in which operands come first, and the rows they use.

use stepwave_netlist::bits::Width;

/// What an operation does with the words of each lane. `V` is a value while code is built, then the row that holds it.
///
/// Patterns are 64-bit, of which a lane takes the top bits; a 1-bit value fills its word (see [`super::lane`]).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Do<V> {
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

impl<V: Copy> Do<V> {
    /// The same operation on other values: the only list of operands.
    pub(super) fn map<W>(self, mut go: impl FnMut(V) -> W) -> Do<W> {
        match self {
            Do::Copy(a) => Do::Copy(go(a)),
            Do::Invert(a, p) => Do::Invert(go(a), p),
            Do::Mask(a, p) => Do::Mask(go(a), p),
            Do::And(a, b) => Do::And(go(a), go(b)),
            Do::AndNot(a, b) => Do::AndNot(go(a), go(b)),
            Do::Or(a, b) => Do::Or(go(a), go(b)),
            Do::Xor(a, b) => Do::Xor(go(a), go(b)),
            Do::Select(a, b, c) => Do::Select(go(a), go(b), go(c)),
            Do::Add(a, b) => Do::Add(go(a), go(b)),
            Do::Sub(a, b) => Do::Sub(go(a), go(b)),
            Do::AddWhere(a, b, p) => Do::AddWhere(go(a), go(b), p),
            Do::AddEither(a, b, p, c, q) => Do::AddEither(go(a), go(b), p, go(c), q),
            Do::AddIf(a, b, c) => Do::AddIf(go(a), go(b), go(c)),
            Do::SubIf(a, b, c) => Do::SubIf(go(a), go(b), go(c)),
            Do::Mul(a, b, bits) => Do::Mul(go(a), go(b), bits),
            Do::Div(a, b, bits) => Do::Div(go(a), go(b), bits),
            Do::Rem(a, b) => Do::Rem(go(a), go(b)),
            Do::ShiftLeft(a, b, bits) => Do::ShiftLeft(go(a), go(b), bits),
            Do::ShiftRight(a, b, bits, p) => Do::ShiftRight(go(a), go(b), bits, p),
            Do::ShiftArithmetic(a, b, bits, p) => Do::ShiftArithmetic(go(a), go(b), bits, p),
            Do::Carry(a, b) => Do::Carry(go(a), go(b)),
            Do::Less(a, b) => Do::Less(go(a), go(b)),
            Do::LessSigned(a, b) => Do::LessSigned(go(a), go(b)),
            Do::LessIf(a, b, c) => Do::LessIf(go(a), go(b), go(c)),
            Do::Equal(a, b) => Do::Equal(go(a), go(b)),
            Do::EqualTo(a, p) => Do::EqualTo(go(a), p),
            Do::EqualIf(a, p, b) => Do::EqualIf(go(a), p, go(b)),
            Do::EqualIfOr(a, p, b, c) => Do::EqualIfOr(go(a), p, go(b), go(c)),
            Do::EqualEitherOr(a, [(p, b), (q, c)], d) => Do::EqualEitherOr(go(a), [(p, go(b)), (q, go(c))], go(d)),
            Do::AddOverflow(a, b) => Do::AddOverflow(go(a), go(b)),
            Do::SubOverflow(a, b) => Do::SubOverflow(go(a), go(b)),
            Do::Left(a, by, p) => Do::Left(go(a), by, p),
            Do::Right(a, by) => Do::Right(go(a), by),
            Do::RightSigned(a, by) => Do::RightSigned(go(a), by),
            Do::Bit(a, by) => Do::Bit(go(a), by),
            Do::Concat(a, b, by, p, q) => Do::Concat(go(a), go(b), by, p, q),
            Do::Fits(a, by) => Do::Fits(go(a), by),
            Do::UnfitIfOr(a, by, b, c) => Do::UnfitIfOr(go(a), by, go(b), go(c)),
            Do::Count(a, b) => Do::Count(go(a), go(b)),
            Do::Idle(a, b, c) => Do::Idle(go(a), go(b), go(c)),
            Do::Least(a, b) => Do::Least(go(a), go(b)),
            Do::Greatest(a, b) => Do::Greatest(go(a), go(b)),
            Do::LeastSigned(a, b) => Do::LeastSigned(go(a), go(b)),
            Do::GreatestSigned(a, b) => Do::GreatestSigned(go(a), go(b)),
            Do::Sum(a, b, bits) => Do::Sum(go(a), go(b), bits),
            Do::RootGaps(a, [(b, p), (c, q)]) => Do::RootGaps(go(a), [(go(b), p), (go(c), q)]),
            Do::LeastWhere(a, b, c) => Do::LeastWhere(go(a), go(b), go(c)),
            Do::GreatestWhere(a, b, c) => Do::GreatestWhere(go(a), go(b), go(c)),
            Do::Since(a, b) => Do::Since(go(a), go(b)),
        }
    }
}

impl<V> Do<V> {
    /// The result is all ones or all zeros, given which operands are.
    pub(super) fn gives_single(self, of: impl Fn(V) -> bool) -> bool {
        match self {
            Do::Carry(..) | Do::Less(..) | Do::LessSigned(..) | Do::LessIf(..) => true,
            Do::Equal(..) | Do::EqualTo(..) | Do::Fits(..) | Do::Bit(..) => true,
            Do::AddOverflow(..) | Do::SubOverflow(..) => true,
            Do::Copy(a) | Do::Invert(a, u64::MAX) | Do::EqualIf(_, _, a) => of(a),
            Do::And(a, b) | Do::AndNot(a, b) | Do::Or(a, b) | Do::Xor(a, b) | Do::Select(_, a, b) => of(a) && of(b),
            Do::EqualIfOr(_, _, a, b) | Do::UnfitIfOr(_, _, a, b) => of(a) && of(b),
            Do::EqualEitherOr(_, [(_, a), (_, b)], c) => of(a) && of(b) && of(c),
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
    pub(super) what: Do<Slot>,
}

/// A register of the machine, and the row that holds its next value after the operations; none if it keeps its value.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegisterRow {
    pub(super) width: Width,
    pub(super) reset: u64,
    pub(super) row: Slot,
    pub(super) next: Option<Slot>,
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
    /// Accumulators, in the order that the builder was given.
    pub(super) accumulators: Vec<Slot>,
    /// All operations; those from `observers` on update the accumulators.
    pub(super) operations: Vec<Operation>,
    /// Index of the first accumulator's operation.
    pub(super) observers: usize,
    /// Rows of the outputs, in the order that the builder was given.
    pub(super) outputs: Vec<Slot>,
}
