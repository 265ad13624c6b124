//! The cases of a folder: `cases.toml`, and that no case leaves its folder.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Component, Path, PathBuf};

use clap::CommandFactory;
use serde::Deserialize;

use super::{Case, names_fit};
use crate::Error;
use crate::cli::{Cli, Command, names_nurbs, names_points, usage};
use crate::commands::{program, run};
use crate::engine::EngineKind;
use crate::output::Outputs;
use crate::own::is_netlist;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    case: Vec<Listed>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Listed {
    /// Name of its files.
    name: String,
    /// Where the example comes from; for people.
    #[allow(dead_code)]
    #[serde(default)]
    source: String,
    /// File of the program in the folder, where it is one.
    program: Option<PathBuf>,
    /// Arguments of `stepwave run` or `stepwave program`.
    args: Vec<String>,
    /// Exit code that the run has.
    #[serde(default)]
    exit: u8,
}

impl Listed {
    /// Runs the command that it is.
    fn run(&self, folder: &Path, engine: EngineKind, [vcd, steps]: [PathBuf; 2]) -> Result<Vec<String>, Error> {
        let mut words: Vec<OsString> = vec!["stepwave".into()];
        match &self.program {
            Some(name) => words.extend(["program".into(), folder.join(name).into_os_string()]),
            None => words.push("run".into()),
        }
        // A netlist of one's own and points are in the folder, as a program is.
        let names_file = |option: &str, word: &str| match option {
            "--bench" => true,
            "--method" => is_netlist(word),
            "--points" => names_points(word),
            "--nurbs" => names_nurbs(word),
            _ => false,
        };
        let of_folder = |index: usize, word: &str| match index.checked_sub(1) {
            None => self.program.is_none() && is_netlist(word),
            Some(before) => names_file(&self.args[before], word),
        };
        let path = |(index, word): (usize, &String)| -> OsString {
            match word.split_once('=') {
                _ if of_folder(index, word) => folder.join(word).into(),
                Some((option, file)) if names_file(option, file) => {
                    [OsStr::new(option), OsStr::new("="), folder.join(file).as_os_str()].into_iter().collect()
                }
                _ => word.into(),
            }
        };
        words.extend(self.args.iter().enumerate().map(path));
        let files = ["--vcd".into(), vcd.into_os_string(), "--steps".into(), steps.into_os_string()];
        words.extend(["--engine".into(), engine.name().into()].into_iter().chain(files));
        let cli = Cli::of(&words).map_err(usage)?;
        let mut outputs = Outputs::default();
        let finished = match &cli.command {
            Command::Program(args) => program::simulate(args, &mut outputs),
            Command::Run(args) => run::simulate(args, &mut outputs),
            _ => return Err(Error::Invalid("is neither a run nor a program".to_owned())),
        }?;
        outputs.commit()?;
        Ok(finished.failures)
    }

    /// The same as a value.
    /// The file of points, if one is read.
    fn points(&self) -> Option<&Path> {
        let given = |option: &str| {
            let mut words = self.args.iter().enumerate();
            words.find_map(|(index, word)| match word.strip_prefix(option) {
                Some("") => self.args.get(index + 1).map(String::as_str),
                Some(rest) => rest.strip_prefix('='),
                None => None,
            })
        };
        let points = given("--points").filter(|given| names_points(given));
        points.or_else(|| given("--nurbs").filter(|given| names_nurbs(given))).map(Path::new)
    }

    fn case(self, dir: &Path) -> Case {
        let (name, exit, folder) = (self.name.clone(), self.exit, dir.to_owned());
        let program = self.program.as_ref().map(|program| dir.join(program));
        let points = self.points().map(|points| dir.join(points));
        let inputs = program.into_iter().chain(points).chain([list_of(dir)]).collect();
        Case { name, exit, inputs, run: Box::new(move |engine, files| self.run(&folder, engine, files)) }
    }
}

/// The file that lists the cases.
fn list_of(dir: &Path) -> PathBuf {
    dir.join("cases.toml")
}

/// Reads all cases.
///
/// # Errors
/// The list cannot be read, names files that it may not, or names two cases alike.
pub(crate) fn read(dir: &Path) -> Result<Vec<Case>, Error> {
    let path = list_of(dir);
    let refused = |what: String| Err::<Vec<Case>, _>(Error::Invalid(format!("{}: {what}", path.display())));
    let cannot = |error: &dyn std::fmt::Display| Error::Invalid(format!("cannot read {}: {error}", path.display()));
    let text = fs::read_to_string(&path).map_err(|error| cannot(&error))?;
    let cases: Cases = toml::from_str(&text).map_err(|error: toml::de::Error| {
        // TOML shows the line and points at the place in it.
        Error::Extract(format!("cannot read {}: {}", path.display(), error.to_string().trim_end()))
    })?;
    for case in &cases.case {
        let name = &case.name;
        if let Some(option) = file_option(case) {
            let rest = "leave out --fst, --checkpoints, --json and --plot";
            return refused(format!(
                "case {name}: {option} names a file; a wave and a step table are recorded; {rest}"
            ));
        }
        let program = case.program.as_deref().map(|program| ("program", program));
        for (what, file) in program.into_iter().chain(case.points().map(|points| ("file of points", points))) {
            stays_in(dir, what, file).map_err(|what| Error::Invalid(format!("case {name}: {what}")))?;
        }
    }
    let cases: Vec<Case> = cases.case.into_iter().map(|case| case.case(dir)).collect();
    names_fit(&cases).map(|()| cases).or_else(|error| match error {
        Error::Invalid(what) => refused(what),
        other => Err(other),
    })
}

/// The cases of these names; `None` where none are given.
///
/// # Errors
/// There is no such case.
pub(crate) fn chosen<'c>(cases: &'c [Case], names: &[&String], dir: &Path) -> Result<Option<Vec<&'c Case>>, Error> {
    if names.is_empty() {
        return Ok(None);
    }
    if let Some(unknown) = names.iter().find(|name| !cases.iter().any(|case| case.name == ***name)) {
        let known: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
        let list = list_of(dir);
        let known = known.join(", ");
        return Err(Error::Invalid(format!("{} has no case '{unknown}': its cases are {known}", list.display())));
    }
    Ok(Some(cases.iter().filter(|case| names.contains(&&case.name)).collect()))
}

/// A file below the folder, to which no link leads from elsewhere.
fn stays_in(dir: &Path, what: &str, file: &Path) -> Result<(), String> {
    let name = file.display();
    if !file.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(format!("the {what} {name} is not in the folder {}: copy it there", dir.display()));
    }
    let path = dir.join(file);
    match (dir.canonicalize(), path.canonicalize()) {
        (Ok(folder), Ok(path)) if !path.starts_with(&folder) => {
            Err(format!("the {what} {name} is a link out of the folder {}: copy the file there", dir.display()))
        }
        (Err(error), _) | (_, Err(error)) => Err(format!("cannot read {}: {error}", path.display())),
        _ => Ok(()),
    }
}

/// The first argument that names a file.
fn file_option(case: &Listed) -> Option<&str> {
    let mut program = Cli::command();
    let command = program.find_subcommand_mut(if case.program.is_some() { "program" } else { "run" })?;
    // Its options are built only now.
    command.build();
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
