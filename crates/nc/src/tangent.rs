//! Directions and bends of segments.

use crate::pulses::swept;
use crate::{Coordinates, Direction, FeedAxes, Point, Segment, SegmentShape, ToolMove};

impl Segment {
    /// The unit vectors along the segment at its start and its end, in x, y and z; none of a segment of no length.
    ///
    /// ```
    /// use stepwave_nc::{Direction, Plane, Segment, SegmentShape};
    ///
    /// let shape = SegmentShape::Arc { plane: Plane::Xy, center: [0.0; 2], direction: Direction::CounterClockwise };
    /// let [start, end] = Segment { from: [5.0, 0.0, 0.0], to: [0.0, 5.0, 0.0], shape }.tangents().unwrap();
    /// assert_eq!((start, end), ([0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]));
    /// ```
    #[must_use]
    pub fn tangents(&self) -> Option<[Point; 2]> {
        if let Some(curve) = self.bezier() {
            let [start, end] = curve.along().map(|[x, y]| unit([x, y, 0.0]));
            return Some([start?, end?]);
        }
        let SegmentShape::Arc { plane, center, direction } = self.shape else {
            let unit = unit([0, 1, 2].map(|axis| self.to[axis] - self.from[axis]))?;
            return Some([unit; 2]);
        };
        let sign = if direction == Direction::Clockwise { -1.0 } else { 1.0 };
        let angle = swept(self, plane, center, direction);
        let climb = plane.of(self.to)[2] - plane.of(self.from)[2];
        let at = |point: Point| {
            let [u, v, _] = plane.of(point);
            let [u, v] = [u - center[0], v - center[1]];
            // The third axis goes as far for each radian as the plane goes by the radius.
            unit(plane.point([-v * sign, u * sign, climb / angle]))
        };
        Some([at(self.from)?, at(self.to)?])
    }

    /// The length, in BLU; of an arc whose radius changes evenly that of its mean radius.
    #[must_use]
    pub fn length(&self) -> f64 {
        if let Some(curve) = self.bezier() {
            return curve.length();
        }
        let SegmentShape::Arc { plane, center, direction } = self.shape else {
            return [0, 1, 2].map(|axis| self.to[axis] - self.from[axis]).into_iter().fold(0.0, f64::hypot);
        };
        let radii = [self.from, self.to].map(|point| {
            let [u, v, _] = plane.of(point);
            f64::hypot(u - center[0], v - center[1])
        });
        let climb = plane.of(self.to)[2] - plane.of(self.from)[2];
        f64::hypot(f64::midpoint(radii[0], radii[1]) * swept(self, plane, center, direction), climb)
    }

    /// The radius of curvature, in BLU; `None` of a line, and of a free curve, which has not one alone.
    #[must_use]
    pub fn bend(&self) -> Option<f64> {
        let SegmentShape::Arc { plane, center, direction } = self.shape else { return None };
        let [u, v, third] = plane.of(self.from);
        let radius = f64::hypot(u - center[0], v - center[1]);
        let climb = (plane.of(self.to)[2] - third) / swept(self, plane, center, direction);
        Some(radius + climb * climb / radius)
    }
}

impl ToolMove {
    /// How far each axis goes for a BLU of the path that the feed is along, at the start and at the end; none of a move of no
    /// length.
    #[must_use]
    pub fn directions(&self) -> Option<[Coordinates; 2]> {
        let [from, to] = self.ends();
        let travels: Coordinates = std::array::from_fn(|axis| to[axis] - from[axis]);
        let along = self.feed_axes();
        let length = match along {
            FeedAxes::Linear => self.segment.length(),
            _ => travels[along.axes()].iter().copied().fold(0.0, f64::hypot),
        };
        let even = travels.map(|travel| travel / length);
        if along != FeedAxes::Linear {
            return Some([even; 2]);
        }
        let tool = self.segment.tangents()?;
        Some(tool.map(|[x, y, z]| {
            let mut directions = even;
            directions[..3].copy_from_slice(&[x, y, z]);
            directions
        }))
    }
}

fn unit(vector: Point) -> Option<Point> {
    let length = vector.into_iter().fold(0.0, f64::hypot);
    (length > 0.0).then(|| vector.map(|c| c / length + 0.0))
}
