//! The counters of printer and mill firmware: the longest axis sets the pace, a counter per axis
//! gives its pulses.

use super::{AXES, EndPoint, Form, Table, counter_columns, per_axis_columns};

/// The step table of a straight line in 2 to 6 axes, in BLU.
///
/// N is the longest |d|, and the block has N steps. The counter of each axis starts at N/2, rounded
/// down. Each step adds |d|; a counter at N or above (above N when `strictly_greater`) gives a pulse
/// and loses N. `Signed` counters start at the negative of that and are compared with 0 instead.
///
/// The columns are `cntx`, `cnty`, …, then `e` (the steps left), then `dx`, `dy`, …, then `x`, `y`, ….
///
/// With `Magnitude` and `strictly_greater` a block of N = 1 makes no pulse at all; with `Signed` and
/// not `strictly_greater` an axis without travel makes one in it, in the positive direction.
///
/// Source: the step counters of open firmware for printers and mills.
///
/// # Panics
/// When the slices differ in length.
pub(crate) fn bresenham(from: &[i64], to: &[i64], form: Form, strictly_greater: bool) -> Table {
    let axes = from.len();
    assert!((2..=AXES.len()).contains(&axes) && to.len() == axes, "2 to 9 axes");
    let d: Vec<i64> = (0..axes).map(|axis| to[axis] - from[axis]).collect();
    let longest = d.iter().map(|d| d.abs()).max().expect("at least two axes");

    let mut columns = per_axis_columns("cnt", axes);
    columns.extend(counter_columns(EndPoint::Longest, axes));
    columns.extend(per_axis_columns("d", axes));
    columns.extend(per_axis_columns("", axes));
    let mut table = Table::new(columns);

    let (start, compared) = if form == Form::Signed { (-(longest / 2), 0) } else { (longest / 2, longest) };
    let threshold = compared + i64::from(strictly_greater);
    let mut counter = vec![start; axes];
    let mut pulse = vec![0; axes];
    let mut position = from.to_vec();
    table.push(&[&counter, &[longest], &pulse, &position]);
    for left in (0..longest).rev() {
        for axis in 0..axes {
            counter[axis] += d[axis].abs();
            let steps = counter[axis] >= threshold;
            if steps {
                counter[axis] -= longest;
            }
            pulse[axis] = if !steps {
                0
            } else if d[axis] < 0 {
                -1
            } else {
                1
            };
            position[axis] += pulse[axis];
        }
        table.push(&[&counter, &[left], &pulse, &position]);
    }
    table.finished = true;
    table
}
