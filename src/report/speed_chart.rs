//! The speed of a program over time, for its picture: over 32 steps each, in bounded memory.

use std::ops::Range;

use stepwave_nc::{FeedAxes, Position, ToolMove};

use super::plot::{Page, Pair, View};
use crate::testbench::SpeedTrack;

/// Spans of time that are kept; when they are full, neighbours merge.
const SPAN_LIMIT: usize = 512;
/// Seconds up to which time is shown in milliseconds.
const FEW_SECONDS: f64 = 20.0;

/// Collects the speed, step by step.
#[derive(Clone, Debug)]
pub(super) struct SpeedChart {
    hz: f64,
    /// mm/min, and degrees/min of rotary axes, of a BLU a clock.
    units: [f64; 2],
    /// Which of both the present block has, by index; and which there were.
    unit: usize,
    had: [bool; 2],
    /// The axes that the feed of the block is along.
    along: Range<usize>,
    track: SpeedTrack,
    /// Clock of the last row; `None` before the first.
    clock: Option<u64>,
    /// Least and greatest speed of spans of `width` clocks from clock 0 on, where there was one.
    spans: Vec<Option<Pair>>,
    width: u64,
}

fn union(a: Option<Pair>, b: Option<Pair>) -> Option<Pair> {
    match (a, b) {
        (Some([least, most]), Some([other, others])) => Some([least.min(other), most.max(others)]),
        (a, b) => a.or(b),
    }
}

impl SpeedChart {
    /// With this clock in Hz, and these BLU in mm and in degrees.
    pub(super) fn new(hz: f64, blu: [f64; 2]) -> SpeedChart {
        let (along, track, units) = (0..3, SpeedTrack::new(3), blu.map(|blu| 60.0 * hz * blu));
        let (clock, spans) = (None, Vec::new());
        SpeedChart { hz, units, unit: 0, had: [false; 2], along, track, clock, spans, width: 1 }
    }

    /// A block begins, whose feed may be along other axes: no window reaches over from those before.
    pub(super) fn begin(&mut self, of: &ToolMove) {
        let along = of.path_axes();
        self.unit = usize::from(of.feed_axes() == FeedAxes::Rotary);
        self.had[self.unit] = true;
        if along != self.along {
            (self.track, self.along) = (SpeedTrack::new(along.len()), along);
        }
    }

    /// Takes the place after a step, and its clock: the speed has been that of the window since the step before.
    pub(super) fn step(&mut self, position: &[i64], clock: u64) {
        let before = self.clock.replace(clock);
        if before.is_some_and(|before| before >= clock) {
            return;
        }
        let place: Position = std::array::from_fn(|axis| position.get(axis).copied().unwrap_or(0));
        let Some(window) = self.track.row(&place[self.along.clone()], clock) else { return };
        let speed = self.units[self.unit] * window.speed();
        while clock / self.width >= SPAN_LIMIT as u64 {
            let merged = self.spans.chunks(2).map(|pair| pair.iter().copied().fold(None, union));
            self.spans = merged.collect();
            self.width *= 2;
        }
        // Both below the limit.
        let [from, to] = [before.unwrap_or(clock), clock].map(|clock| usize::try_from(clock / self.width).unwrap_or(0));
        self.spans.resize(self.spans.len().max(to + 1), None);
        for span in &mut self.spans[from..=to] {
            *span = union(*span, Some([speed; 2]));
        }
    }

    /// Greatest speed; `None` where there was none.
    fn greatest(&self) -> Option<f64> {
        self.spans.iter().flatten().map(|[_, most]| *most).reduce(f64::max)
    }

    /// What it shows at a place, of a size; nothing where there was no speed.
    pub(super) fn view(&self, origin: Pair, size: Pair) -> Option<View> {
        let greatest = self.greatest()?;
        let end = self.time((self.clock? + 1) as f64);
        Some(View { origin, size, ranges: [[-0.012 * end, 1.012 * end], [0.0, 1.1 * greatest.max(1e-9)]] })
    }

    fn in_milliseconds(&self) -> bool {
        self.clock.is_none_or(|clock| (clock as f64) < FEW_SECONDS * self.hz)
    }

    /// The time of a clock, in the unit that is shown.
    fn time(&self, clocks: f64) -> f64 {
        clocks / self.hz * if self.in_milliseconds() { 1e3 } else { 1.0 }
    }

    /// Draws an area from the least to the greatest speed of each span, of the tool or of the output after a filter.
    pub(super) fn draw(&self, page: &mut Page, view: &View, of_output: bool) {
        let unit = if self.in_milliseconds() { "ms" } else { "s" };
        let speed = match self.had {
            [_, false] => "mm/min",
            [false, true] => "degrees/min",
            [true, true] => "mm/min or degrees/min",
        };
        let of = if of_output { "output's speed" } else { "speed" };
        let rotary = if self.had == [true; 2] { "; where A, B, C move alone in degrees" } else { "" };
        let below = format!("time ({unit}); {of} along the axes of F over 32 steps{rotary}");
        page.axes(view, [&below, speed], false, [1.0, 0.1]);
        let (mut upper, mut lower) = (Vec::new(), Vec::new());
        let end = self.clock.map_or(0, |clock| clock + 1);
        for (index, span) in (0_u64..).zip(&self.spans) {
            let [from, to] = [index, index + 1].map(|index| self.time((index * self.width).min(end) as f64));
            let [least, most] = span.unwrap_or([0.0; 2]);
            upper.extend([[from, most], [to, most]]);
            lower.extend([[from, least], [to, least]]);
        }
        upper.extend(lower.into_iter().rev());
        page.path(view, r##"fill="#56b4e9" stroke="#0072b2""##, &upper);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_speed_and_a_pause_are_where_they_were() {
        // A BLU of 0.01 mm every 10th clock of 1 kHz is 1 mm/s; a pause of 5000 clocks; then half of it.
        let mut chart = SpeedChart::new(1e3, [0.01, 0.001]);
        let mut clock = 0;
        for x in 0..2000 {
            chart.step(&[x, 0, 0], clock);
            clock += if x == 999 {
                5000
            } else if x > 1000 {
                20
            } else {
                10
            };
        }
        assert!(chart.spans.len() <= SPAN_LIMIT && chart.width > 1);
        let at = |clock: u64| chart.spans[usize::try_from(clock / chart.width).unwrap()].unwrap();
        let near = |[least, most]: Pair, speed: f64| (least - speed).abs() < 1e-9 && (most - speed).abs() < 1e-9;
        assert!(near(at(5000), 60.0), "{:?}", at(5000));
        assert!(near(at(25_000), 30.0), "{:?}", at(25_000));
        // 32 BLU in 5310 clocks.
        let paused = 32.0 * 0.01 / 5.31 * 60.0;
        assert!(near(at(12_000), paused), "{:?} {paused}", at(12_000));
        assert_eq!(chart.greatest().map(f64::round), Some(60.0));
    }
}
