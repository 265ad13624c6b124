//! The machine of comparison-integral (比较积分法): interval weights and F shared by lines and arcs.
//!
//! ```text
//!   host ──► next block ──► block
//!            a, b ──► compare ──► base axis ──┐
//!             ▲       F ──► F >= 0 ───────────┴─► axes taken ──► x, y, z
//!             └───────┴── ± weights ◄─────────────────┴──► ex, ey ──► end of the block
//!   rate ──► phase ──► step
//! ```
//!
//! On an arc a pulse changes the weight of its axis by one, on a line by nothing. The weight of a pulse is the middle of
//! those before and after it.

use stepwave_nc::{Crossing, Curve, PulseBlock};
use stepwave_netlist::dsl::Scope;

use super::frame::MODE;
use super::{HardwareBlock, planar};
use crate::cim_line;
use crate::claims::{Claims, Region};
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::model::Model;
use crate::options::Weights;
use crate::parts::{A_B, BASE, Change, END, F, PLANE, POSITION, QUAD, WHOLE, Weighing};
use crate::registers::{N, Reg, Where};
use crate::words;

/// Where arcs are split.
const CROSSING: Crossing = Crossing::RoundedRadius;

/// The weights where axes of the machine are called a and b.
const WA_WB: Reg<2> = Reg::each(["wa", "wb"], N, "interval weights A of an X, B of a Y pulse")
    .when(&Where("axes other than x, y and z", |plan| plan.axes() > 3));
/// The machine has no axes but x, y and z.
static XYZ_ALONE: Where = Where("axes x, y and z alone", |plan| plan.axes() <= 3);

fn weights(axes: usize) -> Reg<2> {
    if axes > 3 { WA_WB } else { A_B }
}

/// Comparison-integral: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "cim-machine",
    title: "Comparison-integral",
    method: cim_line::MODEL.method,
    source: cim_line::MODEL.source,
    registers: &[&MODE, &PLANE, &QUAD, &F, &A_B.when(&XYZ_ALONE), &WA_WB, &BASE, &END.pair(), &WHOLE, &POSITION],
    options: machine_options![],
    claims: Some(Claims::of(Region::LinesAndArcs)),
    interpolates: planar::judging(CROSSING, load, |_, block| Some(planar::bound(block, 1.0))),
    hardware,
};

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let frame = super::frame::plain(m, hardware);
    let weighing = Weighing::new(m, hardware, weights(hardware.axes));

    // Judge.
    let [take_x, take_y] = frame.redirected(weighing.judged());
    let taken = [m.name("take_x", take_x), m.name("take_y", take_y)];

    // Compute.
    let changes = frame.grows().map(|grows| Some(Change { grows, unit: frame.arc }));
    weighing.close(&frame.block, Weights::Mid, frame.step, taken, changes);

    frame.close(hardware, taken);
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    planar::blocks(CROSSING, hardware, block, |at| {
        let (f, weights) = match block.curve {
            Curve::Line(_) => (0, [at.pulses[1], at.pulses[0]]),
            _ => (words::weighed(Weights::Mid, at.start, at.x_grows, at.deviation), at.start),
        };
        (Words::new().set(F, f).set_each(self::weights(hardware.axes), weights), planar::longest_steps(at))
    })
}
