//! The machine of the digital pulse multiplier (数字脉冲乘法器): one counter, a coefficient for each axis.
//!
//! ```text
//!   host ──► next block ──► block
//!   rate ──► phase ──► step ──► counter q ──► stages ──┬─ & mx ─► OR ──► x
//!                                  │                   ├─ & my ─► OR ──► y
//!                                  └──► carry ──► end  └─ & mz ─► OR ──► z
//! ```
//!
//! A pulse multiplier draws lines: the control gives it the chords of an arc.

use stepwave_nc::{AXES_MAX, PulseBlock};
use stepwave_netlist::dsl::Scope;

use super::frame::program_words;
use super::{HardwareBlock, Paced, Size, planar, power};
use crate::claims::{Claims, Region};
use crate::dpm_line;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::machine::Words;
use crate::model::Model;
use crate::options::{END_POINT, EndPoint, Radix};
use crate::parts::{Buffer, COEFFICIENT, POSITION, Q, RateMultiplier, SIGN, Units, axis_scope, pulse_source};
use crate::plan::Plan;
use crate::registers::Reg;

/// Digital pulse multiplier: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "dpm-machine",
    title: "Digital pulse multiplier",
    method: dpm_line::MODEL.method,
    source: dpm_line::MODEL.source,
    registers: &[&Q, &COEFFICIENT, &POSITION],
    options: machine_options![],
    claims: Some(Claims::of(Region::Lines)),
    interpolates: Interpolates::Moves(Paced {
        arcs: None,
        curves: false,
        direct: false,
        plan,
        most_steps: |_, plan| [power(plan.bits(Q)); 2],
        load,
        error_bound: |hardware, block| {
            let moving = (0..AXES_MAX).filter(|&axis| block.travel(axis) != 0);
            let off = crate::dpm_line::rate_bound(Radix::Binary, hardware.bits(Q));
            Some(moving.fold(0.0, |sum, _| f64::hypot(sum, off)))
        },
    }),
    hardware,
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(size.magnitude);
    plan.positions(size.positions);
    plan.fix(&END_POINT, EndPoint::Iterations);
    let registers: Vec<Reg> = std::iter::once(Q).chain((0..plan.axes()).map(|axis| COEFFICIENT.of(axis))).collect();
    planar::one_scale(plan, &registers, true)?;
    plan.stall_clocks = planar::stall_clocks(plan.bits(Q));
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let bits = hardware.bits(Q);
    let buffer = Buffer::new(m, hardware);
    let block = buffer.block(m.lit(1, 0));
    let step = m.name("step", pulse_source(m, hardware, &block, buffer.full()) & block.busy);
    program_words(m, &block, hardware);
    let units = Units { radix: Radix::Binary, bits, count: 1 };
    let counter = RateMultiplier::new(m.scope("counter"), &block, Q.name(), units, step);
    for axis in 0..hardware.axes {
        let scope = axis_scope(m, axis);
        let coefficient = block.held(scope, COEFFICIENT.of(axis).name(), bits);
        let negative = hardware.held(scope, &block, SIGN.of(axis));
        let pulse = scope.name("pulse", counter.gated(scope, coefficient));
        hardware.axis(scope, &block, axis, pulse, negative);
    }
    block.close(block.load, step, counter.carry);
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    let travel = |axis: usize| i128::from(block.travel(axis));
    let words = (0..hardware.axes).fold(Words::new(), |words, axis| {
        words.set(COEFFICIENT.of(axis), travel(axis).abs()).set(SIGN.of(axis), travel(axis) < 0)
    });
    let steps = 2f64.powi(hardware.bits(Q).cast_signed());
    vec![HardwareBlock { words, steps, length: block.length() }]
}
