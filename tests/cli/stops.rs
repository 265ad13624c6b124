//! Runs that are stopped: by a signal, by a reader that leaves, by a disk that is full. No half file and no temporary one
//! is left, and what is kept is said.

use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::Folder;

/// Far longer than these tests wait.
const LONG: &str = "run ppc-line --to 2000000000,1999999999 --beats 1";
const SWEEP: &str = "sweep dda-line --to-grid 0..127x0..127 --width 11";

/// Waits until it is so.
fn wait(what: &str, mut so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !so() {
        assert!(begun.elapsed() < Duration::from_secs(300), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn started(folder: &Folder, words: &str) -> Child {
    let mut command = folder.command();
    command.args(words.split(' ')).stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// A long run that has written something, and nothing but temporary files.
fn writing(folder: &Folder) -> Child {
    let child = started(folder, &format!("{LONG} --vcd w.vcd --steps s.csv --json r.json"));
    wait("the run writes", || {
        let written = |name: &String| folder.path(name).metadata().is_ok_and(|found| found.len() > 100_000);
        let prefix = format!(".stepwave-{}-", child.id());
        folder.files().iter().any(|name| name.starts_with(&prefix) && written(name))
    });
    child
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args(["-s", name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

fn errors(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn a_signal_takes_the_temporary_files_away_and_ends_with_its_code() {
    for (name, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        let folder = Folder::new();
        folder.write("w.vcd", "the old wave\n");
        let child = writing(&folder);
        signal(&child, name);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{name}");
        assert_eq!(errors(&output), format!("stepwave: stopped by SIG{name}: no output was written\n"));
        assert_eq!((folder.files(), folder.read("w.vcd")), (vec!["w.vcd".to_owned()], "the old wave\n".to_owned()));
    }
}

#[test]
fn a_signal_that_was_ignored_from_the_start_as_by_nohup_stays_ignored() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_stepwave");
    let script = format!("trap '' HUP; exec {program} {LONG} --vcd w.vcd");
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder.path(""))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait("the run writes", || folder.files().iter().any(|name| name.starts_with(".stepwave-")));
    signal(&child, "HUP");
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none());
    signal(&child, "TERM");
    assert_eq!(child.wait().unwrap().code(), Some(143));
}

#[test]
fn the_next_run_takes_away_what_a_killed_one_has_left_and_nothing_else() {
    let folder = Folder::new();
    let mut killed = writing(&folder);
    killed.kill().unwrap();
    killed.wait().unwrap();
    let left: Vec<String> = folder.files();
    assert_eq!(left.len(), 3, "{left:?}");
    let mut live = writing(&folder);
    let of_live: Vec<String> = folder.files();
    assert!(of_live.len() == 3 && of_live.iter().all(|name| !left.contains(name)), "{left:?} {of_live:?}");
    // Files of others that look alike: of a living process, of no process, a link, a folder.
    let own = std::process::id();
    for name in [&format!(".stepwave-{own}-abcdefgh.part"), ".stepwave-notes.part", ".stepwave-1-abc.part"] {
        folder.write(name, "");
    }
    std::os::unix::fs::symlink("elsewhere", folder.path(".stepwave-4000000-abcdefgh.part")).unwrap();
    let before = folder.files();
    folder.good("run ppc-line --to 2,1 --steps t.csv");
    let after: Vec<String> = folder.files().into_iter().filter(|name| name != "t.csv").collect();
    assert_eq!(after, before);
    live.kill().unwrap();
    live.wait().unwrap();
    folder.good("run ppc-line --to 2,1 --steps t.csv");
    assert!(folder.files().iter().all(|name| !of_live.contains(name)), "{:?}", folder.files());
}

/// Geometries that the journal of a sweep says are done.
fn done(folder: &Folder) -> u64 {
    let text = fs::read_to_string(folder.path(".s.csv.sweep.journal")).unwrap_or_default();
    let mark = text.lines().skip(1).last().and_then(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    mark.and_then(|mark| mark["geometries"].as_u64()).unwrap_or(0)
}

#[test]
fn a_sweep_that_is_stopped_says_that_its_rows_are_kept() {
    let folder = Folder::new();
    folder.good(&format!("{SWEEP} --csv whole.csv"));
    let child = started(&folder, &format!("{SWEEP} --csv s.csv --plot p.svg"));
    wait("a chunk is done", || done(&folder) > 0);
    signal(&child, "INT");
    let output = child.wait_with_output().unwrap();
    let (words, count) = (errors(&output), done(&folder));
    assert_eq!(output.status.code(), Some(130), "{words}");
    let kept = format!("{count} of 16384 geometries are done and kept: the same command with --resume goes on");
    assert_eq!(words, format!("stepwave: stopped by SIGINT: {kept}\n"));
    assert_eq!(folder.files(), [".s.csv.sweep.journal", ".s.csv.sweep.part", "whole.csv"]);
    folder.good(&format!("{SWEEP} --csv s.csv --resume"));
    assert!(folder.read("s.csv") == folder.read("whole.csv"));
}

/// Runs the program where no file may have more bytes.
fn limited(folder: &Folder, bytes: u64, words: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_stepwave");
    let script = format!("exec prlimit --fsize={bytes} {program} {words}");
    Command::new("sh").args(["-c", &script]).current_dir(folder.path("")).output().unwrap()
}

#[test]
fn a_counterexample_whose_wave_cannot_be_written_leaves_no_half_of_it() {
    for words in [
        "prove ppc-arc --narrower f=1",
        "prove ppc-line --width x=8 --box 8",
        "prove ppc-line --width f=4 --box 5 --on-overflow wrap",
    ] {
        let folder = Folder::new();
        let output = limited(&folder, 1024, &format!("{words} --vcd w.vcd"));
        let words = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(words.starts_with("stepwave: cannot write w.vcd: ") && words.lines().count() == 1, "{words}");
        assert_eq!(folder.files(), [""; 0], "{words}");
    }
}

#[test]
fn a_sweep_that_may_write_no_more_keeps_its_rows_and_says_so() {
    let folder = Folder::new();
    folder.good(&format!("{SWEEP} --csv whole.csv"));
    let all = folder.path("whole.csv").metadata().unwrap().len();
    let output = limited(&folder, all / 4 * 3, &format!("{SWEEP} --csv s.csv"));
    let (words, count) = (errors(&output), done(&folder));
    assert_eq!(output.status.code(), Some(2), "{words}");
    assert!(count > 0 && words.starts_with("stepwave: cannot write ") && words.lines().count() == 1, "{words}");
    assert!(words.contains(&format!("{count} of 16384 geometries are done and kept: ")), "{words}");
    assert_eq!(folder.files(), [".s.csv.sweep.journal", ".s.csv.sweep.part", "whole.csv"]);
    folder.good(&format!("{SWEEP} --csv s.csv --resume"));
    assert!(folder.read("s.csv") == folder.read("whole.csv"));
    // With nothing done there is nothing to be kept, and a run leaves nothing either.
    for words in [format!("{SWEEP} --csv t.csv"), "run ppc-line --to 4000,3000 --vcd t.csv --steps u.csv".to_owned()] {
        let output = limited(&folder, 512, &words);
        assert_eq!((output.status.code(), errors(&output).lines().count()), (Some(2), 1), "{output:?}");
        assert!(!errors(&output).contains("kept"), "{output:?}");
        assert_eq!(folder.files(), ["s.csv", "whole.csv"], "{words}");
    }
}

#[test]
fn a_reader_that_leaves_ends_the_run_at_once_and_no_file_is_left() {
    for words in [
        format!("{LONG} --steps - --vcd w.vcd --json r.json"),
        format!("{LONG} --vcd -"),
        format!("{LONG} --steps /dev/stdout"),
        format!("{SWEEP} --csv - --plot p.svg"),
    ] {
        let folder = Folder::new();
        let mut command = folder.command();
        let mut child = command.args(words.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        BufReader::with_capacity(64, child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        assert!(!first.is_empty(), "{words}");
        let left = Instant::now();
        let output = child.wait_with_output().unwrap();
        assert!(left.elapsed() < Duration::from_secs(60), "{words}");
        // As `yes | head -1` ends: by SIGPIPE.
        assert_eq!((output.status.signal(), errors(&output).as_str()), (Some(13), ""), "{words}");
        assert_eq!(folder.files(), [""; 0], "{words}");
    }
}

#[test]
fn a_reader_that_leaves_ends_a_run_that_writes_nothing_else_and_no_other() {
    for (words, ends) in [
        (LONG.to_owned(), true),
        (format!("{LONG} --json -"), true),
        ("widths dda-conic --box 8".to_owned(), true),
        (format!("{LONG} --json r.json"), false),
    ] {
        let folder = Folder::new();
        let mut command = folder.command();
        let mut child = command.args(words.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        if ends {
            wait("the run ends", || child.try_wait().unwrap().is_some());
            let output = child.wait_with_output().unwrap();
            assert_eq!((output.status.signal(), errors(&output).as_str()), (Some(13), ""), "{words}");
        } else {
            std::thread::sleep(Duration::from_millis(500));
            assert!(child.try_wait().unwrap().is_none(), "{words}");
            child.kill().unwrap();
            child.wait().unwrap();
        }
    }
}

#[test]
fn a_large_wave_is_reported_before_it_is_written_where_it_may_be() {
    for (option, large, unit) in [("X100", " --large", " GB; "), ("X5", "", " MB; ")] {
        let folder = Folder::new();
        folder.write("p.ngc", &format!("G1 {option} F60\n"));
        let words = format!("program p.ngc --method ppc --every-clock --vcd -{large}");
        let mut command = folder.command();
        let mut child = command.args(words.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = String::new();
        BufReader::with_capacity(64, child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        let message = errors(&child.wait_with_output().unwrap());
        assert!(first.starts_with("$version") && message.lines().count() == 1, "{first}{message}");
        assert!(message.starts_with("stepwave: the wave will have about ") && message.contains(unit), "{message}");
        assert!(["--trace-steps", "--every-clock", "--fst"].iter().all(|hint| message.contains(hint)), "{message}");
    }
}

/// A process that waits for nothing but its parent.
fn is_gone(process: &str) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/status", process.trim())).unwrap_or_default();
    status.lines().find(|line| line.starts_with("State:")).is_none_or(|state| state.contains('Z'))
}

#[test]
fn a_solver_ends_with_all_that_it_has_started_after_its_time_and_with_its_asker() {
    use std::os::unix::fs::PermissionsExt;
    for seconds in ["1", "300"] {
        let folder = Folder::new();
        folder.write("solver", "#!/bin/sh\nsleep 300 &\necho $! > new\nmv new started\nwait\n");
        fs::set_permissions(folder.path("solver"), fs::Permissions::from_mode(0o755)).unwrap();
        let child = started(&folder, &format!("prove ppc-line --solver ./solver --solver-seconds {seconds}"));
        wait("the solver works", || folder.path("started").exists());
        let own = folder.read("started");
        if seconds == "300" {
            assert!(!is_gone(&own));
            signal(&child, "TERM");
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(if seconds == "300" { 143 } else { 0 }), "{}", errors(&output));
        wait("what the solver has started ends", || is_gone(&own));
    }
}

#[test]
fn a_closed_standard_output_ends_every_command_as_it_ends_other_tools() {
    let folder = Folder::new();
    for words in
        ["list", "list --json", "run ppc-line --to 6,4", "run ppc-line --to 6,4 --vcd -", "completions bash", "--help"]
    {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = folder.command().args(words.split(' ')).stdout(writer).output().unwrap();
        assert_eq!((output.status.signal(), errors(&output).as_str()), (Some(13), ""), "{words}");
    }
}

#[test]
fn a_number_of_threads_beyond_all_bounds_is_bounded() {
    let folder = Folder::new();
    let mut command = folder.command();
    let words = format!("{SWEEP} --csv s.csv");
    let mut child =
        command.env("RAYON_NUM_THREADS", "1000000").args(words.split(' ')).stdout(Stdio::null()).spawn().unwrap();
    wait("a chunk is done", || done(&folder) > 0 || folder.path("s.csv").exists());
    let threads = fs::read_dir(format!("/proc/{}/task", child.id())).map_or(0, Iterator::count);
    let cores = std::thread::available_parallelism().unwrap().get();
    assert!(child.wait().unwrap().success() && threads < 8 * cores + 8, "{threads}");
}
