//! Every choice of hardware has its effect.

use serde_json::{Value, json};

use super::{Csv, good, report};

fn widths(words: &str) -> Value {
    report(words)["widths"].take()
}

#[test]
fn without_a_width_every_register_has_the_least_that_holds_the_geometry() {
    assert_eq!(widths("ppc-line --to 6,4"), json!({ "xe": 3, "ye": 3, "f": 4, "e": 4, "x": 5, "y": 5 }));
    // 8 does not fit in 3 bits.
    let wide = json!({ "jvx": 4, "jvy": 4, "jrx": 4, "jry": 4, "e": 5, "x": 6, "y": 5 });
    assert_eq!(widths("dda-line --to 8,6"), wide);
}

#[test]
fn one_width_is_that_of_all_magnitude_registers() {
    let wide = widths("ppc-line --to 6,4 --width 8");
    assert_eq!([&wide["xe"], &wide["ye"], &wide["f"], &wide["e"]], [8, 8, 9, 9]);
    let wide = widths("ppc-arc --from 5,0 --to 0,5 --ccw --width 7");
    assert_eq!([&wide["xi"], &wide["yi"], &wide["f"], &wide["e"]], [7, 7, 9, 10]);
}

#[test]
fn named_widths_are_those_of_single_registers_and_of_each_axis() {
    let wide = widths("ppc-line --to 6,4 --width f=9 --width e=7,x=12");
    assert_eq!([&wide["xe"], &wide["f"], &wide["e"], &wide["x"]], [3, 9, 7, 12]);
    let wide = widths("dda-line --to 8,6,1 --width jr=6,e=7");
    assert_eq!([&wide["jrx"], &wide["jry"], &wide["jrz"], &wide["jvx"]], [6, 6, 6, 4]);
    let wide = widths("ppc-line --to 6,4 --end-point per-axis --width e=9");
    assert_eq!([&wide["ex"], &wide["ey"]], [9, 9]);
}

#[test]
fn wider_remainders_mean_more_iterations() {
    let table = Csv::of("dda-line --to 8,6 --width 5");
    assert_eq!(table.rows.len(), 1 + 32);
    assert_eq!(table.pulses("x"), [4, 8, 12, 16, 20, 24, 28, 32]);
}

#[test]
fn the_preset_is_what_the_remainders_start_from_and_return_to() {
    for (preset, jrx, jry, first_x) in
        [("zero", 0, 0, 2), ("half", 8, 8, 1), ("full", 15, 15, 1), ("5", 5, 5, 2), ("jrx=3,jry=12", 3, 12, 2)]
    {
        let table = Csv::of(&format!("dda-line --to 8,6 --preset {preset}"));
        for (name, start) in [("jrx", jrx), ("jry", jry)] {
            let column = table.column(name);
            assert_eq!((column[0], column[16]), (start, start), "{preset}: {name}");
        }
        assert_eq!(table.pulses("x")[0], first_x, "{preset}");
        assert_eq!(table.path().last(), Some(&(8, 6)), "{preset}");
    }
}

#[test]
fn decimal_registers_hold_decimal_digits_and_are_reported_as_numbers() {
    let words = "dda-line --to 58,6 --radix 10 --preset half";
    let table = Csv::of(words);
    assert_eq!((table.column("jvx")[0], table.column("jrx")[0], table.rows.len()), (58, 50, 1 + 100));
    assert_eq!(table.column("jrx")[1], 8);
    let report = report(words);
    assert_eq!(report["widths"], json!({ "jvx": 8, "jvy": 8, "jrx": 8, "jry": 8, "e": 7, "x": 8, "y": 5 }));
    let register = |name: &str| {
        let registers = report["registers"].as_array().unwrap();
        let found = registers.iter().find(|register| register["name"] == name).unwrap();
        ["radix", "least", "greatest", "needed_width"].map(|field| found[field].as_i64().unwrap())
    };
    assert_eq!(register("jvx"), [10, 0, 58, 8]);
    assert_eq!(register("jvy"), [10, 0, 6, 4]);
    assert_eq!(register("e"), [2, 0, 100, 7]);
    // Digits show as such in binary too.
    assert!(good("run dda-line --to 8,6 --radix 10 --bits").contains(" 1000"));
}

#[test]
fn a_serial_adder_makes_the_same_table_in_as_many_more_clocks_as_there_are_bits() {
    for words in ["dda-line --to 8,6 --width 5", "dda-line --to 83,-6,40 --radix 10 --end-point per-axis"] {
        let [parallel, serial] = ["", " --adder serial"].map(|adder| Csv::of(&format!("{words}{adder}")));
        let clocks = |table: &Csv| *table.column("clock").last().unwrap() - 1;
        let digits = if words.contains("radix") { 2 } else { 5 };
        assert_eq!(clocks(&serial), digits * clocks(&parallel), "{words}");
        for name in parallel.heading.iter().filter(|name| *name != "clock") {
            assert_eq!(serial.column(name), parallel.column(name), "{words}: {name}");
        }
    }
}

#[test]
fn single_presets_win_over_the_one_for_all() {
    let table = Csv::of("dda-line --to 8,6 --preset half --preset jry=1");
    assert_eq!((table.column("jrx")[0], table.column("jry")[0]), (8, 1));
}

#[test]
fn normalised_integrands_stand_at_the_top_of_their_registers_and_need_fewer_iterations() {
    // 3 = 0011 in four bits goes up to 1100; 16 iterations become 4.
    let table = Csv::of("dda-line --to 3,2 --width 4 --normalize");
    assert_eq!((table.column("jvx")[0], table.column("jvy")[0], table.rows.len()), (12, 8, 1 + 4));
    assert_eq!((table.pulses("x"), table.pulses("y")), (vec![2, 3, 4], vec![2, 4]));
    assert_eq!(Csv::of("dda-line --to 3,2 --width 4").rows.len(), 1 + 16);
    // On an arc the second highest bit is to be set, and corrections grow alike: 5 = 000101 goes up to 010100.
    let table = Csv::of("dda-arc --from 5,0 --to 0,5 --ccw --width 6 --normalize");
    assert_eq!((table.column("jvy")[0], table.column("unit")[0]), (20, 4));
}

#[test]
fn the_end_point_choice_is_the_counter_that_ends_the_block() {
    for (words, counters) in [
        ("ppc-line --to 6,4 --end-point total", vec![("e", 10)]),
        ("ppc-line --to 6,4 --end-point longest", vec![("e", 6)]),
        ("ppc-line --to 6,4 --end-point per-axis", vec![("ex", 6), ("ey", 4)]),
        ("ppc-arc --from 5,0 --to 0,5 --ccw --end-point total", vec![("e", 10)]),
        ("ppc-arc --from 5,0 --to 0,5 --ccw --end-point per-axis", vec![("ex", 5), ("ey", 5)]),
        ("dda-line --to 8,6 --end-point iterations", vec![("e", 16)]),
        ("dda-line --to 8,6 --end-point total", vec![("e", 14)]),
        ("dda-line --to 8,6 --end-point longest", vec![("e", 8)]),
        ("dda-line --to 8,6 --end-point per-axis", vec![("ex", 8), ("ey", 6)]),
        ("dda-arc --from 5,0 --to 0,5 --ccw --end-point per-axis", vec![("ex", 5), ("ey", 5)]),
        ("dda-arc --from 5,0 --to 0,5 --ccw --end-point total --preset half", vec![("e", 10)]),
    ] {
        let table = Csv::of(words);
        let shown = ["e", "ex", "ey"].into_iter().filter(|name| table.heading.iter().any(|heading| heading == name));
        let loaded: Vec<(&str, i64)> = shown.map(|name| (name, table.column(name)[0])).collect();
        assert_eq!(loaded, counters, "{words}");
        assert!(counters.iter().all(|(name, _)| table.column(name).last() == Some(&0)), "{words}");
    }
}

#[test]
fn an_arc_that_ends_off_its_circle_is_counted_per_axis_by_default() {
    assert_eq!(report("ppc-arc --from 6,0 --to 1,5 --ccw")["choices"]["end_point"], "per-axis");
    assert_eq!(report("ppc-arc --from 6,0 --to 0,6 --ccw")["choices"]["end_point"], "total");
}

#[test]
fn the_two_forms_of_a_line_part_where_f_is_0_in_quadrant_2() {
    let path = |form: &str| Csv::of(&format!("ppc-line --from -1,1 --to -4,2{form}")).path();
    assert_eq!(path(" --form signed")[1], (-1, 2));
    assert_eq!(path(" --form magnitude")[1], (-2, 1));
    assert_eq!(path(""), path(" --form magnitude"));
}

#[test]
fn one_beat_makes_a_step_of_each_clock() {
    let clocks = |words: &str| report(&format!("ppc-line --to 6,4{words}"))["clocks"].take();
    assert_eq!((clocks(""), clocks(" --beats 4"), clocks(" --beats 1")), (json!(41), json!(41), json!(11)));
}

#[test]
fn clock_and_blu_scale_the_feed() {
    let feed = |words: &str| report(&format!("ppc-line --to 6,4{words}"))["feed"]["mean_mm_per_min"].as_f64().unwrap();
    // sqrt(52) BLU of 1 um in 40 clocks of 1 us: ten steps of four; the clock that loads is none of them.
    let usual = 60.0 * 52f64.sqrt() * 0.001 * 1e6 / 40.0;
    for (words, factor) in [
        ("", 1.0),
        (" --clock-hz 2e6", 2.0),
        (" --blu 0.01mm", 10.0),
        (" --blu 5um", 5.0),
        (" --blu 0.0001in", 2.54),
        (" --clock-hz 500000 --blu 2um", 1.0),
    ] {
        let expected = factor * usual;
        assert!((feed(words) - expected).abs() < 1e-9 * expected, "{words}: {} instead of {expected}", feed(words));
    }
}

#[test]
fn no_clock_that_loads_counts_in_the_feed() {
    let feed = |words: &str| report(words)["feed"]["mean_mm_per_min"].as_f64().unwrap();
    // 10 BLU in 16 iterations of a clock each; and by two axes, once around: three more blocks are loaded, in two clocks
    // each, which is a part of the motion.
    assert_eq!(feed("dda-line --to 8,6 --width 4"), 37_500.0);
    let arc = report("dda-arc --from 5,0 --to 5,0 --ccw --width 4");
    let (clocks, steps) = (&arc["feed"]["clocks"], &arc["steps"]);
    assert_eq!(clocks.as_u64().unwrap(), steps.as_u64().unwrap() + 2 * 3);
    let mean = 60.0 * std::f64::consts::TAU * 5.0 * 1e3 / clocks.as_f64().unwrap();
    assert!((feed("dda-arc --from 5,0 --to 5,0 --ccw --width 4") - mean).abs() < 1e-9 * mean);
}

#[test]
fn the_report_names_the_choices_and_the_engine() {
    let words = "dda-line --to 3,2 --width 4 --preset half --normalize --adder serial --end-point total \
                 --on-overflow wrap --engine gates";
    let report = report(words);
    let choices = json!({
        "preset": "half",
        "normalize": "yes",
        "radix": 2,
        "adder": "serial",
        "end_point": "total",
        "on_overflow": "wrap",
    });
    assert_eq!(report["choices"], choices);
    assert_eq!(report["engine"], "gates");
}
