//! Comparison-integral method: the axis with the smaller interval, the base, steps every time; the
//! sign of F says whether the other axis steps too.

use super::arc_geometry::{nearest_radius, radius_squared, sectors};
use super::conic_geometry::{Curve, Piece, Shape, Term, pieces};
use super::{Table, per_axis_columns};

/// Which value of a weight a pulse adds to F.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weights {
    /// The sum of the weight before the pulse and the one after it: F has twice the scale.
    Mid,
    /// The weight before the pulse.
    Pre,
    /// The weight after the pulse.
    Post,
}

/// The step table of a straight line, in BLU: the weights are A = |dy|, B = |dx|, and never change.
///
/// Columns as in [`cim_arc`].
///
/// Source: the comparison-integral method, straight line.
pub(crate) fn cim_line(from: [i64; 2], to: [i64; 2]) -> Table {
    let d = [to[0] - from[0], to[1] - from[1]];
    let travel = d.map(i64::signum);
    // With the scale 2 the weight of a linear term is its factor.
    let curve = Curve { terms: [Term::Linear(-d[1].abs()), Term::Linear(d[0].abs())], constant: 0, scale: 2 };
    let piece = Piece { from: [0, 0], to: d, side: travel, travel };
    run(&curve, &[piece], from, Weights::Pre)
}

/// The step table of a circular arc, in BLU; R² is that of the start point, and an end point equal
/// to the start point is a full circle.
///
/// A = |x| is the weight of an X pulse, B = |y| that of a Y pulse. The base is the axis with the
/// smaller weight; of two equal ones Y at the load, later the one that it has been. The base steps
/// every time, the other axis when `F >= 0`. F gains the weight of the base's pulse and loses that
/// of the other's; when the base changes, F changes its sign. An axis without pulses left is
/// inhibited, and the other one forced.
///
/// The arc is split at the axes, which it crosses at R rounded to the nearest integer, or at the
/// point that it has reached already, where this lies farther out. Each sector loads A, B, the base
/// and the end counters, and F: 0, but with [`Weights::Mid`] the exact deviation x² + y² - R² of its
/// start, with the sign that F has there. The row that finishes a sector shows the old registers,
/// the next row is the first step of the next sector.
///
/// The columns are `f`, `a`, `b`, `base` (0 for X, 1 for Y), `ex`, `ey`, `dx`, `dy`, `x`, `y`; all of
/// them after the step, a change of the base included.
///
/// Source: the comparison-integral method, circular arc.
///
/// # Panics
/// With R = 0; with an end point that the last sector cannot reach.
pub(crate) fn cim_arc(from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool, weights: Weights) -> Table {
    let start = [from[0] - center[0], from[1] - center[1]];
    let target = [to[0] - center[0], to[1] - center[1]];
    let r2 = radius_squared(start);
    let curve = Curve { terms: [Term::Square(1); 2], constant: -r2, scale: 1 };
    let list = sectors(start, target, clockwise, [nearest_radius(r2); 2]);
    let list: Vec<Piece> = list.iter().map(Piece::of).collect();
    run(&curve, &list, from, weights)
}

/// The step table of a conic, in BLU.
///
/// The weights are half the slopes of the implicit function G, b²|x| and a²|y|; for a parabola the
/// slopes themselves, c and 2|y|, so that F with [`Weights::Mid`] is twice G there. The curve is
/// split at its semi-axes, or at its vertex. All else is as for [`cim_arc`].
///
/// Source: the comparison-integral method, curves of second order.
///
/// # Panics
/// With an end point that cannot be reached.
pub(crate) fn cim_conic(
    shape: Shape,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    weights: Weights,
) -> Table {
    let local = |[x, y]: [i64; 2]| [x - center[0], y - center[1]];
    let list = pieces(shape, local(from), local(to), clockwise);
    run(&Curve::of(shape), &list, from, weights)
}

/// All pieces of a curve, one after the other.
fn run(curve: &Curve, list: &[Piece], from: [i64; 2], weights: Weights) -> Table {
    let mut columns: Vec<String> = ["f", "a", "b", "base"].map(str::to_owned).into();
    columns.extend(per_axis_columns("e", 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    let mut position = from;
    for (index, piece) in list.iter().enumerate() {
        let mut state = PieceRegisters::load(curve, piece, weights);
        if index == 0 {
            table.push(&[&state.registers(), &[0, 0], &position]);
        }
        while state.left != [0, 0] {
            let pulse = state.step(curve, piece, weights);
            position[0] += pulse[0];
            position[1] += pulse[1];
            table.push(&[&state.registers(), &pulse, &position]);
        }
    }
    table.finished = true;
    table
}

/// The registers of one piece.
struct PieceRegisters {
    /// The comparison value.
    f: i64,
    /// A and B.
    weight: [i64; 2],
    /// The axis with the smaller interval.
    base: usize,
    /// The end counters.
    left: [i64; 2],
}

impl PieceRegisters {
    /// What the loader writes at the start of a piece.
    fn load(curve: &Curve, piece: &Piece, weights: Weights) -> Self {
        let weight = [curve.weight(0, piece.from[0]), curve.weight(1, piece.from[1])];
        let base = usize::from(weight[0] >= weight[1]);
        let deviation = curve.scale * curve.value(piece.from);
        let f = match weights {
            // The base's pulses raise F.
            Weights::Mid if curve.raises(base, piece) => deviation,
            Weights::Mid => -deviation,
            Weights::Pre | Weights::Post => 0,
        };
        PieceRegisters { f, weight, base, left: piece.distance() }
    }

    /// One step; returns the pulses.
    fn step(&mut self, curve: &Curve, piece: &Piece, weights: Weights) -> [i64; 2] {
        let other = 1 - self.base;
        // Judge.
        let mut steps = [true; 2];
        steps[other] = self.f >= 0;
        for axis in 0..2 {
            if self.left[axis] == 0 {
                steps = [axis == 1, axis == 0];
            }
        }
        let mut pulse = [0, 0];
        for axis in (0..2).filter(|&axis| steps[axis]) {
            let before = self.weight[axis];
            let gain = curve.weight_gain(axis);
            let after = if piece.grows(axis) { before + gain } else { before - gain };
            let counted = match weights {
                Weights::Mid => before + after,
                Weights::Pre => before,
                Weights::Post => after,
            };
            self.f += if axis == self.base { counted } else { -counted };
            self.weight[axis] = after;
            self.left[axis] -= 1;
            pulse[axis] = piece.travel[axis];
        }
        // A tie keeps the base.
        if self.weight[other] < self.weight[self.base] {
            self.base = other;
            self.f = -self.f;
        }
        pulse
    }

    /// The registers, in the order of the columns.
    fn registers(&self) -> [i64; 6] {
        let base = if self.base == 0 { 0 } else { 1 };
        [self.f, self.weight[0], self.weight[1], base, self.left[0], self.left[1]]
    }
}
