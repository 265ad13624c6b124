//! NURBS: how they are given, what is reported, and what is refused.

use serde_json::Value;

use super::{Folder, good, refused, run_refused};

const QUARTER: &str = "--nurbs 1000,0,1,1000,1000,0.707106781,0,1000,1 --degree 2";
const SAMPLED: &str = "--step 200 --fraction 16 --tolerance 10";

#[test]
fn a_quarter_circle_gives_the_worked_step_table() {
    let table = good(&format!("run sampled-spline {QUARTER} {SAMPLED} --steps -"));
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines[0], "step,clock,u,cx,cy,jvx,jrx,jvy,jry,dx,dy,x,y");
    assert!(lines[2].contains(",607399444,64125589,13526509,"), "{}", lines[2]);
    assert!(lines[9].contains(",4294967296,0,65536000,") && lines[9].ends_with(",0,1000"), "{}", lines[9]);
}

#[test]
fn points_come_from_a_file_with_or_without_a_heading_and_knots_are_uniform_by_default() {
    let folder = Folder::new();
    folder.write("a.csv", "X,Y,W\n1000,0,1\n1000, 1000, 0.707106781\n\n0,1000,1\n");
    folder.write("b.csv", "1000,0,1\n1000,1000,0.7071067811865\n0,1000,1");
    let ran = |given: &str| folder.run(&format!("run sampled-spline --nurbs {given} {SAMPLED} --steps -"));
    let inline = ran("1000,0,1,1000,1000,0.707106781,0,1000,1 --degree 2 --knots 0,0,0,1,1,1");
    assert!(inline.code == 0, "{inline:?}");
    // Three points have the degree 2.
    assert_eq!([ran("a.csv"), ran("b.csv --degree 2")], [inline.clone(), inline]);
}

#[test]
fn the_report_has_the_curve_the_chord_error_and_the_command_that_repeats_it() {
    let run = format!("run sampled-spline {QUARTER} {SAMPLED}");
    let report: Value = serde_json::from_str(&good(&format!("{run} --json -"))).unwrap();
    let geometry = &report["geometry"];
    assert_eq!(geometry["curve"], "NURBS");
    assert_eq!(geometry["weights"].to_string(), "[1.0,0.707106781,1.0]");
    assert_eq!(geometry["knots"], serde_json::json!([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]));
    let chord = report["sampling"]["chord_error"].as_f64().unwrap();
    assert!(chord > 5.0 && chord < 6.0, "{chord}");
    let summary = good(&run);
    assert!(summary.contains("chord error at the middle of a period's parameters: 5.712465 BLU"), "{summary}");
    assert!(summary.contains("NURBS (1000, 0), (1000, 1000), (0, 1000), degree 2, with weights"), "{summary}");
}

#[test]
fn a_bezier_curve_is_a_nurbs_of_one_span() {
    let by = |curve: &str| good(&format!("run sampled-spline {curve} --clock-hz 2000000 --steps -"));
    assert_eq!(by("--bezier 0,0,40,0,80,40,80,80"), by("--nurbs 0,0,1,40,0,1,80,40,1,80,80,1 --knots 0,0,0,0,1,1,1,1"));
}

#[test]
fn what_is_not_a_nurbs_is_refused() {
    run_refused("sampled-spline", &["the curve is missing", "--nurbs", "--bezier"]);
    run_refused("sampled-spline --to 5,3", &["the curve is missing", "--nurbs"]);
    run_refused("sampled-spline --nurbs 0,0,1,5", &["4 numbers", "X,Y,W of each point"]);
    run_refused("sampled-spline --nurbs 0,0,1", &["2 to 1024 points", "1 were given"]);
    run_refused("sampled-spline --nurbs 0,0.5,1,4,4,1", &["0.5", "whole numbers of BLU"]);
    run_refused("sampled-spline --nurbs 0,0,1,4,4,-1", &["point 2 has the weight -1", "more than 0"]);
    run_refused("sampled-spline --nurbs 0,0,1,4,4,1 --degree 2", &["the degree 2", "from 1 to 1"]);
    run_refused("sampled-spline --nurbs 0,0,1,4,4,1 --knots 0,0,1", &["3 knots", "= 4"]);
    run_refused("sampled-spline --nurbs 0,0,1,4,4,1 --knots 0,x", &["--knots", "'x'"]);
    run_refused("sampled-spline --nurbs no.csv", &["no.csv", "cannot be read", "x,y,w"]);
    run_refused("sampled-spline --bezier 0,0,4,4", &["4 numbers", "three or four points"]);
    run_refused("sampled-spline --bezier 0,0,4,0,8,8 --degree 2", &["--degree", "out"]);
    run_refused("dda-arc --from 5,0 --to 0,5 --ccw --knots 1", &["--nurbs"]);
    for option in ["--to 8,4", "--from 1,1", "--cw", "--center 1,1", "--opens +x", "--b-spline"] {
        let name = option.split(' ').next().unwrap();
        run_refused(&format!("sampled-spline --nurbs 0,0,1,4,4,1 {option}"), &[name]);
    }
    run_refused("spline-dda --nurbs 0,0,1,4,4,1", &["the curve is missing", "--bezier"]);
    refused("widths sampled-spline --box 0..4x0..4", &["given in bits"]);
}

#[test]
fn the_file_of_points_is_never_written_over() {
    let folder = Folder::new();
    folder.write("p.csv", "0,0,1\n40,9,1\n");
    let ran = folder.run("run sampled-spline --nurbs p.csv --steps p.csv");
    assert!(ran.code == 2 && ran.err.contains("p.csv"), "{ran:?}");
}

#[test]
fn a_recorded_case_has_its_file_in_the_folder() {
    let folder = Folder::new();
    folder.write("p.csv", "0,0,1\n40,9,1\n");
    folder.write("cases.toml", "[[case]]\nname = \"line\"\nargs = [\"sampled-spline\", \"--nurbs\", \"p.csv\"]\n");
    for what in ["record", "check"] {
        let ran = folder.run(&format!("golden {what} ."));
        assert_eq!(ran.code, 0, "{ran:?}");
    }
}

/// From one side of the origin to the other a period is longer than any coordinate.
#[test]
fn a_period_may_be_longer_than_the_coordinates() {
    let run = "run sampled-spline --degree 1 --clock-hz 5e6 --steps - --nurbs";
    for (points, step, places) in [
        ("-30,0,1,30,0,1,-30,0,1", "60", &["-30", "30", "-30"][..]),
        ("-500,0,1,500,0,1", "520", &["-500", "20", "500"]),
    ] {
        let table = good(&format!("{run} {points} --step {step}"));
        let x: Vec<&str> = table.lines().skip(1).map(|line| line.rsplit(',').nth(1).unwrap()).collect();
        assert_eq!(x, places, "{points}");
    }
}

#[test]
fn the_length_of_a_line_is_right_whatever_its_weights() {
    let run = "run sampled-spline --degree 1 --clock-hz 5e6 --step 20 --json - --nurbs 0,0,1,300,400";
    for weight in ["1000", "50", "0.01"] {
        let report: serde_json::Value = serde_json::from_str(&good(&format!("{run},{weight}"))).unwrap();
        let length = report["feed"]["length"].as_f64().unwrap();
        assert!((length - 500.0).abs() < 1e-6, "{weight}: {length}");
    }
}

#[test]
fn numbers_too_long_for_the_registers_are_refused_with_a_fraction_that_fits() {
    let curve = "--nurbs 0,0,1000000,1,1,1000000 --degree 1 --step 1000 --knots 0,0,1000000,1000000";
    let hints = ["194 bits, but 192 fit", "--fraction 33 or less"];
    super::refused(&format!("run sampled-spline {curve} --fraction 34"), &hints);
    good(&format!("run sampled-spline {curve} --fraction 33"));
}

#[test]
fn compensation_does_not_end_on_a_chord_of_a_free_curve() {
    let folder = Folder::new();
    for end in ["G40\nG5.1 X30 Y5 I10 J0.2", "G40 G5.1 X30 Y5 I10 J0.2", "G40\nG5 X30 Y5 I10 J0 P-9 Q0"] {
        folder.write("p.ngc", &format!("G21 G90 G17 F600\nG41 D1 G1 X5 Y5\nG1 X10\n{end}\nM2\n"));
        let ran = folder.run("program p.ngc --method mindev --blu 0.01mm --clock-hz 1e6 --tool 1=1mm --chords 5");
        assert!(ran.code == 2 && ran.err.contains("the straight move that ends it"), "{end}: {ran:?}");
    }
    folder.write("p.ngc", "G21 G90 G17 F600\nG41 D1 G1 X5 Y5\nG1 X10\nG40 G1 X13\nG5.1 X30 Y5 I10 J0.2\nM2\n");
    let ran = folder.run("program p.ngc --method mindev --blu 0.01mm --clock-hz 1e6 --tool 1=1mm");
    assert_eq!(ran.code, 0, "{ran:?}");
}

/// A period is a step of many pulses, which go farther off than where they lead.
#[test]
fn the_picture_has_the_error_between_steps() {
    let folder = Folder::new();
    folder.good(&format!("run sampled-spline {QUARTER} {SAMPLED} --plot p.svg"));
    let picture = std::fs::read_to_string(folder.path("p.svg")).unwrap();
    assert!(
        picture.contains("greatest deviation 0.540 BLU, step 1 at (978, 206); between steps 5.975 BLU"),
        "{picture}"
    );
    folder.good("run ppc-line --to 100,62 --plot q.svg");
    assert!(!std::fs::read_to_string(folder.path("q.svg")).unwrap().contains("between steps"));
}

#[test]
fn widths_of_a_box_are_sampled_hold_single_runs_and_name_a_run_that_needs_them() {
    let folder = Folder::new();
    let json = |words: &str| serde_json::from_str::<Value>(&folder.good(words)).unwrap();
    let found = json("widths sampled-spline --box 2 --json");
    assert_eq!((&found["all"], &found["ran"]), (&false.into(), &found["geometries"]));
    let registers = found["registers"].as_array().unwrap();
    let names: Vec<&str> = registers.iter().map(|register| register["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["jrx", "jry", "jvx", "jvy", "x", "y"]);
    assert!(registers.iter().all(|register| register["known"] == "sampled"), "{found}");
    let bound = |register: &Value, end: &str| register[end].as_i64().unwrap();
    let own = |report: &Value, name: &str| {
        let own = report["registers"].as_array().unwrap().iter().find(|register| register["name"] == name).unwrap();
        ["least", "greatest"].map(|end| bound(own, end))
    };
    // Curves of the box, by their points.
    for points in ["0,0,-3,0,3,0,3,0", "3,3,3,-3,-3,3,-3,-3", "0,-3,0,3,0,-3,0,3", "-3,0,3,0,-3,0,3,0"] {
        let report = json(&format!("run sampled-spline --bezier {points} --fraction 10 --json -"));
        for register in registers {
            let [least, greatest] = own(&report, register["name"].as_str().unwrap());
            let held = (bound(register, "least")..=bound(register, "greatest")).contains(&least)
                && greatest <= bound(register, "greatest");
            assert!(held, "{points}: {least} to {greatest} is beyond {register}");
        }
    }
    for (register, name) in registers.iter().zip(names) {
        let Some(below) = register["one_bit_below"].as_str() else { continue };
        let below = below.trim_start_matches("stepwave ");
        assert_ne!(folder.run(below).code, 0, "{below}");
        let needed = bound(register, "needed");
        let narrow = format!(" --width {name}={}", needed - 1);
        assert!(below.contains(&narrow), "{below}");
        let [least, greatest] = own(&json(&format!("{} --json -", below.replace(&narrow, ""))), name);
        // Positions have a sign.
        let magnitude = needed - i64::from(["x", "y"].contains(&name));
        let fits = |bits: i64| greatest < 1 << bits && least >= if magnitude < needed { -(1 << bits) } else { 0 };
        assert!(fits(magnitude) && !fits(magnitude - 1), "{name}: {least} to {greatest} in {needed} bits");
    }
    assert!(registers.iter().filter(|register| register["one_bit_below"].is_string()).count() >= 4, "{found}");
    // What is given is judged, and no box of such curves is proved by running it.
    let judged = folder.run("widths sampled-spline --box 1 --width x=1");
    assert!(judged.code == 1 && judged.err.contains("x of 1 bit is too narrow, it needs 2"), "{judged:?}");
    refused("prove sampled-spline --box 1", &["no box of sampled-spline is simulated whole", "`stepwave widths"]);
}
