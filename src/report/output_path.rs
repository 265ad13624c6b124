//! The path of the output of acceleration after the interpolator, for the picture of a program: where it leaves the contour.

use super::plot::Pair;
use crate::engine::Rows;
use crate::testbench::{BlockReport, OutputPlace, OutputTrack};

/// Points that are kept; when they are full, every second one goes.
const LIMIT: usize = 1 << 13;
/// Distance in BLU from the contour from which on it is drawn: interpolators and rounding leave it by less.
const DRAWN: f64 = 1.5;

/// Collects the pieces of it.
#[derive(Clone, Debug)]
pub(super) struct OutputPath {
    track: OutputTrack,
    pieces: Pieces,
}

#[derive(Clone, Debug)]
struct Pieces {
    axes: [usize; 2],
    all: Vec<Vec<Pair>>,
    points: usize,
    stride: u64,
    seen: u64,
    /// The last place was drawn.
    open: bool,
}

impl OutputPath {
    /// Of this output, as seen in two axes.
    pub(super) fn new(track: OutputTrack, axes: [usize; 2]) -> OutputPath {
        let (all, points, stride, seen, open) = (Vec::new(), 0, 1, 0, false);
        OutputPath { track, pieces: Pieces { axes, all, points, stride, seen, open } }
    }

    /// Takes samples; `visit` gets each place too.
    pub(super) fn samples(&mut self, rows: &Rows, mut visit: impl FnMut(&OutputPlace)) {
        let OutputPath { track, pieces } = self;
        track.samples(rows, |place| {
            pieces.take(place);
            visit(place);
        });
    }

    pub(super) fn begun(&mut self, block: &BlockReport) {
        self.track.begun(block);
    }

    pub(super) fn ended(&mut self, block: &BlockReport) {
        self.track.ended(block);
    }

    pub(super) fn finish(&mut self, mut visit: impl FnMut(&OutputPlace)) {
        let OutputPath { track, pieces } = self;
        track.rest(|place| {
            pieces.take(place);
            visit(place);
        });
    }

    /// The pieces, each its points.
    pub(super) fn pieces(&self) -> &[Vec<Pair>] {
        &self.pieces.all
    }
}

impl Pieces {
    fn take(&mut self, at: &OutputPlace) {
        let drawn = at.off.is_some_and(|(off, _)| off > DRAWN);
        let was = std::mem::replace(&mut self.open, drawn);
        if !drawn {
            return;
        }
        if !was {
            self.all.push(Vec::new());
        }
        self.seen += 1;
        // Within 2^53, as every position is.
        let point = self.axes.map(|axis| at.place[axis] as f64);
        if was && !self.seen.is_multiple_of(self.stride) {
            return;
        }
        if let Some(points) = self.all.last_mut().filter(|points| points.last() != Some(&point)) {
            points.push(point);
            self.points += 1;
        }
        if self.points >= LIMIT {
            self.thin();
        }
    }

    fn thin(&mut self) {
        self.stride *= 2;
        for points in &mut self.all {
            let last = points.last().copied();
            *points = points.iter().step_by(2).copied().collect();
            points.extend(last.filter(|last| points.last() != Some(last)));
        }
        let count = |all: &[Vec<Pair>]| all.iter().map(Vec::len).sum();
        self.points = count(&self.all);
        if self.points > LIMIT / 4 * 3 {
            // Nothing but short pieces: the oldest go.
            self.all.drain(..self.all.len() / 2);
            self.points = count(&self.all);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_where_it_is_off_and_stay_few() {
        let mut pieces = Pieces { axes: [1, 0], all: Vec::new(), points: 0, stride: 1, seen: 0, open: false };
        for index in 0..50_000_i64 {
            let off = if index % 1000 < 400 { 2.0 } else { 1.0 };
            let mut place = [0; 9];
            (place[0], place[1]) = (index, -index);
            pieces.take(&OutputPlace { clock: 0, place, off: Some((off, 1)) });
        }
        assert_eq!(pieces.all.len(), 50);
        assert!(pieces.points < LIMIT && pieces.stride > 1, "{}", pieces.points);
        for (first, points) in (0_i32..).zip(&pieces.all) {
            assert_eq!(points[0], [-1000.0 * f64::from(first), 1000.0 * f64::from(first)]);
            assert!(points.iter().all(|[y, x]| *x == -*y && *x % 1000.0 < 400.0));
        }
    }
}
