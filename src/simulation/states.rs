//! `run --checkpoints`: a file of states, written by one run for the next.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::testbench::{Checkpoint, Checkpoints, Testbench};

use super::Simulation;
use crate::Error;
use crate::output::{Outputs, Sink};

/// What a file of states is for.
pub(super) enum States<'a> {
    /// It does not exist yet: this run writes it.
    Kept(&'a Path, Checkpoints),
    /// It holds a state shortly before the window of the wave: this run begins there.
    Resumed(Checkpoint),
}

impl<'a> States<'a> {
    /// What the options ask for; nothing where the file holds no state before the window.
    pub(super) fn of(simulation: &'a Simulation, bench: &Testbench) -> Result<Option<States<'a>>, Error> {
        let Some(path) = &simulation.checkpoints else { return Ok(None) };
        if simulation.steps.is_some() || simulation.plot.is_some() {
            let need = "the step table and the picture need every step, from the first";
            return Err(Error::Invalid(format!("--checkpoints: {need}: leave out --steps and --plot")));
        }
        let read = |what: &dyn std::fmt::Display| {
            let remedy = "name another file, or delete it";
            Error::Invalid(format!("--checkpoints {}: {what}: {remedy}", path.display()))
        };
        match fs::read_to_string(path) {
            Ok(text) => {
                let states = Checkpoints::read(&text, bench).map_err(|error| read(&error))?;
                Ok(states.before(simulation.waves.from).cloned().map(States::Resumed))
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Some(States::Kept(path, Checkpoints::new(bench)))),
            Err(error) => Err(read(&error)),
        }
    }

    /// Opens the file that is to be written.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn open(self, outputs: &mut Outputs) -> Result<Begin, Error> {
        Ok(match self {
            States::Kept(path, states) => Begin::New { states, sink: outputs.open(path)? },
            States::Resumed(state) => Begin::At(state),
        })
    }
}

/// Where a run begins.
pub(super) enum Begin {
    /// At the reset; its states are kept.
    New {
        /// The states so far.
        states: Checkpoints,
        /// Where they go.
        sink: Sink,
    },
    /// At a state.
    At(Checkpoint),
}

impl Begin {
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
        if let Begin::New { states, mut sink } = self {
            sink.write_all(states.write()?.as_bytes())?;
            sink.flush()?;
        }
        Ok(())
    }
}
