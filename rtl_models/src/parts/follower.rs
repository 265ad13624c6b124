//! Axes that follow those of the plane that a machine interpolates in.

use stepwave_netlist::dsl::{Scope, Signal};

use super::Block;
use crate::plan::Plan;
use crate::registers::{AXES, N, Reg, Rule};

/// The most followers of a machine.
const MOST: usize = AXES.len() - 2;

/// Pulses of both axes of the plane in a block.
pub const WHOLE: Reg = Reg::new("whole", N.plus(1), "pulses of both axes of the plane").hidden();
const AS_WHOLE: Rule = Rule::Planned("as whole");
/// Those of each follower.
pub const SHARE: Reg<MOST> = Reg::each(
    ["share", "share2", "share3", "share4", "share5", "share6", "share7"],
    AS_WHOLE,
    "pulses of an axis that follows",
)
.count(count);
/// What each follower has in store.
pub const REST: Reg<MOST> = Reg::each(
    ["rest", "rest2", "rest3", "rest4", "rest5", "rest6", "rest7"],
    AS_WHOLE,
    "what is left over of a pulse of an axis that follows",
)
.count(count);
/// Direction of each follower: 1 is negative.
pub const FOLLOWER_SIGN: Reg<MOST> = Reg::each(
    ["sw", "sw2", "sw3", "sw4", "sw5", "sw6", "sw7"],
    Rule::Bits(1),
    "direction of an axis that follows, 1 is negative",
)
.count(count);
/// Their scopes.
const SCOPES: [&str; MOST] = ["follower", "follower2", "follower3", "follower4", "follower5", "follower6", "follower7"];

/// How many followers a machine of this many axes has; at least one, whose pulses go nowhere in a plane.
#[must_use]
pub fn followers_of(axes: usize) -> usize {
    axes.saturating_sub(2).clamp(1, MOST)
}

fn count(plan: &Plan) -> usize {
    followers_of(plan.axes())
}

/// Spreads the pulses of `count` axes over those of the two axes in the plane: of each `share` out of `whole`.
///
/// - `whole`, `bits` bits: pulses of both axes in the block. Of each follower: `share`, `bits` bits: its pulses, at most half of
///   them; `rest`, `bits` bits: loaded with half of `whole`.
///
/// At an edge with `step` = 1 every pulse of the plane (`taken`, 1 bit each) adds `share` to `rest`; where `whole` is
/// reached it is taken off, and the axis has a pulse, 1 bit, which is returned. After all pulses of the block the
/// axis has had its share exactly, and was never more than a pulse off it.
#[must_use]
pub fn followers<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    (count, bits): (usize, u32),
    step: Signal<'m>,
    taken: [Signal<'m>; 2],
) -> Vec<Signal<'m>> {
    let scopes: Vec<Scope<'m>> = SCOPES.iter().take(count).map(|name| m.scope(name)).collect();
    let Some(first) = scopes.first() else { return Vec::new() };
    let whole = block.held(*first, WHOLE.name(), bits);
    let followers = scopes.iter().enumerate();
    followers.map(|(index, m)| follower(*m, block, (index, whole), step, taken)).collect()
}

fn follower<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    (index, whole): (usize, Signal<'m>),
    step: Signal<'m>,
    taken: [Signal<'m>; 2],
) -> Signal<'m> {
    let bits = whole.bits();
    let share = block.held(m, SHARE.of(index).name(), bits);
    let rest = m.reg(REST.of(index).name(), bits);
    let wide = bits + 2;
    let zero = m.lit(wide, 0);
    let [first, second] = taken.map(|taken| taken.mux(share.extend(wide), zero));
    let sum = m.name("sum", rest.q.extend(wide).wrapping_add(first).wrapping_add(second));
    let (borrow, less) = sum.borrowing_sub(whole.extend(wide));
    let pulse = m.name("pulse", step & !borrow);
    let next = borrow.mux(sum, less).slice(0, bits);
    rest.when(block.load, block.word(REST.of(index).name(), bits)).when(step, next).else_hold();
    pulse
}
