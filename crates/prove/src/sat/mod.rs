//! Any netlist at its own widths: bounded model checking and induction over several clocks, bit by bit, with a SAT solver.
//!
//! A *goal* is a [property](stepwave_netlist::cells::Property) of the netlist: its net is 0 in every sample of every run
//! from the reset values on. Inputs that are not fixed take any value in every sample.
//!
//! Bounded model checking unrolls the design from its reset values, sample by sample, and finds for each goal a violation
//! with the fewest clocks. Induction unrolls it from any state: where j samples in a row without a violation, all of
//! them in different states, are never followed by one with a violation, and the first samples of every run are free of
//! violations, the goal is proved. Goals are tried together: each may rely on all others up to the sample before, and
//! those that it cannot be shown of are left out until the rest holds. That is sound because in a run with a violation
//! one of them is violated first. Invariants that random runs suggest are tried along with them: bits that do not change,
//! bounds of registers, orders of pairs of them.
//!
//! ```
//! use std::time::Duration;
//! use stepwave_netlist::{dsl::Module, elaborate};
//! use stepwave_prove::sat::{Inputs, Limits, Question, Verdict, decide};
//!
//! // A counter that is cleared when it is 9.
//! let module = Module::new("decade");
//! let m = module.top();
//! let count = m.reg("count", 4);
//! let last = count.q.equals(m.lit(4, 9));
//! count.when(last, m.lit(4, 0)).otherwise(count.q.wrapping_add(m.lit(4, 1)));
//! m.invariant("below_ten", count.q.less_than(m.lit(4, 10)));
//! m.invariant("below_nine", count.q.less_than(m.lit(4, 9)));
//! let design = elaborate(module.finish().unwrap()).unwrap();
//!
//! let question = Question { design: &design, goals: vec![0, 1], assumptions: vec![], inputs: Inputs::default() };
//! let limits = Limits { time: Duration::from_secs(10), memory: 1 << 30, clock: None };
//! let decision = decide(&question, &limits, &mut |_| {}).unwrap();
//! assert!(matches!(decision.verdicts[0], Verdict::Proved { .. }));
//! assert!(matches!(decision.verdicts[1], Verdict::Violated { clock: 9, .. }));
//! ```

mod aig;
mod bounded;
mod candidates;
mod induction;
mod second;
mod solver;
mod template;
mod unrolled;
mod words;

use std::rc::Rc;
use std::time::Duration;

use stepwave_netlist::{Design, Net};

use induction::Induction;
use second::Batch;
use solver::{Guard, Sat};
use unrolled::Unrolled;

pub use second::Query;
pub use solver::Limit;
pub use template::{MOST_MEMORY_BITS, TooLarge};

use template::Template;

/// Values of inputs that are fixed; those that are not named are free.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Inputs {
    /// In sample 0, 1, …
    pub rows: Vec<Vec<(Net, u64)>>,
    /// In all samples after them.
    pub later: Vec<(Net, u64)>,
}

impl Inputs {
    /// Those of a sample.
    fn at(&self, sample: usize) -> &[(Net, u64)] {
        self.rows.get(sample).unwrap_or(&self.later)
    }
}

/// What is to be decided of a design.
#[derive(Clone, Debug)]
pub struct Question<'d> {
    /// The design.
    pub design: &'d Design,
    /// Indices of properties that are to be proved.
    pub goals: Vec<usize>,
    /// Indices of properties that hold in every sample by assumption: runs that violate one are not looked at.
    pub assumptions: Vec<usize>,
    /// Values of inputs.
    pub inputs: Inputs,
}

/// How far a search goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Time on the clock of the wall.
    pub time: Duration,
    /// Bytes of memory of the whole process; where the system does not say how many it has, those of the search.
    pub memory: u64,
    /// The last clock in which a violation is looked for, if there is one.
    pub clock: Option<u64>,
}

/// What is known of a goal.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// It is never violated.
    Proved {
        /// Samples in a row without a violation that exclude one in the next.
        depth: usize,
    },
    /// It is violated, and in no earlier clock of any run.
    Violated {
        /// The clock.
        clock: u64,
        /// Inputs on which it depends, in the samples 0 to `clock`.
        inputs: Vec<Vec<(Net, u64)>>,
    },
    /// It is open.
    Unknown {
        /// Samples, from sample 0 on, in which it is not violated in any run.
        clean: u64,
    },
}

/// The verdicts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Decision {
    /// Of each goal.
    pub verdicts: Vec<Verdict>,
    /// Samples in a row of the longest induction that was tried; `None` where none was.
    pub depth: Option<usize>,
    /// The last clock in which a violation was looked for of every goal that was open then, if there is one.
    pub clock: Option<u64>,
    /// What ended the search before all goals were decided.
    pub limit: Option<Limit>,
    /// No run meets the assumptions up to this clock: nothing later can be said.
    pub contradiction: Option<u64>,
}

/// How far a search is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Progress {
    /// Clock in which violations are looked for.
    pub clock: u64,
    /// Goals that are not decided.
    pub open: usize,
}

/// Conflicts after which a question is left for later.
const PATIENCE: u64 = 2000;

/// Decides as many goals as the limits allow.
///
/// # Errors
/// The goals depend on memories that are too large to be followed bit by bit.
pub fn decide(
    question: &Question<'_>,
    limits: &Limits,
    progress: &mut dyn FnMut(Progress),
) -> Result<Decision, TooLarge> {
    Ok(searched(question, limits, progress, false)?.0)
}

/// The same with the questions that the verdicts rest on, for another solver.
///
/// # Errors
/// As [`decide`].
pub fn decide_with_queries(
    question: &Question<'_>,
    limits: &Limits,
    progress: &mut dyn FnMut(Progress),
) -> Result<(Decision, Vec<Query>), TooLarge> {
    searched(question, limits, progress, true)
}

fn searched(
    question: &Question<'_>,
    limits: &Limits,
    progress: &mut dyn FnMut(Progress),
    asks: bool,
) -> Result<(Decision, Vec<Query>), TooLarge> {
    let properties = &question.design.netlist().properties;
    let never = |&index: &usize| properties.get(index).map(|property| property.never);
    let roots: Vec<Net> = question.goals.iter().chain(&question.assumptions).filter_map(never).collect();
    let mut template = Template::new(question.design, &roots)?;
    let main = question.goals.len();
    let assumptions = template.roots[main..].to_vec();
    let suggested = candidates::suggested(&mut template, question, &assumptions);
    template.insert(main, &suggested);
    let guard = Rc::new(Guard::new(limits.time, limits.memory));
    let bounded = Unrolled::from_reset(&template, &guard);
    let goals: Vec<Goal> = (0..main + suggested.len()).map(|_| Goal { verdict: None, clean: 0 }).collect();
    let induction = Induction::new(&template, question, goals.len(), &guard);
    let (batches, contradiction) = (Vec::new(), None);
    let mut search =
        Search { question, template: &template, guard, bounded, induction, goals, main, batches, contradiction };
    let limit = search.run(limits, progress);
    let queries = if asks { search.queries() } else { Vec::new() };
    Ok((search.decision(limit), queries))
}

/// A goal while it is looked at.
struct Goal {
    verdict: Option<Verdict>,
    /// Samples that are free of violations.
    clean: usize,
}

struct Search<'q, 't> {
    question: &'q Question<'q>,
    template: &'t Template,
    guard: Rc<Guard>,
    bounded: Unrolled<'t>,
    induction: Induction<'q, 't>,
    /// Those that were asked for, and invariants that may help.
    goals: Vec<Goal>,
    /// Number of those that were asked for.
    main: usize,
    /// What was proved, in its order.
    batches: Vec<Batch>,
    contradiction: Option<u64>,
}

impl Search<'_, '_> {
    /// Numbers of the goals that are open.
    fn open(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.goals.len()).filter(|&goal| self.goals[goal].verdict.is_none())
    }

    /// The same of those that were asked for.
    fn open_main(&self) -> impl Iterator<Item = usize> + '_ {
        self.open().take_while(|&goal| goal < self.main)
    }

    /// Looks for violations and for proofs in turn, each with as many conflicts as the other has had.
    fn run(&mut self, limits: &Limits, progress: &mut dyn FnMut(Progress)) -> Option<Limit> {
        let first_free = self.question.inputs.rows.len();
        let (mut clock, mut patience) = (0, PATIENCE);
        loop {
            progress(Progress { clock: clock as u64, open: self.open_main().count() });
            let conflicts = patience.max(self.induction.conflicts() / 4);
            for sample in 0..=clock {
                self.look(sample, conflicts);
            }
            let base = self.open_main().map(|goal| self.goals[goal].clean).max();
            if base.is_some_and(|base| base >= first_free + self.induction.depth()) && self.contradiction.is_none() {
                let conflicts = PATIENCE.max(self.bounded.sat.conflicts());
                self.induce(first_free, conflicts);
            }
            let reached = self.guard.reached();
            if self.open_main().next().is_none() || reached.is_some() || self.contradiction.is_some() {
                return reached;
            }
            if self.open_main().any(|goal| self.goals[goal].clean <= clock) {
                patience *= 2;
            } else if limits.clock.is_some_and(|last| clock as u64 >= last) {
                return Some(Limit::Clock);
            } else {
                clock += 1;
            }
        }
    }

    /// The verdicts, after this limit.
    fn decision(self, limit: Option<Limit>) -> Decision {
        let looked = self.open_main().map(|goal| self.goals[goal].clean).min().unwrap_or(self.bounded.frames.len());
        let clock = (looked as u64).checked_sub(1);
        let open = |goal: Goal| goal.verdict.unwrap_or(Verdict::Unknown { clean: goal.clean as u64 });
        let limit = self.open_main().next().and(limit);
        let (depth, contradiction) = (self.induction.tried(), self.contradiction);
        let verdicts = self.goals.into_iter().take(self.main).map(open).collect();
        Decision { verdicts, depth, clock, limit, contradiction }
    }
}

/// Assumptions of a frame hold in it. Where they cannot, together with all before, nothing meets them.
fn assume(unrolled: &mut Unrolled<'_>, frame: usize, goals: usize) -> bool {
    let assumptions = unrolled.frames[frame].roots[goals..].to_vec();
    assumptions.iter().for_each(|&broken| unrolled.sat.require(&[!broken]));
    assumptions.is_empty() || unrolled.sat.ask(&[], u64::MAX) != solver::Answer::No
}

/// The goal with this net is not violated in these frames.
fn never(sat: &mut Sat, frames: &[unrolled::Frame], goal: usize) {
    frames.iter().for_each(|frame| sat.require(&[!frame.roots[goal]]));
}
