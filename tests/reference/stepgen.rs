//! Step generator: a signed phase accumulator per axis; a change above the picked-off bit is a step.

use super::{AXES, EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a straight line in 2 to 6 axes, in BLU, in 2^`k` iterations.
///
/// The rate of an axis is d·2^(`pick_off` - k). Each iteration adds it to the accumulator, which
/// starts at the `preset` of its axis (0 ..= 2^`pick_off` - 1). When floor(acc / 2^`pick_off`)
/// changes, the axis makes a step in the direction of its rate.
///
/// The columns are `accx`, `accy`, …, then `e` (the iterations left), then `dx`, `dy`, …, then `x`,
/// `y`, ….
///
/// A table with `overflow` ends before an accumulator leaves `acc_bits` bits, two's complement.
///
/// Source: the step generators of motion control cards.
///
/// # Panics
/// When the slices differ in length; when `k` > `pick_off`, for then a rate has a fraction; when a
/// |d| is above 2^`k`, for then an iteration would have to make two steps; when a preset is out of
/// range, or `acc_bits` > 62.
pub(crate) fn stepgen(acc_bits: u32, pick_off: u32, k: u32, from: &[i64], to: &[i64], preset: &[i64]) -> Table {
    let axes = from.len();
    assert!((2..=AXES.len()).contains(&axes), "2 to 6 axes");
    assert!(to.len() == axes && preset.len() == axes, "one value per axis");
    assert!((1..=62).contains(&acc_bits) && pick_off < 62, "1 to 62 bits");
    assert!(k <= pick_off, "a rate is an integer");
    let d: Vec<i64> = (0..axes).map(|axis| to[axis] - from[axis]).collect();
    assert!(d.iter().all(|d| d.abs() <= 1 << k), "at most one step an iteration");
    let step = 1_i64 << pick_off;
    assert!(preset.iter().all(|preset| (0..step).contains(preset)), "a preset lies below the picked-off bit");
    let limit = 1_i64 << (acc_bits - 1);

    let mut columns = per_axis_columns("acc", axes);
    columns.extend(counter_columns(EndPoint::Iterations, axes));
    columns.extend(per_axis_columns("d", axes));
    columns.extend(per_axis_columns("", axes));
    let mut table = Table::new(columns);

    let rate: Vec<i64> = d.iter().map(|d| d * (step >> k)).collect();
    let mut acc = preset.to_vec();
    let mut pulse = vec![0; axes];
    let mut position = from.to_vec();
    table.push(&[&acc, &[1 << k], &pulse, &position]);
    for left in (0..1_i64 << k).rev() {
        for axis in 0..axes {
            let before = acc[axis].div_euclid(step);
            acc[axis] += rate[axis];
            let steps = acc[axis].div_euclid(step) != before;
            pulse[axis] = if steps { rate[axis].signum() } else { 0 };
            position[axis] += pulse[axis];
        }
        if acc.iter().any(|acc| !(-limit..limit).contains(acc)) {
            table.overflow = true;
            return table;
        }
        table.push(&[&acc, &[left], &pulse, &position]);
    }
    table.finished = true;
    table
}
