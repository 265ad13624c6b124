//! The operators in the languages of model checkers and solvers: one table for both.
//!
//! Every net is a bit vector, in SMT-LIB too: what is a truth value there becomes one bit. Carries and overflows are
//! taken from a sum or difference with one more bit, for not every tool knows operators of their own for them.

use std::collections::HashSet;

use stepwave_netlist::cells::{NamedNet, Net, Netlist, Op, Property};

/// An operator in both languages.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct OperatorName {
    /// In BTOR2; operands and then numbers follow.
    pub(super) btor2: &'static str,
    /// In SMT-LIB, with `$0` for the first operand and `#0` for the first number.
    pub(super) smt2: &'static str,
}

const fn word(btor2: &'static str, smt2: &'static str) -> OperatorName {
    OperatorName { btor2, smt2 }
}

const NOT: OperatorName = word("not", "(bvnot $0)");
const AND: OperatorName = word("and", "(bvand $0 $1)");
const OR: OperatorName = word("or", "(bvor $0 $1)");
const XOR: OperatorName = word("xor", "(bvxor $0 $1)");
const MUX: OperatorName = word("ite", "(ite (= $0 #b1) $1 $2)");
const ADD: OperatorName = word("add", "(bvadd $0 $1)");
const SUB: OperatorName = word("sub", "(bvsub $0 $1)");
const MUL: OperatorName = word("mul", "(bvmul $0 $1)");
const DIV: OperatorName = word("udiv", "(bvudiv $0 $1)");
const REM: OperatorName = word("urem", "(bvurem $0 $1)");
const SHIFT_LEFT: OperatorName = word("sll", "(bvshl $0 $1)");
const SHIFT_RIGHT: OperatorName = word("srl", "(bvlshr $0 $1)");
const SHIFT_ARITHMETIC: OperatorName = word("sra", "(bvashr $0 $1)");
const LESS: OperatorName = word("ult", "(ite (bvult $0 $1) #b1 #b0)");
const LESS_SIGNED: OperatorName = word("slt", "(ite (bvslt $0 $1) #b1 #b0)");
const EQUAL: OperatorName = word("eq", "(bvcomp $0 $1)");
const CONCAT: OperatorName = word("concat", "(concat $0 $1)");
/// Highest and lowest bit.
const SLICE: OperatorName = word("slice", "((_ extract #0 #1) $0)");
/// Bits added.
const ZERO_EXTEND: OperatorName = word("uext", "((_ zero_extend #0) $0)");
const SIGN_EXTEND: OperatorName = word("sext", "((_ sign_extend #0) $0)");

/// What a net is made of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Term {
    /// Another net.
    Net(Net),
    /// The number 0 of this many bits.
    Zero(u32),
    /// An operator: its word, its width in bits, operands, numbers.
    Apply(OperatorName, u32, Vec<Term>, Vec<u32>),
}

impl Term {
    fn slice(self, high: u32, low: u32) -> Term {
        Term::Apply(SLICE, high - low + 1, vec![self], vec![high, low])
    }
}

/// What a combinational cell computes. Inputs, constants and registers are given as themselves.
pub(super) fn term(netlist: &Netlist, net: Net) -> Term {
    let (op, width) = (netlist.cell(net).op, netlist.width(net).get());
    let bits = |net: Net| netlist.width(net).get();
    let apply = |word: OperatorName, numbers: Vec<u32>| {
        let mut operands = Vec::new();
        op.visit_inputs(|input| operands.push(Term::Net(input)));
        Term::Apply(word, width, operands, numbers)
    };
    // One bit more, and its value.
    let wider = |word: OperatorName, extend: OperatorName, a: Net, b: Net| {
        let wide = bits(a) + 1;
        let operand = |net: Net| Term::Apply(extend, wide, vec![Term::Net(net)], vec![1]);
        Term::Apply(word, wide, vec![operand(a), operand(b)], vec![])
    };
    // The added bit holds the sign of the exact result.
    let overflow = |word: OperatorName, a: Net, b: Net| {
        let sign = |bit: u32| wider(word, SIGN_EXTEND, a, b).slice(bit, bit);
        Term::Apply(XOR, 1, vec![sign(bits(a)), sign(bits(a) - 1)], vec![])
    };
    // Both languages make all ones of a division by 0.
    let guarded = |word: OperatorName, divisor: Net| {
        let none = Term::Apply(EQUAL, 1, vec![Term::Net(divisor), Term::Zero(width)], vec![]);
        Term::Apply(MUX, width, vec![none, Term::Zero(width), apply(word, vec![])], vec![])
    };
    // Both operands are as wide as the wider one.
    let shift = |word: OperatorName, extend: OperatorName, a: Net, by: Net| {
        let wide = width.max(bits(by));
        let widened = |net: Net, extend: OperatorName| match wide - bits(net) {
            0 => Term::Net(net),
            more => Term::Apply(extend, wide, vec![Term::Net(net)], vec![more]),
        };
        let shifted = Term::Apply(word, wide, vec![widened(a, extend), widened(by, ZERO_EXTEND)], vec![]);
        if wide == width { shifted } else { shifted.slice(width - 1, 0) }
    };
    match op {
        // Designs with memories are refused.
        Op::Input | Op::Const(_) | Op::Register { .. } | Op::Read { .. } => Term::Net(net),
        Op::Not(_) => apply(NOT, vec![]),
        Op::And(..) => apply(AND, vec![]),
        Op::Or(..) => apply(OR, vec![]),
        Op::Xor(..) => apply(XOR, vec![]),
        Op::Mux { .. } => apply(MUX, vec![]),
        Op::Add(..) => apply(ADD, vec![]),
        Op::Sub(..) => apply(SUB, vec![]),
        Op::Mul(..) => apply(MUL, vec![]),
        Op::Div(_, b) => guarded(DIV, b),
        Op::Rem(_, b) => guarded(REM, b),
        Op::ShiftLeft(a, by) => shift(SHIFT_LEFT, ZERO_EXTEND, a, by),
        Op::ShiftRight(a, by) => shift(SHIFT_RIGHT, ZERO_EXTEND, a, by),
        Op::ShiftArithmetic(a, by) => shift(SHIFT_ARITHMETIC, SIGN_EXTEND, a, by),
        Op::Carry(a, b) => wider(ADD, ZERO_EXTEND, a, b).slice(bits(a), bits(a)),
        Op::Borrow(..) => apply(LESS, vec![]),
        Op::AddOverflow(a, b) => overflow(ADD, a, b),
        Op::SubOverflow(a, b) => overflow(SUB, a, b),
        Op::Equal(..) => apply(EQUAL, vec![]),
        Op::LessSigned(..) => apply(LESS_SIGNED, vec![]),
        Op::Slice { low, .. } => apply(SLICE, vec![u32::from(low) + width - 1, u32::from(low)]),
        Op::Concat { .. } => apply(CONCAT, vec![]),
        Op::ZeroExtend(a) => apply(ZERO_EXTEND, vec![width - bits(a)]),
        Op::SignExtend(a) => apply(SIGN_EXTEND, vec![width - bits(a)]),
    }
}

/// What nets and properties are called.
pub(super) struct Symbols {
    /// Of each net: its first path, if it has a name; `path.86_64` of a part of a word of more than 64 bits.
    pub(super) nets: Vec<Option<String>>,
    /// Further paths of nets that have one.
    pub(super) further: Vec<(Net, String)>,
    /// Of each property: `never.` and the path of its net, or where that has none the words of the property's author,
    /// with an underscore for every character that a name cannot have.
    pub(super) properties: Vec<String>,
}

impl Symbols {
    pub(super) fn new(netlist: &Netlist) -> Symbols {
        let mut nets: Vec<Option<String>> = vec![None; netlist.cells.len()];
        let (mut further, mut taken) = (Vec::new(), HashSet::new());
        for named in netlist.names.iter().filter(|named| !named.is_wide()) {
            let path = netlist.path(named);
            taken.insert(path.clone());
            match &mut nets[named.net.index()] {
                Some(_) => further.push((named.net, path)),
                first => *first = Some(path),
            }
        }
        let fit = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '_' };
        let property = |property: &Property| {
            let words = || property.name.chars().map(fit).collect();
            let name = format!("never.{}", nets[property.never.index()].clone().unwrap_or_else(words));
            let numbered = (1u64..).map(|number| format!("{name}_{number}"));
            let free = std::iter::once(name.clone()).chain(numbered).find(|name| taken.insert(name.clone()));
            free.unwrap_or(name)
        };
        let properties = netlist.properties.iter().map(property).collect();
        for named in netlist.names.iter().filter(|named| named.is_wide()) {
            for (low, net) in (0u32..).step_by(NamedNet::PART as usize).zip(named.nets()) {
                let high = low + netlist.width(net).get() - 1;
                nets[net.index()].get_or_insert_with(|| format!("{}.{high}_{low}", netlist.path(named)));
            }
        }
        Symbols { nets, further, properties }
    }
}

/// Inputs and registers in creation order.
pub(super) fn leaves(netlist: &Netlist) -> impl Iterator<Item = Net> {
    netlist.nets().filter(|&net| matches!(netlist.cell(net).op, Op::Input | Op::Register { .. }))
}
