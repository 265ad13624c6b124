//! The machine of minimum deviation (最小偏差法): one accumulator F for lines and arcs.
//!
//! ```text
//!   host ──► next block ──► block
//!            xi, yi ──┬─ gains of x², y² (arc) ─► F1, F2, F3 ─► least |F| ─┐
//!                     └─ 2S, 2(S - L) (line) ──────────────────────────────┴─► F ─► axes taken ──► x, y, z
//!   rate ──► phase ──► step                                                          └──► ex, ey ──► end of the block
//! ```
//!
//! `xi`, `yi` hold the displacements of a line, or count the coordinates of an arc. F is D = 2S - L of a line, or x² + y² - R².

use stepwave_nc::{Crossing, Curve, PulseBlock};
use stepwave_netlist::dsl::Scope;

use super::{HardwareBlock, planar};
use crate::claims::{Claims, Region};
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::mindev_line;
use crate::model::Model;
use crate::parts::{DeviationAccumulator, F, LeastDeviation, XI_YI, line_change, square_gains};

/// Where arcs are split.
const CROSSING: Crossing = Crossing::RoundedRadius;

/// Minimum deviation: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "mindev-machine",
    title: "Minimum deviation",
    method: mindev_line::MODEL.method,
    source: mindev_line::MODEL.source,
    registers: planar::JUDGED,
    options: machine_options![],
    claims: Some(Claims::of(Region::LinesAndArcs)),
    interpolates: planar::judging(CROSSING, load, |_, block| Some(planar::bound(block, 0.5))),
    hardware,
};

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let frame = super::frame::plain(m, hardware);
    let f = DeviationAccumulator::new(m, hardware.bits(F));
    let [xi, yi] = [0, 1].map(|axis| hardware.reg(m, XI_YI.of(axis)));
    let bits = xi.q.bits().max(yi.q.bits());
    let [x, y] = [xi, yi].map(|register| register.q.extend(bits));
    let wide = f.value().bits().max(bits + 2) + 2;

    // Judge an arc: F after each of the three steps, and the least of their magnitudes.
    let least = LeastDeviation::new(m, f.value(), square_gains(m, [x, y], frame.grows(), wide));

    // Judge a line: the long axis always, the other where D >= 0.
    let x_is_longest = m.name("x_is_longest", !x.less_than(y));
    let diagonal = f.not_negative();
    let judged = [
        frame.arc.mux(least.takes_x(), x_is_longest | diagonal),
        frame.arc.mux(least.takes_y(), !x_is_longest | diagonal),
    ];
    let [take_x, take_y] = frame.redirected(judged);
    let taken = [m.name("take_x", take_x), m.name("take_y", take_y)];

    // Compute.
    let of_arc = least.change(taken);
    let travels = [x_is_longest.mux(x, y), x_is_longest.mux(y, x)];
    let of_line = line_change(m, travels, wide, diagonal).as_signed();
    f.close_adding(&frame.block, frame.step, m.name("operand", frame.arc.mux(of_arc, of_line)));
    frame.coordinates([(xi, XI_YI.of(0)), (yi, XI_YI.of(1))], taken);

    frame.close(hardware, taken);
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    planar::blocks(CROSSING, hardware, block, |at| {
        let [x, y] = at.pulses;
        let (f, point) = match block.curve {
            Curve::Line(_) => (2 * x.min(y) - x.max(y), at.pulses),
            _ => (at.deviation, at.start),
        };
        (Words::new().set(F, f).set_each(XI_YI, point), planar::longest_steps(at))
    })
}
