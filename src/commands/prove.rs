//! `stepwave prove`: proofs over all geometries and widths, and counterexamples.

mod check;
mod replay;
mod verdict;

use std::fmt::Write as _;
use std::io::Write as _;
use std::ops::RangeInclusive;

use rayon::prelude::*;
use stepwave::models::{Choices, Claims, Model, Preset, find};
use stepwave::study::proof::{
    Answer, Block, CertificateFile, DOUBTED, Fault, Narrower, ProofError, Subject, Way, ask, blocks, choices_at,
    question, search,
};

use check::check;
use replay::{doubted, refuted};
use verdict::{Attempt, Claim, told, unproved};

use crate::cli::{ProveArgs, ProveCommand};
use crate::failure::Failure;
use crate::output::{self, Outputs};

/// Attempts a proof, or checks one.
pub(crate) fn run(args: &ProveArgs) -> Result<(), Failure> {
    match &args.check {
        Some(ProveCommand::Check { file }) => check(file),
        None => attempt(args),
    }
}

/// Bits of coordinates among which counterexamples are looked for.
const SEARCHED: RangeInclusive<u32> = 1..=6;

/// `1, 2`
fn list(numbers: RangeInclusive<u32>) -> String {
    numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(" and ")
}

/// Bits of coordinates at which a model is proved that is proved at one width at a time.
const COUNTED: RangeInclusive<u32> = 1..=16;

/// Every kind of geometry at each of these widths.
fn followed(
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
fn judge(model: &Model, blocks: &[Block], what: &str) -> Result<(), Failure> {
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

fn attempt(args: &ProveArgs) -> Result<(), Failure> {
    let model = find(args.model.as_deref().unwrap_or_default())?;
    let choices = args.hardware.choices();
    let narrower: Narrower = args.narrower.iter().flat_map(|list| list.0.iter().cloned()).collect();
    let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
    let counted = !claims.counted.is_empty();
    if args.bits.is_some() && !counted && args.solver.is_none() {
        let model = model.name;
        return Err(Failure::Trouble(format!("{model} is proved for all k at once: leave --bits out")));
    }
    let second = args.solver.as_deref().map(|command| asked(args, command, model, &claims, &choices, &narrower));
    let second = second.transpose()?;
    let own = own_attempt(args, model, &claims, &choices, narrower, counted);
    match (&own, second) {
        (Ok(()), Some(Answer::Sat)) => Err(Failure::Check(vec![format!(
            "{}: what is proved here the solver says is wrong: one of both errs, please report this",
            model.name
        )])),
        _ => own,
    }
}

/// Bits of coordinates that a solver is asked about unless the user says otherwise.
const ASKED: u32 = 2;

/// What a solver says of every geometry of some bits.
fn asked(
    args: &ProveArgs,
    command: &str,
    model: &'static Model,
    claims: &Claims,
    choices: &Choices,
    narrower: &Narrower,
) -> Result<Answer, Failure> {
    let k = args.bits.unwrap_or(ASKED);
    let question = question(model, claims, choices, narrower, k).map_err(|error| args.hardware.told_of_study(error))?;
    let answer = ask(command, &question.script)?;
    let (word, what) = match answer {
        Answer::Sat => ("sat", "a register overflows or an end point is missed"),
        Answer::Unsat => ("unsat", "no register overflows, and every end point is reached"),
    };
    let (geometries, clocks) = (question.geometries, question.clocks);
    output::print(&format!(
        "{command} says {word} of {geometries} geometries of {k} bits within {clocks} clocks: {what}\n"
    ))?;
    Ok(answer)
}

fn own_attempt(
    args: &ProveArgs,
    model: &'static Model,
    claims: &Claims,
    choices: &Choices,
    narrower: Narrower,
    counted: bool,
) -> Result<(), Failure> {
    if args.any_preset && counted {
        return Err(Failure::Trouble(format!("{} has no remainder to preset: leave --any-preset out", model.name)));
    }
    let searched = args.bits.map_or(SEARCHED, |k| k..=k);
    let mut outputs = Outputs::default();
    let certificate = args.certificate.as_deref().map(|path| outputs.open(path)).transpose()?;
    // A word that does not fit refutes a narrower register; else it tells that a choice, such as a preset, needs more bits.
    let refutes = |fault| fault != Fault::Refused || !narrower.is_empty();
    if counted {
        let ks: Vec<u32> = args.bits.map_or(COUNTED, |k| k..=k).collect();
        let found = followed(model, choices, &narrower, ks.clone(), Way::Follow);
        if !found.as_ref().is_ok_and(|blocks| blocks.iter().all(Block::is_exact))
            && let Some(example) = search(model, claims, choices, &narrower, searched, refutes)
        {
            return refuted(args, model, &example);
        }
        let blocks = found?;
        // They are not believed: what counts is what the second way comes to.
        if followed(model, choices, &narrower, ks, Way::Recount)? != blocks {
            let model = model.name;
            return Err(Failure::Check(vec![format!("not proved: {model} pulse by pulse comes to something else")]));
        }
        judge(model, &blocks, "the blocks that were followed")?;
        if let Some(mut sink) = certificate {
            let file = CertificateFile {
                model: model.name.to_owned(),
                options: choices.options(),
                narrower: narrower.into_iter().collect(),
                kinds: Vec::new(),
                counted: blocks.iter().map(Block::to_string).collect(),
            };
            write!(sink, "{file}")?;
            sink.flush()?;
        }
        return outputs.commit();
    }
    // What a simulation refutes needs no attempt.
    if let Some(example) = search(model, claims, choices, &narrower, SEARCHED, refutes) {
        return refuted(args, model, &example);
    }
    let subject = Subject::new(model, choices, &narrower).map_err(|error| args.hardware.told_of_study(error))?;
    let subject = if args.any_preset { subject.with_any_preset() } else { subject };
    let kinds = subject.kinds();
    let attempts: Vec<Attempt> = kinds
        .into_par_iter()
        .map(|kind| {
            let (proof, certificate) = subject.prove(&kind)?;
            // The search is not believed: what counts is what the checker finds in the certificate.
            let proof = if proof.holds() { subject.check(&kind, &certificate)? } else { proof };
            Ok((kind, proof, certificate))
        })
        .collect::<Result<_, ProofError>>()?;
    let mut text = told(model, &subject, &attempts, args.details);
    let open = unproved(&attempts);
    if open.is_empty() {
        text += &format!("simulated: the same for every geometry of {} bits\n", list(1..=subject.ks().0 - 1));
        if let Some(mut sink) = certificate {
            let kinds = attempts.into_iter().map(|(kind, _, certificate)| (kind.name, certificate)).collect();
            let narrower = narrower.into_iter().collect();
            let any = args.any_preset.then(|| "--any-preset".to_owned());
            let options = choices.options().into_iter().chain(any).collect();
            let file = CertificateFile { model: model.name.to_owned(), options, narrower, kinds, counted: Vec::new() };
            write!(sink, "{file}")?;
            sink.flush()?;
        }
        outputs.commit()?;
        return output::print(&text);
    }
    let remainders = subject.presets();
    let mut presets = extreme_presets(choices, &remainders);
    if let Some(example) = presets.find_map(|own| search(model, claims, &own, &narrower, SEARCHED, refutes)) {
        return refuted(args, model, &example);
    }
    let names: Vec<&str> = open.iter().map(|claim| claim.name()).collect();
    let mut failure = format!(
        "not proved: {}; no counterexample among the geometries of up to {} bits that were tried",
        names.join(", "),
        SEARCHED.end()
    );
    let doubtful: Vec<_> = attempts.iter().filter(|(_, proof, _)| Claim::is_doubtful(proof)).collect();
    let doubtful: Vec<_> = doubtful.into_iter().map(|(kind, _, certificate)| (kind, certificate)).collect();
    let looked = subject.doubt(&doubtful)?;
    if let Some(doubt) = &looked.found {
        let own = choices_at(model, claims, choices, &narrower, doubt.k)?;
        text += &doubted(args, model, doubt, &own)?;
        failure += "; a step from a state that may be unreachable shows why";
    } else if doubtful.is_empty() {
        text += "UNKNOWN: whether every block ends; no number is stated that every step makes less\n";
    } else {
        let [first, last] = DOUBTED;
        text += &format!(
            "UNKNOWN: no step from {} states at k = {first} and {last} that the invariants allow shows why\n",
            looked.tried
        );
    }
    output::print(&text)?;
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
