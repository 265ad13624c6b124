//! Bézier curves of a contour in real numbers: G05 and G05.1.

use crate::foot::Foot;
use crate::nurbs::Piece;
use crate::spline::growth;
use crate::{Controls, Segment, SegmentShape};

/// A Bézier curve of a contour in x and y, with real control points.
///
/// ```
/// use stepwave_nc::{Controls, Segment, SegmentShape};
///
/// let shape = SegmentShape::Bezier(Controls::One([50.0, 100.0]));
/// let curve = Segment { from: [0.0; 3], to: [100.0, 0.0, 0.0], shape }.bezier().unwrap();
/// assert_eq!((curve.at(0.5), curve.distance([50.0, 53.0])), ([50.0, 50.0], 3.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bezier(Piece<2>);

impl Segment {
    /// The curve of G05 or G05.1 that it is; `None` of a line or an arc.
    #[must_use]
    pub fn bezier(&self) -> Option<Bezier> {
        let SegmentShape::Bezier(controls) = self.shape else { return None };
        let [from, to] = [self.from, self.to].map(|[x, y, _]| [x, y]);
        Some(Bezier(match controls {
            Controls::One(control) => Piece::polynomial(&[from, control, to]),
            Controls::Two([first, second]) => Piece::polynomial(&[from, first, second, to]),
        }))
    }
}

impl Bezier {
    /// Its control points with both ends, three or four, in BLU.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        self.0.points()
    }

    /// The point at u, from 0 to 1, in BLU.
    #[must_use]
    pub fn at(&self, u: f64) -> [f64; 2] {
        self.0.at(u)
    }

    /// The length, in BLU.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.0.length()
    }

    /// The distance of a place from the curve, in BLU.
    #[must_use]
    pub fn distance(&self, place: [f64; 2]) -> f64 {
        let along = |axis: usize| match *self.points() {
            // The same curve with a control point more.
            [first, middle, last] => {
                let [first, middle, last] = [first[axis], middle[axis], last[axis]];
                [first, (first + 2.0 * middle) / 3.0, (2.0 * middle + last) / 3.0, last]
            }
            _ => [0, 1, 2, 3].map(|index| self.0.control[index][axis]),
        };
        let growth = growth([along(0), along(1)], place);
        Foot::of_piece(place, |u| [self.0.at(u), self.0.tangent(u)], (growth, 6)).distance
    }

    /// Least and greatest coordinate along both axes that its control points have, between which it lies.
    #[must_use]
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        self.0.bounds()
    }

    /// The curve as a piece of a NURBS.
    pub(crate) fn piece(self) -> Piece<2> {
        self.0
    }

    /// It is a single point.
    pub(crate) fn is_point(&self) -> bool {
        self.points().iter().all(|point| point == &self.points()[0])
    }

    /// The ends of chords of which no place is farther from it than `tolerance`, in BLU.
    pub(crate) fn chords(&self, tolerance: f64) -> Vec<[f64; 2]> {
        let mut ends = Vec::new();
        self.0.chords(tolerance, usize::MAX, &mut |end| ends.push(end));
        ends
    }

    /// Vectors along the curve at both ends: from an end to the nearest control point that is another place. Those of a
    /// single point are 0.
    pub(crate) fn along(&self) -> [[f64; 2]; 2] {
        let points = self.points();
        let [first, last] = [points[0], points[points.len() - 1]];
        let by = |from: [f64; 2], to: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
        let start = points.iter().find(|point| **point != first).map_or([0.0; 2], |next| by(first, *next));
        let end = points.iter().rfind(|point| **point != last).map_or([0.0; 2], |before| by(*before, last));
        [start, end]
    }

    /// How fast it is at both ends, to its mean speed over u: of a curve that is run evenly in u, what the speed there is to that
    /// of the feed.
    #[must_use]
    pub fn ends_to_mean(&self) -> [f64; 2] {
        let length = self.length();
        [0.0, 1.0].map(|u| {
            let [x, y] = self.0.tangent(u);
            f64::hypot(x, y) / length
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(from: [f64; 2], to: [f64; 2], controls: Controls) -> Segment {
        let [from, to] = [from, to].map(|[x, y]| [x, y, 2.0]);
        Segment { from, to, shape: SegmentShape::Bezier(controls) }
    }

    /// Against many places of the curve by the basis of Bernstein.
    #[test]
    fn a_distance_is_that_of_the_nearest_place() {
        let (from, to) = ([3.0, -7.0], [80.0, 20.5]);
        for controls in [Controls::One([-20.0, 50.0]), Controls::Two([[120.0, 90.0], [-60.0, 31.5]])] {
            let segment = curve(from, to, controls);
            let bezier = segment.bezier().unwrap();
            let at = |u: f64| {
                let v = 1.0 - u;
                [0, 1].map(|axis| match controls {
                    Controls::One(c) => from[axis] * v * v + 2.0 * c[axis] * u * v + to[axis] * u * u,
                    Controls::Two([c, d]) => {
                        let inner = 3.0 * (c[axis] * v + d[axis] * u) * u * v;
                        from[axis] * v * v * v + inner + to[axis] * u * u * u
                    }
                })
            };
            let places: Vec<[f64; 2]> = (0..=20_000).map(|part| at(f64::from(part) / 20_000.0)).collect();
            for index in 0..200 {
                let place = [f64::from(index * 37 % 150) - 30.0, f64::from(index * 53 % 140) - 40.0];
                let nearest = places.iter().map(|[x, y]| f64::hypot(x - place[0], y - place[1]));
                let (nearest, off) = (nearest.fold(f64::INFINITY, f64::min), bezier.distance(place));
                assert!(off <= nearest + 1e-9 && nearest - off < 0.01, "{controls:?} {place:?}: {off}, not {nearest}");
            }
            let chords: f64 =
                places.windows(2).map(|pair| f64::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum();
            assert!((segment.length() - chords).abs() < 1e-4 && segment.bend().is_none());
        }
    }

    #[test]
    fn tangents_pass_over_control_points_at_an_end() {
        let (from, to) = ([0.0, 0.0], [30.0, 0.0]);
        let tangents = |controls| curve(from, to, controls).tangents().unwrap();
        let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(tangents(Controls::Two([[0.0, 8.0], [20.0, 0.0]])), [y, x]);
        assert_eq!(tangents(Controls::Two([from, [0.0, 8.0]])), [y, [30.0, -8.0, 0.0].map(|c| c / 964.0_f64.sqrt())]);
        assert_eq!(tangents(Controls::Two([from, to])), [x, x]);
        assert_eq!(tangents(Controls::One(to)), [x, x]);
        assert!(curve(from, from, Controls::One(from)).tangents().is_none());
    }

    /// X(u) = 15·u + 15·u² has the speeds 15 and 45 at its ends, and 30 between; with both control points at the ends it stops
    /// there.
    #[test]
    fn speeds_at_both_ends_are_to_the_mean_as_the_derivatives() {
        let (from, to) = ([0.0, 0.0], [30.0, 0.0]);
        let of = |controls| curve(from, to, controls).bezier().unwrap().ends_to_mean();
        assert!(of(Controls::One([7.5, 0.0])).iter().zip([0.5, 1.5]).all(|(is, wanted)| (is - wanted).abs() < 1e-9));
        assert_eq!(of(Controls::Two([from, to])), [0.0, 0.0]);
    }
}
