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
#![doc = include_str!("../../waves/ppc-line-6-4.csv")]
//! ```

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::{Module, Scope};
use stepwave_kernel::formula::{Formula, name, number};
use stepwave_nc::{Curve, Line};

use crate::choices::{Choice, Choices, EndPoint, Form};
use crate::claims::{Claims, Region, steps_left};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::machine::Words;
use crate::model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
use crate::parts::{BeatRing, Block, DeviationAccumulator, DownCounter, axis_counter};
use crate::plan;
use crate::registers::Registers;

const NAME: &str = "ppc-line";

pub(crate) const MODEL: Model = Model {
    name: NAME,
    title: "Point-by-point comparison, line",
    method: "point-by-point comparison",
    curve: CurveKind::Line { max_axes: 2 },
    registers: &[
        RegisterDoc { name: "xe", width: "n", about: "|dx| of the line (signed form: dx in n+1 bits)" },
        RegisterDoc { name: "ye", width: "n", about: "|dy| of the line (signed form: dy in n+1 bits)" },
        RegisterDoc { name: "f", width: "n+1", about: "deviation F, two's complement, from 0" },
        RegisterDoc { name: "e", width: "n+1", about: "end-point down-counter (total, longest)" },
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counter of each axis (per-axis)" },
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" },
    ],
    choices: &[
        ChoiceDoc { choice: Choice::Width, values: "N or REGISTER=N,… (default: the least that holds the line)" },
        ChoiceDoc { choice: Choice::Form, values: "magnitude (default) | signed | bare" },
        ChoiceDoc { choice: Choice::EndPoint, values: "total (default) | per-axis | longest" },
        ChoiceDoc { choice: Choice::Beats, values: "4 (default) | 1" },
        ChoiceDoc { choice: Choice::OnOverflow, values: "trap (default) | saturate | wrap" },
    ],
    source: "逐点比较法, the linear interpolator of early NC systems, as in Chinese NC textbooks",
    claims: Some(Claims {
        told_apart: |hardware| (hardware.end_point == EndPoint::Longest).then_some(Region::LinesByLonger),
        rank,
        ..Claims::of(Region::Lines)
    }),
    plan,
    netlist,
    words,
};

/// Steps left; where the counter counts one axis alone, a step of the other takes F, of |F| < 2^k, to where it steps.
fn rank(hardware: &Hardware) -> Option<Formula> {
    if hardware.end_point != EndPoint::Longest {
        return steps_left(hardware);
    }
    let sign = |flag: &str| number(1) - 2 * name(flag);
    let judged = if hardware.form == Form::Signed { sign("sx") * sign("sy") * name("f") } else { name("f") };
    Some(name("e") * name("2^k") + sign("x_is_longest") * judged)
}

fn plan(curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
    let delta = plan::line(curve).map(Line::delta).unwrap_or_default();
    let largest = delta.iter().map(|d| d.unsigned_abs()).max().unwrap_or(0);
    let n = plan::magnitude_bits(choices, largest);
    let end_point = plan::end_point(
        NAME,
        choices,
        EndPoint::Total,
        &[EndPoint::Total, EndPoint::PerAxis, EndPoint::Longest],
        "a point-by-point step has no iterations beside its pulses",
    )?;
    let form = choices.form.unwrap_or_default();
    let end_bits = if form == Form::Signed { n + 1 } else { n };
    let mut registers = Registers::new(NAME, choices);
    registers.register("xe", end_bits).register("ye", end_bits).register("f", n + 1);
    match end_point {
        EndPoint::PerAxis => registers.end_counters(2, n),
        _ => registers.register("e", n + 1),
    };
    registers.positions(plan::end_positions(curve));
    Ok(Hardware { error_bound: Some(1.0), pace: Pace::Total, ..registers.hardware(2, end_point)? })
}

fn netlist(hardware: &Hardware) -> Result<Netlist, ModelError> {
    let module = Module::with_overflow("ppc_line", hardware.on_overflow);
    let m = module.top();
    let signed = hardware.form == Form::Signed;
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.beats, block.busy);
    let end = |name: &str| match hardware.form {
        Form::Magnitude | Form::Bare => block.held(m, name, hardware.bits(name)),
        Form::Signed => block.held_signed(m, name, hardware.bits(name)),
    };
    let (xe, ye) = (end("xe"), end("ye"));
    // Directions: 1 is negative. The signed form has them in its end-point registers.
    let (sx, sy) = if signed { (xe.msb(), ye.msb()) } else { (block.held(m, "sx", 1), block.held(m, "sy", 1)) };
    let f = DeviationAccumulator::new(m, hardware.bits("f"));
    let counter = |name: &str| DownCounter::new(m, &block, name, hardware.bits(name));

    match hardware.form {
        Form::Magnitude => between_steps(m, "f", [name("xe"), name("ye")], &[]),
        Form::Signed => signs_between_steps(m),
        Form::Bare => {}
    }

    // Judge.
    let outside = if signed { f.not_negative() ^ sx ^ sy } else { f.not_negative() };
    let per_axis = (hardware.end_point == EndPoint::PerAxis).then(|| (counter("ex"), counter("ey")));
    let (x_open, y_open) = match per_axis {
        // An exhausted axis hands its step to the other.
        Some((ex, ey)) => (ex.running(), ey.running()),
        None if hardware.form == Form::Bare => (m.lit(1, 1), m.lit(1, 1)),
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
        None if hardware.end_point == EndPoint::Longest => {
            let x_is_longest = block.held(m, "x_is_longest", 1);
            counter("e").count(beat.compare & !(take_x ^ x_is_longest))
        }
        None => counter("e").count(beat.compare),
    };
    beat.close(&block, last);
    block.close(block.load, beat.compare, last);
    Ok(module.finish()?)
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

fn words(hardware: &Hardware, curve: &Curve) -> Vec<Words> {
    let Some(line) = plan::line(curve) else { return Vec::new() };
    let [dx, dy] = [0, 1].map(|axis| i128::from(line.delta()[axis]));
    let (a, b) = (dx.abs(), dy.abs());
    let mut words = match hardware.form {
        Form::Magnitude | Form::Bare => {
            vec![("xe", a), ("ye", b), ("sx", i128::from(dx < 0)), ("sy", i128::from(dy < 0))]
        }
        Form::Signed => vec![("xe", dx), ("ye", dy)],
    };
    words.push(("f", 0));
    match hardware.end_point {
        EndPoint::PerAxis => words.extend([("ex", a), ("ey", b)]),
        EndPoint::Longest => {
            // On 45° lines the counter watches the axis that loses ties and therefore steps last: Y, but X where the
            // signed form gives the tie to Y.
            let x_is_longest = a > b || a == b && hardware.form == Form::Signed && (dx < 0) != (dy < 0);
            words.extend([("e", a.max(b)), ("x_is_longest", i128::from(x_is_longest))]);
        }
        EndPoint::Total | EndPoint::Iterations => words.push(("e", a + b)),
    }
    words.extend([("x", i128::from(line.from()[0])), ("y", i128::from(line.from()[1]))]);
    vec![words]
}
