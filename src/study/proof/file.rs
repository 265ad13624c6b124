//! Certificates in a file: which hardware, and a certificate for each kind of geometry.

use std::fmt;

use stepwave_models::{ModelError, find};
use stepwave_prove::{Certificate, CertificateError};

use super::{Narrower, Proposition};

/// First line of a file of certificates.
const TITLE: &str = "stepwave certificate 1";

/// Kinds of geometry in a file, at most.
const MOST_KINDS: usize = 64;
/// Bytes of a file, at most.
pub const MOST_BYTES: u64 = 1 << 22;

/// What a file of certificates holds.
#[derive(Clone, Debug)]
pub struct CertificateFile {
    /// What it proves.
    pub proposition: Proposition,
    /// A certificate for each kind of geometry, by its name.
    pub kinds: Vec<(String, Certificate)>,
    /// Blocks that were followed clock by clock, each with its width and kind.
    pub counted: Vec<String>,
}

/// Why a file is not a file of certificates.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// It is something else.
    #[error("it does not begin with '{TITLE}'")]
    NoTitle,
    /// Its head cannot be read.
    #[error("line {line} cannot be read: '{text}'")]
    Head {
        /// Number of the line, from 1.
        line: usize,
        /// The line.
        text: String,
    },
    /// There is no such model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Its options are of something else too.
    #[error("'{0}' is not hardware alone")]
    Options(String),
    /// A block has no width that is counted.
    #[error("counted {0}")]
    Counted(String),
    /// The model has no such kind of geometry.
    #[error("{model} has no kind {kind}")]
    NoKind {
        /// The model.
        model: &'static str,
        /// The kind of geometry.
        kind: String,
    },
    /// There are two of one kind, or too many.
    #[error("kind {kind} is one too many: a certificate has each kind once, and at most {MOST_KINDS}")]
    Kind {
        /// The kind of geometry.
        kind: String,
    },
    /// A certificate cannot be read.
    #[error("kind {kind}: {error}")]
    Certificate {
        /// The kind of geometry.
        kind: String,
        /// Where.
        error: CertificateError,
    },
}

impl fmt::Display for CertificateFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{TITLE}\nmodel {}", self.proposition.model.name)?;
        for option in self.proposition.words() {
            writeln!(f, "option {option}")?;
        }
        for (register, bits) in &self.proposition.narrower {
            writeln!(f, "narrower {bits} {register}")?;
        }
        for block in &self.counted {
            writeln!(f, "counted {block}")?;
        }
        for (kind, certificate) in &self.kinds {
            write!(f, "kind {kind}\n{certificate}")?;
        }
        Ok(())
    }
}

impl std::str::FromStr for CertificateFile {
    type Err = FileError;

    fn from_str(text: &str) -> Result<CertificateFile, FileError> {
        let rest = text.strip_prefix(TITLE).ok_or(FileError::NoTitle)?;
        let mut parts = rest.split("\nkind ");
        let (proposition, counted) = head(parts.next().unwrap_or_default())?;
        let mut file = CertificateFile { proposition, kinds: Vec::new(), counted };
        for part in parts {
            let (kind, body) = part.split_once('\n').unwrap_or((part, ""));
            if file.kinds.len() == MOST_KINDS || file.kinds.iter().any(|(other, _)| other == kind) {
                return Err(FileError::Kind { kind: kind.chars().take(60).collect() });
            }
            let certificate = body.parse().map_err(|error| FileError::Certificate { kind: kind.to_owned(), error })?;
            file.kinds.push((kind.to_owned(), certificate));
        }
        Ok(file)
    }
}

/// What a file proves, and the blocks that were followed, from the lines before the first kind.
fn head(text: &str) -> Result<(Proposition, Vec<String>), FileError> {
    let (mut model, mut options, mut narrower, mut counted) = (String::new(), Vec::new(), Narrower::new(), Vec::new());
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.is_empty()) {
        let wrong = || FileError::Head { line: index + 1, text: line.chars().take(60).collect() };
        match line.split_once(' ').ok_or_else(wrong)? {
            ("model", name) if model.is_empty() => name.clone_into(&mut model),
            ("counted", block) => counted.push(block.to_owned()),
            ("option", option) => options.push(option.to_owned()),
            ("narrower", pair) => {
                let (bits, register) = pair.split_once(' ').ok_or_else(wrong)?;
                let bits = bits.parse().map_err(|_| wrong())?;
                if narrower.insert(register.to_owned(), bits).is_some() {
                    return Err(wrong());
                }
            }
            _ => return Err(wrong()),
        }
    }
    let own = Proposition { narrower, ..Proposition::of(find(&model)?) };
    let proposition = own.with_words(&options).ok_or_else(|| FileError::Options(options.join(" ")))?;
    Ok((proposition, counted))
}
