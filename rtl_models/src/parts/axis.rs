//! An axis: its pulse and its machine position.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Scope, Signal};

use super::{Block, up_down_counter};
use crate::per_axis;
use crate::registers::{AXES, PerAxis, Reg, Rule};

/// Machine positions; the plan of a model [sets](crate::Plan::positions) their widths.
pub const POSITION: PerAxis =
    Reg::each(AXES, Rule::Planned("as the path needs, + 1"), "machine position, signed").signed().hidden();
/// Directions of the axes: 1 is negative.
pub const SIGN: PerAxis = Reg::each(per_axis!("s"), Rule::Bits(1), "direction of the axis, 1 is negative").hidden();

/// The scope of an axis: `axis_x` of the first.
#[must_use]
pub fn axis_scope(m: Scope<'_>, axis: usize) -> Scope<'_> {
    m.scope(&format!("axis_{}", AXES[axis]))
}

/// The axis of this letter: at an edge with `pulse` = 1 it sends one pulse, in the negative direction where `negative` is
/// 1 (1 bit each).
///
/// - `d` and the letter, 2 bits: the signed pulse of the last edge, -1, 0 or +1.
/// - The letter, `bits` bits in two's complement: the machine position in BLU, preset with the first block.
///
/// Returns the word of that preset.
pub fn axis_counter<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    letter: &str,
    bits: u32,
    pulse: Signal<'m>,
    negative: Signal<'m>,
) -> Signal<'m> {
    let names = [&format!("d{letter}"), letter];
    position_counter(m, names, bits, [pulse, negative], block.preset_position, || block.position(letter, bits))
}

/// The signed pulse and the position of an axis by these names. Returns what the position is preset with.
pub(super) fn position_counter<'m>(
    m: Scope<'m>,
    [moved, place]: [&str; 2],
    bits: u32,
    [pulse, negative]: [Signal<'m>; 2],
    load: Signal<'m>,
    preset: impl FnOnce() -> Signal<'m>,
) -> Signal<'m> {
    let signed_pulse = m.reg_signed(moved, 2);
    signed_pulse.set(signed(pulse, negative));
    let (up, down) = (pulse & !negative, pulse & negative);
    let position = m.reg_signed(place, bits).shown(Format::Analog);
    let preset = preset();
    up_down_counter(position, &[(load, preset)], up, down, m.lit_signed(2, 1));
    preset
}

/// A pulse, in the negative direction where `negative` is 1 (1 bit each), as a number of 2 bits.
pub(super) fn signed<'m>(pulse: Signal<'m>, negative: Signal<'m>) -> Signal<'m> {
    (pulse & negative).concat(pulse).as_signed()
}
