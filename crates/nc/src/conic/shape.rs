//! What kind of conic a curve is, how large, and where it opens to.

use std::fmt;
use std::ops::Neg;

use crate::exact::{Vector, vector};

/// Where a parabola or a branch of a hyperbola opens to; displays as `+x`, `-x`, `+y` or `-y`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Opens {
    /// Towards positive x: y² = cx.
    PlusX,
    /// Towards negative x: y² = -cx.
    MinusX,
    /// Towards positive y: x² = cy.
    PlusY,
    /// Towards negative y: x² = -cy.
    MinusY,
}

impl Opens {
    /// All four, in the order in which a missing one is looked for.
    pub const ALL: [Opens; 4] = [Opens::PlusX, Opens::MinusX, Opens::PlusY, Opens::MinusY];

    /// The axis of symmetry: 0 is x, 1 is y.
    #[must_use]
    pub fn axis(self) -> usize {
        match self {
            Opens::PlusX | Opens::MinusX => 0,
            Opens::PlusY | Opens::MinusY => 1,
        }
    }

    /// The sign (+1 or -1) of the coordinate on the axis of symmetry along the curve.
    #[must_use]
    pub fn sign(self) -> i64 {
        match self {
            Opens::PlusX | Opens::PlusY => 1,
            Opens::MinusX | Opens::MinusY => -1,
        }
    }

    /// The coordinates along the axis of symmetry, to where the curve opens, and across it.
    pub(crate) fn along_across<T: Neg<Output = T>>(self, [x, y]: [T; 2]) -> [T; 2] {
        match self {
            Opens::PlusX => [x, y],
            Opens::MinusX => [-x, y],
            Opens::PlusY => [y, x],
            Opens::MinusY => [-y, x],
        }
    }

    /// The x and y of coordinates along and across the axis of symmetry.
    pub(crate) fn plane<T: Neg<Output = T>>(self, [along, across]: [T; 2]) -> [T; 2] {
        match self {
            Opens::PlusX => [along, across],
            Opens::MinusX => [-along, across],
            Opens::PlusY => [across, along],
            Opens::MinusY => [across, -along],
        }
    }
}

impl fmt::Display for Opens {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Opens::PlusX => "+x",
            Opens::MinusX => "-x",
            Opens::PlusY => "+y",
            Opens::MinusY => "-y",
        })
    }
}

/// The kind, the size and the orientation of a conic about its centre or vertex; lengths in BLU.
///
/// ```
/// use stepwave_nc::{Opens, Shape};
///
/// assert_eq!(Shape::Ellipse { semi_axes: [6, 4] }.to_string(), "ellipse of semi-axes 6, 4 BLU");
/// assert_eq!(Shape::Parabola { c: 9, opens: Opens::MinusY }.to_string(), "parabola of c = 9 BLU opening to -y");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    /// x²/a² + y²/b² = 1.
    Ellipse {
        /// The semi-axes a along x and b along y.
        semi_axes: [i64; 2],
    },
    /// y² = cx, or what [`Opens`] says.
    Parabola {
        /// The parameter c, twice the distance from the focus to the directrix.
        c: i64,
        /// Where it opens to.
        opens: Opens,
    },
    /// x²/a² - y²/b² = 1 with x > 0, or what [`Opens`] says; a is the real semi-axis in every orientation.
    Hyperbola {
        /// The real semi-axis a and the imaginary semi-axis b.
        semi_axes: [i64; 2],
        /// Where the branch opens to.
        opens: Opens,
    },
}

impl Shape {
    /// Where the curve opens to; an ellipse is closed.
    #[must_use]
    pub fn opens(self) -> Option<Opens> {
        match self {
            Shape::Ellipse { .. } => None,
            Shape::Parabola { opens, .. } | Shape::Hyperbola { opens, .. } => Some(opens),
        }
    }

    /// The implicit function at a point relative to the centre: exact where it fits `i128`, and of the right sign where
    /// it does not.
    pub(crate) fn implicit(self, point: Vector) -> i128 {
        match self {
            Shape::Ellipse { semi_axes } => {
                let ([a, b], [x, y]) = (vector(semi_axes), point);
                square(b * x).saturating_add(square(a * y)) - square(a * b)
            }
            Shape::Parabola { c, opens } => {
                let [along, across] = opens.along_across(point);
                square(across) - i128::from(c) * along
            }
            Shape::Hyperbola { semi_axes, opens } => {
                let ([a, b], [along, across]) = (vector(semi_axes), opens.along_across(point));
                let [real, imaginary] = [(b * along).abs(), (a * across).abs()];
                (real - imaginary).saturating_mul(real + imaginary).saturating_sub(square(a * b))
            }
        }
    }

    /// Whether a point near the curve is on the side of it where the curve is: not the centre of an ellipse, not beyond
    /// the vertex of a parabola, not level with the centre of a hyperbola or beyond it.
    pub(crate) fn on_branch(self, point: [i64; 2]) -> bool {
        match self {
            Shape::Ellipse { .. } => point != [0, 0],
            Shape::Parabola { opens, .. } => opens.along_across(point)[0] >= 0,
            Shape::Hyperbola { opens, .. } => opens.along_across(point)[0] > 0,
        }
    }

    /// What the origin of the curve's own coordinates is.
    pub(crate) fn middle(self) -> &'static str {
        match self {
            Shape::Ellipse { .. } | Shape::Hyperbola { .. } => "centre",
            Shape::Parabola { .. } => "vertex",
        }
    }

    /// Where a point lies that is not [`on_branch`](Shape::on_branch), as a clause of a message.
    pub(crate) fn off_branch(self) -> &'static str {
        match self {
            Shape::Ellipse { .. } => "at its centre, from where no direction leads along it",
            Shape::Parabola { .. } => "behind its vertex",
            Shape::Hyperbola { .. } => "not on its branch",
        }
    }
}

fn square(value: i128) -> i128 {
    value.saturating_mul(value)
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Shape::Ellipse { semi_axes: [a, b] } => write!(f, "ellipse of semi-axes {a}, {b} BLU"),
            Shape::Parabola { c, opens } => write!(f, "parabola of c = {c} BLU opening to {opens}"),
            Shape::Hyperbola { semi_axes: [a, b], opens } => {
                write!(f, "hyperbola of semi-axes {a}, {b} BLU opening to {opens}")
            }
        }
    }
}

/// The interval weight of the pulses of one axis, as a function of that axis' magnitude m: slope·m + constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Weight {
    /// What the weight gains as the magnitude of the coordinate grows by 1 BLU.
    pub slope: i128,
    /// The weight at the coordinate 0.
    pub constant: i128,
}

impl Weight {
    /// The weight where the coordinate has this magnitude; saturates, which no point within the limits comes near to.
    ///
    /// ```
    /// use stepwave_nc::Weight;
    ///
    /// assert_eq!(Weight { slope: 9, constant: 0 }.at(4), 36);
    /// ```
    #[must_use]
    pub fn at(self, magnitude: i64) -> i128 {
        self.slope.saturating_mul(magnitude.into()).saturating_add(self.constant)
    }
}
