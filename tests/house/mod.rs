//! The README is true, and the rules of the house hold.

mod examples;
mod readme;
mod tidy;
mod words;
