//! Steps of two axes that pulse evenly: then 32 of them hold one of two neighbouring numbers of pulses of an axis, and
//! there are four squares at most, however many steps.

use super::kernel::{Bits, STEPS, WORDS};
use super::windows::WINDOW;

/// Numbers of pulses in 32 steps, and what was seen with them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Even {
    /// The less of the two numbers of each axis.
    base: [u32; 2],
    /// A bit for each pair of numbers that was handed on: 1 for the greater number of the first axis, 2 of the second.
    seen: u8,
}

impl Even {
    /// Looks at the window that ends with each of the first `steps` new steps. Hands on the square in BLU² of every pair of
    /// numbers that is new, and the first step with it, in the order of these steps; false where an axis has other
    /// numbers, and not all was handed on.
    #[inline(always)]
    pub(super) fn look(&mut self, [x, y]: [&Bits; 2], steps: usize, mut found: impl FnMut(u32, usize)) -> bool {
        if steps == STEPS && self.is_known([x, y]) {
            return true;
        }
        let mut counts = [x, y].map(|bits| (bits[0] >> WINDOW).count_ones());
        for first in (0..steps).step_by(64) {
            let (word, valid) = (first / 64, u64::MAX >> (64 - (steps - first).min(64)));
            let mut more = [0; 2];
            for (axis, bits) in [x, y].into_iter().enumerate() {
                let [before, now] = [bits[word], bits[word + 1]];
                let Some(greater) = self.greater(axis, counts[axis], [now, now << WINDOW | before >> WINDOW], valid)
                else {
                    return false;
                };
                counts[axis] = self.base[axis] + u32::from(greater & (valid ^ valid >> 1) != 0);
                more[axis] = greater;
            }
            let [x, y] = more;
            let pairs = [!x & !y & valid, x & !y & valid, !x & y & valid, x & y & valid];
            let seen = (0..4).fold(0, |seen, pair| seen | u8::from(pairs[pair] != 0) << pair);
            if seen & !self.seen != 0 {
                self.hand_on(pairs, seen & !self.seen, first, &mut found);
            }
        }
        true
    }

    /// All windows have numbers as before, and every pair of them was handed on.
    #[inline(always)]
    fn is_known(&self, axes: [&Bits; 2]) -> bool {
        let (mut greater, mut wrong) = ([[0; WORDS]; 2], 0);
        for ((bits, base), greater) in axes.into_iter().zip(self.base).zip(&mut greater) {
            let (mut changed, mut odd) = ([0; WORDS], [0; WORDS]);
            for word in 0..WORDS {
                changed[word] = bits[word + 1] ^ (bits[word + 1] << WINDOW | bits[word] >> WINDOW);
                odd[word] = changed[word];
            }
            for shift in [1, 2, 4, 8, 16, 32] {
                for odd in &mut odd {
                    *odd ^= *odd << shift;
                }
            }
            let mut more = u64::from((bits[0] >> WINDOW).count_ones().wrapping_sub(base));
            if more > 1 {
                return false;
            }
            for word in 0..WORDS {
                greater[word] = odd[word] ^ more.wrapping_neg();
                more ^= odd[word] >> 63;
            }
            for word in 0..WORDS {
                wrong |= changed[word] & (greater[word] ^ bits[word + 1]);
            }
        }
        let [x, y] = greater;
        let mut pairs = [0; 4];
        for word in 0..WORDS {
            let (x, y) = (x[word], y[word]);
            let each = [!x & !y, x & !y, !x & y, x & y];
            (0..4).for_each(|pair| pairs[pair] |= each[pair]);
        }
        let seen = (0..4).fold(0, |seen, pair| seen | u8::from(pairs[pair] != 0) << pair);
        wrong == 0 && seen & !self.seen == 0
    }

    /// A bit for each step whose window has the greater number; `None` where one has neither. `came` and `went` are the
    /// pulses that a window gains and loses with each step, `count` those in the window before.
    #[inline(always)]
    fn greater(&mut self, axis: usize, count: u32, [came, went]: [u64; 2], valid: u64) -> Option<u64> {
        let changed = (came ^ went) & valid;
        let mut odd = changed;
        for shift in [1, 2, 4, 8, 16, 32] {
            odd ^= odd << shift;
        }
        // The number goes up and down in turns.
        let fits = |base: u32| {
            match count.wrapping_sub(base) {
                0 => Some(odd),
                1 => Some(!odd),
                _ => None,
            }
            .filter(|greater| changed & greater == changed & came)
        };
        let base = self.base[axis];
        if let Some(greater) = fits(base) {
            return Some(greater);
        }
        let base = [count, count.wrapping_sub(1)].into_iter().find(|&base| fits(base).is_some())?;
        (self.base[axis], self.seen) = (base, 0);
        fits(base)
    }

    #[cold]
    fn hand_on(&mut self, pairs: [u64; 4], new: u8, first: usize, found: &mut impl FnMut(u32, usize)) {
        let mut order = [0, 1, 2, 3];
        order.sort_unstable_by_key(|&pair: &usize| pairs[pair].trailing_zeros());
        for pair in order.into_iter().filter(|pair| new >> pair & 1 == 1) {
            let [x, y] = [0, 1].map(|axis| self.base[axis] + u32::from(pair >> axis & 1 == 1));
            found(x * x + y * y, first + pairs[pair].trailing_zeros() as usize);
        }
        self.seen |= new;
    }
}
