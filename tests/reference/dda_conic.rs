//! Digital differential analyser along ellipses, parabolas and hyperbolas.

use super::conic_geometry::{Curve, Piece, Shape, pieces};
use super::{Table, per_axis_columns};

/// The step table of a conic, in BLU, with `n`-bit integrators.
///
/// J_VX is the weight of Y and J_VY the weight of X: half the slopes of the implicit function, so
/// J_VX = a²|y| and J_VY = b²|x|; for a parabola the slopes themselves, 2|y| and c. Both integrators
/// add in the same step with the old J_V; then a pulse corrects the other axis' J_V, upward when the
/// magnitude of its coordinate grows. An axis without pulses left adds no more, and its J_R freezes.
///
/// The curve is split at its semi-axes, or at its vertex. Each piece loads J_V, J_R (the `preset`)
/// and the end counters; the row that finishes a piece shows the old registers, the next row is the
/// first step of the next piece.
///
/// The columns are `jvx`, `jvy`, `jrx`, `jry`, `ex`, `ey`, `dx`, `dy`, `x`, `y`.
///
/// A table that is not `finished` either shows a curve that hangs (no pulse in 2^n + 1 steps, after
/// which nothing can change any more) or ends before a J_V leaves 0 ..= 2^n - 1 (`overflow`).
///
/// Source: the method of digital integration (DDA), curves of second order.
///
/// # Panics
/// When a J_V does not fit `n` bits where a piece starts, when a preset does not, or `n` > 60; with
/// an end point that cannot be reached.
pub(crate) fn dda_conic(
    n: u32,
    shape: Shape,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    preset: [i64; 2],
) -> Table {
    assert!((1..=60).contains(&n), "1 to 60 bits");
    let modulus = 1_i64 << n;
    assert!(preset.iter().all(|preset| (0..modulus).contains(preset)), "a preset has n bits");
    let curve = Curve::of(shape);
    let local = |[x, y]: [i64; 2]| [x - center[0], y - center[1]];
    let list = pieces(shape, local(from), local(to), clockwise);

    let mut columns: Vec<String> = ["jvx", "jvy", "jrx", "jry"].map(str::to_owned).into();
    columns.extend(per_axis_columns("e", 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    let mut position = from;
    for (index, piece) in list.iter().enumerate() {
        let mut state = State::load(&curve, piece, preset);
        assert!(state.fits(modulus), "2^n must exceed every J_V");
        if index == 0 {
            table.push(&[&state.jv, &state.jr, &state.left, &[0, 0], &position]);
        }
        let mut idle = 0;
        while state.left != [0, 0] {
            let carry = state.iterate(&curve, piece, modulus);
            if !state.fits(modulus) {
                table.overflow = true;
                return table;
            }
            let pulse = [carry[0] * piece.travel[0], carry[1] * piece.travel[1]];
            position[0] += pulse[0];
            position[1] += pulse[1];
            table.push(&[&state.jv, &state.jr, &state.left, &pulse, &position]);
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
struct State {
    /// J_VX, J_VY.
    jv: [i64; 2],
    /// J_RX, J_RY.
    jr: [i64; 2],
    /// The end counters.
    left: [i64; 2],
}

impl State {
    /// What the loader writes at the start of a piece.
    fn load(curve: &Curve, piece: &Piece, preset: [i64; 2]) -> Self {
        let [x, y] = piece.from;
        State { jv: [curve.weight(1, y), curve.weight(0, x)], jr: preset, left: piece.distance() }
    }

    /// True when every J_V is a value of its register.
    fn fits(&self, modulus: i64) -> bool {
        self.jv.iter().all(|jv| (0..modulus).contains(jv))
    }

    /// One iteration; returns the carries of the two integrators.
    fn iterate(&mut self, curve: &Curve, piece: &Piece, modulus: i64) -> [i64; 2] {
        // All integrators add with the old J_V.
        let mut carry = [0, 0];
        for (axis, carry) in carry.iter_mut().enumerate() {
            if self.left[axis] > 0 {
                let sum = self.jr[axis] + self.jv[axis];
                *carry = sum / modulus;
                self.jr[axis] = sum % modulus;
                self.left[axis] -= *carry;
            }
        }
        // A pulse moves its coordinate, of which the integrand of the other axis is a multiple.
        for (axis, carry) in carry.into_iter().enumerate() {
            let gain = carry * curve.weight_gain(axis);
            self.jv[1 - axis] += if piece.grows(axis) { gain } else { -gain };
        }
        carry
    }
}
