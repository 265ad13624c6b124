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
//! viewer files, and the step table `NAME.csv`. [`check_cases`] takes cases as values, without `cases.toml`.

#[cfg(feature = "cli")]
pub(crate) mod cases;
mod differences;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fmt, fs};

use crate::engine::EngineKind;
use crate::output::{Outputs, temporary};
use crate::{Error, Simulation};

/// Simulates on an engine, with the wave and the step table in these files; gives what is wrong with the hardware.
type Run = dyn Fn(EngineKind, [PathBuf; 2]) -> Result<Vec<String>, Error>;

/// A run whose wave and step table are recorded.
#[must_use]
pub struct Case {
    name: String,
    exit: u8,
    /// Files that it reads, which no output may replace.
    inputs: Vec<PathBuf>,
    run: Box<Run>,
}

impl Case {
    /// A run that passes every check. The name is that of its files: letters, digits, `-`, `_` and `.`.
    pub fn new(name: impl Into<String>, simulation: Simulation) -> Case {
        let run = move |engine, [vcd, steps]: [PathBuf; 2]| {
            Ok(simulation.clone().engine(engine).vcd(vcd).steps(steps).run()?.failures())
        };
        Case { name: name.into(), exit: 0, inputs: Vec::new(), run: Box::new(run) }
    }

    /// With this exit code of the run: 1 where the hardware fails a check.
    pub fn exit(self, exit: u8) -> Case {
        Case { exit, ..self }
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Case").field("name", &self.name).field("exit", &self.exit).finish_non_exhaustive()
    }
}

/// Checks every case that `cases.toml` of a folder lists, on every engine; gives their number.
///
/// # Errors
/// [`Error::Check`] with every difference, or a case or its files cannot be read.
#[cfg(feature = "cli")]
pub fn check(folder: impl AsRef<Path>) -> Result<usize, Error> {
    check_cases(&folder, &cases::read(folder.as_ref())?)
}

/// Records every case that `cases.toml` of a folder lists; gives what has changed, a line for each.
///
/// # Errors
/// [`Error::Check`] where a case does not end as it says, or engines differ; a case cannot be read, or a file not written.
#[cfg(feature = "cli")]
pub fn record(folder: impl AsRef<Path>) -> Result<String, Error> {
    record_cases(&folder, &cases::read(folder.as_ref())?)
}

/// Checks these cases, whose files are in a folder, on every engine; gives their number.
///
/// ```
/// use stepwave::golden::{Case, check_cases, record_cases};
/// use stepwave::{Simulation, models::find, nc::Line};
///
/// let folder = tempfile::tempdir()?;
/// let line = Simulation::new(find("dda-line")?, Line::new(vec![0, 0], vec![8, 6])?.into());
/// let cases = [Case::new("line", line)];
/// record_cases(&folder, &cases)?; // once: line.vcd, line.csv, and files for GTKWave
/// assert_eq!(check_cases(&folder, &cases)?, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Check`] with every difference; a name cannot be that of files, or a file cannot be read.
pub fn check_cases(folder: impl AsRef<Path>, cases: &[Case]) -> Result<usize, Error> {
    let report = all_of(folder.as_ref(), cases, None, false, &mut |_, _| {})?;
    report.differences.is_empty().then_some(report.cases).ok_or(Error::Check(report.differences))
}

/// Records these cases in a folder; gives what has changed, a line for each.
///
/// # Errors
/// [`Error::Check`] where a case does not end as it says, or engines differ; a file cannot be written.
pub fn record_cases(folder: impl AsRef<Path>, cases: &[Case]) -> Result<String, Error> {
    let report = all_of(folder.as_ref(), cases, None, true, &mut |_, _| {})?;
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

/// Checks or records those that are chosen, or every case. `done` gets how many of how many are.
pub(crate) fn all_of(
    dir: &Path,
    all: &[Case],
    chosen: Option<Vec<&Case>>,
    record: bool,
    done: &mut dyn FnMut(usize, usize),
) -> Result<Report, Error> {
    names_fit(all)?;
    let whole = chosen.is_none();
    let chosen = chosen.unwrap_or_else(|| all.iter().collect());
    let mut report = Report { cases: chosen.len(), ..Report::default() };
    done(0, chosen.len());
    for (index, case) in chosen.iter().enumerate() {
        one(case, all, dir, record, &mut report)?;
        done(index + 1, chosen.len());
    }
    if whole {
        orphans(dir, all, &mut report.differences)?;
    }
    Ok(report)
}

/// Refuses names that cannot be those of files of one folder, on any system.
fn names_fit(cases: &[Case]) -> Result<(), Error> {
    for (index, Case { name, .. }) in cases.iter().enumerate() {
        let is_stem = name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
        if !is_stem || name.starts_with(['.', '-']) || name.is_empty() {
            let rule = "give letters, digits, '-', '_' and '.', not first '.' or '-'";
            return Err(Error::Invalid(format!("'{name}' cannot name files: {rule}")));
        }
        if cases[..index].iter().any(|other| other.name == *name) {
            return Err(Error::Invalid(format!("two cases are named '{name}'")));
        }
    }
    Ok(())
}

/// Checks or records a case.
fn one(case: &Case, all: &[Case], dir: &Path, record: bool, report: &mut Report) -> Result<(), Error> {
    let mut reported = None;
    for engine in EngineKind::ALL {
        let made = match simulate(case, engine) {
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
fn simulate(case: &Case, engine: EngineKind) -> Result<Files, Error> {
    let dir = temporary::Folder::new()?;
    let file = |extension: &str| dir.path().join(format!("{}.{extension}", case.name));
    let failures = (case.run)(engine, [file("vcd"), file("csv")]).map_err(|failure| match failure {
        Error::Invalid(sentence) => Error::Invalid(format!("case {}: {sentence}", case.name)),
        other => other,
    })?;
    let exit = u8::from(!failures.is_empty());
    if exit != case.exit {
        let said = match failures.join("; ") {
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
    let mut outputs = Outputs::reading(all.iter().flat_map(|case| &case.inputs));
    let mut kinds: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    for (name, content) in files {
        let path = recorded(dir, name)?;
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
        let path = recorded(dir, name)?;
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

/// A file that is recorded, in its folder.
///
/// # Errors
/// It is a link.
fn recorded(dir: &Path, name: &str) -> Result<PathBuf, Error> {
    let path = dir.join(name);
    if path.is_symlink() {
        let message = format!("{} is a link, which may lead out of the folder: delete it", path.display());
        return Err(Error::Invalid(message));
    }
    Ok(path)
}
