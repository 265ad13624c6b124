//! The program `stepwave`: parse, dispatch, print the error, set the exit code.

mod cli;
mod commands;
mod failure;
mod output;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use crate::cli::Cli;
use crate::failure::Failure;

fn main() -> ExitCode {
    let result = match Cli::try_parse() {
        Ok(cli) => commands::dispatch(&cli),
        Err(error) if error.use_stderr() => Err(Failure::usage(&error)),
        Err(help) => output::print(&help.render().to_string()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // Nothing is left to be done where standard error is gone too.
            let _ = writeln!(std::io::stderr(), "{failure}");
            ExitCode::from(failure.code())
        }
    }
}
