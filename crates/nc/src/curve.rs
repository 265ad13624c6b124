//! The ideal curve of a block, of any kind.

use crate::{Arc, Conic, Helix, Line};

/// The greatest number of points of an outline, so that no request exhausts the memory.
pub const OUTLINE_LIMIT: usize = 1 << 16;

/// The number of points that an outline has when `max_points` are asked for.
pub(crate) fn outline_points(max_points: usize) -> usize {
    max_points.clamp(2, OUTLINE_LIMIT)
}

/// The ideal curve of one block.
///
/// ```
/// use stepwave_nc::{Curve, Line};
///
/// let curve: Curve = Line::new(vec![0, 0], vec![6, 8])?.into();
/// assert_eq!((curve.to(), curve.axes(), curve.length()), (&[6, 8][..], 2, 10.0));
/// assert_eq!(curve.signed_deviation(&[0, 5]), 3.0); // left of the line
/// # Ok::<(), stepwave_nc::GeometryError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Curve {
    /// A straight line in two to six axes.
    Line(Line),
    /// A circular arc in x and y.
    Arc(Arc),
    /// An ellipse, a parabola or a hyperbola in x and y.
    Conic(Conic),
    /// An arc in x and y with a travel in z.
    Helix(Helix),
}

impl Curve {
    /// The start point in machine coordinates, in BLU.
    #[must_use]
    pub fn from(&self) -> &[i64] {
        match self {
            Curve::Line(line) => line.from(),
            Curve::Arc(arc) => arc.ends().0,
            Curve::Conic(conic) => conic.ends().0,
            Curve::Helix(helix) => helix.ends().0,
        }
    }

    /// The end point in machine coordinates, in BLU.
    #[must_use]
    pub fn to(&self) -> &[i64] {
        match self {
            Curve::Line(line) => line.to(),
            Curve::Arc(arc) => arc.ends().1,
            Curve::Conic(conic) => conic.ends().1,
            Curve::Helix(helix) => helix.ends().1,
        }
    }

    /// The number of axes: 2 to 6 for a line, 2 for an arc or a conic, 3 for a helix.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.from().len()
    }

    /// The length of the ideal curve, in BLU.
    #[must_use]
    pub fn length(&self) -> f64 {
        match self {
            Curve::Line(line) => line.length(),
            Curve::Arc(arc) => arc.length(),
            Curve::Conic(conic) => conic.length(),
            Curve::Helix(helix) => helix.length(),
        }
    }

    /// The distance of a position from the infinite line, the whole circle or conic (one branch of a hyperbola) or the
    /// helix, in BLU; never negative.
    ///
    /// Coordinates beyond the axes of the curve are ignored; with too few there is no distance (NaN). See
    /// [`Line::deviation`], [`Arc::deviation`], [`Conic::deviation`] and [`Helix::deviation`] for the accuracy.
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        match self {
            Curve::Line(line) => line.deviation(position),
            Curve::Arc(arc) => arc.deviation(position),
            Curve::Conic(conic) => conic.deviation(position),
            Curve::Helix(helix) => helix.deviation(position),
        }
    }

    /// The distance with its side, in BLU: positive on the left of a two-axis line, outside a circle, an ellipse, a
    /// parabola or a helix's cylinder, and inside the bend of a hyperbola.
    ///
    /// Its magnitude is [`deviation`](Curve::deviation); a line of more than two axes has no side.
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        match self {
            Curve::Line(line) => line.signed_deviation(position),
            Curve::Arc(arc) => arc.signed_deviation(position),
            Curve::Conic(conic) => conic.signed_deviation(position),
            Curve::Helix(helix) => helix.signed_deviation(position),
        }
    }

    /// The greater of the distances of both ends from the ideal curve, in BLU: 0 of a line, and of ends on the curve.
    ///
    /// ```
    /// use stepwave_nc::{Arc, Curve, Direction};
    ///
    /// let arc: Curve = Arc::new([4, 0], [1, -3], [0, 0], Direction::Clockwise)?.into();
    /// assert!((arc.ends_off() - (4.0 - f64::sqrt(10.0))).abs() < 1e-12);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn ends_off(&self) -> f64 {
        match self {
            // Both ends make the line.
            Curve::Line(_) => 0.0,
            _ => self.deviation(self.from()).max(self.deviation(self.to())),
        }
    }

    /// Ideal points in the first two axes, in BLU and machine coordinates, for drawing.
    ///
    /// A line gives its two ends, every other curve `max_points` points (two at least, [`OUTLINE_LIMIT`] at most). The
    /// first and the last are the programmed ends exactly.
    #[must_use]
    pub fn outline(&self, max_points: usize) -> Vec<[f64; 2]> {
        match self {
            Curve::Line(line) => line.outline(),
            Curve::Arc(arc) => arc.outline(max_points),
            Curve::Conic(conic) => conic.outline(max_points),
            Curve::Helix(helix) => helix.outline(max_points),
        }
    }
}

impl From<Line> for Curve {
    fn from(line: Line) -> Curve {
        Curve::Line(line)
    }
}

impl From<Arc> for Curve {
    fn from(arc: Arc) -> Curve {
        Curve::Arc(arc)
    }
}

impl From<Conic> for Curve {
    fn from(conic: Conic) -> Curve {
        Curve::Conic(conic)
    }
}

impl From<Helix> for Curve {
    fn from(helix: Helix) -> Curve {
        Curve::Helix(helix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Direction, GeometryError};

    #[test]
    fn both_kinds_of_curve_answer_alike() -> Result<(), GeometryError> {
        let line: Curve = Line::new(vec![1, 2, 3], vec![1, 2, 8])?.into();
        assert_eq!((line.from(), line.to(), line.axes()), (&[1, 2, 3][..], &[1, 2, 8][..], 3));
        assert_eq!((line.length(), line.deviation(&[4, 6, 9]), line.signed_deviation(&[4, 6, 9])), (5.0, 5.0, 5.0));
        assert_eq!(line.outline(100), [[1.0, 2.0]; 2]);

        let arc: Curve = Arc::new([5, 0], [0, 5], [0, 0], Direction::CounterClockwise)?.into();
        assert_eq!((arc.from(), arc.to(), arc.axes()), (&[5, 0][..], &[0, 5][..], 2));
        assert_eq!(arc.length(), 2.5 * std::f64::consts::PI);
        assert_eq!((arc.deviation(&[0, 3]), arc.signed_deviation(&[0, 3])), (2.0, -2.0));
        assert_eq!(arc.outline(9).len(), 9);
        Ok(())
    }
}
