//! The point of a conic next to a position, and the distance to it.

use crate::Shape;
use crate::exact::Vector;

/// Newton's method needs no more rounds, wherever the position is; near the curve it needs three.
const ROUNDS: usize = 200;

/// The distance of a point, relative to the centre, from the whole ellipse, the parabola or the hyperbola's branch.
pub(super) fn distance(shape: Shape, point: Vector) -> f64 {
    let value = shape.implicit(point) as f64;
    let [x, y] = own(shape, point);
    let place = foot(shape, [x, y]);
    let [fx, fy] = at(shape, place);
    let ([gx, gy], [kx, ky]) = match shape {
        Shape::Ellipse { semi_axes } => {
            let [p, q] = squares(semi_axes);
            ([2.0 * q * fx, 2.0 * p * fy], [q, p])
        }
        Shape::Parabola { c, .. } => ([-(c as f64), 2.0 * fy], [0.0, 1.0]),
        Shape::Hyperbola { semi_axes, .. } => {
            let [p, q] = squares(semi_axes);
            ([2.0 * q * fx, -2.0 * p * fy], [q, -p])
        }
    };
    // At the distance d along the unit normal n the implicit function is F = ±|∇F|d + Q(n)d². Near the curve this
    // gives d from the exact F, however large the coordinates are.
    let plain = (x - fx).hypot(y - fy);
    let slope = gx.hypot(gy);
    let bend = plain * (kx * (gx / slope).powi(2) + ky * (gy / slope).powi(2));
    if bend.abs() > slope / 2.0 { plain } else { value.abs() / (slope + bend * value.signum()) }
}

/// The point in the curve's own coordinates: both coordinates of an ellipse positive, an open curve along +x, y
/// positive.
fn own(shape: Shape, point: Vector) -> [f64; 2] {
    let [x, y] = match shape.opens() {
        None => [point[0].abs(), point[1]],
        Some(opens) => opens.along_across(point),
    };
    [x as f64, y.abs() as f64]
}

/// The parameter of the curve's point next to one that is relative to the centre: see [`at`]; never negative.
pub(super) fn parameter(shape: Shape, point: Vector) -> f64 {
    foot(shape, own(shape, point))
}

/// The point with this parameter in the curve's own coordinates.
///
/// An ellipse is (a cos φ, b sin φ), a parabola (t²/c, t), a hyperbola (a cosh t, b sinh t).
pub(super) fn at(shape: Shape, parameter: f64) -> [f64; 2] {
    match shape {
        Shape::Ellipse { semi_axes: [a, b] } => [a as f64 * parameter.cos(), b as f64 * parameter.sin()],
        Shape::Parabola { c, .. } => [parameter * parameter / c as f64, parameter],
        Shape::Hyperbola { semi_axes: [a, b], .. } => [a as f64 * parameter.cosh(), b as f64 * parameter.sinh()],
    }
}

/// How far the point moves as the parameter grows by 1, in BLU.
pub(super) fn speed(shape: Shape, parameter: f64) -> f64 {
    match shape {
        Shape::Ellipse { semi_axes: [a, b] } => (a as f64 * parameter.sin()).hypot(b as f64 * parameter.cos()),
        Shape::Parabola { c, .. } => 1.0_f64.hypot(2.0 * parameter / c as f64),
        Shape::Hyperbola { semi_axes: [a, b], .. } => (a as f64 * parameter.sinh()).hypot(b as f64 * parameter.cosh()),
    }
}

fn squares(semi_axes: [i64; 2]) -> [f64; 2] {
    semi_axes.map(|axis| (axis * axis) as f64) // at most 2^52
}

fn foot(shape: Shape, point: [f64; 2]) -> f64 {
    match shape {
        Shape::Ellipse { semi_axes: [a, b] } => {
            let [x, y] = point;
            let [cos, sin] = if a < b {
                let [sin, cos] = ellipse_foot([b, a], [y, x]);
                [cos, sin]
            } else {
                ellipse_foot([a, b], [x, y])
            };
            sin.atan2(cos)
        }
        Shape::Parabola { c, .. } => parabola_foot(c as f64, point),
        Shape::Hyperbola { semi_axes, .. } => hyperbola_foot(semi_axes, point).asinh(),
    }
}

/// The cosine and the sine of the foot's parameter on an ellipse with a ≥ b.
///
/// The foot is (a²x/(s + k), b²y/s) with k = a² - b² and the one s > 0 that puts it on the ellipse: a zero of a convex
/// falling function, which Newton's method meets from the left without ever passing it.
fn ellipse_foot(semi_axes: [i64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    let [a, b] = semi_axes.map(|axis| axis as f64);
    let [p, q] = squares(semi_axes);
    let k = p - q;
    let (ax, by) = (a * x, b * y);
    if y == 0.0 {
        // Up to k/a from the centre the foot is off the long axis.
        return if ax > k || x > 0.0 && ax == k {
            [1.0, 0.0]
        } else if k == 0.0 {
            [0.0, 1.0]
        } else {
            [ax / k, ((k - ax) * (k + ax)).sqrt() / k]
        };
    }
    let mut s = by.max(ax - k);
    for _ in 0..ROUNDS {
        let (cos, sin) = (ax / (s + k), by / s);
        let value = (cos * cos - 1.0) + sin * sin;
        let step = value / (2.0 * (cos * cos / (s + k) + sin * sin / s));
        s += step;
        if step <= s * f64::EPSILON {
            break;
        }
    }
    let (cos, sin) = (ax / (s + k), by / s);
    let norm = cos.hypot(sin);
    [cos / norm, sin / norm]
}

/// The foot's y on the parabola y² = cx.
///
/// It is the one positive zero of y + (2x/c - 1)t - 2t³/c², which is concave there: Newton's method meets it from the
/// right.
fn parabola_foot(c: f64, [x, y]: [f64; 2]) -> f64 {
    let k = (2.0 * x - c) / c;
    if y == 0.0 {
        return if k > 0.0 { c * (k / 2.0).sqrt() } else { 0.0 };
    }
    let mut t = c * k.max(0.0).sqrt() + (y * c * c).cbrt();
    if k < 0.0 {
        t = t.min(-y / k);
    }
    for _ in 0..ROUNDS {
        let r = t / c;
        let step = (y + k * t - 2.0 * r * r * t) / (k - 6.0 * r * r);
        t -= step;
        if step <= t * f64::EPSILON {
            break;
        }
    }
    t
}

/// The foot's y/b on the branch x > 0 of a hyperbola.
///
/// It is the one positive zero of ax·w/√(1 + w²) + by - (a² + b²)w, which for x > 0 is concave, so that Newton's method
/// meets it from the right, and else convex and falling, so that it does from the left.
fn hyperbola_foot(semi_axes: [i64; 2], [x, y]: [f64; 2]) -> f64 {
    let [a, b] = semi_axes.map(|axis| axis as f64);
    let [p, q] = squares(semi_axes);
    let m = p + q;
    let (ax, by) = (a * x, b * y);
    if y == 0.0 {
        return if ax > m { ((ax - m) * (ax + m)).sqrt() / m } else { 0.0 };
    }
    let mut w = if x > 0.0 { (ax + by) / m } else { 0.0 };
    for _ in 0..ROUNDS {
        let c = 1.0_f64.hypot(w);
        let step = (ax * w / c + by - m * w) / (ax / (c * c * c) - m);
        w -= step;
        if step.abs() <= w * f64::EPSILON {
            break;
        }
    }
    w
}
