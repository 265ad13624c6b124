//! From the axes of an interpolator to those of the machine.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, axis_counter};
use crate::hardware::Hardware;

/// A motion of an interpolator's axis; 1 bit each.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'m> {
    /// It has a pulse at this edge.
    pub pulse: Signal<'m>,
    /// In the negative direction.
    pub negative: Signal<'m>,
}

/// Hands the pulses of the two axes in the plane and of the third to the axes x, y and z of the machine.
///
/// - `plane`, 2 bits: 0 is XY (G17), 1 is ZX (G18), 2 is YZ (G19).
pub fn distributor<'m>(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware, motions: [Motion<'m>; 3]) {
    let names = [(0, "XY"), (1, "ZX"), (2, "YZ")].map(|(value, name)| (value, name.to_owned()));
    let plane = m.reg("plane", 2).shown(Format::States(names.to_vec()));
    plane.when(block.load, block.word("plane", 2)).else_hold();
    let (zx, yz) = (plane.q.bit(0), plane.q.bit(1));
    let [first, second, third] = motions;
    // What each axis of the machine is in each plane.
    let axes = [("x", [first, second, third]), ("y", [second, third, first]), ("z", [third, first, second])];
    for (letter, [in_xy, in_zx, in_yz]) in axes {
        let chosen = |of: fn(Motion<'m>) -> Signal<'m>| zx.mux(of(in_zx), yz.mux(of(in_yz), of(in_xy)));
        let scope = m.scope(&format!("axis_{letter}"));
        let (pulse, negative) = (chosen(|motion| motion.pulse), chosen(|motion| motion.negative));
        axis_counter(scope, block, letter, hardware.bits(letter), pulse, negative);
    }
}
