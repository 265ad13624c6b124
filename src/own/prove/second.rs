//! A second opinion: a solver of another kind is asked the questions that the verdicts rest on.

use std::fmt::Write as _;
use std::time::Duration;

use serde_json::{Value, json};

use crate::Error;
use crate::export::{Checking, smt2_asking};
use crate::netlist::cells::Op;
use crate::netlist::{Net, bits::Bits};
use crate::output::temporary;
use crate::prove::sat::{Decision, Query, Question, Verdict};
use crate::study::proof::{Answer, SolverError, ask};

/// What a solver reads from its input.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SolverLanguage {
    /// SMT-LIB 2.
    Smt2,
    /// Clauses in the form of DIMACS.
    Dimacs,
}

/// A solver, and how long it may take for a question.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Solver {
    pub(super) command: String,
    pub(super) language: SolverLanguage,
    pub(super) limit: Duration,
}

/// What another solver says to the questions that verdicts rest on.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct SecondOpinion {
    /// Its command.
    pub command: String,
    /// Questions.
    pub asked: usize,
    /// Those that it has answered in time.
    pub answered: usize,
    /// Those that it has answered in another way.
    pub differs: Vec<String>,
}

impl Solver {
    /// Asks for all that verdicts rest on.
    ///
    /// # Errors
    /// It cannot be run, or says neither `sat` nor `unsat`, nor that it does not know.
    pub(super) fn ask(
        &self,
        question: &Question<'_>,
        decision: &Decision,
        queries: &[Query],
    ) -> Result<SecondOpinion, Error> {
        let Solver { command, language, limit } = self;
        let mut opinion = SecondOpinion { command: command.clone(), asked: 0, answered: 0, differs: Vec::new() };
        let is_words = *language == SolverLanguage::Smt2;
        let words = is_words.then(|| in_words(question, decision)).flatten();
        let words = words.map(|script| ("no violation, word by word".to_owned(), script, false));
        let bits = queries.iter().map(|query| {
            let script = if is_words { query.smt2() } else { query.dimacs() };
            (query.about.clone(), script, query.satisfiable)
        });
        for (about, script, satisfiable) in words.into_iter().chain(bits) {
            opinion.asked += 1;
            match ask(command, &script, *limit, &temporary::attend) {
                Ok(answer) => {
                    opinion.answered += 1;
                    if (answer == Answer::Sat) != satisfiable {
                        opinion.differs.push(about);
                    }
                }
                Err(SolverError::Late { .. }) => {}
                Err(SolverError::Answer { said, .. }) if ["unknown", "s UNKNOWN"].contains(&said.as_str()) => {}
                Err(other) => return Err(other.into()),
            }
        }
        Ok(opinion)
    }
}

/// The script that asks for a violation in samples that are said to have none, word by word as the design is exported,
/// so that its bits are made by the solver alone. `None` where no sample is said so, or of memories.
fn in_words(question: &Question<'_>, decision: &Decision) -> Option<String> {
    let netlist = question.design.netlist();
    let first_free = question.inputs.rows.len() as u64;
    let clean = decision.verdicts.iter().map(|verdict| match verdict {
        Verdict::Proved { depth } => first_free + *depth as u64,
        Verdict::Violated { clock, .. } => *clock,
        Verdict::Unknown { clean } => *clean,
    });
    let clean: Vec<u64> = clean.collect();
    let last = clean.iter().max()?.checked_sub(1)?;
    let literal = |net: Net, value: u64| format!("#b{}", Bits::truncated(netlist.width(net), value));
    let checking = Checking { comment: &[], held: &[] };
    let script = smt2_asking(question.design, &checking, last, |_, name| {
        let mut text = String::new();
        for clock in 0..=last {
            let row = usize::try_from(clock).ok().and_then(|clock| question.inputs.rows.get(clock));
            for &(net, value) in row.unwrap_or(&question.inputs.later) {
                let _ = writeln!(text, "(assert (= {} {}))", name(net, Some(clock)), literal(net, value));
            }
        }
        text += "(assert (or false";
        for (&goal, &clean) in question.goals.iter().zip(&clean) {
            let never = netlist.properties[goal].never;
            for clock in 0..clean {
                let _ = match netlist.cell(never).op {
                    Op::Const(value) => write!(text, " {}", value == 1),
                    _ => write!(text, "\n  (= {} #b1)", name(never, Some(clock))),
                };
            }
        }
        text + "))\n(check-sat)\n"
    });
    script.ok()
}

impl SecondOpinion {
    /// It in a line.
    #[must_use]
    pub fn line(&self) -> String {
        let SecondOpinion { command, asked, answered, differs } = self;
        let questions = if *asked == 1 { "question" } else { "questions" };
        match (differs.len(), asked - answered) {
            (0, 0) => format!("{command} agrees: {asked} {questions}"),
            (0, late) => {
                format!("{command} agrees in {answered} of {asked} {questions}, and has not answered {late}")
            }
            (differing, _) => {
                format!("{command} disagrees in {differing} of {asked} {questions}: {}", differs.join("; "))
            }
        }
    }

    /// What is wrong, if it says something else.
    pub(super) fn failure(&self) -> Option<String> {
        let SecondOpinion { command, differs, .. } = self;
        let wrong = !differs.is_empty();
        wrong.then(|| {
            format!(
                "{command} disagrees ({}): one of both errs, please report this with the netlist",
                differs.join("; ")
            )
        })
    }

    pub(super) fn json(&self) -> Value {
        json!({ "command": self.command, "questions": self.asked, "answered": self.answered, "differs": self.differs })
    }
}
