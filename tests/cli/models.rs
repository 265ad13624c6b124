//! Good runs: every model reaches its end point, and says so.

use super::{Csv, Folder, engines, good};

/// Runs on every engine and wants the same good end; gives what is printed.
fn reaches(words: &str, point: &str) -> String {
    let printed = good(&format!("run {words}"));
    for engine in engines().chain(["auto"]) {
        assert_eq!(good(&format!("run {words} --engine {engine}")), printed, "{words} on {engine}");
    }
    assert!(printed.contains(&format!("end point {point} reached exactly\n")), "{words}: {printed}");
    printed
}

#[test]
fn lines_of_point_by_point_comparison_reach_their_ends_in_every_quadrant() {
    for (to, shown) in [("3,2", "(3, 2)"), ("-3,2", "(-3, 2)"), ("-3,-2", "(-3, -2)"), ("3,-2", "(3, -2)")] {
        for form in ["magnitude", "signed"] {
            reaches(&format!("ppc-line --to {to} --form {form}"), shown);
        }
    }
}

#[test]
fn lines_along_an_axis_take_no_step_off_it() {
    for (to, shown, moves) in [
        ("4,0", "(4, 0)", "X X X X"),
        ("0,3", "(0, 3)", "Y Y Y"),
        ("0,-2", "(0, -2)", "-Y -Y"),
        ("-1,0", "(-1, 0)", "-X"),
    ] {
        for end_point in ["total", "per-axis", "longest"] {
            let words = format!("ppc-line --to {to} --end-point {end_point}");
            reaches(&words, shown);
            assert_eq!(Csv::of(&words).moves(), moves, "{words}");
        }
    }
}

#[test]
fn arcs_of_point_by_point_comparison_reach_their_ends_also_about_a_centre_far_off() {
    reaches("ppc-arc --from 5,0 --to 0,5 --ccw", "(0, 5)");
    reaches("ppc-arc --from 105,-40 --to 97,-44 --center 100,-40 --cw", "(97, -44)");
}

#[test]
fn an_arc_that_ends_where_it_starts_is_a_full_circle() {
    let printed = reaches("ppc-arc --from 3,4 --to 3,4 --cw", "(3, 4)");
    assert!(printed.contains("full circle") && printed.contains("40 steps"), "{printed}");
    reaches("dda-arc --from 5,0 --to 5,0 --ccw --preset half", "(5, 0)");
}

#[test]
fn dda_lines_run_in_two_to_six_axes() {
    let axes = [("x", 8), ("y", 6), ("z", -3), ("a", 5), ("b", 0), ("c", -7)];
    for count in 2..=6 {
        let list =
            |separator: &str| axes[..count].iter().map(|(_, end)| end.to_string()).collect::<Vec<_>>().join(separator);
        let words = format!("dda-line --to {}", list(","));
        reaches(&words, &format!("({})", list(", ")));
        let table = Csv::of(&words);
        for (axis, end) in &axes[..count] {
            assert_eq!(table.column(axis).last(), Some(end), "{words}: {axis}");
            assert_eq!(table.column(&format!("jv{axis}"))[0], end.abs(), "{words}: jv{axis}");
            assert_eq!(table.pulses(axis).len(), usize::try_from(end.abs()).unwrap(), "{words}: pulses of {axis}");
        }
        assert!(axes[count..].iter().all(|(axis, _)| !table.heading.contains(&(*axis).to_owned())), "{words}");
    }
}

#[test]
fn pulse_multipliers_of_every_kind_run_in_two_to_six_axes() {
    for to in ["8,6", "-37,5,0", "99,-1,2,-3,4,-63"] {
        let shown = format!("({})", to.replace(',', ", "));
        for units in ["", " --cascade 3", " --radix 10"] {
            let printed = reaches(&format!("dpm-line --to {to}{units}"), &shown);
            assert!(printed.contains("\npulses off an even rate: x "), "{printed}");
            reaches(&format!("dpm-line --to {to}{units} --override 77"), &shown);
        }
    }
}

#[test]
fn a_line_from_a_start_point_moves_the_machine_from_there() {
    let table = Csv::of("dda-line --from 10,-20 --to 12,-17");
    assert_eq!((table.path()[0], table.path().last()), ((10, -20), Some(&(12, -17))));
    reaches("dda-line --from 10,-20,5 --to 12,-17,5", "(12, -17, 5)");
}

#[test]
fn an_arc_that_comes_to_a_stand_ends_soon_and_says_so() {
    let ran = Folder::new().run("run dda-arc --from 3,7 --to 0,8 --ccw --width 4 --preset zero");
    assert_eq!(ran.code, 1, "{ran:?}");
    let lines: Vec<&str> = ran.err.lines().collect();
    assert!(lines[0].starts_with("stepwave: stalled at (0, 7): no pulse for "), "{ran:?}");
    assert!(lines[0].contains("--preset half"), "{ran:?}");
    assert_eq!(lines[1], "stepwave: the end point (0, 8) was missed: the machine is at (0, 7)");
    // Four bits: after 16 additions without a pulse there will be none. The run may look up only now and then.
    let clocks = ran.out.lines().find_map(|line| line.split_once(" steps in ")?.1.split_once(" clocks"));
    let clocks: u64 = clocks.unwrap().0.parse().unwrap();
    assert!(clocks < 2000, "{clocks} clocks");
}

#[test]
fn the_preset_that_the_message_advises_brings_that_arc_to_its_end() {
    reaches("dda-arc --from 3,7 --to 0,8 --ccw --width 4 --preset half", "(0, 8)");
    // It is the default.
    reaches("dda-arc --from 3,7 --to 0,8 --ccw --width 4", "(0, 8)");
}

#[test]
fn an_end_point_missed_by_a_total_counter_is_exit_code_1() {
    // (1, 5) lies off the circle through (6, 0).
    let ran = Folder::new().run("run ppc-arc --from 6,0 --to 1,5 --ccw --end-point total");
    assert_eq!(ran.code, 1);
    assert_eq!(ran.err, "stepwave: the end point (1, 5) was missed: the machine is at (2, 6)\n");
    reaches("ppc-arc --from 6,0 --to 1,5 --ccw", "(1, 5)");
}

#[test]
fn conics_and_helices_of_the_dda_reach_their_ends_in_every_orientation() {
    for direction in ["--cw", "--ccw"] {
        let words = format!("dda-conic --ellipse 6,4 --center 10,-3 --from 16,-3 --to 4,-3 {direction}");
        reaches(&words, "(4, -3)");
        reaches(&format!("{words} --preset half --normalize"), "(4, -3)");
        let words = format!("dda-helix --center 1,2 --from 6,2,-5 --to 6,2,20 {direction}");
        let printed = reaches(&words, "(6, 2, 20)");
        assert!(printed.contains("pulses x 20, y 20, z 25"), "{printed}");
    }
    for (opens, to, shown) in
        [("+x", "9,6", "(9, 6)"), ("-x", "-9,-6", "(-9, -6)"), ("+y", "6,9", "(6, 9)"), ("-y", "-6,-9", "(-6, -9)")]
    {
        reaches(&format!("dda-conic --parabola 4 --opens {opens} --to {to}"), shown);
    }
    reaches("dda-conic --hyperbola 3,3 --from 5,4 --to 3,0", "(3, 0)");
}

#[test]
fn compare_has_a_row_for_each_form_of_the_dda() {
    let rows = |words: &str| -> Vec<String> {
        let printed = good(&format!("compare {words}"));
        assert!(printed.lines().skip(1).all(|line| line.ends_with("exact")), "{printed}");
        let name = |line: &str| line.split("  ").next().unwrap().to_owned();
        printed.lines().map(name).filter(|name| name.starts_with("dda-")).collect()
    };
    let lines = ["", " --preset half", " --preset half --normalize", " --radix 10", " --adder serial"];
    let machines = ["", " --preset zero", " --normalize"].map(|form| format!("dda-machine{form}")).to_vec();
    let lines: Vec<String> = lines.iter().map(|form| format!("dda-line{form}")).collect();
    assert_eq!(rows("--to 100,62"), [lines, machines.clone()].concat());
    // Those of curves start from half by default.
    assert_eq!(
        rows("--ellipse 6,4 --from 6,0 --to 0,4 --ccw"),
        ["dda-conic", "dda-conic --preset zero", "dda-conic --normalize"]
    );
    let helices = ["dda-helix", "dda-helix --preset zero"].map(str::to_owned);
    assert_eq!(rows("--from 5,0,0 --to 0,5,3 --ccw"), [helices.to_vec(), machines].concat());
}

#[test]
fn compare_names_what_it_leaves_out() {
    // f of cim-conic would add numbers of 64 bits: a²b is about 2^60, and F has two bits more.
    let printed = good("compare --hyperbola 1000000,1000000 --from 1000000,0 --to 1000000,100");
    assert!(printed.contains("\nppc-conic ") && !printed.contains("\ncim-conic "), "{printed}");
    for form in ["", " --beats 1"] {
        assert!(printed.contains(&format!("\nLeft out: cim-conic{form}: these registers are too wide")), "{printed}");
    }
}

#[test]
fn conics_with_long_axes_run_or_are_refused_with_the_limit() {
    // F of a parabola is about c; that of the others, about a²b twice, has more than 64 bits.
    reaches("ppc-conic --parabola 1099511627776 --from 0,0 --to 1,100", "(1, 100)");
    for words in [
        "cim-conic --ellipse 2000000,1500000 --from 2000000,0 --to 0,1500000 --ccw",
        "ppc-conic --ellipse 67108864,67108864 --from 67108864,0 --to 0,67108864 --ccw",
        "ppc-conic --hyperbola 3000000,3000000 --from 3000000,0 --to 5000000,4000000",
    ] {
        let ran = Folder::new().run(&format!("run {words}"));
        assert!(ran.code == 2 && ran.err.contains("a register holds 1 to 64 bits"), "{words}: {ran:?}");
    }
}
