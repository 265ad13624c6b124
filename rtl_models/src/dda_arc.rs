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
//! Two limits of the method itself: the motion can stop for good one pulse before an axis, where J_V is 0 already: with
//! unequal presets, and on arcs whose end lies off their circle. With both presets `half`, the default, or `zero` it is
//! proved to end where both ends of a sector lie on the circle. And the counter `total` may miss the end.
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
use crate::options::{END_POINT, EndPoint, NORMALIZE, ON_OVERFLOW, PRESET, Preset, WIDTH};
use crate::parts::{ArcKind, Block, E, END, IntegratorPair, JR, JV, Normalizer, POSITION, QUAD, shifted_left};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::{sizes, words};
use stepwave_netlist::formula::{Clause, Formula, name, number};

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
    claims: Some(Claims { rank, ends, ..Claims::of(Region::QuadrantArcs) }),
    interpolates: Interpolates::Arcs(Method { plan, load }),
    hardware,
};

/// Where the remainders begin, if it is known that a block then ends: both at a half or both at 0, with counters that stop
/// each axis.
fn ends_from(hardware: &Hardware) -> Option<Preset> {
    let [x, y] = hardware.presets[..] else { return None };
    let known = x == y && [Preset::Half, Preset::Zero].contains(&x);
    (known && hardware.get(&END_POINT) == EndPoint::PerAxis && !hardware.get(&NORMALIZE)).then_some(x)
}

/// What the remainders and the ends of both axes want of pulses.
fn rank(hardware: &Hardware) -> Option<Formula> {
    let left = END.of(0).value() + END.of(1).value() + 2;
    ends_from(hardware).map(|_| left * name("2^k") - JR.of(0).value() - JR.of(1).value())
}

/// The axis that shrinks is not at 0 before the other one has come to its end. With s and g the coordinates that shrink and
/// grow, R_s and R_g the remainders of their axes and N = 2^k, the number
///
/// N(s² + g² - R²) - s(2R_s - N) + g(2R_g - N)
///
/// is 0 at first, if both remainders are N/2 then, and N(s - g) if both are 0. Without a pulse it stays: R_s gains g
/// and R_g gains s. A pulse of an axis adds twice the remainder that it leaves, and of the axis that has stopped, which is the
/// one that shrinks, nothing is taken. So it is never below its first value, and remainders from 0 to N-1 leave
/// s² + g² + s + g >= R², or R² + s - g of the start: at s = 0 this wants the end of g.
fn ends(hardware: &Hardware) -> Vec<Clause> {
    let Some(preset) = ends_from(hardware) else { return Vec::new() };
    // The second of two where |x| grows, else the first.
    let of = |still: Formula, grown: Formula| grown * name("x_grows") + still.clone() - still * name("x_grows");
    let pair = |[x, y]: [Formula; 2]| (of(y.clone(), x.clone()), of(x, y));
    // |x| is J_VY, |y| is J_VX.
    let (g, s) = pair([JV.of(1).value(), JV.of(0).value()]);
    let (r_g, r_s) = pair([JR.of(0).value(), JR.of(1).value()]);
    let (left, _) = pair([END.of(0).value(), END.of(1).value()]);
    let (g_first, s_first) = pair([name("xs"), name("ys")]);
    let modulus = || name("2^k");
    let first = if preset == Preset::Zero { s_first - g_first } else { number(0) };
    let off = s.clone() * s.clone() + g.clone() * g.clone() - name("xt") * name("xt") - name("yt") * name("yt") - first;
    let beyond = modulus() * off.clone() - s.clone() * (2 * r_s - modulus()) + g.clone() * (2 * r_g - modulus());
    vec![
        Clause::at_least_zero("an axis has not ended", END.of(0).value() + END.of(1).value() - 1),
        Clause::either("remainders push the arc outwards", [beyond, -left.clone()]),
        Clause::either("the arc is left by less than a pulse inwards", [off + s + g, -left]),
    ]
}

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
