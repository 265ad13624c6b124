//! `stepwave widths`: the least width of every register, with its evidence.

use std::fmt::Write as _;

use crate::models::Model;
use crate::models::options::WIDTH;
use crate::models::parts::{E, POSITION};
use crate::report::run_command;
use crate::study::widths::{Known, RegisterWidth, Widths, Witness, widths};
use serde_json::{Value, json};

use super::progress::Progress;
use crate::Error;
use crate::cli::WidthsArgs;
use crate::output;

/// Prints the table; a width that is given and too narrow is a failed check.
pub(crate) fn run(args: &WidthsArgs) -> Result<(), Error> {
    let model = args.bench.model(&args.model)?;
    let choices = args.hardware.choices();
    let progress = Progress::new("geometries");
    let found = widths(model, &choices, &args.extent, &|more| progress.add(more));
    progress.finish();
    let found = found.map_err(|error| args.hardware.explain_study(error))?;
    if args.json { output::print_data(&as_json(model, &found)) } else { output::print(&table(model, &found)) }?;
    // Those of a netlist are given in its source.
    let given = choices.of_all(&WIDTH).is_some() || !choices.of_single(&WIDTH).is_empty() || model.is_described();
    if !given {
        return Ok(());
    }
    let short = found.registers.iter().filter(|register| register.given < register.needed);
    let sentences: Vec<String> = short.map(|register| too_narrow(model, register)).collect();
    if sentences.is_empty() { Ok(()) } else { Err(Error::Check(sentences)) }
}

/// What is wrong with a width that is given, in a sentence.
fn too_narrow(model: &Model, register: &RegisterWidth) -> String {
    let RegisterWidth { name, given, needed, .. } = register;
    let more = if register.known == Known::AtLeast { " or more" } else { "" };
    let bits = if *given == 1 { "bit" } else { "bits" };
    let needs = format!("{name} of {given} {bits} is too narrow, it needs {needed}{more}");
    match &register.fault {
        Some(fault) => format!("{needs}: {}", command(model, fault)),
        None if register.known != Known::Enough || *given < register.shown => needs,
        None => format!("{name} of {given} {bits} is not proved to be enough, {needed} bits are"),
    }
}

/// How a width is known, in a word, or by the share of the geometries that say so.
pub(super) fn evidence(register: &RegisterWidth) -> String {
    let word = match register.known {
        Known::Proved => "proved",
        Known::ProvedHere => "proved at k",
        Known::Exhaustive => "exhaustive",
        Known::Part(ran, all) => return format!("{ran} of {all}"),
        Known::Sampled => "sampled",
        Known::Enough => "enough",
        Known::AtLeast => "at least",
    };
    word.to_owned()
}

fn command(model: &Model, witness: &Witness) -> String {
    run_command(model, &witness.curve, &witness.choices)
}

/// What happens one bit below, by the command that shows it.
pub(super) fn one_bit_below(model: &Model, register: &RegisterWidth) -> String {
    let shown = register.shown;
    match &register.witness {
        Some(witness) if register.shown < register.needed => {
            format!("not known; {shown} bits are needed: {}", command(model, witness))
        }
        Some(witness) if !witness.ran => format!("{} (at the end of a long run)", command(model, witness)),
        Some(witness) => command(model, witness),
        None => "nothing that a run shows".to_owned(),
    }
}

/// The bits that a register needs, by the bits of coordinates; of a ramp only what counts pulses depends on these.
fn relative(model: &Model, register: &RegisterWidth, k: u32) -> String {
    if model.width_is_of_phase() && ![E.name(), POSITION.of(0).name()].contains(&&*register.name) {
        return String::new();
    }
    match i64::from(register.needed) - i64::from(k) {
        0 => "k".to_owned(),
        more => format!("k{more:+}"),
    }
}

/// Which geometries speak for the widths.
fn scope(model: &Model, found: &Widths) -> String {
    let Widths { simulated, extent, .. } = found;
    let (name, ran) = (model.name, found.ran());
    let many = if found.all { "all of the box" } else { "the extreme ones of the box" };
    // What a proof says of all of them does not depend on runs that were followed in part.
    let by_runs = |register: &RegisterWidth| {
        [Known::Sampled, Known::AtLeast].contains(&register.known) || matches!(register.known, Known::Part(..))
    };
    if ran == *simulated || !found.registers.iter().any(by_runs) {
        return format!("{name}: {simulated} geometries of {extent}, {many}\n\n");
    }
    let these = if found.all { "all that run" } else { "the extreme ones that run" };
    format!("{name}: {ran} of {simulated} geometries of {extent}, {these} to their end\n\n")
}

fn table(model: &Model, found: &Widths) -> String {
    let mut text = scope(model, found);
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:<10} {:>5} {:>6}  {:<6} {:<24} {:<11} one bit below",
        "register", "given", "needed", "", "values", "known"
    );
    for register in &found.registers {
        let values = format!("{} to {}", register.range.0, register.range.1);
        let _ = writeln!(
            text,
            "{:<10} {:>5} {:>6}  {:<6} {values:<24} {:<11} {}",
            register.name,
            register.given,
            register.needed,
            relative(model, register, found.k),
            evidence(register),
            one_bit_below(model, register),
        );
    }
    if found.faults > 0 {
        let what = match model.is_described() {
            true => "cannot be loaded or do not end; what registers held until then counts",
            false => "overflow or never end at the default widths and are left out: what they need is not known",
        };
        let _ = writeln!(text, "\n{} geometries {what}", found.faults);
    }
    if found.registers.iter().any(|register| register.known == Known::AtLeast) {
        text +=
            "\nat least: results did not fit, and what the register held after the first says nothing of a wider one\n";
    }
    if found.missed > 0 {
        let _ =
            writeln!(text, "\n{} geometries end, but miss their end points; what registers held counts", found.missed);
    }
    if found.cut > 0 {
        let Widths { cut, limit, .. } = found;
        let _ = writeln!(text, "\n{cut} geometries had not ended after {limit} clocks, and were followed no further");
    }
    text
}

/// A value of a register as a number.
fn number(value: i128) -> Value {
    i64::try_from(value).map(Value::from).or_else(|_| u64::try_from(value).map(Value::from)).unwrap_or(Value::Null)
}

/// Registers with their widths and what is known of them.
pub(super) fn registers_json(model: &Model, registers: &[RegisterWidth]) -> Vec<Value> {
    let one = |register: &RegisterWidth| {
        json!({
            "name": register.name,
            "given": register.given,
            "needed": register.needed,
            "shown": register.shown,
            "least": number(register.range.0),
            "greatest": number(register.range.1),
            "known": evidence(register),
            "one_bit_below": register.witness.as_ref().map(|witness| command(model, witness)),
            "fault": register.fault.as_ref().map(|fault| command(model, fault)),
        })
    };
    registers.iter().map(one).collect()
}

fn as_json(model: &Model, found: &Widths) -> String {
    let all = json!({
        "model": model.name,
        "box": found.extent.to_string(),
        "bits": found.k,
        "geometries": found.simulated,
        "ran": found.ran(),
        "all": found.all && found.ran() == found.simulated,
        "faults": found.faults,
        "followed_in_part": found.cut,
        "followed_clocks": found.limit,
        "missed_end_points": found.missed,
        "registers": registers_json(model, &found.registers),
    });
    format!("{all:#}\n")
}
