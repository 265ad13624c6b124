//! The recurrences against the worked tables of the textbooks, and the claims made for each method,
//! tried on every small geometry.

mod cim;
mod conics;
mod dda;
mod eight;
mod modern;
mod nurbs;
mod ppc;
mod ramp;
mod rates;
mod smooth;
mod space;
mod spline;

use super::{EndPoint, Table};

/// The pulses of every step, `-X` for -1 on X; a step with two pulses writes both, one with none an
/// empty word.
fn moves(table: &Table) -> String {
    let pulses = table.column("dx").into_iter().zip(table.column("dy"));
    let words: Vec<String> = pulses
        .skip(1)
        .map(|(dx, dy)| {
            let word = |pulse, axis| match pulse {
                1 => format!("+{axis}"),
                -1 => format!("-{axis}"),
                _ => String::new(),
            };
            word(dx, 'X') + &word(dy, 'Y')
        })
        .collect();
    words.join(" ")
}

/// The steps in which an axis gets a pulse.
fn pulse_steps(table: &Table, axis: &str) -> Vec<usize> {
    let pulses = table.column(axis).into_iter().enumerate();
    pulses.filter(|&(_, pulse)| pulse != 0).map(|(step, _)| step).collect()
}

/// The last row's position.
fn end_of(table: &Table) -> [i64; 2] {
    *table.path().last().expect("row 0 is always there")
}

/// Every integer point with x² + y² = `radius_squared`.
fn lattice_circle(radius_squared: i64) -> Vec<[i64; 2]> {
    let radius = radius_squared.isqrt();
    let square = (-radius..=radius).flat_map(|x| (-radius..=radius).map(move |y| [x, y]));
    square.filter(|[x, y]| x * x + y * y == radius_squared).collect()
}

/// Every arc with integer end points on a circle about the origin with R² below `limit`: R², start,
/// end, clockwise. A full circle starts at every point, in both senses.
fn lattice_arcs(limit: i64) -> Vec<(i64, [i64; 2], [i64; 2], bool)> {
    let mut arcs = Vec::new();
    for radius_squared in 1..limit {
        let circle = lattice_circle(radius_squared);
        for &from in &circle {
            for &to in &circle {
                arcs.push((radius_squared, from, to, false));
                arcs.push((radius_squared, from, to, true));
            }
        }
    }
    arcs
}

/// True when a <= √square, without rounding.
fn at_most_root(a: i64, square: i64) -> bool {
    a <= 0 || a * a <= square
}

/// True when a < √square, without rounding.
fn below_root(a: i64, square: i64) -> bool {
    a < 0 || a * a < square
}

/// The distance of the farthest row from a circle about the origin, in BLU.
fn radial_error(table: &Table, radius_squared: i64) -> f64 {
    let radius = (radius_squared as f64).sqrt();
    let errors = table.path().into_iter().map(|[x, y]| {
        let distance = ((x * x + y * y) as f64).sqrt();
        (distance - radius).abs()
    });
    errors.fold(0.0, f64::max)
}

/// A point turned by 90° counter-clockwise about the origin.
fn turned([x, y]: [i64; 2]) -> [i64; 2] {
    [-y, x]
}

/// Every pulse moves the position by itself, and nothing else does.
fn assert_pulses_make_the_path(table: &Table) {
    let path = table.path();
    let (dx, dy) = (table.column("dx"), table.column("dy"));
    assert_eq!([dx[0], dy[0]], [0, 0]);
    for k in 1..path.len() {
        let moved = [path[k - 1][0] + dx[k], path[k - 1][1] + dy[k]];
        assert_eq!(path[k], moved, "step {k}");
        assert!(dx[k].abs() <= 1 && dy[k].abs() <= 1, "step {k}");
    }
}

/// The end schemes that lines of point-by-point comparison have.
const LINE_ENDS: [EndPoint; 3] = [EndPoint::Total, EndPoint::PerAxis, EndPoint::Longest];
