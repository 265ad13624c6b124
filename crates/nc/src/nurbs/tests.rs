use super::*;
use crate::Curve;

fn points(all: &[[i64; 3]]) -> Vec<ControlPoint> {
    all.iter().map(|&[x, y, weight]| ControlPoint { at: [x, y], weight }).collect()
}

const ONE: i64 = NURBS_UNIT;
const HALF_ROOT: i64 = 707_106_781;

/// A full circle of 9 points.
fn circle(radius: i64) -> Nurbs {
    let corner = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let weight = |index: usize| if index.is_multiple_of(2) { ONE } else { HALF_ROOT };
    let all: Vec<_> =
        corner.iter().enumerate().map(|(index, [x, y])| [x * radius, y * radius, weight(index)]).collect();
    let knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(|knot| knot * ONE);
    Nurbs::new(2, &points(&all), Some(&knots)).unwrap()
}

#[test]
fn a_circle_is_a_nurbs() {
    let curve = circle(1000);
    // The weights are rounded to 10^-9.
    assert!((curve.length() - 2000.0 * std::f64::consts::PI).abs() < 1e-4, "{}", curve.length());
    for at in curve.outline(101) {
        assert!((at[0].hypot(at[1]) - 1000.0).abs() < 1e-6, "{at:?}");
    }
    for (position, off) in [([0, 0], -1000.0), ([600, 800], 0.0), ([-30, 40], -950.0), ([1200, -1600], 1000.0)] {
        let found = curve.signed_deviation(&position);
        // Left of a circle against the clock is inside.
        assert!((found + off).abs() < 1e-5, "{position:?}: {found}");
        assert_eq!(curve.deviation(&position), found.abs());
    }
    let curve: Curve = curve.into();
    assert_eq!(curve.description().curve(), Ok(curve));
}

#[test]
fn distances_are_the_least_of_many_places() {
    let control = [[0, 0, ONE], [30, 50, 3 * ONE], [60, -20, ONE / 5], [-10, 30, ONE], [70, 70, 2 * ONE], [9, 9, ONE]];
    for degree in 1..=5 {
        let curve = Nurbs::new(degree, &points(&control), None).unwrap();
        let outline = curve.outline(20_001);
        for (x, y) in (-20..90).step_by(11).flat_map(|x| (-30..80).step_by(9).map(move |y| (x, y))) {
            let least = outline.iter().map(|at| (at[0] - x as f64).hypot(at[1] - y as f64)).fold(f64::MAX, f64::min);
            let found = curve.deviation(&[x, y]);
            assert!(found <= least + 1e-9 && found > least - 0.05, "degree {degree}, ({x}, {y}): {found}, {least}");
        }
        let length: f64 = outline.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum();
        assert!((curve.length() - length).abs() < 1e-3 * length, "degree {degree}: {} and {length}", curve.length());
    }
}

#[test]
fn a_bezier_curve_is_a_nurbs_of_one_span() {
    let curve = Nurbs::bezier(&[[0, 0], [4, 0], [8, 4], [8, 8]]).unwrap();
    assert_eq!((curve.degree(), curve.knots()), (3, &[0, 0, 0, 0, ONE, ONE, ONE, ONE][..]));
    assert_eq!(curve.outline(3)[1], [5.5, 2.5]);
}

#[test]
fn what_gives_no_curve_is_refused_with_its_remedy() {
    let three = points(&[[0, 0, ONE], [5, 5, ONE], [9, 0, ONE]]);
    let message = |degree, points: &[ControlPoint], knots: &[i64]| {
        let knots: Vec<_> = knots.iter().map(|knot| knot * ONE).collect();
        Nurbs::new(degree, points, Some(&knots)).unwrap_err().to_string()
    };
    for (degree, knots, wanted) in [
        (0, &[0, 0, 1, 2][..], "give a degree from 1 to 2"),
        (3, &[0; 7], "give a degree from 1 to 2"),
        (2, &[0, 0, 0, 1, 1], "5 knots were given, but points + degree + 1 = 6"),
        (2, &[0, 0, 0, 2, 1, 1], "knot 5 is less than the one before it"),
        (2, &[0, 0, 1, 2, 2, 2], "the first 3 knots must be equal"),
        (2, &[0, 0, 0, 1, 1, 2], "the first 3 knots must be equal, and the last 3 too"),
        (2, &[0; 6], "knot 2 is repeated more than 2 times"),
        (2, &[0, 0, 0, 1_000_001, 1_000_001, 1_000_001], "the knots span more than 1000000"),
    ] {
        let found = message(degree, &three, knots);
        assert!(found.contains(wanted), "{found}");
    }
    let four = points(&[[0, 0, ONE], [5, 5, ONE], [9, 0, ONE], [9, 9, ONE]]);
    let found = message(1, &four, &[0, 0, 1, 1, 2, 2]);
    assert!(found.contains("knot 3 is repeated more than 1 times"), "{found}");
    let found = message(2, &points(&[[0, 0, ONE], [5, 5, 0], [9, 0, ONE]]), &[0, 0, 0, 1, 1, 1]);
    assert!(found.contains("point 2 has the weight 0"), "{found}");
    let found = message(1, &three[..1], &[0, 0, 1]);
    assert!(found.contains("2 to 1024 points"), "{found}");
    let found = message(1, &points(&[[4, 4, ONE], [4, 4, ONE]]), &[0, 0, 1, 1]);
    assert!(found.contains("single point (4, 4)"), "{found}");
}
