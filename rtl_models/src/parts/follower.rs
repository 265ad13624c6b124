//! The third axis of a machine that interpolates in a plane.

use stepwave_netlist::dsl::{Scope, Signal};

use super::Block;
use crate::registers::{N, Reg, Rule};

/// Pulses of both axes of the plane in a block.
pub const WHOLE: Reg = Reg::new("whole", N.plus(1), "pulses of both axes of the plane").hidden();
const AS_WHOLE: Rule = Rule::Planned("as whole");
/// Those of the third axis.
pub const SHARE: Reg = Reg::new("share", AS_WHOLE, "pulses of the third axis");
/// What the third axis has in store.
pub const REST: Reg = Reg::new("rest", AS_WHOLE, "what is left over of a pulse of the third axis");

/// Spreads the pulses of a third axis over those of the two axes in the plane: `share` out of `whole`.
///
/// - `whole`, `bits` bits: pulses of both axes in the block. `share`, `bits` bits: those of the third axis, at most half
///   of them. `rest`, `bits` bits: loaded with half of `whole`.
///
/// At an edge with `step` = 1 every pulse of the plane (`taken`, 1 bit each) adds `share` to `rest`; where `whole` is
/// reached it is taken off, and the third axis has a pulse, 1 bit, which is returned. After all pulses of the block the
/// third axis has had its share exactly, and was never more than a pulse off it.
#[must_use]
pub fn follower<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    bits: u32,
    step: Signal<'m>,
    taken: [Signal<'m>; 2],
) -> Signal<'m> {
    let m = m.scope("follower");
    let [whole, share] = [WHOLE, SHARE].map(|register| block.held(m, register.name(), bits));
    let rest = m.reg(REST.name(), bits);
    let wide = bits + 2;
    let zero = m.lit(wide, 0);
    let [first, second] = taken.map(|taken| taken.mux(share.extend(wide), zero));
    let sum = m.name("sum", rest.q.extend(wide).wrapping_add(first).wrapping_add(second));
    let (borrow, less) = sum.borrowing_sub(whole.extend(wide));
    let pulse = m.name("pulse", step & !borrow);
    let next = borrow.mux(sum, less).slice(0, bits);
    rest.when(block.load, block.word(REST.name(), bits)).when(step, next).else_hold();
    pulse
}
