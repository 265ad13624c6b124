//! `mindev-line`: minimum deviation (最小偏差法), line of 2 to 6 axes.
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
//! **In space** the longest axis, of displacement L, steps at every step, and each other has a deviation of its own: it steps
//! where f >= 0, and f += 2S, less 2L if it stepped. Range of f: from 2(S-L) to the greater of 2S-1 and 2S-L. The path, of k axes,
//! is at most sqrt(k-1)/2 BLU from the line. This is the project's own definition.
//!
//! The line (5, 3), from the golden file `waves/mindev-line-5-3.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/mindev-line-5-3.csv")]
//! ```
//!
//! The line (5, 3, 2) in space, from `waves/mindev-line-space.csv`:
//!
//! ```text
#![doc = include_str!("../waves/mindev-line-space.csv")]
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
use crate::parts::{
    BeatRing, Block, DEVIATION, DeviationAccumulator, E, F, IN_PLANE, IN_SPACE, LONG, LineFrame, POSITION, SpaceLine,
    TRAVEL, line_change, space_words,
};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::{sizes, words};

const L: Reg = LONG.about("displacement of the long axis");
/// Displacement of the short axis.
const S: Reg = Reg::new("s", N, "displacement of the short axis").when(&IN_PLANE);

/// Minimum deviation, line of 2 to 6 axes.
pub static MODEL: Model = Model {
    name: "mindev-line",
    title: "Minimum deviation, line of 2 to 6 axes",
    method: "minimum deviation",
    source: "最小偏差法, the eight-direction interpolator of Chinese NC textbooks",
    registers: &[
        &L,
        &S,
        &TRAVEL.when(&IN_SPACE),
        &F.about("deviation D, two's complement, from 2S - L").when(&IN_PLANE),
        &DEVIATION.width(N.plus(2)),
        &E.width(N).about("end-point down-counter of the long axis"),
        &POSITION,
    ],
    options: &[&WIDTH, &BEATS, &ON_OVERFLOW],
    claims: Some(Claims::of(Region::LinesByLength)),
    interpolates: Interpolates::Lines(6, Method { plan, load }),
    hardware,
};

fn plan(line: &Line, plan: &mut Plan) -> Result<(), ModelError> {
    sizes::judged_line(line, plan);
    plan.error_bound = Some(0.5 * sizes::across(plan.axes()));
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    if hardware.axes > 2 {
        return in_space(m, hardware);
    }
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let travels = [L, S].map(|travel| hardware.held(m, &block, travel));
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

/// The wiring of 3 axes and more.
fn in_space(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let line = SpaceLine::new(m, &block, hardware);
    let e = hardware.counter(m, &block, E);

    // Judge.
    let judged: Vec<_> = line.axes().iter().map(|axis| axis.not_negative).collect();
    let taken = line.decided(&judged);

    // Feed, compute.
    line.close(&block, hardware, &taken, |axis, taken| {
        let wide = axis.travels[0].bits().max(axis.travels[1].bits()) + 2;
        line_change(m, axis.travels, wide, taken)
    });

    // Compare.
    let last = e.count(line.beat.compare);
    line.beat.close(block, last);
}

/// D stays between what a diagonal step at 0 and an axis step at -1 leave.
fn invariants(m: Scope<'_>) {
    let (f, l, s) = (|| F.value(), || L.value(), || S.value());
    m.between_steps("f_from_below", [f() - 2 * s() + 2 * l()]);
    m.between_steps("f_from_above", [2 * s() - 1 - f()]);
}

fn load(line: &Line, hardware: &Hardware) -> Vec<Words> {
    if hardware.axes > 2 {
        let words = space_words(line, sizes::first_longest(line), |long, travel| 2 * travel - long);
        return vec![words.set(E, i128::from(sizes::longest(line)))];
    }
    let ([a, b], words) = words::judged_line(line);
    let (long, short) = (a.max(b), a.min(b));
    vec![words.set(L, long).set(S, short).set(F, 2 * short - long)]
}
