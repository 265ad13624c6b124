//! Bits near others, for all bits of a word at once and without a branch.

/// Doublings that reach as far as a word is long.
const ROUNDS: usize = 6;

/// A distance, as shifts that add up to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// All ones, or 0 where the distance is 0.
    any: u64,
    shifts: [u8; ROUNDS],
}

impl Reach {
    /// Distances from 1 up to this one; those of 63 and more are the same in a word.
    pub(super) fn up_to(distance: u64) -> Reach {
        let distance = u8::try_from(distance.min(63)).unwrap_or(63);
        let (mut shifts, mut reached) = ([0; ROUNDS], 1);
        for shift in &mut shifts {
            *shift = u8::min(reached, distance.saturating_sub(reached));
            reached += *shift;
        }
        Reach { any: if distance == 0 { 0 } else { u64::MAX }, shifts }
    }

    /// The bits that lie so far above one that is set, but not those themselves unless another reaches them.
    #[inline(always)]
    pub(super) fn of(&self, bits: u64) -> u64 {
        self.after(0, bits)
    }

    /// The same, where the bits of another word lie right below those of this one.
    #[inline(always)]
    pub(super) fn after(&self, before: u64, bits: u64) -> u64 {
        let (mut low, mut high) = (before << 1 & self.any, (bits << 1 | before >> 63) & self.any);
        for shift in self.shifts {
            let shift = shift & 63;
            // What reached the other word from below it is too far away to reach this one.
            (low, high) = (low | low << shift, high | high << shift | low >> 1 >> (63 - shift));
        }
        high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_is_that_of_single_shifts() {
        const WORDS: [u64; 6] = [0, 1, 1 << 63, 0x8000_0100_0020_0001, 0x1111_1111_1111_1111, u64::MAX];
        for distance in (0..70).chain([u64::MAX]) {
            for (before, bits) in WORDS.into_iter().flat_map(|before| WORDS.map(|bits| (before, bits))) {
                let both = u128::from(bits) << 64 | u128::from(before);
                let expected = (1..=distance.min(63)).fold(0, |reached, gap| reached | both << gap) >> 64;
                let reach = Reach::up_to(distance);
                assert_eq!(u128::from(reach.after(before, bits)), expected, "{distance} {before:x} {bits:x}");
                assert!(before != 0 || u128::from(reach.of(bits)) == expected, "{distance} {bits:x}");
            }
        }
    }
}
