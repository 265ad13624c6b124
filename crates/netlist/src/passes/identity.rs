//! Algebraic identities: a cell that is one of its operands, a constant, or a simpler operator.

use super::share::Builder;
use super::{concat, equal};
use crate::bits::Width;
use crate::cells::{Net, Op};

/// What a cell is better written as.
pub(super) enum Rewrite {
    /// An existing net.
    Same(Net),
    /// A constant of the cell's width.
    Constant(u64),
    /// Another operator of the same width.
    As(Op),
}

use Rewrite::{As, Constant, Same};

/// A simpler form of a cell, if there is one.
pub(super) fn rewrite(builder: &mut Builder, op: Op, width: Width) -> Option<Rewrite> {
    let ones = width.mask();
    let known = |builder: &Builder, net: Net| builder.known(net);
    match op {
        Op::Not(a) => match builder.op(a) {
            Op::Not(inner) => Some(Same(inner)),
            _ => None,
        },
        Op::And(a, b) => match (known(builder, a), known(builder, b)) {
            (Some(0), _) | (_, Some(0)) => Some(Constant(0)),
            (Some(value), _) if value == ones => Some(Same(b)),
            (_, Some(value)) if value == ones => Some(Same(a)),
            _ if a == b => Some(Same(a)),
            _ if complements(builder, a, b) => Some(Constant(0)),
            (None, Some(mask)) => masked_twice(builder, a, mask, width),
            (Some(mask), None) => masked_twice(builder, b, mask, width),
            (None, None) if width == Width::ONE => both(builder, a, b),
            _ => None,
        },
        Op::Or(a, b) => match (known(builder, a), known(builder, b)) {
            (Some(0), _) => Some(Same(b)),
            (_, Some(0)) => Some(Same(a)),
            (Some(value), _) | (_, Some(value)) if value == ones => Some(Constant(ones)),
            _ if a == b => Some(Same(a)),
            _ if complements(builder, a, b) => Some(Constant(ones)),
            _ => None,
        },
        Op::Xor(a, b) => match (known(builder, a), known(builder, b)) {
            (Some(0), _) => Some(Same(b)),
            (_, Some(0)) => Some(Same(a)),
            (Some(value), _) if value == ones => Some(As(Op::Not(b))),
            (_, Some(value)) if value == ones => Some(As(Op::Not(a))),
            _ if a == b => Some(Constant(0)),
            _ => None,
        },
        Op::Add(a, b) => match (known(builder, a), known(builder, b)) {
            (Some(0), _) => Some(Same(b)),
            (_, Some(0)) => Some(Same(a)),
            _ => None,
        },
        Op::Sub(a, b) if a == b => Some(Constant(0)),
        Op::Sub(a, b) => (known(builder, b) == Some(0)).then_some(Same(a)),
        Op::Mul(a, b) => match (known(builder, a), known(builder, b)) {
            (Some(0), _) | (_, Some(0)) => Some(Constant(0)),
            (Some(1), _) => Some(Same(b)),
            (_, Some(1)) => Some(Same(a)),
            _ => None,
        },
        Op::Div(a, b) => match (known(builder, a), known(builder, b)) {
            (Some(0), _) | (_, Some(0)) => Some(Constant(0)),
            (_, Some(1)) => Some(Same(a)),
            _ => None,
        },
        Op::Rem(a, b) => {
            (known(builder, a) == Some(0) || a == b || matches!(known(builder, b), Some(0 | 1))).then_some(Constant(0))
        }
        Op::ShiftLeft(a, by) | Op::ShiftRight(a, by) | Op::ShiftArithmetic(a, by) => {
            match (known(builder, a), known(builder, by)) {
                (_, Some(0)) => Some(Same(a)),
                (Some(0), _) => Some(Constant(0)),
                (_, Some(by)) if by >= u64::from(width.get()) && !matches!(op, Op::ShiftArithmetic(..)) => {
                    Some(Constant(0))
                }
                _ => None,
            }
        }
        Op::Carry(a, b) | Op::AddOverflow(a, b) => {
            (known(builder, a) == Some(0) || known(builder, b) == Some(0)).then_some(Constant(0))
        }
        Op::Borrow(a, b) | Op::SubOverflow(a, b) if a == b || known(builder, b) == Some(0) => Some(Constant(0)),
        Op::LessSigned(a, b) if a == b => Some(Constant(0)),
        Op::Equal(a, b) => equal::rewrite(builder, a, b),
        Op::Mux { select, high, low } => mux(builder, select, high, low, width),
        Op::Slice { of, low } => slice(builder, of, low, width),
        Op::Concat { high, low } => concat::rewrite(builder, high, low),
        Op::ZeroExtend(a) | Op::SignExtend(a) if builder.width(a) == width => Some(Same(a)),
        Op::ZeroExtend(a) => match builder.op(a) {
            Op::ZeroExtend(inner) => Some(As(Op::ZeroExtend(inner))),
            _ => None,
        },
        _ => None,
    }
}

/// Two bits that are both 1, of which one chooses an operand of the other.
fn both(builder: &mut Builder, a: Net, b: Net) -> Option<Rewrite> {
    [(a, b), (b, a)].into_iter().find_map(|(bit, other)| {
        let (select, value) = match builder.op(bit) {
            Op::Not(inner) => (inner, false),
            _ => (bit, true),
        };
        where_it_is(builder, other, select, value).map(|other| As(Op::And(bit, other)))
    })
}

/// What a sum, a difference or a flag of two operands is where a select has a value that one of them is chosen by.
fn where_it_is(builder: &mut Builder, net: Net, select: Net, value: bool) -> Option<Net> {
    let op = builder.op(net);
    if !matches!(
        op,
        Op::Add(..) | Op::Sub(..) | Op::AddOverflow(..) | Op::SubOverflow(..) | Op::Carry(..) | Op::Borrow(..)
    ) {
        return None;
    }
    let chosen = |builder: &Builder, operand: Net| match builder.op(operand) {
        Op::Mux { select: inner, high, low } if inner == select => Some(if value { high } else { low }),
        _ => None,
    };
    let mut any = false;
    let op = op.map_inputs(|operand| {
        // An operand is as wide as the sum.
        let width = builder.width(operand);
        let other = match builder.op(operand) {
            Op::ZeroExtend(part) => chosen(builder, part).map(|part| builder.make(Op::ZeroExtend(part), width)),
            Op::SignExtend(part) => chosen(builder, part).map(|part| builder.make(Op::SignExtend(part), width)),
            _ => chosen(builder, operand),
        };
        any |= other.is_some();
        other.unwrap_or(operand)
    });
    any.then(|| builder.make(op, builder.width(net)))
}

/// Bits of bits: those of both masks.
fn masked_twice(builder: &mut Builder, net: Net, mask: u64, width: Width) -> Option<Rewrite> {
    let Op::And(a, b) = builder.op(net) else { return None };
    let (inner, other) = builder.known(b).map(|known| (a, known)).or(builder.known(a).map(|known| (b, known)))?;
    let mask = builder.constant(mask & other, width);
    Some(As(Op::And(inner, mask)))
}

fn complements(builder: &Builder, a: Net, b: Net) -> bool {
    builder.op(a) == Op::Not(b) || builder.op(b) == Op::Not(a)
}

fn mux(builder: &mut Builder, select: Net, high: Net, low: Net, width: Width) -> Option<Rewrite> {
    match builder.known(select) {
        Some(1) => return Some(Same(high)),
        Some(_) => return Some(Same(low)),
        None if high == low => return Some(Same(high)),
        None => {}
    }
    if let Op::Not(inner) = builder.op(select) {
        return Some(As(Op::Mux { select: inner, high: low, low: high }));
    }
    // A multiplexer fed by another one with the same select never shows the other side.
    if let Op::Mux { select: inner, high: shown, .. } = builder.op(high)
        && inner == select
    {
        return Some(As(Op::Mux { select, high: shown, low }));
    }
    if let Op::Mux { select: inner, low: shown, .. } = builder.op(low)
        && inner == select
    {
        return Some(As(Op::Mux { select, high, low: shown }));
    }
    // What chooses an operand by the same select never has the other one.
    let (with, without) = (where_it_is(builder, high, select, true), where_it_is(builder, low, select, false));
    if with.is_some() || without.is_some() {
        return Some(As(Op::Mux { select, high: with.unwrap_or(high), low: without.unwrap_or(low) }));
    }
    if width == Width::ONE {
        return match (builder.known(high), builder.known(low)) {
            (Some(1), Some(0)) => Some(Same(select)),
            (Some(0), Some(1)) => Some(As(Op::Not(select))),
            (Some(1), None) => Some(As(Op::Or(select, low))),
            (None, Some(0)) => Some(As(Op::And(select, high))),
            (Some(0), None) => {
                let not = builder.make(Op::Not(select), Width::ONE);
                Some(As(Op::And(not, low)))
            }
            (None, Some(1)) => {
                let not = builder.make(Op::Not(select), Width::ONE);
                Some(As(Op::Or(not, high)))
            }
            _ => None,
        };
    }
    // Counting by one under a condition, or but for one, is adding the condition.
    let by_one = |builder: &Builder, sum: Net, other: Net| -> Option<fn(Net, Net) -> Op> {
        match builder.op(sum) {
            Op::Add(a, b) if a == other && builder.known(b) == Some(1) => Some(Op::Add),
            Op::Add(b, a) if a == other && builder.known(b) == Some(1) => Some(Op::Add),
            Op::Sub(a, b) if a == other && builder.known(b) == Some(1) => Some(Op::Sub),
            _ => None,
        }
    };
    let (count, from, bit) = match (by_one(builder, high, low), by_one(builder, low, high)) {
        (Some(count), _) => (count, low, select),
        (None, Some(count)) => (count, high, builder.make(Op::Not(select), Width::ONE)),
        (None, None) => return None,
    };
    let bit = builder.make(Op::ZeroExtend(bit), width);
    Some(As(count(from, bit)))
}

fn slice(builder: &mut Builder, of: Net, low: u8, width: Width) -> Option<Rewrite> {
    if low == 0 && builder.width(of) == width {
        return Some(Same(of));
    }
    let (from, top) = (u32::from(low), u32::from(low) + width.get());
    match builder.op(of) {
        Op::Slice { of: inner, low: below } => Some(As(Op::Slice { of: inner, low: below + low })),
        Op::Concat { high, low: part } => {
            let split = builder.width(part).get();
            if top <= split {
                Some(As(Op::Slice { of: part, low }))
            } else if from >= split {
                // At most 63 bits are below the high part.
                Some(As(Op::Slice { of: high, low: low - u8::try_from(split).unwrap_or(low) }))
            } else {
                None
            }
        }
        Op::And(a, b) => {
            let (inner, mask) = builder.known(b).map(|mask| (a, mask)).or(builder.known(a).map(|mask| (b, mask)))?;
            match mask >> low & width.mask() {
                0 => Some(Constant(0)),
                kept => (kept == width.mask()).then_some(As(Op::Slice { of: inner, low })),
            }
        }
        Op::ZeroExtend(part) => {
            let split = builder.width(part).get();
            if from >= split { Some(Constant(0)) } else { (top <= split).then_some(As(Op::Slice { of: part, low })) }
        }
        _ => None,
    }
}
