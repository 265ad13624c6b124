//! Numbers of more bits than a signal has.

use stepwave_netlist::dsl::{Scope, Signal};

/// Most bits of a word of a number that has several: the product of two fits in a signal.
const HALF: u32 = 32;
/// Most bits of a number that is one word.
const WHOLE: u32 = 64;

/// How numbers of one calculation are made of words, so that they have the bits of the greatest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wide<'m> {
    m: Scope<'m>,
    /// Bits of a word.
    word: u32,
    words: u32,
}

/// An unsigned number: its words, the lowest first.
type Number<'m> = Vec<Signal<'m>>;

impl<'m> Wide<'m> {
    /// Numbers of `bits` bits at most: one word, or as many of 32 bits as it takes.
    #[must_use]
    pub(super) fn new(m: Scope<'m>, bits: u32) -> Wide<'m> {
        let word = if bits > WHOLE { HALF } else { bits.max(1) };
        Wide { m, word, words: bits.max(1).div_ceil(word) }
    }

    /// An unsigned signal, times 2^`shift`.
    #[must_use]
    pub(super) fn shifted(&self, signal: Signal<'m>, shift: u32) -> Number<'m> {
        let part = |word: u32| {
            let from = word * self.word;
            let [low, high] = [shift.max(from), (shift + signal.bits()).min(from + self.word)];
            if low >= high {
                return self.m.lit(self.word, 0);
            }
            let part = signal.as_unsigned().slice(low - shift, high - low);
            let part = if low > from { part.concat(self.m.lit(low - from, 0)) } else { part };
            part.extend(self.word)
        };
        (0..self.words).map(part).collect()
    }

    /// An unsigned signal.
    #[must_use]
    pub(super) fn of(&self, signal: Signal<'m>) -> Number<'m> {
        self.shifted(signal, 0)
    }

    /// `bits` bits of a number from bit `low` upwards.
    #[must_use]
    pub(super) fn slice(&self, number: &[Signal<'m>], low: u32, bits: u32) -> Signal<'m> {
        let part = |(index, &word): (u32, &Signal<'m>)| {
            let from = index * self.word;
            let [first, end] = [low.max(from), (low + bits).min(from + self.word)];
            (first < end).then(|| word.slice(first - from, end - first))
        };
        let parts = (0..).zip(number).filter_map(part);
        parts.reduce(|below, part| part.concat(below)).unwrap_or_else(|| self.m.lit(bits, 0))
    }

    /// The sum, which must have the bits of these numbers.
    #[must_use]
    pub(super) fn sum(&self, a: &[Signal<'m>], b: &[Signal<'m>]) -> Number<'m> {
        let mut carry: Option<Signal<'m>> = None;
        let add = |(&a, &b): (&Signal<'m>, &Signal<'m>)| {
            let (over, sum) = a.carrying_add(b);
            let Some(before) = carry.replace(over) else { return sum };
            let (again, sum) = sum.carrying_add(before.extend(self.word));
            carry = Some(over | again);
            sum
        };
        a.iter().zip(b).map(add).collect()
    }

    /// The difference, which must not be negative.
    #[must_use]
    pub(super) fn difference(&self, a: &[Signal<'m>], b: &[Signal<'m>]) -> Number<'m> {
        let mut borrow: Option<Signal<'m>> = None;
        let subtract = |(&a, &b): (&Signal<'m>, &Signal<'m>)| {
            let (under, difference) = a.borrowing_sub(b);
            let Some(before) = borrow.replace(under) else { return difference };
            let (again, difference) = difference.borrowing_sub(before.extend(self.word));
            borrow = Some(under | again);
            difference
        };
        a.iter().zip(b).map(subtract).collect()
    }

    /// The product of two unsigned signals, the first of which may be a number of several words.
    #[must_use]
    pub(super) fn product(&self, a: &[Signal<'m>], b: Signal<'m>) -> Number<'m> {
        if let &[a] = a {
            return vec![a.wrapping_mul(b.as_unsigned().extend(self.word))];
        }
        let b_words = b.bits().div_ceil(self.word);
        let b = self.of(b);
        let mut product = self.of(self.m.lit(1, 0));
        for (j, &b) in (0..b_words).zip(&b) {
            for (place, &a) in (j..self.words).zip(a) {
                let part = a.extend(2 * HALF).wrapping_mul(b.extend(2 * HALF));
                product = self.sum(&product, &self.shifted(part, place * self.word));
            }
        }
        product
    }

    /// 1 bit: a <= b.
    #[must_use]
    pub(super) fn at_most(&self, a: &[Signal<'m>], b: &[Signal<'m>]) -> Signal<'m> {
        let mut over = self.m.lit(1, 0);
        for (&a, &b) in a.iter().zip(b) {
            over = b.less_than(a) | a.equals(b) & over;
        }
        !over
    }
}
