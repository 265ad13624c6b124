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

/// Most threads of a computation for each core.
const MOST_THREADS_A_CORE: usize = 8;

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

/// More threads than MOST_THREADS_A_CORE that RAYON_NUM_THREADS asks for are not made: each costs memory, and more than
/// one for each core make nothing faster.
fn bound_threads() -> Result<(), Failure> {
    let most = MOST_THREADS_A_CORE * std::thread::available_parallelism().map_or(1, usize::from);
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|word| word.parse().ok());
    if asked.is_some_and(|threads: u128| threads > most as u128) {
        rayon::ThreadPoolBuilder::new().num_threads(most).build_global()?;
    }
    Ok(())
}
