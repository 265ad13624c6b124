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
        self.shifts.iter().fold((bits << 1) & self.any, |reached, &shift| reached | reached << (shift & 63))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_is_that_of_single_shifts() {
        for distance in (0..70).chain([u64::MAX]) {
            for bits in [0, 1, 1 << 63, 0x8000_0100_0020_0001, 0x1111_1111_1111_1111, u64::MAX] {
                let expected = (1..=distance.min(63)).fold(0, |reached, gap| reached | bits << gap);
                assert_eq!(Reach::up_to(distance).of(bits), expected, "{distance} {bits:x}");
            }
        }
    }
}
