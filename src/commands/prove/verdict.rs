//! What came of attempts, in words.

use std::fmt::Write as _;

use crate::models::{Kind, Model};
use crate::prove::{Certificate, Proof};
use crate::study::proof::{Narrower, Subject};

/// A kind of geometry, and what came of its attempt.
pub(super) type Attempt = (Kind, Proof, Certificate);

/// What is claimed of every model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Claim {
    NoOverflow,
    Exact,
    Ends,
}

/// What attempts at every kind of geometry show of a claim.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Verdict {
    Proved,
    /// The model does not claim it.
    Unclaimed,
    /// It holds up to the first overflow, and whether there is one is open: behind it nothing was followed.
    UnlessOverflow,
    /// It is open for so many kinds.
    Open(usize),
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
    fn open(self, proof: &Proof) -> Option<String> {
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

    pub(super) fn verdict(self, attempts: &[Attempt]) -> Verdict {
        let unclaimed = |proof: &Proof| proof.endless.as_deref() == Some(Proof::NO_RANK);
        if self == Claim::Ends && !attempts.is_empty() && attempts.iter().all(|(_, proof, _)| unclaimed(proof)) {
            return Verdict::Unclaimed;
        }
        let open = attempts.iter().filter(|(_, proof, _)| self.open(proof).is_some()).count();
        let overflows = |(_, proof, _): &Attempt| Claim::NoOverflow.open(proof).is_some();
        match open {
            0 if attempts.is_empty() => Verdict::Open(0),
            0 if attempts.iter().any(overflows) => Verdict::UnlessOverflow,
            0 => Verdict::Proved,
            open => Verdict::Open(open),
        }
    }
}

/// What is claimed and not shown by all of them.
pub(super) fn unproved(attempts: &[Attempt]) -> Vec<Claim> {
    let is_open = |claim: &Claim| !matches!(claim.verdict(attempts), Verdict::Proved | Verdict::Unclaimed);
    Claim::ALL.into_iter().filter(is_open).collect()
}

/// What all of them show.
pub(super) fn proved(attempts: &[Attempt]) -> Vec<Claim> {
    Claim::ALL.into_iter().filter(|claim| claim.verdict(attempts) == Verdict::Proved).collect()
}

/// `a, b`
pub(super) fn names(claims: &[Claim]) -> String {
    claims.iter().map(|claim| claim.name()).collect::<Vec<_>>().join(", ")
}

/// A model with the options of its hardware, and the registers that are narrower than by default.
pub(super) fn hardware_in_words(model: &Model, options: &[String], narrower: &Narrower) -> String {
    let words = [&[model.name.to_owned()], options].concat().join(" ");
    let narrower = narrower.iter().filter(|(_, bits)| **bits > 0).map(|(register, bits)| {
        let bits = if *bits == 1 { "1 bit".to_owned() } else { format!("{bits} bits") };
        format!(" with {register} {bits} narrower")
    });
    words + &narrower.collect::<Vec<_>>().join(" and")
}

/// Of what something is proved.
pub(super) struct Scope {
    /// The hardware and the box, for the first line.
    pub(super) about: String,
    /// The width, for each verdict: `for all k`.
    pub(super) widths: String,
}

impl Scope {
    /// A hardware of every width of a family.
    pub(super) fn of_family(hardware: &str, subject: &Subject) -> Scope {
        let (least, greatest) = subject.ks();
        let about = format!("{hardware}: {}, for every k from {least} to {greatest}", subject.about());
        let widths = if subject.is_whole() { "for all k".to_owned() } else { format!("for k = {least} to {greatest}") };
        Scope { about, widths }
    }
}

/// Every claim with its verdict.
pub(super) fn told(scope: &Scope, attempts: &[Attempt], details: bool) -> String {
    let widths = &scope.widths;
    let (paths, shown) = attempts
        .iter()
        .fold((0, 0), |(paths, shown), (_, proof, _)| (paths + proof.paths, shown + proof.contradictions));
    // Writing to a string cannot fail.
    let mut text = format!("{}\n", scope.about);
    let ends = Claim::Ends.verdict(attempts) == Verdict::Proved;
    for claim in Claim::ALL {
        let name = claim.name();
        let _ = match claim.verdict(attempts) {
            Verdict::Proved if claim == Claim::Exact && !ends => {
                writeln!(text, "PROVED {widths}: {name} by every block that ends")
            }
            Verdict::Proved => writeln!(text, "PROVED {widths}: {name}"),
            Verdict::Unclaimed => writeln!(text, "not claimed: {name}"),
            Verdict::UnlessOverflow => writeln!(text, "not proved: {name} (only as long as no register overflows)"),
            Verdict::Open(open) => {
                let all = attempts.len();
                let many = if open == all { "for none".to_owned() } else { format!("not for {open}") };
                writeln!(text, "not proved: {name} ({many} of {all} kinds of geometry)")
            }
        };
        let why = attempts.iter().find_map(|(kind, proof, _)| Some((&kind.name, claim.open(proof)?)));
        if let (true, Some((kind, why))) = (details, why) {
            let _ = writeln!(text, "  {kind}: {why}");
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

#[cfg(test)]
mod tests {
    use crate::models::find;

    use super::*;

    /// What two kinds of geometry come to, the second of which may overflow.
    fn attempts(violated: &[(usize, String)]) -> Vec<Attempt> {
        let model = find("ppc-line").expect("a model");
        let kinds = model.claims.expect("claims").geometries.kinds();
        let proof = |violated: &[(usize, String)]| Proof { violated: violated.to_vec(), ..Proof::default() };
        let own = [proof(&[]), proof(violated)];
        kinds.into_iter().zip(own).map(|(kind, proof)| (kind, proof, Certificate::default())).collect()
    }

    #[test]
    fn nothing_is_proved_that_holds_only_as_long_as_nothing_overflows() {
        let scope = Scope { about: "line".to_owned(), widths: "for all k".to_owned() };
        let text = told(&scope, &attempts(&[(0, "x >= 0".to_owned())]), false);
        assert!(!text.contains("PROVED"), "{text}");
        assert!(text.contains("not proved: no register overflows (not for 1 of 2 kinds of geometry)\n"), "{text}");
        let conditional = "not proved: the end point is reached exactly (only as long as no register overflows)\nnot proved: every block";
        assert!(text.contains(conditional), "{text}");
        assert_eq!(unproved(&attempts(&[(0, String::new())])).len(), 3);
        assert!(unproved(&attempts(&[])).is_empty() && unproved(&[]).len() == 3);
    }
}
