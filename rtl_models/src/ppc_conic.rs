//! `ppc-conic`: point-by-point comparison (逐点比较法), arcs of ellipses, parabolas and hyperbolas.
//!
//! ```text
//!   gx ± ux ──┐                         ┌──► dx, dy ──► x, y
//!   gy ± uy ──┴─ mux ── ± ──► F ► judge ┼──► gx ± 2ux, gy ± 2uy
//!                       ▲─────────┘     └──► e (ex, ey) ──► done
//! ```
//!
//! | register | ellipse x²/a² + y²/b² = 1 | parabola y² = cx | hyperbola x²/a² - y²/b² = 1 |
//! |---|---|---|---|
//! | f | b²x² + a²y² - a²b² | y² - cx | b²x² - a²y² - a²b² |
//! | gx | 2b²·abs(x) | c | 2b²·abs(x) |
//! | gy | 2a²·abs(y) | 2·abs(y) | 2a²·abs(y) |
//! | ux, uy | b², a² | 0, 1 | b², a² |
//! | e | steps to the end, or to the axis where the loader splits (`total`) | | |
//! | ex, ey | steps of each axis (`per-axis`) | | |
//!
//! gx and gy are the magnitudes of the derivatives of F, and n bits hold the greatest change of F on the arc. A step of
//! x changes F by gx + ux where |x| grows, by gx - ux where it shrinks, and gx itself by 2ux; y likewise. One of both
//! axes lowers F: F >= 0 steps that one, F < 0 the other. Which one it is (`x_lowers`), which coordinates grow
//! (`x_grows`,
//! `y_grows`) and where the axes run (`sx`, `sy`) are load words, so that one machine runs every conic, mirrored or not.
//! The loader splits an ellipse where it meets its axes, and the others at their vertex.
//!
//! The quarter of the ellipse with semi-axes 6 and 4 from (6, 0) to (0, 4), from the golden file
//! `waves/ppc-conic-ellipse.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/ppc-conic-ellipse.csv")]
//! ```

use stepwave_nc::{Conic, ConicSector, Shape, Weight};
use stepwave_netlist::dsl::Scope;

use crate::docs::ARC_END_POINT;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{BEATS, END_POINT, EndPoint, ON_OVERFLOW, WIDTH};
use crate::parts::{
    BeatRing, Block, DeviationAccumulator, E, END, EndCounters, F, POSITION, SIGN, axis_scope, up_down_counter,
};
use crate::plan::Plan;
use crate::registers::{AS_NEEDED, N, Reg, Rule};
use crate::sizes;
use crate::words::{self, GROWS};

const GX_GY: Reg<2> = Reg::each(["gx", "gy"], N, "magnitudes of the derivatives of F");
const UX_UY: Reg<2> = Reg::each(["ux", "uy"], AS_NEEDED, "half the change of gx, gy by a step").hidden();
/// A step of x lowers F.
const X_LOWERS: Reg = Reg::new("x_lowers", Rule::Bits(1), "a step of x lowers F");

/// Point-by-point comparison, ellipse, parabola, hyperbola.
pub static MODEL: Model = Model {
    name: "ppc-conic",
    title: "Point-by-point comparison, ellipse, parabola, hyperbola",
    method: "point-by-point comparison",
    source: "逐点比较法 for curves of second order, as in Chinese NC textbooks",
    registers: &[
        &F.width(N.plus(1)).about("deviation F, two's complement"),
        &GX_GY,
        &UX_UY,
        &E.width(Rule::Planned("as it needs")).about("end-point down-counter of the sector"),
        &END.width(AS_NEEDED).about("end-point down-counter of each axis"),
        &POSITION,
    ],
    options: &[&WIDTH, &ARC_END_POINT, &BEATS, &ON_OVERFLOW],
    claims: None,
    interpolates: Interpolates::Conics(Method { plan, load }),
    hardware,
};

/// Derivative of F along an axis, and half its change by a step, of the axis's interval weight: of an ellipse or a
/// hyperbola it is twice the weight, of a parabola the weight itself.
fn derivative(shape: Shape, weight: Weight, magnitude: i64) -> [i128; 2] {
    match shape {
        Shape::Parabola { .. } => [weight.at(magnitude), weight.slope / 2],
        _ => [2 * weight.at(magnitude), weight.slope],
    }
}

fn plan(conic: &Conic, plan: &mut Plan) -> Result<(), ModelError> {
    let usual = if conic.ends_on_curve() { EndPoint::Total } else { EndPoint::PerAxis };
    plan.decide(&END_POINT, usual);
    // A derivative and what a step adds to it.
    let size = sizes::ConicSize::of(conic, |weight, at| derivative(conic.shape(), weight, at).iter().sum());
    plan.n = plan.bits_or(sizes::needed(size.greatest));
    plan.set(UX_UY.of(0), size.slopes[0]).set(UX_UY.of(1), size.slopes[1]);
    plan.set(E, size.steps + 1).set_each(END, size.steps).positions(size.positions);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let [gx, gy] = [0, 1].map(|axis| hardware.reg(m, GX_GY.of(axis)));
    let [ux, uy] = [0, 1].map(|axis| hardware.held(m, &block, UX_UY.of(axis)));
    let [x_lowers, x_grows, y_grows] = [X_LOWERS, GROWS.of(0), GROWS.of(1)].map(|flag| hardware.held(m, &block, flag));
    let end = EndCounters::new(m, &block, hardware);

    // Judge: F >= 0 steps the axis that lowers it.
    let lower_x = !(f.not_negative() ^ x_lowers);
    let [take_x, _] = end.redirected([lower_x, !lower_x]);
    let take_x = beat.decided("take_x", take_x);
    let taken = [take_x, !take_x];

    // Feed.
    for (axis, taken) in taken.into_iter().enumerate() {
        let scope = axis_scope(m, axis);
        hardware.axis(scope, &block, axis, beat.feed & taken, hardware.held(scope, &block, SIGN.of(axis)));
    }

    // Compute: g + u where the coordinate grows, else g - u.
    let wide = [gx.q, gy.q, ux, uy].map(|signal| signal.bits()).into_iter().max().unwrap_or(1) + 1;
    let [change_x, change_y] = [(gx, ux, x_grows), (gy, uy, y_grows)].map(|(g, u, grows)| {
        let (g, u) = (g.q.extend(wide), u.extend(wide));
        grows.mux(g.wrapping_add(u), g.wrapping_sub(u))
    });
    let lowers = !(take_x ^ x_lowers);
    f.close(&block, beat.compute, lowers, m.name("change", take_x.mux(change_x, change_y)));
    let derivatives = [(gx, ux, x_grows, taken[0]), (gy, uy, y_grows, taken[1])];
    for (axis, (g, u, grows, taken)) in derivatives.into_iter().enumerate() {
        let count = beat.compute & taken;
        let load = [(block.load, hardware.word(&block, GX_GY.of(axis)))];
        up_down_counter(g, &load, count & grows, count & !grows, u.concat(m.lit(1, 0)));
    }

    // Compare.
    let last = end.count(beat.compare, taken);
    beat.close(block, last);
}

fn load(conic: &Conic, hardware: &Hardware) -> Vec<Words> {
    let weights = conic.weights();
    let block = |sector: &ConicSector| {
        let at = |axis: usize| derivative(conic.shape(), weights[axis], sector.start[axis].abs());
        let ([gx, ux], [gy, uy]) = (at(0), at(1));
        let own = Words::new().set(F, conic.implicit(sector.start)).set_each(GX_GY, [gx, gy]).set_each(UX_UY, [ux, uy]);
        let end = words::end_counters(hardware, sector.steps());
        own.and(end).set(X_LOWERS, sector.x_lowers).and(words::conic_sector(conic, sector))
    };
    conic.sectors().iter().map(block).collect()
}
