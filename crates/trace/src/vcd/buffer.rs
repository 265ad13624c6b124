//! Memory for a part of a file.

use std::io::{self, Write};
use std::ops::{Deref, DerefMut};

/// Bytes of every part that goes to the output, but the last: whole pages of a file.
pub(super) const BUFFER: usize = 512 * 1024;

/// Bytes of a page. The system copies a part into pages of the file two to three times as fast where it lies in memory as
/// it does there.
const PAGE: usize = 4096;

/// Bytes that begin at the start of a page.
pub(super) struct Buffer {
    room: Vec<u8>,
    start: usize,
    /// How many of them, from the first on, are text.
    pub(super) filled: usize,
}

impl Buffer {
    /// Zeros.
    pub(super) fn new(length: usize) -> Buffer {
        let room = vec![0; length + PAGE];
        // Where the address is not known, any will do.
        let start = room.as_ptr().align_offset(PAGE).min(PAGE);
        Buffer { room, start, filled: 0 }
    }

    /// The bytes after the text.
    pub(super) fn free(&mut self) -> &mut [u8] {
        let filled = self.filled;
        &mut self[filled..]
    }

    /// Appends text, for which there is room.
    pub(super) fn push(&mut self, text: &[u8]) {
        self.free()[..text.len()].copy_from_slice(text);
        self.filled += text.len();
    }

    /// The text.
    pub(super) fn text(&self) -> &[u8] {
        &self[..self.filled]
    }

    /// Writes as much of the text as are whole parts.
    ///
    /// # Errors
    /// The output cannot be written.
    pub(super) fn write_parts(&mut self, out: &mut impl Write) -> io::Result<()> {
        while self.filled >= BUFFER {
            out.write_all(&self[..BUFFER])?;
            let filled = self.filled;
            self.copy_within(BUFFER..filled, 0);
            self.filled -= BUFFER;
        }
        Ok(())
    }
}

impl Deref for Buffer {
    type Target = [u8];

    #[inline(always)]
    fn deref(&self) -> &[u8] {
        &self.room[self.start..][..self.room.len() - PAGE]
    }
}

impl DerefMut for Buffer {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [u8] {
        let length = self.room.len() - PAGE;
        &mut self.room[self.start..][..length]
    }
}

#[test]
fn a_buffer_has_its_length_and_begins_with_a_page() {
    for length in [1, PAGE - 1, PAGE, 100_000] {
        let mut buffer = Buffer::new(length);
        assert_eq!((buffer.len(), buffer.as_ptr().addr() % PAGE), (length, 0));
        buffer[length - 1] = 1;
    }
}
