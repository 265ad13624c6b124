//! NURBS in the plane: rational B-splines of control points with weights over a knot vector.

use std::hash::{Hash, Hasher};

use crate::GeometryError;
use crate::limit::check_coordinates;

mod check;
mod distance;
mod piece;
#[cfg(test)]
mod tests;

pub use check::KnotFault;
pub(crate) use piece::{Piece, pieces};

/// The unit of weights and knots: they are whole numbers of 10^-9, so that they are exact.
pub const NURBS_UNIT: i64 = 1_000_000_000;
/// The greatest degree.
pub const NURBS_DEGREE: usize = 7;
/// The greatest number of control points.
pub const NURBS_POINTS: usize = 1024;
/// The greatest weight, and the greatest distance of two knots, in ones.
pub const NURBS_MOST: i64 = 1_000_000;

/// A control point with its weight.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct ControlPoint {
    /// x and y in BLU.
    pub at: [i64; 2],
    /// Weight in [`NURBS_UNIT`]s, more than 0.
    pub weight: i64,
}

/// A NURBS of degree p: n+1 control points and n+p+2 knots, the first p+1 of which are equal, and the last p+1 too, so
/// that it leads from the first control point to the last.
///
/// ```
/// use stepwave_nc::{ControlPoint, NURBS_UNIT, Nurbs};
///
/// // A quarter of a circle.
/// let point = |at, weight| ControlPoint { at, weight };
/// let points = [point([1000, 0], NURBS_UNIT), point([1000, 1000], 707_106_781), point([0, 1000], NURBS_UNIT)];
/// let curve = Nurbs::new(2, &points, None)?;
/// assert_eq!((curve.from(), curve.to()), ([1000, 0], [0, 1000]));
/// assert!((curve.length() - 500.0 * std::f64::consts::PI).abs() < 1e-3);
/// assert!(curve.deviation(&[600, 800]) < 1e-6);
/// # Ok::<(), stepwave_nc::GeometryError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Nurbs {
    degree: usize,
    points: Vec<ControlPoint>,
    knots: Vec<i64>,
    pieces: Vec<Piece<2>>,
    ends: [[i64; 2]; 2],
}

impl PartialEq for Nurbs {
    fn eq(&self, other: &Nurbs) -> bool {
        // What the pieces are follows from these.
        (self.degree, &self.points, &self.knots) == (other.degree, &other.points, &other.knots)
    }
}

impl Eq for Nurbs {}

impl Hash for Nurbs {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.degree, &self.points, &self.knots).hash(state);
    }
}

impl Nurbs {
    /// The curve of this degree, with these knots in [`NURBS_UNIT`]s, or with uniform ones: 0, 1, 2, …, the first and the
    /// last degree+1 times.
    ///
    /// # Errors
    /// If there are too few points for the degree or too many of them, if a weight is not more than 0, if the knots are not
    /// as many as points and degree+1 together, decrease, do not repeat degree+1 times at the ends or more than degree
    /// times elsewhere, if a number is too large, or if the curve is a single point.
    pub fn new(degree: usize, points: &[ControlPoint], knots: Option<&[i64]>) -> Result<Nurbs, GeometryError> {
        if !(2..=NURBS_POINTS).contains(&points.len()) {
            return Err(GeometryError::NurbsPoints { given: points.len() });
        }
        if !(1..=NURBS_DEGREE.min(points.len() - 1)).contains(&degree) {
            return Err(GeometryError::NurbsDegree { degree, points: points.len() });
        }
        for (index, point) in points.iter().enumerate() {
            check_coordinates(&point.at)?;
            if !(1..=NURBS_MOST * NURBS_UNIT).contains(&point.weight) {
                return Err(GeometryError::NurbsWeight { index, weight: point.weight });
            }
        }
        let knots = knots.map_or_else(|| uniform(degree, points.len()), <[i64]>::to_vec);
        check::knots(degree, points.len(), &knots)?;
        let (first, last) = (points[0].at, points[points.len() - 1].at);
        if points.iter().all(|point| point.at == first) {
            return Err(GeometryError::SplineIsPoint { point: first });
        }
        let control: Vec<[f64; 3]> = points.iter().map(ControlPoint::homogeneous).collect();
        let real: Vec<f64> = knots.iter().map(|&knot| knot as f64 / NURBS_UNIT as f64).collect();
        let pieces = pieces(degree, &control, &real);
        Ok(Nurbs { degree, points: points.to_vec(), knots, pieces, ends: [first, last] })
    }

    /// The Bézier curve of these points, as a NURBS of one span whose weights are 1.
    ///
    /// # Errors
    /// As [`new`](Nurbs::new).
    pub fn bezier(points: &[[i64; 2]]) -> Result<Nurbs, GeometryError> {
        let points: Vec<_> = points.iter().map(|&at| ControlPoint { at, weight: NURBS_UNIT }).collect();
        Nurbs::new(points.len().saturating_sub(1), &points, None)
    }

    /// The degree p.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The control points.
    #[must_use]
    pub fn points(&self) -> &[ControlPoint] {
        &self.points
    }

    /// The knots, in [`NURBS_UNIT`]s.
    #[must_use]
    pub fn knots(&self) -> &[i64] {
        &self.knots
    }

    /// The start point.
    #[must_use]
    pub fn from(&self) -> [i64; 2] {
        self.ends[0]
    }

    /// The end point.
    #[must_use]
    pub fn to(&self) -> [i64; 2] {
        self.ends[1]
    }

    pub(crate) fn both_ends(&self) -> &[[i64; 2]; 2] {
        &self.ends
    }

    /// The length in BLU.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(Piece::length).sum()
    }

    /// Points of the curve, in BLU, for drawing: `max_points`, but two at least; the first and the last are its ends.
    #[must_use]
    pub fn outline(&self, max_points: usize) -> Vec<[f64; 2]> {
        crate::foot::outline(&self.ends, self.pieces.len(), max_points, |piece, u| self.pieces[piece].at(u))
    }

    /// All numbers that give it: degree and number of points, x, y and weight of each, and the knots.
    pub(crate) fn numbers(&self) -> Vec<i64> {
        let points = self.points.iter().flat_map(|point| [point.at[0], point.at[1], point.weight]);
        // Both are small.
        let head = [self.degree as i64, self.points.len() as i64];
        head.into_iter().chain(points).chain(self.knots.iter().copied()).collect()
    }

    /// The curve of such numbers.
    pub(crate) fn of_numbers(numbers: &[i64]) -> Result<Nurbs, GeometryError> {
        let (head, rest) = numbers.split_at_checked(2).unwrap_or((&[0, 0], &[]));
        let [degree, count] = [0, 1].map(|index| usize::try_from(head[index]).unwrap_or(0));
        let (points, knots) = rest.split_at_checked(count.saturating_mul(3)).unwrap_or((&[], &[]));
        let points: Vec<_> =
            points.as_chunks().0.iter().map(|&[x, y, weight]| ControlPoint { at: [x, y], weight }).collect();
        Nurbs::new(degree, &points, Some(knots))
    }
}

impl ControlPoint {
    /// w·x, w·y and w.
    fn homogeneous(&self) -> [f64; 3] {
        let weight = self.weight as f64 / NURBS_UNIT as f64;
        [self.at[0] as f64 * weight, self.at[1] as f64 * weight, weight]
    }
}

/// Uniform knots, clamped at both ends.
fn uniform(degree: usize, points: usize) -> Vec<i64> {
    let last = points - degree;
    // NURBS_POINTS at most.
    (0..=points + degree).map(|index| (index.saturating_sub(degree).min(last)) as i64 * NURBS_UNIT).collect()
}
