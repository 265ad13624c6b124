//! The rows of a sweep on their way, and the parts of a sweep: no link leads them elsewhere, nothing of others is taken
//! over, and what was changed is noticed.

use std::fs;
use std::os::unix::fs::symlink;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::Folder;

const SWEEP: &str = "sweep ppc-line --to-grid 0..49x0..49";

#[test]
fn a_link_in_the_place_of_the_stage_leads_nowhere() {
    for name in [".o.csv.sweep.part", ".o.csv.sweep.journal"] {
        for kind in ["link", "dangling", "hard", "folder", "foreign"] {
            let folder = Folder::new();
            folder.make("home");
            folder.write("home/secret", "theirs\n");
            let (victim, stage) = (folder.path("home/secret"), folder.path(name));
            match kind {
                "link" => symlink("home/secret", &stage).unwrap(),
                "dangling" => symlink("home/new", &stage).unwrap(),
                "hard" => fs::hard_link(&victim, &stage).unwrap(),
                "folder" => fs::create_dir(&stage).unwrap(),
                _ => fs::write(&stage, "theirs\n").unwrap(),
            }
            for resume in ["", " --resume"] {
                let ran = folder.run(&format!("{SWEEP} --csv o.csv{resume}"));
                let what = format!("{name} {kind}{resume}: {ran:?}");
                assert!(ran.code == 2 && ran.err.lines().count() == 1, "{what}");
                assert!(ran.err.contains(name) && ran.err.contains("delete it, or name another file"), "{what}");
                assert_eq!(folder.files(), [name, "home"], "{what}");
                assert_eq!(folder.read("home/secret"), "theirs\n", "{what}");
                assert_eq!(fs::read_dir(folder.path("home")).unwrap().count(), 1, "{what}");
                if kind == "foreign" {
                    assert_eq!(folder.read(name), "theirs\n", "{what}");
                }
            }
        }
    }
}

/// With one digit of the first row from this line on changed into another.
fn changed(text: &str, line: usize) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let row = &mut lines[line - 1];
    let place = row.rfind(|c: char| c.is_ascii_digit()).unwrap();
    let digit = if row.as_bytes()[place] == b'7' { "8" } else { "7" };
    row.replace_range(place..=place, digit);
    lines.join("\n") + "\n"
}

#[test]
fn a_changed_digit_in_a_part_is_noticed_with_its_file_and_lines() {
    let folder = Folder::new();
    for part in [1, 2] {
        folder.good(&format!("{SWEEP} --shard {part}/2 --csv {part}.csv"));
    }
    let good = folder.read("2.csv");
    // The first line that a part begins with, its heading, 1000 rows, their check, 250 rows and the end.
    assert_eq!(good.lines().count(), 2 + 1000 + 1 + 250 + 1);
    for (line, hint) in [
        (3, "lines 1 to 1002 are not as they were written"),
        (700, "lines 1 to 1002 are not as they were written"),
        (1003, "lines 1 to 1002 are not as they were written, or line 1003"),
        (1004, "lines 1004 to 1253 are not as they were written"),
        (1253, "lines 1004 to 1253 are not as they were written"),
        (1254, "lines 1004 to 1253 are not as they were written, or line 1254"),
    ] {
        folder.write("x.csv", &changed(&good, line));
        let ran = folder.run("sweep merge all.csv 1.csv x.csv");
        assert!(ran.code == 2 && ran.err.contains("x.csv") && ran.err.contains(hint), "{line}: {ran:?}");
        assert!(!folder.path("all.csv").exists(), "{line}");
    }
    folder.good("sweep merge all.csv 2.csv 1.csv");
    folder.good(&format!("{SWEEP} --csv whole.csv"));
    assert!(folder.read("all.csv") == folder.read("whole.csv"));
}

#[test]
fn a_changed_byte_in_a_part_in_parquet_never_makes_another_row() {
    let folder = Folder::new();
    let sweep = "sweep ppc-line --to-grid 0..9x0..9";
    for part in [1, 2] {
        folder.good(&format!("{sweep} --shard {part}/2 --parquet {part}.parquet"));
    }
    folder.good("sweep merge whole.csv 1.parquet 2.parquet");
    let (good, whole) = (fs::read(folder.path("2.parquet")).unwrap(), folder.read("whole.csv"));
    let mut refused = 0;
    for place in (4..good.len()).step_by(good.len() / 150) {
        let mut bytes = good.clone();
        bytes[place] ^= 1;
        fs::write(folder.path("x.parquet"), bytes).unwrap();
        let output = folder.command().args("sweep merge all.csv 1.parquet x.parquet".split(' ')).output().unwrap();
        if output.status.success() {
            assert!(folder.read("all.csv") == whole, "{place}");
        } else {
            refused += 1;
        }
    }
    assert!(refused > 50, "{refused}");
}

/// A sweep that was killed after some chunks, and its stage.
fn stopped(folder: &Folder, words: &str) -> [String; 2] {
    let mut child =
        folder.command().args(words.split(' ')).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    let journal = folder.path(".s.csv.sweep.journal");
    while fs::read_to_string(&journal).unwrap_or_default().lines().count() < 2 {
        assert!(begun.elapsed() < Duration::from_secs(300) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    [".s.csv.sweep.part", ".s.csv.sweep.journal"].map(|name| folder.read(name))
}

#[test]
fn a_changed_digit_in_a_stage_is_noticed_and_the_sweep_begins_anew_on_request() {
    for shard in ["", " --shard 1/2"] {
        let folder = Folder::new();
        let words = format!("sweep dda-line --to-grid 0..127x0..127 --width 11{shard}");
        folder.good(&format!("{words} --csv whole.csv"));
        let [part, journal] = stopped(&folder, &format!("{words} --csv s.csv"));
        let restore = || {
            folder.write(".s.csv.sweep.part", &part);
            folder.write(".s.csv.sweep.journal", &journal);
        };
        let refused = |name: &str, text: String, hint: &str| {
            restore();
            folder.write(name, &text);
            let ran = folder.run(&format!("{words} --csv s.csv --resume"));
            assert!(ran.code == 2 && ran.err.contains(name) && ran.err.contains(hint), "{hint}: {ran:?}");
            assert!(ran.err.contains("leave --resume out to begin anew"), "{ran:?}");
            assert!(!folder.path("s.csv").exists());
        };
        refused(".s.csv.sweep.part", changed(&part, 5), "lines 1 to ");
        refused(".s.csv.sweep.part", part.replacen('\n', " ", 1), "lines 1 to ");
        for digit in ["geometries\":", "rows\":", "bytes\":"] {
            let (head, marks) = journal.split_once('\n').unwrap();
            let (before, after) = marks.split_once(digit).unwrap();
            let first = if after.starts_with('9') { "8" } else { "9" };
            let text = format!("{head}\n{before}{digit}{first}{}", &after[1..]);
            refused(".s.csv.sweep.journal", text, "line 2 is not as it was written");
        }
        // A line that was not written whole does not count.
        restore();
        folder.write(".s.csv.sweep.journal", &journal[..journal.len() - 5]);
        folder.good(&format!("{words} --csv s.csv --resume"));
        assert!(folder.read("s.csv") == folder.read("whole.csv"));
        restore();
        folder.write(".s.csv.sweep.part", &changed(&part, 5));
        folder.good(&format!("{words} --csv s.csv"));
        assert!(folder.read("s.csv") == folder.read("whole.csv"));
        assert_eq!(folder.files(), ["s.csv", "whole.csv"]);
    }
}

#[test]
fn a_stage_of_another_user_is_left_alone() {
    let folder = Folder::new();
    stopped(&folder, "sweep dda-line --to-grid 0..127x0..127 --width 11 --csv s.csv");
    // Only root can give files away.
    let given = Command::new("chown").args(["12345", ".s.csv.sweep.journal"]).current_dir(folder.path("")).status();
    if given.is_ok_and(|status| status.success()) {
        let ran = folder.run("sweep dda-line --to-grid 0..127x0..127 --width 11 --csv s.csv --resume");
        assert!(ran.code == 2 && ran.err.contains("it is another user's"), "{ran:?}");
    }
}
