//! What can be wrong with a compensated contour.

use std::fmt;

use super::WAITING_LIMIT;
use crate::{COORDINATE_LIMIT, Place};

/// Why a block cannot be compensated; the message is one sentence that names the blocks, the radius, the limit and the
/// remedy.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{}{}: {kind}", Named(.place), Second(.second))]
pub struct CompensationError {
    /// The block.
    pub place: Place,
    /// The other block of the corner, where there is one.
    pub second: Option<Place>,
    /// What is wrong.
    pub kind: CompensationErrorKind,
}

/// What is wrong with a compensated contour.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CompensationErrorKind {
    /// A coordinate of a point or of a centre is not finite, or too large in magnitude.
    #[error("a coordinate of {value} BLU is beyond the limit of ±{COORDINATE_LIMIT} BLU: choose a larger BLU")]
    Coordinate {
        /// The coordinate, in BLU.
        value: f64,
    },
    /// The radius of the tool is negative, not finite or too large.
    #[error(
        "a tool radius of {radius} BLU is outside 0 to {COORDINATE_LIMIT} BLU: \
         correct the offset, and for the other side of the contour exchange G41 and G42"
    )]
    Radius {
        /// The radius of the tool, in BLU.
        radius: f64,
    },
    /// An end of an arc is its centre.
    #[error("an end of the arc is its centre, and a tool has no side there: correct the centre")]
    ArcOfNoRadius,
    /// Compensation starts on an arc.
    #[error(
        "compensation starts on an arc, but may only on a straight move: put G41 or G42 into a block with G00 or G01"
    )]
    StartOnArc,
    /// Compensation ends on an arc.
    #[error("compensation ends on an arc, but may only on a straight move: put G40 into a block with G00 or G01")]
    CancelOnArc,
    /// The block on which compensation starts is shorter than the radius of the tool.
    #[error(
        "compensation starts on a move of {length:.3} BLU in the plane, but at least the tool radius of \
         {radius:.3} BLU is needed: start farther off"
    )]
    StartTooShort {
        /// Its length in the plane, in BLU.
        length: f64,
        /// The radius of the tool, in BLU.
        radius: f64,
    },
    /// The block on which compensation ends is shorter than the radius of the tool.
    #[error(
        "compensation ends on a move of {length:.3} BLU in the plane, but at least the tool radius of \
         {radius:.3} BLU is needed: end farther off"
    )]
    CancelTooShort {
        /// Its length in the plane, in BLU.
        length: f64,
        /// The radius of the tool, in BLU.
        radius: f64,
    },
    /// The tool passes on the inside of an arc that is not larger than the tool.
    #[error(
        "tool radius of {radius:.3} BLU too large: the tool is inside an arc of radius {arc:.3} BLU, \
         which must be larger than the tool: take a smaller tool or a larger arc"
    )]
    InsideArc {
        /// The radius of the arc, in BLU.
        arc: f64,
        /// The radius of the tool, in BLU.
        radius: f64,
    },
    /// At an inside corner the offset paths of the two blocks do not meet.
    #[error(
        "tool radius of {radius:.3} BLU too large: the paths of the tool's centre beside the two blocks do not meet: \
         take a smaller tool or open the corner"
    )]
    NoMeeting {
        /// The radius of the tool, in BLU.
        radius: f64,
    },
    /// The compensated block would run against its direction.
    #[error(
        "tool radius of {radius:.3} BLU too large: the block is {length:.3} BLU long and its corners take {taken:.3} BLU \
         from the tool's path, so that it would run backwards: take a smaller tool or leave the block out"
    )]
    Reversed {
        /// The radius of the tool, in BLU.
        radius: f64,
        /// The length of the block's offset path without corners, in BLU.
        length: f64,
        /// What the corners take from it, in BLU.
        taken: f64,
    },
    /// Prolonged at its corners, a compensated arc would be longer than a full circle.
    #[error(
        "with its corners the tool's path about the centre is {turns:.3} turns long, but an arc has 1 at most: \
         program the arc in two halves"
    )]
    MoreThanATurn {
        /// The length, in turns.
        turns: f64,
    },
    /// Another plane is chosen while compensation is on.
    #[error("the plane changes while compensation is on: put G40 before it")]
    PlaneChange,
    /// A compensated arc is in another plane than the one chosen.
    #[error("the arc is not in the plane of compensation: choose its plane with G17, G18 or G19 before G41 or G42")]
    ArcInOtherPlane,
    /// The side changes at an arc.
    #[error("the side changes from or to an arc, but may only between straight moves: put G40 between them")]
    SideChangeOnArc,
    /// Too many blocks without motion in the plane between two compensated blocks.
    #[error(
        "more than {WAITING_LIMIT} moves without motion in the plane stand between two blocks of the contour: \
         put them together, or end compensation before them"
    )]
    TooManyWithoutMotion,
    /// A block does not begin where the one before it ends.
    #[error("the block begins {gap:.3} BLU from where the one before it ends: put G40 between them")]
    Apart {
        /// The distance in the plane, in BLU.
        gap: f64,
    },
}

/// A block by its line and its N word.
struct Named<'a>(&'a Place);

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}", self.0.line)?;
        self.0.number.map_or(Ok(()), |number| write!(f, " (N{number})"))
    }
}

/// The other block, where there is one.
struct Second<'a>(&'a Option<Place>);

impl fmt::Display for Second<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().map_or(Ok(()), |place| write!(f, " with {}", Named(place)))
    }
}
