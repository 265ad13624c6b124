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
use crate::hardware::names::{COEFFICIENT, SIGN};
use crate::options::{END_POINT, EndPoint, ON_OVERFLOW, Radix, WIDTH};
use crate::parts::{Buffer, RateMultiplier, Units, axis_counter, pulse_source};
use crate::plan::Plan;

pub(super) const FAMILY: Family = Family {
    name: "dpm",
    title: "Digital pulse multiplier",
    arcs: false,
    crossing: Crossing::RoundedRadius,
    direct: false,
    options: &[&WIDTH, &ON_OVERFLOW],
    plan,
    hardware,
    words,
    error_bound: |hardware, block| {
        let moving = (0..3).filter(|&axis| block.from[axis] != block.to[axis]);
        let off = crate::dpm_line::rate_bound(Radix::Binary, hardware.bits("q"));
        Some(moving.fold(0.0, |sum, _| f64::hypot(sum, off)))
    },
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    let n = plan.magnitude_bits(size.magnitude);
    plan.register("q", n);
    for name in &COEFFICIENT[..3] {
        plan.register(*name, n);
    }
    plan.positions(size.positions.iter().map(|reach| reach.to_vec()));
    plan.fix(&END_POINT, EndPoint::Iterations);
    planar::one_scale(plan, &["q", COEFFICIENT[0], COEFFICIENT[1], COEFFICIENT[2]], true)?;
    plan.scale = &["m"];
    plan.stall_clocks = 0;
    Ok(())
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let bits = hardware.bits("q");
    let buffer = Buffer::new(m);
    let block = buffer.block(m.lit(1, 0));
    let step = m.name("step", pulse_source(m, &block, buffer.full()) & block.busy);
    program_words(m, &block);
    let units = Units { radix: Radix::Binary, bits, count: 1 };
    let counter = RateMultiplier::new(m.scope("counter"), &block, "q", units, step);
    for (axis, letter) in hardware.letters().iter().enumerate() {
        let scope = m.scope(&format!("axis_{letter}"));
        let coefficient = block.held(scope, COEFFICIENT[axis], bits);
        let negative = block.held(scope, SIGN[axis], 1);
        let pulse = scope.name("pulse", counter.gated(scope, coefficient));
        axis_counter(scope, &block, letter, hardware.bits(letter), pulse, negative);
    }
    block.close(block.load, step, counter.carry);
}

fn words(hardware: &Hardware, block: &PulseBlock) -> Vec<HardwareBlock> {
    let way = |axis: usize| i128::from(block.to[axis]) - i128::from(block.from[axis]);
    let words = (0..3).flat_map(|axis| {
        let way = way(axis);
        [(COEFFICIENT[axis], way.abs()), (SIGN[axis], i128::from(way < 0))]
    });
    let steps = 2f64.powi(hardware.bits("q").cast_signed());
    vec![HardwareBlock { words: words.collect(), steps, length: block.curve.length() }]
}
