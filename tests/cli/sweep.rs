//! `sweep`: rows are what single runs report, for any threads, parts and interruptions.

use std::collections::BTreeMap;
use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

use serde_json::Value;
use stepwave_models::{CurveKind, catalogue};

use super::{Folder, good, refused};

/// A row by its columns.
pub(super) type Row = BTreeMap<String, String>;

/// The fields of a line; quoted ones have no comma and no quote in these tests.
pub(super) fn rows(text: &str) -> Vec<Row> {
    let mut lines = text.lines();
    let heading: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    let row = |line: &str| {
        let mut fields = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => fields.push(String::new()),
                c => fields.last_mut().unwrap().push(c),
            }
        }
        assert_eq!(fields.len(), heading.len(), "{line}");
        heading.iter().map(|name| (*name).to_owned()).zip(fields).collect()
    };
    lines.map(row).collect()
}

/// The words of `run` for the points of a free curve.
fn free_curve(row: &Row) -> Option<String> {
    let get = |name: String| row.get(&name).filter(|word| !word.is_empty()).cloned();
    let point = |index: usize| ["x", "y", "w"].map(|axis| get(format!("p{index}_{axis}")));
    let points = (0..).map(point).take_while(|point| point[0].is_some()).flatten().flatten().collect::<Vec<_>>();
    let points = points.join(",");
    Some(match row.get("curve")?.as_str() {
        "bezier" => format!("--bezier {points}"),
        "hermite" => format!("--hermite {points}"),
        "catmull-rom" => format!("--points {points}"),
        "b-spline" => format!("--points {points} --b-spline"),
        "nurbs" => format!("--nurbs {points} --degree {} --knots {}", row["degree"], row["knots"]),
        _ => return None,
    })
}

/// The words of `run` for a row, from its columns.
fn words(model: &str, row: &Row) -> String {
    let get = |name: &str| row.get(name).filter(|word| !word.is_empty()).cloned();
    let point = |name: &str| {
        let axes = ["x", "y", "z", "a", "b", "c"].iter().map_while(|axis| get(&format!("{name}_{axis}")));
        axes.collect::<Vec<_>>().join(",")
    };
    let mut words = match free_curve(row) {
        Some(options) => format!("run {model} {options}"),
        None => format!("run {model} --from {} --to {}", point("from"), point("to")),
    };
    if let Some(curve) = get("curve").filter(|_| get("p0_x").is_none()) {
        let sizes = [get("size_a"), get("size_b")].into_iter().flatten().collect::<Vec<_>>().join(",");
        words += &format!(" --{curve} {sizes}");
    }
    words += &get("opens").map_or_else(String::new, |opens| format!(" --opens {opens}"));
    words += &get("direction").map_or_else(String::new, |value| format!(" --{value}"));
    if get("center_x").is_some() {
        words += &format!(" --center {}", point("center"));
    }
    for option in [
        "width",
        "preset",
        "beats",
        "end_point",
        "weights",
        "form",
        "speed",
        "accel",
        "jerk",
        "on_overflow",
        "divisions",
        "fraction",
    ] {
        words += &get(option).map_or_else(String::new, |word| format!(" --{} {word}", option.replace('_', "-")));
    }
    if get("normalize").as_deref() == Some("yes") {
        words += " --normalize";
    }
    words
}

/// The greatest path error of a report, to the bit: the reader of JSON may be off by one.
fn greatest(report: &str) -> f64 {
    let error = report.split("\"path_error\": {").nth(1).unwrap();
    let number = error.split("\"greatest\": ").nth(1).unwrap().split(',').next().unwrap();
    number.trim().parse().unwrap()
}

/// Wants a row to be what a single run reports.
pub(super) fn assert_as_run(model: &str, row: &Row) {
    let words = words(model, row);
    let ran = Folder::new().run(&format!("{words} --json -"));
    let what = format!("{words}: {row:?}\n{}", ran.err);
    if row["ending"] == "refused" {
        assert_eq!(ran.code, 2, "{what}");
        let reason = row["reason"].replace('"', "");
        assert!(ran.err.replace('"', "").contains(&reason) && !reason.is_empty(), "{what}");
        return;
    }
    let report: Value = serde_json::from_str(&ran.out).unwrap_or_else(|error| panic!("{error}: {what}"));
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut expected: Vec<(String, String)> = vec![
        ("ending".to_owned(), text(&report["ending"])),
        ("clocks".to_owned(), text(&report["clocks"])),
        ("steps".to_owned(), text(&report["steps"])),
        ("exact".to_owned(), text(&report["end_point"]["exact"])),
        ("overflows".to_owned(), text(&report["overflow"]["count"])),
    ];
    let first = report["overflow"]["events"].get(0);
    expected.push(("overflow".to_owned(), first.map_or_else(String::new, |event| text(&event["component"]))));
    for (place, axis) in report["pulses"].as_object().unwrap().keys().enumerate() {
        expected.push((format!("pulses_{axis}"), text(&report["pulses"][axis])));
        let axis = ["x", "y", "z", "a", "b", "c"][place];
        expected.push((format!("reached_{axis}"), text(&report["end_point"]["reached"][place])));
    }
    for (name, value) in expected {
        assert_eq!(row[&name], value, "{name}: {what}");
    }
    assert_eq!(row["error_max"].parse(), Ok(greatest(&ran.out)), "{what}");
    if row.contains_key("ripple") {
        let feed = &report["feed"];
        let speeds = [("v_least", &feed["least"]["value"]), ("v_greatest", &feed["greatest"]["value"])];
        for (name, said) in speeds.into_iter().chain([("ripple", &feed["ripple"]), ("v_mean", &feed["mean"])]) {
            let given = row[name].parse::<f64>().ok();
            // The reader of JSON may be off by one in the last bit.
            let same = |given: f64| said.as_f64().is_some_and(|said| (said - given).abs() <= given * 1e-15);
            assert!(given.map_or(said.is_null(), same), "{name} is {given:?}, not {said}: {what}");
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn rows_of_every_model_are_what_single_runs_report() {
    for model in catalogue().iter() {
        let name = model.name;
        let geometries = match model.curve() {
            CurveKind::Line { .. } => "--from -3,4 --to-grid -40..40x-40..40 --samples 12 --seed 5",
            CurveKind::Arc | CurveKind::Move => {
                "--from-grid 2..17x-9..9 --to-grid -15..19x-19..19 --center 1,-1 --cw --ccw --samples 12"
            }
            CurveKind::Conic => "--ellipse 3..9,2..9 --to-grid -9..9x-9..9 --cw --ccw --samples 12",
            CurveKind::Axis => "--from-grid -9..9 --to-grid -40..40 --samples 12",
            CurveKind::Spline => "--bezier 0,0,-9..9,-9..9,20,0..9,12,-7 --samples 12",
            CurveKind::Nurbs => "--nurbs 0,0,1,-90..90,300,0.5..2/0.5,300,0..99,1 --samples 12",
            CurveKind::Helix => "--radius 3..9 --height -20..20/5 --cw --ccw --samples 12",
        };
        let all = rows(&good(&format!("sweep {name} {geometries} --csv -")));
        assert_eq!(all.len(), 12, "{name}");
        assert!(all.iter().any(|row| row["ending"] == "done"), "{name}: {all:?}");
        all.iter().for_each(|row| assert_as_run(name, row));
    }
}

#[test]
fn rows_of_many_choices_overflows_stalls_and_refusals_are_what_single_runs_report() {
    for (model, words, seen) in [
        ("ppc-line", "--to-grid 1..9/4x1..9/4 --width f=3..5 --beats 4,1 --on-overflow trap,wrap,saturate", "trapped"),
        ("dda-line", "--to-grid 0..9/3x-8..8/8 --width 3..4 --normalize no,yes --preset zero,3,full", "refused"),
        ("dda-line", "--to-grid 3..5x2..3x-4..-3 --end-point total,longest,per-axis,iterations", "done"),
        (
            "dda-arc",
            "--from 3,7 --to-grid -8..8x6..8 --ccw --width 4 --preset zero,half --end-point per-axis,total",
            "stalled",
        ),
        ("cim-conic", "--parabola 4..5 --to-grid 1..16x0..9 --weights mid,pre,post", "done"),
        ("ramp", "--to-grid -20..20/7 --speed vc=100..144/22 --accel 8..12/4 --accel 9,4", "done"),
        ("ppc-conic", "--hyperbola 3..4,2 --to-grid 3..9x-4..4 --opens +x", "done"),
        ("spline-dda", "--bezier 0,0,-9..9/6,5..7,12,-4..4/4,3,8 --divisions 4,6 --width 14,30", "trapped"),
        ("spline-dda", "--hermite 0,0,9,-9..9/3,8,-4..4/4,3,8 --fraction 9,20", "done"),
        ("spline-dda", "--points 0,0,-9..9/6,5..7,12,-4..4/4,3,8,9,1 --b-spline", "done"),
        ("sampled-spline", "--nurbs 0,0,1,60,-90..90/60,0.5..2/0.5,200,0,1 --degree 2", "done"),
        ("sampled-spline", "--bezier 0,0,60,-90..90/90,200,0..3 --tolerance 2", "done"),
    ] {
        let all = rows(&good(&format!("sweep {model} {words} --ripple --csv -")));
        assert!(all.iter().any(|row| row["ending"] == seen), "{model} {words}");
        assert!(all.len() > 8, "{model} {words}: {}", all.len());
        // Every fourth, so that the test stays quick.
        all.iter().step_by(4).for_each(|row| assert_as_run(model, row));
    }
}

/// Runs with this number of threads.
fn with_threads(folder: &Folder, threads: &str, words: &str) {
    let output = folder.command().env("RAYON_NUM_THREADS", threads).args(words.split_whitespace()).output().unwrap();
    assert!(output.status.success(), "{words}: {output:?}");
}

const SWEEPS: [(&str, &str); 3] = [
    ("dda-line", "--to-grid -20..20x-20..20 --width 5..6 --preset zero,half"),
    ("ppc-arc", "--from-grid 3..9x0..4 --to-grid -10..10x-10..10 --cw --ccw"),
    ("dda-line", "--to-grid 0..99x0..99x0..99 --samples 300 --seed 9"),
];

#[test]
fn the_files_are_the_same_whatever_the_number_of_threads() {
    let folder = Folder::new();
    for (model, words) in SWEEPS {
        for threads in ["1", "2", "3"] {
            let words =
                format!("sweep {model} {words} --csv {threads}.csv --parquet {threads}.parquet --plot {threads}.svg");
            with_threads(&folder, threads, &words);
        }
        for kind in ["csv", "parquet", "svg"] {
            let bytes = |threads: &str| fs::read(folder.path(&format!("{threads}.{kind}"))).unwrap();
            assert!(bytes("1") == bytes("2") && bytes("2") == bytes("3"), "{model} {words}: {kind}");
        }
    }
    assert_eq!(folder.files().len(), 9);
}

#[test]
fn parts_in_any_order_join_to_the_file_of_the_whole_sweep() {
    let folder = Folder::new();
    for (model, words) in SWEEPS {
        for kind in ["csv", "parquet"] {
            folder.good(&format!("sweep {model} {words} --{kind} whole.{kind}"));
            for part in 1..=3 {
                folder.good(&format!("sweep {model} {words} --shard {part}/3 --{kind} {part}.{kind}"));
            }
            folder.good(&format!("sweep merge joined.{kind} 3.{kind} 1.{kind} 2.{kind}"));
            let bytes = |name: &str| fs::read(folder.path(&format!("{name}.{kind}"))).unwrap();
            assert!(bytes("joined") == bytes("whole") && bytes("whole").len() > 1000, "{model} {words}: {kind}");
        }
    }
}

#[test]
fn parts_that_do_not_make_one_whole_sweep_are_refused() {
    let folder = Folder::new();
    let sweep = "sweep dda-line --to-grid 0..9x0..9";
    for (part, kind) in [1, 2].into_iter().flat_map(|part| [(part, "csv"), (part, "parquet")]) {
        folder.good(&format!("{sweep} --shard {part}/2 --{kind} {part}.{kind}"));
    }
    folder.good(&format!("{sweep} --csv whole.csv"));
    folder.good(&format!("{sweep} --width 7 --shard 2/2 --csv other.csv"));
    folder.good(&format!("{sweep} --shard 2/3 --csv third.csv"));
    let text = folder.read("2.csv");
    let lines: Vec<&str> = text.lines().collect();
    folder.write("cut.csv", &lines[..lines.len() - 1].join("\n"));
    folder.write("torn.csv", &text[..text.len() / 2]);
    let few = [&lines[..5], &lines[6..]].concat().join("\n");
    folder.write("few.csv", &few);
    folder.write("old.csv", &text.replacen("\"schema\":2", "\"schema\":1", 1));
    let before = folder.files();
    for (parts, hint) in [
        ("1.csv", "part 2/2 is missing"),
        ("2.csv", "part 1/2 is missing"),
        ("1.csv 1.csv", "part 1/2 is given twice"),
        ("1.csv 2.csv 2.csv", "given twice"),
        ("1.csv other.csv", "it is of another sweep"),
        ("1.csv third.csv", "it is of another sweep"),
        ("1.csv whole.csv", "it is not a part of a sweep"),
        ("1.csv old.csv", "it is a part in form 1, but form 2 is needed: make it anew with --shard"),
        ("1.csv cut.csv", "its end is missing"),
        ("1.csv torn.csv", "cannot merge torn.csv"),
        ("1.csv few.csv", "of its 50 rows"),
        ("1.csv nowhere.csv", "cannot read nowhere.csv"),
    ] {
        let ran = folder.run(&format!("sweep merge joined.csv {parts}"));
        assert!(ran.code == 2 && ran.err.contains(hint) && ran.err.lines().count() == 1, "{parts}: {ran:?}");
        assert_eq!(folder.files(), before, "{parts}");
    }
    // Parts of both kinds make either.
    folder.good("sweep merge joined.csv 1.parquet 2.csv");
    assert_eq!(folder.read("joined.csv"), folder.read("whole.csv"));
}

/// Starts a sweep that takes a while, kills it once a chunk is done, and gives how many geometries were.
fn killed(folder: &Folder, words: &str, target: &str) -> u64 {
    let mut child =
        folder.command().args(words.split_whitespace()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let journal = folder.path(&format!(".{target}.sweep.journal"));
    let begun = Instant::now();
    let done = loop {
        let text = fs::read_to_string(&journal).unwrap_or_default();
        if let Some(mark) = text.lines().skip(1).last().and_then(|line| serde_json::from_str::<Value>(line).ok()) {
            break mark["geometries"].as_u64().unwrap();
        }
        assert!(begun.elapsed() < Duration::from_secs(300) && child.try_wait().unwrap().is_none(), "{text}");
        std::thread::sleep(Duration::from_millis(2));
    };
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!folder.path(target).exists(), "it was done before it was killed");
    done
}

#[test]
fn a_killed_sweep_goes_on_and_gives_the_same_file() {
    let words = "sweep dda-line --to-grid 0..127x0..63 --width 14";
    let folder = Folder::new();
    folder.good(&format!("{words} --csv whole.csv"));
    let done = killed(&folder, &format!("{words} --csv s.csv"), "s.csv");
    assert!((1..128 * 64).contains(&done), "{done}");
    // What was written after the last mark, or in the middle of a line, does not count.
    let part = folder.path(".s.csv.sweep.part");
    fs::write(&part, fs::read_to_string(&part).unwrap() + "999999,1").unwrap();

    let other = folder.run("sweep dda-line --to-grid 0..127x0..63 --width 13 --csv s.csv --resume");
    assert!(other.code == 2 && other.err.contains("it was begun with choices {\"--width\":[\"14\"]}"), "{other:?}");
    let shard = folder.run(&format!("{words} --shard 1/2 --csv s.csv --resume"));
    assert!(shard.code == 2 && shard.err.contains("it was begun with --shard 1/1"), "{shard:?}");

    let text = folder.good(&format!("{words} --csv s.csv --resume"));
    let before: u64 =
        text.lines().find_map(|line| line.strip_suffix(" of the runs were done before")?.parse().ok()).unwrap();
    assert!(before >= done, "{before} {done}");
    assert!(folder.read("s.csv") == folder.read("whole.csv"));
    assert_eq!(folder.files(), ["s.csv", "whole.csv"]);
}

#[test]
fn a_killed_part_in_parquet_goes_on_with_its_heat_map() {
    let words = "sweep dda-line --to-grid 0..99x0..127 --width 14 --shard 2/2";
    let folder = Folder::new();
    folder.good(&format!("{words} --parquet whole.parquet --plot whole.svg"));
    killed(&folder, &format!("{words} --parquet s.parquet --plot s.svg"), "s.parquet");
    folder.good(&format!("{words} --parquet s.parquet --plot s.svg --resume"));
    for kind in ["parquet", "svg"] {
        let bytes = |name: &str| fs::read(folder.path(&format!("{name}.{kind}"))).unwrap();
        assert!(bytes("s") == bytes("whole"), "{kind}");
    }
    assert_eq!(folder.files(), ["s.parquet", "s.svg", "whole.parquet", "whole.svg"]);
}

#[test]
fn resume_with_nothing_left_begins() {
    let folder = Folder::new();
    folder.good("sweep ppc-arc --radius 1..5 --cw --csv s.csv --resume");
    assert_eq!(folder.read("s.csv"), good("sweep ppc-arc --radius 1..5 --cw --csv -"));
}

#[test]
fn geometries_come_from_a_file_as_well() {
    let folder = Folder::new();
    folder.write("p.csv", "from_x,from_y,to_x,to_y,direction\n5,0,0,5,ccw\n3,4,3,4,cw\n\n5,0,9,9,cw\n");
    let all = rows(&folder.good("sweep ppc-arc --file p.csv --csv -"));
    assert_eq!(all.iter().map(|row| row["ending"].as_str()).collect::<Vec<_>>(), ["done", "done", "refused"]);
    all.iter().for_each(|row| assert_as_run("ppc-arc", row));
    folder.write("q.csv", "to_x,to_y\n5,0\n3,4.5\n");
    folder.write("r.csv", "to_x,to_y,centre_x\n5,0,1\n");
    folder.write("s.csv", "");
    for (file, hint) in [
        ("q.csv", "q.csv: line 3: expected a whole number of BLU for to_y, not '4.5'"),
        ("r.csv", "there is no column 'centre_x'"),
        ("s.csv", "a heading is missing"),
        ("t.csv", "cannot read t.csv"),
    ] {
        let ran = folder.run(&format!("sweep dda-line --file {file} --csv out.csv"));
        assert!(ran.code == 2 && ran.err.contains(hint), "{file}: {ran:?}");
    }
    assert!(!folder.path("out.csv").exists());
}

#[test]
fn the_heat_map_names_the_worst_cell_with_the_words_that_repeat_it() {
    let folder = Folder::new();
    let text = folder.good(
        "sweep dda-line --to-grid 0..20x0..20 --width 5..6 --heat error_max --plot heat.svg \
                            --plot heat.png",
    );
    let line = text.lines().find(|line| line.starts_with("greatest error_max ")).unwrap();
    let (number, words) = line.split_once(": stepwave ").unwrap();
    let number: f64 = number.split_whitespace().nth(2).unwrap().parse().unwrap();
    assert_eq!(greatest(&folder.good(&format!("{words} --json -"))), number);
    let svg = folder.read("heat.svg");
    for part in [words, "to_x (BLU)", "to_y (BLU)", "error_max (BLU)", "data:image/png;base64,"] {
        assert!(svg.contains(part), "{part}");
    }
    let png = fs::read(folder.path("heat.png")).unwrap();
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && png.ends_with(b"IEND\xae\x42\x60\x82"));
    assert_eq!(folder.files(), ["heat.png", "heat.svg"]);
}

#[test]
fn bad_words_are_refused_and_leave_no_file() {
    let sweep = "sweep dda-line --to-grid 0..9x0..9";
    for (words, hints) in [
        ("sweep dda-line --csv s.csv", &["the end points are missing", "--to-grid"][..]),
        ("sweep dda-line --to-grid 9..0x0..9 --csv s.csv", &["9..0 begins after its end", "0..9"]),
        ("sweep dda-line --to-grid 0..9 --csv s.csv", &["1 coordinate,"]),
        ("sweep vector-line --to-grid 0..9x0..9x0..9 --csv s.csv", &["3 coordinates", "lines of 2 axes"]),
        ("sweep dda-line --to-grid 0..9x0..9/0 --csv s.csv", &["a step of 0"]),
        ("sweep dda-line --to-grid 0..1000000x0..1000000 --csv s.csv", &["are more than 4294967296 runs", "coarser"]),
        ("sweep ppc-arc --to-grid 1..9x1..9 --csv s.csv --ccw", &["the start points are missing", "--radius"]),
        ("sweep ppc-arc --radius 1..9 --csv s.csv", &["the direction is missing"]),
        ("sweep ppc-arc --from 50,0 --to-grid 1..9x1..9 --ccw --csv s.csv", &["no point of the grid", "another grid"]),
        ("sweep ppc-conic --ellipse 3 --cw --csv s.csv", &["1 sizes", "takes 2"]),
        ("sweep dda-line --to-grid 1..2x1..2 --radius 4 --csv s.csv", &["no --radius"]),
        ("sweep nothing --to-grid 1..2x1..2", &["there is no model 'nothing'"]),
        ("sweep", &["MODEL"]),
    ] {
        refused(words, hints);
    }
    for (more, hints) in [
        ("--width 0..4", &["invalid value '0..4' of --width", "1 to 64"][..]),
        ("--end-point both", &["invalid value 'both' of --end-point", "per-axis"]),
        ("--beats 1", &["dda-line does not take --beats"]),
        ("--plot p.svg --heat speed", &["there is no column 'speed'", "error_max"]),
        ("--plot p.svg --heat ending", &["the column 'ending' is not a measure"]),
        ("--heat clocks", &["--plot"]),
        ("--resume", &["--csv FILE or --parquet FILE"]),
        ("--csv - --resume", &["--csv FILE or --parquet FILE"]),
        ("--csv nowhere/s.csv", &["cannot write nowhere/s.csv", "does not exist"]),
        ("--csv s --parquet s", &["two outputs would go to s"]),
        ("--csv s.csv --plot nowhere/p.svg", &["cannot write nowhere/p.svg"]),
        ("--plot p.png --plot p.png", &["two outputs would go to p.png"]),
        ("--plot - --plot -", &["two outputs cannot both go to standard output"]),
        ("--parquet -", &["name a file"]),
        ("--shard 4/3", &["invalid part '4/3'"]),
        ("--shard 0/3", &["invalid part '0/3'"]),
        ("--samples 0", &["0"]),
        ("--max-clocks 0", &["0"]),
        ("--file p.csv", &["cannot be used with"]),
    ] {
        refused(&format!("{sweep} {more}"), hints);
    }
    let radius = "sweep ppc-arc --radius 1..5 --ccw";
    refused(&format!("{radius} --plot p.svg"), &["a heat map shows a grid", "--to-grid"]);
}

#[test]
fn two_sweeps_of_one_file_do_not_meet() {
    let folder = Folder::new();
    let words = "sweep dda-line --to-grid 0..127x0..63 --width 14 --csv s.csv";
    let mut first =
        folder.command().args(words.split_whitespace()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    while !folder.path(".s.csv.sweep.part").exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let second = folder.run(words);
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(second.code == 2 && second.err.contains("another sweep is writing it"), "{second:?}");
}

#[test]
fn the_examples_of_the_help_of_sweep_work_as_written() {
    let help = good("sweep --help");
    let examples = help.lines().filter_map(|line| line.trim().strip_prefix("stepwave sweep "));
    let examples: Vec<&str> = examples.filter(|example| !example.contains('<')).collect();
    assert_eq!(examples.len(), 6, "{help}");
    for example in examples {
        assert_eq!(Folder::new().run(&format!("sweep {example}")).code, 0, "{example}");
    }
}

#[test]
fn k_v_is_the_ratio_of_mean_speeds_of_lines_of_one_length() {
    let folder = Folder::new();
    std::fs::write(folder.path("lines.csv"), "to_x,to_y\n100,0\n71,71\n-60,80\n0,-100\n").unwrap();
    for options in ["", "--beats 1"] {
        let out = folder.good(&format!("sweep ppc-line --file lines.csv {options} --csv rows.csv"));
        let rows = folder.read("rows.csv");
        let names: Vec<&str> = rows.lines().next().unwrap().split(',').collect();
        let place = names.iter().position(|name| *name == "v_mean").unwrap();
        let means: Vec<f64> =
            rows.lines().skip(1).map(|row| row.split(',').nth(place).unwrap().parse().unwrap()).collect();
        let expected = [1.0, 71f64.hypot(71.0) / 142.0, 100.0 / 140.0, 1.0];
        assert!(means.iter().zip(expected).all(|(mean, expected)| (mean - expected).abs() < 1e-12), "{means:?}");
        assert!(out.contains("\nk_v 1.4142, "), "{out}");
    }
    // Runs that come to no end have no mean speed: those between the axes, of more than 4 * 140 clocks.
    let out = folder.good("sweep ppc-line --file lines.csv --max-clocks 500");
    assert!(out.contains("\nk_v 1.0000, the greatest over the least, of 2 of 4 lines of one length\n"), "{out}");
    // Lines of several lengths have none.
    let out = folder.good("sweep ppc-line --to-grid 1..9x1..9");
    assert!(out.contains("mean speed over v_max: least 0.7071: ") && !out.contains("k_v"), "{out}");
}
