//! `run --checkpoints`: a file of states, written by one run for the next.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::testbench::{Checkpoint, Checkpoints, Testbench};

use super::Simulation;
use crate::Error;
use crate::output::{Outputs, Sink};

/// Where a run begins, and what its file of states is for.
pub(super) enum Begin<'a> {
    /// At the reset: the file does not exist yet, and the run writes it.
    New { states: Checkpoints, path: &'a Path, sink: Option<Sink> },
    /// At a state in the file, shortly before the window of the wave.
    At(Checkpoint),
}

impl<'a> Begin<'a> {
    /// What the options ask for; nothing where the file holds no state before the window.
    pub(super) fn of(simulation: &'a Simulation, bench: &Testbench) -> Result<Option<Begin<'a>>, Error> {
        let Some(path) = &simulation.checkpoints else { return Ok(None) };
        if simulation.source.file().is_some() {
            let need = "states are kept of a run along a curve, not of a program";
            return Err(Error::Invalid(format!("--checkpoints: {need}: leave the option out")));
        }
        let files = [&simulation.files.steps, &simulation.files.plot, &simulation.waves.html];
        if files.into_iter().any(Option::is_some) {
            let need = "the step table, the picture and the page need every step, from the first";
            return Err(Error::Invalid(format!("--checkpoints: {need}: leave out --steps, --plot and --html")));
        }
        let read = |what: &dyn std::fmt::Display| {
            let remedy = "name another file, or delete it";
            Error::Invalid(format!("--checkpoints {}: {what}: {remedy}", path.display()))
        };
        match fs::read_to_string(path) {
            Ok(text) => {
                let states = Checkpoints::read(&text, bench).map_err(|error| read(&error))?;
                Ok(states.before(simulation.waves.from).cloned().map(Begin::At))
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Ok(Some(Begin::New { states: Checkpoints::new(bench), path, sink: None }))
            }
            Err(error) => Err(read(&error)),
        }
    }

    /// Opens the file that is to be written.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn open(&mut self, outputs: &mut Outputs) -> Result<(), Error> {
        if let Begin::New { path, sink, .. } = self {
            *sink = Some(outputs.open(path)?);
        }
        Ok(())
    }

    /// Clock of the state that the run begins at.
    pub(super) fn clock(&self) -> Option<u64> {
        match self {
            Begin::New { .. } => None,
            Begin::At(state) => Some(state.clock()),
        }
    }

    /// Writes the states that were kept.
    ///
    /// # Errors
    /// They cannot be written.
    pub(super) fn finish(self) -> Result<(), Error> {
        if let Begin::New { states, sink: Some(mut sink), .. } = self {
            sink.write_all(states.write()?.as_bytes())?;
            sink.flush()?;
        }
        Ok(())
    }
}
