//! The decision of a proposition: by simulation, step by step for every width, or block by block.

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use stepwave_models::options::PRESET;
use stepwave_models::{Options, Preset};

use super::verdict::{Attempt, Claim, Evidence, Scope, Shown, Verdict, names, unproved};
use super::{
    Block, CountMethod, Counterexample, Fault, Fixed, ProofError, Proposition, Subject, Survey, Tried, blocks,
};
use super::{narrowing_ks, search};
use crate::study::Extent;

/// Bits of coordinates among which counterexamples are looked for.
pub const SEARCHED: RangeInclusive<u32> = 1..=6;
/// Bits of coordinates at which a model is proved one width at a time unless the user says otherwise.
const PROVED: RangeInclusive<u32> = 1..=16;
/// Clocks of all geometries together that are simulated before a proof is attempted, and after it.
const FEW: u64 = 1 << 24;
const MANY: u64 = 1 << 31;
/// The same, of each number of bits at which registers may be too narrow.
const SOME: u64 = 1 << 29;

/// What gets how far a piece of work is: what is counted, how many are done, and how many there are.
pub type Watcher<'a> = &'a (dyn Fn(&'static str, usize, usize) + Sync);

/// How a proposition is decided.
#[derive(Clone, Copy)]
pub struct Effort<'a> {
    /// Bits of coordinates, for models that are proved at one width at a time (default: 1 to 16).
    pub bits: Option<u32>,
    /// A certificate is wanted, even where simulating every geometry of the box is faster than a proof.
    pub certificate: bool,
    /// Gets how far it is.
    pub progress: Watcher<'a>,
}

impl Default for Effort<'_> {
    fn default() -> Self {
        Effort { bits: None, certificate: false, progress: &|_, _, _| {} }
    }
}

impl Effort<'_> {
    /// Does the same for each, on all cores.
    pub(super) fn each<T: Send, R: Send>(
        &self,
        what: &'static str,
        all: Vec<T>,
        one: impl Fn(T) -> Result<R, ProofError> + Sync,
    ) -> Result<Vec<R>, ProofError> {
        let (number, done) = (all.len(), AtomicUsize::new(0));
        (self.progress)(what, 0, number);
        let each = all.into_par_iter().map(|item| {
            let result = one(item);
            (self.progress)(what, done.fetch_add(1, Ordering::Relaxed) + 1, number);
            result
        });
        each.collect()
    }
}

impl Proposition {
    /// Decides it, or says what is open.
    ///
    /// # Errors
    /// The model claims nothing, the hardware cannot be built, or there is no such box; see [`ProofError`].
    pub fn prove(&self, effort: &Effort<'_>) -> Result<Verdict, ProofError> {
        let claims = self.claims()?;
        self.check()?;
        match self.bounds() {
            Some(extent) => self.at_widths(effort, extent),
            None if self.is_fixed() => self.in_any_box(effort),
            None if self.model.is_buffered() && self.narrower.is_empty() => {
                Err(ProofError::Buffered { model: self.model.name })
            }
            None if claims.counted.is_empty() => self.for_every_width(effort),
            None => self.width_by_width(effort),
        }
    }

    fn verdict(&self, scope: Scope, evidence: Evidence) -> Verdict {
        Verdict { proposition: self.clone(), scope, evidence }
    }

    pub(super) fn by_steps(&self, scope: Scope, attempts: Vec<Attempt>) -> Verdict {
        self.verdict(scope, Evidence::Steps { attempts, below: Vec::new(), induction: None })
    }

    fn refuted(&self, example: Counterexample) -> Verdict {
        self.verdict(Scope::of(self), Evidence::Refuted(Box::new(example)))
    }

    pub(super) fn open(&self, why: String) -> Verdict {
        self.verdict(Scope::of(self), Evidence::Open(why))
    }

    /// What blocks show that were followed: nothing where one of them does not end as it should.
    pub(super) fn by_blocks(&self, scope: Scope, blocks: Vec<Block>) -> Verdict {
        let wrong: Vec<String> = blocks.iter().filter(|block| !block.is_exact()).map(Block::to_string).collect();
        if !wrong.is_empty() {
            return self.open(format!("not proved: {}: {}", Claim::Exact.name(), wrong.join("; ")));
        }
        self.verdict(scope, Evidence::Blocks(blocks))
    }

    /// A block that cannot be followed is not proved, and not refuted; all else is an error.
    pub(super) fn unfollowed(&self, error: ProofError) -> Result<Verdict, ProofError> {
        match error {
            lost @ ProofError::Lost { .. } => Ok(self.open(format!("UNKNOWN, no counterexample and no proof: {lost}"))),
            other => Err(other),
        }
    }

    /// Every kind of geometry at each of these widths.
    pub(super) fn followed(
        &self,
        effort: &Effort<'_>,
        ks: Vec<u32>,
        method: CountMethod,
    ) -> Result<Vec<Block>, ProofError> {
        let claims = self.claims()?;
        let each =
            effort.each("widths", ks, |k| blocks(self.model, &claims, &self.options, &self.narrower, k, method))?;
        Ok(each.concat())
    }

    /// Simulates until a geometry refutes what is claimed for every k, on hardware of these options.
    fn search(&self, options: &Options, ks: RangeInclusive<u32>) -> Result<Survey, ProofError> {
        let claims = self.claims_for_every_k()?;
        // A word that does not fit refutes a narrower register; else it says that a choice, such as a preset, needs more
        // bits.
        let refutes = |fault| fault != Fault::Refused || !self.narrower.is_empty();
        Ok(search(self.model, &claims, options, &self.narrower, ks, refutes))
    }

    /// Every width at once, step by step.
    fn for_every_width(&self, effort: &Effort<'_>) -> Result<Verdict, ProofError> {
        // What a simulation refutes needs no attempt.
        let survey = self.search(&self.options, SEARCHED)?;
        if let Some(example) = survey.found {
            return Ok(self.refuted(example));
        }
        let subject = self.subject()?;
        let attempts = attempts(&subject, effort)?;
        let least = subject.ks().0;
        let below = survey.tried.into_iter().filter(|tried| tried.k < least).collect();
        let mut induction = None;
        if !unproved(&attempts).is_empty() {
            for own in extreme_presets(&self.options, &subject.presets()) {
                if let Some(example) = self.search(&own, SEARCHED)?.found {
                    return Ok(self.refuted(example));
                }
            }
            let failed = attempts.iter().filter(|(_, proof, _)| Claim::may_fail_induction(proof));
            let failed: Vec<_> = failed.map(|(kind, _, certificate)| (kind, certificate)).collect();
            induction = Some(Box::new(subject.counterexample_to_induction(&failed)?));
        }
        let scope = Scope::of_family(self, &subject);
        Ok(self.verdict(scope, Evidence::Steps { attempts, below, induction }))
    }

    /// One width at a time, block by block.
    fn width_by_width(&self, effort: &Effort<'_>) -> Result<Verdict, ProofError> {
        let ks: Vec<u32> = effort.bits.map_or(PROVED, |k| k..=k).collect();
        let found = self.followed(effort, ks.clone(), CountMethod::Follow);
        if !found.as_ref().is_ok_and(|blocks| blocks.iter().all(Block::is_exact))
            && let Some(example) = self.search(&self.options, effort.bits.map_or(SEARCHED, |k| k..=k))?.found
        {
            return Ok(self.refuted(example));
        }
        // They are not believed: what counts is what the second method comes to.
        match found.and_then(|blocks| Ok((self.followed(effort, ks, CountMethod::Recount)? == blocks, blocks))) {
            Ok((true, blocks)) => {
                let scope = Scope::of_blocks(self, self.claims()?.geometries.describe(), &blocks);
                Ok(self.by_blocks(scope, blocks))
            }
            Ok((false, _)) => {
                let model = self.model.name;
                Ok(self.open(format!("not proved: {model} pulse by pulse comes to something else")))
            }
            Err(error) => self.unfollowed(error),
        }
    }

    /// One hardware and one box.
    fn at_widths(&self, effort: &Effort<'_>, extent: Extent) -> Result<Verdict, ProofError> {
        let fixed = self.fixed(extent)?;
        let (found, few) = simulate(&fixed, effort, true, FEW)?;
        if let Some(example) = found {
            return Ok(self.refuted(example));
        }
        let scope = Scope::of_fixed(self, &fixed);
        // A proof is searched for a long time where registers are too narrow for the family, and no run shows more than
        // all.
        let why = if few.is_whole() && fixed.is_narrower() && !effort.certificate {
            String::new()
        } else if self.claims()?.counted.is_empty() {
            // By the family of hardware that is as much narrower or wider than by default at every k.
            match fixed.subject().map(|subject| attempts(&subject, effort)) {
                None => "this hardware is of no family that is the same circuit for every k".to_owned(),
                Some(Err(ProofError::Word { word, .. })) => {
                    format!("the load word {word} is not a polynomial of the geometry")
                }
                Some(Err(error)) => return Err(error),
                // All that a proof leaves unclaimed was seen.
                Some(Ok(attempts)) if few.is_whole() && !effort.certificate && !claims_all(&attempts) => String::new(),
                Some(Ok(attempts)) => match unproved(&attempts) {
                    open if open.is_empty() => return Ok(self.by_steps(scope, attempts)),
                    open => format!("the proof for every k leaves open: {}", names(&open)),
                },
            }
        } else {
            match (fixed.blocks(CountMethod::Follow), fixed.blocks(CountMethod::Recount)) {
                (Some(Ok(blocks)), Some(Ok(again))) if blocks == again && blocks.iter().all(Block::is_exact) => {
                    return Ok(self.by_blocks(scope, blocks));
                }
                (Some(Err(lost)), _) => lost.to_string(),
                _ => "the blocks are too long to be followed, or do not end as they should".to_owned(),
            }
        };
        if few.is_whole() {
            return Ok(self.verdict(scope, Evidence::Simulated { tried: few, why }));
        }
        // Every geometry of the box, where they are not too many.
        let (found, tried) = simulate(&fixed, effort, false, MANY)?;
        Ok(match found {
            Some(example) => self.refuted(example),
            None => self.verdict(scope, Evidence::Simulated { tried, why }),
        })
    }

    /// Registers of fixed widths without a box: for coordinates of some bits they are too narrow.
    fn in_any_box(&self, effort: &Effort<'_>) -> Result<Verdict, ProofError> {
        let claims = self.claims()?;
        let ks = narrowing_ks(self.model, &self.options)?;
        let refutes = |fault| fault != Fault::Refused;
        let mut found = search(self.model, &claims, &self.options, &self.narrower, SEARCHED, refutes).found;
        for k in ks {
            if found.is_some() {
                break;
            }
            found = simulate(&self.fixed(Extent::Bits(k))?, effort, false, SOME)?.0;
        }
        let unbounded = || self.verdict(Scope::of(self), Evidence::Unbounded);
        Ok(found.map_or_else(unbounded, |example| self.refuted(example)))
    }
}

fn simulate(
    fixed: &Fixed,
    effort: &Effort<'_>,
    few: bool,
    clocks: u64,
) -> Result<(Option<Counterexample>, Tried), ProofError> {
    fixed.search(few, clocks, |done, all| (effort.progress)("geometries", done, all))
}

/// Every claim is one of the model.
fn claims_all(attempts: &[Attempt]) -> bool {
    Claim::ALL.iter().all(|claim| claim.shown(attempts) != Shown::Unclaimed)
}

/// An attempt at every kind of geometry.
fn attempts(subject: &Subject, effort: &Effort<'_>) -> Result<Vec<Attempt>, ProofError> {
    effort.each("kinds of geometry", subject.kinds(), |kind| {
        let (proof, certificate) = subject.prove(&kind)?;
        // The search is not believed: what counts is what the checker finds in the certificate.
        let proof = if proof.holds() { subject.check(&kind, &certificate)? } else { proof };
        Ok((kind, proof, certificate))
    })
}

/// Every remainder register of these at 0 or full, in all combinations; nothing where there are none.
fn extreme_presets(options: &Options, registers: &[String]) -> impl Iterator<Item = Options> {
    let combinations = if registers.is_empty() { 0 } else { 1_u32 << registers.len().min(8) };
    (0..combinations).map(move |combination| {
        let preset = |place: usize| if combination >> place & 1 == 1 { Preset::Full } else { Preset::Zero };
        let presets = registers.iter().enumerate().map(|(place, register)| (register.clone(), preset(place)));
        options.clone().with_single(&PRESET, presets.collect())
    })
}
