//! Ramps: how they are given, what an operator does, and what is refused.

use serde_json::Value;

use super::{Folder, good, refused};

#[test]
fn twelve_pulses_are_the_worked_table() {
    let table = good("run ramp --to 12 --steps -");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "step,clock,phase,v,e,dx,x");
    assert_eq!(lines[20], "19,20,192,128,3,0,9");
    assert_eq!(lines[27], "26,27,32,64,0,1,12");
    assert_eq!(lines.len(), 28);
}

#[test]
fn units_become_words_of_the_least_width_with_which_an_acceleration_is_128() {
    let run = "run ramp --to 3 --accel 500mm/s2 --speed 2400mm/min --clock-hz 1e6 --blu 1um --json -";
    let report: serde_json::Value = serde_json::from_str(&good(run)).unwrap();
    // 5e5·2^n/1e12 is 128 from n = 28 on; 4e4·2^28/1e6; the greatest start is below the square root of 134·2^28.
    assert_eq!(report["widths"]["v"], 28, "{report}");
    assert_eq!(report["choices"]["accel"], 134);
    let start = (134.0 * 2f64.powi(28)).sqrt().floor();
    assert_eq!(report["choices"]["speed"], format!("vc=10737418,ve={start},vs={start}"));
    assert_eq!(report["end_point"]["exact"], true);
}

#[test]
fn what_the_operator_does_is_in_force_at_the_next_edge() {
    let held = good("run ramp --to 12 --event 9:hold --event 17:resume --steps -");
    let v: Vec<&str> = held.lines().skip(1).map(|line| line.split(',').nth(3).unwrap()).collect();
    assert_eq!(v[8..19], ["144", "128", "112", "96", "80", "64", "0", "0", "0", "64", "80"]);
    assert_eq!(v.len(), 34);
    let slow = good("run ramp --to 12 --event 0:override=50 --steps -");
    assert!(slow.lines().skip(3).all(|line| line.split(',').nth(3) <= Some("72")), "{slow}");
    let report: serde_json::Value =
        serde_json::from_str(&good("run ramp --to 12 --event 9:hold --event 17:resume --json -")).unwrap();
    assert_eq!(report["events"], serde_json::json!(["9:hold", "17:resume"]));
}

#[test]
fn a_start_is_not_lost_with_one_just_before_it() {
    let folder = Folder::new();
    folder.write("p.ngc", "G21 G91 G1 X1 F2400\nX1\nX1\n");
    let run = "program p.ngc --method bresenham --accel 500mm/s2 --blu 0.01mm --clock-hz 2e4 --event 0:single";
    let ran = folder.run(&format!("{run} --event 3001:start --event 3000:start --event 9:start --event 6000:start"));
    assert_eq!(ran.code, 0, "{ran:?}");
}

#[test]
fn a_program_that_nobody_starts_says_what_it_waits_for() {
    let folder = Folder::new();
    folder.write("p.ngc", "G21 G91 G1 X1 F2400\n");
    let ran = folder.run("program p.ngc --method ppc --accel 500mm/s2 --blu 0.01mm --clock-hz 2e4 --event 0:single");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.err.contains("stepwave: stalled at (0, 0, 0)") && ran.err.contains("CLOCK:start"), "{ran:?}");
    assert!(ran.out.contains("given up after 0 moves") && !ran.out.contains("reached exactly"), "{ran:?}");
}

#[test]
fn an_acceleration_with_a_unit_has_a_speed_with_one() {
    let report: serde_json::Value = serde_json::from_str(&good("run ramp --to 3 --accel 500mm/s2 --json -")).unwrap();
    assert_eq!(report["choices"]["speed"].as_str().unwrap().split(',').next(), Some("vc=10737418"), "{report}");
}

#[test]
fn a_hold_without_an_end_stalls() {
    let ran = Folder::new().run("run ramp --to 12 --event 9:hold");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.out.contains("stalled at (6)"), "{ran:?}");
}

#[test]
fn what_cannot_be_is_refused_with_a_remedy() {
    for (command, hints) in [
        ("run ramp --to 12 --speed 300 --width 8", &["300", "255", "--width 9"][..]),
        ("run ramp --to 12 --speed vs=200,vc=144", &["vs=200", "between 1 and vc, which is 144"]),
        ("run ramp --to 12 --speed v=3", &["'v'", "vs=, vc= or ve="]),
        ("run ramp --to 12 --accel 16,8 --brake count", &["16,8", "--brake count"]),
        ("run ramp --to 12 --speed vs=3,ve=4 --brake count", &["vs=3,ve=4"]),
        ("run ramp --to 12 --jerk 2 --brake count", &["count", "S curve"]),
        ("run ramp --to 12 --accel 5mm", &["'5mm'", "mm/s2"]),
        ("run ramp --to 12 --accel 1e-9mm/s2 --width 8", &["0 in registers of 8 bits"]),
        ("run ramp --to 12 --width 60", &["phase of 60 bits", "--width 54"]),
        ("run ramp --to 12 --accel 0.001mm/s2 --clock-hz 1e9 --speed 1mm/s", &["54 bits", "--clock-hz"]),
        ("run ramp --to 12 --width v=9,phase=8", &["v of 9 bits", "phase has 8"]),
        ("run ramp --to 12,5", &["one axis", "a line of 2 axes"]),
        ("run dda-line --to 12", &["2 to 6 axes", "a displacement of one axis"]),
        ("run ramp --to 12 --event 9:stop", &["'9:stop'", "9", "hold"]),
        ("run ramp --to 12 --event 9:override=300", &["300", "0 to 200"]),
        ("run ramp --to 12 --event 9:single", &["single", "program"]),
        ("run ppc-line --to 5,3 --event 9:hold", &["ppc-line", "hold"]),
        ("run dda-machine --to 12,5 --jerk 9mm/s3", &["9mm/s3", "--accel"]),
        ("run dda-machine --to 12,5 --accel 16", &["16", "500mm/s2"]),
        ("run dda-line --to 12,5 --accel 500mm/s2", &["dda-line does not take --accel"]),
        ("run dda-machine --to 12,5 --accel 1e-30mm/s2", &["54 bits", "--clock-hz"]),
        ("run ramp-after --to 60 --width rem=1", &["rem of 1", "--width rem=2"]),
        ("run ramp-after --to 60 --smooth sum=65", &["'sum=65'", "sum=64"]),
        ("run ramp-after --to 60 --step 1.5", &["1.5", "whole BLU"]),
        ("sweep ramp --to 12,3 --csv -", &["displacements of one axis", "2 coordinates"]),
    ] {
        refused(command, hints);
    }
}

#[test]
fn a_machine_without_filters_says_nothing_of_them() {
    let of = |words: &str| -> (Value, String) {
        let folder = Folder::new();
        let json = folder.good(&format!("run dda-machine --to 8,6,2 {words} --json - --vcd m.vcd"));
        (serde_json::from_str(&json).unwrap(), folder.read("m.vcd"))
    };
    let (report, wave) = of("");
    assert!(report["choices"]["smooth"].is_null() && report["choices"]["period"].is_null(), "{report}");
    assert_eq!(report["choices"]["ramp"], "before");
    assert!(!wave.contains("smooth"), "{}", &wave[..400]);
    let (report, wave) = of("--ramp after --smooth sum=2 --period 16");
    assert_eq!((&report["choices"]["smooth"], &report["choices"]["period"]), (&"sum=2".into(), &16.into()));
    assert!(wave.contains("ramp after; smooth sum=2; period 16"), "{}", &wave[..400]);
}
