//! `stepwave widths`: the least width of every register, with its evidence.

use std::fmt::Write as _;

use serde_json::json;
use stepwave::models::{Model, find};
use stepwave::report::run_command;
use stepwave::study::widths::{Known, RegisterWidth, Widths, widths};

use super::progress::Progress;
use crate::cli::WidthsArgs;
use crate::failure::Failure;
use crate::output;

/// Prints the table.
pub(crate) fn run(args: &WidthsArgs) -> Result<(), Failure> {
    let model = find(&args.model)?;
    let progress = Progress::new("geometries");
    let found =
        widths(model, &args.hardware.choices(), &args.extent).map_err(|error| args.hardware.told_of_study(error))?;
    progress.finish();
    output::print(&if args.json { as_json(model, &found) } else { table(model, &found) })
}

fn known(register: &RegisterWidth) -> &'static str {
    match register.known {
        Known::Proved => "proved",
        Known::ProvedHere => "proved at k",
        Known::Exhaustive => "exhaustive",
        Known::Sampled => "sampled",
    }
}

fn below(model: &Model, register: &RegisterWidth) -> Option<String> {
    register.witness.as_ref().map(|(curve, choices)| run_command(model, curve, choices))
}

fn relative(bits: u32, k: u32) -> String {
    match i64::from(bits) - i64::from(k) {
        0 => "k".to_owned(),
        more => format!("k{more:+}"),
    }
}

fn table(model: &Model, found: &Widths) -> String {
    let many = if found.all { "all" } else { "some" };
    let mut text = format!("{}: {} geometries of {}, {many} of the box\n\n", model.name, found.simulated, found.extent);
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:<10} {:>5} {:>6}  {:<6} {:<24} {:<11} one bit below",
        "register", "given", "needed", "", "values", "known"
    );
    for register in &found.registers {
        let values = format!("{} to {}", register.range.0, register.range.1);
        let below = below(model, register).unwrap_or_else(|| "nothing that a run shows".to_owned());
        let _ = writeln!(
            text,
            "{:<10} {:>5} {:>6}  {:<6} {values:<24} {:<11} {below}",
            register.name,
            register.given,
            register.needed,
            relative(register.needed, found.k),
            known(register),
        );
    }
    if found.faults > 0 {
        let _ =
            writeln!(text, "\n{} geometries overflow or never end at the given widths and are left out", found.faults);
    }
    text
}

fn as_json(model: &Model, found: &Widths) -> String {
    let registers = found.registers.iter().map(|register| {
        json!({
            "name": register.name,
            "given": register.given,
            "needed": register.needed,
            "least": register.range.0.to_string(),
            "greatest": register.range.1.to_string(),
            "known": known(register),
            "one_bit_below": below(model, register),
        })
    });
    let all = json!({
        "model": model.name,
        "box": found.extent.to_string(),
        "bits": found.k,
        "geometries": found.simulated,
        "all": found.all,
        "faults": found.faults,
        "registers": registers.collect::<Vec<_>>(),
    });
    format!("{all:#}\n")
}
