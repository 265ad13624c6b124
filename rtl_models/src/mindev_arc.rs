//! `mindev-arc`: minimum deviation (最小偏差法), arc.
//!
//! ```text
//!   quad, ccw ──► kind ──► which coordinate grows, directions
//!                   │
//!   xi ──► ∓2x+1 ──►│──► F1 = F after X ──┐
//!   yi ──► ∓2y+1 ──►│──► F2 = F after Y ──┼──► least |F'| ──► X, Y or both ──► dx, dy ──► x, y
//!                   └──► F3 = F1 + F2 - F ┘        │
//!          F ◄── F1, F2 or F3 ◄───────────────────┴──► xi ± 1, yi ± 1, e (ex, ey) ──► done
//! ```
//!
//! Every step looks at the three neighbours ahead (along x, along y, diagonal) and goes where the deviation
//! F = x² + y² - R² is least in magnitude; of equals Y goes before X, and the diagonal before both. The radial error
//! stays below half a BLU, so that an axis is met at R rounded to the nearest integer. A diagonal step counts two
//! pulses in `e`. F stays within ±R, so n+1 bits; after an end point off the circle one more.
//!
//! The arc NR1 from (5, 0) to (0, 5), from the golden file `waves/mindev-arc-nr1.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/mindev-arc-nr1.csv")]
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
    ArcFrame, BeatRing, Block, DeviationAccumulator, E, END, F, LeastDeviation, POSITION, QUAD, XI_YI, ends_ahead,
    growing, shrinking,
};
use crate::plan::Plan;
use crate::registers::N;
use crate::{sizes, words};

/// Minimum deviation, arc.
pub static MODEL: Model = Model {
    name: "mindev-arc",
    title: "Minimum deviation, arc",
    method: "minimum deviation",
    source: "最小偏差法, the eight-direction interpolator of Chinese NC textbooks",
    registers: &[
        &F.width(N.plus(1)),
        &XI_YI,
        &QUAD,
        &E.width(N.plus(3)).about("end-point down-counter of the pulses of both axes"),
        &END,
        &POSITION,
    ],
    options: &[&WIDTH, &ARC_END_POINT, &BEATS, &ON_OVERFLOW],
    claims: Some(Claims {
        everywhere: |hardware| crossing::every_arc(hardware, CROSSING),
        guesses: |hardware, kind| [ends_ahead(hardware), crossing::places(kind)].concat(),
        ..crossing::CLAIMS
    }),
    interpolates: Interpolates::Arcs(Method { plan, load: |arc, hardware| words::judged_arc(hardware, arc, CROSSING) }),
    hardware,
};

/// The radial error below half a BLU leaves one place to meet an axis.
const CROSSING: Crossing = Crossing::RoundedRadius;

fn plan(arc: &Arc, plan: &mut Plan) -> Result<(), ModelError> {
    sizes::judged_arc(arc, plan, CROSSING, [1, 2]);
    plan.error_bound = Some(0.5);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let arc = ArcFrame::new(m, &block, hardware, beat.judge);

    invariants(m);

    // Judge: F after each of the three steps, and the least of their magnitudes.
    let wide = f.value().bits().max(arc.coordinates()[0].bits() + 2) + 2;
    let least = LeastDeviation::new(m, f.value(), arc.gains(wide));
    let taken = arc.redirected([least.takes_x(), least.takes_y()]);
    let taken = [beat.decided("take_x", taken[0]), beat.decided("take_y", taken[1])];

    // Feed.
    arc.feed(hardware, beat.feed, taken);

    // Compute.
    f.close_adding(&block, beat.compute, m.name("operand", least.change(taken)));

    // Coordinates, end point.
    arc.close(beat, taken);
}

/// A diagonal step lands between two others, nearer to 0 than both: |F| is at most half of what parts it from them, which
/// is less than the coordinate that it leaves or comes to. A step along an axis comes from F on the other side.
fn invariants(m: Scope<'_>) {
    m.between_steps("f_from_below", [shrinking(), growing()].map(|c| F.value() + c));
    m.between_steps("f_from_above", [shrinking(), growing()].map(|c| c - 1 - F.value()));
}
