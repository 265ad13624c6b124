//! What every interpolator has that judges, step by step, whether a line takes its long axis alone or both axes.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{BeatRing, Block, DownCounter, E, SIGN, axis_scope};
use crate::hardware::Hardware;
use crate::per_axis;
use crate::registers::{PerAxis, Reg, Rule};

/// Which axis is the longest one.
pub const LONGEST: PerAxis =
    Reg::each(per_axis!("", "_is_longest"), Rule::Bits(1), "the axis is the longest one").hidden();

/// Axes and end point of a line in eight directions: every step takes the long axis, and the short one where it is
/// diagonal.
///
/// - `x_is_longest`, 1 bit: the long axis is x. `sx`, `sy`, 1 bit each: the axis runs in the negative direction.
/// - `e`: steps left, that is pulses of the long axis.
#[derive(Clone, Copy, Debug)]
pub struct LineFrame<'m> {
    m: Scope<'m>,
    block: Block<'m>,
    e: DownCounter<'m>,
    /// 1 bit: the long axis is x.
    pub x_is_longest: Signal<'m>,
}

impl<'m> LineFrame<'m> {
    /// The registers.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware) -> LineFrame<'m> {
        let e = hardware.counter(m, block, E);
        LineFrame { m, block: *block, e, x_is_longest: hardware.held(m, block, LONGEST.of(0)) }
    }

    /// Closes feed, end counter, beats and block. `diagonal` (1 bit) is what the judge beat decided.
    pub fn close(self, hardware: &Hardware, beat: BeatRing<'m>, diagonal: Signal<'m>) {
        for (axis, long) in [self.x_is_longest, !self.x_is_longest].into_iter().enumerate() {
            let scope = axis_scope(self.m, axis);
            let negative = hardware.held(scope, &self.block, SIGN.of(axis));
            hardware.axis(scope, &self.block, axis, beat.feed & (long | diagonal), negative);
        }
        let last = self.e.count(beat.compare);
        beat.close(self.block, last);
    }
}
