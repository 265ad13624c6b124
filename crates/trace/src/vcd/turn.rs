//! Squares of bits, turned over: a word for each net, and a word for each sample.

use crate::moves::SPAN;

/// Bits of 64 nets each, a word for each net: a word for each sample then.
#[inline(always)]
pub(super) fn turn_over_all(groups: &mut [[u64; SPAN]]) {
    for words in groups {
        turn_over(words);
    }
}

/// Turns rows into columns: bit `b` of word `w` becomes bit `w` of word `b`.
#[inline(always)]
fn turn_over(words: &mut [u64; SPAN]) {
    swap_halves::<32>(words);
    swap_halves::<16>(words);
    swap_halves::<8>(words);
    swap_halves::<4>(words);
    swap_halves::<2>(words);
    swap_halves::<1>(words);
}

/// In squares of `2 * HALF` words and bits: the high bits of the first words change places with the low bits of the others.
#[inline(always)]
fn swap_halves<const HALF: usize>(words: &mut [u64; SPAN]) {
    // The low half of every group of 2 * HALF bits.
    let mask = u64::MAX / ((1 << HALF) + 1);
    for square in words.chunks_exact_mut(2 * HALF) {
        let (first, others) = square.split_at_mut(HALF);
        for (low, high) in first.iter_mut().zip(others) {
            let swapped = (*low >> HALF ^ *high) & mask;
            *low ^= swapped << HALF;
            *high ^= swapped;
        }
    }
}

#[test]
fn turning_over_twice_changes_nothing() {
    let words: [u64; SPAN] = std::array::from_fn(|word| (word as u64 + 3).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let mut turned = words;
    turn_over(&mut turned);
    for (word, bit) in (0..SPAN).flat_map(|word| (0..SPAN).map(move |bit| (word, bit))) {
        assert_eq!(words[word] >> bit & 1, turned[bit] >> word & 1);
    }
    turn_over(&mut turned);
    assert_eq!(words, turned);
}
