//! Numbers of variable length, seven bits a byte, the lowest first; all but the last byte have their highest bit set.

/// Appends a number.
pub fn push(mut number: u64, out: &mut Vec<u8>) {
    while number >= 0x80 {
        out.push(0x80 | number.to_le_bytes()[0]);
        number >>= 7;
    }
    out.push(number.to_le_bytes()[0]);
}

/// Appends a number of either sign: the last byte has the sign in its second highest bit.
pub fn push_signed(mut number: i64, out: &mut Vec<u8>) {
    while !(-0x40..0x40).contains(&number) {
        out.push(0x80 | number.to_le_bytes()[0]);
        number >>= 7;
    }
    out.push(0x7F & number.to_le_bytes()[0]);
}

/// Takes a number of either sign from the start of the bytes; `None` where they end before it does.
pub fn pull_signed(bytes: &mut &[u8]) -> Option<i64> {
    let (mut number, mut shift) = (0_i64, 0);
    loop {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        if shift < 64 {
            number |= i64::from(byte & 0x7F) << shift;
        }
        shift += 7;
        if byte & 0x80 == 0 {
            return Some(if byte & 0x40 != 0 && shift < 64 { number | (-1 << shift) } else { number });
        }
    }
}

/// Eight bytes, the highest first.
pub(crate) fn push_u64(number: u64, out: &mut Vec<u8>) {
    out.extend_from_slice(&number.to_be_bytes());
}

/// A number of at most 35 bits as the bytes of a word, the first the lowest, and how many there are.
#[inline]
pub(crate) fn packed(mut number: u64) -> (u64, usize) {
    let (mut word, mut bytes) = (0, 0);
    while number >= 0x80 {
        word |= (0x80 | number & 0x7F) << (8 * bytes);
        number >>= 7;
        bytes += 1;
    }
    (word | number << (8 * bytes), bytes + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_seven_bits_a_byte() {
        let of = |number| {
            let mut out = Vec::new();
            push(number, &mut out);
            out
        };
        assert_eq!(of(0), [0]);
        assert_eq!(of(127), [127]);
        assert_eq!(of(128), [0x80, 1]);
        assert_eq!(of(0x3FFF), [0xFF, 0x7F]);
        assert_eq!(of(u64::MAX).len(), 10);
        for number in [0, 1, 127, 128, 300, 1 << 21, (1 << 35) - 1] {
            let (word, bytes) = packed(number);
            assert_eq!(word.to_le_bytes()[..bytes], of(number)[..], "{number}");
        }
    }

    #[test]
    fn a_sign_is_in_the_last_byte() {
        let of = |number| {
            let mut out = Vec::new();
            push_signed(number, &mut out);
            out
        };
        assert_eq!(of(63), [63]);
        assert_eq!(of(64), [0xC0, 0]);
        assert_eq!(of(-1), [0x7F]);
        assert_eq!(of(-64), [0x40]);
        assert_eq!(of(-65), [0xBF, 0x7F]);
        for number in [0, 63, 64, -64, -65, 1 << 40, -(1 << 40), i64::MAX, i64::MIN] {
            let (bytes, mut rest) = (of(number), &of(number)[..]);
            assert_eq!((pull_signed(&mut rest), rest.len()), (Some(number), 0));
            assert_eq!(pull_signed(&mut &bytes[..bytes.len() - 1]), None, "{number}");
        }
    }
}
