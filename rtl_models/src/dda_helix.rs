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
//! | register | width | load value |
//! |---|---|---|
//! | jvx, jvy | n | integrands J_VX = abs(y), J_VY = abs(x) relative to the centre |
//! | jrx, jry | n | remainders J_R: the preset |
//! | jvz | n+8 | integrand J_VZ = abs(Z)/θ with a fraction of 8 bits, rounded up |
//! | jrz | n+8 | remainder J_R: the preset |
//! | quad | 2 | quadrant of the sector, Q1 = 0 |
//! | ex, ey | n | steps of each axis in the sector |
//! | ez | n+1 | steps of z in the sector |
//!
//! An iteration turns the circle pair by 1/2^n radian, so z makes J_VZ/2^n = Z/θ of its way per radian, θ being the angle
//! of the whole helix. The pair is that of `dda-arc`: it corrects J_VX and J_VY by ±1, and the loader splits the helix
//! where its arc meets the axes. Up to there z makes its share of Z, rounded to the nearest step; an exhausted axis stops
//! adding, a sector ends when all three are exhausted, and so x, y and z are exact at its end. Where a sector's share was
//! rounded up, the arc waits for z there.
//!
//! 2^n must be greater than the largest coordinate and than Z/θ. The fraction has the bits that jrz is wider than jrx
//! (`--width jrz=N`): with f of them z errs by less than θ/2^f BLU.
//!
//! Textbooks print in row k of their tables the J_V that step k used; here it is the J_V after step k. `run --textbook`
//! prints the table as they do.
//!
//! Limits are those of `dda-arc`: with a preset of zero or full the motion can come to a stand one pulse before an axis,
//! and then z still arrives.
//!
//! A quarter turn from (5, 0, 0) to (0, 5, 3), from the golden file `waves/dda-helix-quarter.csv`; the wave stands beside
//! it:
//!
//! ```text
#![doc = include_str!("../../waves/dda-helix-quarter.csv")]
//! ```

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::Module;
use stepwave_nc::{Crossing, Curve, Helix};

use crate::choices::{Choice, Choices, EndPoint};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
use crate::parts::{Block, DownCounter, IntegratorPair, Iteration, Kind, Normalizer, axis_counter, integrator};
use crate::registers::Registers;
use crate::{plan, words};

const NAME: &str = "dda-helix";

/// Bits of the fraction of J_VZ, unless the widths say otherwise.
const FRACTION: u32 = 8;

pub(crate) const MODEL: Model = Model {
    name: NAME,
    title: "Digital differential analyser, helix",
    method: "digital differential analyser",
    curve: CurveKind::Helix,
    registers: &[
        RegisterDoc { name: "jvx, jvy", width: "n", about: "integrands J_VX = |y|, J_VY = |x|" },
        RegisterDoc { name: "jrx, jry", width: "n", about: "remainders J_R, from the preset" },
        RegisterDoc { name: "jvz", width: "n+8", about: "integrand J_VZ = |Z|/θ, with a fraction" },
        RegisterDoc { name: "jrz", width: "n+8", about: "remainder J_R of z; as much wider than jrx as the fraction" },
        RegisterDoc { name: "quad", width: "2", about: "quadrant of the sector, Q1 = 0 … Q4 = 3" },
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counters of x and y" },
        RegisterDoc { name: "ez", width: "n+1", about: "end-point down-counter of z" },
        RegisterDoc { name: "x, y, z", width: "as the path needs, + 1", about: "machine position, signed" },
    ],
    choices: &[
        ChoiceDoc::WIDTH,
        ChoiceDoc { choice: Choice::Preset, values: "zero (default) | half | full | N, or jrx=N,jry=N,jrz=N" },
        ChoiceDoc::ON_OVERFLOW,
    ],
    source: "数字积分法: the DDA circular interpolator with a third integrator for the linear axis",
    claims: None,
    plan,
    netlist,
    words,
};

/// Steps of z per radian in units of 2^-`fraction`, rounded up.
fn rate(helix: &Helix, fraction: u32) -> i128 {
    #[expect(clippy::cast_precision_loss, reason = "at most 2^53, which f64 holds exactly")]
    let way = helix.z_way().abs() as f64;
    #[expect(clippy::cast_possible_truncation, reason = "rounded; a cast saturates")]
    let rate = (way / helix.angle() * 2f64.powi(fraction.cast_signed())).ceil() as i128;
    rate
}

fn plan(curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
    let helix = plan::helix(curve);
    let plane = helix.map(|helix| Curve::Arc(*helix.arc()));
    let sectors = helix.map(|helix| helix.arc().sectors(Crossing::RoundedRadius)).unwrap_or_default();
    // J_VZ without its fraction.
    let steepest = helix.map_or(0, |helix| u64::try_from(rate(helix, FRACTION) >> FRACTION).unwrap_or(u64::MAX));
    let n = plan::magnitude_bits(choices, plan::largest_coordinate(&sectors).max(steepest));
    let mut registers = Registers::new(NAME, choices);
    for register in ["jvx", "jrx", "jvy", "jry"] {
        registers.register(register, n);
    }
    registers.register("jvz", n + FRACTION).register("jrz", n + FRACTION);
    registers.shown("quad").end_counters(2, n).register("ez", n + 1);
    let z = plan::end_positions(curve).nth(2);
    registers.positions(plane.iter().flat_map(|plane| plan::arc_positions(plane, &sectors)).chain(z));
    registers.integrators_with_fraction(3, 2, EndPoint::PerAxis, 1)
}

fn netlist(hardware: &Hardware) -> Result<Netlist, ModelError> {
    let module = Module::with_overflow("dda_helix", hardware.on_overflow);
    let m = module.top();
    let block = Block::new(m);
    let normalized = Normalizer::new(m, &block, false).close(&[], 1);
    let kind = Kind::held(m, &block);
    let pair = IntegratorPair::new(m, &block, hardware);
    let last_in_plane = pair.close(hardware, normalized, kind.pair_sides(m.name("unit", m.lit(1, 1))));

    let z = m.scope("axis_z");
    let jvz = block.held(z, "jvz", hardware.bits("jvz"));
    let ez = DownCounter::new(z, &block, "ez", hardware.bits("ez"));
    let step = Iteration::new(m, &block, hardware, normalized.run).only(ez.running());
    let pulse = integrator(z, &block, hardware, 2, jvz, step);
    axis_counter(z, &block, "z", hardware.bits("z"), pulse, block.held(z, "sz", 1));
    block.close(normalized.ready, normalized.run, last_in_plane & ez.count(pulse));
    Ok(module.finish()?)
}

fn words(hardware: &Hardware, curve: &Curve) -> Vec<Words> {
    let Some(helix) = plan::helix(curve) else { return Vec::new() };
    let jvz = rate(helix, hardware.fraction("jvz"));
    let mut made = 0;
    let mut blocks = Vec::new();
    for sector in helix.sectors() {
        let mut words = words::integrated_sector(hardware, helix.arc(), &sector.plane);
        words.extend([
            ("jvz", jvz),
            ("jrz", hardware.preset(2, "jrz")),
            ("ez", i128::from(sector.z_steps - made)),
            ("sz", i128::from(helix.z_way() < 0)),
            ("z", i128::from(helix.from()[2])),
        ]);
        blocks.push(words);
        made = sector.z_steps;
    }
    blocks
}
