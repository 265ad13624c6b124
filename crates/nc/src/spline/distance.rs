//! How far a position is from a free curve.

use super::{Spline, SplineSegment};
use crate::foot::{Foot, beyond, nearest_first};

/// Segments that have a box together.
pub(super) const GROUP: usize = 32;

/// Least and greatest x and y of some segments, in whole BLU, outwards.
pub(super) type Bounds = [[i64; 2]; 2];

/// The boxes of all groups.
pub(super) fn boxes(segments: &[SplineSegment]) -> Vec<Bounds> {
    let joined = |group: &[SplineSegment]| {
        [0, 1].map(|axis| {
            let bounds = group.iter().map(|segment| segment.bounds()[axis]);
            let [least, most] =
                bounds.fold([f64::MAX, f64::MIN], |[least, most], [low, high]| [least.min(low), most.max(high)]);
            // Coordinates are far below 2^63, and a float more than exact.
            #[allow(clippy::cast_possible_truncation)]
            [least.floor() as i64 - 1, most.ceil() as i64 + 1]
        })
    };
    segments.chunks(GROUP).map(joined).collect()
}

impl SplineSegment {
    /// Its four Bézier points along an axis, in BLU.
    fn control(&self, axis: usize) -> [f64; 4] {
        let c = self.coefficients[axis].map(|c| c as f64 / self.divisor());
        [c[0], c[0] + c[1] / 3.0, c[0] + (2.0 * c[1] + c[2]) / 3.0, c[0] + c[1] + c[2] + c[3]]
    }

    /// The box of its Bézier points, in which it lies.
    fn bounds(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let points = self.control(axis);
            points.into_iter().fold([f64::MAX, f64::MIN], |[least, most], at| [least.min(at), most.max(at)])
        })
    }

    /// The place of the segment that is nearest.
    fn foot(&self, position: [f64; 2]) -> Foot {
        Foot::of_piece(
            position,
            |u| [self.at(u), self.tangent(u)],
            (growth([0, 1].map(|axis| self.control(axis)), position), 6),
        )
    }
}

/// How fast the square of the distance grows along a cubic curve of these control points by axis, halved: a polynomial of the fifth
/// degree, by its Bézier coefficients.
pub(crate) fn growth(control: [[f64; 4]; 2], position: [f64; 2]) -> [f64; 6] {
    const CHOICES: [[f64; 4]; 2] = [[1.0, 3.0, 3.0, 1.0], [1.0, 2.0, 1.0, 0.0]];
    let mut growth = [0.0; 6];
    for (control, place) in control.into_iter().zip(position) {
        let points = control.map(|point| point - place);
        for (i, point) in points.into_iter().enumerate() {
            for (j, pair) in points.windows(2).enumerate() {
                growth[i + j] += CHOICES[0][i] * CHOICES[1][j] * point * (pair[1] - pair[0]);
            }
        }
    }
    let of_five = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    std::array::from_fn(|k| growth[k] / of_five[k])
}

impl Spline {
    fn foot(&self, position: [f64; 2]) -> Foot {
        let mut nearest = Foot::NONE;
        let of_group = |group: usize| beyond(self.boxes[group].map(|ends| ends.map(|end| end as f64)), position);
        nearest_first(&mut nearest, self.boxes.len(), of_group, |group, nearest| {
            let first = group * GROUP;
            let segments = &self.segments[first..(first + GROUP).min(self.segments.len())];
            let of_segment = |index: usize| beyond(segments[index].bounds(), position);
            nearest_first(nearest, segments.len(), of_segment, |index, nearest| {
                nearest.take(segments[index].foot(position));
            });
        });
        nearest
    }

    /// The distance of a position from the curve, in BLU; further coordinates are ignored; NaN with too few of
    /// them.
    ///
    /// Every minimum of the distance is found by halving, as exactly as `f64` rounds.
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        let [x, y, ..] = *position else { return f64::NAN };
        self.foot([x as f64, y as f64]).distance
    }

    /// The distance with its side: positive on the left of the curve.
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        let [x, y, ..] = *position else { return f64::NAN };
        self.foot([x as f64, y as f64]).signed()
    }
}
