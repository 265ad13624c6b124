//! Ellipses, parabolas and hyperbolas in the plane, their axes along x and y.

use crate::curve::outline_points;
use crate::exact::{between, vector};
use crate::limit::check_coordinates;
use crate::turn::Turn;
use crate::{CONIC_LIMIT, Direction, End, GeometryError, PARABOLA_LIMIT};

mod foot;
mod path;
mod sector;
mod shape;

pub use sector::ConicSector;
pub use shape::{Opens, Shape, Weight};

/// How much farther than 1 BLU off the curve an end may seem to lie, for what `f64` rounds away.
const ROUNDING: f64 = 1e-7;

/// An arc of an ellipse, a parabola or a branch of a hyperbola, from one point to another, with its axes along x and y.
///
/// Both ends may lie up to one BLU off the curve, as rounded program data do. An ellipse that ends where it starts is a
/// full turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Conic {
    shape: Shape,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    /// Counter-clockwise for an open curve, whose ends alone say where the motion leads.
    direction: Direction,
}

crate::ends::ends!(Conic, "centre of an ellipse or hyperbola, or vertex of a parabola");

impl Conic {
    /// The arc of an ellipse with these semi-axes along x and y about a centre; points in machine coordinates, all in
    /// BLU.
    ///
    /// # Errors
    /// If a semi-axis is not in 1..=[`CONIC_LIMIT`], if a coordinate is beyond that limit relative to the centre or
    /// beyond [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), if an end is the centre or more than one BLU off the
    /// curve, or if both ends are off it on different sides of one place, so that the motion does not lead from one
    /// to the other.
    ///
    /// ```
    /// use stepwave_nc::{Conic, Direction};
    ///
    /// let quarter = Conic::ellipse([6, 4], [16, 10], [10, 14], [10, 10], Direction::CounterClockwise)?;
    /// assert_eq!((quarter.start(), quarter.end()), ([6, 0], [0, 4]));
    /// assert_eq!(quarter.implicit([5, 0]), -176);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    pub fn ellipse(
        semi_axes: [i64; 2],
        from: [i64; 2],
        to: [i64; 2],
        center: [i64; 2],
        direction: Direction,
    ) -> Result<Conic, GeometryError> {
        check_sizes([('a', semi_axes[0], CONIC_LIMIT), ('b', semi_axes[1], CONIC_LIMIT)])?;
        let (conic, _) = Conic { shape: Shape::Ellipse { semi_axes }, from, to, center, direction }.checked();
        conic
    }

    /// The arc of the parabola y² = cx about a vertex, or of the one that opens elsewhere; points in machine
    /// coordinates, all in BLU.
    ///
    /// Without `opens` it is the orientation on which both points lie exactly, or else the one that the farther of them
    /// lies next to; of several that are as good, the first of +x, -x, +y, -y.
    ///
    /// # Errors
    /// If c is not in 1..=[`PARABOLA_LIMIT`], if a coordinate is beyond [`CONIC_LIMIT`] relative to the vertex or
    /// beyond [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), if both ends are the same, if one is more than one BLU
    /// off the curve or beyond its vertex, or if both are off it on different sides of one place, so that the motion
    /// does not lead from one to the other.
    ///
    /// ```
    /// use stepwave_nc::{Conic, Opens};
    ///
    /// let parabola = Conic::parabola(4, None, [-1, 2], [-9, 6], [0, 0])?;
    /// assert_eq!(parabola.opens(), Some(Opens::MinusX)); // y² = -4x
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    pub fn parabola(
        c: i64,
        opens: Option<Opens>,
        from: [i64; 2],
        to: [i64; 2],
        vertex: [i64; 2],
    ) -> Result<Conic, GeometryError> {
        check_sizes([('c', c, PARABOLA_LIMIT)])?;
        open(|opens| Shape::Parabola { c, opens }, opens, from, to, vertex)
    }

    /// The arc of the hyperbola x²/a² - y²/b² = 1, x > 0, about a centre, or of the branch that opens elsewhere; points
    /// in machine coordinates, all in BLU. In every orientation a, the first, is the real semi-axis.
    ///
    /// Without `opens` the orientation is found as for a [`parabola`](Conic::parabola).
    ///
    /// # Errors
    /// If a semi-axis is not in 1..=[`CONIC_LIMIT`], if a coordinate is beyond that limit relative to the centre or
    /// beyond [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), if both ends are the same, if one is more than one BLU
    /// off the curve or not on its branch, or if both are off it on different sides of one place, so that the motion
    /// does not lead from one to the other.
    ///
    /// ```
    /// use stepwave_nc::{Conic, Opens};
    ///
    /// let hyperbola = Conic::hyperbola([4, 3], None, [0, 4], [3, 6], [0, 0])?; // rounded: y = 5.66 at x = 3
    /// assert_eq!(hyperbola.opens(), Some(Opens::PlusY));
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    pub fn hyperbola(
        semi_axes: [i64; 2],
        opens: Option<Opens>,
        from: [i64; 2],
        to: [i64; 2],
        center: [i64; 2],
    ) -> Result<Conic, GeometryError> {
        check_sizes([('a', semi_axes[0], CONIC_LIMIT), ('b', semi_axes[1], CONIC_LIMIT)])?;
        open(|opens| Shape::Hyperbola { semi_axes, opens }, opens, from, to, center)
    }

    /// The kind, the size and the orientation of the curve.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Where the curve opens to; an ellipse is closed.
    #[must_use]
    pub fn opens(&self) -> Option<Opens> {
        self.shape.opens()
    }

    /// The direction of rotation of an ellipse; an open curve leads from its start to its end.
    #[must_use]
    pub fn direction(&self) -> Option<Direction> {
        matches!(self.shape, Shape::Ellipse { .. }).then_some(self.direction)
    }

    /// Whether both ends lie on the curve exactly.
    #[must_use]
    pub fn ends_on_curve(&self) -> bool {
        [self.start(), self.end()].iter().all(|end| self.implicit(*end) == 0)
    }

    /// The implicit function at a point relative to the centre or vertex: 0 on the curve.
    ///
    /// An ellipse has b²x² + a²y² - a²b²; a parabola y² - cx, y² + cx, x² - cy or x² + cy as it opens; a hyperbola
    /// b²x² - a²y² - a²b², or b²y² - a²x² - a²b² where it opens to +y or -y (0 on both branches). It is exact within
    /// [`CONIC_LIMIT`] and far beyond; where it would exceed `i128` it saturates with the right sign.
    #[must_use]
    pub fn implicit(&self, point: [i64; 2]) -> i128 {
        self.shape.implicit(vector(point))
    }

    /// The interval weights of a pulse in x and of a pulse in y, as functions of |x| and of |y|.
    ///
    /// They are half the slope of [`implicit`](Conic::implicit) along each axis, and for a parabola the whole slope.
    ///
    /// ```
    /// use stepwave_nc::{Conic, Direction};
    ///
    /// let ellipse = Conic::ellipse([3, 2], [0, -2], [-3, 0], [0, 0], Direction::Clockwise)?;
    /// assert_eq!(ellipse.weights().map(|weight| weight.at(2)), [8, 18]);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn weights(&self) -> [Weight; 2] {
        let sloped = |slope: i128| Weight { slope, constant: 0 };
        let squares = |semi_axes| vector(semi_axes).map(|axis| axis * axis);
        let [along, across] = match self.shape {
            Shape::Ellipse { semi_axes } | Shape::Hyperbola { semi_axes, .. } => {
                let [p, q] = squares(semi_axes);
                [sloped(q), sloped(p)]
            }
            Shape::Parabola { c, .. } => [Weight { slope: 0, constant: c.into() }, sloped(2)],
        };
        if self.opens().is_some_and(|opens| opens.axis() == 1) { [across, along] } else { [along, across] }
    }

    /// The pieces of the curve inside one quadrant each, in the order of the motion: one to five of an ellipse, one or
    /// two of an open curve.
    ///
    /// The first starts at [`start`](Conic::start), the last ends at [`end`](Conic::end), and between them they join
    /// where the curve crosses the axes: an ellipse at (±a, 0) and (0, ±b), but never before a start or beyond an end
    /// that lies farther out, an open curve at its vertex. In every sector the motion leads from the start to the end.
    ///
    /// ```
    /// use stepwave_nc::{Conic, Quadrant};
    ///
    /// let parabola = Conic::parabola(4, None, [4, -4], [1, 2], [0, 0])?;
    /// let [inward, outward] = parabola.sectors()[..] else { panic!("the vertex lies between the ends") };
    /// assert_eq!((inward.start, inward.end, inward.quadrant), ([4, -4], [0, 0], Quadrant::IV));
    /// assert_eq!((outward.start, outward.end, outward.quadrant), ([0, 0], [1, 2], Quadrant::I));
    /// assert_eq!((inward.motion, inward.grows, inward.x_lowers), ([-1, 1], [false; 2], false));
    /// assert_eq!((outward.motion, outward.grows, outward.x_lowers), ([1, 1], [true; 2], true));
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn sectors(&self) -> Vec<ConicSector> {
        sector::split(self)
    }

    /// The length of the ideal curve between its points next to start and end, in BLU, to about nine digits.
    #[must_use]
    pub fn length(&self) -> f64 {
        path::length(self)
    }

    /// The distance of a position from the whole ellipse, the whole parabola or the whole branch of the hyperbola, in
    /// BLU.
    ///
    /// The position is in machine coordinates; coordinates after x and y are ignored, and with fewer there is no
    /// distance (NaN). Near the curve it comes from the exact [`implicit`](Conic::implicit) and is good to a few parts
    /// in 2^52; farther off than the curve's radius of curvature, it is so relative to the coordinates.
    ///
    /// ```
    /// use stepwave_nc::{Conic, Direction};
    ///
    /// let ellipse = Conic::ellipse([5, 3], [5, 0], [0, 3], [0, 0], Direction::CounterClockwise)?;
    /// assert_eq!(ellipse.deviation(&[0, -5]), 2.0);
    /// assert_eq!(ellipse.deviation(&[0, 0]), 3.0);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        match *position {
            [x, y, ..] => foot::distance(self.shape, between(self.center, [x, y])),
            _ => f64::NAN,
        }
    }

    /// The distance with its side, in BLU: the sign is that of [`implicit`](Conic::implicit), so positive outside an
    /// ellipse or a parabola and inside the bend of a hyperbola's branch.
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        let distance = self.deviation(position);
        match *position {
            [x, y, ..] if self.shape.implicit(between(self.center, [x, y])) < 0 => -distance,
            _ => distance,
        }
    }

    /// Points of the ideal curve, in BLU and machine coordinates, for drawing.
    ///
    /// There are `max_points` of them, but two at least and [`OUTLINE_LIMIT`](crate::OUTLINE_LIMIT) at most. The first
    /// and the last are the programmed ends exactly, all others lie on the curve.
    #[must_use]
    pub fn outline(&self, max_points: usize) -> Vec<[f64; 2]> {
        path::outline(self, outline_points(max_points))
    }

    /// The start and the end point in place, for a curve that lends them as slices.
    pub(crate) fn ends(&self) -> (&[i64], &[i64]) {
        (&self.from, &self.to)
    }

    /// The motion about the centre of an ellipse.
    fn turn(&self) -> Turn {
        Turn { start: self.start(), end: self.end(), direction: self.direction }
    }

    /// The curve if it is one, and how far the farther of its ends lies off it, in BLU.
    fn checked(self) -> (Result<Conic, GeometryError>, f64) {
        let mut farthest = 0.0_f64;
        for point in [self.from, self.to, self.center] {
            if let Err(error) = check_coordinates(&point) {
                return (Err(error), f64::INFINITY);
            }
        }
        let mut fault = None;
        for (end, point) in [(End::Start, self.from), (End::End, self.to)] {
            match self.check_end(end, point) {
                Ok(distance) => farthest = farthest.max(distance),
                Err((distance, error)) => {
                    farthest = farthest.max(distance);
                    fault = fault.or(Some(error));
                }
            }
        }
        let shape = self.shape;
        let fault = fault.or_else(|| match shape {
            Shape::Parabola { .. } | Shape::Hyperbola { .. } if self.from == self.to => {
                Some(GeometryError::ZeroLengthConic { shape })
            }
            _ if self.sectors().iter().all(ConicSector::reaches_its_end) => None,
            _ => Some(GeometryError::EndsAcrossCurve { from: self.from, to: self.to, shape }),
        });
        (fault.map_or(Ok(self), Err), farthest)
    }

    /// The distance of an end from the curve, in BLU; an error with it where the end is not on the curve.
    fn check_end(&self, end: End, point: [i64; 2]) -> Result<f64, (f64, GeometryError)> {
        let (shape, relative) = (self.shape, self.relative(point));
        for (axis, value) in ['x', 'y'].into_iter().zip(relative) {
            if value.abs() > CONIC_LIMIT {
                let error = GeometryError::TooFarFromCenter { end, point, axis, value, shape };
                return Err((f64::INFINITY, error));
            }
        }
        let distance = foot::distance(shape, vector(relative));
        if distance > 1.0 + ROUNDING {
            return Err((distance, GeometryError::OffCurve { end, point, distance, shape }));
        }
        if !shape.on_branch(relative) {
            return Err((distance, GeometryError::OffBranch { end, point, distance, shape }));
        }
        Ok(distance)
    }
}

/// Checks that every length lies within 1 and its limit.
fn check_sizes<const N: usize>(sizes: [(char, i64, i64); N]) -> Result<(), GeometryError> {
    for (name, value, limit) in sizes {
        if value < 1 {
            return Err(GeometryError::NotPositive { name, value });
        }
        if value > limit {
            return Err(GeometryError::ConicBeyondLimit { name, value, limit });
        }
    }
    Ok(())
}

/// The open curve that opens as given, or to where both ends fit best.
fn open(
    shape: impl Fn(Opens) -> Shape,
    opens: Option<Opens>,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
) -> Result<Conic, GeometryError> {
    let curve =
        |opens| Conic { shape: shape(opens), from, to, center, direction: Direction::CounterClockwise }.checked();
    if let Some(opens) = opens {
        return curve(opens).0;
    }
    let (mut best, mut nearest) = curve(Opens::PlusX);
    for opens in &Opens::ALL[1..] {
        let (other, distance) = curve(*opens);
        let better = match (&best, &other) {
            (Ok(_), Err(_)) => false,
            (Err(_), Ok(_)) => true,
            _ => distance < nearest, // 0 if both ends are on the curve exactly
        };
        if better {
            (best, nearest) = (other, distance);
        }
    }
    best
}

#[cfg(test)]
mod tests;
