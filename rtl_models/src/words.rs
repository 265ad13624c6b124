//! The load words that several models share.

use stepwave_nc::{Arc, Conic, ConicSector, Crossing, Direction, Line, Sector};

use crate::hardware::Hardware;
use crate::machine::Words;
use crate::options::{END_POINT, EndPoint, Weights};
use crate::parts::{CCW, E, END, F, JR, JV, LONGEST, POSITION, QUAD, SIGN, XI_YI};
use crate::registers::{Reg, Rule};

/// Directions of the growth of both coordinates of a conic.
pub(crate) const GROWS: Reg<2> = Reg::each(["x_grows", "y_grows"], Rule::Bits(1), "the coordinate grows").hidden();

/// Quadrant and direction of a sector, and the position at its start.
pub(crate) fn sector(arc: &Arc, sector: &Sector) -> Words {
    let position = [0, 1].map(|axis| i128::from(arc.center()[axis]) + i128::from(sector.start[axis]));
    let ccw = arc.direction() == Direction::CounterClockwise;
    Words::new().set(QUAD, sector.quadrant.index()).set(CCW, ccw).set_each(POSITION.pair(), position)
}

/// Steps of a sector: of each axis, or of both.
pub(crate) fn end_counters(hardware: &Hardware, steps: [i64; 2]) -> Words {
    let words = Words::new();
    match hardware.get(&END_POINT) {
        EndPoint::PerAxis => words.set_each(END.pair(), steps),
        _ => words.set(E, i128::from(steps[0]) + i128::from(steps[1])),
    }
}

/// Integrands J_VX and J_VY, and the remainders.
pub(crate) fn integrators(hardware: &Hardware, integrands: [i128; 2]) -> Words {
    let remainders = [0, 1].map(|axis| hardware.preset(JR.of(axis)));
    Words::new().set_each(JV.pair(), integrands).set_each(JR.pair(), remainders)
}

/// Integrands of a sector of an arc, J_VX = |y| and J_VY = |x|, remainders, end counters, and [`sector`].
pub(crate) fn integrated_sector(hardware: &Hardware, arc: &Arc, at: &Sector) -> Words {
    let [x, y] = at.start.map(|c| i128::from(c.abs()));
    integrators(hardware, [y, x]).and(end_counters(hardware, at.steps())).and(sector(arc, at))
}

/// Blocks of a machine that judges every step of an arc: one where the hardware crosses the axes by itself, else one
/// for each sector.
pub(crate) fn judged_arc(hardware: &Hardware, arc: &Arc, crossing: Crossing) -> Vec<Words> {
    let sectors = arc.sectors(crossing);
    let begin = |at: &Sector| {
        let [x, y] = at.start.map(i128::from);
        let deviation = x * x + y * y - arc.radius_squared();
        Words::new().set(F, deviation).set_each(XI_YI, [x.abs(), y.abs()]).and(sector(arc, at))
    };
    if hardware.get(&END_POINT) == EndPoint::PerAxis {
        return sectors.iter().map(|sector| begin(sector).and(end_counters(hardware, sector.steps()))).collect();
    }
    // Counted to its end.
    let steps: i128 = sectors.iter().flat_map(Sector::steps).map(i128::from).sum();
    sectors.first().map(|first| begin(first).set(E, steps)).into_iter().collect()
}

/// The displacements |dx| and |dy| of a line in two axes, and the words of its directions and start.
pub(crate) fn line(line: &Line) -> ([i128; 2], Words) {
    let delta = [0, 1].map(|axis| i128::from(line.delta()[axis]));
    let start = [0, 1].map(|axis| line.from()[axis]);
    (delta.map(i128::abs), Words::new().set_each(SIGN.pair(), delta.map(|d| d < 0)).set_each(POSITION.pair(), start))
}

/// As [`line`], with the words of the long axis.
pub(crate) fn judged_line(at: &Line) -> ([i128; 2], Words) {
    let ([a, b], words) = line(at);
    ([a, b], words.set(LONGEST.of(0), a >= b).set(E, a.max(b)))
}

/// Directions and growth of a sector of a conic, and the position at its start.
pub(crate) fn conic_sector(conic: &Conic, sector: &ConicSector) -> Words {
    let position = [0, 1].map(|axis| i128::from(conic.center()[axis]) + i128::from(sector.start[axis]));
    let negative = sector.motion.map(|motion| motion < 0);
    Words::new().set_each(SIGN.pair(), negative).set_each(GROWS, sector.grows).set_each(POSITION.pair(), position)
}

/// F of comparison-integral at the start of a sector whose point has these interval weights: with `mid` the exact
/// `deviation` there, negated where an X step lowers it, and once more where Y is the base axis.
pub(crate) fn weighed(rule: Weights, [a, b]: [i128; 2], x_raises: bool, deviation: i128) -> i128 {
    let base_x = a < b;
    match rule {
        Weights::Mid if x_raises == base_x => deviation,
        Weights::Mid => -deviation,
        Weights::Pre | Weights::Post => 0,
    }
}
