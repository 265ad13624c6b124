//! `mindev-line`: minimum deviation (最小偏差法), line.
//!
//! ```text
//!   l, s ──► 2s or 2(s - l) ──► + ──► F ──► sign: long axis alone, or diagonal ──► dx, dy ──► x, y
//!                               ▲─────┘                                   │
//!                                                                         └──► e ──► done
//! ```
//!
//! D >= 0 steps diagonally and D += 2(S - L); D < 0 steps the long axis and D += 2S. D is twice the deviation that the
//! axis step would leave less the one that the diagonal would, so the nearer of both is taken: the path stays within
//! half a BLU, measured along the short axis.
//!
//! The line (5, 3), from the golden file `waves/mindev-line-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/mindev-line-5-3.csv")]
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
use crate::parts::{BeatRing, Block, DeviationAccumulator, E, F, LineFrame, POSITION, line_change};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::{sizes, words};

/// Displacements of both axes.
const L_S: Reg<2> = Reg::each(["l", "s"], N, "ways of the long and of the short axis");

/// Minimum deviation, line.
pub static MODEL: Model = Model {
    name: "mindev-line",
    title: "Minimum deviation, line",
    method: "minimum deviation",
    source: "最小偏差法, the eight-direction interpolator of Chinese NC textbooks",
    registers: &[
        &L_S,
        &F.about("deviation D, two's complement, from 2S - L"),
        &E.width(N).about("end-point down-counter of the long axis"),
        &POSITION,
    ],
    options: &[&WIDTH, &BEATS, &ON_OVERFLOW],
    claims: Some(Claims::of(Region::LinesByLength)),
    interpolates: Interpolates::Lines(2, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    sizes::judged_line(line, plan);
    plan.error_bound = Some(0.5);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let travels = [0, 1].map(|which| hardware.held(m, &block, L_S.of(which)));
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let line = LineFrame::new(m, &block, hardware);

    invariants(m);

    // Judge.
    let diagonal = beat.decided("diagonal", f.not_negative());

    // Compute.
    let wide = travels[0].bits().max(travels[1].bits()) + 2;
    f.close_adding(&block, beat.compute, m.name("operand", line_change(m, travels, wide, diagonal)));

    // Feed, compare.
    line.close(hardware, beat, diagonal);
}

/// D stays between what a diagonal step at 0 and an axis step at -1 leave.
fn invariants(m: Scope<'_>) {
    let (f, l, s) = (|| F.value(), || L_S.of(0).value(), || L_S.of(1).value());
    m.between_steps("f_from_below", [f() - 2 * s() + 2 * l()]);
    m.between_steps("f_from_above", [2 * s() - 1 - f()]);
}

fn load(line: &Line, _: &Hardware) -> Vec<Words> {
    let ([a, b], words) = words::judged_line(line);
    let (long, short) = (a.max(b), a.min(b));
    vec![words.set_each(L_S, [long, short]).set(F, 2 * short - long)]
}
