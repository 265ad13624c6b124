//! One file per subcommand, thin: it joins the command line with the library.

mod clockless;
mod columns;
mod compare;
pub(crate) mod diff;
mod export;
mod geometry;
mod golden;
mod list;
mod machine;
mod own;
mod pages;
pub(crate) mod program;
mod progress;
mod prove;
pub(crate) mod run;
mod schematic;
pub(crate) mod show;
mod size;
mod sweep;
mod view;
mod widths;

use std::path::{Path, PathBuf};

use crate::Error;
use crate::cli::{Cli, Command, GoldenCommand};
use crate::simulation::FileOptions;
use crate::stop;
use crate::waves::WaveOptions;

/// Runs the command that was given.
///
/// # Errors
/// Whatever ends the process with an exit code other than 0.
pub(crate) fn dispatch(cli: &Cli) -> Result<(), Error> {
    if only_prints(&cli.command) {
        stop::watch_reader();
    }
    match &cli.command {
        Command::List(args) => list::run(args),
        Command::Run(args) => run::run(args),
        Command::Program(args) => program::program(args),
        Command::Sweep(args) => sweep::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Widths(args) => widths::run(args),
        Command::Machine(args) => machine::run(args),
        Command::Prove(args) => prove::run(args),
        Command::Diff(args) => diff::run(args),
        Command::Show(args) => show::run(args),
        Command::Export(args) => export::run(args),
        Command::Import(args) => own::import(args),
        Command::Check(args) => own::check(args),
        Command::Sim(args) => own::sim(args),
        Command::Golden(command) => golden::run(command),
        Command::Completions { shell } => pages::completions(*shell),
        Command::Man { dir } => pages::manual(dir),
    }
}

/// Nothing comes of a command but what it writes on standard output.
fn only_prints(command: &Command) -> bool {
    let traced = |args: &WaveOptions| [args.vcd.clone(), args.fst.clone(), args.html.clone()];
    let written = |args: &FileOptions| [args.steps.clone(), args.json.clone(), args.plot.clone()];
    let files: Vec<Option<PathBuf>> = match command {
        Command::Run(args) => {
            let own = [args.checkpoints.clone()];
            traced(&args.trace).into_iter().chain(written(&args.outputs)).chain(own).collect()
        }
        Command::Program(args) => traced(&args.trace).into_iter().chain(written(&args.outputs)).collect(),
        Command::Sweep(args) if args.command.is_none() => {
            let table = &args.outputs;
            table.plot.iter().cloned().map(Some).chain([table.csv.clone(), table.parquet.clone()]).collect()
        }
        Command::Sim(args) => traced(&args.trace).into_iter().chain([args.json.clone()]).collect(),
        Command::Prove(args) => vec![args.certificate.clone(), args.vcd.clone()],
        Command::Diff(args) => vec![args.merged.clone()],
        Command::Compare(args) => vec![args.html.clone()],
        Command::Show(_) | Command::Widths(_) | Command::Machine(_) | Command::Golden(GoldenCommand::Check(_)) => {
            Vec::new()
        }
        _ => return false,
    };
    files.iter().flatten().all(|file| file == Path::new("-"))
}
