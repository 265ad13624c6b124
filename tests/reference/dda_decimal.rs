//! Digital differential analyser in radix 10: straight lines.

use super::{AXES, EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a straight line in 2 to 6 axes, in BLU, with decimal integrators of `digits`
/// digits.
///
/// J_V = |d|, J_R starts at the `preset` of its axis. Each of the 10^`digits` iterations adds J_V to
/// J_R modulo 10^`digits`; the carry is the pulse.
///
/// The columns are `jvx`, `jrx`, `jvy`, `jry`, … (values, not digits), then `e` or `ex`, `ey`, …, then
/// `dx`, `dy`, …, then `x`, `y`, ….
///
/// `e` counts what [`dda_line`](super::dda_line) counts, and an axis whose own counter is 0 adds no
/// more.
///
/// Source: the method of digital integration (DDA), decimal.
///
/// # Panics
/// When the slices differ in length, a |d| or a preset does not fit the digits, or there are more
/// than 9.
pub(crate) fn dda_line_decimal(digits: u32, from: &[i64], to: &[i64], preset: &[i64], end: EndPoint) -> Table {
    assert!((1..=9).contains(&digits), "1 to 9 digits");
    let modulus = 10_i64.pow(digits);
    let axes = from.len();
    assert!((2..=AXES.len()).contains(&axes), "2 to 6 axes");
    assert!(to.len() == axes && preset.len() == axes, "one value per axis");
    let d: Vec<i64> = (0..axes).map(|axis| to[axis] - from[axis]).collect();
    assert!(d.iter().all(|d| d.abs() < modulus), "10^digits must exceed every |d|");
    assert!(preset.iter().all(|preset| (0..modulus).contains(preset)), "a preset fits the digits");

    let mut columns: Vec<String> =
        AXES[..axes].iter().flat_map(|axis| [format!("jv{axis}"), format!("jr{axis}")]).collect();
    columns.extend(counter_columns(end, axes));
    columns.extend(per_axis_columns("d", axes));
    columns.extend(per_axis_columns("", axes));
    let mut table = Table::new(columns);

    let greatest = d.iter().map(|d| d.abs()).max();
    let longest = d.iter().position(|d| Some(d.abs()) == greatest);
    let mut jr = preset.to_vec();
    let mut made = vec![0; axes];
    for iteration in 0..=modulus {
        let mut pulse = vec![0; axes];
        for axis in 0..axes {
            let exhausted = end == EndPoint::PerAxis && made[axis] == d[axis].abs();
            if iteration > 0 && !exhausted {
                let sum = jr[axis] + d[axis].abs();
                jr[axis] = sum % modulus;
                pulse[axis] = sum / modulus * d[axis].signum();
                made[axis] += sum / modulus;
            }
        }
        let open = |axis: usize| d[axis].abs() - made[axis];
        let left: Vec<i64> = match end {
            EndPoint::Iterations => vec![modulus - iteration],
            EndPoint::Total => vec![(0..axes).map(open).sum()],
            EndPoint::Longest => vec![longest.map_or(0, open)],
            EndPoint::PerAxis => (0..axes).map(open).collect(),
        };
        let registers: Vec<i64> = d.iter().zip(&jr).flat_map(|(d, &jr)| [d.abs(), jr]).collect();
        let position: Vec<i64> = (0..axes).map(|axis| from[axis] + made[axis] * d[axis].signum()).collect();
        table.push(&[&registers, &left, &pulse, &position]);
        if left.iter().all(|&count| count == 0) {
            table.finished = true;
            break;
        }
    }
    table
}
