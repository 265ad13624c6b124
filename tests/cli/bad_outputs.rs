//! Outputs that cannot be written, and waves that would show nothing, are refused; no file is left.

use super::{Folder, refused, run_refused};

#[test]
fn a_trigger_must_be_a_signal_of_one_bit() {
    refused("run dda-line --to 8,6 --vcd w.vcd --trace-on nope", &["--trace-on", "no signal 'nope'"]);
    refused("run dda-line --to 8,6 --vcd w.vcd --trace-on jrx", &["--trace-on", "jrx has 4 bits", "1 bit wide"]);
    refused("run dda-line --to 8,6 --vcd w.vcd --trace-on dda_line.axis_x.dx", &["has 2 bits"]);
    let both = "give one of dda_line.axis_x.carry, dda_line.axis_y.carry";
    refused("run dda-line --to 8,6 --vcd w.vcd --trace-on carry", &["'carry' is the name of several signals", both]);
}

#[test]
fn a_trigger_may_be_given_by_its_name_its_path_or_the_end_of_its_path() {
    let wave = |name: &str| {
        let folder = Folder::new();
        folder.good(&format!("run dda-line --to 8,6 --vcd w.vcd --trace-on {name}"));
        folder.read("w.vcd")
    };
    assert_eq!(wave("axis_y.carry"), wave("dda_line.axis_y.carry"));
    assert_ne!(wave("axis_y.carry"), wave("axis_x.carry"));
    assert_eq!(wave("done"), wave("dda_line.block.done"));
}

#[test]
fn a_trigger_that_never_comes_leaves_no_wave() {
    let hint = "the wave would be empty: no clock from 0 to 17 of this run falls into its window";
    refused("run dda-line --to 8,6 --vcd w.vcd --trace-on x_add_overflow", &[hint]);
}

#[test]
fn a_window_that_no_clock_falls_into_leaves_no_wave() {
    for window in ["--trace-from 18", "--trace-from 18446744073709551615", "--trace-from 10 --trace-to 9"] {
        let hint = "the wave would be empty: no clock from 0 to 17 of this run falls into its window";
        refused(&format!("run dda-line --to 8,6 --vcd w.vcd {window}"), &[hint]);
    }
    for window in
        ["--trace-from -1", "--trace-to x", "--trace-from 1.5", "--trace-depth 0", "--trace-to 99999999999999999999"]
    {
        run_refused(&format!("dda-line --to 8,6 {window}"), &[window.split(' ').nth(1).unwrap()]);
    }
}

#[test]
fn patterns_that_leave_nothing_or_cannot_be_read_are_refused() {
    refused("run dda-line --to 8,6 --vcd w.vcd --trace zz*", &["no signal is called 'zz*'"]);
    refused("run dda-line --to 8,6 --vcd w.vcd --trace-exclude *", &["no signal is left to trace", "leave out '*'"]);
    for pattern in ["a[", "[z-a]", "{a"] {
        for option in ["--trace", "--trace-exclude"] {
            let hint = format!("invalid name pattern '{pattern}'");
            refused(&format!("run dda-line --to 8,6 --vcd w.vcd {option} {pattern}"), &[&hint]);
        }
    }
}

#[test]
fn options_of_the_wave_without_a_wave_are_refused() {
    for option in [
        "--trace x",
        "--trace-exclude x",
        "--trace-depth 1",
        "--trace-from 0",
        "--trace-to 5",
        "--trace-on done",
        "--no-clk",
    ] {
        refused(&format!("run dda-line --to 8,6 {option} --steps s.csv"), &["--vcd <FILE>"]);
    }
}

#[test]
fn a_folder_that_does_not_exist_is_named() {
    for option in ["--vcd", "--steps", "--json", "--plot"] {
        refused(
            &format!("run dda-line --to 8,6 {option} no/where/f"),
            &["cannot write no/where/f", "folder no/where does not exist"],
        );
        refused(&format!("run dda-line --to 8,6 {option} nowhere/"), &["cannot write nowhere/", "no such folder"]);
    }
    refused("man no/where", &["cannot write no/where/stepwave.1", "folder no/where does not exist"]);
}

#[test]
fn one_output_that_cannot_be_written_keeps_all_others_from_being_written() {
    for bad in ["no/f", "nowhere/", "."] {
        refused(
            &format!("run ppc-line --to 6,4 --vcd w.vcd --steps s.csv --json r.json --plot {bad}"),
            &["cannot write"],
        );
        refused(&format!("run ppc-line --to 6,4 --vcd {bad} --steps s.csv --json - --plot p.svg"), &["cannot write"]);
    }
    let long = "n".repeat(300);
    refused(&format!("run ppc-line --to 6,4 --vcd w.vcd --steps {long}"), &["cannot write", &long]);
    // The wave's name fits, those of the files next to it do not.
    let long = "n".repeat(250);
    refused(&format!("run ppc-line --to 6,4 --vcd {long}.vcd --steps s.csv"), &["cannot write", &long]);
}

/// Wants a run refused in a folder with `sub/` and `file`, and both left as they were.
fn refused_with(words: &str, hint: &str) {
    let folder = Folder::new();
    folder.make("sub");
    folder.write("file", "old\n");
    let ran = folder.run(words);
    assert!(ran.code == 2 && ran.err.starts_with("stepwave: ") && ran.err.lines().count() == 1, "{words}: {ran:?}");
    assert!(ran.err.contains(hint) && ran.out.is_empty(), "{words}: {ran:?}");
    assert_eq!((folder.files(), folder.read("file")), (vec!["file".to_owned(), "sub".to_owned()], "old\n".to_owned()));
    assert_eq!(std::fs::read_dir(folder.path("sub")).expect("the folder").count(), 0, "{words}");
}

#[test]
fn a_folder_is_no_target() {
    for option in ["--vcd", "--steps", "--json", "--plot"] {
        for target in ["sub", "sub/", "./sub/../sub"] {
            let hint = format!("cannot write {target}: it is a folder");
            refused_with(&format!("run dda-line --to 8,6 {option} {target}"), &hint);
        }
    }
}

#[test]
fn a_path_through_a_file_is_no_target() {
    for target in ["file/w.vcd", "file/"] {
        refused_with(&format!("run dda-line --to 8,6 --vcd {target}"), &format!("cannot write {target}: "));
    }
    refused_with("man file", "cannot write file/stepwave.1: ");
}

#[test]
fn two_outputs_to_one_file_are_refused_however_it_is_written() {
    for (first, second) in [
        ("--vcd w", "--steps w"),
        ("--steps s", "--json ./s"),
        ("--json sub/../s", "--plot s"),
        ("--steps file", "--json ./file"),
        ("--vcd w.vcd", "--steps w.gtkw"),
        ("--vcd w.gtkw", ""),
    ] {
        refused_with(&format!("run dda-line --to 8,6 {first} {second}"), "two outputs would go to ");
    }
    refused_with("run ppc-line --to 6,4 --vcd w.vcd --plot w.beat.states", "two outputs would go to w.beat.states");
}

#[test]
fn waves_that_cannot_be_read_are_named() {
    refused("diff no.vcd no.vcd", &["no.vcd: cannot be read"]);
    refused("golden check", &["cannot read waves/cases.toml"]);
}
