//! Hardware of one's own: netlists from files, run by a stimulus, without a model and without a geometry.

mod file;
mod sim;
mod stimulus;
mod yosys;

pub use file::{FileError, read_netlist};
#[cfg(feature = "cli")]
pub(crate) use file::{checked, read_text, summary};
pub use sim::{Sim, SimReport};
pub use stimulus::{Stimulus, StimulusError};
pub use yosys::{Source, YosysError, yosys_json};
