//! `stepwave golden`: recorded waves, simulated anew and compared bit by bit.
//!
//! `cases.toml` in the folder lists the cases: a name, the arguments of `stepwave run`, or those of `stepwave program` and
//! a program in the folder, the exit code, and the source of the example. Recorded are the wave `NAME.vcd` with its viewer files, and the step table `NAME.csv`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;
use serde::Deserialize;
use stepwave::kernel::engine::EngineKind;
use stepwave::kernel::trace::diverge::{self, Options};
use stepwave::kernel::trace::read::Wave;

use super::progress::Progress;
use super::{program, run};
use crate::cli::{Cli, Command, GoldenCommand};
use crate::failure::Failure;
use crate::output::{self, Outputs};

/// Clocks shown before a divergence.
const CONTEXT: usize = 5;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Cases {
    case: Vec<Case>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// Name of its files.
    name: String,
    /// Where the example comes from; for people.
    #[allow(dead_code)]
    source: String,
    /// File of the program in the folder, where it is one.
    program: Option<String>,
    /// Arguments of `stepwave run` or `stepwave program`.
    args: Vec<String>,
    /// Exit code that the run has.
    #[serde(default)]
    exit: u8,
}

/// Checks or records every case.
pub(crate) fn run(command: &GoldenCommand) -> Result<(), Failure> {
    let (args, record) = match command {
        GoldenCommand::Check(args) => (args, false),
        GoldenCommand::Record(args) => (args, true),
    };
    let cases = read_cases(&args.dir)?;
    let mut differences = Vec::new();
    let progress = Progress::of(cases.len() as u64, "cases");
    for case in &cases {
        let mut told = None;
        for engine in EngineKind::ALL {
            let made = match simulate(case, &args.dir, engine) {
                Ok(made) => made,
                Err(Failure::Check(sentences)) => {
                    differences.extend(sentences);
                    break;
                }
                Err(failure) => return Err(failure),
            };
            if record && engine == EngineKind::ALL[0] {
                write(&args.dir, &made)?;
            }
            // What the engines agree on is told once.
            if told.as_ref() != Some(&made) {
                compare(case, engine, &args.dir, &made, &mut differences)?;
                told = Some(made);
            }
        }
        progress.add(1);
    }
    progress.finish();
    orphans(&args.dir, &cases, &mut differences)?;
    if !differences.is_empty() {
        return Err(Failure::Check(differences));
    }
    let verb = if record { "recorded" } else { "same, bit by bit" };
    output::print(&format!("{} cases {verb}, from {} engines\n", cases.len(), EngineKind::ALL.len()))
}

fn read_cases(dir: &Path) -> Result<Vec<Case>, Failure> {
    let path = dir.join("cases.toml");
    let cannot = |error: &dyn std::fmt::Display| Failure::Trouble(format!("cannot read {}: {error}", path.display()));
    let text = fs::read_to_string(&path).map_err(|error| cannot(&error))?;
    let cases: Cases = toml::from_str(&text).map_err(|error: toml::de::Error| {
        // TOML shows the line and points at the place in it.
        Failure::Extract(format!("cannot read {}: {}", path.display(), error.to_string().trim_end()))
    })?;
    for (index, case) in cases.case.iter().enumerate() {
        if !is_file_stem(&case.name) {
            let rule = "give letters, digits, '-', '_' and '.', not first '.' or '-'";
            return Err(Failure::Trouble(format!("{}: '{}' cannot name files: {rule}", path.display(), case.name)));
        }
        if cases.case[..index].iter().any(|other| other.name == case.name) {
            return Err(Failure::Trouble(format!("{}: two cases are named '{}'", path.display(), case.name)));
        }
    }
    Ok(cases.case)
}

/// Names files of this very folder, on any system.
fn is_file_stem(name: &str) -> bool {
    name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
        && !name.starts_with(['.', '-'])
        && !name.is_empty()
}

/// The files of a case, by name.
type Files = BTreeMap<String, Vec<u8>>;

/// Runs a case as its user would, in a folder of its own.
fn simulate(case: &Case, folder: &Path, engine: EngineKind) -> Result<Files, Failure> {
    let wrong = |what: String| Failure::Trouble(format!("case {}: {what}", case.name));
    let dir = tempfile::tempdir()?;
    let file = |extension: &str| dir.path().join(format!("{}.{extension}", case.name)).into_os_string();
    let mut words: Vec<std::ffi::OsString> = vec!["stepwave".into()];
    match &case.program {
        Some(name) => words.extend(["program".into(), folder.join(name).into_os_string()]),
        None => words.push("run".into()),
    }
    words.extend(case.args.iter().map(Into::into));
    words.extend(["--engine".into(), engine.name().into(), "--vcd".into(), file("vcd"), "--steps".into(), file("csv")]);
    let in_words = |failure: Failure| match failure {
        Failure::Trouble(sentence) => wrong(sentence),
        other => other,
    };
    let cli = Cli::try_parse_from(words).map_err(|error| in_words(Failure::usage(&error)))?;
    let (trace, made, checkpoints) = match &cli.command {
        Command::Run(args) => (&args.trace, &args.outputs, args.checkpoints.as_ref()),
        Command::Program(args) => (&args.trace, &args.outputs, None),
        _ => return Err(wrong("is neither a run nor a program".to_owned())),
    };
    let others = [trace.fst.as_ref(), checkpoints, made.json.as_ref(), made.plot.as_ref()];
    if others.iter().any(|path| path.is_some()) {
        let rest = "leave out --fst, --checkpoints, --json and --plot";
        return Err(wrong(format!("a wave and a step table are recorded; {rest}")));
    }
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
        let said = finished.failures.join("; ");
        return Err(Failure::Check(vec![format!("case {}: exit code {exit}, not {}: {said}", case.name, case.exit)]));
    }
    let mut files = Files::new();
    for entry in fs::read_dir(dir.path())? {
        let entry = entry?;
        files.insert(entry.file_name().to_string_lossy().into_owned(), fs::read(entry.path())?);
    }
    Ok(files)
}

fn write(dir: &Path, files: &Files) -> Result<(), Failure> {
    let mut outputs = Outputs::default();
    for (name, content) in files {
        outputs.write(&dir.join(name), &String::from_utf8_lossy(content))?;
    }
    outputs.commit()
}

fn compare(
    case: &Case,
    engine: EngineKind,
    dir: &Path,
    made: &Files,
    differences: &mut Vec<String>,
) -> Result<(), Failure> {
    for (name, content) in made {
        let path = dir.join(name);
        match fs::read(&path) {
            Ok(recorded) if recorded == *content => {}
            Ok(recorded) => {
                let what = if name.ends_with(".vcd") { first_divergence(recorded, content.clone()) } else { None };
                let what = what.unwrap_or_else(|| first_unequal_line(&path, content));
                differences.push(format!("case {} on {}: {name} differs: {what}", case.name, engine.name()));
            }
            Err(error) => return Err(Failure::Trouble(format!("cannot read {}: {error}", path.display()))),
        }
    }
    Ok(())
}

/// Where two waves part, in words; `None` if they agree in all values and differ only as text.
fn first_divergence(recorded: Vec<u8>, made: Vec<u8>) -> Option<String> {
    let (recorded, made) = (Wave::from_bytes(recorded).ok()?, Wave::from_bytes(made).ok()?);
    let options = Options { context: CONTEXT, ..Options::default() };
    let divergence = diverge::first_divergence(&recorded, &made, &options).ok()??;
    Some(format!("recorded is A, simulated is B\n{divergence}"))
}

fn first_unequal_line(path: &Path, made: &[u8]) -> String {
    let recorded = fs::read(path).unwrap_or_default();
    let (recorded, made) =
        (String::from_utf8_lossy(&recorded).into_owned(), String::from_utf8_lossy(made).into_owned());
    let line = recorded.lines().zip(made.lines()).take_while(|(a, b)| a == b).count();
    let at = |text: &str| text.lines().nth(line).unwrap_or("the end of the file").to_owned();
    format!("line {}: recorded '{}', simulated '{}'", line + 1, at(&recorded), at(&made))
}

/// Recorded waves that no case makes any more.
fn orphans(dir: &Path, cases: &[Case], differences: &mut Vec<String>) -> Result<(), Failure> {
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
