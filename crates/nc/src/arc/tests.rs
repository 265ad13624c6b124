use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::*;
use crate::COORDINATE_LIMIT as L;
use crate::Direction::{Clockwise, CounterClockwise};
use crate::Quadrant::{I, II, III, IV};

type Outcome = Result<(), GeometryError>;

const ORIGIN: [i64; 2] = [0, 0];

#[test]
fn an_end_point_up_to_one_blu_off_the_circle_is_taken() -> Outcome {
    let exact = Arc::new([5, 0], [3, 4], ORIGIN, CounterClockwise)?;
    assert!(exact.ends_on_circle());
    for to in [[0, 6], [0, 4], [4, 4]] {
        let near = Arc::new([5, 0], to, ORIGIN, CounterClockwise)?;
        assert!(!near.ends_on_circle());
    }
    for to in [[1, 6], [0, 7], [2, 3], [0, 1]] {
        let off = Arc::new([5, 0], to, ORIGIN, CounterClockwise);
        assert!(matches!(off, Err(GeometryError::EndOffCircle { .. })), "{to:?}");
    }
    Ok(())
}

#[test]
fn one_blu_off_a_circle_at_the_limit_differs_from_a_hair_more() {
    let [from, center] = [[-L, 0], [L, 0]]; // R = 2^53
    assert!(Arc::new(from, [-L + 1, 0], center, Clockwise).is_ok());
    // R - 1 inwards and 1 BLU aside is nearer to the circle by 2^-54 BLU; the same outwards is too
    // far.
    assert!(Arc::new(from, [-L + 1, 1], center, Clockwise).is_ok());
    let (from, center) = ([-L + 1, 0], [L, 0]);
    assert!(Arc::new(from, [-L, 0], center, Clockwise).is_ok());
    assert!(Arc::new(from, [-L, 1], center, Clockwise).is_err());
}

#[test]
fn the_centre_is_neither_a_start_nor_an_end() {
    let start = Arc::new([2, 3], [4, 3], [2, 3], Clockwise);
    assert_eq!(start, Err(GeometryError::ZeroRadius { center: [2, 3] }));
    let end = Arc::new([3, 3], [2, 3], [2, 3], Clockwise);
    assert_eq!(end, Err(GeometryError::EndAtCenter { center: [2, 3] }));
}

#[test]
fn quadrants_of_axis_points_follow_the_motion() -> Outcome {
    for (direction, start, end) in [(CounterClockwise, I, IV), (Clockwise, IV, I)] {
        let circle = Arc::new([5, 0], [5, 0], ORIGIN, direction)?;
        assert!(circle.is_full_circle());
        assert_eq!((circle.start_quadrant(), circle.end_quadrant()), (start, end));
        assert_eq!(circle.crossings(), 3);
    }
    let half = Arc::new([0, 5], [0, -5], ORIGIN, CounterClockwise)?;
    assert_eq!((half.start_quadrant(), half.end_quadrant(), half.crossings()), (II, III, 1));
    Ok(())
}

#[test]
fn an_end_short_of_the_start_in_its_quadrant_makes_nearly_a_full_turn() -> Outcome {
    let ahead = Arc::new([4, 3], [3, 4], ORIGIN, CounterClockwise)?;
    assert_eq!(ahead.crossings(), 0);
    let after = Arc::new([4, 3], [3, 4], ORIGIN, Clockwise)?;
    assert_eq!(after.crossings(), 4);
    assert!((ahead.sweep() + after.sweep() - TAU).abs() < 1e-15);
    Ok(())
}

#[test]
fn sweeps_run_from_above_zero_to_a_full_turn() -> Outcome {
    let sweep = |to, direction| Arc::new([5, 0], to, ORIGIN, direction).map(|arc| arc.sweep());
    assert_eq!(sweep([0, 5], CounterClockwise)?, FRAC_PI_2);
    assert_eq!(sweep([0, 5], Clockwise)?, 3.0 * FRAC_PI_2);
    assert_eq!(sweep([-5, 0], Clockwise)?, PI);
    assert_eq!(sweep([-5, 0], CounterClockwise)?, PI);
    assert_eq!(sweep([5, 0], Clockwise)?, TAU);
    assert_eq!(sweep([6, 0], CounterClockwise)?, TAU); // the same ray, off the circle: a turn as well
    Ok(())
}

#[test]
fn outside_is_positive_and_a_circle_at_the_limit_keeps_every_digit() -> Outcome {
    let arc = Arc::new([-L, -L], [L, L], [L, -L], Clockwise)?;
    assert_eq!(arc.radius_squared(), 1 << 106);
    let off = [([L, L - 1], -1.0), ([L, L + 1], 1.0), ([-L + 3, -L], -3.0), ([L + (1 << 27), L], 1.0)];
    for (position, expected) in off {
        let reached = arc.signed_deviation(&position);
        assert!((reached - expected).abs() < 1e-15, "{position:?}: {reached}");
        assert_eq!(arc.deviation(&position), reached.abs());
    }
    assert_eq!(arc.deviation(&[L, L]), 0.0);
    Ok(())
}

#[test]
fn any_position_has_a_deviation_without_overflow() -> Outcome {
    let arc = Arc::new([-L, -L], [-L, -L], [L, L], Clockwise)?;
    for position in [[i64::MAX, i64::MAX], [i64::MIN, i64::MIN], [i64::MIN, i64::MAX]] {
        assert!(arc.deviation(&position).is_finite());
    }
    assert!(arc.deviation(&[0]).is_nan());
    assert_eq!(arc.deviation(&[-L, -L, 99]), 0.0);
    Ok(())
}

#[test]
fn an_outline_runs_along_the_circle_in_the_sense_of_the_motion() -> Outcome {
    let arc = Arc::new([15, 10], [10, 15], [10, 10], Clockwise)?;
    let points = arc.outline(4);
    let expected = [[15.0, 10.0], [10.0, 5.0], [5.0, 10.0], [10.0, 15.0]];
    for (point, wanted) in points.iter().zip(expected) {
        assert!((point[0] - wanted[0]).hypot(point[1] - wanted[1]) < 1e-14, "{point:?} {wanted:?}");
    }
    assert_eq!(points.len(), 4);
    assert_eq!((points[0], points[3]), (expected[0], expected[3]));
    assert_eq!(arc.outline(0), [expected[0], expected[3]]);
    assert_eq!(arc.outline(usize::MAX).len(), crate::OUTLINE_LIMIT);
    Ok(())
}
