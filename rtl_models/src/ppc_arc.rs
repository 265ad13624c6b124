//! `ppc-arc`: point-by-point comparison (逐点比较法), arc.
//!
//! ```text
//!   quad, ccw ──► kind ──► which axis shrinks, directions
//!                   │
//!   xi ──┐          ▼                    ┌──► dx, dy ──► x, y
//!   yi ──┴─ 2c±1 ── ± ──► F ──► judge ───┼──► xi ± 1, yi ± 1
//!                   ▲────────────┘       └──► e (ex, ey) ──► done
//! ```
//!
//! | register | width | load value |
//! |---|---|---|
//! | xi, yi | n | abs(x), abs(y) relative to the centre |
//! | f | n+2, two's complement | 0; behind a split x² + y² - R² |
//! | quad | 2 | quadrant that the motion enters, Q1 = 0 |
//! | ccw | 1 | 1: counter-clockwise (NR) |
//! | e | n+3 | steps to the end, across axes up to the path's extremes and back (`total`) |
//! | ex, ey | n | steps of each axis to the end or to the next axis (`per-axis`) |
//!
//! F >= 0 steps the axis whose coordinate c shrinks, F -= 2c - 1; F < 0 steps the other, F += 2c + 1, with c before the
//! step. Where the shrinking coordinate stands at 0 the judge beat turns to the next quadrant (but not in the centre,
//! which R = 1 passes through). With `per-axis` the loader splits the arc at the axes, and an exhausted axis hands its
//! step to the other, so that an end point beside the circle is reached too.
//!
//! F stays within [-(2R-1), 2·ceil(R)], so n+2 bits; the radial error within [-1, +1) BLU.
//!
//! The arc NR1 from (6, 0) to (0, 6), from the golden file `waves/ppc-arc-nr1.csv`; the wave stands beside it:
//!
//! ```text
#![doc = include_str!("../../waves/ppc-arc-nr1.csv")]
//! ```

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::Module;
use stepwave_nc::{Arc, Crossing, Curve, Direction, Sector};

use crate::choices::{Choice, Choices, EndPoint};
use crate::error::ModelError;
use crate::hardware::{Hardware, Widths};
use crate::machine::Words;
use crate::model::{ChoiceDoc, CurveKind, Model, RegisterDoc};
use crate::parts::{
    BeatRing, Block, DeviationAccumulator, DownCounter, Kind, axis_counter, next_quadrant, quadrant_register,
    up_down_counter, x_grows,
};
use crate::plan;

const NAME: &str = "ppc-arc";

pub(crate) const MODEL: Model = Model {
    name: NAME,
    title: "Point-by-point comparison, arc",
    method: "point-by-point comparison",
    curve: CurveKind::Arc,
    registers: &[
        RegisterDoc { name: "f", width: "n+2", about: "deviation F, two's complement, from 0" },
        RegisterDoc { name: "xi, yi", width: "n", about: "|x|, |y| relative to the centre" },
        RegisterDoc { name: "quad", width: "2", about: "quadrant of the step, Q1 = 0 … Q4 = 3" },
        RegisterDoc { name: "e", width: "n+3", about: "end-point down-counter (total)" },
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counter of each axis (per-axis)" },
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" },
    ],
    choices: &[
        ChoiceDoc { choice: Choice::Width, values: "N or REGISTER=N,… (default: the least that holds the arc)" },
        ChoiceDoc {
            choice: Choice::EndPoint,
            values: "total (default where the end point is on the circle) | per-axis (default elsewhere)",
        },
        ChoiceDoc { choice: Choice::Beats, values: "4 (default) | 1" },
        ChoiceDoc { choice: Choice::OnOverflow, values: "trap (default) | saturate | wrap" },
    ],
    source: "逐点比较法, the circular interpolator of early NC systems, as in Chinese NC textbooks",
    plan,
    netlist,
    words,
};

fn plan(curve: &Curve, choices: &Choices) -> Result<Hardware, ModelError> {
    let on_circle = plan::arc(curve).is_some_and(Arc::ends_on_circle);
    let end_point = plan::end_point(
        NAME,
        choices,
        if on_circle { EndPoint::Total } else { EndPoint::PerAxis },
        &[EndPoint::Total, EndPoint::PerAxis],
        "the longest axis of an arc may arrive while the other still has steps to go, and iterations are not counted",
    )?;
    let sectors = plan::arc(curve).map(|arc| arc.sectors(Crossing::PathExtreme)).unwrap_or_default();
    let n = plan::magnitude_bits(choices, plan::largest_coordinate(&sectors));
    let mut widths = Widths::new(NAME, choices);
    widths.register("f", n + 2).register("xi", n).register("yi", n);
    match end_point {
        EndPoint::PerAxis => widths.register("ex", n).register("ey", n),
        _ => widths.register("e", n + 3),
    };
    let mut table = widths.names();
    table.insert(3, "quad".to_owned());
    for (axis, letter) in ["x", "y"].into_iter().enumerate() {
        let positions = plan::arc(curve).map(|arc| plan::sector_positions(arc, &sectors, axis));
        widths.register(letter, plan::position_bits(positions.unwrap_or_default()));
    }
    Ok(Hardware {
        model: NAME,
        axes: 2,
        widths: widths.resolve()?,
        presets: Vec::new(),
        normalize: false,
        end_point,
        form: choices.form.unwrap_or_default(),
        beats: choices.beats.unwrap_or_default(),
        on_overflow: choices.on_overflow.unwrap_or_default(),
        table,
        stall_clocks: 16,
        error_bound: Some(1.0),
    })
}

fn netlist(hardware: &Hardware) -> Result<Netlist, ModelError> {
    let module = Module::with_overflow("ppc_arc", hardware.on_overflow);
    let m = module.top();
    let bits = |name: &str| hardware.bits(name);
    let block = Block::new(m);
    let beat = BeatRing::new(m, hardware.beats, block.busy);
    let f = DeviationAccumulator::new(m, bits("f"));
    let (xi, yi) = (m.reg("xi", bits("xi")), m.reg("yi", bits("yi")));
    let quad = quadrant_register(m);
    let ccw = block.held(m, "ccw", 1);
    let counter = |name: &str| DownCounter::new(m, &block, name, bits(name));

    // Judge. A shrinking coordinate at 0 means that the axis is reached: the next quadrant takes over, unless the loader
    // splits the arc there.
    let per_axis = (hardware.end_point == EndPoint::PerAxis).then(|| (counter("ex"), counter("ey")));
    let q = m.scope("quadrant");
    let entered = if per_axis.is_some() {
        quad.q
    } else {
        let (x_zero, y_zero) = (xi.q.is_zero(), yi.q.is_zero());
        let cross = q.name("cross", x_grows(quad.q, ccw).mux(y_zero & !x_zero, x_zero & !y_zero));
        cross.mux(next_quadrant(q, quad.q, ccw), quad.q)
    };
    quad.when(block.load, block.word("quad", 2)).when(beat.judge, entered).else_hold();
    // Behind the judge beat `entered` is `quad` itself, until the coordinates change.
    let kind = Kind::decode(q, entered, ccw);
    let grow_x = !f.not_negative() & kind.x_grows | f.not_negative() & !kind.x_grows;
    let take_x = match per_axis {
        Some((ex, ey)) => grow_x & ex.running() | !ey.running(),
        None => grow_x,
    };
    let take_x = beat.decided("take_x", take_x);

    // Feed.
    axis_counter(m.scope("axis_x"), &block, "x", bits("x"), beat.feed & take_x, kind.x_negative);
    axis_counter(m.scope("axis_y"), &block, "y", bits("y"), beat.feed & !take_x, kind.y_negative);

    // Compute: 2c+1 is c with a 1 behind it, 2c-1 is c-1 with a 1 behind it.
    let grows = m.name("grows", !(take_x ^ kind.x_grows));
    let wide = bits("xi").max(bits("yi"));
    let c = take_x.mux(xi.q.extend(wide), yi.q.extend(wide));
    let c_less = c.wrapping_sub(m.lit(wide, 1));
    let operand = m.name("operand", grows.mux(c, c_less).concat(m.lit(1, 1)));
    f.close(&block, beat.compute, !grows, operand);
    for (coordinate, name, taken) in [(xi, "xi", take_x), (yi, "yi", !take_x)] {
        let count = beat.compute & taken;
        let load = [(block.load, block.word(name, bits(name)))];
        up_down_counter(coordinate, &load, count & grows, count & !grows, m.lit(1, 1));
    }

    // Compare.
    let last = match per_axis {
        Some((ex, ey)) => ex.count(beat.compare & take_x) & ey.count(beat.compare & !take_x),
        None => counter("e").count(beat.compare),
    };
    beat.close(&block, last);
    block.close(block.load, beat.compare, last);
    Ok(module.finish()?)
}

fn words(hardware: &Hardware, curve: &Curve) -> Vec<Words> {
    let Some(arc) = plan::arc(curve) else { return Vec::new() };
    let sectors = arc.sectors(Crossing::PathExtreme);
    let begin = |sector: &Sector| -> Words {
        let [x, y] = sector.start.map(i128::from);
        vec![
            ("f", x * x + y * y - arc.radius_squared()),
            ("xi", x.abs()),
            ("yi", y.abs()),
            ("quad", i128::from(sector.quadrant.index())),
            ("ccw", i128::from(arc.direction() == Direction::CounterClockwise)),
            ("x", i128::from(arc.center()[0]) + x),
            ("y", i128::from(arc.center()[1]) + y),
        ]
    };
    if hardware.end_point == EndPoint::PerAxis {
        let block = |sector: &Sector| {
            let [ex, ey] = sector.steps().map(i128::from);
            [begin(sector), vec![("ex", ex), ("ey", ey)]].concat()
        };
        return sectors.iter().map(block).collect();
    }
    // The hardware crosses the axes by itself: one block, counted to its end.
    let steps: i128 = sectors.iter().flat_map(Sector::steps).map(i128::from).sum();
    sectors.first().map(|first| [begin(first), vec![("e", steps)]].concat()).into_iter().collect()
}
