//! The machine of firmware for printers and mills: step counters, a tick of the pulse source for each step event.
//!
//! ```text
//!   host ──► next block ──► block
//!   rate ──► phase ──► tick ──► ADD, then TEST ──► for each axis: cnt ──► >= events ? ──► x, y, z
//!                                                  └──► e ──► end
//! ```
//!
//! It draws lines: the control gives it the chords of an arc. Ticks are two clocks apart at least, as a step event is.

use stepwave_nc::PulseBlock;
use stepwave_netlist::dsl::Scope;

use super::frame::{delta, program_words};
use super::{HardwareBlock, Paced, Size};
use crate::bresenham;
use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::model::Model;
use crate::options::{COMPARE, FORM};
use crate::parts::{Buffer, pulse_source_while};
use crate::plan::Plan;

/// Step counters of printer and mill firmware: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "bresenham-machine",
    title: "Step counters of printer and mill firmware",
    method: bresenham::MODEL.method,
    source: bresenham::MODEL.source,
    registers: bresenham::MODEL.registers,
    options: machine_options![&bresenham::FORMS, &bresenham::COMPARISONS],
    claims: Some(Claims::of(Region::Lines)),
    interpolates: Interpolates::Moves(Paced {
        arcs: None,
        curves: false,
        direct: false,
        plan,
        most_steps: |size, _| [size.magnitude, 1],
        load,
        error_bound: |hardware, block| {
            let right = bresenham::compares_right(hardware.get(&FORM), hardware.get(&COMPARE));
            // The longest axis is exact, every other one half a BLU off.
            let others = delta(block).iter().filter(|travel| **travel != 0).count().saturating_sub(1);
            right.then(|| (others as f64).sqrt() / 2.0)
        },
    }),
    hardware,
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    bresenham::registers(plan, size.magnitude, size.positions.iter().copied());
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Buffer::new(m, hardware).block(m.lit(1, 0));
    let tick = pulse_source_while(m, hardware, &block, block.busy);
    program_words(m, &block, hardware);
    bresenham::interpolator(m, hardware, block, Some(tick));
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    let delta = &delta(block)[..hardware.axes];
    let steps = crate::sizes::longest_of(delta) as f64;
    vec![HardwareBlock { words: bresenham::words(delta, &[], hardware), steps, length: block.length() }]
}
