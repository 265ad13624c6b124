//! Digital differential analyser: per step each integrator adds its integrand J_V to its remainder
//! J_R modulo 2^n, and the overflow is the pulse of its axis.

use super::arc_geometry::{ArcKind, Sector, nearest_radius, radius_squared, sectors};
use super::{AXES, EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a straight line in 2 to 6 axes, in BLU, with `n`-bit integrators.
///
/// J_V = |d| (times 2^Q, with Q the largest shift that fits `n` bits, when `normalize`), J_R starts
/// at the `preset` of its axis. A block has at most 2^(n-Q) iterations.
///
/// The columns are `jvx`, `jrx`, `jvy`, `jry`, …, then `e` or `ex`, `ey`, …, then `dx`, `dy`, …,
/// then `x`, `y`, ….
///
/// - `Iterations`: `e` counts 2^(n-Q) down by one an iteration.
/// - `Total`: `e` counts the pulses of all axes.
/// - `Longest`: `e` counts the pulses of the longest axis, of the first one on a tie.
/// - `PerAxis`: an axis without pulses left adds no more, and its J_R freezes.
///
/// A line of zero length is not normalised; it is done at once but for `Iterations`, which runs 2^n
/// empty ones.
///
/// Source: the method of digital integration (DDA), straight line.
///
/// # Panics
/// When the slices differ in length, a |d| or a preset does not fit `n` bits, or `n` > 60.
pub(crate) fn dda_line(n: u32, from: &[i64], to: &[i64], preset: &[i64], normalize: bool, end: EndPoint) -> Table {
    let axes = from.len();
    assert!((2..=AXES.len()).contains(&axes), "2 to 6 axes");
    assert!(to.len() == axes && preset.len() == axes, "one value per axis");
    let modulus = modulus(n);
    assert_presets(preset, modulus);

    let d: Vec<i64> = (0..axes).map(|axis| to[axis] - from[axis]).collect();
    let length: Vec<i64> = d.iter().map(|d| d.abs()).collect();
    let longest = (0..axes).rev().max_by_key(|&axis| length[axis]);
    let longest = longest.expect("at least two axes");
    assert!(length[longest] < modulus, "2^n must exceed every |d|");

    let mut unit = 1;
    while normalize && length[longest] > 0 && length[longest] * unit < modulus / 2 {
        unit *= 2;
    }
    let jv: Vec<i64> = length.iter().map(|length| length * unit).collect();
    let mut jr = preset.to_vec();
    let mut position = from.to_vec();
    let mut left = match end {
        EndPoint::Total => vec![length.iter().sum()],
        EndPoint::PerAxis => length.clone(),
        EndPoint::Longest => vec![length[longest]],
        EndPoint::Iterations => vec![modulus / unit],
    };

    let mut columns: Vec<String> =
        AXES[..axes].iter().flat_map(|axis| [format!("jv{axis}"), format!("jr{axis}")]).collect();
    columns.extend(counter_columns(end, axes));
    columns.extend(per_axis_columns("d", axes));
    columns.extend(per_axis_columns("", axes));
    let mut table = Table::new(columns);

    let mut pulse = vec![0; axes];
    table.push(&[&interleave(&jv, &jr), &left, &pulse, &position]);
    for _ in 0..modulus / unit {
        if left.iter().all(|&count| count == 0) {
            break;
        }
        let mut pulses = 0;
        for axis in 0..axes {
            let adds = end != EndPoint::PerAxis || left[axis] > 0;
            let sum = jr[axis] + if adds { jv[axis] } else { 0 };
            let carry = sum / modulus;
            jr[axis] = sum % modulus;
            pulse[axis] = carry * d[axis].signum();
            position[axis] += pulse[axis];
            pulses += carry;
            match end {
                EndPoint::PerAxis => left[axis] -= carry,
                EndPoint::Longest if axis == longest => left[0] -= carry,
                _ => (),
            }
        }
        match end {
            EndPoint::Total => left[0] = (left[0] - pulses).max(0),
            EndPoint::Iterations => left[0] -= 1,
            EndPoint::PerAxis | EndPoint::Longest => (),
        }
        table.push(&[&interleave(&jv, &jr), &left, &pulse, &position]);
    }
    table.finished = left.iter().all(|&count| count == 0);
    table
}

/// The step table of a circular arc, in BLU, with `n`-bit integrators; R² is that of the start
/// point, and an end point equal to the start point is a full circle.
///
/// J_VX = |y| and J_VY = |x| relative to the centre (times 2^Q, when `normalize`, so that the larger
/// one has its second highest bit set, or its highest). Both integrators add in the same step with
/// the old J_V; then an X pulse corrects J_VY and a Y pulse J_VX, by +2^Q when the magnitude of that
/// coordinate grows and by -2^Q when it shrinks.
///
/// The arc is split at the axes, which it crosses at R rounded to the nearest integer. Each sector
/// loads J_V, Q, J_R (the `preset`), the end counters and the quadrant; the row that finishes a
/// sector shows the old registers, the next row is the first step of the next sector.
///
/// The columns are `jvx`, `jvy`, `jrx`, `jry`, `unit` (2^Q), `quad` (0 ..= 3), then `e` or `ex`,
/// `ey`, then `dx`, `dy`, `x`, `y`.
///
/// - `PerAxis`: an axis without pulses left adds no more, and its J_R freezes; its J_V still follows
///   the other axis.
/// - `Total`: both integrators add until all pulses were counted; only for arcs of one sector.
///
/// A table that is not `finished` either shows an arc that hangs (no pulse in 2^n + 1 steps, after
/// which nothing can change any more) or ends before a J_V leaves 0 ..= 2^n - 1 (`overflow`).
///
/// Source: the method of digital integration (DDA), circular arc, kinds SR1–SR4 and NR1–NR4.
///
/// # Panics
/// With [`EndPoint::Longest`] and [`EndPoint::Iterations`]; with `Total` across an axis; when a
/// coordinate of the arc or a preset does not fit `n` bits, or `n` > 60; with R = 0; with an end
/// point that the last sector cannot reach.
#[expect(clippy::too_many_arguments, reason = "each one is a register or a switch of the method")]
pub(crate) fn dda_arc(
    n: u32,
    from: [i64; 2],
    to: [i64; 2],
    center: [i64; 2],
    clockwise: bool,
    preset: [i64; 2],
    normalize: bool,
    end: EndPoint,
) -> Table {
    let start = [from[0] - center[0], from[1] - center[1]];
    let target = [to[0] - center[0], to[1] - center[1]];
    let crossing = nearest_radius(radius_squared(start));
    let list = sectors(start, target, clockwise, [crossing; 2]);
    let modulus = modulus(n);
    assert_presets(&preset, modulus);
    for coordinate in list.iter().flat_map(|sector| [sector.from, sector.to]) {
        let largest = coordinate[0].abs().max(coordinate[1].abs());
        assert!(largest < modulus, "2^n must exceed every coordinate");
    }
    assert!(
        end == EndPoint::PerAxis || (end == EndPoint::Total && list.len() == 1),
        "{end:?} does not tell the end of this arc"
    );

    let registers = ["jvx", "jvy", "jrx", "jry", "unit", "quad"];
    let mut columns: Vec<String> = registers.map(str::to_owned).into();
    columns.extend(counter_columns(end, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    for (index, sector) in list.iter().enumerate() {
        let mut state = ArcState::load(sector, preset, modulus, normalize, end);
        if index == 0 {
            table.push(&state.row(center, [0, 0]).each_ref().map(Vec::as_slice));
        }
        let mut idle = 0;
        while state.left.iter().any(|&count| count > 0) {
            let carry = state.iterate(modulus, end);
            if state.jv.iter().any(|jv| !(0..modulus).contains(jv)) {
                table.overflow = true;
                return table;
            }
            table.push(&state.row(center, carry).each_ref().map(Vec::as_slice));
            idle = if carry == [0, 0] { idle + 1 } else { 0 };
            if idle > modulus {
                return table;
            }
        }
    }
    table.finished = true;
    table
}

/// The registers of an arc inside one sector.
struct ArcState {
    /// The quadrant and the sense of rotation.
    kind: ArcKind,
    /// J_VX = 2^Q·|y|, J_VY = 2^Q·|x|.
    jv: [i64; 2],
    /// J_RX, J_RY.
    jr: [i64; 2],
    /// 2^Q.
    unit: i64,
    /// The end counters.
    left: Vec<i64>,
    /// The position relative to the centre.
    point: [i64; 2],
}

impl ArcState {
    /// What the loader writes at the start of a sector.
    fn load(sector: &Sector, preset: [i64; 2], modulus: i64, normalize: bool, end: EndPoint) -> Self {
        let [x, y] = sector.from;
        let largest = x.abs().max(y.abs());
        let mut unit = 1;
        // Until the larger J_V is at least 2^(n-2): its second highest bit, or its highest, is set.
        while normalize && 4 * largest * unit < modulus {
            unit *= 2;
        }
        let [dx, dy] = sector.distance();
        ArcState {
            kind: sector.kind,
            jv: [y.abs() * unit, x.abs() * unit],
            jr: preset,
            unit,
            left: match end {
                EndPoint::PerAxis => vec![dx, dy],
                _ => vec![dx + dy],
            },
            point: sector.from,
        }
    }

    /// One iteration; returns the carries of the two integrators.
    fn iterate(&mut self, modulus: i64, end: EndPoint) -> [i64; 2] {
        // All integrators add with the old J_V.
        let mut carry = [0, 0];
        for (axis, carry) in carry.iter_mut().enumerate() {
            if end != EndPoint::PerAxis || self.left[axis] > 0 {
                let sum = self.jr[axis] + self.jv[axis];
                *carry = sum / modulus;
                self.jr[axis] = sum % modulus;
            }
        }
        // A pulse moves its coordinate, which is the integrand of the other axis.
        for (axis, carry) in carry.into_iter().enumerate() {
            self.point[axis] += carry * self.kind.travel()[axis];
            if axis == self.kind.growing() {
                self.jv[1 - axis] += carry * self.unit;
            } else {
                self.jv[1 - axis] -= carry * self.unit;
            }
        }
        if end == EndPoint::PerAxis {
            self.left[0] -= carry[0];
            self.left[1] -= carry[1];
        } else {
            self.left[0] = (self.left[0] - carry[0] - carry[1]).max(0);
        }
        carry
    }

    /// The groups of a row.
    fn row(&self, center: [i64; 2], carry: [i64; 2]) -> [Vec<i64>; 4] {
        let travel = self.kind.travel();
        [
            [&self.jv[..], &self.jr, &[self.unit, self.kind.quadrant]].concat(),
            self.left.clone(),
            vec![carry[0] * travel[0], carry[1] * travel[1]],
            vec![center[0] + self.point[0], center[1] + self.point[1]],
        ]
    }
}

/// 2^n, one more than the largest value of an `n`-bit register.
fn modulus(n: u32) -> i64 {
    assert!((1..=60).contains(&n), "1 to 60 bits");
    1 << n
}

/// Every preset is a value of an `n`-bit register.
fn assert_presets(preset: &[i64], modulus: i64) {
    for preset in preset {
        assert!((0..modulus).contains(preset), "a preset has n bits");
    }
}

/// `jvx`, `jrx`, `jvy`, `jry`, ….
fn interleave(jv: &[i64], jr: &[i64]) -> Vec<i64> {
    jv.iter().zip(jr).flat_map(|(&v, &r)| [v, r]).collect()
}
