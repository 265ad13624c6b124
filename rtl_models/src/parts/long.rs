//! Unsigned numbers of more bits than a net has: nets of 64 bits, and one above them.

use stepwave_netlist::cells::NamedNet;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::microprogram::Write;

/// Bits of every part but the highest.
const PART: u32 = NamedNet::PART;
/// Most parts.
const PARTS: usize = 3;
/// The widest number, in bits.
pub(crate) const MOST_BITS: u32 = PART * 3;

/// An unsigned number of up to 192 bits. One of up to 64 is a net as any other, and every operation one cell.
#[derive(Clone, Copy, Debug)]
pub struct Long<'m> {
    /// The lowest first; what is beyond the count repeats the first.
    parts: [Signal<'m>; PARTS],
    count: usize,
}

impl<'m> From<Signal<'m>> for Long<'m> {
    fn from(signal: Signal<'m>) -> Long<'m> {
        Long { parts: [signal; PARTS], count: 1 }
    }
}

/// Bits of each part of a number of this many.
fn layout(bits: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..bits.max(1)).step_by(PART as usize).map(move |low| (low, (bits - low).min(PART)))
}

impl<'m> Long<'m> {
    fn of(parts: impl IntoIterator<Item = Signal<'m>>) -> Long<'m> {
        let parts: Vec<_> = parts.into_iter().take(PARTS).collect();
        let count = parts.len();
        Long { parts: std::array::from_fn(|index| parts[if index < count { index } else { 0 }]), count }
    }

    /// The constant 0.
    #[must_use]
    pub fn zero(m: Scope<'m>, bits: u32) -> Long<'m> {
        Long::of(layout(bits).map(|(_, bits)| m.lit(bits, 0)))
    }

    /// A constant.
    #[must_use]
    pub fn constant(m: Scope<'m>, bits: u32, value: u128) -> Long<'m> {
        // A part has 64 bits of it.
        #[allow(clippy::cast_possible_truncation)]
        let part = |(low, bits): (u32, u32)| {
            let value = if low < 128 { (value >> low) as u64 } else { 0 };
            m.lit(bits, value & (u64::MAX >> (PART - bits)))
        };
        Long::of(layout(bits).map(part))
    }

    fn all(&self) -> &[Signal<'m>] {
        &self.parts[..self.count]
    }

    /// The number as one net, of up to 64 bits; of more its lowest 64.
    #[must_use]
    pub fn net(&self) -> Signal<'m> {
        self.parts[0]
    }

    /// Number of bits.
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.all().iter().map(|part| part.bits()).sum()
    }

    /// One bit, 0 the least significant.
    #[must_use]
    pub fn bit(&self, index: u32) -> Signal<'m> {
        self.slice(index, 1).net()
    }

    /// `bits` bits from bit `low` upwards.
    #[must_use]
    pub fn slice(&self, low: u32, bits: u32) -> Long<'m> {
        if self.count == 1 {
            return self.net().slice(low, bits).into();
        }
        Long::of(layout(bits).map(|(from, bits)| {
            // From one part, or from two next to each other.
            let (index, skip) = (((low + from) / PART) as usize, (low + from) % PART);
            let here = self.parts[index];
            let own = bits.min(here.bits() - skip);
            let lower = here.slice(skip, own);
            if own == bits { lower } else { self.parts[index + 1].slice(0, bits - own).concat(lower) }
        }))
    }

    /// This above `low`.
    #[must_use]
    pub fn concat(&self, low: impl Into<Long<'m>>) -> Long<'m> {
        let low = low.into();
        let (below, bits) = (low.bits(), low.bits() + self.bits());
        if bits <= PART {
            return self.net().concat(low.net()).into();
        }
        Long::of(layout(bits).map(|(from, bits)| {
            let own = below.saturating_sub(from).min(bits);
            match (own, bits - own) {
                (own, 0) => low.slice(from, own).net(),
                (0, rest) => self.slice(from - below, rest).net(),
                (own, rest) => self.slice(0, rest).net().concat(low.slice(from, own).net()),
            }
        }))
    }

    /// The same number in `bits` bits, at least as wide.
    #[must_use]
    pub fn extend(&self, m: Scope<'m>, bits: u32) -> Long<'m> {
        if bits <= PART {
            return self.net().extend(bits).into();
        }
        let more = bits - self.bits();
        if more == 0 { *self } else { Long::zero(m, more).concat(*self) }
    }

    fn pairs(&self, rhs: &Long<'m>) -> Vec<(Signal<'m>, Signal<'m>)> {
        self.all().iter().copied().zip(rhs.all().iter().copied()).collect()
    }

    /// Of this select bit: 1 gives `high`, 0 gives `low`; both are equally wide.
    #[must_use]
    pub fn select(select: Signal<'m>, high: Long<'m>, low: Long<'m>) -> Long<'m> {
        Long::of(high.pairs(&low).into_iter().map(|(high, low)| select.mux(high, low)))
    }

    /// Carry (1 bit) and sum. Operands are equally wide.
    #[must_use]
    pub fn carrying_add(&self, rhs: Long<'m>) -> (Signal<'m>, Long<'m>) {
        self.chained(rhs, Signal::carrying_add)
    }

    /// Borrow (1 bit) and difference. Operands are equally wide.
    #[must_use]
    pub fn borrowing_sub(&self, rhs: Long<'m>) -> (Signal<'m>, Long<'m>) {
        self.chained(rhs, Signal::borrowing_sub)
    }

    /// An operation part by part, whose flag is passed to the next one.
    fn chained(
        &self,
        rhs: Long<'m>,
        operation: impl Fn(Signal<'m>, Signal<'m>) -> (Signal<'m>, Signal<'m>),
    ) -> (Signal<'m>, Long<'m>) {
        let (mut flag, first) = operation(self.net(), rhs.net());
        let mut parts = vec![first];
        for (a, b) in self.pairs(&rhs).into_iter().skip(1) {
            let (own, result) = operation(a, b);
            let (passed, result) = operation(result, flag.extend(a.bits()));
            flag = own | passed;
            parts.push(result);
        }
        (flag, Long::of(parts))
    }

    /// 1 (1 bit) where it is less.
    #[must_use]
    pub fn less_than(&self, rhs: Long<'m>) -> Signal<'m> {
        self.borrowing_sub(rhs).0
    }

    /// The number as it is, or 0 less the number, in two's complement, where `negative` (1 bit) is 1.
    #[must_use]
    pub fn negated_if(&self, m: Scope<'m>, negative: Signal<'m>) -> Long<'m> {
        let (_, negated) = Long::zero(m, self.bits()).borrowing_sub(*self);
        Long::select(negative, negated, *self)
    }
}

/// A register of up to 192 bits.
#[derive(Clone, Copy, Debug)]
#[must_use = "a register needs a next value"]
pub struct LongRegister<'m> {
    parts: [Register<'m>; PARTS],
    /// The value held since the last edge.
    pub q: Long<'m>,
}

impl<'m> LongRegister<'m> {
    /// The register of this name.
    pub fn new(m: Scope<'m>, name: &str, bits: u32) -> LongRegister<'m> {
        let parts = m.wide_reg(name, bits);
        let q = Long::of(parts.iter().map(|part| part.q));
        LongRegister { parts: std::array::from_fn(|index| parts[if index < q.count { index } else { 0 }]), q }
    }

    /// It takes the value of the first condition (1 bit each) that is 1, and else holds its own.
    pub fn close<const N: usize>(self, arms: [(Signal<'m>, Long<'m>); N]) {
        for index in 0..self.q.count {
            let [(condition, value), rest @ ..] = &arms[..] else { return };
            let chain = self.parts[index].when(*condition, value.parts[index]);
            let chain = rest.iter().fold(chain, |chain, (condition, value)| chain.when(*condition, value.parts[index]));
            chain.else_hold();
        }
    }

    /// The writes by which it takes a value as wide.
    #[must_use]
    pub fn takes(self, value: Long<'m>) -> Vec<Write<'m>> {
        (0..self.q.count).map(|index| (self.parts[index], value.parts[index])).collect()
    }
}
