//! What can be wrong with a study.

use stepwave_models::ModelError;
use stepwave_netlist::did_you_mean;

/// Why a sweep cannot be made, continued, or joined; every message names the value and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A word is not a range.
    #[error("invalid range '{0}': give a whole number, or FIRST..LAST, or FIRST..LAST/STEP")]
    NoRange(String),
    /// A range whose last number is less than its first.
    #[error("the range {first}..{last} begins after its end: give {last}..{first}")]
    Reversed {
        /// Its first number.
        first: i64,
        /// Its last.
        last: i64,
    },
    /// A range with step 0.
    #[error("the range {first}..{last} has a step of 0: give 1 or more")]
    NoStep {
        /// Its first number.
        first: i64,
        /// Its last.
        last: i64,
    },
    /// A word among the values of a hardware option.
    #[error("invalid value '{word}' of --{option}{}: give {values}", did_you_mean(.word, .values.split(", ")))]
    NoValue {
        /// The word.
        word: String,
        /// The option, without its dashes.
        option: &'static str,
        /// What it may be.
        values: String,
    },
    /// The options do not tell geometries.
    #[error("{0}")]
    Geometries(String),
    /// More runs than can be numbered and kept.
    #[error(
        "{geometries} geometries with {variants} hardware choices each are more than {limit} runs: give a coarser grid, such as 0..1000/10"
    )]
    TooMany {
        /// Geometries.
        geometries: String,
        /// Options for each.
        variants: String,
        /// Most runs.
        limit: u64,
    },
    /// A file of geometries with a mistake.
    #[error("{file}: line {line}: {what}")]
    Points {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The mistake.
        what: String,
    },
    /// There is no such column, or it holds no numbers.
    #[error("{what}: the columns that a heat map shows are {known}")]
    Column {
        /// What is wrong.
        what: String,
        /// Columns with numbers.
        known: String,
    },
    /// The part that was begun does not fit this sweep.
    #[error("cannot resume {file}: {what}")]
    Resume {
        /// The final file.
        file: String,
        /// Why not, and the remedy.
        what: String,
    },
    /// Parts that do not make one sweep.
    #[error("cannot merge {file}: {what}")]
    Merge {
        /// The part.
        file: String,
        /// Why not.
        what: String,
    },
    /// A file cannot be read or written.
    #[error("{what} {file}: {error}")]
    File {
        /// What was tried, such as "cannot write".
        what: &'static str,
        /// The file.
        file: String,
        /// What the system says.
        error: String,
    },
    /// The model does not take a choice.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A run failed by itself.
    #[error("{0}")]
    Run(String),
}

impl StudyError {
    /// A file that cannot be written.
    pub(super) fn writing(file: &std::path::Path, error: impl ToString) -> StudyError {
        StudyError::File { what: "cannot write", file: file.display().to_string(), error: error.to_string() }
    }

    /// A file that cannot be read.
    pub(super) fn reading(file: &std::path::Path, error: impl ToString) -> StudyError {
        StudyError::File { what: "cannot read", file: file.display().to_string(), error: error.to_string() }
    }
}
