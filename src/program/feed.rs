//! Feeds: from F to the rate of the pulse source.

use stepwave_models::Hardware;
use stepwave_models::parts::{FASTEST_RATE, PULSE_RATE, RATE_BITS};
use stepwave_models::program::{Acceleration, FASTEST_SPEED, HardwareBlock, Moves, PROGRAM_WORDS, Pacing};
use stepwave_nc::{Cause, Feed, FeedAxes, PulseBlock};

use super::ProgramFailure;

/// The clock and the scale of a machine.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pace {
    /// Clock in Hz.
    pub clock_hz: f64,
    /// One BLU in millimetres.
    pub blu_mm: f64,
    /// One BLU of a rotary axis in degrees.
    pub blu_degrees: f64,
    /// Rapid feed in mm/min; `None` for as fast as the pulse source runs.
    pub rapid: Option<f64>,
    /// Speed in mm/min at which an axis of a machine that accelerates can start and stop, and by which it can change at
    /// once; `None` for the least with which no pulse is waited for.
    pub jump: Option<f64>,
}

impl Pace {
    /// The nearest to this number of pulses or BLU a second, in 2^-32 a clock and at most `most`.
    fn nearest(self, hertz: f64, most: u64) -> Rate {
        let word = (hertz / self.clock_hz * 2f64.powi(RATE_BITS.cast_signed())).round();
        // 0 for what is not a number.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let wanted = word as u64;
        Rate { word: wanted.clamp(1, most), limited: wanted > most || wanted == 0 }
    }

    /// The frequency that a rate gives, in Hz.
    fn frequency(self, word: u64) -> f64 {
        word as f64 / 2f64.powi(RATE_BITS.cast_signed()) * self.clock_hz
    }

    /// The commanded speed of a move of this length, in BLU per second; `None` where it is as fast as the machine runs.
    /// `before` is that of the move before, which one inserted by compensation keeps.
    fn commanded(self, block: &PulseBlock, length: f64, before: Option<f64>) -> Option<f64> {
        let blu = if block.of.feed_axes() == FeedAxes::Rotary { self.blu_degrees } else { self.blu_mm };
        let per_second = |feed: f64| feed / (60.0 * blu);
        match block.feed() {
            Feed::Rapid => self.rapid.map(per_second),
            Feed::PerMinute(feed) => Some(per_second(feed)),
            Feed::Inverse(_) if block.cause() == Cause::Inserted => before,
            Feed::Inverse(number) => Some(length * number / 60.0),
        }
    }

    /// A dwell of this many seconds in clocks, a whole number.
    pub(super) fn dwell(self, seconds: f64) -> f64 {
        (seconds * self.clock_hz).round()
    }
}

/// What sets the speed of one block of the machine.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Rate {
    /// Pulses or BLU a clock, in 2^-32.
    word: u64,
    /// More was asked for than there is, or less than the least.
    limited: bool,
}

/// Gives each block of the machine its speed, move by move.
pub(super) struct Pacer<'a> {
    moves: &'static dyn Moves,
    hardware: &'a Hardware,
    pace: Pace,
    /// The commanded speed of the present move, in BLU per second; `None` where it is as fast as the machine runs.
    pub(super) speed: Option<f64>,
    accelerates: bool,
}

/// A block of the machine with its speed.
pub(super) struct Paced {
    /// The block, with all its words.
    pub(super) block: HardwareBlock,
    /// What our pulse source is given, in 2^-32 pulses a clock, and the frequency in Hz that it has then; `None` where the
    /// hardware sets its own feed.
    pub(super) source: Option<(u64, f64)>,
    /// The feed is out of reach of what sets it.
    pub(super) limited: bool,
    /// Pulses of our source for a BLU of the path at the speed that it is given.
    pub(super) pulses_per_blu: f64,
}

impl<'a> Pacer<'a> {
    pub(super) fn new(moves: &'static dyn Moves, hardware: &'a Hardware, pace: Pace) -> Pacer<'a> {
        Pacer { moves, hardware, pace, speed: None, accelerates: Acceleration::of(hardware).is_some() }
    }

    /// Begins a move of these blocks.
    pub(super) fn begin(&mut self, blocks: &[PulseBlock]) {
        let length = blocks.iter().map(|block| block.length()).sum();
        if let Some(first) = blocks.first() {
            self.speed = self.pace.commanded(first, length, self.speed);
        }
    }

    /// What the machine is loaded with for a block of that move, in order.
    ///
    /// # Errors
    /// The machine does not take the block.
    pub(super) fn blocks(&self, block: &PulseBlock) -> Result<Vec<Paced>, ProgramFailure> {
        let fastest = Rate { word: FASTEST_SPEED, limited: false };
        let own = self.speed.map_or(fastest, |speed| self.pace.nearest(speed, FASTEST_SPEED));
        let parts = self.moves.words(self.hardware, block, own.word);
        let parts = parts.map_err(|error| ProgramFailure::Block { line: block.of.place.line, error })?;
        let paced = |part| match self.moves.pacing() {
            Pacing::Hardware { reads_speed } => {
                Paced { block: part, source: None, limited: reads_speed && own.limited, pulses_per_blu: 1.0 }
            }
            pacing => self.by_source(block, part, pacing == Pacing::Feed),
        };
        Ok(parts.into_iter().map(paced).collect())
    }

    /// A block at the speed of our pulse source.
    ///
    /// f_g = v where the machine takes F as it is (60·δ·f_g is the feed along an axis), but with G93 and for feed rate
    /// numbers f_g = v · steps / length, so that the block takes the time that is wanted; so too where axes move that F is
    /// not along.
    fn by_source(&self, block: &PulseBlock, part: HardwareBlock, takes_feed: bool) -> Paced {
        let timed = !takes_feed || matches!(block.feed(), Feed::Inverse(_)) || block.carries_others();
        let pulses_per_blu = if timed { part.steps / part.length } else { 1.0 };
        let hertz = |speed| speed * pulses_per_blu;
        let fastest = Rate { word: FASTEST_RATE, limited: false };
        let Rate { word, limited } = self.speed.map_or(fastest, |speed| self.pace.nearest(hertz(speed), FASTEST_RATE));
        let hz = self.pace.frequency(word);
        let place = block.place();
        let [shown, speed] = PROGRAM_WORDS;
        let words = part.words.set(shown, place.number.unwrap_or(place.line));
        // A machine that accelerates learns its speeds when those of the next blocks are known.
        let words = if self.accelerates { words } else { words.set(PULSE_RATE, word) };
        let words = words.set(speed, self.shown_feed(part.steps, part.length, hz));
        Paced { block: HardwareBlock { words, ..part }, source: Some((word, hz)), limited, pulses_per_blu }
    }

    /// The feed that the control shows of a block, in whole mm/min: the commanded one, or else what the pulse source gives.
    fn shown_feed(&self, steps: f64, length: f64, source_hz: f64) -> u64 {
        let own = length * source_hz / steps;
        let feed = (self.speed.unwrap_or(own) * 60.0 * self.pace.blu_mm).round();
        // 0 for what is not a number, the greatest for what is beyond.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let feed = feed as u64;
        feed.min(u32::MAX.into())
    }
}
