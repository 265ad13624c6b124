//! What every run of a box shows of hardware whose author claims nothing else: a proof by exhaustion, or a counterexample.

use rayon::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::{Model, Options};
use stepwave_nc::Curve;

use super::boxes::{Extent, Geometries};
use super::proof::ProofError;
use super::widths::LIMIT;
use crate::testbench::{Ending, OverflowWatch, Testbench, missed};

/// Runs that are made at once.
const CHUNK: usize = 1 << 10;

/// What the runs of a box came to.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Exhausted {
    /// Runs until the first that failed, or all.
    pub simulated: usize,
    /// The geometries are all of the box; else the extreme ones.
    pub all: bool,
    /// The first geometry of which something is wrong: it does not end, misses its end point, is refused, or violates a
    /// property that is not announced.
    pub example: Option<Curve>,
    /// What is wrong of it on the hardware of the whole box; empty without one.
    pub why: String,
}

/// Runs the geometries of a box until one fails.
///
/// # Errors
/// There is no such box for the model, or the hardware cannot be built.
pub fn exhausted(
    model: &'static Model,
    choices: &Options,
    extent: &Extent,
    tick: &(dyn Fn(u64) + Sync),
) -> Result<Exhausted, ProofError> {
    let Geometries { curves, all, hardware, .. } = Geometries::of(model, choices, extent)?;
    let bench = Testbench::of_hardware(model, hardware)?;
    let mut simulated = 0;
    for chunk in curves.chunks(CHUNK) {
        let failure = |curve: &Curve| {
            let failure = failure(model, &bench, curve);
            tick(1);
            failure.map(|why| (curve.clone(), why))
        };
        if let Some((example, why)) = chunk.par_iter().find_map_first(failure) {
            return Ok(Exhausted { simulated: simulated + 1, all, example: Some(example), why });
        }
        simulated += chunk.len();
    }
    Ok(Exhausted { simulated, all, example: None, why: String::new() })
}

/// What is wrong with a run, in a sentence.
fn failure(model: &Model, bench: &Testbench, curve: &Curve) -> Option<String> {
    let bench = match bench.of(model, curve) {
        Ok(bench) => bench.limited(LIMIT),
        Err(error) => return Some(error.to_string()),
    };
    let mut overflows = OverflowWatch::new(&bench);
    let outcome = match bench.run(EngineKind::Word, &mut [&mut overflows]) {
        Ok(outcome) => outcome,
        Err(error) => return Some(error.to_string()),
    };
    if let Some(tally) = overflows.tallies().first() {
        return Some(tally.sentence());
    }
    if outcome.ending != Ending::Done {
        return Some(format!("it has not ended after {} clocks", outcome.clocks));
    }
    (!outcome.ends(curve)).then(|| missed(curve.to(), &outcome.reached))
}
