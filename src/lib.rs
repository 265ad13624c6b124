//! Cycle-accurate simulation of numerical-control interpolator hardware.
pub mod testbench;
