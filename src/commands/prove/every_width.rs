//! Proofs for every width at once.

use std::ops::RangeInclusive;

use rayon::prelude::*;
use stepwave::models::{Choices, Preset};
use stepwave::study::proof::{INDUCTION_KS, ProofError, Subject, choices_at};

use super::replay::{not_inductive, refuted};
use super::verdict::{Attempt, Claim, told, unproved};
use super::{Job, SEARCHED, tell};
use crate::failure::Failure;

/// `1, 2`
fn list(numbers: RangeInclusive<u32>) -> String {
    numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(" and ")
}

/// Attempts a proof of every kind of geometry.
pub(super) fn attempt(job: &Job<'_>) -> Result<(), Failure> {
    let Job { args, model, choices, narrower, .. } = job;
    let certificate = job.certificate()?;
    // What a simulation refutes needs no attempt.
    if let Some(example) = job.counterexample(choices, SEARCHED) {
        return refuted(args, model, &example);
    }
    let subject = Subject::new(model, choices, narrower).map_err(|error| args.hardware.told_of_study(error))?;
    let subject = if args.any_preset { subject.with_any_preset() } else { subject };
    let attempts: Vec<Attempt> = subject
        .kinds()
        .into_par_iter()
        .map(|kind| {
            let (proof, certificate) = subject.prove(&kind)?;
            // The search is not believed: what counts is what the checker finds in the certificate.
            let proof = if proof.holds() { subject.check(&kind, &certificate)? } else { proof };
            Ok((kind, proof, certificate))
        })
        .collect::<Result<_, ProofError>>()?;
    let mut text = told(model, &subject, &attempts, args.details);
    if !unproved(&attempts).is_empty() {
        return undecided(job, &subject, &attempts, text);
    }
    text += &format!("simulated: the same for every geometry of {} bits\n", list(1..=subject.ks().0 - 1));
    let kinds = attempts.into_iter().map(|(kind, _, certificate)| (kind.name, certificate)).collect();
    let any = args.any_preset.then(|| "--any-preset".to_owned());
    certificate.write(choices.options().into_iter().chain(any).collect(), kinds, Vec::new())?;
    tell(args, &text)
}

/// Looks for what keeps a proof from being one, and tells it behind what was proved.
fn undecided(job: &Job<'_>, subject: &Subject, attempts: &[Attempt], mut text: String) -> Result<(), Failure> {
    let Job { args, model, claims, choices, narrower } = job;
    let remainders = subject.presets();
    let mut presets = extreme_presets(choices, &remainders);
    if let Some(example) = presets.find_map(|own| job.counterexample(&own, SEARCHED)) {
        return refuted(args, model, &example);
    }
    let names: Vec<&str> = unproved(attempts).iter().map(|claim| claim.name()).collect();
    let mut failure = format!(
        "not proved: {}; no counterexample among the geometries of up to {} bits that were tried",
        names.join(", "),
        SEARCHED.end()
    );
    let failed = attempts.iter().filter(|(_, proof, _)| Claim::may_fail_induction(proof));
    let failed: Vec<_> = failed.map(|(kind, _, certificate)| (kind, certificate)).collect();
    let looked = subject.counterexample_to_induction(&failed)?;
    if let Some(step) = &looked.found {
        let own = choices_at(model, claims, choices, narrower, step.k)?;
        text += &not_inductive(args, model, step, &own)?;
        failure += "; a step from a state that may be unreachable shows why";
    } else if failed.is_empty() {
        text += "UNKNOWN: whether every block ends; no number is stated that every step makes less\n";
    } else {
        let [first, last] = INDUCTION_KS;
        let tried = looked.tried;
        text += &format!(
            "UNKNOWN: no step from {tried} states at k = {first} and {last} that the invariants allow shows why\n"
        );
    }
    tell(args, &text)?;
    Err(Failure::Check(vec![failure]))
}

/// Every remainder register of these at 0 or full, in all combinations; nothing where there are none.
fn extreme_presets(choices: &Choices, registers: &[String]) -> impl Iterator<Item = Choices> {
    let combinations = if registers.is_empty() { 0 } else { 1_u32 << registers.len().min(8) };
    (0..combinations).map(move |combination| {
        let preset = |place: usize| if combination >> place & 1 == 1 { Preset::Full } else { Preset::Zero };
        let presets = registers.iter().enumerate().map(|(place, register)| (register.clone(), preset(place)));
        Choices { presets: presets.collect(), ..choices.clone() }
    })
}
