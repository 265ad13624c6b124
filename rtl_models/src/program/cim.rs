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
//! those before and behind it.

use stepwave_kernel::Netlist;
use stepwave_kernel::dsl::Module;
use stepwave_nc::{Crossing, Curve, PulseBlock};

use super::{Family, HardwareBlock, Size, planar};
use crate::choices::{Choices, Weights};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::model::ChoiceDoc;
use crate::parts::{Change, Weighing};
use crate::words;

pub(super) const FAMILY: Family = Family {
    name: "cim",
    title: "Comparison-integral",
    arcs: true,
    crossing: Crossing::RoundedRadius,
    direct: true,
    choices: &[ChoiceDoc::WIDTH, ChoiceDoc::ON_OVERFLOW],
    plan,
    netlist,
    words: blocks,
    error_bound: |_, block| Some(planar::bound(block, 1.0)),
};

fn plan(size: &Size, choices: &Choices) -> Result<Hardware, ModelError> {
    let mut registers = planar::registers(&FAMILY, size, choices);
    let n = planar::bits(size, choices);
    registers.register("f", n + 2).register("a", n).register("b", n).shown("base");
    planar::hardware(registers, size, n)
}

fn netlist(hardware: &Hardware) -> Result<Netlist, ModelError> {
    let module = Module::with_overflow("cim_machine", hardware.on_overflow);
    let frame = super::frame::plain(&module, hardware);
    let m = frame.m;
    let weighing = Weighing::new(m, hardware);

    // Judge.
    let [take_x, take_y] = frame.redirected(weighing.judged());
    let taken = [m.name("take_x", take_x), m.name("take_y", take_y)];

    // Compute.
    let changes = frame.grows().map(|grows| Some(Change { grows, unit: frame.arc }));
    weighing.close(&frame.block, Weights::Mid, frame.step, taken, changes);

    frame.close(hardware, taken);
    Ok(module.finish()?)
}

fn blocks(_: &Hardware, block: &PulseBlock) -> Vec<HardwareBlock> {
    planar::blocks(&FAMILY, block, |at| {
        let words = match block.curve {
            Curve::Line(_) => vec![("f", 0), ("a", at.pulses[1]), ("b", at.pulses[0])],
            _ => {
                let f = words::weighed(Weights::Mid, at.start, at.x_grows, at.deviation);
                vec![("f", f), ("a", at.start[0]), ("b", at.start[1])]
            }
        };
        (words, planar::longest_steps(at))
    })
}
