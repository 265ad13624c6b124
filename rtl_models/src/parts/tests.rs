//! Every part alone on a bench, on every engine.
//!
//! A wave in these tests is a string with one character a sample: hexadecimal digits, `-` for -1, and `_` between
//! groups of four. Sample k is at the same place in every wave of a test, inputs included.

mod axis;
mod beats;
mod bench;
mod block;
mod comparison;
mod coordinate;
mod deviation;
mod digit_adder;
mod down_counter;
mod end_counters;
mod frames;
mod integrator;
mod integrator_pair;
mod normalizer;
mod phase_accumulator;
mod quadrant;
mod rate_multiplier;
mod serial;
mod sign;
mod step_output;
mod wide;
