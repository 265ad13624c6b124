//! Digital differential analyser along a helix: an arc in X and Y and a third integrator for Z.

use super::arc_geometry::{ArcKind, Sector, nearest_radius, radius_squared, sectors};
use super::{Table, per_axis_columns};

/// The step table of a helix about an axis parallel to Z, in BLU.
///
/// X and Y are those of the arc with one counter per axis that is not normalised: `n`-bit
/// integrators, J_VX = |y|, J_VY = |x|. The integrator of Z has `n` + `fraction` bits and a J_V that
/// does not change; its carry is the Z pulse. `z_words` has J_VZ and the Z pulses of every sector,
/// as [`helix_words`] makes them. An axis without pulses left adds no more, and its J_R freezes; a
/// sector is done when all three are.
///
/// Each sector loads J_V, J_R (the `preset`), the end counters and the quadrant; the row that
/// finishes a sector shows the old registers, the next row is the first step of the next sector.
///
/// The columns are `jvx`, `jvy`, `jvz`, `jrx`, `jry`, `jrz`, `quad` (0 ..= 3), `ex`, `ey`, `ez`,
/// `dx`, `dy`, `dz`, `x`, `y`, `z`.
///
/// A table that is not `finished` ends with the row after which nothing can change any more: every
/// axis that has pulses left has J_V = 0.
///
/// Source: the method of digital integration (DDA), helix.
///
/// # Panics
/// When a coordinate, a word or a preset does not fit its register, or `n` + `fraction` > 60; when
/// there is not one word for each sector; with R = 0; with an end point that the last sector cannot
/// reach.
#[expect(clippy::too_many_arguments, reason = "each one is a register or a switch of the method")]
pub(crate) fn dda_helix(
    n: u32,
    fraction: u32,
    from: [i64; 3],
    to: [i64; 3],
    center: [i64; 2],
    clockwise: bool,
    z_words: &[(i64, i64)],
    preset: [i64; 3],
) -> Table {
    assert!(n >= 1 && n + fraction <= 60, "1 to 60 bits");
    let modulus = [1_i64 << n, 1 << n, 1 << (n + fraction)];
    let list = plane_sectors(from, to, center, clockwise);
    assert_eq!(list.len(), z_words.len(), "one word for each sector");
    for coordinate in list.iter().flat_map(|sector| [sector.from, sector.to]).flatten() {
        assert!(coordinate.abs() < modulus[0], "2^n must exceed every coordinate");
    }
    for (word, modulus) in preset.into_iter().zip(modulus) {
        assert!((0..modulus).contains(&word), "a preset fits its register");
    }
    let rise = (to[2] - from[2]).signum();

    let registers = ["jvx", "jvy", "jvz", "jrx", "jry", "jrz", "quad"];
    let mut columns: Vec<String> = registers.map(str::to_owned).into();
    for prefix in ["e", "d", ""] {
        columns.extend(per_axis_columns(prefix, 3));
    }
    let mut table = Table::new(columns);

    let mut position = from;
    for (index, (sector, &(jvz, ez))) in list.iter().zip(z_words).enumerate() {
        assert!((0..modulus[2]).contains(&jvz) && ez >= 0, "a word fits its register");
        // Load.
        let kind: ArcKind = sector.kind;
        let [x, y] = sector.from.map(i64::abs);
        let mut jv = [y, x, jvz];
        let mut jr = preset;
        let [ex, ey] = sector.distance();
        let mut left = [ex, ey, ez];
        let direction = [kind.travel()[0], kind.travel()[1], rise];
        if index == 0 {
            table.push(&[&jv, &jr, &[kind.quadrant], &left, &[0; 3], &position]);
        }
        while left != [0; 3] {
            if (0..3).all(|axis| left[axis] == 0 || jv[axis] == 0) {
                return table;
            }
            // All integrators add with the old J_V.
            let mut carry = [0; 3];
            for axis in (0..3).filter(|&axis| left[axis] > 0) {
                let sum = jr[axis] + jv[axis];
                carry[axis] = sum / modulus[axis];
                jr[axis] = sum % modulus[axis];
            }
            // A pulse of X or Y moves its coordinate, which is the integrand of the other.
            jv[1 - kind.growing()] += carry[kind.growing()];
            jv[1 - kind.shrinking()] -= carry[kind.shrinking()];
            let mut pulse = [0; 3];
            for axis in 0..3 {
                left[axis] -= carry[axis];
                pulse[axis] = carry[axis] * direction[axis];
                position[axis] += pulse[axis];
            }
            table.push(&[&jv, &jr, &[kind.quadrant], &left, &pulse, &position]);
        }
    }
    table.finished = true;
    table
}

/// J_VZ and the Z pulses of every sector of a helix.
///
/// An iteration turns the arc by 1/2^n radian, so J_VZ = |Z|/θ with θ the whole angle, in units of
/// 2^-`fraction`, rounded up. Up to the end of each sector Z makes its share |Z|·θ_i/θ, θ_i the
/// angle up to there, rounded to the nearest integer, halves up; at the end all of |Z|.
///
/// # Panics
/// As [`dda_helix`], for the arc.
pub(crate) fn helix_words(
    from: [i64; 3],
    to: [i64; 3],
    center: [i64; 2],
    clockwise: bool,
    fraction: u32,
) -> Vec<(i64, i64)> {
    let z = (to[2] - from[2]).abs();
    let list = plane_sectors(from, to, center, clockwise);
    let total: f64 = list.iter().map(angle).sum();
    let jvz = if z == 0 { 0 } else { to_integer((z as f64 / total * 2_f64.powi(fraction.cast_signed())).ceil()) };
    let (mut swept, mut made) = (0.0, 0);
    let mut words = Vec::new();
    for (index, sector) in list.iter().enumerate() {
        swept += angle(sector);
        let is_last = index + 1 == list.len();
        // What the angles lose to rounding must not turn a half down.
        let share = if is_last { z } else { to_integer((z as f64 * swept / total + 0.5 + 1e-9).floor()) };
        words.push((jvz, share - made));
        made = share;
    }
    words
}

/// The sectors of the arc in the plane of X and Y.
fn plane_sectors(from: [i64; 3], to: [i64; 3], center: [i64; 2], clockwise: bool) -> Vec<Sector> {
    let start = [from[0] - center[0], from[1] - center[1]];
    let target = [to[0] - center[0], to[1] - center[1]];
    sectors(start, target, clockwise, [nearest_radius(radius_squared(start)); 2])
}

/// The angle of a sector in radians, 0 ..= π/2.
fn angle(sector: &Sector) -> f64 {
    let ([x0, y0], [x1, y1]) = (sector.from, sector.to);
    let cross = x0 * y1 - y0 * x1;
    let dot = x0 * x1 + y0 * y1;
    (cross.abs() as f64).atan2(dot as f64)
}

/// An integer that a float holds exactly.
#[expect(clippy::cast_possible_truncation, reason = "the value is an integer far below 2^63")]
fn to_integer(value: f64) -> i64 {
    value as i64
}
