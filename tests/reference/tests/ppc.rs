//! Point-by-point comparison: worked tables and claims.

use super::super::arc_geometry::{ArcKind, natural_extreme};
use super::super::{EndPoint, Form, Table, ppc_arc, ppc_line};
use super::{
    LINE_ENDS, assert_pulses_make_the_path, at_most_root, below_root, end_of, lattice_arcs, lattice_circle, moves,
    turned,
};

const FORMS: [Form; 2] = [Form::Magnitude, Form::Signed];
const ARC_ENDS: [EndPoint; 2] = [EndPoint::Total, EndPoint::PerAxis];

/// Every line from (0,0) with |dx|, |dy| <= `limit`.
fn lines(limit: i64) -> impl Iterator<Item = [i64; 2]> {
    (-limit..=limit).flat_map(move |x| (-limit..=limit).map(move |y| [x, y]))
}

#[test]
fn the_worked_line_to_6_4_is_reproduced_to_the_digit() {
    for end in LINE_ENDS {
        let table = ppc_line([0, 0], [6, 4], Form::Magnitude, end);
        assert_eq!(table.column("f"), [0, -4, 2, -2, 4, 0, -4, 2, -2, 4, 0]);
        assert_eq!(moves(&table), "+X +Y +X +Y +X +X +Y +X +Y +X");
        assert_eq!(table.column("xe"), [6; 11]);
        assert_eq!(table.column("ye"), [4; 11]);
    }
    let total = ppc_line([0, 0], [6, 4], Form::Magnitude, EndPoint::Total);
    assert_eq!(total.column("e"), [10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0]);
    let longest = ppc_line([0, 0], [6, 4], Form::Magnitude, EndPoint::Longest);
    assert_eq!(longest.column("e"), [6, 5, 5, 4, 4, 3, 2, 2, 1, 1, 0]);
    let per_axis = ppc_line([0, 0], [6, 4], Form::Magnitude, EndPoint::PerAxis);
    assert_eq!(per_axis.column("ex"), [6, 5, 5, 4, 4, 3, 2, 2, 1, 1, 0]);
    assert_eq!(per_axis.column("ey"), [4, 4, 3, 3, 2, 2, 2, 1, 1, 0, 0]);
}

#[test]
fn the_worked_line_to_5_3_is_reproduced_to_the_digit() {
    let table = ppc_line([0, 0], [5, 3], Form::Magnitude, EndPoint::Total);
    assert_eq!(table.column("f"), [0, -3, 2, -1, 4, 1, -2, 3, 0]);
}

#[test]
fn the_worked_signed_line_steps_y_on_the_tie_in_quadrant_2() {
    let table = ppc_line([-1, 1], [-4, 2], Form::Signed, EndPoint::Total);
    assert_eq!(table.column("f"), [0, -3, -2, -1, 0]);
    assert_eq!(table.path(), [[-1, 1], [-1, 2], [-2, 2], [-3, 2], [-4, 2]]);
    assert_eq!(table.column("xe"), [-3; 5]);
    assert_eq!(table.column("ye"), [1; 5]);
}

#[test]
fn the_worked_arcs_are_reproduced_to_the_digit() {
    for end in ARC_ENDS {
        let nr1 = ppc_arc([6, 0], [0, 6], [0, 0], false, end);
        let f = [0, -11, -10, -7, -2, 5, -4, 5, -2, 9, 4, 1, 0];
        assert_eq!(nr1.column("f"), f);
        assert_eq!(nr1.column("xi"), [6, 5, 5, 5, 5, 5, 4, 4, 3, 3, 2, 1, 0]);
        assert_eq!(nr1.column("yi"), [0, 0, 1, 2, 3, 4, 4, 5, 5, 6, 6, 6, 6]);
        assert_eq!(nr1.column("quad"), [0; 13]);

        let sr1 = ppc_arc([0, 5], [5, 0], [0, 0], true, end);
        let f = [0, -9, -8, -5, 0, -7, 0, -5, 4, 1, 0];
        assert_eq!(sr1.column("f"), f);

        let across = ppc_arc([-5, -3], [-3, 5], [0, 0], true, end);
        let f = [0, -5, 6, 3, 2, -9, -8, -5, 0, -9, -2, 7, 0];
        assert_eq!(across.column("f"), f);
        assert_eq!(across.path()[4], [-6, 0]);
        let quadrants = [2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1];
        assert_eq!(across.column("quad"), quadrants);
    }
    let total = ppc_arc([-5, -3], [-3, 5], [0, 0], true, EndPoint::Total);
    assert_eq!(total.column("e")[0], 12);
    let split = ppc_arc([-5, -3], [-3, 5], [0, 0], true, EndPoint::PerAxis);
    assert_eq!(split.column("ex"), [1, 1, 0, 0, 0, 2, 2, 2, 2, 1, 1, 1, 0]);
    assert_eq!(split.column("ey"), [3, 2, 2, 1, 0, 5, 4, 3, 2, 2, 1, 0, 0]);
}

#[test]
fn the_move_table_of_the_eight_arc_kinds_follows_from_the_tangent() {
    let rows = [(0, "-Y +X", "-X +Y"), (1, "+X +Y", "-Y -X"), (2, "+Y -X", "+X -Y"), (3, "-X -Y", "+Y +X")];
    for (quadrant, clockwise, counter_clockwise) in rows {
        for (expected, clockwise) in [(clockwise, true), (counter_clockwise, false)] {
            let kind = ArcKind { quadrant, clockwise };
            let word = |axis: usize| {
                let sign = if kind.travel()[axis] > 0 { '+' } else { '-' };
                format!("{sign}{}", ['X', 'Y'][axis])
            };
            let shown = format!("{} {}", word(kind.shrinking()), word(kind.growing()));
            assert_eq!(shown, expected, "{kind:?}");
        }
    }
}

#[test]
fn every_line_ends_exactly_and_deviates_by_less_than_one_blu() {
    let from = [7, -3];
    for [dx, dy] in lines(20) {
        let to = [from[0] + dx, from[1] + dy];
        let (a, b) = (dx.abs(), dy.abs());
        for form in FORMS {
            let total = ppc_line(from, to, form, EndPoint::Total);
            for end in LINE_ENDS {
                let table = ppc_line(from, to, form, end);
                assert!(table.finished);
                assert_eq!(end_of(&table), to, "{form:?} {end:?}");
                assert_eq!(table.path(), total.path(), "{form:?} {end:?} to {to:?}");
                assert_eq!(table.column("f"), total.column("f"));
            }
            assert_pulses_make_the_path(&total);
            assert_eq!(total.steps(), usize::try_from(a + b).expect("not negative"));
            let mirrored = form == Form::Signed && dx * dy < 0;
            for (f, [x, y]) in total.column("f").into_iter().zip(total.path()) {
                let cross = dx * (y - from[1]) - dy * (x - from[0]);
                assert!(cross * cross < (a * a + b * b).max(1), "{to:?}: {x},{y}");
                assert!(a > 0 || f == 0);
                match form {
                    Form::Signed => assert_eq!(f, cross),
                    Form::Magnitude => {
                        assert_eq!(f, a * (y - from[1]).abs() - b * (x - from[0]).abs());
                    }
                }
                // [-b, a - 1], and its mirror image where F has the other sign.
                let f = if mirrored { -f } else { f };
                let bonus = i64::from(mirrored);
                let range = -b + bonus..=a - 1 + bonus;
                assert!(a == 0 || range.contains(&f), "{to:?} {form:?}: F = {f}");
            }
        }
    }
}

#[test]
fn the_tie_goes_to_x_but_for_the_signed_form_in_quadrants_2_and_4() {
    for [dx, dy] in lines(12) {
        if dx == 0 || dy == 0 {
            continue;
        }
        for form in FORMS {
            let table = ppc_line([0, 0], [dx, dy], form, EndPoint::Total);
            let ties_step_y = form == Form::Signed && dx * dy < 0;
            let (f, steps_y) = (table.column("f"), table.column("dy"));
            for k in 1..f.len() {
                if f[k - 1] == 0 {
                    assert_eq!(steps_y[k] != 0, ties_step_y, "{form:?} ({dx},{dy})");
                }
            }
        }
    }
}

#[test]
fn on_a_45_degree_line_the_axis_that_wins_ties_is_done_one_step_early() {
    // This is why the counter on the longer axis must be on the other one.
    for a in 1..=20 {
        let x_first = ppc_line([0, 0], [a, a], Form::Magnitude, EndPoint::Total).path();
        assert_eq!(x_first[x_first.len() - 2], [a, a - 1]);
        let y_first = ppc_line([0, 0], [-a, a], Form::Signed, EndPoint::Total).path();
        assert_eq!(y_first[y_first.len() - 2], [1 - a, a]);
    }
}

#[test]
fn every_lattice_arc_ends_exactly_and_stays_within_one_blu() {
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        let arc = format!("{from:?} to {to:?}, clockwise: {clockwise}");
        let total = ppc_arc(from, to, [0, 0], clockwise, EndPoint::Total);
        assert_eq!(end_of(&total), to, "{arc}");
        assert_eq!(total.column("e").last(), Some(&0));
        assert_pulses_make_the_path(&total);
        for ((f, [x, y]), (xi, yi)) in
            total.column("f").into_iter().zip(total.path()).zip(total.column("xi").into_iter().zip(total.column("yi")))
        {
            let p2 = x * x + y * y;
            assert_eq!(f, p2 - r2, "{arc}");
            assert_eq!([xi, yi], [x.abs(), y.abs()], "{arc}");
            // -1 <= √p2 - R < 1, squared with F = p2 - R².
            assert!(at_most_root(-f - 1, 4 * p2), "{arc}: F = {f}");
            assert!(below_root(f - 1, 4 * r2), "{arc}: F = {f}");
            // -(2R - 1) <= F, and what holds above for every R: F <= 2√(R² - 2), or 0.
            assert!(at_most_root(1 - f, 4 * r2), "{arc}: F = {f}");
            assert!(at_most_root(f, 4 * (r2 - 2).max(0)), "{arc}: F = {f}");
        }

        let split = ppc_arc(from, to, [0, 0], clockwise, EndPoint::PerAxis);
        assert!(split.finished);
        for column in ["f", "xi", "yi", "quad", "dx", "dy", "x", "y"] {
            assert_eq!(split.column(column), total.column(column), "{arc}");
        }
    }
}

#[test]
fn the_deviation_of_an_arc_is_at_most_2r_minus_2_only_where_r_is_an_integer() {
    let largest = |start, clockwise| {
        let table = ppc_arc(start, start, [0, 0], clockwise, EndPoint::Total);
        table.column("f").into_iter().max().expect("row 0")
    };
    for r in 1..=30 {
        for start in lattice_circle(r * r) {
            for clockwise in [false, true] {
                let f = largest(start, clockwise);
                assert!(f <= 2 * r - 2, "R = {r} from {start:?}: F = {f}");
            }
        }
    }
    // R = √18 = 4.24: 2R - 2 = 6.49, but the path goes (4,1), (5,1) with F = 26 - 18.
    assert_eq!(largest([3, 3], true), 8);
}

#[test]
fn the_path_meets_the_axes_at_the_root_of_r_squared_minus_1_rounded_up() {
    let mut crossings = 0;
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        if from != to {
            continue;
        }
        let table = ppc_arc(from, to, [0, 0], clockwise, EndPoint::Total);
        let (quad, path) = (table.column("quad"), table.path());
        let mut largest = [0; 2];
        for k in 1..path.len() {
            largest = [0, 1].map(|axis: usize| path[k][axis].abs().max(largest[axis]));
            if quad[k] != quad[k - 1] {
                let [x, y] = path[k - 1].map(i64::abs);
                assert_eq!([x.max(y), x.min(y)], [natural_extreme(r2), 0], "{from:?}");
                crossings += 1;
            }
        }
        assert_eq!(largest, [natural_extreme(r2); 2], "{from:?}");
    }
    assert!(crossings > 1000);
    assert_eq!([1, 2, 4, 5, 25, 34, 50].map(natural_extreme), [1, 1, 2, 2, 5, 6, 7]);
}

#[test]
fn an_end_point_before_the_start_means_nearly_a_full_turn() {
    let steps = |from, to, clockwise| {
        let table: Table = ppc_arc(from, to, [0, 0], clockwise, EndPoint::Total);
        table.column("e")[0]
    };
    // R = 5: a full circle has 8·5 steps.
    assert_eq!(steps([3, 4], [3, 4], false), 40);
    assert_eq!(steps([5, 0], [5, 0], true), 40);
    assert_eq!(steps([4, 3], [3, 4], false), 2);
    assert_eq!(steps([3, 4], [4, 3], false), 38);
    assert_eq!(steps([3, 4], [4, 3], true), 2);
    assert_eq!(steps([5, 0], [0, 5], true), 30);
    // R = √2, extreme 1: the path is the square through (1,1).
    assert_eq!(steps([1, 1], [1, 1], false), 8);
}

#[test]
fn the_circle_with_radius_1_passes_through_its_centre_and_holds_the_quadrant_there() {
    for end in ARC_ENDS {
        let table = ppc_arc([1, 0], [1, 0], [0, 0], false, end);
        assert_eq!(moves(&table), "-X +Y -Y -X +X -Y +Y +X");
        assert_eq!(table.column("quad"), [0, 0, 0, 1, 1, 2, 2, 3, 3]);
        assert_eq!(table.column("f"), [0, -1, 0, -1, 0, -1, 0, -1, 0]);
        let table = ppc_arc([11, 20], [10, 19], [10, 20], true, end);
        assert_eq!(moves(&table), "-X -Y");
        assert_eq!(table.column("quad"), [3, 3, 3]);
    }
}

#[test]
fn an_arc_turned_by_90_degrees_or_moved_makes_the_same_steps_there() {
    for (_, from, to, clockwise) in lattice_arcs(60) {
        for end in ARC_ENDS {
            let table = ppc_arc(from, to, [0, 0], clockwise, end);
            let other = ppc_arc(turned(from), turned(to), [0, 0], clockwise, end);
            let path: Vec<_> = table.path().into_iter().map(turned).collect();
            assert_eq!(other.path(), path);
            assert_eq!(other.column("f"), table.column("f"));

            let moved = |[x, y]: [i64; 2]| [x - 40, y + 9];
            let other = ppc_arc(moved(from), moved(to), [-40, 9], clockwise, end);
            let path: Vec<_> = table.path().into_iter().map(moved).collect();
            assert_eq!(other.path(), path);
        }
    }
}

/// True when some point of the circle about the origin rounds to the point.
fn is_rounded_from_circle([x, y]: [i64; 2], radius_squared: i64) -> bool {
    // The nearest and the farthest corner of the unit square about the point, in half BLU.
    let near = [x, y].map(|c| (2 * c.abs() - 1).max(0));
    let far = [x, y].map(|c| 2 * c.abs() + 1);
    let square = |[u, v]: [i64; 2]| u * u + v * v;
    (square(near)..=square(far)).contains(&(4 * radius_squared))
}

#[test]
fn one_counter_per_axis_reaches_rounded_end_points_and_the_total_counter_misses_some() {
    let (mut missed, mut tried) = (0, 0);
    for (r2, from, clockwise) in (1..120).flat_map(|r2| {
        let starts = lattice_circle(r2).into_iter();
        starts.flat_map(move |from| [(r2, from, false), (r2, from, true)])
    }) {
        let ends = lines(12).filter(|&to| to != [0, 0] && is_rounded_from_circle(to, r2));
        for to in ends {
            let split = ppc_arc(from, to, [0, 0], clockwise, EndPoint::PerAxis);
            assert_eq!(end_of(&split), to, "from {from:?}, clockwise: {clockwise}");
            let total = end_of(&ppc_arc(from, to, [0, 0], clockwise, EndPoint::Total));
            tried += 1;
            if total != to {
                missed += 1;
                let diagonal = [0, 1].map(|axis: usize| (total[axis] - to[axis]).abs());
                assert_eq!(diagonal, [1, 1], "{from:?} to {to:?}");
            }
        }
    }
    assert!(missed > 0 && missed < tried / 4, "{missed} of {tried}");
}
