//! Free curves by cascaded integrators.

use proptest::prelude::*;
use rayon::prelude::*;
use stepwave::testbench::{Ending, PathWatch, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::{DIVISIONS, FRACTION};
use stepwave_models::{Options, find};
use stepwave_nc::{Conic, Curve, Spline, SplineForm};
use stepwave_netlist::Width;

use super::{assert_equal, bench, check, run, widths};
use crate::reference::{Basis, Segment, Table, spline_dda, spline_dda_fraction, spline_owes};

const NAME: &str = "spline-dda";

fn spline(form: SplineForm, points: &[[i64; 2]]) -> Curve {
    Spline::new(form, points).unwrap().into()
}

/// The segments of a curve, each by its own points.
fn segments(form: SplineForm, points: &[[i64; 2]]) -> Vec<Segment> {
    match form {
        SplineForm::Bezier => vec![(Basis::Bezier, points.to_vec())],
        SplineForm::Hermite => vec![(Basis::Hermite, vec![points[0], points[1], points[2], points[3]])],
        SplineForm::BSpline => points.windows(4).map(|four| (Basis::BSpline, four.to_vec())).collect(),
        SplineForm::CatmullRom => {
            // The neighbour that is missing at an end lies as far beyond it as the next point is inside.
            let beyond = |end: [i64; 2], next: [i64; 2]| [2 * end[0] - next[0], 2 * end[1] - next[1]];
            let last = points.len() - 1;
            let all =
                [&[beyond(points[0], points[1])][..], points, &[beyond(points[last], points[last - 1])][..]].concat();
            all.windows(4).map(|four| (Basis::CatmullRom, four.to_vec())).collect()
        }
    }
}

/// The least number of divisions in which no axis owes more than a pulse a step.
fn least(segments: &[Segment]) -> u32 {
    (1..20).find(|&s| spline_owes(segments, s).is_none()).unwrap()
}

fn check_spline(form: SplineForm, points: &[[i64; 2]], engine: EngineKind) {
    let (curve, segments) = (spline(form, points), segments(form, points));
    check(NAME, &curve, &Options::default(), engine, &spline_dda(&segments, least(&segments)));
}

#[test]
fn every_cubic_bezier_curve_with_small_points() {
    let sides = || -5..=5;
    (-5..=5i64).into_par_iter().for_each(|a| {
        for (b, c) in sides().flat_map(|b| sides().map(move |c| (b, c))).filter(|(b, c)| [a, *b, *c] != [0; 3]) {
            // Another curve in y, no simple image of that in x.
            let y = [3, 3 - c, a + 1, (a * b) % 6];
            let points: Vec<_> = [0, a, b, c].into_iter().zip(y).map(|(x, y)| [x, y]).collect();
            check_spline(SplineForm::Bezier, &points, EngineKind::Word);
        }
    });
}

/// Points of chains; two of the second are one.
const CHAINS: [&[[i64; 2]]; 3] = [
    &[[0, 0], [30, 50], [60, -20], [90, 30]],
    &[[5, -3], [5, -3], [-40, 17], [2, 60], [2, 60], [31, 8], [-7, -7]],
    &[[-100, 0], [-99, 3], [-97, 100], [0, 101], [1, 100]],
];

#[test]
fn every_form_on_every_engine() {
    for engine in EngineKind::ALL {
        check_spline(SplineForm::Bezier, &[[0, 0], [4, 0], [8, 4], [8, 8]], engine);
        check_spline(SplineForm::Bezier, &[[7, -7], [90, 44], [-3, 13]], engine);
        check_spline(SplineForm::Hermite, &[[3, 1], [100, 0], [-20, 14], [-9, 77]], engine);
        for points in CHAINS {
            check_spline(SplineForm::CatmullRom, points, engine);
            check_spline(SplineForm::BSpline, points, engine);
        }
    }
}

#[test]
fn a_step_that_owes_more_than_a_pulse_traps_there() {
    let chains = CHAINS.iter().flat_map(|points| [(SplineForm::CatmullRom, *points), (SplineForm::BSpline, *points)]);
    let beziers = [[[0, 0], [50, 3], [-20, 8], [9, 31]], [[0, 0], [1, 3], [20, 8], [90, -31]]];
    let all = chains.chain(beziers.iter().map(|points| (SplineForm::Bezier, &points[..])));
    let mut trapped = 0;
    for (form, points) in all {
        let segments = segments(form, points);
        for s in 1..=least(&segments) {
            let choices = Options::default().with(&DIVISIONS, Some(u64::from(s)));
            let ran = run(NAME, &spline(form, points), &choices, EngineKind::Word);
            let Some((segment, step)) = spline_owes(&segments, s) else {
                assert_eq!(ran.outcome.ending, Ending::Done);
                continue;
            };
            let before = (segment << s) as u64 + u64::try_from(step).unwrap();
            assert_eq!((ran.outcome.ending, ran.outcome.steps), (Ending::Trapped, before), "{form:?} {points:?} {s}");
            trapped += 1;
        }
    }
    assert!(trapped > 20, "{trapped}");
}

/// How far an axis of a curve of whole start points may be off its place after any step, in BLU.
fn bound(s: u32, bits: u32) -> f64 {
    let n = f64::from(1 << s);
    (n + n * (n - 1.0) / 2.0 + n * (n - 1.0) * (n - 2.0) / 6.0) / 2f64.powi(i32::try_from(bits).unwrap() + 1)
}

/// How far an axis is off its place at most: both tables have it as x and jr.
fn farthest(rounded: &Table, bits: u32, exact: &Table, segments: &[Segment], s: u32) -> f64 {
    let places = |table: &Table, axis: &str, modulus: f64| -> Vec<f64> {
        let (x, rest) = (table.column(axis), table.column(&format!("jr{axis}")));
        x.iter().zip(rest).map(|(x, rest)| *x as f64 + rest as f64 / modulus - 0.5).collect()
    };
    let divisor = if segments[0].0 == Basis::CatmullRom { 2.0 } else { 1.0 };
    let off = |axis| {
        let rounded = places(rounded, axis, 2f64.powi(i32::try_from(bits).unwrap()));
        let exact = places(exact, axis, divisor * 2f64.powi(3 * i32::try_from(s).unwrap()));
        rounded.into_iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    off("x").max(off("y"))
}

#[test]
fn with_a_fraction_the_registers_are_those_of_the_rounded_recurrence() {
    for engine in EngineKind::ALL {
        for (form, points) in [
            (SplineForm::Bezier, &[[0, 0], [4, 0], [8, 4], [8, 8]][..]),
            (SplineForm::Hermite, &[[3, 1], [40, 0], [-20, 14], [-9, 57]]),
            (SplineForm::CatmullRom, CHAINS[0]),
        ] {
            let segments = segments(form, points);
            let s = least(&segments);
            for bits in [2 * s, 3 * s - 2, 3 * s, 3 * s + 4] {
                let choices = Options::default().with(&FRACTION, Some(bits));
                let ran = run(NAME, &spline(form, points), &choices, engine);
                let table = spline_dda_fraction(&segments, s, bits);
                assert_equal(|| format!("{form:?}, {bits} bits of fraction"), &ran, &table);
                let exact = spline_dda(&segments, s);
                assert!(farthest(&table, bits, &exact, &segments, s) <= bound(s, bits), "{form:?} {bits}");
                let whole = form == SplineForm::CatmullRom || ran.outcome.reached == spline(form, points).to();
                assert!(bits < 3 * s - 2 || whole, "{form:?} {bits}");
            }
        }
    }
}

#[test]
fn what_segments_err_by_with_a_fraction_adds_up_within_the_promise() {
    for (points, bits) in [
        (&[[2, 1], [-2, -1], [1, 0], [-3, 1], [-1, 1], [3, -1]][..], 6),
        (&[[3, -10], [7, -2], [-9, -8], [6, -2], [-6, 1], [5, -10]], 8),
    ] {
        let curve = spline(SplineForm::CatmullRom, points);
        let bench = bench(NAME, &curve, &Options::default().with(&FRACTION, Some(bits)));
        let mut path = PathWatch::new(&bench, &curve);
        bench.run(EngineKind::Word, &mut [&mut path]).unwrap();
        let (error, bound) = (path.worst.unwrap().error, bench.hardware().error_bound.unwrap());
        assert!(error > 2.0 && error <= bound, "{error} {bound}");
    }
}

#[test]
fn a_quadratic_curve_ends_where_the_parabola_of_the_conic_does_and_lies_on_it() {
    // y² = 4x from (0, 0) to (9, 6): the control point is where the tangents of both ends meet.
    let curve = spline(SplineForm::Bezier, &[[0, 0], [0, 3], [9, 6]]);
    let conic = Curve::Conic(Conic::parabola(4, None, [0, 0], [9, 6], [0, 0]).unwrap());
    let [by_spline, by_conic] = [(NAME, &curve), ("dda-conic", &conic)].map(|(model, own)| {
        let bench = bench(model, own, &Options::default());
        let mut path = PathWatch::new(&bench, &conic);
        let outcome = bench.run(EngineKind::Word, &mut [&mut path]).unwrap();
        (outcome.reached, path.worst.unwrap().error)
    });
    assert_eq!(by_spline.0, by_conic.0);
    assert!(by_spline.1 <= 0.5f64.sqrt() && by_conic.1 < 1.5, "{by_spline:?} {by_conic:?}");
}

/// Where p is least or greatest next to a row, not in it; the second in several segments.
#[test]
fn the_steepest_row_is_found_where_the_vertex_lies_between_two() {
    check_spline(SplineForm::Hermite, &[[-4, -2], [0, -1], [1, -2], [-3, -4]], EngineKind::Word);
    check_spline(SplineForm::CatmullRom, &[[-1, -1], [-1, 0], [2, -2], [-1, -1], [-2, 2]], EngineKind::Word);
}

#[test]
fn a_closed_curve_of_less_than_a_blu_needs_no_pulse() {
    let curve = spline(SplineForm::Hermite, &[[1, -2], [1, -1], [1, -2], [-2, -2]]);
    let ran = run(NAME, &curve, &Options::default(), EngineKind::Word);
    assert!(ran.outcome.ending == Ending::Done && ran.outcome.ends(&curve), "{:?}", ran.outcome);
    assert_eq!(ran.outcome.pulses, [0, 0]);
}

#[test]
fn one_bit_less_traps_in_the_register_that_lacks_it() {
    let curve = spline(SplineForm::Bezier, &[[0, 0], [50, 3], [-20, 8], [9, 31]]);
    let hardware = find(NAME).unwrap().plan(&curve, &Options::default()).unwrap();
    for register in ["px", "qx"] {
        let narrow = widths(&[(register, hardware.bits_of(register) - 1)]);
        // Either the first word does not fit, or a later value.
        match Testbench::new(find(NAME).unwrap(), &curve, &narrow) {
            Ok(bench) => {
                let outcome = bench.run(EngineKind::Word, &mut []).unwrap();
                assert_eq!(outcome.ending, Ending::Trapped, "{register}");
            }
            Err(error) => assert!(error.to_string().starts_with(&format!("{register} = ")), "{error}"),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn divisions_and_widths_are_those_of_every_row(
        points in prop::collection::vec(prop::array::uniform2(-6i64..7), 4..7), form in 0usize..4
    ) {
        let form = SplineForm::ALL[form];
        let few = if matches!(form, SplineForm::Bezier | SplineForm::Hermite) { 4 } else { points.len() };
        let Ok(curve) = Spline::new(form, &points[..few]) else { return Ok(()) };
        let segments = segments(form, &points[..few]);
        let (s, hardware) = (least(&segments), find(NAME).unwrap().plan(&curve.into(), &Options::default()).unwrap());
        prop_assert_eq!(hardware.get(&DIVISIONS), Some(u64::from(s)), "{:?} {:?}", form, points);
        let table = spline_dda(&segments, s);
        for kind in ["p", "q", "r"] {
            let values = ["x", "y"].map(|axis| table.column(&format!("{kind}{axis}"))).concat();
            let needed = values.iter().map(|value| Width::needed_signed((*value).into())).max().unwrap();
            prop_assert!(hardware.bits_of(&format!("{kind}x")) >= needed, "{:?} {:?} {}", form, points, kind);
        }
    }
}

proptest! {
    #[test]
    fn random_curves_stay_within_half_a_blu_of_each_axis(
        points in prop::collection::vec(prop::array::uniform2(-300i64..300), 4..8), form in 0usize..4
    ) {
        let form = SplineForm::ALL[form];
        let few = if matches!(form, SplineForm::Bezier | SplineForm::Hermite) { 4 } else { points.len() };
        let points = &points[..few];
        let Ok(curve) = Spline::new(form, points) else { return Ok(()) };
        let curve: Curve = curve.into();
        let segments = segments(form, points);
        let table = spline_dda(&segments, least(&segments));
        check(NAME, &curve, &Options::default(), EngineKind::Compiled, &table);
        let bench = bench(NAME, &curve, &Options::default());
        let mut path = PathWatch::new(&bench, &curve);
        bench.run(EngineKind::Word, &mut [&mut path]).unwrap();
        let error = path.worst.unwrap().error;
        prop_assert!(error <= 0.5f64.sqrt() + 1e-9, "{form:?} {points:?}: {error}");
    }
}
