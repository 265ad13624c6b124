//! Counterexamples: geometries that the simulator itself runs into an overflow, past their end, or to a stand.

use std::ops::RangeInclusive;

use stepwave_models::{Choices, Claims, Model};
use stepwave_nc::Curve;

use super::{Narrower, choices_at};
use crate::testbench::{Ending, LaneOutcome, Testbench};

/// What a geometry shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault {
    /// A register overflows.
    Overflow,
    /// A word of the geometry does not fit in its register.
    Refused,
    /// The block ends elsewhere.
    Missed,
    /// The block never ends.
    Endless,
}

/// A geometry that refutes a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Counterexample {
    /// Bits of its coordinates.
    pub k: u32,
    /// The geometry.
    pub curve: Curve,
    /// The choices with which a run shows it.
    pub choices: Choices,
    /// What it shows.
    pub fault: Fault,
}

/// Geometries of each that are tried.
const TRIED: usize = 20_000;
/// Clocks after which a run counts as endless.
const LIMIT: u64 = 1 << 22;

/// The first geometry of these numbers of bits that shows a fault which is `wanted`; small ones come first.
#[must_use]
pub fn search(
    model: &'static Model,
    claims: &Claims,
    choices: &Choices,
    narrower: &Narrower,
    ks: RangeInclusive<u32>,
    wanted: impl Fn(Fault) -> bool,
) -> Option<Counterexample> {
    ks.into_iter().find_map(|k| search_at(model, claims, choices, narrower, k, &wanted))
}

fn search_at(
    model: &'static Model,
    claims: &Claims,
    choices: &Choices,
    narrower: &Narrower,
    k: u32,
    wanted: &impl Fn(Fault) -> bool,
) -> Option<Counterexample> {
    let own = choices_at(model, claims, choices, narrower, k).ok()?;
    let hardware = model.plan(&claims.geometries.largest(k)?, &own).ok()?;
    let bench = Testbench::of_hardware(model, hardware).ok()?;
    let kinds = claims.geometries.kinds();
    let mut curves = claims.geometries.curves(k, TRIED);
    curves.retain(|curve| kinds.iter().any(|kind| claims.geometries.symbols(kind, curve).is_some()));
    let coordinates = |curve: &Curve| [curve.from(), curve.to()].concat();
    curves.sort_by_key(|curve| {
        let negative = coordinates(curve).iter().filter(|coordinate| **coordinate < 0).count();
        (coordinates(curve).iter().map(|coordinate| coordinate.abs()).sum::<i64>(), negative)
    });
    let outcomes = bench.run_many(&curves, LIMIT).ok()?;
    curves.into_iter().zip(outcomes).find_map(|(curve, outcome)| {
        let fault = match outcome {
            Ok(outcome) => fault(&curve, &outcome)?,
            Err(_) => Fault::Refused,
        };
        wanted(fault).then(|| Counterexample { k, curve, choices: own.clone(), fault })
    })
}

fn fault(curve: &Curve, outcome: &LaneOutcome) -> Option<Fault> {
    match outcome.ending {
        Some(Ending::Trapped) => Some(Fault::Overflow),
        Some(Ending::Done) if outcome.overflows > 0 => Some(Fault::Overflow),
        Some(Ending::Done) => (outcome.reached != curve.to()).then_some(Fault::Missed),
        Some(Ending::Stalled { .. } | Ending::Endless { .. }) => Some(Fault::Endless),
        Some(Ending::Limit) | None => None,
    }
}
