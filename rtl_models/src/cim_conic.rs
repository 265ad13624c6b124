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
//! | register | ellipse x²/a² + y²/b² = 1, hyperbola | parabola y² = cx |
//! |---|---|---|
//! | a | A = b²·abs(x), the interval weight of an X pulse | c |
//! | b | B = a²·abs(y), the interval weight of a Y pulse | 2·abs(y) |
//! | alpha | b², the change of A by an X pulse | 0 |
//! | beta | a², the change of B by a Y pulse | 2 |
//! | f | 0 | 0 |
//! | base | X if A < B, else Y | |
//! | ex, ey | steps of each axis in the sector | |
//!
//! n bits hold the greatest weight on the arc. A hyperbola whose branch runs along y has a and b, and a parabola that
//! opens along y has x and y changed over. The method is that of `cim-arc`; which weight grows and where the axes run
//! are load words (`x_grows`, `y_grows`, `sx`, `sy`), so that one machine runs all of them. The loader splits an
//! ellipse where it meets its axes, and the others at their vertex. With `mid` a parabola counts in halves: F is 2(y² -
//! cx).
//!
//! The ellipse 4x² + 9y² = 36 from (0, -2) to (-3, 0) with `post`, from the golden file
//! `waves/cim-conic-ellipse.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/cim-conic-ellipse.csv")]
//! ```

use stepwave_nc::{Conic, ConicSector, Shape};
use stepwave_netlist::dsl::Scope;

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{BEATS, END_POINT, EndPoint, ON_OVERFLOW, WEIGHTS, WIDTH};
use crate::parts::{A_B, BASE, Block, Change, END, F, POSITION, SIGN, Side, comparison_integral};
use crate::plan::Plan;
use crate::registers::{AS_NEEDED, Reg};
use crate::sizes;
use crate::words::{self, GROWS};

/// Changes of the interval weights.
const ALPHA_BETA: Reg<2> = Reg::each(["alpha", "beta"], AS_NEEDED, "changes of A and B by a pulse").hidden();

/// Comparison-integral, ellipse, parabola, hyperbola.
pub static MODEL: Model = Model {
    name: "cim-conic",
    title: "Comparison-integral, ellipse, parabola, hyperbola",
    method: "comparison-integral",
    source: "比较积分法, as in Chinese NC textbooks, with F turned over where the base axis changes",
    registers: &[
        &F.about("deviation F, two's complement"),
        &A_B,
        &BASE,
        &ALPHA_BETA,
        &END.width(AS_NEEDED).about("end-point down-counter of each axis"),
        &POSITION,
    ],
    options: &[&WIDTH, &WEIGHTS, &BEATS, &ON_OVERFLOW],
    claims: None,
    interpolates: Interpolates::Conics(Method { plan, load }),
    hardware,
};

fn plan(conic: &Conic, plan: &mut Plan) -> Result<(), ModelError> {
    let size = sizes::ConicSize::of(conic, |weight, at| weight.at(at));
    plan.n = plan.bits_or(sizes::needed(size.greatest));
    plan.set(ALPHA_BETA.of(0), size.slopes[0]).set(ALPHA_BETA.of(1), size.slopes[1]);
    plan.set_each(END, size.steps).positions(size.positions);
    plan.fix(&END_POINT, EndPoint::PerAxis);
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let sides = [0, 1].map(|axis| {
        let [grows, unit, negative] =
            [GROWS, ALPHA_BETA, SIGN.pair()].map(|pair| hardware.held(m, &block, pair.of(axis)));
        Side { negative, change: Some(Change { grows, unit }) }
    });
    comparison_integral(m, block, hardware, sides);
}

fn load(conic: &Conic, hardware: &Hardware) -> Vec<Words> {
    // The weights of a parabola are twice those that its implicit function has.
    let scale = if matches!(conic.shape(), Shape::Parabola { .. }) { 2 } else { 1 };
    let weights = conic.weights();
    let block = |sector: &ConicSector| {
        let [a, b] = [0, 1].map(|axis| weights[axis].at(sector.start[axis].abs()));
        let f = words::weighed(hardware.get(&WEIGHTS), [a, b], !sector.x_lowers, scale * conic.implicit(sector.start));
        let slopes = weights.map(|weight| weight.slope);
        let own = Words::new().set(F, f).set_each(A_B, [a, b]).set_each(ALPHA_BETA, slopes);
        own.set_each(END.pair(), sector.steps()).and(words::conic_sector(conic, sector))
    };
    conic.sectors().iter().map(block).collect()
}
