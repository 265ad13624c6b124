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

use stepwave_nc::PulseBlock;
use stepwave_netlist::dsl::Scope;

use super::frame::{delta, program_words};
use super::{HardwareBlock, Paced, Size, power};
use crate::claims::{Claims, Region};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::model::Model;
use crate::parts::{Buffer, E, pulse_source_while};
use crate::plan::Plan;
use crate::stepgen;

/// Phase accumulators of a motion card: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "stepgen-machine",
    title: "Phase accumulators of a motion card",
    method: stepgen::MODEL.method,
    source: stepgen::MODEL.source,
    registers: stepgen::MODEL.registers,
    options: machine_options![&stepgen::PART_OF_A_STEP, &stepgen::PICKED, &stepgen::TIMES],
    claims: Some(Claims::of(Region::Lines)),
    interpolates: Interpolates::Moves(Paced {
        arcs: None,
        curves: false,
        direct: false,
        plan,
        most_steps: |_, plan| [power(plan.bits(E)); 2],
        load,
        error_bound: |hardware, block| {
            let moving = delta(block).iter().filter(|travel| **travel != 0).count();
            Some((moving as f64).sqrt() * stepgen::axis_bound(&hardware.presets))
        },
    }),
    hardware,
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    let accumulations = stepgen::registers(plan, size.magnitude, size.positions.iter().copied())?;
    // The source gives a pulse every second clock at most.
    plan.stall_clocks = stepgen::stall_clocks(plan, accumulations.saturating_mul(2));
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let block = Buffer::new(m, hardware).block(m.lit(1, 0));
    program_words(m, &block, hardware);
    stepgen::interpolator(m, hardware, block, Some(pulse_source_while));
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    let delta = &delta(block)[..hardware.axes];
    let k = stepgen::least_accumulations(delta, hardware);
    let steps = 2f64.powi(k.cast_signed());
    vec![HardwareBlock { words: stepgen::words(delta, &[], hardware, k), steps, length: block.length() }]
}
