//! `ppc-line`: point-by-point comparison (逐点比较法), line of 2 to 6 axes.
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
//! **In space.** Each axis has a deviation of its own from the longest one, of displacement L: the first axis whose f < 0
//! steps, and its f += L; where there is none the longest steps, and every f -= S. Range of f: [-S, L-1]. The steps of
//! the longest axis and one other are those of the line (L, S) in the plane, so each axis is less than 1 BLU from its place, and the
//! path, of k axes, less than sqrt(k-1) BLU from the line. Textbooks that compare with X whatever its length go far off
//! where X is short. This is the project's own definition, magnitudes with a counter of all pulses.
//!
//! The line (6, 4), from the golden file `waves/ppc-line-6-4.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/ppc-line-6-4.csv")]
//! ```
//!
//! The line (5, 3, 2) in space, from `waves/ppc-line-space.csv`:
//!
//! ```text
#![doc = include_str!("../waves/ppc-line-space.csv")]
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
use crate::parts::{
    BeatRing, Block, DEVIATION, DeviationAccumulator, E, END, F, IN_PLANE, IN_SPACE, LONG, LONGEST, POSITION, SIGN,
    SpaceLine, TRAVEL, axis_scope, negated, space_words,
};
use crate::plan::Plan;
use crate::registers::{N, PerAxis, Reg};
use crate::sizes;

const ENDS: PerAxis = TRAVEL.about("|dx|, … of the line (signed form: dx, … in n+1 bits)");
const XE: Reg = ENDS.of(0);
const YE: Reg = ENDS.of(1);

/// Point-by-point comparison, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: "ppc-line",
    title: "Point-by-point comparison, line of 2 to 6 axes",
    method: "point-by-point comparison",
    source: "逐点比较法, the linear interpolator of early NC systems, as in Chinese NC textbooks",
    registers: &[
        &ENDS,
        &LONG.when(&IN_SPACE),
        &F.width(N.plus(1)).when(&IN_PLANE),
        &DEVIATION,
        &E.about("end-point down-counter (of k axes n + log2(k), rounded up, bits)"),
        &END,
        &POSITION,
    ],
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
    interpolates: Interpolates::Lines(6, Method { plan, load }),
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
    if plan.axes() > 2 {
        magnitudes_and_total(plan)?;
        plan.set(E, plan.n + plan.axes().next_power_of_two().trailing_zeros());
    }
    plan.error_bound = Some(sizes::across(plan.axes()));
    plan.pace = Pace::Total;
    Ok(())
}

/// Refuses what a line in space has not.
fn magnitudes_and_total(plan: &Plan) -> Result<(), ModelError> {
    let refused = |option: &'static str, value: String, usual: &str| {
        let reason = format!("a line of {} axes has {usual} only: leave --{option} out", plan.axes());
        Err(ModelError::Value { model: plan.model(), option, value, reason })
    };
    match (plan.get(&FORM), plan.get(&END_POINT)) {
        (Form::Magnitude, EndPoint::Total) => Ok(()),
        (Form::Magnitude, end) => {
            refused(END_POINT.name, END_POINT.value(end).text().to_owned(), "a counter of all pulses")
        }
        (form, _) => refused(FORM.name, FORM.value(form).text().to_owned(), "magnitudes"),
    }
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    if hardware.axes > 2 {
        return in_space(m, hardware);
    }
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

/// The wiring of 3 axes and more.
fn in_space(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let line = SpaceLine::new(m, &block, hardware);
    let e = hardware.counter(m, &block, E);

    // Judge: the first axis of a negative deviation, or the longest one.
    let mut none = m.lit(1, 1);
    let mut judged = Vec::new();
    for axis in line.axes() {
        judged.push(none & !axis.not_negative);
        none = none & axis.not_negative;
    }
    for (judged, axis) in judged.iter_mut().zip(line.axes()) {
        *judged = *judged | (none & axis.is_longest);
    }
    let taken = line.decided(&judged);
    let of_longest = taken.iter().zip(line.axes()).map(|(taken, axis)| *taken & axis.is_longest);
    let longest = m.name("take_longest", of_longest.reduce(|a, b| a | b).unwrap_or(none));

    // Feed, compute: a step of the axis adds L, one of the longest takes S off.
    line.close(&block, hardware, &taken, |axis, taken| {
        let wide = axis.travels[0].bits().max(axis.travels[1].bits()) + 1;
        let [long, travel] = axis.travels.map(|travel| travel.extend(wide));
        let zero = m.lit(wide, 0);
        longest.mux(negated(m, travel), taken.mux(long, zero)).as_signed()
    });

    // Compare.
    let last = e.count(line.beat.compare);
    line.beat.close(block, last);
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
    if hardware.axes > 2 {
        let pulses: i128 = line.delta().iter().map(|delta| i128::from(*delta).abs()).sum();
        return vec![space_words(line, sizes::first_longest(line), |_, _| 0).set(E, pulses)];
    }
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
