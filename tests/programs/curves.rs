//! Free curves of programs: G5, G5.1 and a NURBS by every family, as chords and whole.

use stepwave_nc::{ControlPoint, NURBS_UNIT, Nurbs};

use super::command::{FAMILIES, number, report};
use crate::cli::Folder;

/// Lines and chords of the lines of that program, where no hardware takes its curves.
const CHORDS: [usize; 5] = [1, 62, 32, 62, 32];
const CURVES: &str = include_str!("../../examples/curves.ngc");
const OPTIONS: &str = "--blu 0.01mm --clock-hz 2e4";

#[test]
fn every_family_draws_the_chords_of_all_curves_and_ends_each_exactly() {
    for family in FAMILIES {
        let folder = Folder::new();
        let normalized = if family == "dda" { "--normalize" } else { "" };
        let report = report(&folder, CURVES, &format!("--method {family} {OPTIONS} {normalized}"));
        assert_eq!((&report["missed_end_points"], &report["beyond_bound"]), (&0.into(), &0.into()), "{family}");
        assert_eq!(report["reached"], serde_json::json!([1000, 0, 0]), "{family}");
        // The line to the start, and the chords of each curve; one of G5 or G5.1 is one block where the hardware takes it.
        let blocks = report["blocks"].as_array().unwrap();
        let of = |line: u64, kind: &str| {
            blocks.iter().filter(|block| block["line"] == line && block["kind"] == kind).count()
        };
        let whole = family == "dda";
        assert_eq!(
            [3, 7, 8, 9, 10].map(|line| of(line, if line == 3 { "line" } else { "chord" })),
            if whole { [1, 62, 0, 0, 0] } else { CHORDS },
            "{family}"
        );
        assert_eq!([8, 9, 10].map(|line| of(line, "curve")), [usize::from(whole); 3], "{family}");
        let off = number(&report["compensated_contour_error"]["blu"]);
        assert!(off < 2.0, "{family}: {off}");
    }
}

#[test]
fn the_table_names_chords_and_curves() {
    let folder = Folder::new();
    std::fs::write(folder.path("p.ngc"), "G1 F600 X0.4\nG5.1 X1 Y0.6 I0.3 J0.1\nG1 X0 Y0\nM2\n").unwrap();
    for (family, kinds) in [("dda --normalize", ["line", "curve", "line"]), ("ppc", ["line", "chord", "line"])] {
        let out = folder.good(&format!("program p.ngc --method {family} {OPTIONS}"));
        let table = out.lines().filter_map(|line| line.split_whitespace().find(|word| kinds.contains(word)));
        let mut table: Vec<&str> = table.collect();
        table.dedup();
        assert_eq!(table, kinds, "{family}: {out}");
    }
}

/// What is given for hardware of free curves where it is not to be used: an explicit distance of chords, or a ramp in front of the
/// interpolator, whose path has to have as many pulses everywhere.
#[test]
fn chords_that_are_asked_for_and_ramps_have_chords_by_dda_too() {
    let of = |options: &str| {
        let report = report(&Folder::new(), CURVES, &format!("--method dda --normalize {OPTIONS} {options}"));
        assert_eq!((&report["missed_end_points"], &report["beyond_bound"]), (&0.into(), &0.into()), "{options}");
        assert_eq!(report["reached"], serde_json::json!([1000, 0, 0]), "{options}");
        let blocks = report["blocks"].as_array().unwrap();
        (blocks.iter().filter(|block| block["kind"] != "curve").count(), blocks.len())
    };
    assert_eq!(of(""), (63, 66));
    assert_eq!(of("--chords 0.5"), (189, 189));
    assert_eq!(of("--accel 500mm/s2"), (189, 189));
    assert_eq!(of("--accel 500mm/s2 --jerk 20000mm/s3"), (189, 189));
    assert_eq!(of("--ramp after --smooth sum=4 --period 20"), (63, 66));
}

#[test]
fn fewer_chords_are_farther_off() {
    let count = |chords: &str| {
        let report = report(&Folder::new(), CURVES, &format!("--method mindev {OPTIONS} --chords {chords}"));
        report["blocks"].as_array().unwrap().len()
    };
    let counts = ["0.05", "0.5", "5"].map(count);
    assert!(counts[0] > 2 * counts[1] && counts[1] > 2 * counts[2], "{counts:?}");
}

#[test]
fn the_pulses_of_a_nurbs_stay_as_near_as_method_rounding_and_chords_say() {
    let point = |at, weight| ControlPoint { at, weight };
    let points = [point([1000, 0], NURBS_UNIT), point([1000, 1000], 707_106_781), point([0, 1000], NURBS_UNIT)];
    let curve = Nurbs::new(2, &points, None).unwrap();
    // Half a BLU of chords, and ends rounded by half a BLU along both axes.
    for (family, method) in [("mindev", 0.5), ("ppc", 1.0)] {
        let folder = Folder::new();
        folder.write("p.ngc", CURVES);
        let table = folder.good(&format!("program p.ngc --method {family} {OPTIONS} --steps -"));
        let mut lines = table.lines();
        let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
        let [block, x, y] = ["block", "x", "y"].map(|name| columns.iter().position(|column| *column == name).unwrap());
        let (mut steps, mut worst) = (0, 0.0_f64);
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            if cells[block] == "7" {
                let [x, y] = [x, y].map(|column| cells[column].parse().unwrap());
                worst = worst.max(curve.deviation(&[x, y]));
                steps += 1;
            }
        }
        let bound = method + 0.5 + 0.5_f64.sqrt();
        assert!(steps > 1000 && worst > 0.3 && worst <= bound, "{family}: {steps}, {worst}, {bound}");
    }
}
