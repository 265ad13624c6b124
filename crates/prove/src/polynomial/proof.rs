//! From a case to a proof: invariants are guessed from recorded runs, what a step does not keep is dropped, and what is
//! left is proved and recorded.

use super::certificate::Certificate;
use super::decisions::Oracle;
use super::family::Family;
use super::farkas::{Refutation, holds};
use super::infer;
use super::obligations::{self, Findings, Invariants};
use super::poly::{Poly, Var};
use super::refute::{self, Effort};
use super::system::{Case, CaseError, System};
use crate::Strobes;
use stepwave_netlist::cells::Net;

/// The state of a running block between two steps, from a recorded run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The k of the netlist that ran.
    pub k: u32,
    /// The symbols of the case, in its order.
    pub symbols: Vec<i128>,
    /// What every register holds as it is read, in the order of
    /// [`Design::registers`](stepwave_netlist::Design::registers).
    pub registers: Vec<i128>,
    /// Steps that the block has taken: 0 in the first row of a run.
    pub steps: i128,
}

/// What came of an attempt at a proof. Every sentence names what it could not show. Paths end at their first violated
/// claim: where `violated` names one, goals and the end of blocks are shown up to the first violation alone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Proof {
    /// The invariants that hold in every row, in words.
    pub invariants: Vec<String>,
    /// Invariants of the author that a step does not keep; then nothing is proved.
    pub not_inductive: Vec<String>,
    /// Claims of the netlist that may be violated, by number, and on which path.
    pub violated: Vec<(usize, String)>,
    /// Goals that may be missed, by name, and on which path.
    pub missed: Vec<(String, String)>,
    /// Why the block may never end; also where the case states no rank.
    pub endless: Option<String>,
    /// What could not be followed; then nothing is proved.
    pub astray: Option<String>,
    /// Paths gone through in the last pass.
    pub paths: usize,
    /// Contradictions that were shown in it.
    pub contradictions: usize,
}

impl Proof {
    /// What `endless` says where the case states no rank.
    pub const NO_RANK: &str = "no rank is stated";

    /// The invariants are inductive, so that claims and goals that are not named as open are proved.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.not_inductive.is_empty() && self.astray.is_none()
    }

    /// Everything is proved but, perhaps, that the block ends.
    #[must_use]
    pub fn is_safe(&self) -> bool {
        self.holds() && self.violated.is_empty() && self.missed.is_empty()
    }
}

/// Looks for contradictions and records them.
struct Search<'b> {
    answers: Vec<Option<Refutation>>,
    /// Sums of products that may still be looked for.
    budget: &'b mut usize,
}

impl Oracle for Search<'_> {
    fn refutes(&mut self, rows: &[Poly], own: usize, clauses: &[Vec<Poly>], effort: Effort) -> bool {
        let found = refute::refute(rows, own, clauses, effort, self.budget);
        let held = found.as_ref().is_some_and(|found| holds(found, &mut rows.to_vec(), clauses, &mut { EFFORT }));
        self.answers.push(found.filter(|_| held));
        held
    }
}

/// Plays recorded contradictions back, each checked.
struct Playback<'c> {
    answers: std::slice::Iter<'c, Option<Refutation>>,
    /// Multiplications that may still be made.
    effort: usize,
    /// Answers that may still leave a question open.
    open: usize,
    /// An answer was wrong or missing: the certificate is invalid.
    wrong: bool,
}

impl Oracle for Playback<'_> {
    fn refutes(&mut self, rows: &[Poly], _: usize, clauses: &[Vec<Poly>], _: Effort) -> bool {
        // The answers that follow belong to other paths; so that these need not be gone through, each ends at once.
        if self.wrong {
            return true;
        }
        match self.answers.next() {
            Some(Some(refutation)) => {
                self.wrong = !holds(refutation, &mut rows.to_vec(), clauses, &mut self.effort);
                true
            }
            Some(None) if self.open > 0 => {
                self.open -= 1;
                false
            }
            _ => {
                self.wrong = true;
                true
            }
        }
    }

    fn is_over(&self) -> bool {
        self.wrong
    }
}

/// Sums of products that are looked for in one attempt; then it counts as failed.
const BUDGET: usize = 30_000;
/// Multiplications that the certificate of one kind of geometry may take: those of the models here take a hundredth.
const EFFORT: usize = 50_000_000;
/// Questions that a certificate may leave open, each of which is a path more: those of the models here leave a hundred, but
/// those of a ramp that brakes by count thousands.
const MOST_OPEN: usize = 20_000;
/// Rounds of dropping what is not inductive, at most.
const MOST_ROUNDS: usize = 12;

/// Attempts a proof of a case. `rows` are of running blocks, not of their ends: runs one after the other, each from its
/// first row on.
///
/// # Errors
/// The case does not fit the netlist.
pub fn prove(family: &Family, strobes: Strobes, case: &Case, rows: &[Row]) -> Result<(Proof, Certificate), CaseError> {
    let system = System::new(family, strobes, case)?;
    let mut invariants = guess(&system, rows);
    let (mut given_up, mut budget) = (Vec::new(), BUDGET);
    for _ in 0..MOST_ROUNDS {
        let mut search = Search { answers: Vec::new(), budget: &mut budget };
        let findings = obligations::check(&system, &invariants, &mut search, false);
        if findings.broken_equalities.is_empty() && findings.broken_clauses.is_empty() {
            let certificate = Certificate { invariants, answers: search.answers };
            return Ok((proof(&system, &findings, &certificate, given_up), certificate));
        }
        given_up.extend(drop_broken(&system, &mut invariants, &findings));
    }
    let findings = Findings { astray: Some("no end of broken invariants".to_owned()), ..Findings::default() };
    let certificate = Certificate { invariants, answers: Vec::new() };
    Ok((proof(&system, &findings, &certificate, given_up), certificate))
}

/// Checks a certificate of a case: nothing is looked for, nothing believed.
///
/// # Errors
/// The case does not fit the netlist.
pub fn check(family: &Family, strobes: Strobes, case: &Case, certificate: &Certificate) -> Result<Proof, CaseError> {
    let system = System::new(family, strobes, case)?;
    let all = &certificate.invariants;
    let is_alone = |(place, own): (usize, &Invariants)| all[..place].iter().all(|other| other.modes != own.modes);
    let fits = certificate.fits(system.variables.len())
        && all.iter().all(|own| own.modes.len() == system.count_modes())
        && all.iter().enumerate().all(is_alone);
    if !fits {
        let astray =
            Some("the certificate has variables or modes that the case does not have, or modes twice".to_owned());
        return Ok(Proof { astray, ..Proof::default() });
    }
    let answers = certificate.answers.iter();
    let mut playback = Playback { answers, effort: EFFORT, open: MOST_OPEN, wrong: false };
    let findings = obligations::check(&system, &certificate.invariants, &mut playback, true);
    let mut proof = proof(&system, &findings, certificate, Vec::new());
    if playback.wrong {
        proof.astray = Some("a step of the certificate does not show what it should".to_owned());
    } else if !findings.broken_equalities.is_empty() || !findings.broken_clauses.is_empty() {
        proof.astray = Some("the certificate's invariants are not inductive".to_owned());
    }
    Ok(proof)
}

/// An invariant of a certificate that does not hold in one of these rows, in words. Runs are one after the other, each
/// from its first row on.
///
/// # Errors
/// The case does not fit the netlist.
pub fn violated(
    family: &Family,
    strobes: Strobes,
    case: &Case,
    certificate: &Certificate,
    rows: &[Row],
) -> Result<Option<String>, CaseError> {
    let system = System::new(family, strobes, case)?;
    let name = |var| system.variables.name(var);
    for (modes, values) in system.modes_of(rows) {
        let value = |poly: &Poly| poly.value(|var| values[var.index()]);
        let Some(own) = certificate.invariants.iter().find(|own| own.modes == modes) else {
            return Ok(Some(format!("modes {modes:?}")));
        };
        for (var, poly) in &own.equalities {
            if value(poly) != Some(values[var.index()]) {
                return Ok(Some(format!("{} = {}", name(*var), poly.display(name))));
            }
        }
        for any in &own.clauses {
            if !any.iter().any(|poly| value(poly).is_some_and(|number| number >= 0)) {
                return Ok(Some(in_words(&system, any)));
            }
        }
    }
    Ok(None)
}

/// Takes out what a step does not keep; gives those of the author, in words.
fn drop_broken(system: &System<'_>, invariants: &mut [Invariants], findings: &Findings) -> Vec<String> {
    let mut authored = Vec::new();
    for (place, own) in invariants.iter_mut().enumerate() {
        let mut number = 0;
        own.clauses.retain(|clause| {
            let broken = findings.broken_clauses.contains(&(place, number));
            number += 1;
            let author = system.stated(&own.modes).authored.iter().find(|(_, any)| any == clause);
            if let (true, Some((name, any))) = (broken, author) {
                authored.push(format!("{name}: {}", in_words(system, any)));
            }
            !broken
        });
        own.equalities.retain(|(var, _)| !findings.broken_equalities.contains(&(place, *var)));
    }
    authored
}

pub(super) fn in_words(system: &System<'_>, any: &[Poly]) -> String {
    let name = |var| system.variables.name(var);
    any.iter().map(|poly| format!("{} >= 0", poly.display(name))).collect::<Vec<_>>().join(" or ")
}

fn proof(system: &System<'_>, findings: &Findings, certificate: &Certificate, not_inductive: Vec<String>) -> Proof {
    let name = |var| system.variables.name(var);
    let mut invariants = Vec::new();
    for own in &certificate.invariants {
        let mode = system.in_modes(&own.modes);
        invariants
            .extend(own.equalities.iter().map(|(var, poly)| format!("{mode}{} = {}", name(*var), poly.display(name))));
        invariants.extend(own.clauses.iter().map(|any| format!("{mode}{}", in_words(system, any))));
    }
    let missed = findings.missed.iter().map(|(number, path)| (system.goals[*number].0.clone(), path.clone()));
    let no_rank = || system.rank.is_none().then(|| Proof::NO_RANK.to_owned());
    Proof {
        invariants,
        not_inductive,
        violated: findings.violated.clone(),
        missed: missed.collect(),
        endless: findings.endless.clone().or_else(no_rank),
        astray: findings.astray.clone(),
        paths: findings.paths,
        contradictions: certificate.answers.iter().flatten().count(),
    }
}

/// The k of a row, and the value of every variable in it.
type Values = (u32, Vec<i128>);

/// Invariants that the recorded runs suggest, with those of the author.
fn guess(system: &System<'_>, rows: &[Row]) -> Vec<Invariants> {
    let mut by_modes: Vec<(Vec<i128>, Vec<Values>)> = Vec::new();
    for ((modes, values), row) in system.modes_of(rows).into_iter().zip(rows) {
        match by_modes.iter_mut().find(|(other, _)| *other == modes) {
            Some((_, group)) => group.push((row.k, values)),
            None => by_modes.push((modes, vec![(row.k, values)])),
        }
    }
    by_modes.sort();
    by_modes.into_iter().map(|(modes, group)| guess_in(system, modes, &group)).collect()
}

fn guess_in(system: &System<'_>, modes: Vec<i128>, rows: &[Values]) -> Invariants {
    let values: Vec<Vec<i128>> = rows.iter().map(|(_, values)| values.clone()).collect();
    let relevant = system.relevant();
    let registers: Vec<Var> =
        system.registers.iter().map(|(_, var)| *var).filter(|var| relevant.contains(var)).collect();
    let bits = system.bitwise.iter().flat_map(|(_, bits)| bits.iter().copied());
    // Products with flags say nothing.
    let is_flag = |register: &Net| {
        let width = system.family.width(*register);
        !width.grows && width.fixed <= 2
    };
    let flags: Vec<Var> = system.registers.iter().filter(|(net, _)| is_flag(net)).map(|(_, var)| *var).collect();
    let scale = (system.family.ks().len() > 1).then_some(Family::SCALE);
    let free = scale.into_iter().chain(system.symbols.iter().copied()).chain(bits).chain(system.steps);
    let free: Vec<Var> = free.collect();
    let infer::Found { equalities, zeros } = infer::equalities(&values, &registers, &free, &flags);
    let stated = system.stated(&modes);
    let authored = stated.authored.iter().map(|(_, any)| any.clone());
    let mut clauses: Vec<Vec<Poly>> = authored.chain(system.rank.iter().map(|rank| vec![rank.clone()])).collect();
    clauses.extend(stated.guesses.iter().cloned());
    clauses.extend(zeros.into_iter().flat_map(|zero| [vec![zero.negated()], vec![zero]]));
    // Bounds that are the same for every k.
    for var in
        registers.iter().filter(|var| equalities.iter().all(|(other, poly)| other != *var || poly.constant().is_none()))
    {
        let mut by_k: Vec<(u32, i128, i128)> = Vec::new();
        for (k, row) in rows {
            let value = row[var.index()];
            match by_k.iter_mut().find(|(other, ..)| other == k) {
                Some((_, least, greatest)) => (*least, *greatest) = (value.min(*least), value.max(*greatest)),
                None => by_k.push((*k, value, value)),
            }
        }
        let Some(&(_, least, greatest)) = by_k.first() else { continue };
        let own = Poly::from(*var);
        let known = system.variables.ranges([*var].into_iter());
        if by_k.iter().all(|(_, other, _)| *other == least) {
            clauses.extend(Some(vec![own.plus_number(-least)]).filter(|bound| !known.contains(&bound[0])));
        }
        if by_k.len() > 1 && by_k.iter().all(|(.., other)| *other == greatest) {
            clauses.extend(Some(vec![own.negated().plus_number(greatest)]).filter(|bound| !known.contains(&bound[0])));
        }
    }
    Invariants { modes, equalities, clauses }
}
