//! One file per subcommand, thin: it joins the command line with the library.

mod compare;
pub(crate) mod diff;
mod export;
mod geometry;
mod golden;
mod list;
mod pages;
mod program;
mod progress;
mod prove;
mod run;
mod size;
mod states;
mod sweep;
mod wave;
mod widths;

use crate::cli::{Cli, Command};
use crate::failure::Failure;

/// Runs the command that was given.
///
/// # Errors
/// Whatever ends the process with an exit code other than 0.
pub(crate) fn dispatch(cli: &Cli) -> Result<(), Failure> {
    match &cli.command {
        Command::List(args) => list::run(args),
        Command::Run(args) => run::run(args),
        Command::Program(args) => program::program(args),
        Command::Sweep(args) => sweep::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Widths(args) => widths::run(args),
        Command::Prove(args) => prove::run(args),
        Command::Diff(args) => diff::run(args),
        Command::Export(args) => export::run(args),
        Command::Golden(command) => golden::run(command),
        Command::Completions { shell } => pages::completions(*shell),
        Command::Man { dir } => pages::manual(dir),
    }
}
