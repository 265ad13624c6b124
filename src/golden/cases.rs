//! The cases of a folder: `cases.toml`, and that no case leaves its folder.

use std::fs;
use std::path::{Component, Path, PathBuf};

use clap::CommandFactory;
use serde::Deserialize;

use crate::Error;
use crate::cli::Cli;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    case: Vec<Case>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Case {
    /// Name of its files.
    pub(super) name: String,
    /// Where the example comes from; for people.
    #[allow(dead_code)]
    #[serde(default)]
    source: String,
    /// File of the program in the folder, where it is one.
    pub(super) program: Option<PathBuf>,
    /// Arguments of `stepwave run` or `stepwave program`.
    pub(super) args: Vec<String>,
    /// Exit code that the run has.
    #[serde(default)]
    pub(super) exit: u8,
}

/// The file that lists the cases.
pub(super) fn list_of(dir: &Path) -> PathBuf {
    dir.join("cases.toml")
}

/// Reads all cases.
///
/// # Errors
/// The list cannot be read, names files that it may not, or names two cases alike.
pub(super) fn read(dir: &Path) -> Result<Vec<Case>, Error> {
    let path = list_of(dir);
    let refused = |what: String| Err(Error::Invalid(format!("{}: {what}", path.display())));
    let cannot = |error: &dyn std::fmt::Display| Error::Invalid(format!("cannot read {}: {error}", path.display()));
    let text = fs::read_to_string(&path).map_err(|error| cannot(&error))?;
    let cases: Cases = toml::from_str(&text).map_err(|error: toml::de::Error| {
        // TOML shows the line and points at the place in it.
        Error::Extract(format!("cannot read {}: {}", path.display(), error.to_string().trim_end()))
    })?;
    for (index, case) in cases.case.iter().enumerate() {
        let name = &case.name;
        if !is_file_stem(name) {
            let rule = "give letters, digits, '-', '_' and '.', not first '.' or '-'";
            return refused(format!("'{name}' cannot name files: {rule}"));
        }
        if cases.case[..index].iter().any(|other| other.name == *name) {
            return refused(format!("two cases are named '{name}'"));
        }
        if let Some(option) = file_option(case) {
            let rest = "leave out --fst, --checkpoints, --json and --plot";
            return refused(format!(
                "case {name}: {option} names a file; a wave and a step table are recorded; {rest}"
            ));
        }
        if let Some(program) = &case.program {
            stays_in(dir, program).map_err(|what| Error::Invalid(format!("case {name}: {what}")))?;
        }
    }
    Ok(cases.case)
}

/// The cases of these names, or all where none are given.
///
/// # Errors
/// There is no such case.
pub(super) fn chosen<'c>(cases: &'c [Case], names: &[&String], dir: &Path) -> Result<Vec<&'c Case>, Error> {
    if let Some(unknown) = names.iter().find(|name| !cases.iter().any(|case| case.name == ***name)) {
        let known: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        let list = list_of(dir);
        let known = known.join(", ");
        return Err(Error::Invalid(format!("{} has no case '{unknown}': its cases are {known}", list.display())));
    }
    Ok(cases.iter().filter(|case| names.is_empty() || names.contains(&&case.name)).collect())
}

/// Names files of this very folder, on any system.
fn is_file_stem(name: &str) -> bool {
    name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
        && !name.starts_with(['.', '-'])
        && !name.is_empty()
}

/// A file below the folder, to which no link leads from elsewhere.
fn stays_in(dir: &Path, file: &Path) -> Result<(), String> {
    let name = file.display();
    if !file.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(format!("the program {name} is not in the folder {}: copy it there", dir.display()));
    }
    let path = dir.join(file);
    match (dir.canonicalize(), path.canonicalize()) {
        (Ok(folder), Ok(path)) if !path.starts_with(&folder) => {
            Err(format!("the program {name} is a link out of the folder {}: copy the file there", dir.display()))
        }
        (Err(error), _) | (_, Err(error)) => Err(format!("cannot read {}: {error}", path.display())),
        _ => Ok(()),
    }
}

/// A file that is recorded, in its folder.
///
/// # Errors
/// It is a link.
pub(super) fn recorded(dir: &Path, name: &str) -> Result<PathBuf, Error> {
    let path = dir.join(name);
    if path.is_symlink() {
        let message = format!("{} is a link, which may lead out of the folder: delete it", path.display());
        return Err(Error::Invalid(message));
    }
    Ok(path)
}

/// The first argument that names a file.
fn file_option(case: &Case) -> Option<&str> {
    let program = Cli::command();
    let command = program.find_subcommand(if case.program.is_some() { "program" } else { "run" })?;
    let files = command.get_arguments().filter(|argument| {
        argument
            .get_value_names()
            .is_some_and(|names| names.iter().any(|name| name.starts_with("FILE") || name.starts_with("F.")))
    });
    let options: Vec<&str> = files.filter_map(clap::Arg::get_long).collect();
    let word = |word: &str| word.strip_prefix("--").map(|word| word.split('=').next().unwrap_or(word).to_owned());
    let named = |argument: &&String| word(argument).is_some_and(|word| options.contains(&word.as_str()));
    case.args.iter().find(named).map(|argument| argument.split('=').next().unwrap_or(argument))
}
