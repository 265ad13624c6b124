//! Counterexamples: geometries that the simulator itself runs into an overflow, past their end, or to a stand.

use std::ops::RangeInclusive;

use stepwave_models::{Claims, Model, ModelError, Options};
use stepwave_nc::Curve;

use super::{Narrower, choices_at, hardware_at};
use crate::testbench::{Ending, LaneOutcome, Testbench, is_ended};

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
    pub choices: Options,
    /// What it shows.
    pub fault: Fault,
}

/// What came of the geometries of one number of bits.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tried {
    /// Bits of coordinates.
    pub k: u32,
    /// Geometries that were tried.
    pub geometries: usize,
    /// They are all that there are.
    pub all: bool,
    /// Those that ran to their end as it is claimed.
    pub as_claimed: usize,
    /// Those that the hardware does not take, so that nothing is known of them.
    pub refused: usize,
    /// Why the first of them is not taken, or why there is no such hardware at all.
    pub refusal: Option<String>,
    /// Those whose run was given up after some million clocks.
    pub given_up: usize,
}

impl Tried {
    /// Every geometry that there is was simulated, and did as claimed.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.all && self.as_claimed == self.geometries && self.geometries > 0
    }
}

/// What a search came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// The first geometry that shows a fault that was wanted; small ones come first.
    pub found: Option<Counterexample>,
    /// What else was tried, by bits of coordinates, up to where the search ended.
    pub tried: Vec<Tried>,
}

/// Geometries of each number of bits that are tried.
const TRIED: usize = 20_000;
/// Clocks after which a run is given up.
const LIMIT: u64 = 1 << 22;
/// Geometries that run before one looks whether a fault was found.
const CHUNK: usize = 1 << 13;

/// Simulates the geometries of these numbers of bits until one shows a fault that is `wanted`.
#[must_use]
pub fn search(
    model: &'static Model,
    claims: &Claims,
    choices: &Options,
    narrower: &Narrower,
    ks: RangeInclusive<u32>,
    wanted: impl Fn(Fault) -> bool,
) -> Survey {
    let mut survey = Survey::default();
    for k in ks {
        let mut tried = Tried { k, ..Tried::default() };
        match search_at(model, claims, choices, narrower, &mut tried, &wanted) {
            Ok(None) => survey.tried.push(tried),
            Ok(found) => return Survey { found, ..survey },
            Err(error) => survey.tried.push(Tried { k, refusal: Some(error.to_string()), ..Tried::default() }),
        }
    }
    survey
}

fn search_at(
    model: &'static Model,
    claims: &Claims,
    choices: &Options,
    narrower: &Narrower,
    tried: &mut Tried,
    wanted: &impl Fn(Fault) -> bool,
) -> Result<Option<Counterexample>, ModelError> {
    let k = tried.k;
    let own = choices_at(model, claims, choices, narrower, k)?;
    let bench = Testbench::of_hardware(model, hardware_at(model, claims, &own, k)?)?;
    let kinds = claims.geometries.kinds();
    let mut curves = claims.geometries.curves(k, TRIED);
    tried.all = claims.geometries.is_whole(k) && curves.len() < TRIED;
    curves.retain(|curve| kinds.iter().any(|kind| claims.geometries.symbols(kind, curve).is_some()));
    let found = try_all(&bench, curves, LIMIT, tried, wanted, |_| {})?;
    Ok(found.map(|(curve, fault)| Counterexample { k, curve, choices: own, fault }))
}

/// Runs geometries of one hardware, small ones first and each for about `limit` clocks, until one shows a fault that is
/// `wanted`; `progress` gets how many are done.
pub(super) fn try_all(
    bench: &Testbench,
    mut curves: Vec<Curve>,
    limit: u64,
    tried: &mut Tried,
    wanted: &impl Fn(Fault) -> bool,
    mut progress: impl FnMut(usize),
) -> Result<Option<(Curve, Fault)>, ModelError> {
    let coordinates = |curve: &Curve| [curve.from(), curve.to()].concat();
    curves.sort_by_cached_key(|curve| {
        let negative = coordinates(curve).iter().filter(|coordinate| **coordinate < 0).count();
        (coordinates(curve).iter().map(|coordinate| coordinate.abs()).sum::<i64>(), negative)
    });
    tried.geometries += curves.len();
    for (place, chunk) in curves.chunks(CHUNK).enumerate() {
        progress(place * CHUNK);
        for (curve, outcome) in chunk.iter().zip(bench.run_many(chunk, limit)?) {
            let fault = match outcome {
                Ok(LaneOutcome { ending: Some(Ending::Limit) | None, .. }) => {
                    tried.given_up += 1;
                    continue;
                }
                Ok(outcome) => fault(curve, &outcome),
                Err(error) => {
                    tried.refused += 1;
                    tried.refusal.get_or_insert_with(|| error.to_string());
                    Some(Fault::Refused)
                }
            };
            match fault {
                Some(fault) if wanted(fault) => return Ok(Some((curve.clone(), fault))),
                Some(_) => {}
                None => tried.as_claimed += 1,
            }
        }
    }
    Ok(None)
}

fn fault(curve: &Curve, outcome: &LaneOutcome) -> Option<Fault> {
    match outcome.ending {
        Some(Ending::Trapped) => Some(Fault::Overflow),
        Some(Ending::Done) if outcome.overflows > 0 => Some(Fault::Overflow),
        Some(Ending::Done) => {
            (!is_ended(&curve.description(), &outcome.reached, &outcome.pulses)).then_some(Fault::Missed)
        }
        Some(Ending::Stalled { .. } | Ending::Endless { .. }) => Some(Fault::Endless),
        Some(Ending::Limit) | None => None,
    }
}
