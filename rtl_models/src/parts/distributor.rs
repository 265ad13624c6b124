//! From the axes of an interpolator to those of the machine.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, axis_scope};
use crate::hardware::Hardware;
use crate::registers::{Reg, Rule};

/// The plane of a block.
pub const PLANE: Reg = Reg::new("plane", Rule::Bits(2), "plane, XY = 0, ZX = 1, YZ = 2");

/// A motion of an interpolator's axis; 1 bit each.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'m> {
    /// It has a pulse at this edge.
    pub pulse: Signal<'m>,
    /// In the negative direction.
    pub negative: Signal<'m>,
}

/// Hands the pulses of the two axes in the plane and of the third to the axes x, y and z of the machine, or to x and y where
/// it has no third.
///
/// - `plane`, 2 bits: 0 is XY (G17), 1 is ZX (G18), 2 is YZ (G19).
pub fn distributor<'m>(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware, motions: [Motion<'m>; 3]) {
    let names = [(0, "XY"), (1, "ZX"), (2, "YZ")].map(|(value, name)| (value, name.to_owned()));
    let plane = hardware.reg(m, PLANE).shown(Format::States(names.to_vec()));
    plane.when(block.load, hardware.word(block, PLANE)).else_hold();
    let (zx, yz) = (plane.q.bit(0), plane.q.bit(1));
    let [first, second, third] = motions;
    // What each axis of the machine is in each plane.
    let axes = [[first, second, third], [second, third, first], [third, first, second]];
    for (axis, [in_xy, in_zx, in_yz]) in axes.into_iter().enumerate().take(hardware.axes) {
        let chosen = |of: fn(Motion<'m>) -> Signal<'m>| zx.mux(of(in_zx), yz.mux(of(in_yz), of(in_xy)));
        let (pulse, negative) = (chosen(|motion| motion.pulse), chosen(|motion| motion.negative));
        hardware.axis(axis_scope(m, axis), block, axis, pulse, negative);
    }
}
