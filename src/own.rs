//! Hardware of one's own: netlists from files, run by a stimulus, proved for every one, or with a bench file as a model.

mod announce;
mod bench;
mod example;
mod file;
mod printed;
mod prove;
mod sim;
mod stimulus;
mod vhdl;
mod yosys;

pub(crate) use announce::{announce, matching};
#[cfg(feature = "cli")]
pub(crate) use bench::next_to;
pub use bench::{BenchError, is_netlist, model};
pub use file::{FileError, read_netlist};
#[cfg(feature = "cli")]
pub(crate) use file::{checked, read_stimulus, read_text, summary};
pub use prove::{BenchReport, Counterexample, Goal, Prove, ProveReport, SecondOpinion, SolverLanguage, Verdict};
pub use sim::{Sim, SimReport};
pub use stimulus::{Stimulus, StimulusError};
#[cfg(feature = "cli")]
pub(crate) use yosys::loaded_then_assigned;
pub use yosys::{Source, YosysError, yosys_json};
