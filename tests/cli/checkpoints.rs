//! A run that begins in the middle shows and reports what a whole run does.

use serde_json::{Value, json};

use super::{Folder, engines};

/// Runs of more than 2^17 clocks: a state is kept every 2^16.
const LONG: [&str; 6] = [
    "dda-line --to 120000,-90000 --width 18",
    "ppc-line --to -30000,20000 --from 5,7",
    "dpm-line --to 120000,-43691 --override 70",
    // Loaded anew in every quadrant.
    "dda-arc --from 30000,0 --to 30000,0 --ccw --preset half --width 16",
    // The same through a buffer.
    "mindev-machine --from 30000,0 --to 30000,0 --ccw",
    // More overflows than are reported in full.
    "ppc-line --to 30000,20000 --width f=8 --on-overflow wrap",
];

/// The wave of a late window, and the report.
fn window(folder: &Folder, words: &str, more: &str) -> (String, Vec<u8>, String) {
    let window = "--trace-from 100000 --trace-to 100300 --vcd w.vcd --json r.json";
    let ran = folder.run(&format!("run {words} {window} {more}"));
    assert!(ran.code < 2, "{ran:?}");
    (ran.out, std::fs::read(folder.path("w.vcd")).unwrap(), folder.read("r.json"))
}

#[test]
fn a_late_window_is_the_same_from_a_state_and_from_the_beginning() {
    for words in LONG {
        let folder = Folder::new();
        folder.run(&format!("run {words} --checkpoints states.json"));
        let states = folder.read("states.json");
        for engine in engines().filter(|engine| *engine != "gates") {
            let (whole, vcd, report) = window(&folder, words, &format!("--engine {engine}"));
            let (late, late_vcd, late_report) =
                window(&folder, words, &format!("--engine {engine} --checkpoints states.json"));
            assert!(vcd.len() > 1_000 && vcd == late_vcd, "{words} on {engine}");
            assert_eq!(report, late_report, "{words} on {engine}");
            let note = "begun from the state at clock 65";
            assert!(late.starts_with(&whole) && late[whole.len()..].starts_with(note), "{late}");
        }
        assert_eq!(folder.read("states.json"), states, "a file of states is never changed");
    }
}

#[test]
fn the_oracle_goes_on_from_a_state_too() {
    let folder = Folder::new();
    folder.good(&format!("run {} --checkpoints states.json", LONG[1]));
    let (_, vcd, _) = window(&folder, LONG[1], "");
    let (_, late, _) = window(&folder, LONG[1], "--engine gates --checkpoints states.json");
    assert!(vcd == late);
}

#[test]
fn a_window_before_the_first_state_begins_at_the_beginning() {
    let folder = Folder::new();
    let run = format!("run {} --checkpoints states.json", LONG[0]);
    let first = folder.good(&run);
    assert_eq!(folder.good(&format!("{run} --trace-from 50 --trace-to 60 --vcd w.vcd")), first);
    assert_eq!(folder.good(&run), first);
    assert!(folder.read("w.vcd").contains("\n#500\n"));
}

#[test]
fn a_short_run_keeps_no_state_and_its_table() {
    let folder = Folder::new();
    let plain = folder.good("run ppc-line --to 6,4");
    for _ in 0..2 {
        assert_eq!(folder.good("run ppc-line --to 6,4 --checkpoints s.json --trace-from 3 --vcd w.vcd"), plain);
    }
}

#[test]
fn states_of_another_run_and_what_is_none_are_refused() {
    let folder = Folder::new();
    folder.good(&format!("run {} --checkpoints states.json", LONG[0]));
    folder.write("none.json", "{}");
    let states = folder.read("states.json");
    folder.write("cut.json", &states[..states.len() / 2]);
    let other = LONG[0].replace("90000", "80000");
    for (words, hint) in [
        (format!("{other} --checkpoints states.json"), "states of another machine, geometry or version"),
        (format!("{} --end-point total --checkpoints states.json", LONG[0]), "states of another machine"),
        (format!("{} --checkpoints none.json", LONG[0]), "it holds no states of a run"),
        (format!("{} --checkpoints cut.json", LONG[0]), "it holds no states of a run"),
        (format!("{} --checkpoints .", LONG[0]), "--checkpoints .: "),
        (format!("{} --checkpoints new.json --steps s.csv", LONG[0]), "leave out --steps, --plot and --html"),
        (format!("{} --checkpoints no/new.json", LONG[0]), "no/new.json"),
    ] {
        let ran = folder.run(&format!("run {words}"));
        assert_eq!((ran.code, ran.err.lines().count()), (2, 1), "{words}: {ran:?}");
        assert!(ran.err.contains(hint), "{hint}: {ran:?}");
        assert_eq!(folder.files(), ["cut.json", "none.json", "states.json"]);
    }
}

#[test]
fn no_content_of_a_file_of_states_panics() {
    let folder = Folder::new();
    folder.good(&format!("run {} --checkpoints states.json", LONG[0]));
    let (subject, states): (Value, Vec<Value>) = serde_json::from_str(&folder.read("states.json")).unwrap();
    let window = "--trace-from 100000 --trace-to 100010 --vcd w.vcd --checkpoints changed.json";
    let (mut refused, mut turn) = (0, 0);
    for pointer in [
        "/clock",
        "/block",
        "/registers/0",
        "/registers",
        "/inputs/0",
        "/inputs",
        "/memory",
        "/memory/steps",
        "/memory/steps/0",
        "/memory/steps/1",
        "/memory/steps/1/0",
        "/memory/steps/2",
        "/memory/steps/3",
        "/memory/path",
        "/memory/path/0",
        "/memory/path/1",
        "/memory/path/2/1",
        "/memory/ranges",
        "/memory/ranges/0",
        "/memory/ranges/0/2",
        "/memory/spacing/0",
        "/memory/spacing/1",
        "/memory/spacing/2",
        "/memory/spacing/3",
        "/memory/spacing/3/0/0",
        "/memory/spacing/3/0/1",
        "/memory/spacing/3/0/2/0",
        "/memory/spacing/3/0/2/1",
        "/memory/spacing/3/0/3/0",
        "/memory/overflows/0",
        "/memory/overflows/2",
        "/memory/overflows/2/0",
        "/memory/overflows/2/0/count",
        "/memory/overflows/2/0/needed",
    ] {
        for value in [json!(u64::MAX), json!([]), json!([1, 2, 3]), json!({}), json!(-1), json!("x"), json!(1e300)] {
            // Every second value, of neighbours not the same ones: seven are an odd number.
            turn += 1;
            if turn % 2 == 0 {
                continue;
            }
            let mut states = states.clone();
            *states[0].pointer_mut(pointer).unwrap() = value.clone();
            folder.write("changed.json", &json!([subject, states]).to_string());
            let ran = folder.run(&format!("run {} {window}", LONG[0]));
            // Input that cannot be right is one sentence; a run whose counters and pulses differ has one for each of
            // them.
            let lines = ran.err.lines().count();
            let sentence = if ran.code == 1 { lines > 0 } else { lines == usize::from(ran.code != 0) };
            assert!(ran.code <= 2 && sentence && !ran.err.contains("panick"), "{pointer} {value}: {ran:?}");
            refused += u32::from(ran.code == 2);
        }
    }
    assert!(refused > 20, "{refused}");
}

#[test]
fn a_file_of_states_that_cannot_be_written_is_reported_before_the_run() {
    let folder = Folder::new();
    // Days of clocks.
    let ran = folder.run("run dda-line --to 8,6 --width 50 --checkpoints no/states.json");
    assert_eq!(ran.code, 2, "{ran:?}");
    assert!(ran.err.contains("no/states.json"));
}
