//! Up/down counters: coordinates, integrands and positions.

use stepwave_netlist::dsl::{Register, Signal};

/// Closes an up/down counter: an arm of `loads` (condition, value) wins; else it counts `unit` up or down, which must
/// not leave its range: `register` keeps its width and reading, and the two counts are strict cells, flagged only at an
/// edge at which the register takes them.
///
/// `up` and `down` are 1 bit and never both 1; `unit` may be narrower than the register.
pub fn up_down_counter<'m>(
    register: Register<'m>,
    loads: &[(Signal<'m>, Signal<'m>)],
    up: Signal<'m>,
    down: Signal<'m>,
    unit: Signal<'m>,
) {
    let any_load = loads.iter().map(|(condition, _)| *condition).reduce(|a, b| a | b);
    // Where a load wins, what would not fit is not taken.
    let taken = |count: Signal<'m>| any_load.map_or(count, |load| count & !load);
    let sum = register.q.strict_add(unit, taken(up));
    let difference = register.q.strict_sub(unit, taken(down));
    let counting = up.mux(sum, down.mux(difference, register.q));
    match loads {
        [] => register.set(counting),
        [(condition, value), rest @ ..] => {
            let first = register.when(*condition, *value);
            rest.iter().fold(first, |chain, (condition, value)| chain.when(*condition, *value)).otherwise(counting);
        }
    }
}
