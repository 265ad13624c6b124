//! `sampled-line`: data sampling (数据采样法), line of 2 axes: a coarse stage once a period, and a fine DDA between.
//!
//! ```text
//!   coarse, one state after another                     fine, 2^k additions in T
//!   ┌────────────┐
//!   │ multiplier │◄─┐                                   jvx_next ──► jvx ──► + ──► jrx ──┐
//!   │ divider    │◄─┼── state ──► far, near ──► round ─┤ (buffer)            ▲───────────┘
//!   │ root       │◄─┘     remf, remn    less tx, ty     jvy_next ──► jvy      │ carry ──► dx ──► x
//!   └────────────┘
//! ```
//!
//! | register | width | load value |
//! |---|---|---|
//! | long, short | n | abs(d) of the long and the short axis |
//! | f | as it needs | way of a period, in 2^-q BLU |
//! | far, near | n+1+q | 0: coarse way of the long and the short axis, in 2^-q BLU |
//! | remf, remn | n | 0: what is below 2^-q of both (`7360`), or of the short axis (`7m`, in parts of the long way) |
//! | cx, cy | n+2+q | coarse point that the burst draws to, from the start, signed |
//! | jvx, jvy | k | whole pulses of the period; `jvx_next`, `jvy_next` those of the next |
//! | jrx, jry | k | remainder J_R: the preset |
//! | e | k+1 | additions of the period left |
//! | phase | as it needs | divider of the clock: parts of an addition that have passed |
//!
//! n bits hold the length of the line, q is `--fraction`, and 2^k is greater than f and the pulse that rounding may add.
//!
//! Once a block the root of long² + short² gives the length. Then
//!
//! - `7m` (T = 8 ms): a period of the long axis is Δl = f·long/length, once for the block; that of the short one
//!   Δs = (Δl·short + remn)/long, whose remainder stays in remn.
//! - `7360` (T = 10.24 ms): λ = f/length with n+q bits of fraction, once for the block; {far, remf} grows by λ·long, and
//!   {near, remn} by λ·short.
//!
//! So nothing is lost, and coarse points lie on the line but for what 2^-q cuts off. The fine stage takes the points
//! rounded to the nearest pulse; the fraction stays in the point. The last period is the one in which the long axis would
//! come to its end or beyond: it takes what is left, so that the end is exact.
//!
//! The multiplier (shift and add), the divider and the root (both restoring) take a bit a clock. While the fine stage
//! draws one period, they calculate the next. A divider of the clock spreads the 2^k additions of a period over T, so
//! that at the clock frequency given a period takes T, what is not a whole number of clocks carried on to the next; a
//! clock that leaves the coarse calculation too few clocks is refused. `stepped` marks the end of each period, which is a
//! row of the step table.
//!
//! The line (12, -5) with 4 BLU a period, from the golden file `waves/sampled-line-12-5.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../../waves/sampled-line-12-5.csv")]
//! ```

use std::f64::consts::SQRT_2;

use stepwave_nc::Line;
use stepwave_netlist::dsl::Scope;

use crate::docs::{SAMPLED_SYSTEM, SAMPLED_WIDTH};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{FRACTION, ON_OVERFLOW, PRESET, STEP, System};
use crate::parts::{ArithmeticUnit, Block, FineStage, with_sign};
use crate::plan::Plan;
use crate::sampling::Sampling;
use crate::{sizes, words};

/// Data sampling with a fine DDA, line of 2 axes.
pub static MODEL: Model = Model {
    name: "sampled-line",
    title: "Data sampling with a fine DDA, line of 2 axes",
    method: "data sampling",
    source: "数据采样法, the two-stage interpolation of CNC systems, as in Chinese NC textbooks",
    registers: &[
        RegisterDoc { name: "state", width: "3", about: "step of the coarse calculation" },
        RegisterDoc { name: "far, near", width: "n+1+q", about: "coarse way of the long and the short axis" },
        RegisterDoc { name: "remf, remn", width: "n", about: "remainder of each below the fraction" },
        RegisterDoc::SAMPLED_POINT,
        RegisterDoc::SAMPLED_JV,
        RegisterDoc::SAMPLED_JR,
        RegisterDoc::POSITIONS,
    ],
    options: &[
        &SAMPLED_SYSTEM,
        &FRACTION,
        &STEP.about("BLU of a period (default: 8); or --feed"),
        &SAMPLED_WIDTH,
        &PRESET,
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let sampling = Sampling::plan(plan, line.length(), None)?;
    let coarse = f64::from(coarse_clocks(&sampling));
    sampling.hardware(plan, [0.0, coarse], sizes::end_positions(line))?;
    // Half a pulse of rounding on each axis, twice where the fine stage is between two pulses.
    plan.error_bound = Some(1.5 * SQRT_2);
    Ok(())
}

/// Clocks from one hand-over to the next: a component takes a bit a clock, and its state two more.
fn coarse_clocks(sampling: &Sampling) -> u32 {
    let product = sampling.whole + 2;
    let hand = 1;
    match sampling.system {
        System::Direction => product + dividend_bits(sampling) + 2 + hand,
        System::StepFactor => 2 * product + hand,
    }
}

fn dividend_bits(sampling: &Sampling) -> u32 {
    sampling.magnitude() + sampling.word_bits().max(sampling.whole + 1)
}

/// States of the coarse stage; SHARE is one of `7m` alone.
mod at {
    pub(super) const SQUARE_FAR: u64 = 1;
    pub(super) const SQUARE_NEAR: u64 = 2;
    pub(super) const LENGTH: u64 = 3;
    pub(super) const SHARE: u64 = 4;
    pub(super) const FACTOR: u64 = 5;
    pub(super) const FIRST: u64 = 6;
    pub(super) const SECOND: u64 = 7;
    pub(super) const HAND: u64 = 8;
}

const DIRECTION: [(u64, &str); 9] = [
    (0, "IDLE"),
    (at::SQUARE_FAR, "SQUARE_FAR"),
    (at::SQUARE_NEAR, "SQUARE_NEAR"),
    (at::LENGTH, "LENGTH"),
    (at::SHARE, "SHARE"),
    (at::FACTOR, "STEP"),
    (at::FIRST, "SLOPE"),
    (at::SECOND, "RATIO"),
    (at::HAND, "HAND_OVER"),
];
const STEP_FACTOR: [(u64, &str); 8] = [
    (0, "IDLE"),
    (at::SQUARE_FAR, "SQUARE_FAR"),
    (at::SQUARE_NEAR, "SQUARE_NEAR"),
    (at::LENGTH, "LENGTH"),
    (at::FACTOR, "LAMBDA"),
    (at::FIRST, "STEP_FAR"),
    (at::SECOND, "STEP_NEAR"),
    (at::HAND, "HAND_OVER"),
];

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let Some(sampling) = hardware.sampling else { return };
    let by_direction = sampling.system == System::Direction;
    let (q, n, bits) = (sampling.fraction, sampling.whole, sampling.magnitude());
    let block = Block::new(m);
    let fine = FineStage::new(m.scope("fine"), hardware.bits("jvx"));

    let coarse = m.scope("coarse");
    let f = block.held(coarse, "f", sampling.word_bits());
    let [long, short] = ["long", "short"].map(|name| block.held(coarse, name, n));
    let x_is_longest = block.held(coarse, "x_is_longest", 1);
    let states = if by_direction { &DIRECTION[..] } else { &STEP_FACTOR };
    let dividend = [dividend_bits(&sampling), bits.max(n)];
    let unit = ArithmeticUnit::new(coarse, states, [bits + 1, n], dividend, bits);

    // The length of the line, once a block.
    let square = coarse.reg("square", 2 * n);
    let product = unit.multiplier.product();
    let of_square = product.slice(0, 2 * n);
    square
        .when(unit.multiplied(at::SQUARE_FAR), of_square)
        .when(unit.multiplied(at::SQUARE_NEAR), square.q.wrapping_add(of_square))
        .else_hold();
    let measured = unit.rooted(at::LENGTH);
    let radicand = square.q.concat(coarse.lit(2 * q, 0));

    // The way of the long axis, or the step factor: both once a block.
    let factor = coarse.reg(if by_direction { "step" } else { "lambda" }, bits + 1);
    let quotient = unit.divider.quotient();
    let beyond = quotient.slice(bits, quotient.bits() - bits).is_nonzero();
    // A way beyond the end is as good as one up to it.
    let whole = coarse.lit(1, 1).concat(coarse.lit(bits, 0));
    factor.when(unit.divided(at::FACTOR), beyond.mux(whole, quotient.slice(0, bits + 1))).else_hold();

    // A period: what is below the fraction is kept for the next.
    let [far, near] = ["far", "near"].map(|name| coarse.reg(name, bits + 1));
    let near_rest = coarse.reg("remn", n);
    let [zero, no_rest] = [coarse.lit(bits + 1, 0), coarse.lit(n, 0)];
    let (stepped_far, stepped_near);
    if by_direction {
        // Δs = (Δl·S + rest) / L, the rest kept.
        (stepped_far, stepped_near) = (unit.divided(at::SECOND), unit.divided(at::SECOND));
        far.when(block.load, zero).when(stepped_far, far.q.wrapping_add(factor.q)).else_hold();
        near.when(block.load, zero).when(stepped_near, near.q.wrapping_add(quotient.slice(0, bits + 1))).else_hold();
        near_rest.when(block.load, no_rest).when(stepped_near, unit.divider.remainder().slice(0, n)).else_hold();
        let dividend = product.extend(bits + n + 1).wrapping_add(near_rest.q.extend(bits + n + 1));
        let shared = product.slice(0, sampling.word_bits() + n).concat(coarse.lit(q, 0));
        unit.multiplier.close(&[
            (unit.begins(at::SQUARE_FAR), long, long),
            (unit.begins(at::SQUARE_NEAR), short, short),
            (unit.begins(at::SHARE), f, long),
            (unit.begins(at::FIRST), factor.q, short),
        ]);
        unit.divider
            .close(&[(unit.begins(at::FACTOR), shared, unit.root.root()), (unit.begins(at::SECOND), dividend, long)]);
    } else {
        // λ = f / length; {way, rest} := {way, rest} + λ·L.
        let far_rest = coarse.reg("remf", n);
        (stepped_far, stepped_near) = (unit.multiplied(at::FIRST), unit.multiplied(at::SECOND));
        for (way, rest, stepped) in [(far, far_rest, stepped_far), (near, near_rest, stepped_near)] {
            let sum = way.q.concat(rest.q).wrapping_add(product);
            way.when(block.load, zero).when(stepped, sum.slice(n, bits + 1)).else_hold();
            rest.when(block.load, no_rest).when(stepped, sum.slice(0, n)).else_hold();
        }
        unit.multiplier.close(&[
            (unit.begins(at::SQUARE_FAR), long, long),
            (unit.begins(at::SQUARE_NEAR), short, short),
            (unit.begins(at::FIRST), factor.q, long),
            (unit.begins(at::SECOND), factor.q, short),
        ]);
        unit.divider.close(&[(unit.begins(at::FACTOR), f.concat(coarse.lit(bits, 0)), unit.root.root())]);
    }
    unit.root.close(&[(unit.begins(at::LENGTH), radicand)]);

    let end = long.concat(coarse.lit(q, 0)).extend(bits + 1);
    let last = coarse.name("arrived", !far.q.less_than(end));
    let hand = coarse.name("hand", unit.sequence.at(at::HAND) & fine.free());
    let more = hand & !last;
    let after_length = if by_direction { at::SHARE } else { at::FACTOR };
    let shared = if by_direction { unit.multiplied(at::SHARE) } else { coarse.lit(1, 0) };
    let second = if by_direction { unit.multiplied(at::FIRST) } else { stepped_far };
    unit.sequence.close(
        block.load,
        &[
            (unit.multiplied(at::SQUARE_FAR), at::SQUARE_NEAR),
            (unit.multiplied(at::SQUARE_NEAR), at::LENGTH),
            (measured, after_length),
            (shared, at::FACTOR),
            (unit.divided(at::FACTOR), at::FIRST),
            (second, at::SECOND),
            (stepped_near, at::HAND),
            (more, at::FIRST),
            (hand & last, 0),
        ],
    );

    let signs = ["negative_x", "negative_y"].map(|name| block.held(coarse, name, 1));
    let ways = [x_is_longest.mux(far.q, near.q), x_is_longest.mux(near.q, far.q)];
    let wholes = [x_is_longest.mux(long, short), x_is_longest.mux(short, long)];
    let points = [0, 1].map(|axis| with_sign(coarse, ways[axis], bits + 2, signs[axis]));
    let ends = [0, 1].map(|axis| with_sign(coarse, wholes[axis], n + 2, signs[axis]));
    fine.close(block, hardware, [hand, last], points, q, ends);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let Some(sampling) = hardware.sampling else { return Vec::new() };
    let ([a, b], line) = words::line(line);
    let sign = |name: &str| line.iter().find(|(word, _)| *word == name).map_or(0, |(_, value)| *value);
    let preset = |axis: usize, name: &str| hardware.preset(axis, name);
    vec![vec![
        ("f", sampling.word.into()),
        ("long", a.max(b)),
        ("short", a.min(b)),
        ("x_is_longest", i128::from(a >= b)),
        ("negative_x", sign("sx")),
        ("negative_y", sign("sy")),
        ("tx", 0),
        ("ty", 0),
        ("jrx", preset(0, "jrx")),
        ("jry", preset(1, "jry")),
        ("x", sign("x")),
        ("y", sign("y")),
    ]]
}
