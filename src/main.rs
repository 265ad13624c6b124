//! The program `stepwave`: parse, dispatch, print the error, set the exit code.

mod cli;
mod commands;
mod failure;
mod output;
mod stop;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use crate::cli::Cli;
use crate::failure::Failure;

/// Most threads of a computation.
const MOST_THREADS: usize = 256;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            // Nothing is left to be done where standard error is gone too.
            let _ = writeln!(std::io::stderr(), "{failure}");
            ExitCode::from(failure.code())
        }
    }
}

fn run() -> Result<(), Failure> {
    stop::watch()?;
    bound_threads()?;
    match Cli::try_parse() {
        Ok(cli) => commands::dispatch(&cli),
        Err(error) if error.use_stderr() => Err(Failure::usage(&error)),
        Err(help) => output::print(&help.render().to_string()),
    }
}

/// More threads than MOST_THREADS that RAYON_NUM_THREADS asks for are not made: each costs memory, and beyond the number
/// of cores none makes anything faster.
fn bound_threads() -> Result<(), Failure> {
    let asked = std::env::var("RAYON_NUM_THREADS").ok().filter(|word| word.bytes().all(|c| c.is_ascii_digit()));
    let many = asked.is_some_and(|word| word.parse().is_ok_and(|threads: u128| threads > MOST_THREADS as u128));
    if many {
        rayon::ThreadPoolBuilder::new().num_threads(MOST_THREADS).build_global()?;
    }
    Ok(())
}
