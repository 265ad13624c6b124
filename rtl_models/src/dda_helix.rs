//! `dda-helix`: digital differential analyser, DDA (数字积分法), helix about an axis parallel to z.
//!
//! ```text
//!   the pair of `dda-arc`:  jvx = |y| ──► jrx ──► dx ──► x, ex
//!                           jvy = |x| ──► jry ──► dy ──► y, ey
//!
//!   jvz = |Z|/θ ──► + ──► jrz    carry ──► dz ──► z, ez
//!    (fraction)     ▲──────┘
//! ```
//!
//! An iteration turns the circle pair by 1/2^n radian, so z makes J_VZ/2^n = Z/θ of its travel per radian, θ being the
//! angle of the whole helix. The pair is that of `dda-arc`: it corrects J_VX and J_VY by ±1, and the loader splits the
//! helix where its arc meets the axes. Up to there z makes its share of Z, rounded to the nearest step; an exhausted
//! axis stops adding, a sector ends when all three are exhausted, and so x, y and z are exact at its end. Where a
//! sector's share was rounded up, the arc waits for z there.
//!
//! 2^n must be greater than the largest coordinate and than Z/θ. The fraction has the bits that jrz is wider than jrx
//! (`--width jrz=N`): with f of them the error of z is less than θ/2^f BLU.
//!
//! Textbooks print in row k of their tables the J_V that step k used; here it is the J_V after step k. `run --textbook`
//! prints the table as they do.
//!
//! Limits are those of `dda-arc`: with a preset of zero or full the motion can stop one pulse before an axis, and then
//! z still arrives; the default is `half`.
//!
//! A quarter turn from (5, 0, 0) to (0, 5, 3) with `--preset zero`, from the golden file
//! `waves/dda-helix-quarter.csv`; the wave is next to it:
//!
//! ```text
#![doc = include_str!("../waves/dda-helix-quarter.csv")]
//! ```

use stepwave_nc::{Crossing, Helix};
use stepwave_netlist::dsl::Scope;

use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::{Interpolates, Method};
use crate::machine::Words;
use crate::model::Model;
use crate::options::{END_POINT, EndPoint, ON_OVERFLOW, PRESET, Preset, WIDTH};
use crate::parts::{
    ArcKind, Block, END, IntegratorPair, Iteration, JR, JV, Normalizer, POSITION, QUAD, SIGN, axis_scope, integrator,
};
use crate::plan::Plan;
use crate::registers::{N, Reg};
use crate::{sizes, words};

/// Bits of the fraction of J_VZ, unless the widths say otherwise.
const FRACTION: u32 = 8;

const JVZ: Reg = JV.of(2).width(N.plus(FRACTION));
const JRZ: Reg = JR.of(2).width(N.plus(FRACTION));
const EZ: Reg = END.of(2).width(N.plus(1));

/// Digital differential analyser, helix.
pub static MODEL: Model = Model {
    name: "dda-helix",
    title: "Digital differential analyser, helix",
    method: "digital differential analyser",
    source: "数字积分法: the DDA circular interpolator with a third integrator for the linear axis",
    registers: &[
        &(JV.pair().about("integrands J_VX = |y|, J_VY = |x|"), JR.pair().about("remainders J_R, from the preset")),
        &JVZ.about("integrand J_VZ = |Z|/θ, with a fraction"),
        &JRZ.about("remainder J_R of z; as much wider than jrx as the fraction"),
        &QUAD.about("quadrant of the sector, Q1 = 0 … Q4 = 3"),
        &END.pair().about("end-point down-counters of x and y"),
        &EZ.about("end-point down-counter of z"),
        &POSITION,
    ],
    options: &[&WIDTH, &PRESET.about("half (default) | zero | full | N, or jrx=N,jry=N,jrz=N"), &ON_OVERFLOW],
    claims: None,
    interpolates: Interpolates::Helices(Method { plan, load }),
    hardware,
};

/// Steps of z per radian in units of 2^-`fraction`, rounded up.
fn rate(helix: &Helix, fraction: u32) -> i128 {
    #[expect(clippy::cast_precision_loss, reason = "at most 2^53, which f64 holds exactly")]
    let travel = helix.z_travel().abs() as f64;
    #[expect(clippy::cast_possible_truncation, reason = "rounded; a cast saturates")]
    let rate = (travel / helix.angle() * 2f64.powi(fraction.cast_signed())).ceil() as i128;
    rate
}

fn plan(helix: &Helix, plan: &mut Plan) -> Result<(), ModelError> {
    plan.usual_preset(Preset::Half);
    let sectors = helix.arc().sectors(Crossing::RoundedRadius);
    // J_VZ without its fraction.
    let steepest = u64::try_from(rate(helix, FRACTION) >> FRACTION).unwrap_or(u64::MAX);
    plan.n = plan.magnitude_bits(sizes::largest_coordinate(&sectors).max(steepest));
    let z = vec![helix.from()[2], helix.to()[2]];
    plan.positions(sizes::arc_positions(helix.arc(), &sectors).into_iter().chain([z]));
    plan.fix(&END_POINT, EndPoint::PerAxis);
    plan.integrators_with_fraction(2, 1)?;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Block::new(m);
    let normalized = Normalizer::new(m, &block, false).close(&[], 1);
    let kind = ArcKind::held(m, &block);
    let pair = IntegratorPair::new(m, &block, hardware);
    let last_in_plane = pair.close(hardware, normalized, kind.pair_sides(m.name("unit", m.lit(1, 1))));

    let z = axis_scope(m, 2);
    let jvz = hardware.held(z, &block, JVZ);
    let ez = hardware.counter(z, &block, EZ);
    let step = Iteration::new(m, &block, hardware, normalized.run).only(ez.running());
    let pulse = integrator(z, &block, hardware, 2, jvz, step);
    hardware.axis(z, &block, 2, pulse, hardware.held(z, &block, SIGN.of(2)));
    block.close(normalized.ready, normalized.run, last_in_plane & ez.count(pulse));
}

fn load(helix: &Helix, hardware: &Hardware) -> Vec<Words> {
    let jvz = rate(helix, hardware.fraction(JVZ.name()));
    let mut made = 0;
    let mut blocks = Vec::new();
    for sector in helix.sectors() {
        let plane = words::integrated_sector(hardware, helix.arc(), &sector.plane);
        let words = plane.set(JVZ, jvz).set(JRZ, hardware.preset(JRZ)).set(EZ, sector.z_steps - made);
        blocks.push(words.set(SIGN.of(2), helix.z_travel() < 0).set(POSITION.of(2), helix.from()[2]));
        made = sector.z_steps;
    }
    blocks
}
