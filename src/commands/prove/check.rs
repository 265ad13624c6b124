//! Certificates, checked alone.

use std::fs::File;
use std::io::Read as _;
use std::path::{Display, Path};

use crate::models::find;
use crate::study::proof::{Block, CertificateFile, MOST_BYTES, ProofError, Way};
use clap::Parser;
use rayon::prelude::*;

use super::counted::{followed, judge, scope, unfollowed};
use super::verdict::{Attempt, Scope, names, proved, told, unproved};
use super::{Job, at_widths};
use crate::Error;
use crate::cli::{Cli, Command, usage};
use crate::output;

/// Checks a file of certificates: nothing is looked for.
pub(super) fn check(path: &Path) -> Result<(), Error> {
    let name = path.display();
    let text = read(path)?;
    let file: CertificateFile =
        text.parse().map_err(|error| Error::Invalid(format!("{name} is no certificate: {error}")))?;
    let model = find(&file.model)?;
    let words = ["stepwave", "prove", model.name].map(str::to_owned).into_iter().chain(file.options.iter().cloned());
    let parsed = Cli::try_parse_from(words).map_err(|error| usage(&error))?;
    let Command::Prove(args) = &parsed.command else {
        return Err(Error::Invalid(format!("{name} is no certificate: its options are none of `stepwave prove`")));
    };
    let job = Job::new(args, file.narrower.iter().cloned().collect())?;
    if job.options() != file.options {
        let words = file.options.join(" ");
        return Err(Error::Invalid(format!("{name} is no certificate: '{words}' is not hardware alone")));
    }
    if job.claims.counted.is_empty() { check_steps(&job, &name, &file) } else { check_blocks(&job, &name, &file) }
}

/// The text of a file that is not too large for a certificate.
fn read(path: &Path) -> Result<String, Error> {
    let name = path.display();
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_string(&mut text));
    read.map_err(|error| Error::Invalid(format!("cannot read {name}: {error}")))?;
    if text.len() as u64 > MOST_BYTES {
        let most = MOST_BYTES >> 20;
        return Err(Error::Invalid(format!(
            "{name} is no certificate: it holds more than {most} MiB, the most of one"
        )));
    }
    Ok(text)
}

/// Blocks that were followed at some widths: they are counted anew.
fn check_blocks(job: &Job<'_>, name: &Display<'_>, file: &CertificateFile) -> Result<(), Error> {
    let mut ks: Vec<u32> = Vec::new();
    for block in &file.counted {
        let k = block.split(' ').next().and_then(|k| k.parse().ok()).filter(|k| (1..=20).contains(k));
        ks.push(k.ok_or_else(|| Error::Invalid(format!("{name} is no certificate: counted {block}")))?);
    }
    ks.dedup();
    let other = || Error::Check(vec![format!("{name} does not say what its blocks come to")]);
    // Whatever follows takes its time for every width.
    if ks.is_empty() || !ks.is_sorted() || file.counted.len() != ks.len() * job.claims.geometries.kinds().len() {
        return Err(other());
    }
    // What does not even say that every axis ends where it should is not worth it.
    let wanted = followed(job.model, &job.choices, &job.narrower, ks.clone(), Way::Wanted)
        .map_err(|error| unfollowed(error, Error::from))?;
    let ends = |block: &str| {
        let (head, rest) = block.split_once(" clocks=")?;
        let (clocks, ends) = rest.split_once(' ')?;
        clocks.parse::<u64>().ok().map(|_| (head.to_owned(), ends.to_owned()))
    };
    let as_wanted =
        |(block, line): (&Block, &String)| ends(line).is_some_and(|own| ends(&block.to_string()) == Some(own));
    if !wanted.iter().zip(&file.counted).all(as_wanted) {
        return Err(other());
    }
    let blocks = followed(job.model, &job.choices, &job.narrower, ks, Way::Recount)
        .map_err(|error| unfollowed(error, Error::from))?;
    if blocks.iter().map(Block::to_string).ne(file.counted.iter().cloned()) {
        return Err(other());
    }
    let scope = match job.extent() {
        Some(extent) => {
            let fixed = job.fixed(extent)?;
            if blocks.iter().any(|block| block.k != fixed.k()) || fixed.blocks(Way::Recount).is_none() {
                return Err(other());
            }
            at_widths::scope(job, &fixed)
        }
        None => scope(job, &blocks),
    };
    output::print(&judge(&scope, &blocks)?)
}

/// Kinds of geometry that were proved step by step.
fn check_steps(job: &Job<'_>, name: &Display<'_>, file: &CertificateFile) -> Result<(), Error> {
    let fixed = job.extent().map(|extent| job.fixed(extent)).transpose()?;
    let (subject, scope) = match &fixed {
        Some(fixed) => {
            let subject = fixed.subject().ok_or_else(|| {
                Error::Check(vec![format!("{name} does not prove: its hardware is no family for every k")])
            })?;
            (subject, at_widths::scope(job, fixed))
        }
        None => {
            let subject = job.subject()?;
            let scope = Scope::of_family(&job.hardware(), &subject);
            (subject, scope)
        }
    };
    let kinds = subject.kinds();
    if let Some((other, _)) = file.kinds.iter().find(|(other, _)| kinds.iter().all(|kind| kind.name != *other)) {
        let (model, other) = (job.model.name, other.chars().take(60).collect::<String>());
        return Err(Error::Invalid(format!("{name} is no certificate: {model} has no kind {other}")));
    }
    let attempts: Vec<Attempt> = kinds
        .into_par_iter()
        .map(|kind| {
            let own = file.kinds.iter().find(|(other, _)| *other == kind.name);
            let certificate = own.map(|(_, certificate)| certificate.clone()).unwrap_or_default();
            Ok((kind.clone(), subject.check(&kind, &certificate)?, certificate))
        })
        .collect::<Result<_, ProofError>>()?;
    output::print(&told(&scope, &attempts, false))?;
    let (open, shown) = (unproved(&attempts), proved(&attempts));
    match (open.is_empty(), shown.is_empty()) {
        (true, _) => Ok(()),
        (false, true) => Err(Error::Check(vec![format!("{name} does not prove: {}", names(&open))])),
        (false, false) => Err(Error::Check(vec![format!(
            "{name} proves a part ({}), and does not prove: {}",
            names(&shown),
            names(&open)
        )])),
    }
}
