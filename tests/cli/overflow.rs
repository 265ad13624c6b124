//! Registers one bit too narrow: trapped at the very clock, or carried on with and told.

use serde_json::{Value, json};

use super::{Csv, Folder, engines};

/// The line to (6, 4) by hand: F = 0, -4, 2, -2, and step 4, in Y, makes -2 + 6 = 4, where three bits end at 3.
/// Step 4 begins behind clock 13 = 1 + 3·4; it is judged, fed and computed, so the adder shows 4 at clock 15.
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
fn in_one_beat_the_trap_stands_at_the_clock_before_the_step() {
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
    let expected = "stepwave: the end point (6, 4) was missed: the machine stands at (4, 6)\n\
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
    let expected = "stepwave: the end point (6, 4) was missed: the machine stands at (5, 5)\n\
                    stepwave: the path left the line: 1.387 BLU off at (5, 5) after step 10, where the method promises at \
                    most 1 BLU\n";
    assert_eq!(sentences, expected);
}

#[test]
fn without_an_overflow_all_three_ways_are_the_same_run() {
    let [trap, saturate, wrap] =
        ["trap", "saturate", "wrap"].map(|way| Csv::of(&format!("ppc-line --to 6,4 --on-overflow {way}")));
    assert!(trap == saturate && trap == wrap && trap == Csv::of("ppc-line --to 6,4"));
}

/// With `total` a diagonal step counts two pulses: from an odd count the counter wraps around past 0, and the machine
/// goes round and round.
const ENDLESS: [&str; 2] = [
    "run vector-arc --from 1,0 --to -2,0 --cw --end-point total --on-overflow wrap",
    "run mindev-arc --from 1,0 --to -2,0 --cw --end-point total --on-overflow wrap",
];

#[test]
fn a_motion_that_never_ends_is_given_up_where_it_comes_back_to_an_earlier_state() {
    for words in ENDLESS {
        let mut told = Vec::new();
        for engine in engines() {
            let folder = Folder::new();
            let ran = folder.run(&format!("{words} --engine {engine} --json r.json --vcd w.vcd"));
            assert!(ran.code == 1 && ran.err.contains("the motion never ends: at clock"), "{words}: {ran:?}");
            assert!(ran.err.contains("--on-overflow trap") && ran.err.lines().count() == 1, "{words}: {ran:?}");
            let report: Value = serde_json::from_str(&folder.read("r.json")).unwrap();
            assert_eq!(report["ending"], "endless");
            told.push((ran.err, folder.read("w.vcd")));
        }
        assert!(told.windows(2).all(|pair| pair[0] == pair[1]), "{words}");
        // The two clocks that the sentence names show the same registers: so the wave says too.
        let folder = Folder::new();
        let numbers: Vec<u64> =
            told[0].0.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect();
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
    // Ten steps of four clocks behind the load.
    for (clocks, code) in [(41, 0), (40, 1)] {
        let ran = folder.run(&format!("run ppc-line --to 6,4 --max-clocks {clocks}"));
        assert_eq!(ran.code, code, "{ran:?}");
    }
    let ran = folder.run("run ppc-line --to 6,4 --max-clocks 0");
    assert!(ran.code == 2 && ran.err.contains("--max-clocks"), "{ran:?}");
}
