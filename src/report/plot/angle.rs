//! The deviation over the angle of an arc, in bounded memory: what repeats in every octant or quadrant shows.

use stepwave_nc::{Arc, Direction};

use super::{Page, Pair, View, union};

/// Parts of the angle of the arc, each with its least and its greatest deviation.
const PARTS: usize = 720;
/// Degrees between ticks, at least; others are 2, 5, 10, … times as many.
const FINEST: f64 = 45.0;

/// What is known of each part of the angle.
#[derive(Debug, Clone)]
pub(super) struct Angle {
    center: Pair,
    /// +1 counter-clockwise, -1 clockwise.
    turn: f64,
    /// All of the arc, in degrees.
    sweep: f64,
    /// The last position relative to the centre, and its angle from the start in degrees.
    last: Option<(Pair, f64)>,
    parts: Vec<Option<Pair>>,
}

impl Angle {
    pub(super) fn new(arc: &Arc) -> Angle {
        let turn = if arc.direction() == Direction::CounterClockwise { 1.0 } else { -1.0 };
        let center = arc.center().map(|coordinate| coordinate as f64);
        Angle { center, turn, sweep: arc.sweep().to_degrees(), last: None, parts: vec![None; PARTS] }
    }

    /// Takes the deviation at a position.
    pub(super) fn take(&mut self, position: Pair, deviation: f64) {
        let now = [0, 1].map(|axis| position[axis] - self.center[axis]);
        let angle = self.last.map_or(0.0, |(before, angle)| {
            let (cross, dot) = (before[0] * now[1] - before[1] * now[0], before[0] * now[0] + before[1] * now[1]);
            angle + self.turn * cross.atan2(dot).to_degrees()
        });
        self.last = Some((now, angle));
        // At the ends a position may be a little before the start, or past the end.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let part = (angle / self.sweep * PARTS as f64).clamp(0.0, PARTS as f64 - 1.0) as usize;
        let known = &mut self.parts[part];
        *known = Some(known.map_or([deviation; 2], |known| union(known, [deviation; 2])));
    }

    /// The range of the chart to the right.
    pub(super) fn range(&self) -> Pair {
        let aside = 0.012 * self.sweep;
        [-aside, self.sweep + aside]
    }

    /// The chart, with a mark of each quadrant of the arc.
    pub(super) fn draw(&self, page: &mut Page, view: &View) {
        page.axes(view, ["angle from the start (degrees)", "deviation (BLU)"], false, [FINEST, 0.1]);
        let middle = |part: usize| (part as f64 + 0.5) * self.sweep / PARTS as f64;
        let known = self.parts.iter().enumerate().filter_map(|(part, range)| Some((middle(part), (*range)?)));
        let upper: Vec<Pair> = known.clone().map(|(angle, [_, most])| [angle, most]).collect();
        let lower: Vec<Pair> = known.map(|(angle, [least, _])| [angle, least]).collect();
        let area: Vec<Pair> = upper.into_iter().chain(lower.into_iter().rev()).collect();
        page.path(view, r##"fill="#56b4e9" stroke="#0072b2""##, &area);
        page.levels(view);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_is_at_its_angle_in_both_directions_and_all_round() {
        for direction in [Direction::CounterClockwise, Direction::Clockwise] {
            let mut angle = Angle::new(&Arc::new([3, 100], [3, 100], [3, 0], direction).unwrap());
            for degree in 0..=360_u32 {
                let turned = (90.0 + angle.turn * f64::from(degree)).to_radians();
                let position = [3.0 + 100.0 * turned.cos(), 100.0 * turned.sin()];
                // Of two deviations at one place both are kept.
                angle.take(position, f64::from(degree));
                angle.take(position, -f64::from(degree));
            }
            assert_eq!((angle.parts[0], angle.parts[PARTS - 1]), (Some([0.0; 2]), Some([-360.0, 360.0])));
            let known = angle.parts.iter().enumerate().filter_map(|(part, range)| Some((part as f64, (*range)?[1])));
            let off = known.map(|(part, degree)| (part / 2.0 - degree).abs()).fold(0.0, f64::max);
            assert!(off <= 0.5, "{off}");
        }
    }
}
