//! Conics whose axes are parallel to X and Y: the implicit function, its weights, and the pieces of
//! a curve between the axes.
//!
//! Everything is relative to the centre, which for a parabola is its vertex. Axes are 0 for X and 1
//! for Y.

use super::arc_geometry::{Sector, sectors};

/// The direction of the axis to which a parabola or a branch of a hyperbola opens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Opens {
    /// To the right.
    PlusX,
    /// To the left.
    MinusX,
    /// Up.
    PlusY,
    /// Down.
    MinusY,
}

impl Opens {
    /// The axis of symmetry, and the sign of the coordinates on it.
    fn axis_and_sign(self) -> (usize, i64) {
        match self {
            Opens::PlusX => (0, 1),
            Opens::MinusX => (0, -1),
            Opens::PlusY => (1, 1),
            Opens::MinusY => (1, -1),
        }
    }
}

/// A conic; lengths in BLU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// x²/a² + y²/b² = 1: the semi-axes a (along X) and b (along Y).
    Ellipse([i64; 2]),
    /// y² = c·x with c > 0, or its image that opens to another direction.
    Parabola(i64, Opens),
    /// A branch of x²/a² - y²/b² = 1, or of y²/a² - x²/b² = 1 when it opens along Y: a is the real
    /// semi-axis.
    Hyperbola([i64; 2], Opens),
}

/// What one coordinate adds to the implicit function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Term {
    /// w·c².
    Square(i64),
    /// w·|c|.
    Linear(i64),
}

/// The implicit function of a curve: G = (term of x) + (term of y) + constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Curve {
    /// The terms of x and y.
    pub(crate) terms: [Term; 2],
    /// What makes G = 0 on the curve.
    pub(crate) constant: i64,
    /// The weights that steer an integrator belong to `scale`·G: 1 where every slope of G is even,
    /// else 2.
    pub(crate) scale: i64,
}

impl Curve {
    /// G = b²x² + a²y² - a²b², y² - c|x|, b²x² - a²y² - a²b² or an image of these.
    pub(crate) fn of(shape: Shape) -> Self {
        match shape {
            Shape::Ellipse([a, b]) => {
                assert!(a > 0 && b > 0, "semi-axes are positive");
                Curve { terms: [Term::Square(b * b), Term::Square(a * a)], constant: -a * a * b * b, scale: 1 }
            }
            Shape::Parabola(c, opens) => {
                assert!(c > 0, "c is positive");
                let mut terms = [Term::Square(1); 2];
                terms[opens.axis_and_sign().0] = Term::Linear(-c);
                Curve { terms, constant: 0, scale: 2 }
            }
            Shape::Hyperbola([a, b], opens) => {
                assert!(a > 0 && b > 0, "semi-axes are positive");
                let mut terms = [Term::Square(-a * a); 2];
                terms[opens.axis_and_sign().0] = Term::Square(b * b);
                Curve { terms, constant: -a * a * b * b, scale: 1 }
            }
        }
    }

    /// G at a point.
    pub(crate) fn value(&self, point: [i64; 2]) -> i64 {
        let part = |axis: usize| match self.terms[axis] {
            Term::Square(w) => w * point[axis] * point[axis],
            Term::Linear(w) => w * point[axis].abs(),
        };
        part(0) + part(1) + self.constant
    }

    /// |∂G/∂c| at a coordinate of this axis.
    pub(crate) fn slope(&self, axis: usize, coordinate: i64) -> i64 {
        match self.terms[axis] {
            Term::Square(w) => 2 * w.abs() * coordinate.abs(),
            Term::Linear(w) => w.abs(),
        }
    }

    /// The weight of a pulse of this axis: half the slope of `scale`·G.
    pub(crate) fn weight(&self, axis: usize, coordinate: i64) -> i64 {
        self.scale * self.slope(axis, coordinate) / 2
    }

    /// How much the weight changes with one pulse of this axis.
    pub(crate) fn weight_gain(&self, axis: usize) -> i64 {
        match self.terms[axis] {
            Term::Square(w) => self.scale * w.abs(),
            Term::Linear(_) => 0,
        }
    }

    /// True when a pulse of this axis raises G on the piece.
    pub(crate) fn raises(&self, axis: usize, piece: &Piece) -> bool {
        let (Term::Square(w) | Term::Linear(w)) = self.terms[axis];
        (w > 0) == piece.grows(axis)
    }
}

/// A part of a curve along which neither coordinate changes its sign or its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    /// Where it starts.
    pub(crate) from: [i64; 2],
    /// Where it ends.
    pub(crate) to: [i64; 2],
    /// The signs of x and y.
    pub(crate) side: [i64; 2],
    /// The direction of an X and of a Y pulse.
    pub(crate) travel: [i64; 2],
}

impl Piece {
    /// The piece of a circle or an ellipse in one quadrant.
    pub(crate) fn of(sector: &Sector) -> Self {
        Piece { from: sector.from, to: sector.to, side: sector.kind.side(), travel: sector.kind.travel() }
    }

    /// The pulses of each axis.
    pub(crate) fn distance(&self) -> [i64; 2] {
        [(self.to[0] - self.from[0]).abs(), (self.to[1] - self.from[1]).abs()]
    }

    /// True when the pulses of this axis point away from the centre.
    pub(crate) fn grows(&self, axis: usize) -> bool {
        self.travel[axis] == self.side[axis]
    }
}

/// Splits a conic where it meets an axis: an ellipse at its semi-axes, a parabola and a hyperbola at
/// the vertex. `clockwise` gives the direction round an ellipse; start = end is a full ellipse.
///
/// # Panics
/// When an end point lies so far from the curve that its piece cannot reach it.
pub(crate) fn pieces(shape: Shape, from: [i64; 2], to: [i64; 2], clockwise: bool) -> Vec<Piece> {
    let (vertex, opens) = match shape {
        Shape::Ellipse(semi_axes) => {
            return sectors(from, to, clockwise, semi_axes).iter().map(Piece::of).collect();
        }
        Shape::Parabola(_, opens) => (0, opens),
        Shape::Hyperbola([a, _], opens) => (a, opens),
    };
    let (along, sign) = opens.axis_and_sign();
    let across = 1 - along;
    if from[across] * to[across] < 0 {
        let mut middle = [0, 0];
        middle[along] = sign * vertex;
        vec![open_piece(from, middle, along, sign), open_piece(middle, to, along, sign)]
    } else {
        vec![open_piece(from, to, along, sign)]
    }
}

/// A piece of a parabola or a hyperbola: both coordinates grow, or both shrink.
fn open_piece(from: [i64; 2], to: [i64; 2], along: usize, sign: i64) -> Piece {
    let across = 1 - along;
    let mut side = [0, 0];
    side[along] = sign;
    side[across] = if from[across] + to[across] < 0 { -1 } else { 1 };
    let reach = |[x, y]: [i64; 2]| side[0] * x + side[1] * y;
    let outward = if reach(to) >= reach(from) { 1 } else { -1 };
    let travel = side.map(|side| side * outward);
    for axis in 0..2 {
        assert!(
            from[axis] * side[axis] >= 0 && to[axis] * side[axis] >= 0 && (to[axis] - from[axis]) * travel[axis] >= 0,
            "{to:?} cannot be reached from {from:?}"
        );
    }
    Piece { from, to, side, travel }
}
