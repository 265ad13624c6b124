//! `vector-arc`: vector discrimination (矢量判别法), arc.
//!
//! ```text
//!   quad, ccw ──► kind ──┐
//!   xi ──┬──► compare ───┴──► octant: axis vector and diagonal vector ──┐
//!   yi ──┘                                                              ▼
//!   F ──► sign ──────────────────────────────────────────────────► one of the two ──► dx, dy ──► x, y
//!   ▲                                                                   │
//!   └── ± (2x ± 1) ± (2y ± 1) ◄─────────────────────────────────────────┴──► xi ± 1, yi ± 1, e (ex, ey) ──► done
//! ```
//!
//! No primary source of the method survives; this is a definition of this project. The octant fixes an axis vector, x
//! where |x| < |y| (or both are equal and |x| shrinks), else y, and the diagonal. F = x² + y² - R² >= 0 takes the one
//! of the two that goes farther inwards, F < 0 the other. The radial error stays below 1 BLU; the axes are met where
//! point-by-point comparison meets them. A diagonal step counts two pulses in `e`.
//!
//! The arc NR1 from (5, 0) to (0, 5), from the golden file `waves/vector-arc-nr1.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/vector-arc-nr1.csv")]
//! ```

use stepwave_nc::{Arc, Crossing};
use stepwave_netlist::dsl::Scope;

use crate::claims::{Claims, crossing};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::model::Model;
use crate::options::BEATS;
use crate::parts::{ArcFrame, BeatRing, Block, DeviationAccumulator, F, ends_ahead, growing, shrinking};
use crate::plan::Plan;
use crate::{ppc_arc, sizes, words};

/// Vector discrimination, arc.
pub static MODEL: Model = Model {
    name: "vector-arc",
    title: "Vector discrimination, arc",
    method: "vector discrimination",
    source: "矢量判别法; no primary source survives: a definition of this project",
    registers: ppc_arc::MODEL.registers,
    options: ppc_arc::MODEL.options,
    claims: Some(Claims {
        everywhere: |hardware| crossing::every_arc(hardware, CROSSING),
        guesses: |hardware, kind| [ends_ahead(hardware), crossing::places(kind)].concat(),
        ..crossing::CLAIMS
    }),
    interpolates: Interpolates::Arcs(Method { plan, load: |arc, hardware| words::judged_arc(hardware, arc, CROSSING) }),
    hardware,
};

/// Next to an axis the path is that of point-by-point comparison.
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

    // Judge: the octant's axis vector; the other axis only joins it on the diagonal.
    let [x, y] = arc.coordinates();
    let [x_grows, y_grows] = arc.grows();
    let along_x = m.name("along_x", x.less_than(y) | x.equals(y) & !x_grows);
    // The diagonal goes farther inwards than an axis vector along which the coordinate grows.
    let diagonal_inwards = along_x.mux(x_grows, y_grows);
    let diagonal = m.name("diagonal", !(f.not_negative() ^ diagonal_inwards));
    let taken = arc.redirected([along_x | diagonal, !along_x | diagonal]);
    let taken = [beat.decided("take_x", taken[0]), beat.decided("take_y", taken[1])];

    // Feed.
    arc.feed(hardware, beat.feed, taken);

    // Compute.
    let wide = x.bits() + 3;
    let zero = m.lit_signed(wide, 0);
    let [gain_x, gain_y] = arc.gains(wide);
    let operand = taken[0].mux(gain_x, zero).wrapping_add(taken[1].mux(gain_y, zero));
    f.close_adding(&block, beat.compute, m.name("operand", operand));

    // Coordinates, end point.
    arc.close(beat, taken);
}

/// F stays between what a step at 0 and a step at -1 leave; in the first octant of a quadrant the diagonal is the step
/// inwards, which takes less off it. Whether an axis that is reached is crossed already or not.
fn invariants(m: Scope<'_>) {
    let in_second_octant = growing() - shrinking() - 1;
    m.between_steps("f_from_below", [F.value() + 2 * shrinking() + 1]);
    m.between_steps("f_from_below_at_first", [F.value() + 2 * shrinking() - 2 * growing() + 2, in_second_octant]);
    m.between_steps("f_from_above", [2 * growing() - 2 - F.value(), -F.value(), -growing()]);
    m.between_steps("f_after_an_axis", [growing() - 1, 2 * shrinking() - 3 - F.value(), -F.value()]);
    m.between_steps("f_on_an_axis", [growing() - 1, F.value() + 1]);
    m.between_steps("off_the_centre", [growing() - 1, F.value(), shrinking() - 1]);
}
