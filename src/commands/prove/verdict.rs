//! What came of attempts, in words.

use std::fmt::Write as _;

use stepwave::kernel::prove::{Certificate, Proof};
use stepwave::models::{Kind, Model};
use stepwave::study::proof::Subject;

/// A kind of geometry, and what came of its attempt.
pub(super) type Attempt = (Kind, Proof, Certificate);

/// What is claimed of every model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Claim {
    NoOverflow,
    Exact,
    Ends,
}

impl Claim {
    pub(super) const ALL: [Claim; 3] = [Claim::NoOverflow, Claim::Exact, Claim::Ends];

    pub(super) fn name(self) -> &'static str {
        match self {
            Claim::NoOverflow => "no register overflows",
            Claim::Exact => "the end point is reached exactly",
            Claim::Ends => "every block ends",
        }
    }

    /// A step may show why something is not proved: more than a rank is missing.
    pub(super) fn may_fail_induction(proof: &Proof) -> bool {
        !proof.is_safe() || proof.endless.as_ref().is_some_and(|why| why != Proof::NO_RANK)
    }

    /// Why a proof does not show it; `None` where it does.
    pub(super) fn open(self, proof: &Proof) -> Option<String> {
        if !proof.holds() {
            let why = proof.not_inductive.iter().map(|invariant| format!("a step does not keep {invariant}"));
            return Some(why.chain(proof.astray.clone()).collect::<Vec<_>>().join("; "));
        }
        match self {
            Claim::NoOverflow => proof.violated.first().map(|(_, path)| path.clone()),
            Claim::Exact => proof.missed.first().map(|(goal, path)| format!("{goal}: {path}")),
            Claim::Ends => proof.endless.clone(),
        }
    }
}

/// What one of them does not show.
pub(super) fn unproved(attempts: &[Attempt]) -> Vec<Claim> {
    Claim::ALL.into_iter().filter(|claim| attempts.iter().any(|(_, proof, _)| claim.open(proof).is_some())).collect()
}

/// Every claim with its verdict.
pub(super) fn told(model: &Model, subject: &Subject, attempts: &[Attempt], details: bool) -> String {
    let (least, greatest) = subject.ks();
    let (paths, shown) = attempts
        .iter()
        .fold((0, 0), |(paths, shown), (_, proof, _)| (paths + proof.paths, shown + proof.contradictions));
    // Writing to a string cannot fail.
    let mut text = format!("{}: {}, for every k from {least} to {greatest}\n", model.name, subject.about());
    for claim in Claim::ALL {
        let open: Vec<(&str, String)> =
            attempts.iter().filter_map(|(kind, proof, _)| Some((kind.name.as_str(), claim.open(proof)?))).collect();
        match open.first() {
            None => {
                let _ = writeln!(text, "PROVED for all k: {}", claim.name());
            }
            Some((kind, why)) => {
                let many = if open.len() == attempts.len() {
                    "for none".to_owned()
                } else {
                    format!("not for {}", open.len())
                };
                let _ = writeln!(text, "not proved: {} ({many} of {} kinds of geometry)", claim.name(), attempts.len());
                if details {
                    let _ = writeln!(text, "  {kind}: {why}");
                }
            }
        }
    }
    let _ = writeln!(
        text,
        "{} kinds of geometry, {paths} paths, {shown} contradictions, each checked in exact arithmetic",
        attempts.len()
    );
    if details {
        for (kind, proof, _) in attempts {
            let _ = writeln!(text, "\n{}", kind.name);
            for invariant in &proof.invariants {
                let _ = writeln!(text, "  {invariant}");
            }
        }
    }
    text
}
