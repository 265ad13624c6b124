//! What shows the files of a run: a viewer of waves, a browser.

use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::Error;
use crate::cli::ShownArgs;
use crate::output::is_stream;
use crate::waves::{Viewer, WaveOptions, stems};

/// A file, and what shows it.
#[derive(Clone, PartialEq, Eq, Debug)]
enum Shown {
    /// A viewer of waves with its words.
    Viewer(&'static str, Vec<OsString>),
    /// What the system opens such files with.
    File(PathBuf),
}

/// What is printed and opened after the files of a run are written.
#[derive(Debug)]
pub(crate) struct View {
    pub(crate) quiet: bool,
    open: bool,
    shown: Vec<Shown>,
}

impl View {
    /// Of a run that writes these waves, and a picture.
    ///
    /// # Errors
    /// Something is to be opened, and nothing is written that can be.
    pub(crate) fn new(args: &ShownArgs, waves: &WaveOptions, plot: Option<&PathBuf>) -> Result<View, Error> {
        let view = View { quiet: args.outputs.quiet, open: args.open, shown: shown(waves, plot) };
        if view.open && view.shown.is_empty() {
            return Err(Error::Invalid(
                "--open shows what is written into a file, but there is nothing to show: give -o FILE.vcd".to_owned(),
            ));
        }
        Ok(view)
    }

    /// Opens what was written, or says on a terminal how to.
    ///
    /// # Errors
    /// A viewer cannot be started.
    pub(crate) fn show(&self) -> Result<(), Error> {
        if self.open {
            return self.shown.iter().try_for_each(Shown::open);
        }
        let mut terminal = std::io::stderr();
        if !self.quiet && terminal.is_terminal() {
            for shown in &self.shown {
                // A hint that cannot be written is not missed.
                let _ = writeln!(terminal, "to see it: {}", shown.hint());
            }
        }
        Ok(())
    }
}

/// The files that can be shown, each with what shows it.
fn shown(waves: &WaveOptions, plot: Option<&PathBuf>) -> Vec<Shown> {
    let file = |path: &&PathBuf| !is_stream(path);
    let traced = [&waves.vcd, &waves.fst].map(|path| path.as_ref().filter(file));
    let mut all = Vec::new();
    for (path, stem) in traced.into_iter().zip(stems(traced.map(|path| path.map(PathBuf::as_path)))) {
        let (Some(path), Some(stem)) = (path, stem) else { continue };
        let next_to = |ending: &str| {
            let mut name = stem.to_owned();
            name.push(ending);
            path.with_file_name(name).into_os_string()
        };
        match waves.viewer.unwrap_or_default() {
            Viewer::Gtkwave | Viewer::Both => all.push(Shown::Viewer("gtkwave", vec![next_to(".gtkw")])),
            Viewer::Surfer => {
                let words = vec!["--command-file".into(), next_to(".sucl"), path.clone().into_os_string()];
                all.push(Shown::Viewer("surfer", words));
            }
        }
    }
    let files = waves.html.iter().chain(plot).filter(file);
    all.extend(files.map(|path| Shown::File(path.clone())));
    all
}

impl Shown {
    /// The command, for a shell.
    fn hint(&self) -> String {
        let quoted = |word: &OsString| {
            let word = word.to_string_lossy();
            shlex::try_quote(&word).map_or_else(|_| word.to_string(), |quoted| quoted.into_owned())
        };
        match self {
            Shown::Viewer(program, words) => {
                format!("{program} {}", words.iter().map(quoted).collect::<Vec<_>>().join(" "))
            }
            Shown::File(path) => format!("open {} in a browser", path.display()),
        }
    }

    fn open(&self) -> Result<(), Error> {
        match self {
            Shown::Viewer(program, words) => {
                let mut command = Command::new(program);
                command.args(words).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
                command.spawn().map(drop).map_err(|error| cannot_open(program, &error, &self.hint()))
            }
            Shown::File(path) => open::that_detached(path)
                .map_err(|error| cannot_open(&format!("what opens {}", path.display()), &error, &self.hint())),
        }
    }
}

fn cannot_open(what: &str, error: &std::io::Error, hint: &str) -> Error {
    Error::Invalid(format!(
        "the files are written, but {what} cannot be started: {error}; install it, or leave --open out and show them by hand: {hint}"
    ))
}
