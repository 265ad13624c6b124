//! Feeds: from F to the rate of the pulse source.

use stepwave_models::parts::{FASTEST_RATE, RATE_BITS};
use stepwave_models::program::{FASTEST_SPEED, HardwareBlock, Moves, Pacing};
use stepwave_nc::{Cause, Feed, PulseBlock};

/// The clock and the scale of a machine.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pace {
    /// Clock in Hz.
    pub clock_hz: f64,
    /// One BLU in millimetres.
    pub blu_mm: f64,
    /// Rapid feed in mm/min; `None` for as fast as the pulse source runs.
    pub rapid: Option<f64>,
}

/// What sets the speed of one block of the machine.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Rate {
    /// Pulses or BLU a clock, in 2^-32.
    pub(super) word: u64,
    /// More was asked for than there is, or less than the least.
    pub(super) limited: bool,
}

impl Rate {
    /// The nearest to this number of pulses or BLU a second, at most `most`.
    fn nearest(pace: Pace, hertz: f64, most: u64) -> Rate {
        let word = (hertz / pace.clock_hz * 2f64.powi(RATE_BITS.cast_signed())).round();
        // 0 for what is not a number.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let wanted = word as u64;
        Rate { word: wanted.clamp(1, most), limited: wanted > most || wanted == 0 }
    }
}

/// The commanded speed of a block, in BLU per second; `None` where it is as fast as the machine runs. `before` is that of
/// the block before, which a move inserted by compensation keeps.
#[must_use]
pub(super) fn commanded(pace: Pace, block: &PulseBlock, length: f64, before: Option<f64>) -> Option<f64> {
    let per_second = |feed: f64| feed / (60.0 * pace.blu_mm);
    match block.feed() {
        Feed::Rapid => pace.rapid.map(per_second),
        Feed::PerMinute(feed) => Some(per_second(feed)),
        Feed::Inverse(_) if block.cause() == Cause::Inserted => before,
        Feed::Inverse(number) => Some(length * number / 60.0),
    }
}

/// The rate of the pulse source for a block of the machine at this speed, in BLU per second.
///
/// f_g = v where the machine takes F as it is (60·δ·f_g is the feed along an axis), but with G93 and for feed rate numbers
/// f_g = v · steps / length, so that the block takes the time that is wanted.
#[must_use]
pub(super) fn rate(
    pace: Pace,
    moves: &dyn Moves,
    block: &PulseBlock,
    part: &HardwareBlock,
    speed: Option<f64>,
) -> Rate {
    let Some(speed) = speed else { return Rate { word: FASTEST_RATE, limited: false } };
    let timed = moves.pacing() != Pacing::Feed || matches!(block.feed(), Feed::Inverse(_));
    let hertz = if timed { speed * part.steps / part.length } else { speed };
    Rate::nearest(pace, hertz, FASTEST_RATE)
}

/// The commanded speed, in BLU per second, as a machine without our pulse source takes it.
#[must_use]
pub(super) fn own_speed(pace: Pace, speed: Option<f64>) -> Rate {
    let fastest = Rate { word: FASTEST_SPEED, limited: false };
    speed.map_or(fastest, |speed| Rate::nearest(pace, speed, FASTEST_SPEED))
}

/// The frequency that a rate gives, in Hz.
#[must_use]
pub(super) fn frequency(pace: Pace, word: u64) -> f64 {
    word as f64 / 2f64.powi(RATE_BITS.cast_signed()) * pace.clock_hz
}

/// The feed that the control shows of a block of the machine, in whole mm/min: the commanded one, in BLU per second, or else
/// what the pulse source gives.
#[must_use]
pub(super) fn shown_feed(pace: Pace, speed: Option<f64>, part: &HardwareBlock, source_hz: f64) -> u64 {
    let own = part.length * source_hz / part.steps;
    let feed = (speed.unwrap_or(own) * 60.0 * pace.blu_mm).round();
    // 0 for what is not a number, the greatest for what is beyond.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let feed = feed as u64;
    feed.min(u32::MAX.into())
}
