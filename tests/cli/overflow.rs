//! Registers one bit too narrow: trapped at the very clock, or continued and reported.

use serde_json::{Value, json};

use super::sweep::rows;
use super::{Csv, Folder, engines};

/// The line to (6, 4) by hand: F = 0, -4, 2, -2, and step 4, in Y, makes -2 + 6 = 4, where three bits end at 3.
/// Step 4 begins after clock 13 = 1 + 3·4; it is judged, fed and computed, so the adder shows 4 at clock 15.
const SENTENCE: &str = "overflow of ppc_line.f at clock 15: -2 + 6 = 4 does not fit in its 3 bits (-4 to 3); 4 bits would \
                        hold it: give --width f=4, or go on with --on-overflow wrap or saturate";

#[test]
fn a_deviation_register_one_bit_too_narrow_is_trapped_at_its_clock() {
    for engine in engines() {
        let folder = Folder::new();
        let ran =
            folder.run(&format!("run ppc-line --to 6,4 --width f=3 --engine {engine} --steps s.csv --json r.json"));
        assert_eq!((ran.code, ran.err), (1, format!("stepwave: {SENTENCE}\n")), "{engine}");
        assert!(ran.out.contains("stopped by an overflow at (2, 2)"), "{engine}: {}", ran.out);
        let table = Csv::parse(&folder.read("s.csv"));
        assert_eq!((table.column("f"), table.column("clock")), (vec![0, -4, 2, -2], vec![1, 5, 9, 13]), "{engine}");
        let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
        let event = json!({ "component": "ppc_line.f", "clock": 15, "width": 3, "signed": true, "operation": "add",
                            "left": -2, "right": 6, "exact": 4, "needed_width": 4 });
        let tally = json!({ "component": "ppc_line.f", "count": 1, "first_clock": 15, "needed_width": 4 });
        let overflow = json!({ "count": 1, "events": [event], "components": [tally] });
        assert_eq!(report["overflow"], overflow, "{engine}");
        assert_eq!((&report["clocks"], &report["failures"]), (&json!(15), &json!([SENTENCE])), "{engine}");
    }
}

#[test]
fn the_wave_ends_at_the_trap_with_the_operands_and_the_flag_in_sight() {
    let folder = Folder::new();
    assert_eq!(folder.run("run ppc-line --to 6,4 --width f=3 --vcd w.vcd --trace f --trace *_overflow").code, 1);
    let wave = folder.read("w.vcd");
    let id = |name: &str| {
        let line = wave.lines().find(|line| line.starts_with("$var") && line.contains(&format!(" {name} "))).unwrap();
        line.split(' ').nth(3).unwrap().to_owned()
    };
    let (f, flag) = (id("f"), id("f_add_overflow"));
    // 10 ticks a clock: f becomes -2 in sample 12, the flag rises in sample 15, and the last cycle ends at 160.
    let blocks: Vec<Vec<&str>> = wave.split("\n#").map(|block| block.lines().collect()).collect();
    let changes = |line: &str| -> Vec<&str> {
        blocks[1..].iter().filter(|block| block.contains(&line)).map(|block| block[0]).collect()
    };
    assert_eq!(changes(&format!("b110 {f}")), ["120"]);
    assert_eq!(changes(&format!("1{flag}")), ["150"]);
    assert_eq!(blocks.last().unwrap(), &["160"]);
}

#[test]
fn in_one_beat_the_trap_is_at_the_clock_before_the_step() {
    // Step 4 happens at the edge from clock 4 to clock 5.
    let ran = Folder::new().run("run ppc-line --to 6,4 --width f=3 --beats 1");
    assert_eq!(ran.code, 1);
    assert_eq!(ran.err, format!("stepwave: {}\n", SENTENCE.replace("clock 15", "clock 4")));
}

#[test]
fn an_arc_traps_on_its_subtraction() {
    // NR1 from (6, 0): the first step makes 0 - (2·6 - 1) = -11, below the -8 of four bits, in the third clock.
    let ran = Folder::new().run("run ppc-arc --from 6,0 --to 0,6 --ccw --width f=4");
    let sentence = "overflow of ppc_arc.f at clock 3: 0 - 11 = -11 does not fit in its 4 bits (-8 to 7); 5 bits would hold \
                    it: give --width f=5, or go on with --on-overflow wrap or saturate";
    assert_eq!((ran.code, ran.err), (1, format!("stepwave: {sentence}\n")));
}

#[test]
fn a_position_counter_traps_too() {
    // X pulses with steps 2, 4, 6 and 8; three bits end at 3. Step 8 happens at the edge from clock 8 to clock 9.
    let ran = Folder::new().run("run dda-line --to 8,6 --width x=3");
    let begin =
        "stepwave: overflow of dda_line.axis_x.x at clock 8: 3 + 1 = 4 does not fit in its 3 bits (-4 to 3); 4 bits";
    assert!(ran.code == 1 && ran.err.starts_with(begin), "{ran:?}");
}

#[test]
fn the_width_that_the_message_names_makes_the_run_good() {
    let folder = Folder::new();
    for words in ["ppc-line --to 6,4 --width f=4", "ppc-arc --from 6,0 --to 0,6 --ccw --width f=5"] {
        folder.good(&format!("run {words}"));
    }
}

/// Runs on although registers overflow; gives the table and the sentences.
fn goes_on(words: &str) -> (Csv, String) {
    let folder = Folder::new();
    let ran = folder.run(&format!("run {words} --steps s.csv"));
    assert_eq!(ran.code, 1, "{words}: {ran:?}");
    assert!(
        ran.out.contains("overflow(s), the first: overflow of ppc_line.f at clock 15: -2 + 6 = 4"),
        "{words}: {ran:?}"
    );
    (Csv::parse(&folder.read("s.csv")), ran.err)
}

#[test]
fn wrapped_around_the_run_goes_on_and_misses_its_end() {
    // 4 becomes -4: F < 0 steps Y again.
    let (table, sentences) = goes_on("ppc-line --to 6,4 --width f=3 --on-overflow wrap");
    assert_eq!(table.column("f"), [0, -4, 2, -2, -4, 2, -2, -4, 2, -2, -4]);
    assert_eq!(table.moves(), "X Y X Y Y X Y Y X Y");
    // (4, 6) is (6·6 - 4·4)/sqrt(52) = 2.774 off the line.
    let expected = "stepwave: the end point (6, 4) was missed: the machine is at (4, 6)\n\
                    stepwave: the path left the line: 2.774 BLU off at (4, 6) after step 10, where the method promises at \
                    most 1 BLU\n";
    assert_eq!(sentences, expected);
}

#[test]
fn saturated_the_run_goes_on_and_misses_its_end() {
    // 4 becomes 3, and so does every later sum of 5 (-1 + 6).
    let (table, sentences) = goes_on("ppc-line --to 6,4 --width f=3 --on-overflow saturate");
    assert_eq!(table.column("f"), [0, -4, 2, -2, 3, -1, 3, -1, 3, -1, 3]);
    assert_eq!(table.moves(), "X Y X Y X Y X Y X Y");
    // (5, 5) is (6·5 - 4·5)/sqrt(52) = 1.387 off the line.
    let expected = "stepwave: the end point (6, 4) was missed: the machine is at (5, 5)\n\
                    stepwave: the path left the line: 1.387 BLU off at (5, 5) after step 10, where the method promises at \
                    most 1 BLU\n";
    assert_eq!(sentences, expected);
}

/// Both end after ten steps, where the line does not.
#[test]
fn a_run_that_misses_its_end_has_no_mean_speed() {
    for choice in ["wrap", "saturate"] {
        let words = format!("--width f=3 --on-overflow {choice}");
        let folder = Folder::new();
        let ran = folder.run(&format!("run ppc-line --to 6,4 {words} --json r.json"));
        let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
        let feed = &report["feed"];
        assert_eq!([&feed["mean"], &feed["mean_mm_per_min"], &feed["ripple"]], [&Value::Null; 3], "{feed}");
        assert!(feed["least"]["value"].is_f64() && ran.out.contains("speed over v_max: "), "{feed} {ran:?}");
        assert!(!ran.out.contains(", mean ") && !ran.out.contains("ripple"), "{ran:?}");
        let swept = folder.good(&format!("sweep ppc-line --to-grid 6..6x4..4 {words} --ripple --csv rows.csv"));
        assert!(!swept.contains("mean speed"), "{swept}");
        // In lanes, and alone.
        for more in ["", " --ripple"] {
            let rows = rows(&folder.good(&format!("sweep ppc-line --to-grid 6..6x4..4 {words}{more} --csv -")));
            let ends = (&*rows[0]["ending"], &*rows[0]["exact"], &*rows[0]["steps"], &*rows[0]["v_mean"]);
            assert!(rows.len() == 1 && ends == ("done", "false", "10", ""), "{rows:?}");
            assert!(rows[0].get("ripple").is_none_or(String::is_empty), "{rows:?}");
        }
    }
}

#[test]
fn without_an_overflow_all_three_choices_give_the_same_run() {
    let [trap, saturate, wrap] =
        ["trap", "saturate", "wrap"].map(|choice| Csv::of(&format!("ppc-line --to 6,4 --on-overflow {choice}")));
    assert!(trap == saturate && trap == wrap && trap == Csv::of("ppc-line --to 6,4"));
}

/// With `total` a diagonal step counts two pulses: from an odd count the counter wraps around past 0, and the machine
/// cycles.
const ENDLESS: [&str; 2] = [
    "run vector-arc --from 1,0 --to -2,0 --cw --end-point total --on-overflow wrap",
    "run mindev-arc --from 1,0 --to -2,0 --cw --end-point total --on-overflow wrap",
];

#[test]
fn a_motion_that_never_ends_is_given_up_where_it_comes_back_to_an_earlier_state() {
    for words in ENDLESS {
        let mut reported = Vec::new();
        for engine in engines() {
            let folder = Folder::new();
            let ran = folder.run(&format!("{words} --engine {engine} --json r.json --vcd w.vcd"));
            assert!(ran.code == 1 && ran.err.contains("the motion never ends: at clock"), "{words}: {ran:?}");
            assert!(ran.err.contains("--on-overflow trap") && ran.err.lines().count() == 1, "{words}: {ran:?}");
            let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
            assert_eq!(report["ending"], "endless");
            reported.push((ran.err, folder.read("w.vcd")));
        }
        assert!(reported.windows(2).all(|pair| pair[0] == pair[1]), "{words}");
        // The two clocks that the sentence names show the same registers: so the wave says too.
        let folder = Folder::new();
        let numbers: Vec<u64> =
            reported[0].0.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect();
        let (end, since) = (numbers[0], numbers[numbers.len() - 1]);
        folder.run(&format!("{words} --steps s.csv"));
        let table = Csv::parse(&folder.read("s.csv"));
        let clocks = table.column("clock");
        let row = |clock: u64| clocks.iter().rposition(|&at| at <= i64::try_from(clock).unwrap()).unwrap();
        for register in ["f", "xi", "yi", "e", "x", "y"] {
            let values = table.column(register);
            assert_eq!(values[row(end)], values[row(since)], "{words}: {register}");
        }
    }
}

#[test]
fn a_run_beyond_its_clocks_is_given_up_there_and_one_within_them_is_not() {
    let folder = Folder::new();
    let ran = folder.run(&format!("{} --max-clocks 100 --json r.json", ENDLESS[0]));
    assert_eq!(ran.code, 1);
    assert!(
        ran.err.starts_with("stepwave: not done after 100 clocks, at (") && ran.err.contains("greater --max-clocks")
    );
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    assert_eq!((&report["ending"], &report["clocks"]), (&json!("limit"), &json!(100)));
    // Ten steps of four clocks after the load.
    for (clocks, code) in [(41, 0), (40, 1)] {
        let ran = folder.run(&format!("run ppc-line --to 6,4 --max-clocks {clocks}"));
        assert_eq!(ran.code, code, "{ran:?}");
    }
    let ran = folder.run("run ppc-line --to 6,4 --max-clocks 0");
    assert!(ran.code == 2 && ran.err.contains("--max-clocks"), "{ran:?}");
}

#[test]
fn pulses_are_counted_apart_from_a_position_counter_that_wraps() {
    let folder = Folder::new();
    let ran =
        folder.run("run ppc-line --to 5,0 --width x=3 --on-overflow wrap --json r.json --plot p.svg --steps s.csv");
    assert_eq!(ran.code, 1);
    assert!(ran.out.contains("end point (5, 0) reached exactly"), "{}", ran.out);
    assert!(ran.err.contains("the counter x shows -3, 5 pulses were given"), "{}", ran.err);
    let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
    let end = json!({ "wanted": [5, 0], "reached": [5, 0], "exact": true });
    assert_eq!(report["position_counters"], json!([-3, 0]));
    assert_eq!((&report["end_point"], &report["path_error"]["greatest"]), (&end, &json!(0.0)));
    // The table shows the counter, the picture the path.
    assert_eq!(Csv::parse(&folder.read("s.csv")).column("x"), [0, 1, 2, 3, -4, -3]);
    assert!(!folder.read("p.svg").contains("(\u{2212}3, 0)"));
    let ran = folder.run("sweep ppc-line --to 5,0 --width x=3 --on-overflow wrap --csv -");
    assert!(ran.out.contains(",5,0,true,0"), "{}", ran.out);
}

#[test]
fn a_program_counts_pulses_apart_from_its_counters_too() {
    let folder = Folder::new();
    folder.write("p.ngc", "G21 G91\nG1 X0.005 F100\nM2\n");
    for (mode, shown) in [("wrap", -3), ("saturate", 3)] {
        let ran = folder.run(&format!("program p.ngc --method ppc --width x=3 --on-overflow {mode} --json r.json"));
        assert_eq!(ran.code, 1, "{}", ran.out);
        assert!(ran.err.contains(&format!("the counter x shows {shown}, 5 pulses were given")), "{}", ran.err);
        let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
        assert_eq!((&report["reached"], &report["position_counters"]), (&json!([5, 0, 0]), &json!([shown, 0, 0])));
        assert_eq!(report["missed_end_points"], 0);
    }
}

#[test]
fn a_load_word_is_cut_as_hardware_cuts_it_and_the_report_says_so() {
    let folder = Folder::new();
    for (line, sentence, reached, word) in [
        (
            "bresenham --to 300,3 --width e=8 --on-overflow wrap",
            "e = 300 does not fit in its 8 bits: 44 was loaded",
            json!([44, 0]),
            json!({ "register": "e", "block": 0, "value": 300, "loaded": 44, "width": 8 }),
        ),
        (
            "stepgen --to 100,62 --width ratex=7 --on-overflow wrap",
            "ratex = 100 does not fit in its 7 bits: -28 was loaded",
            json!([-28, 62]),
            json!({ "register": "ratex", "block": 0, "value": 100, "loaded": -28, "width": 7 }),
        ),
        (
            "stepgen --to 100,62 --width ratex=7 --on-overflow saturate",
            "ratex = 100 does not fit in its 7 bits: 63 was loaded",
            json!([63, 62]),
            json!({ "register": "ratex", "block": 0, "value": 100, "loaded": 63, "width": 7 }),
        ),
    ] {
        let ran = folder.run(&format!("run {line} --json r.json"));
        assert_eq!(ran.code, 1, "{line}");
        assert!(ran.out.contains(sentence), "{line}: {}", ran.out);
        let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
        assert_eq!((&report["cut_words"], &report["end_point"]["reached"]), (&json!([word]), &reached), "{line}");
        let ran = folder.run(&format!("sweep {line} --csv -"));
        assert!(ran.out.lines().nth(1).is_some_and(|row| row.ends_with(sentence)), "{line}: {}", ran.out);
        let ran = folder.run(&format!("export {line} --verilog m.v"));
        assert!(ran.code == 0 && ran.out.contains(sentence), "{line}: {ran:?}");
    }
    let ran = folder.run("run bresenham --to 300,3 --width e=8");
    assert_eq!((ran.code, ran.out.as_str()), (2, ""));
}

#[test]
fn a_machine_whose_cut_words_never_let_it_end_is_given_up() {
    let folder = Folder::new();
    // 1000 in 9 bits is 488, which the long travel never reaches: both counters wrap again and again.
    let ran =
        folder.run("run ppc-arc --from 1000,0 --to 0,1000 --ccw --width xi=9 --on-overflow wrap --max-clocks 100000");
    assert_eq!(ran.code, 1, "{}", ran.out);
    assert!(ran.out.contains("xi = 1000 does not fit in its 9 bits: 488 was loaded"), "{}", ran.out);
}
