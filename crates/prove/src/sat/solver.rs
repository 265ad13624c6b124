//! Questions about a graph, answered by a SAT solver that keeps what it has learnt from one question to the next.

use std::cell::Cell;
use std::rc::Rc;
use std::time::{Duration, Instant};

use batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface as _, SolverOpts, lbool};

use super::aig::{Graph, Literal};

/// What ended a search.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Limit {
    /// The time that was given.
    Time,
    /// The memory that was given.
    Memory,
    /// The clock up to which was asked.
    Clock,
}

/// Time and memory of a search. Once one of them is used up, every question ends.
pub(super) struct Guard {
    start: Instant,
    time: Duration,
    /// Bytes of the process.
    memory: u64,
    reached: Cell<Option<Limit>>,
    polls: Cell<u32>,
    /// When the memory was measured last.
    measured: Cell<Duration>,
    /// Bytes of all clauses: as many again are needed for a moment when they are moved together.
    clauses: Cell<u64>,
    /// Bytes of nodes and variables, where the system does not say how much memory is in use.
    others: Cell<u64>,
}

/// Bytes of a node with its place in the table of known ones.
const NODE: u64 = 40;
/// Bytes of a variable of the solver.
const VARIABLE: u64 = 160;
/// Bytes of a clause and its two watches, without its literals.
const CLAUSE: u64 = 64;
/// Questions of the solver between two looks at the clock.
const POLLS: u32 = 64;
/// Time between two measurements of the memory.
const MEASURE: Duration = Duration::from_millis(50);

impl Guard {
    pub(super) fn new(time: Duration, memory: u64) -> Guard {
        let nothing = || Cell::new(0);
        let (reached, polls, measured) = (Cell::new(None), Cell::new(0), Cell::new(Duration::ZERO));
        Guard { start: Instant::now(), time, memory, reached, polls, measured, clauses: nothing(), others: nothing() }
    }

    /// The limit that is reached, if one is.
    pub(super) fn reached(&self) -> Option<Limit> {
        let passed = self.start.elapsed();
        if self.reached.get().is_none() {
            if passed >= self.time {
                self.reached.set(Some(Limit::Time));
            } else if passed >= self.measured.get() + MEASURE || self.measured.get().is_zero() {
                self.measured.set(passed);
                let used = resident().unwrap_or(self.clauses.get() + self.others.get());
                if used + self.clauses.get() >= self.memory {
                    self.reached.set(Some(Limit::Memory));
                }
            }
        }
        self.reached.get()
    }

    /// The same, asked often.
    fn polled(&self) -> bool {
        let polls = self.polls.get().wrapping_add(1);
        self.polls.set(polls);
        if polls.is_multiple_of(POLLS) { self.reached().is_some() } else { self.reached.get().is_some() }
    }

    fn take(&self, counter: &Cell<u64>, bytes: u64) {
        counter.set(counter.get().saturating_add(bytes));
    }
}

/// Bytes of memory that the process has, where the system says so.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib << 10)
}

/// Ends a question at a limit.
struct Watch {
    guard: Rc<Guard>,
    /// Conflicts, all and up to which is searched.
    conflicts: u64,
    most: u64,
}

fn bytes(clause: &[Lit]) -> u64 {
    CLAUSE + 4 * clause.len() as u64
}

impl Callbacks for Watch {
    fn on_new_clause(&mut self, clause: &[Lit], kind: ClauseKind) {
        self.guard.take(&self.guard.clauses, bytes(clause));
        self.conflicts += u64::from(kind == ClauseKind::Learnt);
    }

    fn on_delete_clause(&mut self, clause: &[Lit]) {
        let left = self.guard.clauses.get().saturating_sub(bytes(clause));
        self.guard.clauses.set(left);
    }

    fn stop(&self) -> bool {
        self.conflicts >= self.most || self.guard.polled()
    }
}

/// What is known of a question.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Answer {
    /// Some values make it true; [`Sat::value`] has them.
    Yes,
    /// None do.
    No,
    /// Open when the search was ended.
    Open,
}

/// The value of every node.
pub(super) struct Values(Vec<bool>);

impl Values {
    pub(super) fn of(&self, literal: Literal) -> bool {
        self.0[literal.node()] != literal.is_negated()
    }
}

/// A graph, and a solver that has met those of its nodes that were asked about.
pub(super) struct Sat {
    pub(super) graph: Graph,
    solver: Solver<Watch>,
    guard: Rc<Guard>,
    /// The solver's literal of each node.
    met: Vec<Option<Lit>>,
    counted: usize,
}

impl Sat {
    pub(super) fn new(guard: Rc<Guard>) -> Sat {
        let watch = Watch { guard: Rc::clone(&guard), conflicts: 0, most: 0 };
        let solver = Solver::new(SolverOpts::default(), watch);
        Sat { graph: Graph::new(), solver, guard, met: Vec::new(), counted: 0 }
    }

    /// Conflicts of all questions.
    pub(super) fn conflicts(&self) -> u64 {
        self.solver.cb().conflicts
    }

    fn clause(&mut self, literals: &[Lit]) {
        let mut clause = literals.to_vec();
        self.guard.take(&self.guard.clauses, bytes(&clause));
        // False where the clauses contradict each other: every further question is answered with No.
        self.solver.add_clause_reuse(&mut clause);
    }

    fn variable(&mut self) -> Lit {
        self.guard.take(&self.guard.others, VARIABLE);
        Lit::new(self.solver.new_var_default(), true)
    }

    /// The solver's literal, once its node is met.
    fn known(&self, literal: Literal) -> Option<Lit> {
        let lit = *self.met.get(literal.node())?;
        lit.map(|lit| if literal.is_negated() { !lit } else { lit })
    }

    /// The solver's literal of a literal; the solver learns of all that it depends on.
    fn meet(&mut self, literal: Literal) -> Lit {
        let nodes = self.graph.len();
        self.guard.take(&self.guard.others, NODE * (nodes - self.counted) as u64);
        self.counted = nodes;
        self.met.resize(nodes, None);
        let mut pending = vec![literal.node()];
        while let Some(&node) = pending.last() {
            if self.met[node].is_some() {
                pending.pop();
                continue;
            }
            let mux = self.graph.as_mux(node);
            let operands: Vec<Literal> = match mux {
                Some(operands) => operands.to_vec(),
                None => self.graph.operands(node).into_iter().flatten().collect(),
            };
            let lits: Option<Vec<Lit>> = operands.iter().map(|&operand| self.known(operand)).collect();
            let Some(lits) = lits else {
                pending.extend(operands.iter().map(|operand| operand.node()).filter(|&node| self.met[node].is_none()));
                continue;
            };
            let out = self.variable();
            match lits[..] {
                [select, high, low] => self.mux(out, select, high, low),
                [a, b] => {
                    [vec![!out, a], vec![!out, b], vec![out, !a, !b]].iter().for_each(|clause| self.clause(clause))
                }
                _ if node == 0 => self.clause(&[!out]),
                _ => {}
            }
            self.met[node] = Some(out);
            pending.pop();
        }
        self.known(literal).unwrap_or(Lit::UNDEF)
    }

    /// `out` = `select` ? `high` : `low`
    fn mux(&mut self, out: Lit, select: Lit, high: Lit, low: Lit) {
        self.clause(&[!select, !high, out]);
        self.clause(&[!select, high, !out]);
        self.clause(&[select, !low, out]);
        self.clause(&[select, low, !out]);
        if high != !low {
            // What follows without knowing which is selected.
            self.clause(&[!high, !low, out]);
            self.clause(&[high, low, !out]);
        }
    }

    /// One of these holds, from now on.
    pub(super) fn require(&mut self, any: &[Literal]) {
        let lits: Vec<Lit> = any.iter().map(|&literal| self.meet(literal)).collect();
        self.clause(&lits);
    }

    /// Whether all of these can hold, within this number of conflicts.
    pub(super) fn ask(&mut self, all: &[Literal], conflicts: u64) -> Answer {
        if all.contains(&Literal::FALSE) {
            return Answer::No;
        }
        let lits: Vec<Lit> = all.iter().map(|&literal| self.meet(literal)).collect();
        if self.guard.reached().is_some() {
            return Answer::Open;
        }
        let watch = self.solver.cb_mut();
        watch.most = watch.conflicts.saturating_add(conflicts);
        match self.solver.solve_limited(&lits) {
            answer if answer == lbool::TRUE => Answer::Yes,
            answer if answer == lbool::FALSE => Answer::No,
            _ => Answer::Open,
        }
    }

    /// The values of all nodes after a question that was answered with Yes. Variables that the solver has not met are 0.
    pub(super) fn values(&self) -> Values {
        let variable = |node: usize| {
            let lit = self.met.get(node).copied().flatten();
            lit.is_some_and(|lit| self.solver.value_lit(lit) == lbool::TRUE)
        };
        Values(self.graph.evaluate(variable))
    }
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;
    use std::time::Duration;

    use super::{Answer, Guard, Limit, Literal, Sat};

    fn sat() -> Sat {
        Sat::new(Rc::new(Guard::new(Duration::from_secs(1000), u64::MAX)))
    }

    #[test]
    fn answers_about_random_functions_are_those_of_their_truth_tables() {
        let mut seed = 3u64;
        let mut random = |limit: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            usize::try_from(seed >> 33).unwrap() % limit
        };
        let mut answers = [0, 0];
        for _ in 0..40 {
            let mut sat = sat();
            let mut made: Vec<Literal> = sat.graph.variables(5);
            for _ in 0..60 {
                let mut pick = || made[random(made.len())].negated_if(random(2) == 1);
                let [a, b, c] = [pick(), pick(), pick()];
                made.push(match random(3) {
                    0 => sat.graph.and(a, b),
                    1 => sat.graph.xor(a, b),
                    _ => sat.graph.mux(a, b, c),
                });
            }
            let tables: Vec<Vec<bool>> =
                (0..32usize).map(|point| sat.graph.evaluate(|node| point >> (node - 1) & 1 == 1)).collect();
            for _ in 0..20 {
                let asked: Vec<Literal> = (0..3).map(|_| made[random(made.len())].negated_if(random(2) == 1)).collect();
                let holds = |table: &&Vec<bool>| asked.iter().all(|l| table[l.node()] != l.is_negated());
                let want = if tables.iter().any(|table| holds(&table)) { Answer::Yes } else { Answer::No };
                assert_eq!(sat.ask(&asked, u64::MAX), want);
                answers[usize::from(want == Answer::Yes)] += 1;
                if want == Answer::Yes {
                    let values = sat.values();
                    assert!(asked.iter().all(|&literal| values.of(literal)));
                }
            }
        }
        assert!(answers.iter().all(|&count| count > 100), "{answers:?}");
    }

    #[test]
    fn what_is_required_holds_in_every_later_question() {
        let mut sat = sat();
        let (a, b) = (sat.graph.variable(), sat.graph.variable());
        assert_eq!(sat.ask(&[a, b], u64::MAX), Answer::Yes);
        sat.require(&[!a, !b]);
        assert_eq!(sat.ask(&[a, b], u64::MAX), Answer::No);
        assert_eq!(sat.ask(&[a], u64::MAX), Answer::Yes);
        let values = sat.values();
        assert!(values.of(a) && !values.of(b) && values.of(!b));
        sat.require(&[a]);
        sat.require(&[b]);
        assert_eq!(sat.ask(&[Literal::TRUE], u64::MAX), Answer::No);
    }

    #[test]
    fn a_question_that_is_too_hard_ends_at_its_limit() {
        // 13 pigeons in 12 holes.
        let pigeons = |sat: &mut Sat| {
            let at: Vec<Vec<Literal>> = (0..13).map(|_| sat.graph.variables(12)).collect();
            at.iter().for_each(|holes| sat.require(holes));
            for hole in 0..12 {
                for (first, one) in at.iter().enumerate() {
                    at[..first].iter().for_each(|other| sat.require(&[!one[hole], !other[hole]]));
                }
            }
        };
        let mut few = sat();
        pigeons(&mut few);
        assert_eq!(few.ask(&[], 50), Answer::Open);
        assert!((50..80).contains(&few.conflicts()), "{}", few.conflicts());
        for (time, memory, limit) in
            [(Duration::from_millis(30), u64::MAX, Limit::Time), (Duration::MAX, 1, Limit::Memory)]
        {
            let guard = Rc::new(Guard::new(time, memory));
            let mut sat = Sat::new(Rc::clone(&guard));
            pigeons(&mut sat);
            assert_eq!((sat.ask(&[], u64::MAX), guard.reached()), (Answer::Open, Some(limit)));
        }
    }
}
