//! `ppc-conic`: point-by-point comparison (逐点比较法), arcs of ellipses, parabolas and hyperbolas.
//!
//! ```text
//!   gx ± ux ──┐                         ┌──► dx, dy ──► x, y
//!   gy ± uy ──┴─ mux ── ± ──► F ► judge ┼──► gx ± 2ux, gy ± 2uy
//!                       ▲─────────┘     └──► e (ex, ey) ──► done
//! ```
//!
//! | register | width | ellipse x²/a² + y²/b² = 1 | parabola y² = cx | hyperbola x²/a² - y²/b² = 1 |
//! |---|---|---|---|---|
//! | f | n+1, two's complement | b²x² + a²y² - a²b² | y² - cx | b²x² - a²y² - a²b² |
//! | gx | n | 2b²·abs(x) | c | 2b²·abs(x) |
//! | gy | n | 2a²·abs(y) | 2·abs(y) | 2a²·abs(y) |
//! | ux, uy | as they need | b², a² | 0, 1 | b², a² |
//! | e | as it needs | steps to the end, or to the axis where the loader splits (`total`) | | |
//! | ex, ey | as they need | steps of each axis (`per-axis`) | | |
//!
//! gx and gy are the magnitudes of the derivatives of F, and n bits hold the greatest change of F on the arc. A step of x
//! changes F by gx + ux where |x| grows, by gx - ux where it shrinks, and gx itself by 2ux; y likewise. One of both axes
//! lowers F: F >= 0 steps that one, F < 0 the other. Which one it is (`x_lowers`), which coordinates grow (`x_grows`,
//! `y_grows`) and where the axes run (`sx`, `sy`) are load words, so that one machine runs every conic, mirrored or not.
//! The loader splits an ellipse where it meets its axes, and the others at their vertex.
//!
//! The quarter of the ellipse with semi-axes 6 and 4 from (6, 0) to (0, 4), from the golden file
//! `waves/ppc-conic-ellipse.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../waves/ppc-conic-ellipse.csv")]
//! ```

use stepwave_nc::{Conic, ConicSector, Shape, Weight};
use stepwave_netlist::dsl::Scope;

use crate::docs::ARC_END_POINT;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{BEATS, END_POINT, EndPoint, ON_OVERFLOW, WIDTH};
use crate::parts::{BeatRing, Block, DeviationAccumulator, EndCounters, axis_counter, up_down_counter};
use crate::plan::Plan;
use crate::{sizes, words};

/// Point-by-point comparison, ellipse, parabola, hyperbola.
pub static MODEL: Model = Model {
    name: "ppc-conic",
    title: "Point-by-point comparison, ellipse, parabola, hyperbola",
    method: "point-by-point comparison",
    source: "逐点比较法 for curves of second order, as in Chinese NC textbooks",
    registers: &[
        RegisterDoc { name: "f", width: "n+1", about: "deviation F, two's complement" },
        RegisterDoc { name: "gx, gy", width: "n", about: "magnitudes of the derivatives of F" },
        RegisterDoc { name: "ux, uy", width: "as they need", about: "half the change of gx, gy by a step" },
        RegisterDoc { name: "e", width: "as it needs", about: "end-point down-counter of the sector (total)" },
        RegisterDoc::EX_EY_NEEDED,
        RegisterDoc::POSITIONS,
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
    let end_point = plan.decide(&END_POINT, usual);
    // A derivative and what a step adds to it.
    let size = sizes::ConicSize::of(conic, |weight, at| derivative(conic.shape(), weight, at).iter().sum());
    let n = plan.bits_or(sizes::needed(size.greatest));
    plan.register("f", n + 1).register("gx", n).register("gy", n);
    plan.hidden("ux", size.slopes[0]).hidden("uy", size.slopes[1]);
    match end_point {
        EndPoint::PerAxis => plan.end_counters(2, size.steps),
        _ => plan.register("e", size.steps + 1),
    };
    plan.positions(size.positions);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let bits = |name: &str| hardware.bits(name);
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.get(&BEATS), block.busy);
    let f = DeviationAccumulator::new(m, bits("f"));
    let [gx, gy] = ["gx", "gy"].map(|name| m.reg(name, bits(name)));
    let [ux, uy] = ["ux", "uy"].map(|name| block.held(m, name, bits(name)));
    let [x_lowers, x_grows, y_grows] = ["x_lowers", "x_grows", "y_grows"].map(|name| block.held(m, name, 1));
    let end = EndCounters::new(m, &block, hardware);

    // Judge: F >= 0 steps the axis that lowers it.
    let lower_x = !(f.not_negative() ^ x_lowers);
    let [take_x, _] = end.redirected([lower_x, !lower_x]);
    let take_x = beat.decided("take_x", take_x);
    let taken = [take_x, !take_x];

    // Feed.
    for ((letter, sign), taken) in [("x", "sx"), ("y", "sy")].into_iter().zip(taken) {
        let scope = m.scope(&format!("axis_{letter}"));
        axis_counter(scope, &block, letter, bits(letter), beat.feed & taken, block.held(scope, sign, 1));
    }

    // Compute: g + u where the coordinate grows, else g - u.
    let wide = ["gx", "gy", "ux", "uy"].map(bits).into_iter().max().unwrap_or(1) + 1;
    let [change_x, change_y] = [(gx, ux, x_grows), (gy, uy, y_grows)].map(|(g, u, grows)| {
        let (g, u) = (g.q.extend(wide), u.extend(wide));
        grows.mux(g.wrapping_add(u), g.wrapping_sub(u))
    });
    let lowers = !(take_x ^ x_lowers);
    f.close(&block, beat.compute, lowers, m.name("change", take_x.mux(change_x, change_y)));
    let derivatives = [("gx", gx, ux, x_grows, taken[0]), ("gy", gy, uy, y_grows, taken[1])];
    for (name, g, u, grows, taken) in derivatives {
        let count = beat.compute & taken;
        let load = [(block.load, block.word(name, bits(name)))];
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
        let own = vec![("f", conic.implicit(sector.start)), ("gx", gx), ("gy", gy), ("ux", ux), ("uy", uy)];
        let end = words::end_counters(hardware, sector.steps());
        let side = vec![("x_lowers", i128::from(sector.x_lowers))];
        [own, end, side, words::conic_sector(conic, sector)].concat()
    };
    conic.sectors().iter().map(block).collect()
}
