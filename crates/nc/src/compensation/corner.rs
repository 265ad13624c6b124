//! Classes of corners, and how the tool gets from one block to the next.

use super::geometry::{Tip, Vector, add, cross, dot, meeting, miter, scale, sub, unit};
use super::{CompensationErrorKind, Corner};

/// The sine of the angle below which two tangents are parallel: a corner of 1e-9 rad moves a tool of 1 000 000 BLU by a
/// thousandth of a BLU.
const PARALLEL: f64 = 1e-9;

/// What a corner is to the tool, by p = -(l1·l2) and q = s·(l2x·l1y - l1x·l2y).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    /// q < 0: an inside corner; both offset paths are cut short where they meet.
    Shortening,
    /// q > 0, p <= 0: an outside corner of a quarter turn at most; both offset paths are prolonged until they meet.
    Extension,
    /// q > 0, p > 0: an outside corner of more than a quarter turn; moves are inserted.
    Insertion,
    /// q = 0, p < 0: the blocks are tangent.
    StraightOn,
    /// q = 0, p > 0: the second block goes back.
    Reversal,
}

/// The class of a corner on a side: 1 left, -1 right.
pub(super) fn class(leaving: Vector, entering: Vector, side: f64) -> Class {
    let p = -dot(leaving, entering);
    let q = side * cross(entering, leaving);
    match () {
        () if q.abs() <= PARALLEL && p < 0.0 => Class::StraightOn,
        () if q.abs() <= PARALLEL => Class::Reversal,
        () if q < 0.0 => Class::Shortening,
        // A right angle is an extension, however its cosine is rounded.
        () if p <= PARALLEL => Class::Extension,
        () => Class::Insertion,
    }
}

/// How the tool's centre passes a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Joint {
    /// Where it leaves the path of the first block.
    pub(super) leave: Vector,
    /// What is inserted.
    pub(super) between: Between,
    /// Where it enters the path of the second block.
    pub(super) enter: Vector,
}

/// What is inserted at a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Between {
    /// Straight moves through two points to the second block; those of no length are left out.
    Lines([Vector; 2]),
    /// An arc about the corner: 1 counter-clockwise, -1 clockwise.
    Arc { turn: f64 },
}

impl Joint {
    fn at(point: Vector) -> Joint {
        Joint { leave: point, between: Between::Lines([point; 2]), enter: point }
    }

    /// A straight move from where one block ends to where the next begins.
    pub(super) fn straight(leave: Vector, enter: Vector) -> Joint {
        Joint { leave, between: Between::Lines([leave, enter]), enter }
    }
}

/// The corner between two blocks, the tool on a side (1 left, -1 right) at a radius.
pub(super) fn joint(
    leaving: &Tip,
    entering: &Tip,
    side: f64,
    radius: f64,
    corner: Corner,
) -> Result<Joint, CompensationErrorKind> {
    let none = CompensationErrorKind::NoMeeting { radius };
    match class(leaving.tangent, entering.tangent, side) {
        Class::StraightOn => {
            let normal = unit(add(leaving.normal(side), entering.normal(side)));
            Ok(Joint::at(add(leaving.point, scale(radius, normal))))
        }
        Class::Shortening => meeting(leaving, entering, side, radius).map(Joint::at).ok_or(none),
        Class::Extension => Ok(meeting(leaving, entering, side, radius)
            .map_or_else(|| insertion(leaving, entering, side, radius, corner), Joint::at)),
        Class::Insertion => Ok(insertion(leaving, entering, side, radius, corner)),
        // Going back, the second block bends away from the first towards the tool: the cusp has no room for it.
        Class::Reversal if side * (bend(leaving) + bend(entering)) < 0.0 => Err(none),
        Class::Reversal => Ok(insertion(leaving, entering, side, radius, corner)),
    }
}

/// The corner after the tool has stopped at the end normal of the first block: on an outside corner it goes round, on
/// an inside corner straight to the second block.
pub(super) fn joint_after_stop(leaving: &Tip, entering: &Tip, side: f64, radius: f64, corner: Corner) -> Joint {
    let [leave, enter] = [leaving, entering].map(|tip| tip.foot(side, radius));
    match class(leaving.tangent, entering.tangent, side) {
        Class::Shortening | Class::StraightOn => Joint::straight(leave, enter),
        _ => Joint { leave, between: round(leaving, entering, side, radius, corner), enter },
    }
}

fn insertion(leaving: &Tip, entering: &Tip, side: f64, radius: f64, corner: Corner) -> Joint {
    let [mut leave, mut enter] = [leaving, entering].map(|tip| tip.foot(side, radius));
    let between = round(leaving, entering, side, radius, corner);
    if let Between::Lines([first, second]) = between {
        // A line is prolonged itself; on an arc the tangent is a move of its own.
        leave = if leaving.radius.is_none() { first } else { leave };
        enter = if entering.radius.is_none() { second } else { enter };
    }
    Joint { leave, between, enter }
}

/// The path round an outside corner, from foot to foot.
fn round(leaving: &Tip, entering: &Tip, side: f64, radius: f64, corner: Corner) -> Between {
    if corner == Corner::Circular {
        return Between::Arc { turn: -side };
    }
    let extension = class(leaving.tangent, entering.tangent, side) == Class::Extension;
    match miter(leaving, entering, side, radius).filter(|_| extension) {
        Some(tip) => Between::Lines([tip; 2]),
        None => Between::Lines(shoulders(leaving, entering, side, radius)),
    }
}

/// P + r(n1 + l1) and P + r(n2 - l2).
fn shoulders(leaving: &Tip, entering: &Tip, side: f64, radius: f64) -> [Vector; 2] {
    let first = add(leaving.normal(side), leaving.tangent);
    let second = sub(entering.normal(side), entering.tangent);
    [first, second].map(|direction| add(leaving.point, scale(radius, direction)))
}

/// The curvature, positive to the left.
fn bend(tip: &Tip) -> f64 {
    tip.radius.map_or(0.0, |radius| 1.0 / radius)
}
