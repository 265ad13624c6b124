//! Step generator: a signed phase accumulator per axis; a change above the picked-off bit is a step; the outputs and
//! their timers say when it may be sent.

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

/// Times of an output, in clocks: the step output is 1, it is 0 between two steps, from a change of the direction to
/// the next step, from the end of a step to a change of the direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timing {
    pub(crate) length: i64,
    pub(crate) space: i64,
    pub(crate) setup: i64,
    pub(crate) hold: i64,
}

/// The step and direction output of an axis, as the clocks at which something happened last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepOutput {
    timing: Timing,
    /// The direction output is negative.
    pub(crate) negative: bool,
    /// When a step was sent.
    sent: Option<i64>,
    /// When the direction changed.
    turned: Option<i64>,
}

impl StepOutput {
    /// An output that has been at rest in the positive direction for long.
    pub(crate) fn new(timing: Timing) -> Self {
        StepOutput { timing, negative: false, sent: None, turned: None }
    }

    /// True when a step in this direction may begin at clock `t`: the direction output has had it for the set-up time,
    /// one clock at least, and the last step and its space are over.
    pub(crate) fn may_send(&self, t: i64, negative: bool) -> bool {
        let prepared = self.turned.is_none_or(|turned| t >= turned + self.timing.setup.max(1));
        self.negative == negative && prepared && self.is_over(t)
    }

    /// True when the last step and its space are over at clock `t`.
    pub(crate) fn is_over(&self, t: i64) -> bool {
        self.sent.is_none_or(|sent| t >= sent + self.timing.length + self.timing.space)
    }

    /// Clock `t`, with this direction wanted: turns as soon as the hold time is over, or begins a step.
    pub(crate) fn clock(&mut self, t: i64, negative: bool, send: bool) {
        let held = self.sent.is_none_or(|sent| t >= sent + self.timing.length + self.timing.hold);
        if self.negative != negative && held {
            self.negative = negative;
            self.turned = Some(t);
        }
        if send {
            self.sent = Some(t);
        }
    }

    /// The step output after clock `t`.
    pub(crate) fn step(&self, t: i64) -> bool {
        self.sent.is_some_and(|sent| t < sent + self.timing.length)
    }
}

/// The line of [`stepgen`] clock by clock, with the outputs of every axis.
///
/// Row t is the state t clocks after the load. In every clock all axes accumulate, unless an axis would make a step
/// that its outputs do not allow yet: then all wait. The last row is the clock at which all accumulations are made and
/// all steps and their spaces are over.
///
/// The columns are `accx`, `accy`, …, then `e`, then `stepx`, …, then `dirx`, … (1 is negative), then `x`, `y`, ….
pub(crate) fn stepgen_clocks(pick_off: u32, k: u32, from: &[i64], to: &[i64], preset: &[i64], timing: Timing) -> Table {
    let axes = from.len();
    let unit = 1_i64 << pick_off;
    let rate: Vec<i64> = (0..axes).map(|axis| (to[axis] - from[axis]) * (unit >> k)).collect();

    let mut columns = per_axis_columns("acc", axes);
    columns.extend(counter_columns(EndPoint::Iterations, axes));
    for prefix in ["step", "dir", ""] {
        columns.extend(per_axis_columns(prefix, axes));
    }
    let mut table = Table::new(columns);

    let mut acc = preset.to_vec();
    let mut position = from.to_vec();
    let mut outputs = vec![StepOutput::new(timing); axes];
    let mut left = 1_i64 << k;
    let idle = vec![0; axes];
    table.push(&[&acc, &[left], &idle, &idle, &position]);
    for t in 1.. {
        let crosses = |axis: usize| (acc[axis] + rate[axis]).div_euclid(unit) != acc[axis].div_euclid(unit);
        let steps: Vec<bool> = (0..axes).map(|axis| left > 0 && crosses(axis)).collect();
        let allowed = (0..axes).all(|axis| !steps[axis] || outputs[axis].may_send(t, rate[axis] < 0));
        let accumulates = left > 0 && allowed;
        let over = outputs.iter().all(|output| output.is_over(t));
        for axis in 0..axes {
            let send = accumulates && steps[axis];
            outputs[axis].clock(t, rate[axis] < 0, send);
            if accumulates {
                acc[axis] += rate[axis];
            }
            if send {
                position[axis] += rate[axis].signum();
            }
        }
        left -= i64::from(accumulates);
        let step: Vec<i64> = outputs.iter().map(|output| i64::from(output.step(t))).collect();
        let dir: Vec<i64> = outputs.iter().map(|output| i64::from(output.negative)).collect();
        table.push(&[&acc, &[left], &step, &dir, &position]);
        let sends = accumulates && steps.contains(&true);
        if left == 0 && over && !sends {
            break;
        }
    }
    table.finished = true;
    table
}
