//! What lanes of values come to: extremes, the extremes of a form, the samples in which one changes. Loops that compilers
//! make vectors of.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, u32x16};

/// Least, greatest, the bits that were 1 in any and in all values of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Found<T> {
    pub(super) least: T,
    pub(super) greatest: T,
    pub(super) any: T,
    pub(super) all: T,
}

/// A number that lanes hold.
pub(super) trait Lane: Copy + Ord + std::ops::BitOr<Output = Self> + std::ops::BitAnd<Output = Self> {
    const LEAST: Self;
    const GREATEST: Self;
    const ZERO: Self;
    const ONES: Self;
    fn turned(self, by: Self) -> Self;
}

impl Lane for u32 {
    const LEAST: u32 = 0;
    const GREATEST: u32 = u32::MAX;
    const ZERO: u32 = 0;
    const ONES: u32 = u32::MAX;

    #[inline(always)]
    fn turned(self, by: u32) -> u32 {
        self ^ by
    }
}

/// Signed, as vector units compare them.
impl Lane for i64 {
    const LEAST: i64 = i64::MIN;
    const GREATEST: i64 = i64::MAX;
    const ZERO: i64 = 0;
    const ONES: i64 = -1;

    #[inline(always)]
    fn turned(self, by: i64) -> i64 {
        self ^ by
    }
}

/// What the values of a lane come to, with the bits of `turned` inverted in each.
pub(super) fn extremes<T: Lane>(level: Level, values: &[T], turned: T) -> Found<T> {
    dispatch!(level, _simd => found(values, turned))
}

#[inline(always)]
fn found<T: Lane>(values: &[T], turned: T) -> Found<T> {
    let none = Found { least: T::GREATEST, greatest: T::LEAST, any: T::ZERO, all: T::ONES };
    values.iter().map(|value| value.turned(turned)).fold(none, |found, value| Found {
        least: found.least.min(value),
        greatest: found.greatest.max(value),
        any: found.any | value,
        all: found.all & value,
    })
}

/// A term of a form: the values of its net, of this many bits in two's complement, and the factors of the number and of
/// its square.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operand<'a> {
    pub(super) values: &'a [u32],
    pub(super) bits: u32,
    pub(super) linear: i32,
    pub(super) squared: bool,
}

/// The least and the greatest sum of two terms, which stays within ±2^62.
pub(super) fn form(level: Level, terms: [Operand<'_>; 2]) -> [i64; 2] {
    match terms.map(|term| (term.linear != 0, term.squared)) {
        [(_, false), (_, false)] => dispatch!(level, _simd => sums::<true, false>(terms)),
        [(false, true), (false, true)] => dispatch!(level, _simd => sums::<false, true>(terms)),
        _ => dispatch!(level, _simd => sums::<true, true>(terms)),
    }
}

/// The ends of the sum. Where no term has a linear factor, or a square, that need not be computed.
#[inline(always)]
fn sums<const LINEAR: bool, const SQUARE: bool>([a, b]: [Operand<'_>; 2]) -> [i64; 2] {
    let number = |value: u32, of: Operand<'_>| ((value << (32 - of.bits)).cast_signed()) >> (32 - of.bits);
    let term = |value: u32, of: Operand<'_>, squared: i32| {
        let number = number(value, of);
        let linear = if LINEAR { i64::from(number) * i64::from(of.linear) } else { 0 };
        let square = if SQUARE { i64::from(number) * i64::from(number & squared) } else { 0 };
        linear.wrapping_add(square)
    };
    let squared = |of: Operand<'_>| if of.squared { -1 } else { 0 };
    let masks = [squared(a), squared(b)];
    let sums = a.values.iter().zip(b.values);
    let sums = sums.map(|(x, y)| term(*x, a, masks[0]).wrapping_add(term(*y, b, masks[1])));
    let (least, greatest) =
        sums.fold((i64::MAX, i64::MIN), |(least, greatest), sum| (least.min(sum), greatest.max(sum)));
    [least, greatest]
}

/// Every `step`th word with its highest bit the lowest, moved down by `unused` bits.
pub(super) fn turned_over(level: Level, words: &[u64], step: usize, unused: usize, out: &mut [u64]) {
    dispatch!(level, _simd => {
        for (out, word) in out.iter_mut().zip(words.iter().step_by(step)) {
            *out = word.reverse_bits() >> unused;
        }
    });
}

/// A bit for each of 64 values, the first the lowest: 1 where it is another than the one before, the first of which follows
/// `before`.
pub(super) fn changes(level: Level, values: &[u32; 64], before: u32) -> u64 {
    dispatch!(level, simd => changed(simd, values, before))
}

#[inline(always)]
fn changed<S: Simd>(simd: S, values: &[u32; 64], before: u32) -> u64 {
    let rests = |now: &[u32], earlier: &[u32]| {
        u32x16::from_slice(simd, now).simd_eq(u32x16::from_slice(simd, earlier)).to_bitmask()
    };
    let mut earlier = [before; 16];
    earlier[1..].copy_from_slice(&values[..15]);
    let mut resting = rests(&values[..16], &earlier);
    // Functions of the standard library that take closures would be compiled without vector instructions.
    for first in [16, 32, 48] {
        resting |= rests(&values[first..first + 16], &values[first - 1..first + 15]) << first;
    }
    !resting
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(count: usize) -> Vec<u32> {
        let mut seed = 1u64;
        let next = |_| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            u32::try_from(seed >> 40).unwrap() << (seed & 8)
        };
        (0..count).map(next).collect()
    }

    #[test]
    fn extremes_are_those_of_all_values() {
        let values = values(320);
        for turned in [0, 1 << 31] {
            let of = || values.iter().map(|value| value ^ turned);
            let expected = Found {
                least: of().min().unwrap(),
                greatest: of().max().unwrap(),
                any: of().reduce(|a, b| a | b).unwrap(),
                all: of().reduce(|a, b| a & b).unwrap(),
            };
            assert_eq!(extremes(Level::new(), &values, turned), expected);
        }
        let signed: Vec<i64> = values.iter().map(|&value| i64::from(value) - (1 << 30)).collect();
        let found = extremes(Level::new(), &signed, 0);
        assert_eq!(
            (Some(found.least), Some(found.greatest)),
            (signed.iter().copied().min(), signed.iter().copied().max())
        );
    }

    #[test]
    fn forms_are_evaluated_with_and_without_squares() {
        let values = values(128);
        let (x, y): (Vec<u32>, Vec<u32>) = values.chunks(2).map(|pair| (pair[0] >> 3, pair[1] >> 9)).unzip();
        for (linear, squared) in
            [([5, -7], [false; 2]), ([0, 0], [true; 2]), ([3, 0], [true, false]), ([-1, 9], [true; 2])]
        {
            let terms = [(&x, 29, 0), (&y, 23, 1)].map(|(values, bits, index)| Operand {
                values,
                bits,
                linear: linear[index],
                squared: squared[index],
            });
            let number = |value: u32, bits: u32| i64::from((value << (32 - bits)).cast_signed() >> (32 - bits));
            let sum = |(x, y): (&u32, &u32)| {
                let each = [(number(*x, 29), 0), (number(*y, 23), 1)];
                let term = |(number, index): (i64, usize)| {
                    i64::from(linear[index]) * number + if squared[index] { number * number } else { 0 }
                };
                each.into_iter().map(term).sum::<i64>()
            };
            let all: Vec<i64> = x.iter().zip(&y).map(sum).collect();
            let expected = [*all.iter().min().unwrap(), *all.iter().max().unwrap()];
            assert_eq!(form(Level::new(), terms), expected, "{linear:?} {squared:?}");
        }
    }

    #[test]
    fn every_value_that_is_another_than_the_one_before_has_its_bit() {
        let values: [u32; 64] = std::array::from_fn(|index| u32::try_from(index * index / 100).unwrap());
        for before in [0, 1] {
            let bits = changes(Level::new(), &values, before);
            for (index, value) in values.iter().enumerate() {
                let earlier = index.checked_sub(1).map_or(before, |earlier| values[earlier]);
                assert_eq!(bits >> index & 1 == 1, *value != earlier, "value {index}");
            }
        }
    }
}
