//! The progress line, on a pseudo terminal that `script` of util-linux makes.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::Folder;

/// Runs the program with its standard error on a terminal; gives what it drew there, and how long it took.
fn drawn(words: &str) -> (String, Duration) {
    let folder = Folder::new();
    let command = format!("stty cols 100; {} {words} >out", env!("CARGO_BIN_EXE_stepwave"));
    let start = Instant::now();
    let mut script = Command::new("script");
    script.args(["-qec", &command, "/dev/null"]).current_dir(folder.path("")).env("TERM", "xterm");
    let output = script.stdin(Stdio::null()).output().expect("`script` of util-linux is there");
    (String::from_utf8(output.stdout).expect("UTF-8"), start.elapsed())
}

/// Makes the work larger until it takes long enough to draw a line more than once; gives what was drawn last.
fn at_length(words: impl Fn(u64) -> String) -> (String, Duration) {
    let mut size = 1 << 4;
    loop {
        let (text, taken) = drawn(&words(size));
        if taken > Duration::from_millis(1500) {
            return (text, taken);
        }
        size *= if taken < Duration::from_millis(300) { 8 } else { 2 };
    }
}

/// The numbers in front of a word.
fn numbers(text: &str, word: &str) -> Vec<f64> {
    let before = text.match_indices(word).map(|(at, _)| text[..at].rsplit([' ', '(']).next().unwrap_or_default());
    before.filter_map(|number| number.replace(',', "").parse().ok()).collect()
}

#[test]
fn a_long_run_shows_clocks_at_their_true_rate_and_per_cent_and_leaves_nothing() {
    let (text, taken) = at_length(|size| format!("run dda-line --to {0},{0} --preset half", size * 1000));
    let (clocks, rates) = (numbers(&text, " clocks ("), numbers(&text, " clocks/s"));
    assert!(!clocks.is_empty() && clocks.len() == rates.len(), "{text:?}");
    for (clocks, rate) in clocks.iter().zip(&rates) {
        // The first line comes after a second, the last before the end.
        assert!(*rate <= clocks * 1.01 && *rate >= clocks / taken.as_secs_f64() * 0.99, "{clocks} {rate} {text:?}");
    }
    let shares = numbers(&text, " %)");
    assert!(shares.iter().all(|share| (0.0..=100.0).contains(share)) && shares.is_sorted(), "{text:?}");
    // The last thing is that the line is cleared.
    let rest = text.rsplit(" left").next().unwrap();
    assert!(rest.contains("\u{1b}[2K") && !rest.contains("clocks"), "{text:?}");
}

#[test]
fn a_sweep_counts_its_geometries() {
    let (text, _) = at_length(|size| format!("sweep stepgen --to-grid 0..{size}x0..{size} --csv rows.csv"));
    assert!(!numbers(&text, " geometries (").is_empty() && text.contains(" geometries/s, "), "{text:?}");
}

#[test]
fn short_work_draws_nothing_and_neither_does_work_without_a_terminal() {
    let (text, _) = drawn("list");
    assert_eq!(text, "");
    let ran = Folder::new().run("run dda-line --to 20000000,1");
    assert_eq!(ran.err.lines().count(), usize::from(ran.code != 0), "{ran:?}");
}
