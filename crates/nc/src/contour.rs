//! The tool path that an NC program describes, in real numbers: segments of a contour, before they are rounded to
//! pulses.

use crate::{AXES_MAX, Direction};

/// A point in x, y and z, in BLU; not yet rounded.
pub type Point = [f64; 3];

/// A place of a machine in whole BLU: x, y, z, a, b, c, u, v, w.
pub type Position = [i64; AXES_MAX];

/// A place of a machine in BLU, before it is rounded, in the order of a [`Position`].
pub type Coordinates = [f64; AXES_MAX];

/// How many axes there are other than x, y and z.
pub const OTHERS: usize = AXES_MAX - 3;

/// Where the axes other than x, y and z are at both ends of a move, in BLU: a, b, c, u, v, w. They go evenly with its path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Others {
    /// At the start.
    pub from: [f64; OTHERS],
    /// At the end.
    pub to: [f64; OTHERS],
}

impl Others {
    /// At rest.
    #[must_use]
    pub fn at(place: [f64; OTHERS]) -> Others {
        Others { from: place, to: place }
    }

    /// None of them moves.
    #[must_use]
    pub fn rest(&self) -> bool {
        self.from == self.to
    }

    /// The greatest travel of one of them, in BLU.
    #[must_use]
    pub fn farthest(&self) -> f64 {
        self.from.iter().zip(self.to).map(|(from, to)| (to - from).abs()).fold(0.0, f64::max)
    }

    /// Where they are at this part of the path, from 0 to 1.
    #[must_use]
    pub fn after(&self, part: f64) -> [f64; OTHERS] {
        let mut at = self.to;
        if part < 1.0 {
            at.iter_mut().zip(self.from).for_each(|(at, from)| *at = from + (*at - from) * part);
        }
        at
    }
}

/// The axes along which the feed of a move is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FeedAxes {
    /// x, y and z, where one of them moves: others go as fast as they must to arrive together.
    Linear,
    /// u, v and w, where one of them moves and x, y and z do not.
    Parallel,
    /// a, b and c, where no other axis moves: a feed is in degrees per minute.
    Rotary,
}

impl FeedAxes {
    /// Those of a move; of one without travel x, y and z.
    pub(crate) fn of(segment: &Segment, others: &Others) -> FeedAxes {
        let moves = |axes: std::ops::Range<usize>| axes.into_iter().any(|axis| others.from[axis] != others.to[axis]);
        let linear = segment.from != segment.to || segment.shape != SegmentShape::Line;
        match (linear, moves(3..6), moves(0..3)) {
            (false, true, _) => FeedAxes::Parallel,
            (false, false, true) => FeedAxes::Rotary,
            _ => FeedAxes::Linear,
        }
    }

    /// Their indices among the axes of a machine.
    #[must_use]
    pub fn axes(self) -> std::ops::Range<usize> {
        match self {
            FeedAxes::Linear => 0..3,
            FeedAxes::Rotary => 3..6,
            FeedAxes::Parallel => 6..9,
        }
    }
}

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
    /// A free curve in x and y.
    Bezier(Controls),
}

/// The control points of a Bézier curve between its ends, in x and y, in BLU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Controls {
    /// That of a quadratic one.
    One([f64; 2]),
    /// Those of a cubic one.
    Two([[f64; 2]; 2]),
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
    /// The axes other than x, y and z.
    pub others: Others,
    /// It is a chord of a free curve, whose block has as many moves as chords.
    pub chord: bool,
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
    /// The axes other than x, y and z.
    pub others: Others,
    /// It is a chord of a free curve.
    pub chord: bool,
}

/// A place of the tool and of the other axes.
pub(crate) fn coordinates([x, y, z]: Point, [a, b, c, u, v, w]: [f64; OTHERS]) -> Coordinates {
    [x, y, z, a, b, c, u, v, w]
}

impl ToolMove {
    /// Where all axes are at its start and at its end.
    #[must_use]
    pub fn ends(&self) -> [Coordinates; 2] {
        let Others { from, to } = self.others;
        [coordinates(self.segment.from, from), coordinates(self.segment.to, to)]
    }

    /// The axes that its feed is along.
    #[must_use]
    pub fn feed_axes(&self) -> FeedAxes {
        FeedAxes::of(&self.segment, &self.others)
    }

    /// Whether an axis is at the same whole BLU at both ends.
    pub(crate) fn rests(&self, axis: usize) -> bool {
        let [from, to] = self.ends().map(|end| end[axis].round());
        from == to
    }

    /// The indices of the axes along which the length of its path is counted: those of the feed, but of a line that rounding to
    /// whole BLU has left no travel along them all axes.
    #[must_use]
    pub fn path_axes(&self) -> std::ops::Range<usize> {
        let axes = self.feed_axes().axes();
        let rounded_off = self.segment.shape == SegmentShape::Line && axes.clone().all(|axis| self.rests(axis));
        if rounded_off { 0..AXES_MAX } else { axes }
    }
}
