//! What a run says of its registers: bits that never toggled, ends of ranges, and warnings from values that were
//! reached.

use serde_json::{Value, json};

use super::{Folder, engines, good};

/// The report of a run, with any result.
fn report(words: &str) -> Value {
    let folder = Folder::new();
    folder.run(&format!("run {words} --json r.json"));
    serde_json::from_str(&folder.read("r.json")).unwrap()
}

/// A field of the registers of a report, by name.
fn field(report: &Value, name: &str, field: &str) -> Value {
    let registers = report["registers"].as_array().unwrap();
    registers.iter().find(|register| register["name"] == name).unwrap()[field].clone()
}

/// The lines of a summary that speak of registers.
fn range_lines(printed: &str) -> Vec<&str> {
    let begins = ["bits needed", "needed bits", "one unit", "warning"];
    printed.lines().filter(|line| begins.iter().any(|begin| line.starts_with(begin))).collect()
}

#[test]
fn every_bit_that_never_toggled_is_reported_with_its_value() {
    // All values are known from the step table in the README: J_RY is 0, 6, 12, 2, 8 and so on, always even.
    for engine in engines() {
        let report = report(&format!("dda-line --to 8,6 --width 4 --engine {engine}"));
        for (register, bits) in [
            ("jvx", "-000"),
            ("jvy", "0--0"),
            ("jrx", "-000"),
            ("jry", "---0"),
            ("e", "-----"),
            ("x", "00----"),
            ("y", "00---"),
        ] {
            assert_eq!(field(&report, register, "stuck_bits"), bits, "{register} on {engine}");
        }
    }
    // 0000 after reset, then -3 = 1101, at last -4 = 1100.
    let report = report("ppc-line --from -3,0 --to -4,0");
    assert_eq!((field(&report, "x", "least"), field(&report, "x", "stuck_bits")), (json!(-4), json!("--0-")));
}

#[test]
fn the_summary_says_only_what_the_needed_bits_do_not_say() {
    assert_eq!(
        range_lines(&good("run dda-line --to 8,6 --width 4")),
        [
            "bits needed/given: jvx 4/4, jvy 3/4, jrx 4/4, x 5/6, jry 4/4, y 4/5, e 5/5",
            "needed bits that never toggled: jrx[2:0] at 0, jry[0] at 0",
        ]
    );
    // The integrands are no operands that are merely held where they are shifted: 5 = 101 and 2 = 010, then 100.
    let printed = good("run dda-line --to 5,2 --normalize");
    let stuck = "needed bits that never toggled: jvx[1] at 0, jvy[0] at 0, jry[0] at 0";
    assert_eq!(range_lines(&printed).last(), Some(&stuck), "{printed}");
    // F is 0 and -3 = 1…101 in turn; that it has six bits too many, and a bit 1 in none of them, is said once.
    let printed = good("run ppc-line --to 3,3 --width 8 --beats 1");
    let [needed, stuck] = range_lines(&printed)[..] else { panic!("{printed}") };
    assert!(needed.contains("xe 2/8, ye 2/8, f 3/9,"), "{needed}");
    assert_eq!(stuck, "needed bits that never toggled: f[1] at 0");
}

#[test]
fn a_register_that_reached_the_end_of_its_range_is_reported_where_one_more_unit_would_overflow() {
    let arc = "ppc-arc --from 7,0 --to 0,7 --ccw";
    // X falls from 7 and Y rises to 7; E falls to 0, which is where it is to end.
    let printed = good(&format!("run {arc}"));
    assert_eq!(range_lines(&printed).last(), Some(&"one unit from an overflow: xi at 7, yi at 7"));
    let limits = |words: &str| ["xi", "yi", "f", "e"].map(|name| field(&report(words), name, "limits"));
    assert_eq!(limits(arc), [json!([7]), json!([7]), json!([]), json!([])]);
    assert_eq!(limits(&format!("{arc} --width 4")), [json!([]), json!([]), json!([]), json!([])]);
    // Both ends in two's complement: see the table in `overflow`.
    let report = report("ppc-line --to 6,4 --width f=3 --on-overflow saturate");
    assert_eq!(field(&report, "f", "limits"), json!([-4, 3]));
}

#[test]
fn a_good_run_has_no_warning() {
    for words in ["ppc-line --to 6,4", "dda-line --to 8,6 --width 20", "ppc-arc --from 7,0 --to 0,7 --ccw"] {
        assert_eq!(report(words)["warnings"], json!([]), "{words}");
        assert!(!good(&format!("run {words}")).contains("warning"), "{words}");
    }
}

#[test]
fn a_register_that_wrapped_while_the_run_went_on_is_a_warning() {
    // F is -2 before the steps 4, 7 and 10, and each makes -2 + 6 of it: see the table in `overflow`.
    let words = "ppc-line --to 6,4 --width f=3 --on-overflow";
    let little = "what registers held after clock 15 is not what the method makes of this curve, so ranges and bits needed \
                  say little about it";
    let tally = |count| json!([{ "component": "ppc_line.f", "count": count, "first_clock": 15, "needed_width": 4 }]);
    for engine in engines() {
        let report = report(&format!("{words} wrap --engine {engine}"));
        let wrapped = "ppc_line.f wrapped around 3 times, first at clock 15; 4 bits would have held every result";
        assert_eq!(report["warnings"], json!([wrapped, little]), "{engine}");
        assert_eq!(report["overflow"]["components"], tally(3), "{engine}");
    }
    // -2 + 6 once, then -1 + 6 three times.
    let ran = Folder::new().run(&format!("run {words} saturate"));
    let held =
        "ppc_line.f was held at an end of its range 4 times, first at clock 15; 4 bits would have held every result";
    assert_eq!(range_lines(&ran.out)[1..], [format!("warning: {held}"), format!("warning: {little}")]);
    assert_eq!(field(&report(&format!("{words} wrap")), "f", "needed_width"), 4);
}

#[test]
fn overflows_beyond_those_reported_in_full_are_counted_by_component() {
    let report = report("ppc-line --to 300,200 --width f=8 --on-overflow wrap");
    let overflow = &report["overflow"];
    let count = overflow["count"].as_u64().unwrap();
    assert!(count > 100 && overflow["events"].as_array().unwrap().len() == 100, "{count}");
    let components = overflow["components"].as_array().unwrap();
    assert_eq!(components.len(), 1);
    assert_eq!(components[0]["count"], count);
}

#[test]
fn a_run_cut_short_says_how_far_its_ranges_can_be_trusted() {
    for (words, warning) in [
        (
            "ppc-line --to 6,4 --width f=3",
            "ranges and bits needed are those up to clock 15 alone, where the run was stopped",
        ),
        (
            "dda-arc --from 3,7 --to 0,8 --ccw --width 4 --preset zero",
            "ranges and bits needed are those up to clock 255 alone, where the machine was given up",
        ),
    ] {
        assert_eq!(report(words)["warnings"], json!([warning]), "{words}");
    }
}
