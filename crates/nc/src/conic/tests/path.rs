//! Lengths and outlines of conics.

use std::f64::consts::{PI, TAU};

use super::*;

fn assert_near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
}

#[test]
fn lengths_of_ellipses_are_those_of_tables() -> Outcome {
    let turn = |a, b| Conic::ellipse([a, b], [a, 0], [a, 0], ORIGIN, Clockwise).map(|curve| curve.length());
    assert_near(turn(5, 5)?, 10.0 * PI);
    assert_near(turn(2, 1)?, 9.688_448_220_547_675);
    assert_near(turn(1, 2)?, 9.688_448_220_547_675);
    assert_near(turn(CONIC_LIMIT, CONIC_LIMIT)?, TAU * CONIC_LIMIT as f64);
    assert_near(turn(CONIC_LIMIT, 1)?, 4.0 * CONIC_LIMIT as f64); // and b²/a² · ln(a/b) of it more
    let part = |from, to, direction| Conic::ellipse([9, 4], from, to, ORIGIN, direction).map(|curve| curve.length());
    assert_near(part([9, 0], [0, 4], Clockwise)?, turn(9, 4)? * 0.75);
    assert_near(part([9, 0], [0, 4], CounterClockwise)?, turn(9, 4)? * 0.25);
    assert_near(part([8, 2], [-8, -2], Clockwise)?, turn(9, 4)? / 2.0);
    // Both ends next to one place: hardly any angle, or nearly a full turn.
    let (short, long) = (part([8, 2], [7, 2], CounterClockwise)?, part([8, 2], [7, 2], Clockwise)?);
    assert_near(short + long, turn(9, 4)?);
    assert!(short < 1.5);
    Ok(())
}

#[test]
fn lengths_of_open_curves_are_those_of_closed_forms_and_chords() -> Outcome {
    let parabola = |from, to| Conic::parabola(4, Some(Opens::PlusX), from, to, ORIGIN).map(|curve| curve.length());
    let until = |y: f64| y / 2.0 * (1.0 + y * y / 4.0).sqrt() + (y / 2.0).asinh();
    assert_near(parabola(ORIGIN, [1, 2])?, until(2.0));
    assert_near(parabola([4, -4], [1, 2])?, until(2.0) + until(4.0));
    assert_near(parabola([100, 20], [1, 2])?, until(20.0) - until(2.0));

    // (15, -16) lies on x²/9² - y²/12² = 1; the chords run over the parameter of (9 cosh t, 12 sinh t).
    let hyperbola = Conic::hyperbola([9, 12], None, [15, -16], [9, 0], ORIGIN)?;
    assert!(hyperbola.ends_on_curve());
    let place = |index: i32| (4.0_f64 / 3.0).asinh() * f64::from(index) / 400_000.0;
    let point = |index: i32| [9.0 * place(index).cosh(), 12.0 * place(index).sinh()];
    let chord = |index: i32| {
        let ([x0, y0], [x1, y1]) = (point(index), point(index + 1));
        (x1 - x0).hypot(y1 - y0)
    };
    let expected: f64 = (0..400_000).map(chord).sum();
    assert!((hyperbola.length() / expected - 1.0).abs() < 1e-10);
    Ok(())
}

/// Curves of every kind about (100, 50), with ends on them and off them.
fn curves() -> Result<Vec<Conic>, GeometryError> {
    let mut curves = vec![
        Conic::ellipse([9, 4], [108, 52], [92, 48], [100, 50], Clockwise)?,
        Conic::ellipse([9, 4], [108, 52], [92, 48], [100, 50], CounterClockwise)?,
        Conic::ellipse([4, 9], [104, 50], [104, 50], [100, 50], Clockwise)?,
    ];
    let at = |opens, point| {
        let [x, y] = turned(opens, point);
        [x + 100, y + 50]
    };
    for opens in OPEN {
        for [from, to] in [[[4, -4], [9, 6]], [[9, 6], [1, 2]]] {
            curves.push(Conic::parabola(4, Some(opens), at(opens, from), at(opens, to), [100, 50])?);
        }
        for [from, to] in [[[5, -5], [3, 0]], [[4, 3], [6, -7]]] {
            curves.push(Conic::hyperbola([3, 4], Some(opens), at(opens, from), at(opens, to), [100, 50])?);
        }
    }
    Ok(curves)
}

/// How far a point lies off a curve, as a part of its size.
fn off(shape: Shape, [x, y]: [f64; 2]) -> f64 {
    match shape {
        Shape::Ellipse { semi_axes: [a, b] } => (x / a as f64).powi(2) + (y / b as f64).powi(2) - 1.0,
        Shape::Parabola { c, opens } => {
            let [along, across] = opens.along_across([x, y]);
            across * across / c as f64 - along
        }
        Shape::Hyperbola { semi_axes: [a, b], opens } => {
            let [along, across] = opens.along_across([x, y]);
            (along / a as f64).powi(2) - (across / b as f64).powi(2) - along.signum()
        }
    }
}

#[test]
fn outlines_run_along_the_curve_from_end_to_end() -> Outcome {
    for curve in curves()? {
        let points = curve.outline(2_001);
        assert_eq!((points.len(), curve.outline(0).len()), (2_001, 2));
        let [from, to] = [curve.from(), curve.to()].map(|end| end.map(|c| c as f64));
        assert_eq!((points.first(), points.last()), (Some(&from), Some(&to)));
        let relative: Vec<_> = points.iter().map(|[x, y]| [x - 100.0, y - 50.0]).collect();
        assert!(relative[1..2_000].iter().all(|point| off(curve.shape(), *point).abs() < 1e-9), "{curve:?}");
        let chords = points.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
        let along: f64 = chords.sum();
        assert!((along - curve.length()).abs() < 2.0, "{curve:?}: {along} {}", curve.length());
        let motion = curve.sectors()[0].motion;
        let gain = [0, 1].map(|axis: usize| (relative[9][axis] - relative[1][axis]) * motion[axis] as f64);
        assert!(gain[0] > 0.0 && gain[1] > 0.0, "{curve:?}");
    }
    Ok(())
}
