//! The program as its users meet it: what it prints and where, what it writes, and the exit code it ends with.

mod bad_geometry;
mod bad_hardware;
mod bad_outputs;
mod checkpoints;
mod choices;
mod completions;
mod endings;
mod files;
#[cfg(unix)]
mod follow;
mod golden;
mod html;
mod inputs;
mod machine;
mod models;
mod nearest;
mod nurbs;
mod outputs;
mod overflow;
mod pages;
mod parts;
mod pictures;
mod progress;
mod ramps;
mod ranges;
mod sampled;
mod show;
mod signs;
mod speed_row;
mod splines;
mod stages;
mod stepgen_bresenham;
mod stops;
mod sweep;
mod sweep_curves;
mod sweep_ripple;
#[cfg(unix)]
mod synth;
mod tables;
mod terminal;
mod tolerance;
mod waves;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;
use stepwave::engine::EngineKind;

/// What a run of the program came to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Ran {
    /// Exit code.
    pub(crate) code: i32,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

impl Ran {
    fn new(output: Output) -> Ran {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program prints UTF-8");
        let ran = Ran {
            code: output.status.code().expect("the program ends by itself"),
            out: text(output.stdout),
            err: text(output.stderr),
        };
        assert!((0..=2).contains(&ran.code) && !ran.err.contains("panicked"), "{ran:?}");
        ran
    }
}

/// An empty folder in which the program runs.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a folder"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stepwave"));
        command.current_dir(self.0.path());
        command
    }

    /// Runs the program with these words, which stand apart by blanks.
    pub(crate) fn run(&self, words: &str) -> Ran {
        self.run_words(&words.split_whitespace().collect::<Vec<_>>())
    }

    /// Runs the program with exactly these words.
    pub(crate) fn run_words(&self, words: &[&str]) -> Ran {
        Ran::new(self.command().args(words).output().expect("the program starts"))
    }

    /// Runs the program and expects a good end with nothing on standard error; returns standard output.
    pub(crate) fn good(&self, words: &str) -> String {
        let ran = self.run(words);
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "stepwave {words}");
        ran.out
    }

    /// Names of all files, hidden ones too, in order.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn make(&self, name: &str) {
        fs::create_dir(self.path(name)).expect("a folder");
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("a file");
    }
}

/// Names of the engines.
fn engines() -> impl Iterator<Item = &'static str> {
    EngineKind::ALL.into_iter().map(EngineKind::name)
}

/// Runs the program in a folder of its own, as [`Folder::good`].
fn good(words: &str) -> String {
    Folder::new().good(words)
}

/// The report of a run that ends well.
fn report(words: &str) -> Value {
    let text = good(&format!("run {words} --json -"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{words}: {error}: {text}"))
}

/// Wants the words refused as bad input: exit code 2, one line on standard error that holds every hint, nothing on
/// standard output, no file.
fn refused(words: &str, hints: &[&str]) {
    refused_words(&words.split_whitespace().collect::<Vec<_>>(), hints);
}

fn refused_words(words: &[&str], hints: &[&str]) {
    let folder = Folder::new();
    let ran = folder.run_words(words);
    let what = format!("stepwave {words:?}: {ran:?}");
    assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{what}");
    assert!(ran.err.starts_with("stepwave: ") && ran.err.ends_with('\n') && ran.err.lines().count() == 1, "{what}");
    for hint in hints {
        assert!(ran.err.contains(hint), "'{hint}' is missing: {what}");
    }
    assert_eq!(folder.files(), [""; 0], "{what}");
}

/// As [`refused`], for a run that would write every kind of output.
fn run_refused(words: &str, hints: &[&str]) {
    refused(&format!("run {words} --vcd w.vcd --steps s.csv --json r.json --plot p.svg"), hints);
}

/// A step table in CSV.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Csv {
    heading: Vec<String>,
    rows: Vec<Vec<i64>>,
}

impl Csv {
    fn parse(text: &str) -> Csv {
        let mut lines = text.lines().map(|line| line.split(','));
        let heading: Vec<String> = lines.next().expect("a heading").map(str::to_owned).collect();
        let number = |word: &str| word.parse().unwrap_or_else(|_| panic!("'{word}' in {text}"));
        let rows: Vec<Vec<i64>> = lines.map(|line| line.map(number).collect()).collect();
        assert!(rows.iter().all(|row| row.len() == heading.len()), "{text}");
        Csv { heading, rows }
    }

    /// The table that a good run writes.
    fn of(words: &str) -> Csv {
        Csv::parse(&good(&format!("run {words} --steps -")))
    }

    fn column(&self, name: &str) -> Vec<i64> {
        let column = self.heading.iter().position(|heading| heading == name);
        let column = column.unwrap_or_else(|| panic!("no column {name} in {:?}", self.heading));
        self.rows.iter().map(|row| row[column]).collect()
    }

    /// Numbers of the steps in which this axis pulses.
    fn pulses(&self, axis: &str) -> Vec<i64> {
        let steps = self.column("step").into_iter().zip(self.column(&format!("d{axis}")));
        steps.filter(|(_, pulse)| *pulse != 0).map(|(step, _)| step).collect()
    }

    /// The pulses of every step in words: `X -Y X-Y`.
    fn moves(&self) -> String {
        let word = |pulse: i64, letter: &str| match pulse {
            0 => String::new(),
            -1 => format!("-{letter}"),
            _ => letter.to_owned(),
        };
        let pulses = self.column("dx").into_iter().zip(self.column("dy")).skip(1);
        pulses.map(|(dx, dy)| word(dx, "X") + &word(dy, "Y")).collect::<Vec<_>>().join(" ")
    }

    /// Machine positions of the plane.
    fn path(&self) -> Vec<(i64, i64)> {
        self.column("x").into_iter().zip(self.column("y")).collect()
    }
}
