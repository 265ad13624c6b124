//! One machine word of a lane, and the arrays of them that an operation runs over.
//!
//! A value is at the *top* of its word, zeros below it: sums and differences wrap, carries and comparisons come out
//! right without a mask. A net of one bit fills its word instead: all ones or all zeros, so that it selects with `&`.

use stepwave_netlist::bits::Width;

/// Lanes in a group: the inner loops run over whole groups, so their length is known to the compiler.
pub(super) const GROUP: usize = 32;
/// Groups in a block.
pub(super) const GROUPS: usize = 8;
/// Lanes in a block. At 256 lanes a net takes 1 KiB (2 KiB in the wide form): a machine's working set stays in the
/// first-level cache, and the cost of choosing an operation is spread thin.
pub(super) const LANES: usize = GROUP * GROUPS;

/// A word of a lane: `u32` where every width is at most 32, else `u64`.
pub(crate) trait Lane: Copy + Default + PartialEq + PartialOrd + Send + Sync + 'static {
    /// Bits of the word.
    const BITS: u32;
    /// All bits.
    const ONES: Self;
    /// The top bits of a 64-bit pattern.
    fn top(pattern: u64) -> Self;
    /// The low bits of a number.
    fn number(number: u64) -> Self;
    /// The word as a number.
    fn get(self) -> u64;
    /// The nearest real number.
    fn real(self) -> f64;
    /// The nearest real number of the word in two's complement.
    fn real_signed(self) -> f64;
    fn add(self, rhs: Self) -> Self;
    fn sub(self, rhs: Self) -> Self;
    fn mul(self, rhs: Self) -> Self;
    /// Quotient; 0 where `rhs` is 0.
    fn div(self, rhs: Self) -> Self;
    /// Remainder; 0 where `rhs` is 0.
    fn rem(self, rhs: Self) -> Self;
    fn and(self, rhs: Self) -> Self;
    fn or(self, rhs: Self) -> Self;
    fn xor(self, rhs: Self) -> Self;
    fn not(self) -> Self;
    fn left(self, by: u32) -> Self;
    fn right(self, by: u32) -> Self;
    /// Shift right that repeats the top bit.
    fn right_signed(self, by: u32) -> Self;
    fn less_signed(self, rhs: Self) -> bool;
    /// All ones for true.
    fn mask(condition: bool) -> Self;

    /// The word that stands for a value of this width.
    fn encode(width: Width, value: u64) -> Self {
        Self::top(pattern(width, value))
    }

    /// The number of a value of `bits` bits, or `most` if that is less.
    #[inline(always)]
    fn amount(self, bits: u32, most: u32) -> u32 {
        let number = self.right(Self::BITS - bits).get();
        u32::try_from(number).map_or(most, |number| number.min(most))
    }

    /// The value of this width that the word stands for.
    fn decode(self, width: Width) -> u64 {
        self.get() >> (Self::BITS - width.get())
    }
}

/// The 64-bit pattern of a value: at the top, or all ones for a 1 of one bit.
pub(super) fn pattern(width: Width, value: u64) -> u64 {
    if width == Width::ONE { 0u64.wrapping_sub(value & 1) } else { value << (64 - width.get()) }
}

macro_rules! lane {
    ($word:ty) => {
        impl Lane for $word {
            const BITS: u32 = <$word>::BITS;
            const ONES: Self = <$word>::MAX;
            #[allow(clippy::cast_possible_truncation)]
            fn top(pattern: u64) -> Self {
                (pattern >> (64 - <$word>::BITS)) as $word
            }
            #[allow(clippy::cast_possible_truncation)]
            fn number(number: u64) -> Self {
                number as $word
            }
            fn get(self) -> u64 {
                u64::from(self)
            }
            #[inline(always)]
            #[allow(clippy::cast_lossless, clippy::cast_precision_loss)]
            fn real(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            #[allow(clippy::cast_lossless, clippy::cast_precision_loss)]
            fn real_signed(self) -> f64 {
                self.cast_signed() as f64
            }
            #[inline(always)]
            fn add(self, rhs: Self) -> Self {
                self.wrapping_add(rhs)
            }
            #[inline(always)]
            fn sub(self, rhs: Self) -> Self {
                self.wrapping_sub(rhs)
            }
            #[inline(always)]
            fn mul(self, rhs: Self) -> Self {
                self.wrapping_mul(rhs)
            }
            #[inline(always)]
            fn div(self, rhs: Self) -> Self {
                self.checked_div(rhs).unwrap_or(0)
            }
            #[inline(always)]
            fn rem(self, rhs: Self) -> Self {
                self.checked_rem(rhs).unwrap_or(0)
            }
            #[inline(always)]
            fn and(self, rhs: Self) -> Self {
                self & rhs
            }
            #[inline(always)]
            fn or(self, rhs: Self) -> Self {
                self | rhs
            }
            #[inline(always)]
            fn xor(self, rhs: Self) -> Self {
                self ^ rhs
            }
            #[inline(always)]
            fn not(self) -> Self {
                !self
            }
            #[inline(always)]
            fn left(self, by: u32) -> Self {
                self.wrapping_shl(by)
            }
            #[inline(always)]
            fn right(self, by: u32) -> Self {
                self.wrapping_shr(by)
            }
            #[inline(always)]
            fn right_signed(self, by: u32) -> Self {
                self.cast_signed().wrapping_shr(by).cast_unsigned()
            }
            #[inline(always)]
            fn less_signed(self, rhs: Self) -> bool {
                self.cast_signed() < rhs.cast_signed()
            }
            #[inline(always)]
            fn mask(condition: bool) -> Self {
                (0 as $word).wrapping_sub(<$word>::from(condition))
            }
        }
    };
}

lane!(u32);
lane!(u64);

/// The words of one net in all lanes of a block, aligned so that no vector load crosses a cache line.
#[derive(Clone)]
#[repr(align(64))]
pub(super) struct LaneRow<T>(pub(super) [[T; GROUP]; GROUPS]);

impl<T: Lane> LaneRow<T> {
    pub(super) fn filled(word: T) -> Box<LaneRow<T>> {
        Box::new(LaneRow([[word; GROUP]; GROUPS]))
    }

    pub(super) fn get(&self, lane: usize) -> T {
        self.0[lane / GROUP][lane % GROUP]
    }

    pub(super) fn set(&mut self, lane: usize, word: T) {
        self.0[lane / GROUP][lane % GROUP] = word;
    }
}
