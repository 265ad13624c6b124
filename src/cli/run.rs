//! What describes the run of a model, for every command that makes one.

use std::path::PathBuf;

use clap::Args;

use super::{BenchArgs, ClockArgs, GeometryArgs, HardwareArgs, SimulationArgs};

/// Geometry, hardware and clock of a run.
#[derive(Debug, Args)]
pub(crate) struct MachineRun {
    #[command(flatten)]
    pub(crate) bench: BenchArgs,
    #[command(flatten)]
    pub(crate) geometry: GeometryArgs,
    #[command(flatten)]
    pub(crate) hardware: HardwareArgs,
    #[command(flatten)]
    pub(crate) clock: ClockArgs,
    #[command(flatten)]
    pub(crate) simulation: SimulationArgs,
}

impl MachineRun {
    /// The files that are read for such a run of the model of this name.
    pub(crate) fn files(&self, model: &str) -> Vec<PathBuf> {
        self.bench.files([&model.to_owned()]).into_iter().chain(self.geometry.file()).collect()
    }
}
