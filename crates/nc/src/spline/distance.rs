//! How far a position is from a free curve.

use super::{Spline, SplineSegment};

/// Halvings of a segment that place a minimum as exactly as an `f64` can.
pub(crate) const HALVINGS: u32 = 52;

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

/// A distance that no place in a box is nearer than.
pub(crate) fn beyond(bounds: [[f64; 2]; 2], position: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis: usize| {
        let ([least, most], at) = (bounds[axis], position[axis]);
        (least - at).max(at - most).max(0.0)
    });
    x.hypot(y)
}

/// Visits what may be nearer than the nearest so far by its bound, that of the least bound first.
pub(crate) fn nearest_first(
    nearest: &mut Foot,
    count: usize,
    bound: impl Fn(usize) -> f64,
    mut visit: impl FnMut(usize, &mut Foot),
) {
    let Some(first) = (0..count).min_by(|a, b| bound(*a).total_cmp(&bound(*b))) else { return };
    for index in std::iter::once(first).chain((0..count).filter(|index| *index != first)) {
        if bound(index) < nearest.distance {
            visit(index, nearest);
        }
    }
}

/// The place of a curve that is nearest to a position.
pub(crate) struct Foot {
    pub(crate) distance: f64,
    /// Positive where the position is on the left.
    pub(crate) side: f64,
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

    fn foot_at(&self, u: f64, [x, y]: [f64; 2]) -> Foot {
        let ([at_x, at_y], [dx, dy]) = (self.at(u), self.tangent(u));
        Foot { distance: (x - at_x).hypot(y - at_y), side: dx * (y - at_y) - dy * (x - at_x) }
    }

    /// How fast the square of the distance grows along the segment, halved: a polynomial of the fifth degree, by its
    /// Bézier coefficients.
    fn growth(&self, position: [f64; 2]) -> [f64; 6] {
        const CHOICES: [[f64; 4]; 2] = [[1.0, 3.0, 3.0, 1.0], [1.0, 2.0, 1.0, 0.0]];
        let mut growth = [0.0; 6];
        for (axis, place) in position.into_iter().enumerate() {
            let points = self.control(axis).map(|point| point - place);
            for (i, point) in points.into_iter().enumerate() {
                for (j, pair) in points.windows(2).enumerate() {
                    growth[i + j] += CHOICES[0][i] * CHOICES[1][j] * point * (pair[1] - pair[0]);
                }
            }
        }
        let of_five = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        std::array::from_fn(|k| growth[k] / of_five[k])
    }

    /// The place of the segment that is nearest.
    fn foot(&self, position: [f64; 2]) -> Foot {
        let mut nearest = self.foot_at(0.0, position);
        let mut take = |u: f64| {
            let foot = self.foot_at(u, position);
            if foot.distance < nearest.distance {
                nearest = foot;
            }
        };
        take(1.0);
        minima(self.growth(position), 6, [0.0, 1.0], HALVINGS, &mut take);
        nearest
    }
}

/// Visits every place from `low` to `low + length` at which a polynomial of these Bézier coefficients, `count` of them,
/// may turn from negative to positive.
pub(crate) fn minima<const N: usize>(
    growth: [f64; N],
    count: usize,
    [low, length]: [f64; 2],
    halvings: u32,
    visit: &mut impl FnMut(f64),
) {
    // A polynomial has no more roots than its coefficients have changes of sign.
    let mut signs = growth[..count].iter().filter(|c| **c != 0.0).map(|c| *c > 0.0);
    let Some(first) = signs.next() else { return };
    let (mut sign, mut changes) = (first, 0);
    for next in signs {
        changes += u32::from(next != sign);
        sign = next;
    }
    if changes == 0 || changes == 1 && first {
        return;
    }
    if halvings == 0 {
        visit(low + length / 2.0);
        return;
    }
    let [left, right] = halves(growth, count);
    if right[0] == 0.0 {
        visit(low + length / 2.0);
    }
    minima(left, count, [low, length / 2.0], halvings - 1, visit);
    minima(right, count, [low + length / 2.0, length / 2.0], halvings - 1, visit);
}

/// The Bézier coefficients of both halves, by de Casteljau.
fn halves<const N: usize>(mut right: [f64; N], count: usize) -> [[f64; N]; 2] {
    let mut left = right;
    for (round, left) in left[..count].iter_mut().enumerate() {
        if round > 0 {
            for place in 0..count - round {
                right[place] = f64::midpoint(right[place], right[place + 1]);
            }
        }
        *left = right[0];
    }
    [left, right]
}

impl Spline {
    fn foot(&self, position: [f64; 2]) -> Foot {
        let mut nearest = Foot { distance: f64::INFINITY, side: 0.0 };
        let of_group = |group: usize| beyond(self.boxes[group].map(|ends| ends.map(|end| end as f64)), position);
        nearest_first(&mut nearest, self.boxes.len(), of_group, |group, nearest| {
            let first = group * GROUP;
            let segments = &self.segments[first..(first + GROUP).min(self.segments.len())];
            let of_segment = |index: usize| beyond(segments[index].bounds(), position);
            nearest_first(nearest, segments.len(), of_segment, |index, nearest| {
                let foot = segments[index].foot(position);
                if foot.distance < nearest.distance {
                    *nearest = foot;
                }
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
        let foot = self.foot([x as f64, y as f64]);
        if foot.side < 0.0 { -foot.distance } else { foot.distance }
    }
}
