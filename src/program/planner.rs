//! From moves to blocks of the machine with their speeds: at once, or after a look at what follows where it accelerates.

use std::collections::VecDeque;

use stepwave_models::Hardware;
use stepwave_models::parts::SETTLE;
use stepwave_models::program::{Acceleration, After, HardwareBlock, Moves, Profile};
use stepwave_nc::{Cause, Coordinates, FeedAxes, PathControl, PulseBlock, ToolMove};

use super::ProgramFailure;
use super::corners::Corners;
use super::feed::{Pace, Paced, Pacer};
use super::lookahead::{Lookahead, Stretch, seconds};

/// A block of the machine with all its words, and what it was planned for.
#[derive(Clone, Debug)]
pub(super) struct Planned<T> {
    /// The block.
    pub(super) block: HardwareBlock,
    /// What our pulse source is given, in 2^-32 pulses a clock, and the frequency in Hz that it has then; `None` where the
    /// hardware sets its own feed.
    pub(super) source: Option<(u64, f64)>,
    /// The feed is out of reach of what sets it.
    pub(super) limited: bool,
    /// Seconds that it takes with acceleration; `None` where it has one speed.
    pub(super) seconds: Option<f64>,
    /// It begins only after the filters after the interpolator are empty.
    pub(super) settles: bool,
    /// What it is of.
    pub(super) of: T,
}

/// Plans the blocks of a machine.
pub(super) struct Planner<'a, T> {
    pacer: Pacer<'a>,
    ahead: Option<Ahead<T>>,
    corners: Option<Corners>,
    /// Blocks whose words are known.
    planned: VecDeque<Planned<T>>,
}

/// What is known of a machine that accelerates.
struct Ahead<T> {
    by: Acceleration,
    queue: Lookahead<(Paced, T)>,
    /// Parts of one ramp that wait for those before them.
    ready: VecDeque<Planned<T>>,
    /// How the move before ends, unless the machine stops there.
    end: Option<(PathControl, FeedAxes, Coordinates)>,
    /// Pulses of a BLU in the part before.
    scale: Option<f64>,
}

impl<'a, T> Planner<'a, T> {
    pub(super) fn new(moves: &'static dyn Moves, hardware: &'a Hardware, pace: Pace) -> Planner<'a, T> {
        let ahead = Acceleration::of(hardware).map(|by| {
            let jump = pace.jump.map_or_else(|| by.start(), |jump| jump / (60.0 * pace.blu_mm));
            Ahead { by, queue: Lookahead::new(by, jump), ready: VecDeque::new(), end: None, scale: None }
        });
        let corners = After::of(hardware).map(|after| Corners::new(after, pace));
        Planner { pacer: Pacer::new(moves, hardware, pace), ahead, corners, planned: VecDeque::new() }
    }

    /// Takes the next move, and with each of its parts what `of` makes of the block and of whether it is the first of it.
    ///
    /// # Errors
    /// The machine does not take a block.
    pub(super) fn push(
        &mut self,
        of: &ToolMove,
        blocks: &[PulseBlock],
        mut with: impl FnMut(&Pacer<'a>, &PulseBlock, bool) -> T,
    ) -> Result<(), ProgramFailure> {
        self.pacer.begin(blocks);
        let mut joint = self.ahead.as_mut().map_or(f64::INFINITY, |ahead| ahead.joint(of));
        for block in blocks {
            for (index, paced) in self.pacer.blocks(block)?.into_iter().enumerate() {
                let what = with(&self.pacer, block, index == 0);
                match &mut self.ahead {
                    None => {
                        let settles = self.corners.as_mut().map(|corners| corners.settles(block, &paced));
                        self.planned.push_back(at_once(paced, what, settles));
                    }
                    Some(ahead) => {
                        ahead.push(of, paced, self.pacer.speed, std::mem::replace(&mut joint, f64::INFINITY), what)
                    }
                }
            }
        }
        self.settle();
        Ok(())
    }

    /// The machine stops here.
    pub(super) fn stop(&mut self) {
        if let Some(ahead) = &mut self.ahead {
            ahead.queue.stop();
            ahead.end = None;
        }
        if let Some(corners) = &mut self.corners {
            corners.stop();
        }
        self.settle();
    }

    fn settle(&mut self) {
        if let Some(ahead) = &mut self.ahead {
            self.planned.extend(std::iter::from_fn(|| ahead.pop()));
        }
    }

    /// The next block whose words are known.
    pub(super) fn next(&mut self) -> Option<Planned<T>> {
        self.planned.pop_front()
    }
}

/// A block at one speed. `settles`, where there are filters after the interpolator: they are to be empty before.
fn at_once<T>(Paced { block, source, limited, .. }: Paced, of: T, settles: Option<bool>) -> Planned<T> {
    let words = match settles {
        None => block.words,
        Some(settles) => block.words.set(SETTLE, settles),
    };
    Planned {
        block: HardwareBlock { words, ..block },
        source,
        limited,
        seconds: None,
        settles: settles == Some(true),
        of,
    }
}

impl<T> Ahead<T> {
    /// The greatest speed at the start of a move.
    fn joint(&mut self, of: &ToolMove) -> f64 {
        let jump = self.queue.jump();
        let Some([start, end]) = of.directions() else { return jump };
        // A speed along other axes is none to compare with.
        let before = self.end.replace((of.path, of.feed_axes(), end)).filter(|before| before.1 == of.feed_axes());
        // What compensation puts in belongs to the block before it.
        let path = |path: PathControl| if of.cause == Cause::Inserted { of.path } else { path };
        before.map_or(jump, |before| self.queue.joint(path(before.0), of.feed_axes(), [before.2, start]))
    }

    fn push(&mut self, of: &ToolMove, paced: Paced, speed: Option<f64>, joint: f64, what: T) {
        let fastest = self.by.fastest(paced.pulses_per_blu);
        let bend = of.segment.bend().map_or(f64::INFINITY, |radius| self.queue.bend(radius));
        let cap = speed.unwrap_or(fastest).min(fastest).min(bend);
        // The way that the source counts, at the speed that it is given.
        let length = paced.block.steps / paced.pulses_per_blu;
        self.queue.push(Stretch { length, cap, joint, pulses: paced.block.steps }, (paced, what));
    }

    fn pop(&mut self) -> Option<Planned<T>> {
        if self.ready.is_empty() {
            let (parts, speeds) = self.queue.pop()?;
            self.plan(parts, speeds);
        }
        self.ready.pop_front()
    }

    /// Plans parts of one ramp, with the speeds at its start, on the way and at its end.
    fn plan(&mut self, parts: Vec<(Paced, T)>, speeds: [f64; 3]) {
        let [_, cap, exit] = speeds;
        let mut left: f64 = parts.iter().map(|(paced, _)| paced.block.steps).sum();
        let Some(k) = parts.first().map(|(paced, _)| paced.pulses_per_blu) else { return };
        let all = left;
        let seconds = seconds(&self.by, all / k, speeds);
        // The greatest speed from which the end can be met.
        let from = |left: f64| (exit * exit + 2.0 * self.by.gains[1] * left.max(0.0) / k).sqrt();
        for (index, (Paced { block, source, limited, .. }, of)) in parts.into_iter().enumerate() {
            let before = self.scale.replace(k).unwrap_or(k);
            let (pulses, own) = (left, block.steps);
            let is_first = index == 0;
            left -= own;
            let speeds = if is_first { speeds } else { [from(pulses), cap, from(left)] };
            let profile = Profile { speeds, jump: self.queue.jump().min(cap), pulses_per_blu: k, before, pulses, own };
            let (words, hz) = if is_first { self.by.words(&profile) } else { self.by.carried(&profile) };
            let block = HardwareBlock { words: block.words.clone().and(words), ..block };
            let source = source.map(|(word, _)| (word, hz));
            let seconds = Some(seconds * own / all);
            self.ready.push_back(Planned { block, source, limited, seconds, settles: false, of });
        }
    }
}
