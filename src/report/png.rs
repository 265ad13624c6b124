//! Pictures of few colours as PNG, for embedding in a page.

use miniz_oxide::deflate::compress_to_vec_zlib;

/// How hard the compressor tries, of 10.
const LEVEL: u8 = 6;

/// A picture of `width` pixels a row, each an index into the colours, as a PNG file.
pub(super) fn png(width: usize, pixels: &[u8], colours: &[[u8; 3]]) -> Vec<u8> {
    let height = pixels.len() / width.max(1);
    let size = |side: usize| u32::try_from(side).unwrap_or(u32::MAX).to_be_bytes();
    // 8 bits a pixel, by palette; then the only compression, filter and order there are.
    let header = [&size(width)[..], &size(height)[..], &[8, 3, 0, 0, 0]].concat();
    // Every row says first that it is not filtered.
    let rows: Vec<u8> = pixels.chunks(width.max(1)).flat_map(|row| [&[0], row].concat()).collect();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut file, *b"IHDR", &header);
    chunk(&mut file, *b"PLTE", colours.as_flattened());
    chunk(&mut file, *b"IDAT", &compress_to_vec_zlib(&rows, LEVEL));
    chunk(&mut file, *b"IEND", &[]);
    file
}

fn chunk(file: &mut Vec<u8>, kind: [u8; 4], data: &[u8]) {
    let body = [&kind[..], data].concat();
    file.extend(u32::try_from(data.len()).unwrap_or(u32::MAX).to_be_bytes());
    file.extend(&body);
    file.extend(checksum(&body).to_be_bytes());
}

/// The cyclic redundancy check of PNG, a bit at a time.
fn checksum(bytes: &[u8]) -> u32 {
    let bit = |rest: u32| if rest & 1 == 1 { rest >> 1 ^ 0xedb8_8320 } else { rest >> 1 };
    !bytes.iter().fold(u32::MAX, |rest, byte| (0..8).fold(rest ^ u32::from(*byte), |rest, _| bit(rest)))
}

/// Bytes as text of 64 letters.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0, |word, place| word << 8 | u32::from(three.get(place).copied().unwrap_or(0)));
        for place in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * place) & 63) as usize];
            text.push(if place <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_and_letters_are_those_of_the_standards() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
        let texts = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        assert!(texts.iter().all(|(plain, text)| base64(plain.as_bytes()) == *text));
    }

    #[test]
    fn the_pixels_can_be_read_back() {
        let file = png(3, &[0, 1, 2, 2, 1, 0], &[[0; 3], [9; 3], [255; 3]]);
        let data = file.windows(4).position(|four| four == b"IDAT").unwrap() + 4;
        let rows = miniz_oxide::inflate::decompress_to_vec_zlib(&file[data..]).unwrap();
        assert_eq!(rows, [0, 0, 1, 2, 0, 2, 1, 0]);
        assert_eq!(file[16..24], [0, 0, 0, 3, 0, 0, 0, 2]);
    }
}
