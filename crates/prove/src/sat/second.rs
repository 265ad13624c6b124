//! The questions that verdicts rest on, for a solver of another kind: each with its answer.
//!
//! They are written from the unrolled design alone, without what the search has learnt, and with another encoding.

use std::fmt::Write as _;
use std::rc::Rc;
use std::time::Duration;

use super::aig::{Graph, Literal};
use super::solver::Guard;
use super::unrolled::Unrolled;
use super::words::differs;
use super::{Search, Verdict};

/// A formula in clauses, and whether some values make all of them true.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Query {
    /// What it asks, in words.
    pub about: String,
    /// Its answer, if the verdicts are right.
    pub satisfiable: bool,
    /// Variables, numbered from 1.
    pub variables: usize,
    /// Clauses: variables, or their complements as negative numbers, of which one holds.
    pub clauses: Vec<Vec<i64>>,
}

impl Query {
    /// The formula in the form of DIMACS, which SAT solvers read.
    #[must_use]
    pub fn dimacs(&self) -> String {
        let mut text = format!("c {}\np cnf {} {}\n", self.about, self.variables, self.clauses.len());
        for clause in &self.clauses {
            clause.iter().for_each(|literal| text += &format!("{literal} "));
            text += "0\n";
        }
        text
    }

    /// The formula as a script in SMT-LIB 2, which ends with the question.
    #[must_use]
    pub fn smt2(&self) -> String {
        // Writing to a string cannot fail.
        let mut text = format!("; {}\n(set-logic QF_BV)\n", self.about);
        for variable in 1..=self.variables {
            let _ = writeln!(text, "(declare-const v{variable} Bool)");
        }
        for clause in &self.clauses {
            text += "(assert (or false";
            for literal in clause {
                let variable = literal.unsigned_abs();
                let _ = if *literal < 0 { write!(text, " (not v{variable})") } else { write!(text, " v{variable}") };
            }
            text += "))\n";
        }
        text + "(check-sat)\n"
    }
}

/// What is known of a formula while it is written.
struct Writer<'g> {
    graph: &'g Graph,
    /// The variable of each node that it depends on.
    variables: Vec<i64>,
    query: Query,
}

impl Writer<'_> {
    /// The number of a literal, whose node and all that it depends on have variables from then on.
    fn number(&mut self, literal: Literal) -> i64 {
        let mut pending = vec![literal.node()];
        while let Some(&node) = pending.last() {
            let operands = self.graph.operands(node);
            let missing = operands.iter().flatten().map(|operand| operand.node());
            let missing: Vec<usize> = missing.filter(|&node| self.variables[node] == 0).collect();
            if self.variables[node] != 0 || missing.is_empty() {
                pending.pop();
            }
            if self.variables[node] != 0 {
                continue;
            }
            if !missing.is_empty() {
                pending.extend(missing);
                continue;
            }
            self.query.variables += 1;
            let out = i64::try_from(self.query.variables).unwrap_or(i64::MAX);
            self.variables[node] = out;
            if let Some([a, b]) = operands.map(|both| both.map(|operand| self.signed(operand))) {
                self.query.clauses.extend([vec![-out, a], vec![-out, b], vec![out, -a, -b]]);
            } else if node == 0 {
                self.query.clauses.push(vec![-out]);
            }
        }
        self.signed(literal)
    }

    fn signed(&self, literal: Literal) -> i64 {
        let variable = self.variables[literal.node()];
        if literal.is_negated() { -variable } else { variable }
    }
}

/// Whether some values make all of these true.
fn query(graph: &Graph, all: &[Literal], about: String, satisfiable: bool) -> Query {
    let query = Query { about, satisfiable, variables: 0, clauses: Vec::new() };
    let mut writer = Writer { graph, variables: vec![0; graph.len()], query };
    for &literal in all {
        let number = writer.number(literal);
        writer.query.clauses.push(vec![number]);
    }
    writer.query
}

/// Goals that were proved together, each relying on the others.
pub(super) struct Batch {
    pub(super) depth: usize,
    pub(super) goals: Vec<usize>,
}

impl Search<'_, '_> {
    /// The questions that the verdicts rest on.
    pub(super) fn queries(&self) -> Vec<Query> {
        let mut queries = self.bounded_queries();
        let mut before: Vec<usize> = Vec::new();
        for batch in &self.batches {
            queries.push(self.step_query(batch, &before));
            before.extend(&batch.goals);
        }
        queries
    }

    /// Samples in which a goal is said not to be violated, and the one after them if it is violated there.
    fn said(&self, goal: usize) -> (usize, bool) {
        match self.goals[goal].verdict {
            Some(Verdict::Proved { depth }) => (self.question.inputs.rows.len() + depth, false),
            _ if goal >= self.main => (0, false),
            Some(Verdict::Violated { clock, .. }) => (usize::try_from(clock).unwrap_or(usize::MAX), true),
            Some(Verdict::Unknown { .. }) | None => (self.goals[goal].clean, false),
        }
    }

    /// No goal is violated in samples in which it is said not to be, and the others are where they are said to be.
    fn bounded_queries(&self) -> Vec<Query> {
        let goals = self.goals.len();
        let said: Vec<(usize, bool)> = (0..goals).map(|goal| self.said(goal)).collect();
        let samples = said.iter().map(|(clean, violated)| clean + usize::from(*violated)).max().unwrap_or(0);
        let mut run = Unrolled::from_reset(self.template, &unlimited());
        // The assumptions hold up to each sample.
        let (mut assumed, mut bad, mut violated) = (Literal::TRUE, Vec::new(), Vec::new());
        for sample in 0..samples {
            run.push(self.question.inputs.at(sample));
            let (graph, roots) = (&mut run.sat.graph, &run.frames[sample].roots);
            assumed = roots[goals..].iter().fold(assumed, |all, &broken| graph.and(all, !broken));
            for (&(clean, is_violated), &root) in said.iter().zip(roots) {
                if sample < clean {
                    bad.push(graph.and(root, assumed));
                } else if sample == clean && is_violated {
                    violated.push((sample, graph.and(root, assumed)));
                }
            }
        }
        let any = run.sat.graph.any(bad);
        let graph = &run.sat.graph;
        let clean = query(graph, &[any], format!("no violation in the first {samples} samples"), false);
        let found = violated.into_iter();
        let found = found.map(|(clock, flag)| query(graph, &[flag], format!("a violation at clock {clock}"), true));
        std::iter::once(clean).chain(found).collect()
    }

    /// Goals that are not violated in some samples in a row, all of them different, are not in the next.
    fn step_query(&self, batch: &Batch, before: &[usize]) -> Query {
        let mut run = Unrolled::from_anywhere(self.template, &unlimited());
        let mut all = Vec::new();
        for sample in 0..=batch.depth {
            run.push(&self.question.inputs.later);
            let roots = &run.frames[sample].roots;
            all.extend(
                roots[self.goals.len()..].iter().chain(before.iter().map(|&goal| &roots[goal])).map(|&root| !root),
            );
            if sample < batch.depth {
                all.extend(batch.goals.iter().map(|&goal| !roots[goal]));
            }
        }
        let graph = &mut run.sat.graph;
        let mut bad = Vec::new();
        for &goal in &batch.goals {
            let mut flag = run.frames[batch.depth].roots[goal];
            for (last, later) in run.frames.iter().enumerate() {
                for first in &run.frames[..last] {
                    let state = |state: &[Literal]| self.induction.cone(goal).iter().map(|&bit| state[bit]).collect();
                    let [a, b]: [Vec<Literal>; 2] = [state(&first.state), state(&later.state)];
                    let differ = differs(graph, &a, &b);
                    flag = graph.and(flag, differ);
                }
            }
            bad.push(flag);
        }
        all.push(graph.any(bad));
        query(graph, &all, format!("a violation after {} samples without one", batch.depth), false)
    }
}

/// Nothing is searched, so nothing ends it.
fn unlimited() -> Rc<Guard> {
    Rc::new(Guard::new(Duration::MAX, u64::MAX))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use batsat::{BasicSolver, Lit, SolverInterface as _, Var, lbool};
    use stepwave_netlist::dsl::Module;
    use stepwave_netlist::elaborate;

    use super::Query;
    use crate::sat::{Inputs, Limits, Question, Verdict, decide_with_queries};

    fn is_satisfiable(variables: usize, clauses: &[Vec<i64>]) -> bool {
        let mut solver = BasicSolver::default();
        let all: Vec<Var> = (0..variables).map(|_| solver.new_var_default()).collect();
        for clause in clauses {
            let lit = |&number: &i64| Lit::new(all[usize::try_from(number.unsigned_abs()).unwrap() - 1], number > 0);
            solver.add_clause_reuse(&mut clause.iter().map(lit).collect());
        }
        solver.solve_limited(&[]) == lbool::TRUE
    }

    #[test]
    fn queries_have_their_answers_and_are_not_answered_by_their_assumptions_alone() {
        // A counter that is cleared at 9, and one that follows it; it may be stopped, but not at 5.
        let module = Module::new("decade");
        let m = module.top();
        let go = m.input("go", 1);
        let count = m.reg("count", 4);
        let next = count.q.wrapping_add(m.lit(4, 1));
        count.when(go & count.q.equals(m.lit(4, 9)), m.lit(4, 0)).when(go, next).else_hold();
        let follows = m.reg("follows", 4);
        follows.set(count.q);
        m.invariant("below_ten", count.q.less_than(m.lit(4, 10)));
        m.invariant("follows_below_ten", follows.q.less_than(m.lit(4, 10)));
        m.invariant("below_eight", follows.q.less_than(m.lit(4, 8)));
        let design = elaborate(module.finish().unwrap()).unwrap();
        let question =
            Question { design: &design, goals: vec![0, 1, 2], assumptions: vec![], inputs: Inputs::default() };
        let limits = Limits { time: Duration::from_secs(100), memory: u64::MAX, clock: None };
        let (decision, queries) = decide_with_queries(&question, &limits, &mut |_| {}).unwrap();
        let violated = Verdict::Violated { clock: 9, inputs: Vec::new() };
        let kinds =
            decision.verdicts.iter().map(std::mem::discriminant).filter(|of| *of == std::mem::discriminant(&violated));
        assert_eq!(kinds.count(), 1, "{decision:?}");
        assert!(queries.len() >= 3 && queries.iter().any(|query| query.satisfiable), "{}", queries.len());
        for Query { about, satisfiable, variables, clauses } in &queries {
            assert_eq!(is_satisfiable(*variables, clauses), *satisfiable, "{about}");
            // The last clause is the violation.
            assert!(is_satisfiable(*variables, &clauses[..clauses.len() - 1]), "{about}");
        }
        let few =
            Query { about: "few".to_owned(), satisfiable: true, variables: 2, clauses: vec![vec![1, -2], vec![2]] };
        assert_eq!(few.dimacs(), "c few\np cnf 2 2\n1 -2 0\n2 0\n");
        let text = few.smt2();
        assert!(text.ends_with("(assert (or false v1 (not v2)))\n(assert (or false v2))\n(check-sat)\n"), "{text}");
    }
}
