//! The radius to the end point of an arc, which a point that moves along the arc passes at its end.

use stepwave_netlist::dsl::{Register, Signal};

use super::{Microprogram, Row, State, magnitude, multiply, row, with_sign};

/// The side on which a point (x, y) about the centre lies of the radius to the end (xe, ye): the sign of xe·y - ye·x, by two
/// products of the multiplier.
///
/// - `side`: the first product. `before`, 1 bit: the point was in front of the end, in the sense of the motion. `first`, 1
///   bit: nothing was judged yet. `arrives`, 1 bit: the point that is judged passed the end.
#[derive(Clone, Copy, Debug)]
pub struct EndRadius<'m> {
    program: Microprogram<'m>,
    point: [Signal<'m>; 2],
    end: [Signal<'m>; 2],
    /// |x| and |y|, in as many bits as a magnitude has.
    pub magnitudes: [Signal<'m>; 2],
    /// |xe| and |ye|.
    ends: [Signal<'m>; 2],
    /// Bits of a product with its sign.
    bits: u32,
    half: Register<'m>,
    before: Signal<'m>,
    was_before: Register<'m>,
    passed: Signal<'m>,
    /// 1 bit: the point that was judged last passed the end.
    pub arrives: Register<'m>,
    /// 1 bit: no point was judged yet.
    pub first: Register<'m>,
}

impl<'m> EndRadius<'m> {
    /// The registers, for magnitudes of `bits` bits of the point and `whole` bits of the end; `ccw` is 1 bit.
    #[must_use]
    pub fn new(
        program: Microprogram<'m>,
        point: [Signal<'m>; 2],
        end: [Signal<'m>; 2],
        [bits, whole]: [u32; 2],
        ccw: Signal<'m>,
    ) -> EndRadius<'m> {
        let m = program.m;
        let magnitudes = point.map(|coordinate| magnitude(m, coordinate).slice(0, bits));
        let ends = end.map(|coordinate| magnitude(m, coordinate).slice(0, whole));
        let bits = bits + whole + 2;
        let half = m.reg("side", bits);
        let side = half.q.as_signed().wrapping_sub(signed(program, bits, end[1].msb() ^ point[0].msb()));
        let before = ccw.mux(side.msb(), !side.msb() & side.is_nonzero());
        let [was_before, arrives, first] = ["before", "arrives", "first"].map(|name| m.reg(name, 1));
        let passed = was_before.q & !before & !first.q;
        EndRadius { program, point, end, magnitudes, ends, bits, half, before, was_before, passed, arrives, first }
    }

    /// The rows of both products; after them comes the third of these states, and the first time in a block `begin`. `no`
    /// is 0 (1 bit).
    #[must_use]
    pub fn rows(&self, [x, y, next]: [State; 3], begin: State, no: Signal<'m>) -> [Row<'m>; 2] {
        let ([ax, ay], [ex, ey]) = (self.magnitudes, self.ends);
        let part = signed(self.program, self.bits, self.end[0].msb() ^ self.point[1].msb());
        let judged = [(self.was_before, self.before), (self.arrives, self.passed), (self.first, no)];
        [
            row(x, multiply(ay, ex), [(self.half, part)], y),
            row(y, multiply(ax, ey), judged, next).unless(self.first.q, begin),
        ]
    }
}

/// The product in two's complement of `bits` bits, with the sign that `negative` (1 bit) gives it.
fn signed<'m>(program: Microprogram<'m>, bits: u32, negative: Signal<'m>) -> Signal<'m> {
    with_sign(program.m, program.multiplier.product().slice(0, bits - 2), bits, negative)
}
