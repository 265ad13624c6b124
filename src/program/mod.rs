//! Whole NC programs through one machine: text → blocks → compensation → pulses → netlist.
//!
//! A program is read twice: a [`Survey`] finds what is wrong with it and how wide the registers must be, before anything
//! is written; then a [`Control`] feeds the machine, one block ahead of it. Neither holds more than a few blocks, so that
//! memory does not grow with the program.

mod control;
mod corners;
mod estimate;
mod feed;
mod lookahead;
mod planner;
mod speeds;
mod stream;
mod survey;
mod tally;

use stepwave_models::ModelError;
use stepwave_nc::{CompensationError, GeometryError, ProgramError, ReadingError};

pub use control::Control;
pub use estimate::Estimate;
pub use feed::Pace;
pub use speeds::{SpeedAt, Speeds};
pub use stream::{Item, Preparation, Stream};
pub use survey::Survey;
pub use tally::{CutWords, Greatest, LeftOut, Totals};

/// Why a program cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum ProgramFailure {
    /// Its text is wrong.
    #[error(transparent)]
    Text(#[from] ProgramError),
    /// What it is to be read with is wrong.
    #[error(transparent)]
    Reading(#[from] ReadingError),
    /// Its contour cannot be compensated.
    #[error(transparent)]
    Compensation(#[from] CompensationError),
    /// A block is too large.
    #[error("line {line}: {error}")]
    Geometry {
        /// The line of the program.
        line: u64,
        /// What is wrong.
        error: GeometryError,
    },
    /// The machine does not take a block.
    #[error("line {line}: {error}")]
    Block {
        /// The line of the program.
        line: u64,
        /// What is wrong.
        error: ModelError,
    },
    /// A feed of G00 for hardware that takes none.
    #[error(
        "--rapid {rapid}: no expression of {bench} reads rate, so the hardware sets its own feed: leave --rapid out"
    )]
    Rapid {
        /// The feed in mm/min.
        rapid: f64,
        /// The hardware.
        bench: &'static str,
    },
    /// Nothing moves.
    #[error("no block of the program moves an axis by as much as one BLU: choose a smaller --blu")]
    NoPulses,
    /// A file cannot be read, or what is wrong with its text, with the name of the file.
    #[error("{0}")]
    File(String),
    /// The machine does not take what it is given.
    #[error(transparent)]
    Model(#[from] ModelError),
}
