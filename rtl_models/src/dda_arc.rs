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
//! | register | width | load value |
//! |---|---|---|
//! | jvx, jvy | n | integrands J_VX = abs(y), J_VY = abs(x) relative to the centre |
//! | jrx, jry | n | remainders J_R: the preset |
//! | unit | n | 1; shifted along with the integrands when normalised: 2^Q |
//! | quad | 2 | quadrant of the sector, Q1 = 0 |
//! | ex, ey | n | steps of each axis in the sector (`per-axis`) |
//! | e | n+1 | steps of both axes in the sector (`total`) |
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
#![doc = include_str!("../../waves/dda-arc-nr1.csv")]
//! ```

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::Module;
use stepwave_nc::{Crossing, Curve, Sector};

use crate::choices::{Choice, Choices, EndPoint, Preset};
use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
use crate::parts::{Block, IntegratorPair, Kind, Normalizer, shifted_left};
use crate::registers::Registers;
use crate::{plan, words};

const NAME: &str = "dda-arc";

pub(crate) const MODEL: Model = Model {
    name: NAME,
    title: "Digital differential analyser, arc",
    method: "digital differential analyser",
    curve: CurveKind::Arc,
    registers: &[
        RegisterDoc { name: "jvx, jvy", width: "n", about: "integrands J_VX = |y|, J_VY = |x|" },
        RegisterDoc { name: "jrx, jry", width: "n", about: "remainders J_R, from the preset" },
        RegisterDoc { name: "unit", width: "n", about: "correction of an integrand, 2^Q" },
        RegisterDoc { name: "quad", width: "2", about: "quadrant of the sector, Q1 = 0 … Q4 = 3" },
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counter of each axis (per-axis)" },
        RegisterDoc { name: "e", width: "n+1", about: "end-point down-counter of both axes (total)" },
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" },
    ],
    choices: &[
        ChoiceDoc { choice: Choice::Width, values: "N or REGISTER=N,… (default: the least that holds the arc)" },
        ChoiceDoc { choice: Choice::Preset, values: "half (default) | zero | full | N, or jrx=N,jry=N" },
        ChoiceDoc { choice: Choice::Normalize, values: "left-shift normalisation (default: none)" },
        ChoiceDoc { choice: Choice::EndPoint, values: "per-axis (default) | total" },
        ChoiceDoc { choice: Choice::OnOverflow, values: "trap (default) | saturate | wrap" },
    ],
    source: "数字积分法, the DDA circular interpolator of early NC systems, as in Chinese NC textbooks",
    claims: Some(Claims { rank: |_| None, ..Claims::of(Region::QuadrantArcs) }),
    plan,
    netlist,
    words,
};

fn plan(curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
    let choices = &Choices { preset: Some(choices.preset.unwrap_or(Preset::Half)), ..choices.clone() };
    let end_point = plan::integrated_end_point(NAME, choices)?;
    let sectors = plan::arc(curve).map(|arc| arc.sectors(Crossing::RoundedRadius)).unwrap_or_default();
    let n = plan::magnitude_bits(choices, plan::largest_coordinate(&sectors));
    let mut registers = Registers::new(NAME, choices);
    for register in ["jvx", "jrx", "jvy", "jry"] {
        registers.register(register, n);
    }
    registers.shown("unit").shown("quad");
    match end_point {
        EndPoint::PerAxis => registers.end_counters(2, n),
        _ => registers.register("e", n + 1),
    };
    registers.positions(plan::arc_positions(curve, &sectors));
    registers.integrators(2, end_point, 1)
}

fn netlist(hardware: &Hardware) -> Result<Netlist, ModelError> {
    let module = Module::with_overflow("dda_arc", hardware.on_overflow);
    let m = module.top();
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, hardware.normalize);
    let kind = Kind::held(m, &block);
    let pair = IntegratorPair::new(m, &block, hardware);
    let integrands = pair.integrands();
    let wide = integrands[0].bits();
    let normalized = normalizer.close(&integrands, wide.min(2));
    let unit = if hardware.normalize {
        let unit = m.reg("unit", wide);
        unit.when(block.load, m.lit(wide, 1)).when(normalized.shift, shifted_left(m, unit.q)).else_hold();
        unit.q
    } else {
        m.name("unit", m.lit(1, 1))
    };

    let last = pair.close(hardware, normalized, kind.pair_sides(unit));
    block.close(normalized.ready, normalized.run, last);
    Ok(module.finish()?)
}

fn words(hardware: &Hardware, curve: &Curve) -> Vec<Words> {
    let Some(arc) = plan::arc(curve) else { return Vec::new() };
    let block = |sector: &Sector| words::integrated_sector(hardware, arc, sector);
    arc.sectors(Crossing::RoundedRadius).iter().map(block).collect()
}
