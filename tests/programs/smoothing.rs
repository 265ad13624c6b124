//! Acceleration after the interpolator of machines: every pulse against a recurrence in plain integers.

use std::fmt::Write as _;

use proptest::prelude::*;
use stepwave::Simulation;
use stepwave::report::Report;
use stepwave::testbench::{Ending, Trace};
use stepwave_engine::EngineKind;
use stepwave_models::events::Timed;
use stepwave_models::{AXES, Options, find};

use super::command::FAMILIES;
use crate::reference::{Filter, smoothed};

fn simulation(folder: &tempfile::TempDir, family: &str, text: &str, options: &[&str]) -> Simulation {
    let file = folder.path().join("p.ngc");
    std::fs::write(&file, text).unwrap();
    let options = Options::parse(options.iter().copied()).unwrap();
    let machine = find(&format!("{family}-machine")).unwrap();
    Simulation::program(machine, file).options(options).clock_hz(20_000.0).blu_mm(0.01)
}

/// A machine with this filter and period.
fn filtered(
    folder: &tempfile::TempDir,
    family: &str,
    text: &str,
    (filter, period): (Filter, usize),
    engine: EngineKind,
) -> (Report, Trace) {
    operated(folder, family, text, ((filter, period), engine), &[])
}

/// The same with an operator.
pub(super) fn operated(
    folder: &tempfile::TempDir,
    family: &str,
    text: &str,
    ((filter, period), engine): ((Filter, usize), EngineKind),
    events: &[&str],
) -> (Report, Trace) {
    let events: Vec<Timed> = events.iter().map(|event| Timed::parse(event).unwrap()).collect();
    let filter = match filter {
        Filter::Sum(k) => format!("sum={k}"),
        Filter::Exponential(s) => format!("exp={s}"),
    };
    let options = ["--ramp", "after", "--smooth", &filter, "--period", &period.to_string()];
    simulation(folder, family, text, &options).engine(engine).events(events).run_traced().unwrap()
}

/// Bits of a fine line: it has more additions than an axis has pulses.
fn bits(period: usize) -> u32 {
    usize::BITS - period.div_ceil(2).leading_zeros()
}

/// Every pulse that goes out is that of the recurrence, and all of them do.
pub(super) fn check(report: &Report, trace: &Trace, (filter, period): (Filter, usize), what: &str) {
    assert_eq!(report.outcome.ending, Ending::Done, "{what}");
    assert!(report.failures().is_empty(), "{what}: {:?}", report.failures());
    for letter in &AXES[..report.hardware.axes] {
        let [given, sent] = ["", "_out"].map(|end| trace.i64(&format!("d{letter}{end}")).unwrap());
        let wanted = smoothed(filter, period, bits(period), &given);
        let first = sent.iter().zip(&wanted).position(|(sent, wanted)| sent != wanted);
        assert_eq!(first, None, "{what}: {letter}, {} samples", sent.len());
        let [reached, out] = ["", "_out"].map(|end| *trace.i64(&format!("{letter}{end}")).unwrap().last().unwrap());
        let totals = [given, sent].map(|pulses| pulses.iter().sum::<i64>());
        assert_eq!((totals, out), ([reached; 2], reached), "{what}: {letter}");
    }
}

const PROGRAM: &str = "G21 G90 G64 F600\nG1 X0.5\nG1 Y0.4\nG61\nG1 X0 Y0\nG64\nG2 X0 Y0 I0.3 J0\nG4 P0.01\n\
                       G1 X0.2 Y-0.1 Z0.05 A0.013 U0.1\nG3 X-0.2 Y-0.1 I-0.2 J0 F3000\nG1 X0 Y0 Z0 W0.02 A0\nM2\n";

/// Of few clocks, for the gates.
const SHORT: &str = "G21 G90 G64 F3000\nG1 X0.2 Y-0.05\nG2 X-0.1 Y-0.05 I-0.15\nM0\nG1 Z0.03 X0\nM2\n";

#[test]
fn every_family_and_engine_sends_what_the_recurrence_does() {
    let folder = tempfile::tempdir().unwrap();
    let filters = [(Filter::Sum(4), 40), (Filter::Exponential(2), 33), (Filter::Sum(7), 128)];
    for (index, family) in FAMILIES.iter().enumerate() {
        for of in filters {
            for engine in [EngineKind::Word, EngineKind::Compiled] {
                let (report, trace) = filtered(&folder, family, PROGRAM, of, engine);
                check(&report, &trace, of, &format!("{family} {of:?} {engine:?}"));
            }
        }
        let of = [(Filter::Sum(4), 20), (Filter::Exponential(2), 16)][index % 2];
        let (report, trace) = filtered(&folder, family, SHORT, of, EngineKind::Gates);
        check(&report, &trace, of, &format!("{family} {of:?} gates"));
    }
}

/// After G61, a dwell, a stop and at the end all of a block is out before anything else is done; after G64 nothing waits.
#[test]
fn exact_stops_wait_for_the_filter() {
    let folder = tempfile::tempdir().unwrap();
    let clocks = |between: &str| {
        let text = format!("G21 G91 G1 X0.5 F600\n{between}\nG1 Y0.5\nM2\n");
        let (report, trace) = filtered(&folder, "bresenham", &text, (Filter::Sum(4), 40), EngineKind::Word);
        check(&report, &trace, (Filter::Sum(4), 40), between);
        let [x, y] = ["dx", "dy"].map(|name| trace.i64(name).unwrap());
        let [out_x, out_y] = ["dx_out", "dy_out"].map(|name| trace.i64(name).unwrap());
        let last = |pulses: &[i64]| pulses.iter().rposition(|pulse| *pulse != 0).unwrap();
        let first = |pulses: &[i64]| pulses.iter().position(|pulse| *pulse != 0).unwrap();
        assert!(trace.len() > last(&out_y), "the run ends after its last pulse");
        (first(&y) - last(&x), first(&y) > last(&out_x))
    };
    let (apart, empty) = clocks("G64");
    assert!(apart <= 21 && !empty, "{apart}");
    let (apart, empty) = clocks("(none)");
    assert!(apart <= 21 && !empty, "{apart}");
    for stop in ["M0", "M1", "G4 P0"] {
        let (apart, empty) = clocks(stop);
        assert!(empty && (160..=300).contains(&apart), "{stop}: {apart}");
    }
    // A block with G61 is the first that waits, after one that had it.
    let text = "G21 G91 G61 G1 X0.5 F600\nG1 Y0.5\nG64 G1 X0.5\nY0.5\nM2\n";
    let (report, trace) = filtered(&folder, "bresenham", text, (Filter::Sum(4), 40), EngineKind::Word);
    check(&report, &trace, (Filter::Sum(4), 40), "G61");
    let moving = |name: &str| trace.i64(name).unwrap().iter().map(|pulse| *pulse != 0).collect::<Vec<_>>();
    let [x, y, out_x, out_y] = ["dx", "dy", "dx_out", "dy_out"].map(moving);
    let [first_y, last_y] = [y.iter().position(|is| *is).unwrap(), y.iter().rposition(|is| *is).unwrap()];
    // The second X begins when the first Y has come out, the second Y at once.
    let second_x = (first_y..x.len()).find(|&clock| x[clock]).unwrap();
    let before = |out: &[bool], clock: usize| out[..clock].iter().rposition(|is| *is).unwrap();
    assert!(before(&out_x, second_x) < first_y, "G61 waits for X");
    assert!(out_y[..second_x].iter().filter(|is| **is).count() == 50, "G61 waits for Y");
    let second_y = (second_x..y.len()).find(|&clock| y[clock]).unwrap();
    assert!(last_y > second_y && out_x[second_y..].iter().any(|is| *is), "G64 waits for nothing");
}

/// G64 P: a corner that would be passed farther off is passed with a stop.
#[test]
fn the_tolerance_of_g64_decides_where_the_machine_stops() {
    let folder = tempfile::tempdir().unwrap();
    // Two pulses a period of 40 clocks: a square corner of sum=16 is passed at 16·2·sqrt(2)/8 = 5.66 BLU.
    for (limit, stops) in [("0.05", true), ("0.056", true), ("0.058", false), ("1", false)] {
        let text = format!("G21 G91 G64 P{limit} G1 X0.5 F600\nG1 Y0.5\nM2\n");
        let of = (Filter::Sum(16), 40);
        let (report, trace) = filtered(&folder, "bresenham", &text, of, EngineKind::Word);
        check(&report, &trace, of, limit);
        let [y, out_x] = ["dy", "dx_out"].map(|name| trace.i64(name).unwrap());
        let first = y.iter().position(|pulse| *pulse != 0).unwrap();
        let stopped = out_x[first..].iter().all(|pulse| *pulse == 0);
        assert_eq!(stopped, stops, "P{limit}");
    }
}

fn json(folder: &tempfile::TempDir, family: &str, text: &str, options: &[&str]) -> serde_json::Value {
    let file = folder.path().join("r.json");
    let simulation = simulation(folder, family, text, options).clock_hz(200_000.0).json(&file);
    let report = simulation.run().unwrap();
    assert!(report.failures().is_empty(), "{:?}", report.failures());
    serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap()
}

/// F3000 at 0.01 mm is 5000 BLU/s, 10 BLU in a period of 400 clocks at 200 kHz.
const CIRCLES: &str = "G21 G90 G64 F3000\nG1 X1\nG2 X1 Y0 I5 J0\nG3 X1 Y0 I5 J0\nG1 X0\nM2\n";

/// Full circles of R = 500 lose (k²-1)·f²/(24·R) = 2.125 BLU of a moving sum of 16, (4^s-2^s)·f²/(2·R) = 5.6 of an exponential of
/// 8: measured where the interpolator is even.
#[test]
fn circles_lose_the_radius_of_the_formula() {
    let folder = tempfile::tempdir().unwrap();
    let filters = [("sum=16", 255.0 * 100.0 / (24.0 * 500.0)), ("exp=3", (64.0 - 8.0) * 100.0 / (2.0 * 500.0))];
    for (family, (smooth, wanted)) in
        ["dda", "stepgen", "bresenham"].into_iter().flat_map(|family| filters.map(|filter| (family, filter)))
    {
        let options = ["--ramp", "after", "--period", "400", "--smooth", smooth];
        let after = json(&folder, family, CIRCLES, &options)["after"].take();
        let arcs = after["radius_loss"]["arcs"].as_array().unwrap().clone();
        assert_eq!(arcs.len(), 2);
        for arc in arcs.iter().chain([&after["radius_loss"]["worst"]]) {
            let [expected, measured] = ["expected", "measured"].map(|name| arc[name].as_f64().unwrap());
            assert!((expected - wanted).abs() < 0.02 * wanted, "{family} {smooth}: {expected}, not {wanted}");
            assert!((measured - wanted).abs() < 0.04 * wanted, "{family} {smooth}: measured {measured}, not {wanted}");
        }
    }
}

/// With f BLU a period before and after a square corner a moving sum of k passes it at f·k/8 from both legs.
#[test]
fn the_radius_lost_is_the_same_by_every_engine_and_up_to_the_end_of_the_arc() {
    let folder = tempfile::tempdir().unwrap();
    let text = "G21 G90 G64 P0.2\nG1 F600\nG64 P0.05\nG1 Y-0.15 X-0.50\nG2 X-0.97 Y0.38 I-0.50 J0.03\nG64 P0.01\nG2 X-0.19 Y0.58 I0.49 J-0.29\nM2\n";
    let measured = |engine: EngineKind| {
        let options = ["--normalize", "--ramp", "after", "--smooth", "sum=16", "--period", "333"];
        let file = folder.path().join("r.json");
        let simulation = simulation(&folder, "dda", text, &options).clock_hz(50_000.0).engine(engine);
        simulation.rapid(600.0).json(&file).run().unwrap();
        let json: serde_json::Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
        let arcs = json["after"]["radius_loss"]["arcs"].as_array().unwrap().clone();
        arcs.iter().map(|arc| arc["measured"].as_f64()).collect::<Vec<_>>()
    };
    let all: Vec<_> = [EngineKind::Compiled, EngineKind::Word, EngineKind::Gates].map(measured).to_vec();
    assert!(all.windows(2).all(|pair| pair[0] == pair[1]), "{all:?}");
    // By the wave, at the ends of periods from 17 of them after the beginning of the arc to its end.
    assert!((all[0][0].unwrap() - 8.417_751_926).abs() < 1e-6 && all[0][1].is_none(), "{all:?}");
}

#[test]
fn the_output_is_as_far_off_a_corner_as_the_integral_says() {
    let folder = tempfile::tempdir().unwrap();
    let text = "G21 G90 G64 F3000\nG1 X5\nG1 Y5\nM2\n";
    for (smooth, wanted) in [("sum=16", 20.0), ("sum=8", 10.0), ("sum=1", 1.25)] {
        let options = ["--ramp", "after", "--period", "400", "--smooth", smooth];
        let off = json(&folder, "bresenham", text, &options)["after"]["contour_error"].take();
        let distance = off["blu"].as_f64().unwrap();
        assert!((distance - wanted).abs() <= 1.0, "{smooth}: {distance}, not {wanted}");
        let place = off["place"].as_array().unwrap();
        let [x, y] = [0, 1].map(|axis| place[axis].as_f64().unwrap());
        assert!((500.0 - x - wanted).abs() <= 2.0 && (y - wanted).abs() <= 2.0, "{smooth}: ({x}, {y})");
    }
    // With stops it stays as near as the interpolator is.
    let text = text.replace("G64", "G61");
    let options = ["--ramp", "after", "--period", "400", "--smooth", "sum=16"];
    let off = json(&folder, "bresenham", &text, &options)["after"]["contour_error"]["blu"].as_f64().unwrap();
    assert!(off <= 1.0, "{off}");
}

/// A run along a curve ends when all has come out too.
#[test]
fn a_curve_alone_comes_out_whole() {
    let folder = crate::cli::Folder::new();
    for model in ["ppc-machine", "dda-machine", "stepgen-machine"] {
        let options = "--from 20,-3 --to 60,27 --ramp after --smooth exp=3 --period 24";
        let ran = folder.run(&format!("run {model} {options} --vcd w.vcd --no-clk"));
        assert_eq!(ran.code, 0, "{model}: {ran:?}");
        let wave = folder.read("w.vcd");
        let last = |name: &str| {
            let code = wave.lines().find(|line| line.ends_with(&format!(" {name} $end"))).unwrap();
            let code = code.split(' ').nth(3).unwrap();
            wave.lines().rev().find_map(|line| line.strip_suffix(&format!(" {code}"))).unwrap().to_owned()
        };
        for axis in ["x", "y"] {
            assert_eq!(last(&format!("{axis}_out")), last(axis), "{model}");
        }
    }
}

#[test]
fn the_picture_draws_the_output_where_it_is_off_the_contour() {
    let folder = crate::cli::Folder::new();
    folder.write("p.ngc", CIRCLES);
    let drawn = |options: &str| {
        folder.good(&format!("program p.ngc --method dda --blu 0.01mm --clock-hz 2e5 --plot p.svg {options}"));
        let svg = folder.read("p.svg");
        let paths: Vec<String> = svg.lines().filter(|line| line.contains("#d55e00")).map(str::to_owned).collect();
        (paths, svg)
    };
    let (paths, svg) = drawn("--ramp after --smooth sum=64 --period 400");
    assert!(
        svg.contains(">output, where it is off the contour<") && svg.contains("output's speed along the axes"),
        "{svg}"
    );
    // The legend, and at least the circle.
    assert!(paths.len() >= 2 && paths.iter().any(|path| path.len() > 5000), "{paths:?}");
    // Every corner is an exact stop: nothing is off but what a circle loses.
    folder.write("p.ngc", "G21 G90 G61 F3000\nG1 X1\nG1 Y1\nM2\n");
    assert_eq!(drawn("--ramp after --smooth sum=64 --period 400").0.len(), 1);
    let (paths, svg) = drawn("");
    assert!(paths.is_empty() && svg.contains("; speed along the axes of F over 32 steps<"), "{svg}");
}

/// The speed of moves of A, B, C or U, V, W alone is along these.
#[test]
fn the_picture_shows_the_speed_along_the_axes_of_f() {
    let folder = crate::cli::Folder::new();
    let drawn = |moves: &str| {
        folder.write("p.ngc", &format!("G21 G90 {moves}\nM2\n"));
        folder.good("program p.ngc --method ppc --blu 0.01mm --blu-rotary 0.01deg --clock-hz 1e5 --plot p.svg");
        let svg = folder.read("p.svg");
        let panel = svg.split("(BLU)</text>").last().unwrap().to_owned();
        // The ticks of the speed are at the end of their texts.
        let ticks = panel.lines().filter(|line| line.contains("text-anchor=\"end\""));
        let greatest = ticks.filter_map(|line| line.split(['>', '<']).nth(2)?.parse::<f64>().ok()).fold(0.0, f64::max);
        (panel, greatest)
    };
    for (moves, unit, tick) in [
        ("G1 A90 F600", "degrees/min", 600.0),
        ("G1 U5 F300", "mm/min", 300.0),
        ("G1 X5 F300\nA20 F600", "mm/min or degrees/min", 600.0),
        ("G1 X5 A20 F300", "mm/min", 300.0),
    ] {
        let (panel, greatest) = drawn(moves);
        assert!(panel.contains(&format!(">{unit}<")), "{moves}: {panel}");
        assert_eq!(greatest, tick, "{moves}: {panel}");
    }
}

#[derive(Clone, Debug)]
struct Leg {
    by: [i64; 3],
    feed: u32,
    word: u8,
}

/// With `curves` some are free, which the machine has to take whole: chords may each wait for a filter.
fn text(legs: &[Leg], curves: bool) -> String {
    let mut text = "G21 G91 G64\n".to_owned();
    for Leg { by, feed, word } in legs {
        let [x, y, a] = by.map(|travel| travel as f64 / 100.0);
        let before = ["", "G61\n", "G64\n", "G64 P0.03\n", "G4 P0.002\n", "M0\n"][usize::from(*word)];
        let curve = match word {
            2 if by[0] != 0 => format!("G2 X{x:.2} Y0 I{:.3} J0", x / 2.0),
            3 if curves => format!("G5 X{x:.2} Y{y:.2} I{y:.2} J0.1 P{:.3} Q-0.05", -x / 2.0),
            _ => format!("G1 X{x:.2} Y{y:.2} A{:.3}", a / 10.0),
        };
        writeln!(text, "{before}{curve} F{feed}").unwrap();
    }
    text
}

fn legs() -> impl Strategy<Value = Vec<Leg>> {
    let by = [-60..60i64, -60..60i64, -60..60i64];
    let leg = (by, 1500..6000u32, 0..6u8).prop_map(|(by, feed, word)| Leg { by, feed, word });
    prop::collection::vec(leg.prop_filter("it moves", |leg| leg.by[0] != 0), 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(12) })]

    #[test]
    fn random_programs_send_what_the_recurrence_does(
        legs in legs(),
        of in prop_oneof![(1..=64i64).prop_map(Filter::Sum), (1..=5u32).prop_map(Filter::Exponential)],
        period in 2..300usize,
        family in 0..FAMILIES.len(),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let family = FAMILIES[family];
        // A filter is soon empty, and a period has a fine line.
        let long = if let Filter::Sum(k) = of { usize::try_from(k).unwrap() } else { 60 };
        let period = period.min(3000 / long);
        let period = period + usize::from((period + 1).is_power_of_two());
        let mut clocks = u64::MAX;
        for engine in [EngineKind::Word, EngineKind::Compiled, EngineKind::Gates] {
            // Gates take their time.
            if engine == EngineKind::Gates && clocks > 1500 {
                break;
            }
            let (report, trace) = filtered(&folder, family, &text(&legs, family == "dda"), (of, period), engine);
            check(&report, &trace, (of, period), &format!("{family} {of:?} {period} {engine:?}\n{}", text(&legs, family == "dda")));
            clocks = report.outcome.clocks;
        }
    }
}

/// Clocks of the pulses of a signal.
pub(super) fn clocks_of(trace: &Trace, name: &str) -> Vec<usize> {
    let pulses = trace.i64(name).unwrap();
    (0..pulses.len()).filter(|&clock| pulses[clock] != 0).collect()
}

/// In a hold the interpolator rests from the second edge after the event on and the filter runs empty; an override changes the
/// distances of its pulses by its share.
#[test]
fn a_hold_and_an_override_act_in_front_of_the_filter() {
    let folder = tempfile::tempdir().unwrap();
    let of = (Filter::Sum(4), 40);
    // A pulse every 20 clocks.
    let text = "G21 G91 G1 X1 F600\nM2\n";
    for family in FAMILIES.iter().filter(|family| **family != "stepgen") {
        let run = |events: &[&str]| {
            let (report, trace) = operated(&folder, family, text, (of, EngineKind::Compiled), events);
            check(&report, &trace, of, &format!("{family} {events:?}"));
            (report.outcome.clocks, clocks_of(&trace, "dx"), clocks_of(&trace, "dx_out"))
        };
        let (clocks, plain, _) = run(&[]);
        // 60 periods, so that what comes after them is what came without them.
        let (held, pulses, out) = run(&["500:hold", "2900:resume"]);
        let shifted: Vec<usize> = plain.iter().map(|&clock| if clock > 501 { clock + 2400 } else { clock }).collect();
        assert_eq!((held, pulses), (clocks + 2400, shifted), "{family}");
        let rests = out.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
        assert!((2400 - 6 * 40..=2400 + 40).contains(&rests), "{family}: {rests}");
        for (event, apart) in [("0:override=50", 40.0), ("0:override=100", 20.0), ("0:override=200", 10.0)] {
            let (_, pulses, _) = run(&[event]);
            let steps = (pulses[pulses.len() - 1] - pulses[0]) as f64 / (pulses.len() - 1) as f64;
            assert!((steps - apart).abs() < 0.6, "{family} {event}: {steps}");
        }
        let (_, pulses, _) = run(&["500:override=0", "2900:override=100"]);
        assert_eq!(pulses.iter().filter(|clock| (502..=2901).contains(*clock)).count(), 0, "{family}");
    }
    let (report, _) = operated(&folder, "ppc", text, (of, EngineKind::Compiled), &["500:hold"]);
    assert!(matches!(report.outcome.ending, Ending::Stalled { .. }), "{:?}", report.outcome.ending);
}

/// With `single` every block waits for `start`, and begins when all of the block before has come out.
#[test]
fn single_blocks_wait_for_the_start_and_for_the_filter() {
    let folder = tempfile::tempdir().unwrap();
    let of = (Filter::Sum(4), 40);
    let text = "G21 G91 G64 G1 X0.5 F600\nG1 Y0.5\nG1 X0.5\nM2\n";
    for family in FAMILIES {
        let run = |events: &[&str]| {
            let (report, trace) = operated(&folder, family, text, (of, EngineKind::Compiled), events);
            check(&report, &trace, of, &format!("{family} {events:?}"));
            ["dx", "dy", "dx_out", "dy_out"].map(|name| clocks_of(&trace, name))
        };
        let [x, y, out_x, _] = run(&["0:single", "2000:start", "5000:start", "8000:continuous"]);
        assert!(x[0] > 2000 && x[49] < 5000 && y[0] > 5000 && y[49] < 8000 && x[50] > 8000, "{family}");
        assert!(out_x[49] < 5000, "{family}");
        // A start before the filter is empty is not lost, and the block waits for the filter.
        let early = format!("{}:start", x[49] + 40);
        let [x, y, out_x, _] = run(&["0:single", "2000:start", &early, "8000:continuous"]);
        assert!(x[0] > 2000 && out_x[49] > x[49] + 40 && out_x[49] < y[0] && y[0] < x[49] + 400, "{family}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(16) })]

    /// Whatever the operator does at any clock, every pulse comes out.
    #[test]
    fn events_lose_no_pulse_of_a_filter(
        legs in legs(),
        of in prop_oneof![(1..=32i64).prop_map(Filter::Sum), (1..=4u32).prop_map(Filter::Exponential)],
        events in prop::collection::vec((0..4000u64, 0..6u8, 0..=200u32), 0..8),
        period in 20..90usize,
        family in 0..FAMILIES.len(),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let family = FAMILIES[family];
        let period = period + usize::from((period + 1).is_power_of_two());
        let words = ["hold", "resume", "single", "start", "continuous"].map(str::to_owned);
        let word = |kind: u8, percent: u32| words.get(usize::from(kind)).cloned().unwrap_or(format!("override={percent}"));
        let events = events.into_iter().map(|(clock, kind, percent)| format!("{clock}:{}", word(kind, percent)));
        let last = ["resume", "continuous", "override=100"].map(|word| format!("4001:{word}"));
        let events: Vec<String> = events.chain(last).collect();
        let events: Vec<&str> = events.iter().map(String::as_str).collect();
        let mut before = None;
        for engine in [EngineKind::Word, EngineKind::Compiled] {
            let (report, trace) = operated(&folder, family, &text(&legs, family == "dda"), ((of, period), engine), &events);
            check(&report, &trace, (of, period), &format!("{family} {of:?} {period} {events:?}\n{}", text(&legs, family == "dda")));
            let wanted: i64 = legs.iter().map(|leg| leg.by[0]).sum();
            prop_assert_eq!(report.outcome.reached[0], wanted);
            let clocks = report.outcome.clocks;
            prop_assert_eq!(*before.get_or_insert(clocks), clocks);
        }
    }
}

#[test]
fn options_that_would_do_nothing_are_refused() {
    let folder = crate::cli::Folder::new();
    folder.write("p.ngc", "G21 G1 X1 F100\nM2\n");
    let refused = |options: &str, said: &str| {
        for command in ["program p.ngc --method ppc", "run ppc-machine --to 8,6"] {
            let ran = folder.run(&format!("{command} {options}"));
            assert_eq!(ran.code, 2, "{command} {options}: {ran:?}");
            assert!(ran.err.contains(said), "{command} {options}: {}", ran.err);
        }
    };
    refused("--smooth sum=4", "--ramp after");
    refused("--ramp before --period 100", "--ramp after");
    refused("--ramp after --accel 500mm/s2", "leave this out, or leave out --ramp after");
    refused("--ramp after --jerk 500mm/s3", "leave this out, or leave out --ramp after");
    refused(
        "--ramp after --period 127",
        "64 pulses in as many clocks, whose fine line takes 128 additions: give 128 or 126",
    );
    refused("--ramp after --period 1", "2");
    let ran = folder.run("program p.ngc --method ppc --ramp after --jump 100");
    assert_eq!(ran.code, 2, "{ran:?}");
    let ran = folder.run("run ppc-line --to 8,6 --ramp after");
    assert_eq!((ran.code, ran.err.contains("does not take")), (2, true), "{ran:?}");
}
