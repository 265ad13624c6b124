//! Data sampling: the points that the coarse stage is to make, in real numbers.
//!
//! A point is relative to the start of a line or the centre of an arc, in BLU; the first is the start. The last period
//! is the one whose point would lie at the end or beyond it: it goes to the end itself.

use std::f64::consts::FRAC_1_SQRT_2;

/// How the coarse stage calculates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum System {
    /// The way of the long axis first, the other by the slope; arcs by the direction in the middle of the period.
    Direction,
    /// The extended DDA by a step factor.
    StepFactor,
}

/// The points of a line by `d` with a way of `f` a period; at the end where the long axis arrives.
pub(crate) fn sampled_line(d: [i64; 2], f: f64, system: System) -> Vec<[f64; 2]> {
    let [dx, dy] = d.map(|delta| delta as f64);
    let length = dx.hypot(dy);
    let x_is_long = dx.abs() >= dy.abs();
    let step = match system {
        System::Direction => {
            let (long, short) = if x_is_long { (dx, dy) } else { (dy, dx) };
            let far = f * long / length;
            let near = short / long * far;
            if x_is_long { [far, near] } else { [near, far] }
        }
        System::StepFactor => {
            let lambda = f / length;
            [lambda * dx, lambda * dy]
        }
    };
    let periods = (length / f).ceil();
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut period = 0.0;
    while period < periods {
        points.push([period * step[0], period * step[1]]);
        period += 1.0;
    }
    points.push([dx, dy]);
    points
}

/// The point after a period of travel `f` from `[x, y]`, clockwise.
fn clockwise([x, y]: [f64; 2], f: f64, radius: f64, system: System) -> [f64; 2] {
    match system {
        System::StepFactor => {
            let lambda = f / radius;
            [x + lambda * (y - lambda * x / 2.0), y - lambda * (x + lambda * y / 2.0)]
        }
        System::Direction => {
            // Turned by quarters until y is the larger one and positive: there x goes to the right.
            if x.abs() > y.abs() {
                let [u, v] = clockwise([-y, x], f, radius, system);
                return [v, -u];
            }
            if y < 0.0 {
                let [u, v] = clockwise([-x, -y], f, radius, system);
                return [-u, -v];
            }
            let part = f / 2.0 * FRAC_1_SQRT_2;
            // Left of the axis the direction is the mirror image of the one on the right.
            let tangent = if x >= 0.0 { (x + part) / (y - part) } else { (x.abs() - part) / (y + part) };
            let dx = f * (1.0 / (1.0 + tangent * tangent).sqrt());
            // Δy (y - ½Δy) = Δx (x + ½Δx), the smaller root.
            let dy = y - (y * y - 2.0 * dx * (x + dx / 2.0)).sqrt();
            [x + dx, y - dy]
        }
    }
}

/// The points of an arc about the origin.
pub(crate) fn sampled_arc(start: [i64; 2], end: [i64; 2], is_clockwise: bool, f: f64, system: System) -> Vec<[f64; 2]> {
    let mirror = |[x, y]: [f64; 2]| if is_clockwise { [x, y] } else { [-x, y] };
    let [mut at, end] = [start, end].map(|point| mirror(point.map(|c| c as f64)));
    let radius = at[0].hypot(at[1]);
    // How far the end is to the left of the point, seen from the centre: clockwise it is ahead while this is negative.
    let ahead = |[x, y]: [f64; 2]| x * end[1] - y * end[0];
    let mut points = vec![mirror(at)];
    loop {
        let next = clockwise(at, f, radius, system);
        if ahead(at) < 0.0 && ahead(next) >= 0.0 {
            points.push(mirror(end));
            return points;
        }
        points.push(mirror(next));
        at = next;
    }
}

/// The points of an arc by the step factor in whole numbers, clockwise, `periods` of them after the start, in
/// 2^-`fraction` BLU: `word` is the travel of a period in that unit, and `bits` are those of the fraction of λ. What is
/// below the unit is kept for the next period.
pub(crate) fn step_factor_points(
    start: [i64; 2],
    word: i128,
    fraction: u32,
    bits: u32,
    periods: usize,
) -> Vec<[i128; 2]> {
    let [x, y] = start.map(i128::from);
    let lambda = (word << bits) / ((x * x + y * y) << (2 * fraction)).isqrt();
    let half = |coordinate: i128| coordinate.signum() * ((lambda * coordinate.abs()) >> (bits + 1));
    let mut at = [x, y].map(|coordinate| coordinate << (fraction + bits));
    let mut points = vec![at.map(|coordinate| coordinate >> bits)];
    for _ in 0..periods {
        let [x, y] = at.map(|coordinate| coordinate >> bits);
        let middle = [x + half(y), y - half(x)];
        at = [at[0] + lambda * middle[1], at[1] - lambda * middle[0]];
        points.push(at.map(|coordinate| coordinate >> bits));
    }
    points
}
