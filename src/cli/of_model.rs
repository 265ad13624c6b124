//! The help of a command with a model: the options that this model takes alone.

use std::collections::BTreeSet;
use std::ffi::OsString;

use clap::{Args, Command, CommandFactory};

use super::{Cli, GeometryArgs, TextArgs};
use crate::commands::run::TEXTBOOK_MODELS;
use crate::models::options::{ACCEL, STEP, all};
use crate::models::{Model, find};
use crate::nc::{Drawn, SplineForm};

/// What `stepwave COMMAND MODEL --help` prints; `None` where these words ask for something else.
pub(crate) fn help_of_model(words: &[OsString]) -> Option<String> {
    // No name of a model or a command holds what is not Unicode.
    let words: Vec<&str> = words.iter().map(|word| word.to_str().unwrap_or_default()).collect();
    let [_, name, rest @ ..] = &words[..] else { return None };
    let asks = rest.iter().any(|word| *word == "--help" || *word == "-h");
    let model = rest.iter().find_map(|word| find(word).ok()).filter(|_| asks)?;
    let mut program = Cli::command();
    program.build();
    let command = program.find_subcommand(name)?;
    if !command.get_positionals().any(|argument| argument.get_id() == "model") {
        return None;
    }
    let usage = format!("stepwave {name} {} [OPTIONS]", model.name);
    Some(shortened(command.clone(), model).override_usage(usage).render_help().to_string())
}

/// The command without the options that this model refuses.
fn shortened(command: Command, model: &Model) -> Command {
    let taken: BTreeSet<&str> = model.options.iter().map(|option| option.name()).collect();
    let drawn = geometry(model);
    let of_program = TextArgs::augment_args(Command::new("program"));
    let of_geometry = GeometryArgs::augment_args(Command::new("geometry"));
    let has = |group: &Command, id: &str| group.get_arguments().any(|argument| argument.get_id() == id);
    let is_hardware = |id: &str| all().iter().any(|option| option.name() == id);
    let is_hidden = |id: &str| match id {
        "model" | "bench" | "program" | "method" => true,
        "feed" => !taken.contains(STEP.name),
        "event" => !taken.contains(ACCEL.name),
        "textbook" => !TEXTBOOK_MODELS.contains(&model.name),
        _ if is_hardware(id) => !taken.contains(id),
        _ if has(&of_geometry, id) => !drawn.contains(id),
        _ => has(&of_program, id),
    };
    let about = format!(
        "{}\n\nIt takes {}. `stepwave list {}` shows its registers and the source of the method.",
        model.title,
        model.curve().describe(),
        model.name
    );
    command.about(about).after_help("").mut_args(|argument| {
        let id = argument.get_id().as_str();
        let (hidden, hardware) = (is_hidden(id), is_hardware(id) || ["blu", "feed"].contains(&id));
        let argument = if hardware { argument.help_heading("Hardware") } else { argument };
        argument.hide(hidden)
    })
}

/// The options that give a curve of this model.
fn geometry(model: &Model) -> BTreeSet<&'static str> {
    let mut ids = BTreeSet::new();
    for drawn in model.curve().drawn() {
        ids.extend(Some(drawn.option().trim_start_matches("--")).filter(|option| !option.is_empty()));
        if !drawn.is_spline() {
            ids.extend(["from", "to"]);
        }
        if drawn.is_centered() {
            ids.extend(["center", "cw", "ccw"]);
        }
        if drawn.is_open() {
            ids.insert("opens");
        }
        match drawn {
            Drawn::Spline(SplineForm::BSpline) => ids.extend(["b_spline"]),
            Drawn::Nurbs => ids.extend(["degree", "knots"]),
            _ => {}
        }
    }
    ids
}
