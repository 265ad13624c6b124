//! Which nets change in which samples: what the writers of waves walk along.
//!
//! Samples are looked at 64 at a time. A column gives a word with a bit for each sample; turned over, these are words
//! with a bit for each net, one a sample.

use std::ops::Range;

use fearless_simd::{Level, dispatch};

use stepwave_netlist::{Rows, packed};

/// Samples looked at together.
pub(super) const SPAN: usize = 64;

/// Some nets, and their changes in up to [`SPAN`] samples.
pub(super) struct Moves {
    level: Level,
    /// Columns of the nets.
    columns: Vec<usize>,
    /// Values in the sample looked at last.
    last: Vec<u64>,
    /// Bits of 64 nets each, sample by sample.
    groups: Vec<[u64; SPAN]>,
}

impl Moves {
    /// Of the nets in these columns.
    pub(super) fn new(columns: Vec<usize>) -> Moves {
        let groups = vec![[0; SPAN]; columns.len().div_ceil(SPAN)];
        Moves { level: Level::new(), last: vec![0; columns.len()], columns, groups }
    }

    /// Takes the first sample: changes are relative to it.
    pub(super) fn start(&mut self, rows: &Rows, row: usize) {
        for (last, &column) in self.last.iter_mut().zip(&self.columns) {
            *last = rows.value(column, row);
        }
    }

    /// Takes the next samples, at most [`SPAN`], to be asked for [bits](Self::bits).
    pub(super) fn scan(&mut self, rows: &Rows, range: Range<usize>) {
        self.scan_nets(rows, range);
        dispatch!(self.level, _simd => self.groups.iter_mut().for_each(turn_over));
    }

    /// Takes the next samples, at most [`SPAN`], to be asked for changes [net by net](Self::net).
    pub(super) fn scan_nets(&mut self, rows: &Rows, range: Range<usize>) {
        let nets = self.columns.iter().map(|&column| &rows.column(column)[range.clone()]).zip(&mut self.last);
        dispatch!(self.level, _simd => scan(&mut self.groups, nets));
    }

    /// The samples in which a net changes: a bit each, the first the lowest.
    #[inline]
    pub(super) fn net(&self, net: usize) -> u64 {
        self.groups.as_flattened()[net]
    }

    /// The samples in which some net changes, after [`scan_nets`](Self::scan_nets).
    pub(super) fn any(&self) -> u64 {
        self.groups.as_flattened().iter().fold(0, |any, changes| any | changes)
    }

    /// The value of a net in the sample looked at last.
    pub(super) fn last(&self, net: usize) -> u64 {
        self.last[net]
    }

    /// The nets of a group that change in a sample: a bit each, the first the lowest. Group `g` begins with net
    /// `g * SPAN`.
    #[inline]
    pub(super) fn bits(&self, group: usize, sample: usize) -> u64 {
        self.groups[group][sample % SPAN]
    }
}

/// Takes the samples of every net, in order, equally many of each; `before` gives and takes the value of a net before
/// them.
#[inline(always)]
fn scan<'r>(groups: &mut [[u64; SPAN]], nets: impl Iterator<Item = (&'r [u64], &'r mut u64)>) {
    groups.as_flattened_mut().fill(0);
    for (index, (values, before)) in nets.enumerate() {
        groups[index / SPAN][index % SPAN] = changes(values, *before);
        *before = values.last().copied().unwrap_or(*before);
    }
}

/// A bit for each value that is not the one before it, the first the lowest.
#[inline(always)]
fn changes(values: &[u64], before: u64) -> u64 {
    // Most nets rest most of the time.
    if values.iter().fold(0, |seen, value| seen | (value ^ before)) == 0 {
        return 0;
    }
    let mut flags = [0_u8; SPAN];
    flags[0] = u8::from(values[0] != before);
    for ((flag, before), value) in flags[1..].iter_mut().zip(values).zip(&values[1..]) {
        *flag = u8::from(value != before);
    }
    packed(&flags)
}

/// Turns rows into columns: bit `b` of word `w` becomes bit `w` of word `b`.
#[inline(always)]
fn turn_over(words: &mut [u64; SPAN]) {
    let mut half = SPAN / 2;
    // The low half of every group of 2 * half bits.
    let mut mask = u64::MAX >> half;
    while half > 0 {
        for low in (0..SPAN).filter(|word| word & half == 0) {
            let swapped = (words[low] >> half ^ words[low + half]) & mask;
            words[low] ^= swapped << half;
            words[low + half] ^= swapped;
        }
        half /= 2;
        mask ^= mask << half;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sequence of values with pauses and repetitions.
    fn values(net: usize, len: usize) -> Vec<u64> {
        let mut state = net as u64 + 1;
        let step = |_| {
            state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
            if net % 5 == 3 { 7 } else { state >> 60 & (net as u64 % 4) }
        };
        (0..len).map(step).collect()
    }

    #[test]
    fn every_change_of_every_net_is_found_in_its_sample() {
        for nets in [1, 2, 63, 64, 65, 200] {
            let mut moves = Moves::new(vec![0; nets]);
            let mut before: Vec<u64> = (0..nets).map(|net| net as u64 % 3).collect();
            for len in [64, 1, 17, 64, 63] {
                let columns: Vec<Vec<u64>> = (0..nets).map(|net| values(net + len, len)).collect();
                let expected: Vec<Vec<usize>> = (0..len)
                    .map(|sample| {
                        let earlier = |net: usize| if sample == 0 { before[net] } else { columns[net][sample - 1] };
                        (0..nets).filter(|&net| columns[net][sample] != earlier(net)).collect()
                    })
                    .collect();
                scan(&mut moves.groups, columns.iter().map(Vec::as_slice).zip(&mut before));
                let by_net = moves.groups.clone();
                moves.groups.iter_mut().for_each(turn_over);
                let changes = |sample, &net: &usize| moves.bits(net / SPAN, sample) >> (net % SPAN) & 1 == 1;
                let found: Vec<Vec<usize>> =
                    (0..len).map(|sample| (0..nets).filter(|net| changes(sample, net)).collect()).collect();
                assert_eq!(found, expected, "{nets} nets, {len} samples");
                let changes = |sample, &net: &usize| by_net.as_flattened()[net] >> sample & 1 == 1;
                let found: Vec<Vec<usize>> =
                    (0..len).map(|sample| (0..nets).filter(|net| changes(sample, net)).collect()).collect();
                assert_eq!(found, expected, "{nets} nets, {len} samples, net by net");
                assert!((0..nets).all(|net| before[net] == columns[net][len - 1]));
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
}
