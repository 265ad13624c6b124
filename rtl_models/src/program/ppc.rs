//! The machine of point-by-point comparison (逐点比较法): one accumulator F for lines and arcs.
//!
//! ```text
//!   host ──► next block ──► block                       ┌──► ex, ey ──► end of the block
//!            xi, yi ──┬─ 2c±1 (arc) ─┐                  │
//!                     └─ c (line) ───┴─ ± ──► F ──► judge ──► first or second axis of the plane ──► x, y, z
//!   rate ──► phase ──► step ──────────────────▲─────────┘         └──► third axis follows
//! ```
//!
//! `xi`, `yi` hold the displacements of a line, or count the coordinates of an arc. A line takes F -= yi for a step of its first
//! axis and F += xi for one of the second; an arc F -= 2c - 1 or F += 2c + 1. The loader splits arcs at the axes.

use stepwave_nc::{Crossing, Curve, PulseBlock};
use stepwave_netlist::dsl::Scope;

use super::{HardwareBlock, planar};
use crate::claims::{Claims, Region};
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::Model;
use crate::parts::{DeviationAccumulator, F, XI_YI, judged_by_sign, step_of_circle};
use crate::ppc_line;

/// Where arcs are split.
const CROSSING: Crossing = Crossing::PathExtreme;

/// Point-by-point comparison: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "ppc-machine",
    title: "Point-by-point comparison",
    method: ppc_line::MODEL.method,
    source: ppc_line::MODEL.source,
    registers: planar::JUDGED,
    options: machine_options![],
    claims: Some(Claims::of(Region::LinesAndArcs)),
    interpolates: planar::judging(CROSSING, load, |_, block| Some(planar::bound(block, 1.0))),
    hardware,
};

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let frame = super::frame::plain(m, hardware);
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let [xi, yi] = [0, 1].map(|axis| hardware.reg(m, XI_YI.of(axis)));

    // Judge: F >= 0 takes the first axis of a line, and the one that shrinks on an arc.
    let take_x = judged_by_sign(&f, frame.x_grows);
    let taken = frame.redirected([take_x, !take_x]);
    let take_x = m.name("take_x", taken[0]);

    // Compute.
    let wide = xi.q.bits().max(yi.q.bits());
    let [x, y] = [xi, yi].map(|register| register.q.extend(wide));
    let (grows, gain) = step_of_circle(m, [x, y], take_x, frame.x_grows);
    let other = take_x.mux(y, x).extend(gain.bits());
    f.close(&frame.block, frame.step, !grows, m.name("operand", frame.arc.mux(gain, other)));
    frame.coordinates([(xi, XI_YI.of(0)), (yi, XI_YI.of(1))], taken);

    frame.close(hardware, taken);
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    let pulses = |[a, b]: [i128; 2]| (a + b) as f64;
    planar::blocks(CROSSING, hardware, block, |at| {
        let (f, point) = if let Curve::Line(_) = block.curve { (0, at.pulses) } else { (at.deviation, at.start) };
        (Words::new().set(F, f).set_each(XI_YI, point), pulses(at.pulses))
    })
}
