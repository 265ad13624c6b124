//! `bresenham`: the step counters of firmware for 3D printers and mills, line of 2 to 6 axes.
//!
//! ```text
//!   for each axis i:   stepsi ──► + ──► cnti ──► >= events ? ──► di ──► position i
//!                                 ▲──────┴── - events ◄── yes
//!                                                                e ──► done
//! ```
//!
//! A step event takes two clocks, as the firmware's interrupt takes two statements. ADD: every counter += abs(d). TEST:
//! a counter that has come to N steps its axis, and counter -= N. The signed form keeps counters N lower and tests
//! their sign.
//!
//! **The test.** `--compare ge` steps at N, `gt` only above it. Counters then stay among N numbers: 0 … N-1 with `ge`,
//! 1 … N with `gt`; signed, -N … -1 and -N+1 … 0. Where a counter starts among them the end point is exact: in a block
//! it rises by N·abs(d) and falls by N a step, so it ends as many times N from its start as steps are wrong, and among
//! N numbers that is none. Every start is one of them for N >= 2. A block of N = 1 starts at 0: unsigned that is right
//! with
//! `ge`, while `gt`, the test of early firmware, makes no step at all; signed it is right with `gt`, while with `ge` an
//! axis steps that has no travel.
//!
//! **Widths.** A counter must hold the sum of the ADD clock. It was one of its N numbers, at most N-1 (`gt` at N), and
//! abs(d) <= N: at most 2N - 1 or 2N. As N < 2^n, n+1 bits hold both. Signed, the sum is at most N, and what TEST
//! leaves at least -N: n+1 bits again. With n bits (`ge`) the longest axis overflows where N + floor(N/2) >= 2^n, and
//! an axis whose abs(d) < N has no common divisor with N where N - 1 + abs(d) >= 2^n, for it does come to N-1. Firmware
//! whose counters were as wide as its step counts lost steps on the longest moves only.
//!
//! A path of the right test stays within half a BLU along each axis; the other test may add 1/(2N).
//!
//! The line (5, 3), from the golden file `waves/bresenham-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/bresenham-5-3.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{COMPARE, Compare, END_POINT, EndPoint, FORM, Form, ON_OVERFLOW, Taken, WIDTH};
use crate::parts::{Block, E, POSITION, SIGN, axis_scope};
use crate::per_axis;
use crate::plan::Plan;
use crate::registers::{N, PerAxis, Reg};
use crate::sizes;

const STEPS: PerAxis = Reg::each(per_axis!("steps"), N, "|d| of each axis");
const COUNTER: PerAxis = Reg::each(per_axis!("cnt"), N.plus(1), "counter, from N/2 (signed form: from -N/2)");
const EVENTS: Reg = Reg::new("events", N, "N, the longest |d|");

pub(crate) static FORMS: Taken<Form> = FORM.only(
    Some(Form::Magnitude),
    &[(Form::Magnitude, ""), (Form::Signed, ": counters are N lower")],
    "its counters have no case of their own for a line along an axis",
);
pub(crate) static COMPARISONS: Taken<Compare> =
    COMPARE.only(None, &[(Compare::AtLeast, " (default)"), (Compare::Greater, " (default of the signed form)")], "");

/// Step counters of printer and mill firmware, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: "bresenham",
    title: "Step counters of printer and mill firmware, line of 2 to 6 axes",
    method: "modern step generators",
    source: "the line tracing of open firmware for printers and mills, after J. E. Bresenham, 1965",
    registers: &[&(STEPS, COUNTER), &EVENTS, &E.width(N).about("step events left, from N"), &POSITION],
    options: &[&WIDTH, &FORMS, &COMPARISONS, &ON_OVERFLOW],
    claims: Some(Claims::of(Region::LinesHalved)),
    interpolates: Interpolates::Lines(6, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    registers(plan, sizes::longest(line), sizes::end_positions(line));
    plan.error_bound = (plan.axes() == 2 && compares_right(plan.get(&FORM), plan.get(&COMPARE))).then_some(0.5);
    plan.pace = Pace::Longest;
    Ok(())
}

/// The registers for blocks of up to `longest` step events that lead to these positions of each axis.
pub(crate) fn registers(
    plan: &mut Plan,
    longest: u64,
    positions: impl IntoIterator<Item = impl IntoIterator<Item = i64>>,
) {
    plan.n = plan.magnitude_bits(longest);
    plan.positions(positions);
    plan.fix(&END_POINT, EndPoint::Longest);
    plan.decide(&COMPARE, right_test(plan.get(&FORM)));
    // Adding and testing.
    plan.step_clocks = Some(2);
}

fn right_test(form: Form) -> Compare {
    if form == Form::Signed { Compare::Greater } else { Compare::AtLeast }
}

/// The test is the one with which a path stays within half a BLU along each axis.
pub(crate) fn compares_right(form: Form, compare: Compare) -> bool {
    compare == right_test(form)
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    interpolator(m, hardware, Block::new(m), None);
}

/// The wiring after a block loader. Each `tick` (1 bit) of a pulse source begins a step event; without one, events
/// follow each other.
pub(crate) fn interpolator<'m>(m: Scope<'m>, hardware: &Hardware, block: Block<'m>, tick: Option<Signal<'m>>) {
    let names = [(0, "IDLE"), (1, "ADD"), (2, "TEST")].map(|(value, name)| (value, name.to_owned()));
    let beat = m.reg("beat", 2).shown(Format::States(names.to_vec()));
    let [ready, test] = [0, 1].map(|place| beat.q.bit(place));
    let add = tick.map_or(ready, |tick| ready & tick);
    let events = hardware.held(m, &block, EVENTS);
    let e = hardware.counter(m, &block, E);
    for axis in 0..hardware.axes {
        let scope = axis_scope(m, axis);
        let steps = hardware.held(scope, &block, STEPS.of(axis));
        let step = counter(scope, &block, hardware, axis, [add, test], [steps, events]);
        if hardware.get(&FORM) == Form::Magnitude && hardware.get(&COMPARE) == Compare::AtLeast {
            scope.between_steps("below_the_events", [EVENTS.value() - 1 - COUNTER.of(axis).value()]);
        }
        hardware.axis(scope, &block, axis, step, hardware.held(scope, &block, SIGN.of(axis)));
    }
    let last = e.count(test);
    let sequence = beat.when(block.load, m.lit(2, 1)).when(test & last, m.lit(2, 0));
    let next = add.concat(test);
    match tick {
        None => sequence.otherwise(next),
        Some(tick) => sequence.when(ready & !tick, beat.q).otherwise(next),
    }
    block.close(block.load, test, last);
}

/// The counter of an axis: adds the steps at an edge with `add` = 1; at one with `test` = 1 it loses the events where
/// it has come to them. Returns 1 bit: it does so at this edge, and the axis steps.
fn counter<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    hardware: &Hardware,
    axis: usize,
    [add, test]: [Signal<'m>; 2],
    [steps, events]: [Signal<'m>; 2],
) -> Signal<'m> {
    let signed = hardware.get(&FORM) == Form::Signed;
    let own = if signed { COUNTER.of(axis).signed() } else { COUNTER.of(axis) };
    let counter = hardware.reg(m, own);
    let wide = counter.q.bits().max(events.bits());
    let [count, whole] = [counter.q.extend(wide), events.extend(wide)];
    let come = match (signed, hardware.get(&COMPARE)) {
        (false, Compare::AtLeast) => !count.less_than(whole),
        (false, Compare::Greater) => whole.less_than(count),
        (true, Compare::AtLeast) => !count.msb(),
        (true, Compare::Greater) => !count.msb() & count.is_nonzero(),
    };
    let step = m.name("step", test & come);
    let word = hardware.word(block, own);
    let sum = counter.q.strict_add(steps, add & !block.load);
    let rest = counter.q.strict_sub(events, step & !block.load);
    counter.when(block.load, word).when(add, sum).when(step, rest).else_hold();
    step
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    vec![words(&line.delta(), line.from(), hardware)]
}

/// The words of a block with these displacements of the axes, in BLU, and of the first block with the place that it
/// starts from.
pub(crate) fn words(delta: &[i64], from: &[i64], hardware: &Hardware) -> Words {
    let events = i128::from(sizes::longest_of(delta));
    let half = events / 2;
    let start = if hardware.get(&FORM) == Form::Signed { -half } else { half };
    let mut words = Words::new().set(EVENTS, events).set(E, events);
    for (axis, &delta) in delta.iter().enumerate() {
        words = words.set(STEPS.of(axis), delta.abs()).set(COUNTER.of(axis), start);
        words = words.set(SIGN.of(axis), delta < 0);
        if let Some(&from) = from.get(axis) {
            words = words.set(POSITION.of(axis), from);
        }
    }
    words
}
