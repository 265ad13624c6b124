//! The netlist kernel.
