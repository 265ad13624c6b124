//! What all contenders have in common.

use std::path::Path;
use std::process::Command;

use crate::Fallible;

/// What a run writes next to its result.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Wave {
    /// Nothing.
    None,
    /// Every named net and the clock, as VCD.
    Vcd,
    /// The same as FST.
    Fst,
}

/// Runs a command that only prepares.
pub(crate) fn shell(dir: &Path, command: &str) -> Fallible<()> {
    let output = Command::new("sh").args(["-c", command]).current_dir(dir).output()?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(format!("in {}: {command}: {said}", dir.display()).into())
}

/// The first line that a program prints.
pub(crate) fn first_line(program: &str, words: &[&str]) -> String {
    let output = Command::new(program).args(words).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().next().unwrap_or("not found").to_owned()
}
