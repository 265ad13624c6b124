//! The judgement of point-by-point comparison on an arc: the axis that steps, and what it adds to F.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{DeviationAccumulator, square_gain};

/// 1 bit: x steps. F >= 0 takes the coordinate that shrinks, which is y where x grows (1 bit); F < 0 the other.
#[must_use]
pub fn judged_by_sign<'m>(f: &DeviationAccumulator<'m>, x_grows: Signal<'m>) -> Signal<'m> {
    f.not_negative() ^ x_grows
}

/// Whether the coordinate of the step grows (1 bit, the net `grows`), and what the step adds to F, or takes off where it
/// shrinks. `coordinates` are |x| and |y|, equally wide; the result has a bit more.
#[must_use]
pub fn step_of_circle<'m>(
    m: Scope<'m>,
    [x, y]: [Signal<'m>; 2],
    take_x: Signal<'m>,
    x_grows: Signal<'m>,
) -> (Signal<'m>, Signal<'m>) {
    let grows = m.name("grows", !(take_x ^ x_grows));
    (grows, square_gain(m, take_x.mux(x, y), grows))
}
