//! Parts: clocked components that more than one interpolator is made of. A part is a plain function, or a struct where
//! a register has to exist before the logic that drives it.

mod arc_frame;
mod axis;
mod beats;
mod block;
mod comparison;
mod coordinate;
mod deviation;
mod digit_adder;
mod distributor;
mod down_counter;
mod end_counters;
mod fine_stage;
mod follower;
mod integrator;
mod integrator_pair;
mod iteration;
mod line_frame;
mod microprogram;
mod normalizer;
mod phase_accumulator;
mod pulse_source;
mod quadrant;
mod rate_multiplier;
mod serial_divider;
mod serial_multiplier;
mod serial_root;
mod sign;
mod step_output;

pub use arc_frame::{ArcFrame, square_gain};
pub use axis::axis_counter;
pub use beats::BeatRing;
pub use block::{Block, Buffer};
pub use comparison::{Change, Side, Weighing, comparison_integral};
pub use coordinate::up_down_counter;
pub use deviation::DeviationAccumulator;
pub use digit_adder::{decimal_adder, digit_adder};
pub use distributor::{Motion, distributor};
pub use down_counter::{DownCounter, population_count};
pub use end_counters::EndCounters;
pub use fine_stage::FineStage;
pub use follower::follower;
pub use integrator::{digits, integrator, rotated};
pub use integrator_pair::{IntegratorPair, PairSide};
pub use iteration::Iteration;
pub use line_frame::LineFrame;
use microprogram::operand;
pub(crate) use microprogram::states;
pub use microprogram::{Microprogram, Row, State, Task, row};
pub use normalizer::{Normalized, Normalizer, shifted_left, shifted_right};
pub use phase_accumulator::PhaseAccumulator;
pub use pulse_source::{RATE_BITS, pulse_source};
pub use quadrant::{Kind, next_quadrant, quadrant_register, x_grows};
pub use rate_multiplier::{RateMultiplier, Units};
pub use serial_divider::SerialDivider;
pub use serial_multiplier::SerialMultiplier;
pub use serial_root::SerialRoot;
pub use sign::{magnitude, negated, with_sign};
pub use step_output::{StepOutput, Timer};

#[cfg(test)]
mod tests;
