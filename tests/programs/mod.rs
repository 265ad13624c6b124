//! Whole programs: machines of every family, and what comes before them.

mod command;
mod field;
mod machines;
