//! Distances from conics, against a search.

use super::*;

/// The point of a curve with this parameter, relative to its centre.
fn point(shape: Shape, parameter: f64) -> [f64; 2] {
    match shape {
        Shape::Ellipse { semi_axes: [a, b] } => [a as f64 * parameter.cos(), b as f64 * parameter.sin()],
        Shape::Parabola { c, opens } => opens.plane([parameter * parameter / c as f64, parameter]),
        Shape::Hyperbola { semi_axes: [a, b], opens } => {
            opens.plane([a as f64 * parameter.cosh(), b as f64 * parameter.sinh()])
        }
    }
}

/// The least distance from a dense row of points of the curve, refined around the nearest of them.
fn searched(shape: Shape, [px, py]: Point) -> f64 {
    let off = |parameter: f64| {
        let [x, y] = point(shape, parameter);
        (x - px as f64).hypot(y - py as f64)
    };
    let reach = match shape {
        Shape::Ellipse { .. } => 3.2,
        Shape::Parabola { .. } => 100.0,
        Shape::Hyperbola { .. } => 5.0,
    };
    let count = 4_000;
    let place = |index: i32| reach * (2.0 * f64::from(index) / f64::from(count) - 1.0);
    let nearest = (0..=count).min_by(|a, b| off(place(*a)).total_cmp(&off(place(*b)))).unwrap();
    let [mut low, mut high] = [place(nearest - 1), place(nearest + 1)];
    for _ in 0..100 {
        let [left, right] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if off(left) < off(right) {
            high = right;
        } else {
            low = left;
        }
    }
    off(low.midpoint(high))
}

/// Small curves of every kind and orientation, round, flat and steep, `times` as large.
fn curves(times: i64) -> Result<Vec<Conic>, GeometryError> {
    let mut curves = Vec::new();
    let large = |opens, point: Point| turned(opens, point.map(|c| c * times));
    for [a, b] in [[1, 1], [5, 5], [6, 4], [3, 7], [12, 1], [1, 9], [10, 9]] {
        let [a, b] = [a * times, b * times];
        curves.push(Conic::ellipse([a, b], [a, 0], [0, b], ORIGIN, CounterClockwise)?);
    }
    for opens in OPEN {
        for c in [1, 4, 9, 30] {
            curves.push(Conic::parabola(c * times, Some(opens), ORIGIN, large(opens, [c, c]), ORIGIN)?);
        }
        for [a, b] in [[1, 1], [4, 3], [2, 7], [9, 2]] {
            let from = large(opens, [a, 0]);
            let across = opens.plane([0, 1]);
            let to = [from[0] + across[0], from[1] + across[1]];
            curves.push(Conic::hyperbola([a * times, b * times], Some(opens), from, to, ORIGIN)?);
        }
    }
    Ok(curves)
}

#[test]
fn deviations_are_those_of_a_dense_search_to_a_billionth() -> Outcome {
    for curve in curves(1)? {
        for point in lattice(16).chain([[40, 3], [-50, 20]]) {
            let (found, expected) = (curve.deviation(&point), searched(curve.shape(), point));
            assert!((found - expected).abs() < 1e-9, "{curve:?} {point:?}: {found} {expected}");
            let outside = curve.implicit(point) >= 0;
            assert_eq!(curve.signed_deviation(&point), if outside { found } else { -found });
        }
    }
    Ok(())
}

#[test]
fn a_curve_a_million_times_as_large_has_deviations_a_million_times_as_large() -> Outcome {
    let times = 1 << 20;
    for (curve, larger) in curves(1)?.into_iter().zip(curves(times)?) {
        for point in lattice(12) {
            let [small, far] = [curve.deviation(&point), larger.deviation(&point.map(|c| c * times)) / times as f64];
            assert!((small - far).abs() < 1e-13, "{larger:?} {point:?}: {small} {far}");
        }
    }
    Ok(())
}

#[test]
fn near_the_largest_curves_no_digit_is_lost() -> Outcome {
    let limit = CONIC_LIMIT;
    // (a·3/5, b·4/5) lies on the ellipse; its normal and curvature there give the distances of its neighbours.
    let [a, b] = [limit / 5 * 5, 5 << 20];
    let ellipse = Conic::ellipse([a, b], [a, 0], [a, 0], ORIGIN, Clockwise)?;
    let [x, y] = [a / 5 * 3, b / 5 * 4];
    assert_eq!(ellipse.deviation(&[x, y]), 0.0);
    let (gx, gy) = (0.6 / a as f64, 0.8 / b as f64);
    let radius = (0.8 * a as f64).hypot(0.6 * b as f64).powi(3) / (a as f64 * b as f64);
    for [dx, dy] in lattice(2) {
        let off = (dx as f64 * gx + dy as f64 * gy) / gx.hypot(gy);
        let along = (dx as f64 * gy - dy as f64 * gx) / gx.hypot(gy);
        let expected = off + along * along / (2.0 * radius);
        let found = ellipse.signed_deviation(&[x + dx, y + dy]);
        assert!((found - expected).abs() < 1e-12, "{dx} {dy}: {found} {expected}");
    }
    for tip in 1..5 {
        assert_eq!(ellipse.deviation(&[a + tip, 0]), tip as f64);
        assert_eq!(ellipse.signed_deviation(&[0, tip - b]), -(tip as f64));
    }
    let circle = Conic::ellipse([limit, limit], [limit, 0], [limit, 0], ORIGIN, Clockwise)?;
    let arc = crate::Arc::new([limit, 0], [limit, 0], ORIGIN, Clockwise)?;
    for point in [[limit, 1], [3, 1 - limit], [limit / 3, limit], [1, 1], [0, 0], [47_453_133, 47_453_132]] {
        let [found, expected] = [circle.deviation(&point), arc.deviation(&point)];
        assert!((found - expected).abs() <= 1e-15 * expected, "{point:?}: {found} {expected}");
    }
    Ok(())
}

#[test]
fn any_position_has_a_deviation_and_a_gauge_the_same() -> Outcome {
    let limit = CONIC_LIMIT;
    let mut curves = curves(1)?;
    curves.push(Conic::ellipse([limit, 1], [limit, 0], [0, 1], ORIGIN, CounterClockwise)?);
    curves.push(Conic::ellipse([1, limit], [L, 0], [L, 0], [L - 1, 0], CounterClockwise)?);
    curves.push(Conic::parabola(1, Some(Opens::MinusX), [L, L], [L - 4, L - 2], [L, L])?);
    for [a, b] in [[1, limit], [limit, limit], [limit - 1, 1 << 20]] {
        curves.push(Conic::hyperbola([a, b], Some(Opens::MinusY), [0, -a], [1, -a], ORIGIN)?);
    }
    let values = [0, 1, -1, 2, 1000, limit, -limit, 1 << 40, L, -L, i64::MAX, i64::MIN];
    for conic in curves {
        let curve: crate::Curve = conic.into();
        let gauge = curve.gauge();
        assert!(gauge.batch(10).is_none());
        for [x, y] in values.into_iter().flat_map(|x| values.map(|y| [x, y])) {
            let found = conic.deviation(&[x, y]);
            assert!(found.is_finite() && found >= 0.0, "{conic:?} {x} {y}: {found}");
            assert_eq!(gauge.deviation(&[x, y]).to_bits(), found.to_bits());
            // No point of the curve is nearer than that.
            let [cx, cy] = conic.center();
            let [rx, ry] = between([cx, cy], [x, y]).map(|c| c as f64);
            for parameter in (-60..=60).map(|step| f64::from(step) * 0.05) {
                let [px, py] = point(conic.shape(), parameter);
                let bound = (rx - px).hypot(ry - py) + (rx.hypot(ry) + px.hypot(py)) * 1e-15;
                assert!(found <= bound, "{conic:?} {x} {y}: {found} {bound}");
            }
        }
        assert!(conic.deviation(&[1]).is_nan() && conic.signed_deviation(&[]).is_nan());
        assert_eq!(conic.deviation(&[4, 5, 6]), conic.deviation(&[4, 5]));
    }
    Ok(())
}
