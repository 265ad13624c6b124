//! Room in a file that is asked for some megabytes ahead of what is written: the system then finds blocks of the disk for
//! all of them at once, rather than for each page by itself.

use std::fs::File;
use std::io;

/// Bytes after which an output is large, and those asked for at a time.
const LARGE: u64 = 1 << 20;
const AHEAD: u64 = 8 << 20;

/// The room of a file that is written from its start on.
#[derive(Debug, Default)]
pub(super) struct Room {
    written: u64,
    /// The end of the room.
    end: u64,
    /// The system gives none, or the file is not written from its start on.
    given_up: bool,
}

impl Room {
    /// Asks for room before this many bytes are written, if there is none for them. A disk that is full is noticed where it
    /// is written.
    pub(super) fn ask(&mut self, file: &File, bytes: usize) {
        let end = self.written.saturating_add(bytes as u64);
        if self.given_up || end <= self.end.max(LARGE) {
            return;
        }
        let from = self.end.max(self.written);
        match allocate(file, from, AHEAD) {
            Ok(()) => self.end = from + AHEAD,
            Err(_) => self.given_up = true,
        }
    }

    /// This many bytes are written.
    pub(super) fn take(&mut self, bytes: usize) {
        self.written += bytes as u64;
    }

    /// Gives back what is not written.
    ///
    /// # Errors
    /// The system does not take it.
    pub(super) fn give_back(&mut self, file: &File) -> io::Result<()> {
        if self.end > self.written {
            file.set_len(file.metadata()?.len())?;
        }
        self.end = 0;
        Ok(())
    }

    /// Gives back what is not written, and asks for no more: the next bytes are written somewhere else.
    ///
    /// # Errors
    /// The system does not take it.
    pub(super) fn give_up(&mut self, file: &File) -> io::Result<()> {
        self.given_up = true;
        self.give_back(file)
    }
}

/// Room beyond the end of a file, whose length stays.
#[cfg(target_os = "linux")]
fn allocate(file: &File, from: u64, bytes: u64) -> io::Result<()> {
    Ok(rustix::fs::fallocate(file, rustix::fs::FallocateFlags::KEEP_SIZE, from, bytes)?)
}

#[cfg(not(target_os = "linux"))]
fn allocate(_: &File, _: u64, _: u64) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::io::{Seek, SeekFrom, Write};
    use std::os::unix::fs::MetadataExt;
    use std::path::Path;

    use super::super::Named;
    use super::*;

    /// Bytes of the disk that a file has.
    fn room(path: &Path) -> u64 {
        path.metadata().expect("a file").blocks() * 512
    }

    fn named(path: &Path) -> Named {
        Named::new(path, File::create(path).expect("a file"))
    }

    #[test]
    fn a_large_file_has_no_more_room_than_it_needs_in_the_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("large");
        for length in [0usize, 1, 1_000_000, 1 << 20, (1 << 20) + 1, 9_500_001] {
            let bytes: Vec<u8> = (0..length).map(|index| u8::try_from(index % 251).unwrap_or(0)).collect();
            let mut file = named(&path);
            for part in bytes.chunks(300_007) {
                file.write_all(part).expect("room");
                // The length is that of what is written at all times.
                assert!(path.metadata().expect("a file").len() <= length as u64);
            }
            file.flush().expect("an end");
            assert!(std::fs::read(&path).expect("a file") == bytes, "{length}");
            assert!(room(&path) <= length as u64 + (1 << 16), "{length} bytes, room for {}", room(&path));
        }
    }

    #[test]
    fn a_file_in_which_one_goes_back_is_as_long_as_what_was_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("back");
        let mut file = named(&path);
        file.write_all(&vec![1; 3 << 20]).expect("room");
        file.seek(SeekFrom::Start(10)).expect("a place");
        file.write_all(&[2; 5]).expect("room");
        file.seek(SeekFrom::End(0)).expect("a place");
        file.write_all(&vec![3; 3 << 20]).expect("room");
        file.flush().expect("an end");
        let read = std::fs::read(&path).expect("a file");
        assert_eq!((read.len(), read[9], read[10], read[14], read[15]), (6 << 20, 1, 2, 2, 1));
        assert!(room(&path) <= (6 << 20) + (1 << 16), "{}", room(&path));
    }
}
