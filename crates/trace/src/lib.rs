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
pub mod timescale;
pub mod vcd;
mod wide;
