//! `vector-line`: vector discrimination (矢量判别法), line.
//!
//! ```text
//!   xe ──┐
//!   ye ──┴─► + xe, - ye or both ──► + ──► F ──► sign: axis vector or diagonal vector ──► dx, dy ──► x, y
//!                                   ▲─────┘                                   │
//!                                                                             └──► e ──► done
//! ```
//!
//! No primary source of the method survives; this is a definition of this project. The octant of the line fixes an axis
//! vector (x where a >= b, else y) and the diagonal vector; on a line of 45° both are the diagonal. F = a·y - b·x is
//! the cross product of the line and the distance covered: an X pulse takes b off, a Y pulse puts a on. On the line, F
//! = 0, the axis vector is taken; next to it the one that leads back: the diagonal where x is the axis vector and F <
//! 0, or y is and F > 0. The path stays below 1 BLU off the line, and F within [1 - max(a, b), max(a, b) - 1].
//!
//! The line (5, 3), from the golden file `waves/vector-line-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/vector-line-5-3.csv")]
//! ```

use stepwave_nc::Line;
use stepwave_netlist::dsl::Scope;

use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{BEATS, ON_OVERFLOW, WIDTH};
use crate::parts::{BeatRing, Block, DeviationAccumulator, E, F, LONGEST, LineFrame, POSITION};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::{sizes, words};

/// Displacements.
const XE_YE: Reg<2> = Reg::each(["xe", "ye"], N, "|dx|, |dy| of the line");

/// Vector discrimination, line.
pub static MODEL: Model = Model {
    name: "vector-line",
    title: "Vector discrimination, line",
    method: "vector discrimination",
    source: "矢量判别法; no primary source survives: a definition of this project",
    registers: &[&XE_YE, &F.width(N.plus(1)), &E.width(N).about("end-point down-counter of the long axis"), &POSITION],
    options: &[&WIDTH, &BEATS, &ON_OVERFLOW],
    claims: Some(Claims::of(Region::LinesByLength)),
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    sizes::judged_line(line, plan);
    plan.error_bound = Some(1.0);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let [xe, ye] = [0, 1].map(|axis| hardware.held(m, &block, XE_YE.of(axis)));
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let line = LineFrame::new(m, &block, hardware);
    let wide = xe.bits().max(ye.bits()) + 1;
    let [xe, ye] = [xe, ye].map(|end| end.extend(wide).as_signed());

    invariants(m);

    // Judge.
    let (below, above) = (!f.not_negative(), f.not_negative() & f.value().is_nonzero());
    let diagonal = beat.decided("diagonal", line.x_is_longest.mux(below, above) | xe.equals(ye));

    // Compute: an X pulse takes ye off F, a Y pulse puts xe on.
    let zero = m.lit_signed(wide, 0);
    let [x_steps, y_steps] = [line.x_is_longest | diagonal, !line.x_is_longest | diagonal];
    let operand = y_steps.mux(xe, zero).wrapping_sub(x_steps.mux(ye, zero));
    f.close_adding(&block, beat.compute, m.name("operand", operand));

    // Feed, compare.
    line.close(hardware, beat, diagonal);
}

/// F stays between what a step of the axis vector at 0 and one of the diagonal next to the line leave.
fn invariants(m: Scope<'_>) {
    let (f, x_is_long) = (|| F.value(), || LONGEST.of(0).value());
    let [xe, ye] = [0, 1].map(|axis| move || XE_YE.of(axis).value());
    m.between_steps("f_from_below_x", [f() + ye(), -x_is_long()]);
    m.between_steps("f_from_above_x", [xe() - ye() - 1 - f(), -f(), -x_is_long()]);
    m.between_steps("f_on_45_degrees", [f(), xe() - ye() - 1, -x_is_long()]);
    m.between_steps("f_from_below_y", [f() - xe() + ye() - 1, f(), x_is_long() - 1]);
    m.between_steps("f_from_above_y", [xe() - f(), x_is_long() - 1]);
}

fn load(line: &Line, _: &Hardware) -> Vec<Words> {
    let (end, words) = words::judged_line(line);
    vec![words.set_each(XE_YE, end).set(F, 0)]
}
