//! What can be wrong with a geometry.

use std::fmt;

use crate::{
    AXES_MAX, AXES_MIN, CONIC_LIMIT, COORDINATE_LIMIT, Drawn, KnotFault, NURBS_DEGREE, NURBS_MOST, NURBS_POINTS,
    NURBS_UNIT, SPLINE_POINTS, Shape, SplineForm,
};

/// The limit of a chain of segments, in words.
fn most(form: SplineForm) -> String {
    match form {
        SplineForm::Bezier | SplineForm::Hermite => String::new(),
        SplineForm::CatmullRom | SplineForm::BSpline => format!(", {SPLINE_POINTS} at most"),
    }
}

/// Why a geometry cannot be built; every message names the value, the limit and the remedy.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// A line has no axis or more than nine.
    #[error("a line has {AXES_MIN} to {AXES_MAX} axes, not {axes}: give x at least, and at most x,y,z,a,b,c,u,v,w")]
    AxisCount {
        /// The number of axes given.
        axes: usize,
    },
    /// The start point and the end point have different numbers of coordinates.
    #[error(
        "the start point has {from} coordinate{} and the end point has {to}: \
         give the same axes in both",
        if *from == 1 { "" } else { "s" }
    )]
    AxisMismatch {
        /// The number of coordinates of the start point.
        from: usize,
        /// The number of coordinates of the end point.
        to: usize,
    },
    /// A coordinate is larger in magnitude than [`COORDINATE_LIMIT`].
    #[error("{axis} = {value} BLU is beyond the limit of ±{COORDINATE_LIMIT} BLU: choose a larger BLU")]
    CoordinateBeyondLimit {
        /// The letter of the axis: x, y, z, a, b or c.
        axis: char,
        /// The coordinate given, in BLU.
        value: i64,
    },
    /// A line ends where it starts.
    #[error(
        "the line ends where it starts and has length 0, but at least 1 BLU is needed: \
         drop the block"
    )]
    ZeroLength,
    /// A free curve has too few points, or too many.
    #[error(
        "{} has {}{}, but {given} were given: give as many", Drawn::Spline(*.form).noun(), .form.takes(), most(*.form)
    )]
    SplinePoints {
        /// What the points mean.
        form: SplineForm,
        /// How many points were given.
        given: usize,
    },
    /// All points of a free curve are one.
    #[error(
        "the curve is the single point ({}, {}) and has length 0, but at least 1 BLU is needed: drop the block",
        .point[0], .point[1]
    )]
    SplineIsPoint {
        /// The first point given, in BLU.
        point: [i64; 2],
    },
    /// A NURBS has too few control points, or too many.
    #[error("a NURBS has 2 to {NURBS_POINTS} points, but {given} were given: give as many")]
    NurbsPoints {
        /// How many points were given.
        given: usize,
    },
    /// The degree of a NURBS is 0, or too high for its points.
    #[error(
        "the degree {degree} does not fit {points} points: give a degree from 1 to {}", NURBS_DEGREE.min(*.points - 1)
    )]
    NurbsDegree {
        /// The degree given.
        degree: usize,
        /// How many points were given.
        points: usize,
    },
    /// A weight of a NURBS is 0, negative or too large.
    #[error(
        "point {} has the weight {}, which must be more than 0 and at most {NURBS_MOST}: correct the weight",
        .index + 1, *.weight as f64 / NURBS_UNIT as f64
    )]
    NurbsWeight {
        /// Which point, from 0.
        index: usize,
        /// The weight in [`NURBS_UNIT`]s.
        weight: i64,
    },
    /// The knots of a NURBS are no knot vector.
    #[error("{fault}")]
    Knots {
        /// What is wrong.
        fault: KnotFault,
    },
    /// The start point of an arc is its centre.
    #[error(
        "the arc starts at its centre ({}, {}) and has radius 0, but at least 1 BLU is needed: \
         move the centre or the start point",
        .center[0], .center[1]
    )]
    ZeroRadius {
        /// The centre given, in BLU.
        center: [i64; 2],
    },
    /// The end point of an arc is its centre.
    #[error(
        "the arc ends at its centre ({}, {}), but the end point must lie within 1 BLU of the circle \
         and off the centre: move the centre or the end point",
        .center[0], .center[1]
    )]
    EndAtCenter {
        /// The centre given, in BLU.
        center: [i64; 2],
    },
    /// The end point of an arc lies more than one BLU off the circle through the start point.
    #[error(
        "the radius is {start_radius:.3} BLU at the start point but {end_radius:.3} BLU at the \
         end point, and they may differ by at most 1 BLU{}: correct the centre or the end point{}",
        beyond(*.tolerance), accepted(*.start_radius, *.end_radius)
    )]
    EndOffCircle {
        /// Distance of the start point from the centre, in BLU.
        start_radius: f64,
        /// Distance of the end point from the centre, in BLU.
        end_radius: f64,
        /// What they may differ by beyond the one BLU, in BLU.
        tolerance: f64,
    },
    /// A semi-axis or a parameter of a conic is zero or negative.
    #[error(
        "{name} = {value} BLU, but at least 1 BLU is needed: give a positive length, \
         and for another orientation say where the curve opens to"
    )]
    NotPositive {
        /// The semi-axis or parameter: a, b or c.
        name: char,
        /// The length given, in BLU.
        value: i64,
    },
    /// A semi-axis or a parameter of a conic is too large.
    #[error("{name} = {value} BLU is beyond the limit of {limit} BLU for a conic: choose a larger BLU")]
    ConicBeyondLimit {
        /// The semi-axis or parameter: a, b or c.
        name: char,
        /// The length given, in BLU.
        value: i64,
        /// The limit, in BLU.
        limit: i64,
    },
    /// An end of a conic is too far from its centre or vertex.
    #[error(
        "the {end} point ({}, {}) has {axis} = {value} BLU relative to the {}, beyond the limit of \
         ±{CONIC_LIMIT} BLU for a conic: choose a larger BLU",
        .point[0], .point[1], .shape.middle()
    )]
    TooFarFromCenter {
        /// Which end it is.
        end: End,
        /// The end in machine coordinates, in BLU.
        point: [i64; 2],
        /// The letter of the axis: x or y.
        axis: char,
        /// The coordinate relative to the centre or vertex, in BLU.
        value: i64,
        /// The curve.
        shape: Shape,
    },
    /// An end of a conic lies more than one BLU off it.
    #[error(
        "the {end} point ({}, {}) lies {distance:.3} BLU off the {shape}, and at most 1 BLU is allowed: \
         correct the point, the {} or the size of the curve",
        .point[0], .point[1], .shape.middle()
    )]
    OffCurve {
        /// Which end it is.
        end: End,
        /// The end in machine coordinates, in BLU.
        point: [i64; 2],
        /// Its distance from the curve, in BLU.
        distance: f64,
        /// The curve.
        shape: Shape,
    },
    /// An end of a conic is the centre of the ellipse, beyond the vertex of the parabola, or not on the hyperbola's
    /// branch.
    #[error(
        "the {end} point ({}, {}) lies {distance:.3} BLU off the {shape} and {}: correct the point or the {}",
        .point[0], .point[1], .shape.off_branch(), .shape.middle()
    )]
    OffBranch {
        /// Which end it is.
        end: End,
        /// The end in machine coordinates, in BLU.
        point: [i64; 2],
        /// Its distance from the curve, in BLU.
        distance: f64,
        /// The curve.
        shape: Shape,
    },
    /// A parabola or hyperbola ends where it starts.
    #[error("the {shape} ends where it starts and has length 0, but at least 1 BLU is needed: drop the block")]
    ZeroLengthConic {
        /// The curve.
        shape: Shape,
    },
    /// Both ends of a conic lie off it, on different sides of one place, so that the motion along it leads from neither
    /// to the other.
    #[error(
        "the way from ({}, {}) to ({}, {}) leads across the {shape} and not along it, as both ends lie off the curve \
         (up to 1 BLU is allowed): move one of them onto the curve",
        .from[0], .from[1], .to[0], .to[1]
    )]
    EndsAcrossCurve {
        /// The start point in machine coordinates, in BLU.
        from: [i64; 2],
        /// The end point in machine coordinates, in BLU.
        to: [i64; 2],
        /// The curve.
        shape: Shape,
    },
}

/// One of the two ends of a curve; displays as `start` or `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum End {
    /// Where the motion begins.
    Start,
    /// Where it ends.
    End,
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            End::Start => "start",
            End::End => "end",
        })
    }
}

fn beyond(tolerance: f64) -> String {
    if tolerance > 0.0 { format!(" and the --tolerance of {tolerance} BLU beyond") } else { String::new() }
}

/// The tolerance that would accept an arc with these radii, where one may.
fn accepted(start: f64, end: f64) -> String {
    let apart = (end - start).abs();
    if apart > start / 2.0 {
        return String::new();
    }
    format!(", or accept it with --tolerance {}", ((apart - 1.0) * 1000.0).ceil() / 1000.0)
}

#[cfg(test)]
mod tests {
    use crate::{Arc, Direction, GeometryError, Line};

    fn message<T>(result: Result<T, GeometryError>) -> String {
        result.err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn every_message_names_the_value_the_limit_and_the_remedy() {
        let arc = |from, to, center| Arc::new(from, to, center, Direction::Clockwise);
        assert_eq!(
            message(Line::new(vec![0; 10], vec![1; 10])),
            "a line has 1 to 9 axes, not 10: give x at least, and at most x,y,z,a,b,c,u,v,w"
        );
        assert_eq!(
            message(Line::new(vec![0, 0], vec![1, 1, 1])),
            "the start point has 2 coordinates and the end point has 3: give the same axes in both"
        );
        assert_eq!(
            message(Line::new(vec![0, 0, 0], vec![1, 1, i64::MIN])),
            "z = -9223372036854775808 BLU is beyond the limit of \
             ±4503599627370496 BLU: choose a larger BLU"
        );
        assert_eq!(
            message(Line::new(vec![4, 4], vec![4, 4])),
            "the line ends where it starts and has length 0, but at least 1 BLU is needed: \
             drop the block"
        );
        assert_eq!(
            message(arc([2, -3], [5, 5], [2, -3])),
            "the arc starts at its centre (2, -3) and has radius 0, but at least 1 BLU is needed: \
             move the centre or the start point"
        );
        assert_eq!(
            message(arc([3, -3], [2, -3], [2, -3])),
            "the arc ends at its centre (2, -3), but the end point must lie within 1 BLU of the circle and \
             off the centre: move the centre or the end point"
        );
        assert_eq!(
            message(arc([5, 0], [0, 7], [0, 0])),
            "the radius is 5.000 BLU at the start point but 7.000 BLU at the end point, and they may differ by \
             at most 1 BLU: correct the centre or the end point, or accept it with --tolerance 1"
        );
    }
}
