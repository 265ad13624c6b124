//! `cim-line`: comparison-integral (比较积分法), line.
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
//! The line (5, 3), from the golden file `waves/cim-line-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/cim-line-5-3.csv")]
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
use crate::parts::{A_B, BASE, Block, END, F, POSITION, SIGN, Side, comparison_integral};
use crate::plan::Plan;
use crate::registers::N;
use crate::{sizes, words};

/// Comparison-integral, line.
pub static MODEL: Model = Model {
    name: "cim-line",
    title: "Comparison-integral, line",
    method: "comparison-integral",
    source: "比较积分法, as in Chinese NC textbooks",
    registers: &[
        &F.width(N.plus(1)),
        &A_B.about("interval weights A of an X, B of a Y pulse: |dy|, |dx|"),
        &BASE,
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
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(sizes::longest(line));
    plan.positions(sizes::end_positions(line));
    plan.fix(&END_POINT, EndPoint::PerAxis);
    plan.error_bound = Some(1.0);
    plan.pace = Pace::Longest;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let sides = [0, 1].map(|axis| Side { negative: hardware.held(m, &block, SIGN.of(axis)), change: None });
    invariants(m);

    comparison_integral(m, block, hardware, sides);
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

fn load(line: &Line, _: &Hardware) -> Vec<Words> {
    let ([a, b], words) = words::line(line);
    vec![words.set(F, 0).set_each(A_B, [b, a]).set_each(END.pair(), [a, b])]
}
