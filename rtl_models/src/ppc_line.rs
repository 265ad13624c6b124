//! `ppc-line`: point-by-point comparison (逐点比较法), line.
//!
//! ```text
//!            xe ──┐                       ┌── sx, sy: directions
//!            ye ──┴─ mux ── ± ──► F ──► judge ──► X or Y ──► dx, dy ──► x, y
//!                           ▲────────────┘                    │
//!                                                             └──► e (ex, ey) ──► done
//! ```
//!
//! Magnitude form: F >= 0 steps X and F -= b; F < 0 steps Y and F += a. In the signed form F = dx·y - dy·x, whose sign
//! means the opposite in quadrants 2 and 4; there the tie F = 0 steps Y. A line of a = 0 steps Y only, one of b = 0
//! steps X only. The bare form leaves this out, as textbooks do: F = 0 steps X, and a line along y ends next to its
//! end.
//!
//! Four beats a step: judge, feed, compute, compare; or all at one edge (`--beats 1`). Range of F: [-b, a-1].
//!
//! The line (6, 4), from the golden file `waves/ppc-line-6-4.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/ppc-line-6-4.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::dsl::Scope;
use stepwave_netlist::formula::{Formula, name, number};

use crate::claims::{Claims, Region, steps_left};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{BEATS, END_POINT, EndPoint, FORM, Form, ON_OVERFLOW, WIDTH};
use crate::parts::{BeatRing, Block, DeviationAccumulator, E, END, F, LONGEST, POSITION, SIGN, axis_scope};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::sizes;

const XE: Reg = Reg::new("xe", N, "|dx| of the line (signed form: dx in n+1 bits)");
const YE: Reg = Reg::new("ye", N, "|dy| of the line (signed form: dy in n+1 bits)");

/// Point-by-point comparison, line.
pub static MODEL: Model = Model {
    name: "ppc-line",
    title: "Point-by-point comparison, line",
    method: "point-by-point comparison",
    source: "逐点比较法, the linear interpolator of early NC systems, as in Chinese NC textbooks",
    registers: &[&XE, &YE, &F.width(N.plus(1)), &E, &END, &POSITION],
    options: &[
        &WIDTH.about("N or REGISTER=N,… (default: the least that holds the line)"),
        &FORM,
        &END_POINT.only(
            Some(EndPoint::Total),
            &[(EndPoint::Total, ""), (EndPoint::PerAxis, ""), (EndPoint::Longest, "")],
            "a point-by-point step has no iterations next to its pulses",
        ),
        &BEATS,
        &ON_OVERFLOW,
    ],
    claims: Some(Claims {
        refined: |hardware| (hardware.get(&END_POINT) == EndPoint::Longest).then_some(Region::LinesByLonger),
        rank,
        ..Claims::of(Region::Lines)
    }),
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

/// Steps left; where the counter counts one axis alone, a step of the other takes F, of |F| < 2^k, to where it steps.
fn rank(hardware: &Hardware) -> Option<Formula> {
    if hardware.get(&END_POINT) != EndPoint::Longest {
        return steps_left(hardware);
    }
    let sign = |flag: Reg| number(1) - 2 * flag.value();
    let signs = || sign(SIGN.of(0)) * sign(SIGN.of(1));
    let judged = if hardware.get(&FORM) == Form::Signed { signs() * F.value() } else { F.value() };
    Some(E.value() * name("2^k") + sign(LONGEST.of(0)) * judged)
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(sizes::longest(line));
    if plan.get(&FORM) == Form::Signed {
        let bits = plan.n + 1;
        plan.set(XE, bits).set(YE, bits);
    }
    plan.positions(sizes::end_positions(line));
    plan.error_bound = Some(1.0);
    plan.pace = Pace::Total;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let signed = hardware.get(&FORM) == Form::Signed;
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let [xe, ye] = [XE, YE].map(|end| hardware.held(m, &block, if signed { end.signed() } else { end }));
    // Directions: 1 is negative. The signed form has them in its end-point registers.
    let sign = |axis| hardware.held(m, &block, SIGN.of(axis));
    let (sx, sy) = if signed { (xe.msb(), ye.msb()) } else { (sign(0), sign(1)) };
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let counter = |register| hardware.counter(m, &block, register);

    match hardware.get(&FORM) {
        Form::Magnitude => between_steps(m, "f", [XE.value(), YE.value()], &[]),
        Form::Signed => signs_between_steps(m),
        Form::Bare => {}
    }

    // Judge.
    let outside = if signed { f.not_negative() ^ sx ^ sy } else { f.not_negative() };
    let per_axis = (hardware.get(&END_POINT) == EndPoint::PerAxis).then(|| (counter(END.of(0)), counter(END.of(1))));
    let (x_open, y_open) = match per_axis {
        // An exhausted axis hands its step to the other.
        Some((ex, ey)) => (ex.running(), ey.running()),
        None if hardware.get(&FORM) == Form::Bare => (m.lit(1, 1), m.lit(1, 1)),
        None => (xe.is_nonzero(), ye.is_nonzero()),
    };
    let take_x = beat.decided("take_x", outside & x_open | !y_open);

    // Feed.
    hardware.axis(axis_scope(m, 0), &block, 0, beat.feed & take_x, sx);
    hardware.axis(axis_scope(m, 1), &block, 1, beat.feed & !take_x, sy);

    // Compute: an X step takes ye off F, a Y step puts xe on; signed, against the direction of the step.
    let subtract = if signed { take_x.mux(!sx, sy) } else { take_x };
    let wide = xe.bits().max(ye.bits());
    f.close(&block, beat.compute, subtract, take_x.mux(ye.extend(wide), xe.extend(wide)));

    // Compare.
    let last = match per_axis {
        Some((ex, ey)) => ex.count(beat.compare & take_x) & ey.count(beat.compare & !take_x),
        None if hardware.get(&END_POINT) == EndPoint::Longest => {
            let x_is_longest = hardware.held(m, &block, LONGEST.of(0));
            counter(E).count(beat.compare & !(take_x ^ x_is_longest))
        }
        None => counter(E).count(beat.compare),
    };
    beat.close(block, last);
}

/// F stays between what a step of the first axis, which F >= 0 takes, at 0 and one of the second at -1 leave. `ways`
/// are those of both axes; or one of `unless` is 0 or more.
fn between_steps(m: Scope<'_>, what: &str, [first, second]: [Formula; 2], unless: &[Formula]) {
    let f = || F.value();
    let state = |bound: &str, any: &[Formula]| {
        m.between_steps(&format!("{what}_{bound}"), any.iter().chain(unless).cloned());
    };
    state("from_below", &[f() + second]);
    state("from_above", &[first.clone() - 1 - f(), -f()]);
    state("of_a_line_along_one_axis", &[f(), first - 1]);
}

/// The same in each quadrant: F >= 0 takes Y in the second and the fourth.
fn signs_between_steps(m: Scope<'_>) {
    for (quadrant, [x, y]) in [("q1", [1, 1]), ("q2", [-1, 1]), ("q3", [-1, -1]), ("q4", [1, -1])] {
        let [a, b] = [x * XE.value(), y * YE.value()];
        // The travel of a motion that is not negative may be 0.
        let elsewhere =
            [(x, &a), (y, &b)].map(|(sign, travel)| if sign > 0 { -travel.clone() - 1 } else { -travel.clone() });
        between_steps(m, &format!("f_in_{quadrant}"), if x == y { [a, b] } else { [b, a] }, &elsewhere);
    }
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let [dx, dy] = [0, 1].map(|axis| i128::from(line.delta()[axis]));
    let (a, b) = (dx.abs(), dy.abs());
    let words = match hardware.get(&FORM) {
        Form::Magnitude | Form::Bare => Words::new().set(XE, a).set(YE, b).set_each(SIGN.pair(), [dx < 0, dy < 0]),
        Form::Signed => Words::new().set(XE, dx).set(YE, dy),
    };
    let words = words.set(F, 0);
    let words = match hardware.get(&END_POINT) {
        EndPoint::PerAxis => words.set_each(END.pair(), [a, b]),
        EndPoint::Longest => {
            // On 45° lines the counter watches the axis that loses ties and therefore steps last: Y, but X where the
            // signed form gives the tie to Y.
            let x_is_longest = a > b || a == b && hardware.get(&FORM) == Form::Signed && (dx < 0) != (dy < 0);
            words.set(E, a.max(b)).set(LONGEST.of(0), x_is_longest)
        }
        EndPoint::Total | EndPoint::Iterations => words.set(E, a + b),
    };
    vec![words.set_each(POSITION.pair(), [line.from()[0], line.from()[1]])]
}
