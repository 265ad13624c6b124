//! The machine of the digital differential analyser (数字积分法): a pair of integrators for lines and arcs, and cascades of them for
//! free curves.
//!
//! ```text
//!   host ──► next block, normalised in the buffer ──► block
//!            jvx ──► + ──► jrx   carry ──► first axis ──┬──► ex ──┐
//!             ▲ ±unit on a pulse of the other (arc)     │         ├──► end of the block
//!            jvy ──► + ──► jry   carry ──► second axis ─┴──► ey ──┘      x, y, z
//!   rate ──► phase ──► step
//!
//!   with G5 or G5.1 in the program:
//!            rx ──► + ──► qx ──► + ──► px ──► + ──► jcx   pulse, signed ──► x     e ──► end of the curve
//!            ry ──► + ──► qy ──► + ──► py ──► + ──► jcy   pulse, signed ──► y
//! ```
//!
//! A line loads J_VX = abs(dx), J_VY = abs(dy), which stay; an arc J_VX = abs(y), J_VY = abs(x), which pulses of the
//! other axis change. An exhausted axis stops adding. Where one axis is exhausted and the integrand of the other is 0, the
//! other steps at once: next to an axis an arc would stall there otherwise. Normalised, the integrands of the
//! *next* block shift left in the buffer while the present one runs, until one has its highest bit set, on an arc its
//! second highest. The cascades are those of [`spline-dda`](crate::spline_dda), one step in each pulse of the source;
//! meanwhile both axes of the pair are exhausted.

use stepwave_nc::{Crossing, Curve, PulseBlock};
use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::frame::{Frame, MODE};
use super::{HardwareBlock, Paced, Size, curve, planar, power};
use crate::claims::{Claims, Region};
use crate::dda_line;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::interpolates::Interpolates;
use crate::machine::Words;
use crate::model::Model;
use crate::options::{NORMALIZE, PRESET, Preset};
use crate::parts::{
    Buffer, END, Iteration, JR, JV, PLANE, POSITION, QUAD, WHOLE, integrator, shifted_left, up_down_counter,
};
use crate::plan::Plan;
use crate::registers::{N, Reg, Rule};
use crate::words;

/// By how much a pulse changes an integrand.
const UNIT: Reg = Reg::new("unit", N, "correction of an integrand").follows(|_| true);
/// The next block is an arc.
const ARC: Reg = Reg::new("arc", Rule::Bits(1), "the next block is an arc");

/// Where arcs are split.
const CROSSING: Crossing = Crossing::RoundedRadius;

/// Digital differential analyser: a machine that runs whole programs.
pub static MODEL: Model = Model {
    name: "dda-machine",
    title: "Digital differential analyser",
    method: dda_line::MODEL.method,
    source: dda_line::MODEL.source,
    registers: &[
        &MODE.about("mode, LINE = 1, ARC = 2, CURVE = 3"),
        &PLANE,
        &QUAD,
        &(JV.pair(), JR.pair()),
        &UNIT,
        &END.pair(),
        &WHOLE,
        &curve::CURVE_REMAINDER.pair(),
        &curve::CURVE_P.pair(),
        &curve::CURVE_Q.pair(),
        &curve::CURVE_R.pair(),
        &curve::CURVE_STEPS,
        &POSITION,
    ],
    options: machine_options![&PRESET.about("half (default) | zero | full | N"), &NORMALIZE],
    claims: Some(Claims::of(Region::LinesAndArcs)),
    interpolates: Interpolates::Moves(Paced {
        arcs: Some(CROSSING),
        curves: true,
        direct: false,
        plan,
        most_steps: |_, plan| [2_u64.saturating_mul(power(plan.bits(JV.of(0)))); 2],
        load,
        error_bound: |hardware, block| {
            // Each axis of a line is rounded to the nearest, or cut, and of a free curve to the nearest; an arc has no promise.
            let half = hardware.presets.iter().all(|preset| *preset == Preset::Half);
            let off = match block.curve {
                Curve::Line(_) => Some(if half { 0.5 } else { 1.0 }),
                Curve::Spline(_) => Some(0.5),
                _ => None,
            };
            off.map(|off| planar::bound(block, f64::hypot(off, off)))
        },
    }),
    hardware,
};

fn plan(size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
    let normalized = plan.get(&NORMALIZE);
    // Normalised, the integrands of an arc keep a bit free.
    let n = plan.magnitude_bits(size.magnitude);
    plan.n = plan.bits_or(n + u32::from(normalized));
    planar::common_plan(plan, size);
    // Normalised, a block takes no more steps than its integrands need.
    planar::one_scale(plan, &[JV.of(0), JV.of(1), JR.of(0), JR.of(1)], !normalized)?;
    plan.stall_clocks = planar::stall_clocks(plan.bits(JR.of(0)));
    curve::plan(plan, size.curves);
    Ok(())
}

/// The words of the integrands in the buffer, normalised there.
struct Normalized<'m> {
    integrands: [Signal<'m>; 2],
    unit: Signal<'m>,
    /// 1 bit: it is still shifting.
    shifting: Signal<'m>,
}

fn normalized<'m>(m: Scope<'m>, buffer: &Buffer<'m>, bits: u32, normalize: bool) -> Normalized<'m> {
    let m = m.scope("normalizer");
    let (yes, no) = (m.lit(1, 1), m.lit(1, 0));
    let next = [0, 1]
        .map(|axis| JV.of(axis).name())
        .map(|name| (m.reg(&format!("next_{name}"), bits), buffer.word(name, bits)));
    let unit = m.reg("next_unit", bits);
    let (shifting, shift) = if normalize {
        let busy = m.reg("normalizing", 1);
        let arc = m.reg("next_is_arc", 1);
        arc.when(buffer.write, buffer.word(ARC.name(), 1)).else_hold();
        let any = next[0].0.q | next[1].0.q;
        let top = any.msb() | arc.q & any.bit(bits.saturating_sub(2));
        busy.when(buffer.write, yes).when(top, no).else_hold();
        (busy.q, busy.q & !top)
    } else {
        (no, no)
    };
    let close = |register: Register<'m>, word: Signal<'m>| {
        register.when(buffer.write, word).when(shift, shifted_left(m, register.q)).else_hold();
        register.q
    };
    let integrands = next.map(|(register, word)| close(register, word));
    Normalized { integrands, unit: close(unit, m.lit(bits, 1)), shifting }
}

fn hardware(m: Scope<'_>, hardware: &Hardware) {
    let bits = hardware.bits(JV.of(0));
    let buffer = Buffer::new(m, hardware);
    let next = normalized(m, &buffer, bits, hardware.get(&NORMALIZE));
    let frame = Frame::new(m, hardware, buffer, next.shifting);
    let block = frame.block;
    let unit = m.reg(UNIT.name(), bits);
    unit.when(block.load, next.unit).else_hold();
    let scopes = ["integrator_x", "integrator_y"].map(|name| m.scope(name));
    let jv = [0, 1].map(|axis| scopes[axis].reg(JV.of(axis).name(), bits));

    // Both integrators add with the old integrands; an exhausted axis freezes its remainder.
    let open = frame.open();
    let pulses = [0, 1].map(|axis| {
        let add = frame.step & open[axis];
        let iteration = Iteration { add, complete: add };
        let carry = integrator(scopes[axis], &block, hardware, axis, jv[axis].q, iteration);
        let stalled = !open[1 - axis] & jv[axis].q.is_zero();
        scopes[axis].name("taken", carry | open[axis] & stalled)
    });

    // A pulse of one axis corrects the integrand of the other.
    let grows = frame.grows();
    for axis in [0, 1] {
        let (other, pulse) = (1 - axis, frame.step & frame.arc & pulses[1 - axis]);
        let load = [(block.load, next.integrands[axis])];
        up_down_counter(jv[axis], &load, pulse & grows[other], pulse & !grows[other], unit.q);
    }

    frame.close(hardware, pulses);
}

/// The words of the pair of integrators in a block in which it has nothing to do.
fn at_rest(hardware: &Hardware, bits: u32) -> Words {
    if !hardware.get(&NORMALIZE) {
        return words::integrators(hardware, [0; 2]);
    }
    // Normalised already.
    words::integrators(hardware, [1 << bits.saturating_sub(1); 2]).set(ARC, false)
}

fn load(block: &PulseBlock, hardware: &Hardware) -> Vec<HardwareBlock> {
    let bits = hardware.bits(JV.of(0));
    if let Curve::Spline(_) = block.curve {
        return curve::load(hardware, block, at_rest(hardware, bits));
    }
    planar::blocks(CROSSING, hardware, block, |at| {
        let arc = !matches!(block.curve, Curve::Line(_));
        let [x, y] = if arc { [at.start[1], at.start[0]] } else { at.pulses };
        let mut words = curve::at_rest(hardware, words::integrators(hardware, [x, y]));
        let mut shift = 0;
        if hardware.get(&NORMALIZE) {
            words = words.set(ARC, arc);
            let needed = Width::needed_unsigned(x.max(y).unsigned_abs());
            shift = bits.saturating_sub(needed + u32::from(arc));
        }
        // 2^(n - Q) iterations make a radian, or a whole line.
        let iterations = 2f64.powi(bits.saturating_sub(shift).cast_signed());
        (words, if arc { at.angle * iterations } else { iterations })
    })
}
