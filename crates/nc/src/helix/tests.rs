use std::f64::consts::PI;

use super::*;
use crate::COORDINATE_LIMIT as L;
use crate::Curve;
use crate::Direction::{Clockwise, CounterClockwise};

type Outcome = Result<(), GeometryError>;

const ORIGIN: [i64; 2] = [0, 0];

/// A position on the ideal helix about the origin, rounded where `f64` has to be.
fn at(helix: &Helix, part: f64) -> [f64; 3] {
    let [sx, sy] = helix.arc().start().map(|c| c as f64);
    let turn = if helix.arc().direction() == Clockwise { -part } else { part } * helix.angle();
    let (sin, cos) = turn.sin_cos();
    [sx * cos - sy * sin, sx * sin + sy * cos, helix.from()[2] as f64 + helix.z_travel() as f64 * part]
}

#[test]
fn shares_of_z_are_rounded_and_the_last_is_exact() -> Outcome {
    let shares = |to, direction| -> Result<Vec<i64>, GeometryError> {
        let helix = Helix::new([5, 0, 2], to, ORIGIN, direction)?;
        Ok(helix.sectors().iter().map(|sector| sector.z_steps).collect())
    };
    assert_eq!(shares([5, 0, 12], CounterClockwise)?, [3, 5, 8, 10]); // 2.5, 5, 7.5
    assert_eq!(shares([5, 0, -8], Clockwise)?, [3, 5, 8, 10]);
    assert_eq!(shares([0, -5, 2], CounterClockwise)?, [0, 0, 0]);
    assert_eq!(shares([3, -4, 102], CounterClockwise)?, [29, 59, 88, 100]); // θ = 306.87°
    assert_eq!(shares([0, 5, L], CounterClockwise)?, [L - 2]);
    for from in [[3, 4, 0], [-4, 3, 0], [0, -5, 0]] {
        for travel in -40..=40 {
            let helix = Helix::new(from, [from[0], from[1], travel], ORIGIN, Clockwise)?;
            let sectors = helix.sectors();
            assert!(sectors.is_sorted_by_key(|sector| sector.z_steps));
            assert_eq!(sectors.last().map(|sector| sector.z_steps), Some(travel.abs()));
            let planes: Vec<Sector> = sectors.iter().map(|sector| sector.plane).collect();
            assert_eq!(planes, helix.arc().sectors(Crossing::RoundedRadius));
        }
    }
    Ok(())
}

#[test]
fn a_helix_has_an_angle_a_travel_in_z_and_a_length() -> Outcome {
    let helix = Helix::new([13, 20, 5], [13, 20, -7], [10, 20], Clockwise)?;
    assert_eq!((helix.angle(), helix.z_travel(), helix.from(), helix.to()), (TAU, -12, [13, 20, 5], [13, 20, -7]));
    assert!((helix.length() - (6.0 * PI).hypot(12.0)).abs() < 1e-12);
    let curve: Curve = helix.into();
    assert_eq!((curve.from(), curve.to(), curve.axes()), (&[13, 20, 5][..], &[13, 20, -7][..], 3));
    assert_eq!((curve.length(), curve.outline(7)), (helix.length(), helix.arc().outline(7)));
    Ok(())
}

#[test]
fn what_the_arc_refuses_the_helix_does_and_z_has_its_limit() {
    let helix = |from, to| Helix::new(from, to, ORIGIN, Clockwise);
    assert_eq!(helix([0, 0, 0], [1, 0, 0]), Err(GeometryError::ZeroRadius { center: ORIGIN }));
    assert!(matches!(helix([5, 0, 0], [0, 9, 0]), Err(GeometryError::EndOffCircle { .. })));
    for value in [L + 1, i64::MAX, i64::MIN] {
        let beyond = Err(GeometryError::CoordinateBeyondLimit { axis: 'z', value });
        assert_eq!([helix([5, 0, value], [0, 5, 0]), helix([5, 0, 0], [0, 5, value])], [beyond; 2]);
    }
    assert!(helix([5, 0, -L], [0, 5, L]).is_ok());
}

#[test]
fn deviations_are_radial_and_along_z_at_the_own_angle() -> Outcome {
    let (r, travel) = (1_000_000, 2_000_000);
    for (to, direction) in [([0, r], CounterClockwise), ([0, r], Clockwise), ([r, 0], Clockwise), ([-r, 0], Clockwise)]
    {
        let helix = Helix::new([r, 0, 7], [to[0], to[1], 7 + travel], ORIGIN, direction)?;
        let cosine = 1.0 / 1.0_f64.hypot(travel as f64 / (r as f64 * helix.angle()));
        for part in (1..40).map(|step| f64::from(step) / 40.0) {
            let [x, y, z] = at(&helix, part);
            for (farther, higher) in [(1.0, 0.0), (0.999, 0.0), (1.001, 30_000.0), (0.5, -2_000.0)] {
                #[expect(clippy::cast_possible_truncation, reason = "a few millions")]
                let position = [x * farther, y * farther, z + higher].map(|c| c.round() as i64);
                let expected = ((farther - 1.0) * r as f64).hypot(higher * cosine);
                let found = helix.deviation(&position);
                assert!((found - expected).abs() < 4.0, "{helix:?} {position:?}: {found} {expected}");
                assert_eq!(helix.signed_deviation(&position).abs(), found);
            }
        }
    }
    let flat = Helix::new([5, 0, 7], [0, 5, 7], ORIGIN, CounterClockwise)?;
    assert_eq!([flat.signed_deviation(&[6, 0, 7]), flat.signed_deviation(&[4, 0, 7])], [1.0, -1.0]);
    Ok(())
}

#[test]
fn beyond_an_end_the_end_counts() -> Outcome {
    let quarter = Helix::new([50, 0, 0], [0, 50, 90], ORIGIN, CounterClockwise)?;
    // The middle of the rest is at 225°: before it the end counts, after it the start.
    for (position, z) in [([-50, 0], 90), ([-50, -48], 90), ([-48, -50], 0), ([0, -50], 0), ([50, -1], 0)] {
        let radial = quarter.arc().deviation(&position);
        let off = quarter.deviation(&[position[0], position[1], z]);
        assert!((off - radial).abs() < 1e-12, "{position:?}: {off} {radial}");
        assert!(quarter.deviation(&[position[0], position[1], 90 - z]) > 30.0);
    }
    // At the seam of a full turn both ends count, and half a turn away neither.
    let turn = Helix::new([50, 0, 0], [50, 0, 90], ORIGIN, CounterClockwise)?;
    for y in -1..=1 {
        assert!(turn.deviation(&[50, y, 0]) < 1.0 && turn.deviation(&[50, y, 90]) < 1.0);
    }
    assert!(turn.deviation(&[-50, 0, 45]) < 1e-12 && turn.deviation(&[-50, 0, 0]) > 40.0);
    // The axis is next to all of it.
    assert_eq!([0, 45, 90].map(|z| turn.deviation(&[0, 0, z])), [50.0; 3]);
    assert!(turn.deviation(&[0, 0, 91]) > 50.0);
    Ok(())
}

#[test]
fn any_position_has_a_deviation_and_a_gauge_the_same() -> Outcome {
    let values = [0, 1, -5, 1000, L, -L, i64::MAX, i64::MIN];
    for helix in [
        Helix::new([1, 0, 0], [1, 0, 5], ORIGIN, Clockwise)?,
        Helix::new([L, L, L], [L, L, -L], [-L, -L], CounterClockwise)?,
        Helix::new([3, 4, 5], [-4, 3, 5], ORIGIN, Clockwise)?,
    ] {
        let curve: Curve = helix.into();
        let gauge = curve.gauge();
        assert!(gauge.batch(10).is_none());
        for [x, y] in values.into_iter().flat_map(|x| values.map(|y| [x, y])) {
            for z in values {
                let found = helix.deviation(&[x, y, z]);
                assert!(found.is_finite() && found >= 0.0, "{helix:?} {x} {y} {z}: {found}");
                assert_eq!(found.to_bits(), gauge.deviation(&[x, y, z]).to_bits());
                assert_eq!(found.to_bits(), curve.deviation(&[x, y, z, 9]).to_bits());
            }
        }
        assert!(helix.deviation(&[1, 2]).is_nan() && gauge.deviation(&[1, 2]).is_nan());
    }
    Ok(())
}
