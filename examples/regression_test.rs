//! A regression test on golden waves, as it would be a file of `tests/` in a project of one's own:
//!
//! ```sh
//! cargo test --example regression_test
//! BLESS=1 cargo test --example regression_test   # records what is new or has changed
//! ```
//!
//! `waves/cases.toml` lists the runs. A difference fails the test with file, clock and signal; `git diff` shows what a
//! blessing has changed.

#![allow(clippy::print_stdout, reason = "an example prints")]

use stepwave::Error;

/// The folder that holds `cases.toml` and the recorded waves.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/waves");

/// Checks all waves, or records them where `BLESS` is set; says what came of it.
fn waves_are_as_recorded() -> Result<String, Error> {
    if std::env::var_os("BLESS").is_some() {
        return stepwave::golden::record(FOLDER);
    }
    stepwave::golden::check(FOLDER).map(|cases| format!("{cases} cases are as recorded, bit by bit\n"))
}

#[test]
fn golden_waves() {
    waves_are_as_recorded().unwrap_or_else(|differences| panic!("{differences}"));
}

fn main() -> Result<(), Error> {
    print!("{}", waves_are_as_recorded()?);
    Ok(())
}
