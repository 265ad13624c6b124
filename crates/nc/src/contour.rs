//! The tool path that an NC program describes, in real numbers: segments of a contour, before they are rounded to
//! pulses.

use crate::Direction;

/// A point in x, y and z, in BLU; not yet rounded.
pub type Point = [f64; 3];

/// The plane of an arc and of tool radius compensation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Plane {
    /// G17: x and y, seen from +z.
    #[default]
    Xy,
    /// G18: z and x, seen from +y.
    Zx,
    /// G19: y and z, seen from +x.
    Yz,
}

impl Plane {
    /// The two axes of the plane, so that a turn from the first to the second is counter-clockwise, and the third axis.
    #[must_use]
    pub fn axes(self) -> [usize; 3] {
        match self {
            Plane::Xy => [0, 1, 2],
            Plane::Zx => [2, 0, 1],
            Plane::Yz => [1, 2, 0],
        }
    }

    /// The coordinates of a point along the [`axes`](Self::axes).
    #[must_use]
    pub fn of(self, point: Point) -> [f64; 3] {
        self.axes().map(|axis| point[axis])
    }

    /// The point that has these coordinates along the [`axes`](Self::axes).
    #[must_use]
    pub fn point(self, along: [f64; 3]) -> Point {
        let mut point = [0.0; 3];
        for (axis, value) in self.axes().into_iter().zip(along) {
            point[axis] = value;
        }
        point
    }
}

/// The shape of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SegmentShape {
    /// Straight.
    Line,
    /// A circular arc in a plane, with an even travel along the third axis (a helix where that is not 0). An arc that
    /// ends where it starts, seen in the plane, is a full circle.
    Arc {
        /// The plane.
        plane: Plane,
        /// The centre along the first two axes of the plane, in BLU.
        center: [f64; 2],
        /// The turn, seen from the positive third axis.
        direction: Direction,
    },
}

/// A piece of a contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// The start, in BLU.
    pub from: Point,
    /// The end, in BLU.
    pub to: Point,
    /// The shape between them.
    pub shape: SegmentShape,
}

/// The place of a block in its program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Place {
    /// The line of the file, from 1.
    pub line: u64,
    /// The N word.
    pub number: Option<u64>,
}

/// How fast a block is to be run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Feed {
    /// G00: as fast as the machine runs.
    Rapid,
    /// G94: of the tool's centre along its path, in mm/min.
    PerMinute(f64),
    /// G93: the block takes one such part of a minute, in 1/min.
    Inverse(f64),
}

/// The side on which the tool passes the contour, seen along it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Side {
    /// G40: the tool's centre is on the contour.
    #[default]
    On,
    /// G41: left of it, by the radius in BLU.
    Left(f64),
    /// G42: right of it, by the radius in BLU.
    Right(f64),
}

/// How the end of a block is passed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum PathControl {
    /// G61: exact stop.
    Exact,
    /// G64: continuous.
    #[default]
    Continuous,
    /// G64 P: continuous, where the path could be left by this many BLU.
    Within(f64),
}

/// A block of a program that moves the tool, as programmed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// Its line and number.
    pub place: Place,
    /// The segment of the programmed contour.
    pub segment: Segment,
    /// How fast.
    pub feed: Feed,
    /// The plane that is chosen (G17 to G19); compensation is in its two axes.
    pub plane: Plane,
    /// The side at the end of the block.
    pub side: Side,
    /// How its end is passed.
    pub path: PathControl,
}

/// Why the tool moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Cause {
    /// The block is programmed.
    Programmed,
    /// The block leads onto the compensated contour.
    StartUp,
    /// The block leads off the compensated contour.
    Cancel,
    /// Compensation put it between two blocks, at an outside corner.
    Inserted,
}

/// A move of the tool's centre, after tool radius compensation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolMove {
    /// The block that it belongs to; of an inserted one the block before it.
    pub place: Place,
    /// The segment of the tool's centre.
    pub segment: Segment,
    /// How fast.
    pub feed: Feed,
    /// Why.
    pub cause: Cause,
    /// The segment as programmed; of an inserted move the corner, a line of no length.
    pub programmed: Segment,
    /// The side and radius that the move keeps to.
    pub side: Side,
    /// How its end is passed.
    pub path: PathControl,
}
