//! Conics by point-by-point comparison, comparison-integral and integration: the claims.

use std::f64::consts::PI;

use super::super::conic_geometry::Curve;
use super::super::{EndPoint, Opens, Shape, Table, Weights, cim_conic, dda_conic, ppc_conic};
use super::{assert_pulses_make_the_path, end_of, moves};

/// Any conic method.
type Method = fn(Shape, [i64; 2], [i64; 2], [i64; 2], bool) -> Table;

/// Where a point goes in a mirrored or turned figure.
type Image = fn([i64; 2]) -> [i64; 2];

/// Every method, with every end point and weight rule that it has.
const METHODS: [Method; 8] = [
    |shape, from, to, center, clockwise| ppc_conic(shape, from, to, center, clockwise, EndPoint::Total),
    |shape, from, to, center, clockwise| ppc_conic(shape, from, to, center, clockwise, EndPoint::PerAxis),
    |shape, from, to, center, clockwise| cim_conic(shape, from, to, center, clockwise, Weights::Mid),
    |shape, from, to, center, clockwise| cim_conic(shape, from, to, center, clockwise, Weights::Pre),
    |shape, from, to, center, clockwise| cim_conic(shape, from, to, center, clockwise, Weights::Post),
    |shape, from, to, center, clockwise| integrated(shape, from, to, center, clockwise, 0),
    |shape, from, to, center, clockwise| integrated(shape, from, to, center, clockwise, 1),
    |shape, from, to, center, clockwise| integrated(shape, from, to, center, clockwise, 2),
];

/// By integration, in the bits of the largest weight, with the preset zero, half or full.
fn integrated(shape: Shape, from: [i64; 2], to: [i64; 2], center: [i64; 2], clockwise: bool, which: usize) -> Table {
    let n = bits_for(shape, from, to, center);
    let preset = [0, 1 << (n - 1), (1 << n) - 1][which];
    dda_conic(n, shape, from, to, center, clockwise, [preset; 2], false, EndPoint::PerAxis)
}

/// The bits of the largest weight on a curve.
fn bits_for(shape: Shape, from: [i64; 2], to: [i64; 2], center: [i64; 2]) -> u32 {
    let curve = Curve::of(shape);
    let mut largest = 1;
    for [x, y] in [from, to] {
        largest = largest.max(curve.weight(0, x - center[0])).max(curve.weight(1, y - center[1]));
    }
    if let Shape::Ellipse([a, b]) = shape {
        largest = largest.max(curve.weight(0, a)).max(curve.weight(1, b));
    }
    if let Shape::Hyperbola([a, b], _) = shape {
        largest = largest.max(b * b * a);
    }
    (1..).find(|&n| 1 << n > largest).expect("some n")
}

/// The four quarters of an ellipse in one sense.
fn quarters([a, b]: [i64; 2], clockwise: bool) -> [([i64; 2], [i64; 2]); 4] {
    let mut corners = [[a, 0], [0, b], [-a, 0], [0, -b]];
    if clockwise {
        corners.reverse();
    }
    [0, 1, 2, 3].map(|i: usize| (corners[i], corners[(i + 1) % 4]))
}

/// Open curves with integer points, and those points.
fn open_curves(opens: Opens) -> Vec<(Shape, Vec<[i64; 2]>)> {
    let placed = |[along, across]: [i64; 2]| match opens {
        Opens::PlusX => [along, across],
        Opens::MinusX => [-along, across],
        Opens::PlusY => [across, along],
        Opens::MinusY => [across, -along],
    };
    let square = (0..=45_i64).flat_map(|x| (-24..=24_i64).map(move |y| [x, y]));
    let square: Vec<[i64; 2]> = square.collect();
    let mut list = Vec::new();
    for c in 1..=12 {
        let points = square.iter().filter(|[x, y]| y * y == c * x);
        list.push((Shape::Parabola(c, opens), points.map(|&point| placed(point)).collect()));
    }
    for a in 1..=10 {
        for b in 1..=10 {
            let points = square.iter().filter(|[x, y]| b * b * x * x - a * a * y * y == a * a * b * b);
            list.push((Shape::Hyperbola([a, b], opens), points.map(|&point| placed(point)).collect()));
        }
    }
    list
}

/// True when the curve passes a point at less than 1 BLU along an axis, or at 1: G is 0 there, or
/// has another sign at one of its four neighbours.
fn is_near(curve: &Curve, [x, y]: [i64; 2]) -> bool {
    let around = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(|[i, j]| curve.value([x + i, y + j]).signum());
    let own = curve.value([x, y]).signum();
    own == 0 || around.iter().any(|&sign| sign != own)
}

/// The distance of a point from an ellipse, found on a quarter of it that is parted finer and finer.
fn ellipse_distance([a, b]: [i64; 2], [x, y]: [i64; 2]) -> f64 {
    let at = |t: f64| (a as f64 * t.cos() - x.abs() as f64).hypot(b as f64 * t.sin() - y.abs() as f64);
    let (mut center, mut width) = (0.25 * PI, 0.25 * PI);
    let mut best = f64::INFINITY;
    for _ in 0..6 {
        let middle = center;
        for part in -8..=8 {
            let t = (middle + width * f64::from(part) / 8.0).clamp(0.0, 0.5 * PI);
            if at(t) < best {
                (best, center) = (at(t), t);
            }
        }
        width /= 4.0;
    }
    best
}

#[test]
fn the_worked_ellipse_of_the_comparison_integral_is_reproduced_to_the_digit() {
    let table = cim_conic(Shape::Ellipse([3, 2]), [0, -2], [-3, 0], [0, 0], true, Weights::Post);
    assert_eq!(table.column("f"), [0, -5, 3, -15]);
    assert_eq!(table.path(), [[0, -2], [-1, -1], [-2, -1], [-3, 0]]);
    let counters = table.column("ex").into_iter().zip(table.column("ey"));
    assert_eq!(counters.map(|(x, y)| x + y).collect::<Vec<_>>(), [5, 3, 2, 0]);
    assert_eq!(table.column("a"), [0, 4, 8, 12]);
    assert_eq!(table.column("b"), [18, 9, 9, 0]);
    assert_eq!(table.column("base"), [0, 0, 0, 1]);
}

#[test]
fn small_curves_by_hand() {
    // G = 4x² + 9y² - 36 from (3,0): -X takes 4·5, +Y adds 9·1 and 9·3.
    let table = ppc_conic(Shape::Ellipse([3, 2]), [3, 0], [0, 2], [0, 0], false, EndPoint::Total);
    assert_eq!(table.column("f"), [0, -20, -11, 16, 4, 0]);
    assert_eq!(moves(&table), "-X +Y +Y -X -X");
    assert_eq!(table.column("gx"), [24, 16, 16, 16, 8, 0]);
    assert_eq!(table.column("gy"), [0, 0, 18, 36, 36, 36]);
    // y² = 2x outward: +X takes 2, +Y adds 2y + 1.
    let table = ppc_conic(Shape::Parabola(2, Opens::PlusX), [0, 0], [2, 2], [0, 0], false, EndPoint::PerAxis);
    assert_eq!(table.column("f"), [0, -2, -1, 2, 0]);
    assert_eq!(moves(&table), "+X +Y +Y +X");
    assert_eq!(table.column("gx"), [2; 5]);
    assert_eq!(table.column("gy"), [0, 0, 2, 4, 4]);
    // The same with F doubled. A = 2 > B = 0, so Y is the base. Y: B = 2, X: A stays.
    let table = cim_conic(Shape::Parabola(2, Opens::PlusX), [0, 0], [2, 2], [0, 0], false, Weights::Mid);
    assert_eq!(moves(&table), "+X+Y +Y +X");
    assert_eq!(table.column("base"), [1, 1, 0, 0]);
    assert_eq!(table.column("f"), [0, -2, -4, 0]);
    // In three bits: Y at every fourth iteration, X follows J_VX = 2y.
    let table =
        dda_conic(3, Shape::Parabola(2, Opens::PlusX), [0, 0], [2, 2], [0, 0], false, [0, 0], false, EndPoint::PerAxis);
    assert_eq!(table.column("jvx"), [0, 0, 0, 0, 2, 2, 2, 2, 4, 4, 4]);
    assert_eq!(table.column("jrx"), [0, 0, 0, 0, 0, 2, 4, 6, 0, 4, 0]);
    assert_eq!(table.column("jvy"), [2; 11]);
}

#[test]
fn every_quarter_ellipse_lands_exactly_by_every_method() {
    let mut hung = [0; 8];
    let mut worst = [0.0_f64; 8];
    for a in 1..30 {
        for b in 1..30 {
            let shape = Shape::Ellipse([a, b]);
            let curve = Curve::of(shape);
            for clockwise in [false, true] {
                let (from, to) = quarters([a, b], clockwise)[0];
                for (which, method) in METHODS.into_iter().enumerate() {
                    let table = method(shape, from, to, [0, 0], clockwise);
                    if !table.finished {
                        assert!(!table.overflow);
                        hung[which] += 1;
                        continue;
                    }
                    assert_eq!(end_of(&table), to, "{shape:?} method {which}");
                    assert_pulses_make_the_path(&table);
                    if which < 2 {
                        assert!(table.path().into_iter().all(|point| is_near(&curve, point)), "{shape:?} {which}");
                    }
                    if which < 2 {
                        let (f, path) = (table.column("f"), table.path());
                        let (gx, gy) = (table.column("gx"), table.column("gy"));
                        for (k, [x, y]) in path.into_iter().enumerate() {
                            assert_eq!(f[k], b * b * x * x + a * a * y * y - a * a * b * b);
                            assert_eq!([gx[k], gy[k]], [2 * b * b * x.abs(), 2 * a * a * y.abs()]);
                        }
                    }
                    if clockwise {
                        // The reverse direction is this one with a and b exchanged.
                        continue;
                    }
                    let errors = table.path().into_iter().map(|point| ellipse_distance([a, b], point));
                    worst[which] = errors.fold(worst[which], f64::max);
                }
            }
        }
    }
    // Within 1 BLU, but for pre, post and the integrators.
    assert!(worst[..3].iter().all(|&worst| worst > 0.99 && worst < 1.0 + 1e-6), "{worst:?}");
    assert!(worst[2] < 0.9995 && worst[3] > 1.66 && worst[4] > 1.99, "{worst:?}");
    assert!(worst[5] > 2.1 && worst[6] < 1.2, "{worst:?}");
    // Only the full preset lets X run out before Y is there, or vice versa.
    assert_eq!(hung[..7], [0; 7]);
    assert!(hung[7] > 0, "{hung:?}");
}

#[test]
fn a_full_preset_can_hang_on_an_ellipse() {
    let table = dda_conic(3, Shape::Ellipse([1, 2]), [1, 0], [0, 2], [0, 0], false, [7, 7], false, EndPoint::PerAxis);
    assert!(!table.finished && !table.overflow);
    assert_eq!(table.column("ex").last(), Some(&0));
    assert_eq!(table.column("jvy").last(), Some(&0));
    let idle = table.column("ey").iter().filter(|&&ey| Some(&ey) == table.column("ey").last()).count();
    assert!(idle >= 9, "{table:?}");
}

#[test]
fn a_full_ellipse_is_its_four_quarters() {
    for semi_axes in [[1, 1], [5, 2], [2, 5], [7, 6], [11, 11], [3, 20]] {
        let shape = Shape::Ellipse(semi_axes);
        for clockwise in [false, true] {
            let quarters = quarters(semi_axes, clockwise);
            for method in &METHODS[..7] {
                let start = quarters[0].0;
                let whole = method(shape, start, start, [0, 0], clockwise);
                let mut rows = Vec::new();
                for (from, to) in quarters {
                    let quarter = method(shape, from, to, [0, 0], clockwise);
                    rows.extend(quarter.rows.into_iter().skip(usize::from(!rows.is_empty())));
                }
                assert_eq!(whole.rows, rows, "{semi_axes:?}");
            }
        }
    }
}

#[test]
fn every_open_curve_lands_exactly_there_and_back() {
    let mut hung = [0; 8];
    let mut tried = 0;
    for (shape, points) in open_curves(Opens::PlusX) {
        let curve = Curve::of(shape);
        for &from in &points {
            for &to in &points {
                tried += 1;
                for (which, method) in METHODS.into_iter().enumerate() {
                    let table = method(shape, from, to, [0, 0], false);
                    assert!(!table.overflow);
                    if !table.finished {
                        hung[which] += 1;
                        continue;
                    }
                    assert_eq!(end_of(&table), to, "{shape:?} from {from:?} method {which}");
                    assert_pulses_make_the_path(&table);
                    if which < 3 {
                        assert!(table.path().into_iter().all(|point| is_near(&curve, point)), "{shape:?} {which}");
                    }
                    if which < 2 {
                        let f: Vec<i64> = table.path().into_iter().map(|point| curve.value(point)).collect();
                        assert_eq!(table.column("f"), f);
                    }
                }
            }
        }
    }
    assert!(tried > 500, "{tried}");
    assert!(hung[..5] == [0; 5] && hung[6] == 0, "{hung:?}");
    assert!(hung[7] > 0);
}

#[test]
fn the_mid_comparison_value_is_the_implicit_function_with_the_sign_of_the_base() {
    let mut curves: Vec<(Shape, Vec<[i64; 2]>)> = open_curves(Opens::MinusY);
    curves.extend((1..12).flat_map(|a| (1..12).map(move |b| (Shape::Ellipse([a, b]), vec![[a, 0], [0, b]]))));
    for (shape, points) in curves {
        let curve = Curve::of(shape);
        for &from in &points {
            for &to in &points {
                let table = cim_conic(shape, from, to, [0, 0], false, Weights::Mid);
                let scale = if matches!(shape, Shape::Parabola(..)) { 2 } else { 1 };
                for (f, [x, y]) in table.column("f").into_iter().zip(table.path()) {
                    assert_eq!(f.abs(), (scale * curve.value([x, y])).abs(), "{shape:?}");
                }
                // The base has the smaller weight.
                let weights = table.column("a").into_iter().zip(table.column("b"));
                for ((a, b), base) in weights.zip(table.column("base")) {
                    assert!(a == b || (base == 1) == (b < a));
                }
            }
        }
    }
}

#[test]
fn curves_that_open_to_the_four_sides_are_mirror_images() {
    let images: [(Opens, Image); 3] =
        [(Opens::MinusX, |[x, y]| [-x, -y]), (Opens::PlusY, |[x, y]| [-y, x]), (Opens::MinusY, |[x, y]| [y, -x])];
    for (shape, points) in open_curves(Opens::PlusX) {
        for (opens, image) in images {
            let other = match shape {
                Shape::Parabola(c, _) => Shape::Parabola(c, opens),
                Shape::Hyperbola(axes, _) => Shape::Hyperbola(axes, opens),
                Shape::Ellipse(_) => shape,
            };
            for (&from, &to) in points.iter().zip(points.iter().rev()) {
                for method in &METHODS[..2] {
                    let table = method(shape, from, to, [0, 0], false);
                    let moved = |point| image(point).map(|c| c + 7);
                    let there = method(other, moved(from), moved(to), [7, 7], false);
                    assert_eq!(there.column("f"), table.column("f"));
                    assert_eq!(there.path(), table.path().into_iter().map(moved).collect::<Vec<_>>());
                }
                for method in &METHODS[5..] {
                    let table = method(shape, from, to, [0, 0], false);
                    let there = method(other, image(from), image(to), [0, 0], false);
                    assert_eq!(there.path(), table.path().into_iter().map(image).collect::<Vec<_>>());
                }
            }
        }
    }
}

#[test]
fn quarter_ellipses_in_all_quadrants_are_mirror_images() {
    for a in 1..14 {
        for b in 1..14 {
            let shape = Shape::Ellipse([a, b]);
            for method in &METHODS {
                let first = method(shape, [a, 0], [0, b], [0, 0], false);
                for (sx, sy, clockwise) in [(-1, 1, true), (-1, -1, false), (1, -1, true)] {
                    let image = |[x, y]: [i64; 2]| [sx * x - 9, sy * y + 4];
                    let table = method(shape, image([a, 0]), image([0, b]), [-9, 4], clockwise);
                    let path: Vec<_> = first.path().into_iter().map(image).collect();
                    assert_eq!(table.path(), path);
                }
            }
        }
    }
}

#[test]
fn one_counter_per_axis_reaches_rounded_points_and_the_total_counter_misses_some() {
    let (mut tried, mut missed) = (0, 0);
    for a in 2..=12 {
        for b in 2..=12 {
            let shape = Shape::Ellipse([a, b]);
            let rounded = |x: i64| {
                let y = b as f64 * (1.0 - (x * x) as f64 / (a * a) as f64).sqrt();
                (0..=b).find(|&candidate| (candidate as f64 - y).abs() <= 0.5).map(|y| [x, y])
            };
            let points: Vec<[i64; 2]> = (0..=a).rev().filter_map(rounded).collect();
            for (i, &from) in points.iter().enumerate() {
                for &to in &points[i + 1..] {
                    for method in &METHODS[1..5] {
                        assert_eq!(end_of(&method(shape, from, to, [0, 0], false)), to);
                    }
                    let total = end_of(&METHODS[0](shape, from, to, [0, 0], false));
                    tried += 1;
                    missed += i64::from(total != to);
                }
            }
        }
    }
    assert!(missed > 0 && missed < tried / 4, "{missed} of {tried}");
}

#[test]
fn an_ellipse_is_never_split_before_the_point_that_was_reached() {
    // (1,3) lies outside: Y is met at (0,3), not at (0,2).
    for method in &METHODS[..5] {
        let table = method(Shape::Ellipse([5, 2]), [1, 3], [-5, 0], [0, 0], false);
        assert_eq!(end_of(&table), [-5, 0]);
        assert!(table.path().into_iter().all(|[_, y]| y <= 3));
    }
    let table = METHODS[1](Shape::Ellipse([5, 2]), [1, 3], [-5, 0], [0, 0], false);
    assert_eq!([table.column("ex")[0], table.column("ey")[0]], [1, 0]);
    // F of the second piece starts at G(0,3) = 225 - 100 and loses nothing but what Y takes.
    assert_eq!(table.column("f")[..3], [129, 125, 0]);
}

#[test]
fn a_mid_comparison_value_starts_as_the_deviation_with_the_sign_of_the_base() {
    // G(1,4) = 16·1 + 36·16 - 576 = 16, and X is the base: it lowers G on the way to the axis, and
    // raises it on the way from there.
    let shape = Shape::Ellipse([6, 4]);
    for (to, clockwise, f) in [([-6, 0], false, -16), ([6, 0], true, 16)] {
        let table = cim_conic(shape, [1, 4], to, [0, 0], clockwise, Weights::Mid);
        assert_eq!(table.column("f")[0], f);
        assert_eq!(table.column("base")[0], 0);
        assert_eq!(cim_conic(shape, [1, 4], to, [0, 0], clockwise, Weights::Pre).column("f")[0], 0);
    }
}

#[test]
fn an_integrand_that_outgrows_its_register_is_reported() {
    // y² = 4x up to (9,6): J_VX = 2y becomes 8 with the fourth Y pulse.
    let table =
        dda_conic(3, Shape::Parabola(4, Opens::PlusX), [0, 0], [9, 6], [0, 0], false, [0, 0], false, EndPoint::PerAxis);
    assert!(table.overflow && !table.finished);
    assert_eq!(table.column("jvx").last(), Some(&6));
}

#[test]
fn a_normalised_curve_is_that_of_the_fewest_bits() {
    for semi_axes in [[5, 2], [2, 5], [7, 6], [3, 20]] {
        for clockwise in [false, true] {
            for (from, to) in quarters(semi_axes, clockwise) {
                let shape = Shape::Ellipse(semi_axes);
                let n = bits_for(shape, from, to, [0, 0]);
                let plain = integrated(shape, from, to, [0, 0], clockwise, 1);
                let half = [1 << (n + 2); 2];
                let scaled = dda_conic(n + 3, shape, from, to, [0, 0], clockwise, half, true, EndPoint::PerAxis);
                assert_eq!(scaled.path(), plain.path());
                for name in ["jvx", "jvy", "jrx", "jry", "ux", "uy"] {
                    let eightfold: Vec<i64> = plain.column(name).into_iter().map(|value| 8 * value).collect();
                    assert_eq!(scaled.column(name), eightfold, "{shape:?} {name}");
                }
            }
        }
    }
}

#[test]
fn one_counter_of_both_integrators_counts_every_pulse() {
    let shape = Shape::Ellipse([5, 2]);
    let table = dda_conic(7, shape, [5, 0], [0, 2], [0, 0], false, [64; 2], false, EndPoint::Total);
    assert!(table.finished);
    assert_eq!(table.column("e")[0], 7);
    let mut counted = 0;
    for ((dx, dy), e) in table.column("dx").into_iter().zip(table.column("dy")).zip(table.column("e")) {
        counted += dx.abs() + dy.abs();
        assert_eq!(e, (7 - counted).max(0));
    }
}
