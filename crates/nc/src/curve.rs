//! The ideal curve of a block, of any kind, and what gives one.

use crate::{Arc, Conic, Direction, GeometryError, Helix, Line, Nurbs, Opens, Shape, Spline, SplineForm};

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
    /// A straight line in one to nine axes.
    Line(Line),
    /// A circular arc in x and y.
    Arc(Arc),
    /// An ellipse, a parabola or a hyperbola in x and y.
    Conic(Conic),
    /// An arc in x and y with a travel in z.
    Helix(Helix),
    /// A free curve in x and y.
    Spline(Spline),
    /// A rational B-spline in x and y.
    Nurbs(Nurbs),
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
            Curve::Spline(spline) => &spline.both_ends()[0],
            Curve::Nurbs(nurbs) => &nurbs.both_ends()[0],
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
            Curve::Spline(spline) => &spline.both_ends()[1],
            Curve::Nurbs(nurbs) => &nurbs.both_ends()[1],
        }
    }

    /// The number of axes: 1 to 6 for a line, 2 for an arc or a conic, 3 for a helix.
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
            Curve::Spline(spline) => spline.length(),
            Curve::Nurbs(nurbs) => nurbs.length(),
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
            Curve::Spline(spline) => spline.deviation(position),
            Curve::Nurbs(nurbs) => nurbs.deviation(position),
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
            Curve::Spline(spline) => spline.signed_deviation(position),
            Curve::Nurbs(nurbs) => nurbs.signed_deviation(position),
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
            Curve::Spline(spline) => spline.outline(max_points),
            Curve::Nurbs(nurbs) => nurbs.outline(max_points),
        }
    }

    /// The circular arc that it is, or that a helix makes in x and y.
    #[must_use]
    pub fn arc(&self) -> Option<&Arc> {
        match self {
            Curve::Arc(arc) => Some(arc),
            Curve::Helix(helix) => Some(helix.arc()),
            _ => None,
        }
    }

    /// Where the [deviation with its side](Curve::signed_deviation) is positive, in words.
    #[must_use]
    pub fn positive_side(&self) -> &'static str {
        match self {
            Curve::Line(line) if line.axes() == 2 => "positive left of the line",
            Curve::Line(_) => "in all axes, without sign",
            Curve::Arc(_) => "positive outside the circle",
            Curve::Conic(_) => "positive where the implicit function is",
            Curve::Helix(_) => "positive outside the cylinder",
            Curve::Spline(_) | Curve::Nurbs(_) => "positive left of the curve",
        }
    }

    /// What gives this curve.
    #[must_use]
    pub fn description(&self) -> Description {
        let (drawn, sizes, center, direction) = match self {
            Curve::Line(_) => (Drawn::Line, Vec::new(), [0, 0], None),
            Curve::Arc(arc) => (Drawn::Arc, Vec::new(), arc.center(), Some(arc.direction())),
            Curve::Helix(helix) => (Drawn::Helix, Vec::new(), helix.arc().center(), Some(helix.arc().direction())),
            Curve::Conic(conic) => {
                let (drawn, sizes) = match conic.shape() {
                    Shape::Ellipse { semi_axes } => (Drawn::Ellipse, semi_axes.to_vec()),
                    Shape::Parabola { c, .. } => (Drawn::Parabola(conic.opens()), vec![c]),
                    Shape::Hyperbola { semi_axes, .. } => (Drawn::Hyperbola(conic.opens()), semi_axes.to_vec()),
                };
                (drawn, sizes, conic.center(), conic.direction())
            }
            Curve::Spline(spline) => (Drawn::Spline(spline.form()), spline.points().concat(), [0, 0], None),
            Curve::Nurbs(nurbs) => (Drawn::Nurbs, nurbs.numbers(), [0, 0], None),
        };
        let direction = direction.unwrap_or(Direction::CounterClockwise);
        let (from, to) = (self.from().to_vec(), self.to().to_vec());
        Description { drawn, sizes, from, to, center, direction, radii: 0.0 }
    }
}

/// A curve of its own type within a [`Curve`].
pub trait CurveType: Sized {
    /// The curve, if it is of this type.
    fn of(curve: &Curve) -> Option<&Self>;
}

macro_rules! curve_types {
    ($($kind:ident),*) => {
        $(
            impl From<$kind> for Curve {
                fn from(curve: $kind) -> Curve {
                    Curve::$kind(curve)
                }
            }

            impl CurveType for $kind {
                fn of(curve: &Curve) -> Option<&$kind> {
                    if let Curve::$kind(own) = curve { Some(own) } else { None }
                }
            }
        )*
    };
}

curve_types!(Line, Arc, Conic, Helix, Spline, Nurbs);

/// What is drawn through given points.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Drawn {
    /// Lines.
    Line,
    /// Arcs, or full circles.
    Arc,
    /// Arcs with a travel in z.
    Helix,
    /// Ellipses of two semi-axes.
    Ellipse,
    /// Parabolas of one parameter.
    Parabola(Option<Opens>),
    /// Branches of hyperbolas of two semi-axes.
    Hyperbola(Option<Opens>),
    /// Free curves of as many points as they have.
    Spline(SplineForm),
    /// Rational B-splines of as many points as they have.
    Nurbs,
}

/// What is said of one kind of curve.
struct Traits {
    /// With its article.
    noun: &'static str,
    /// The option that gives its size.
    option: &'static str,
    /// Least number of axes, and that of all but lines.
    axes: usize,
    /// Numbers that give its size.
    sizes: usize,
    /// It has a direction.
    turns: bool,
}

impl Drawn {
    fn traits(self) -> Traits {
        let (noun, option, axes, sizes, turns) = match self {
            Drawn::Line => ("a line", "", 2, 0, false),
            Drawn::Arc => ("an arc", "", 2, 0, true),
            Drawn::Helix => ("a helix", "", 3, 0, true),
            Drawn::Ellipse => ("an ellipse", "--ellipse", 2, 2, true),
            Drawn::Parabola(_) => ("a parabola", "--parabola", 2, 1, false),
            Drawn::Hyperbola(_) => ("a hyperbola", "--hyperbola", 2, 2, false),
            Drawn::Spline(SplineForm::Bezier) => ("a Bezier curve", "--bezier", 2, 0, false),
            Drawn::Spline(SplineForm::Hermite) => ("a Hermite segment", "--hermite", 2, 0, false),
            Drawn::Spline(SplineForm::CatmullRom) => ("a Catmull-Rom spline", "--points", 2, 0, false),
            Drawn::Spline(SplineForm::BSpline) => ("a uniform B-spline", "--points", 2, 0, false),
            Drawn::Nurbs => ("a NURBS", "--nurbs", 2, 0, false),
        };
        Traits { noun, option, axes, sizes, turns }
    }

    /// What one is called: `an arc`.
    #[must_use]
    pub fn noun(self) -> &'static str {
        self.traits().noun
    }

    /// The option that gives its sizes: `--ellipse`; empty where it has none.
    #[must_use]
    pub fn option(self) -> &'static str {
        self.traits().option
    }

    /// The noun alone: `ellipse`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.noun().split_once(' ').map_or("", |(_, name)| name)
    }

    /// Axes of its points; the least of a line.
    #[must_use]
    pub fn axes(self) -> usize {
        self.traits().axes
    }

    /// How many numbers besides its ends give it: c of a parabola, the semi-axes of another conic. A free curve has its
    /// points instead, as many as there are.
    #[must_use]
    pub fn sizes(self) -> usize {
        self.traits().sizes
    }

    /// A free curve, which its points give.
    #[must_use]
    pub fn is_spline(self) -> bool {
        matches!(self, Drawn::Spline(_) | Drawn::Nurbs)
    }

    /// It is about a centre or vertex.
    #[must_use]
    pub fn is_centered(self) -> bool {
        !matches!(self, Drawn::Line | Drawn::Spline(_) | Drawn::Nurbs)
    }

    /// It runs clockwise or counter-clockwise; others lead from their start to their end.
    #[must_use]
    pub fn turns(self) -> bool {
        self.traits().turns
    }

    /// Its ends have two radii about its centre.
    #[must_use]
    pub fn is_round(self) -> bool {
        matches!(self, Drawn::Arc | Drawn::Helix)
    }

    /// It opens to one side.
    #[must_use]
    pub fn is_open(self) -> bool {
        self.opening(Some(Opens::PlusX)).opens().is_some()
    }

    /// Where it opens to, if that is given.
    #[must_use]
    pub fn opens(self) -> Option<Opens> {
        match self {
            Drawn::Parabola(opens) | Drawn::Hyperbola(opens) => opens,
            _ => None,
        }
    }

    /// One that opens there, if it opens at all.
    #[must_use]
    pub fn opening(self, opens: Option<Opens>) -> Drawn {
        match self {
            Drawn::Parabola(_) => Drawn::Parabola(opens),
            Drawn::Hyperbola(_) => Drawn::Hyperbola(opens),
            other => other,
        }
    }

    /// Where a curve of this first size begins, in BLU relative to its centre.
    #[must_use]
    pub fn vertex(self, size: i64) -> [i64; 2] {
        match (self, self.opens().unwrap_or(Opens::PlusX)) {
            (Drawn::Parabola(_), _) => [0, 0],
            (_, Opens::PlusX) => [size, 0],
            (_, Opens::MinusX) => [size.saturating_neg(), 0],
            (_, Opens::PlusY) => [0, size],
            (_, Opens::MinusY) => [0, size.saturating_neg()],
        }
    }
}

/// What gives one curve, whether it can be built or not; lengths are in BLU.
#[derive(Clone, PartialEq, Debug)]
pub struct Description {
    /// What is drawn.
    pub drawn: Drawn,
    /// Semi-axes or parameter of a conic; x and y of each point of a free curve, whose ends follow from them; of a NURBS
    /// degree and number of points, x, y and weight of each, and the knots.
    pub sizes: Vec<i64>,
    /// Start point.
    pub from: Vec<i64>,
    /// End point.
    pub to: Vec<i64>,
    /// Centre, or vertex of a parabola; it does not count for a line.
    pub center: [i64; 2],
    /// Direction, where it counts.
    pub direction: Direction,
    /// How far the two radii of an arc may differ beyond what rounding makes.
    pub radii: f64,
}

impl Description {
    /// The curve.
    ///
    /// ```
    /// use stepwave_nc::{Arc, Curve, Direction};
    ///
    /// let arc: Curve = Arc::new([5, 0], [0, 5], [0, 0], Direction::CounterClockwise)?.into();
    /// assert_eq!(arc.description().curve()?, arc);
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    ///
    /// # Errors
    /// No curve has these ends, sizes and centre.
    pub fn curve(&self) -> Result<Curve, GeometryError> {
        let plane = |point: &[i64]| [0, 1].map(|axis| point.get(axis).copied().unwrap_or(0));
        let space = |point: &[i64]| [0, 1, 2].map(|axis| point.get(axis).copied().unwrap_or(0));
        let (sizes, from, to) = (plane(&self.sizes), plane(&self.from), plane(&self.to));
        let (center, direction, radii) = (self.center, self.direction, self.radii);
        Ok(match self.drawn {
            Drawn::Line => Line::new(self.from.clone(), self.to.clone())?.into(),
            Drawn::Arc => Arc::within(from, to, center, direction, radii)?.into(),
            Drawn::Helix => Helix::within(space(&self.from), space(&self.to), center, direction, radii)?.into(),
            Drawn::Ellipse => Conic::ellipse(sizes, from, to, center, direction)?.into(),
            Drawn::Parabola(opens) => Conic::parabola(sizes[0], opens, from, to, center)?.into(),
            Drawn::Hyperbola(opens) => Conic::hyperbola(sizes, opens, from, to, center)?.into(),
            Drawn::Spline(form) => Spline::new(form, self.sizes.as_chunks().0)?.into(),
            Drawn::Nurbs => Nurbs::of_numbers(&self.sizes)?.into(),
        })
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

    #[test]
    fn every_kind_of_curve_is_built_again_from_its_description() -> Result<(), GeometryError> {
        let clockwise = Direction::Clockwise;
        let curves: [(Curve, &str); 7] = [
            (Line::new(vec![1, 2, 3, 4], vec![-1, 2, 8, 0])?.into(), "a line"),
            (Arc::new([8, 2], [3, 7], [3, 2], clockwise)?.into(), "an arc"),
            (Helix::new([5, 0, 1], [0, 5, -3], [0, 0], clockwise)?.into(), "a helix"),
            (Conic::ellipse([6, 4], [7, 0], [1, 4], [1, 0], clockwise)?.into(), "an ellipse"),
            (Conic::parabola(4, Some(Opens::MinusY), [0, 0], [4, -4], [0, 0])?.into(), "a parabola"),
            (Conic::hyperbola([4, 3], Some(Opens::MinusX), [-4, 0], [-5, 2], [0, 0])?.into(), "a hyperbola"),
            (
                Spline::new(SplineForm::BSpline, &[[0, 0], [9, 1], [4, -7], [2, 2], [0, 5]])?.into(),
                "a uniform B-spline",
            ),
        ];
        for (curve, noun) in curves {
            let description = curve.description();
            let sizes = if let Curve::Spline(_) = curve { 10 } else { description.drawn.sizes() };
            assert_eq!((description.drawn.noun(), description.sizes.len()), (noun, sizes));
            assert_eq!(description.curve()?, curve);
        }
        Ok(())
    }
}
