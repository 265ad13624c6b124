//! What is refused as a conic, and with which words.

use super::*;

fn message(result: Result<Conic, GeometryError>) -> String {
    result.err().map(|error| error.to_string()).unwrap_or_default()
}

#[test]
fn every_message_names_the_value_the_limit_and_the_remedy() {
    let ellipse = |axes, from, to| message(Conic::ellipse(axes, from, to, [10, 20], Clockwise));
    let parabola = |c, opens, from, to| message(Conic::parabola(c, opens, from, to, [10, 20]));
    let hyperbola = |axes, opens, from, to| message(Conic::hyperbola(axes, opens, from, to, [10, 20]));
    let plus_x = Some(Opens::PlusX);
    assert_eq!(
        parabola(-4, None, [10, 20], [6, 24]),
        "c = -4 BLU, but at least 1 BLU is needed: give a positive length, and for another orientation say where the \
         curve opens to"
    );
    assert_eq!(
        ellipse([5, (1 << 26) + 1], [10, 20], [6, 24]),
        "b = 67108865 BLU is beyond the limit of 67108864 BLU for a conic: choose a larger BLU"
    );
    assert_eq!(
        parabola((1 << 40) + 1, None, [10, 20], [6, 24]),
        "c = 1099511627777 BLU is beyond the limit of 1099511627776 BLU for a conic: choose a larger BLU"
    );
    assert_eq!(
        hyperbola([4, 3], plus_x, [14, 20], [14, 67_108_885]),
        "the end point (14, 67108885) has y = 67108865 BLU relative to the centre, beyond the limit of ±67108864 BLU \
         for a conic: choose a larger BLU"
    );
    assert_eq!(
        ellipse([5, 3], [15, 20], [10, 25]),
        "the end point (10, 25) lies 2.000 BLU off the ellipse of semi-axes 5, 3 BLU, and at most 1 BLU is allowed: \
         correct the point, the centre or the size of the curve"
    );
    assert_eq!(
        parabola(4, None, [3, 20], [10, 20]),
        "the start point (3, 20) lies 4.580 BLU off the parabola of c = 4 BLU opening to +y, and at most 1 BLU is \
         allowed: correct the point, the vertex or the size of the curve"
    );
    assert_eq!(
        ellipse([9, 1], [10, 20], [19, 20]),
        "the start point (10, 20) lies 1.000 BLU off the ellipse of semi-axes 9, 1 BLU and at its centre, from where \
         no direction leads along it: correct the point or the centre"
    );
    assert_eq!(
        parabola(4, plus_x, [9, 20], [14, 24]),
        "the start point (9, 20) lies 1.000 BLU off the parabola of c = 4 BLU opening to +x and behind its vertex: \
         correct the point or the vertex"
    );
    assert_eq!(
        hyperbola([1, 3], plus_x, [11, 20], [10, 20]),
        "the end point (10, 20) lies 1.000 BLU off the hyperbola of semi-axes 1, 3 BLU opening to +x and not on its \
         branch: correct the point or the centre"
    );
    assert_eq!(
        hyperbola([4, 3], plus_x, [14, 20], [14, 20]),
        "the hyperbola of semi-axes 4, 3 BLU opening to +x ends where it starts and has length 0, but at least 1 BLU \
         is needed: drop the block"
    );
    assert_eq!(
        parabola(4, plus_x, [12, 22], [11, 23]),
        "the way from (12, 22) to (11, 23) leads across the parabola of c = 4 BLU opening to +x and not along it, as \
         both ends lie off the curve (up to 1 BLU is allowed): move one of them onto the curve"
    );
}

#[test]
fn limits_are_allowed_and_one_more_is_not() {
    let limit = CONIC_LIMIT;
    let ellipse = |a, b| Conic::ellipse([a, b], [a, 0], [0, b], ORIGIN, Clockwise);
    let hyperbola = |a, b| Conic::hyperbola([a, b], Some(Opens::PlusX), [a, 0], [a - i64::from(b == 1), 1 % b], ORIGIN);
    let parabola = |c| Conic::parabola(c, None, ORIGIN, [0, 1], ORIGIN);
    assert!(hyperbola(1, limit).is_ok() && hyperbola(limit, limit).is_ok());
    for [a, b] in [[1, limit], [limit, 1], [limit, limit]] {
        assert!(ellipse(a, b).is_ok());
    }
    for build in [ellipse, hyperbola] as [fn(i64, i64) -> _; 2] {
        for size in [0, -1, i64::MIN] {
            assert_eq!(build(size, 2), Err(GeometryError::NotPositive { name: 'a', value: size }));
        }
        for value in [limit + 1, i64::MAX] {
            assert_eq!(build(value, 2), Err(GeometryError::ConicBeyondLimit { name: 'a', value, limit }));
            assert_eq!(build(2, value), Err(GeometryError::ConicBeyondLimit { name: 'b', value, limit }));
        }
    }
    assert!(parabola(PARABOLA_LIMIT).is_ok());
    let beyond = GeometryError::ConicBeyondLimit { name: 'c', value: i64::MAX, limit: PARABOLA_LIMIT };
    assert_eq!(parabola(i64::MAX), Err(beyond));
}

#[test]
fn any_points_are_taken_or_refused() {
    let values = [0, 1, -1, 5, CONIC_LIMIT, -CONIC_LIMIT - 1, L, -L, i64::MAX, i64::MIN];
    let points: Vec<Point> = values.into_iter().flat_map(|x| values.map(|y| [x, y])).collect();
    for (from, to) in points.iter().flat_map(|from| points.iter().map(move |to| (*from, *to))) {
        for center in [ORIGIN, [L, -L], [i64::MIN, 3]] {
            let far = [from, to, center].iter().flatten().any(|c| c.unsigned_abs() > L.unsigned_abs());
            let ellipse = Conic::ellipse([5, 5], from, to, center, Clockwise);
            let parabola = Conic::parabola(5, None, from, to, center);
            let hyperbola = Conic::hyperbola([5, 5], None, from, to, center);
            assert!(!far || [ellipse, parabola, hyperbola].iter().all(Result::is_err));
        }
    }
}

#[test]
fn one_blu_off_is_taken_in_every_direction() {
    // On a circle as an ellipse these points lie exactly 1 BLU off, which f64 need not show.
    for (point, radius) in [([6, 8], 9), ([6, 8], 11), ([5, 12], 12), ([5, 12], 14), ([8, 15], 18), ([20, 21], 28)] {
        assert!(Conic::ellipse([radius; 2], point, point, ORIGIN, Clockwise).is_ok());
    }
    let limit = CONIC_LIMIT;
    let ellipse = |point| Conic::ellipse([limit - 1, limit - 1], point, point, ORIGIN, Clockwise);
    assert!(ellipse([limit, 0]).is_ok() && ellipse([0, limit - 2]).is_ok());
    assert!(ellipse([limit, 40]).is_err()); // 1.00001 BLU
}
