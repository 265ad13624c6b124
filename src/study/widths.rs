//! The least width of every register over all geometries of a box, and a geometry that one bit less does not hold.

use std::collections::BTreeMap;

use rayon::prelude::*;
use stepwave_kernel::bits::to_signed;
use stepwave_kernel::engine::EngineKind;
use stepwave_kernel::engine::lanes::{LaneProgram, LaneWatch, Observe};
use stepwave_kernel::{Net, Width};
use stepwave_models::{Choices, Claims, Model, ModelError};
use stepwave_nc::Curve;

use super::boxes::{Extent, Geometries};
use super::proof::{Block, Narrower, ProofError, Subject, Way, blocks};
use crate::testbench::{Ending, RangeWatch, Testbench};

/// How the width of a register is known to be enough.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Known {
    /// Proved for every k, relative to k.
    Proved,
    /// Proved at this width alone.
    ProvedHere,
    /// Every geometry of the box was simulated.
    Exhaustive,
    /// Some were.
    Sampled,
}

/// What a register needs.
#[derive(Clone, Debug, PartialEq)]
pub struct RegisterWidth {
    /// Its name.
    pub name: String,
    /// Its width by default.
    pub given: u32,
    /// The bits that the values seen need.
    pub needed: u32,
    /// Least and greatest value seen.
    pub range: (i128, i128),
    /// How that is known to be enough.
    pub known: Known,
    /// A geometry that one bit less does not hold, with the choices of a run that shows it.
    pub witness: Option<(Curve, Choices)>,
}

/// Least widths over a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Widths {
    /// The box.
    pub extent: Extent,
    /// Bits of coordinates.
    pub k: u32,
    /// Geometries that were simulated.
    pub simulated: usize,
    /// They are all of the box.
    pub all: bool,
    /// Geometries that end in a fault at the default widths.
    pub faults: usize,
    /// Every register with a width to choose, by name.
    pub registers: Vec<RegisterWidth>,
}

/// Clocks after which a run is given up.
const LIMIT: u64 = 1 << 24;

/// What was seen of a register: least and greatest value, and where.
#[derive(Clone)]
struct Seen {
    least: (i128, usize),
    greatest: (i128, usize),
}

/// The least widths of a model's registers over a box of geometries: every line from the origin, every arc inside a
/// quadrant with both ends on the circle, every quarter of an ellipse and every arc of a parabola or hyperbola from or to
/// its vertex, or every helix over such an arc.
///
/// # Errors
/// There is no such box for the model, or the hardware cannot be built.
pub fn widths(model: &'static Model, choices: &Choices, extent: &Extent) -> Result<Widths, ProofError> {
    let Geometries { curves, all, k, hardware, choices: wide } = Geometries::of(model, choices, extent)?;
    let bench = Testbench::of_hardware(model, hardware)?;
    let (seen, faults) = simulate(&bench, &curves)?;

    let netlist = bench.design().netlist();
    let mut registers: Vec<RegisterWidth> = Vec::new();
    for (name, seen) in seen {
        let signed = netlist.find(&name).is_some_and(|named| named.format.is_signed());
        let needs = |value: i128| Width::needed(value, signed);
        let (least, greatest) = (needs(seen.least.0), needs(seen.greatest.0));
        let worst = if least > greatest { seen.least.1 } else { seen.greatest.1 };
        let needed = least.max(greatest);
        let given = bench.hardware().bits(&name);
        registers.push(RegisterWidth {
            witness: witness(model, &wide, &name, needed, &curves[worst]),
            range: (seen.least.0, seen.greatest.0),
            known: if all { Known::Exhaustive } else { Known::Sampled },
            name,
            given,
            needed,
        });
    }
    if let Some(claims) = model.claims.filter(|_| bench.hardware().axes == 2) {
        mark_proved(model, &claims, choices, k, &mut registers);
    }
    Ok(Widths { extent: extent.clone(), k, simulated: curves.len(), all, faults, registers })
}

/// Least and greatest value of every register with a width to choose, by name, and how many runs ended in a fault.
fn simulate(bench: &Testbench, curves: &[Curve]) -> Result<(BTreeMap<String, Seen>, usize), ModelError> {
    let (machine, netlist) = (bench.machine(), bench.design().netlist());
    let names = bench.hardware().widths.keys();
    let registers: Vec<(String, Net, bool)> = names
        .filter_map(|name| netlist.find(name).map(|named| (name.clone(), named.net, named.format.is_signed())))
        .collect();
    let ends =
        registers.iter().flat_map(|&(_, net, signed)| [Observe::Min { net, signed }, Observe::Max { net, signed }]);
    let watch = LaneWatch {
        traps: netlist.properties.iter().map(|property| property.never).collect(),
        rest: vec![(machine.load.net, 0), (machine.preset_position.net, 0)],
        observe: ends.collect(),
        limit: LIMIT,
        ..LaneWatch::new(machine.done.net)
    };
    let program = LaneProgram::new(bench.design(), &watch);
    let lanes = bench.lanes(LIMIT)?;
    let (mut seen, mut faults, mut place) = (BTreeMap::<String, Seen>::new(), 0, 0);
    let prepare = |curve: &Curve| lanes.job(curve);
    program.run(curves.iter(), prepare, |end: Result<_, ModelError>| {
        match end {
            Ok(end) if end.stop == stepwave_kernel::engine::lanes::LaneStop::Done => {
                for ((name, net, signed), pair) in registers.iter().zip(end.values.chunks(2)) {
                    let width = netlist.width(*net);
                    let number =
                        |bits: u64| if *signed { i128::from(to_signed(width, bits)) } else { i128::from(bits) };
                    let (least, greatest) = (number(pair[0]), number(pair[1]));
                    let own =
                        seen.entry(name.clone()).or_insert(Seen { least: (least, place), greatest: (greatest, place) });
                    if least < own.least.0 {
                        own.least = (least, place);
                    }
                    if greatest > own.greatest.0 {
                        own.greatest = (greatest, place);
                    }
                }
            }
            _ => faults += 1,
        }
        place += 1;
    });
    Ok((seen, faults))
}

/// Least and greatest value of every register over single runs of these curves on one engine, one after another instead of
/// in lanes: what [`widths`] is judged by. Runs that do not come to their end are left out.
///
/// # Errors
/// A value does not fit in its register.
pub fn ranges_alone(
    model: &Model,
    bench: &Testbench,
    curves: &[Curve],
    engine: EngineKind,
) -> Result<BTreeMap<String, (i128, i128)>, ModelError> {
    type Ranges = BTreeMap<String, (i128, i128)>;
    let joined = |mut all: Ranges, one: Ranges| {
        for (name, (least, greatest)) in one {
            let own = all.entry(name).or_insert((least, greatest));
            *own = (own.0.min(least), own.1.max(greatest));
        }
        Ok(all)
    };
    let alone = |curve: &Curve| {
        let bench = bench.of(model, curve)?.limited(LIMIT);
        let mut watch = RangeWatch::new(&bench);
        let outcome = bench.run(engine, &mut [&mut watch]);
        if outcome.is_ok_and(|outcome| outcome.ending != Ending::Done) {
            return Ok(Ranges::new());
        }
        Ok(watch.finish().into_iter().map(|range| (range.name, (range.least, range.greatest))).collect())
    };
    curves.par_iter().map(alone).try_reduce(Ranges::new, joined)
}

/// The choices of a run of this curve that one bit less does not hold: it is refused, or traps.
fn witness(model: &Model, wide: &Choices, name: &str, needed: u32, curve: &Curve) -> Option<(Curve, Choices)> {
    let below = Width::new(u64::from(needed.checked_sub(1)?)).ok()?;
    let mut choices = wide.clone();
    choices.widths.insert(name.to_owned(), below);
    let shown = match Testbench::new(model, curve, &choices) {
        Err(ModelError::DoesNotFit { .. }) => true,
        Err(_) => false,
        Ok(bench) => {
            let outcome = bench.run(EngineKind::Word, &mut []);
            outcome.is_ok_and(|outcome| outcome.ending == Ending::Trapped)
        }
    };
    shown.then(|| (curve.clone(), choices))
}

/// Marks what a proof for every k, or for this one, shows: the widths needed here, as so many bits less than by default,
/// are enough.
fn mark_proved(model: &'static Model, claims: &Claims, choices: &Choices, k: u32, registers: &mut [RegisterWidth]) {
    debug_assert_eq!(model.claims.map(|own| own.geometries), Some(claims.geometries));
    let less = |register: &RegisterWidth| register.given.saturating_sub(register.needed);
    let narrower: Narrower =
        registers.iter().filter(|register| less(register) > 0).map(|r| (r.name.clone(), less(r))).collect();
    if !claims.counted.is_empty() {
        let exact = |block: &Block| block.is_exact();
        if blocks(model, claims, choices, &narrower, k, Way::Follow).is_ok_and(|blocks| blocks.iter().all(exact)) {
            registers.iter_mut().for_each(|register| register.known = Known::ProvedHere);
        }
        return;
    }
    let Ok(subject) = Subject::new(model, choices, &narrower) else { return };
    let safe = |kind| subject.prove(&kind).is_ok_and(|(proof, _)| proof.is_safe());
    if subject.kinds().into_par_iter().all(safe) {
        registers.iter_mut().for_each(|register| register.known = Known::Proved);
    }
}
