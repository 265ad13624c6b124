//! Which nets change in which samples: what the writers of waves walk along.
//!
//! Samples are looked at 64 at a time. A column gives a word with a bit for each sample.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, u64x4};

use stepwave_netlist::Rows;

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

    /// Takes the next samples, at most [`SPAN`], to be asked for changes [net by net](Self::net).
    pub(super) fn scan_nets(&mut self, rows: &Rows, range: Range<usize>) {
        let Moves { level, columns, last, groups } = self;
        dispatch!(*level, simd => scan(simd, groups, columns.iter().zip(last), rows, range));
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
}

/// Takes some samples of every net, by its column; with it is the value in the sample before, and then in the last.
#[inline(always)]
fn scan<'n, S: Simd>(
    simd: S,
    groups: &mut [[u64; SPAN]],
    nets: impl Iterator<Item = (&'n usize, &'n mut u64)>,
    rows: &Rows,
    range: Range<usize>,
) {
    groups.as_flattened_mut().fill(0);
    for (bits, (&column, before)) in groups.as_flattened_mut().iter_mut().zip(nets) {
        if let Some(value) = rows.still(column) {
            *bits = u64::from(value != *before);
            *before = value;
            continue;
        }
        let values = &rows.column(column)[range.clone()];
        *bits = match values.first_chunk() {
            Some(values) => changes(simd, values, *before),
            None => few_changes(values, *before),
        };
        *before = values.last().copied().unwrap_or(*before);
    }
}

/// A bit for each value that is not the one before it, the first the lowest.
#[inline(always)]
fn changes<S: Simd>(simd: S, values: &[u64; SPAN], before: u64) -> u64 {
    let rests = |now: &[u64], earlier: &[u64]| {
        u64x4::from_slice(simd, now).simd_eq(u64x4::from_slice(simd, earlier)).to_bitmask()
    };
    let mut resting = rests(&values[..4], &[before, values[0], values[1], values[2]]);
    for first in (4..SPAN).step_by(4) {
        resting |= rests(&values[first..first + 4], &values[first - 1..first + 3]) << first;
    }
    !resting
}

/// The same of fewer values.
fn few_changes(values: &[u64], before: u64) -> u64 {
    let earlier = [before].into_iter().chain(values.iter().copied());
    let changed = values.iter().zip(earlier).map(|(&now, earlier)| u64::from(now != earlier));
    changed.enumerate().fold(0, |bits, (index, changed)| bits | changed << index)
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
            let mut moves = Moves::new((0..nets).collect());
            let mut before: Vec<u64> = (0..nets).map(|net| net as u64 % 3).collect();
            moves.last.clone_from(&before);
            for len in [64, 1, 17, 64, 63] {
                let columns: Vec<Vec<u64>> = (0..nets).map(|net| values(net + len, len)).collect();
                let expected: Vec<Vec<usize>> = (0..len)
                    .map(|sample| {
                        let earlier = |net: usize| if sample == 0 { before[net] } else { columns[net][sample - 1] };
                        (0..nets).filter(|&net| columns[net][sample] != earlier(net)).collect()
                    })
                    .collect();
                // Not the first rows of their block.
                let mut rows = Rows::new(nets, 3 + len);
                (0..3).for_each(|clock| rows.push(clock, |_| 9));
                (0..len).for_each(|sample| rows.push(3 + sample as u64, |net| columns[net][sample]));
                moves.scan_nets(&rows, 3..3 + len);
                let changes = |sample, &net: &usize| moves.net(net) >> sample & 1 == 1;
                let found: Vec<Vec<usize>> =
                    (0..len).map(|sample| (0..nets).filter(|net| changes(sample, net)).collect()).collect();
                assert_eq!(found, expected, "{nets} nets, {len} samples");
                assert!((0..nets).all(|net| moves.last(net) == columns[net][len - 1]));
                before = moves.last.clone();
            }
        }
    }

    #[test]
    fn a_column_that_rests_changes_in_its_first_sample_or_in_none() {
        let mut moves = Moves::new(vec![0]);
        let mut rows = Rows::new(1, SPAN);
        for (value, expected) in [(0, 0), (5, 1), (5, 0), (0, 1)] {
            rows.clear();
            _ = rows.spare(&[0]);
            rows.fill(0, SPAN as u64, value);
            rows.grow(0, SPAN as u64);
            assert_eq!(rows.still(0), Some(value));
            moves.scan_nets(&rows, 0..SPAN);
            assert_eq!((moves.net(0), moves.last(0)), (expected, value));
        }
    }
}
