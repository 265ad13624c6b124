use super::*;

type Tested = Result<(), GeometryError>;

#[test]
fn coefficients_are_those_of_the_four_forms() -> Tested {
    let of = |form, points: &[[i64; 2]]| Spline::new(form, points).map(|spline| spline.segments().to_vec());
    let bezier = of(SplineForm::Bezier, &[[0, 1], [5, 1], [7, -3]])?;
    assert_eq!(bezier[0], SplineSegment { coefficients: [[0, 10, -3, 0], [1, 0, -4, 0]], divisor: 1 });
    // The same curve as a cubic, its inner points at two thirds, and as a Hermite segment.
    let cubic = of(SplineForm::Bezier, &[[0, 0], [12, 6], [18, 0], [18, -9]])?;
    let hermite = of(SplineForm::Hermite, &[[0, 0], [36, 18], [18, -9], [0, -27]])?;
    assert_eq!(cubic, hermite);
    // A chain passes all of its points, or is the mean of three of them.
    let points = [[0, 0], [10, 4], [13, -7], [2, 2], [2, 9]];
    let chain = Spline::new(SplineForm::CatmullRom, &points)?;
    let ends: Vec<_> = chain.segments().iter().map(SplineSegment::ends).collect();
    assert_eq!(ends, [[points[0], points[1]], [points[1], points[2]], [points[2], points[3]], [points[3], points[4]]]);
    let along = Spline::new(SplineForm::BSpline, &points)?;
    assert_eq!(along.segments().len(), 2);
    assert_eq!(along.from(), [9, 2], "(0 + 40 + 13)/6, (0 + 16 - 7)/6 upwards");
    Ok(())
}

#[test]
fn segments_of_a_chain_meet_with_one_tangent() -> Tested {
    let points: Vec<_> = (0..40).map(|index: i64| [index * index * 7 % 113, index * 31 % 57]).collect();
    for form in [SplineForm::CatmullRom, SplineForm::BSpline] {
        for pair in Spline::new(form, &points)?.segments().windows(2) {
            for axis in 0..2 {
                assert!((pair[0].at(1.0)[axis] - pair[1].at(0.0)[axis]).abs() < 1e-9);
                assert!((pair[0].tangent(1.0)[axis] - pair[1].tangent(0.0)[axis]).abs() < 1e-9);
            }
        }
    }
    Ok(())
}

#[test]
fn distances_are_those_of_a_fine_search() -> Tested {
    let curves = [
        Spline::new(SplineForm::Bezier, &[[0, 0], [40, 0], [80, 40], [80, 80]])?,
        // A loop, and a cusp.
        Spline::new(SplineForm::Bezier, &[[0, 0], [120, 90], [-40, 90], [80, 0]])?,
        Spline::new(SplineForm::Bezier, &[[0, 0], [90, 90], [0, 90], [90, 0]])?,
        Spline::new(SplineForm::CatmullRom, &[[0, 0], [30, 50], [60, -20], [90, 30], [90, 60]])?,
        // More segments than one box has.
        Spline::new(SplineForm::CatmullRom, &(0..90).map(|at| [at * 37 % 101, at * 23 % 89]).collect::<Vec<_>>())?,
    ];
    for curve in &curves {
        for position in (-20..=120).step_by(9).flat_map(|x| (-30..=120).step_by(11).map(move |y| [x, y])) {
            let parts = if curve.segments().len() > 9 { 2_000 } else { 20_000 };
            let places = |segment: &SplineSegment| {
                let segment = *segment;
                (0..=parts).map(move |part| segment.at(f64::from(part) / f64::from(parts)))
            };
            let distances = curve.segments().iter().flat_map(places);
            let [x, y] = position.map(|c: i64| c as f64);
            let searched = distances.map(|[px, py]| (px - x).hypot(py - y)).fold(f64::MAX, f64::min);
            let found = curve.deviation(&position);
            assert!(found <= searched + 1e-9 && searched - found < 0.02, "{position:?}: {found} {searched}");
            assert_eq!(curve.signed_deviation(&position).abs(), found);
        }
    }
    Ok(())
}

#[test]
fn lengths_are_those_of_closed_forms() -> Tested {
    let straight = Spline::new(SplineForm::Bezier, &[[0, 0], [1, 1], [299, 399], [300, 400]])?;
    assert!((straight.length() - 500.0).abs() < 0.1, "{}", straight.length());
    // The parabola y = x² / 400 from (0, 0) to (200, 100).
    let parabola = Spline::new(SplineForm::Bezier, &[[0, 0], [100, 0], [200, 100]])?;
    let closed = 100.0 * (2f64.sqrt() + 1f64.asinh());
    assert!((parabola.length() - closed).abs() < 1e-9, "{} {closed}", parabola.length());
    Ok(())
}

#[test]
fn what_is_no_curve_is_refused_with_the_numbers() {
    let refused = |form, points: &[[i64; 2]]| Spline::new(form, points).unwrap_err().to_string();
    let said = refused(SplineForm::Bezier, &[[0, 0], [1, 1]]);
    assert!(said.contains("3 or 4 points") && said.contains("2 were given"), "{said}");
    let said = refused(SplineForm::BSpline, &[[0, 0], [1, 1], [2, 2]]);
    assert!(said.contains("4 points or more") && said.contains("3 were given"), "{said}");
    let said = refused(SplineForm::CatmullRom, &[[7, -2], [7, -2]]);
    assert!(said.contains("(7, -2)") && said.contains("single point"), "{said}");
    let said = refused(SplineForm::Bezier, &[[0, 0], [1, 1], [1 << 53, 0]]);
    assert!(said.contains("limit"), "{said}");
}
