//! Windows, filters and depth, as given on the command line.

use stepwave_engine::EngineKind;
use stepwave_models::Options;

use super::written::read;
use super::{Case, Folder, Recording, Shown, TICKS, Truth, compare, compare_clock, line, record};

/// The line to (8, 6) in 17 clocks: Y pulses with steps 3, 6, 8, 11, 14, 16; its carry is at the same clocks, before
/// the edge at which the axis steps.
const WORDS: &str = "run dda-line --to 8,6 --vcd w.vcd";
const LAST: u64 = 17;

fn truth() -> Recording {
    record(&Case { what: "", model: "dda-line", curve: line(&[8, 6]), choices: Options::default() }, EngineKind::Word)
}

fn shown(options: &str) -> Shown {
    let folder = Folder::new();
    folder.good(&format!("{WORDS} {options}"));
    read(folder.read("w.vcd").as_bytes())
}

/// Whether a path is kept.
type Keeps = Box<dyn Fn(&str) -> bool>;

/// Names of the signals of a recording that fulfil a condition on their path.
fn only(recording: &Recording, keep: impl Fn(&str) -> bool) -> Vec<&Truth> {
    recording.signals.iter().filter(|signal| keep(&signal.path)).collect()
}

#[test]
fn a_window_shows_its_clocks_at_their_true_times() {
    let recording = truth();
    assert_eq!(recording.samples, LAST + 1);
    for (options, first, last) in [
        ("", 0, LAST),
        ("--trace-from 0 --trace-to 17", 0, LAST),
        ("--trace-from 5", 5, LAST),
        ("--trace-to 9", 0, 9),
        ("--trace-from 5 --trace-to 9", 5, 9),
        ("--trace-from 7 --trace-to 7", 7, 7),
        ("--trace-from 17", LAST, LAST),
        ("--trace-to 0", 0, 0),
        ("--trace-from 16 --trace-to 99999", 16, LAST),
    ] {
        let shown = shown(options);
        compare(options, &shown, &recording.signals, first, last);
        compare_clock(options, &shown, first, last);
    }
}

#[test]
fn windows_of_a_long_run_begin_and_end_anywhere_in_a_block_of_samples() {
    // 500 steps of four clocks; samples go from the engine to the writer in blocks of 256 or so.
    let case = Case { what: "", model: "ppc-line", curve: line(&[300, 200]), choices: Options::default() };
    let recording = record(&case, EngineKind::Word);
    assert_eq!(recording.samples, 2002);
    for (first, last) in
        [(0, 255), (0, 256), (255, 256), (256, 256), (256, 511), (257, 513), (1000, 1999), (2001, 2001)]
    {
        let folder = Folder::new();
        let window = format!("--trace-from {first} --trace-to {last}");
        folder.good(&format!("run ppc-line --to 300,200 --vcd w.vcd {window}"));
        let shown = read(folder.read("w.vcd").as_bytes());
        compare(&window, &shown, &recording.signals, first, last);
        compare_clock(&window, &shown, first, last);
    }
}

#[test]
fn a_trigger_opens_the_window_at_the_first_clock_on_which_it_is_1() {
    let recording = truth();
    for (options, first, last) in [
        ("--trace-on loaded", 1, LAST),
        ("--trace-on done", LAST, LAST),
        ("--trace-on dda_line.axis_y.carry", 3, LAST),
        ("--trace-on dda_line.axis_y.carry --trace-from 3", 3, LAST),
        ("--trace-on dda_line.axis_y.carry --trace-from 4", 6, LAST),
        ("--trace-on dda_line.axis_y.carry --trace-from 9 --trace-to 12", 11, 12),
    ] {
        let shown = shown(options);
        compare(options, &shown, &recording.signals, first, last);
        compare_clock(options, &shown, first, last);
    }
}

#[test]
fn patterns_keep_names_by_leaf_and_by_path() {
    let recording = truth();
    let starts = |path: &str, begin: &str| path.rsplit('.').next().unwrap().starts_with(begin);
    let cases: [(&str, Keeps); 7] = [
        ("--trace jr*", Box::new(move |path| starts(path, "jr"))),
        ("--trace jr* --trace jvx", Box::new(move |path| starts(path, "jr") || path.ends_with(".jvx"))),
        ("--trace axis_x.*", Box::new(|path| path.starts_with("dda_line.axis_x."))),
        ("--trace dda_line.axis_x.*", Box::new(|path| path.starts_with("dda_line.axis_x."))),
        ("--trace-exclude *_in", Box::new(|path| !path.ends_with("_in"))),
        ("--trace jr* --trace-exclude *_in", Box::new(move |path| starts(path, "jr") && !path.ends_with("_in"))),
        (
            "--trace-exclude block.* --trace-exclude axis_?.*",
            Box::new(|path| !path.contains(".block.") && !path.contains(".axis_")),
        ),
    ];
    for (options, keep) in cases {
        let kept = only(&recording, keep);
        assert!(!kept.is_empty() && kept.len() < recording.signals.len(), "{options}");
        let shown = shown(options);
        compare(options, &shown, kept, 0, LAST);
        compare_clock(options, &shown, 0, LAST);
    }
}

#[test]
fn depth_counts_scopes_from_the_top() {
    let recording = truth();
    for (options, depth) in [("--trace-depth 1", 1), ("--trace-depth 2", 2), ("--trace-depth 99", 99)] {
        let kept = only(&recording, |path| path.matches('.').count() <= depth);
        assert!(!kept.is_empty() && (depth > 1 || kept.len() < recording.signals.len()), "{options}");
        compare(options, &shown(options), kept, 0, LAST);
    }
}

#[test]
fn without_the_clock_all_else_stays_the_same() {
    let recording = truth();
    for (options, first) in [("--no-clk", 0), ("--no-clk --trace-from 5", 5)] {
        let shown = shown(options);
        assert!(shown.variables.keys().all(|path| !path.ends_with(".clk")), "{options}");
        compare(options, &shown, &recording.signals, first, LAST);
    }
}

#[test]
fn a_clock_without_a_change_takes_no_line_where_the_clock_itself_is_left_out() {
    let folder = Folder::new();
    folder.good(&format!("{WORDS} --no-clk --trace axis_y.dy"));
    let text = folder.read("w.vcd");
    let times: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix('#')).collect();
    // dy rises with the steps 3, 6, 8, 11, 14 and 16, at the clocks 4, 7, 9, 12, 15 and 17, and falls one clock later.
    let edges = [0, 4, 5, 7, 8, 9, 10, 12, 13, 15, 16, 17, 18].map(|clock| (clock * TICKS).to_string());
    assert_eq!(times, edges);
}

#[test]
fn the_clock_frequency_sets_the_timescale() {
    for (hz, scale, period) in [("1e6", "100 ns", 10), ("50e6", "10 ns", 2), ("1", "100 ms", 10), ("250", "1 ms", 4)] {
        let folder = Folder::new();
        folder.good(&format!("{WORDS} --clock-hz {hz}"));
        let text = folder.read("w.vcd");
        assert!(text.contains(&format!("\n$timescale {scale} $end\n")), "{hz}: {text}");
        assert!(text.ends_with(&format!("\n#{}\n", (LAST + 1) * period)), "{hz}");
        let hz: f64 = hz.parse().unwrap();
        assert!(text.contains(&format!("; clock {hz} Hz; dda-line; line (0, 0) to (8, 6); ")), "{hz}");
    }
}
