//! The place of a curve that is nearest to a position: what curves in pieces, each over u from 0 to 1, have in common.

use crate::curve::outline_points;

/// Halvings of a segment that place a minimum as exactly as an `f64` can.
const HALVINGS: u32 = 52;

/// The place of a curve that is nearest to a position.
pub(crate) struct Foot {
    pub(crate) distance: f64,
    /// Positive where the position is on the left.
    side: f64,
}

impl Foot {
    /// Farther than any other.
    pub(crate) const NONE: Foot = Foot { distance: f64::INFINITY, side: 0.0 };

    /// The foot `at` a place of the curve, with its tangent.
    fn new([at_x, at_y]: [f64; 2], [dx, dy]: [f64; 2], [x, y]: [f64; 2]) -> Foot {
        Foot { distance: (x - at_x).hypot(y - at_y), side: dx * (y - at_y) - dy * (x - at_x) }
    }

    /// The nearest place of a piece: one of its ends, or where `growth`, the Bézier coefficients, `count` of them, of a polynomial with the
    /// sign of the change of the distance along u, turns from negative to positive. `at` gives the place at u and its tangent.
    pub(crate) fn of_piece<const N: usize>(
        position: [f64; 2],
        at: impl Fn(f64) -> [[f64; 2]; 2],
        (growth, count): ([f64; N], usize),
    ) -> Foot {
        let mut nearest = Foot::NONE;
        let mut take = |u: f64| {
            let [place, tangent] = at(u);
            nearest.take(Foot::new(place, tangent, position));
        };
        take(0.0);
        take(1.0);
        minima(growth, count, [0.0, 1.0], HALVINGS, &mut take);
        nearest
    }

    /// Takes the other one in place of this if it is nearer.
    pub(crate) fn take(&mut self, other: Foot) {
        if other.distance < self.distance {
            *self = other;
        }
    }

    /// The distance with its side: positive on the left of the curve.
    pub(crate) fn signed(&self) -> f64 {
        if self.side < 0.0 { -self.distance } else { self.distance }
    }
}

/// A distance that no place in a box is nearer than.
pub(crate) fn beyond(bounds: [[f64; 2]; 2], position: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis: usize| {
        let ([least, most], at) = (bounds[axis], position[axis]);
        (least - at).max(at - most).max(0.0)
    });
    x.hypot(y)
}

/// Visits what may be nearer than the nearest so far by its bound, that of the least bound first.
pub(crate) fn nearest_first(
    nearest: &mut Foot,
    count: usize,
    bound: impl Fn(usize) -> f64,
    mut visit: impl FnMut(usize, &mut Foot),
) {
    let Some(first) = (0..count).min_by(|a, b| bound(*a).total_cmp(&bound(*b))) else { return };
    for index in std::iter::once(first).chain((0..count).filter(|index| *index != first)) {
        if bound(index) < nearest.distance {
            visit(index, nearest);
        }
    }
}

/// Visits every place from `low` to `low + length` at which a polynomial of these Bézier coefficients, `count` of them,
/// may turn from negative to positive.
fn minima<const N: usize>(
    growth: [f64; N],
    count: usize,
    [low, length]: [f64; 2],
    halvings: u32,
    visit: &mut impl FnMut(f64),
) {
    // A polynomial has no more roots than its coefficients have changes of sign.
    let mut signs = growth[..count].iter().filter(|c| **c != 0.0).map(|c| *c > 0.0);
    let Some(first) = signs.next() else { return };
    let (mut sign, mut changes) = (first, 0);
    for next in signs {
        changes += u32::from(next != sign);
        sign = next;
    }
    if changes == 0 || changes == 1 && first {
        return;
    }
    if halvings == 0 {
        visit(low + length / 2.0);
        return;
    }
    let [left, right] = halves(growth, count);
    if right[0] == 0.0 {
        visit(low + length / 2.0);
    }
    minima(left, count, [low, length / 2.0], halvings - 1, visit);
    minima(right, count, [low + length / 2.0, length / 2.0], halvings - 1, visit);
}

/// The Bézier coefficients of both halves, by de Casteljau.
fn halves<const N: usize>(mut right: [f64; N], count: usize) -> [[f64; N]; 2] {
    let mut left = right;
    for (round, left) in left[..count].iter_mut().enumerate() {
        if round > 0 {
            for place in 0..count - round {
                right[place] = f64::midpoint(right[place], right[place + 1]);
            }
        }
        *left = right[0];
    }
    [left, right]
}

/// Points of a curve in BLU for drawing: `max_points`, but two at least; the first and the last are its ends. `at` gives a
/// place of one of its `pieces` at u.
pub(crate) fn outline(
    ends: &[[i64; 2]; 2],
    pieces: usize,
    max_points: usize,
    at: impl Fn(usize, f64) -> [f64; 2],
) -> Vec<[f64; 2]> {
    let last = outline_points(max_points) - 1;
    let point = |index: usize| {
        if index == 0 || index == last {
            return ends[usize::from(index > 0)].map(|c| c as f64);
        }
        let place = index as f64 / last as f64 * pieces as f64;
        // Not negative, and less than the number of pieces.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let piece = (place as usize).min(pieces - 1);
        at(piece, place - piece as f64)
    };
    (0..=last).map(point).collect()
}
