//! The path along a conic from start to end: its length and points of it.

use std::f64::consts::{FRAC_PI_2, PI};

use super::foot::{at, parameter, speed};
use crate::exact::vector;
use crate::{Conic, Direction, Opens, Quadrant, Shape};

/// Halvings of a piece at most, so that no input runs long.
const DEPTH: u32 = 48;

/// The parameters of the curve's points next to start and end; those between are the curve's.
///
/// Of an ellipse they are angles counter-clockwise from +x, of an open curve negative on the negative side of its axis.
fn span(conic: &Conic) -> [f64; 2] {
    let ends = [conic.start(), conic.end()];
    let [first, last] = ends.map(|end| parameter(conic.shape(), vector(end)));
    let Some(opens) = conic.opens() else {
        return around(conic, first, last);
    };
    let side = |point: [i64; 2], parameter: f64| if opens.along_across(point)[1] < 0 { -parameter } else { parameter };
    [side(ends[0], first), side(ends[1], last)]
}

fn around(conic: &Conic, first: f64, last: f64) -> [f64; 2] {
    let turn = conic.turn();
    let base = |quadrant: Quadrant, inside: f64| match quadrant {
        Quadrant::I => inside,
        Quadrant::II => PI - inside,
        Quadrant::III => PI + inside,
        Quadrant::IV => 2.0 * PI - inside,
    };
    let gone = |quadrant: Quadrant, inside: f64| {
        if quadrant.growing_axis(turn.direction) == 1 { inside } else { FRAC_PI_2 - inside }
    };
    let quarters = u8::try_from(turn.crossings()).map_or(0.0, f64::from); // at most 4
    let angle = quarters * FRAC_PI_2 + gone(turn.end_quadrant(), last) - gone(turn.start_quadrant(), first);
    let start = base(turn.start_quadrant(), first);
    match turn.direction {
        Direction::Clockwise => [start, start - angle],
        Direction::CounterClockwise => [start, start + angle],
    }
}

/// The length of the curve, by Gauss's rule on pieces halved until it no longer changes.
pub(super) fn length(conic: &Conic) -> f64 {
    let [first, last] = span(conic);
    let pieces = 16_u8;
    let place = |index: u8| first + (last - first) * f64::from(index) / f64::from(pieces);
    let ends = |index: u8| [place(index), place(index + 1)];
    let rough: f64 = (0..pieces).map(|index| gauss(conic.shape(), ends(index)).abs()).sum();
    let piece = |index: u8| refined(conic.shape(), ends(index), gauss(conic.shape(), ends(index)), rough, DEPTH);
    (0..pieces).map(piece).sum::<f64>().abs()
}

/// The integral of the speed over a piece, where it is about `whole`, to a part of the rough length of all.
fn refined(shape: Shape, [first, last]: [f64; 2], whole: f64, rough: f64, depth: u32) -> f64 {
    let middle = first.midpoint(last);
    let halves = [[first, middle], [middle, last]];
    let [left, right] = halves.map(|half| gauss(shape, half));
    if depth == 0 || (left + right - whole).abs() <= rough * 1e-13 {
        return left + right;
    }
    refined(shape, halves[0], left, rough, depth - 1) + refined(shape, halves[1], right, rough, depth - 1)
}

/// The integral of the speed over a piece by Gauss's rule of five points.
fn gauss(shape: Shape, [first, last]: [f64; 2]) -> f64 {
    let root = (10.0_f64 / 7.0).sqrt();
    let [near, far] = [5.0 - 2.0 * root, 5.0 + 2.0 * root].map(|square| square.sqrt() / 3.0);
    let share = 13.0 * 70.0_f64.sqrt();
    let (middle, half) = (first.midpoint(last), (last - first) / 2.0);
    let pair = |place: f64| speed(shape, middle + half * place) + speed(shape, middle - half * place);
    let sum = 128.0 / 225.0 * speed(shape, middle)
        + (322.0 + share) / 900.0 * pair(near)
        + (322.0 - share) / 900.0 * pair(far);
    half * sum
}

/// This many points of the curve at equal steps of its parameter, in machine coordinates, the ends as programmed.
pub(super) fn outline(conic: &Conic, points: usize) -> Vec<[f64; 2]> {
    let [start, end] = span(conic);
    let (last, opens) = (points - 1, conic.opens().unwrap_or(Opens::PlusX));
    let [cx, cy] = conic.center().map(|c| c as f64);
    let inner = (1..last).map(|place| {
        let [x, y] = opens.plane(at(conic.shape(), start + (end - start) * place as f64 / last as f64));
        [cx + x, cy + y]
    });
    let [first, end] = [conic.from(), conic.to()].map(|point| point.map(|c| c as f64));
    std::iter::once(first).chain(inner).chain(std::iter::once(end)).collect()
}
