//! Extremes of records: values of several lanes, one record after another.

use fearless_simd::{Level, dispatch};

/// Least, greatest, the bits that were 1 in any and in all values of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Found<T> {
    pub(super) least: T,
    pub(super) greatest: T,
    pub(super) any: T,
    pub(super) all: T,
}

impl<T: Lane> Found<T> {
    const NONE: Found<T> = Found { least: T::GREATEST, greatest: T::LEAST, any: T::ZERO, all: T::ONES };

    fn and(self, other: Found<T>) -> Found<T> {
        Found {
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
            any: self.any | other.any,
            all: self.all & other.all,
        }
    }
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

/// Values of a vector, or several.
const SPAN: usize = 8;

/// What each lane of records came to, with the bits of `turned` inverted in every value. A record has `turned.len()`
/// lanes: a power of two up to 8, or a multiple of 8.
pub(super) fn scan<T: Lane>(level: Level, records: &[T], turned: &[T], found: &mut Vec<Found<T>>) {
    found.clear();
    if turned.is_empty() {
        return;
    }
    for first in (0..turned.len()).step_by(SPAN) {
        let mut by = [T::ZERO; SPAN];
        for (lane, by) in by.iter_mut().enumerate() {
            *by = turned[(first + lane) % turned.len()];
        }
        let [least, greatest, any, all] = dispatch!(level, _simd => group(records, first, turned.len().max(SPAN), by));
        let sums: [Found<T>; SPAN] = std::array::from_fn(|lane| Found {
            least: least[lane],
            greatest: greatest[lane],
            any: any[lane],
            all: all[lane],
        });
        let lanes = turned.len().min(SPAN);
        let of = |lane: usize| sums[lane..].iter().step_by(lanes).fold(Found::NONE, |sum, other| sum.and(*other));
        found.extend((0..lanes).map(of));
    }
}

/// Eight values from `first` on of each `stride` values: least, greatest, or, and. Returned as arrays, which compilers
/// keep in vectors.
#[inline(always)]
fn group<T: Lane>(records: &[T], first: usize, stride: usize, turned: [T; SPAN]) -> [[T; SPAN]; 4] {
    let (mut least, mut greatest) = ([T::GREATEST; SPAN], [T::LEAST; SPAN]);
    let (mut any, mut all) = ([T::ZERO; SPAN], [T::ONES; SPAN]);
    for record in records.chunks_exact(stride) {
        let (values, _) = record[first..].as_chunks::<SPAN>();
        let Some(values) = values.first() else { continue };
        for lane in 0..SPAN {
            let value = values[lane].turned(turned[lane]);
            least[lane] = least[lane].min(value);
            greatest[lane] = greatest[lane].max(value);
            any[lane] = any[lane] | value;
            all[lane] = all[lane] & value;
        }
    }
    [least, greatest, any, all]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every number of lanes, and values on all sides, against one lane after another.
    #[test]
    fn each_lane_has_its_own_extremes() {
        let mut seed = 1u64;
        for lanes in [1, 2, 4, 8, 16, 24] {
            let values: Vec<u32> = (0..lanes * 64)
                .map(|_| {
                    seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    u32::try_from(seed >> 40).unwrap() << (seed & 8)
                })
                .collect();
            let turned: Vec<u32> = (0..lanes).map(|lane| if lane % 3 == 0 { 1 << 31 } else { 0 }).collect();
            let mut found = Vec::new();
            scan(Level::new(), &values, &turned, &mut found);
            assert_eq!(found.len(), lanes);
            let signed: Vec<i64> = values.iter().map(|&value| i64::from(value) - (1 << 30)).collect();
            let mut signed_found = Vec::new();
            scan(Level::new(), &signed, &vec![0; lanes], &mut signed_found);
            for lane in 0..lanes {
                let of = || values[lane..].iter().step_by(lanes).map(|value| value ^ turned[lane]);
                let expected = Found {
                    least: of().min().unwrap(),
                    greatest: of().max().unwrap(),
                    any: of().reduce(|a, b| a | b).unwrap(),
                    all: of().reduce(|a, b| a & b).unwrap(),
                };
                assert_eq!(found[lane], expected, "lane {lane} of {lanes}");
                let of = || signed[lane..].iter().step_by(lanes);
                let ends = (*of().min().unwrap(), *of().max().unwrap());
                assert_eq!((signed_found[lane].least, signed_found[lane].greatest), ends, "lane {lane} of {lanes}");
            }
        }
    }
}
