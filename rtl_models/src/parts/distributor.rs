//! From the axes of an interpolator to those of the machine.

use stepwave_netlist::Width;
use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, axis_scope};
use crate::hardware::Hardware;
use crate::registers::{AXES, Reg, Rule};

/// The plane of a block.
pub const PLANE: Reg = Reg::new("plane", Rule::Planned("2"), "plane, XY = 0, ZX = 1, YZ = 2").follows(|_| true);

/// A motion of an interpolator's axis; 1 bit each.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'m> {
    /// It has a pulse at this edge.
    pub pulse: Signal<'m>,
    /// In the negative direction.
    pub negative: Signal<'m>,
}

/// The planes of a machine of this many axes, at least 3: the two axes of each, the first three those of G17, G18 and G19.
fn planes(axes: usize) -> impl Iterator<Item = [usize; 2]> {
    let ordered = |[low, high]: [usize; 2]| if [low, high] == [0, 2] { [high, low] } else { [low, high] };
    (1..axes).flat_map(move |high| (0..high).map(move |low| ordered([low, high])))
}

/// The number of the plane of two axes.
#[must_use]
pub fn plane_index(axes: [usize; 2]) -> usize {
    let [low, high] = [axes[0].min(axes[1]), axes[0].max(axes[1])];
    high * high.saturating_sub(1) / 2 + low
}

/// Bits of [`PLANE`] in a machine of this many axes.
#[must_use]
pub fn plane_bits(axes: usize) -> u32 {
    Width::needed_unsigned(planes(axes.max(3)).count() as u128 - 1)
}

/// Hands the pulses of the two axes in the plane and of those that follow to the axes of the machine; of a machine of two axes
/// those of the third go nowhere.
///
/// - `plane`: 0 is XY (G17), 1 is ZX (G18), 2 is YZ (G19), 2 bits; with more axes XA, YA, ZA, XB and so on. The followers are the
///   other axes, in their order.
pub fn distributor<'m>(m: Scope<'m>, block: &Block<'m>, hardware: &Hardware, motions: &[Motion<'m>]) {
    let axes = hardware.axes.max(3);
    let planes: Vec<[usize; 2]> = planes(axes).collect();
    let letters = |[first, second]: [usize; 2]| [AXES[first], AXES[second]].concat().to_uppercase();
    let names = (0..).zip(&planes).map(|(index, plane)| (index, letters(*plane))).collect();
    let bits = plane_bits(axes);
    let plane = m.reg(PLANE.name(), bits).shown(Format::States(names));
    plane.when(block.load, block.word(PLANE.name(), bits)).else_hold();
    let chosen: Vec<Signal<'m>> = (0..)
        .zip(&planes)
        .skip(1)
        // Of three planes each but the first has a bit of its own.
        .map(|(index, _)| if axes == 3 { plane.q.bit(index - 1) } else { plane.q.equals(m.lit(bits, index.into())) })
        .collect();
    for axis in 0..hardware.axes {
        let role = |[first, second]: &[usize; 2]| match axis {
            axis if axis == *first => motions[0],
            axis if axis == *second => motions[1],
            axis => motions[2 + axis - usize::from(axis > *first) - usize::from(axis > *second)],
        };
        let select = |of: fn(Motion<'m>) -> Signal<'m>| {
            let others = planes.iter().skip(1).zip(&chosen);
            others.fold(of(role(&planes[0])), |else_, (plane, chosen)| chosen.mux(of(role(plane)), else_))
        };
        let (pulse, negative) = (select(|motion| motion.pulse), select(|motion| motion.negative));
        hardware.axis(axis_scope(m, axis), block, axis, pulse, negative);
    }
}
