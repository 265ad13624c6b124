//! What a machine with acceleration after its interpolator sends to its drives: every pulse of it, how far it leaves the contour, and
//! the radius that arcs lose.

use std::collections::VecDeque;

use stepwave_engine::Rows;
use stepwave_models::Port;
use stepwave_models::program::After;
use stepwave_nc::{AXES_MAX, Position, SegmentShape, ToolMove};
use stepwave_netlist::bits::to_signed;

use super::contour::{Outline, radii_apart};
use super::tool::signed;
use super::{BlockReport, Observer, ObserverError, Testbench};

/// Most moves that may still be on their way; of more the last ones.
const MOVES: usize = 4096;
/// Arcs that are kept.
const ARCS: usize = 100;
/// Periods of an arc of which it may not be known yet whether it had ended: far more than an engine hands over at once.
const RECENT: usize = 1 << 14;

/// A place that the output has come to by a pulse.
#[derive(Clone, Copy, Debug)]
pub struct OutputPlace {
    /// Clock of the sample.
    pub clock: u64,
    /// Where it is, in BLU; 0 along an axis that the machine has not.
    pub place: Position,
    /// Distance in BLU from the nearest of the moves that may be on their way, a pulse of every axis as one BLU, and the line of
    /// that move; `None` where there is none.
    pub off: Option<(f64, u64)>,
}

/// A move of which something may still be to come.
#[derive(Clone, Debug)]
struct Passed {
    outline: Outline,
    line: u64,
    begun: u64,
    /// Where it has ended: the clock, and its mean displacement of a period in BLU.
    ended: Option<(u64, f64)>,
    arc: Option<Turning>,
}

/// An arc: its radius, and what it was at the ends of periods.
#[derive(Clone, Debug)]
struct Turning {
    of: ToolMove,
    radius: f64,
    /// Of the interpolator's radius less that of the output.
    sum: f64,
    count: u64,
    /// The same of the last periods, with their clocks: the end of a move is reported after its samples.
    recent: VecDeque<(u64, f64)>,
}

impl Turning {
    fn take(&mut self, clock: u64, lost: f64) {
        if self.recent.len() == RECENT {
            self.settle_first();
        }
        self.recent.push_back((clock, lost));
    }

    fn settle_first(&mut self) {
        if let Some((_, lost)) = self.recent.pop_front() {
            self.sum += lost;
            self.count += 1;
        }
    }

    /// It has ended at this clock.
    fn end(&mut self, clock: u64) {
        self.recent.retain(|(at, _)| *at <= clock);
    }

    /// The mean of all periods, if there are any.
    fn mean(mut self) -> Option<f64> {
        while !self.recent.is_empty() {
            self.settle_first();
        }
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// Where both are after a sample.
#[derive(Clone, Copy, Debug)]
struct Places {
    clock: u64,
    /// The interpolator.
    given: Position,
    /// The output, and that it has just moved.
    sent: Position,
    moved: bool,
}

/// Follows the output through samples.
#[derive(Clone, Debug)]
pub struct OutputTrack {
    after: After,
    /// Columns of the pulses of the interpolator, and of the output.
    columns: [Vec<usize>; 2],
    /// Where they are, in BLU.
    places: [Position; 2],
    /// Places of samples whose moves are not all known yet.
    pending: Vec<Places>,
    moves: VecDeque<Passed>,
    /// Index among the moves of that which was nearest.
    nearest: usize,
    /// The last end of a period that arcs were measured at, and where both are since the last pulse.
    measured: u64,
    before: [Position; 2],
    arcs: Vec<ArcLoss>,
}

/// The radius that an arc lost.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ArcLoss {
    /// Line of the program.
    pub line: u64,
    /// Its radius in BLU.
    pub radius: f64,
    /// Mean displacement of a period, in BLU.
    pub displacement: f64,
    /// What the [formula](After::radius_loss) says, in BLU.
    pub expected: f64,
    /// The mean radius of the interpolator less that of the output, both at the ends of periods, in BLU, from where what was before
    /// the arc has come out; `None` of an arc that is too short for that.
    pub measured: Option<f64>,
}

impl OutputTrack {
    /// That of a machine that has such an output.
    #[must_use]
    pub fn of(bench: &Testbench) -> Option<OutputTrack> {
        let ports = bench.machine().after.as_ref()?;
        let start = bench.start.iter().copied();
        let mut place = [0; AXES_MAX];
        place.iter_mut().zip(start).for_each(|(place, at)| *place = at);
        Some(OutputTrack {
            after: After::of(bench.hardware())?,
            columns: [&bench.machine().pulses, &ports.pulses]
                .map(|ports| ports.iter().map(|port| bench.columns().index(port.net)).collect()),
            places: [place; 2],
            pending: Vec::new(),
            moves: VecDeque::new(),
            nearest: 0,
            measured: 0,
            before: [place; 2],
            arcs: Vec::new(),
        })
    }

    /// A move has begun.
    pub fn begun(&mut self, block: &BlockReport) {
        let of = block.of;
        let arc = matches!(of.segment.shape, SegmentShape::Arc { .. }) && radii_apart(&of.segment) < 0.5;
        let outline = Outline::of(&of);
        let arc = arc.then(|| Turning { of, radius: outline.radius(), sum: 0.0, count: 0, recent: VecDeque::new() });
        if self.moves.len() == MOVES {
            self.leave();
        }
        self.moves.push_back(Passed { outline, line: of.place.line, begun: block.begun, ended: None, arc });
    }

    /// It has ended.
    pub fn ended(&mut self, block: &BlockReport) {
        let f = block.length * self.after.period as f64 / block.clocks.max(1) as f64;
        if let Some(last) = self.moves.back_mut() {
            let ended = block.begun + block.clocks;
            last.ended = Some((ended, f));
            if let Some(arc) = &mut last.arc {
                arc.end(ended);
            }
        }
    }

    /// Takes samples, and shows the places of those before them, whose moves have been reported by now.
    pub fn samples(&mut self, rows: &Rows, visit: impl FnMut(&OutputPlace)) {
        self.show(visit);
        for first in (0..rows.len()).step_by(64) {
            let any = |columns: &[usize]| columns.iter().fold(0, |seen, &column| seen | rows.nonzero(column, first));
            let sends = any(&self.columns[1]);
            let mut eventful = sends | any(&self.columns[0]);
            while eventful != 0 {
                let sample = eventful.trailing_zeros();
                let row = first + sample as usize;
                for (place, columns) in self.places.iter_mut().zip(&self.columns) {
                    for (place, &column) in place.iter_mut().zip(columns) {
                        *place = place.saturating_add(signed(rows.value(column, row)));
                    }
                }
                let [given, sent] = self.places;
                self.pending.push(Places { clock: rows.clock(row), given, sent, moved: sends >> sample & 1 == 1 });
                eventful &= eventful - 1;
            }
        }
    }

    /// The run is over: shows the rest.
    pub fn rest(&mut self, visit: impl FnMut(&OutputPlace)) {
        self.show(visit);
        while !self.moves.is_empty() {
            self.leave();
        }
    }

    fn show(&mut self, mut visit: impl FnMut(&OutputPlace)) {
        let mut pending = std::mem::take(&mut self.pending);
        for &Places { clock, given, sent, moved } in &pending {
            self.turn(clock);
            self.before = [given, sent];
            if !moved {
                continue;
            }
            let longest = self.after.longest();
            let is_over = |of: &Passed| of.ended.is_some_and(|(ended, _)| ended + longest < clock);
            while self.moves.len() > 1 && self.moves.front().is_some_and(is_over) {
                self.leave();
            }
            let off = self.off(sent);
            visit(&OutputPlace { clock, place: sent, off });
        }
        pending.clear();
        self.pending = pending;
    }

    /// The first of the moves is over.
    fn leave(&mut self) {
        let Some(Passed { line, ended, arc, .. }) = self.moves.pop_front() else { return };
        self.nearest = self.nearest.saturating_sub(1);
        if let (Some(arc), Some((_, f))) = (arc, ended) {
            let radius = arc.radius;
            let (expected, measured) = (self.after.radius_loss(f, radius), arc.mean());
            self.arcs.push(ArcLoss { line, radius, displacement: f, expected, measured });
        }
    }

    /// Distance from the nearest of the moves, and its line.
    fn off(&mut self, place: Position) -> Option<(f64, u64)> {
        // Within 2^53, as every position is.
        let at = place.map(|c| c as f64);
        let mut least = self.moves.get(self.nearest)?.outline.off(&at);
        for (index, passed) in self.moves.iter().enumerate() {
            if passed.outline.at_least(&at) < least {
                let off = passed.outline.off(&at);
                if off < least {
                    (least, self.nearest) = (off, index);
                }
            }
        }
        Some((least, self.moves[self.nearest].line))
    }

    /// Measures arcs at the ends of periods before this clock.
    fn turn(&mut self, clock: u64) {
        let period = self.after.period;
        if self.moves.iter().all(|passed| passed.arc.is_none()) {
            self.measured = (clock - 1) / period * period;
            return;
        }
        let settling = self.after.settling(self.after.most() as f64);
        let places = self.before.map(|place| place.map(|c| c as f64));
        while self.measured + period < clock {
            self.measured += period;
            let now = self.measured;
            for passed in &mut self.moves {
                let is_in = passed.begun + settling <= now && passed.ended.is_none_or(|(ended, _)| now <= ended);
                if let Some(arc) = passed.arc.as_mut().filter(|_| is_in) {
                    let [given, sent] = places.each_ref().map(|place| Outline::radius_at(&arc.of, place));
                    arc.take(now, given - sent);
                }
            }
        }
    }
}

/// The greatest distance of the output from the contour.
#[derive(Clone, PartialEq, Debug)]
pub struct OffContour {
    /// In BLU.
    pub distance: f64,
    /// Line of the move that is nearest there.
    pub line: u64,
    /// Clock.
    pub clock: u64,
    /// Where the output is, in BLU.
    pub place: Vec<i64>,
}

/// What a machine sent to its drives.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Sent {
    /// Pulses of each axis, in either direction.
    pub pulses: Vec<u64>,
    /// Where they led, in BLU.
    pub reached: Vec<i64>,
    /// What the position counters show in the last sample, in BLU.
    pub counters: Vec<i64>,
    /// The greatest distance from the contour of the tool's centre; `None` without a contour.
    pub off: Option<OffContour>,
    /// Arcs; the first of many.
    pub arcs: Vec<ArcLoss>,
    /// The one that loses most by the formula.
    pub worst: Option<ArcLoss>,
}

/// Looks on what a machine sends to its drives.
#[derive(Clone, Debug)]
pub struct OutputWatch {
    track: OutputTrack,
    positions: Vec<(usize, Port)>,
    sent: Sent,
}

impl OutputWatch {
    /// Of a machine that has such an output.
    #[must_use]
    pub fn of(bench: &Testbench) -> Option<OutputWatch> {
        let ports = &bench.machine().after.as_ref()?.positions;
        let positions = ports.iter().map(|port| (bench.columns().index(port.net), *port)).collect();
        let none = vec![0; ports.len()];
        let sent = Sent { pulses: vec![0; ports.len()], reached: none.clone(), counters: none, ..Sent::default() };
        Some(OutputWatch { track: OutputTrack::of(bench)?, positions, sent })
    }

    /// What was sent, after the run.
    #[must_use]
    pub fn finish(mut self) -> Sent {
        let sent = &mut self.sent;
        self.track.rest(|place| sent.take(place));
        sent.reached = self.track.places[1][..sent.reached.len()].to_vec();
        let arcs = &self.track.arcs;
        sent.worst = arcs.iter().copied().reduce(|a, b| if b.expected > a.expected { b } else { a });
        sent.arcs = arcs.iter().copied().take(ARCS).collect();
        self.sent
    }
}

impl Sent {
    fn take(&mut self, at: &OutputPlace) {
        let Some((distance, line)) = at.off else { return };
        if self.off.as_ref().is_none_or(|before| distance > before.distance) {
            let place = at.place[..self.pulses.len()].to_vec();
            self.off = Some(OffContour { distance, line, clock: at.clock, place });
        }
    }
}

impl Observer for OutputWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let OutputWatch { track, positions, sent } = self;
        for (all, &column) in sent.pulses.iter_mut().zip(&track.columns[1]) {
            *all += rows.column(column).iter().map(|pulse| pulse & 1).sum::<u64>();
        }
        if let Some(last) = rows.len().checked_sub(1) {
            for (counter, &(column, port)) in sent.counters.iter_mut().zip(positions.iter()) {
                *counter = to_signed(port.width, rows.value(column, last));
            }
        }
        track.samples(rows, |place| sent.take(place));
        Ok(())
    }

    fn block_begun(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        self.track.begun(block);
        Ok(())
    }

    fn block_ended(&mut self, block: &BlockReport) -> Result<(), ObserverError> {
        self.track.ended(block);
        Ok(())
    }
}
