//! Circular arcs in the plane.

use std::f64::consts::TAU;

use crate::curve::outline_points;
use crate::exact::{between, norm_squared, roots_within_one, vector};
use crate::limit::check_coordinates;
use crate::turn::Turn;
use crate::{Crossing, Direction, GeometryError, Quadrant, Sector, sector};

/// A circular arc from one point to another about a centre.
///
/// The ideal circle is the one through the start point. The end point may lie up to one BLU off it, as rounded program
/// data do. An arc that ends where it starts is a full circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Arc {
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    direction: Direction,
}

crate::ends::ends!(Arc, "centre");

impl Arc {
    /// The arc between two points about a centre, all in BLU and in machine coordinates.
    ///
    /// # Errors
    /// If a coordinate is beyond [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), if the start or the end point is the
    /// centre, or if the end point is more than one BLU nearer to or farther from the centre than the start point.
    ///
    /// ```
    /// use stepwave_nc::{Arc, Direction, Quadrant};
    ///
    /// let arc = Arc::new([15, 10], [10, 15], [10, 10], Direction::CounterClockwise)?;
    /// assert_eq!((arc.start(), arc.end(), arc.radius()), ([5, 0], [0, 5], 5.0));
    /// assert_eq!((arc.start_quadrant(), arc.end_quadrant()), (Quadrant::I, Quadrant::I));
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    pub fn new(from: [i64; 2], to: [i64; 2], center: [i64; 2], direction: Direction) -> Result<Arc, GeometryError> {
        for point in [from, to, center] {
            check_coordinates(&point)?;
        }
        if from == center {
            return Err(GeometryError::ZeroRadius { center });
        }
        let [start_squared, end_squared] = [from, to].map(|point| norm_squared(between(center, point)));
        if !roots_within_one(start_squared, end_squared) {
            let [start_radius, end_radius] = [start_squared, end_squared].map(|squared| (squared as f64).sqrt());
            return Err(GeometryError::EndOffCircle { start_radius, end_radius, tolerance: 0.0 });
        }
        if to == center {
            return Err(GeometryError::EndAtCenter { center });
        }
        Ok(Arc { from, to, center, direction })
    }

    /// The arc between two points about a centre, whose two radii may differ by this many BLU beyond the one that
    /// [`new`](Arc::new) allows. Where they do, both ends stay and the centre moves: to the whole point about which an
    /// arc between the ends is nearest to the one wanted, whose radius goes evenly from that of the start to that of
    /// the end.
    ///
    /// # Errors
    /// As [`new`](Arc::new); also where the radii differ by more than half of the first.
    ///
    /// ```
    /// use stepwave_nc::{Arc, Direction};
    ///
    /// // The radii are 538.516 and 540.754 BLU.
    /// let [from, to, center] = [[0, 0], [-702, 299], [-200, 500]];
    /// assert!(Arc::new(from, to, center, Direction::Clockwise).is_err());
    /// let arc = Arc::within(from, to, center, Direction::Clockwise, 2.0)?;
    /// assert_eq!((arc.from(), arc.to()), (from, to));
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    pub fn within(
        from: [i64; 2],
        to: [i64; 2],
        center: [i64; 2],
        direction: Direction,
        tolerance: f64,
    ) -> Result<Arc, GeometryError> {
        let refused = match Arc::new(from, to, center, direction) {
            Err(GeometryError::EndOffCircle { start_radius, end_radius, .. }) => {
                GeometryError::EndOffCircle { start_radius, end_radius, tolerance }
            }
            other => return other,
        };
        let GeometryError::EndOffCircle { start_radius, end_radius, .. } = refused else { return Err(refused) };
        let apart = (end_radius - start_radius).abs();
        if apart > (1.0 + tolerance).min(start_radius / 2.0) {
            return Err(refused);
        }
        crate::pulses::arc_between(from, to, center, direction).ok_or(refused)
    }

    /// The direction of rotation.
    #[must_use]
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// The square of the distance of the start point from the centre, in BLU², exact.
    #[must_use]
    pub fn radius_squared(&self) -> i128 {
        let [x, y] = vector(self.start());
        x * x + y * y
    }

    /// The radius of the ideal circle, the one through the start point, in BLU.
    #[must_use]
    pub fn radius(&self) -> f64 {
        (self.radius_squared() as f64).sqrt()
    }

    /// Whether the end point lies exactly on the circle through the start point.
    #[must_use]
    pub fn ends_on_circle(&self) -> bool {
        norm_squared(vector(self.start())) == norm_squared(vector(self.end()))
    }

    /// Whether the arc ends where it starts, which means one whole turn.
    #[must_use]
    pub fn is_full_circle(&self) -> bool {
        self.from == self.to
    }

    /// The quadrant that the motion enters at the start point.
    ///
    /// A start point on an axis belongs to the quadrant ahead: (R, 0) is in Q1 counter-clockwise, in Q4 clockwise.
    #[must_use]
    pub fn start_quadrant(&self) -> Quadrant {
        self.turn().start_quadrant()
    }

    /// The quadrant that the motion leaves at the end point.
    ///
    /// An end point on an axis belongs to the quadrant it leaves: (R, 0) is in Q4 counter-clockwise, in Q1 clockwise.
    #[must_use]
    pub fn end_quadrant(&self) -> Quadrant {
        self.turn().end_quadrant()
    }

    /// How often the arc passes over an axis between its ends, 0 to 4: one less than its number of sectors.
    #[must_use]
    pub fn crossings(&self) -> usize {
        self.turn().crossings()
    }

    /// The pieces of the arc inside one quadrant each, in the order of the motion: one to five.
    ///
    /// The first starts at [`start`](Arc::start), the last ends at [`end`](Arc::end), and between them they join at the
    /// axes, where [`Crossing`] says. A full circle from inside a quadrant enters that quadrant twice and has five
    /// sectors; from an axis it has four.
    ///
    /// In every sector one coordinate grows and the other shrinks in magnitude, even if the end is off the circle.
    ///
    /// ```
    /// use stepwave_nc::{Arc, Crossing, Direction, Quadrant, Sector};
    ///
    /// let arc = Arc::new([-3, -4], [-4, 3], [0, 0], Direction::Clockwise)?;
    /// let sectors = arc.sectors(Crossing::RoundedRadius);
    /// assert_eq!(sectors[0], Sector { quadrant: Quadrant::III, start: [-3, -4], end: [-5, 0] });
    /// assert_eq!(sectors[1], Sector { quadrant: Quadrant::II, start: [-5, 0], end: [-4, 3] });
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn sectors(&self, crossing: Crossing) -> Vec<Sector> {
        sector::split(self, crossing)
    }

    /// The part of its whole turn after which each [sector](Self::sectors) on the rounded radius ends; 1 for the last.
    #[must_use]
    pub fn parts(&self) -> Vec<f64> {
        let (turn, angle) = (self.turn(), self.sweep());
        let reached = |sector: Sector| Turn { end: sector.end, ..turn }.angle() / angle;
        let mut parts: Vec<f64> = self.sectors(Crossing::RoundedRadius).into_iter().map(reached).collect();
        parts.last_mut().into_iter().for_each(|last| *last = 1.0);
        parts
    }

    /// The angle through which the arc turns, in radians: more than 0, and 2π for a full circle.
    #[must_use]
    pub fn sweep(&self) -> f64 {
        self.turn().angle()
    }

    /// The length of the ideal arc, in BLU.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.radius() * self.sweep()
    }

    /// The distance of a position from the whole ideal circle, in BLU.
    ///
    /// The position is in machine coordinates; coordinates after x and y are ignored, and with fewer there is no
    /// distance (NaN). It is |x² + y² - R²| / (√(x² + y²) + R), whose numerator is exact.
    ///
    /// ```
    /// use stepwave_nc::{Arc, Direction};
    ///
    /// let arc = Arc::new([5, 0], [0, 5], [0, 0], Direction::CounterClockwise)?;
    /// assert_eq!(arc.deviation(&[3, 4]), 0.0);
    /// assert_eq!(arc.deviation(&[4, 0]), 1.0);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        self.signed_deviation(position).abs()
    }

    /// The distance of a position from the whole ideal circle with its side, in BLU: positive outside.
    ///
    /// Its magnitude is [`deviation`](Arc::deviation).
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        let [x, y, ..] = *position else {
            return f64::NAN;
        };
        self.signed_deviation_at(norm_squared(between(self.center, [x, y])))
    }

    /// The distance from the whole ideal circle, positive outside, of a position whose distance from the centre has
    /// this square, in BLU and BLU²: of any such position the same as [`signed_deviation`](Arc::signed_deviation).
    ///
    /// ```
    /// use stepwave_nc::{Arc, Direction};
    ///
    /// let arc = Arc::new([5, 0], [0, 5], [0, 0], Direction::CounterClockwise)?;
    /// assert_eq!(arc.signed_deviation_at(16), -1.0);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn signed_deviation_at(&self, reached: u128) -> f64 {
        let wanted = norm_squared(vector(self.start()));
        let distance = reached.abs_diff(wanted) as f64 / ((reached as f64).sqrt() + self.radius());
        if reached < wanted { -distance } else { distance }
    }

    /// Points of the ideal arc at equal angles, in BLU and machine coordinates, for drawing.
    ///
    /// There are `max_points` of them, but two at least and [`OUTLINE_LIMIT`](crate::OUTLINE_LIMIT) at most. The first
    /// and the last are the programmed ends exactly, all others lie on the circle through the start point.
    #[must_use]
    pub fn outline(&self, max_points: usize) -> Vec<[f64; 2]> {
        let [[cx, cy], [sx, sy]] = [self.center, self.start()].map(|point| point.map(|c| c as f64));
        let turn = match self.direction {
            Direction::Clockwise => -self.sweep(),
            Direction::CounterClockwise => self.sweep(),
        };
        let last = outline_points(max_points) - 1;
        let inner = (1..last).map(|place| {
            let (sin, cos) = (turn * place as f64 / last as f64).sin_cos();
            [cx + sx * cos - sy * sin, cy + sx * sin + sy * cos]
        });
        let [first, end] = [self.from, self.to].map(|point| point.map(|c| c as f64));
        std::iter::once(first).chain(inner).chain(std::iter::once(end)).collect()
    }

    /// The start and the end point in place, for a curve that lends them as slices.
    pub(crate) fn ends(&self) -> (&[i64], &[i64]) {
        (&self.from, &self.to)
    }

    /// The motion about the centre.
    pub(crate) fn turn(&self) -> Turn {
        Turn { start: self.start(), end: self.end(), direction: self.direction }
    }

    /// The angle from the start point to any position but the centre in the sense of the motion, in radians, 0 to 2π.
    pub(crate) fn turn_to(&self, position: [i64; 2]) -> f64 {
        let [sx, sy] = self.start().map(|c| c as f64);
        let [x, y] = between(self.center, position).map(|c| c as f64);
        let turned = match self.direction {
            Direction::Clockwise => sy * x - sx * y,
            Direction::CounterClockwise => sx * y - sy * x,
        };
        let angle = turned.atan2(sx * x + sy * y);
        if angle < 0.0 { angle + TAU } else { angle }
    }
}

#[cfg(test)]
mod tests;
