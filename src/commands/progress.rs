//! A progress line for runs longer than a second, on a terminal only.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use stepwave::kernel::engine::Rows;
use stepwave::testbench::{Observer, ObserverError};

/// How long a run may take before it shows its progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Samples between two looks at the time.
const INTERVAL: usize = 1 << 16;

/// Counts clocks.
pub(crate) struct Progress {
    start: Instant,
    since_look: usize,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Nothing is shown yet.
    pub(crate) fn new() -> Progress {
        Progress { start: Instant::now(), since_look: 0, bar: None }
    }

    /// Takes the line off the terminal.
    pub(crate) fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Progress {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        self.since_look += rows.len();
        if self.since_look >= INTERVAL {
            self.since_look = 0;
            if self.bar.is_none() && self.start.elapsed() >= PATIENCE {
                // Draws on standard error, and only where that is a terminal.
                let style = ProgressStyle::with_template("{spinner} {human_pos} clocks, {per_sec}")?;
                self.bar = Some(ProgressBar::new_spinner().with_style(style));
            }
            if let Some(bar) = &self.bar {
                bar.set_position(rows.first_clock());
            }
        }
        Ok(())
    }
}

/// Counts what is done of a known number, for work longer than a second, on a terminal only.
pub(crate) struct Counter {
    start: Instant,
    all: u64,
    what: &'static str,
    bar: Option<ProgressBar>,
}

impl Counter {
    /// Nothing is shown yet.
    pub(crate) fn new(all: u64, what: &'static str) -> Counter {
        Counter { start: Instant::now(), all, what, bar: None }
    }

    /// So many are done.
    pub(crate) fn set(&mut self, done: u64) {
        if self.bar.is_none() && self.start.elapsed() >= PATIENCE {
            let template = format!("{{bar:30}} {{human_pos}} of {{human_len}} {}, {{eta}} left", self.what);
            let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
            self.bar = Some(ProgressBar::new(self.all).with_style(style));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }

    /// Takes the bar off the terminal.
    pub(crate) fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}
