//! Sectors of conics.

use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::{Arc, Crossing, Quadrant, Sector};

/// What every curve's sectors have in common.
fn assert_lead_from_start_to_end(curve: &Conic) {
    let sectors = curve.sectors();
    assert_eq!(sectors.first().map(|sector| sector.start), Some(curve.start()));
    assert_eq!(sectors.last().map(|sector| sector.end), Some(curve.end()));
    for pair in sectors.windows(2) {
        assert!(pair[0].end == pair[1].start && pair[0].end.contains(&0), "{curve:?}");
    }
    for sector in sectors {
        let (signs, steps) = (sector.quadrant.signs(), sector.steps());
        for axis in 0..2 {
            assert_eq!(sector.start[axis] + sector.motion[axis] * steps[axis], sector.end[axis], "{curve:?}");
            assert!([sector.start, sector.end].iter().all(|point| point[axis] * signs[axis] >= 0), "{curve:?}");
            assert_eq!(sector.grows[axis], sector.motion[axis] == signs[axis], "{curve:?}");
            if steps[axis] > 0 {
                let mut next = sector.start;
                next[axis] += sector.motion[axis];
                let lowers = curve.implicit(next) < curve.implicit(sector.start);
                assert_eq!(lowers, (axis == 0) == sector.x_lowers, "{curve:?} {axis}");
            }
        }
    }
}

/// How many axes lie between start and end, from the angles.
fn axes_between(start: Point, end: Point, direction: Direction) -> usize {
    let turn = if direction == Clockwise { -1.0 } else { 1.0 };
    let quarters = |[x, y]: Point| {
        let angle = f64::atan2(y as f64, x as f64) * turn / FRAC_PI_2;
        if angle < 0.0 { angle + 4.0 } else { angle }
    };
    let (first, mut last) = (quarters(start), quarters(end));
    if last <= first {
        last += 4.0;
    }
    (1..8).map(f64::from).filter(|axis| first < *axis && *axis < last).count()
}

/// What every ellipse's sectors have, too.
fn assert_cross_where_it_must(curve: &Conic, [a, b]: [i64; 2], direction: Direction) {
    let (start, end, sectors) = (curve.start(), curve.end(), curve.sectors());
    assert_eq!(sectors.len(), axes_between(start, end, direction) + 1, "{curve:?}");
    for (place, pair) in sectors.windows(2).enumerate() {
        assert_eq!(pair[0].quadrant.next(direction), pair[1].quadrant);
        let axis = usize::from(pair[0].end[0] == 0);
        let first = if place == 0 { start[axis].abs() } else { 0 };
        let last = if place + 2 == sectors.len() { end[axis].abs() } else { 0 };
        assert_eq!(pair[0].end[axis].abs(), [a, b][axis].max(first).max(last), "{curve:?}");
    }
    for sector in sectors {
        assert_eq!(sector.motion, sector.quadrant.motion(direction));
        assert_ne!(sector.grows[0], sector.grows[1]);
    }
}

#[test]
fn every_small_ellipse_splits_at_the_axes_between_all_points_near_it() {
    let (mut taken, mut refused) = (0, 0);
    for [a, b] in lattice(12).filter(|[a, b]| *a > 0 && *b > 0) {
        let whole = |point, direction| Conic::ellipse([a, b], point, point, ORIGIN, direction);
        let near: Vec<Point> = lattice(13).filter(|point| whole(*point, Clockwise).is_ok()).collect();
        for (start, end) in near.iter().flat_map(|start| near.iter().map(move |end| (*start, *end))) {
            for direction in [Clockwise, CounterClockwise] {
                match Conic::ellipse([a, b], start, end, ORIGIN, direction) {
                    Ok(curve) => {
                        assert_lead_from_start_to_end(&curve);
                        assert_cross_where_it_must(&curve, [a, b], direction);
                        taken += 1;
                    }
                    Err(error) => {
                        assert!(matches!(error, GeometryError::EndsAcrossCurve { .. }), "{error}");
                        let exact = [start, end].map(|end| whole(end, direction).map(|whole| whole.ends_on_curve()));
                        assert_eq!(axes_between(start, end, direction), 0);
                        assert!(exact == [Ok(false); 2], "{a} {b} {start:?} {end:?}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert_eq!((taken, refused), (2_386_944, 26_400));
}

#[test]
fn every_small_open_curve_splits_at_its_vertex_between_all_points_near_it() {
    let [mut taken, mut refused] = [0, 0];
    let parabolas = (1..=9).map(|c| [c, 0]);
    for [a, b] in parabolas.chain(lattice(5).filter(|[a, b]| *a > 0 && *b > 0)) {
        let build = |opens, from, to| match b {
            0 => Conic::parabola(a, Some(opens), from, to, ORIGIN),
            _ => Conic::hyperbola([a, b], Some(opens), from, to, ORIGIN),
        };
        let vertex = if b == 0 { ORIGIN } else { [a, 0] };
        let ends = lattice(8).filter(|point| point[0] >= 0);
        for (from, to) in ends.clone().flat_map(|from| ends.clone().map(move |to| (from, to))) {
            let curve = match build(Opens::PlusX, from, to) {
                Ok(curve) => curve,
                Err(error) => {
                    refused += i32::from(matches!(error, GeometryError::EndsAcrossCurve { .. }));
                    continue;
                }
            };
            taken += 1;
            let sectors = curve.sectors();
            assert_lead_from_start_to_end(&curve);
            assert_eq!(sectors.len(), 1 + usize::from(from[1] * to[1] < 0));
            assert!(sectors.windows(2).all(|pair| pair[0].end == vertex && !pair[0].grows[0] && pair[1].grows[0]));
            assert!(sectors.iter().all(|sector| sector.grows[0] == sector.grows[1]));

            // Turned to the other sides, it has the same sectors, turned.
            for opens in [Opens::MinusX, Opens::PlusY, Opens::MinusY] {
                let other = build(opens, turned(opens, from), turned(opens, to)).map(|curve| curve.sectors());
                let expected = sectors.iter().map(|sector| ConicSector {
                    start: turned(opens, sector.start),
                    end: turned(opens, sector.end),
                    quadrant: quadrant(turned(opens, sector.quadrant.signs())),
                    motion: turned(opens, sector.motion),
                    grows: sector.grows,
                    x_lowers: sector.x_lowers == (opens.axis() == 0),
                });
                assert_eq!(other, Ok(expected.collect()), "{curve:?}");
            }
            // And the reversed motion has them in the reverse order.
            let back = build(Opens::PlusX, to, from).map(|curve| curve.sectors()).unwrap_or_default();
            assert_eq!(back.len(), sectors.len());
            for (there, back) in sectors.iter().zip(back.iter().rev()) {
                assert_eq!((there.start, there.end, there.quadrant), (back.end, back.start, back.quadrant));
                assert_eq!((there.motion, there.x_lowers), (back.motion.map(|sign| -sign), !back.x_lowers));
            }
        }
    }
    assert_eq!([taken, refused], [42_178, 1_408]);
}

fn quadrant(signs: [i64; 2]) -> Quadrant {
    Quadrant::ALL.into_iter().find(|quadrant| quadrant.signs() == signs).unwrap()
}

#[test]
fn a_mirrored_ellipse_has_mirrored_sectors() -> Outcome {
    let ends = [([9, 0], [0, 4]), ([8, 2], [7, 2]), ([-8, 2], [-8, 2]), ([3, -4], [-9, 1]), ([10, 0], [9, -1])];
    for (start, end) in ends {
        for direction in [Clockwise, CounterClockwise] {
            let sectors = Conic::ellipse([9, 4], start, end, ORIGIN, direction)?.sectors();
            for [sx, sy] in [[-1, 1], [1, -1], [-1, -1]] {
                let mirror = |[x, y]: Point| [sx * x, sy * y];
                let direction = if sx * sy < 0 { direction.reversed() } else { direction };
                let other = Conic::ellipse([9, 4], mirror(start), mirror(end), ORIGIN, direction)?.sectors();
                let mirrored = |sector: &ConicSector| ConicSector {
                    start: mirror(sector.start),
                    end: mirror(sector.end),
                    quadrant: quadrant(mirror(sector.quadrant.signs())),
                    motion: mirror(sector.motion),
                    ..*sector
                };
                assert_eq!(other, sectors.iter().map(mirrored).collect::<Vec<_>>());
            }
        }
    }
    Ok(())
}

#[test]
fn a_circle_as_an_ellipse_has_the_sectors_of_the_arc() {
    let starts = lattice(5).filter(|[x, y]| x * x + y * y == 25);
    for (start, end) in starts.flat_map(|start| lattice(6).map(move |end| (start, end))) {
        let ellipse = Conic::ellipse([5, 5], start, end, ORIGIN, Clockwise).map(|curve| {
            let plain = |part: &ConicSector| Sector { quadrant: part.quadrant, start: part.start, end: part.end };
            curve.sectors().iter().map(plain).collect::<Vec<_>>()
        });
        let arc = Arc::new(start, end, ORIGIN, Clockwise).map(|arc| arc.sectors(Crossing::RoundedRadius));
        assert_eq!(ellipse.ok(), arc.ok(), "{start:?} {end:?}");
    }
}
