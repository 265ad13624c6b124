//! Arcs of a few BLU against a search of its own over all whole centres, with arcs as clouds of points.

use std::f64::consts::TAU;

use super::{blocks, circle, moved};
use crate::{Arc, Curve, Direction, SegmentShape};

type Cloud = Vec<[f64; 2]>;

/// Points of an arc, close together.
fn cloud(center: [f64; 2], radius: f64, first: f64, turn: f64, points: usize) -> Cloud {
    let place = |index: usize| {
        let (sin, cos) = (first + turn * index as f64 / points as f64).sin_cos();
        [center[0] + radius * cos, center[1] + radius * sin]
    };
    (0..=points).map(place).collect()
}

/// The greatest distance of a point of either cloud from the other.
fn apart(one: &[[f64; 2]], other: &[[f64; 2]]) -> f64 {
    let off = |from: &[[f64; 2]], to: &[[f64; 2]]| {
        let nearest = |p: &[f64; 2]| {
            to.iter().map(|q| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)).fold(f64::INFINITY, f64::min)
        };
        from.iter().map(nearest).fold(0.0, f64::max).sqrt()
    };
    off(one, other).max(off(other, one))
}

/// The commanded arc, as a cloud: on the circle through its start, and then to its end.
fn commanded(arc: &Arc, points: usize) -> Cloud {
    let start = arc.start().map(|c| c as f64);
    let sign = if arc.direction() == Direction::Clockwise { -1.0 } else { 1.0 };
    let center = arc.center().map(|c| c as f64);
    let mut points = cloud(center, arc.radius(), start[1].atan2(start[0]), sign * arc.sweep(), points);
    points.push(arc.to().map(|c| c as f64));
    points
}

/// The distance of what the rounder makes of an arc, and the least that any whole centre or no move has.
fn chosen_and_best(center: [f64; 2], radius: f64, first: f64, turn: f64, reach: i64, points: usize) -> (f64, f64) {
    let direction = if turn > 0.0 { Direction::CounterClockwise } else { Direction::Clockwise };
    let ideal = cloud(center, radius, first, turn, points);
    let at = |point: [f64; 2]| [point[0], point[1], 0.0];
    let full = turn.abs() == TAU;
    let (from, to) = (at(ideal[0]), at(if full { ideal[0] } else { ideal[points] }));
    let moves = [moved([0.0; 3], from, SegmentShape::Line), moved(from, to, circle(center, direction))];
    let before = usize::from(from.map(f64::round) != [0.0; 3]);
    let blocks = blocks(&moves, None);
    let chosen = match blocks.get(before).map(|block| &block.curve) {
        Some(Curve::Arc(arc)) => apart(&ideal, &commanded(arc, points)),
        Some(Curve::Line(line)) => {
            let ends = [line.from(), line.to()].map(|end| [end[0] as f64, end[1] as f64]);
            let part =
                |i: usize, axis: usize| ends[0][axis] + (ends[1][axis] - ends[0][axis]) * i as f64 / points as f64;
            apart(&ideal, &(0..=points).map(|i| [part(i, 0), part(i, 1)]).collect::<Cloud>())
        }
        None => apart(&ideal, &[[from[0].round(), from[1].round()]]),
        other => panic!("{other:?}"),
    };
    #[allow(clippy::cast_possible_truncation)]
    let [start, end, middle] = [[from[0], from[1]], [to[0], to[1]], center].map(|p| p.map(|c| c.round() as i64));
    let mut best = f64::INFINITY;
    if start == end {
        best = apart(&ideal, &[start.map(|c| c as f64)]);
    }
    for (dx, dy) in (-reach..=reach).flat_map(|dx| (-reach..=reach).map(move |dy| (dx, dy))) {
        if let Ok(arc) = Arc::new(start, end, [middle[0] + dx, middle[1] + dy], direction) {
            best = best.min(apart(&ideal, &commanded(&arc, points)));
        }
    }
    (chosen, best)
}

/// How far off the clouds may be from the arcs that they are of.
const CLOUDY: f64 = 0.03;

/// The worst distance of many arcs, none of which may be farther than the best of all whole centres and no move at all.
fn search(radii: [f64; 2], reach: i64, points: usize, count: u32) -> f64 {
    let mut seed = 12_345_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut worst = 0.0_f64;
    for index in 0..count {
        let center = [100.0 + random(), 100.0 + random()];
        let (radius, first) = (radii[0] + (radii[1] - radii[0]) * random(), TAU * random());
        let turn = if index % 2 == 0 { TAU } else { TAU * random() } * if index % 4 < 2 { 1.0 } else { -1.0 };
        let (chosen, best) = chosen_and_best(center, radius, first, turn, reach, points);
        assert!(chosen < best + CLOUDY, "{center:?} {radius} {first} {turn}: {chosen}, but {best} is possible");
        worst = worst.max(chosen);
    }
    worst
}

#[test]
fn no_whole_centre_is_nearer_to_a_tiny_arc_nor_is_no_move() {
    let worst = search([0.02, 1.0], 5, 80, 120);
    assert!(worst < 1.5, "{worst}");
}

#[test]
fn no_whole_centre_is_nearer_to_a_small_arc() {
    let worst = search([1.0, 4.0], 6, 100, 40);
    assert!(worst < 1.5, "{worst}");
}

#[test]
fn no_whole_centre_near_is_nearer_to_an_arc_of_some_ten_pulses() {
    let worst = search([4.0, 15.0], 10, 140, 8);
    assert!(worst < 1.5, "{worst}");
}

#[test]
fn a_circle_of_radius_0_6_becomes_one_of_radius_1_and_a_smaller_one_nothing() {
    let at = [100.0, 100.0, 0.0];
    let of = |center: [f64; 2]| {
        let moves = [moved([0.0; 3], at, SegmentShape::Line), moved(at, at, circle(center, Direction::Clockwise))];
        blocks(&moves, None).split_off(1)
    };
    let Some(Curve::Arc(arc)) = of([99.4, 100.0]).first().map(|block| block.curve.clone()) else { panic!("no arc") };
    assert_eq!((arc.center(), arc.radius()), ([99, 100], 1.0));
    // No move is 0.8 BLU off, the circle of radius 1 would be 1.2.
    assert_eq!(of([99.6, 100.0]).len(), 0);
}
