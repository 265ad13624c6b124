//! Proofs at one width, for what no polynomial says: one block is followed clock by clock with the bits of its load
//! words unknown ([`follow()`]), and a second method that shares only the question with it counts the pulses again
//! ([`recount()`]).

mod follow;
mod recount;
mod three_valued;

pub use follow::{Followed, KnownSample, LoadWord, Lost, Sum, follow};
pub use recount::{AxisNets, recount};
