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
//! | register | width | load value |
//! |---|---|---|
//! | a | n | A = abs(dy), the interval weight of an X pulse |
//! | b | n | B = abs(dx), the interval weight of a Y pulse |
//! | f | n+1, two's complement | 0 |
//! | base | 1 | X if A < B, else Y |
//! | ex, ey | n | abs(dx), abs(dy) |
//!
//! The axis with the smaller interval, the longer one, is the base axis: it steps at every step, the other where
//! F >= 0. F gains the weight of the base axis for its pulse and loses that of the other for its own. The intervals of
//! a line are constant, so the three weight rules are one.
//!
//! The line (5, 3), from the golden file `waves/cim-line-5-3.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../../waves/cim-line-5-3.csv")]
//! ```

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::{Module, Scope};
use stepwave_kernel::formula::{name, number};
use stepwave_nc::Curve;

use crate::choices::{Choice, Choices, EndPoint};
use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::{Hardware, Pace};
use crate::machine::Words;
use crate::model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
use crate::parts::{Block, Side, comparison_integral};
use crate::registers::Registers;
use crate::{plan, words};

const NAME: &str = "cim-line";

pub(crate) const MODEL: Model = Model {
    name: NAME,
    title: "Comparison-integral, line",
    method: "comparison-integral",
    curve: CurveKind::Line { max_axes: 2 },
    registers: &[
        RegisterDoc { name: "f", width: "n+1", about: "deviation F, two's complement, from 0" },
        RegisterDoc { name: "a, b", width: "n", about: "interval weights A of an X, B of a Y pulse: |dy|, |dx|" },
        RegisterDoc::BASE,
        RegisterDoc::EX_EY,
        RegisterDoc::POSITIONS,
    ],
    choices: &[
        ChoiceDoc::WIDTH,
        ChoiceDoc { choice: Choice::Weights, values: "mid (default) | pre | post: all the same on a line" },
        ChoiceDoc::BEATS,
        ChoiceDoc::ON_OVERFLOW,
    ],
    source: "比较积分法, as in Chinese NC textbooks",
    claims: Some(Claims { modes: &["base"], ..Claims::of(Region::Lines) }),
    plan,
    netlist,
    words,
};

fn plan(curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
    let n = plan::magnitude_bits(choices, plan::longest(curve));
    let mut registers = Registers::new(NAME, choices);
    registers.register("f", n + 1).register("a", n).register("b", n).shown("base").end_counters(2, n);
    registers.positions(plan::end_positions(curve));
    let hardware = registers.hardware(2, EndPoint::PerAxis)?;
    Ok(Hardware { error_bound: Some(1.0), pace: Pace::Longest, ..hardware })
}

fn netlist(hardware: &Hardware) -> Result<Netlist, ModelError> {
    let module = Module::with_overflow("cim_line", hardware.on_overflow);
    let m = module.top();
    let block = Block::new(m);
    let sides = ["sx", "sy"].map(|sign| Side { negative: block.held(m, sign, 1), change: None });
    invariants(m);

    comparison_integral(m, block, hardware, sides);
    Ok(module.finish()?)
}

/// F stays between what a step at 0 and a step at -1 leave.
fn invariants(m: Scope<'_>) {
    // Where X is base F is A·x - B·y, where Y is base the negative of it.
    let (f, a, b, y_is_base) = (|| name("f"), || name("a"), || name("b"), || name("base"));
    let x_is_base = || number(1) - y_is_base();
    m.between_steps("f_from_below_x", [f() - a() + b(), y_is_base() - 1]);
    m.between_steps("f_from_below_y", [f() - b() + a(), x_is_base() - 1]);
    m.between_steps("f_from_above_x", [a() - 1 - f(), -f(), y_is_base() - 1]);
    m.between_steps("f_from_above_y", [b() - 1 - f(), -f(), x_is_base() - 1]);
}

fn words(_: &Hardware, curve: &Curve) -> Vec<Words> {
    let Some((way, mut words)) = words::line(curve) else { return Vec::new() };
    words.extend([("f", 0), ("a", way[1]), ("b", way[0]), ("ex", way[0]), ("ey", way[1])]);
    vec![words]
}
