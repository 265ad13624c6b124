//! `stepwave completions` and `stepwave man`: from the same definitions as `--help`.

use std::path::Path;

use clap::CommandFactory;

use crate::cli::Cli;
use crate::failure::Failure;
use crate::output::{self, Outputs};

/// Prints the completion script of a shell.
pub(crate) fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "stepwave", &mut script);
    output::print_data(&String::from_utf8_lossy(&script))
}

/// Writes a manual page for the program, for each command and for each command of a command.
pub(crate) fn manual(dir: &Path) -> Result<(), Failure> {
    let mut outputs = Outputs::default();
    // Pages speak of `stepwave help` in its own place; a page each for `help run`, `help list`, … would say nothing.
    let mut program = Cli::command().disable_help_subcommand(true);
    program.build();
    pages(&mut outputs, dir, &program, "stepwave")?;
    outputs.commit()
}

fn pages(outputs: &mut Outputs, dir: &Path, command: &clap::Command, name: &str) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone()).title(name.to_uppercase()).render(&mut text)?;
    outputs.write(&dir.join(format!("{name}.1")), &String::from_utf8_lossy(&text))?;
    for inner in command.get_subcommands() {
        pages(outputs, dir, inner, &format!("{name}-{}", inner.get_name()))?;
    }
    Ok(())
}
