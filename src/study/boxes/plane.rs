//! Lines and arcs in a grid: all of them, or the extreme ones.

use stepwave_models::Model;
use stepwave_models::extremes::{self, Reach};
use stepwave_nc::Curve;

use super::{MOST, line};
use crate::study::proof::ProofError;
use crate::study::{Grid, Range};

/// Points of a grid in which all arcs are looked for, at most.
const MOST_POINTS: u64 = 1 << 22;
/// Coordinates at each end of a range that are looked at where its points are more.
const CORNER: u64 = 256;

/// The model takes geometries of as many axes as the grid has ranges.
pub(super) fn check(model: &Model, Grid(ranges): &Grid, arcs: bool) -> Result<(), ProofError> {
    let (axes, most) = (ranges.len(), model.curve().max_axes());
    let least = most.min(2);
    if (least..=most).contains(&axes) {
        return Ok(());
    }
    let takes = if arcs { "arcs in the plane" } else { model.curve().describe() };
    let ranges = vec!["0..9"; if axes < least { least } else { most }].join("x");
    let plural = if axes == 1 { "range" } else { "ranges" };
    Err(ProofError::Box(format!(
        "the box has {axes} {plural}, but {} interpolates {takes}: give --box {ranges}",
        model.name
    )))
}

/// Points of a grid.
pub(super) fn count(Grid(ranges): &Grid) -> u128 {
    ranges.iter().fold(1_u128, |count, range| count.saturating_mul(range.count().into()))
}

/// The lines from the origin to all points of a grid; `None` if they are too many.
pub(super) fn all_lines(grid: &Grid) -> Option<Vec<Curve>> {
    let count = count(grid);
    let point = |mut place: u128| {
        let digit = |range: &Range| {
            let count = u128::from(range.count());
            let digit = place % count;
            place /= count;
            range.at(u64::try_from(digit).unwrap_or(0))
        };
        grid.0.iter().map(digit).collect::<Vec<i64>>()
    };
    (count < MOST as u128).then(|| (0..count).map(point).filter_map(line).collect())
}

/// All arcs about the origin inside one quadrant whose ends are points of a grid, on one circle; `None` if they are too
/// many, or the points are.
pub(super) fn all_arcs(grid: &Grid) -> Option<Vec<Curve>> {
    let [x, y] = grid.0[..] else { return None };
    if count(grid) > u128::from(MOST_POINTS) {
        return None;
    }
    arcs_between(&x.numbers().collect::<Vec<i64>>(), &y.numbers().collect::<Vec<i64>>())
}

/// Such arcs between the points next to the corners of a grid that is too large for all of them; `None` if they are too
/// many.
pub(super) fn corner_arcs(grid: &Grid) -> Option<Vec<Curve>> {
    let [x, y] = grid.0[..] else { return None };
    let ends = |range: Range| -> Vec<i64> {
        let count = range.count();
        let first = 0..CORNER.min(count);
        let last = count.saturating_sub(CORNER).max(first.end)..count;
        first.chain(last).map(|place| range.at(place)).collect()
    };
    arcs_between(&ends(x), &ends(y))
}

/// Arcs inside one quadrant between points of these coordinates, in the order of their radii.
fn arcs_between(x: &[i64], y: &[i64]) -> Option<Vec<Curve>> {
    let square = |place: i64| i128::from(place).pow(2);
    let mut points: Vec<(i128, [i64; 2])> =
        x.iter().flat_map(|&x| y.iter().map(move |&y| (square(x) + square(y), [x, y]))).collect();
    points.sort_by_key(|(square, _)| *square);
    let mut arcs = Vec::new();
    for circle in points.chunk_by(|a, b| a.0 == b.0) {
        let side = |axis: usize, point: &[i64; 2]| point[axis].signum();
        for (_, from) in circle {
            // The ends of an arc inside a quadrant are on no two sides of an axis.
            let near =
                |to: &&[i64; 2]| *to != from && [0, 1].iter().all(|&axis| side(axis, from) * side(axis, to) >= 0);
            let ends = circle.iter().map(|(_, to)| to).filter(near);
            arcs.extend(ends.filter_map(|to| extremes::inside([*from, *to])));
            if arcs.len() > MOST {
                return None;
            }
        }
    }
    Some(arcs)
}

/// The extreme lines or arcs of a grid.
pub(super) fn extremes(Grid(ranges): &Grid, arcs: bool) -> Vec<Curve> {
    let sides: Vec<Reach> = ranges.iter().map(reach).collect();
    match sides[..] {
        [x, y] if arcs => extremes::arcs([x, y]).into_iter().filter_map(extremes::inside).collect(),
        _ => extremes::points(&sides).into_iter().filter_map(line).collect(),
    }
}

fn reach(range: &Range) -> Reach {
    let last = range.at(range.count() - 1);
    Reach { least: range.at(0), greatest: last, step: range.step() }
}
