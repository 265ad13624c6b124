//! Eight-direction methods: worked tables and claims.

use super::super::arc_geometry::{natural_extreme, nearest_radius};
use super::super::{EndPoint, Table, mindev_arc, mindev_line, vector_arc, vector_line};
use super::{assert_pulses_make_the_path, end_of, lattice_arcs, moves, radial_error, turned};

const ENDS: [EndPoint; 2] = [EndPoint::Total, EndPoint::PerAxis];

/// Every line from (0,0) with |dx|, |dy| <= `limit`.
fn lines(limit: i64) -> impl Iterator<Item = [i64; 2]> {
    (-limit..=limit).flat_map(move |x| (-limit..=limit).map(move |y| [x, y]))
}

#[test]
fn the_worked_arc_of_minimum_deviation_is_reproduced_to_the_digit() {
    for end in ENDS {
        let table = mindev_arc([5, 0], [0, 5], [0, 0], false, end);
        assert_eq!(moves(&table), "+Y +Y -X+Y -X+Y -X+Y -X -X");
        assert_eq!(table.column("f"), [0, 1, 4, 0, 0, 4, 1, 0]);
        assert_eq!(table.column("quad"), [0; 8]);
    }
    let total = mindev_arc([5, 0], [0, 5], [0, 0], false, EndPoint::Total);
    assert_eq!(total.column("e"), [10, 9, 8, 6, 4, 2, 1, 0]);
}

#[test]
fn small_lines_and_arcs_by_hand() {
    // D = 2S - L = 1, then 1 + 2(S - L) = -3, -3 + 2S = 3, ….
    let table = mindev_line([0, 0], [5, 3]);
    assert_eq!(table.column("f"), [1, -3, 3, -1, 5, 1]);
    assert_eq!(moves(&table), "+X+Y +X +X+Y +X +X+Y");
    assert_eq!(table.column("e"), [5, 4, 3, 2, 1, 0]);
    // D = 0 takes the diagonal.
    let table = mindev_line([0, 0], [4, 2]);
    assert_eq!(table.column("f"), [0, -4, 0, -4, 0]);
    assert_eq!(moves(&table), "+X+Y +X +X+Y +X");
    let table = vector_line([0, 0], [5, 3]);
    assert_eq!(table.column("f"), [0, -3, -1, 1, -2, 0]);
    assert_eq!(moves(&table), "+X +X+Y +X+Y +X +X+Y");
    let table = vector_line([0, 0], [3, -5]);
    // The same path with both axes changed over.
    assert_eq!(table.column("f"), [0, 3, 1, -1, 2, 0]);
    assert_eq!(moves(&table), "-Y +X-Y +X-Y -Y +X-Y");
    let table = vector_arc([5, 0], [0, 5], [0, 0], false, EndPoint::Total);
    assert_eq!(table.column("f"), [0, -8, -5, 0, 0, -5, 1, 0]);
    assert_eq!(moves(&table), "-X+Y +Y +Y -X+Y -X -X+Y -X");
}

#[test]
fn every_line_ends_exactly_and_stays_near() {
    let from = [-4, 11];
    for [dx, dy] in lines(20) {
        let to = [from[0] + dx, from[1] + dy];
        let length = dx.abs().max(dy.abs());
        let nearest = mindev_line(from, to);
        let vector = vector_line(from, to);
        for table in [&nearest, &vector] {
            assert_eq!(end_of(table), to);
            assert_pulses_make_the_path(table);
            assert_eq!(table.steps(), usize::try_from(length).expect("not negative"));
        }
        for [x, y] in nearest.path() {
            let cross = (dx * (y - from[1]) - dy * (x - from[0])).abs();
            // Half a BLU along the shorter axis.
            assert!(2 * cross <= length, "{to:?}");
        }
        for (f, [x, y]) in vector.column("f").into_iter().zip(vector.path()) {
            let [u, v] = [(x - from[0]).abs(), (y - from[1]).abs()];
            assert_eq!(f, dx.abs() * v - dy.abs() * u, "{to:?}");
            assert!(f * f < (dx * dx + dy * dy).max(1));
        }
        for (sx, sy) in [(1, -1), (-1, 1), (-1, -1)] {
            let image = |[x, y]: [i64; 2]| [sx * x, sy * y];
            for (table, other) in
                [(&nearest, mindev_line(image(from), image(to))), (&vector, vector_line(image(from), image(to)))]
            {
                assert_eq!(other.path(), table.path().into_iter().map(image).collect::<Vec<_>>());
            }
        }
    }
}

#[test]
fn a_line_along_y_never_asks_x() {
    // F stays 0: a pulse of X, even in no direction, would have taken b from it.
    let table = vector_line([2, 2], [2, 6]);
    assert_eq!(table.column("f"), [0; 5]);
    assert_eq!(moves(&table), "+Y +Y +Y +Y");
    assert_eq!(vector_line([2, 2], [-1, 2]).column("f"), [0; 4]);
}

#[test]
fn every_arc_ends_exactly_by_either_counter() {
    let mut worst = [0.0_f64; 2];
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        for (which, method) in [mindev_arc, vector_arc].into_iter().enumerate() {
            let [total, split] = ENDS.map(|end| method(from, to, [0, 0], clockwise, end));
            assert_eq!(end_of(&total), to, "{from:?} to {to:?}");
            assert_eq!(total.column("e").last(), Some(&0));
            assert_pulses_make_the_path(&total);
            for column in ["f", "xi", "yi", "quad", "dx", "dy", "x", "y"] {
                assert_eq!(split.column(column), total.column(column), "{from:?} to {to:?}");
            }
            for (f, [x, y]) in total.column("f").into_iter().zip(total.path()) {
                assert_eq!(f, x * x + y * y - r2);
                // Minimum deviation keeps n + 1 bits, vector discrimination n + 2.
                let bound = if which == 0 { 1 } else { 4 };
                assert!(f * f < bound * r2, "{from:?} to {to:?}: {f}");
            }
            worst[which] = worst[which].max(radial_error(&total, r2));
        }
    }
    let [nearest, vector] = worst;
    assert!(nearest > 0.48 && nearest < 0.5, "{nearest}");
    assert!(vector > 0.96 && vector < 1.0, "{vector}");
}

#[test]
fn the_paths_meet_the_axes_where_the_counters_expect_them() {
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        if from != to {
            continue;
        }
        let crossings = [nearest_radius(r2), natural_extreme(r2)];
        for (method, crossing) in [mindev_arc, vector_arc].into_iter().zip(crossings) {
            let table: Table = method(from, to, [0, 0], clockwise, EndPoint::Total);
            let largest = table.path().into_iter().flatten().map(i64::abs).max();
            assert_eq!(largest, Some(crossing), "{from:?}");
        }
    }
}

#[test]
fn the_three_deviations_are_never_equal() {
    // F of X and Y differs from F of XY by an odd number; and where F of X is -F of Y, XY is nearer.
    for x in 1..40_i64 {
        for y in 0..40_i64 {
            for f in -120..=120_i64 {
                let (f1, f2) = (f - 2 * x + 1, f + 2 * y + 1);
                let f3 = f1 + f2 - f;
                let smallest = f1.abs().min(f2.abs()).min(f3.abs());
                let equal = [f1, f2, f3].into_iter().filter(|f| f.abs() == smallest).count();
                assert_eq!(equal, 1, "x = {x}, y = {y}, F = {f}");
            }
        }
    }
}

#[test]
fn minimum_deviation_leaves_the_smallest_deviation_of_three() {
    for (r2, from, to, clockwise) in lattice_arcs(100) {
        let table = mindev_arc(from, to, [0, 0], clockwise, EndPoint::Total);
        let f = table.column("f");
        for (k, step) in table.path().windows(2).enumerate() {
            let [x0, y0] = step[0];
            let (dx, dy) = (step[1][0] - x0, step[1][1] - y0);
            let after = |dx: i64, dy: i64| ((x0 + dx).pow(2) + (y0 + dy).pow(2) - r2).abs();
            let taken = f[k + 1].abs();
            if dx != 0 && dy != 0 {
                assert!(taken <= after(dx, 0) && taken <= after(0, dy));
            } else if dy != 0 {
                // X alone in the direction of the quadrant: the tangent is (y, -x) or (-y, x).
                let sx = if clockwise { y0.signum() } else { -y0.signum() };
                assert!(sx == 0 || (taken <= after(sx, 0) && taken < after(sx, dy)));
            } else {
                let sy = if clockwise { -x0.signum() } else { x0.signum() };
                assert!(sy == 0 || (taken < after(0, sy) && taken < after(dx, sy)));
            }
        }
    }
}

#[test]
fn rounded_end_points_are_reached_by_one_counter_per_axis() {
    let mut missed = 0;
    for (x, y) in (1..=12_i64).flat_map(|x| (1..=12_i64).map(move |y| (x, y))) {
        let r = ((x * x + y * y) as f64).sqrt().round();
        let r: i64 = (1..20).find(|&i| i as f64 == r).expect("small");
        if x > r || y > r || ((x * x + y * y) as f64).sqrt() < r as f64 - 0.5 {
            continue;
        }
        for method in [mindev_arc, vector_arc] {
            for (from, clockwise) in [([r, 0], false), ([0, r], true), ([0, -r], false), ([-r, 0], true)] {
                assert_eq!(end_of(&method(from, [x, y], [0, 0], clockwise, EndPoint::PerAxis)), [x, y]);
                let total = method(from, [x, y], [0, 0], clockwise, EndPoint::Total);
                missed += i64::from(end_of(&total) != [x, y]);
            }
        }
    }
    assert!(missed > 0, "the total counter misses some");
}

#[test]
fn an_arc_mirrored_in_x_and_y_or_moved_makes_the_same_steps_there() {
    for (_, from, to, clockwise) in lattice_arcs(60) {
        for end in ENDS {
            for method in [mindev_arc, vector_arc] {
                let table = method(from, to, [0, 0], clockwise, end);
                let image = |point: [i64; 2]| turned(turned(point)).map(|c| c - 5);
                let other = method(image(from), image(to), [-5, -5], clockwise, end);
                assert_eq!(other.path(), table.path().into_iter().map(image).collect::<Vec<_>>());
                assert_eq!(other.column("f"), table.column("f"));
                let image = |[x, y]: [i64; 2]| [x, -y];
                let other = method(image(from), image(to), [0, 0], !clockwise, end);
                assert_eq!(other.path(), table.path().into_iter().map(image).collect::<Vec<_>>());
            }
        }
    }
}
