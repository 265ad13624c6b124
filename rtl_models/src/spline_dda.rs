//! `spline-dda`: cascaded integrators, free curves of cubic and quadratic segments.
//!
//! ```text
//!   for each axis:   r ──► + ──► q ──┬──► + ──► p ──┬──► + ──► jr ──┐      2^s steps
//!                          ▲─────────┤    ▲─────────┤    ▲──────────┤      e ──► done
//!                                    └────┘         └────┘          │
//!                                                     mod M: over M or below 0
//!                                                                   └──► d ──► position
//! ```
//!
//! A segment X(u) = (c0 + c1·u + c2·u² + c3·u³)/D is walked in N = 2^s steps of u. Its forward differences are whole
//! numbers of 1/M BLU, M = D·2^(3s): the third, r = 6·c3, is constant, and in every step {pulse, jr} := jr + p, p += q,
//! q += r, all with the old values. jr starts at half of M beyond the start, so x = floor(X + 1/2) after *every* step: each
//! axis stays within half a BLU of its place, and the path within sqrt(1/2) BLU of the curve. No rounding adds up, nor
//! from one segment to the next, because each is loaded from its own coefficients; with a fraction it does.
//!
//! | curve | D | c0 to c3 |
//! |---|---|---|
//! | Bézier, cubic | 1 | P0, 3(P1-P0), 3(P0-2P1+P2), P3-3P2+3P1-P0 |
//! | Bézier, quadratic | 1 | P0, 2(P1-P0), P0-2P1+P2, 0 |
//! | Hermite | 1 | P0, T0, 3(P1-P0)-2T0-T1, 2(P0-P1)+T0+T1 |
//! | Catmull-Rom, P1 to P2 | 2 | 2P1, P2-P0, 2P0-5P1+4P2-P3, 3P1-P0-3P2+P3 |
//! | uniform B-spline | 6 | P0+4P1+P2, 3(P2-P0), 3(P0-2P1+P2), P3-3P2+3P1-P0 |
//!
//! **Steps.** An axis makes one pulse a step at most, abs(p) <= M: without `--divisions` s is the least from 1 on with which that is so
//! on both axes in all segments. 2^s of three times the longest distance of two neighbouring Bézier points is always
//! enough; below that a greater s may fail where a smaller one fits. Where abs(p) > M, `one_pulse` - abs(p) is below 0, and
//! the run traps.
//!
//! **Fraction.** `--fraction B` keeps the start, p, q and r to B bits after the point, rounded half upwards, M = 2^B. After n steps an axis
//! is then off by at most (g + n + n(n-1)/2 + n(n-1)(n-2)/6)·2^-(B+1) BLU beyond the half, g = 1 where the start is not whole.
//! Ends at whole points are exact for certain from B = 3s-2 on; with less the end may be missed. In a chain what each
//! segment errs by adds up, and a BLU each of rounding.
//!
//! The recurrence is the project's own form of forward differencing as computer graphics has it, in whole numbers.
//! The Bézier curve (0, 0), (4, 0), (8, 4), (8, 8), from the golden file `waves/spline-dda-bezier.csv`; the wave is
//! next to it:
//!
//! ```text
#![doc = include_str!("../waves/spline-dda-bezier.csv")]
//! ```

use std::f64::consts::SQRT_2;

use stepwave_nc::{Spline, SplineSegment};
use stepwave_netlist::dsl::Scope;

use crate::differences::{Differences, MOST_DIVISIONS, bits, differences, exact_modulus, least_divisions};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{DIVISIONS, FRACTION, ON_OVERFLOW, WIDTH};
use crate::parts::{
    Block, E, FIRST_DIFFERENCE, MODULUS, ONE_PULSE, POSITION, SECOND_DIFFERENCE, THIRD_DIFFERENCE, axis_scope, cascade,
};
use crate::per_axis;
use crate::plan::Plan;
use crate::registers::{PerAxis, Reg, Rule};

const NAME: &str = "spline-dda";

/// Remainders.
const REMAINDER: PerAxis = Reg::each(
    JR_NAMES,
    Rule::Planned("3s + log2(D), or the fraction"),
    "remainder of each axis, from half a BLU beyond the start",
)
.follows(|_| true);
const JR_NAMES: [&str; 9] = per_axis!("jr");
/// Most bits of p.
const MOST_BITS: u32 = 62;

/// Cascaded integrators, free curves.
pub static MODEL: Model = Model {
    name: NAME,
    title: "Cascaded integrators, Bézier curves and splines",
    method: "digital differential analyser",
    source: "forward differences of polynomials, as in computer graphics, in the integrators of 数字积分法",
    registers: &[
        &REMAINDER,
        &FIRST_DIFFERENCE,
        &SECOND_DIFFERENCE,
        &THIRD_DIFFERENCE,
        &E.width(Rule::Planned("s+1")).about("steps left of the segment"),
        &POSITION,
    ],
    options: &[
        &WIDTH.about("N of p, or REGISTER=N,… (default: the least that holds the curve)"),
        &DIVISIONS,
        &FRACTION.about("bits of the fraction (default: exact)"),
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Splines(Method { plan, load }),
    hardware,
};

fn plan(spline: &Spline, plan: &mut Plan) -> Result<(), ModelError> {
    let given = plan.get(&DIVISIONS).and_then(|s| u32::try_from(s).ok());
    let Some(s) = given.or_else(|| least_divisions(spline)) else {
        return Err(ModelError::Widths(format!(
            "{NAME}: the curve would need more than 2^{MOST_DIVISIONS} steps a segment, for which no register is wide \
             enough: divide it into more segments, or choose a larger BLU"
        )));
    };
    plan.fix(&DIVISIONS, Some(s.into()));
    let fraction = plan.get(&FRACTION);
    if let Some(bits) = fraction.filter(|bits| !(1..=3 * MOST_DIVISIONS).contains(bits)) {
        let reason = format!("a remainder has 1 to {} bits of fraction", 3 * MOST_DIVISIONS);
        return Err(ModelError::Value { model: NAME, option: FRACTION.name, value: bits.to_string(), reason });
    }
    let modulus = fraction.map_or_else(|| exact_modulus(spline, s), |bits| 1 << bits);
    plan.constants.push((MODULUS, modulus));
    plan.remedies
        .push((ONE_PULSE, format!("an axis owes more than a pulse a step: give --divisions greater than {s}")));

    let (mut p, mut q, mut r) = (1, 1, 1);
    for axis in differences(spline, s, modulus).flatten() {
        let [of_p, of_q, of_r] = axis.ranges(s).map(bits);
        (p, q, r) = (p.max(of_p), q.max(of_q), r.max(of_r));
    }
    plan.n = plan.bits_or(p);
    plan.set_each(SECOND_DIFFERENCE, q).set_each(THIRD_DIFFERENCE, r).set(E, s + 1);
    if plan.n > MOST_BITS {
        return Err(ModelError::Widths(format!(
            "{NAME}: p of {} bits is too wide, as a sum with the remainder takes 2 more: give --width {MOST_BITS} or less",
            plan.n
        )));
    }
    let off = fraction.map_or(0.0, |bits| rounding(spline, s, bits));
    // A path that errs by what was rounded goes no farther than its steps.
    let astray = off.ceil().min((spline.segments().len() as f64) * f64::from(1_u32 << s));
    #[allow(clippy::cast_possible_truncation)]
    plan.positions([0, 1].map(|axis| reach(spline, axis, astray as i64)));
    plan.error_bound = Some((0.5 + off) * SQRT_2);
    // A segment may be a single point.
    plan.stall_clocks = (spline.segments().len() as u64).saturating_mul(1 << s).saturating_add(16);
    Ok(())
}

/// Positions of an axis between which the path lies: those of the Bézier points of the curve, outwards, and as far off
/// as rounding may lead.
fn reach(spline: &Spline, axis: usize, astray: i64) -> impl Iterator<Item = i64> {
    spline.segments().iter().flat_map(move |segment| {
        let ([c0, c1, c2, c3], d) = (segment.coefficients[axis], segment.divisor);
        let points = [3 * c0, 3 * c0 + c1, 3 * c0 + 2 * c1 + c2, 3 * (c0 + c1 + c2 + c3)];
        points
            .into_iter()
            .flat_map(move |point| [point.div_euclid(3 * d) - astray, -(-point).div_euclid(3 * d) + astray])
    })
}

/// How far an axis may be off beyond half a BLU where its registers have this many bits of fraction. A segment begins
/// where the one before it ended, so that what they err by adds up, and a BLU each of rounding to whole positions.
fn rounding(spline: &Spline, s: u32, bits: u32) -> f64 {
    let n = f64::from(1_u32 << s);
    let whole = |segment: &SplineSegment| segment.coefficients.iter().all(|c| c[0] % segment.divisor == 0);
    let start = if spline.segments().iter().all(whole) { 0.0 } else { 1.0 };
    let all = start + n + n * (n - 1.0) / 2.0 + n * (n - 1.0) * (n - 2.0) / 6.0;
    let off = all * (-f64::from(bits) - 1.0).exp2();
    off + (spline.segments().len() - 1) as f64 * (off + 1.0)
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let e = hardware.counter(m, &block, E);
    for axis in 0..hardware.axes {
        let m = axis_scope(m, axis);
        let step = block.busy & !block.load;
        let [pulse, negative] = cascade(m, &block, hardware, (axis, REMAINDER.of(axis)), step);
        hardware.axis(m, &block, axis, pulse, negative);
    }
    let last = e.count(block.busy);
    block.close(block.load, block.busy, last);
}

fn load(spline: &Spline, hardware: &Hardware) -> Vec<Words> {
    let modulus = hardware.constant(MODULUS);
    let s = hardware.get(&DIVISIONS).and_then(|s| u32::try_from(s).ok()).unwrap_or(1);
    let block = |axes: [Differences; 2]| {
        axes.into_iter().enumerate().fold(Words::new().set(E, 1_i128 << s), |words, (axis, at)| {
            // Half a BLU ahead, so that the floor of the sum is the nearest whole number.
            let ahead = at.start + modulus / 2;
            let words = at.words(words, axis);
            words.set(REMAINDER.of(axis), ahead.rem_euclid(modulus)).set(POSITION.of(axis), ahead.div_euclid(modulus))
        })
    };
    differences(spline, s, modulus).map(block).collect()
}
