//! `dda-arc`: digital differential analyser, DDA (数字积分法), arc.
//!
//! ```text
//!            ┌──────────────────────────────────────────────┐
//!            ▼ ±1 on a Y pulse                              │
//!   jvx = |y| ──► + ──► jrx    carry ──► dx ──► x, ex ──┐   │
//!                 ▲──────┘                              ▼   │
//!   jvy = |x| ──► + ──► jry    carry ──► dy ──► y, ey ──┼───┘
//!        ▲        ▲──────┘                              │
//!        └── ±1 on an X pulse ──────────────────────────┘
//! ```
//!
//! On every iteration both integrators add with the old J_V; a pulse of one axis corrects the integrand of the other.
//! An exhausted axis stops adding and freezes its remainder. The loader splits the arc at the axes, where the
//! coordinate is R rounded to the nearest integer, and loads each sector anew. 2^n must be greater than the largest
//! coordinate.
//!
//! Two limits of the method itself: with a preset of zero or full the motion can stop for good one pulse before an axis,
//! where J_V is 0 already (with `half`, the default, this was only seen on arcs whose end lies off their circle); and the
//! counter `total` may miss the end.
//!
//! Textbooks print in row k of their tables the J_V that step k used; here row k holds every register after step k, so
//! that their J_V is that of row k-1. `run --textbook` prints the table as they do. Their tables begin with remainders of
//! 0: `--preset zero`.
//!
//! The arc NR1 from (5, 0) to (0, 5) in 3 bits with `--preset zero`, from the golden file `waves/dda-arc-nr1.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/dda-arc-nr1.csv")]
//! ```

use stepwave_nc::{Arc, Crossing, Sector};
use stepwave_netlist::dsl::Scope;

use crate::claims::{Claims, Region};
use crate::docs::INTEGRATED_END_POINT;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{NORMALIZE, ON_OVERFLOW, PRESET, Preset, WIDTH};
use crate::parts::{ArcKind, Block, E, END, IntegratorPair, JR, JV, Normalizer, POSITION, QUAD, shifted_left};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::{sizes, words};

/// By how much a pulse changes an integrand.
const UNIT: Reg = Reg::new("unit", N, "correction of an integrand, 2^Q").follows(|_| true);

/// Digital differential analyser, arc.
pub static MODEL: Model = Model {
    name: "dda-arc",
    title: "Digital differential analyser, arc",
    method: "digital differential analyser",
    source: "数字积分法, the DDA circular interpolator of early NC systems, as in Chinese NC textbooks",
    registers: &[
        &(JV.about("integrands J_VX = |y|, J_VY = |x|"), JR.about("remainders J_R, from the preset")),
        &UNIT,
        &QUAD.about("quadrant of the sector, Q1 = 0 … Q4 = 3"),
        &END,
        &E.about("end-point down-counter of both axes"),
        &POSITION,
    ],
    options: &[
        &WIDTH.about("N or REGISTER=N,… (default: the least that holds the arc)"),
        &PRESET.about("half (default) | zero | full | N, or jrx=N,jry=N"),
        &NORMALIZE,
        &INTEGRATED_END_POINT,
        &ON_OVERFLOW,
    ],
    claims: Some(Claims { rank: |_| None, ..Claims::of(Region::QuadrantArcs) }),
    interpolates: Interpolates::Arcs(Method { plan, load }),
    hardware,
};

fn plan(arc: &Arc, plan: &mut Plan) -> Result<(), ModelError> {
    plan.usual_preset(Preset::Half);
    let sectors = arc.sectors(Crossing::RoundedRadius);
    plan.n = plan.magnitude_bits(sizes::largest_coordinate(&sectors));
    plan.positions(sizes::arc_positions(arc, &sectors));
    plan.integrators(1)?;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, hardware.get(&NORMALIZE));
    let kind = ArcKind::held(m, &block);
    let pair = IntegratorPair::new(m, &block, hardware);
    let integrands = pair.integrands();
    let wide = integrands[0].bits();
    let normalized = normalizer.close(&integrands, wide.min(2));
    let unit = if hardware.get(&NORMALIZE) {
        let unit = m.reg(UNIT.name(), wide);
        unit.when(block.load, m.lit(wide, 1)).when(normalized.shift, shifted_left(m, unit.q)).else_hold();
        unit.q
    } else {
        m.name(UNIT.name(), m.lit(1, 1))
    };

    let last = pair.close(hardware, normalized, kind.pair_sides(unit));
    block.close(normalized.ready, normalized.run, last);
}

fn load(arc: &Arc, hardware: &Hardware) -> Vec<Words> {
    let block = |sector: &Sector| words::integrated_sector(hardware, arc, sector);
    arc.sectors(Crossing::RoundedRadius).iter().map(block).collect()
}
