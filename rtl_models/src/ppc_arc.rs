//! `ppc-arc`: point-by-point comparison (逐点比较法), arc.
//!
//! ```text
//!   quad, ccw ──► kind ──► which axis shrinks, directions
//!                   │
//!   xi ──┐          ▼                    ┌──► dx, dy ──► x, y
//!   yi ──┴─ 2c±1 ── ± ──► F ──► judge ───┼──► xi ± 1, yi ± 1
//!                   ▲────────────┘       └──► e (ex, ey) ──► done
//! ```
//!
//! F >= 0 steps the axis whose coordinate c shrinks, F -= 2c - 1; F < 0 steps the other, F += 2c + 1, with c before the
//! step. Where the shrinking coordinate is 0 the judge beat turns to the next quadrant (but not in the centre,
//! which R = 1 passes through). With `per-axis` the loader splits the arc at the axes, and an exhausted axis hands its
//! step to the other, so that an end point off the circle is reached too.
//!
//! F stays within [-(2R-1), 2·ceil(R)], so n+2 bits; the radial error within [-1, +1) BLU.
//!
//! The arc NR1 from (6, 0) to (0, 6), from the golden file `waves/ppc-arc-nr1.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/ppc-arc-nr1.csv")]
//! ```

use stepwave_nc::{Arc, Crossing};
use stepwave_netlist::dsl::Scope;

use crate::claims::{Claims, crossing};
use crate::docs::ARC_END_POINT;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::model::Model;
use crate::options::{BEATS, ON_OVERFLOW, WIDTH};
use crate::parts::{
    ArcFrame, BeatRing, Block, DeviationAccumulator, E, END, F, POSITION, QUAD, XI_YI, growing, judged_by_sign,
    shrinking, step_of_circle,
};
use crate::plan::Plan;
use crate::registers::N;
use crate::{sizes, words};

/// Point-by-point comparison, arc.
pub static MODEL: Model = Model {
    name: "ppc-arc",
    title: "Point-by-point comparison, arc",
    method: "point-by-point comparison",
    source: "逐点比较法, the circular interpolator of early NC systems, as in Chinese NC textbooks",
    registers: &[&F, &XI_YI, &QUAD, &E.width(N.plus(3)), &END, &POSITION],
    options: &[&WIDTH, &ARC_END_POINT, &BEATS, &ON_OVERFLOW],
    claims: Some(Claims {
        everywhere: |hardware| crossing::every_arc(hardware, CROSSING),
        guesses: |_, kind| crossing::places(kind),
        ..crossing::CLAIMS
    }),
    interpolates: Interpolates::Arcs(Method { plan, load: |arc, hardware| words::judged_arc(hardware, arc, CROSSING) }),
    hardware,
};

/// The path itself crosses the axes.
const CROSSING: Crossing = Crossing::PathExtreme;

fn plan(arc: &Arc, plan: &mut Plan) -> Result<(), ModelError> {
    sizes::judged_arc(arc, plan, CROSSING, [2; 2]);
    plan.error_bound = Some(1.0);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let arc = ArcFrame::new(m, &block, hardware, beat.judge);

    invariants(m);

    // Judge: F >= 0 steps the shrinking coordinate, F < 0 the growing one.
    let judged = judged_by_sign(&f, arc.kind.x_grows);
    let [take_x, _] = arc.redirected([judged, !judged]);
    let take_x = beat.decided("take_x", take_x);
    let taken = [take_x, !take_x];

    // Feed.
    arc.feed(hardware, beat.feed, taken);

    // Compute.
    let (grows, gain) = step_of_circle(m, arc.coordinates(), take_x, arc.kind.x_grows);
    f.close(&block, beat.compute, !grows, m.name("operand", gain));

    // Coordinates, end point.
    arc.close(beat, taken);
}

/// F stays between what a step at 0 and a step at -1 leave; whether an axis that is reached is crossed already or not.
fn invariants(m: Scope<'_>) {
    m.between_steps("f_from_below", [F.value() + 2 * shrinking() + 1]);
    m.between_steps("f_from_above", [2 * growing() - 2 - F.value(), -F.value(), -growing()]);
    m.between_steps("f_after_an_axis", [growing() - 1, 2 * shrinking() - 3 - F.value(), -F.value()]);
    m.between_steps("f_on_an_axis", [shrinking() - 1, 2 * growing() - 3 - F.value(), -F.value()]);
}
