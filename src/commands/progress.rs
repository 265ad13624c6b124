//! A progress line for work longer than a second, on a terminal only.
//!
//! A thread of its own draws it, so that the workers only count, from any thread, and the line lives on while a
//! single step takes long.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::engine::{Digest, Rows, Wanted};
use crate::nc::Curve;
use crate::simulation::Onlookers;
use crate::testbench::{BlockReport, Memory, Observer, ObserverError, Testbench};
use indicatif::{HumanCount, ProgressBar, ProgressStyle};

/// How long work may take before it shows its progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two drawings.
const INTERVAL: Duration = Duration::from_millis(125);

/// Shows how far a piece of work is. The line goes when this does, whether the work ended well or not.
///
/// ```ignore
/// let progress = Progress::of(jobs, "jobs");   // or Progress::new("clocks") where nobody knows how many there are
/// jobs.par_iter().for_each(|job| { …; progress.add(1) });
/// ```
pub(crate) struct Progress {
    shared: Arc<Shared>,
    drawer: Option<JoinHandle<()>>,
}

/// What the worker and the drawer share.
struct Shared {
    what: &'static str,
    /// The share is that of the pieces counted, and not of something else.
    counted: bool,
    start: Instant,
    done: AtomicU64,
    /// What was done before the work began.
    begun: AtomicU64,
    /// The share that is done: `part` of `whole`, in any unit; 0 of 0 where it is not known.
    part: AtomicU64,
    whole: AtomicU64,
    over: Mutex<bool>,
    wake: Condvar,
}

impl Progress {
    /// Of work whose extent is not known. `what` is counted, in the plural: `clocks`.
    pub(crate) fn new(what: &'static str) -> Progress {
        Progress::start(what, 0, true)
    }

    /// Of this many pieces of work.
    pub(crate) fn of(all: u64, what: &'static str) -> Progress {
        Progress::start(what, all, true)
    }

    fn start(what: &'static str, whole: u64, counted: bool) -> Progress {
        let zero = || AtomicU64::new(0);
        let shared = Arc::new(Shared {
            what,
            counted,
            start: Instant::now(),
            done: zero(),
            begun: zero(),
            part: zero(),
            whole: AtomicU64::new(whole),
            over: Mutex::new(false),
            wake: Condvar::new(),
        });
        let drawn = Arc::clone(&shared);
        // Without a thread the work is still done.
        let drawer = io::stderr().is_terminal().then(|| thread::Builder::new().spawn(move || drawn.draw()).ok());
        Progress { shared, drawer: drawer.flatten() }
    }

    /// This many of them were done before: they count for the share, not for the rate.
    pub(crate) fn begin_at(&self, done: u64) {
        self.shared.begun.store(done, Ordering::Relaxed);
        self.set(done);
    }

    /// This many are done in total.
    pub(crate) fn set(&self, done: u64) {
        self.shared.done.store(done, Ordering::Relaxed);
        self.shared.part.store(done, Ordering::Relaxed);
    }

    /// This many more are done.
    pub(crate) fn add(&self, more: u64) {
        self.shared.done.fetch_add(more, Ordering::Relaxed);
        self.shared.part.fetch_add(more, Ordering::Relaxed);
    }

    /// Takes the line off the terminal, for what is printed next.
    pub(crate) fn finish(self) {}
}

impl Drop for Progress {
    fn drop(&mut self) {
        *self.shared.over.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.shared.wake.notify_all();
        if let Some(drawer) = self.drawer.take() {
            // It has nothing to say.
            let _ = drawer.join();
        }
    }
}

impl Shared {
    /// Draws until the work is over.
    fn draw(&self) {
        let mut bar: Option<ProgressBar> = None;
        let mut pause = PATIENCE;
        loop {
            let over = self.over.lock().unwrap_or_else(PoisonError::into_inner);
            let waited = self.wake.wait_timeout_while(over, pause, |over| !*over);
            if *waited.unwrap_or_else(PoisonError::into_inner).0 {
                break;
            }
            pause = INTERVAL;
            let bar = bar.get_or_insert_with(|| {
                let style = ProgressStyle::with_template("{spinner} {wide_msg}");
                ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()))
            });
            bar.set_message(self.now().text());
            bar.tick();
        }
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
    }

    fn now(&self) -> Now {
        let read = |number: &AtomicU64| number.load(Ordering::Relaxed);
        Now {
            what: self.what,
            counted: self.counted,
            elapsed: self.start.elapsed(),
            done: read(&self.done),
            begun: read(&self.begun),
            part: read(&self.part),
            whole: read(&self.whole),
        }
    }
}

/// How far the work is at a moment.
struct Now {
    what: &'static str,
    counted: bool,
    elapsed: Duration,
    done: u64,
    begun: u64,
    part: u64,
    whole: u64,
}

impl Now {
    // Counts far beyond 2^53 are approximate, as is all that is shown.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn text(&self) -> String {
        let (what, seconds) = (self.what, self.elapsed.as_secs_f64());
        if self.done <= self.begun {
            return format!("{what}, {} s", self.elapsed.as_secs());
        }
        let counted = self.counted && self.whole > 0;
        let of = if counted { format!(" of {}", HumanCount(self.whole)) } else { String::new() };
        let rate = (self.done - self.begun) as f64 / seconds.max(1e-3);
        let rate = if rate < 10.0 { format!("{rate:.1}") } else { HumanCount(rate.round() as u64).to_string() };
        let mut text = format!("{}{of} {what}", HumanCount(self.done));
        let share = (self.whole > 0).then(|| (self.part as f64 / self.whole as f64).min(1.0));
        if let Some(share) = share {
            text += &format!(" ({} %)", (share * 100.0).floor());
        }
        text += &format!(", {rate} {what}/s");
        let before = if counted { self.begun as f64 / self.whole as f64 } else { 0.0 };
        if let Some(share) = share.filter(|&share| share > before) {
            text += &format!(", {} left", span(seconds * (1.0 - share) / (share - before)));
        }
        text
    }
}

/// A time in the two units that matter.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn span(seconds: f64) -> String {
    // Beyond all patience the cast saturates.
    let seconds = seconds.ceil() as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        3600..86_400 => format!("{} h {} min", seconds / 3600, seconds % 3600 / 60),
        _ => format!("{} days {} h", HumanCount(seconds / 86_400), seconds % 86_400 / 3600),
    }
}

/// Shows how far a run is: along a curve its clocks, and the share of its pulses that were made; of a program its moves.
pub(crate) struct RunProgress {
    progress: Progress,
    pulses: Vec<usize>,
    /// Where a digest has them.
    trains: Vec<usize>,
    begun: bool,
}

impl RunProgress {
    /// Nothing is shown yet.
    pub(crate) fn new(bench: &Testbench, curve: &Curve) -> RunProgress {
        let progress = Progress::start("clocks", path_length(curve), false);
        let pulses = bench.machine().pulses.iter().map(|port| bench.columns().index(port.net)).collect();
        RunProgress { progress, pulses, trains: Vec::new(), begun: false }
    }

    /// Of a program of this many moves.
    pub(crate) fn of_moves(moves: u64) -> RunProgress {
        RunProgress { progress: Progress::of(moves, "moves"), pulses: Vec::new(), trains: Vec::new(), begun: false }
    }
}

impl RunProgress {
    /// This many samples from a clock on, with their pulses.
    fn show(&mut self, first_clock: u64, clocks: u64, pulses: u64) {
        let shared = &self.progress.shared;
        if !std::mem::replace(&mut self.begun, true) {
            shared.begun.store(first_clock, Ordering::Relaxed);
        }
        shared.part.fetch_add(pulses, Ordering::Relaxed);
        shared.done.store(first_clock + clocks - 1, Ordering::Relaxed);
    }
}

impl Onlookers for RunProgress {
    fn observers(&mut self) -> Vec<&mut dyn Observer> {
        vec![self]
    }
}

impl Observer for RunProgress {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        // Without a drawer nobody looks, and of a program moves are counted.
        if self.progress.drawer.is_none() || self.pulses.is_empty() || rows.is_empty() {
            return Ok(());
        }
        let made = |column: &usize| rows.column(*column).iter().map(|&pulse| u64::from(pulse != 0)).sum::<u64>();
        let pulses = self.pulses.iter().map(made).sum();
        self.show(rows.first_clock(), rows.len() as u64, pulses);
        Ok(())
    }

    fn want(&mut self, bench: &Testbench, wanted: &mut Wanted) -> bool {
        self.trains = bench.machine().pulses.iter().map(|port| wanted.train(port.net)).collect();
        true
    }

    fn digest(&mut self, digest: &Digest, _: &[u64]) {
        if self.progress.drawer.is_some() {
            let made =
                |&train: &usize| digest.trains[train].iter().map(|word| u64::from(word.count_ones())).sum::<u64>();
            self.show(digest.first_clock, digest.clocks, self.trains.iter().map(made).sum());
        }
    }

    fn block_ended(&mut self, _: &BlockReport) -> Result<(), ObserverError> {
        self.progress.add(1);
        Ok(())
    }

    fn recall(&mut self, _: &Memory) {
        // What share was done before is not known here.
        self.progress.shared.whole.store(0, Ordering::Relaxed);
    }
}

/// The pulses that the axes make along a curve, but for some at its corners.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn path_length(curve: &Curve) -> u64 {
    const CHORDS: usize = 1000;
    let straight = |axis: usize| curve.from()[axis].abs_diff(curve.to()[axis]);
    match curve {
        Curve::Line(_) => (0..curve.axes()).map(straight).sum(),
        round => {
            let outline = round.outline(CHORDS);
            let along = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0]).abs() + (pair[1][1] - pair[0][1]).abs();
            let plane: f64 = outline.windows(2).map(along).sum();
            plane.round() as u64 + (2..curve.axes()).map(straight).sum::<u64>()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn now(done: u64, part: u64, whole: u64) -> Now {
        Now { what: "clocks", counted: false, elapsed: Duration::from_secs(4), done, begun: 0, part, whole }
    }

    #[test]
    fn the_rate_is_what_was_done_by_the_time_that_it_took() {
        assert_eq!(now(8_000_000, 0, 0).text(), "8,000,000 clocks, 2,000,000 clocks/s");
        assert_eq!(now(10, 0, 0).text(), "10 clocks, 2.5 clocks/s");
        assert_eq!(now(0, 0, 0).text(), "clocks, 4 s");
        let resumed = Now { begun: 7_000_000, ..now(8_000_000, 0, 0) };
        assert_eq!(resumed.text(), "8,000,000 clocks, 250,000 clocks/s");
    }

    #[test]
    fn where_the_whole_is_known_there_are_per_cent_and_the_time_left() {
        assert_eq!(now(4_000, 30, 120).text(), "4,000 clocks (25 %), 1,000 clocks/s, 12 s left");
        let moves = Now { what: "moves", counted: true, ..now(300, 300, 1200) };
        assert_eq!(moves.text(), "300 of 1,200 moves (25 %), 75 moves/s, 12 s left");
        let resumed = Now { begun: 600, ..Now { what: "rows", counted: true, ..now(900, 900, 1200) } };
        assert_eq!(resumed.text(), "900 of 1,200 rows (75 %), 75 rows/s, 4 s left");
        // The pulses of an arc are known but for a few.
        assert_eq!(now(4_000, 121, 120).text(), "4,000 clocks (100 %), 1,000 clocks/s, 0 s left");
        assert_eq!(span(7_325.0), "2 h 2 min");
    }
}
