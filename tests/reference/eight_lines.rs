//! Straight lines of the eight-direction methods: every step is one along the longer axis, alone or
//! together with one along the shorter axis.

use super::{EndPoint, Table, counter_columns, per_axis_columns};

/// The step table of a straight line by minimum deviation, in BLU.
///
/// With S the shorter and L the longer of |dx|, |dy|: D = 2S - L at the start. `D >= 0` steps both
/// axes, and D += 2(S - L); `D < 0` steps the longer axis alone, and D += 2S.
///
/// The columns are `f` (D), `e` (the steps left), `dx`, `dy`, `x`, `y`.
///
/// Source: the method of minimum deviation, straight line.
pub(crate) fn mindev_line(from: [i64; 2], to: [i64; 2]) -> Table {
    let length = [(to[0] - from[0]).abs(), (to[1] - from[1]).abs()];
    let longer = usize::from(length[1] > length[0]);
    let (short, long) = (length[1 - longer], length[longer]);
    run(from, to, 2 * short - long, |d| {
        if d >= 0 { ([true; 2], d + 2 * (short - long)) } else { ([longer == 0, longer == 1], d + 2 * short) }
    })
}

/// The step table of a straight line by vector discrimination, in BLU.
///
/// F = a·|y| - b·|x| with a = |dx|, b = |dy|, the cross product of the direction and the present
/// point; 0 at the start. The octant fixes an axis vector (X when a >= b, else Y) and a diagonal
/// vector (XY). On the line, `F = 0`, the axis vector is taken; next to it the one that leads back: on
/// the Y side, `F > 0`, the one nearer to X, on the X side the one nearer to Y. The diagonal of a
/// line with a = b is the line.
///
/// The columns are `f`, `e` (the steps left), `dx`, `dy`, `x`, `y`.
///
/// This is the project's own definition of the method.
pub(crate) fn vector_line(from: [i64; 2], to: [i64; 2]) -> Table {
    let [a, b] = [(to[0] - from[0]).abs(), (to[1] - from[1]).abs()];
    run(from, to, 0, |f| {
        let steps = if a == b {
            [true, true]
        } else if a > b {
            [true, f < 0]
        } else {
            [f > 0, true]
        };
        (steps, f + if steps[1] { a } else { 0 } - if steps[0] { b } else { 0 })
    })
}

/// A line of as many steps as its longer axis has pulses; `judge` takes F to the axes that step and
/// the next F.
fn run(from: [i64; 2], to: [i64; 2], start: i64, judge: impl Fn(i64) -> ([bool; 2], i64)) -> Table {
    let d = [to[0] - from[0], to[1] - from[1]];
    let mut columns = vec!["f".to_owned()];
    columns.extend(counter_columns(EndPoint::Longest, 2));
    columns.extend(per_axis_columns("d", 2));
    columns.extend(per_axis_columns("", 2));
    let mut table = Table::new(columns);

    let mut f = start;
    let mut position = from;
    let mut left = d[0].abs().max(d[1].abs());
    table.push(&[&[f], &[left], &[0, 0], &position]);
    while left > 0 {
        let steps;
        (steps, f) = judge(f);
        let mut pulse = [0, 0];
        for axis in (0..2).filter(|&axis| steps[axis]) {
            pulse[axis] = d[axis].signum();
            position[axis] += pulse[axis];
        }
        left -= 1;
        table.push(&[&[f], &[left], &pulse, &position]);
    }
    table.finished = true;
    table
}
