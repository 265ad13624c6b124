//! Golden waves: recorded once, simulated anew and compared bit by bit, by `stepwave golden` or in a `cargo test`.
//!
//! ```no_run
//! #[test]
//! fn waves_are_as_recorded() {
//!     stepwave::golden::check("tests/waves").unwrap();
//! }
//! ```
//!
//! `cases.toml` in the folder lists the cases; the help of the command says how. Recorded are the wave `NAME.vcd` with its
//! viewer files, and the step table `NAME.csv`.

mod cases;
mod differences;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::engine::EngineKind;
use clap::Parser;

use self::cases::Case;
use crate::Error;
use crate::cli::{self, Cli, Command};
use crate::commands::{program, run};
use crate::output::{Outputs, temporary};

/// Checks every case of a folder on every engine; gives their number.
///
/// # Errors
/// [`Error::Check`] with every difference, or a case or its files cannot be read.
pub fn check(folder: impl AsRef<Path>) -> Result<usize, Error> {
    let report = all_of(folder.as_ref(), &[], false, &mut |_, _| {})?;
    report.differences.is_empty().then_some(report.cases).ok_or(Error::Check(report.differences))
}

/// Records every case of a folder; gives what has changed, a line for each.
///
/// # Errors
/// [`Error::Check`] where a case does not end as it says, or engines differ; a case cannot be read, or a file not
/// written.
pub fn record(folder: impl AsRef<Path>) -> Result<String, Error> {
    let report = all_of(folder.as_ref(), &[], true, &mut |_, _| {})?;
    report.differences.is_empty().then_some(report.text).ok_or(Error::Check(report.differences))
}

/// What cases have come to.
#[derive(Default)]
pub(crate) struct Report {
    /// Number of cases.
    pub(crate) cases: usize,
    /// What was recorded, a line for each case.
    pub(crate) text: String,
    /// What is not as it should be.
    pub(crate) differences: Vec<String>,
}

/// Checks or records the cases of these names, or every case where none are given. `done` gets how many of how many
/// are.
pub(crate) fn all_of(
    dir: &Path,
    names: &[&String],
    record: bool,
    done: &mut dyn FnMut(usize, usize),
) -> Result<Report, Error> {
    let all = cases::read(dir)?;
    let chosen = cases::chosen(&all, names, dir)?;
    let mut report = Report { cases: chosen.len(), ..Report::default() };
    done(0, chosen.len());
    for (index, case) in chosen.iter().enumerate() {
        one(case, &all, dir, record, &mut report)?;
        done(index + 1, chosen.len());
    }
    if names.is_empty() {
        orphans(dir, &all, &mut report.differences)?;
    }
    Ok(report)
}

/// Checks or records a case.
fn one(case: &Case, all: &[Case], dir: &Path, record: bool, report: &mut Report) -> Result<(), Error> {
    let mut reported = None;
    for engine in EngineKind::ALL {
        let made = match simulate(case, dir, engine) {
            Ok(made) => made,
            Err(Error::Check(sentences)) => {
                report.differences.extend(sentences);
                break;
            }
            Err(failure) => return Err(failure),
        };
        let stale = stale(case, all, dir, &made)?;
        if record && engine == EngineKind::ALL[0] {
            report.text += &write(case, all, dir, &made, &stale)?;
        } else if reported.is_none() {
            let unmade = stale.iter().map(|name| format!("case {} no longer makes {name}: delete it", case.name));
            report.differences.extend(unmade);
        }
        // What the engines agree on is reported once.
        if reported.as_ref() != Some(&made) {
            compare(case, engine, dir, &made, &mut report.differences)?;
            reported = Some(made);
        }
    }
    Ok(())
}

/// The files of a case, by name.
type Files = BTreeMap<String, Vec<u8>>;

/// Runs a case as its user would, in a folder of its own.
fn simulate(case: &Case, folder: &Path, engine: EngineKind) -> Result<Files, Error> {
    let wrong = |what: String| Error::Invalid(format!("case {}: {what}", case.name));
    let dir = temporary::Folder::new()?;
    let file = |extension: &str| dir.path().join(format!("{}.{extension}", case.name)).into_os_string();
    let mut words: Vec<std::ffi::OsString> = vec!["stepwave".into()];
    match &case.program {
        Some(name) => words.extend(["program".into(), folder.join(name).into_os_string()]),
        None => words.push("run".into()),
    }
    words.extend(case.args.iter().map(Into::into));
    words.extend(["--engine".into(), engine.name().into(), "--vcd".into(), file("vcd"), "--steps".into(), file("csv")]);
    let in_words = |failure: Error| match failure {
        Error::Invalid(sentence) => wrong(sentence),
        other => other,
    };
    let cli = Cli::try_parse_from(words).map_err(|error| in_words(cli::usage(&error)))?;
    let mut outputs = Outputs::default();
    let finished = match &cli.command {
        Command::Program(args) => program::simulate(args, &mut outputs),
        Command::Run(args) => run::simulate(args, &mut outputs),
        _ => return Err(wrong("is neither a run nor a program".to_owned())),
    };
    let finished = finished.map_err(in_words)?;
    outputs.commit()?;
    let exit = u8::from(!finished.failures.is_empty());
    if exit != case.exit {
        let said = match finished.failures.join("; ") {
            none if none.is_empty() => "it passes every check".to_owned(),
            said => said,
        };
        return Err(Error::Check(vec![format!("case {}: exit code {exit}, not {}: {said}", case.name, case.exit)]));
    }
    let mut files = Files::new();
    for entry in fs::read_dir(dir.path())? {
        let entry = entry?;
        files.insert(entry.file_name().to_string_lossy().into_owned(), fs::read(entry.path())?);
    }
    Ok(files)
}

/// Names of state files that the case has made once and makes no more.
fn stale(case: &Case, all: &[Case], dir: &Path, made: &Files) -> Result<Vec<String>, Error> {
    let belongs_to = |name: &str, case: &Case| name.strip_prefix(&case.name).is_some_and(|rest| rest.starts_with('.'));
    let mut names = Vec::new();
    for entry in fs::read_dir(dir)? {
        let entry = entry?;
        // A folder, or a name that is not Unicode, was made by no case.
        let Some(name) = entry.file_name().into_string().ok().filter(|_| !entry.path().is_dir()) else { continue };
        // `a.b.states` is that of the case `a.b` rather than of `a`, if there is one.
        let owner = all.iter().filter(|case| belongs_to(&name, case)).max_by_key(|case| case.name.len());
        let own = owner.is_some_and(|owner| owner.name == case.name);
        if own && name.ends_with(".states") && !made.contains_key(&name) {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// Records the files of a case; gives what has changed.
fn write(case: &Case, all: &[Case], dir: &Path, files: &Files, stale: &[String]) -> Result<String, Error> {
    let programs = all.iter().filter_map(|case| case.program.as_ref()).map(|program| dir.join(program));
    let inputs: Vec<PathBuf> = programs.chain([cases::list_of(dir)]).collect();
    let mut outputs = Outputs::reading(&inputs);
    let mut kinds: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    for (name, content) in files {
        let path = cases::recorded(dir, name)?;
        let kind = match fs::read(&path) {
            Ok(recorded) if recorded == *content => 3,
            Ok(_) => 1,
            Err(_) => 0,
        };
        kinds.entry(kind).or_default().push(name);
        outputs.write(&path, &String::from_utf8_lossy(content))?;
    }
    outputs.commit()?;
    for name in stale {
        let path = dir.join(name);
        fs::remove_file(&path).map_err(|error| Error::Invalid(format!("cannot delete {}: {error}", path.display())))?;
        kinds.entry(2).or_default().push(name);
    }
    let words = ["new", "changed", "removed", "same"];
    let said = kinds.iter().map(|(&kind, names)| format!("{} {}", words[kind], names.join(", ")));
    Ok(format!("{}: {}\n", case.name, said.collect::<Vec<_>>().join("; ")))
}

fn compare(
    case: &Case,
    engine: EngineKind,
    dir: &Path,
    made: &Files,
    differences: &mut Vec<String>,
) -> Result<(), Error> {
    for (name, content) in made {
        let path = cases::recorded(dir, name)?;
        let recorded = fs::read(&path).map_err(|error| {
            let remedy = "`stepwave golden record` writes it";
            Error::Invalid(format!("cannot read {}: {error}: {remedy}", path.display()))
        })?;
        if recorded != *content {
            let what = differences::first(name, &recorded, content);
            differences.push(format!("case {} on {}: {name} differs: {what}", case.name, engine.name()));
        }
    }
    Ok(())
}

/// Recorded waves that no case makes any more.
fn orphans(dir: &Path, cases: &[Case], differences: &mut Vec<String>) -> Result<(), Error> {
    for entry in fs::read_dir(dir)? {
        let path: PathBuf = entry?.path();
        let is_wave = path.extension().is_some_and(|extension| extension == "vcd");
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if is_wave && !cases.iter().any(|case| case.name == name) {
            differences.push(format!("{} belongs to no case: delete it, or add its case", path.display()));
        }
    }
    Ok(())
}
