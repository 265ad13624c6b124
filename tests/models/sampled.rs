//! Data sampling: coarse points in fixed point against formulas in real numbers, and the pulses made of them.

use rayon::prelude::*;
use stepwave::testbench::{CoarseWatch, Ending, SpacingWatch};
use stepwave_engine::EngineKind;
use stepwave_models::options::{FRACTION, PRESET, STEP, SYSTEM, TOLERANCE, WIDTH};
use stepwave_models::{Millionths, ModelError, Options, Preset, System, find};
use stepwave_nc::Curve;
use stepwave_netlist::Width;

use super::{Ran, arc, bench, lattice, line, run};
use crate::reference::{self, sampled_arc, sampled_line, step_factor_points};

const SYSTEMS: [(System, reference::System); 2] =
    [(System::Direction, reference::System::Direction), (System::StepFactor, reference::System::StepFactor)];

/// A step in thousandths of a BLU.
fn choices(system: System, fraction: u32, step: u64) -> Options {
    let step = Some(Millionths(step * 1000));
    Options::default().with(&SYSTEM, system).with(&FRACTION, Some(fraction)).with(&STEP, step)
}

fn column(ran: &Ran, name: &str) -> Vec<i64> {
    let index = ran.columns.iter().position(|column| column == name).unwrap();
    ran.rows.iter().map(|row| row[index]).collect()
}

/// Coarse points in BLU, one a row.
fn points(ran: &Ran, fraction: u32) -> Vec<[f64; 2]> {
    let [x, y] = ["cx", "cy"].map(|name| column(ran, name));
    let unit = f64::from(1 << fraction);
    x.into_iter().zip(y).map(|(x, y)| [x as f64 / unit, y as f64 / unit]).collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The distance of a point from the radius to another.
fn side([x, y]: [f64; 2], end: [f64; 2]) -> f64 {
    (x * end[1] - y * end[0]).abs() / end[0].hypot(end[1])
}

/// What holds of every run: each coarse point within `drift` units of the fraction a period of the one wanted, each
/// period ends at its point rounded, the end is exact, and J_R returns.
fn assert_sampled(what: &str, curve: &Curve, ran: &Ran, wanted: &[[f64; 2]], fraction: u32, drift: f64) {
    let round = matches!(curve, Curve::Arc(_));
    assert_eq!((ran.outcome.ending, &ran.outcome.reached[..]), (Ending::Done, curve.to()), "{what}");
    let got = points(ran, fraction);
    let room = |period: usize| drift * (period + 1) as f64 / f64::from(1 << fraction);
    let inner = got.len().min(wanted.len()) - 1;
    for period in 0..inner {
        let off = distance(got[period], wanted[period]);
        assert!(off <= room(period), "{what}: {off} off after period {period}: {:?}", got[period]);
    }
    assert_eq!(got.last(), wanted.last(), "{what}");
    if got.len() != wanted.len() {
        // Where a point comes to the end within rounding, it may count as the last or not.
        let longer = if got.len() > wanted.len() { &got[..] } else { wanted };
        assert!(got.len().abs_diff(wanted.len()) == 1, "{what}: {} and {}", got.len(), wanted.len());
        let end = *longer.last().unwrap();
        let off = if round { side(longer[inner], end) } else { distance(longer[inner], end) };
        assert!(off <= room(inner), "{what}: a period more, {off} before the end");
    }
    for (axis, names) in [["x", "jrx", "dx", "jvx", "cx"], ["y", "jry", "dy", "jvy", "cy"]].into_iter().enumerate() {
        let [position, jr, pulses, jv, fine] = names.map(|name| column(ran, name));
        let offset = position[0] - (fine[0] >> fraction);
        for row in 1..position.len() {
            let rounded = (fine[row] + (1 << (fraction - 1))) >> fraction;
            assert_eq!(position[row], rounded + offset, "{what}: axis {axis} behind period {row}");
            assert_eq!((jr[row], pulses[row].abs()), (jr[0], jv[row]), "{what}: axis {axis} behind period {row}");
        }
    }
}

fn check_line(from: [i64; 2], d: [i64; 2], choices: &Options, engine: EngineKind) {
    let curve = line(&from, &[from[0] + d[0], from[1] + d[1]]);
    let system = SYSTEMS.iter().find(|(system, _)| Some(*system) == choices.get(&SYSTEM).copied()).unwrap().1;
    let (fraction, step) = (choices.value(&FRACTION).unwrap(), choices.value(&STEP).unwrap().units());
    let what = format!("{curve:?} {choices:?} on {}", engine.name());
    let ran = run("sampled-line", &curve, choices, engine);
    assert_sampled(&what, &curve, &ran, &sampled_line(d, step, system), fraction, 2.0);
}

fn check_arc(start: [i64; 2], end: [i64; 2], clockwise: bool, choices: &Options, engine: EngineKind) {
    let curve = arc([start[0] + 3, start[1] - 5], [end[0] + 3, end[1] - 5], [3, -5], clockwise);
    let system = SYSTEMS.iter().find(|(system, _)| Some(*system) == choices.get(&SYSTEM).copied()).unwrap().1;
    let (fraction, step) = (choices.value(&FRACTION).unwrap(), choices.value(&STEP).unwrap().units());
    let what = format!("{curve:?} {choices:?} on {}", engine.name());
    let ran = run("sampled-arc", &curve, choices, engine);
    assert_sampled(&what, &curve, &ran, &sampled_arc(start, end, clockwise, step, system), fraction, 4.0);
}

/// In millimetres of 1000 BLU, to six digits.
fn six_digits(point: [f64; 2]) -> String {
    format!("({:.6},{:.6})", point[0] / 1000.0, point[1] / 1000.0)
}

#[test]
fn the_worked_numbers_of_both_systems_come_out_of_the_fixed_point() {
    // R = 10 mm from (0, 10), 0.08 mm a period; and λ = 0.01024.
    for (system, step, wanted) in [
        (System::Direction, 80_000, ["(0.080000,9.999680)", "(0.159995,9.998720)"]),
        (System::StepFactor, 102_400, ["(0.102400,9.999476)", "(0.204789,9.997903)"]),
    ] {
        let curve = arc([0, 10_000], [10_000, 0], [0, 0], true);
        let ran = run("sampled-arc", &curve, &choices(system, 12, step), EngineKind::Compiled);
        let points = points(&ran, 12);
        assert_eq!([1, 2].map(|period| six_digits(points[period])), wanted.map(str::to_owned), "{system:?}");
        assert_eq!(ran.outcome.reached, [10_000, 0]);
    }
}

#[test]
fn lines_of_all_quadrants_are_those_of_the_formulas_at_every_period_and_end_exactly() {
    let travels: Vec<i64> = vec![-97, -31, -3, -1, 0, 2, 16, 89];
    travels.par_iter().for_each(|&x| {
        for &y in travels.iter().filter(|&&y| [x, y] != [0, 0]) {
            for (system, _) in SYSTEMS {
                for (fraction, step) in [(8, 8_000), (12, 2_500), (10, 700)] {
                    check_line([4, -9], [x, y], &choices(system, fraction, step), EngineKind::Word);
                }
            }
        }
    });
}

#[test]
fn arcs_of_all_quadrants_in_both_directions_are_those_of_the_formulas_at_every_period_and_end_exactly() {
    // 12 lattice points each: every quadrant, every octant, the axes; among them full circles.
    [25_i64, 625, 1250].par_iter().for_each(|&square| {
        let points = lattice(square);
        let radius = square.isqrt().unsigned_abs();
        for &start in &points {
            for &end in points.iter().step_by(5) {
                for clockwise in [true, false] {
                    for (system, _) in SYSTEMS {
                        for (fraction, step) in [(8, radius * 250), (12, 2_300)] {
                            check_arc(start, end, clockwise, &choices(system, fraction, step), EngineKind::Word);
                        }
                    }
                }
            }
        }
    });
}

#[test]
fn arcs_whose_ends_lie_off_their_circles_and_shorter_than_a_period_end_exactly() {
    for (start, end) in
        [([50, 0], [0, 51]), ([50, 0], [51, 0]), ([51, 0], [50, 1]), ([30, 40], [31, 39]), ([0, -9], [1, -9])]
    {
        for clockwise in [true, false] {
            for (system, _) in SYSTEMS {
                check_arc(start, end, clockwise, &choices(system, 10, 4_000), EngineKind::Compiled);
            }
        }
    }
}

#[test]
fn every_engine_draws_the_same_lines_and_arcs() {
    for engine in EngineKind::ALL {
        for (system, _) in SYSTEMS {
            check_line([0, 0], [30, -17], &choices(system, 8, 8_000), engine);
            check_arc([-7, 24], [24, 7], true, &choices(system, 8, 6_000), engine);
        }
    }
}

#[test]
fn the_fraction_bits_are_all_that_keeps_coarse_points_off_the_curve() {
    for fraction in 8..=14 {
        let unit = 1.0 / f64::from(1 << fraction);
        for (model, curve, system, units) in [
            // The other axis is the root of what is left, rounded down.
            ("sampled-arc", arc([600, 0], [600, 0], [0, 0], false), System::Direction, 1.5),
            ("sampled-line", line(&[0, 0], &[997, -613]), System::Direction, 1.0),
            ("sampled-line", line(&[0, 0], &[997, -613]), System::StepFactor, 1.0),
        ] {
            let bench = bench(model, &curve, &choices(system, fraction, 9_300));
            let mut coarse = CoarseWatch::new(&bench, &curve).unwrap();
            bench.run(EngineKind::Compiled, &mut [&mut coarse]).unwrap();
            let worst = coarse.worst.unwrap();
            assert!(worst.error <= units * unit, "{model} {fraction}: {worst:?}");
            // Nor are there idle bits.
            assert!(worst.error >= unit / 16.0, "{model} {fraction}: {worst:?}");
        }
    }
}

#[test]
fn a_circle_by_the_step_factor_grows_as_its_formula_says_and_no_more() {
    let (radius, step) = (1000.0_f64, 50.0_f64);
    let curve = arc([1000, 0], [1000, 0], [0, 0], true);
    let ran = run("sampled-arc", &curve, &choices(System::StepFactor, 14, 50_000), EngineKind::Compiled);
    let points = points(&ran, 14);
    let factor = (1.0 + (step / radius).powi(4) / 4.0).sqrt();
    for (period, [x, y]) in points[..points.len() - 1].iter().enumerate() {
        let wanted = radius * factor.powi(i32::try_from(period).unwrap());
        assert!((x.hypot(*y) - wanted).abs() < 1e-3, "period {period}: {} and {wanted}", x.hypot(*y));
    }
}

#[test]
fn nothing_is_lost_below_the_fraction_of_an_arc_by_the_step_factor() {
    for (start, fraction, step) in [([0, 1000], 8, 50_000), ([-700, 100], 10, 33_000), ([3, -90], 12, 7_000)] {
        let curve = arc(start, start, [0, 0], true);
        let choices = choices(System::StepFactor, fraction, step);
        let sampling = bench("sampled-arc", &curve, &choices).hardware().sampling.unwrap();
        let ran = run("sampled-arc", &curve, &choices, EngineKind::Compiled);
        let got: Vec<[i128; 2]> =
            column(&ran, "cx").into_iter().zip(column(&ran, "cy")).map(|(x, y)| [x.into(), y.into()]).collect();
        let periods = got.len() - 2;
        let word = (i128::from(step) << fraction) / 1000;
        let wanted = step_factor_points(start, word, fraction, sampling.whole + fraction, periods);
        assert!(
            periods > 50 && got[..=periods] == wanted[..],
            "{start:?}: {:?}",
            got.iter().zip(&wanted).find(|(a, b)| a != b)
        );
    }
}

/// Clocks of the rows of the step table, from the first period's end on.
fn ends(model: &str, curve: &Curve, choices: &Options) -> Vec<i64> {
    column(&run(model, curve, choices, EngineKind::Compiled), "clock")[1..].to_vec()
}

fn curves() -> [(&'static str, Curve); 2] {
    [("sampled-arc", arc([300, 0], [0, 300], [0, 0], false)), ("sampled-line", line(&[0, 0], &[300, 162]))]
}

#[test]
fn a_period_takes_t_at_the_clock_given_and_exactly_so_in_the_mean() {
    for (model, curve) in curves() {
        for (system, hz, period, of) in [
            // 8 ms of 1 MHz and of 250 kHz; 10.24 ms of 1 MHz; and clocks of which a period is not a whole number.
            (System::Direction, 1_000_000.0, 8000, 1),
            (System::Direction, 250_000.0, 2000, 1),
            (System::Direction, 100_090.0, 80_072, 100),
            (System::StepFactor, 1_000_000.0, 10_240, 1),
            (System::StepFactor, 100_001.0, 102_401_024, 100_000),
        ] {
            let choices = choices(system, 10, 8_000).at_clock(hz);
            let clocks = ends(model, &curve, &choices);
            assert!(clocks.len() > 20, "{model}");
            let [first, last] = [clocks[0], clocks[clocks.len() - 1]];
            let periods = clocks.len() as i64 - 1;
            // Each is a whole number of clocks, and none of the rest is lost.
            assert!(((last - first) * of - periods * period).abs() < of, "{model} {hz}: {clocks:?}");
            for pair in clocks.windows(2) {
                let clocks = pair[1] - pair[0];
                assert!(clocks == period / of || clocks == period / of + 1, "{model} {hz}: {clocks}");
            }
        }
    }
}

#[test]
fn the_pulses_of_a_period_are_spread_over_it() {
    // 8 BLU of a long axis in 8000 clocks: a pulse every 1000, to the distance of two additions of 16.
    let choices = choices(System::Direction, 10, 8_000).at_clock(1e6);
    let curve = line(&[0, 0], &[400, 0]);
    let bench = bench("sampled-line", &curve, &choices);
    let mut spacing = SpacingWatch::new(&bench, &curve);
    bench.run(EngineKind::Compiled, &mut [&mut spacing]).unwrap();
    let [least, most] = spacing.finish()[0].spacing.unwrap();
    assert!(least >= 999 && most <= 1001, "{least} to {most}");
}

#[test]
fn the_least_clock_just_leaves_the_coarse_calculation_its_time_and_a_slower_one_is_refused() {
    for (model, curve) in curves() {
        for (system, period) in [(System::Direction, 125.0), (System::StepFactor, 97.656_25)] {
            // Steps of 2 BLU are added in 2^2 additions, so that the calculation is what takes longest.
            let free = choices(system, 10, 2_000);
            let least = bench(model, &curve, &free).hardware().sampling.unwrap().clocks;
            assert_eq!(least[1], 1, "{model}");
            let clocks = ends(model, &curve, &free);
            let wanted = i64::try_from(least[0]).unwrap();
            assert!(clocks.windows(2).all(|pair| pair[1] - pair[0] == wanted), "{model} {system:?}: {clocks:?}");
            // A slower clock names the least in Hz, and with that it works.
            let hz = (least[0] as f64 * period).ceil();
            let at = |hz: f64| free.clone().at_clock(hz);
            let message = refusal(model, &curve, &at(hz - 1.0));
            assert!(message.contains(&format!("the coarse calculation takes {}", least[0])), "{message}");
            assert!(message.contains(&format!("give --clock-hz {hz} or more")), "{message}");
            let clocks = ends(model, &curve, &at(hz));
            assert!(clocks.windows(2).all(|pair| (wanted..=wanted + 1).contains(&(pair[1] - pair[0]))), "{model}");
        }
    }
    for hz in [0.0, 1.0, f64::NAN] {
        let choices = Options::default().at_clock(hz);
        assert!(refusal("sampled-line", &line(&[0, 0], &[9, 5]), &choices).contains("give --clock-hz"), "{hz}");
    }
}

#[test]
fn wide_integrators_want_a_clock_for_their_additions() {
    let choices = Options::at_1_mhz().with_all(&WIDTH, Width::new(14).unwrap());
    let message = refusal("sampled-line", &line(&[0, 0], &[9, 5]), &choices);
    // 2^14 additions, two clocks each, in 8 ms.
    assert!(
        message.contains("the additions of the fine stage take 32768: give --clock-hz 4096000 or more"),
        "{message}"
    );
}

#[test]
fn any_preset_draws_the_same_coarse_points() {
    for preset in [Preset::Half, Preset::Full, Preset::Value(5)] {
        for (system, _) in SYSTEMS {
            let choices = choices(system, 10, 8_000).with_all(&PRESET, preset);
            check_line([1, 2], [-77, 40], &choices, EngineKind::Compiled);
            check_arc([-65, 0], [63, 16], false, &choices, EngineKind::Compiled);
        }
    }
}

fn refusal(model: &str, curve: &Curve, choices: &Options) -> String {
    let refused: ModelError = find(model).unwrap().plan(curve, choices).unwrap_err();
    refused.to_string()
}

#[test]
fn steps_whose_chords_leave_the_arc_are_refused_with_the_greatest_that_do_not() {
    let curve = arc([10_000, 0], [0, 10_000], [0, 0], false);
    // f²/(8R) = 500²/80000 = 3.125; and sqrt(80000) = 282.84.
    let message = refusal("sampled-arc", &curve, &choices(System::Direction, 10, 500_000));
    assert!(message.contains("--step 500: its chords would be up to 3.125 BLU off"), "{message}");
    assert!(message.contains("give --step 282.842 or less"), "{message}");
    let plan = |choices: &Options| find("sampled-arc").unwrap().plan(&curve, choices);
    assert!(plan(&choices(System::Direction, 10, 282_842)).is_ok());
    let hardware = plan(&choices(System::Direction, 10, 500_000).with(&TOLERANCE, Some(Millionths(3_125_000))));
    assert_eq!(hardware.unwrap().sampling.unwrap().chord_error, 3.125);

    let small = refusal("sampled-arc", &arc([5, 0], [0, 5], [0, 0], false), &choices(System::StepFactor, 10, 2_600));
    assert!(small.contains("more than half the radius 5.000: give --step 2.5 or less"), "{small}");
}

#[test]
fn fractions_out_of_range_and_geometries_too_large_for_the_root_are_refused() {
    let curve = line(&[0, 0], &[1 << 24, 5]);
    for fraction in [0, 7, 31, u32::MAX] {
        let message = refusal("sampled-line", &curve, &choices(System::Direction, fraction, 8_000));
        assert!(message.contains("8 to 30 bits"), "{message}");
    }
    let message = refusal("sampled-line", &line(&[0, 0], &[1 << 20, 5]), &choices(System::Direction, 12, 8_000));
    assert!(message.contains("give --fraction 10 or less"), "{message}");
    let message = refusal("sampled-line", &curve, &choices(System::Direction, 8, 8_000));
    assert!(message.contains("give a smaller geometry"), "{message}");
    let tiny = choices(System::Direction, 8, 1).with(&STEP, Some(Millionths(100)));
    let message = refusal("sampled-line", &line(&[0, 0], &[9, 5]), &tiny);
    assert!(message.contains("give --step 0.003907 or more"), "{message}");
}
