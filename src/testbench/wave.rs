//! Writes the samples of a run into a wave file, within a window of clocks.

use std::io::{self, Seek, Write};
use std::ops::Range;

use stepwave_kernel::engine::Rows;
use stepwave_kernel::trace::fst::FstBody;
use stepwave_kernel::trace::vcd::VcdBody;

use super::{Observer, ObserverError};

/// When a window opens.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Trigger {
    /// At its first clock.
    #[default]
    Immediately,
    /// At the first clock, not before the window's first, on which the net in this column is 1.
    Column(usize),
}

/// Clocks that a wave shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Window {
    /// First clock.
    pub from: u64,
    /// Last clock, if there is one.
    pub to: Option<u64>,
    /// What opens it.
    pub trigger: Trigger,
}

impl Window {
    /// The rows of a block that fall between its first and last clock.
    fn rows(&self, rows: &Rows) -> Range<usize> {
        // A clock beyond the block lies behind its last row, whatever the size of a usize.
        let index = |clock: u64| {
            let index = usize::try_from(clock.saturating_sub(rows.first_clock()));
            index.map_or(rows.len(), |index| index.min(rows.len()))
        };
        let end = self.to.map_or(rows.len(), |to| index(to.saturating_add(1)));
        index(self.from).min(end)..end
    }
}

/// A format of waves whose header is written: takes the rows of blocks, in order.
pub trait WaveBody {
    /// What is left when the wave is whole.
    type Output;

    /// Writes some rows of a block.
    ///
    /// # Errors
    /// The output cannot be written.
    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()>;

    /// Ends the wave.
    ///
    /// # Errors
    /// The output cannot be written.
    fn finish(self) -> io::Result<Self::Output>;
}

impl<W: Write> WaveBody for VcdBody<W> {
    type Output = W;

    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()> {
        VcdBody::rows(self, rows, range)
    }

    fn finish(self) -> io::Result<W> {
        VcdBody::finish(self)
    }
}

impl<W: Write + Seek> WaveBody for FstBody<W> {
    type Output = W;

    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()> {
        FstBody::rows(self, rows, range)
    }

    fn finish(self) -> io::Result<W> {
        FstBody::finish(self)
    }
}

/// A wave file that is being written.
pub struct WaveWriter<B> {
    body: B,
    window: Window,
    open: bool,
    /// First and last clock written.
    pub written: Option<(u64, u64)>,
}

impl<B: WaveBody> WaveWriter<B> {
    /// Writes what falls into the window.
    #[must_use]
    pub fn new(body: B, window: Window) -> WaveWriter<B> {
        let open = window.trigger == Trigger::Immediately;
        WaveWriter { body, window, open, written: None }
    }

    /// Ends the wave.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(self) -> io::Result<B::Output> {
        self.body.finish()
    }
}

impl<B: WaveBody> Observer for WaveWriter<B> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let mut range = self.window.rows(rows);
        if let (Trigger::Column(column), false) = (self.window.trigger, self.open) {
            match rows.column(column)[range.clone()].iter().position(|&value| value == 1) {
                Some(index) => range.start += index,
                None => return Ok(()),
            }
        }
        if range.is_empty() {
            return Ok(());
        }
        self.open = true;
        let clock = |index: usize| rows.first_clock() + index as u64;
        let (first, last) = (clock(range.start), clock(range.end - 1));
        self.body.rows(rows, range)?;
        self.written = Some((self.written.map_or(first, |(first, _)| first), last));
        Ok(())
    }
}
