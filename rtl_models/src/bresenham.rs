//! `bresenham`: the step counters of firmware for 3D printers and mills, line of 2 to 6 axes.
//!
//! ```text
//!   for each axis i:   stepsi ──► + ──► cnti ──► >= events ? ──► di ──► position i
//!                                 ▲──────┴── - events ◄── yes
//!                                                                e ──► done
//! ```
//!
//! | register | width | load value |
//! |---|---|---|
//! | events | n | N, the longest abs(d): step events of the block |
//! | stepsx, stepsy, … | n | abs(d) of each axis |
//! | cntx, cnty, … | n+1 | floor(N/2) (signed form, two's complement: -floor(N/2)) |
//! | e | n | N step events |
//!
//! A step event takes two clocks, as the firmware's interrupt takes two statements. ADD: every counter += abs(d). TEST: a
//! counter that has come to N steps its axis, and counter -= N. The signed form keeps counters N lower and tests
//! their sign.
//!
//! **The test.** `--compare ge` steps at N, `gt` only above it. Counters then stay among N numbers: 0 … N-1 with `ge`,
//! 1 … N with `gt`; signed, -N … -1 and -N+1 … 0. Where a counter starts among them the end point is exact: in a block
//! it rises by N·abs(d) and falls by N a step, so it ends as many times N from its start as steps are wrong, and among N
//! numbers that is none. Every start is one of them for N >= 2. A block of N = 1 starts at 0: unsigned that is right with
//! `ge`, while `gt`, the test of early firmware, makes no step at all; signed it is right with `gt`, while with `ge` an
//! axis steps that has no way to go.
//!
//! **Widths.** A counter must hold the sum of the ADD clock. It stood among its N numbers, at most at N-1 (`gt` at N), and
//! abs(d) <= N: at most 2N - 1 or 2N. As N < 2^n, n+1 bits hold both. Signed, the sum is at most N, and what TEST leaves at
//! least -N: n+1 bits again. With n bits (`ge`) the longest axis overflows where N + floor(N/2) >= 2^n, and an axis whose
//! abs(d) < N has no common divisor with N where N - 1 + abs(d) >= 2^n, for it does come to N-1. Firmware whose counters
//! were as wide as its step counts lost steps on the longest moves only.
//!
//! A path of the right test stays within half a BLU along each axis; the other test may add 1/(2N).
//!
//! The line (5, 3), from the golden file `waves/bresenham-5-3.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../waves/bresenham-5-3.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};
use stepwave_netlist::formula::name;

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::names::{COUNTER, POSITION, SIGN, STEPS};
use crate::hardware::{Hardware, Pace};
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{COMPARE, Compare, END_POINT, EndPoint, FORM, Form, ON_OVERFLOW, WIDTH};
use crate::parts::{Block, DownCounter, axis_counter};
use crate::plan::Plan;
use crate::sizes;

/// Step counters of printer and mill firmware, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: "bresenham",
    title: "Step counters of printer and mill firmware, line of 2 to 6 axes",
    method: "modern step generators",
    source: "the line tracing of open firmware for printers and mills, after J. E. Bresenham, 1965",
    registers: &[
        RegisterDoc { name: "stepsx, stepsy, …", width: "n", about: "|d| of each axis" },
        RegisterDoc { name: "cntx, cnty, …", width: "n+1", about: "counter, from N/2 (signed form: from -N/2)" },
        RegisterDoc { name: "events", width: "n", about: "N, the longest |d|" },
        RegisterDoc { name: "e", width: "n", about: "step events left, from N" },
        RegisterDoc::AXIS_POSITIONS,
    ],
    options: &[
        &WIDTH,
        &FORM.only(
            Some(Form::Magnitude),
            &[(Form::Magnitude, ""), (Form::Signed, ": counters are N lower")],
            "its counters have no case of their own for a line along an axis",
        ),
        &COMPARE.only(
            None,
            &[(Compare::AtLeast, " (default)"), (Compare::Greater, " (default of the signed form)")],
            "",
        ),
        &ON_OVERFLOW,
    ],
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
pub(crate) fn registers(plan: &mut Plan, longest: u64, positions: impl IntoIterator<Item = Vec<i64>>) {
    let n = plan.magnitude_bits(longest);
    for axis in 0..plan.axes() {
        plan.register(STEPS[axis], n).register(COUNTER[axis], n + 1);
    }
    plan.register("events", n).register("e", n).positions(positions);
    plan.fix(&END_POINT, EndPoint::Longest);
    plan.decide(&COMPARE, right_test(plan.get(&FORM)));
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

/// The wiring after a block loader. Each `tick` (1 bit) of a pulse source begins a step event; without one, events follow
/// each other.
pub(crate) fn interpolator<'m>(m: Scope<'m>, hardware: &Hardware, block: Block<'m>, tick: Option<Signal<'m>>) {
    let names = [(0, "IDLE"), (1, "ADD"), (2, "TEST")].map(|(value, name)| (value, name.to_owned()));
    let beat = m.reg("beat", 2).shown(Format::States(names.to_vec()));
    let [ready, test] = [0, 1].map(|place| beat.q.bit(place));
    let add = tick.map_or(ready, |tick| ready & tick);
    let events = block.held(m, "events", hardware.bits("events"));
    let e = DownCounter::new(m, &block, "e", hardware.bits("e"));
    for (i, letter) in hardware.letters().iter().enumerate() {
        let scope = m.scope(&format!("axis_{letter}"));
        let steps = block.held(scope, STEPS[i], hardware.bits(STEPS[i]));
        let step = counter(scope, &block, hardware, COUNTER[i], [add, test], [steps, events]);
        if hardware.get(&FORM) == Form::Magnitude && hardware.get(&COMPARE) == Compare::AtLeast {
            scope.between_steps("below_the_events", [name("events") - 1 - name(COUNTER[i])]);
        }
        let negative = block.held(scope, SIGN[i], 1);
        axis_counter(scope, &block, POSITION[i], hardware.bits(POSITION[i]), step, negative);
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

/// The counter of an axis: adds the steps at an edge with `add` = 1; at one with `test` = 1 it loses the events where it
/// has come to them. Returns 1 bit: it does so at this edge, and the axis steps.
fn counter<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    hardware: &Hardware,
    name: &str,
    [add, test]: [Signal<'m>; 2],
    [steps, events]: [Signal<'m>; 2],
) -> Signal<'m> {
    let bits = hardware.bits(name);
    let signed = hardware.get(&FORM) == Form::Signed;
    let counter = if signed { m.reg_signed(name, bits) } else { m.reg(name, bits) };
    let wide = bits.max(events.bits());
    let [count, whole] = [counter.q.extend(wide), events.extend(wide)];
    let come = match (signed, hardware.get(&COMPARE)) {
        (false, Compare::AtLeast) => !count.less_than(whole),
        (false, Compare::Greater) => whole.less_than(count),
        (true, Compare::AtLeast) => !count.msb(),
        (true, Compare::Greater) => !count.msb() & count.is_nonzero(),
    };
    let step = m.name("step", test & come);
    let word = if signed { block.word_signed(name, bits) } else { block.word(name, bits) };
    let sum = counter.q.strict_add(steps, add & !block.load);
    let rest = counter.q.strict_sub(events, step & !block.load);
    counter.when(block.load, word).when(add, sum).when(step, rest).else_hold();
    step
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    vec![words(&line.delta(), line.from(), hardware)]
}

/// The words of a block with these displacements of the axes, in BLU, and of the first block with the place that it starts
/// from.
pub(crate) fn words(delta: &[i64], from: &[i64], hardware: &Hardware) -> Words {
    let events = i128::from(sizes::longest_of(delta));
    let half = events / 2;
    let mut words: Words = vec![("events", events), ("e", events)];
    for (axis, &delta) in delta.iter().enumerate() {
        words.push((STEPS[axis], i128::from(delta).abs()));
        words.push((COUNTER[axis], if hardware.get(&FORM) == Form::Signed { -half } else { half }));
        words.push((SIGN[axis], i128::from(delta < 0)));
        words.extend(from.get(axis).map(|&from| (POSITION[axis], i128::from(from))));
    }
    words
}
