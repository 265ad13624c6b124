//! What engines promise: the meaning of each operator on every engine, clocks and samples, random netlists, native code,
//! and many geometries in lanes.

#![cfg(test)]

mod branches;
mod digest;
mod lanes;
mod memories;
mod native;
mod operators;
mod passing;
pub(crate) mod random;
mod semantics;
mod unnamed;
