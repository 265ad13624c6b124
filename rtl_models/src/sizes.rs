//! The size of a geometry, and the registers that several models plan alike.

use stepwave_nc::{Arc, Conic, ConicSector, Crossing, Line, Sector, Weight};
use stepwave_netlist::Width;

use crate::hardware::Pace;
use crate::options::{END_POINT, EndPoint};
use crate::parts::F;
use crate::plan::Plan;

/// Bits that a weight needs.
pub(crate) fn needed(weight: i128) -> u32 {
    Width::needed_unsigned(weight.unsigned_abs())
}

/// What the registers of a conic must hold.
pub(crate) struct ConicSize {
    /// Greatest value of the function given, at the ends of all sectors and on both axes.
    pub(crate) greatest: i128,
    /// Bits of the slopes of the weights of x and y.
    pub(crate) slopes: [u32; 2],
    /// Bits of the steps of one axis in a sector.
    pub(crate) steps: u32,
    /// Positions of each axis.
    pub(crate) positions: [Vec<i64>; 2],
}

impl ConicSize {
    /// Of a conic; `value` gives what a register holds at a magnitude on an axis of this weight.
    pub(crate) fn of(conic: &Conic, value: impl Fn(Weight, i64) -> i128) -> ConicSize {
        let (sectors, weights, center) = (conic.sectors(), conic.weights(), conic.center());
        let ends = || sectors.iter().flat_map(|sector| [sector.start, sector.end]);
        let values = ends().flat_map(|end| [0, 1].map(|axis| value(weights[axis], end[axis].abs())));
        let steps = sectors.iter().flat_map(ConicSector::steps).max().unwrap_or(0);
        ConicSize {
            greatest: values.max().unwrap_or(0),
            slopes: weights.map(|weight| needed(weight.slope)),
            steps: needed(steps.into()),
            positions: [0, 1].map(|axis| ends().map(|end| center[axis] + end[axis]).collect()),
        }
    }
}

/// Largest coordinate relative to the centre on the sectors of an arc.
pub(crate) fn largest_coordinate(sectors: &[Sector]) -> u64 {
    sectors
        .iter()
        .flat_map(|sector| sector.start.into_iter().chain(sector.end))
        .map(i64::unsigned_abs)
        .max()
        .unwrap_or(0)
}

/// Displacement of the longest axis of a line.
pub(crate) fn longest(line: &Line) -> u64 {
    longest_of(&line.delta())
}

/// The greatest of these displacements.
pub(crate) fn longest_of(delta: &[i64]) -> u64 {
    delta.iter().map(|d| d.unsigned_abs()).max().unwrap_or(0)
}

/// The longest axis of a line, of equal ones the first.
pub(crate) fn first_longest(line: &Line) -> usize {
    let longest = longest(line);
    line.delta().iter().position(|d| d.unsigned_abs() == longest).unwrap_or(0)
}

/// The longest axis of a line, of equal ones the last.
pub(crate) fn last_longest(line: &Line) -> usize {
    let longest = longest(line);
    line.delta().iter().rposition(|d| d.unsigned_abs() == longest).unwrap_or(0)
}

/// How far a path of this many axes is from its line at most, in BLU, where each but the longest axis is at most 1 BLU from
/// its place.
pub(crate) fn across(axes: usize) -> f64 {
    (axes.saturating_sub(1) as f64).sqrt()
}

/// Positions of each axis at the ends of a line.
pub(crate) fn end_positions(line: &Line) -> impl Iterator<Item = [i64; 2]> {
    line.from().iter().zip(line.to()).map(|(&from, &to)| [from, to])
}

/// Positions of x and y at the ends of all sectors of an arc, in machine coordinates.
pub(crate) fn arc_positions(arc: &Arc, sectors: &[Sector]) -> [Vec<i64>; 2] {
    let center = arc.center();
    let ends = || sectors.iter().flat_map(|sector| [sector.start, sector.end]);
    [0, 1].map(|axis| ends().map(|end| center[axis] + end[axis]).collect())
}

/// The n of a deviation register, where that of magnitudes is planned. Forced steps lead to an end off the circle,
/// where F is up to twice the radius, which may need a bit more than the coordinates between both ends.
pub(crate) fn off_circle_bits(arc: &Arc, plan: &Plan) -> u32 {
    plan.n.max(plan.magnitude_bits(off_circle_radius(arc)))
}

/// The radius of an arc whose end lies off the circle, in whole BLU, rounded up; 0 of others.
pub(crate) fn off_circle_radius(arc: &Arc) -> u64 {
    // Within 2^53.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    if arc.ends_on_circle() { 0 } else { arc.radius().ceil() as u64 }
}

/// Plans hardware that judges every step of an arc by its deviation: `f` has this many more bits than the largest
/// coordinate (where the end point is on the circle, and where it is off it).
pub(crate) fn judged_arc(arc: &Arc, plan: &mut Plan, crossing: Crossing, deviation: [u32; 2]) {
    let on_circle = arc.ends_on_circle();
    plan.decide(&END_POINT, if on_circle { EndPoint::Total } else { EndPoint::PerAxis });
    let sectors = arc.sectors(crossing);
    plan.n = plan.magnitude_bits(largest_coordinate(&sectors));
    plan.set(F, off_circle_bits(arc, plan) + deviation[usize::from(!on_circle)]);
    plan.positions(arc_positions(arc, &sectors));
}

/// Plans hardware that decides at every step of a line whether it takes the long axis alone.
pub(crate) fn judged_line(line: &Line, plan: &mut Plan) {
    plan.n = plan.magnitude_bits(longest(line));
    plan.positions(end_positions(line));
    plan.fix(&END_POINT, EndPoint::Longest);
    plan.pace = Pace::Longest;
}
