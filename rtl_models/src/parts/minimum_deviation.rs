//! The judgement of minimum deviation: the step that leaves the least |F|, and what it adds to F.

use stepwave_netlist::dsl::{Scope, Signal};

use super::magnitude;

/// Which of the three steps of an arc leaves the least |F|.
///
/// - `f1`, `f2`, `f3`, two's complement: F after a step of x, of y, and of both.
#[derive(Clone, Copy, Debug)]
pub struct LeastDeviation<'m> {
    m: Scope<'m>,
    gains: [Signal<'m>; 2],
    /// 1 bit: F after the diagonal is not the least.
    beaten: Signal<'m>,
    /// 1 bit: F after a step of y is not greater than that after one of x.
    by_y: Signal<'m>,
}

impl<'m> LeastDeviation<'m> {
    /// Compares what follows `f` where a step of x and one of y add these gains, two's complement and equally wide, 2
    /// bits wider than `f` at least.
    #[must_use]
    pub fn new(m: Scope<'m>, f: Signal<'m>, gains: [Signal<'m>; 2]) -> LeastDeviation<'m> {
        let [gain_x, gain_y] = gains;
        let now = f.extend(gain_x.bits());
        let f1 = m.name("f1", now.wrapping_add(gain_x));
        let f2 = m.name("f2", now.wrapping_add(gain_y));
        let f3 = m.name("f3", f1.wrapping_add(gain_y));
        let [m1, m2, m3] = [f1, f2, f3].map(|f| magnitude(m, f));
        LeastDeviation { m, gains, beaten: m1.less_than(m3) | m2.less_than(m3), by_y: !m1.less_than(m2) }
    }

    /// 1 bit: x steps.
    #[must_use]
    pub fn takes_x(&self) -> Signal<'m> {
        !self.beaten | !self.by_y
    }

    /// 1 bit: y steps.
    #[must_use]
    pub fn takes_y(&self) -> Signal<'m> {
        !self.beaten | self.by_y
    }

    /// What the step of the axes taken (1 bit each) adds to F.
    #[must_use]
    pub fn change(&self, taken: [Signal<'m>; 2]) -> Signal<'m> {
        let zero = self.m.lit_signed(self.gains[0].bits(), 0);
        taken[0].mux(self.gains[0], zero).wrapping_add(taken[1].mux(self.gains[1], zero))
    }
}

/// What a step of a line adds to D = 2S - L: twice S, or twice S - L where it is diagonal (1 bit). Two's complement of
/// `bits` bits, at least 2 more than the long and the short travel have.
#[must_use]
pub fn line_change<'m>(m: Scope<'m>, travels: [Signal<'m>; 2], bits: u32, diagonal: Signal<'m>) -> Signal<'m> {
    let [long, short] = travels.map(|travel| travel.extend(bits - 1).as_signed());
    diagonal.mux(short.wrapping_sub(long), short).concat(m.lit(1, 0))
}
