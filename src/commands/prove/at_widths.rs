//! Verdicts on one hardware of given widths, over one box.

use std::cell::OnceCell;

use crate::study::Extent;
use crate::study::proof::{Block, Counterexample, Fault, Fixed, Tried, Way, narrowing_ks, search};

use super::counted::judge;
use super::every_width::{attempts, keep};
use super::replay::refuted_with;
use super::verdict::{Claim, Scope, names, proved, told, unproved};
use super::{CertificateOutput, Job, SEARCHED, tell};
use crate::Error;
use crate::commands::progress::Progress;

/// Clocks of all geometries together that are simulated before a proof is attempted, and after it.
const FEW: u64 = 1 << 24;
const MANY: u64 = 1 << 31;
/// The same, of each number of bits at which registers may be too narrow.
const SOME: u64 = 1 << 29;

/// Attempts a verdict.
pub(super) fn attempt(job: &Job<'_>) -> Result<(), Error> {
    let Some(extent) = job.extent() else { return attempt_any_box(job) };
    let certificate = job.certificate()?;
    let fixed = job.fixed(extent)?;
    let (found, few) = simulate(job, &fixed, true, FEW)?;
    if let Some(example) = found {
        return refuted_with(job.args, job.model, &example, "");
    }
    // A proof is searched for a long time where registers are too narrow for the family, and no run shows more than all.
    if is_whole(&few) && fixed.is_narrower() && job.args.certificate.is_none() {
        return exhaust(job, &fixed, few, "");
    }
    if job.claims.counted.is_empty() {
        by_steps(job, &fixed, few, certificate)
    } else {
        by_blocks(job, &fixed, few, certificate)
    }
}

fn simulate(job: &Job<'_>, fixed: &Fixed, few: bool, clocks: u64) -> Result<(Option<Counterexample>, Tried), Error> {
    let progress = OnceCell::new();
    let show = |done: usize, all: usize| {
        progress.get_or_init(|| Progress::of(all as u64, "geometries")).set(done as u64);
    };
    fixed.search(few, clocks, show).map_err(|error| job.args.hardware.explain_study(error))
}

/// The hardware and its box in words.
pub(super) fn scope(job: &Job<'_>, fixed: &Fixed) -> Scope {
    Scope { about: format!("{}: {}", job.hardware(), fixed.about()), widths: "at these widths".to_owned() }
}

/// By the family of hardware that is as much narrower or wider than by default at every k.
fn by_steps(job: &Job<'_>, fixed: &Fixed, few: Tried, certificate: CertificateOutput<'_>) -> Result<(), Error> {
    let Some(subject) = fixed.subject() else {
        return exhaust(job, fixed, few, "this hardware is of no family that is the same circuit for every k");
    };
    let attempts = attempts(&subject)?;
    let open = unproved(&attempts);
    if !open.is_empty() {
        let why = format!("the proof for every k leaves open: {}", names(&open));
        return exhaust(job, fixed, few, &why);
    }
    debug_assert!(!proved(&attempts).is_empty());
    let text = told(&scope(job, fixed), &attempts, job.args.details);
    keep(job, certificate, attempts)?;
    tell(job.args, &text)
}

/// By following the block of every kind.
fn by_blocks(job: &Job<'_>, fixed: &Fixed, few: Tried, certificate: CertificateOutput<'_>) -> Result<(), Error> {
    match (fixed.blocks(Way::Follow), fixed.blocks(Way::Recount)) {
        (Some(Ok(blocks)), Some(Ok(again))) if blocks == again && blocks.iter().all(Block::is_exact) => {
            let text = judge(&scope(job, fixed), &blocks)?;
            certificate.write(job.options(), Vec::new(), blocks.iter().map(Block::to_string).collect())?;
            tell(job.args, &text)
        }
        (Some(Err(lost)), _) => exhaust(job, fixed, few, &lost.to_string()),
        _ => exhaust(job, fixed, few, "the blocks are too long to be followed, or do not end as they should"),
    }
}

/// Every geometry of the box was simulated, and did as claimed.
fn is_whole(tried: &Tried) -> bool {
    tried.all && tried.as_claimed == tried.geometries && tried.geometries > 0
}

/// By simulating every geometry of the box, where they are not too many.
fn exhaust(job: &Job<'_>, fixed: &Fixed, few: Tried, why: &str) -> Result<(), Error> {
    let tried = if is_whole(&few) {
        few
    } else {
        let (found, tried) = simulate(job, fixed, false, MANY)?;
        if let Some(example) = found {
            return refuted_with(job.args, job.model, &example, "");
        }
        tried
    };
    let Scope { about, widths } = scope(job, fixed);
    let Tried { geometries, as_claimed, refused, given_up, .. } = &tried;
    if is_whole(&tried) {
        let lines =
            Claim::ALL.map(|claim| format!("PROVED {widths} (exhausted: {geometries} geometries): {}\n", claim.name()));
        let none = if job.args.certificate.is_some() { "no certificate: simulation shows it, no proof\n" } else { "" };
        return tell(job.args, &format!("{about}\n{}{none}", lines.concat()));
    }
    let some = if tried.all { "all" } else { "some" };
    tell(
        job.args,
        &format!(
            "{about}\nUNKNOWN: {why}\nsimulated: {geometries} geometries, {some} of the box: {as_claimed} did as claimed, \
             {refused} were refused, {given_up} were not run to their end\n"
        ),
    )?;
    Err(Error::Check(vec![format!("not proved {widths}: {}; no counterexample was found", names(&Claim::ALL))]))
}

/// Registers of fixed widths without a box: for coordinates of some bits they are too narrow.
fn attempt_any_box(job: &Job<'_>) -> Result<(), Error> {
    let Job { args, model, claims, choices, narrower } = job;
    let _ = job.certificate()?;
    let told = |error| args.hardware.explain_study(error);
    let ks = narrowing_ks(model, choices).map_err(told)?;
    let first = search(model, claims, choices, narrower, SEARCHED, |fault| fault != Fault::Refused);
    let mut found = first.found;
    for k in ks {
        if found.is_some() {
            break;
        }
        found = simulate(job, &job.fixed(Extent::Bits(k))?, false, SOME)?.0;
    }
    let widths = choices.words();
    match found {
        Some(example) => {
            let below = example.k - 1;
            let note = format!(
                "; of smaller coordinates see `stepwave prove {} {} --box {below}`",
                model.name,
                widths.join(" ")
            );
            refuted_with(args, model, &example, if below > 0 { &note } else { "" })
        }
        None => {
            tell(
                args,
                &format!("{}\nUNKNOWN: where these widths begin to be too narrow was not found\n", job.hardware()),
            )?;
            Err(Error::Check(vec![format!(
                "not proved: {}; give a box of geometries, such as --travel 100",
                names(&Claim::ALL)
            )]))
        }
    }
}
