//! Looking ahead: the speeds at which the blocks of a program meet, so that no axis jumps by more than it can, and the
//! machine always can stop in time.
//!
//! A block waits until what follows it is as long as the braking distance from its own speed, or a stop follows: then
//! nothing further on can change the speed at its end. With a jerk, blocks that follow each other in one direction at one speed have one
//! ramp: else each had an S of its own, slower the shorter it is.

use std::collections::VecDeque;

use stepwave_models::program::Acceleration;
use stepwave_nc::{Coordinates, FeedAxes, PathControl};

/// Most blocks that wait, and most that have one ramp. With more of them as short a stop is assumed after the last.
const MOST: usize = 4096;

/// Halvings by which a speed is found that has no formula: to a part in 2^30.
const BISECTIONS: usize = 30;

/// What a part of a block is to the plan; lengths in BLU, speeds in BLU/s.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Stretch {
    /// Its length.
    pub(super) length: f64,
    /// The greatest speed in it.
    pub(super) cap: f64,
    /// The greatest speed at which it may be entered from what was before.
    pub(super) joint: f64,
    /// Pulses of the source.
    pub(super) pulses: f64,
}

impl Stretch {
    /// It can have one ramp with what was before: the path and the scale of its pulses go on, at the same speed.
    fn continues(&self, before: &Stretch) -> bool {
        let [scale, other] = [self, before].map(|of| of.pulses / of.length);
        self.joint == f64::INFINITY && self.cap == before.cap && (scale - other).abs() <= 1e-9 * other
    }
}

/// Parts that wait for what follows them.
#[derive(Debug)]
pub(super) struct Lookahead<T> {
    by: Acceleration,
    jump: f64,
    queue: VecDeque<(Stretch, Vec<T>)>,
    /// Speed at which the first of them begins.
    entry: f64,
    /// It begins there from a stop.
    rests: bool,
    /// How many of them are before the first stop, if there is one.
    stop: Option<usize>,
    /// Length of all but the first.
    beyond: f64,
}

impl<T> Lookahead<T> {
    /// With nothing in it. An axis can start, stop and change by `jump` in BLU/s at once.
    pub(super) fn new(by: Acceleration, jump: f64) -> Lookahead<T> {
        Lookahead { by, jump, queue: VecDeque::new(), entry: jump, rests: true, stop: None, beyond: 0.0 }
    }

    /// The speed in BLU/s by which an axis may change at once.
    pub(super) fn jump(&self) -> f64 {
        self.jump
    }

    /// The greatest speed on a path with this radius of curvature in BLU.
    pub(super) fn bend(&self, radius: f64) -> f64 {
        (self.by.gains[0].min(self.by.gains[1]) * radius).sqrt().max(self.jump)
    }

    /// The greatest speed at which a corner between two directions may be passed, along these axes; others turn as much as they
    /// must.
    pub(super) fn joint(&self, path: PathControl, along: FeedAxes, [before, after]: [Coordinates; 2]) -> f64 {
        let changes = before.into_iter().zip(after).map(|(before, after)| (after - before).abs());
        // What rounding leaves of two equal directions is none.
        let by_axis =
            changes.filter(|change| *change > 1e-9).map(|change| self.jump / change).fold(f64::INFINITY, f64::min);
        let by_path = match path {
            PathControl::Exact => 0.0,
            PathControl::Continuous => by_axis,
            PathControl::Within(off) => {
                let along: f64 = along.axes().map(|axis| before[axis] * after[axis]).sum();
                // Of the angle between both legs, of which a straight path has 180 degrees.
                let sine = ((1.0 + along) / 2.0).max(0.0).sqrt();
                let limit = self.by.gains[0].min(self.by.gains[1]) * off * sine / (1.0 - sine);
                if sine < 1.0 { by_axis.min(limit.sqrt()) } else { by_axis }
            }
        };
        by_path.max(self.jump)
    }

    /// Takes the next part.
    pub(super) fn push(&mut self, stretch: Stretch, what: T) {
        let before = self.queue.back().map(|(before, _)| *before);
        let follows = before.is_some_and(|before| stretch.continues(&before));
        if !self.queue.is_empty() {
            self.beyond += stretch.length;
        }
        let is_short = before.is_some_and(|before| before.length < 2.0 * self.braking_distance(before.cap));
        self.queue.push_back((stretch, vec![what]));
        if follows && is_short {
            self.join();
        } else if !follows && self.queue.len() > 1 {
            let last = self.queue.pop_back();
            self.join_rest();
            self.queue.extend(last);
        }
    }

    /// Gives the last ones a common ramp with those before them, if they can have one.
    fn join(&mut self) {
        let Some((stretch, parts)) = self.queue.pop_back() else { return };
        let (one, most) = (self.queue.len() == 1, self.by.most_pulses());
        match self.queue.back_mut() {
            Some((before, all))
                if self.by.jerk.is_some()
                    && stretch.continues(before)
                    && before.pulses + stretch.pulses <= most
                    && all.len() + parts.len() <= MOST =>
            {
                before.length += stretch.length;
                before.pulses += stretch.pulses;
                all.extend(parts);
                if one {
                    // All of it is in the first now.
                    self.beyond -= stretch.length;
                }
            }
            _ => self.queue.push_back((stretch, parts)),
        }
    }

    /// What is left at the end of a chain has no ramp of its own where it is shorter than one.
    fn join_rest(&mut self) {
        if self.queue.len() > 1
            && self.queue.back().is_some_and(|(last, _)| last.length < self.braking_distance(last.cap))
        {
            self.join();
        }
    }

    /// The machine stops after what has been taken so far, all of which is to be taken out before more is put in.
    pub(super) fn stop(&mut self) {
        if !self.queue.is_empty() && self.stop.is_none() {
            self.join_rest();
            self.stop = Some(self.queue.len());
        }
    }

    /// The first part, or those that have one ramp, if nothing that follows can change it, with the speeds at its start, in it
    /// and at its end.
    pub(super) fn pop(&mut self) -> Option<(Vec<T>, [f64; 3])> {
        let Stretch { cap, length, .. } = self.queue.front()?.0;
        let settled = self.stop.is_some() || self.queue.len() > MOST || self.beyond >= self.braking_distance(cap);
        if !settled {
            return None;
        }
        let known = self.stop.unwrap_or(self.queue.len());
        // From the end back: what can still be slowed down.
        let mut exit = self.jump;
        for (index, (stretch, _)) in self.queue.iter().enumerate().take(known).skip(1).rev() {
            let before = self.queue.get(index - 1).map_or(f64::INFINITY, |(before, _)| before.cap);
            exit = self.reach(exit.min(stretch.cap), stretch.length, 1);
            exit = exit.min(stretch.joint).min(stretch.cap).min(before);
        }
        // From a stop it begins no faster than it can brake.
        let entry =
            self.entry.min(cap).min(if self.rests { self.reach(exit.min(cap), length, 1) } else { f64::INFINITY });
        let exit = exit.min(cap).min(self.reach(entry, length, 0));
        let (_, what) = self.queue.pop_front()?;
        let next = self.queue.front().map_or(0.0, |(next, _)| next.length);
        self.beyond = if self.queue.len() > 1 { self.beyond - next } else { 0.0 };
        self.rests = self.stop == Some(1);
        self.entry = if self.rests { self.jump } else { exit };
        self.stop = self.stop.map(|parts| parts - 1).filter(|parts| *parts > 0);
        Some((what, [entry, cap, exit]))
    }

    /// The speed that is reached from another on this length, accelerating or, looked at backwards, braking (`gain` 1).
    fn reach(&self, from: f64, length: f64, gain: usize) -> f64 {
        let gain = self.by.gains[gain];
        let without_jerk = (from * from + 2.0 * gain * length).sqrt();
        let Some(jerk) = self.by.jerk else { return without_jerk };
        // A ramp along an S gains less.
        let (mut low, mut high) = (from, without_jerk);
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(low, high);
            if s_length(from, middle, gain, jerk) <= length { low = middle } else { high = middle }
        }
        low
    }

    /// The length in BLU from a speed down to a stop.
    fn braking_distance(&self, speed: f64) -> f64 {
        let gain = self.by.gains[1];
        self.by.jerk.map_or(speed * speed / (2.0 * gain), |jerk| s_length(0.0, speed, gain, jerk))
    }
}

/// The length of an S between two speeds: their mean, for D/A + A/J, or 2·sqrt(D/J) where A is not reached.
fn s_length(low: f64, high: f64, gain: f64, jerk: f64) -> f64 {
    let difference = high - low;
    let seconds = if difference >= gain * gain / jerk {
        difference / gain + gain / jerk
    } else {
        2.0 * (difference / jerk).sqrt()
    };
    f64::midpoint(low, high) * seconds
}

/// The seconds that a part takes, whose speeds these are.
pub(super) fn seconds(by: &Acceleration, length: f64, [start, drive, stop]: [f64; 3]) -> f64 {
    let ramp = |low: f64, high: f64, gain: f64| match by.jerk {
        None => [(high * high - low * low) / (2.0 * gain), (high - low) / gain],
        Some(jerk) => {
            let distance = s_length(low, high, gain, jerk);
            [distance, distance / f64::midpoint(low, high)]
        }
    };
    let at = |drive: f64| [ramp(start, drive, by.gains[0]), ramp(stop, drive, by.gains[1])];
    let (mut low, mut high) = (start.max(stop), drive.max(start).max(stop));
    let fits = |drive: f64| at(drive).iter().map(|[distance, _]| distance).sum::<f64>() <= length;
    if fits(high) {
        low = high;
    } else {
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(low, high);
            if fits(middle) { low = middle } else { high = middle }
        }
    }
    let [[up, rising], [down, falling]] = at(low);
    rising + falling + (length - up - down).max(0.0) / low
}
