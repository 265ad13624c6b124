//! Bounds of registers over a box of lines or arcs, concluded from what is proved for every k: narrower than 2^k where the
//! box is.
//!
//! A register that only holds or counts down its load word stays between 0 and that word. A position goes from end to end
//! without turning back. And what is proved to hold between two steps bounds a register by others: F >= -ye, say.

use std::collections::BTreeMap;

use stepwave_models::{AXES, Machine, Model};
use stepwave_nc::Curve;
use stepwave_netlist::cells::Op;
use stepwave_netlist::formula::{Clause, Formula};
use stepwave_netlist::{Net, Netlist};

use crate::study::boxes::{Extent, Geometries};
use crate::study::{Grid, Range};

/// Least and greatest value.
type Bounds = (i128, i128);

/// Bounds of registers of a proved hardware over the box whose extreme geometries are given; registers without any are
/// left out.
pub(super) fn bounds(model: &Model, machine: &Machine, set: &Geometries, extent: &Extent) -> BTreeMap<String, Bounds> {
    let netlist = machine.design.netlist();
    let mut bounds = positions(set, extent);
    if !set.curves.iter().all(|curve| matches!(curve, Curve::Line(_))) {
        return bounds;
    }
    // Load words follow |dx| and |dy| up or down, so that they come to their extremes at those of the box.
    let mut loaded: BTreeMap<&str, Bounds> = BTreeMap::new();
    for (register, value) in set.curves.iter().flat_map(|curve| model.words(&set.hardware, curve)).flatten().flatten() {
        let own = loaded.entry(register).or_insert((value, value));
        *own = (own.0.min(value), own.1.max(value));
    }
    for (register, (least, greatest)) in loaded {
        let of = |falls| netlist.find(register).is_some_and(|named| keeps(netlist, named.net, register, falls));
        let signed = netlist.find(register).is_some_and(|named| named.format.is_signed());
        if of(false) || !signed && of(true) {
            // 0 after reset.
            bounds.insert(register.to_owned(), (least.min(0), greatest.max(0)));
        }
    }
    if let Some(own) = of_deviation(netlist, &bounds) {
        bounds.insert("f".to_owned(), own);
    }
    bounds
}

/// Where the position counters are.
fn positions(set: &Geometries, extent: &Extent) -> BTreeMap<String, Bounds> {
    let most = (1_i128 << set.k) - 1;
    let side = |axis: usize| match extent {
        Extent::Bits(_) => Some((-most, most)),
        Extent::Grid(Grid(ranges)) => ranges.get(axis).map(|range: &Range| {
            let [least, greatest] = [0, range.count() - 1].map(|place| i128::from(range.at(place)));
            (least.min(0), greatest.max(0))
        }),
    };
    AXES.iter().enumerate().filter_map(|(axis, name)| Some(((*name).to_owned(), side(axis)?))).collect()
}

/// The register takes its load word and holds it; or, if it may `fall`, takes off it what must not be more than it is.
fn keeps(netlist: &Netlist, register: Net, name: &str, falls: bool) -> bool {
    let Op::Register { next: Some(next), .. } = netlist.cell(register).op else { return false };
    let word = netlist.find(&format!("{name}_in")).map(|named| named.net);
    let mut pending = vec![next];
    while let Some(net) = pending.pop() {
        match netlist.cell(net).op {
            _ if net == register || Some(net) == word => {}
            Op::Mux { high, low, .. } => pending.extend([high, low]),
            Op::Sub(from, _) if falls && from == register => {}
            _ => return false,
        }
    }
    true
}

/// What the invariants say of the deviation F where all other registers are within these bounds.
fn of_deviation(netlist: &Netlist, bounds: &BTreeMap<String, Bounds>) -> Option<Bounds> {
    let flags: Vec<&str> =
        netlist.invariants.iter().flat_map(|clause| clause.any.iter().flat_map(Formula::names)).collect();
    let is_flag = |name: &&str| {
        netlist.find(name).is_some_and(|named| netlist.width(named.net).get() == 1) && !bounds.contains_key(*name)
    };
    let mut flags: Vec<&str> = flags.into_iter().filter(is_flag).collect();
    flags.sort_unstable();
    flags.dedup();
    let mut all: Option<Bounds> = None;
    for case in 0..1_u32 << flags.len().min(8) {
        let mut known = bounds.clone();
        for (place, flag) in flags.iter().enumerate() {
            let value = i128::from(case >> place & 1);
            known.insert((*flag).to_owned(), (value, value));
        }
        let (mut least, mut greatest): (Option<i128>, Option<i128>) = (None, None);
        for clause in &netlist.invariants {
            let (below, above) = of_clause(clause, &known)?;
            least = least.max(below);
            greatest = greatest.into_iter().chain(above).min();
        }
        // 0 after reset.
        let own = (least?.min(0), greatest?.max(0));
        all = Some(all.map_or(own, |all| (all.0.min(own.0), all.1.max(own.1))));
    }
    all
}

/// The least and the greatest F that a clause allows; `None` for either where it does not bound it.
fn of_clause(clause: &Clause, known: &BTreeMap<String, Bounds>) -> Option<(Option<i128>, Option<i128>)> {
    let (mut least, mut greatest) = (Some(i128::MAX), Some(i128::MIN));
    for formula in &clause.any {
        let (mut factor, mut rest) = (0_i128, 0_i128);
        let mut open = false;
        for (product, coefficient) in formula.terms() {
            match product {
                [] => rest = rest.checked_add(coefficient)?,
                [name] if name == "f" => factor = coefficient,
                [name] => match known.get(name) {
                    // The greatest value that the rest may have.
                    Some((low, high)) => {
                        let most = if coefficient > 0 { *high } else { *low };
                        rest = rest.checked_add(coefficient.checked_mul(most)?)?;
                    }
                    None => open = true,
                },
                _ => open = true,
            }
        }
        match factor {
            // This alternative cannot be.
            0 if !open && rest < 0 => {}
            1 if !open => {
                least = least.map(|least| least.min(-rest));
                greatest = None;
            }
            -1 if !open => {
                greatest = greatest.map(|greatest| greatest.max(rest));
                least = None;
            }
            _ => (least, greatest) = (None, None),
        }
    }
    // No alternative is left: nothing is like this.
    Some((least.filter(|least| *least != i128::MAX), greatest.filter(|greatest| *greatest != i128::MIN)))
}

#[cfg(test)]
mod tests {
    use stepwave_models::{Options, find};

    use super::*;
    use crate::testbench::Testbench;

    #[test]
    fn the_deviation_is_bounded_by_the_travels_of_the_box_exactly() {
        // F of a line is within [-b, a - 1]; of minimum deviation, that of 2S - L, within [-2L, 2S - 1].
        for (name, wanted) in [("ppc-line", (-200_000, 299_999)), ("mindev-line", (-600_000, 399_999))] {
            let model = find(name).expect("a model");
            let extent: Extent = "0..300000x0..200000".parse().expect("a box");
            let set = Geometries::extremes(model, &Options::default(), &extent).expect("geometries");
            let bench = Testbench::of_hardware(model, set.hardware.clone()).expect("hardware");
            let found = bounds(model, bench.machine(), &set, &extent);
            assert_eq!(found["f"], wanted, "{name}");
        }
    }
}
