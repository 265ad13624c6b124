//! `sampled-arc`: data sampling (数据采样法), arc: a coarse stage once a period, and a fine DDA between.
//!
//! ```text
//!   coarse, one state after another                     fine, 2^k additions in T
//!   ┌────────────┐
//!   │ multiplier │◄─┐                                   jvx_next ──► jvx ──► + ──► jrx ──┐
//!   │ divider    │◄─┼── state ──► px, py ──► round ────┤ (buffer)            ▲───────────┘
//!   │ root       │◄─┘     remx, remy   less tx, ty      jvy_next ──► jvy      │ carry ──► dx ──► x
//!   └────────────┘               └─► side of the end
//! ```
//!
//! n bits hold 1.25·R and some BLU, q is `--fraction`, and 2^k is greater than the displacement of any period. The signs of px and
//! py are all that distinguishes quadrants; nothing is reloaded at the axes.
//!
//! - `7m` (T = 8 ms): of the smaller coordinate u and the larger v, where both grow away from each other,
//!   tan α = (u + ½f·cos 45°)/(v - ½f·sin 45°), and u moves by f·cos α = f/√(1 + tan² α). The larger becomes √(R² - u²):
//!   that is Δv from Δv(v - ½Δv) = Δu(u + ½Δu), which keeps the point on the circle. Towards the axis, where |u| shrinks,
//!   both signs in tan α turn over. Beyond 45° x and y change places.
//! - `7360` (T = 10.24 ms, the extended DDA): λ = f/R with n+q bits of fraction, once for the block. Clockwise
//!   Δx = λ(y - ½λx) and Δy = -λ(x + ½λy), counter-clockwise with -λ, added to {px, remx} and {py, remy}. The radius
//!   grows by the factor √(1 + λ⁴/4) a period.
//!
//! The fine stage takes the points rounded to the nearest pulse; the fraction stays in the point. The last period is the
//! one that passes the radius to the end point: before it xe·y - ye·x, which the multiplier gives in every period, has
//! the sign of a point before the end, and after it no longer. It takes what is left, so that the end is exact. An
//! arc that starts after the radius of its end, or on it, goes once around.
//!
//! The chord of a period leaves the arc by f²/(8R): steps for which that is more than `--tolerance`, or which are longer
//! than R/2, are refused.
//!
//! The multiplier (shift and add), the divider and the root (both restoring) take a bit a clock. While the fine stage
//! draws one period, they calculate the next. A divider of the clock spreads the 2^k additions of a period over T, so
//! that at the clock frequency given a period takes T, what is not a whole number of clocks carried on to the next; a
//! clock that leaves the coarse calculation too few clocks is refused. `stepped` marks the end of each period, which is a
//! row of the step table.
//!
//! A quarter of the circle of 10 BLU with 4 BLU a period, from the golden file `waves/sampled-arc-7m.csv`; the wave
//! is next to it:
//!
//! ```text
#![doc = include_str!("../waves/sampled-arc-7m.csv")]
//! ```
//!
//! The same by the step factor, λ = 0.4, from `waves/sampled-arc-7360.csv`:
//!
//! ```text
#![doc = include_str!("../waves/sampled-arc-7360.csv")]
//! ```

use stepwave_nc::{Arc, Crossing, Direction};
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::docs::{SAMPLED_SYSTEM, SAMPLED_WIDTH};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{FRACTION, ON_OVERFLOW, PRESET, STEP, System, TOLERANCE};
use crate::parts::Task::{Start, Wait};
use crate::parts::{
    BURST, Block, CCW, DISPLACEMENT, EndRadius, FineStage, JV, Microprogram, POINT, POSITION, Row, STATE, divide,
    magnitude, magnitude_of_difference, multiply, row, square_root, squares, states, with_sign,
};
use crate::plan::Plan;
use crate::registers::{Reg, Rule};
use crate::sampling::{BY_STEP_FACTOR, Sampling};
use crate::sizes;

const P_XY: Reg<2> =
    Reg::each(["px", "py"], Rule::Planned("n+1+q"), "coarse point that is calculated, about the centre, signed")
        .signed()
        .inner();
const REMAINDERS: Reg<2> = Reg::each(["remx", "remy"], Rule::Planned("n+q"), "remainder of each below the fraction")
    .inner()
    .when(&BY_STEP_FACTOR);
const ENDS: Reg<2> = Reg::each(["xe", "ye"], Rule::Planned("n+1"), "end point about the centre, signed");

/// Data sampling with a fine DDA, arc.
pub static MODEL: Model = Model {
    name: "sampled-arc",
    title: "Data sampling with a fine DDA, arc",
    method: "data sampling",
    source: "数据采样法, the two-stage interpolation of CNC systems, as in Chinese NC textbooks",
    registers: &[&STATE, &P_XY, &REMAINDERS, &POINT, &BURST, &POSITION],
    options: &[
        &SAMPLED_SYSTEM,
        &FRACTION,
        &STEP.about("BLU of a period, R/2 at most (default: 8, or what is taken); or --feed"),
        &TOLERANCE.about("greatest chord error in BLU (default: 1)"),
        &SAMPLED_WIDTH,
        &PRESET,
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Arcs(Method { plan, load }),
    hardware,
};

fn plan(arc: &Arc, plan: &mut Plan) -> Result<(), ModelError> {
    let radius = arc.radius();
    let sampling = Sampling::plan(plan, radius, Some(radius))?;
    let sectors = arc.sectors(Crossing::PathExtreme);
    // The end may lie 1 BLU off the circle, and a path by the step factor ends outside it.
    let more = 2.0 + growth(&sampling, radius);
    // From one hand-over to the next: a component takes a bit a clock, and its state two more.
    let bits = sampling.magnitude();
    let [product, root, quotient] = [bits + 2, bits + 2, 2 * bits + 2];
    let (sides, hand, drive) = (2 * product, 1, 1);
    let own = match sampling.system {
        System::Direction => 2 * quotient + 2 * root + 2 * product + drive,
        System::StepFactor => 4 * product,
    };
    FineStage::plan(sampling, plan, more, own + sides + hand, sizes::arc_positions(arc, &sectors))
}

/// How far a full circle by the step factor ends outside, in BLU: λ = f/R, and R grows by the factor sqrt(1 + λ⁴/4) in
/// each of 2π/λ periods.
fn growth(sampling: &Sampling, radius: f64) -> f64 {
    match sampling.system {
        System::Direction => 0.0,
        System::StepFactor => radius * (sampling.step.units() / radius).powi(3) * std::f64::consts::FRAC_PI_4,
    }
}

// States of the coarse stage: common ones, those of `7m`, those of `7360`.
states! { mod at {
    IDLE = 0, SQUARE_X = 1, SQUARE_Y = 2, SIDE_X = 3, SIDE_Y = 4, HAND_OVER = 5,
    HALF_STEP = 6, TANGENT = 7, SQUARE_TAN = 8, SECANT = 9, COSINE = 10, DRIVE = 11, SQUARE = 12, ROOT = 13,
    RADIUS = 6, LAMBDA = 7, MIDDLE_X = 8, MIDDLE_Y = 9, STEP_X = 10, STEP_Y = 11
} }

/// What both systems calculate with.
#[derive(Clone, Copy)]
struct Coarse<'m> {
    program: Microprogram<'m>,
    bits: u32,
    f: Signal<'m>,
    ccw: Signal<'m>,
    point: [Register<'m>; 2],
    /// R² with the fraction of a square.
    radicand: Signal<'m>,
}

/// tan α = (u + f/2·cos 45°) / (v - f/2·sin 45°) of the axis u that is driven and the other, v; u moves by f·cos α,
/// and v is what the circle leaves of R².
fn by_direction(coarse: Coarse<'_>) -> Vec<Row<'_>> {
    let Coarse { program, bits, f, ccw, point: [px, py], radicand } = coarse;
    let (m, size) = (program.m, |value| magnitude(program.m, value).slice(0, bits));
    let (product, quotient, root) = (program.multiplier.product(), program.divider.quotient(), program.root.root());
    // Bits of the fraction of tan and sec; ½·cos 45° with as many bits as f has.
    let (p, k) = (f.bits().min(bits - 2), f.bits().min(40));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let half_cosine = m.lit(k, (std::f64::consts::FRAC_1_SQRT_2 / 2.0 * (1_u64 << k) as f64).round() as u64);
    let half_step = m.reg("half_step", f.bits());
    let [drives_x, backwards, other_negative] =
        ["x_is_driven", "backwards", "other_negative"].map(|name| m.reg(name, 1));
    let tangent = m.reg("tangent", p + 1);

    let (x, y) = (px.q, py.q);
    let [ax, ay] = [x, y].map(size);
    let x_is_driven = !ay.less_than(ax);
    let [driven, other] = [x_is_driven.mux(x, y), x_is_driven.mux(y, x)];
    let [u, v] = [x_is_driven.mux(ax, ay), x_is_driven.mux(ay, ax)];
    // Clockwise x goes with y, and y against x.
    let against = x_is_driven.mux(y.msb(), !x.msb()) ^ ccw;
    let outwards = u.is_zero() | !(driven.msb() ^ against);
    let half = half_step.q.extend(bits);
    let ahead = outwards.mux(u.wrapping_add(half), magnitude_of_difference(m, u, half));
    let below = outwards.mux(v.wrapping_sub(half), v.wrapping_add(half));
    let kept = [(drives_x, x_is_driven), (backwards, against), (other_negative, other.msb())];

    let one = m.lit(1, 1).concat(m.lit(2 * p, 0)).extend(2 * bits);
    let above_one = product.slice(0, 2 * p + 2).extend(2 * bits).wrapping_add(one);
    let driven = drives_x.q.mux(x, y);
    let chord = quotient.slice(0, f.bits()).extend(bits + 1).as_signed();
    let moved = backwards.q.mux(driven.wrapping_sub(chord), driven.wrapping_add(chord));
    let found = with_sign(m, root, bits + 1, other_negative.q);
    let drive = [(px, drives_x.q.mux(moved, x)), (py, drives_x.q.mux(y, moved))];
    let follow = [(px, drives_x.q.mux(x, found)), (py, drives_x.q.mux(found, y))];
    let [ahead, scaled_f] = [ahead, f].map(|value| value.concat(m.lit(p, 0)));
    let (cosine, tan, coordinate) = (product.slice(k, f.bits()), quotient.slice(0, p + 1), size(driven));
    vec![
        row(at::HALF_STEP, multiply(f, half_cosine), [(half_step, cosine)], at::SIDE_X),
        row(at::TANGENT, divide(ahead, below), [(tangent, tan)], at::SQUARE_TAN).keeping(kept),
        row(at::SQUARE_TAN, multiply(tangent.q, tangent.q), [], at::SECANT),
        row(at::SECANT, square_root(above_one), [], at::COSINE),
        row(at::COSINE, divide(scaled_f, root.slice(0, p + 2)), [], at::DRIVE),
        row(at::DRIVE, Wait(m.lit(1, 1)), drive, at::SQUARE),
        row(at::SQUARE, multiply(coordinate, coordinate), [], at::ROOT),
        row(at::ROOT, square_root(radicand.saturating_sub(product)), follow, at::SIDE_X),
    ]
}

/// λ = f/R, and clockwise Δx = λ(y - ½λx), Δy = -λ(x + ½λy); counter-clockwise λ is negative. `rests` is what a step
/// leaves below the fraction.
fn by_step_factor<'m>(coarse: Coarse<'m>) -> (Vec<Row<'m>>, [Register<'m>; 2]) {
    let Coarse { program, bits, f, ccw, point: [px, py], radicand } = coarse;
    let m = program.m;
    let product = program.multiplier.product();
    let plus = |a: Signal<'m>, b: Signal<'m>, subtract: Signal<'m>| subtract.mux(a.wrapping_sub(b), a.wrapping_add(b));
    let lambda = m.reg("lambda", bits);
    let [middle_y, middle_x] = ["middle_y", "middle_x"].map(|name| m.reg(name, bits + 1));
    // From a coordinate, half of λ times the other.
    let middle = |from: Register<'m>, other: Register<'m>, subtract| {
        let half = with_sign(m, product.slice(bits + 1, bits - 1), bits + 1, other.q.msb());
        plus(from.q, half, subtract)
    };
    let step = |axis: Register<'m>, rest: Register<'m>, middle: Register<'m>, against| {
        let chord = product.extend(2 * bits + 1).as_signed();
        let sum = plus(axis.q.concat(rest.q), chord, middle.q.msb() ^ against);
        [(axis, sum.slice(bits, bits + 1).as_signed()), (rest, sum.slice(0, bits))]
    };
    let [rest_x, rest_y] = [0, 1].map(|axis| m.reg(REMAINDERS.of(axis).name(), bits));
    let (to_y, to_x) = (middle(py, px, !ccw), middle(px, py, ccw));
    let (step_x, step_y) = (step(px, rest_x, middle_y, ccw), step(py, rest_y, middle_x, !ccw));
    let [x, y, at_y, at_x] =
        [px.q, py.q, middle_y.q, middle_x.q].map(|coordinate| magnitude(m, coordinate.as_signed()).slice(0, bits));
    let (scaled_f, found) = (f.concat(m.lit(bits, 0)), program.divider.quotient().slice(0, bits));
    let rows = vec![
        row(at::RADIUS, square_root(radicand), [], at::LAMBDA),
        row(at::LAMBDA, divide(scaled_f, program.root.root()), [(lambda, found)], at::SIDE_X),
        row(at::MIDDLE_X, multiply(x, lambda.q), [(middle_y, to_y)], at::MIDDLE_Y),
        row(at::MIDDLE_Y, multiply(y, lambda.q), [(middle_x, to_x)], at::STEP_X),
        row(at::STEP_X, multiply(at_y, lambda.q), step_x, at::STEP_Y),
        row(at::STEP_Y, multiply(at_x, lambda.q), step_y, at::SIDE_X),
    ];
    (rows, [rest_x, rest_y])
}

fn hardware(top: Scope<'_>, hardware: &Hardware) {
    let Some(sampling) = hardware.sampling else { return };
    let (q, n, bits) = (sampling.fraction, sampling.whole, sampling.magnitude());
    let block = Block::new(top);
    let fine = FineStage::new(top.scope("fine"), hardware.bits(JV.of(0)));
    let m = top.scope("coarse");
    let f = block.held(m, DISPLACEMENT.name(), sampling.word_bits());
    let ccw = hardware.held(m, &block, CCW);
    let point = [0, 1].map(|axis| m.reg_signed(P_XY.of(axis).name(), bits + 1));
    let square = m.reg("square", 2 * n);
    let program = Microprogram::new(m, [bits; 2], [2 * bits, bits], bits);
    let ends = [0, 1].map(|axis| block.held_signed(m, ENDS.of(axis).name(), n + 1));
    let coarse = Coarse { program, bits, f, ccw, point, radicand: square.q.concat(m.lit(2 * q, 0)) };
    let [start_x, start_y] = [0, 1].map(|axis| block.word_signed(P_XY.of(axis).name(), bits + 1));
    let (own, rests, [after_square, period]) = match sampling.system {
        System::Direction => (by_direction(coarse), vec![], [at::HALF_STEP, at::TANGENT]),
        System::StepFactor => {
            let (rows, rests) = by_step_factor(coarse);
            (rows, rests.to_vec(), [at::RADIUS, at::MIDDLE_X])
        }
    };

    let [x, y] = point.map(|axis| axis.q);
    let radius = EndRadius::new(program, [x, y], ends, [bits, n], ccw);
    let hand = m.name("hand", program.at(at::HAND_OVER) & fine.free());

    let [yes, no] = [m.lit(1, 1), m.lit(1, 0)];
    let start = [(point[0], start_x), (point[1], start_y), (radius.arrives, no), (radius.first, yes)];
    let wholes = radius.magnitudes.map(|coordinate| coordinate.slice(q, n));
    let squares = squares(&program, square, wholes, [at::SQUARE_X, at::SQUARE_Y, after_square]);
    let sides = radius.rows([at::SIDE_X, at::SIDE_Y, at::HAND_OVER], period, no);
    let idle = row(at::IDLE, Start(block.load), start, at::SQUARE_X).clearing(m, &rests);
    let hand_over = row(at::HAND_OVER, Wait(fine.free()), [], period).unless(radius.arrives.q, at::IDLE);
    program.close(&[&[idle][..], &squares, &sides, &[hand_over], &own].concat());
    // As wide as the points that the fine stage takes.
    let points = [x, y].map(|coordinate| coordinate.extend(bits + 2));
    fine.close(block, hardware, [hand, radius.arrives.q], points, q, ends);
}

fn load(arc: &Arc, hardware: &Hardware) -> Vec<Words> {
    let Some(sampling) = hardware.sampling else { return Vec::new() };
    let [start, end, from] = [arc.start(), arc.end(), arc.from()].map(|point| point.map(i128::from));
    let ccw = arc.direction() == Direction::CounterClockwise;
    let words = Words::new().set(DISPLACEMENT, sampling.word).set(CCW, ccw);
    let words = words.set_each(P_XY, start.map(|coordinate| coordinate << sampling.fraction)).set_each(ENDS, end);
    FineStage::words(words, hardware, start, from)
}
