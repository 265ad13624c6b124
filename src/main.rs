//! The program `stepwave`: the commands over the models of the catalogue.

use std::process::ExitCode;

fn main() -> ExitCode {
    stepwave::main_with(stepwave::models::catalogue())
}
