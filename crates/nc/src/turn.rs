//! Motion about a centre: which quadrants it runs through, and through what angle.

use std::f64::consts::TAU;

use crate::exact::{cross, dot, vector};
use crate::{Direction, Quadrant, Sector};

/// The turn from one point to another about the origin; neither point is the origin. Equal points mean one whole turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn {
    /// The start point relative to the centre, in BLU.
    pub(crate) start: [i64; 2],
    /// The end point relative to the centre, in BLU.
    pub(crate) end: [i64; 2],
    /// The direction of rotation.
    pub(crate) direction: Direction,
}

impl Turn {
    /// The quadrant that the motion enters at the start point.
    pub(crate) fn start_quadrant(self) -> Quadrant {
        Quadrant::entered(self.start, self.direction)
    }

    /// The quadrant that the motion leaves at the end point.
    pub(crate) fn end_quadrant(self) -> Quadrant {
        Quadrant::entered(self.end, self.direction.reversed())
    }

    /// How often the motion passes over an axis between its ends, 0 to 4.
    pub(crate) fn crossings(self) -> usize {
        let (mut quadrant, last) = (self.start_quadrant(), self.end_quadrant());
        if quadrant == last && self.ahead() <= 0 {
            return 4; // the end point is the start point or before it: a full turn, or nearly
        }
        let mut count = 0;
        while quadrant != last {
            quadrant = quadrant.next(self.direction);
            count += 1;
        }
        count
    }

    /// The angle of the motion, in radians: more than 0, and 2π for a whole turn.
    pub(crate) fn angle(self) -> f64 {
        let angle = (self.ahead() as f64).atan2(dot(vector(self.start), vector(self.end)) as f64);
        if angle > 0.0 { angle } else { angle + TAU }
    }

    /// The pieces inside one quadrant each, in the order of the motion, where the curve meets the x axis at `±radii[0]`
    /// and the y axis at `±radii[1]`.
    ///
    /// No crossing lies before the start of its sector, nor the last one beyond the end point.
    pub(crate) fn sectors(self, radii: [i64; 2]) -> Vec<Sector> {
        let crossings = self.crossings();
        let mut sectors = Vec::with_capacity(crossings + 1);
        let (mut quadrant, mut start) = (self.start_quadrant(), self.start);
        for left in (0..crossings).rev() {
            let growing = quadrant.growing_axis(self.direction);
            let ahead = if left == 0 { self.end[growing].abs() } else { 0 };
            let mut end = [0, 0];
            end[growing] = quadrant.signs()[growing] * radii[growing].max(start[growing].abs()).max(ahead);
            sectors.push(Sector { quadrant, start, end });
            (quadrant, start) = (quadrant.next(self.direction), end);
        }
        sectors.push(Sector { quadrant, start, end: self.end });
        sectors
    }

    /// The cross product of start and end in the sense of the motion: positive if the end point lies less than half a
    /// turn ahead.
    fn ahead(self) -> i128 {
        let turned = cross(vector(self.start), vector(self.end));
        match self.direction {
            Direction::Clockwise => -turned,
            Direction::CounterClockwise => turned,
        }
    }
}
