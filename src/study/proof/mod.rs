//! Proofs about models: a [`Proposition`] says what of which hardware, [`Proposition::prove`] decides it, and [`check`]
//! checks the certificate of what it found. To that end there are the family of a model's netlists, recorded runs of each,
//! and one attempt for each kind of geometry.

mod check;
mod counted;
mod counter;
mod decide;
mod file;
mod fixed;
mod induction;
mod learning;
mod members;
mod proposition;
mod runs;
mod solver;
mod subject;
mod verdict;

use stepwave_models::ModelError;
use stepwave_prove::{CaseError, FamilyError, Lost};

pub use check::{CheckError, check, check_with};
pub use counted::{Block, CountMethod, blocks};
pub use counter::{Counterexample, Fault, Survey, Tried, search};
pub use decide::{Effort, SEARCHED, Watcher};
pub use file::{CertificateFile, FileError, MOST_BYTES};
pub use fixed::{Fixed, narrowing_ks, symmetric_box};
pub use induction::{CounterexampleToInduction, INDUCTION_KS, InductionSearch};
pub(in crate::study) use members::hardware_at;
use members::largest;
pub use members::{Narrower, choices_at};
pub use proposition::Proposition;
use runs::number;
pub use runs::{State, states};
pub use solver::{Answer, Attend, Question, SolverError, ask, question};
pub use subject::{Subject, strobes};
pub use verdict::{Attempt, Claim, Evidence, Scope, Shown, Verdict, names, proved, unproved};

/// Why nothing can be attempted.
#[derive(Debug, thiserror::Error)]
pub enum ProofError {
    /// The model claims nothing.
    #[error(
        "{model} claims nothing for every k: give a box (--box 4), of which every geometry is simulated, or study it by `stepwave sweep`"
    )]
    NoClaims {
        /// The model.
        model: &'static str,
    },
    /// Its blocks go through a buffer.
    #[error(
        "{model} takes its blocks through a buffer, which a proof for every width does not follow: give --width, --box or \
         --travel, and every geometry is simulated"
    )]
    Buffered {
        /// The model.
        model: &'static str,
    },
    /// There is no such box of geometries for the model.
    #[error("{0}")]
    Box(String),
    /// An option is about hardware of every k, and the widths are given.
    #[error("{option} is for hardware of every k, but --width, --box or --travel choose one: leave one of them out")]
    ForEveryK {
        /// The option.
        option: &'static str,
    },
    /// The model has no register that a preset is for.
    #[error("{model} has no remainder to preset: leave --any-preset out")]
    NoRemainder {
        /// The model.
        model: &'static str,
    },
    /// The hardware cannot be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Its netlists are no family.
    #[error(transparent)]
    Family(#[from] FamilyError),
    /// The claims do not fit the netlist.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The load word of an input is not a formula of the geometry.
    #[error(
        "the load word {word} of {kind} is not a polynomial of its geometry, so that nothing can be concluded from it for every k: give a box, of which every geometry is simulated"
    )]
    Word {
        /// The register.
        word: String,
        /// Kind of geometry.
        kind: String,
    },
    /// An invariant does not hold in a run: the proof is wrong.
    #[error("{kind}: {invariant} was proved, but a run shows that it does not hold")]
    Untrue {
        /// Kind of geometry.
        kind: String,
        /// The invariant.
        invariant: String,
    },
    /// A block cannot be followed to its end.
    #[error("{model} at k = {k}, {kind}: {lost}")]
    Lost {
        /// The model.
        model: &'static str,
        /// Bits of coordinates.
        k: u32,
        /// Kind of geometry.
        kind: String,
        /// Why.
        lost: Lost,
    },
    /// A counted register is not loaded with the displacement of its axis, bit by bit.
    #[error("{register} is not loaded with |d| in binary, so that its bits are not followed: leave --radix 10 out")]
    Counted {
        /// The register.
        register: String,
    },
    /// No curve of the kind was found.
    #[error("no geometry of the kind {kind} was found to learn from")]
    NoCurves {
        /// Kind of geometry.
        kind: String,
    },
}
