//! Certificates, checked alone: nothing is looked for.

use rayon::prelude::*;

use super::verdict::{Attempt, Scope, Verdict};
use super::{Block, CertificateFile, CountMethod, Effort, FileError, ProofError, Proposition};

/// Why a text proves nothing.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// It is not a certificate.
    #[error("no certificate: {0}")]
    File(#[from] FileError),
    /// It is about something that cannot be checked.
    #[error(transparent)]
    Proof(#[from] ProofError),
    /// The blocks in it are not those that the second method comes to.
    #[error("does not say what its blocks come to")]
    Blocks,
    /// Its widths are of no family.
    #[error("does not prove: its hardware is no family for every k")]
    NoFamily,
}

/// Checks a certificate: every step of it is multiplied out in exact arithmetic, every block in it counted anew.
///
/// # Errors
/// See [`CheckError`]. What the certificate leaves open is not an error: [`Verdict::is_proved`] says it.
pub fn check(text: &str) -> Result<Verdict, CheckError> {
    check_with(text, &Effort::default())
}

/// As [`check`], with a watcher.
///
/// # Errors
/// As [`check`].
pub fn check_with(text: &str, effort: &Effort<'_>) -> Result<Verdict, CheckError> {
    let file: CertificateFile = text.parse()?;
    let proposition = &file.proposition;
    let claims = proposition.claims()?;
    proposition.check()?;
    if claims.counted.is_empty() { check_steps(proposition, &file) } else { check_blocks(proposition, &file, effort) }
}

/// Blocks that were followed at some widths: they are counted anew.
fn check_blocks(proposition: &Proposition, file: &CertificateFile, effort: &Effort<'_>) -> Result<Verdict, CheckError> {
    let mut ks: Vec<u32> = Vec::new();
    for block in &file.counted {
        let k = block.split(' ').next().and_then(|k| k.parse().ok()).filter(|k| (1..=20).contains(k));
        ks.push(k.ok_or_else(|| FileError::Counted(block.clone()))?);
    }
    ks.dedup();
    let geometries = proposition.claims()?.geometries;
    // Whatever follows takes its time for every width.
    if ks.is_empty() || !ks.is_sorted() || file.counted.len() != ks.len() * geometries.kinds().len() {
        return Err(CheckError::Blocks);
    }
    // What does not even say that every axis ends where it should is not worth it.
    let wanted = match proposition.followed(effort, ks.clone(), CountMethod::Wanted) {
        Ok(wanted) => wanted,
        Err(error) => return Ok(proposition.unfollowed(error)?),
    };
    let ends = |block: &str| {
        let (head, rest) = block.split_once(" clocks=")?;
        let (clocks, ends) = rest.split_once(' ')?;
        clocks.parse::<u64>().ok().map(|_| (head.to_owned(), ends.to_owned()))
    };
    let as_wanted =
        |(block, line): (&Block, &String)| ends(line).is_some_and(|own| ends(&block.to_string()) == Some(own));
    if !wanted.iter().zip(&file.counted).all(as_wanted) {
        return Err(CheckError::Blocks);
    }
    let blocks = match proposition.followed(effort, ks, CountMethod::Recount) {
        Ok(blocks) => blocks,
        Err(error) => return Ok(proposition.unfollowed(error)?),
    };
    if blocks.iter().map(Block::to_string).ne(file.counted.iter().cloned()) {
        return Err(CheckError::Blocks);
    }
    let scope = match proposition.bounds() {
        Some(extent) => {
            let fixed = proposition.fixed(extent)?;
            if blocks.iter().any(|block| block.k != fixed.k()) || fixed.blocks(CountMethod::Recount).is_none() {
                return Err(CheckError::Blocks);
            }
            Scope::of_fixed(proposition, &fixed)
        }
        None => Scope::of_blocks(proposition, geometries.describe(), &blocks),
    };
    Ok(proposition.by_blocks(scope, blocks))
}

/// Kinds of geometry that were proved step by step.
fn check_steps(proposition: &Proposition, file: &CertificateFile) -> Result<Verdict, CheckError> {
    let fixed = proposition.bounds().map(|extent| proposition.fixed(extent)).transpose()?;
    let (subject, scope) = match &fixed {
        Some(fixed) => (fixed.subject().ok_or(CheckError::NoFamily)?, Scope::of_fixed(proposition, fixed)),
        None => {
            let subject = proposition.subject()?;
            let scope = Scope::of_family(proposition, &subject);
            (subject, scope)
        }
    };
    let kinds = subject.kinds();
    if let Some((other, _)) = file.kinds.iter().find(|(other, _)| kinds.iter().all(|kind| kind.name != *other)) {
        let kind = other.chars().take(60).collect();
        return Err(FileError::NoKind { model: proposition.model.name, kind }.into());
    }
    let attempts: Vec<Attempt> = kinds
        .into_par_iter()
        .map(|kind| {
            let own = file.kinds.iter().find(|(other, _)| *other == kind.name);
            let certificate = own.map(|(_, certificate)| certificate.clone()).unwrap_or_default();
            Ok((kind.clone(), subject.check(&kind, &certificate)?, certificate))
        })
        .collect::<Result<_, ProofError>>()?;
    Ok(proposition.by_steps(scope, attempts))
}
