//! Windows of steps that are equally far apart, many at once: the pulses of each step as bytes, summed over 32 steps in
//! five rounds of doubling, in loops that compilers make vectors of.

use super::windows::WINDOW;

/// Words of new steps.
pub(super) const WORDS: usize = 8;
/// New steps at most.
pub(super) const STEPS: usize = 64 * WORDS;
/// A word of steps before, of which the last [`WINDOW`] count, and the new ones; the first step the lowest bit.
pub(super) type Bits = [u64; WORDS + 1];

/// Bytes of an axis: the steps before and the new ones, and room for sums beyond the end.
const BYTES: usize = WINDOW + STEPS + WINDOW;
/// The bits of a byte, a byte each, the lowest first.
const EXPANDED: [u64; 256] = expanded();

const fn expanded() -> [u64; 256] {
    let (mut table, mut bits) = ([0; 256], 0);
    while bits < 256 {
        let mut bit = 0;
        while bit < 8 {
            table[bits] |= ((bits as u64 >> bit) & 1) << (8 * bit);
            bit += 1;
        }
        bits += 1;
    }
    table
}

/// Room for what is computed, so that nothing is allocated.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    sums: [[u8; BYTES]; 2],
    /// Of the window that ends with each new step.
    squares: [u16; STEPS],
}

impl Kernel {
    pub(super) fn new() -> Kernel {
        Kernel { sums: [[0; BYTES]; 2], squares: [0; STEPS] }
    }

    /// Computes |p_k - p_(k-32)|² in BLU² for the first `steps` new steps, and gives the least and the greatest of them.
    /// An axis moves by the bit of the step, always in the same direction.
    #[inline(always)]
    pub(super) fn extremes(&mut self, axes: &[Bits], steps: usize) -> [u16; 2] {
        extremes(axes, steps, &mut self.sums, &mut self.squares)
    }

    /// The first of the new steps whose window has this square.
    pub(super) fn first(&self, square: u16) -> usize {
        self.squares.iter().position(|&found| found == square).unwrap_or(0)
    }
}

#[inline(always)]
fn extremes(axes: &[Bits], steps: usize, sums: &mut [[u8; BYTES]; 2], squares: &mut [u16; STEPS]) -> [u16; 2] {
    let [x, y] = sums;
    for (pair, bits) in axes.chunks(2).enumerate() {
        windows(&bits[0], x);
        match bits.get(1) {
            Some(other) => windows(other, y),
            None => y.fill(0),
        }
        // Of 32 steps each: six axes make 6144 at most.
        let [x, y] = [&*x, &*y].map(|sums| &sums[1..=STEPS]);
        for ((square, &x), &y) in squares.iter_mut().zip(x).zip(y) {
            let [x, y] = [u16::from(x), u16::from(y)];
            let both = x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y));
            *square = if pair == 0 { both } else { square.wrapping_add(both) };
        }
    }
    let (chunks, rest) = squares[..steps.min(STEPS)].as_chunks::<16>();
    let (mut least, mut greatest) = ([u16::MAX; 16], [0; 16]);
    for chunk in chunks {
        for (index, &square) in chunk.iter().enumerate() {
            least[index] = least[index].min(square);
            greatest[index] = greatest[index].max(square);
        }
    }
    for &square in rest {
        (least[0], greatest[0]) = (least[0].min(square), greatest[0].max(square));
    }
    [least.into_iter().fold(u16::MAX, u16::min), greatest.into_iter().fold(0, u16::max)]
}

/// The bits as bytes, and then in the place of each byte the sum of it and the 31 after it.
#[inline(always)]
fn windows(bits: &Bits, sums: &mut [u8; BYTES]) {
    let before = (bits[0] >> 32).to_le_bytes();
    let new = bits[1..].iter().flat_map(|word| word.to_le_bytes());
    for (bytes, bits) in sums.as_chunks_mut::<8>().0.iter_mut().zip(before[..4].iter().copied().chain(new)) {
        *bytes = EXPANDED[usize::from(bits)].to_le_bytes();
    }
    doubled::<1>(sums);
    doubled::<2>(sums);
    doubled::<4>(sums);
    doubled::<8>(sums);
    doubled::<16>(sums);
}

#[inline(always)]
fn doubled<const APART: usize>(sums: &mut [u8; BYTES]) {
    for index in 0..BYTES - APART {
        sums[index] = sums[index].wrapping_add(sums[index + APART]);
    }
}
