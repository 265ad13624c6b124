//! Proofs at one width at a time.

use std::fmt::Write as _;
use std::ops::RangeInclusive;

use rayon::prelude::*;
use stepwave::models::{Choices, Model};
use stepwave::study::proof::{Block, Narrower, ProofError, Way, blocks};

use super::replay::refuted;
use super::verdict::Claim;
use super::{Job, SEARCHED};
use crate::failure::Failure;
use crate::output;

/// Bits of coordinates at which a model is proved unless the user says otherwise.
const PROVED: RangeInclusive<u32> = 1..=16;

/// Every kind of geometry at each of these widths.
pub(super) fn followed(
    model: &'static Model,
    choices: &Choices,
    narrower: &Narrower,
    ks: Vec<u32>,
    way: Way,
) -> Result<Vec<Block>, Failure> {
    let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
    let each = ks.into_par_iter().map(|k| blocks(model, &claims, choices, narrower, k, way));
    match each.collect::<Result<Vec<_>, _>>() {
        Ok(all) => Ok(all.concat()),
        Err(lost @ ProofError::Lost { .. }) => {
            Err(Failure::Check(vec![format!("UNKNOWN, no counterexample and no proof: {lost}")]))
        }
        Err(error) => Err(error.into()),
    }
}

/// Tells of blocks that were followed, and fails where one of them does not end as it should.
pub(super) fn judge(model: &Model, blocks: &[Block], what: &str) -> Result<(), Failure> {
    let about = model.claims.map_or("", |claims| claims.geometries.describe());
    let mut ks: Vec<u32> = blocks.iter().map(|block| block.k).collect();
    ks.dedup();
    let k = match ks[..] {
        [] => return Err(Failure::Check(vec![format!("{what} are none: nothing is proved")])),
        [k] => format!("k = {k}"),
        [first, .., last] if ks.iter().copied().eq(first..=last) => format!("k = {first} to {last}"),
        _ => format!("k = {}", ks.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")),
    };
    let wrong: Vec<String> = blocks.iter().filter(|block| !block.is_exact()).map(Block::to_string).collect();
    let mut text = format!("{}: {about}, at {k}\n", model.name);
    for claim in Claim::ALL {
        let proved = claim != Claim::Exact || wrong.is_empty();
        let verdict = if proved { format!("PROVED at {k}") } else { "not proved".to_owned() };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{verdict}: {}", claim.name());
    }
    let clocks: u64 = blocks.iter().map(|block| block.clocks).sum();
    let _ = writeln!(text, "{} blocks followed for {clocks} clocks with unknown coefficients", blocks.len());
    output::print(&text)?;
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Failure::Check(vec![format!("not proved: {}: {}", Claim::Exact.name(), wrong.join("; "))]))
}

/// Attempts a proof at each width.
pub(super) fn attempt(job: &Job<'_>) -> Result<(), Failure> {
    let Job { args, model, choices, narrower, .. } = job;
    if args.any_preset {
        return Err(Failure::Trouble(format!("{} has no remainder to preset: leave --any-preset out", model.name)));
    }
    let certificate = job.certificate()?;
    let ks: Vec<u32> = args.bits.map_or(PROVED, |k| k..=k).collect();
    let found = followed(model, choices, narrower, ks.clone(), Way::Follow);
    if !found.as_ref().is_ok_and(|blocks| blocks.iter().all(Block::is_exact))
        && let Some(example) = job.counterexample(choices, args.bits.map_or(SEARCHED, |k| k..=k))
    {
        return refuted(args, model, &example);
    }
    let blocks = found?;
    // They are not believed: what counts is what the second way comes to.
    if followed(model, choices, narrower, ks, Way::Recount)? != blocks {
        let model = model.name;
        return Err(Failure::Check(vec![format!("not proved: {model} pulse by pulse comes to something else")]));
    }
    judge(model, &blocks, "the blocks that were followed")?;
    certificate.write(choices.options(), Vec::new(), blocks.iter().map(Block::to_string).collect())
}
