//! A file appears whole or not at all.

use std::fs;
use std::os::unix::fs::{FileTypeExt, symlink};
use std::time::{Duration, Instant};

use super::{Folder, engines, good};

const BAD_RUNS: [&str; 5] = [
    "--vcd w.vcd --steps s.csv --trace-from 99999",
    "--vcd w.vcd --steps s.csv --trace zz*",
    "--vcd w.vcd --steps s.csv --json no/r.json",
    "--vcd w.vcd --steps s.csv --plot /dev/full",
    "--vcd /dev/full --steps s.csv --json w.vcd",
];

#[test]
fn files_that_were_there_stay_whole_when_a_run_fails() {
    for options in BAD_RUNS {
        let folder = Folder::new();
        folder.write("w.vcd", "the old wave\n");
        folder.write("s.csv", "the old table\n");
        let ran = folder.run(&format!("run ppc-line --to 6,4 {options}"));
        assert_eq!((ran.code, ran.err.lines().count()), (2, 1), "{options}: {ran:?}");
        assert_eq!(folder.files(), ["s.csv", "w.vcd"], "{options}");
        assert_eq!(folder.read("w.vcd") + &folder.read("s.csv"), "the old wave\nthe old table\n", "{options}");
    }
}

#[test]
fn files_that_were_there_are_replaced_when_a_run_is_good_or_trapped() {
    let folder = Folder::new();
    for (words, code) in [("run ppc-line --to 6,4", 0), ("run ppc-line --to 6,4 --width f=3", 1)] {
        folder.write("w.vcd", "the old wave\n");
        assert_eq!(folder.run(&format!("{words} --vcd w.vcd")).code, code);
        assert!(folder.read("w.vcd").starts_with("$version"), "{words}");
        assert_eq!(folder.files(), ["w.beat.states", "w.gtkw", "w.vcd"], "{words}");
    }
}

#[test]
fn a_killed_run_leaves_the_old_file_whole() {
    let folder = Folder::new();
    folder.write("w.vcd", "the old wave\n");
    let mut command = folder.command();
    // Far longer than this test waits.
    command.args("run ppc-line --to 2000000000,1999999999 --beats 1 --vcd w.vcd".split(' '));
    let mut child = command.spawn().unwrap();
    let written = || {
        let sizes =
            fs::read_dir(folder.path("")).unwrap().map(|entry| entry.unwrap().metadata().map_or(0, |file| file.len()));
        sizes.sum::<u64>()
    };
    let start = Instant::now();
    while written() < 100_000 && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let midway = written();
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(midway >= 100_000, "the run wrote {midway} bytes only");
    assert_eq!(folder.read("w.vcd"), "the old wave\n");
    assert!(
        folder.files().iter().all(|name| name == "w.vcd" || name.starts_with(".stepwave-")),
        "{:?}",
        folder.files()
    );
}

#[test]
fn a_link_is_kept_and_what_it_points_to_is_replaced() {
    let folder = Folder::new();
    folder.write("there.csv", "the old table\n");
    symlink("there.csv", folder.path("here.csv")).unwrap();
    folder.good("run ppc-line --to 2,1 --steps here.csv");
    assert!(folder.path("here.csv").is_symlink());
    assert!(folder.read("there.csv").starts_with("step,clock"));
}

#[test]
fn a_file_gets_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write("usual", "");
    folder.good("run ppc-line --to 2,1 --steps s.csv --vcd w.vcd");
    let mode = |name: &str| folder.path(name).metadata().unwrap().permissions().mode();
    for name in ["s.csv", "w.vcd", "w.gtkw", "w.beat.states"] {
        assert_eq!(mode(name), mode("usual"), "{name}");
    }
}

#[test]
fn a_file_that_is_replaced_keeps_its_mode() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    for (name, mode) in [("s.csv", 0o600), ("r.json", 0o664), ("w.vcd", 0o755), ("w.gtkw", 0o400)] {
        folder.write(name, "old\n");
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(mode)).unwrap();
    }
    folder.good("run ppc-line --to 2,1 --steps s.csv --json r.json --vcd w.vcd");
    for (name, mode) in [("s.csv", 0o600), ("r.json", 0o664), ("w.vcd", 0o755), ("w.gtkw", 0o400)] {
        assert_eq!(folder.path(name).metadata().unwrap().permissions().mode() & 0o777, mode, "{name}");
        assert_ne!(folder.read(name), "old\n", "{name}");
    }
}

#[test]
fn several_outputs_may_go_to_a_device_but_not_into_one_pipe() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 2,1 --vcd /dev/null --steps /dev/null --json /dev/null --plot /dev/zero");
    folder.good("sweep ppc-line --to-grid 0..5x0..5 --plot /dev/null --plot /dev/null");
    assert!(std::process::Command::new("mkfifo").arg(folder.path("pipe")).status().unwrap().success());
    // A reader, so that the first output does not wait for one.
    let pipe = fs::File::options().read(true).write(true).open(folder.path("pipe")).unwrap();
    let ran = folder.run("run ppc-line --to 2,1 --steps pipe --json ./pipe");
    assert!(ran.code == 2 && ran.err.contains("two outputs would go to ./pipe"), "{ran:?}");
    drop(pipe);
}

#[test]
fn a_name_with_blanks_and_unusual_letters_is_a_name_like_any_other() {
    let folder = Folder::new();
    let ran = folder.run_words(&["run", "ppc-line", "--to", "2,1", "--vcd", "eine Gerade 直线.vcd"]);
    assert_eq!(ran.code, 0, "{ran:?}");
    let files = ["eine Gerade 直线.beat.states", "eine Gerade 直线.gtkw", "eine Gerade 直线.vcd"];
    assert_eq!(folder.files(), files);
}

#[test]
fn the_null_device_stays_a_device_and_gets_no_files_next_to_it() {
    let folder = Folder::new();
    symlink("/dev/null", folder.path("null.vcd")).unwrap();
    for option in ["--vcd null.vcd", "--steps null.vcd", "--json null.vcd", "--plot null.vcd", "--vcd /dev/null"] {
        let printed = folder.good(&format!("run ppc-line --to 6,4 {option}"));
        assert!(printed.contains("reached exactly"), "{option}: {printed}");
        assert_eq!(folder.files(), ["null.vcd"], "{option}");
        assert!(folder.path("null.vcd").is_symlink(), "{option}");
    }
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    assert!(!fs::exists("/dev/null.gtkw").unwrap());
}

#[test]
fn a_full_device_is_named() {
    for option in ["--vcd", "--steps", "--json", "--plot"] {
        let folder = Folder::new();
        let ran = folder.run(&format!("run ppc-line --to 6,4 {option} /dev/full"));
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{option}");
        assert!(ran.err.starts_with("stepwave: cannot write /dev/full: "), "{option}: {}", ran.err);
        assert_eq!((ran.err.lines().count(), folder.files().len()), (1, 0), "{option}: {}", ran.err);
    }
}

#[test]
fn a_pipe_is_written_into() {
    let folder = Folder::new();
    let pipe = folder.path("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn(move || fs::read_to_string(pipe).unwrap());
    folder.good("run ppc-line --to 2,1 --vcd pipe");
    assert_eq!(reader.join().unwrap(), good("run ppc-line --to 2,1 --vcd -"));
    assert_eq!(folder.files(), ["pipe"]);
}

#[test]
fn two_runs_of_the_same_job_give_the_same_bytes() {
    let bytes = |engine: &str| {
        let folder = Folder::new();
        let out = "--vcd w.vcd --steps s.csv --plot p.svg";
        folder.good(&format!("run ppc-arc --from 6,0 --to 0,6 --ccw --engine {engine} {out}"));
        folder.files().iter().map(|name| (name.clone(), folder.read(name))).collect::<Vec<_>>()
    };
    let first = bytes("auto");
    for engine in engines().chain(["auto"]) {
        assert!(bytes(engine) == first, "{engine}");
    }
}
