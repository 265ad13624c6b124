//! Waves: which nets are shown, how they are written, read back and compared.

pub mod gtkw;

pub mod probe;

pub mod timescale;
pub mod vcd;
