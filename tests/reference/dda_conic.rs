//! Digital differential analyser along ellipses, parabolas and hyperbolas.

use super::conic_geometry::{Curve, Piece, Shape, pieces};
use super::{EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a conic, in BLU, with `n`-bit integrators.
///
/// J_VX is the weight of Y and J_VY the weight of X: half the slopes of the implicit function, so
/// J_VX = a²|y| and J_VY = b²|x|; for a parabola the slopes themselves, 2|y| and c. Both integrators
/// add in the same step with the old J_V; then a pulse corrects the other axis' J_V, upward when the
/// magnitude of its coordinate grows. When `normalize`, J_V and corrections are doubled together as
/// long as the largest of them on the piece, at its start or its end, stays below 2^n.
///
/// The curve is split at its semi-axes, or at its vertex. Each piece loads J_V, J_R (the `preset`)
/// and the end counters; the row that finishes a piece shows the old registers, the next row is the
/// first step of the next piece.
///
/// The columns are `jvx`, `jvy`, `jrx`, `jry`, `ux`, `uy` (the corrections of `jvx` and of `jvy`),
/// then `e` or `ex`, `ey`, then `dx`, `dy`, `x`, `y`.
///
/// - `PerAxis`: an axis without pulses left adds no more, and its J_R freezes; its J_V still follows
///   the other axis.
/// - `Total`: both integrators add until all pulses were counted; only for curves of one piece.
///
/// A table that is not `finished` either shows a curve that hangs (no pulse in 2^n + 1 steps, after
/// which nothing can change any more) or ends before a J_V leaves 0 ..= 2^n - 1 (`overflow`).
///
/// Source: the method of digital integration (DDA), curves of second order.
///
/// # Panics
/// When a J_V does not fit `n` bits where a piece starts, when a preset does not, or `n` > 60; with
/// an end point that cannot be reached; with [`EndPoint::Longest`] and [`EndPoint::Iterations`]; with
/// `Total` across an axis.
#[expect(clippy::too_many_arguments, reason = "each one is a register or a switch of the method")]
pub(crate) fn dda_conic(
    n: u32,
    shape: Shape,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    preset: [i64; 2],
    normalize: bool,
    end: EndPoint,
) -> Table {
    assert!((1..=60).contains(&n), "1 to 60 bits");
    let modulus = 1_i64 << n;
    assert!(preset.iter().all(|preset| (0..modulus).contains(preset)), "a preset has n bits");
    let curve = Curve::of(shape);
    let local = |[x, y]: [i64; 2]| [x - center[0], y - center[1]];
    let list = pieces(shape, local(from), local(to), clockwise);
    assert!(
        end == EndPoint::PerAxis || (end == EndPoint::Total && list.len() == 1),
        "{end:?} does not tell the end of this curve"
    );

    let mut columns: Vec<String> = ["jvx", "jvy", "jrx", "jry", "ux", "uy"].map(str::to_owned).into();
    columns.extend(counter_columns(end, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    let mut position = from;
    for (index, piece) in list.iter().enumerate() {
        let mut state = PieceRegisters::load(&curve, piece, preset, if normalize { modulus } else { 0 }, end);
        assert!(state.fits(modulus), "2^n must exceed every J_V");
        if index == 0 {
            table.push(&[&state.jv, &state.jr, &state.unit, &state.left, &[0, 0], &position]);
        }
        let mut idle = 0;
        while state.left.iter().any(|&count| count > 0) {
            let carry = state.iterate(piece, modulus, end);
            if !state.fits(modulus) {
                table.overflow = true;
                return table;
            }
            let pulse = [carry[0] * piece.travel[0], carry[1] * piece.travel[1]];
            position[0] += pulse[0];
            position[1] += pulse[1];
            table.push(&[&state.jv, &state.jr, &state.unit, &state.left, &pulse, &position]);
            idle = if carry == [0, 0] { idle + 1 } else { 0 };
            if idle > modulus {
                return table;
            }
        }
    }
    table.finished = true;
    table
}

/// The registers of one piece.
struct PieceRegisters {
    /// J_VX, J_VY.
    jv: [i64; 2],
    /// J_RX, J_RY.
    jr: [i64; 2],
    /// The corrections of J_VX and of J_VY.
    unit: [i64; 2],
    /// The end counters.
    left: Vec<i64>,
}

impl PieceRegisters {
    /// What the loader writes at the start of a piece, doubled as long as it stays below `limit`.
    fn load(curve: &Curve, piece: &Piece, preset: [i64; 2], limit: i64, end: EndPoint) -> Self {
        let jv = |[x, y]: [i64; 2]| [curve.weight(1, y), curve.weight(0, x)];
        let (start, unit) = (jv(piece.from), [curve.weight_gain(1), curve.weight_gain(0)]);
        let largest = [start, jv(piece.to), unit].concat().into_iter().fold(0, i64::max);
        let mut scale = 1;
        while 2 * scale * largest < limit {
            scale *= 2;
        }
        let [dx, dy] = piece.distance();
        PieceRegisters {
            jv: start.map(|jv| jv * scale),
            jr: preset,
            unit: unit.map(|unit| unit * scale),
            left: if end == EndPoint::PerAxis { vec![dx, dy] } else { vec![dx + dy] },
        }
    }

    /// True when every J_V is a value of its register.
    fn fits(&self, modulus: i64) -> bool {
        self.jv.iter().all(|jv| (0..modulus).contains(jv))
    }

    /// One iteration; returns the carries of the two integrators.
    fn iterate(&mut self, piece: &Piece, modulus: i64, end: EndPoint) -> [i64; 2] {
        // All integrators add with the old J_V.
        let mut carry = [0, 0];
        for (axis, carry) in carry.iter_mut().enumerate() {
            if end == EndPoint::Total || self.left[axis] > 0 {
                let sum = self.jr[axis] + self.jv[axis];
                *carry = sum / modulus;
                self.jr[axis] = sum % modulus;
            }
        }
        // A pulse moves its coordinate, of which the integrand of the other axis is a multiple.
        for (axis, carry) in carry.into_iter().enumerate() {
            let gain = carry * self.unit[1 - axis];
            self.jv[1 - axis] += if piece.grows(axis) { gain } else { -gain };
        }
        if end == EndPoint::Total {
            self.left[0] = (self.left[0] - carry[0] - carry[1]).max(0);
        } else {
            self.left[0] -= carry[0];
            self.left[1] -= carry[1];
        }
        carry
    }
}
