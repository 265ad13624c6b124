//! Where the blocks of a run come from.

use stepwave_netlist::Net;

use super::{ObserverError, Part, Testbench};

/// What a machine does next.
#[derive(Clone, Debug)]
pub enum Next {
    /// It takes a block: the words on its inputs, and of a program what they are a part of.
    Block(Vec<(Net, u64)>, Option<Box<Part>>),
    /// Nothing for this many clocks, from the end of all blocks before.
    Wait(u64),
    /// The end of the run, at the end of all blocks before.
    End,
}

/// Gives a machine its blocks, in order: those of one geometry, or those of a whole program.
///
/// A machine with a block buffer asks for the next block while the present one runs; any other asks as early, and takes it
/// when the present one has ended.
pub trait Feeder {
    /// What is next; not asked again after [`Next::End`].
    ///
    /// # Errors
    /// Whatever keeps the feeder from it; the run ends.
    fn next(&mut self) -> Result<Next, ObserverError>;

    /// Load words of all blocks so far that did not fit in their registers.
    fn cut_words(&self) -> u64 {
        0
    }
}

/// The blocks of a bench's geometry.
pub(super) struct Geometry<'a>(std::slice::Iter<'a, Vec<(Net, u64)>>);

impl Testbench {
    /// The blocks of its geometry from this one on.
    pub(super) fn geometry(&self, first: usize) -> Geometry<'_> {
        Geometry(self.blocks.get(first..).unwrap_or_default().iter())
    }
}

impl Feeder for Geometry<'_> {
    fn next(&mut self) -> Result<Next, ObserverError> {
        Ok(self.0.next().map_or(Next::End, |words| Next::Block(words.clone(), None)))
    }
}
