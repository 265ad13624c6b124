//! What clap has to say about a command line, in one line.

use clap::CommandFactory;
use clap::error::ErrorKind;

use super::Cli;
use super::show::as_given;
use crate::Error;

/// A usage error, in one line: what is wrong, and where to read on. Without a command, the help.
pub(crate) fn usage(mut error: clap::Error) -> Error {
    let program = Cli::command();
    // Not `args`, which panics on what is not Unicode.
    let command = std::env::args_os().nth(1).and_then(|word| word.into_string().ok());
    let command = command.filter(|word| program.find_subcommand(word).is_some());
    let command = command.unwrap_or_default();
    if command == "show" {
        as_given(&mut error);
    }
    let text = error.render().to_string();
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return Error::Help(text.trim_end().to_owned());
    }
    // The first paragraph says what is wrong; tips and usage follow.
    let paragraph: Vec<&str> = text.lines().take_while(|line| !line.trim().is_empty()).map(str::trim).collect();
    let sentence = paragraph.join(" ");
    let mut sentence = sentence.strip_prefix("error: ").unwrap_or(&sentence).to_owned();
    // That a word after `--` is a value is seldom what was meant.
    let tips = text.lines().filter_map(|line| line.trim().strip_prefix("tip: "));
    for tip in tips.filter(|tip| !tip.starts_with("to pass ")) {
        sentence += &format!("; {tip}");
    }
    if error.kind() == ErrorKind::InvalidUtf8
        && let Some(word) = std::env::args_os().find(|word| word.to_str().is_none())
    {
        sentence = format!("'{}' is not Unicode: only names of files may be any bytes", word.to_string_lossy());
    }
    let help = format!("stepwave {command}").trim_end().to_owned();
    Error::Invalid(format!("{sentence} (see `{help} --help`)"))
}
