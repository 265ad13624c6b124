//! `dda-conic`: digital differential analyser, DDA (数字积分法), arcs of ellipses, parabolas and hyperbolas.
//!
//! ```text
//!            ┌──────────────────────────────────────────────┐
//!            ▼ ±ux on a Y pulse                             │
//!         jvx ──► + ──► jrx    carry ──► dx ──► x, ex ──┐   │
//!                 ▲──────┘                              ▼   │
//!         jvy ──► + ──► jry    carry ──► dy ──► y, ey ──┼───┘
//!          ▲      ▲──────┘                              │
//!          └── ±uy on an X pulse ───────────────────────┘
//! ```
//!
//! | register | ellipse x²/a² + y²/b² = 1, hyperbola | parabola y² = cx |
//! |---|---|---|
//! | jvx | integrand J_VX = a²·abs(y) | 2·abs(y) |
//! | jvy | integrand J_VY = b²·abs(x) | c |
//! | jrx, jry | remainders J_R: the preset | |
//! | ux | a², the correction of jvx by a Y pulse | 2 |
//! | uy | b², the correction of jvy by an X pulse | 0 |
//! | jvm | when normalised: the greatest of J_V, ux, uy in the sector | |
//! | ex, ey | steps of each axis in the sector (`per-axis`) | |
//! | e | steps of both axes in the sector (`total`) | |
//!
//! On every iteration both integrators add with the old J_V; a pulse of one axis corrects the integrand of the other:
//! upward where its coordinate grows, downward where it shrinks. On an ellipse one coordinate grows and the other shrinks,
//! on an open curve both grow, or on the way back both shrink. An exhausted axis stops adding and freezes its remainder.
//! A hyperbola whose branch runs along y has a and b, and a parabola that opens along y has x and y changed over. What
//! grows and where the axes run are load words (`x_grows`, `y_grows`, `sx`, `sy`), so that one machine runs every conic,
//! mirrored or not. The loader splits an ellipse where it meets its axes, and the others at their vertex.
//!
//! 2^n must be greater than every J_V on the arc. An integrand may grow from 0 to a²·b, however small the other is;
//! so normalised, all of them and their corrections are shifted left until the greatest of the sector, which the loader
//! knows, has its top bit set.
//!
//! Textbooks print in row k of their tables the J_V that step k used; here it is the J_V after step k. `run --textbook`
//! prints the table as they do.
//!
//! Limits of the method itself: the path may leave the curve by more than one BLU (on quarter ellipses of semi-axes
//! below 30 by up to 2.13 with the preset zero, 1.17 with half, 2.07 with full); with a preset of full, seldom with
//! zero, the motion can stop before an axis or a vertex, where J_V is 0 already (with `half`, the default, it was never seen
//! to on a curve whose ends lie on it); and the counter `total` may miss the end.
//!
//! The quarter of the ellipse with semi-axes 6 and 4 from (6, 0) to (0, 4) with `--preset zero`, from the golden
//! file `waves/dda-conic-ellipse.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/dda-conic-ellipse.csv")]
//! ```

use stepwave_nc::{Conic, ConicSector};
use stepwave_netlist::dsl::Scope;

use crate::docs::INTEGRATED_END_POINT;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{NORMALIZE, ON_OVERFLOW, PRESET, Preset, WIDTH};
use crate::parts::{Block, E, END, IntegratorPair, JR, JV, Normalizer, POSITION, PairSide, SIGN, shifted_left};
use crate::plan::Plan;
use crate::registers::{AS_NEEDED, N, Reg, Rule, With};
use crate::sizes;
use crate::words::{self, GROWS};

const UX_UY: Reg<2> = Reg::each(["ux", "uy"], AS_NEEDED, "corrections of jvx by a Y, of jvy by an X pulse")
    .follows(|plan| plan.get(&NORMALIZE));
const JVM: Reg =
    Reg::new("jvm", N, "greatest integrand or correction of the sector").scaled().inner().when(&NORMALIZED);
static NORMALIZED: With<bool> = With(&NORMALIZE, |normalize| *normalize);

/// Digital differential analyser, ellipse, parabola, hyperbola.
pub static MODEL: Model = Model {
    name: "dda-conic",
    title: "Digital differential analyser, ellipse, parabola, hyperbola",
    method: "digital differential analyser",
    source: "数字积分法 for curves of second order, as in Chinese NC textbooks",
    registers: &[
        &(
            JV.about("integrands J_VX = a²|y|, J_VY = b²|x|; parabola 2|y|, c"),
            JR.about("remainders J_R, from the preset"),
        ),
        &UX_UY,
        &JVM,
        &END.width(AS_NEEDED).about("end-point down-counter of each axis"),
        &E.width(Rule::Planned("as it needs")).about("end-point down-counter of both axes"),
        &POSITION,
    ],
    options: &[
        &WIDTH,
        &PRESET.about("half (default) | zero | full | N, or jrx=N,jry=N"),
        &NORMALIZE,
        &INTEGRATED_END_POINT,
        &ON_OVERFLOW,
    ],
    claims: None,
    interpolates: Interpolates::Conics(Method { plan, load }),
    hardware,
};

/// The integrands J_VX and J_VY at a point: what weighs a pulse of the other axis.
fn integrands(conic: &Conic, [x, y]: [i64; 2]) -> [i128; 2] {
    let [of_x, of_y] = conic.weights();
    [of_y.at(y.abs()), of_x.at(x.abs())]
}

/// Their corrections by a pulse of the other axis.
fn corrections(conic: &Conic) -> [i128; 2] {
    let [of_x, of_y] = conic.weights();
    [of_y.slope, of_x.slope]
}

fn plan(conic: &Conic, plan: &mut Plan) -> Result<(), ModelError> {
    plan.usual_preset(Preset::Half);
    let size = sizes::ConicSize::of(conic, |weight, at| weight.at(at).max(weight.slope));
    plan.n = plan.bits_or(sizes::needed(size.greatest));
    plan.set(UX_UY.of(0), size.slopes[1]).set(UX_UY.of(1), size.slopes[0]);
    plan.set(E, size.steps + 1).set_each(END, size.steps).positions(size.positions);
    plan.integrators(1)?;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, hardware.get(&NORMALIZE));
    let pair = IntegratorPair::new(m, &block, hardware);

    // What shifts along has the width of the integrands.
    let bits = |own: Reg| hardware.bits(if hardware.get(&NORMALIZE) { JV.of(0) } else { own });
    let [ux, uy] = [0, 1].map(|axis| UX_UY.of(axis)).map(|own| m.reg(own.name(), bits(own)));
    let greatest = hardware.get(&NORMALIZE).then(|| m.reg(JVM.name(), bits(JVM)));
    let normalized = normalizer.close(&greatest.map(|greatest| greatest.q).into_iter().collect::<Vec<_>>(), 1);
    for (own, register) in [(UX_UY.of(0), Some(ux)), (UX_UY.of(1), Some(uy)), (JVM, greatest)] {
        let Some(register) = register else { continue };
        let shifted = shifted_left(m, register.q);
        register.when(block.load, block.word(own.name(), bits(own))).when(normalized.shift, shifted).else_hold();
    }

    // A pulse of an axis raises the integrand of the other where its own coordinate grows.
    let [x_grows, y_grows] = [0, 1].map(|axis| hardware.held(m, &block, GROWS.of(axis)));
    let x = PairSide { negative: hardware.held(m, &block, SIGN.of(0)), raised: y_grows, unit: ux.q };
    let y = PairSide { negative: hardware.held(m, &block, SIGN.of(1)), raised: x_grows, unit: uy.q };
    let last = pair.close(hardware, normalized, [x, y]);
    block.close(normalized.ready, normalized.run, last);
}

fn load(conic: &Conic, hardware: &Hardware) -> Vec<Words> {
    let units = corrections(conic);
    let block = |sector: &ConicSector| {
        let start = integrands(conic, sector.start);
        let mut own = words::integrators(hardware, start);
        if hardware.get(&NORMALIZE) {
            // Each integrand is greatest at one of the ends.
            let all = [start, integrands(conic, sector.end), units];
            own = own.set(JVM, all.into_iter().flatten().max().unwrap_or(0));
        }
        let end = words::end_counters(hardware, sector.steps());
        own.set_each(UX_UY, units).and(end).and(words::conic_sector(conic, sector))
    };
    conic.sectors().iter().map(block).collect()
}
