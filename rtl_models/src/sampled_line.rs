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
//! The line (12, -5) with 4 BLU a period, from the golden file `waves/sampled-line-12-5.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/sampled-line-12-5.csv")]
//! ```

use std::f64::consts::SQRT_2;

use stepwave_nc::Line;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use crate::docs::{SAMPLED_SYSTEM, SAMPLED_WIDTH};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{FRACTION, ON_OVERFLOW, PRESET, STEP, System};
use crate::parts::Task::{Start, Wait};
use crate::parts::{
    BURST, Block, DISPLACEMENT, FineStage, JV, LONGEST, Microprogram, POINT, POSITION, Row, SIGN, STATE, divide,
    multiply, row, square_root, squares, states, with_sign,
};
use crate::plan::Plan;
use crate::registers::{Reg, Rule};
use crate::sampling::{BY_STEP_FACTOR, Sampling};
use crate::{sizes, words};

const FAR_NEAR: Reg<2> =
    Reg::each(["far", "near"], Rule::Planned("n+1+q"), "coarse way of the long and the short axis").inner();
const REM_NEAR: Reg = Reg::new("remn", Rule::Planned("n"), "remainder of near below the fraction").inner();
const REM_FAR: Reg =
    Reg::new("remf", Rule::Planned("n"), "remainder of far below the fraction").inner().when(&BY_STEP_FACTOR);
const LONG_SHORT: Reg<2> = Reg::each(["long", "short"], Rule::Planned("n"), "|d| of the long and the short axis");
const NEGATIVE: Reg<2> = Reg::each(["negative_x", "negative_y"], Rule::Bits(1), "direction of each axis");

/// Data sampling with a fine DDA, line of 2 axes.
pub static MODEL: Model = Model {
    name: "sampled-line",
    title: "Data sampling with a fine DDA, line of 2 axes",
    method: "data sampling",
    source: "数据采样法, the two-stage interpolation of CNC systems, as in Chinese NC textbooks",
    registers: &[&STATE, &FAR_NEAR, &REM_FAR, &REM_NEAR, &POINT, &BURST, &POSITION],
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
    // From one hand-over to the next, with its own: a component takes a bit a clock, and its state two more.
    let product = sampling.whole + 2;
    let coarse = match sampling.system {
        System::Direction => product + dividend_bits(&sampling) + 2 + 1,
        System::StepFactor => 2 * product + 1,
    };
    FineStage::plan(sampling, plan, 0.0, coarse, sizes::end_positions(line))?;
    // Half a pulse of rounding on each axis, twice where the fine stage is between two pulses.
    plan.error_bound = Some(1.5 * SQRT_2);
    Ok(())
}

fn dividend_bits(sampling: &Sampling) -> u32 {
    sampling.magnitude() + sampling.word_bits().max(sampling.whole + 1)
}

// States of the coarse stage: common ones, those of `7m`, those of `7360`.
states! { mod at {
    IDLE = 0, SQUARE_FAR = 1, SQUARE_NEAR = 2, LENGTH = 3, HAND_OVER = 8,
    SHARE = 4, STEP = 5, SLOPE = 6, RATIO = 7,
    LAMBDA = 5, STEP_FAR = 6, STEP_NEAR = 7
} }

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let Some(sampling) = hardware.sampling else { return };
    let (q, n, bits) = (sampling.fraction, sampling.whole, sampling.magnitude());
    let block = Block::new(m);
    let fine = FineStage::new(m.scope("fine"), hardware.bits(JV.of(0)));
    let m = m.scope("coarse");
    let f = block.held(m, DISPLACEMENT.name(), sampling.word_bits());
    let [long, short] = [0, 1].map(|axis| block.held(m, LONG_SHORT.of(axis).name(), n));
    let x_is_longest = hardware.held(m, &block, LONGEST.of(0));
    let program = Microprogram::new(m, [bits + 1, n], [dividend_bits(&sampling), bits.max(n)], bits);
    let square = m.reg("square", 2 * n);
    let (after_length, period) = match sampling.system {
        System::Direction => (at::SHARE, at::SLOPE),
        System::StepFactor => (at::LAMBDA, at::STEP_FAR),
    };
    let ([far, near], cleared, own) = own_rows(m, &sampling, program, f, [long, short]);

    let last = m.name("arrived", !far.less_than(long.concat(m.lit(q, 0)).extend(bits + 1)));
    let hand = m.name("hand", program.at(at::HAND_OVER) & fine.free());
    let squares = squares(&program, square, [long, short], [at::SQUARE_FAR, at::SQUARE_NEAR, at::LENGTH]);
    let length = row(at::LENGTH, square_root(square.q.concat(m.lit(2 * q, 0))), [], after_length);
    let idle = row(at::IDLE, Start(block.load), [], at::SQUARE_FAR).clearing(m, &cleared);
    let hand_over = row(at::HAND_OVER, Wait(fine.free()), [], period).unless(last, at::IDLE);
    program.close(&[&[idle][..], &squares, &[length, hand_over], &own].concat());

    let signs = [0, 1].map(|axis| hardware.held(m, &block, NEGATIVE.of(axis)));
    let travels = [x_is_longest.mux(far, near), x_is_longest.mux(near, far)];
    let wholes = [x_is_longest.mux(long, short), x_is_longest.mux(short, long)];
    let points = [0, 1].map(|axis| with_sign(m, travels[axis], bits + 2, signs[axis]));
    let ends = [0, 1].map(|axis| with_sign(m, wholes[axis], n + 2, signs[axis]));
    fine.close(block, hardware, [hand, last], points, q, ends);
}

/// The coarse travel of the long and the short axis, the registers that a block begins with as 0, and the rows that a system
/// has for itself.
fn own_rows<'m>(
    m: Scope<'m>,
    sampling: &Sampling,
    program: Microprogram<'m>,
    f: Signal<'m>,
    [long, short]: [Signal<'m>; 2],
) -> ([Signal<'m>; 2], Vec<Register<'m>>, Vec<Row<'m>>) {
    let (n, bits, by_direction) = (sampling.whole, sampling.magnitude(), sampling.system == System::Direction);
    // The travel of the long axis, or the step factor: both once a block. A travel beyond the end is as good as one up to it.
    let factor = m.reg(if by_direction { "step" } else { "lambda" }, bits + 1);
    let [far, near] = [0, 1].map(|axis| m.reg(FAR_NEAR.of(axis).name(), bits + 1));
    // What is below the fraction is kept for the next period.
    let near_rest = m.reg(REM_NEAR.name(), n);
    let (product, quotient, length) = (program.multiplier.product(), program.divider.quotient(), program.root.root());
    let beyond = quotient.slice(bits, quotient.bits() - bits).is_nonzero();
    let limited = beyond.mux(m.lit(1, 1).concat(m.lit(bits, 0)), quotient.slice(0, bits + 1));
    let mut cleared = vec![far, near, near_rest];
    let rows = if by_direction {
        // Δs = (Δl·S + rest) / L.
        let share = product.slice(0, f.bits() + n).concat(m.lit(sampling.fraction, 0));
        let ratio = product.extend(bits + n + 1).wrapping_add(near_rest.q.extend(bits + n + 1));
        let next_near = near.q.wrapping_add(quotient.slice(0, bits + 1));
        let rest = program.divider.remainder().slice(0, n);
        let point = [(far, far.q.wrapping_add(factor.q)), (near, next_near), (near_rest, rest)];
        vec![
            row(at::SHARE, multiply(f, long), [], at::STEP),
            row(at::STEP, divide(share, length), [(factor, limited)], at::SLOPE),
            row(at::SLOPE, multiply(factor.q, short), [], at::RATIO),
            row(at::RATIO, divide(ratio, long), point, at::HAND_OVER),
        ]
    } else {
        // λ = f / length; {travel, rest} := {travel, rest} + λ·L.
        let far_rest = m.reg(REM_FAR.name(), n);
        cleared.push(far_rest);
        let [far, near] = [(far, far_rest), (near, near_rest)].map(|(travel, rest)| {
            let sum = travel.q.concat(rest.q).wrapping_add(product);
            [(travel, sum.slice(n, bits + 1)), (rest, sum.slice(0, n))]
        });
        vec![
            row(at::LAMBDA, divide(f.concat(m.lit(bits, 0)), length), [(factor, limited)], at::STEP_FAR),
            row(at::STEP_FAR, multiply(factor.q, long), far, at::STEP_NEAR),
            row(at::STEP_NEAR, multiply(factor.q, short), near, at::HAND_OVER),
        ]
    };
    ([far.q, near.q], cleared, rows)
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let Some(sampling) = hardware.sampling else { return Vec::new() };
    let ([a, b], own) = words::line(line);
    let pair = |registers: Reg<2>| [0, 1].map(|axis| own.get(registers.of(axis)).unwrap_or(0));
    let words = Words::new().set(DISPLACEMENT, sampling.word).set_each(LONG_SHORT, [a.max(b), a.min(b)]);
    let words = words.set(LONGEST.of(0), a >= b).set_each(NEGATIVE, pair(SIGN.pair()));
    FineStage::words(words, hardware, [0; 2], pair(POSITION.pair()))
}
