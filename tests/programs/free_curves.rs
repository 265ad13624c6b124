//! G5 and G5.1 by the cascaded integrators of the `dda` machine, register by register, step by step.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use proptest::prelude::*;
use stepwave::Simulation;
use stepwave::program::Preparation;
use stepwave_engine::EngineKind;
use stepwave_models::{Options, find};
use stepwave_nc::Integers;

use super::command::{number, report};
use super::smoothing::{check as check_filter, clocks_of, operated};
use crate::cli::Folder;
use crate::reference::{Basis, Filter, spline_dda};

/// Three or four control points, relative to the first.
type Points = Vec<[i64; 2]>;

/// A program of curves one after another, each in a line of its own.
fn text(curves: &[Points]) -> String {
    let mut text = String::from("G91 G21 F60000\n");
    for points in curves {
        let [end_x, end_y] = points[points.len() - 1];
        let [x, y] = points[1];
        match points[..] {
            [_, _, _] => writeln!(text, "G5.1 X{end_x} Y{end_y} I{x} J{y}").unwrap(),
            [_, _, [p, q], _] => {
                writeln!(text, "G5 X{end_x} Y{end_y} I{x} J{y} P{} Q{}", p - end_x, q - end_y).unwrap();
            }
            _ => unreachable!(),
        }
    }
    text
}

/// The step table of a program in pulses by the machine of `dda`, row by row: column and value.
fn table(text: &str, options: &[&str], engine: EngineKind) -> String {
    let folder = tempfile::tempdir().unwrap();
    let [program, steps] = ["p.ngc", "s.csv"].map(|name| folder.path().join(name));
    std::fs::write(&program, text).unwrap();
    let mut preparation = Preparation::default();
    preparation.reading.integers = Integers::Pulses;
    let simulation = Simulation::program(find("dda-machine").unwrap(), program).preparation(preparation);
    let simulation = simulation.options(Options::parse(options.iter().copied()).unwrap()).engine(engine);
    let report = simulation.steps(&steps).run().unwrap();
    assert!(report.failures().is_empty(), "{:?}", report.failures());
    std::fs::read_to_string(steps).unwrap()
}

/// The names of the columns, of which the first is `block`, and the rows of each block by its line.
fn blocks(table: &str) -> (Vec<&str>, BTreeMap<i64, Vec<Vec<i64>>>) {
    let mut lines = table.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut blocks: BTreeMap<i64, Vec<_>> = BTreeMap::new();
    for line in lines {
        let row: Vec<i64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        blocks.entry(row[0]).or_default().push(row);
    }
    (columns, blocks)
}

/// The greatest speed of an axis on its curve in BLU for u from 0 to 1, at 4097 places, times 4096².
fn fastest(points: &Points) -> i128 {
    let degree = points.len() - 1;
    let speed = |axis: usize, i: i128| -> i128 {
        let d: Vec<i128> =
            points.windows(2).map(|pair| i128::from(pair[1][axis] - pair[0][axis]) * degree as i128).collect();
        let (u, v) = (i, 4096 - i);
        match d[..] {
            [a, b] => (a * v + b * u) * 4096,
            [a, b, c] => a * v * v + 2 * b * u * v + c * u * u,
            _ => unreachable!(),
        }
    };
    (0..=4096).flat_map(|i| [speed(0, i).abs(), speed(1, i).abs()]).max().unwrap()
}

/// Every row of every curve is that of the recurrence, in units of the longest curve's steps.
fn check(curves: &[Points], table: &str) {
    let (columns, blocks) = blocks(table);
    assert_eq!(blocks.len(), curves.len());
    let divisions: Vec<u32> = blocks.values().map(|rows| (rows.len() - 1).ilog2()).collect();
    let finest = *divisions.iter().max().unwrap();
    let mut at = [0, 0];
    for ((points, (line, rows)), s) in curves.iter().zip(&blocks).zip(divisions) {
        let what = format!("line {line}, {points:?}");
        assert_eq!(rows.len(), (1 << s) + 1, "{what}");
        // No axis is faster than a pulse a step, with half the steps one would be.
        let (most, one) = (fastest(points), 4096 * 4096);
        assert!(most <= one << s, "{what}");
        assert!(s == 1 || most + most / 1000 > one << (s - 1), "{what}");
        let column = |name: &str| -> Vec<i64> {
            let index = columns.iter().position(|column| *column == name).unwrap();
            rows.iter().map(|row| row[index]).collect()
        };
        let absolute = points.iter().map(|[x, y]| [at[0] + x, at[1] + y]).collect();
        let wanted = spline_dda(&[(Basis::Bezier, absolute)], s);
        for name in ["x", "y", "e", "px", "py", "qx", "qy", "rx", "ry", "jrx", "jry"] {
            let wanted = wanted.column(name);
            // One pulse is 2^3S of the longest curve.
            let shift = if name.len() == 1 { 0 } else { 3 * (finest - s) };
            let wanted: Vec<i64> = wanted.iter().map(|value| value << shift).collect();
            assert_eq!(column(&name.replace("jr", "jc")), wanted, "{what}: {name}");
        }
        for axis in ["x", "y"] {
            let (place, pulses) = (column(axis), column(&format!("d{axis}")));
            let moved: Vec<i64> = place.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert_eq!(pulses[1..], moved, "{what}: {axis}");
        }
        for (name, value) in [("mode", 3), ("plane", 0), ("ex", 0), ("ey", 0), ("z", 0)] {
            assert!(column(name).iter().all(|held| *held == value), "{what}: {name}");
        }
        let [dx, dy] = points[points.len() - 1];
        at = [at[0] + dx, at[1] + dy];
        // At its end each axis is half a BLU from the next pulse again.
        let last = ["x", "y", "jcx", "jcy"].map(|name| column(name)[rows.len() - 1]);
        let half = 1 << (3 * finest - 1);
        assert_eq!(last, [at[0], at[1], half, half], "{what}");
    }
}

/// Not a single point, and, as G5.1 wants, with a control point apart from the start of a quadratic one.
fn is_curve(points: &Points) -> bool {
    points.iter().any(|point| *point != points[0]) && (points.len() == 4 || points[1] != points[0])
}

#[test]
fn every_small_curve_is_that_of_the_recurrence_step_by_step() {
    let sides = || -4..=4_i64;
    let cubic = |[a, b, c]: [i64; 3]| {
        // Another curve in y, no simple image of that in x.
        vec![[0, 0], [a, 3 - c], [b, a + 1], [c, a * b % 6]]
    };
    let cubics = sides().flat_map(|a| sides().flat_map(move |b| sides().map(move |c| cubic([a, b, c]))));
    let square = || sides().flat_map(|x| sides().map(move |y| [x, y]));
    let quadratics = square().flat_map(|first| square().step_by(3).map(move |end| vec![[0, 0], first, end]));
    let curves: Vec<Points> = cubics.chain(quadratics).filter(is_curve).collect();
    assert!(curves.len() > 2500, "{}", curves.len());
    check(&curves, &table(&text(&curves), &[], EngineKind::Compiled));
}

fn coordinate() -> impl Strategy<Value = i64> {
    prop_oneof![-8..=8_i64, -60..=60_i64]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(12) })]

    /// Curves of very different lengths in one program, on every engine.
    #[test]
    fn curves_of_any_size_follow_each_other_on_every_engine(
        curves in prop::collection::vec(prop::collection::vec([coordinate(), coordinate()], 2..=3), 1..24),
        normalize: bool,
    ) {
        let start = |points: &Points| [vec![[0, 0]], points.clone()].concat();
        let curves: Vec<Points> = curves.iter().map(start).filter(is_curve).collect();
        prop_assume!(!curves.is_empty());
        let options: &[&str] = if normalize { &["--normalize"] } else { &[] };
        let tables = EngineKind::ALL.map(|engine| table(&text(&curves), options, engine));
        prop_assert!(tables.iter().all(|table| *table == tables[0]));
        check(&curves, &tables[0]);
    }
}

/// A line, an arc in another plane, curves and a dwell: what one kind leaves in the registers does not reach another.
const MIXED: &str = "G21 G90 G17 F600\nG1 X0.3 Y-0.1\nG5 X0.9 Y0.6 I0.4 J0 P0 Q-0.4\nG1 Z0.2 X0.8\nG5.1 X0.1 Y0.4 I-0.3 J0.5\n\
                     G18 G2 X0.3 Z0 R0.3\nG4 P0.01\nG17 G5 X0 Y0 I-0.2 J0.1 P0.4 Q-0.3\nG0 X-0.1\nG5 X-0.1 Y0 I1 J0.4 P1 Q-0.4\nM2\n";

#[test]
fn curves_lines_and_arcs_share_a_machine() {
    for normalize in ["", "--normalize"] {
        let folder = Folder::new();
        let options = format!("--method dda {normalize} --blu 0.01mm --clock-hz 1e5");
        let report = report(&folder, MIXED, &options);
        let kinds = report["blocks"].as_array().unwrap().iter().map(|block| block["kind"].as_str().unwrap());
        assert_eq!(kinds.collect::<Vec<_>>(), ["line", "curve", "line", "curve", "arc", "curve", "rapid", "curve"]);
        for block in report["blocks"].as_array().unwrap().iter().filter(|block| block["kind"] == "curve") {
            let [commanded, reached] =
                ["commanded", "reached"].map(|which| number(&block["feed"][format!("{which}_mm_per_min").as_str()]));
            assert!((reached / commanded - 1.0).abs() < 0.02, "{block}");
            assert!(number(&block["path_error"]["greatest"]) <= 0.5_f64.sqrt(), "{block}");
        }
        assert_eq!((&report["missed_end_points"], &report["beyond_bound"]), (&0.into(), &0.into()));
        assert_eq!(report["reached"], serde_json::json!([-10, 0, 0]));
    }
}

/// G93 is the time of a curve, and F along it the mean of a speed that changes as the parameter runs evenly.
#[test]
fn a_curve_takes_the_time_of_its_feed() {
    // A line whose speed grows from 0.5 to 1.5 of its mean: X(u) = 500·u + 500·u².
    let line = "G5.1 X10 Y0 I2.5 J0";
    let of = |feed: &str| {
        let folder = Folder::new();
        let report = report(&folder, &format!("G21 {feed} {line}\nM2\n"), "--method dda --blu 0.01mm --clock-hz 1e6");
        report["blocks"][0].clone()
    };
    for (feed, seconds) in [("F600", 1.0), ("F6000", 0.1), ("G93 F30", 2.0)] {
        let block = of(feed);
        assert!((number(&block["seconds"]) / seconds - 1.0).abs() < 1e-3, "{feed}: {block}");
        assert_eq!((&block["kind"], &block["steps"]), (&"curve".into(), &2048.into()), "{feed}");
        // Of v_max, which is a BLU in each of the 2048 steps.
        let [least, greatest] = ["least", "greatest"].map(|which| number(&block["feed"][which]["value"]) * 2.048);
        assert!((least - 0.5).abs() < 0.07 && (greatest - 1.5).abs() < 0.07, "{feed}: {least}, {greatest}");
    }
}

/// What goes out after a filter is the recurrence of the pulses, whatever the operator does within a curve.
#[test]
fn curves_can_be_held_and_started_one_by_one_in_front_of_a_filter() {
    let folder = tempfile::tempdir().unwrap();
    let of = (Filter::Sum(4), 40);
    let text = "G21 G90 G64 F600\nG5 X0.9 Y0.6 I0.4 J0 P0 Q-0.4\nG5.1 X0.1 Y0.4 I-0.3 J0.5\nG1 X0 Y0\nM2\n";
    for engine in EngineKind::ALL {
        let run = |events: &[&str]| {
            let (report, trace) = operated(&folder, "dda", text, (of, engine), events);
            check_filter(&report, &trace, of, &format!("{events:?}"));
            (report.outcome.clocks, ["dx", "dx_out", "loaded"].map(|name| clocks_of(&trace, name)))
        };
        let (clocks, [plain, ..]) = run(&[]);
        // 30 periods.
        let (held, [pulses, ..]) = run(&["700:hold", "1900:resume"]);
        let shifted: Vec<usize> = plain.iter().map(|&clock| if clock > 701 { clock + 1200 } else { clock }).collect();
        assert_eq!((held, pulses), (clocks + 1200, shifted), "{engine:?}");
        let (_, [_, out, loaded]) = run(&["0:single", "1000:start", "6000:start", "12000:start"]);
        let begun = |after: usize| loaded.iter().filter(|clock| (after..after + 4).contains(*clock)).count();
        assert_eq!(([1001, 6001, 12001].map(begun), loaded.len()), ([1; 3], 3), "{engine:?} {loaded:?}");
        let gaps = [6001, 12001].map(|clock| out.iter().filter(|out| (clock - 1000..clock).contains(*out)).count());
        assert_eq!(gaps, [0; 2], "{engine:?}");
    }
}

/// A word that does not fit is refused with the width that would hold it, and a sum that does not fit traps in its step.
#[test]
fn a_narrow_register_of_a_curve_is_refused_or_traps() {
    let folder = Folder::new();
    folder.write("p.ngc", "G21 G90 F600 G5 X0.08 Y0.08 I0.04 J0 P0 Q-0.04\nM2\n");
    let options = "--method dda --blu 0.01mm --clock-hz 1e5";
    let good = folder.good(&format!("program p.ngc {options}"));
    // p is 3068, q falls to -408 and r is -24.
    assert!(good.contains("rx 6/6, qx 10/10, px 13/13, ry 6/6, qy 10/10, py 13/13, e 5/5"), "{good}");
    for (narrow, remedy) in [("px=12", "px=13"), ("p=12", "px=13"), ("ry=5", "ry=6"), ("e=4", "e=5"), ("jcx=12", "jcx")]
    {
        let ran = folder.run(&format!("program p.ngc {options} --width {narrow}"));
        assert!(ran.code == 2 && ran.err.contains(remedy), "{narrow}: {ran:?}");
    }
    // After ten steps q would be -264.
    let ran = folder.run(&format!("program p.ngc {options} --width qx=9"));
    assert!(ran.code == 1 && ran.err.contains("--width qx=10"), "{ran:?}");
    let ran = folder.run(&format!("program p.ngc {options} --width p=12 --on-overflow wrap"));
    assert!(ran.code == 1 && ran.out.contains("12 bits"), "{ran:?}");
    // Without curves there are no such registers.
    folder.write("p.ngc", "G21 G90 F600 G1 X0.08\nM2\n");
    let ran = folder.run(&format!("program p.ngc {options} --width px=12"));
    assert!(ran.code == 2 && ran.err.contains("px"), "{ran:?}");
}

/// A curve that would need more steps than the registers are wide for is cut into chords, next to others that are not.
#[test]
fn a_curve_beyond_the_registers_has_chords() {
    let long = "G21 G90 F60000\nG5 X0 Y170 I170 J0 P0 Q0\nG5 X0 Y0 I176 J0 P0 Q0\nM2\n";
    let report = report(&Folder::new(), long, "--method dda --normalize --clock-hz 1e7");
    let blocks = report["blocks"].as_array().unwrap();
    assert_eq!((&blocks[0]["kind"], &blocks[0]["steps"], blocks.len()), (&"curve".into(), &524_288.into(), 2));
    assert_eq!((&report["missed_end_points"], &report["beyond_bound"]), (&0.into(), &0.into()));
    // 176 000 BLU are three times as many as 2^19 and more; normalised chords are short.
    assert!(
        blocks[1]["steps"].as_u64().unwrap() != 524_288 && number(&blocks[1]["length"]) > 100_000.0,
        "{}",
        blocks[1]
    );
}

/// The second and the fourth curve end where they begin, and every place of them is rounded to there.
#[test]
fn a_closed_curve_without_a_pulse_is_left_out_and_no_failure() {
    let folder = Folder::new();
    let text = "G91 G21 F600\nG5 X4 Y2 I2 J0 P0 Q-2\nG5.1 X0 Y0 I0 J-1\nG5.1 X0 Y0 I0 J1\nG5 X0 Y0 I1 J0 P0 Q1\nM2\n";
    let report = report(&folder, text, "--method dda --integers pulses");
    assert_eq!(report["left_out"]["moves"], 2);
    // The middle of the fourth, three eighths along both axes.
    assert!((number(&report["left_out"]["blu"]) - 0.375 * 2_f64.sqrt()).abs() < 1e-9, "{report}");
    let blocks = report["blocks"].as_array().unwrap();
    assert_eq!(blocks.iter().map(|block| block["line"].as_u64().unwrap()).collect::<Vec<_>>(), [2, 4]);
    assert_eq!(blocks[1]["pulses"]["y"], 2);
}
