//! The deviation of many positions from one curve, with all that they share worked out before.

use crate::helix::Ruler;
use crate::{Arc, Curve, Line};

/// Relative coordinates below this have squares and products of which two together fit in an `i64`.
const NEAR: i64 = 1 << 31;

/// Measures the distance of positions from one curve: the values of [`Curve::deviation`], quickly.
///
/// ```
/// use stepwave_nc::{Curve, Line};
///
/// let curve: Curve = Line::new(vec![0, 0], vec![4, 3])?.into();
/// let gauge = curve.gauge();
/// assert_eq!(gauge.deviation(&[0, 5]), 4.0);
/// # Ok::<(), stepwave_nc::GeometryError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Gauge<'a> {
    curve: &'a Curve,
    plane: Option<Plane>,
    ruler: Option<Ruler>,
}

/// A curve of two axes that spans less than [`NEAR`] on each.
#[derive(Clone, Copy, Debug)]
enum Plane {
    Line { from: [i64; 2], delta: [i64; 2], length: f64 },
    Circle { center: [i64; 2], radius_squared: u64, radius: f64 },
}

fn near(offsets: [i64; 2]) -> bool {
    offsets.iter().all(|offset| offset.unsigned_abs() < NEAR.unsigned_abs())
}

fn line(line: &Line) -> Option<Plane> {
    let delta = <[i64; 2]>::try_from(line.delta()).ok().filter(|delta| near(*delta))?;
    Some(Plane::Line { from: [line.from()[0], line.from()[1]], delta, length: line.length() })
}

fn circle(arc: &Arc) -> Option<Plane> {
    let radius_squared = u64::try_from(arc.radius_squared()).ok()?;
    Some(Plane::Circle { center: arc.center(), radius_squared, radius: arc.radius() })
}

impl Curve {
    /// A gauge of this curve.
    #[must_use]
    pub fn gauge(&self) -> Gauge<'_> {
        let plane = match self {
            Curve::Line(given) => line(given),
            Curve::Arc(arc) => circle(arc),
            _ => None,
        };
        let ruler = if let Curve::Helix(helix) = self { Some(helix.ruler()) } else { None };
        Gauge { curve: self, plane, ruler }
    }
}

impl Gauge<'_> {
    /// The distance of a position from the curve, in BLU: [`Curve::deviation`], to the bit.
    #[inline]
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        let from = |[x0, y0]: [i64; 2]| match *position {
            [x, y, ..] => Some([x.checked_sub(x0)?, y.checked_sub(y0)?]).filter(|offset| near(*offset)),
            _ => None,
        };
        match self.plane {
            Some(Plane::Line { from: start, delta: [dx, dy], length }) => {
                if let Some([x, y]) = from(start) {
                    return (dx * y - dy * x).unsigned_abs() as f64 / length;
                }
            }
            Some(Plane::Circle { center, radius_squared, radius }) => {
                if let Some([x, y]) = from(center) {
                    let reached = (x * x + y * y).unsigned_abs();
                    return reached.abs_diff(radius_squared) as f64 / ((reached as f64).sqrt() + radius);
                }
            }
            None => {}
        }
        self.ruler.as_ref().map_or_else(|| self.curve.deviation(position), |ruler| ruler.deviation(position))
    }
}

/// The greatest deviation of many positions at once.
#[derive(Clone, Copy, Debug)]
pub struct BatchGauge(Plane);

impl Gauge<'_> {
    /// A gauge for positions of two axes of which every coordinate lies in `-reach..=reach`; `None` where the curve or
    /// they reach so far that it could be wrong, and for a conic or a helix.
    #[must_use]
    pub fn batch(&self, reach: u64) -> Option<BatchGauge> {
        let plane = self.plane?;
        let (Plane::Line { from: [x, y], .. } | Plane::Circle { center: [x, y], .. }) = plane;
        let farthest = x.unsigned_abs().max(y.unsigned_abs()).checked_add(reach)?;
        (farthest < NEAR.unsigned_abs()).then_some(BatchGauge(plane))
    }
}

impl BatchGauge {
    /// The greatest deviation of some positions, in BLU; 0 without a position. Branchless, for hot loops: within the
    /// reach that the gauge was made for no product and no sum leaves `i64`, so that none of them is checked.
    #[inline(always)]
    #[must_use]
    pub fn greatest(&self, positions: impl Iterator<Item = [i64; 2]>) -> f64 {
        match self.0 {
            Plane::Line { from: [x0, y0], delta: [dx, dy], length } => {
                let cross = |[x, y]: [i64; 2]| {
                    let [x, y] = [x.wrapping_sub(x0), y.wrapping_sub(y0)];
                    dx.wrapping_mul(y).wrapping_sub(dy.wrapping_mul(x)).unsigned_abs()
                };
                positions.map(cross).fold(0, u64::max) as f64 / length
            }
            Plane::Circle { center: [x0, y0], radius_squared, radius } => {
                let squared = |[x, y]: [i64; 2]| {
                    let [x, y] = [x.wrapping_sub(x0), y.wrapping_sub(y0)];
                    x.wrapping_mul(x).wrapping_add(y.wrapping_mul(y)).unsigned_abs()
                };
                let start = (radius_squared, radius_squared);
                let (least, most) =
                    positions.map(squared).fold(start, |(least, most), now| (least.min(now), most.max(now)));
                let off = |reached: u64| reached.abs_diff(radius_squared) as f64 / ((reached as f64).sqrt() + radius);
                off(least).max(off(most))
            }
        }
    }
}

impl BatchGauge {
    /// Factors of x and x², and of y and y², in a number of which [`within`](Self::within) is the deviation.
    #[must_use]
    pub fn factors(&self) -> [[i64; 2]; 2] {
        match self.0 {
            Plane::Line { delta: [dx, dy], .. } => [[-dy, 0], [dx, 0]],
            Plane::Circle { center: [x0, y0], .. } => [[-2 * x0, 1], [-2 * y0, 1]],
        }
    }

    /// The greatest deviation, in BLU, of positions for which that number lies in a range; both its ends are reached.
    #[must_use]
    pub fn within(&self, ends: [i64; 2]) -> f64 {
        match self.0 {
            Plane::Line { length, .. } => self.crossed(ends).unwrap_or_default() as f64 / length,
            Plane::Circle { center: [x0, y0], radius_squared, radius } => {
                let off = |end: i64| {
                    let reached = i128::from(end) + i128::from(x0).pow(2) + i128::from(y0).pow(2);
                    let reached = u64::try_from(reached).unwrap_or(0);
                    reached.abs_diff(radius_squared) as f64 / ((reached as f64).sqrt() + radius)
                };
                off(ends[0]).max(off(ends[1]))
            }
        }
    }

    /// The greatest cross product, in BLU², of a line and positions on it for which that number lies in a range; both its
    /// ends are reached. `None` of a circle.
    #[must_use]
    pub fn crossed(&self, ends: [i64; 2]) -> Option<u128> {
        let Plane::Line { from: [x0, y0], delta: [dx, dy], .. } = self.0 else { return None };
        let start = i128::from(dy) * i128::from(x0) - i128::from(dx) * i128::from(y0);
        ends.map(|end| (i128::from(end) + start).unsigned_abs()).into_iter().max()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{COORDINATE_LIMIT, Direction, GeometryError};

    /// Positions around the origin and around a far point, near and far from it.
    fn positions(around: [i64; 2]) -> Vec<[i64; 2]> {
        let offsets = [0, 1, -1, 2, 5, -7, 100, (1 << 31) - 1, -(1 << 31) + 1, 1 << 31, 1 << 33, i64::MAX, i64::MIN];
        let each = offsets.iter().flat_map(|x| offsets.iter().map(move |y| [*x, *y]));
        each.map(|[x, y]| [around[0].saturating_add(x), around[1].saturating_add(y)]).collect()
    }

    fn assert_same(curve: &Curve) {
        let gauge = curve.gauge();
        let from = [curve.from()[0], curve.from()[1]];
        let to = [curve.to()[0], curve.to()[1]];
        for position in [positions([0, 0]), positions(from), positions(to)].concat() {
            let [quick, plain] = [gauge.deviation(&position), curve.deviation(&position)];
            assert!(quick == plain || quick.is_nan() && plain.is_nan(), "{curve:?} {position:?}: {quick} {plain}");
        }
        assert!(gauge.deviation(&[1]).is_nan());
    }

    #[test]
    fn a_batch_gauge_gives_the_greatest_deviation_and_refuses_what_it_cannot() -> Result<(), GeometryError> {
        let line: Curve = Line::new(vec![3, -2], vec![90, 71])?.into();
        let circle: Curve = Arc::new([30, 40], [30, 40], [-5, 6], Direction::Clockwise)?.into();
        let far: Curve = Line::new(vec![1 << 30, 0], vec![(1 << 30) + 9, 5])?.into();
        for curve in [line, circle] {
            let (gauge, batch) = (curve.gauge(), curve.gauge().batch(1000).expect("a batch gauge"));
            let some = || (0..500_i64).map(|step| [step * 37 % 200 - 99, step * 53 % 150 - 80]);
            // Divided, they lie inside the circle, where the nearest to its centre is the worst.
            for (count, divided) in [0, 1, 2, 17, 500].into_iter().flat_map(|count| [(count, 1), (count, 9)]) {
                let positions = || some().take(count).map(|position| position.map(|offset| offset / divided));
                let each = positions().map(|position| gauge.deviation(&position));
                assert_eq!(batch.greatest(positions()), each.fold(0.0, f64::max), "{curve:?}");
            }
            assert!(gauge.batch(1 << 31).is_none() && gauge.batch(u64::MAX).is_none());
        }
        assert!(far.gauge().batch(1 << 29).is_some() && far.gauge().batch(1 << 30).is_none());
        Ok(())
    }

    #[test]
    fn a_gauge_measures_what_the_curve_does() -> Result<(), GeometryError> {
        const L: i64 = COORDINATE_LIMIT;
        for (from, to) in [([0, 0], [6, 4]), ([-3, 9], [100, -77]), ([0, 0], [1 << 31, 1]), ([-L, -L], [L, L - 1])] {
            assert_same(&Line::new(from.to_vec(), to.to_vec())?.into());
        }
        for (start, center) in [([5, 0], [0, 0]), ([3, 7], [0, 0]), ([L, 0], [0, 0]), ([L, 5 - L], [L, -L])] {
            assert_same(&Arc::new(start, start, center, Direction::Clockwise)?.into());
        }
        let spatial: Curve = Line::new(vec![0, 0, 0], vec![3, 4, 5])?.into();
        assert_eq!(spatial.gauge().deviation(&[1, 2, 4]), spatial.deviation(&[1, 2, 4]));
        Ok(())
    }
}
