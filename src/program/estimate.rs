//! How long a program will run, before it does.

use std::io::BufRead;

use stepwave_models::Hardware;
use stepwave_models::program::{After, Moves, Pacing};

use super::ProgramFailure;
use super::feed::Pace;
use super::planner::{Planned, Planner};
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
        let (mut estimate, mut planner) = (Estimate::default(), Planner::new(moves, hardware, pace));
        let after = After::of(hardware);
        for item in Stream::new(text, moves, preparation)? {
            match item? {
                Item::Dwell(_, seconds) => {
                    planner.stop();
                    estimate.clocks += pace.dwell(seconds);
                }
                Item::Stop(_) => planner.stop(),
                Item::LeftOut(..) => {}
                Item::Move(of, blocks) => planner.push(&of, &blocks, |_, _, _| ())?,
            }
            std::iter::from_fn(|| planner.next()).for_each(|planned| estimate.add(&planned, pace, after));
        }
        planner.stop();
        std::iter::from_fn(|| planner.next()).for_each(|planned| estimate.add(&planned, pace, after));
        Ok(Some(estimate))
    }

    fn add(&mut self, Planned { block, source, seconds, settles, .. }: &Planned<()>, pace: Pace, after: Option<After>) {
        let Some((word, source_hz)) = source else { return };
        self.steps += block.steps;
        self.moving += block.steps.min(block.length * PULSES);
        // Where the source gives a pulse every 2^n clocks, its phase comes round.
        self.drifting += if word.is_power_of_two() { 0.0 } else { block.steps };
        if let Some(after) = after.filter(|_| *settles) {
            self.clocks += after.settling(after.most() as f64) as f64;
        }
        // The next block is taken over in one clock.
        self.clocks += seconds.unwrap_or(block.steps / source_hz) * pace.clock_hz + 1.0;
    }
}
