//! Operations that are better written as another one: an operand, or two operations in one.

use super::code::LaneOp;
use super::lower::{Lowering, Value};

/// What an operation is better written as.
pub(super) enum Rewrite {
    /// An existing value.
    Same(Value),
    /// Another operation.
    As(LaneOp<Value>),
}

use Rewrite::{As, Same};

/// A simpler form of an operation, if there is one.
pub(super) fn rewrite(lowering: &mut Lowering, what: LaneOp<Value>) -> Option<Rewrite> {
    let constant = |value| lowering.constant(value);
    match what {
        LaneOp::Invert(a, p) => match lowering.what(a) {
            Some(LaneOp::Invert(inner, q)) if p == q => Some(Same(inner)),
            _ => None,
        },
        LaneOp::And(a, b) => and(lowering, a, b).or_else(|| and(lowering, b, a)),
        LaneOp::Or(a, b) => {
            if constant(a) == Some(0) {
                return Some(Same(b));
            }
            or(lowering, a, b).or_else(|| or(lowering, b, a))
        }
        LaneOp::Select(select, high, low) => {
            if constant(low) == Some(0) {
                return Some(As(LaneOp::And(select, high)));
            }
            if constant(high) == Some(0) {
                return Some(As(LaneOp::AndNot(low, select)));
            }
            select_sum(lowering, select, high, low)
        }
        LaneOp::AddIf(a, b, condition) => constant(b).map(|p| As(LaneOp::AddWhere(a, condition, p))),
        LaneOp::SubIf(a, b, condition) => constant(b).map(|p| As(LaneOp::AddWhere(a, condition, p.wrapping_neg()))),
        LaneOp::AddWhere(a, second, q) => match lowering.what(a)? {
            LaneOp::AddWhere(a, first, p) => Some(As(LaneOp::AddEither(a, first, p, second, q))),
            _ => None,
        },
        LaneOp::Left(a, by, u64::MAX) => left(lowering, a, by),
        LaneOp::Add(a, b) => add(lowering, a, b, false).or_else(|| add(lowering, b, a, false)),
        LaneOp::Sub(a, b) => add(lowering, a, b, true),
        LaneOp::Equal(a, b) => equal(lowering, a, b).or_else(|| equal(lowering, b, a)),
        _ => None,
    }
}

/// a & b, looked at from `a`.
fn and(lowering: &mut Lowering, a: Value, b: Value) -> Option<Rewrite> {
    match lowering.what(a)? {
        LaneOp::Invert(inner, u64::MAX) => Some(As(LaneOp::AndNot(b, inner))),
        LaneOp::EqualTo(inner, p) => Some(As(LaneOp::EqualIf(inner, p, b))),
        // Adding nothing carries nothing, so the condition may be applied before the adder, where its sum is needed
        // too. But a number gated by a carry is not a condition.
        LaneOp::Carry(x, y) if lowering.is_single(b) => {
            let sum = lowering.make(LaneOp::AddIf(x, y, b));
            Some(As(LaneOp::Less(sum, x)))
        }
        LaneOp::Less(x, y) if lowering.is_single(b) => Some(As(LaneOp::LessIf(x, y, b))),
        _ => None,
    }
}

/// a | b, looked at from `a`.
fn or(lowering: &mut Lowering, a: Value, b: Value) -> Option<Rewrite> {
    match lowering.what(a)? {
        LaneOp::EqualIf(inner, p, first) => match lowering.what(b) {
            Some(LaneOp::EqualIfOr(same, q, second, or)) if same == inner => {
                Some(As(LaneOp::EqualEitherOr(inner, [(p, first), (q, second)], or)))
            }
            _ => Some(As(LaneOp::EqualIfOr(inner, p, first, b))),
        },
        LaneOp::AndNot(condition, fits) => match lowering.what(fits)? {
            LaneOp::Fits(inner, by) => Some(As(LaneOp::UnfitIfOr(inner, by, condition, b))),
            _ => None,
        },
        _ => None,
    }
}

/// a ± b, looked at from `b`.
fn add(lowering: &Lowering, a: Value, b: Value, minus: bool) -> Option<Rewrite> {
    match lowering.what(b)? {
        LaneOp::Mask(condition, p) => {
            Some(As(LaneOp::AddWhere(a, condition, if minus { p.wrapping_neg() } else { p })))
        }
        _ => None,
    }
}

/// a = b, looked at from `a`.
fn equal(lowering: &Lowering, a: Value, b: Value) -> Option<Rewrite> {
    if let Some(p) = lowering.constant(a) {
        return Some(As(LaneOp::EqualTo(b, p)));
    }
    let LaneOp::RightSigned(cut, by) = lowering.what(a)? else { return None };
    match lowering.what(cut)? {
        LaneOp::Left(whole, left, u64::MAX) if whole == b && left == by => Some(As(LaneOp::Fits(b, by))),
        _ => None,
    }
}

/// A sum or difference under a condition: the condition goes into the adder.
fn select_sum(lowering: &mut Lowering, select: Value, high: Value, low: Value) -> Option<Rewrite> {
    let of = |what, onto| match what {
        LaneOp::Add(a, b) if a == onto => Some(LaneOp::AddIf(low, b, select)),
        LaneOp::Add(b, a) if a == onto => Some(LaneOp::AddIf(low, b, select)),
        LaneOp::Sub(a, b) if a == onto => Some(LaneOp::SubIf(low, b, select)),
        _ => None,
    };
    let high = lowering.what(high)?;
    // Where the condition is 1, `low` is `held` itself, if it adds only under one that is then 0.
    let held = match lowering.what(low) {
        Some(
            LaneOp::AddWhere(held, condition, _)
            | LaneOp::AddIf(held, _, condition)
            | LaneOp::SubIf(held, _, condition),
        ) if excludes(lowering, select, condition) => held,
        _ => low,
    };
    of(high, held).or_else(|| of(high, low)).map(As)
}

/// The two are never ones together: both need the same value, but with unlike signs of another.
fn excludes(lowering: &Lowering, a: Value, b: Value) -> bool {
    match (lowering.what(a), lowering.what(b)) {
        (Some(LaneOp::AndNot(p, n)), Some(LaneOp::And(q, r)))
        | (Some(LaneOp::And(q, r)), Some(LaneOp::AndNot(p, n))) => (p, n) == (q, r) || (p, n) == (r, q),
        _ => false,
    }
}

/// a << by, where nothing is left below the result: the cut of a number to fewer bits.
fn left(lowering: &mut Lowering, a: Value, by: u32) -> Option<Rewrite> {
    let cut = |lowering: &mut Lowering, value| lowering.make(LaneOp::Left(value, by, u64::MAX));
    match lowering.what(a)? {
        // A number that was extended for an exact sum, and the sum cut again: the sum of what it was.
        LaneOp::Add(x, y) => {
            let (x, y) = (extended(lowering, x, by)?, cut(lowering, y));
            Some(As(LaneOp::Add(x, y)))
        }
        LaneOp::Sub(x, y) => {
            let (x, y) = (extended(lowering, x, by)?, cut(lowering, y));
            Some(As(LaneOp::Sub(x, y)))
        }
        LaneOp::Right(inner, right) if right > by => Some(As(LaneOp::Right(inner, right - by))),
        _ => None,
    }
}

/// What a value is that was extended by `by` bits.
fn extended(lowering: &Lowering, value: Value, by: u32) -> Option<Value> {
    match lowering.what(value)? {
        LaneOp::RightSigned(inner, right) | LaneOp::Right(inner, right) if right == by => Some(inner),
        _ => None,
    }
}
