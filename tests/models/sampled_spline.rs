//! Data sampling of a NURBS: every period against the recurrence in whole numbers, circles against those of the arcs.

use proptest::prelude::*;
use stepwave::testbench::{Ending, PathWatch, Testbench};
use stepwave_engine::EngineKind;
use stepwave_models::options::{FRACTION, ON_OVERFLOW, STEP, TOLERANCE, WIDTH};
use stepwave_models::{Millionths, OnOverflow, Options, find};
use stepwave_nc::{ControlPoint, Curve, NURBS_UNIT, Nurbs};
use stepwave_netlist::Width;

use super::{Ran, arc, bench, run};
use crate::reference::{Row, Sampled, sampled_nurbs};

const NAME: &str = "sampled-spline";
const ONE: i64 = NURBS_UNIT;
const HALF_ROOT: i64 = 707_106_781;

/// Bits of the fraction, the displacement of a period and the tolerance, both in thousandths of a BLU.
#[derive(Clone, Copy, Debug)]
struct Choices {
    fraction: u32,
    step: u64,
    tolerance: u64,
}

impl Choices {
    fn options(self) -> Options {
        let thousandths = |value: u64| Some(Millionths(value * 1000));
        let options = Options::default().with(&FRACTION, Some(self.fraction));
        options.with(&STEP, thousandths(self.step)).with(&TOLERANCE, thousandths(self.tolerance))
    }
}

fn nurbs(degree: usize, points: &[[i64; 3]], knots: Option<&[i64]>) -> Nurbs {
    let points: Vec<_> = points.iter().map(|&[x, y, weight]| ControlPoint { at: [x, y], weight }).collect();
    let knots: Option<Vec<_>> = knots.map(|knots| knots.iter().map(|knot| knot * ONE).collect());
    Nurbs::new(degree, &points, knots.as_deref()).unwrap()
}

/// A full circle about the origin, against the clock.
fn circle(radius: i64) -> Nurbs {
    let corners = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let weight = |index: usize| if index.is_multiple_of(2) { ONE } else { HALF_ROOT };
    let points: Vec<_> =
        corners.iter().enumerate().map(|(index, [x, y])| [x * radius, y * radius, weight(index)]).collect();
    nurbs(2, &points, Some(&[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]))
}

/// What the recurrence makes of it.
fn reference(curve: &Nurbs, choices: Choices) -> Option<Vec<Row>> {
    let scaled = |value: i64, bits: u32| {
        let (value, unit) = (i128::from(value), i128::from(ONE));
        ((value << (bits + 1)) + unit) / (2 * unit)
    };
    let points: Vec<_> = curve.points().iter().map(|point| point.at).collect();
    let weights: Vec<_> = curve.points().iter().map(|point| scaled(point.weight, choices.fraction)).collect();
    let knots: Vec<_> = curve.knots().iter().map(|knot| scaled(knot - curve.knots()[0], 32)).collect();
    let step = ((i128::from(choices.step) << choices.fraction) + 500) / 1000;
    let tolerance = Some(i128::from(choices.tolerance) * 1000);
    let (degree, fraction) = (curve.degree(), choices.fraction);
    sampled_nurbs(&Sampled { degree, points: &points, weights: &weights, knots: &knots, fraction, step, tolerance })
}

fn column(ran: &Ran, name: &str) -> Vec<i64> {
    let index = ran.columns.iter().position(|column| column == name).unwrap();
    ran.rows.iter().map(|row| row[index]).collect()
}

/// Runs it, and compares every period: u, the coarse point, and where the fine stage comes to. All periods take as many
/// clocks as the plan says.
fn check(curve: &Nurbs, choices: Choices, engine: EngineKind) -> usize {
    let what = format!("{curve:?} {choices:?} on {}", engine.name());
    let rows = reference(curve, choices).unwrap();
    let (curve, options) = (Curve::Nurbs(curve.clone()), choices.options());
    let ran = run(NAME, &curve, &options, engine);
    assert_eq!((ran.outcome.ending, &ran.outcome.reached[..]), (Ending::Done, curve.to()), "{what}");
    let wanted: Vec<i128> = rows.iter().map(|row| row.u).collect();
    assert_eq!(column(&ran, "u").into_iter().map(i128::from).collect::<Vec<_>>(), wanted, "{what}: u");
    let q = choices.fraction;
    for (axis, names) in [["x", "cx", "jrx", "dx", "jvx"], ["y", "cy", "jry", "dy", "jvy"]].into_iter().enumerate() {
        let [position, point, jr, pulses, jv] = names.map(|name| column(&ran, name));
        for (index, row) in rows.iter().enumerate() {
            assert_eq!(i128::from(point[index]), row.point[axis], "{what}: axis {axis}, period {index}");
            let whole = (row.point[axis] + (1 << (q - 1))) >> q;
            assert_eq!(i128::from(position[index]), whole, "{what}: axis {axis} after period {index}");
            assert_eq!((jr[index], pulses[index].abs()), (jr[0], jv[index]), "{what}: axis {axis}, period {index}");
        }
    }
    let sampling = bench(NAME, &curve, &options).hardware().sampling.unwrap();
    let (clocks, period) = (column(&ran, "clock"), i64::try_from(sampling.clocks[0]).unwrap());
    assert!(clocks[1..].windows(2).all(|pair| pair[1] - pair[0] == period), "{what}: {clocks:?}, {period}");
    rows.len()
}

/// All but the oracle, which takes a hundred times as long.
const FAST: [EngineKind; 2] = [EngineKind::Word, EngineKind::Compiled];

#[test]
fn the_worked_table_comes_out_of_the_hardware() {
    let curve = nurbs(2, &[[1000, 0, ONE], [1000, 1000, HALF_ROOT], [0, 1000, ONE]], None);
    for engine in FAST {
        // A chord of 200 BLU leaves the circle of 1000 BLU by 5 BLU.
        assert_eq!(check(&curve, Choices { fraction: 16, step: 200_000, tolerance: 10_000 }, engine), 9);
        assert!(check(&curve, Choices { fraction: 16, step: 200_000, tolerance: 1_300 }, engine) > 16);
    }
}

#[test]
fn every_degree_and_many_spans() {
    let points = [
        [0, 0, ONE],
        [30, 50, 3 * ONE],
        [60, -20, ONE / 5],
        [-10, 30, ONE],
        [70, 70, 2 * ONE],
        [9, 9, ONE],
        [40, -3, ONE],
    ];
    for degree in 1..=6 {
        // What the word engine does with a degree it does with the others.
        for engine in FAST.into_iter().skip(usize::from(degree != 3)) {
            let choices = Choices { fraction: 12, step: 21_500, tolerance: 700 };
            let long = check(&nurbs(degree, &points, None), choices, engine);
            assert!(long > 10, "degree {degree}: {long}");
        }
    }
    // Corners, and spans of unequal length that do not begin at 0.
    let knots = [-2, -2, -2, 1, 1, 2, 2, 9, 9, 9];
    check(
        &nurbs(2, &points, Some(&knots)),
        Choices { fraction: 14, step: 9_000, tolerance: 200 },
        EngineKind::Compiled,
    );
    // Numbers of more than 64 bits in every component.
    let far: Vec<_> = points.iter().map(|[x, y, weight]| [x * 90, y * 90, *weight]).collect();
    check(&nurbs(3, &far, None), Choices { fraction: 20, step: 900_000, tolerance: 20_000 }, EngineKind::Compiled);
}

#[test]
fn the_gates_make_the_same_of_a_short_curve() {
    let short = nurbs(2, &[[9, -2, ONE], [14, 8, HALF_ROOT], [0, 5, ONE], [-3, 1, ONE]], None);
    for engine in EngineKind::ALL {
        assert!(check(&short, Choices { fraction: 9, step: 8_000, tolerance: 300 }, engine) >= 5);
    }
}

#[test]
fn a_circle_stays_as_near_as_that_of_the_arcs() {
    for (radius, steps) in [(40_i64, &[5.0, 20.0_f64][..]), (250, &[40.0]), (1000, &[100.0])] {
        for &step in steps {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let step_thousandths = (step * 1000.0) as u64;
            let options = Choices { fraction: 16, step: step_thousandths, tolerance: 2_000 }.options();
            let round = arc([radius, 0], [radius, 0], [0, 0], false);
            let fewer = options.clone().with(&FRACTION, Some(12));
            let of_arc = (radius as f64 / 2.0 >= step).then(|| error("sampled-arc", &round, &round, &fewer));
            let own = error(NAME, &circle(radius).into(), &round, &options);
            // Half a pulse of rounding on each axis, twice between two pulses, and the chord of the longest step.
            let r = radius as f64;
            let longest = step + 0.21 * step * step / r;
            let bound = 1.5 * std::f64::consts::SQRT_2 + longest * longest / (8.0 * r);
            assert!(own <= bound, "{radius} {step}: {own}, but {bound}");
            assert!(of_arc.is_none_or(|of_arc| of_arc <= bound), "{radius} {step}: {of_arc:?}, but {bound}");
        }
    }
}

/// The greatest path error of a run, from this curve.
fn error(model: &str, curve: &Curve, from: &Curve, options: &Options) -> f64 {
    let bench = bench(model, curve, options);
    let mut path = PathWatch::new(&bench, from);
    let outcome = bench.run(EngineKind::Compiled, &mut [&mut path]).unwrap();
    assert!(outcome.ending == Ending::Done && outcome.reached == curve.to());
    path.worst.unwrap().error
}

#[test]
fn steps_on_a_circle_differ_from_the_displacement_chosen_by_little() {
    for (radius, step) in [(1000_i64, 100_u64), (1000, 200), (4000, 300)] {
        let choices = Choices { fraction: 20, step: step * 1000, tolerance: 50_000 };
        let rows = reference(&circle(radius), choices).unwrap();
        let scale = f64::from(1 << 20);
        let (f, r) = (step as f64, radius as f64);
        for pair in rows.windows(2).take(rows.len() - 2) {
            let [x, y] = [0, 1].map(|axis| (pair[1].point[axis] - pair[0].point[axis]) as f64 / scale);
            assert!((x.hypot(y) - f).abs() <= 0.21 * f * f / r + 0.01, "{radius} {step}: {}", x.hypot(y));
        }
    }
}

#[test]
fn the_chord_error_that_is_reported_is_that_of_the_periods_and_is_held() {
    let curve = circle(1000);
    for (tolerance, least) in [(1_000, 0.2), (4_000, 1.0), (50_000, 4.9)] {
        let choices = Choices { fraction: 16, step: 200_000, tolerance };
        let hardware = find(NAME).unwrap().plan(&curve.clone().into(), &choices.options()).unwrap();
        let seen = hardware.sampling.unwrap().chord_error;
        assert!(seen <= tolerance as f64 / 1000.0 && seen > least, "{tolerance}: {seen}");
    }
}

#[test]
fn steps_far_below_a_pulse_are_no_stall() {
    // A chord of 0.28 BLU is 0.001 BLU off the circle of 10 BLU.
    let curve = nurbs(2, &[[10, 0, ONE], [10, 10, HALF_ROOT], [0, 10, ONE]], None);
    let long = check(&curve, Choices { fraction: 12, step: 8_000, tolerance: 1 }, EngineKind::Compiled);
    assert!(long > 50, "{long}");
}

#[test]
fn an_integrand_that_is_too_narrow_traps_and_else_loses_its_top_bit() {
    let curve: Curve = nurbs(2, &[[100, 0, ONE], [100, 100, HALF_ROOT], [0, 100, ONE]], None).into();
    let choices = Choices { fraction: 12, step: 12_000, tolerance: 1_000 };
    let narrow = |mode: OnOverflow| {
        let narrow = [("jvx".to_owned(), Width::new(3).unwrap())].into();
        choices.options().with_single(&WIDTH, narrow).with(&ON_OVERFLOW, mode)
    };
    let bench = Testbench::new(find(NAME).unwrap(), &curve, &narrow(OnOverflow::Trap)).unwrap();
    for engine in FAST {
        let outcome = bench.run(engine, &mut []).unwrap();
        assert_eq!(outcome.ending, Ending::Trapped, "{}", engine.name());
    }
    let bench = Testbench::new(find(NAME).unwrap(), &curve, &narrow(OnOverflow::Wrap)).unwrap();
    assert_ne!(bench.run(EngineKind::Word, &mut []).unwrap().reached, curve.to());
}

#[test]
fn what_cannot_be_sampled_is_refused_with_its_remedy() {
    let refusal = |curve: &Nurbs, options: &Options| {
        find(NAME).unwrap().plan(&curve.clone().into(), options).unwrap_err().to_string()
    };
    let rests = nurbs(2, &[[0, 0, ONE], [0, 0, ONE], [9, 3, ONE]], None);
    let message = refusal(&rests, &Options::default());
    assert!(
        message.contains("rests at u = 0.000000") && message.contains("move the control points apart"),
        "{message}"
    );
    let curve = circle(1000);
    let with = |fraction: u32, step: u64| Choices { fraction, step, tolerance: 1_000 }.options();
    for (options, wanted) in [
        (with(7, 8_000), "8 to 48 bits of fraction"),
        (with(49, 8_000), "8 to 48 bits of fraction"),
        (with(48, 8_000), "give --fraction 40 or less"),
        (with(16, 0), "it does not fit 16 bits of fraction"),
        (with(16, 1), "more than 1048576 periods: give a greater --step"),
    ] {
        let message = refusal(&curve, &options);
        assert!(message.contains(wanted), "{message}");
    }
    let light = nurbs(1, &[[0, 0, ONE], [5, 5, ONE / 1_000_000], [9, 0, ONE]], None);
    let message = refusal(&light, &with(8, 8_000));
    assert!(message.contains("the weight of point 2 would be 0: give more bits"), "{message}");
    let slow = with(16, 8_000).at_clock(1000.0);
    let message = refusal(&curve, &slow);
    assert!(message.contains("8 clocks in the period of 8 ms") && message.contains("give --clock-hz"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_curves_are_those_of_the_recurrence(
        degree in 1_usize..5,
        points in prop::collection::vec((prop::array::uniform2(-120_i64..121), 1_i64..40), 2..9),
        gaps in prop::collection::vec(0_i64..4, 16),
        fraction in 8_u32..20,
        step in 3_000_u64..40_000,
        tolerance in 100_u64..3_000,
    ) {
        let points: Vec<_> =
            points.iter().map(|&([x, y], weight)| ControlPoint { at: [x, y], weight: weight * ONE / 8 }).collect();
        let degree = degree.min(points.len() - 1);
        // Ends, and inner knots that may be equal.
        let mut inner = 0;
        let mut knots = vec![0; degree + 1];
        for gap in gaps.iter().take(points.len() - degree - 1) {
            inner += gap * ONE / 2;
            knots.push(inner);
        }
        knots.extend(vec![inner + ONE; degree + 1]);
        let Ok(curve) = Nurbs::new(degree, &points, Some(&knots)) else { return Ok(()) };
        let choices = Choices { fraction, step, tolerance };
        match reference(&curve, choices) {
            None => {
                let refused = find(NAME).unwrap().plan(&curve.into(), &choices.options());
                prop_assert!(refused.is_err_and(|error| error.to_string().contains("rests")));
            }
            Some(rows) if rows.len() > 60 => {}
            Some(_) => {
                check(&curve, choices, EngineKind::Compiled);
            }
        }
    }
}
