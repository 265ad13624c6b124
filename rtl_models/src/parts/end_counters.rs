//! The end point of a motion in two axes: one counter of all pulses, or one for each axis.

use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, DownCounter};
use crate::hardware::Hardware;
use crate::options::{END_POINT, EndPoint};
use crate::per_axis;
use crate::registers::{N, PerAxis, Reg, With};

/// The end-point down-counter of hardware that has one for all axes.
pub const E: Reg = Reg::new("e", N.plus(1), "end-point down-counter").when(&ONE_FOR_ALL);
static ONE_FOR_ALL: With<EndPoint> = With(&END_POINT, |end_point| *end_point != EndPoint::PerAxis);
/// The end-point down-counters of hardware that has one for each axis.
pub const END: PerAxis = Reg::each(per_axis!("e"), N, "end-point down-counter of each axis").when(&ONE_EACH);
static ONE_EACH: With<EndPoint> = With(&END_POINT, |end_point| *end_point == EndPoint::PerAxis);

/// End-point counters of two axes: `ex` and `ey` with [`EndPoint::PerAxis`], else `e`.
#[derive(Clone, Copy, Debug)]
pub enum EndCounters<'m> {
    /// Pulses of both axes.
    Total(DownCounter<'m>),
    /// Pulses of x, pulses of y.
    PerAxis([DownCounter<'m>; 2]),
}

impl<'m> EndCounters<'m> {
    /// The counters, as wide as the hardware says.
    #[must_use]
    pub fn new(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware) -> EndCounters<'m> {
        match hardware.get(&END_POINT) {
            EndPoint::PerAxis => EndCounters::PerAxis([0, 1].map(|axis| hardware.counter(m, block, END.of(axis)))),
            _ => EndCounters::Total(hardware.counter(m, block, E)),
        }
    }

    /// The axes that the judgement takes (1 bit each, x and y), but an exhausted axis hands its step to the other.
    #[must_use]
    pub fn redirected(&self, [x, y]: [Signal<'m>; 2]) -> [Signal<'m>; 2] {
        match self {
            EndCounters::Total(_) => [x, y],
            EndCounters::PerAxis([ex, ey]) => handed_over([ex.running(), ey.running()], [x, y]),
        }
    }

    /// Closes the counters: at an edge with `step` = 1 the axes taken (1 bit each) count. Returns 1 bit: the end point is
    /// reached at this edge.
    #[must_use]
    pub fn count(self, step: Signal<'m>, [x, y]: [Signal<'m>; 2]) -> Signal<'m> {
        match self {
            // Two pulses, or one.
            EndCounters::Total(e) => e.count_by(step, (x & y).concat(x ^ y)),
            EndCounters::PerAxis([ex, ey]) => ex.count(step & x) & ey.count(step & y),
        }
    }
}

/// The axes that the judgement takes (1 bit each, x and y), but one that is not `open` (1 bit each) hands its step to the
/// other.
#[must_use]
pub fn handed_over<'m>([x_open, y_open]: [Signal<'m>; 2], [x, y]: [Signal<'m>; 2]) -> [Signal<'m>; 2] {
    [x_open & (x | !y_open), y_open & (y | !x_open)]
}
