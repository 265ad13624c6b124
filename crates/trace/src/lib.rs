//! Waves: which nets are shown, how they are written, read back and compared.

pub mod changes;
pub mod diverge;
pub mod draw;
pub mod fst;
pub mod gtkw;
pub mod guard;
pub mod merge;
mod moves;
pub mod numbers;
pub mod pattern;
pub mod probe;
pub mod read;
pub mod surfer;
pub mod timescale;
pub mod vcd;
mod wide;

use std::io;
use std::ops::Range;

use stepwave_netlist::Rows;

/// A format of waves whose header is written: takes the rows of blocks, in order.
pub trait WaveBody {
    /// What is left when the wave is whole.
    type Output;

    /// Takes some rows of a block, which are later than those taken before.
    ///
    /// # Errors
    /// The output cannot be written.
    fn rows(&mut self, rows: &Rows, range: Range<usize>) -> io::Result<()>;

    /// Samples up to this clock, after the last row, are as that row.
    fn rest(&mut self, clock: u64);

    /// Ends the wave.
    ///
    /// # Errors
    /// The output cannot be written.
    fn finish(self) -> io::Result<Self::Output>;
}
