//! The tests of the whole: models against plain recurrences, engines against each other, waves against a second
//! reader, and the command line as its users meet it.

// A test that cannot continue fails.
#![allow(clippy::unwrap_used)]

mod cli;
mod engine;
mod export;
mod house;
mod import;
mod models;
mod netlist;
mod programs;
mod proofs;
mod reference;
mod waves;
