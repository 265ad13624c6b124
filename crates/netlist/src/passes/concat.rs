//! Concatenations: parts of one net that meet are one part, a bit that is repeated is the extension of a sign, and parts
//! that are selected together are selected as one; what is above zeros where it was before is a net with bits cleared.

use super::identity::Rewrite;
use super::share::Builder;
use crate::bits::Width;
use crate::cells::{Net, Op};

/// Multiplexers of multiplexers that are looked into.
const DEEPEST: u32 = 3;

/// A simpler form of a concatenation, if there is one.
pub(super) fn rewrite(builder: &mut Builder, high: Net, low: Net) -> Option<Rewrite> {
    if builder.known(high) == Some(0) {
        return Some(Rewrite::As(Op::ZeroExtend(low)));
    }
    if let Some(op) = cleared(builder, high, low) {
        return Some(Rewrite::As(op));
    }
    if let Some(op) = joined(builder, high, low, 0) {
        return Some(Rewrite::As(op));
    }
    // Words are put together from the lowest part on: the two highest may be one.
    let Op::Concat { high: middle, low: rest } = builder.op(low) else { return None };
    let op = joined(builder, high, middle, 0)?;
    let width = sum(builder, high, middle)?;
    let high = builder.make(op, width);
    Some(Rewrite::As(Op::Concat { high, low: rest }))
}

/// A part of a net above as many zeros as were below it there: the net without those bits.
fn cleared(builder: &mut Builder, high: Net, low: Net) -> Option<Op> {
    let (width, zeros) = (sum(builder, high, low)?, builder.width(low));
    let Op::Slice { of, low: from } = builder.op(high) else { return None };
    if builder.known(low) != Some(0) || u32::from(from) != zeros.get() {
        return None;
    }
    let whole = builder.make(Op::Slice { of, low: 0 }, width);
    let mask = builder.constant(width.mask() & !zeros.mask(), width);
    Some(Op::And(whole, mask))
}

fn sum(builder: &Builder, high: Net, low: Net) -> Option<Width> {
    Width::new(u64::from(builder.width(high).get() + builder.width(low).get())).ok()
}

/// An operator other than a concatenation that gives two parts at once.
fn joined(builder: &mut Builder, high: Net, low: Net, depth: u32) -> Option<Op> {
    let width = builder.width(low).get();
    if let (Some(high), Some(low)) = (builder.known(high), builder.known(low)) {
        return Some(Op::Const(high << width | low));
    }
    match (builder.op(high), builder.op(low)) {
        (Op::Slice { of: a, low: above }, Op::Slice { of: b, low })
            if a == b && u32::from(above) == u32::from(low) + width =>
        {
            Some(Op::Slice { of: a, low })
        }
        (Op::Mux { select, high: a, low: b }, Op::Mux { select: same, high: c, low: d })
            if select == same && depth < DEEPEST =>
        {
            let all = sum(builder, high, low)?;
            let (with, without) = (joined(builder, a, c, depth + 1)?, joined(builder, b, d, depth + 1)?);
            let (high, low) = (builder.make(with, all), builder.make(without, all));
            Some(Op::Mux { select, high, low })
        }
        _ => repeated(builder, high, low).map(Op::SignExtend),
    }
}

/// The net whose sign is extended where a bit, once or more often, is above a part that has it for its highest one.
fn repeated(builder: &Builder, high: Net, low: Net) -> Option<Net> {
    let bit = match builder.op(high) {
        Op::SignExtend(bit) if builder.width(bit) == Width::ONE => bit,
        _ if builder.width(high) == Width::ONE => high,
        _ => return None,
    };
    let is_top = |of: Net, base: u32, width: u32| match builder.op(bit) {
        Op::Slice { of: whole, low } => whole == of && u32::from(low) == base + width - 1,
        _ => false,
    };
    let width = builder.width(low).get();
    match builder.op(low) {
        _ if low == bit || is_top(low, 0, width) => Some(low),
        Op::SignExtend(inner) if inner == bit || is_top(inner, 0, builder.width(inner).get()) => Some(inner),
        Op::Slice { of, low: base } if is_top(of, u32::from(base), width) => Some(low),
        _ => None,
    }
}
