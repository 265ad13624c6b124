//! Proofs at one width at a time.

use std::fmt::Write as _;
use std::ops::RangeInclusive;

use crate::models::{Model, Options};
use crate::study::proof::{Block, Narrower, ProofError, Way, blocks};
use rayon::prelude::*;

use super::replay::refuted;
use super::verdict::{Claim, Scope};
use super::{Job, SEARCHED, tell};
use crate::Error;
use crate::commands::progress::Progress;

/// Bits of coordinates at which a model is proved unless the user says otherwise.
const PROVED: RangeInclusive<u32> = 1..=16;

/// Every kind of geometry at each of these widths.
pub(super) fn followed(
    model: &'static Model,
    choices: &Options,
    narrower: &Narrower,
    ks: Vec<u32>,
    way: Way,
) -> Result<Vec<Block>, ProofError> {
    let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
    let progress = Progress::of(ks.len() as u64, "widths");
    let each = ks.into_par_iter().map(|k| {
        let blocks = blocks(model, &claims, choices, narrower, k, way);
        progress.add(1);
        blocks
    });
    Ok(each.collect::<Result<Vec<_>, _>>()?.concat())
}

/// A block that cannot be followed is not proved, and not refuted; all else is bad input.
pub(super) fn unfollowed(error: ProofError, told: impl Fn(ProofError) -> Error) -> Error {
    match error {
        lost @ ProofError::Lost { .. } => {
            Error::Check(vec![format!("UNKNOWN, no counterexample and no proof: {lost}")])
        }
        other => told(other),
    }
}

/// What blocks that were followed are about: a hardware for each of these widths.
pub(super) fn scope(job: &Job<'_>, blocks: &[Block]) -> Scope {
    let mut ks: Vec<u32> = blocks.iter().map(|block| block.k).collect();
    ks.dedup();
    let k = match ks[..] {
        [k] => format!("k = {k}"),
        [first, .., last] if ks.iter().copied().eq(first..=last) => format!("k = {first} to {last}"),
        _ => format!("k = {}", ks.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")),
    };
    let about = format!("{}: {}, at {k}", job.hardware(), job.claims.geometries.describe());
    Scope { about, widths: format!("at {k}") }
}

/// What they show, in words; fails where one of them does not end as it should.
pub(super) fn judge(scope: &Scope, blocks: &[Block]) -> Result<String, Error> {
    let wrong: Vec<String> = blocks.iter().filter(|block| !block.is_exact()).map(Block::to_string).collect();
    if !wrong.is_empty() {
        return Err(Error::Check(vec![format!("not proved: {}: {}", Claim::Exact.name(), wrong.join("; "))]));
    }
    let mut text = format!("{}\n", scope.about);
    for claim in Claim::ALL {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "PROVED {}: {}", scope.widths, claim.name());
    }
    let clocks: u64 = blocks.iter().map(|block| block.clocks).sum();
    let _ = writeln!(text, "{} blocks followed for {clocks} clocks with unknown coefficients", blocks.len());
    Ok(text)
}

/// Attempts a proof at each width.
pub(super) fn attempt(job: &Job<'_>) -> Result<(), Error> {
    let Job { args, model, choices, narrower, .. } = job;
    if args.any_preset {
        return Err(Error::Invalid(format!("{} has no remainder to preset: leave --any-preset out", model.name)));
    }
    let certificate = job.certificate()?;
    let ks: Vec<u32> = args.bits.map_or(PROVED, |k| k..=k).collect();
    let found = followed(model, choices, narrower, ks.clone(), Way::Follow);
    if !found.as_ref().is_ok_and(|blocks| blocks.iter().all(Block::is_exact))
        && let Some(example) = job.search(choices, args.bits.map_or(SEARCHED, |k| k..=k)).found
    {
        return refuted(args, model, &example);
    }
    let told = |error| unfollowed(error, |error| args.hardware.explain_study(error));
    let blocks = found.map_err(told)?;
    // They are not believed: what counts is what the second way comes to.
    if followed(model, choices, narrower, ks, Way::Recount).map_err(told)? != blocks {
        let model = model.name;
        return Err(Error::Check(vec![format!("not proved: {model} pulse by pulse comes to something else")]));
    }
    let text = judge(&scope(job, &blocks), &blocks)?;
    certificate.write(job.options(), Vec::new(), blocks.iter().map(Block::to_string).collect())?;
    tell(args, &text)
}
