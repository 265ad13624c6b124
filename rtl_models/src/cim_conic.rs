//! `cim-conic`: comparison-integral (比较积分法), arcs of ellipses, parabolas and hyperbolas.
//!
//! ```text
//!      ┌── ± alpha, ± beta
//!      ▼
//!   a, b ──► compare ──► base axis, which steps always
//!                            │
//!   F ──► F >= 0 ──► the other axis steps too ──► dx, dy ──► x, y
//!   ▲                        │                     │
//!   └────── ± weights ◄──────┴─────────────────────┴──► ex, ey ──► done
//! ```
//!
//! | register | width | ellipse x²/a² + y²/b² = 1, hyperbola | parabola y² = cx |
//! |---|---|---|---|
//! | a | n | A = b²·abs(x), the interval weight of an X pulse | c |
//! | b | n | B = a²·abs(y), the interval weight of a Y pulse | 2·abs(y) |
//! | alpha | as it needs | b², the change of A by an X pulse | 0 |
//! | beta | as it needs | a², the change of B by a Y pulse | 2 |
//! | f | n+2, two's complement | 0 | 0 |
//! | base | 1 | X if A < B, else Y | |
//! | ex, ey | as they need | steps of each axis in the sector | |
//!
//! n bits hold the greatest weight on the arc. A hyperbola whose branch runs along y has a and b, and a parabola that
//! opens along y has x and y changed over. The method is that of `cim-arc`; which weight grows and where the axes run are
//! load words (`x_grows`, `y_grows`, `sx`, `sy`), so that one machine runs all of them. The loader splits an ellipse where
//! it meets its axes, and the others at their vertex. With `mid` a parabola counts in halves: F is 2(y² - cx).
//!
//! The ellipse 4x² + 9y² = 36 from (0, -2) to (-3, 0) with `post`, from the golden file
//! `waves/cim-conic-ellipse.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../waves/cim-conic-ellipse.csv")]
//! ```

use stepwave_nc::{Conic, ConicSector, Shape};
use stepwave_netlist::dsl::Scope;

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{Interpolates, Method, Model, RegisterDoc};
use crate::options::{BEATS, END_POINT, EndPoint, ON_OVERFLOW, WEIGHTS, WIDTH};
use crate::parts::{Block, Change, Side, comparison_integral};
use crate::plan::Plan;
use crate::{sizes, words};

/// Comparison-integral, ellipse, parabola, hyperbola.
pub static MODEL: Model = Model {
    name: "cim-conic",
    title: "Comparison-integral, ellipse, parabola, hyperbola",
    method: "comparison-integral",
    source: "比较积分法, as in Chinese NC textbooks, with F turned over where the base axis changes",
    registers: &[
        RegisterDoc { name: "f", width: "n+2", about: "deviation F, two's complement" },
        RegisterDoc { name: "a, b", width: "n", about: "interval weights A of an X, B of a Y pulse" },
        RegisterDoc::BASE,
        RegisterDoc { name: "alpha, beta", width: "as they need", about: "changes of A and B by a pulse" },
        RegisterDoc::EX_EY_NEEDED,
        RegisterDoc::POSITIONS,
    ],
    options: &[&WIDTH, &WEIGHTS, &BEATS, &ON_OVERFLOW],
    claims: None,
    interpolates: Interpolates::Conics(Method { plan, load }),
    hardware,
};

fn plan(conic: &Conic, plan: &mut Plan) -> Result<(), ModelError> {
    let size = sizes::ConicSize::of(conic, |weight, at| weight.at(at));
    let n = plan.bits_or(sizes::needed(size.greatest));
    plan.register("f", n + 2).register("a", n).register("b", n).shown("base");
    plan.hidden("alpha", size.slopes[0]).hidden("beta", size.slopes[1]);
    plan.end_counters(2, size.steps).positions(size.positions);
    plan.fix(&END_POINT, EndPoint::PerAxis);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let side = |sign, grows, unit| {
        let grows = block.held(m, grows, 1);
        let unit = block.held(m, unit, hardware.bits(unit));
        Side { negative: block.held(m, sign, 1), change: Some(Change { grows, unit }) }
    };
    let sides = [side("sx", "x_grows", "alpha"), side("sy", "y_grows", "beta")];
    comparison_integral(m, block, hardware, sides);
}

fn load(conic: &Conic, hardware: &Hardware) -> Vec<Words> {
    // The weights of a parabola are twice those that its implicit function has.
    let scale = if matches!(conic.shape(), Shape::Parabola { .. }) { 2 } else { 1 };
    let weights = conic.weights();
    let block = |sector: &ConicSector| {
        let [a, b] = [0, 1].map(|axis| weights[axis].at(sector.start[axis].abs()));
        let f = words::weighed(hardware.get(&WEIGHTS), [a, b], !sector.x_lowers, scale * conic.implicit(sector.start));
        let own = vec![("f", f), ("a", a), ("b", b), ("alpha", weights[0].slope), ("beta", weights[1].slope)];
        let [ex, ey] = sector.steps().map(i128::from);
        [own, vec![("ex", ex), ("ey", ey)], words::conic_sector(conic, sector)].concat()
    };
    conic.sectors().iter().map(block).collect()
}
