//! `cim-line`: comparison-integral (比较积分法), line of 2 to 6 axes.
//!
//! ```text
//!   a ──┬──► compare ──► base axis, which steps always
//!   b ──┘                    │
//!   F ──► F >= 0 ──► the other axis steps too ──► dx, dy ──► x, y
//!   ▲                        │                     │
//!   └── + weight of the base axis, - of the other ◄┴──► ex, ey ──► done
//! ```
//!
//! The axis with the smaller interval, the longer one, is the base axis: it steps at every step, the other where
//! F >= 0. F gains the weight of the base axis for its pulse and loses that of the other for its own. The intervals of
//! a line are constant, so the three weight rules are one.
//!
//! **In space** the longest axis, of displacement L, is the base axis, and each other has a deviation of its own: it steps where
//! f >= 0, as long as it has pulses left, and f += S, less L if it stepped. Range of f: [S-L, S-1]. The path, of k axes,
//! is less than sqrt(k-1) BLU from the line. This is the project's own definition.
//!
//! The line (5, 3), from the golden file `waves/cim-line-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/cim-line-5-3.csv")]
//! ```
//!
//! The line (5, 3, 2) in space, from `waves/cim-line-space.csv`:
//!
//! ```text
#![doc = include_str!("../waves/cim-line-space.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::dsl::Scope;
use stepwave_netlist::formula::number;

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{BEATS, END_POINT, EndPoint, ON_OVERFLOW, WEIGHTS, WIDTH, Weights};
use crate::parts::{
    A_B, BASE, Block, DEVIATION, END, F, IN_PLANE, IN_SPACE, LONG, POSITION, SIGN, Side, SpaceLine, TRAVEL,
    comparison_integral, space_words,
};
use crate::plan::Plan;
use crate::registers::N;
use crate::{sizes, words};

/// Comparison-integral, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: "cim-line",
    title: "Comparison-integral, line of 2 to 6 axes",
    method: "comparison-integral",
    source: "比较积分法, as in Chinese NC textbooks",
    registers: &[
        &TRAVEL.when(&IN_SPACE),
        &LONG.when(&IN_SPACE),
        &F.width(N.plus(1)).when(&IN_PLANE),
        &DEVIATION,
        &A_B.about("interval weights A of an X, B of a Y pulse: |dy|, |dx|").when(&IN_PLANE),
        &BASE.when(&IN_PLANE),
        &END,
        &POSITION,
    ],
    options: &[
        &WIDTH,
        &WEIGHTS.only(
            Some(Weights::Mid),
            &[(Weights::Mid, ""), (Weights::Pre, ""), (Weights::Post, ": all the same on a line")],
            "",
        ),
        &BEATS,
        &ON_OVERFLOW,
    ],
    claims: Some(Claims { modes: &[BASE], ..Claims::of(Region::Lines) }),
    interpolates: Interpolates::Lines(6, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(sizes::longest(line));
    plan.positions(sizes::end_positions(line));
    plan.fix(&END_POINT, EndPoint::PerAxis);
    plan.error_bound = Some(sizes::across(plan.axes()));
    plan.pace = Pace::Longest;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    if hardware.axes > 2 {
        return in_space(m, hardware);
    }
    let block = Block::new(m);
    let sides = [0, 1].map(|axis| Side { negative: hardware.held(m, &block, SIGN.of(axis)), change: None });
    invariants(m);

    comparison_integral(m, block, hardware, sides);
}

/// The wiring of 3 axes and more.
fn in_space(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let line = SpaceLine::new(m, &block, hardware);
    let left: Vec<_> = (0..hardware.axes).map(|axis| hardware.counter(m, &block, END.of(axis))).collect();

    // Judge: an axis at its end steps no more.
    let judged: Vec<_> = line.axes().iter().zip(&left).map(|(axis, e)| axis.not_negative & e.running()).collect();
    let taken = line.decided(&judged);

    // Feed, compute.
    line.close(&block, hardware, &taken, |axis, taken| {
        let wide = axis.travels[0].bits().max(axis.travels[1].bits()) + 1;
        let [long, travel] = axis.travels.map(|travel| travel.extend(wide).as_signed());
        taken.mux(travel.wrapping_sub(long), travel)
    });

    // Compare.
    let ended = left.into_iter().zip(&taken).map(|(e, taken)| e.count(line.beat.compare & *taken));
    let last = ended.reduce(|a, b| a & b).unwrap_or(block.load);
    line.beat.close(block, last);
}

/// F stays between what a step at 0 and a step at -1 leave.
fn invariants(m: Scope<'_>) {
    // Where X is base F is A·x - B·y, where Y is base the negative of it.
    let (f, a, b, y_is_base) = (|| F.value(), || A_B.of(0).value(), || A_B.of(1).value(), || BASE.value());
    let x_is_base = || number(1) - y_is_base();
    m.between_steps("f_from_below_x", [f() - a() + b(), y_is_base() - 1]);
    m.between_steps("f_from_below_y", [f() - b() + a(), x_is_base() - 1]);
    m.between_steps("f_from_above_x", [a() - 1 - f(), -f(), y_is_base() - 1]);
    m.between_steps("f_from_above_y", [b() - 1 - f(), -f(), x_is_base() - 1]);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    if hardware.axes > 2 {
        let words = space_words(line, sizes::last_longest(line), |_, _| 0);
        let pulses = line.delta().into_iter().map(|delta| i128::from(delta).abs()).enumerate();
        return vec![pulses.fold(words, |words, (axis, pulses)| words.set(END.of(axis), pulses))];
    }
    let ([a, b], words) = words::line(line);
    vec![words.set(F, 0).set_each(A_B, [b, a]).set_each(END.pair(), [a, b])]
}
