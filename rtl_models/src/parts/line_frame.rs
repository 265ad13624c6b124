//! What every interpolator has that judges, step by step, whether a line takes its long axis alone or both axes.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{BeatRing, Block, DownCounter, axis_counter};
use crate::hardware::Hardware;

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
        let e = DownCounter::new(m, block, "e", hardware.bits("e"));
        LineFrame { m, block: *block, e, x_is_longest: block.held(m, "x_is_longest", 1) }
    }

    /// Closes feed, end counter, beats and block. `diagonal` (1 bit) is what the judge beat decided.
    pub fn close(self, hardware: &Hardware, beat: BeatRing<'m>, diagonal: Signal<'m>) {
        let axes = [("x", "sx", self.x_is_longest), ("y", "sy", !self.x_is_longest)];
        for (letter, sign, long) in axes {
            let scope = self.m.scope(&format!("axis_{letter}"));
            let negative = self.block.held(scope, sign, 1);
            axis_counter(scope, &self.block, letter, hardware.bits(letter), beat.feed & (long | diagonal), negative);
        }
        let last = self.e.count(beat.compare);
        beat.close(self.block, last);
    }
}
