//! The obligations of a proof: invariants hold when a block is loaded, every step keeps them, no claim is violated
//! at any clock, and what ends the block is the goal.

use super::decisions::{Decisions, Oracle, Stop};
use super::path::Path;
use super::poly::{Poly, Var};
use super::refute::Effort;
use super::system::System;

/// What holds in every row of a block that runs, for one combination of the modes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Invariants {
    /// Values of the mode registers, and, where they are counted, how often these have changed.
    pub(crate) modes: Vec<i128>,
    /// Variables and what they equal, as polynomials of other variables.
    pub(crate) equalities: Vec<(Var, Poly)>,
    /// At least one of each list is 0 or more.
    pub(crate) clauses: Vec<Vec<Poly>>,
}

/// What was found wrong.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Findings {
    /// Invariants that a step or the load does not keep: which combination of modes, and its equality or clause.
    pub(crate) broken_equalities: Vec<(usize, Var)>,
    pub(crate) broken_clauses: Vec<(usize, usize)>,
    /// Claims of no overflow that may be violated, by number, and a path.
    pub(crate) violated: Vec<(usize, String)>,
    /// Goals that may be missed, by number, and a path.
    pub(crate) missed: Vec<(usize, String)>,
    /// The rank may not fall.
    pub(crate) endless: Option<String>,
    /// A step leads to modes that were never seen, or beyond what can be followed.
    pub(crate) astray: Option<String>,
    /// Paths gone through.
    pub(crate) paths: usize,
    /// The first broken invariant ends it all: a certificate has none.
    pub(crate) strict: bool,
}

impl Findings {
    fn is_broken(&self) -> bool {
        !self.broken_equalities.is_empty() || !self.broken_clauses.is_empty()
    }
}

/// Clocks of a step at most.
const LONGEST_STEP: usize = 8;

/// Goes through the load and one step from every combination of modes; if `strict`, to the first invariant that is
/// broken.
pub(crate) fn check(system: &System<'_>, all: &[Invariants], oracle: &mut dyn Oracle, strict: bool) -> Findings {
    let mut findings = Findings { strict, ..Findings::default() };
    load(system, all, oracle, &mut findings);
    for place in 0..all.len() {
        if strict && (findings.is_broken() || findings.astray.is_some()) {
            break;
        }
        step(system, all, place, oracle, &mut findings);
    }
    findings
}

/// The edge that loads the block, for all previous contents of the registers.
fn load(system: &System<'_>, all: &[Invariants], oracle: &mut dyn Oracle, findings: &mut Findings) {
    let first = first_state(system, None);
    let later = [(system.strobes.load, 0), (system.strobes.preset_position, 0)];
    let (premises, clauses) = split(&system.premises);
    let mut decisions = Decisions::new(oracle, premises, clauses);
    let explored = decisions.explore(|decisions| {
        let mut path = Path::new(system.family, &system.variables, &first, &later, decisions);
        claims(system, &mut path, 0, findings)?;
        if !path.truth(system.strobes.loaded, 1)? {
            return astray(&mut path, "the edge that loads does not load", findings);
        }
        row(system, all, &mut path, 1, None, findings)
    });
    count(explored, findings);
}

/// One step from a row.
fn step(system: &System<'_>, all: &[Invariants], place: usize, oracle: &mut dyn Oracle, findings: &mut Findings) {
    let first = first_state(system, Some(&all[place]));
    let later = [(system.strobes.load, 0), (system.strobes.preset_position, 0)];
    let known = |var: Var| all[place].equalities.iter().find(|(other, _)| *other == var).map(|(_, poly)| poly);
    // A register lies in its range, even if it equals something else.
    let mut premises: Vec<Vec<Poly>> = Vec::new();
    for (var, poly) in &all[place].equalities {
        let ranges = system.variables.ranges([*var].into_iter());
        premises.extend(ranges.iter().map(|range| vec![range.replaced(|v| (v == *var).then_some(poly))]));
    }
    premises.extend(system.premises.iter().cloned());
    let replaced = |clause: &Vec<Poly>| clause.iter().map(|poly| poly.replaced(known)).collect();
    premises.extend(all[place].clauses.iter().map(replaced));
    for clause in &mut premises {
        clause.retain(|poly| poly.constant().is_none_or(|number| number >= 0));
    }
    premises.retain(|clause: &Vec<Poly>| !clause.iter().any(|poly| poly.constant().is_some_and(|number| number >= 0)));
    let (premises, clauses) = split(&premises);
    let rank = system.rank.as_ref().map(|rank| rank.replaced(known));
    let mut decisions = Decisions::new(oracle, premises, clauses);
    let explored = decisions.explore(|decisions| {
        let mut path = Path::new(system.family, &system.variables, &first, &later, decisions);
        for clock in 0..LONGEST_STEP {
            claims(system, &mut path, clock, findings)?;
            if path.truth(system.strobes.stepped, clock + 1)? {
                falls(system, rank.as_ref(), &mut path, clock + 1, findings)?;
                return if path.truth(system.strobes.done, clock + 1)? {
                    claims(system, &mut path, clock + 1, findings)?;
                    goals(system, &mut path, clock + 1, findings)
                } else {
                    row(system, all, &mut path, clock + 1, Some(&all[place]), findings)
                };
            }
        }
        astray(&mut path, "a step takes more clocks than are followed", findings)
    });
    count(explored, findings);
}

fn count(explored: Result<usize, Stop>, findings: &mut Findings) {
    match explored {
        Ok(paths) => findings.paths += paths,
        Err(Stop::Unsupported(what)) => findings.astray = Some(format!("not followed: {what}")),
        Err(Stop::TooLarge) => findings.astray = Some("there are too many paths".to_owned()),
        // It is among what was found.
        Err(Stop::Broken) => {}
        Err(Stop::Impossible | Stop::Undecided) => {
            findings.astray = Some("a path was cut short, which is a mistake of the prover".to_owned())
        }
    }
}

/// What registers and inputs hold at the first clock: every register an unknown, or what it equals by the invariants of
/// a row; without invariants it is the clock that loads. The words are on the inputs, and stay there.
fn first_state(system: &System<'_>, invariants: Option<&Invariants>) -> Vec<Poly> {
    let equalities = invariants.map_or(&[][..], |invariants| &invariants.equalities);
    let known = |var: Var| equalities.iter().find(|(other, _)| *other == var).map(|(_, poly)| poly);
    let value = |var: Var| known(var).cloned().unwrap_or_else(|| Poly::from(var));
    let mut first = vec![Poly::from(0); system.family.netlist().cells.len()];
    for (input, word) in &system.words {
        first[input.index()] = word.clone();
    }
    for (register, var) in &system.registers {
        first[register.index()] = value(*var);
    }
    for (register, bits) in &system.bitwise {
        let bits = bits.iter().enumerate().map(|(place, bit)| value(*bit).times_number(1 << place));
        first[register.index()] = bits.fold(Poly::from(0), |sum, bit| sum.plus(&bit));
    }
    if invariants.is_some() {
        // After the edge that loads, nothing loads.
        first[system.strobes.load.index()] = Poly::from(0);
        first[system.strobes.preset_position.index()] = Poly::from(0);
    }
    first
}

/// Conditions by themselves, and those of several alternatives.
fn split(all: &[Vec<Poly>]) -> (Vec<Poly>, Vec<Vec<Poly>>) {
    let (single, several): (Vec<_>, Vec<_>) = all.iter().cloned().partition(|clause| clause.len() == 1);
    (single.into_iter().flatten().collect(), several)
}

/// No claim is violated at this clock.
fn claims(system: &System<'_>, path: &mut Path<'_, '_>, clock: usize, findings: &mut Findings) -> Result<(), Stop> {
    for (number, property) in system.family.netlist().properties.iter().enumerate() {
        if path.truth(property.never, clock)? {
            if !contradicts(path, &[]) {
                let reported = findings.violated.iter().any(|(other, _)| *other == number);
                if !reported {
                    findings.violated.push((number, story(path)));
                }
            }
            return Err(Stop::Impossible);
        }
    }
    Ok(())
}

/// The invariants hold in the row at this clock, a step after a row of those `before`, or where the block was loaded.
fn row(
    system: &System<'_>,
    all: &[Invariants],
    path: &mut Path<'_, '_>,
    clock: usize,
    before: Option<&Invariants>,
    findings: &mut Findings,
) -> Result<(), Stop> {
    let mut held = Vec::new();
    for (register, _) in &system.modes {
        let number = path.unsigned(*register, clock)?.constant();
        held.push(number.ok_or_else(|| Stop::Unsupported("modes that depend on the geometry".to_owned()))?);
    }
    let modes = system.after(before.map(|before| &before.modes[..]), held);
    let Some(place) = all.iter().position(|invariants| invariants.modes == modes) else {
        return astray(path, "modes that were never seen", findings);
    };
    let needed: Vec<Var> = {
        let clauses = all[place].clauses.iter().flatten().flat_map(Poly::vars);
        let equalities = all[place].equalities.iter().flat_map(|(var, poly)| [vec![*var], poly.vars()].concat());
        clauses.chain(equalities).collect()
    };
    let mut next = next_values(system, path, clock, |var| needed.contains(&var))?;
    if let Some(var) = system.steps.filter(|_| before.is_none()) {
        next[var.index()] = Some(Poly::from(0));
    }
    let value = |var: Var| next.get(var.index()).and_then(Option::as_ref);
    for (var, poly) in &all[place].equalities {
        let gap = Poly::from(*var).minus(poly).replaced(value);
        let kept = gap.constant() == Some(0)
            || contradicts(path, &[gap.plus_number(-1)]) && contradicts(path, &[gap.negated().plus_number(-1)]);
        if !kept && !findings.broken_equalities.contains(&(place, *var)) {
            findings.broken_equalities.push((place, *var));
            stop_if_strict(findings)?;
        }
    }
    for (number, clause) in all[place].clauses.iter().enumerate() {
        if findings.broken_clauses.contains(&(place, number)) {
            continue;
        }
        if !follows(path, &clause.iter().map(|poly| poly.replaced(value)).collect::<Vec<_>>()) {
            findings.broken_clauses.push((place, number));
            stop_if_strict(findings)?;
        }
    }
    Ok(())
}

fn stop_if_strict(findings: &Findings) -> Result<(), Stop> {
    if findings.strict { Err(Stop::Broken) } else { Ok(()) }
}

/// The goals hold in the last row.
fn goals(system: &System<'_>, path: &mut Path<'_, '_>, clock: usize, findings: &mut Findings) -> Result<(), Stop> {
    let needed: Vec<Var> = system.goals.iter().flat_map(|(_, any)| any.iter().flat_map(Poly::vars)).collect();
    let next = next_values(system, path, clock, |var| needed.contains(&var))?;
    let value = |var: Var| next.get(var.index()).and_then(Option::as_ref);
    for (number, (_, any)) in system.goals.iter().enumerate() {
        let reported = findings.missed.iter().any(|(other, _)| *other == number);
        if !reported && !follows(path, &any.iter().map(|poly| poly.replaced(value)).collect::<Vec<_>>()) {
            findings.missed.push((number, story(path)));
        }
    }
    Ok(())
}

/// The rank was 0 or more, and is less after the step.
fn falls(
    system: &System<'_>,
    before: Option<&Poly>,
    path: &mut Path<'_, '_>,
    clock: usize,
    findings: &mut Findings,
) -> Result<(), Stop> {
    let (Some(rank), Some(before)) = (&system.rank, before) else { return Ok(()) };
    if findings.endless.is_some() {
        return Ok(());
    }
    let needed = rank.vars();
    let next = next_values(system, path, clock, |var| needed.contains(&var))?;
    let after = rank.replaced(|var| next.get(var.index()).and_then(Option::as_ref));
    let falls = follows(path, &[before.minus(&after).plus_number(-1)]) && follows(path, std::slice::from_ref(before));
    if !falls {
        findings.endless = Some(story(path));
    }
    Ok(())
}

/// The values of the wanted variables of registers after the clocks of a step, by variable.
fn next_values(
    system: &System<'_>,
    path: &mut Path<'_, '_>,
    clock: usize,
    wanted: impl Fn(Var) -> bool,
) -> Result<Vec<Option<Poly>>, Stop> {
    let mut next = vec![None; system.variables.len()];
    for (register, var) in &system.registers {
        if wanted(*var) {
            let value = if system.is_signed(*register) {
                path.signed(*register, clock)?
            } else {
                path.unsigned(*register, clock)?
            };
            next[var.index()] = Some(value);
        }
    }
    if let Some(var) = system.steps {
        next[var.index()] = Some(Poly::from(var).plus_number(1));
    }
    for (register, bits) in &system.bitwise {
        if bits.iter().any(|bit| wanted(*bit)) {
            let number = path.unsigned(*register, clock)?;
            for (place, bit) in bits.iter().enumerate() {
                let value = path.variables.bits_of(&number, 1 << place, 2);
                next[bit.index()] = Some(value.ok_or_else(|| Stop::Unsupported("the bits of a sum".to_owned()))?);
            }
        }
    }
    Ok(next)
}

/// One of these is 0 or more on this path.
fn follows(path: &mut Path<'_, '_>, any: &[Poly]) -> bool {
    if any.iter().any(|poly| poly.constant().is_some_and(|number| number >= 0)) {
        return true;
    }
    let none: Vec<Poly> = any.iter().map(|poly| poly.negated().plus_number(-1)).collect();
    !any.iter().any(Poly::is_lost) && contradicts(path, &none)
}

fn contradicts(path: &mut Path<'_, '_>, more: &[Poly]) -> bool {
    let (decisions, variables) = path.decisions();
    decisions.contradicts(more, variables, Effort::All)
}

fn astray(path: &mut Path<'_, '_>, what: &str, findings: &mut Findings) -> Result<(), Stop> {
    if !contradicts(path, &[]) && findings.astray.is_none() {
        findings.astray = Some(format!("{what}: {}", story(path)));
    }
    Ok(())
}

/// The decisions of a path in words.
fn story(path: &Path<'_, '_>) -> String {
    let facts = path.facts().iter().map(|fact| format!("{} >= 0", fact.display(|var| path.variables.name(var))));
    facts.collect::<Vec<_>>().join(", ")
}
