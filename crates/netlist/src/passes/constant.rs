//! The value of a cell whose operands are known.

use crate::bits::{self, Width};
use crate::cells::{Net, Op};

/// The value of `op` in `width`, where `value` knows the value and width of every operand; `None` where one is unknown.
pub fn value(op: Op, width: Width, value: impl Fn(Net) -> Option<(u64, Width)>) -> Option<u64> {
    let one = |a: Net| value(a).map(|(a, _)| a);
    let two = |a: Net, b: Net| Some((one(a)?, one(b)?));
    let flag = |a: Net, b: Net, of: fn(Width, u64, u64) -> bool| {
        let ((a, width), b) = (value(a)?, one(b)?);
        Some(u64::from(of(width, a, b)))
    };
    match op {
        Op::Input | Op::Register { .. } | Op::Read { .. } => None,
        Op::Const(constant) => Some(constant),
        Op::Not(a) => one(a).map(|a| !a & width.mask()),
        Op::And(a, b) => two(a, b).map(|(a, b)| a & b),
        Op::Or(a, b) => two(a, b).map(|(a, b)| a | b),
        Op::Xor(a, b) => two(a, b).map(|(a, b)| a ^ b),
        Op::Mux { select, high, low } => one(if one(select)? == 1 { high } else { low }),
        Op::Add(a, b) => two(a, b).map(|(a, b)| bits::add(width, a, b)),
        Op::Sub(a, b) => two(a, b).map(|(a, b)| bits::sub(width, a, b)),
        Op::Mul(a, b) => two(a, b).map(|(a, b)| bits::mul(width, a, b)),
        Op::Div(a, b) => two(a, b).map(|(a, b)| bits::div(a, b)),
        Op::Rem(a, b) => two(a, b).map(|(a, b)| bits::rem(a, b)),
        Op::ShiftLeft(a, by) => two(a, by).map(|(a, by)| bits::shift_left(width, a, by)),
        Op::ShiftRight(a, by) => two(a, by).map(|(a, by)| bits::shift_right(a, by)),
        Op::ShiftArithmetic(a, by) => two(a, by).map(|(a, by)| bits::shift_arithmetic(width, a, by)),
        Op::Carry(a, b) => flag(a, b, bits::carry),
        Op::Borrow(a, b) => flag(a, b, |_, a, b| bits::borrow(a, b)),
        Op::AddOverflow(a, b) => flag(a, b, bits::add_overflow),
        Op::SubOverflow(a, b) => flag(a, b, bits::sub_overflow),
        Op::Equal(a, b) => flag(a, b, |_, a, b| a == b),
        Op::LessSigned(a, b) => flag(a, b, bits::less_signed),
        Op::Slice { of, low } => one(of).map(|of| of >> low & width.mask()),
        Op::Concat { high, low } => {
            let (high, (low, low_width)) = (one(high)?, value(low)?);
            Some(high << low_width.get() | low)
        }
        Op::ZeroExtend(a) => one(a),
        Op::SignExtend(a) => value(a).map(|(a, from)| bits::sign_extend(from, width, a)),
    }
}
