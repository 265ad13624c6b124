//! Free curves by forward differences. The exact table comes from the curve itself, by its basis functions in whole
//! numbers; no difference is summed up for it.

use super::{Table, per_axis_columns};

/// What the points of a segment mean.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Basis {
    Bezier,
    Hermite,
    CatmullRom,
    BSpline,
}

/// A segment: its basis, and its three or four points.
pub(crate) type Segment = (Basis, Vec<[i64; 2]>);

/// D·N³ times an axis of a segment at u = i/N; D is 1, 2 or 6. Any i will do.
fn value((basis, points): &Segment, axis: usize, i: i128, steps: i128) -> i128 {
    let (u, v, n) = (i, steps - i, steps);
    let p = |index: usize| i128::from(points[index][axis]);
    match (basis, points.len()) {
        (Basis::Bezier, 3) => (p(0) * v * v + 2 * p(1) * u * v + p(2) * u * u) * n,
        (Basis::Bezier, _) => p(0) * v * v * v + 3 * p(1) * u * v * v + 3 * p(2) * u * u * v + p(3) * u * u * u,
        (Basis::Hermite, _) => {
            let (u2, u3, n2, n3) = (u * u, u * u * u, n * n, n * n * n);
            p(0) * (2 * u3 - 3 * u2 * n + n3)
                + p(1) * (u3 - 2 * u2 * n + u * n2)
                + p(2) * (3 * u2 * n - 2 * u3)
                + p(3) * (u3 - u2 * n)
        }
        (Basis::CatmullRom, _) => {
            let (u2, u3, n2, n3) = (u * u, u * u * u, n * n, n * n * n);
            p(0) * (2 * u2 * n - u3 - u * n2)
                + p(1) * (3 * u3 - 5 * u2 * n + 2 * n3)
                + p(2) * (4 * u2 * n - 3 * u3 + u * n2)
                + p(3) * (u3 - u2 * n)
        }
        (Basis::BSpline, _) => {
            let (u2, u3, n2, n3) = (u * u, u * u * u, n * n, n * n * n);
            p(0) * v * v * v
                + p(1) * (3 * u3 - 6 * u2 * n + 4 * n3)
                + p(2) * (3 * u2 * n - 3 * u3 + 3 * u * n2 + n3)
                + p(3) * u3
        }
    }
}

fn divisor(basis: Basis) -> i128 {
    match basis {
        Basis::Bezier | Basis::Hermite => 1,
        Basis::CatmullRom => 2,
        Basis::BSpline => 6,
    }
}

/// D·N³, of which a BLU is made in steps of 1/N.
fn modulus(segment: &Segment, s: u32) -> i128 {
    divisor(segment.0) << (3 * s)
}

/// p, q and r of an axis after i steps.
fn differences(segment: &Segment, axis: usize, i: i128, s: u32) -> [i128; 3] {
    let [v0, v1, v2, v3] = [0, 1, 2, 3].map(|ahead| value(segment, axis, i + ahead, 1 << s));
    [v1 - v0, v2 - 2 * v1 + v0, v3 - 3 * v2 + 3 * v1 - v0]
}

/// The first step, from 0 on, in which an axis of one of the segments would make more than a pulse.
pub(crate) fn spline_owes(segments: &[Segment], s: u32) -> Option<(usize, i128)> {
    let all = segments.iter().enumerate().flat_map(|(index, segment)| (0..1 << s).map(move |i| (index, segment, i)));
    all.into_iter().find_map(|(index, segment, i)| {
        let owes = (0..2).any(|axis| differences(segment, axis, i, s)[0].abs() > modulus(segment, s));
        owes.then_some((index, i))
    })
}

fn narrow(value: i128) -> i64 {
    i64::try_from(value).expect("small curves")
}

fn table() -> Table {
    let columns = ["jr", "p", "q", "r"].map(|name| per_axis_columns(name, 2)).concat();
    Table::new([columns, vec!["e".to_owned()], per_axis_columns("d", 2), per_axis_columns("", 2)].concat())
}

/// The step table of a chain of segments in 2^s steps each, in 1/M BLU, M = D·2^(3s): after every step an axis is at its
/// place rounded to whole BLU, halves upwards, and jr is what the rounding left.
///
/// The columns are `jrx`, `jry`, `px`, …, `e` (steps left), `dx`, `dy`, `x`, `y`.
///
/// Source: forward differences of polynomials.
pub(crate) fn spline_dda(segments: &[Segment], s: u32) -> Table {
    let mut table = table();
    let mut position: Option<[i64; 2]> = None;
    for segment in segments {
        let modulus = modulus(segment, s);
        for i in 0..=1_i128 << s {
            let ahead = [0, 1].map(|axis| value(segment, axis, i, 1 << s) + modulus / 2);
            let place = ahead.map(|ahead| narrow(ahead.div_euclid(modulus)));
            let before = position.replace(place).unwrap_or(place);
            if i == 0 && !table.rows.is_empty() {
                assert_eq!(before, place, "segments meet");
                continue;
            }
            let difference = |order: usize| [0, 1].map(|axis| narrow(differences(segment, axis, i, s)[order]));
            let rest = ahead.map(|ahead| narrow(ahead.rem_euclid(modulus)));
            let pulse = [place[0] - before[0], place[1] - before[1]];
            let [p, q, r] = [0, 1, 2].map(difference);
            table.push(&[&rest, &p, &q, &r, &[narrow((1 << s) - i)], &pulse, &place]);
        }
    }
    table.finished = true;
    table
}

/// The same with registers of `bits` bits of fraction: start and differences rounded, halves upwards, then summed up.
pub(crate) fn spline_dda_fraction(segments: &[Segment], s: u32, bits: u32) -> Table {
    let mut table = table();
    let one = 1_i128 << bits;
    let mut position = [0, 1].map(|axis| {
        let (start, modulus) = (value(&segments[0], axis, 0, 1 << s), modulus(&segments[0], s));
        ((2 * start * one + modulus).div_euclid(2 * modulus) + one / 2).div_euclid(one)
    });
    for segment in segments {
        let modulus = modulus(segment, s);
        let round = |value: i128| (2 * value * one + modulus).div_euclid(2 * modulus);
        let mut rest = [0, 1].map(|axis| (round(value(segment, axis, 0, 1 << s)) + one / 2).rem_euclid(one));
        let mut axes = [0, 1].map(|axis| differences(segment, axis, 0, s).map(round));
        for i in 0..=1_i128 << s {
            let mut pulses = [0; 2];
            if i > 0 {
                for (axis, [p, q, r]) in axes.iter_mut().enumerate() {
                    let sum = rest[axis] + *p;
                    (pulses[axis], rest[axis]) = (sum.div_euclid(one), sum.rem_euclid(one));
                    position[axis] += pulses[axis];
                    (*p, *q) = (*p + *q, *q + *r);
                }
            } else if !table.rows.is_empty() {
                continue;
            }
            let column = |order: usize| axes.map(|axis| narrow(axis[order]));
            let (rest, pulses, position) = (rest.map(narrow), pulses.map(narrow), position.map(narrow));
            table.push(&[&rest, &column(0), &column(1), &column(2), &[narrow((1 << s) - i)], &pulses, &position]);
        }
    }
    table.finished = true;
    table
}
