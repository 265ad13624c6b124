//! Comparisons with a constant: what is between the constant and the bits that decide is left out.

use super::identity::Rewrite::{self, As, Constant, Same};
use super::share::Builder;
use crate::bits::{self, Width};
use crate::cells::{Net, Op};

/// A simpler form of `a == b`, if there is one.
pub(super) fn rewrite(builder: &mut Builder, a: Net, b: Net) -> Option<Rewrite> {
    let (net, value) = match (builder.known(a), builder.known(b)) {
        _ if a == b => return Some(Constant(1)),
        (None, Some(value)) => (a, value),
        (Some(value), None) => (b, value),
        _ => return None,
    };
    let width = builder.width(net);
    if width == Width::ONE {
        return Some(if value == 1 { Same(net) } else { As(Op::Not(net)) });
    }
    let to = |builder: &mut Builder, net: Net, value: u64| {
        let value = builder.constant(value, builder.width(net));
        Op::Equal(net, value)
    };
    match builder.op(net) {
        Op::Not(inner) => Some(As(to(builder, inner, !value & width.mask()))),
        Op::Xor(x, y) => {
            let (inner, flipped) =
                builder.known(y).map(|flipped| (x, flipped)).or(builder.known(x).map(|known| (y, known)))?;
            Some(As(to(builder, inner, value ^ flipped)))
        }
        Op::ZeroExtend(inner) if value > builder.width(inner).mask() => Some(Constant(0)),
        Op::ZeroExtend(inner) => Some(As(to(builder, inner, value))),
        Op::SignExtend(inner) => {
            let from = builder.width(inner);
            let low = value & from.mask();
            let possible = bits::sign_extend(from, width, low) == value;
            Some(if possible { As(to(builder, inner, low)) } else { Constant(0) })
        }
        Op::Mux { select, high, low } => match (builder.known(high)? == value, builder.known(low)? == value) {
            (true, true) => Some(Constant(1)),
            (true, false) => Some(Same(select)),
            (false, true) => Some(As(Op::Not(select))),
            (false, false) => Some(Constant(0)),
        },
        Op::Concat { high, low } => parts(builder, high, low, value),
        _ => None,
    }
}

/// Of a word put together from two parts: the part that is not known, or, of all ones or zeros, bit by bit.
fn parts(builder: &mut Builder, high: Net, low: Net, value: u64) -> Option<Rewrite> {
    let split = builder.width(low);
    let [above, below] = [value >> split.get(), value & split.mask()];
    if let Some(known) = builder.known(high) {
        let below = builder.constant(below, split);
        return Some(if known == above { As(Op::Equal(low, below)) } else { Constant(0) });
    }
    if let Some(known) = builder.known(low) {
        let above = builder.constant(above, builder.width(high));
        return Some(if known == below { As(Op::Equal(high, above)) } else { Constant(0) });
    }
    let alike = above == 0 && below == 0 || above == 1 && below == split.mask();
    if builder.width(high) != Width::ONE || !alike {
        return None;
    }
    let rest = builder.constant(below, split);
    let rest = builder.make(Op::Equal(low, rest), Width::ONE);
    if above == 1 {
        return Some(As(Op::And(high, rest)));
    }
    let any = builder.make(Op::Not(rest), Width::ONE);
    let any = builder.make(Op::Or(high, any), Width::ONE);
    Some(As(Op::Not(any)))
}
