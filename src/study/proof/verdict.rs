//! What came of a proposition: the evidence, and what it shows of each claim.

use stepwave_models::Kind;
use stepwave_prove::{Certificate, Proof};

use super::{Block, CertificateFile, Counterexample, Fixed, InductionSearch, Proposition, Subject, Tried};

/// A kind of geometry, and what came of its attempt.
pub type Attempt = (Kind, Proof, Certificate);

/// What came of a proposition.
#[derive(Debug)]
#[must_use]
#[non_exhaustive]
pub struct Verdict {
    /// What was to be proved.
    pub proposition: Proposition,
    /// Of what something is proved, in words.
    pub scope: Scope,
    /// What was found.
    pub evidence: Evidence,
}

/// What a verdict rests on.
#[derive(Debug)]
#[non_exhaustive]
pub enum Evidence {
    /// Steps from any state in which invariants hold.
    Steps {
        /// An attempt at every kind of geometry, each proof checked in exact arithmetic.
        attempts: Vec<Attempt>,
        /// What was simulated of bits of coordinates below those of the proof.
        below: Vec<Tried>,
        /// Where something is open: steps that could show why.
        induction: Option<Box<InductionSearch>>,
    },
    /// Blocks that were followed with coefficients of unknown bits, each exact and counted a second time.
    Blocks(Vec<Block>),
    /// Geometries that were simulated: all of the box, each as claimed ([`Tried::is_whole`]), or else it is open.
    Simulated {
        /// They.
        tried: Tried,
        /// Why there is no proof of another kind.
        why: String,
    },
    /// A geometry that the simulator shows to go wrong.
    Refuted(Box<Counterexample>),
    /// Nothing, for this reason.
    Open(String),
    /// Registers of given widths without a box: none at which they begin to be too narrow was found.
    Unbounded,
}

impl Verdict {
    /// All that the model claims is proved.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        match &self.evidence {
            Evidence::Steps { attempts, .. } => unproved(attempts).is_empty(),
            Evidence::Blocks(_) => true,
            Evidence::Simulated { tried, .. } => tried.is_whole(),
            Evidence::Refuted(_) | Evidence::Open(_) | Evidence::Unbounded => false,
        }
    }

    /// The geometry that refutes it: [`Simulation`](crate::Simulation) with its curve and options shows it.
    #[must_use]
    pub fn counterexample(&self) -> Option<&Counterexample> {
        match &self.evidence {
            Evidence::Refuted(example) => Some(example),
            _ => None,
        }
    }

    /// The certificate of what is proved, be it a part; `None` where there is nothing that [`check`](super::check) could
    /// check.
    #[must_use]
    pub fn certificate(&self) -> Option<CertificateFile> {
        let (kinds, counted) = match &self.evidence {
            Evidence::Steps { attempts, .. } if !proved(attempts).is_empty() || unproved(attempts).is_empty() => {
                let kinds = attempts.iter().map(|(kind, _, certificate)| (kind.name.clone(), certificate.clone()));
                (kinds.collect(), Vec::new())
            }
            Evidence::Blocks(blocks) => (Vec::new(), blocks.iter().map(Block::to_string).collect()),
            _ => return None,
        };
        Some(CertificateFile { proposition: self.proposition.clone(), kinds, counted })
    }
}

/// What is claimed of every model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Claim {
    /// No register overflows.
    NoOverflow,
    /// The end point is reached exactly.
    Exact,
    /// Every block ends.
    Ends,
}

/// What attempts at every kind of geometry show of a claim.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shown {
    /// It holds for all of them.
    Proved,
    /// The model does not claim it.
    Unclaimed,
    /// It holds up to the first overflow, and whether there is one is open: after it nothing was followed.
    UnlessOverflow,
    /// It is open for this number of kinds.
    Open(usize),
}

impl Claim {
    /// Every claim.
    pub const ALL: [Claim; 3] = [Claim::NoOverflow, Claim::Exact, Claim::Ends];

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
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
    #[must_use]
    pub fn open(self, proof: &Proof) -> Option<String> {
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

    /// What attempts at every kind of geometry show of it.
    #[must_use]
    pub fn shown(self, attempts: &[Attempt]) -> Shown {
        let unclaimed = |proof: &Proof| proof.endless.as_deref() == Some(Proof::NO_RANK);
        if self == Claim::Ends && !attempts.is_empty() && attempts.iter().all(|(_, proof, _)| unclaimed(proof)) {
            return Shown::Unclaimed;
        }
        let open = attempts.iter().filter(|(_, proof, _)| self.open(proof).is_some()).count();
        let overflows = |(_, proof, _): &Attempt| Claim::NoOverflow.open(proof).is_some();
        match open {
            0 if attempts.is_empty() => Shown::Open(0),
            0 if attempts.iter().any(overflows) => Shown::UnlessOverflow,
            0 => Shown::Proved,
            open => Shown::Open(open),
        }
    }
}

/// What is claimed and not shown by all of them.
#[must_use]
pub fn unproved(attempts: &[Attempt]) -> Vec<Claim> {
    let is_open = |claim: &Claim| !matches!(claim.shown(attempts), Shown::Proved | Shown::Unclaimed);
    Claim::ALL.into_iter().filter(is_open).collect()
}

/// What all of them show.
#[must_use]
pub fn proved(attempts: &[Attempt]) -> Vec<Claim> {
    Claim::ALL.into_iter().filter(|claim| claim.shown(attempts) == Shown::Proved).collect()
}

/// `a, b`
#[must_use]
pub fn names(claims: &[Claim]) -> String {
    claims.iter().map(|claim| claim.name()).collect::<Vec<_>>().join(", ")
}

/// Of what something is proved, in words.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Scope {
    /// The hardware and the box, for the first line.
    pub about: String,
    /// The width, for each verdict: `for all k`.
    pub widths: String,
}

impl Scope {
    /// The hardware alone.
    pub(super) fn of(proposition: &Proposition) -> Scope {
        Scope { about: proposition.hardware(), widths: "at these widths".to_owned() }
    }

    /// A hardware of given widths and its box.
    pub(super) fn of_fixed(proposition: &Proposition, fixed: &Fixed) -> Scope {
        let about = format!("{}: {}", proposition.hardware(), fixed.about());
        Scope { about, widths: "at these widths".to_owned() }
    }

    /// A hardware of every width of a family.
    pub(super) fn of_family(proposition: &Proposition, subject: &Subject) -> Scope {
        let (least, greatest) = subject.ks();
        let hardware = proposition.hardware();
        let about = format!("{hardware}: {}, for every k from {least} to {greatest}", subject.about());
        let widths = if subject.is_whole() { "for all k".to_owned() } else { format!("for k = {least} to {greatest}") };
        Scope { about, widths }
    }

    /// A hardware for each of the widths of blocks that were followed, of geometries described so.
    pub(super) fn of_blocks(proposition: &Proposition, geometries: &str, blocks: &[Block]) -> Scope {
        let mut ks: Vec<u32> = blocks.iter().map(|block| block.k).collect();
        ks.dedup();
        let k = match ks[..] {
            [k] => format!("k = {k}"),
            [first, .., last] if ks.iter().copied().eq(first..=last) => format!("k = {first} to {last}"),
            _ => format!("k = {}", ks.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")),
        };
        let about = format!("{}: {geometries}, at {k}", proposition.hardware());
        Scope { about, widths: format!("at {k}") }
    }
}
