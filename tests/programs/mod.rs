//! Whole programs: machines of every method, and what comes before them.

mod acceleration;
mod alone;
mod axes;
mod command;
mod curves;
mod field;
mod free_curves;
mod like_any;
mod machines;
mod smoothing;
