//! Netlists of any size: a chain of integrators, each with an integrand that grows with the carries of the one before.

use stepwave::netlist::dsl::{Module, Scope, Signal};
use stepwave::netlist::{Net, elaborate};

use crate::Fallible;
use crate::unit::Unit;

const BITS: u32 = 24;

/// A netlist of about this many cells.
pub(crate) fn chain(cells: usize) -> Fallible<Unit> {
    let (one, two) = (integrators(1)?, integrators(2)?);
    let count = |unit: &Unit| unit.design.netlist().cells.len();
    let (first, further) = (count(&one), count(&two) - count(&one));
    integrators(1 + cells.saturating_sub(first).div_ceil(further))
}

fn integrators(count: usize) -> Fallible<Unit> {
    let module = Module::new("chain");
    let m = module.top();
    let (load, clocks) = (m.input("load", 1), m.input("clocks", 32));
    let left = m.reg("left", 32);
    left.when(load, clocks).otherwise(left.q.wrapping_sub(m.lit(32, 1)));
    let done = m.reg("done", 1);
    done.set(left.q.equals(m.lit(32, 1)));
    let mut carry = m.lit(1, 1);
    let mut check = m.lit(BITS, 0);
    for index in 0..count {
        let (next, remainder) = integrator(m.scope(&format!("i{index}")), carry, index as u64);
        carry = next;
        check = check ^ remainder;
    }
    let check = m.name("check", check);
    let (load, done, check) = (load.net(), done.q.net(), check.net());
    let design = elaborate(module.finish()?)?;
    Ok(Unit {
        design,
        outputs: vec![done, check],
        strobes: vec![load],
        done,
        result: vec![(check, false)],
        source: None,
    })
}

fn integrator<'m>(m: Scope<'m>, grow: Signal<'m>, index: u64) -> (Signal<'m>, Signal<'m>) {
    let integrand = m.reg("jv", BITS).reset((0x0051_7cc1 * (index + 1)) & 0xff_ffff);
    integrand.set(integrand.q.wrapping_add(grow.extend(BITS)));
    let remainder = m.reg("jr", BITS);
    let (carry, sum) = remainder.q.carrying_add(integrand.q);
    remainder.set(sum);
    (carry, remainder.q)
}

/// The block that runs this many clocks.
pub(crate) fn block(unit: &Unit, clocks: u64) -> Vec<(Net, u64)> {
    let inputs = unit.design.inputs().iter().filter(|net| !unit.strobes.contains(net));
    inputs.map(|&net| (net, clocks)).collect()
}
