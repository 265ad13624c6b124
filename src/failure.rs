//! How a command fails: with which exit code, and in which words.

use std::error::Error;
use std::fmt;

use clap::CommandFactory;
use clap::error::ErrorKind;

use crate::cli::Cli;
use crate::output::shown;

/// A command did not end well.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The simulated hardware failed a check, or a comparison differs: exit code 1. One sentence a line.
    Check(Vec<String>),
    /// Bad input or usage, or a file cannot be read or written: exit code 2.
    Trouble(String),
    /// The same with an extract of a file, in lines.
    Extract(String),
    /// No command was given: the help, exit code 2.
    Help(String),
}

impl Failure {
    /// The exit code of the process.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Failure::Check(_) => 1,
            Failure::Trouble(_) | Failure::Extract(_) | Failure::Help(_) => 2,
        }
    }

    /// A usage error, in one line: what is wrong, and where to read on. Without a command, the help.
    pub(crate) fn usage(error: &clap::Error) -> Failure {
        let text = error.render().to_string();
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Failure::Help(text.trim_end().to_owned());
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
        let program = Cli::command();
        // Not `args`, which panics on what is not Unicode.
        let command = std::env::args_os().nth(1).and_then(|word| word.into_string().ok());
        let command = command.filter(|word| program.find_subcommand(word).is_some());
        let command = command.unwrap_or_default();
        let help = format!("stepwave {command}").trim_end().to_owned();
        Failure::Trouble(format!("{sentence} (see `{help} --help`)"))
    }
}

/// One line without control characters, whatever the words that it quotes hold.
fn one_line(sentence: &str) -> String {
    shown(&sentence.replace(['\n', '\r'], " ")).into_owned()
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Check(sentences) => {
                let line = |sentence: &String| format!("stepwave: {}", one_line(sentence));
                let lines: Vec<_> = sentences.iter().map(line).collect();
                f.write_str(&lines.join("\n"))
            }
            Failure::Trouble(sentence) => write!(f, "stepwave: {}", one_line(sentence)),
            Failure::Extract(text) => {
                let lines: Vec<_> = text.lines().map(one_line).collect();
                write!(f, "stepwave: {}", lines.join("\n"))
            }
            Failure::Help(text) => f.write_str(text),
        }
    }
}

/// Every error of a library is trouble; it keeps its own words.
impl<E: Into<Box<dyn Error + Send + Sync>>> From<E> for Failure {
    fn from(error: E) -> Failure {
        Failure::Trouble(error.into().to_string())
    }
}
