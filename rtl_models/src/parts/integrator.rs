//! The DDA integrator.

use stepwave_kernel::dsl::{Scope, Signal};

use super::Block;

/// One DDA integrator: at every edge with `step` = 1 it adds the integrand J_V into the remainder register J_R (name
/// `jr` + axis, `bits` bits, at least as wide as the integrand); returns the carry (1 bit), which is the axis's pulse.
pub fn integrator<'m>(
    m: Scope<'m>,
    block: &Block<'m>,
    axis: &str,
    bits: u32,
    integrand: Signal<'m>,
    step: Signal<'m>,
) -> Signal<'m> {
    let name = format!("jr{axis}");
    let remainder = m.reg(&name, bits);
    let (carry, sum) = remainder.q.carrying_add(integrand.extend(bits));
    remainder.when(block.load, block.word(&name, bits)).when(step, sum).else_hold();
    m.name("carry", carry & step)
}
