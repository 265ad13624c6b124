//! The tests of the whole: models against plain recurrences, engines against each other, waves against a second
//! reader, and the command line as its users meet it.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used)]

mod cli;
mod export;
mod house;
mod kernel;
mod lanes;
mod models;
mod programs;
mod proofs;
mod reference;
mod waves;
