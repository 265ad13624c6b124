//! Recorded waves: made anew, compared bit by bit, and the first difference named.

use std::os::unix::ffi::OsStrExt;

use super::Folder;

const LINE: &str = "[[case]]\nname = \"line\"\nsource = \"by hand\"\nargs = [\"ppc-line\", \"--to\", \"6,4\"]\n";

/// A folder with these cases in `w/cases.toml`.
fn folder(cases: &str) -> Folder {
    let folder = Folder::new();
    folder.make("w");
    folder.write("w/cases.toml", cases);
    folder
}

fn recorded(cases: &str) -> Folder {
    let folder = folder(cases);
    folder.good("golden record w");
    folder
}

#[test]
fn what_was_recorded_is_found_the_same() {
    let folder = folder(LINE);
    let files = "line.beat.states, line.csv, line.gtkw, line.vcd";
    assert_eq!(folder.good("golden record w"), format!("line: new {files}\n1 cases recorded, from 3 engines\n"));
    assert_eq!(folder.good("golden record w"), format!("line: same {files}\n1 cases recorded, from 3 engines\n"));
    assert_eq!(folder.good("golden check w"), "1 cases same, bit by bit, from 3 engines\n");
    for file in ["line.vcd", "line.gtkw", "line.beat.states", "line.csv"] {
        assert!(folder.path("w").join(file).is_file(), "{file}");
    }
    // And what a run writes is what was recorded.
    folder.good("run ppc-line --to 6,4 --vcd line.vcd");
    assert_eq!(folder.read("line.vcd"), folder.read("w/line.vcd"));
}

#[test]
fn one_flipped_bit_is_found_with_its_clock_its_signal_and_both_values() {
    let folder = recorded(LINE);
    let wave = folder.read("w/line.vcd");
    let var = wave.lines().find(|line| line.starts_with("$var") && line.contains(" f ")).unwrap();
    let id = var.split(' ').nth(3).unwrap();
    // F becomes 2 in the compute beat of step 2, at clock 8, which is time 80.
    let (before, after) = wave.split_once("#80\n").unwrap();
    let flipped = after.replacen(&format!("b0010 {id}\n"), &format!("b0011 {id}\n"), 1);
    assert_ne!(flipped, after);
    folder.write("w/line.vcd", &format!("{before}#80\n{flipped}"));
    let ran = folder.run("golden check w");
    assert_eq!(ran.code, 1, "{ran:?}");
    for hint in [
        "case line on gates: line.vcd differs",
        "first divergence: clock 8, signal ppc_line.f",
        "A  0011 (3)",
        "B  0010 (2)",
    ] {
        assert!(ran.err.contains(hint), "{hint}: {ran:?}");
    }
    assert_eq!(ran.err.matches("first divergence").count(), 1, "what all engines agree on is told once: {ran:?}");
    let ran = folder.run("golden record w");
    assert_eq!(ran.code, 0, "{ran:?}");
    assert_eq!(folder.read("w/line.vcd"), wave);
}

#[test]
fn a_changed_table_and_a_wave_of_no_case_are_differences() {
    let folder = recorded(LINE);
    folder.write("w/line.csv", &folder.read("w/line.csv").replace("\n1,5,", "\n1,6,"));
    folder.write("w/old.vcd", &folder.read("w/line.vcd"));
    let ran = folder.run("golden check w");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.err.contains("line.csv differs: line 3: recorded '1,6,"), "{ran:?}");
    assert!(ran.err.contains("; step 1: column clock: recorded 6, simulated 5"), "{ran:?}");
    assert!(ran.err.contains("w/old.vcd belongs to no case"), "{ran:?}");
}

#[test]
fn every_case_with_another_exit_code_is_reported_and_the_others_are_checked() {
    let trap = LINE.replace("\"line\"", "\"trap\"").replace("\"6,4\"", "\"6,4\", \"--width\", \"f=3\"");
    let folder = folder(&format!("{trap}{LINE}"));
    let ran = folder.run("golden record w");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.err.starts_with("stepwave: case trap: exit code 1, not 0: overflow of ppc_line.f"), "{ran:?}");
    assert!(folder.path("w/line.vcd").is_file() && !folder.path("w/trap.vcd").exists());
    let folder = self::folder(&format!("{LINE}exit = 1\n"));
    let ran = folder.run("golden record w");
    assert_eq!(ran.err, "stepwave: case line: exit code 0, not 1: it passes every check\n");
    let folder = recorded(&format!("{trap}exit = 1\n{LINE}"));
    assert_eq!(folder.good("golden check w"), "2 cases same, bit by bit, from 3 engines\n");
}

#[test]
fn cases_that_cannot_be_are_refused_in_one_line_and_nothing_is_written() {
    let with = |from: &str, to: &str| LINE.replace(from, to);
    for (cases, hint) in [
        (with("\"line\"", "\"../line\""), "'../line' cannot name files"),
        (with("\"line\"", "\"a/b\""), "'a/b' cannot name files"),
        (with("\"line\"", "'a\\b'"), "cannot name files"),
        (with("\"line\"", "\"\""), "'' cannot name files"),
        (with("\"line\"", "\".line\""), "'.line' cannot name files"),
        (format!("{LINE}{LINE}"), "two cases are named 'line'"),
        (with("ppc-line", "nope"), "case line: there is no model 'nope'"),
        (with("\"6,4\"", "\"6\""), "case line: "),
        (with("\"6,4\"", "\"6,4\", \"--frob\""), "case line: unexpected argument '--frob'"),
        (with("\"6,4\"", "\"6,4\", \"--json\", \"r.json\""), "leave out --fst, --checkpoints, --json and --plot"),
        (with("\"6,4\"", "\"6,4\", \"--vcd\", \"v.vcd\""), "case line: "),
        (with("source", "sauce"), "cases.toml"),
        ("case = 3".to_owned(), "cases.toml"),
    ] {
        let folder = folder(&cases);
        for command in ["record", "check"] {
            let ran = folder.run(&format!("golden {command} w"));
            // What TOML cannot read is shown with its line.
            let lines = if hint == "cases.toml" { 5 } else { 1 };
            assert_eq!((ran.code, ran.err.lines().count()), (2, lines), "{cases}: {ran:?}");
            assert!(ran.err.starts_with("stepwave: ") && ran.err.contains(hint), "{hint}: {ran:?}");
            assert_eq!(ran.err.matches("stepwave: ").count(), 1, "{ran:?}");
        }
        assert_eq!(folder.files(), ["w"]);
        assert_eq!(std::fs::read_dir(folder.path("w")).unwrap().count(), 1, "{cases}");
    }
    super::refused("golden check nowhere", &["cannot read nowhere/cases.toml"]);
}

#[test]
fn a_case_may_be_a_program_in_its_folder() {
    let folder = folder(
        "[[case]]\nname = \"two\"\nsource = \"by hand\"\nprogram = \"two.nc\"\nargs = [\"--method\", \"cim\"]\n",
    );
    folder.write("w/two.nc", "G01 X0.004 Y0.003 F600\nG02 X0.008 Y-0.001 I0 J-0.004\n");
    assert!(folder.good("golden record w").ends_with("\n1 cases recorded, from 3 engines\n"));
    folder.good("program w/two.nc --method cim --vcd two.vcd --steps two.csv");
    for file in ["two.vcd", "two.csv"] {
        assert_eq!(folder.read(file), folder.read(&format!("w/{file}")));
    }
    // Another program under the same name is found out.
    folder.write("w/two.nc", "G01 X0.004 Y0.002 F600\nG02 X0.008 Y-0.002 I0 J-0.004\n");
    let ran = folder.run("golden check w");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.err.contains("case two on gates: two.vcd differs: recorded is A"), "{ran:?}");
}

#[test]
fn the_source_of_a_case_may_be_left_out() {
    let folder = folder(&LINE.replace("source = \"by hand\"\n", ""));
    folder.good("golden record w");
    folder.good("golden check w");
}

#[test]
fn single_cases_are_checked_and_recorded_by_their_names() {
    let other = LINE.replace("\"line\"", "\"other\"").replace("6,4", "5,3");
    let folder = folder(&format!("{LINE}{other}"));
    folder.good("golden record w other");
    assert!(folder.path("w/other.vcd").exists() && !folder.path("w/line.vcd").exists());
    assert_eq!(folder.good("golden check w other"), "1 cases same, bit by bit, from 3 engines\n");
    assert_eq!(folder.good("golden check w --case other"), "1 cases same, bit by bit, from 3 engines\n");
    assert_eq!(folder.run("golden check w line").code, 2);
    folder.good("golden record w line other");
    folder.write("w/other.csv", "");
    assert_eq!((folder.run("golden check w line").code, folder.run("golden check w").code), (0, 1));
    let ran = folder.run("golden check w lime");
    assert!(ran.code == 2 && ran.err.contains("has no case 'lime': its cases are line, other"), "{ran:?}");
}

#[test]
fn record_says_what_is_new_changed_removed_and_the_same() {
    let folder = recorded(LINE);
    folder.write("w/line.csv", "");
    folder.write("w/line.old.states", "");
    // Of another case, by its longer name; a folder; a name that is not Unicode.
    folder.write("w/line-2.old.states", "");
    folder.make("w/line.folder.states");
    let strange = folder.path("w").join(std::ffi::OsStr::from_bytes(b"line.\xff.states"));
    std::fs::write(&strange, "").unwrap();
    std::fs::remove_file(folder.path("w/line.gtkw")).unwrap();
    let ran = folder.run("golden check w");
    assert_eq!(ran.code, 2, "{ran:?}");
    let text = folder.good("golden record w");
    let line = "line: new line.gtkw; changed line.csv; removed line.old.states; same line.beat.states, line.vcd";
    assert_eq!(text.lines().next(), Some(line));
    assert!(!folder.path("w/line.old.states").exists() && folder.path("w/line-2.old.states").exists());
    assert!(strange.exists() && folder.path("w/line.folder.states").exists());
    folder.good("golden check w");
    folder.write("w/line.old.states", "");
    let ran = folder.run("golden check w");
    assert!(ran.code == 1 && ran.err.contains("case line no longer makes line.old.states"), "{ran:?}");
}

#[test]
fn differences_of_tables_name_the_columns_and_the_step() {
    let folder = recorded(LINE);
    let good = folder.read("w/line.csv");
    let lines: Vec<&str> = good.lines().collect();
    for (text, hints) in [
        (
            good.replacen(lines[4], &lines[4].replacen(",0,", ",9,", 1), 1),
            vec!["line 5: recorded", "; step 3: column "],
        ),
        (good.replacen("clock", "cycle", 1), vec!["columns only recorded: cycle, only simulated: clock"]),
        (
            good.replace('\n', "\r\n"),
            vec!["recorded are lines that end with CR and LF, simulated lines that end with LF"],
        ),
        (good.trim_end().to_owned(), vec!["recorded are lines of which the last has no end, simulated lines"]),
        (good.replacen(lines[4], &format!("{},9", lines[4]), 1), vec!["; recorded are 11 columns, simulated 10"]),
        (lines[..8].join("\n"), vec!["line 9: recorded 'the end of the file'", "recorded are 7 rows, simulated 11"]),
    ] {
        assert_ne!(text, good);
        folder.write("w/line.csv", &text);
        let ran = folder.run("golden check w");
        assert_eq!(ran.code, 1, "{ran:?}");
        hints.iter().for_each(|hint| assert!(ran.err.contains(hint), "{hint}: {ran:?}"));
    }
}

#[test]
fn a_case_stays_in_its_folder() {
    let program =
        |name: &str| format!("[[case]]\nname = \"two\"\nprogram = {name:?}\nargs = [\"--method\", \"cim\"]\n");
    let folder = folder(LINE);
    folder.write("two.nc", "G01 X0.004 Y0.003 F600\n");
    std::os::unix::fs::symlink("../two.nc", folder.path("w/link.nc")).unwrap();
    let outside = folder.path("two.nc").display().to_string();
    for (name, hint) in [
        ("../two.nc", "the program ../two.nc is not in the folder w"),
        (outside.as_str(), "is not in the folder w"),
        ("link.nc", "the program link.nc is a link out of the folder w"),
    ] {
        folder.write("w/cases.toml", &program(name));
        let ran = folder.run("golden record w");
        assert!(ran.code == 2 && ran.err.contains(hint), "{name}: {ran:?}");
    }
    folder.write("w/in.nc", &folder.read("two.nc"));
    folder.write("w/cases.toml", &program("./in.nc"));
    folder.good("golden record w");
    std::fs::remove_file(folder.path("w/two.vcd")).unwrap();
    // A recorded file that leads elsewhere, and one that is the program.
    folder.write("w/cases.toml", LINE);
    folder.good("golden record w");
    std::fs::remove_file(folder.path("w/line.csv")).unwrap();
    folder.write("mine.csv", "mine\n");
    std::os::unix::fs::symlink("../mine.csv", folder.path("w/line.csv")).unwrap();
    for command in ["record", "check"] {
        let ran = folder.run(&format!("golden {command} w"));
        assert!(ran.code == 2 && ran.err.contains("w/line.csv is a link"), "{command}: {ran:?}");
    }
    assert_eq!(folder.read("mine.csv"), "mine\n");
    folder.write("w/two.csv", "G01 X0.004 Y0.003 F600\n");
    folder.write("w/cases.toml", &program("two.csv"));
    let ran = folder.run("golden record w");
    assert!(ran.code == 2 && ran.err.contains("two.csv, which this command reads"), "{ran:?}");
    assert_eq!(folder.read("w/two.csv"), "G01 X0.004 Y0.003 F600\n");
}

#[test]
fn golden_waves_and_merged_ones_take_no_viewer() {
    let folder = Folder::new();
    for words in ["golden record waves --viewer surfer", "golden check waves --viewer both"] {
        let ran = folder.run(words);
        assert_eq!(ran.code, 2);
        assert!(
            ran.err.contains("golden waves have the files of GTKWave") && ran.err.contains("leave --viewer out"),
            "{}",
            ran.err
        );
    }
    folder.good("run dda-line --to 8,6 --vcd a.vcd");
    let ran = folder.run("diff a.vcd a.vcd --merged m.vcd --viewer surfer");
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("a merged wave has no files for a viewer next to it: leave --viewer out"), "{}", ran.err);
    assert!(!folder.files().contains(&"m.vcd".to_owned()));
}
