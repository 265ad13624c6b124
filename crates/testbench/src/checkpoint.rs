//! States of a run that are kept, so that a later run of the same machine can begin in the middle.
//!
//! A state is taken between two blocks of samples: registers and inputs of the machine, and what every observer has
//! gathered, so that the report of a run that was continued is that of a whole run. There are at most [`KEPT`] states;
//! when there would be more, every second one is dropped and the distance doubled.

use std::collections::BTreeMap;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use stepwave_engine::{Engine, contents};
use stepwave_netlist::Net;
use stepwave_netlist::text;

use super::Testbench;

/// Most states kept.
const KEPT: usize = 256;
/// Clocks between the first states.
const INTERVAL: u64 = 1 << 16;

/// Greatest clock or count that a state may hold: beyond it one more day of simulation could overflow.
pub(super) const GREATEST: u64 = 1 << 62;

/// What observers have gathered, by their names.
pub type Memory = BTreeMap<String, Value>;

/// What an observer wrote down under its name.
pub(super) fn recalled<T: DeserializeOwned>(memory: &Memory, name: &str) -> Option<T> {
    memory.get(name).and_then(|value| serde_json::from_value(value.clone()).ok())
}

/// The state of a machine and its observers after some clock.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Clock of the sample.
    pub(super) clock: u64,
    /// Index of the block that runs.
    pub(super) block: usize,
    /// Values of the design's registers, in its order.
    pub(super) registers: Vec<u64>,
    /// Values of the design's inputs, in its order.
    pub(super) inputs: Vec<u64>,
    /// Words of the design's memories, in its order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) memories: Vec<Vec<u64>>,
    /// What the observers have gathered.
    pub(super) memory: Memory,
}

impl Checkpoint {
    pub(super) fn of(engine: &dyn Engine, bench: &Testbench, block: usize, memory: Memory) -> Checkpoint {
        let values = |nets: &[Net]| nets.iter().map(|&net| engine.value(net)).collect();
        let design = bench.design();
        Checkpoint {
            clock: engine.clock(),
            block,
            registers: values(design.registers()),
            inputs: values(design.inputs()),
            memories: contents(engine, design),
            memory,
        }
    }

    /// Clock of the sample that the state is of.
    #[must_use]
    pub fn clock(&self) -> u64 {
        self.clock
    }
}

/// What makes a run the same run: the machine, and what is loaded into it.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
struct Subject {
    stepwave: String,
    netlist: String,
    blocks: Vec<Vec<(usize, u64)>>,
}

impl Subject {
    fn of(bench: &Testbench) -> Subject {
        let block = |block: &Vec<(Net, u64)>| block.iter().map(|(net, v)| (net.index(), *v)).collect();
        Subject {
            stepwave: env!("CARGO_PKG_VERSION").to_owned(),
            netlist: text::print(bench.design().netlist()),
            blocks: bench.blocks.iter().map(block).collect(),
        }
    }
}

/// Why states cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The text is not what [`Checkpoints::write`] gives.
    #[error("it holds no states of a run ({0})")]
    Unreadable(String),
    /// They were taken of another run.
    #[error("it holds states of another machine, geometry or version of stepwave")]
    Other,
}

/// The states of one run, in order.
#[derive(Clone, Debug)]
pub struct Checkpoints {
    subject: Subject,
    states: Vec<Checkpoint>,
    interval: u64,
}

impl Checkpoints {
    /// No states yet.
    #[must_use]
    pub fn new(bench: &Testbench) -> Checkpoints {
        Checkpoints { subject: Subject::of(bench), states: Vec::new(), interval: INTERVAL }
    }

    /// Reads what [`write`](Self::write) gave for the same machine and geometry.
    ///
    /// # Errors
    /// The text is not a checkpoint, or of another run.
    pub fn read(text: &str, bench: &Testbench) -> Result<Checkpoints, CheckpointError> {
        let unreadable = |error: serde_json::Error| CheckpointError::Unreadable(error.to_string());
        let (subject, states): (Subject, Vec<Checkpoint>) = serde_json::from_str(text).map_err(unreadable)?;
        let fresh = Checkpoints::new(bench);
        let design = bench.design();
        let hold = |nets: &[Net], values: &[u64]| {
            let width = |net: &Net| design.netlist().width(*net);
            nets.len() == values.len() && nets.iter().zip(values).all(|(net, &value)| value <= width(net).mask())
        };
        let fits = |state: &Checkpoint| {
            hold(design.registers(), &state.registers)
                && hold(design.inputs(), &state.inputs)
                && state.block < bench.blocks.len()
                && state.clock <= GREATEST
        };
        if subject != fresh.subject || !states.iter().all(fits) {
            return Err(CheckpointError::Other);
        }
        Ok(Checkpoints { states, ..fresh })
    }

    /// All states as text, for [`read`](Self::read).
    ///
    /// # Errors
    /// None that a state of a run gives.
    pub fn write(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(&(&self.subject, &self.states)).map(|text| text + "\n")
    }

    /// The last state from which the sample of `clock` is still to come.
    #[must_use]
    pub fn before(&self, clock: u64) -> Option<&Checkpoint> {
        self.states.iter().rev().find(|state| state.clock < clock)
    }

    /// A state is wanted at this clock.
    pub(super) fn wants(&self, clock: u64) -> bool {
        clock >= self.states.last().map_or(0, |state| state.clock) + self.interval
    }

    pub(super) fn keep(&mut self, state: Checkpoint) {
        self.states.push(state);
        if self.states.len() > KEPT {
            let mut index = 0;
            self.states.retain(|_| {
                index += 1;
                index % 2 == 0
            });
            self.interval *= 2;
        }
    }
}
