//! Blocks of LZ4, made piece by piece, so that what is packed need not be in memory as a whole.
//!
//! A block is a list of sequences: a token with two lengths, literal bytes, and a match, which is a distance back and
//! a length. The last sequence is literals alone. Each piece is searched for matches within itself; the literals at its
//! end stay open, and the next piece adds to them.

/// The longest piece, in bytes: a distance has 16 bits.
const LONGEST_PIECE: usize = 1 << 16;
/// The shortest match.
const SHORTEST: usize = 4;
/// No match begins in the last bytes of a block.
const LAST_BEGIN: usize = 12;
/// No match goes into the last bytes of a block.
const LAST_END: usize = 5;
/// A length in a token is less than this, or continues in the bytes after it.
const IN_TOKEN: usize = 15;
/// Places that are remembered, as a power of two.
const PLACES: u32 = 12;
/// Places without a match, as a power of two, after which the search takes longer steps.
const PATIENCE: u32 = 6;

/// Searches for matches.
pub(super) struct Packer {
    /// Where bytes of this hash were last.
    places: Box<[u16; 1 << PLACES]>,
}

/// A block that is being made.
#[derive(Default)]
pub(super) struct Packed {
    /// Whole sequences, then literals whose token is not written yet.
    bytes: Vec<u8>,
    /// Where those literals begin.
    open: usize,
    /// A match was found.
    matches: bool,
}

impl Packer {
    pub(super) fn new() -> Packer {
        Packer { places: Box::new([0; 1 << PLACES]) }
    }

    /// Packs more bytes of a block.
    pub(super) fn pack(&mut self, bytes: &[u8], to: &mut Packed) {
        bytes.chunks(LONGEST_PIECE).for_each(|piece| self.piece(piece, to));
    }

    fn piece(&mut self, piece: &[u8], to: &mut Packed) {
        let mut literals = 0;
        if piece.len() > LAST_BEGIN {
            self.places.fill(0);
            let mut at = 1;
            while let Some((mut here, mut there)) = self.find(piece, at) {
                while here > literals && there > 0 && piece[here - 1] == piece[there - 1] {
                    (here, there) = (here - 1, there - 1);
                }
                let length = common(&piece[..piece.len() - LAST_END], here, there);
                to.sequence(&piece[literals..here], here - there, length);
                at = here + length;
                literals = at;
                if at < piece.len() - LAST_BEGIN {
                    self.remember(piece, at - 2);
                }
            }
        }
        to.bytes.extend_from_slice(&piece[literals..]);
    }

    /// The next match from a place on, and the place where the same bytes were before.
    #[inline]
    fn find(&mut self, piece: &[u8], mut at: usize) -> Option<(usize, usize)> {
        let last = piece.len() - LAST_BEGIN;
        let mut tried = 1 << PATIENCE;
        while at <= last {
            let before = self.remember(piece, at);
            if word(piece, before) == word(piece, at) && before < at {
                return Some((at, before));
            }
            at += tried >> PATIENCE;
            tried += 1;
        }
        None
    }

    /// Notes what is at a place; returns where something of the same hash was before.
    #[inline]
    #[allow(clippy::cast_possible_truncation)]
    fn remember(&mut self, piece: &[u8], at: usize) -> usize {
        let hash = word(piece, at).wrapping_mul(0x9E37_79B1) >> (u32::BITS - PLACES);
        usize::from(std::mem::replace(&mut self.places[hash as usize], at as u16))
    }
}

#[inline]
fn word(bytes: &[u8], at: usize) -> u32 {
    bytes[at..].first_chunk().map_or(0, |word| u32::from_le_bytes(*word))
}

/// Number of bytes that are the same from two places on.
#[inline]
fn common(bytes: &[u8], here: usize, there: usize) -> usize {
    let (ahead, before) = (&bytes[here..], &bytes[there..]);
    let words = ahead.as_chunks::<8>().0.iter().zip(before.as_chunks::<8>().0);
    let mut length = 0;
    for (a, b) in words {
        let differs = u64::from_le_bytes(*a) ^ u64::from_le_bytes(*b);
        if differs != 0 {
            return length + differs.trailing_zeros() as usize / 8;
        }
        length += 8;
    }
    length + ahead[length..].iter().zip(&before[length..]).take_while(|(a, b)| a == b).count()
}

impl Packed {
    /// Forgets what was packed.
    pub(super) fn clear(&mut self) {
        self.bytes.clear();
        (self.open, self.matches) = (0, false);
    }

    /// Ends the block. False if no match was found: then there are the bytes as they were.
    pub(super) fn end(&mut self) -> bool {
        if self.matches {
            self.head(0);
        }
        self.matches
    }

    /// The block.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    #[inline]
    fn sequence(&mut self, literals: &[u8], distance: usize, length: usize) {
        self.matches = true;
        let token = self.head(literals.len());
        self.bytes.extend_from_slice(literals);
        // Below 2^16, as the length of a piece is at most that.
        let distance = distance.to_le_bytes();
        self.bytes.extend_from_slice(&distance[..2]);
        let length = length - SHORTEST;
        self.bytes[token] |= in_token(length);
        let more = more_bytes(length);
        let at = self.bytes.len();
        self.bytes.resize(at + more, u8::MAX);
        put_length(length, &mut self.bytes[at..]);
        self.open = self.bytes.len();
    }

    /// Puts the token in front of the open literals, with their number and that of `more` that follow; returns its
    /// place.
    #[inline]
    fn head(&mut self, more: usize) -> usize {
        let (token, end) = (self.open, self.bytes.len());
        let literals = end - token + more;
        let head = 1 + more_bytes(literals);
        self.bytes.resize(end + head, 0);
        self.bytes.copy_within(token..end, token + head);
        self.bytes[token] = in_token(literals) << 4;
        put_length(literals, &mut self.bytes[token + 1..token + head]);
        token
    }
}

/// What a token holds of a length.
#[inline]
#[allow(clippy::cast_possible_truncation)]
fn in_token(length: usize) -> u8 {
    length.min(IN_TOKEN) as u8
}

/// Bytes of a length after its token.
#[inline]
fn more_bytes(length: usize) -> usize {
    if length < IN_TOKEN { 0 } else { (length - IN_TOKEN) / 255 + 1 }
}

/// Writes the bytes of a length after its token.
#[inline]
#[allow(clippy::cast_possible_truncation)]
fn put_length(length: usize, out: &mut [u8]) {
    if let [full @ .., last] = out {
        full.fill(u8::MAX);
        *last = ((length - IN_TOKEN) % 255) as u8;
    }
}

/// Packs bytes as one block.
pub(super) fn block(bytes: &[u8]) -> Vec<u8> {
    let mut packer = Packer::new();
    let mut packed = Packed::default();
    packer.pack(bytes, &mut packed);
    packed.head(0);
    packed.bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bytes of a few kinds in turn: without a pattern, a pattern again and again, few different ones.
    fn bytes(kinds: &[(u8, usize)]) -> Vec<u8> {
        let mut state = 7_u64;
        let mut out: Vec<u8> = Vec::new();
        for &(kind, length) in kinds {
            for index in 0..length {
                state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
                let noise = state.to_be_bytes()[0];
                out.push(match kind {
                    0 => noise,
                    1 => out.len().checked_sub(usize::from(noise % 2) + 5).map_or(noise, |at| out[at]),
                    2 => noise & 1,
                    _ => u8::try_from(index % 7).unwrap_or(0),
                });
            }
        }
        out
    }

    fn check(bytes: &[u8], pieces: usize) {
        let (mut packer, mut packed) = (Packer::new(), Packed::default());
        bytes.chunks(pieces).for_each(|piece| packer.pack(piece, &mut packed));
        if packed.end() {
            assert!(lz4_flex::block::decompress(packed.bytes(), bytes.len()).expect("a block") == bytes);
            assert!(packed.bytes().len() <= bytes.len() + bytes.len() / 255 + 16);
        } else {
            assert!(packed.bytes() == bytes);
        }
        assert!(lz4_flex::block::decompress(&block(bytes), bytes.len()).expect("a block") == bytes);
    }

    proptest! {
        #[test]
        fn a_block_unpacks_to_what_was_packed(
            kinds in proptest::collection::vec((0..4_u8, prop_oneof![0..40_usize, 0..90_000_usize]), 0..6),
            pieces in prop_oneof![1..100_usize, 1000..200_000_usize],
        ) {
            check(&bytes(&kinds), pieces);
        }
    }

    #[test]
    fn what_repeats_is_packed() {
        let bytes = bytes(&[(3, 1_000_000)]);
        assert!(block(&bytes).len() < 5_000);
        check(&bytes, 1 << 16);
    }
}
