//! Decisions of a path, and how all paths are gone through: always in the same order, so that recorded contradictions
//! can be played back.

use super::poly::{Poly, Var};
use super::refute::Effort;
use super::variables::Variables;

/// Why a path ends before its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Stop {
    /// Its decisions contradict each other.
    Impossible,
    /// A decision would have to be made, which is not allowed at the moment.
    Undecided,
    /// The netlist has something that cannot be followed.
    Unsupported(String),
    /// There are too many paths, or unknowns.
    TooLarge,
    /// An invariant is not kept, after which nothing else is of interest.
    Broken,
}

/// Shows contradictions: looks for them, or plays back those that were found.
pub(crate) trait Oracle {
    /// The conditions `rows`, all 0 or more, of which those from `own` on matter most, and one alternative of each clause
    /// cannot hold together; checked in exact arithmetic.
    fn refutes(&mut self, rows: &[Poly], own: usize, clauses: &[Vec<Poly>], effort: Effort) -> bool;

    /// Nothing that it says counts any more.
    fn is_over(&self) -> bool {
        false
    }
}

/// The paths of one exploration.
pub(crate) struct Decisions<'o> {
    oracle: &'o mut dyn Oracle,
    /// What holds at the beginning of every path, each 0 or more.
    premises: Vec<Poly>,
    /// One alternative of each holds at the beginning of every path.
    clauses: Vec<Vec<Poly>>,
    /// Options to be taken on this path, in order.
    script: Vec<usize>,
    /// How many of them were taken.
    taken: usize,
    facts: Vec<Poly>,
    /// Scripts of paths still to go.
    open: Vec<Vec<usize>>,
}

/// Paths gone through at most.
const MOST_PATHS: usize = 20_000;

impl<'o> Decisions<'o> {
    pub(crate) fn new(oracle: &'o mut dyn Oracle, premises: Vec<Poly>, clauses: Vec<Vec<Poly>>) -> Decisions<'o> {
        Decisions { oracle, premises, clauses, script: Vec::new(), taken: 0, facts: Vec::new(), open: vec![Vec::new()] }
    }

    /// Goes through all paths; `walk` takes each from its beginning.
    pub(crate) fn explore(&mut self, mut walk: impl FnMut(&mut Self) -> Result<(), Stop>) -> Result<usize, Stop> {
        let mut paths = 0;
        while let Some(script) = self.open.pop().filter(|_| !self.oracle.is_over()) {
            paths += 1;
            if paths > MOST_PATHS {
                return Err(Stop::TooLarge);
            }
            (self.script, self.taken) = (script, 0);
            self.facts.clear();
            match walk(self) {
                Ok(()) | Err(Stop::Impossible) => {}
                Err(stop) => return Err(stop),
            }
        }
        Ok(paths)
    }

    pub(crate) fn facts(&self) -> &[Poly] {
        &self.facts
    }

    /// Takes on a condition that is true by construction.
    pub(crate) fn assume(&mut self, fact: Poly) {
        self.facts.push(fact);
    }

    /// Decides between options, each a list of conditions of which one holds whole. What is known already is taken; else
    /// those that are possible are gone through, one a path.
    pub(crate) fn decide(
        &mut self,
        options: &[Vec<Poly>],
        variables: &Variables,
        peeking: bool,
    ) -> Result<usize, Stop> {
        let known = options.iter().position(|option| option.iter().all(|fact| self.facts.contains(fact)));
        if let Some(known) = known {
            return Ok(known);
        }
        if peeking {
            return Err(Stop::Undecided);
        }
        let option = match self.script.get(self.taken) {
            Some(option) => *option,
            None => {
                let possible: Vec<usize> = (0..options.len())
                    .filter(|option| !self.contradicts(&options[*option], variables, Effort::Sums))
                    .collect();
                let Some((first, others)) = possible.split_first() else { return Err(Stop::Impossible) };
                for other in others.iter().rev() {
                    self.open.push([&self.script[..], &[*other]].concat());
                }
                self.script.push(*first);
                *first
            }
        };
        self.taken += 1;
        self.facts.extend(options[option].iter().cloned());
        Ok(option)
    }

    /// What holds on this path and these conditions contradict each other.
    pub(crate) fn contradicts(&mut self, more: &[Poly], variables: &Variables, effort: Effort) -> bool {
        let own: Vec<Poly> = self.facts.iter().chain(more).cloned().collect();
        let clauses = if effort == Effort::All { &self.clauses[..] } else { &[] };
        let mut vars: Vec<Var> =
            self.premises.iter().chain(&own).chain(clauses.iter().flatten()).flat_map(Poly::vars).collect();
        vars.push(super::family::Family::SCALE);
        vars.sort_unstable();
        vars.dedup();
        let mut rows = variables.ranges(vars.into_iter());
        rows.extend(self.premises.iter().cloned());
        let first_own = rows.len();
        rows.extend(own);
        rows.retain(|row| !row.is_lost());
        self.oracle.refutes(&rows, first_own.min(rows.len()), clauses, effort)
    }
}
