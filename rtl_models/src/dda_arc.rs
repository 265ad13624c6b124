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
//! Two limits of the method itself: with a preset of zero or full the motion can come to a stand one pulse before an
//! axis, where J_V is 0 already (the preset `half` was never seen to); and the counter `total` may miss the end.
//!
//! The arc NR1 from (5, 0) to (0, 5) in 3 bits, from the golden file `waves/dda-arc-nr1.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../../waves/dda-arc-nr1.csv")]
//! ```

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::Module;
use stepwave_nc::{Crossing, Curve, Direction, Sector};

use crate::choices::{Choice, Choices, EndPoint};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
use crate::parts::{
    Block, DownCounter, Kind, Normalizer, axis_counter, integrator, population_count, quadrant_register, shifted_left,
    up_down_counter,
};
use crate::plan;
use crate::registers::Registers;

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
        ChoiceDoc { choice: Choice::Preset, values: "zero (default) | half | full | N, or jrx=N,jry=N" },
        ChoiceDoc { choice: Choice::Normalize, values: "left-shift normalisation (default: none)" },
        ChoiceDoc { choice: Choice::EndPoint, values: "per-axis (default) | total" },
        ChoiceDoc { choice: Choice::OnOverflow, values: "trap (default) | saturate | wrap" },
    ],
    source: "数字积分法, the DDA circular interpolator of early NC systems, as in Chinese NC textbooks",
    plan,
    netlist,
    words,
};

fn plan(curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
    let end_point = plan::end_point(
        NAME,
        choices,
        EndPoint::PerAxis,
        &[EndPoint::PerAxis, EndPoint::Total],
        "the longest axis of an arc may arrive while the other still has steps to go, and iterations say nothing of \
         where an arc stands",
    )?;
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
    let bits = |name: &str| hardware.bits(name);
    let block = Block::new(m);
    let normalizer = Normalizer::new(m, &block, hardware.normalize);
    let ccw = block.held(m, "ccw", 1);
    let quad = quadrant_register(m);
    quad.when(block.load, block.word("quad", 2)).else_hold();
    let kind = Kind::decode(m.scope("quadrant"), quad.q, ccw);
    let (sx, sy) = (m.scope("axis_x"), m.scope("axis_y"));
    let (jvx, jvy) = (sx.reg("jvx", bits("jvx")), sy.reg("jvy", bits("jvy")));
    let wide = bits("jvx").max(bits("jvy"));
    let normalized = normalizer.close(&[jvx.q.extend(wide), jvy.q.extend(wide)], wide.min(2));
    let unit = if hardware.normalize {
        let unit = m.reg("unit", wide);
        unit.when(block.load, m.lit(wide, 1)).when(normalized.shift, shifted_left(m, unit.q)).else_hold();
        unit.q
    } else {
        m.name("unit", m.lit(1, 1))
    };

    // An exhausted axis stops adding.
    let per_axis = (hardware.end_point == EndPoint::PerAxis)
        .then(|| (DownCounter::new(sx, &block, "ex", bits("ex")), DownCounter::new(sy, &block, "ey", bits("ey"))));
    let run = normalized.run;
    let (step_x, step_y) = per_axis.map_or((run, run), |(ex, ey)| (run & ex.running(), run & ey.running()));
    let pulse_x = integrator(sx, &block, "x", bits("jrx"), jvx.q, step_x);
    let pulse_y = integrator(sy, &block, "y", bits("jry"), jvy.q, step_y);
    axis_counter(sx, &block, "x", bits("x"), pulse_x, kind.x_negative);
    axis_counter(sy, &block, "y", bits("y"), pulse_y, kind.y_negative);

    // A Y pulse changes |y|, which is J_VX; an X pulse changes |x|, which is J_VY.
    for (scope, jv, name, pulse, grows) in
        [(sx, jvx, "jvx", pulse_y, !kind.x_grows), (sy, jvy, "jvy", pulse_x, kind.x_grows)]
    {
        let loads = [(block.load, block.word(name, bits(name))), (normalized.shift, shifted_left(scope, jv.q))];
        up_down_counter(jv, &loads, pulse & grows, pulse & !grows, unit);
    }

    let last = match per_axis {
        Some((ex, ey)) => ex.count(pulse_x) & ey.count(pulse_y),
        None => DownCounter::new(m, &block, "e", bits("e")).count_pulses(population_count(m, 2, &[pulse_x, pulse_y])),
    };
    block.close(normalized.ready, run, last);
    Ok(module.finish()?)
}

fn words(hardware: &Hardware, curve: &Curve) -> Vec<Words> {
    let Some(arc) = plan::arc(curve) else { return Vec::new() };
    let block = |sector: &Sector| -> Words {
        let [x, y] = sector.start.map(i128::from);
        let [ex, ey] = sector.steps().map(i128::from);
        let mut words = vec![
            ("jvx", y.abs()),
            ("jvy", x.abs()),
            ("jrx", hardware.preset(0, "jrx")),
            ("jry", hardware.preset(1, "jry")),
            ("quad", i128::from(sector.quadrant.index())),
            ("ccw", i128::from(arc.direction() == Direction::CounterClockwise)),
            ("x", i128::from(arc.center()[0]) + x),
            ("y", i128::from(arc.center()[1]) + y),
        ];
        match hardware.end_point {
            EndPoint::PerAxis => words.extend([("ex", ex), ("ey", ey)]),
            _ => words.push(("e", ex + ey)),
        }
        words
    };
    arc.sectors(Crossing::RoundedRadius).iter().map(block).collect()
}
