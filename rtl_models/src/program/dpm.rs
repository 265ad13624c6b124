//! The machine of the digital pulse multiplier (数字脉冲乘法器): one counter, a coefficient for each of three axes.
//!
//! ```text
//!   host ──► next block ──► block
//!   rate ──► phase ──► step ──► counter q ──► stages ──┬─ & mx ─► OR ──► x
//!                                  │                   ├─ & my ─► OR ──► y
//!                                  └──► carry ──► end  └─ & mz ─► OR ──► z
//! ```
//!
//! A pulse multiplier draws lines: the control gives it the chords of an arc.

use stepwave_nc::{Crossing, PulseBlock};
use stepwave_netlist::dsl::Scope;

use super::frame::program_words;
use super::{Family, HardwareBlock, Size, planar};
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::options::{END_POINT, EndPoint, ON_OVERFLOW, Radix, WIDTH};
use crate::parts::{Buffer, COEFFICIENT, POSITION, Q, RateMultiplier, SIGN, Units, axis_scope, pulse_source};
use crate::plan::Plan;

pub(super) const FAMILY: Family = Family {
    name: "dpm",
    title: "Digital pulse multiplier",
    arcs: false,
    crossing: Crossing::RoundedRadius,
    direct: false,
    registers: &[&Q, &COEFFICIENT, &POSITION],
    options: &[&WIDTH, &ON_OVERFLOW],
    plan,
    hardware,
    words,
    error_bound: |hardware, block| {
        let moving = (0..3).filter(|&axis| block.from[axis] != block.to[axis]);
        let off = crate::dpm_line::rate_bound(Radix::Binary, hardware.bits(Q));
        Some(moving.fold(0.0, |sum, _| f64::hypot(sum, off)))
    },
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    plan.n = plan.magnitude_bits(size.magnitude);
    plan.positions(size.positions);
    plan.fix(&END_POINT, EndPoint::Iterations);
    planar::one_scale(plan, &[Q, COEFFICIENT.of(0), COEFFICIENT.of(1), COEFFICIENT.of(2)], true)?;
    plan.scale = &["m"];
    plan.stall_clocks = 0;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let bits = hardware.bits(Q);
    let buffer = Buffer::new(m);
    let block = buffer.block(m.lit(1, 0));
    let step = m.name("step", pulse_source(m, &block, buffer.full()) & block.busy);
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

fn words(hardware: &Hardware, block: &PulseBlock) -> Vec<HardwareBlock> {
    let way = |axis: usize| i128::from(block.to[axis]) - i128::from(block.from[axis]);
    let words = (0..3).fold(Words::new(), |words, axis| {
        words.set(COEFFICIENT.of(axis), way(axis).abs()).set(SIGN.of(axis), way(axis) < 0)
    });
    let steps = 2f64.powi(hardware.bits(Q).cast_signed());
    vec![HardwareBlock { words, steps, length: block.curve.length() }]
}
