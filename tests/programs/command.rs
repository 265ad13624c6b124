//! `stepwave program` as its users meet it.

use std::fs;

use serde_json::Value;

use crate::cli::Folder;

/// Runs a program and gives its report.
pub(super) fn report(folder: &Folder, text: &str, options: &str) -> Value {
    fs::write(folder.path("p.ngc"), text).unwrap();
    folder.good(&format!("program p.ngc {options} --json r.json"));
    serde_json::from_str(&fs::read_to_string(folder.path("r.json")).unwrap()).unwrap()
}

pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

pub(super) const FAMILIES: [&str; 7] = ["ppc", "dda", "dpm", "cim", "mindev", "stepgen", "bresenham"];

/// Coarse and slow, so that it is short; r = 200 BLU.
const PART: &str = "--blu 0.01mm --clock-hz 2e4 --tool 1=2mm";

#[test]
fn a_part_with_every_kind_of_corner_ends_every_block_at_its_end_point_by_every_family() {
    let text = include_str!("../../examples/part.ngc");
    for family in FAMILIES {
        let folder = Folder::new();
        let options = format!("--method {family} {PART} {}", if family == "dda" { "--normalize" } else { "" });
        let report = report(&folder, text, &options);
        assert_eq!(report["missed_end_points"], 0, "{family}");
        assert_eq!(report["beyond_bound"], 0, "{family}");
        assert_eq!(report["overflow"]["events"], Value::Array(Vec::new()), "{family}");
        assert_eq!(report["reached"], serde_json::json!([-2000, -1000, 200]), "{family}");
        // A rounded contour is up to a BLU off, a chord half a one more.
        let off = number(&report["programmed_contour_error"]["blu"]);
        assert!(off < 3.5, "{family}: {off}");
        let blocks = report["blocks"].as_array().unwrap();
        for kind in ["line", "arc", "rapid", "start-up", "cancel", "inserted line"] {
            assert!(blocks.iter().any(|block| block["kind"] == kind), "{family}: no {kind}");
        }
        // The clock after the last step of a block loads the next one, which waits in the buffer; the end of a block of
        // step outputs is that of its last space.
        let clock = |block: &Value, name: &str| block[name].as_u64().unwrap();
        let idle = |pair: &[Value]| clock(&pair[1], "begun") - clock(&pair[0], "begun") - clock(&pair[0], "clocks");
        assert!(family == "stepgen" || blocks.windows(2).all(|pair| idle(pair) == 1), "{family}");
    }
}

#[test]
fn no_pulse_is_late_between_two_blocks() {
    let folder = Folder::new();
    // Four lines of 100 pulses along x at a pulse every 10 clocks.
    let lines: String = (1..=4).map(|i| format!("G01 X{} F600\n", f64::from(i) * 0.1)).collect();
    report(&folder, &lines, "--method ppc --clock-hz 1e5 --steps s.csv");
    let table = fs::read_to_string(folder.path("s.csv")).unwrap();
    let clocks: Vec<u64> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>())
        .filter(|row| row[1] != "0")
        .map(|row| row[2].parse().unwrap())
        .collect();
    assert_eq!(clocks.len(), 400);
    let gaps: Vec<u64> = clocks.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(gaps.iter().all(|&gap| gap == 10 || gap == 11 || gap == 9), "{gaps:?}");
    assert_eq!(clocks[399] - clocks[0], 3990);
}

#[test]
fn the_step_table_has_the_block_in_front() {
    let folder = Folder::new();
    report(&folder, "N7 G01 X0.003 Y0.002 F60\nG02 X0.006 Y-0.001 I0 J-0.003\n", "--method ppc --steps s.csv");
    let table = fs::read_to_string(folder.path("s.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows[0], "block,step,clock,mode,plane,quad,f,xi,yi,ex,ey,dx,dy,dz,x,y,z");
    let columns = |row: &str, wanted: &[usize]| -> Vec<i64> {
        let values: Vec<i64> = row.split(',').map(|value| value.parse().unwrap()).collect();
        wanted.iter().map(|&index| values[index]).collect()
    };
    // block, step, F, x, y of the line (3, 2): X Y X Y X, F = 0, -2, 1, -1, 2, 0.
    let line: Vec<Vec<i64>> = rows[1..7].iter().map(|row| columns(row, &[0, 1, 6, 14, 15])).collect();
    assert_eq!(
        line,
        [[7, 0, 0, 0, 0], [7, 1, -2, 1, 0], [7, 2, 1, 1, 1], [7, 3, -1, 2, 1], [7, 4, 2, 2, 2], [7, 5, 0, 3, 2]]
    );
    // SR1 from (0, 3) to (3, 0) about (3, -1): the line of the file is its name.
    let arc: Vec<Vec<i64>> = rows[7..14].iter().map(|row| columns(row, &[0, 1, 6])).collect();
    assert_eq!(arc, [[2, 0, 0], [2, 1, -5], [2, 2, -4], [2, 3, -1], [2, 4, 4], [2, 5, 1], [2, 6, 0]]);
    assert_eq!(columns(rows[13], &[14, 15]), [6, -1]);
}

#[test]
fn mean_feeds_are_those_of_the_methods() {
    // Section by section: F along an axis, and what the direction of a line makes of it.
    let text = "G01 X3 Y4 F120\n";
    for (family, ratio) in [("ppc", 5.0 / 7.0), ("cim", 5.0 / 4.0), ("mindev", 5.0 / 4.0), ("dda", 1.0), ("dpm", 1.0)] {
        let folder = Folder::new();
        let report = report(&folder, text, &format!("--method {family} --clock-hz 1e6"));
        let feed = &report["blocks"][0]["feed"];
        assert_eq!(number(&feed["commanded_mm_per_min"]), 120.0);
        let reached = number(&feed["reached_mm_per_min"]);
        assert!((reached / 120.0 - ratio).abs() < 2e-3, "{family}: {reached}");
        assert_eq!(feed["limited"], false, "{family}");
        // f_g = F / (60 δ), or FRN·2^n/60 of a line of 5 mm in 12 bits.
        let source = if ratio == 1.0 { 120.0 / 5.0 * 4096.0 / 60.0 } else { 120.0 / 60.0 / 0.001 };
        assert!((number(&feed["source_hz"]) / source - 1.0).abs() < 1e-6, "{family}: {feed}");
    }
}

#[test]
fn inverse_time_gives_every_family_the_same_time() {
    for family in FAMILIES {
        let folder = Folder::new();
        let text = "G93 G01 X0.8 Y0.6 F30\nG03 X0 Y1.4 I-0.8 J0 F12\n";
        let report = report(&folder, text, &format!("--method {family} --clock-hz 1e6"));
        for (block, seconds) in [(0, 2.0), (1, 5.0)] {
            let took = number(&report["blocks"][block]["seconds"]);
            assert!((took / seconds - 1.0).abs() < 0.01, "{family} block {block}: {took}");
        }
    }
}

#[test]
fn normalisation_lets_a_slow_pulse_source_reach_the_feed() {
    // A long block makes the registers wide; the short one then needs a fast source.
    let text = "G00 X100\nG01 Y0.1 F300\n";
    let folder = Folder::new();
    let plain = report(&folder, text, "--method dda --clock-hz 1e5");
    let normalized = report(&folder, text, "--method dda --clock-hz 1e5 --normalize");
    let feed =
        |report: &Value| (number(&report["blocks"][1]["feed"]["reached_mm_per_min"]), report["limited_feeds"].clone());
    assert!(feed(&plain).0 < 10.0 && feed(&plain).1 == 1, "{:?}", feed(&plain));
    assert!((feed(&normalized).0 / 300.0 - 1.0).abs() < 0.02 && feed(&normalized).1 == 0, "{:?}", feed(&normalized));
}

#[test]
fn the_textbook_form_counts_pulses() {
    let folder = Folder::new();
    let report = report(&folder, "N3G01X-450Y-750F150\n", "--method ppc --integers pulses");
    assert_eq!(report["reached"], serde_json::json!([-450, -750, 0]));
    assert_eq!(report["blocks"][0]["n"], 3);
}

#[test]
fn bad_programs_end_with_line_and_column_and_leave_nothing() {
    let cases: [(&[u8], &str); 9] = [
        (b"G01 X1 F100\nG01 Q5\n", "line 2, column 5"),
        (b"G02 X1 Y1 F100\n", "line 1, column 1"),
        (b"G01 X1 F0\n", "line 1, column 8"),
        (b"G01 X1\n", "line 1, column"),
        (b"G01 X99999999999999999999 F1\n", "line 1, column 5"),
        (b"\x00\xff\x13junk", "line 1, column 2"),
        (b"G01 X1 F100\nG91 G30 Z0\n", "line 2, column 5"),
        (b"G41 D1 G01 X50 F100\nX60\nY10\nX55\nY9\nX70\nG40 X90\n", "too large"),
        (b"", "line 1"),
    ];
    for (text, wanted) in cases {
        let folder = Folder::new();
        fs::write(folder.path("p.ngc"), text).unwrap();
        let ran =
            folder.run("program p.ngc --method ppc --tool 1=4mm --json r.json --vcd w.vcd --plot p.svg --steps s.csv");
        assert_eq!(ran.code, 2, "{ran:?}");
        assert!(
            ran.err.contains(wanted) && ran.err.lines().count() == 1,
            "{:?}: {ran:?}",
            String::from_utf8_lossy(text)
        );
        assert_eq!(folder.files(), ["p.ngc"], "{ran:?}");
    }
}

#[test]
fn a_width_that_is_too_small_traps_in_its_block_or_is_refused() {
    let folder = Folder::new();
    fs::write(folder.path("p.ngc"), "G01 X0.006 F60\nG01 X0.012 Y0.004\n").unwrap();
    let ran = folder.run("program p.ngc --method ppc --width f=3 --vcd w.vcd");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.err.contains("line 2: ") && ran.err.contains("--width f="), "{ran:?}");
    assert!(folder.files().contains(&"w.vcd".to_owned()));
    let ran = folder.run("program p.ngc --method ppc --width 2");
    assert_eq!(ran.code, 2, "{ran:?}");
    assert!(ran.err.contains("does not fit"), "{ran:?}");
}

#[test]
fn a_width_whose_blocks_would_not_end_is_refused() {
    let folder = Folder::new();
    fs::write(folder.path("p.ngc"), "G01 X0.006 F60\n").unwrap();
    for (options, bits) in [("dpm --width 64", 64), ("dpm --width 53", 53), ("dda --width 60", 60)] {
        let ran = folder.run(&format!("program p.ngc --method {options} --json r.json"));
        assert_eq!(ran.code, 2, "{ran:?}");
        for hint in [&format!("2^{bits} steps"), "within 2^53 clocks", "--width 52 or less"] {
            assert!(ran.err.contains(hint), "{hint}: {ran:?}");
        }
        assert_eq!(folder.files(), ["p.ngc"]);
    }
    // At the limit the run ends as requested, and normalised integrands take few steps in any width.
    assert_eq!(folder.run("program p.ngc --method dpm --width 52 --max-clocks 9").code, 1);
    folder.good("program p.ngc --method dda --normalize --width 60");
}

#[test]
fn a_feed_that_a_machine_of_programs_does_not_take_is_refused_by_its_name() {
    let folder = Folder::new();
    fs::write(folder.path("p.ngc"), "G01 X0.006 F60\n").unwrap();
    let ran = folder.run("program p.ngc --method ppc --feed 600");
    assert_eq!(ran.code, 2, "{ran:?}");
    assert!(ran.err.contains("ppc does not take --feed; it takes --width"), "{ran:?}");
}
