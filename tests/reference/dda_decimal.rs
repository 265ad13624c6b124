//! Digital differential analyser in radix 10: straight lines.

use super::{AXES, EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a straight line in 2 to 6 axes, in BLU, with decimal integrators of `digits`
/// digits.
///
/// J_V = |d|, J_R starts at the `preset` of its axis. Each of the 10^`digits` iterations adds J_V to
/// J_R modulo 10^`digits`; the carry is the pulse.
///
/// The columns are `jvx`, `jrx`, `jvy`, `jry`, … (values, not digits), then `e` (the iterations
/// left), then `dx`, `dy`, …, then `x`, `y`, ….
///
/// Source: the method of digital integration (DDA), decimal.
///
/// # Panics
/// When the slices differ in length, a |d| or a preset does not fit the digits, or there are more
/// than 9.
pub(crate) fn dda_line_decimal(digits: u32, from: &[i64], to: &[i64], preset: &[i64]) -> Table {
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
    columns.extend(counter_columns(EndPoint::Iterations, axes));
    columns.extend(per_axis_columns("d", axes));
    columns.extend(per_axis_columns("", axes));
    let mut table = Table::new(columns);

    let mut jr = preset.to_vec();
    let mut pulse = vec![0; axes];
    let mut position = from.to_vec();
    for left in (0..=modulus).rev() {
        if left < modulus {
            for axis in 0..axes {
                let sum = jr[axis] + d[axis].abs();
                jr[axis] = sum % modulus;
                pulse[axis] = sum / modulus * d[axis].signum();
                position[axis] += pulse[axis];
            }
        }
        let registers: Vec<i64> = d.iter().zip(&jr).flat_map(|(d, &jr)| [d.abs(), jr]).collect();
        table.push(&[&registers, &[left], &pulse, &position]);
    }
    table.finished = true;
    table
}
