//! The pulses of each axis on an axis of time: a row of ticks an axis, up for a step ahead and down for one back.

use super::{CENTRED, FEW_STEPS, Page, Pair, View};

/// Pixels of the row of an axis.
const ROW: f64 = 30.0;
const AXES: [&str; 9] = ["x", "y", "z", "a", "b", "c", "u", "v", "w"];

/// The positions of a short run with their clocks; a long one has none, as its ticks would be one band.
#[derive(Debug, Clone, Default)]
pub(super) struct Pulses {
    points: Vec<(u64, Vec<i64>)>,
    is_long: bool,
}

impl Pulses {
    pub(super) fn take(&mut self, clock: u64, position: &[i64]) {
        self.is_long |= self.points.len() > FEW_STEPS;
        if self.is_long {
            self.points = Vec::new();
        } else {
            self.points.push((clock, position.to_vec()));
        }
    }

    fn axes(&self) -> usize {
        self.points.first().map_or(0, |(_, position)| position.len()).min(AXES.len())
    }

    /// Height of the chart; none where nothing moved, or too much.
    pub(super) fn height(&self) -> Option<f64> {
        (self.points.len() > 1).then(|| ROW * self.axes() as f64)
    }

    /// Clocks from left to right, and axes from the top down.
    pub(super) fn ranges(&self) -> [Pair; 2] {
        let [first, last] = [self.points.first(), self.points.last()].map(|end| end.map_or(0, |end| end.0) as f64);
        let aside = 0.5 + 0.012 * (last - first);
        [[first - aside, last + aside], [-(self.axes() as f64), 0.0]]
    }

    pub(super) fn draw(&self, page: &mut Page, view: &View) {
        page.axes(view, ["clock (pulses of each axis)", ""], false, [1.0, f64::INFINITY]);
        for (axis, name) in AXES.iter().enumerate().take(self.axes()) {
            let middle = -(axis as f64) - 0.5;
            page.path(view, r##"stroke="#999""##, &view.ranges[0].map(|clock| [clock, middle]));
            let [_, y] = view.at([0.0, middle]);
            page.text([view.origin[0] - 14.0, y + 4.0], CENTRED, name);
            for pair in self.points.windows(2) {
                let pulse = pair[1].1[axis] - pair[0].1[axis];
                if pulse != 0 {
                    let end = middle + 0.4 * pulse.signum() as f64;
                    let clock = pair[1].0 as f64;
                    page.path(view, r##"stroke="#0072b2" stroke-width="1.6""##, &[[clock, middle], [clock, end]]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directions of the ticks of a picture, and at which share of its width each is.
    fn ticks(pulses: &Pulses) -> Vec<(f64, bool)> {
        let mut page = Page(String::new());
        let view = View { origin: [0.0; 2], size: [100.0, pulses.height().unwrap()], ranges: pulses.ranges() };
        pulses.draw(&mut page, &view);
        let lines = page.0.lines().filter(|line| line.contains("#0072b2"));
        let ends = lines.map(|line| {
            let data = line.split('"').nth(1).unwrap().replace(['M', 'L'], " ");
            data.split_whitespace().map(|number| number.parse().unwrap()).collect::<Vec<f64>>()
        });
        ends.map(|ends| (ends[0], ends[3] < ends[1])).collect()
    }

    #[test]
    fn every_pulse_is_a_tick_at_its_clock_up_or_down_and_a_long_run_has_none() {
        let mut pulses = Pulses::default();
        assert!(pulses.height().is_none());
        for (clock, position) in [(0, [0, 0]), (4, [1, 0]), (8, [1, -1]), (10, [0, -1])] {
            pulses.take(clock, &position);
        }
        let [[from, to], _] = pulses.ranges();
        let at = |clock: f64| ((clock - from) / (to - from) * 1e4).round() / 1e2;
        assert_eq!(ticks(&pulses), [(at(4.0), true), (at(10.0), false), (at(8.0), false)]);
        for clock in 11..500 {
            pulses.take(clock, &[i64::from(clock % 2 == 0), 0]);
        }
        assert!(pulses.height().is_none() && pulses.points.is_empty());
    }
}
