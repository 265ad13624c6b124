//! Options that say more of another one, which is missing.
//!
//! Clap demands what an option requires only where nothing given excludes that, so such an option would be ignored.

use std::ffi::OsString;

use clap::Command;
use clap::builder::Resettable;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;

/// Words that this program takes; it has taken them once, which has built what is known of their command.
///
/// # Errors
/// An option says more of one that is not given.
pub(super) fn check(program: &Command, words: &[OsString]) -> Result<(), clap::Error> {
    let Some(name) = words.get(1).and_then(|word| word.to_str()) else { return Ok(()) };
    let Some(command) = program.find_subcommand(name) else { return Ok(()) };
    let groups: Vec<String> = command.get_groups().map(|group| group.get_id().to_string()).collect();
    let command = command.clone().mut_args(|arg| arg.conflicts_with(Resettable::Reset).required(false));
    let command = groups.iter().fold(command, |command, group| command.mut_group(group, |group| group.multiple(true)));
    let Err(error) = command.clone().try_get_matches_from(&words[1..]) else { return Ok(()) };
    let (ErrorKind::MissingRequiredArgument, Some(ContextValue::Strings(missing))) =
        (error.kind(), error.get(ContextKind::InvalidArg))
    else {
        return Ok(());
    };
    let Some(option) = lone(&command, words) else { return Ok(()) };
    let missing = missing.join(", ");
    let sentence = format!("{option} says more of {missing}, which is missing: leave {option} out");
    Err(clap::Error::raw(ErrorKind::MissingRequiredArgument, sentence))
}

/// The first option given that alone makes the command line incomplete.
fn lone(command: &Command, words: &[OsString]) -> Option<String> {
    let free = command.clone().mut_args(|arg| arg.requires(Resettable::Reset));
    let matches = free.try_get_matches_from(&words[1..]).ok()?;
    let given = |id: &&clap::Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
    let alone = |id: &&clap::Id| {
        let others_free =
            command.clone().mut_args(|arg| if arg.get_id() == *id { arg } else { arg.requires(Resettable::Reset) });
        others_free.try_get_matches_from(&words[1..]).is_err()
    };
    let id = matches.ids().filter(given).find(alone)?;
    let argument = command.get_arguments().find(|argument| argument.get_id() == id)?;
    Some(argument.get_long().map_or_else(|| id.to_string(), |long| format!("--{long}")))
}
