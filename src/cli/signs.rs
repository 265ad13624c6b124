//! Values that begin with a minus, which clap would take for options.

use std::ffi::{OsStr, OsString};

use clap::{Arg, Command};

/// The words of a command line with an option and its value in one, `--feed=-5`, where the value begins like a number below
/// zero: the parser of the option says what is wrong with it. No option begins so.
pub(crate) fn with_signs(words: Vec<OsString>, program: impl FnOnce() -> Command) -> Vec<OsString> {
    if !words.iter().any(|word| is_negative(word)) {
        return words;
    }
    let mut program = program();
    program.build();
    let mut command = &program;
    for word in &words[1..] {
        match command.find_subcommand(word) {
            Some(inner) => command = inner,
            None => break,
        }
    }
    let mut joined: Vec<OsString> = Vec::new();
    for word in words {
        match joined.last_mut() {
            Some(option) if is_negative(&word) && takes_value(command, option) => {
                option.push("=");
                option.push(word);
            }
            _ => joined.push(word),
        }
    }
    joined
}

/// It begins as `-5`, `-0.5` or `-.5`.
fn is_negative(word: &OsStr) -> bool {
    matches!(word.as_encoded_bytes(), [b'-', b'0'..=b'9', ..] | [b'-', b'.', b'0'..=b'9', ..])
}

/// This word is an option of the command that a value follows.
fn takes_value(command: &Command, word: &OsStr) -> bool {
    let Some(word) = word.to_str() else { return false };
    let is_named = |arg: &Arg| match word.strip_prefix("--") {
        Some(long) => arg.get_long() == Some(long),
        None => arg.get_short().is_some_and(|short| word == format!("-{short}")),
    };
    command.get_arguments().any(|arg| is_named(arg) && arg.get_action().takes_values())
}
