use super::*;
use crate::COORDINATE_LIMIT as L;
use crate::Direction::{Clockwise, CounterClockwise};

mod distance;
mod errors;
mod path;
mod sectors;

type Outcome = Result<(), GeometryError>;
type Point = [i64; 2];

const ORIGIN: Point = [0, 0];
const OPEN: [Opens; 4] = Opens::ALL;

/// The lattice points with both coordinates in `-reach..=reach`.
fn lattice(reach: i64) -> impl Iterator<Item = Point> + Clone {
    (-reach..=reach).flat_map(move |x| (-reach..=reach).map(move |y| [x, y]))
}

/// What a mirrored curve has of these coordinates, where the unmirrored one opens to +x.
fn turned(opens: Opens, point: Point) -> Point {
    opens.plane(point)
}

#[test]
fn implicit_functions_are_those_of_the_textbooks() -> Outcome {
    let ellipse = Conic::ellipse([6, 4], [6, 0], [0, 4], ORIGIN, CounterClockwise)?;
    assert_eq!([[0, 0], [6, 0], [0, -4], [-3, 2]].map(|point| ellipse.implicit(point)), [-576, 0, 0, -288]);
    let parabola = |opens, end| Conic::parabola(4, Some(opens), ORIGIN, end, ORIGIN);
    for (opens, end) in OPEN.into_iter().zip([[4, 4], [-4, 4], [4, 4], [4, -4]]) {
        let parabola = parabola(opens, end)?;
        for [x, y] in lattice(5) {
            let expected = match opens {
                Opens::PlusX => y * y - 4 * x,
                Opens::MinusX => y * y + 4 * x,
                Opens::PlusY => x * x - 4 * y,
                Opens::MinusY => x * x + 4 * y,
            };
            assert_eq!(parabola.implicit([x, y]), expected.into());
        }
    }
    for opens in OPEN {
        let [from, to] = [[3, 0], [5, 3]].map(|point| turned(opens, point)); // y = 2.67 at x = 5
        let hyperbola = Conic::hyperbola([3, 2], Some(opens), from, to, ORIGIN)?;
        for [x, y] in lattice(5) {
            let expected = if opens.axis() == 0 { 4 * x * x - 9 * y * y } else { 4 * y * y - 9 * x * x };
            assert_eq!(hyperbola.implicit([x, y]), i128::from(expected - 36));
        }
    }
    Ok(())
}

#[test]
fn implicit_functions_keep_their_sign_at_every_point() -> Outcome {
    const M: i64 = i64::MAX;
    let limit = CONIC_LIMIT;
    let ellipse = Conic::ellipse([limit, limit], [limit, 0], [limit, 0], ORIGIN, Clockwise)?;
    assert_eq!(ellipse.implicit([limit, limit]), 1 << 104);
    assert_eq!(ellipse.implicit([i64::MIN, M]), i128::MAX - (1 << 104));
    let hyperbola = Conic::hyperbola([limit, limit], None, [limit, 0], [limit, 1], ORIGIN)?;
    assert_eq!(hyperbola.implicit([M, M]), -(1 << 104));
    assert!(hyperbola.implicit([i64::MIN, 0]) > 0 && hyperbola.implicit([0, i64::MIN]) < 0);
    let parabola = Conic::parabola(PARABOLA_LIMIT, None, ORIGIN, [1, 1 << 20], ORIGIN)?;
    assert_eq!(parabola.implicit([0, i64::MIN]), 1 << 126);
    assert_eq!(parabola.implicit([i64::MIN, 0]), 1 << 103);
    Ok(())
}

#[test]
fn weights_are_the_mean_slopes_of_the_implicit_function() -> Outcome {
    let mut curves = vec![Conic::ellipse([7, 3], [7, 0], [7, 0], ORIGIN, Clockwise)?];
    for opens in OPEN {
        curves.push(Conic::parabola(5, Some(opens), ORIGIN, turned(opens, [5, 5]), ORIGIN)?);
        curves.push(Conic::hyperbola([5, 2], Some(opens), turned(opens, [5, 0]), turned(opens, [7, 2]), ORIGIN)?);
    }
    for curve in curves {
        let doubled = if matches!(curve.shape(), Shape::Parabola { .. }) { 2 } else { 1 };
        for [x, y] in lattice(9).filter(|[x, y]| *x >= 0 && *y >= 0) {
            for (axis, next) in [[x + 1, y], [x, y + 1]].into_iter().enumerate() {
                let magnitude = [x, y][axis];
                let gained = (curve.implicit(next) - curve.implicit([x, y])).abs() * doubled;
                let weight = curve.weights()[axis];
                assert_eq!(gained, weight.at(magnitude) + weight.at(magnitude + 1), "{curve:?} {x} {y}");
            }
        }
    }
    assert_eq!(Weight { slope: i128::MAX, constant: 9 }.at(2), i128::MAX);
    Ok(())
}

#[test]
fn coordinates_are_relative_to_the_centre_wherever_it_is() -> Outcome {
    for center in [[100, -50], [L - 9, 9 - L]] {
        let at = |[x, y]: Point| [center[0] + x, center[1] + y];
        for (start, end) in [([5, 0], [0, 3]), ([4, 2], [-3, -2])] {
            let here = Conic::ellipse([5, 3], start, end, ORIGIN, Clockwise)?;
            let there = Conic::ellipse([5, 3], at(start), at(end), center, Clockwise)?;
            assert_eq!((there.start(), there.end(), there.center()), (start, end, center));
            assert_eq!((there.from(), there.to()), (at(start), at(end)));
            assert_eq!((here.sectors(), here.length()), (there.sectors(), there.length()));
            assert_eq!(here.deviation(&[7, -2]), there.deviation(&at([7, -2])));
        }
        let parabola = Conic::parabola(4, None, at([1, -2]), at([4, 4]), center)?;
        assert_eq!((parabola.opens(), parabola.start()), (Some(Opens::PlusX), [1, -2]));
        assert_eq!(parabola.signed_deviation(&at([-3, 0])), 3.0);
    }
    Ok(())
}

#[test]
fn only_an_ellipse_has_a_direction_and_only_an_open_curve_a_side_to_open_to() -> Outcome {
    let ellipse = Conic::ellipse([5, 3], [5, 0], [0, 3], ORIGIN, Clockwise)?;
    assert_eq!((ellipse.direction(), ellipse.opens()), (Some(Clockwise), None));
    let hyperbola = Conic::hyperbola([5, 3], None, [-5, 0], [-7, 3], ORIGIN)?;
    assert_eq!((hyperbola.direction(), hyperbola.opens()), (None, Some(Opens::MinusX)));
    assert!(ellipse.ends_on_curve() && !hyperbola.ends_on_curve());
    Ok(())
}

#[test]
fn an_orientation_is_found_from_exact_points() -> Outcome {
    for opens in OPEN {
        for c in 1..=30 {
            // All exact points of y² = cx up to y = 30 but the vertex; two of them are on one side or on both.
            let points: Vec<Point> = (-30..=30).filter(|y| *y != 0 && y * y % c == 0).map(|y| [y * y / c, y]).collect();
            for from in &points {
                for to in points.iter().filter(|to| *to != from) {
                    let [from, to] = [*from, *to].map(|point| turned(opens, point));
                    let found = Conic::parabola(c, None, from, to, ORIGIN)?;
                    // With |x| = |y| = c at both ends, two orientations hold both, and the first of them is taken.
                    let all = OPEN.into_iter().filter(|opens| {
                        Conic::parabola(c, Some(*opens), from, to, ORIGIN).is_ok_and(|curve| curve.ends_on_curve())
                    });
                    assert_eq!(found.opens(), all.clone().next());
                    assert!(all.clone().any(|any| any == opens) && found.ends_on_curve());
                }
            }
        }
        for (semi_axes, to) in [([3, 4], [5, 5]), ([5, 12], [13, -29]), ([1, 1], [1, -1])] {
            let [from, to] = [[semi_axes[0], 0], to].map(|point| turned(opens, point));
            let found = Conic::hyperbola(semi_axes, None, from, to, ORIGIN)?;
            assert_eq!(found.opens(), Some(opens), "{from:?} {to:?}");
        }
    }
    Ok(())
}

#[test]
fn a_nearer_orientation_goes_before_a_farther_and_an_exact_one_before_all() -> Outcome {
    let found = |c, from, to| Conic::parabola(c, None, from, to, ORIGIN).map(|curve| curve.opens());
    // x² = 4y holds (2, 1) and (4, 4) exactly, y² = 4x the second only and lies 0.75 BLU off the first.
    assert_eq!(found(4, [2, 1], [4, 4])?, Some(Opens::PlusY));
    assert!(Conic::parabola(4, Some(Opens::PlusX), [3, 4], [4, 4], ORIGIN).is_ok());
    assert_eq!(found(4, ORIGIN, [4, 4])?, Some(Opens::PlusX)); // both are exact
    assert_eq!(found(4, ORIGIN, [-4, 4])?, Some(Opens::MinusX)); // and so are these
    assert_eq!(found(4, ORIGIN, [-4, -4])?, Some(Opens::MinusX));
    assert_eq!(found(4, ORIGIN, [4, -4])?, Some(Opens::PlusX));
    // Not exact: (3, 4) lies nearer to y² = 4x, (4, 3) nearer to x² = 4y, though each is taken on both.
    assert_eq!([found(4, ORIGIN, [3, 4])?, found(4, ORIGIN, [4, 3])?], [Some(Opens::PlusX), Some(Opens::PlusY)]);
    assert!(Conic::parabola(4, Some(Opens::PlusX), ORIGIN, [4, 3], ORIGIN).is_ok());
    Ok(())
}
