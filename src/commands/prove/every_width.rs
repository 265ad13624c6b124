//! Proofs for every width at once.

use crate::models::options::PRESET;
use crate::models::{Options, Preset};
use crate::study::proof::{INDUCTION_KS, ProofError, Subject, choices_at};
use rayon::prelude::*;

use super::replay::{not_inductive, refuted};
use super::simulated::simulated;
use super::verdict::{Attempt, Claim, Scope, names, proved, told, unproved};
use super::{CertificateOutput, Job, SEARCHED, tell};
use crate::Error;
use crate::commands::progress::Progress;

/// Attempts a proof of every kind of geometry.
pub(super) fn attempt(job: &Job<'_>) -> Result<(), Error> {
    let Job { args, model, choices, .. } = job;
    let certificate = job.certificate()?;
    // What a simulation refutes needs no attempt.
    let survey = job.search(choices, SEARCHED);
    if let Some(example) = survey.found {
        return refuted(args, model, &example);
    }
    let subject = job.subject()?;
    let attempts = attempts(&subject)?;
    let scope = Scope::of_family(&job.hardware(), &subject);
    let mut text = told(&scope, &attempts, args.details);
    let least = subject.ks().0;
    let below: Vec<_> = survey.tried.into_iter().filter(|tried| tried.k < least).collect();
    text += &simulated(&below);
    if !unproved(&attempts).is_empty() {
        return undecided(job, &subject, attempts, text, certificate);
    }
    keep(job, certificate, attempts)?;
    tell(args, &text)
}

/// An attempt at every kind of geometry.
pub(super) fn attempts(subject: &Subject) -> Result<Vec<Attempt>, ProofError> {
    let kinds = subject.kinds();
    let progress = Progress::of(kinds.len() as u64, "kinds of geometry");
    let attempt = |kind| {
        let (proof, certificate) = subject.prove(&kind)?;
        // The search is not believed: what counts is what the checker finds in the certificate.
        let proof = if proof.holds() { subject.check(&kind, &certificate)? } else { proof };
        progress.add(1);
        Ok((kind, proof, certificate))
    };
    kinds.into_par_iter().map(attempt).collect()
}

/// Writes the certificate of these attempts.
pub(super) fn keep(job: &Job<'_>, certificate: CertificateOutput<'_>, attempts: Vec<Attempt>) -> Result<(), Error> {
    let kinds = attempts.into_iter().map(|(kind, _, certificate)| (kind.name, certificate)).collect();
    certificate.write(job.options(), kinds, Vec::new())
}

/// Looks for what keeps a proof from being one, and tells it after what was proved.
fn undecided(
    job: &Job<'_>,
    subject: &Subject,
    attempts: Vec<Attempt>,
    mut text: String,
    certificate: CertificateOutput<'_>,
) -> Result<(), Error> {
    let Job { args, model, claims, choices, narrower } = job;
    let remainders = subject.presets();
    let mut presets = extreme_presets(choices, &remainders);
    if let Some(example) = presets.find_map(|own| job.search(&own, SEARCHED).found) {
        return refuted(args, model, &example);
    }
    let open = unproved(&attempts);
    let mut failure = format!(
        "not proved: {}; no counterexample among the geometries of up to {} bits that were tried",
        names(&open),
        SEARCHED.end()
    );
    let failed = attempts.iter().filter(|(_, proof, _)| Claim::may_fail_induction(proof));
    let failed: Vec<_> = failed.map(|(kind, _, certificate)| (kind, certificate)).collect();
    let looked = subject.counterexample_to_induction(&failed)?;
    if let Some(step) = &looked.found {
        let own = choices_at(model, claims, choices, narrower, step.k)?;
        text += &not_inductive(args, model, step, &own)?;
        failure += "; a step from a state that may be unreachable shows why";
    } else {
        let [first, last] = INDUCTION_KS;
        let tried = looked.tried;
        text += &format!(
            "UNKNOWN: no step from {tried} states at k = {first} and {last} that the invariants allow shows why\n"
        );
    }
    let shown = proved(&attempts);
    if args.certificate.is_some() {
        text += &if shown.is_empty() {
            "no certificate: nothing is proved\n".to_owned()
        } else {
            keep(job, certificate, attempts)?;
            format!("the certificate proves a part: {}\n", names(&shown))
        };
    }
    tell(args, &text)?;
    Err(Error::Check(vec![failure]))
}

/// Every remainder register of these at 0 or full, in all combinations; nothing where there are none.
fn extreme_presets(choices: &Options, registers: &[String]) -> impl Iterator<Item = Options> {
    let combinations = if registers.is_empty() { 0 } else { 1_u32 << registers.len().min(8) };
    (0..combinations).map(move |combination| {
        let preset = |place: usize| if combination >> place & 1 == 1 { Preset::Full } else { Preset::Zero };
        let presets = registers.iter().enumerate().map(|(place, register)| (register.clone(), preset(place)));
        choices.clone().with_single(&PRESET, presets.collect())
    })
}
