//! What every interpolator that judges the steps of an arc has around its judgement.

use stepwave_netlist::dsl::{Register, Scope, Signal};
use stepwave_netlist::formula::{Clause, Formula, name};

use super::{
    ArcKind, BeatRing, Block, CCW, E, EndCounters, QUAD, axis_scope, negated, next_quadrant, quadrant_register,
    up_down_counter, x_grows,
};
use crate::hardware::Hardware;
use crate::options::{END_POINT, EndPoint};
use crate::registers::{N, Reg};

/// The coordinates of an arc.
pub const XI_YI: Reg<2> = Reg::each(["xi", "yi"], N, "|x|, |y| relative to the centre");

/// The coordinate that shrinks along the motion, between two steps.
#[must_use]
pub fn shrinking() -> Formula {
    let [x, y] = [0, 1].map(|axis| XI_YI.of(axis).value());
    in_x_or_y([y, x])
}

/// The coordinate that grows along the motion, between two steps.
#[must_use]
pub fn growing() -> Formula {
    let [x, y] = [0, 1].map(|axis| XI_YI.of(axis).value());
    in_x_or_y([x, y])
}

/// The first where x grows, else the second.
fn in_x_or_y([x_grows, y_grows]: [Formula; 2]) -> Formula {
    x_grows * name("x_grows") + y_grows.clone() - y_grows * name("x_grows")
}

/// Between two steps of an arc whose steps may be diagonal, in the quadrant of its end: no coordinate is beyond the end, and
/// with one pulse left one of them is there.
pub fn ends_ahead(hardware: &Hardware) -> Vec<Clause> {
    if hardware.get(&END_POINT) == EndPoint::PerAxis {
        return Vec::new();
    }
    let [xt, yt] = ["xt", "yt"].map(name);
    let growth = in_x_or_y([xt.clone(), yt.clone()]) - growing();
    let shrinkage = shrinking() - in_x_or_y([yt, xt]);
    vec![
        Clause::at_least_zero("what grows is not beyond the end", growth.clone()),
        Clause::at_least_zero("what shrinks is not beyond the end", shrinkage.clone()),
        Clause::either("with one pulse left one has come to it", [E.value() - 2, -growth, -shrinkage]),
    ]
}

/// Coordinates, quadrant, end point and axes of an arc. The judgement between them says which axes a step takes.
///
/// - `xi`, `yi`, unsigned: |x| and |y| relative to the centre.
/// - `quad`, 2 bits: the quadrant, Q1 = 0; `ccw`, 1 bit: counter-clockwise.
/// - `e`, or `ex` and `ey`: the end point.
///
/// With one counter the hardware crosses the axes: where the shrinking coordinate is 0 the judge beat turns to
/// the next quadrant (but not in the centre, which R = 1 passes through). With a counter for each axis the loader
/// splits the arc there.
#[derive(Clone, Copy, Debug)]
pub struct ArcFrame<'m> {
    m: Scope<'m>,
    block: Block<'m>,
    xi: Register<'m>,
    yi: Register<'m>,
    end: EndCounters<'m>,
    /// The decoded quadrant and direction.
    pub kind: ArcKind<'m>,
}

impl<'m> ArcFrame<'m> {
    /// The registers; the quadrant is turned at an edge with `judge` = 1 (1 bit).
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware, judge: Signal<'m>) -> ArcFrame<'m> {
        let [xi, yi] = [0, 1].map(|axis| hardware.reg(m, XI_YI.of(axis)));
        let quad = quadrant_register(m);
        let ccw = hardware.held(m, block, CCW);
        let end = EndCounters::new(m, block, hardware);
        let q = m.scope("quadrant");
        let entered = if hardware.get(&END_POINT) == EndPoint::PerAxis {
            quad.q
        } else {
            let (x_zero, y_zero) = (xi.q.is_zero(), yi.q.is_zero());
            let cross = q.name("cross", x_grows(quad.q, ccw).mux(y_zero & !x_zero, x_zero & !y_zero));
            cross.mux(next_quadrant(q, quad.q, ccw), quad.q)
        };
        quad.when(block.load, hardware.word(block, QUAD)).when(judge, entered).else_hold();
        // After the judge beat `entered` is `quad` itself, until the coordinates change.
        ArcFrame { m, block: *block, xi, yi, end, kind: ArcKind::decode(q, entered, ccw) }
    }

    /// |x| and |y|, equally wide.
    #[must_use]
    pub fn coordinates(&self) -> [Signal<'m>; 2] {
        let wide = self.xi.q.bits().max(self.yi.q.bits());
        [self.xi.q.extend(wide), self.yi.q.extend(wide)]
    }

    /// 1 bit each: |x| grows, |y| grows along the motion.
    #[must_use]
    pub fn grows(&self) -> [Signal<'m>; 2] {
        [self.kind.x_grows, !self.kind.x_grows]
    }

    /// What a step of x and one of y add to x² + y², in two's complement of `bits` bits, more than the coordinates have
    /// by 2 or more.
    #[must_use]
    pub fn gains(&self, bits: u32) -> [Signal<'m>; 2] {
        square_gains(self.m, self.coordinates(), self.grows(), bits)
    }

    /// The axes that the judgement takes (1 bit each), but an exhausted axis hands its step to the other.
    #[must_use]
    pub fn redirected(&self, taken: [Signal<'m>; 2]) -> [Signal<'m>; 2] {
        self.end.redirected(taken)
    }

    /// The axes taken (1 bit each) get a pulse at an edge with `feed` = 1.
    pub fn feed(&self, hardware: &Hardware, feed: Signal<'m>, [x, y]: [Signal<'m>; 2]) {
        for (axis, taken, negative) in [(0, x, self.kind.x_negative), (1, y, self.kind.y_negative)] {
            hardware.axis(axis_scope(self.m, axis), &self.block, axis, feed & taken, negative);
        }
    }

    /// The coordinates taken (1 bit each) change at an edge with `compute` = 1.
    pub(super) fn compute(&self, compute: Signal<'m>, taken: [Signal<'m>; 2]) {
        let registers = [(self.xi, XI_YI.of(0)), (self.yi, XI_YI.of(1))];
        count_coordinates(self.m, &self.block, registers, taken, self.grows(), |taken| compute & taken);
    }

    /// Closes the end counters; see [`EndCounters::count`].
    #[must_use]
    pub(super) fn compare(self, compare: Signal<'m>, taken: [Signal<'m>; 2]) -> Signal<'m> {
        self.end.count(compare, taken)
    }

    /// Closes coordinates, end counters, beats and block: the coordinates taken (1 bit each) change in the compute
    /// beat, and the compare beat counts their pulses.
    pub fn close(self, beat: BeatRing<'m>, taken: [Signal<'m>; 2]) {
        self.compute(beat.compute, taken);
        beat.close(self.block, self.compare(beat.compare, taken));
    }
}

/// Closes the registers of both coordinates, loaded with their words: where `counts` says of the axis taken (1 bit)
/// that it counts at this edge, the coordinate changes by 1.
pub fn count_coordinates<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    registers: [(Register<'m>, Reg); 2],
    taken: [Signal<'m>; 2],
    grows: [Signal<'m>; 2],
    counts: impl Fn(Signal<'m>) -> Signal<'m>,
) {
    for (((register, own), taken), grows) in registers.into_iter().zip(taken).zip(grows) {
        let count = counts(taken);
        let load = [(block.load, block.word(own.name(), register.q.bits()))];
        up_down_counter(register, &load, count & grows, count & !grows, m.lit(1, 1));
    }
}

/// What a step of each coordinate (unsigned) adds to the sum of their squares, in two's complement of `bits` bits, more
/// than the coordinates have by 2 or more; `grows`, 1 bit each: the step makes it grow.
#[must_use]
pub fn square_gains<'m>(m: Scope<'m>, [x, y]: [Signal<'m>; 2], grows: [Signal<'m>; 2], bits: u32) -> [Signal<'m>; 2] {
    [(x, grows[0]), (y, grows[1])].map(|(c, grows)| {
        let gain = square_gain(m, c, grows).extend(bits).as_signed();
        grows.mux(gain, negated(m, gain))
    })
}

/// What one step of a coordinate c (unsigned) adds to its square, without the sign: 2c + 1 where it grows (1 bit), else
/// 2c - 1; one bit wider than c.
#[must_use]
pub(super) fn square_gain<'m>(m: Scope<'m>, c: Signal<'m>, grows: Signal<'m>) -> Signal<'m> {
    // c, or c - 1, with a 1 after it.
    grows.mux(c, c.wrapping_sub(m.lit(c.bits(), 1))).concat(m.lit(1, 1))
}
