//! The ending of a file and the option that writes it must agree.

use super::Folder;

#[test]
fn an_ending_of_another_format_is_refused_with_the_right_option() {
    let sweep = "sweep dda-line --to-grid 1..3x1..3";
    for (words, sentence) in [
        (
            "run dda-line --to 8,6 --vcd x.fst",
            "--vcd writes VCD, but x.fst has the ending of FST: give --fst x.fst, or x.vcd",
        ),
        (
            "run dda-line --to 8,6 --fst x.VCD",
            "--fst writes FST, but x.VCD has the ending of VCD: give --vcd x.VCD, or x.fst",
        ),
        ("run dda-line --to 8,6 --json x.csv", "but x.csv has the ending of CSV: give --steps x.csv, or x.json"),
        ("run dda-line --to 8,6 --steps sub/x.json", "give --json sub/x.json, or sub/x.csv"),
        ("run dda-line --to 8,6 --plot x.png", "--plot writes SVG, but x.png has the ending of PNG: give x.svg"),
        ("run dda-line --to 8,6 --checkpoints x.vcd --vcd w", "give --vcd x.vcd, or x.json"),
        ("run dda-line --to 8,6 --vcd part.ngc", "has the ending of an NC program: give part.vcd"),
        (
            "program a.ngc --method ppc --steps x.parquet",
            "--steps writes CSV, but x.parquet has the ending of Parquet: give x.csv",
        ),
        ("export dda-line --to 8,6 --verilog x.btor2", "give --btor2 x.btor2, or x.v"),
        ("export dda-line --to 8,6 --smt2 x.v", "give --verilog x.v, or x.smt2"),
        ("prove ppc-line --vcd x.fst", "--vcd writes VCD, but x.fst has the ending of FST: give x.vcd"),
        ("prove ppc-line --certificate x.vcd", "give --vcd x.vcd, or a name with another ending"),
        ("diff a.vcd b.vcd --merged x.fst", "--merged writes VCD, but x.fst has the ending of FST: give x.vcd"),
        (&format!("{sweep} --csv x.parquet"), "give --parquet x.parquet, or x.csv"),
        (&format!("{sweep} --parquet x.csv"), "give --csv x.csv, or x.parquet"),
        (&format!("{sweep} --plot x.json"), "--plot writes SVG or PNG, but x.json has the ending of JSON: give x.svg"),
        ("sweep merge x.vcd a.csv", "writes CSV or Parquet, but x.vcd has the ending of VCD"),
    ] {
        let folder = Folder::new();
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(sentence), "{words}: {ran:?}");
        assert_eq!(folder.files(), [""; 0], "{words}");
    }
}

#[test]
fn other_names_are_left_to_the_user() {
    for options in [
        "--vcd x.txt",
        "--vcd x",
        "--vcd x.v.vcd",
        "--vcd .fst",
        "--steps x.dat",
        "--json x.JSON",
        "--plot /dev/null",
        "--steps -",
    ] {
        let ran = Folder::new().run(&format!("run dda-line --to 8,6 {options}"));
        assert_eq!(ran.code, 0, "{options}: {ran:?}");
    }
}

#[test]
fn what_o_writes_is_what_the_option_for_such_files_writes() {
    let own = Folder::new();
    own.good(
        "run dda-line --to 8,6 -w 4 --vcd a.vcd --html a.html --steps a.csv --json a.json --plot a.svg --fst a.fst",
    );
    let short = Folder::new();
    let out =
        short.good("run dda-line --to 8,6 -w 4 -o a.vcd -oa.html --output a.csv --output=a.json -o a.svg -o a.fst -q");
    assert_eq!(out, "");
    for file in ["a.vcd", "a.gtkw", "a.csv", "a.svg"] {
        assert_eq!(short.read(file), own.read(file), "{file}");
    }
    for file in ["a.html", "a.json", "a.fst"] {
        assert!(short.path(file).exists(), "{file}");
    }
    let same = |words: &str, short_words: &str, file: &str| {
        own.good(words);
        short.good(short_words);
        assert_eq!(short.read(file), own.read(file), "{words}");
    };
    same("export dda-line --to 8,6 --verilog d.v", "export dda-line --to 8,6 -q -o d.v", "d.v");
    same("export dda-line --to 8,6 --schematic d.svg", "export dda-line --to 8,6 -o d.svg", "d.svg");
    same("sweep dda-line --to-grid 1..3x1..3 --csv s.csv", "sweep dda-line --to-grid 1..3x1..3 -o s.csv -q", "s.csv");
}

#[test]
fn a_name_that_does_not_say_what_it_holds_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    for (words, hint) in [
        (
            "run dda-line --to 8,6 -o a.txt",
            "the ending of a.txt does not say what -o is to write: give one of .vcd, .fst, .csv, .json, .svg, .html",
        ),
        ("run dda-line --to 8,6 -o -", "the ending of - does not say"),
        ("run dda-line --to 8,6 -o --vcd", "the ending of --vcd does not say"),
        ("run dda-line --to 8,6 -o a.v", "the ending of a.v does not say"),
        ("run dda-line --to 8,6 -o a.png", "the ending of a.png does not say"),
        ("run dda-line --to 8,6 -o a.vcd -o b.vcd", "cannot be used multiple times"),
        ("run dda-line --to 8,6 -o", "a value is required for '--output <FILE>'"),
        ("widths dda-line --box 3 -o a.csv", "unexpected argument '-o'"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
    }
    assert_eq!(folder.files(), [""; 0]);
}

/// A folder with programs of these names that write their words into a file.
#[cfg(unix)]
fn viewers(folder: &Folder, names: &[&str]) -> String {
    use std::os::unix::fs::PermissionsExt;
    folder.make("bin");
    for name in names {
        let own = format!("bin/{name}");
        folder.write(&own, &format!("#!/bin/sh\necho {name} \"$@\" >>{}\n", folder.path("opened").display()));
        std::fs::set_permissions(folder.path(&own), std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder.path("bin").display().to_string()
}

#[test]
#[cfg(unix)]
fn open_starts_the_viewer_of_what_was_written_also_of_a_trap() {
    let folder = Folder::new();
    let path = viewers(&folder, &["gtkwave", "surfer", "xdg-open"]);
    let run = |words: &str, lines: &[&str], code: i32| {
        let _ = std::fs::remove_file(folder.path("opened"));
        let ran = folder.command().env("PATH", &path).args(words.split_whitespace()).output().unwrap();
        assert_eq!(ran.status.code(), Some(code), "{words}: {ran:?}");
        // The programs run by themselves.
        let deadline = std::time::Instant::now() + std::time::Duration::from_secs(20);
        loop {
            let text = std::fs::read_to_string(folder.path("opened")).unwrap_or_default();
            let mut opened: Vec<&str> = text.lines().collect();
            opened.sort_unstable();
            if opened == lines {
                break;
            }
            assert!(std::time::Instant::now() < deadline, "{words}: {opened:?}");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    };
    run("run dda-line --to 8,6 -o a.vcd --open", &["gtkwave a.gtkw"], 0);
    run("run ppc-line --to 6,4 --width f=3 -o t.vcd --open -q", &["gtkwave t.gtkw"], 1);
    run("run dda-line --to 8,6 -o a.vcd -o a.fst --open", &["gtkwave a.fst.gtkw", "gtkwave a.gtkw"], 0);
    run("run dda-line --to 8,6 -o a.fst --viewer surfer --open", &["surfer --command-file a.sucl a.fst"], 0);
    run("run dda-line --to 8,6 -o a.html -o a.svg --open", &["xdg-open a.html", "xdg-open a.svg"], 0);
}

#[test]
fn open_without_a_file_or_a_viewer_is_refused_with_its_remedy() {
    let folder = Folder::new();
    let ran = folder.run("run dda-line --to 8,6 --open --steps -");
    assert!(ran.code == 2 && ran.err.contains("there is nothing to show: give -o FILE.vcd"), "{ran:?}");
    let mut command = folder.command();
    command.env("PATH", folder.path("none")).args(["run", "dda-line", "--to", "8,6", "-o", "a.vcd", "--open"]);
    let ran = command.output().unwrap();
    let err = String::from_utf8(ran.stderr).unwrap();
    assert!(
        ran.status.code() == Some(2)
            && err.contains("gtkwave cannot be started")
            && err.contains("by hand: gtkwave a.gtkw"),
        "{err}"
    );
    assert!(folder.path("a.vcd").exists());
}
