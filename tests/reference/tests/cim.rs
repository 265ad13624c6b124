//! Comparison-integral method, lines and arcs: worked tables and claims.

use super::super::{Weights, cim_arc, cim_line};
use super::{assert_pulses_make_the_path, end_of, lattice_arcs, moves, radial_error, turned};

const RULES: [Weights; 3] = [Weights::Mid, Weights::Pre, Weights::Post];

#[test]
fn the_worked_line_to_5_3_is_reproduced_to_the_digit() {
    let table = cim_line([0, 0], [5, 3]);
    assert_eq!(table.column("f"), [0, -2, 1, -1, 2, 0]);
    assert_eq!(moves(&table), "+X+Y +X +X+Y +X +X+Y");
    assert_eq!(table.column("a"), [3; 6]);
    assert_eq!(table.column("b"), [5; 6]);
    assert_eq!(table.column("base"), [0; 6]);
    assert_eq!(table.column("ex"), [5, 4, 3, 2, 1, 0]);
    assert_eq!(table.column("ey"), [3, 2, 2, 1, 1, 0]);
    // The mirrored line has the base Y, and a tie takes Y.
    let table = cim_line([0, 0], [-3, 5]);
    assert_eq!(moves(&table), "-X+Y +Y -X+Y +Y -X+Y");
    assert_eq!(table.column("base"), [1; 6]);
    assert_eq!(cim_line([1, 1], [4, -2]).column("base"), [1; 4]);
}

#[test]
fn every_line_ends_exactly_in_as_many_steps_as_its_longer_axis_has_pulses() {
    let from = [7, -3];
    for dx in -20..=20_i64 {
        for dy in -20..=20_i64 {
            let table = cim_line(from, [from[0] + dx, from[1] + dy]);
            let (a, b) = (dx.abs(), dy.abs());
            assert_eq!(end_of(&table), [from[0] + dx, from[1] + dy]);
            assert_pulses_make_the_path(&table);
            assert_eq!(table.steps(), usize::try_from(a.max(b)).expect("not negative"));
            for (f, [x, y]) in table.column("f").into_iter().zip(table.path()) {
                let cross = dx * (y - from[1]) - dy * (x - from[0]);
                assert!(cross * cross < (a * a + b * b).max(1));
                let n = i64::BITS - a.max(b).leading_zeros();
                assert!((-(1_i64 << n)..1 << n).contains(&f), "n + 1 bits");
                if a > 0 && b > 0 {
                    assert_eq!(f.abs(), cross.abs());
                }
            }
        }
    }
}

#[test]
fn the_comparison_value_and_the_base_follow_the_coordinates() {
    // NR1 from (5,0), mid: A = 5, B = 0, so Y is the base.
    let table = cim_arc([5, 0], [0, 5], [0, 0], false, Weights::Mid);
    assert_eq!(moves(&table), "-X+Y +Y +Y -X+Y -X+Y -X -X");
    assert_eq!(table.column("f"), [0, -8, -5, 0, 0, -4, -1, 0]);
    assert_eq!(table.column("a"), [5, 4, 4, 4, 3, 2, 1, 0]);
    assert_eq!(table.column("b"), [0, 1, 2, 3, 4, 5, 5, 5]);
    // At (3,4) X becomes the base; Y is done one step later, and X is forced.
    assert_eq!(table.column("base"), [1, 1, 1, 1, 0, 0, 0, 0]);
    assert_eq!(table.column("ey"), [5, 4, 3, 2, 1, 0, 0, 0]);
    // Without the sums of two weights: A and B before the pulses, A and B after them.
    let pre = cim_arc([5, 0], [0, 5], [0, 0], false, Weights::Pre);
    assert_eq!(pre.column("f")[..4], [0, -5, -4, -2]);
    let post = cim_arc([5, 0], [0, 5], [0, 0], false, Weights::Post);
    assert_eq!(post.column("f")[..4], [0, -3, -1, 2]);
}

#[test]
fn every_arc_ends_exactly_and_mid_is_the_exact_deviation_within_one_blu() {
    let mut worst = [0.0_f64; 3];
    let mut shares = [[0.0_f64; 2]; 3];
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        for (which, rule) in RULES.into_iter().enumerate() {
            let table = cim_arc(from, to, [0, 0], clockwise, rule);
            assert_eq!(end_of(&table), to, "{from:?} {rule:?}");
            assert_pulses_make_the_path(&table);
            worst[which] = worst[which].max(radial_error(&table, r2));
            let path = table.path();
            let (f, base) = (table.column("f"), table.column("base"));
            let (a, b) = (table.column("a"), table.column("b"));
            for (k, &[x, y]) in path.iter().enumerate() {
                assert_eq!([a[k], b[k]], [x.abs(), y.abs()]);
                assert!(a[k] == b[k] || (base[k] == 1) == (b[k] < a[k]));
                if rule == Weights::Mid {
                    assert_eq!(f[k].abs(), (x * x + y * y - r2).abs());
                }
                let share = f[k] as f64 / (r2 as f64).sqrt();
                shares[which] = [shares[which][0].min(share), shares[which][1].max(share)];
            }
        }
    }
    assert!(worst[0] > 0.96 && worst[0] < 1.0, "{worst:?}");
    assert!(worst[1] > 1.45 && worst[2] > 1.45, "{worst:?}");
    // |F| < 2R: n + 2 bits. After an axis that is crossed off the circle the others go beyond R.
    assert!(shares[0][0] > -2.0 && shares[0][1] < 2.0);
    assert!(shares[1][1] > 1.25 && shares[1][1] < 1.4 && shares[2][0] < -1.25, "{shares:?}");
}

#[test]
fn full_circles_keep_the_error_that_each_rule_buys() {
    let mut worst = [0.0_f64; 3];
    for (r2, from, to, clockwise) in (1..900).flat_map(|r2| {
        let starts = super::lattice_circle(r2).into_iter();
        starts.flat_map(move |from| [(r2, from, from, false), (r2, from, from, true)])
    }) {
        for (which, rule) in RULES.into_iter().enumerate() {
            let table = cim_arc(from, to, [0, 0], clockwise, rule);
            worst[which] = worst[which].max(radial_error(&table, r2));
        }
    }
    let [mid, pre, post] = worst;
    assert!(mid > 0.982 && mid < 0.983, "mid: {mid}");
    assert!(pre > 1.89 && pre < 1.9, "pre: {pre}");
    assert!(post > 1.64 && post < 1.65, "post: {post}");
}

#[test]
fn inside_one_quadrant_pre_and_post_keep_f_within_r() {
    for (r2, from, to, clockwise) in lattice_arcs(200) {
        let (x, y) = ([from[0], to[0]], [from[1], to[1]]);
        let inside = [x, y].into_iter().flatten().all(|c| c >= 0) && from != to;
        if !inside || (to[0] > from[0]) != clockwise {
            continue;
        }
        for rule in [Weights::Pre, Weights::Post] {
            let f = cim_arc(from, to, [0, 0], clockwise, rule).column("f");
            assert!(f.into_iter().all(|f| f * f <= r2), "{from:?} {to:?} {rule:?}");
        }
    }
}

#[test]
fn arcs_mirrored_in_both_axes_or_moved_make_the_same_steps_there() {
    for (_, from, to, clockwise) in lattice_arcs(60) {
        for rule in RULES {
            let table = cim_arc(from, to, [0, 0], clockwise, rule);
            let image = |point: [i64; 2]| turned(turned(point)).map(|c| c + 3);
            let other = cim_arc(image(from), image(to), [3, 3], clockwise, rule);
            assert_eq!(other.path(), table.path().into_iter().map(image).collect::<Vec<_>>());
            assert_eq!(other.column("f"), table.column("f"));
            let image = |[x, y]: [i64; 2]| [-x, y];
            let other = cim_arc(image(from), image(to), [0, 0], !clockwise, rule);
            assert_eq!(other.path(), table.path().into_iter().map(image).collect::<Vec<_>>());
        }
    }
}
