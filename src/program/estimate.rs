//! How long a program will run, before it does.

use std::io::BufRead;

use stepwave_models::Hardware;
use stepwave_models::program::{FASTEST_SPEED, Moves, Pacing};

use super::ProgramFailure;
use super::feed::{Pace, commanded, frequency, rate};
use super::stream::{Item, Preparation, Stream};

/// What a run of a program comes to, from its feeds and lengths.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Estimate {
    /// Clocks, dwells among them.
    pub clocks: f64,
    /// Steps of the interpolator.
    pub steps: f64,
    /// Those that move the machine.
    pub moving: f64,
    /// Those after which the phase of the pulse source is another one than before.
    pub drifting: f64,
}

/// Pulses for each BLU of the path, on the average of all directions.
const PULSES: f64 = 1.25;

impl Estimate {
    /// Reads the program once more, for this hardware and pace; `None` of hardware that sets its own feed, of which nothing is
    /// known.
    ///
    /// # Errors
    /// The program is wrong.
    pub fn of<R: BufRead>(
        text: R,
        moves: &'static dyn Moves,
        preparation: &Preparation,
        hardware: &Hardware,
        pace: Pace,
    ) -> Result<Option<Estimate>, ProgramFailure> {
        if let Pacing::Hardware { .. } = moves.pacing() {
            return Ok(None);
        }
        let mut estimate = Estimate::default();
        let mut speed = None;
        for item in Stream::new(text, moves, preparation)? {
            match item? {
                Item::Dwell(_, seconds) => estimate.clocks += (seconds * pace.clock_hz).round(),
                Item::Stop(_) | Item::LeftOut(..) => {}
                Item::Move(_, blocks) => {
                    let whole: f64 = blocks.iter().map(|block| block.curve.length()).sum();
                    if let Some(first) = blocks.first() {
                        speed = commanded(pace, first, whole, speed);
                    }
                    for block in &blocks {
                        for part in moves.words(hardware, block, FASTEST_SPEED)? {
                            let word = rate(pace, moves, block, &part, speed).word;
                            let source_hz = frequency(pace, word);
                            estimate.steps += part.steps;
                            estimate.moving += part.steps.min(part.length * PULSES);
                            // Where the source gives a pulse every 2^n clocks, its phase comes round.
                            estimate.drifting += if word.is_power_of_two() { 0.0 } else { part.steps };
                            // The next block is taken over in one clock.
                            estimate.clocks += part.steps * pace.clock_hz / source_hz + 1.0;
                        }
                    }
                }
            }
        }
        Ok(Some(estimate))
    }
}
