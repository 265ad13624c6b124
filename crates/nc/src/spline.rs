//! Free curves in the plane: Bézier curves, Hermite segments, and chains of cubic segments by points.

use crate::GeometryError;
use crate::limit::check_coordinates;

mod distance;
pub(crate) use distance::growth;

/// What the points of a [`Spline`] mean.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum SplineForm {
    /// Three or four control points of one quadratic or cubic Bézier curve.
    Bezier,
    /// Start point, its tangent, end point, its tangent, of one cubic segment.
    Hermite,
    /// Points that the curve passes, by Catmull and Rom: the tangent at each is half of the chord between its
    /// neighbours. At either end the neighbour that is missing continues the first or last chord.
    CatmullRom,
    /// Control points of a uniform cubic B-spline: one segment for each four in a row.
    BSpline,
}

impl SplineForm {
    /// All of them.
    pub const ALL: [SplineForm; 4] =
        [SplineForm::Bezier, SplineForm::Hermite, SplineForm::CatmullRom, SplineForm::BSpline];

    /// How many points give one, in words.
    #[must_use]
    pub fn takes(self) -> &'static str {
        match self {
            SplineForm::Bezier => "3 or 4 points",
            SplineForm::Hermite => "start point, tangent, end point and tangent",
            SplineForm::CatmullRom => "2 points or more",
            SplineForm::BSpline => "4 points or more",
        }
    }

    fn fits(self, points: usize) -> bool {
        match self {
            SplineForm::Bezier => (3..=4).contains(&points),
            SplineForm::Hermite => points == 4,
            SplineForm::CatmullRom => (2..=SPLINE_POINTS).contains(&points),
            SplineForm::BSpline => (4..=SPLINE_POINTS).contains(&points),
        }
    }
}

/// The greatest number of points of a chain of segments.
pub const SPLINE_POINTS: usize = 1 << 20;

/// One segment: of each axis (c0 + c1·u + c2·u² + c3·u³)/d BLU, u from 0 to 1.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct SplineSegment {
    /// c0 to c3 of x, and of y.
    pub coefficients: [[i64; 4]; 2],
    /// d: 1, 2 or 6.
    pub divisor: i64,
}

impl SplineSegment {
    /// The point at u, in BLU.
    #[must_use]
    pub fn at(&self, u: f64) -> [f64; 2] {
        self.coefficients
            .map(|[c0, c1, c2, c3]| (((c3 as f64 * u + c2 as f64) * u + c1 as f64) * u + c0 as f64) / self.divisor())
    }

    /// The first derivative by u, in BLU.
    #[must_use]
    pub fn tangent(&self, u: f64) -> [f64; 2] {
        self.coefficients
            .map(|[_, c1, c2, c3]| ((3.0 * c3 as f64 * u + 2.0 * c2 as f64) * u + c1 as f64) / self.divisor())
    }

    fn divisor(&self) -> f64 {
        self.divisor as f64
    }

    /// The whole point nearest to its start, or to its end, halves upwards.
    #[must_use]
    pub fn ends(&self) -> [[i64; 2]; 2] {
        let whole = |sum: i64| (2 * sum + self.divisor).div_euclid(2 * self.divisor);
        [self.coefficients.map(|c| whole(c[0])), self.coefficients.map(|c| whole(c.iter().sum()))]
    }

    /// Its length in BLU, by the formula of Gauss over 32 parts.
    fn length(&self) -> f64 {
        gauss(|u| {
            let [x, y] = self.tangent(u);
            x.hypot(y)
        })
    }
}

/// The integral over u from 0 to 1, by the formula of Gauss over 32 parts.
pub(crate) fn gauss(speed: impl Fn(f64) -> f64) -> f64 {
    const PARTS: u32 = 32;
    const NODES: [(f64, f64); 3] = [
        (0.0, 128.0 / 225.0),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let half = 0.5 / f64::from(PARTS);
    let part = |index: u32| {
        let middle = f64::from(2 * index + 1) * half;
        let both = |(node, weight): (f64, f64)| match node {
            0.0 => weight * speed(middle),
            _ => weight * (speed(middle - node * half) + speed(middle + node * half)),
        };
        half * NODES.into_iter().map(both).sum::<f64>()
    };
    (0..PARTS).map(part).sum()
}

/// A free curve: polynomial segments in x and y, one after another.
///
/// ```
/// use stepwave_nc::{Spline, SplineForm};
///
/// let curve = Spline::new(SplineForm::Bezier, &[[0, 0], [4, 0], [8, 4], [8, 8]])?;
/// assert_eq!(curve.segments()[0].coefficients, [[0, 12, 0, -4], [0, 0, 12, -4]]);
/// assert_eq!((curve.from(), curve.to()), ([0, 0], [8, 8]));
/// assert!((curve.length() - 12.391).abs() < 0.001);
/// # Ok::<(), stepwave_nc::GeometryError>(())
/// ```
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Spline {
    form: SplineForm,
    points: Vec<[i64; 2]>,
    segments: Vec<SplineSegment>,
    /// The box of each [`GROUP`](distance::GROUP) segments.
    boxes: Vec<distance::Bounds>,
    ends: [[i64; 2]; 2],
}

impl Spline {
    /// The curve that these points give, in BLU; of a Hermite segment the second and the fourth are tangents.
    ///
    /// # Errors
    /// If the number of points is not one of its form, if a coordinate is beyond
    /// [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), or if the curve is a single point.
    pub fn new(form: SplineForm, points: &[[i64; 2]]) -> Result<Spline, GeometryError> {
        if !form.fits(points.len()) {
            return Err(GeometryError::SplinePoints { form, given: points.len() });
        }
        points.iter().try_for_each(|point| check_coordinates(point))?;
        let segments = segments(form, points);
        if segments.iter().all(|segment| segment.coefficients.iter().all(|c| c[1..] == [0; 3])) {
            return Err(GeometryError::SplineIsPoint { point: points[0] });
        }
        let end = |which: usize| segments.get(which).map_or([[0; 2]; 2], SplineSegment::ends);
        let ends = [end(0)[0], end(segments.len() - 1)[1]];
        Ok(Spline { form, points: points.to_vec(), boxes: distance::boxes(&segments), segments, ends })
    }

    /// What its points mean.
    #[must_use]
    pub fn form(&self) -> SplineForm {
        self.form
    }

    /// The points that give it, in BLU.
    #[must_use]
    pub fn points(&self) -> &[[i64; 2]] {
        &self.points
    }

    /// Its segments, one at least.
    #[must_use]
    pub fn segments(&self) -> &[SplineSegment] {
        &self.segments
    }

    /// The start point, rounded to whole BLU, halves upwards.
    #[must_use]
    pub fn from(&self) -> [i64; 2] {
        self.ends[0]
    }

    /// The end point, rounded to whole BLU, halves upwards.
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
        self.segments.iter().map(SplineSegment::length).sum()
    }

    /// Points of the curve, in BLU, for drawing: `max_points`, but two at least; the first and the last are its ends in
    /// whole BLU.
    #[must_use]
    pub fn outline(&self, max_points: usize) -> Vec<[f64; 2]> {
        crate::foot::outline(&self.ends, self.segments.len(), max_points, |segment, u| self.segments[segment].at(u))
    }
}

fn segments(form: SplineForm, points: &[[i64; 2]]) -> Vec<SplineSegment> {
    let of =
        |divisor: i64, axis: &dyn Fn(usize) -> [i64; 4]| SplineSegment { coefficients: [axis(0), axis(1)], divisor };
    match form {
        SplineForm::Bezier => vec![of(1, &|axis| {
            let p = |index: usize| points[index][axis];
            match points.len() {
                3 => [p(0), 2 * (p(1) - p(0)), p(0) - 2 * p(1) + p(2), 0],
                _ => [p(0), 3 * (p(1) - p(0)), 3 * (p(0) - 2 * p(1) + p(2)), p(3) - 3 * p(2) + 3 * p(1) - p(0)],
            }
        })],
        SplineForm::Hermite => vec![of(1, &|axis| {
            let [p0, t0, p1, t1] = [0, 1, 2, 3].map(|index| points[index][axis]);
            [p0, t0, 3 * (p1 - p0) - 2 * t0 - t1, 2 * (p0 - p1) + t0 + t1]
        })],
        SplineForm::CatmullRom => {
            let last = points.len() - 1;
            let point = |index: Option<usize>, axis: usize| match index {
                None => 2 * points[0][axis] - points[1][axis],
                Some(index) if index > last => 2 * points[last][axis] - points[last - 1][axis],
                Some(index) => points[index][axis],
            };
            let segment = |index: usize| {
                of(2, &|axis| {
                    let all = [index.checked_sub(1), Some(index), Some(index + 1), Some(index + 2)];
                    let [p0, p1, p2, p3] = all.map(|index| point(index, axis));
                    [2 * p1, p2 - p0, 2 * p0 - 5 * p1 + 4 * p2 - p3, 3 * p1 - p0 - 3 * p2 + p3]
                })
            };
            (0..last).map(segment).collect()
        }
        SplineForm::BSpline => {
            let segment = |four: &[[i64; 2]]| {
                of(6, &|axis| {
                    let [p0, p1, p2, p3] = [0, 1, 2, 3].map(|index| four[index][axis]);
                    [p0 + 4 * p1 + p2, 3 * (p2 - p0), 3 * (p0 - 2 * p1 + p2), p3 - 3 * p2 + 3 * p1 - p0]
                })
            };
            points.windows(4).map(segment).collect()
        }
    }
}

#[cfg(test)]
mod tests;
