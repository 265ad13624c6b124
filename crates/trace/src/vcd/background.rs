//! A thread that writes while the run goes on. It makes text of changes that were gathered, and the system copies it into the
//! file; where it has enough to do the run makes the text itself. Either way the bytes are the same, in the same order.

use std::io::{self, Write};
use std::mem;
use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, channel, sync_channel};
use std::thread::{self, JoinHandle};

use stepwave_netlist::Rows;

use super::buffer::Buffer;
use super::cores;
use super::samples::{Parts, Samples};
use super::scan::{Batch, Scan, Span};

/// An output smaller than this, in bytes, never needs a thread.
const SMALL: usize = 1 << 20;
/// Parts in flight with which the thread has enough to do. With fewer the run would make text while the thread, which was about
/// to be free, waits for it.
const ENOUGH: usize = 4;
/// Most parts that wait.
const WAITING: usize = 5;

/// Writes samples, with a thread as soon as they are many, and only where there is a second core.
pub(super) struct Background<W: Write + Send + 'static> {
    state: State<W>,
}

enum State<W> {
    Direct {
        writer: Box<Writer<W>>,
        may_start: bool,
    },
    Thread(Box<Worker<W>>),
    /// An error was reported, or nothing is left.
    Closed,
}

/// Text, and where it goes.
pub(super) struct Writer<W> {
    pub(super) samples: Samples,
    pub(super) out: Output<W>,
}

/// A file, or what is like one.
pub(super) struct Output<W> {
    pub(super) out: W,
    written: usize,
}

impl<W: Write> Output<W> {
    pub(super) fn new(out: W) -> Output<W> {
        Output { out, written: 0 }
    }
}

impl<W: Write> Parts for Output<W> {
    fn part(&mut self, buffer: &mut Buffer) -> io::Result<()> {
        let before = buffer.filled;
        buffer.write_parts(&mut self.out)?;
        self.written += before - buffer.filled;
        Ok(())
    }
}

/// What is handed over.
enum Part {
    Changes(Batch),
    Text(Buffer),
}

/// A thread, and what it will get next: one of the two is empty.
struct Worker<W> {
    link: Link,
    batch: Batch,
    samples: Samples,
    /// The next part is text.
    is_text: bool,
    thread: JoinHandle<io::Result<Writer<W>>>,
}

/// The ways to a thread and back.
struct Link {
    parts: SyncSender<Part>,
    /// What was written, to be filled again.
    done: Receiver<Part>,
    /// Parts handed over and not written.
    in_flight: usize,
    batches: Vec<Batch>,
    buffers: Vec<Buffer>,
}

impl Link {
    fn send(&mut self, part: Part) -> io::Result<()> {
        self.in_flight += 1;
        // The thread has ended, which it does only with an error.
        self.parts.send(part).map_err(|_| closed())
    }

    /// Takes back what is written; whether the thread has enough to do.
    fn is_busy(&mut self) -> bool {
        while let Ok(part) = self.done.try_recv() {
            self.in_flight -= 1;
            match part {
                Part::Changes(batch) => self.batches.push(batch),
                Part::Text(buffer) => self.buffers.push(buffer),
            }
        }
        self.in_flight >= ENOUGH
    }
}

impl Parts for Link {
    fn part(&mut self, buffer: &mut Buffer) -> io::Result<()> {
        let next = self.buffers.pop().unwrap_or_else(|| Buffer::new(buffer.len()));
        self.send(Part::Text(mem::replace(buffer, next)))
    }
}

impl<W: Write + Send + 'static> Background<W> {
    pub(super) fn new(writer: Writer<W>) -> Background<W> {
        Background { state: State::Direct { writer: Box::new(writer), may_start: true } }
    }

    /// Takes the span that was looked at last.
    ///
    /// # Errors
    /// The output cannot be written; an error of the thread comes out of a later call.
    pub(super) fn take(&mut self, span: Span, scan: &Scan, rows: &Rows, range: &Range<usize>) -> io::Result<()> {
        match &mut self.state {
            State::Direct { writer, may_start } => {
                let Writer { samples, out } = &mut **writer;
                samples.span(span, scan, rows, range, out)?;
                if *may_start && out.written >= SMALL { self.start() } else { Ok(()) }
            }
            State::Thread(worker) => match worker.take(span, scan, rows, range) {
                // The thread knows better what went wrong.
                Err(error) => self.writer().and(Err(error)),
                Ok(()) => Ok(()),
            },
            State::Closed => Err(closed()),
        }
    }

    /// Starts the thread where there is a core for it.
    fn start(&mut self) -> io::Result<()> {
        let writer = self.writer()?;
        self.state = if thread::available_parallelism().is_ok_and(|cores| cores.get() > 1) {
            State::Thread(Box::new(Worker::start(writer)?))
        } else {
            State::Direct { writer: Box::new(writer), may_start: false }
        };
        Ok(())
    }

    /// Waits until everything is in the hands of the output.
    ///
    /// # Errors
    /// The output cannot be written.
    pub(super) fn writer(&mut self) -> io::Result<Writer<W>> {
        match mem::replace(&mut self.state, State::Closed) {
            State::Direct { writer, .. } => Ok(*writer),
            State::Thread(worker) => worker.finish(),
            State::Closed => Err(closed()),
        }
    }
}

/// Waits, so that nothing writes any more when the output's owner removes the file.
impl<W: Write + Send + 'static> Drop for Background<W> {
    fn drop(&mut self) {
        if let State::Thread(worker) = mem::replace(&mut self.state, State::Closed) {
            drop(worker.link.parts);
            let _ = worker.thread.join();
        }
    }
}

fn closed() -> io::Error {
    io::Error::new(io::ErrorKind::BrokenPipe, "the output is closed")
}

impl<W: Write + Send + 'static> Worker<W> {
    fn start(mut writer: Writer<W>) -> io::Result<Worker<W>> {
        let samples = writer.samples.later();
        let (parts, incoming) = sync_channel::<Part>(WAITING);
        let (sender, done) = channel();
        let here = cores::current();
        let thread = thread::Builder::new().name("wave writer".to_owned()).spawn(move || {
            cores::avoid(here);
            for mut part in incoming {
                writer.part(&mut part)?;
                // Nobody takes it back any more when the sender has ended.
                let _ = sender.send(part);
            }
            Ok(writer)
        })?;
        let link = Link { parts, done, in_flight: 0, batches: Vec::new(), buffers: Vec::new() };
        Ok(Worker { link, batch: Batch::default(), samples, is_text: false, thread })
    }

    fn take(&mut self, span: Span, scan: &Scan, rows: &Rows, range: &Range<usize>) -> io::Result<()> {
        if self.is_text {
            let parts = self.link.in_flight;
            self.samples.span(span, scan, rows, range, &mut self.link)?;
            if self.link.in_flight > parts && !self.link.is_busy() {
                self.is_text = false;
                // The beginning of what would have been the next part.
                return if self.samples.buffer.filled > 0 { self.link.part(&mut self.samples.buffer) } else { Ok(()) };
            }
            return Ok(());
        }
        self.batch.add(span, scan, rows, range);
        if self.batch.is_full() {
            let next = self.link.batches.pop().unwrap_or_default();
            self.link.send(Part::Changes(mem::replace(&mut self.batch, next)))?;
            self.is_text = self.link.is_busy();
        }
        Ok(())
    }

    fn finish(self) -> io::Result<Writer<W>> {
        drop(self.link.parts);
        let panicked = |_| Err(io::Error::other("the thread that writes the wave has panicked"));
        let mut writer = self.thread.join().unwrap_or_else(panicked)?;
        writer.part(&mut Part::Changes(self.batch))?;
        writer.part(&mut Part::Text(self.samples.buffer))?;
        Ok(writer)
    }
}

impl<W: Write> Writer<W> {
    /// Writes a part, and empties it.
    fn part(&mut self, part: &mut Part) -> io::Result<()> {
        match part {
            Part::Changes(batch) => {
                self.samples.batch(batch, &mut self.out)?;
                batch.clear();
            }
            Part::Text(buffer) => {
                self.samples.append(buffer.text(), &mut self.out)?;
                buffer.filled = 0;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
