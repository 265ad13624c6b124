//! What every run of a box shows of hardware whose author claims nothing else: a proof by exhaustion, or a counterexample.

use rayon::prelude::*;
use stepwave_engine::EngineKind;
use stepwave_models::{Model, Options};
use stepwave_nc::Curve;

use super::boxes::{Extent, Geometries};
use super::proof::ProofError;
use super::widths::LIMIT;
use crate::testbench::{Ending, OverflowWatch, Testbench};

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
        let fails = |curve: &&Curve| {
            let fails = fails(model, &bench, curve);
            tick(1);
            fails
        };
        if let Some(example) = chunk.par_iter().find_first(fails) {
            return Ok(Exhausted { simulated: simulated + 1, all, example: Some(example.clone()) });
        }
        simulated += chunk.len();
    }
    Ok(Exhausted { simulated, all, example: None })
}

fn fails(model: &Model, bench: &Testbench, curve: &Curve) -> bool {
    let Ok(bench) = bench.of(model, curve) else { return true };
    let bench = bench.limited(LIMIT);
    let mut overflows = OverflowWatch::new(&bench);
    // Nothing in it can fail.
    let outcome = bench.run(EngineKind::Word, &mut [&mut overflows]);
    outcome
        .map_or(true, |outcome| outcome.ending != Ending::Done || outcome.reached != curve.to() || overflows.count > 0)
}
