//! Straight lines of 3 axes and more: every axis is compared with the longest one, G, by a deviation of its own.

use super::{EndPoint, Table, counter_columns, per_axis_columns};

/// Displacements, directions and the longest axis of a line.
struct Line {
    lengths: Vec<i64>,
    signs: Vec<i64>,
    longest: usize,
    from: Vec<i64>,
}

impl Line {
    /// `last`: of equally long axes the last is the longest, else the first.
    fn new(from: &[i64], to: &[i64], last: bool) -> Line {
        let delta: Vec<i64> = from.iter().zip(to).map(|(from, to)| to - from).collect();
        let lengths: Vec<i64> = delta.iter().map(|d| d.abs()).collect();
        let mut longest = 0;
        for axis in 1..lengths.len() {
            if lengths[axis] > lengths[longest] || last && lengths[axis] == lengths[longest] {
                longest = axis;
            }
        }
        Line { signs: delta.iter().map(|d| d.signum()).collect(), lengths, longest, from: from.to_vec() }
    }

    /// L.
    fn length(&self) -> i64 {
        self.lengths[self.longest]
    }

    /// The table of a method. `judge` takes the deviations and what is left of each axis to the axes that step;
    /// `change` gives what a step adds to the deviation of an axis, by its S, its own pulse and that of G.
    fn table(
        &self,
        end: EndPoint,
        start: impl Fn(i64) -> i64,
        judge: impl Fn(&[i64], &[i64]) -> Vec<bool>,
        change: impl Fn(i64, bool, bool) -> i64,
    ) -> Table {
        let axes = self.lengths.len();
        let columns = [
            per_axis_columns("f", axes),
            counter_columns(end, axes),
            per_axis_columns("d", axes),
            per_axis_columns("", axes),
        ];
        let mut table = Table::new(columns.concat());
        let others: Vec<bool> = (0..axes).map(|axis| axis != self.longest).collect();
        let mut f: Vec<i64> = (0..axes).map(|axis| if others[axis] { start(self.lengths[axis]) } else { 0 }).collect();
        let mut left = self.lengths.clone();
        let mut position = self.from.clone();
        let counted = |left: &[i64]| match end {
            EndPoint::PerAxis => left.to_vec(),
            EndPoint::Total => vec![left.iter().sum()],
            _ => vec![left[self.longest]],
        };
        table.push(&[&f, &counted(&left), &vec![0; axes], &position]);
        while left.iter().any(|left| *left > 0) {
            let taken = judge(&f, &left);
            let mut pulses = vec![0; axes];
            for axis in 0..axes {
                if taken[axis] {
                    pulses[axis] = self.signs[axis];
                    position[axis] += pulses[axis];
                    left[axis] -= 1;
                }
                if others[axis] {
                    f[axis] += change(self.lengths[axis], taken[axis], taken[self.longest]);
                }
            }
            table.push(&[&f, &counted(&left), &pulses, &position]);
        }
        table.finished = true;
        table
    }
}

/// The step table of a line by point-by-point comparison: the first axis of a negative deviation steps, and its
/// deviation gains L; where there is none G steps, and every other deviation loses its S. One axis a step.
///
/// The columns are `fx`, …, `e` (all pulses), `dx`, …, `x`, ….
pub(crate) fn ppc_space_line(from: &[i64], to: &[i64]) -> Table {
    let line = Line::new(from, to, false);
    let judge = |f: &[i64], _: &[i64]| {
        let taken = f.iter().position(|f| *f < 0).unwrap_or(line.longest);
        (0..f.len()).map(|axis| axis == taken).collect()
    };
    let change = |s: i64, taken, longest| {
        if longest {
            -s
        } else if taken {
            line.length()
        } else {
            0
        }
    };
    line.table(EndPoint::Total, |_| 0, judge, change)
}

/// The step table of a line by comparison-integral: G steps always, another axis where its deviation is 0 or more and it
/// has pulses left; it gains S, and loses L if it stepped.
///
/// The columns are `fx`, …, `ex`, …, `dx`, …, `x`, ….
pub(crate) fn cim_space_line(from: &[i64], to: &[i64]) -> Table {
    let line = Line::new(from, to, true);
    let judge = |f: &[i64], left: &[i64]| {
        (0..f.len()).map(|axis| axis == line.longest || f[axis] >= 0 && left[axis] > 0).collect()
    };
    let change = |s: i64, taken, _| s - if taken { line.length() } else { 0 };
    line.table(EndPoint::PerAxis, |_| 0, judge, change)
}

/// The step table of a line by minimum deviation: G steps always, another axis where its deviation, 2S - L at the start, is 0 or
/// more; it gains 2S, and loses 2L if it stepped.
///
/// The columns are `fx`, …, `e` (steps left), `dx`, …, `x`, ….
pub(crate) fn mindev_space_line(from: &[i64], to: &[i64]) -> Table {
    let line = Line::new(from, to, false);
    let judge = |f: &[i64], _: &[i64]| (0..f.len()).map(|axis| axis == line.longest || f[axis] >= 0).collect();
    let change = |s: i64, taken, _| 2 * s - if taken { 2 * line.length() } else { 0 };
    line.table(EndPoint::Longest, |s| 2 * s - line.length(), judge, change)
}
