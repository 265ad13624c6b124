//! An output that is written by a thread of its own, so that the system copies one part while the next is made. Parts are
//! handed over, not copied.

use std::io::{self, Write};
use std::ops::{Deref, DerefMut};
use std::sync::mpsc::{Receiver, SyncSender, channel, sync_channel};
use std::thread::{self, JoinHandle};

/// Parts in flight: one that is written, and one that waits.
const PARTS: usize = 2;
/// An output smaller than this, in bytes, never needs a thread.
const SMALL: usize = 1 << 20;

/// Bytes of a page. The system copies a part into pages of the file two to three times as fast where it lies in memory as
/// it does there.
const PAGE: usize = 4096;

/// Bytes that begin at the start of a page.
pub(super) struct Buffer {
    room: Vec<u8>,
    start: usize,
}

impl Buffer {
    /// Zeros.
    pub(super) fn new(length: usize) -> Buffer {
        let room = vec![0; length + PAGE];
        // Where the address is not known, any will do.
        let start = room.as_ptr().align_offset(PAGE).min(PAGE);
        Buffer { room, start }
    }
}

impl Deref for Buffer {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.room[self.start..][..self.room.len() - PAGE]
    }
}

impl DerefMut for Buffer {
    fn deref_mut(&mut self) -> &mut [u8] {
        let length = self.room.len() - PAGE;
        &mut self.room[self.start..][..length]
    }
}

/// Takes the parts of an output, one after another.
pub(super) trait Parts {
    /// Writes the first `filled` bytes of a buffer, in the place of which may then be another one of its length.
    ///
    /// # Errors
    /// The output cannot be written; an error of a thread comes out of the next call.
    fn part(&mut self, buffer: &mut Buffer, filled: usize) -> io::Result<()>;
}

/// Writes to `W` in a thread, in order, byte by byte the same.
pub(super) struct Background<W: Write + Send + 'static> {
    state: Destination<W>,
}

enum Destination<W> {
    /// The first bytes are written directly: short outputs start no thread.
    Direct {
        out: W,
        /// Bytes after which a thread is started; never where there is one core.
        left: Option<usize>,
    },
    Thread(Worker<W>),
    /// An error was reported, or nothing is left.
    Closed,
}

struct Worker<W> {
    /// Buffers, and how many bytes of each are to be written.
    parts: SyncSender<(Buffer, usize)>,
    /// Buffers that were written and can be used again.
    empty: Receiver<Buffer>,
    thread: JoinHandle<io::Result<W>>,
}

impl<W: Write + Send + 'static> Background<W> {
    /// Writes to `out`; a thread starts as soon as the output is large, and only where there is a second core.
    pub(super) fn new(out: W) -> Background<W> {
        Background { state: Destination::Direct { out, left: Some(SMALL) } }
    }

    /// Waits until everything is written, and gives the output back.
    ///
    /// # Errors
    /// The output cannot be written.
    pub(super) fn finish(mut self) -> io::Result<W> {
        match std::mem::replace(&mut self.state, Destination::Closed) {
            Destination::Direct { mut out, .. } => out.flush().map(|()| out),
            Destination::Thread(worker) => worker.join(),
            Destination::Closed => Err(closed()),
        }
    }
}

impl<W: Write + Send + 'static> Parts for Background<W> {
    fn part(&mut self, buffer: &mut Buffer, filled: usize) -> io::Result<()> {
        match &mut self.state {
            Destination::Direct { out, left } => {
                out.write_all(&buffer[..filled])?;
                let Some(before) = *left else { return Ok(()) };
                *left = before.checked_sub(filled);
                if left.is_some() {
                    return Ok(());
                }
                let Destination::Direct { out, .. } = std::mem::replace(&mut self.state, Destination::Closed) else {
                    return Err(closed());
                };
                self.state = if thread::available_parallelism().is_ok_and(|cores| cores.get() > 1) {
                    Destination::Thread(Worker::start(out)?)
                } else {
                    Destination::Direct { out, left: None }
                };
                Ok(())
            }
            Destination::Thread(worker) => {
                if worker.send(buffer, filled) {
                    return Ok(());
                }
                // The thread has ended, which it does only with an error.
                match std::mem::replace(&mut self.state, Destination::Closed) {
                    Destination::Thread(worker) => Err(worker.join().err().unwrap_or_else(closed)),
                    _ => Err(closed()),
                }
            }
            Destination::Closed => Err(closed()),
        }
    }
}

fn closed() -> io::Error {
    io::Error::new(io::ErrorKind::BrokenPipe, "the output is closed")
}

impl<W: Write + Send + 'static> Worker<W> {
    fn start(mut out: W) -> io::Result<Worker<W>> {
        let (parts, incoming) = sync_channel::<(Buffer, usize)>(PARTS);
        let (done, empty) = channel();
        let thread = thread::Builder::new().name("wave writer".to_owned()).spawn(move || {
            for (buffer, filled) in incoming {
                out.write_all(&buffer[..filled])?;
                // Nobody takes it back any more when the sender has ended.
                let _ = done.send(buffer);
            }
            out.flush()?;
            Ok(out)
        })?;
        Ok(Worker { parts, empty, thread })
    }

    /// False if the thread has ended.
    fn send(&self, buffer: &mut Buffer, filled: usize) -> bool {
        let next = self.empty.try_recv().unwrap_or_else(|_| Buffer::new(buffer.len()));
        self.parts.send((std::mem::replace(buffer, next), filled)).is_ok()
    }

    fn join(self) -> io::Result<W> {
        drop(self.parts);
        self.thread.join().unwrap_or_else(|_| Err(io::Error::other("the thread that writes the wave has panicked")))
    }
}

/// Waits, so that nothing writes any more when the output's owner removes the file.
impl<W: Write + Send + 'static> Drop for Background<W> {
    fn drop(&mut self) {
        if let Destination::Thread(worker) = std::mem::replace(&mut self.state, Destination::Closed) {
            let _ = worker.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Takes this many bytes, then fails.
    struct Disk(Vec<u8>, usize);

    impl Write for Disk {
        fn write(&mut self, part: &[u8]) -> io::Result<usize> {
            if self.0.len() + part.len() > self.1 {
                return Err(io::Error::new(io::ErrorKind::StorageFull, "cannot write w.vcd: no space"));
            }
            self.0.extend_from_slice(part);
            Ok(part.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn parts() -> impl Iterator<Item = Vec<u8>> {
        (0..400).map(|index: u32| index.to_string().repeat(4000).into_bytes())
    }

    /// Writes a part from a buffer that is longer.
    fn write<W: Write + Send>(background: &mut Background<W>, part: &[u8]) -> io::Result<()> {
        let mut buffer = Buffer::new(part.len() + 4);
        buffer[..part.len()].copy_from_slice(part);
        assert!(buffer.as_ptr().addr().is_multiple_of(PAGE));
        let length = buffer.len();
        let written = background.part(&mut buffer, part.len());
        assert_eq!(buffer.len(), length);
        written
    }

    #[test]
    fn a_large_output_arrives_whole_and_in_order() {
        let mut background = Background::new(Vec::new());
        for part in parts() {
            write(&mut background, &part).unwrap();
        }
        assert!(background.finish().unwrap() == parts().flatten().collect::<Vec<u8>>());
    }

    #[test]
    fn a_full_disk_is_reported_in_its_own_words_wherever_it_happens() {
        for room in [0, 100_000, SMALL + 50_000, 3_000_000] {
            let mut background = Background::new(Disk(Vec::new(), room));
            let written = parts().try_for_each(|part| write(&mut background, &part));
            let error = written.and_then(|()| background.finish().map(drop)).unwrap_err();
            assert_eq!(error.to_string(), "cannot write w.vcd: no space", "{room}");
        }
    }

    #[test]
    fn an_error_at_the_very_end_is_reported_by_finish() {
        let all = parts().map(|part| part.len()).sum::<usize>();
        let mut background = Background::new(Disk(Vec::new(), all - 1));
        let written = parts().try_for_each(|part| write(&mut background, &part));
        let error = written.and_then(|()| background.finish().map(drop)).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }

    #[test]
    fn what_is_dropped_unfinished_neither_waits_for_ever_nor_panics() {
        let mut background = Background::new(Disk(Vec::new(), 3_000_000));
        let _ = parts().try_for_each(|part| write(&mut background, &part));
        drop(background);
    }
}
