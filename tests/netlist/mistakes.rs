//! A description with many mistakes at once; `mistakes.expect` holds what is said of them.

use stepwave_netlist::dsl::Scope;

/// A machine by someone in a hurry. Adding a line moves the line numbers in `mistakes.expect`.
pub(super) fn describe(m: Scope<'_>) {
    let load = m.input("load", 2);
    let integrand = m.input("jv", 4);
    let axis = m.scope("axis x");
    let remainder = axis.reg("jr", 5);
    let (carry, sum) = remainder.q.carrying_add(integrand);
    remainder.when(load, integrand).when(carry, sum).else_hold();
    remainder.set(sum);
    m.reg("jv", 70).set(carry);
    let count = m.reg_signed("count", 4).reset(16);
    count.set(m.lit_signed(4, 8));
    let _ = count.q.slice(2, 3);
    let _ = (!count.q).strict_add(m.lit_signed(2, 1), carry);
    m.invariant("small", integrand);
    let _ = m.reg("forgotten", 3);
}
