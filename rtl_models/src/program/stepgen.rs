//! The machine of FPGA motion cards: phase accumulators, a tick of the pulse source for each accumulation.
//!
//! ```text
//!   host ──► next block ──► block
//!   rate ──► phase ──► tick ──► for each axis: acc += rate of the axis ──► step, dir ──► x, y, z
//!               ▲               └──► e ──► end
//!               └── ready: no step has to wait for the timers of its axis
//! ```
//!
//! It draws lines: the control gives it the chords of an arc. A block takes the least 2^k accumulations that its rates
//! allow. The pulse source waits with the accumulators.

use stepwave_nc::{Crossing, PulseBlock};
use stepwave_netlist::dsl::Scope;

use super::frame::{delta, program_words};
use super::{Family, HardwareBlock, Size};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::parts::{Buffer, pulse_source_while};
use crate::plan::Plan;
use crate::stepgen;

pub(super) const FAMILY: Family = Family {
    name: "stepgen",
    title: "Phase accumulators of a motion card",
    arcs: false,
    crossing: Crossing::RoundedRadius,
    direct: false,
    registers: stepgen::MODEL.registers,
    options: stepgen::MODEL.options,
    plan,
    hardware,
    words,
    error_bound: |hardware, block| {
        let moving = delta(block).iter().filter(|way| **way != 0).count();
        Some((moving as f64).sqrt() * stepgen::axis_bound(&hardware.presets))
    },
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    stepgen::registers(plan, size.magnitude, size.positions.iter().copied())?;
    plan.stall_clocks = 0;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Buffer::new(m).block(m.lit(1, 0));
    program_words(m, &block, hardware);
    stepgen::interpolator(m, hardware, block, Some(pulse_source_while));
}

fn words(hardware: &Hardware, block: &PulseBlock) -> Vec<HardwareBlock> {
    let delta = delta(block);
    let k = stepgen::least_accumulations(&delta, hardware);
    let steps = 2f64.powi(k.cast_signed());
    vec![HardwareBlock { words: stepgen::words(&delta, &[], hardware, k), steps, length: block.curve.length() }]
}
