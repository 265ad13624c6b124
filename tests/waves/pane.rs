//! What one sees of a wave at once, when it is opened.

use std::collections::HashMap;

use vcd::{Command, Value};

use super::Folder;
use super::second_reader::variables;

/// Every value that each variable takes, as GTKWave shows it, with its clock at 1 MHz.
fn values(text: &str) -> HashMap<String, Vec<(u64, String)>> {
    let mut parser = vcd::Parser::new(text.as_bytes());
    let header = parser.parse_header().expect("a header");
    let list = variables(&header);
    let mut found: HashMap<String, Vec<(u64, String)>> = HashMap::new();
    let mut time = 0;
    let unit = if text.contains("$timescale 100 ns $end") { 10 } else { 1 };
    for command in parser {
        let (id, bits) = match command.expect("a command") {
            Command::Timestamp(now) => {
                time = now / unit;
                continue;
            }
            Command::ChangeScalar(id, value) => (id, value.to_string()),
            Command::ChangeVector(id, vector) => (id, vector.iter().map(|value: Value| value.to_string()).collect()),
            _ => continue,
        };
        for (path, var) in list.iter().filter(|(_, var)| var.code == id) {
            let number = u128::from_str_radix(&bits, 2).map(|number| number.cast_signed()).unwrap_or(-1);
            let signed = var.var_type == vcd::VarType::Integer && bits.starts_with('1');
            let number = if signed { number - (1_i128 << bits.len()) } else { number };
            found.entry(path.clone()).or_default().push((time, number.to_string()));
        }
    }
    found
}

/// The setting of this name in a save file.
fn setting<'a>(save: &'a str, name: &str) -> &'a str {
    let start = format!("[{name}] ");
    save.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{name}: {save}"))
}

/// Traces in order, without groups, each with its flags and the rows of its height.
fn traces(save: &str) -> Vec<(String, String, usize)> {
    let (mut flags, mut found) = (String::new(), Vec::<(String, String, usize)>::new());
    for line in save.lines() {
        match line.chars().next() {
            Some('@') => line[1..].clone_into(&mut flags),
            Some('-') if flags == "20200" => found.last_mut().expect("a trace").2 += 1,
            Some(c) if c.is_ascii_alphabetic() => found.push((line.to_owned(), flags.clone(), 1)),
            _ => {}
        }
    }
    found
}

fn opened(words: &str) -> (String, String) {
    let folder = Folder::new();
    let ran = folder.run(&format!("{words} --vcd w.vcd"));
    assert!(ran.code <= 1, "{words}: {ran:?}");
    (folder.read("w.vcd"), folder.read("w.gtkw"))
}

const RUNS: [&str; 6] = [
    "run ppc-line --to 6,4",
    "run ppc-line --to 6,4 --width f=3",
    "run dda-line --to 3000,-2001",
    "run ppc-arc --from 1000,0 --to 0,1000 --ccw",
    "run dda-line --to 9,-30,4,0,-17,31 --end-point per-axis",
    "run dda-line --to 80,60 --trace-from 50",
];

#[test]
fn names_and_values_have_the_room_that_they_need() {
    for words in RUNS {
        let (wave, save) = opened(words);
        let width: usize = setting(&save, "signals_width").parse().unwrap();
        let values = values(&wave);
        let (mut name_letters, mut value_letters) = (0, 0);
        for (name, flags, _) in traces(&save).iter().filter(|(name, ..)| !name.ends_with(".clk")) {
            name_letters = name_letters.max(name.rsplit('.').next().unwrap().len());
            if flags != "2028" {
                let path = name.split('[').next().unwrap();
                value_letters = value_letters.max(values[path].iter().map(|(_, value)| value.len()).max().unwrap());
            } else if name.contains("beat") {
                value_letters = value_letters.max("COMPARE".len());
            }
        }
        // Letters of the viewer are 8 pixels wide; values begin right of the longest name.
        assert!((name_letters + 1 + value_letters) * 8 < width, "{words}: {name_letters}, {value_letters}, {width}");
        let window: usize = setting(&save, "size").split(' ').next().unwrap().parse().unwrap();
        assert!(window - width >= 650, "{words}: {window} {width}");
    }
}

#[test]
fn the_whole_run_fills_the_pane() {
    for words in RUNS {
        let (wave, save) = opened(words);
        let zoom: f64 =
            save.lines().find_map(|line| line.strip_prefix('*')).unwrap().split(' ').next().unwrap().parse().unwrap();
        let number = |name: &str| setting(&save, name).split(' ').next().unwrap().parse::<f64>().unwrap();
        let end: f64 = wave.lines().filter_map(|line| line.strip_prefix('#')).next_back().unwrap().parse().unwrap();
        // Ticks of 100 ns; the save file counts ns.
        let shown = end * 100.0 - number("timestart");
        let (window, names) = (number("size"), number("signals_width"));
        let pixels = shown * 200.0 * zoom.exp2();
        assert!(pixels <= window - names - 20.0 && pixels > window - names - 80.0, "{words}: {pixels} pixels");
    }
}

#[test]
fn curves_of_all_axes_have_one_scale() {
    let heights = |words: &str| {
        let (_, save) = opened(words);
        let analog = traces(&save).into_iter().filter(|(_, flags, _)| flags.ends_with("8420"));
        analog.map(|(_, _, rows)| rows).collect::<Vec<_>>()
    };
    assert_eq!(heights("run dda-line --to 8,6"), [4, 3]);
    assert_eq!(heights("run dda-line --to 300,-200"), [6, 4]);
    assert_eq!(heights("run ppc-arc --from 5,0 --to 0,5 --ccw"), [5, 5]);
    assert_eq!(heights("run dda-line --from 100,100,7 --to 104,101,7"), [4, 1, 1]);
    assert_eq!(heights("run dda-line --to 1000,1")[1], 1);
}

#[test]
fn positions_begin_at_the_start_and_not_at_the_reset() {
    let (_, save) = opened("run ppc-arc --from 1000,0 --to 997,77 --ccw");
    assert_eq!(setting(&save, "timestart"), "1000");
    // Scaled to what is in view, which begins after the load.
    assert!(traces(&save).iter().any(|(name, flags, _)| name == "ppc_arc.axis_x.x" && flags == "8420"), "{save}");
    let (_, save) = opened("run ppc-arc --from 0,0 --to 0,0 --center 5,0 --ccw");
    assert_eq!(setting(&save, "timestart"), "0");
    assert!(traces(&save).iter().any(|(name, flags, _)| name == "ppc_arc.axis_x.x" && flags == "88420"), "{save}");
}

#[test]
fn flags_are_folded_away_unless_one_rose() {
    let (_, save) = opened("run ppc-line --to 6,4");
    assert!(save.contains("@c00200\n-overflow\n") && save.contains("@1401200\n-overflow\n"), "{save}");
    for mode in ["trap", "wrap"] {
        let (_, save) = opened(&format!("run ppc-line --to 6,4 --width f=3 --on-overflow {mode}"));
        assert!(save.contains("@800200\n-overflow\n") && !save.contains("@c00200"), "{mode}: {save}");
    }
}

#[test]
fn a_trap_shows_its_operands_and_the_exact_result() {
    for (words, [left, right, exact]) in [
        ("run ppc-line --to 6,4 --width f=3", ["-2", "6", "4"]),
        ("run dda-line --to 20,10 --width x=3", ["3", "1", "4"]),
    ] {
        let (wave, save) = opened(words);
        let values = values(&wave);
        let top = words.split(' ').nth(1).unwrap().replace('-', "_");
        // The trap is the last sample.
        let last = |name: &str| values[&format!("{top}.trap.{name}")].last().unwrap().1.clone();
        let found = [last("left"), last("right"), last("exact")];
        assert_eq!(found, [left, right, exact], "{words}");
        assert!(save.contains("-trap\n") && save.contains(".trap.exact\n"), "{save}");
    }
    // What does not trap has nothing of it.
    assert!(!opened("run ppc-line --to 6,4 --width f=3 --on-overflow wrap").0.contains(" trap "));
}

#[test]
fn the_wave_of_a_program_begins_with_place_feed_and_block() {
    let folder = Folder::new();
    folder.write("p.ngc", "N10 G21 G90 G01 X6 Y4 F60\nN25 G02 X10 Y0 I0 J-4\nG00 X0 Y0\n");
    let bits = "program p.ngc --method ppc --integers pulses --blu 0.01mm --clock-hz 1e6";
    folder.good(&format!("{bits} --vcd w.vcd"));
    let names: Vec<String> = traces(&folder.read("w.gtkw")).into_iter().map(|(name, ..)| name).collect();
    let inner = |name: &String| name.split_once('.').unwrap().1.split('[').next().unwrap().to_owned();
    assert_eq!(
        names[..4].iter().map(inner).collect::<Vec<_>>(),
        ["axis_x.x", "axis_y.y", "program.feed", "program.block"]
    );
    let values = values(&folder.read("w.vcd"));
    let shown = |name: &str| values[name].iter().map(|(_, value)| value.clone()).collect::<Vec<_>>();
    // The third block has no number, but a line; it runs as fast as the source, a pulse every second clock.
    assert_eq!(shown("ppc_machine.program.block"), ["0", "10", "25", "3"]);
    assert_eq!(shown("ppc_machine.program.feed")[..2], ["0", "60"]);
    // The ninth and tenth names of `kind` are those without an arc.
    let names = folder.read("w.kind.states");
    assert!(names.contains("1000 LINE\n1001 NONE\n") && names.starts_with("0000 SR1\n"), "{names}");
    assert_eq!(shown("ppc_machine.quadrant.kind")[..2], ["9", "8"]);
    assert_eq!(shown("ppc_machine.quadrant.kind").last().unwrap(), "8");
}
