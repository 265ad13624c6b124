//! The README tells the truth, and the rules of the house hold.

mod readme;
mod tidy;
