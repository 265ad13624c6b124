//! Lines and arcs in the plane of compensation: their tangents, their offset at a corner, and where two offset paths
//! meet.

use std::f64::consts::TAU;

use crate::{Direction, Plane, Segment, SegmentShape, swept};

/// Below this a length counts as 0, in BLU: a millionth of a pulse.
pub(super) const LEAST: f64 = 1e-6;

/// A point or a vector in the plane, in BLU.
pub(super) type Vector = [f64; 2];

pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn scale(factor: f64, a: Vector) -> Vector {
    [factor * a[0], factor * a[1]]
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: Vector, b: Vector) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn length(a: Vector) -> f64 {
    f64::hypot(a[0], a[1])
}

/// The vector turned by a quarter to the left.
pub(super) fn left(a: Vector) -> Vector {
    [-a[1], a[0]]
}

/// The vector of length 1 in this direction; the zero vector stays.
pub(super) fn unit(a: Vector) -> Vector {
    let length = length(a);
    if length > 0.0 { scale(1.0 / length, a) } else { a }
}

/// A block seen in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    pub(super) from: Vector,
    pub(super) to: Vector,
    pub(super) bend: Bend,
}

/// The shape of an [`Edge`] between its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bend {
    Straight,
    Round {
        center: Vector,
        /// 1 counter-clockwise, -1 clockwise.
        turn: f64,
        /// The angle, more than 0, up to 2π.
        sweep: f64,
    },
}

/// An end of a block at a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tip {
    /// The corner.
    pub(super) point: Vector,
    /// The unit tangent, in the direction of motion.
    pub(super) tangent: Vector,
    /// The signed radius of an arc: positive where the centre is on the left. None on a line.
    pub(super) radius: Option<f64>,
}

impl Edge {
    /// The block as the plane shows it.
    pub(super) fn of(segment: &Segment, plane: Plane) -> Edge {
        let [from, to] = [segment.from, segment.to].map(|point| {
            let [u, v, _] = plane.of(point);
            [u, v]
        });
        let bend = match segment.shape {
            // A free curve is never compensated.
            SegmentShape::Line | SegmentShape::Bezier(_) => Bend::Straight,
            SegmentShape::Arc { center, direction, .. } => Bend::Round {
                center,
                turn: if direction == Direction::Clockwise { -1.0 } else { 1.0 },
                sweep: if length(sub(to, from)) < LEAST { TAU } else { swept(segment, plane, center, direction) },
            },
        };
        Edge { from, to, bend }
    }

    /// The length, in BLU.
    pub(super) fn length(&self) -> f64 {
        match self.bend {
            Bend::Straight => length(sub(self.to, self.from)),
            Bend::Round { center, sweep, .. } => length(sub(self.from, center)) * sweep,
        }
    }

    /// Whether the block moves in the plane.
    pub(super) fn moves(&self) -> bool {
        self.length() >= LEAST
    }

    pub(super) fn start(&self) -> Tip {
        self.tip(self.from)
    }

    pub(super) fn end(&self) -> Tip {
        self.tip(self.to)
    }

    fn tip(&self, point: Vector) -> Tip {
        match self.bend {
            Bend::Straight => Tip { point, tangent: unit(sub(self.to, self.from)), radius: None },
            Bend::Round { center, turn, .. } => {
                let spoke = sub(point, center);
                Tip { point, tangent: scale(turn, left(unit(spoke))), radius: Some(turn * length(spoke)) }
            }
        }
    }

    /// The length of the path from `enter` to `leave`, both on the path that is offset from this block, in BLU:
    /// negative where the path would run against the block's direction. `foot` are the ends of the offset path where
    /// neither corner changes it.
    pub(super) fn along(&self, foot: [Vector; 2], enter: Vector, leave: Vector) -> f64 {
        match self.bend {
            Bend::Straight => dot(sub(leave, enter), self.start().tangent),
            Bend::Round { center, turn, sweep } => {
                let angle = |a: Vector, b: Vector| {
                    let (a, b) = (sub(a, center), sub(b, center));
                    turn * cross(a, b).atan2(dot(a, b))
                };
                (sweep - angle(foot[0], enter) + angle(foot[1], leave)) * length(sub(enter, center))
            }
        }
    }
}

impl Tip {
    /// The normal towards a side: 1 left, -1 right.
    pub(super) fn normal(&self, side: f64) -> Vector {
        scale(side, left(self.tangent))
    }

    /// The point at a distance from the corner along the normal: where the offset path begins or ends if the corner
    /// does not change it.
    pub(super) fn foot(&self, side: f64, radius: f64) -> Vector {
        add(self.point, scale(radius, self.normal(side)))
    }

    /// The radius of an arc, positive where the tool passes outside the circle, negative inside.
    fn outward(&self, side: f64) -> Option<f64> {
        self.radius.map(|radius| -side * radius)
    }

    /// How much smaller than the tool's radius an arc is that the tool is to pass inside; its radius then.
    pub(super) fn too_small(&self, side: f64, radius: f64) -> Option<f64> {
        self.outward(side).map(|outward| -outward).filter(|&inside| inside > 0.0 && inside < radius + LEAST)
    }
}

/// P + r(n1 + n2)/(1 + n1·n2): where the lines meet that are offset from the tangents of both blocks; `None` where they
/// are parallel.
pub(super) fn miter(leaving: &Tip, entering: &Tip, side: f64, radius: f64) -> Option<Vector> {
    let sum = add(leaving.normal(side), entering.normal(side));
    // |n1 + n2|² / 2 = 1 + n1·n2, without the cancellation.
    let both = dot(sum, sum) / 2.0;
    (both > 0.0).then(|| add(leaving.point, scale(radius / both, sum)))
}

/// Where the paths that are offset from two blocks meet, the root nearest to the feet of both; `None` where they do not
/// meet.
///
/// All roots are sought relative to a foot F = P + r·n, not relative to the centres, so that a corner that is almost
/// tangent loses no digits. A point F + z is on the circle R' = |ρ| about an arc's centre where z² + 2ρ(n·z) = 0, with
/// ρ the signed radius of the offset circle and n the normal at F.
pub(super) fn meeting(leaving: &Tip, entering: &Tip, side: f64, radius: f64) -> Option<Vector> {
    let (n1, n2) = (leaving.normal(side), entering.normal(side));
    // |n1 - n2|² / 2 = 1 - n1·n2, without the cancellation.
    let apart = dot(sub(n1, n2), sub(n1, n2)) / 2.0;
    match (leaving.outward(side), entering.outward(side)) {
        (None, None) => miter(leaving, entering, side, radius),
        (None, Some(arc)) => {
            let t = nearer_root(arc * dot(n2, leaving.tangent), -2.0 * radius * arc * apart)?;
            Some(add(leaving.foot(side, radius), scale(t, leaving.tangent)))
        }
        (Some(arc), None) => {
            let t = nearer_root(arc * dot(n1, entering.tangent), -2.0 * radius * arc * apart)?;
            Some(add(entering.foot(side, radius), scale(t, entering.tangent)))
        }
        (Some(first), Some(second)) => {
            // From centre to centre; the roots lie on a line across.
            let between = sub(scale(first, n1), scale(second, n2));
            let distance = length(between);
            if distance < LEAST {
                return None;
            }
            let towards = scale(1.0 / distance, between);
            let across = left(towards);
            let offset = radius + first;
            let depth = -radius * second * apart / distance;
            let t = nearer_root(offset * dot(n1, across), depth * depth + 2.0 * offset * depth * dot(n1, towards))?;
            Some(add(leaving.foot(side, radius), add(scale(depth, towards), scale(t, across))))
        }
    }
}

/// The root of t² + 2bt + c = 0 that is nearer to 0, if the roots are real.
fn nearer_root(b: f64, c: f64) -> Option<f64> {
    let square = b * b - c;
    if square < -1e-12 * (b * b + c.abs()) {
        return None;
    }
    let root = square.max(0.0).sqrt();
    let farther = if b < 0.0 { b - root } else { b + root };
    Some(if farther == 0.0 { 0.0 } else { -c / farther })
}
