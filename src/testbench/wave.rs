//! Writes the samples of a run into a wave file, within a window of clocks.

use std::io::Write;

use stepwave_kernel::engine::Rows;
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

/// A wave file that is being written.
pub struct WaveWriter<W: Write> {
    body: VcdBody<W>,
    window: Window,
    open: bool,
    /// First and last clock written.
    pub written: Option<(u64, u64)>,
}

impl<W: Write> WaveWriter<W> {
    /// Writes what falls into the window.
    #[must_use]
    pub fn new(body: VcdBody<W>, window: Window) -> WaveWriter<W> {
        WaveWriter { body, window, open: false, written: None }
    }

    /// Ends the wave.
    ///
    /// # Errors
    /// The output cannot be written.
    pub fn finish(self) -> std::io::Result<W> {
        self.body.finish()
    }
}

impl<W: Write> Observer for WaveWriter<W> {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for (clock, row) in rows.iter() {
            if clock < self.window.from || self.window.to.is_some_and(|to| clock > to) {
                continue;
            }
            self.open |= match self.window.trigger {
                Trigger::Immediately => true,
                Trigger::Column(column) => row[column] == 1,
            };
            if self.open {
                self.body.sample(clock, row)?;
                self.written = Some((self.written.map_or(clock, |(first, _)| first), clock));
            }
        }
        Ok(())
    }
}
