//! Programs as CAM systems and people write them.

use std::fs;

use serde_json::Value;

use super::command::{number, report};
use crate::cli::Folder;

/// Runs a command that is refused with these words.
fn refused(folder: &Folder, words: &str, parts: &[&str]) {
    let ran = folder.run(words);
    assert_eq!(ran.code, 2, "{words}: {}", ran.err);
    for part in parts {
        assert!(ran.err.contains(part), "{words}: {}", ran.err);
    }
}

/// x, y and z of every row of a step table, in order.
fn path(folder: &Folder) -> Vec<[i64; 3]> {
    let table = fs::read_to_string(folder.path("s.csv")).unwrap();
    let row = |line: &str| {
        let cells: Vec<i64> = line.rsplit(',').take(3).map(|cell| cell.parse().unwrap()).collect();
        [cells[2], cells[1], cells[0]]
    };
    table.lines().skip(1).map(row).collect()
}

#[test]
fn a_circle_of_radius_0_6_is_never_more_than_1_6_blu_off() {
    let folder = Folder::new();
    for family in ["ppc", "dda", "cim", "mindev"] {
        let options = format!("--method {family} --blu 0.01mm --steps s.csv");
        report(&folder, "G0 X1 Y1\nG2 I-0.006 J0 F100\n", &options);
        // After the rapid move to (100, 100).
        let circle = path(&folder).into_iter().skip_while(|at| *at != [100, 100, 0]);
        for [x, y, _] in circle {
            let off = f64::hypot(x as f64 - 99.4, y as f64 - 100.0) - 0.6;
            assert!(off.abs() < 1.65, "{family}: ({x}, {y}) is {off} off");
        }
    }
}

#[test]
fn a_circle_too_small_for_pulses_is_left_out_and_reported() {
    let folder = Folder::new();
    let report = report(&folder, "G0 X1 Y1\nG2 I-0.004 J0 F100\nG1 X2\n", "--method cim --blu 0.01mm");
    assert_eq!(report["moves"], 2);
    assert_eq!(report["left_out"]["moves"], 1);
    assert_eq!(report["left_out"]["line"], 2);
    // The far side of the circle.
    assert!((number(&report["left_out"]["blu"]) - 0.8).abs() < 1e-9);
}

#[test]
fn an_arc_of_two_turns_takes_its_third_axis_to_the_end() {
    let folder = Folder::new();
    let text = "G21 G90 G17\nF200\nG0 X0 Y8 Z0\nG2 Z-6 I0 J-8 P2\n";
    for family in ["ppc", "cim", "dpm"] {
        let report = report(&folder, text, &format!("--method {family} --blu 0.01mm --steps s.csv"));
        assert_eq!(report["reached"], serde_json::json!([0, 800, -600]), "{family}");
        // After each turn it is again where it began, the first time at half of the depth.
        let path = path(&folder);
        assert!(path.iter().any(|at| at[0] == 0 && at[1] == 800 && (at[2] + 300).abs() <= 1), "{family}");
        assert!(path.iter().all(|at| (f64::hypot(at[0] as f64, at[1] as f64) - 800.0).abs() < 2.5 || at[2] == 0));
    }
    // With the tool off the contour: the same turns about the same centre, 2 mm farther out.
    let offset = "G21 G90 G17\nF200\nG0 X0 Y18\nG42 D1 G1 X0 Y8\nG2 Z-6 I0 J-8 P2\nG40 G1 Y18\n";
    let report = report(&folder, offset, "--method cim --blu 0.01mm --tool 1=2mm --steps s.csv");
    assert_eq!(report["missed_end_points"], 0);
    assert!(number(&report["programmed_contour_error"]["blu"]) < 2.5);
}

#[test]
fn a_steep_helix_runs_in_chords() {
    let folder = Folder::new();
    for family in ["ppc", "dda", "cim", "mindev", "dpm"] {
        let options = format!("--method {family} --blu 0.01mm");
        let report = report(&folder, "G0 X10\nG3 X0 Y10 Z-9 I-10 J0 F300\n", &options);
        assert_eq!(report["reached"], serde_json::json!([0, 1000, -900]), "{family}");
        assert_eq!(report["missed_end_points"], 0, "{family}");
        assert!(number(&report["compensated_contour_error"]["blu"]) < 3.0, "{family}");
    }
}

#[test]
fn starts_and_ends_as_cam_systems_write_them_run() {
    let folder = Folder::new();
    let text = "%\n(T1 D=6)\nG90 G94 G17\nG21\nG53 G0 Z0\nT1 M6\nS9000 M3\nG54\nG0 X10 Y5\nG43 Z15 H1\nG1 Z-1 F300\nX30\n\
                G53 G0 Z0\nM30\n%\n";
    let reached = |home: &str| report(&folder, text, &format!("--method cim --blu 0.01mm {home}"))["reached"].clone();
    assert_eq!(reached(""), serde_json::json!([3000, 500, 0]));
    assert_eq!(reached("--home 0,0,50"), serde_json::json!([3000, 500, 5000]));
    assert_eq!(reached("--home ignore"), serde_json::json!([3000, 500, -100]));
    refused(&folder, "program p.ngc --method cim --home 1,2", &["'1,2' is not a home: give X,Y,Z"]);
}

#[test]
fn a_tool_of_radius_0_runs_on_the_contour() {
    let folder = Folder::new();
    let text = "G0 X-10 Y-10\nG41 D8 G1 X0 Y0 F300\nY20\nG40 X10\n";
    for zero in ["0mm", "0", "0.0"] {
        let report = report(&folder, text, &format!("--method cim --blu 0.01mm --tool 8={zero}"));
        assert_eq!(report["reached"], serde_json::json!([1000, 2000, 0]));
    }
    refused(&folder, "program p.ngc --method cim --tool 8=-1mm", &["invalid tool '8=-1mm'"]);
}

#[test]
fn a_wave_that_would_be_large_is_reported_before_it_is_written() {
    let folder = Folder::new();
    fs::write(folder.path("p.ngc"), "G1 X100 F60\n").unwrap();
    let wanted = ["the wave would have about", "--trace-steps", "without --every-clock", "--fst", "--large"];
    refused(&folder, "program p.ngc --method ppc --every-clock --vcd w.vcd", &wanted);
    assert!(!folder.path("w.vcd").exists());
}

#[test]
fn the_estimate_is_near_the_wave_that_comes() {
    // One path a hundred times as long would be too large; its hundredth part is written.
    for options in [
        "--method ppc --every-clock",
        "--method dda --every-clock",
        "--method cim --every-clock --no-clk",
        "--method mindev --trace phase --trace x",
    ] {
        let folder = Folder::new();
        fs::write(folder.path("p.ngc"), "G1 X400 Y300 F60\n").unwrap();
        let ran = folder.run(&format!("program p.ngc {options} --vcd w.vcd"));
        let words: Vec<&str> = ran.err.split_whitespace().collect();
        let at =
            words.iter().position(|word| word.starts_with("GB")).unwrap_or_else(|| panic!("{options}: {}", ran.err));
        let estimate: f64 = words[at - 1].parse().unwrap();
        report(&folder, "G1 X0.4 Y0.3 F60\n", &format!("{options} --vcd w.vcd"));
        let size = fs::metadata(folder.path("w.vcd")).unwrap().len() as f64 * 1000.0 / 1e9;
        assert!((0.75..1.6).contains(&(estimate / size)), "{options}: {estimate} GB for {size} GB");
    }
}

#[test]
fn a_wave_of_steps_has_one_sample_a_step() {
    let folder = Folder::new();
    let report: Value =
        report(&folder, "G1 X0.1 F60\n", "--method ppc --vcd w.vcd --trace-steps --trace phase --steps s.csv");
    let wave = fs::read_to_string(folder.path("w.vcd")).unwrap();
    let stamps = wave.lines().filter(|line| line.starts_with('#')).count() as u64;
    // The beginning, the loading, every step, and the end.
    let steps = report["steps"].as_u64().unwrap();
    assert!((steps + 2..=steps + 4).contains(&stamps), "{stamps} for {steps} steps");
}
