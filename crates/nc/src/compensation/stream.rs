//! The compensator: blocks in, moves of the tool's centre out, with one block held back.

use std::f64::consts::TAU;

use super::corner::{Between, Joint, joint, joint_after_stop};
use super::geometry::{Bend, Edge, LEAST, Vector, length, sub};
use super::{CompensationError, CompensationErrorKind as Kind, Corner, Scheme, WAITING_LIMIT};
use crate::{
    COORDINATE_LIMIT, Cause, Direction, Move, OTHERS, Others, Place, Point, Segment, SegmentShape, Side, ToolMove,
};

/// A move shorter than this along every axis is left out, in BLU.
const NOTHING: f64 = 1e-9;

/// Where the contour counts as interrupted between two blocks, in BLU.
const GAP: f64 = 1e-3;

/// Tool radius compensation of a program, block by block; it holds back one block of the contour at most, with the
/// moves without motion in the plane after it.
///
/// A call that returns an error has put out nothing and changed nothing.
///
/// ```
/// use stepwave_nc::{Compensator, Corner, Feed, Move, Others, PathControl, Place, Plane, Scheme, Segment, Side, SegmentShape};
///
/// let line = |line, from, to, side| Move {
///     place: Place { line, number: None },
///     segment: Segment { from, to, shape: SegmentShape::Line },
///     feed: Feed::PerMinute(100.0),
///     plane: Plane::Xy,
///     side,
///     path: PathControl::Continuous,
///     others: Others::default(),
///     chord: false,
/// };
/// let mut compensator = Compensator::new(Scheme::C, Corner::Straight);
/// let mut out = Vec::new();
/// compensator.push(line(1, [0.0; 3], [10.0, 0.0, 0.0], Side::Left(2.0)), &mut out)?;
/// compensator.push(line(2, [10.0, 0.0, 0.0], [30.0, 0.0, 0.0], Side::Left(2.0)), &mut out)?;
/// compensator.push(line(3, [30.0, 0.0, 0.0], [30.0, 20.0, 0.0], Side::Left(2.0)), &mut out)?;
/// compensator.flush(&mut out)?;
/// let ends: Vec<_> = out.iter().map(|tool| tool.segment.to).collect();
/// assert_eq!(ends, [[10.0, 2.0, 0.0], [28.0, 2.0, 0.0], [28.0, 20.0, 0.0]]);
/// # Ok::<(), stepwave_nc::CompensationError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Compensator {
    scheme: Scheme,
    corner: Corner,
    tail: Tail,
    /// Moves without motion in the plane, after the block that is held back.
    waiting: Vec<Move>,
    /// The tool's centre after the last move put out; of use while compensation is on.
    position: Point,
    /// The axes other than x, y and z then.
    others: [f64; OTHERS],
}

/// The end of the contour so far.
#[derive(Debug, Clone, Copy)]
enum Tail {
    /// Compensation is off.
    Off,
    /// A block is held back until its end is known.
    Held(Held),
    /// The last block is put out, up to the normal of its end.
    Stopped(OffsetBlock),
}

/// A block with its side.
#[derive(Debug, Clone, Copy)]
struct OffsetBlock {
    source: Move,
    edge: Edge,
    /// 1 left, -1 right.
    side: f64,
    radius: f64,
}

#[derive(Debug, Clone, Copy)]
struct Held {
    block: OffsetBlock,
    start_up: bool,
    /// Where the block's offset path begins.
    enter: Vector,
    /// The block before it.
    before: Option<Place>,
}

/// The path of the tool's centre along a block, from where the tool is.
#[derive(Debug, Clone, Copy)]
struct Path {
    to: Vector,
    shape: SegmentShape,
    cause: Cause,
}

impl Compensator {
    /// A compensator of a scheme, compensation off.
    #[must_use]
    pub fn new(scheme: Scheme, corner: Corner) -> Self {
        Compensator { scheme, corner, tail: Tail::Off, waiting: Vec::new(), position: [0.0; 3], others: [0.0; OTHERS] }
    }

    /// Takes the next block and puts out what is known by then. With compensation off a block passes as it is.
    ///
    /// # Errors
    ///
    /// The block cannot be compensated, or the one held back cannot be before this one; nothing is put out then.
    pub fn push(&mut self, block: Move, out: &mut Vec<ToolMove>) -> Result<(), CompensationError> {
        let alone = |kind| CompensationError { place: block.place, second: None, kind };
        check(&block).map_err(alone)?;
        let edge = Edge::of(&block.segment, block.plane);
        let before = match self.tail {
            Tail::Off => return self.start(block, edge, out).map_err(alone),
            Tail::Held(Held { block: before, .. }) | Tail::Stopped(before) => before,
        };
        let both = |kind| CompensationError { place: block.place, second: Some(before.source.place), kind };
        if block.plane != before.source.plane {
            return Err(both(Kind::PlaneChange));
        }
        if matches!(block.segment.shape, SegmentShape::Arc { plane, .. } if plane != block.plane) {
            return Err(alone(Kind::ArcInOtherPlane));
        }
        let gap = length(sub(edge.from, before.edge.to));
        if gap > GAP {
            return Err(both(Kind::Apart { gap }));
        }
        if let Bend::Round { center, .. } = edge.bend
            && [edge.from, edge.to].iter().any(|&end| length(sub(end, center)) < LEAST)
        {
            return Err(alone(Kind::ArcOfNoRadius));
        }
        if !edge.moves() {
            return self.wait(block, &before, out).map_err(alone);
        }
        match sided(block.side).map_err(alone)? {
            None => self.cancel(block, edge, out),
            Some((side, radius)) => {
                let next = OffsetBlock { source: block, edge, side, radius };
                if let Some(arc) = [edge.start(), edge.end()].iter().find_map(|tip| tip.too_small(side, radius)) {
                    return Err(alone(Kind::InsideArc { arc, radius }));
                }
                self.follow(next, out)
            }
        }
    }

    /// Puts out what is held back, up to the normal of its end: before a stop of the program and at its end.
    /// Compensation stays on.
    ///
    /// # Errors
    ///
    /// The block held back would run backwards; nothing is put out then.
    pub fn flush(&mut self, out: &mut Vec<ToolMove>) -> Result<(), CompensationError> {
        if let Tail::Held(held) = self.tail {
            let path = held.path(held.block.end_foot(), held.before)?;
            self.put(&held.block, path, out);
            self.release(&held.block, out);
            self.tail = Tail::Stopped(held.block);
        }
        Ok(())
    }

    /// A block while compensation is off.
    fn start(&mut self, block: Move, edge: Edge, out: &mut Vec<ToolMove>) -> Result<(), Kind> {
        let Some((side, radius)) = sided(block.side)?.filter(|_| edge.moves()) else {
            let Move { place, segment, feed, path, others, chord, .. } = block;
            let (cause, side) = (Cause::Programmed, Side::On);
            self.others = others.to;
            out.push(ToolMove { place, segment, feed, cause, programmed: segment, side, path, others, chord });
            return Ok(());
        };
        let length = edge.length();
        if edge.bend != Bend::Straight {
            return Err(Kind::StartOnArc);
        }
        if length < radius {
            return Err(Kind::StartTooShort { length, radius });
        }
        let start = OffsetBlock { source: block, edge, side, radius };
        self.position = block.segment.from;
        self.tail = Tail::Held(Held { block: start, start_up: true, enter: edge.from, before: None });
        Ok(())
    }

    /// A block without motion in the plane.
    fn wait(&mut self, block: Move, before: &OffsetBlock, out: &mut Vec<ToolMove>) -> Result<(), Kind> {
        if self.waiting.len() == WAITING_LIMIT {
            return Err(Kind::TooManyWithoutMotion);
        }
        self.waiting.push(block);
        if let Tail::Stopped(_) = self.tail {
            self.release(before, out);
        }
        Ok(())
    }

    /// A block that ends compensation.
    fn cancel(&mut self, block: Move, edge: Edge, out: &mut Vec<ToolMove>) -> Result<(), CompensationError> {
        let (Tail::Held(Held { block: before, .. }) | Tail::Stopped(before)) = self.tail else {
            return Ok(());
        };
        let alone = |kind| CompensationError { place: block.place, second: None, kind };
        let (length, radius) = (edge.length(), before.radius);
        if edge.bend != Bend::Straight {
            return Err(alone(Kind::CancelOnArc));
        }
        if length < radius {
            return Err(alone(Kind::CancelTooShort { length, radius }));
        }
        self.flush(out)?;
        let cancel = OffsetBlock { source: block, edge, side: before.side, radius };
        self.put(&cancel, Path { to: edge.to, shape: SegmentShape::Line, cause: Cause::Cancel }, out);
        self.tail = Tail::Off;
        Ok(())
    }

    /// A compensated block after another.
    fn follow(&mut self, next: OffsetBlock, out: &mut Vec<ToolMove>) -> Result<(), CompensationError> {
        let (before, held) = match self.tail {
            Tail::Off => return Ok(()),
            Tail::Held(held) => (held.block, Some(held)),
            Tail::Stopped(block) => (block, None),
        };
        let place = before.source.place;
        let second = Some(next.source.place);
        let joint = self.joint(&before, held, &next).map_err(|kind| CompensationError { place, second, kind })?;
        let path = held.map(|held| held.path(joint.leave, second)).transpose()?;
        let held = Held { block: next, start_up: false, enter: joint.enter, before: Some(place) };
        let whole = match self.scheme {
            Scheme::B => Some(held.path(next.end_foot(), Some(place))?),
            Scheme::C => None,
        };
        if let Some(path) = path {
            self.put(&before, path, out);
            self.release(&before, out);
        }
        self.insert(&before, &joint, out);
        self.tail = match whole {
            None => Tail::Held(held),
            Some(path) => {
                self.put(&next, path, out);
                Tail::Stopped(next)
            }
        };
        Ok(())
    }

    fn joint(&self, before: &OffsetBlock, held: Option<Held>, next: &OffsetBlock) -> Result<Joint, Kind> {
        let [leaving, entering] = [before.edge.end(), next.edge.start()];
        let enter = entering.foot(next.side, next.radius);
        if held.is_some_and(|held| held.start_up) {
            return Ok(Joint::straight(enter, enter));
        }
        let OffsetBlock { side, radius, .. } = *before;
        let same_side = side * next.side > 0.0;
        let straight = [before, next].iter().all(|block| block.edge.bend == Bend::Straight);
        if !same_side && !straight {
            return Err(Kind::SideChangeOnArc);
        }
        #[allow(clippy::float_cmp)] // as programmed
        let same_radius = radius == next.radius;
        match (self.scheme, held) {
            (Scheme::C, Some(_)) if same_side && same_radius => joint(&leaving, &entering, side, radius, self.corner),
            (Scheme::C, None) if same_side && same_radius => {
                Ok(joint_after_stop(&leaving, &entering, side, radius, self.corner))
            }
            _ => Ok(Joint::straight(before.end_foot(), enter)),
        }
    }

    /// Puts out the moves without motion in the plane, where the tool is.
    fn release(&mut self, before: &OffsetBlock, out: &mut Vec<ToolMove>) {
        for source in std::mem::take(&mut self.waiting) {
            let [u, v, _] = source.plane.of(self.position);
            let [_, _, third] = source.plane.of(source.segment.to);
            let to = source.plane.point([u, v, third]);
            let segment = Segment { from: self.position, to, shape: SegmentShape::Line };
            let Move { place, feed, segment: programmed, path, others, chord, .. } = source;
            let (cause, side) = (Cause::Programmed, before.source.side);
            self.send(ToolMove { place, segment, feed, cause, programmed, side, path, others, chord }, out);
        }
    }

    /// Puts out what a corner inserts after a block.
    fn insert(&mut self, before: &OffsetBlock, joint: &Joint, out: &mut Vec<ToolMove>) {
        let plane = before.source.plane;
        let [u, v, third] = plane.of(self.position);
        let [x, y] = before.edge.to;
        let corner = plane.point([x, y, third]);
        let shapes = match joint.between {
            Between::Arc { turn } if length(sub(joint.enter, [u, v])) >= LEAST => {
                let direction = if turn < 0.0 { Direction::Clockwise } else { Direction::CounterClockwise };
                [None, None, Some((joint.enter, SegmentShape::Arc { plane, center: before.edge.to, direction }))]
            }
            Between::Arc { .. } => [None, None, Some((joint.enter, SegmentShape::Line))],
            Between::Lines([first, second]) => [first, second, joint.enter].map(|to| Some((to, SegmentShape::Line))),
        };
        for ([u, v], shape) in shapes.into_iter().flatten() {
            let segment = Segment { from: self.position, to: plane.point([u, v, third]), shape };
            let programmed = Segment { from: corner, to: corner, shape: SegmentShape::Line };
            let Move { place, feed, side, path, .. } = before.source;
            let (cause, others) = (Cause::Inserted, Others::at(self.others));
            self.send(ToolMove { place, segment, feed, cause, programmed, side, path, others, chord: false }, out);
        }
    }

    /// Puts out the tool's path along a block.
    fn put(&mut self, block: &OffsetBlock, path: Path, out: &mut Vec<ToolMove>) {
        let plane = block.source.plane;
        let [_, _, third] = plane.of(block.source.segment.to);
        let [u, v, _] = plane.of(self.position);
        // A full circle ends exactly where it starts.
        let closed = matches!(path.shape, SegmentShape::Arc { .. }) && length(sub(path.to, [u, v])) < LEAST;
        let [u, v] = if closed { [u, v] } else { path.to };
        let segment = Segment { from: self.position, to: plane.point([u, v, third]), shape: path.shape };
        let cause = path.cause;
        let Move { place, feed, side, segment: programmed, path, others, chord, .. } = block.source;
        self.send(ToolMove { place, segment, feed, cause, programmed, side, path, others, chord }, out);
    }

    fn send(&mut self, tool: ToolMove, out: &mut Vec<ToolMove>) {
        let Segment { from, to, shape } = tool.segment;
        let still = from.iter().zip(to).all(|(from, to)| (from - to).abs() <= NOTHING);
        if !still || shape != SegmentShape::Line || !tool.others.rest() {
            self.position = to;
            self.others = tool.others.to;
            out.push(tool);
        }
    }
}

impl OffsetBlock {
    fn end_foot(&self) -> Vector {
        self.edge.end().foot(self.side, self.radius)
    }
}

impl Held {
    /// The tool's path along the block, to where it is left; `other` is the block to blame if that is not possible.
    fn path(&self, leave: Vector, other: Option<Place>) -> Result<Path, CompensationError> {
        let OffsetBlock { source, edge, side, radius } = self.block;
        let line = |cause| Path { to: leave, shape: SegmentShape::Line, cause };
        if self.start_up {
            return Ok(line(Cause::StartUp));
        }
        let feet = [edge.start(), edge.end()].map(|tip| tip.foot(side, radius));
        let along = edge.along(feet, self.enter, leave);
        let fail = |kind| Err(CompensationError { place: source.place, second: other, kind });
        if along < -LEAST {
            let length = edge.along(feet, feet[0], feet[1]);
            return fail(Kind::Reversed { radius, length, taken: length - along });
        }
        let Bend::Round { center, .. } = edge.bend else {
            return Ok(line(Cause::Programmed));
        };
        let circle = length(sub(self.enter, center)) * TAU;
        if along > circle + LEAST {
            return fail(Kind::MoreThanATurn { turns: along / circle });
        }
        // An arc of next to no length would be taken for a full circle.
        if along < 2.0 * LEAST {
            return Ok(line(Cause::Programmed));
        }
        Ok(Path { shape: source.segment.shape, ..line(Cause::Programmed) })
    }
}

/// The side of a block, 1 left and -1 right, and the radius; `None` with compensation off.
fn sided(side: Side) -> Result<Option<(f64, f64)>, Kind> {
    let (sign, radius) = match side {
        Side::On => return Ok(None),
        Side::Left(radius) => (1.0, radius),
        Side::Right(radius) => (-1.0, radius),
    };
    if (0.0..=limit()).contains(&radius) { Ok(Some((sign, radius))) } else { Err(Kind::Radius { radius }) }
}

/// Every coordinate is a number within the limit.
fn check(block: &Move) -> Result<(), Kind> {
    let center = match block.segment.shape {
        // Control points are looked at where they are rounded.
        SegmentShape::Line | SegmentShape::Bezier(_) => [0.0; 2],
        SegmentShape::Arc { center, .. } => center,
    };
    let Segment { from, to, .. } = block.segment;
    match from.into_iter().chain(to).chain(center).find(|value| !(-limit()..=limit()).contains(value)) {
        Some(value) => Err(Kind::Coordinate { value }),
        None => Ok(()),
    }
}

#[allow(clippy::cast_precision_loss)] // a power of two
fn limit() -> f64 {
    COORDINATE_LIMIT as f64
}
