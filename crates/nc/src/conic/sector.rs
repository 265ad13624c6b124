//! Splitting a conic at the axes through its centre or vertex.

use crate::exact::length;
use crate::{Conic, Opens, Quadrant, Shape};

/// A piece of a conic inside one quadrant; the points are relative to the centre or vertex, in BLU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ConicSector {
    /// Where it starts: the start point of the curve or a point on the axis that is crossed.
    pub start: [i64; 2],
    /// Where it ends: a point on the next axis or the end point of the curve.
    pub end: [i64; 2],
    /// The quadrant that the piece runs through.
    pub quadrant: Quadrant,
    /// The signs (+1 or -1) of the motion in x and in y.
    pub motion: [i64; 2],
    /// Whether |x| and whether |y| grows along the motion.
    pub grows: [bool; 2],
    /// Whether a step in x lowers [`Conic::implicit`]; a step in y then raises it, and vice versa.
    pub x_lowers: bool,
}

impl ConicSector {
    /// The number of steps of each axis from start to end, |Δx| and |Δy| in BLU.
    ///
    /// Differences beyond `i64` saturate; no sector of a [`Conic`] has one.
    #[must_use]
    pub fn steps(&self) -> [i64; 2] {
        [0, 1].map(|axis: usize| length(self.end[axis].abs_diff(self.start[axis]).into()))
    }

    /// Whether the motion leads from the start to the end.
    pub(super) fn reaches_its_end(&self) -> bool {
        (0..2).all(|axis| (self.end[axis] - self.start[axis]) * self.motion[axis] >= 0)
    }
}

pub(super) fn split(conic: &Conic) -> Vec<ConicSector> {
    match conic.shape() {
        Shape::Ellipse { semi_axes } => around(conic, semi_axes),
        Shape::Parabola { opens, .. } => open(conic, opens, 0),
        Shape::Hyperbola { semi_axes: [a, _], opens } => open(conic, opens, a),
    }
}

fn around(conic: &Conic, semi_axes: [i64; 2]) -> Vec<ConicSector> {
    let turn = conic.turn();
    let sector = |sector: crate::Sector| {
        let growing = sector.quadrant.growing_axis(turn.direction);
        ConicSector {
            start: sector.start,
            end: sector.end,
            quadrant: sector.quadrant,
            motion: sector.quadrant.motion(turn.direction),
            grows: [growing == 0, growing == 1],
            x_lowers: growing == 1,
        }
    };
    turn.sectors(semi_axes).into_iter().map(sector).collect()
}

/// The sectors of an open curve whose vertex lies at this place on its axis of symmetry.
///
/// Ends on different sides of that axis lie no nearer to the centre than the vertex, along the axis: the whole branch
/// lies at or beyond the vertex, so what does not is 1 BLU nearer, and then within 1 BLU of the curve only where it is
/// on the axis itself.
fn open(conic: &Conic, opens: Opens, vertex: i64) -> Vec<ConicSector> {
    let ends = [conic.start(), conic.end()].map(|point| opens.along_across(point));
    let [[from_along, from], [to_along, to]] = ends;
    if from.signum() * to.signum() < 0 {
        let middle = [vertex, 0];
        let [first, second] = [[ends[0], middle], [middle, ends[1]]];
        return vec![
            piece(conic.shape(), opens, first, from.signum(), false),
            piece(conic.shape(), opens, second, to.signum(), true),
        ];
    }
    let side = if from < 0 || to < 0 { -1 } else { 1 };
    let outward = to.abs() > from.abs() || to == from && to_along > from_along;
    vec![piece(conic.shape(), opens, ends, side, outward)]
}

/// One sector of an open curve on this side of its axis of symmetry; the points are along and across that axis.
fn piece(shape: Shape, opens: Opens, [start, end]: [[i64; 2]; 2], side: i64, outward: bool) -> ConicSector {
    let signs = opens.plane([1, side]);
    let quadrant = match signs {
        [1, 1] => Quadrant::I,
        [1, _] => Quadrant::IV,
        [_, 1] => Quadrant::II,
        _ => Quadrant::III,
    };
    // Outward, a parabola's step along its axis lowers the implicit function and a hyperbola's raises it.
    let along_lowers = matches!(shape, Shape::Parabola { .. }) == outward;
    ConicSector {
        start: opens.plane(start),
        end: opens.plane(end),
        quadrant,
        motion: signs.map(|sign| if outward { sign } else { -sign }),
        grows: [outward; 2],
        x_lowers: along_lowers == (opens.axis() == 0),
    }
}
