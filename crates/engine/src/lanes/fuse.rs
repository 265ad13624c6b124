//! Operations that are better written as another one: an operand, or two operations in one.

use super::code::Do;
use super::lower::{Lowering, Value};

/// What an operation is better written as.
pub(super) enum Simpler {
    /// An existing value.
    Same(Value),
    /// Another operation.
    As(Do<Value>),
}

use Simpler::{As, Same};

/// A simpler form of an operation, if there is one.
pub(super) fn simpler(lowering: &mut Lowering, what: Do<Value>) -> Option<Simpler> {
    let constant = |value| lowering.constant(value);
    match what {
        Do::Invert(a, p) => match lowering.what(a) {
            Some(Do::Invert(inner, q)) if p == q => Some(Same(inner)),
            _ => None,
        },
        Do::And(a, b) => and(lowering, a, b).or_else(|| and(lowering, b, a)),
        Do::Or(a, b) => {
            if constant(a) == Some(0) {
                return Some(Same(b));
            }
            or(lowering, a, b).or_else(|| or(lowering, b, a))
        }
        Do::Select(select, high, low) => {
            if constant(low) == Some(0) {
                return Some(As(Do::And(select, high)));
            }
            if constant(high) == Some(0) {
                return Some(As(Do::AndNot(low, select)));
            }
            select_sum(lowering, select, high, low)
        }
        Do::AddIf(a, b, condition) => constant(b).map(|p| As(Do::AddWhere(a, condition, p))),
        Do::SubIf(a, b, condition) => constant(b).map(|p| As(Do::AddWhere(a, condition, p.wrapping_neg()))),
        Do::AddWhere(a, second, q) => match lowering.what(a)? {
            Do::AddWhere(a, first, p) => Some(As(Do::AddEither(a, first, p, second, q))),
            _ => None,
        },
        Do::Left(a, by, u64::MAX) => left(lowering, a, by),
        Do::Add(a, b) => add(lowering, a, b, false).or_else(|| add(lowering, b, a, false)),
        Do::Sub(a, b) => add(lowering, a, b, true),
        Do::Equal(a, b) => equal(lowering, a, b).or_else(|| equal(lowering, b, a)),
        _ => None,
    }
}

/// a & b, looked at from `a`.
fn and(lowering: &mut Lowering, a: Value, b: Value) -> Option<Simpler> {
    match lowering.what(a)? {
        Do::Invert(inner, u64::MAX) => Some(As(Do::AndNot(b, inner))),
        Do::EqualTo(inner, p) => Some(As(Do::EqualIf(inner, p, b))),
        // Adding nothing carries nothing, so the condition may be applied before the adder, where its sum is needed
        // too. But a number gated by a carry is not a condition.
        Do::Carry(x, y) if lowering.is_single(b) => {
            let sum = lowering.make(Do::AddIf(x, y, b));
            Some(As(Do::Less(sum, x)))
        }
        Do::Less(x, y) if lowering.is_single(b) => Some(As(Do::LessIf(x, y, b))),
        _ => None,
    }
}

/// a | b, looked at from `a`.
fn or(lowering: &mut Lowering, a: Value, b: Value) -> Option<Simpler> {
    match lowering.what(a)? {
        Do::EqualIf(inner, p, first) => match lowering.what(b) {
            Some(Do::EqualIfOr(same, q, second, or)) if same == inner => {
                Some(As(Do::EqualEitherOr(inner, [(p, first), (q, second)], or)))
            }
            _ => Some(As(Do::EqualIfOr(inner, p, first, b))),
        },
        Do::AndNot(condition, fits) => match lowering.what(fits)? {
            Do::Fits(inner, by) => Some(As(Do::UnfitIfOr(inner, by, condition, b))),
            _ => None,
        },
        _ => None,
    }
}

/// a ± b, looked at from `b`.
fn add(lowering: &Lowering, a: Value, b: Value, minus: bool) -> Option<Simpler> {
    match lowering.what(b)? {
        Do::Mask(condition, p) => Some(As(Do::AddWhere(a, condition, if minus { p.wrapping_neg() } else { p }))),
        _ => None,
    }
}

/// a = b, looked at from `a`.
fn equal(lowering: &Lowering, a: Value, b: Value) -> Option<Simpler> {
    if let Some(p) = lowering.constant(a) {
        return Some(As(Do::EqualTo(b, p)));
    }
    let Do::RightSigned(cut, by) = lowering.what(a)? else { return None };
    match lowering.what(cut)? {
        Do::Left(whole, left, u64::MAX) if whole == b && left == by => Some(As(Do::Fits(b, by))),
        _ => None,
    }
}

/// A sum or difference under a condition: the condition goes into the adder.
fn select_sum(lowering: &mut Lowering, select: Value, high: Value, low: Value) -> Option<Simpler> {
    let of = |what, onto| match what {
        Do::Add(a, b) if a == onto => Some(Do::AddIf(low, b, select)),
        Do::Add(b, a) if a == onto => Some(Do::AddIf(low, b, select)),
        Do::Sub(a, b) if a == onto => Some(Do::SubIf(low, b, select)),
        _ => None,
    };
    let high = lowering.what(high)?;
    // Where the condition is 1, `low` is `held` itself, if it adds only under one that is then 0.
    let held = match lowering.what(low) {
        Some(Do::AddWhere(held, condition, _) | Do::AddIf(held, _, condition) | Do::SubIf(held, _, condition))
            if excludes(lowering, select, condition) =>
        {
            held
        }
        _ => low,
    };
    of(high, held).or_else(|| of(high, low)).map(As)
}

/// The two are never ones together: both need the same value, but with unlike signs of another.
fn excludes(lowering: &Lowering, a: Value, b: Value) -> bool {
    match (lowering.what(a), lowering.what(b)) {
        (Some(Do::AndNot(p, n)), Some(Do::And(q, r))) | (Some(Do::And(q, r)), Some(Do::AndNot(p, n))) => {
            (p, n) == (q, r) || (p, n) == (r, q)
        }
        _ => false,
    }
}

/// a << by, where nothing is left below the result: the cut of a number to fewer bits.
fn left(lowering: &mut Lowering, a: Value, by: u32) -> Option<Simpler> {
    let cut = |lowering: &mut Lowering, value| lowering.make(Do::Left(value, by, u64::MAX));
    match lowering.what(a)? {
        // A number that was extended for an exact sum, and the sum cut again: the sum of what it was.
        Do::Add(x, y) => {
            let (x, y) = (extended(lowering, x, by)?, cut(lowering, y));
            Some(As(Do::Add(x, y)))
        }
        Do::Sub(x, y) => {
            let (x, y) = (extended(lowering, x, by)?, cut(lowering, y));
            Some(As(Do::Sub(x, y)))
        }
        Do::Right(inner, right) if right > by => Some(As(Do::Right(inner, right - by))),
        _ => None,
    }
}

/// What a value is that was extended by `by` bits.
fn extended(lowering: &Lowering, value: Value, by: u32) -> Option<Value> {
    match lowering.what(value)? {
        Do::RightSigned(inner, right) | Do::Right(inner, right) if right == by => Some(inner),
        _ => None,
    }
}
