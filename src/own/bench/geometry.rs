//! The numbers of a geometry that expressions of a bench file read.

use crate::models::AXES;
use crate::nc::{Arc, Crossing, Curve, Direction, Sector};
use crate::netlist::Width;

/// Numbers that only an arc has.
const OF_ARCS: [&str; 4] = ["r", "cx", "cy", "cw"];
/// Those of both, besides the ones of each axis.
const OF_BOTH: [&str; 4] = ["arc", "quadrant", "n", SPEED];
/// The commanded speed, in 2^-32 BLU a clock.
pub(super) const SPEED: &str = "rate";

/// Names of all numbers, in the order of [`values`].
pub(super) fn names() -> Vec<String> {
    let of_axis = |axis: &str| [format!("d{axis}"), format!("{axis}0"), format!("{axis}e")];
    let relative = AXES[..2].iter().flat_map(|axis| [format!("d{axis}0"), format!("d{axis}e")]);
    let axes = AXES.iter().flat_map(|axis| of_axis(axis));
    let others = OF_ARCS.iter().chain(&OF_BOTH).map(|&name| name.to_owned());
    axes.chain(relative).chain(others).collect()
}

/// The names that only an arc gives a meaning.
pub(super) fn of_arcs() -> Vec<String> {
    let relative = AXES[..2].iter().flat_map(|axis| [format!("d{axis}0"), format!("d{axis}e")]);
    relative.chain(OF_ARCS.iter().map(|&name| name.to_owned())).collect()
}

/// What is loaded at once: a line, an arc, or the part of an arc in one quadrant.
pub(super) struct Piece<'a> {
    pub(super) curve: &'a Curve,
    /// Where it starts and ends, in BLU.
    pub(super) from: Vec<i64>,
    pub(super) to: Vec<i64>,
    pub(super) quadrant: i128,
}

impl<'a> Piece<'a> {
    /// All of a curve.
    pub(super) fn whole(curve: &'a Curve) -> Piece<'a> {
        Piece { curve, from: curve.from().to_vec(), to: curve.to().to_vec(), quadrant: quadrant(curve) }
    }

    /// The parts of an arc between the axes through its centre, or all of a line.
    pub(super) fn split(self) -> Vec<Piece<'a>> {
        let Curve::Arc(arc) = self.curve else { return vec![self] };
        let at = |point: [i64; 2]| -> Vec<i64> {
            let around = arc.center().into_iter().zip(point).map(|(center, at)| center + at);
            around.chain(self.from.iter().skip(2).copied()).collect()
        };
        let part = |sector: Sector| Piece {
            from: at(sector.start),
            to: at(sector.end),
            quadrant: i128::from(sector.quadrant.index()) + 1,
            ..Piece::whole(self.curve)
        };
        arc.sectors(Crossing::RoundedRadius).into_iter().map(part).filter(|part| part.from != part.to).collect()
    }
}

/// The numbers of a line or an arc in BLU, at this commanded speed in 2^-32 BLU a clock; what it does not have is 0.
pub(super) fn values(piece: &Piece<'_>, speed: u64) -> Vec<i128> {
    let at = |point: &[i64], axis: usize| point.get(axis).copied().map_or(0, i128::from);
    let Piece { curve, from, to, quadrant } = piece;
    let mut values = Vec::new();
    for axis in 0..AXES.len() {
        let (start, end) = (at(from, axis), at(to, axis));
        values.extend([end - start, start, end]);
    }
    let arc = match curve {
        Curve::Arc(arc) => Some(arc),
        _ => None,
    };
    let center = arc.map(Arc::center);
    for axis in 0..2 {
        let relative = |point: &[i64]| center.map_or(0, |center| at(point, axis) - i128::from(center[axis]));
        values.extend([relative(from), relative(to)]);
    }
    let clockwise = arc.is_some_and(|arc| arc.direction() == Direction::Clockwise);
    let [cx, cy] = center.unwrap_or_default().map(i128::from);
    values.extend([arc.map_or(0, |arc| root(arc.radius_squared())), cx, cy, i128::from(clockwise)]);
    values.extend([i128::from(arc.is_some()), *quadrant, bits(curve), i128::from(speed)]);
    values
}

/// The whole number nearest to the square root of one that is not negative.
fn root(square: i128) -> i128 {
    let floor = square.isqrt();
    if square - floor * floor > floor { floor + 1 } else { floor }
}

/// 1 to 4: that of the displacement of a line, or that in which an arc begins, in its direction.
fn quadrant(curve: &Curve) -> i128 {
    if let Curve::Arc(arc) = curve {
        return i128::from(arc.start_quadrant().index()) + 1;
    }
    let delta = |axis: usize| {
        let [from, to] = [curve.from(), curve.to()].map(|point| point.get(axis).copied().unwrap_or(0));
        to - from
    };
    match (delta(0) < 0, delta(1) < 0) {
        (false, false) => 1,
        (true, false) => 2,
        (true, true) => 3,
        (false, true) => 4,
    }
}

/// Bits that the longest displacement of a line needs, or the largest coordinate of an arc about its centre.
fn bits(curve: &Curve) -> i128 {
    let largest = match curve {
        Curve::Arc(arc) => {
            let sectors = arc.sectors(Crossing::RoundedRadius);
            let ends = sectors.iter().flat_map(|sector| sector.start.into_iter().chain(sector.end));
            ends.map(i64::unsigned_abs).max()
        }
        _ => curve.from().iter().zip(curve.to()).map(|(from, to)| from.abs_diff(*to)).max(),
    };
    Width::needed_unsigned(largest.unwrap_or(0).into()).into()
}
