//! Data sampling as its users meet it: feeds, reports, refusals.

use serde_json::json;

use super::{Folder, good, report, run_refused};

#[test]
fn a_feed_gives_the_travel_of_a_period_by_the_system_and_the_blu() {
    // 600 mm/min · 8 ms = 0.08 mm; · 10.24 ms = 0.1024 mm.
    for (words, step) in [
        ("--feed 600", 80.0),
        ("--feed 600 --system 7360", 102.4),
        ("--feed 600 --blu 0.01mm", 8.0),
        ("--step 80", 80.0),
        ("--step 102.4 --system 7360", 102.4),
    ] {
        let sampling = &report(&format!("sampled-line --to 1000,-333 {words}"))["sampling"];
        assert_eq!(sampling["step"], step, "{words}");
        let feed = sampling["feed_mm_per_min"].as_f64().unwrap();
        assert!((feed - 600.0).abs() < 1e-9, "{words}: {feed}");
    }
}

#[test]
fn the_report_says_what_the_fraction_and_the_chords_cost_in_micrometres() {
    let words = "sampled-arc --from 0,10000 --to 10000,0 --cw --step 80 --blu 0.01mm";
    let of = |bits: u32| report(&format!("{words} --fraction {bits}"));
    let [coarse, fine] = [8, 16].map(|bits| of(bits)["sampling"]["coarse_error_um"].as_f64().unwrap());
    // A unit of the fraction in µm, of a BLU of 10 µm.
    assert!(coarse < 1.5 * 10.0 / 256.0 && coarse > 50.0 * fine, "{coarse} and {fine}");
    let report = of(10);
    assert_eq!(report["end_point"]["exact"], true);
    // 80²/80000 BLU.
    assert!((report["sampling"]["chord_error_um"].as_f64().unwrap() - 0.8).abs() < 1e-12);
    let text = good(&format!("run {words} --fraction 10"));
    assert!(text.contains("coarse stage 7m: 80 BLU in 8 ms, 6000.000 mm/min"), "{text}");
    assert!(text.contains("chord error f²/8R: 0.080000 BLU (0.800000 µm)"), "{text}");
    assert!(text.contains("coarse points with 10 bits of fraction: up to 0.00"), "{text}");
}

#[test]
fn what_data_sampling_does_not_take_is_refused_with_a_remedy() {
    let arc = "sampled-arc --from 10000,0 --to 0,10000 --ccw";
    run_refused(&format!("{arc} --step 500"), &["3.125 BLU off", "--tolerance is 1", "give --step 282.842 or less"]);
    run_refused(&format!("{arc} --feed 6000"), &["--step 800", "or a lower --feed"]);
    run_refused(&format!("{arc} --feed 1e30"), &["give --step 282.842 or less"]);
    run_refused(&format!("{arc} --step 5 --fraction 7"), &["--fraction 7", "8 to 30 bits"]);
    run_refused(&format!("{arc} --step 5 --feed 5"), &["--step", "--feed"]);
    run_refused("sampled-line --to 9,5 --step 0", &["invalid length '0'"]);
    run_refused("sampled-line --to 9,5 --step nan", &["invalid length 'nan'"]);
    run_refused("sampled-line --to 9,5 --feed=-1", &["invalid feed '-1'"]);
    run_refused("sampled-line --to 9,5 --tolerance 1", &["sampled-line does not take --tolerance"]);
    run_refused("dda-line --to 9,5 --feed 100", &["dda-line does not take --feed; it takes --width"]);
}

#[test]
fn a_period_keeps_its_time_so_that_the_feed_asked_for_and_the_feed_reached_agree() {
    let report = report("sampled-line --to 3000,2000 --feed 600");
    assert_eq!((&report["sampling"]["period_clocks"], &report["steps"]), (&json!(8000.0), &json!(46)));
    // 45 whole periods and one that takes what is left: 600 mm/min of 46 · 80 BLU.
    let mean = report["feed"]["mean_mm_per_min"].as_f64().unwrap();
    let whole = 600.0 * 3_605.551 / (46.0 * 80.0);
    assert!((mean - whole).abs() < 0.001 * whole, "{mean} for {whole}");
    run_refused("sampled-line --to 3000,2000 --feed 600 --clock-hz 1000", &["--clock-hz", "or more", "8 ms"]);
}

#[test]
fn the_summary_says_why_the_mean_feed_is_below_the_feed() {
    // 45 periods of 80 BLU and one of 5.551, 8000 clocks each, and the first calculation, at 1 MHz.
    let text = good("run sampled-line --to 3000,2000 --feed 600");
    assert!(
        text.contains("mean feed 587.600 mm/min over 46 period(s): the last goes what is left of the way"),
        "{text}"
    );
    let report = report("sampled-line --to 3000,2000 --feed 600");
    let clocks = report["feed"]["clocks"].as_f64().unwrap();
    let mean = 60.0 * 3000_f64.hypot(2000.0) * 0.001 * 1e6 / clocks;
    assert!((report["feed"]["mean_mm_per_min"].as_f64().unwrap() - mean).abs() < 1e-9);
    assert!((46.0 * 8000.0..46.0 * 8000.0 + 200.0).contains(&clocks), "{clocks}");
}

#[test]
fn refusals_of_a_feed_or_a_clock_name_what_was_given() {
    run_refused(
        "sampled-line --to 9,5 --feed 1e-6",
        &["--feed 0.000001 gives the way of a period", "or a higher --feed"],
    );
    run_refused("sampled-line --to 9,5 --feed 1e9", &["make 37 bits", "give a smaller --step, or a lower --feed"]);
    for clock in ["nan", "inf", "1e300", "0", "1e15"] {
        run_refused(&format!("sampled-line --to 9,5 --clock-hz {clock}"), &["is not possible", "from 1e-3 to 1e14 Hz"]);
    }
}

/// The buffer in front of an integrand overflows first, and is as wide as it.
#[test]
fn an_integrand_that_overflows_in_its_buffer_is_widened_by_its_own_name() {
    for (curve, first, enough) in [
        ("sampled-arc --from 0,31 --to 31,0 --cw", "--width jvx=3", "--width jvx=4"),
        ("sampled-line --to 100,50", "--width 3", "--width 4"),
        ("sampled-spline --nurbs 0,0,1,100,0,1,0,100,1,100,100,1", "--width jvx=2", "--width jvx=4"),
    ] {
        let ran = Folder::new().run(&format!("run {curve} {first}"));
        let said = ran.err;
        assert_eq!(ran.code, 1, "{said}");
        assert!(said.contains("jvx_next") && said.contains(&format!("give {enough}, or go on")), "{said}");
        good(&format!("run {curve} {enough}"));
    }
}

/// Alone a short arc has a shorter step than in the hardware of a box: one of the others shows what one bit less does.
#[test]
fn each_width_of_a_box_has_a_run_that_one_bit_less_stops() {
    for model in ["sampled-arc", "sampled-line"] {
        let folder = Folder::new();
        let printed = folder.good(&format!("widths {model} --box 5"));
        let runs: Vec<&str> =
            printed.lines().filter_map(|line| line.split_once("  stepwave ").map(|of| of.1)).collect();
        assert_eq!(runs.len(), 6, "{printed}");
        for run in runs {
            assert_ne!(folder.run(run).code, 0, "{run}");
        }
    }
}
