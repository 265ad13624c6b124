use std::f64::consts::FRAC_PI_2;

use super::*;
use crate::COORDINATE_LIMIT as L;
use crate::Direction::{self, Clockwise, CounterClockwise};
use crate::GeometryError;

use walk::Walk;

mod walk;

type Outcome = Result<(), GeometryError>;
type Point = [i64; 2];

const DIRECTIONS: [Direction; 2] = [Clockwise, CounterClockwise];

fn on_axis(point: Point) -> bool {
    point.contains(&0)
}

/// The lattice points with 0 < R² < bound.
fn lattice(bound: i64) -> impl Iterator<Item = Point> {
    let reach = bound.isqrt();
    let points = (-reach..=reach).flat_map(move |x| (-reach..=reach).map(move |y| [x, y]));
    points.filter(move |[x, y]| (1..bound).contains(&(x * x + y * y)))
}

/// The angle of a point in quarter turns in the sense of the motion, and exact on the axes.
fn quarters([x, y]: Point, direction: Direction) -> f64 {
    let turn = if direction == Clockwise { -1.0 } else { 1.0 };
    let angle = f64::atan2(y as f64, x as f64) * turn / FRAC_PI_2;
    if angle < 0.0 { angle + 4.0 } else { angle }
}

/// How many axes lie between start and end, from the angles.
fn axes_between(start: Point, end: Point, direction: Direction) -> usize {
    let first = quarters(start, direction);
    let mut last = quarters(end, direction);
    if last <= first {
        last += 4.0;
    }
    (1..8).map(f64::from).filter(|&axis| first < axis && axis < last).count()
}

fn total(sectors: &[Sector]) -> i64 {
    sectors.iter().flat_map(Sector::steps).sum()
}

#[test]
fn path_extreme_is_where_the_recurrence_crosses_and_the_total_is_its_number_of_steps() -> Outcome {
    let mut arcs = 0;
    for start in lattice(100) {
        let squared = start[0].pow(2) + start[1].pow(2);
        for end in lattice(100).filter(|[x, y]| x * x + y * y == squared) {
            for direction in DIRECTIONS {
                let case = format!("{start:?} -> {end:?} {direction}");
                let arc = Arc::new(start, end, [0, 0], direction)?;
                let sectors = arc.sectors(Crossing::PathExtreme);
                let crossings = axes_between(start, end, direction);
                assert_eq!(sectors.len(), crossings + 1, "{case}");

                // An end point on an axis is a crossing of its own for the recurrence.
                let turns = crossings + usize::from(on_axis(end));
                let mut walk = Walk::new(start, arc.start_quadrant().index(), direction);
                let mut steps = 0;
                while steps == 0 || walk.position != end || walk.crossed_at.len() != turns {
                    assert!(walk.crossed_at.len() <= turns, "{case} is missed");
                    walk.step();
                    steps += 1;
                }
                assert_eq!(total(&sectors), steps, "{case}");
                let ends: Vec<Point> = sectors.iter().map(|sector| sector.end).take(turns).collect();
                assert_eq!(ends, walk.crossed_at, "{case}");
                arcs += 1;
            }
        }
    }
    assert_eq!(arcs, 5_120);
    Ok(())
}

#[test]
fn full_circles_of_every_small_radius_come_back_after_the_total() -> Outcome {
    for start in lattice(2_500) {
        for direction in DIRECTIONS {
            let arc = Arc::new(start, start, [0, 0], direction)?;
            let sectors = arc.sectors(Crossing::PathExtreme);
            assert_eq!(sectors.len(), if on_axis(start) { 4 } else { 5 });
            let mut walk = Walk::new(start, arc.start_quadrant().index(), direction);
            for _ in 0..total(&sectors) {
                walk.step();
            }
            assert_eq!((walk.position, walk.crossed_at.len(), walk.f), (start, 4, 0), "{start:?} {direction}");
        }
    }
    Ok(())
}

#[test]
fn the_worked_arc_from_the_third_quadrant_has_twelve_steps_through_minus_six() -> Outcome {
    let arc = Arc::new([-5, -3], [-3, 5], [0, 0], Clockwise)?;
    let sectors = arc.sectors(Crossing::PathExtreme);
    assert_eq!(
        sectors,
        [
            Sector { quadrant: Quadrant::III, start: [-5, -3], end: [-6, 0] },
            Sector { quadrant: Quadrant::II, start: [-6, 0], end: [-3, 5] },
        ]
    );
    assert_eq!(total(&sectors), 12);
    Ok(())
}

#[test]
fn sectors_are_relative_to_the_centre() -> Outcome {
    let (arc, moved) = (
        Arc::new([3, 4], [-4, -3], [0, 0], CounterClockwise)?,
        Arc::new([103, -46], [96, -53], [100, -50], CounterClockwise)?,
    );
    for crossing in [Crossing::PathExtreme, Crossing::RoundedRadius] {
        assert_eq!(arc.sectors(crossing), moved.sectors(crossing));
    }
    Ok(())
}

#[test]
fn sectors_join_and_move_in_one_direction_on_every_arc_with_both_crossings() -> Outcome {
    // Every end point within 1 BLU of a circle below radius 10 is below radius 11.
    for start in lattice(100) {
        for end in lattice(121) {
            for direction in DIRECTIONS {
                let Ok(arc) = Arc::new(start, end, [0, 0], direction) else {
                    continue;
                };
                for crossing in [Crossing::PathExtreme, Crossing::RoundedRadius] {
                    let sectors = arc.sectors(crossing);
                    assert_eq!(sectors.first().map(|sector| sector.start), Some(start));
                    assert_eq!(sectors.last().map(|sector| sector.end), Some(end));
                    for pair in sectors.windows(2) {
                        assert_eq!(pair[0].end, pair[1].start);
                        assert_eq!(pair[0].quadrant.next(direction), pair[1].quadrant);
                        assert!(on_axis(pair[0].end));
                    }
                    // A full circle from the same start crosses by the rule alone; only the last crossing may differ.
                    let circle = Arc::new(start, start, [0, 0], direction)?.sectors(crossing);
                    let crossings = sectors.len() - 1;
                    for (place, sector) in sectors[..crossings].iter().enumerate() {
                        let mut expected = circle[place].end;
                        if place + 1 == crossings && !arc.ends_on_circle() {
                            let axis = sector.quadrant.growing_axis(direction);
                            expected[axis] = expected[axis].signum() * expected[axis].abs().max(end[axis].abs());
                        }
                        assert_eq!(sector.end, expected, "{arc:?}");
                    }
                    for Sector { quadrant, start, end } in sectors {
                        let motion = quadrant.motion(direction);
                        assert!((0..2).all(|axis| (end[axis] - start[axis]) * motion[axis] >= 0), "{arc:?}");
                    }
                }
            }
        }
    }
    Ok(())
}

#[test]
fn the_rounded_radius_is_exact_and_never_short_of_the_start() -> Outcome {
    let crossing = |start, direction| -> Result<Point, GeometryError> {
        let circle = Arc::new(start, start, [0, 0], direction)?;
        Ok(circle.sectors(Crossing::RoundedRadius)[0].end)
    };
    assert_eq!(crossing([-5, -3], Clockwise)?, [-6, 0]); // √34 = 5.83
    assert_eq!(crossing([2, 5], CounterClockwise)?, [0, 5]); // √29 = 5.39
    assert_eq!(crossing([-1, 5], CounterClockwise)?, [-5, 0]);
    // R² = r² + r rounds down and R² + 1 up, where f64 no longer separates the two roots.
    let r = L;
    let half = 1 << 26; // (r, half) has R² = r² + r
    assert_eq!(crossing([half, r], CounterClockwise)?, [0, r]);
    assert_eq!(crossing([half + 1, r], CounterClockwise)?, [0, r + 1]);
    Ok(())
}

#[test]
fn the_largest_circle_splits_without_overflow() -> Outcome {
    let circle = Arc::new([-L, -L], [-L, -L], [L, L], Clockwise)?;
    let sectors = circle.sectors(Crossing::PathExtreme);
    let extreme = 12_738_103_345_051_546; // ⌈2^53 · √2⌉
    let ends: Vec<Point> = sectors.iter().map(|sector| sector.end).collect();
    assert_eq!(ends, [[-extreme, 0], [0, extreme], [extreme, 0], [0, -extreme], [-2 * L, -2 * L]]);
    assert_eq!(total(&sectors), 8 * extreme);
    Ok(())
}

#[test]
fn an_end_outside_the_circle_moves_the_last_crossing_out() -> Outcome {
    let arc = Arc::new([1, 5], [6, -1], [0, 0], Clockwise)?; // from √26 to √37
    for crossing in [Crossing::PathExtreme, Crossing::RoundedRadius] {
        assert_eq!(
            arc.sectors(crossing),
            [
                Sector { quadrant: Quadrant::I, start: [1, 5], end: [6, 0] },
                Sector { quadrant: Quadrant::IV, start: [6, 0], end: [6, -1] },
            ]
        );
    }
    // The crossings before the last stay at the rounded radius, 5.
    let arc = Arc::new([1, 5], [-6, 1], [0, 0], Clockwise)?;
    let ends: Vec<Point> = arc.sectors(Crossing::RoundedRadius).iter().map(|sector| sector.end).collect();
    assert_eq!(ends, [[5, 0], [0, -5], [-6, 0], [-6, 1]]);
    Ok(())
}

#[test]
fn steps_of_any_two_points_saturate() {
    let sector = Sector { quadrant: Quadrant::I, start: [i64::MIN, 3], end: [i64::MAX, -4] };
    assert_eq!(sector.steps(), [i64::MAX, 7]);
}
