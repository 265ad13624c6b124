//! `ppc-line`: point-by-point comparison (逐点比较法), line.
//!
//! ```text
//!            xe ──┐                       ┌── sx, sy: directions
//!            ye ──┴─ mux ── ± ──► F ──► judge ──► X or Y ──► dx, dy ──► x, y
//!                           ▲────────────┘                    │
//!                                                             └──► e (ex, ey) ──► done
//! ```
//!
//! | register | width | load value |
//! |---|---|---|
//! | xe, ye | n (signed form n+1) | a = abs(dx), b = abs(dy) (signed form dx, dy) |
//! | f | n+1, two's complement | 0 |
//! | e | n+1 | a + b (`total`), or the longer of both (`longest`) |
//! | ex, ey | n | a, b (`per-axis`) |
//!
//! Magnitude form: F >= 0 steps X and F -= b; F < 0 steps Y and F += a. In the signed form F = dx·y - dy·x, whose sign
//! means the opposite in quadrants 2 and 4; there the tie F = 0 steps Y. A line of a = 0 steps Y only, one of b = 0
//! steps X only. The bare form leaves this out, as textbooks do: F = 0 steps X, and a line along y ends beside its end.
//!
//! Four beats a step: judge, feed, compute, compare; or all at one edge (`--beats 1`). Range of F: [-b, a-1].
//!
//! The line (6, 4), from the golden file `waves/ppc-line-6-4.csv`; the wave stands beside it:
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
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{BEATS, END_POINT, EndPoint, FORM, Form, ON_OVERFLOW, WIDTH};
use crate::parts::{BeatRing, Block, DeviationAccumulator, DownCounter, axis_counter};
use crate::plan::Plan;
use crate::sizes;

/// Point-by-point comparison, line.
pub static MODEL: Model = Model {
    name: "ppc-line",
    title: "Point-by-point comparison, line",
    method: "point-by-point comparison",
    source: "逐点比较法, the linear interpolator of early NC systems, as in Chinese NC textbooks",
    registers: &[
        RegisterDoc { name: "xe", width: "n", about: "|dx| of the line (signed form: dx in n+1 bits)" },
        RegisterDoc { name: "ye", width: "n", about: "|dy| of the line (signed form: dy in n+1 bits)" },
        RegisterDoc { name: "f", width: "n+1", about: "deviation F, two's complement, from 0" },
        RegisterDoc { name: "e", width: "n+1", about: "end-point down-counter (total, longest)" },
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counter of each axis (per-axis)" },
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" },
    ],
    options: &[
        &WIDTH.about("N or REGISTER=N,… (default: the least that holds the line)"),
        &FORM,
        &END_POINT.only(
            Some(EndPoint::Total),
            &[(EndPoint::Total, ""), (EndPoint::PerAxis, ""), (EndPoint::Longest, "")],
            "a point-by-point step has no iterations beside its pulses",
        ),
        &BEATS,
        &ON_OVERFLOW,
    ],
    claims: Some(Claims {
        told_apart: |hardware| (hardware.get(&END_POINT) == EndPoint::Longest).then_some(Region::LinesByLonger),
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
    let sign = |flag: &str| number(1) - 2 * name(flag);
    let judged = if hardware.get(&FORM) == Form::Signed { sign("sx") * sign("sy") * name("f") } else { name("f") };
    Some(name("e") * name("2^k") + sign("x_is_longest") * judged)
}

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    let n = plan.magnitude_bits(sizes::longest(line));
    let end_bits = if plan.get(&FORM) == Form::Signed { n + 1 } else { n };
    plan.register("xe", end_bits).register("ye", end_bits).register("f", n + 1);
    match plan.get(&END_POINT) {
        EndPoint::PerAxis => plan.end_counters(2, n),
        _ => plan.register("e", n + 1),
    };
    plan.positions(sizes::end_positions(line));
    plan.error_bound = Some(1.0);
    plan.pace = Pace::Total;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let signed = hardware.get(&FORM) == Form::Signed;
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let end = |name: &str| match hardware.get(&FORM) {
        Form::Magnitude | Form::Bare => block.held(m, name, hardware.bits(name)),
        Form::Signed => block.held_signed(m, name, hardware.bits(name)),
    };
    let (xe, ye) = (end("xe"), end("ye"));
    // Directions: 1 is negative. The signed form has them in its end-point registers.
    let (sx, sy) = if signed { (xe.msb(), ye.msb()) } else { (block.held(m, "sx", 1), block.held(m, "sy", 1)) };
    let f = DeviationAccumulator::new(m, hardware.bits("f"));
    let counter = |name: &str| DownCounter::new(m, &block, name, hardware.bits(name));

    match hardware.get(&FORM) {
        Form::Magnitude => between_steps(m, "f", [name("xe"), name("ye")], &[]),
        Form::Signed => signs_between_steps(m),
        Form::Bare => {}
    }

    // Judge.
    let outside = if signed { f.not_negative() ^ sx ^ sy } else { f.not_negative() };
    let per_axis = (hardware.get(&END_POINT) == EndPoint::PerAxis).then(|| (counter("ex"), counter("ey")));
    let (x_open, y_open) = match per_axis {
        // An exhausted axis hands its step to the other.
        Some((ex, ey)) => (ex.running(), ey.running()),
        None if hardware.get(&FORM) == Form::Bare => (m.lit(1, 1), m.lit(1, 1)),
        None => (xe.is_nonzero(), ye.is_nonzero()),
    };
    let take_x = beat.decided("take_x", outside & x_open | !y_open);

    // Feed.
    axis_counter(m.scope("axis_x"), &block, "x", hardware.bits("x"), beat.feed & take_x, sx);
    axis_counter(m.scope("axis_y"), &block, "y", hardware.bits("y"), beat.feed & !take_x, sy);

    // Compute: an X step takes ye off F, a Y step puts xe on; signed, against the direction of the step.
    let subtract = if signed { take_x.mux(!sx, sy) } else { take_x };
    let wide = xe.bits().max(ye.bits());
    f.close(&block, beat.compute, subtract, take_x.mux(ye.extend(wide), xe.extend(wide)));

    // Compare.
    let last = match per_axis {
        Some((ex, ey)) => ex.count(beat.compare & take_x) & ey.count(beat.compare & !take_x),
        None if hardware.get(&END_POINT) == EndPoint::Longest => {
            let x_is_longest = block.held(m, "x_is_longest", 1);
            counter("e").count(beat.compare & !(take_x ^ x_is_longest))
        }
        None => counter("e").count(beat.compare),
    };
    beat.close(block, last);
}

/// F stays between what a step of the first axis, which F >= 0 takes, at 0 and one of the second at -1 leave. `ways` are
/// those of both axes; or one of `unless` is 0 or more.
fn between_steps(m: Scope<'_>, what: &str, [first, second]: [Formula; 2], unless: &[Formula]) {
    let f = || name("f");
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
        let [a, b] = [x * name("xe"), y * name("ye")];
        // The way of a motion that is not negative may be 0.
        let elsewhere = [(x, &a), (y, &b)].map(|(sign, way)| if sign > 0 { -way.clone() - 1 } else { -way.clone() });
        between_steps(m, &format!("f_in_{quadrant}"), if x == y { [a, b] } else { [b, a] }, &elsewhere);
    }
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    let [dx, dy] = [0, 1].map(|axis| i128::from(line.delta()[axis]));
    let (a, b) = (dx.abs(), dy.abs());
    let mut words = match hardware.get(&FORM) {
        Form::Magnitude | Form::Bare => {
            vec![("xe", a), ("ye", b), ("sx", i128::from(dx < 0)), ("sy", i128::from(dy < 0))]
        }
        Form::Signed => vec![("xe", dx), ("ye", dy)],
    };
    words.push(("f", 0));
    match hardware.get(&END_POINT) {
        EndPoint::PerAxis => words.extend([("ex", a), ("ey", b)]),
        EndPoint::Longest => {
            // On 45° lines the counter watches the axis that loses ties and therefore steps last: Y, but X where the
            // signed form gives the tie to Y.
            let x_is_longest = a > b || a == b && hardware.get(&FORM) == Form::Signed && (dx < 0) != (dy < 0);
            words.extend([("e", a.max(b)), ("x_is_longest", i128::from(x_is_longest))]);
        }
        EndPoint::Total | EndPoint::Iterations => words.push(("e", a + b)),
    }
    words.extend([("x", i128::from(line.from()[0])), ("y", i128::from(line.from()[1]))]);
    vec![words]
}
