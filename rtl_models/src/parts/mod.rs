//! Parts: clocked components that more than one interpolator is made of. A part is a plain function, or a struct where
//! a register has to exist before the logic that drives it.

mod after;
mod arc_frame;
mod axis;
mod beats;
mod block;
mod cascade;
mod comparison;
mod coordinate;
mod deviation;
mod digit_adder;
mod distributor;
mod down_counter;
mod end_counters;
mod end_radius;
mod fine_stage;
mod follower;
mod integrator;
mod integrator_pair;
mod iteration;
mod line_frame;
mod long;
mod microprogram;
mod minimum_deviation;
mod normalizer;
mod phase_accumulator;
mod point_comparison;
mod pulse_source;
mod quadrant;
mod ramp;
mod rate_multiplier;
mod s_curve;
mod serial_divider;
mod serial_multiplier;
mod serial_root;
mod sign;
mod smoothing;
mod space_line;
mod step_output;
mod wide;

pub use after::{AxisAfter, Period, SETTLE};
use arc_frame::square_gain;
pub use arc_frame::{ArcFrame, XI_YI, count_coordinates, ends_ahead, growing, shrinking, square_gains};
pub use axis::{POSITION, SIGN, axis_counter, axis_scope};
pub use beats::BeatRing;
pub use block::{Block, Buffer};
pub use cascade::{FIRST_DIFFERENCE, MODULUS, ONE_PULSE, SECOND_DIFFERENCE, THIRD_DIFFERENCE, cascade};
pub use comparison::{A_B, BASE, Change, Side, Weighing, comparison_integral};
pub use coordinate::up_down_counter;
pub use deviation::{DeviationAccumulator, F};
pub use digit_adder::{decimal_adder, digit_adder};
pub use distributor::{Motion, PLANE, distributor, plane_bits, plane_index};
pub use down_counter::{DownCounter, population_count};
pub use end_counters::{E, END, EndCounters, handed_over};
pub use end_radius::EndRadius;
pub use fine_stage::{BURST, DISPLACEMENT, FineStage, POINT, TARGET};
pub use follower::{FOLLOWER_SIGN, REST, SHARE, WHOLE, followers, followers_of};
use integrator::fine_line;
pub use integrator::{JR, JV, digits, integrator, rotated};
pub use integrator_pair::{IntegratorPair, PairSide};
pub use iteration::{Iteration, PLACE};
pub use line_frame::{LONGEST, LineFrame};
pub(crate) use long::MOST_BITS;
pub use long::{Long, LongRegister};
use microprogram::operand;
pub(crate) use microprogram::states;
pub use microprogram::{Microprogram, Row, STATE, State, Task, divide, multiply, row, square_root, squares};
pub use minimum_deviation::{LeastDeviation, line_change};
pub use normalizer::{Normalized, Normalizer, shifted_left, shifted_right};
pub use phase_accumulator::{ACC, PhaseAccumulator, RATE};
pub use point_comparison::{judged_by_sign, step_of_circle};
pub use pulse_source::{
    CARRY, FASTEST_RATE, OWN_PULSES, PULSE_RATE, PULSES, RATE_BITS, RATIO, RATIO_BITS, RATIO_FRACTION, pulse_source,
    pulse_source_while,
};
pub use quadrant::{ArcKind, CCW, QUAD, next_quadrant, quadrant_register, x_grows};
pub use ramp::{GAINS, LIMITS, PATH_GAINS, PHASE, RESTART, RISEN, Ramp, RampBits, RampEdge, V, WHOLE_OVERRIDE};
pub use rate_multiplier::{COEFFICIENT, Q, RateMultiplier, Units};
pub use s_curve::{CHANGE, GROWTH, LENGTH, PARTS, SCurveBits, TICKS};
pub use serial_divider::SerialDivider;
pub use serial_multiplier::SerialMultiplier;
pub use serial_root::SerialRoot;
pub use sign::{magnitude, magnitude_of_difference, negated, with_sign};
pub(crate) use smoothing::{NONE, Taking, YOUNGER, exponential, integrand, moving_sum};
pub(crate) use space_line::space_words;
pub use space_line::{DEVIATION, IN_PLANE, IN_SPACE, LONG, SpaceAxis, SpaceLine, TRAVEL};
pub use step_output::{StepOutput, Timer};

#[cfg(test)]
mod tests;
