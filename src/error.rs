//! The one error at the top: what is wrong, in words for the user, and the exit code of a command that ends with it.

use std::fmt;

use crate::output::shown;

/// What keeps a run, a check or a command from ending well. It prints as `stepwave: ` and one sentence a line.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The simulated hardware failed a check, or a comparison differs: exit code 1. One sentence a line.
    Check(Vec<String>),
    /// Bad input or usage, or a file cannot be read or written: exit code 2.
    Invalid(String),
    /// The same with an extract of a file, in lines.
    Extract(String),
    /// No command was given: the help, exit code 2.
    Help(String),
}

impl Error {
    /// The exit code of a process that ends with it: 1 the hardware failed a check, 2 bad input.
    #[must_use]
    pub fn code(&self) -> u8 {
        match self {
            Error::Check(_) => 1,
            Error::Invalid(_) | Error::Extract(_) | Error::Help(_) => 2,
        }
    }
}

/// One line without control characters, regardless of the text that it quotes.
fn one_line(sentence: &str) -> String {
    shown(&sentence.replace(['\n', '\r'], " ")).into_owned()
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Check(sentences) => {
                let line = |sentence: &String| format!("stepwave: {}", one_line(sentence));
                let lines: Vec<_> = sentences.iter().map(line).collect();
                f.write_str(&lines.join("\n"))
            }
            Error::Invalid(sentence) => write!(f, "stepwave: {}", one_line(sentence)),
            Error::Extract(text) => {
                let lines: Vec<_> = text.lines().map(one_line).collect();
                write!(f, "stepwave: {}", lines.join("\n"))
            }
            Error::Help(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for Error {}

/// Errors of parts of the library are bad input; each keeps its own words.
macro_rules! invalid_by {
    ($($error:ty),+ $(,)?) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Error {
                Error::Invalid(error.to_string())
            }
        })+
    };
}

invalid_by!(
    std::io::Error,
    rayon::ThreadPoolBuildError,
    serde_json::Error,
    crate::models::ModelError,
    crate::nc::GeometryError,
    crate::import::ImportError,
    crate::netlist::Diagnostics,
    crate::netlist::HasMemories,
    crate::own::BenchError,
    crate::own::FileError,
    crate::own::StimulusError,
    crate::own::YosysError,
    crate::schematic::DrawError,
    crate::program::ProgramFailure,
    crate::prove::sat::TooLarge,
    crate::study::StudyError,
    crate::study::proof::ProofError,
    crate::study::proof::SolverError,
    crate::study::synth::SynthError,
    crate::testbench::ObserverError,
    crate::testbench::SignalError,
    crate::trace::diverge::CompareError,
    crate::trace::merge::MergeError,
    crate::trace::probe::PatternError,
    crate::trace::read::WaveError,
    crate::trace::timescale::ClockError,
);

impl From<String> for Error {
    fn from(sentence: String) -> Error {
        Error::Invalid(sentence)
    }
}
