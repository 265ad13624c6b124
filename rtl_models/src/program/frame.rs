//! What every machine that runs whole programs has around its interpolator.

use stepwave_nc::{Position, PulseBlock};
use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Register, Scope, Signal};

use super::PROGRAM_WORDS;
use super::curve::{self, OfCurve};
use crate::hardware::Hardware;
use crate::parts::{
    ArcKind, Block, Buffer, CCW, DownCounter, END, FOLLOWER_SIGN, Motion, QUAD, WHOLE, count_coordinates, distributor,
    followers, followers_of, handed_over, pulse_source, quadrant_register,
};
use crate::registers::{Reg, Rule};

/// What a block is.
pub(super) const MODE: Reg = Reg::new("mode", Rule::Bits(2), "mode, LINE = 1, ARC = 2");

/// Block buffer, pulse source, mode and quadrant of a machine that interpolates in a plane.
///
/// - `mode`, 2 bits: 1 is LINE, 2 is ARC, 3 is CURVE where there is hardware for free curves. `quad`, 2 bits: the quadrant of an arc's sector, or the one that a line runs into, Q1 = 0;
///   `ccw`, 1 bit.
/// - `ex`, `ey`: pulses of the first and second axis of the plane that are left.
/// - `plane`, and the axes of the machine after the pulse distributor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame<'m> {
    pub(super) m: Scope<'m>,
    pub(super) block: Block<'m>,
    /// 1 bit: the interpolator takes a step at this edge.
    pub(super) step: Signal<'m>,
    /// 1 bit: the block is an arc.
    pub(super) arc: Signal<'m>,
    /// 1 bit, in hardware for free curves: the block is one.
    pub(super) curve: Option<Signal<'m>>,
    /// 1 bit: the first coordinate grows along the arc and the second shrinks; 0 on a line.
    pub(super) x_grows: Signal<'m>,
    negative: [Signal<'m>; 2],
    end: [DownCounter<'m>; 2],
}

impl<'m> Frame<'m> {
    /// The registers. The block waits in its buffer while `wait` (1 bit) is 1.
    pub(super) fn new(m: Scope<'m>, hardware: &Hardware, buffer: Buffer<'m>, wait: Signal<'m>) -> Frame<'m> {
        let block = buffer.block(wait);
        let step = pulse_source(m, hardware, &block, buffer.full() & !wait);
        program_words(m, &block, hardware);
        // One bit each, as viewers show no text for a single bit.
        let known = if curve::has(hardware) { 4 } else { 3 };
        let modes = (0..).zip(["NONE", "LINE", "ARC", "CURVE"]).map(|(value, name)| (value, name.to_owned()));
        let mode = hardware.reg(m, MODE).shown(Format::States(modes.take(known).collect()));
        mode.when(block.load, hardware.word(&block, MODE)).else_hold();
        let curve = curve::has(hardware).then(|| m.name("is_curve", mode.q.bit(0) & mode.q.bit(1)));
        let only = |bit: u32| curve.map_or(mode.q.bit(bit), |curve| mode.q.bit(bit) & !curve);
        let arc = only(1);
        let quad = quadrant_register(m);
        quad.when(block.load, hardware.word(&block, QUAD)).else_hold();
        let ccw = hardware.held(m, &block, CCW);
        let kind = ArcKind::decode_in_modes(m.scope("quadrant"), quad.q, ccw, [arc, only(0)], curve);
        // A line into Q2 or Q3 has negative x, one into Q3 or Q4 negative y.
        let (low, high) = (quad.q.bit(0), quad.q.bit(1));
        let negative = [arc.mux(kind.x_negative, low ^ high), arc.mux(kind.y_negative, high)];
        let end = [0, 1].map(|axis| hardware.counter(m, &block, END.of(axis)));
        let step = m.name("step", step & block.busy);
        Frame { m, block, step, arc, curve, x_grows: kind.x_grows & arc, negative, end }
    }

    /// 1 bit each: the axis has pulses left.
    pub(super) fn open(&self) -> [Signal<'m>; 2] {
        self.end.map(|counter| counter.running())
    }

    /// The axes that the judgement takes (1 bit each), but an exhausted axis hands its step to the other.
    pub(super) fn redirected(&self, taken: [Signal<'m>; 2]) -> [Signal<'m>; 2] {
        handed_over(self.open(), taken)
    }

    /// 1 bit each: the coordinate grows along an arc.
    pub(super) fn grows(&self) -> [Signal<'m>; 2] {
        [self.x_grows, self.arc & !self.x_grows]
    }

    /// Closes a pair of registers that hold the displacements of a line, and count the coordinates of an arc: those of the axes
    /// taken (1 bit each) change by one.
    pub(super) fn coordinates(&self, registers: [(Register<'m>, Reg); 2], taken: [Signal<'m>; 2]) {
        let counts = |taken: Signal<'m>| self.step & self.arc & taken;
        count_coordinates(self.m, &self.block, registers, taken, self.grows(), counts);
    }

    /// Closes feed, end counters and block: a step gives the axes taken (1 bit each) a pulse.
    pub(super) fn close(self, hardware: &Hardware, taken: [Signal<'m>; 2]) {
        let of_curve = curve::hardware(self.m, hardware, &self);
        let Frame { m, block, step, negative, end: [ex, ey], .. } = self;
        let size = (followers_of(hardware.axes), hardware.bits(WHOLE));
        let following = followers(m, &block, size, step, taken)
            .into_iter()
            .enumerate()
            .map(|(index, pulse)| Motion { pulse, negative: hardware.held(m, &block, FOLLOWER_SIGN.of(index)) });
        let in_plane = [0, 1].map(|axis| {
            let (pulse, negative) = (step & taken[axis], negative[axis]);
            of_curve.map_or(Motion { pulse, negative }, |OfCurve { is, motions, .. }| {
                // The others take no axis whose end counter is 0, as both are of a curve.
                Motion { pulse: pulse | motions[axis].pulse, negative: is.mux(motions[axis].negative, negative) }
            })
        });
        distributor(m, &block, hardware, &in_plane.into_iter().chain(following).collect::<Vec<_>>());
        let last = ex.count(step & taken[0]) & ey.count(step & taken[1]);
        let last = of_curve.map_or(last, |OfCurve { is, last: of_curve, .. }| is.mux(of_curve, last));
        block.close(block.load, step, last);
    }
}

/// What the control shows of the block that runs, in the scope `program`; nothing else takes it.
///
/// - `block`, 41 bits: its N number, or its line where it has none.
/// - `feed`, 32 bits: the speed that it is to have, in whole mm/min.
pub(super) fn program_words<'m>(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware) {
    let m = m.scope("program");
    for register in PROGRAM_WORDS {
        let _ = hardware.held(m, block, register);
    }
}

/// A frame with a buffer that is ready as soon as it is full.
pub(super) fn plain<'m>(m: Scope<'m>, hardware: &Hardware) -> Frame<'m> {
    Frame::new(m, hardware, Buffer::new(m, hardware), m.lit(1, 0))
}

/// The displacement of each axis in a block, in BLU.
pub(super) fn delta(block: &PulseBlock) -> Position {
    std::array::from_fn(|axis| block.travel(axis))
}
