//! Induction over several clocks: no samples in a row without a violation are followed by one with a violation.

use std::collections::HashSet;
use std::rc::Rc;

use super::aig::Literal;
use super::second::Batch;
use super::solver::{Answer, Guard, Values};
use super::template::Template;
use super::unrolled::Unrolled;
use super::words::differs;
use super::{Question, Search, Verdict, assume, never};

/// Nodes that are looked at for invariants that were suggested, in one attempt.
const WORK: usize = 4_000_000;
/// Samples in a row after which an invariant that is not shown is given up.
const DEEPEST: usize = 4;

/// Bits of the state on which some goals depend, and the samples that must differ in them.
struct Cone {
    bits: Vec<usize>,
    /// While it holds, the samples of each pair that was met differ in these bits.
    differ: Literal,
    met: HashSet<(usize, usize)>,
}

/// Samples from any state on.
pub(super) struct Induction<'q, 't> {
    question: &'q Question<'q>,
    unrolled: Unrolled<'t>,
    cones: Vec<Cone>,
    /// The cone of each goal.
    cone_of: Vec<usize>,
    /// While it holds, the goal is not violated in any sample but the last.
    holds: Vec<Literal>,
    proved: Vec<bool>,
}

impl<'q, 't> Induction<'q, 't> {
    pub(super) fn new(
        template: &'t Template,
        question: &'q Question<'q>,
        goals: usize,
        guard: &Rc<Guard>,
    ) -> Induction<'q, 't> {
        let mut unrolled = Unrolled::from_anywhere(template, guard);
        let assumed: Vec<_> = template.roots[goals..].iter().map(|&root| template.reached(&[root])).collect();
        let (mut cones, mut cone_of): (Vec<Cone>, Vec<usize>) = (Vec::new(), Vec::new());
        for &root in &template.roots[..goals] {
            let (mut nodes, mut kept) = template.reached(&[root]);
            // Assumptions that share a variable with it belong to it, and those that share one with them.
            let mut left: Vec<_> = assumed.iter().collect();
            let shares = |nodes: &[bool], other: &[bool]| {
                let both = |node: usize| nodes[node] && other[node] && template.graph.operands(node).is_none();
                (1..nodes.len()).any(both)
            };
            while let Some(index) = left.iter().position(|(other, _)| shares(&nodes, other)) {
                let (more, bits) = left.swap_remove(index);
                nodes.iter_mut().zip(more).for_each(|(node, &more)| *node |= more);
                kept.iter_mut().zip(bits).for_each(|(bit, &more)| *bit |= more);
            }
            let bits: Vec<usize> = (0..kept.len()).filter(|&bit| kept[bit]).collect();
            let known = cones.iter().position(|cone| cone.bits == bits);
            cone_of.push(known.unwrap_or(cones.len()));
            if known.is_none() {
                cones.push(Cone { bits, differ: unrolled.sat.graph.variable(), met: HashSet::new() });
            }
        }
        let holds = (0..goals).map(|_| unrolled.sat.graph.variable()).collect();
        Induction { question, unrolled, cones, cone_of, holds, proved: vec![false; goals] }
    }

    /// Bits of the state on which a goal depends.
    pub(super) fn cone(&self, goal: usize) -> &[usize] {
        &self.cones[self.cone_of[goal]].bits
    }

    pub(super) fn conflicts(&self) -> u64 {
        self.unrolled.sat.conflicts()
    }

    /// Samples without a violation before the last one, of the next attempt.
    pub(super) fn depth(&self) -> usize {
        self.unrolled.frames.len()
    }

    /// The same of the last attempt.
    pub(super) fn tried(&self) -> Option<usize> {
        self.depth().checked_sub(1)
    }

    /// One more sample; `false` where no run meets the assumptions in as many samples.
    fn push(&mut self) -> bool {
        let frame = self.unrolled.frames.len();
        let goals = self.holds.len();
        for goal in 0..goals {
            // What was the last sample is not the last any more.
            if let Some(last) = self.unrolled.frames.last() {
                let clause = [!self.holds[goal], !last.roots[goal]];
                self.unrolled.sat.require(&clause);
            }
        }
        self.unrolled.push(&self.question.inputs.later);
        for goal in (0..goals).filter(|&goal| self.proved[goal]) {
            never(&mut self.unrolled.sat, &self.unrolled.frames[frame..], goal);
        }
        assume(&mut self.unrolled, frame, goals)
    }

    /// The last sample violates a goal, and all samples differ.
    fn fails(&mut self, goal: usize) -> Literal {
        let violated = self.unrolled.frames.last().map_or(Literal::FALSE, |frame| frame.roots[goal]);
        self.unrolled.sat.graph.and(violated, self.cones[self.cone_of[goal]].differ)
    }

    /// Pairs of samples that do not differ in the cone of a goal, as the values found have them, differ from now on.
    fn separate(&mut self, values: &Values, goal: usize) -> bool {
        let cone = &mut self.cones[self.cone_of[goal]];
        let mut found = false;
        for last in 0..self.unrolled.frames.len() {
            for first in 0..last {
                let state = |frame: usize| {
                    let frame = &self.unrolled.frames[frame];
                    cone.bits.iter().map(|&bit| frame.state[bit]).collect::<Vec<_>>()
                };
                let (a, b) = (state(first), state(last));
                if a.iter().zip(&b).any(|(&a, &b)| values.of(a) != values.of(b)) || !cone.met.insert((first, last)) {
                    continue;
                }
                found = true;
                let differ = differs(&mut self.unrolled.sat.graph, &a, &b);
                self.unrolled.sat.require(&[!cone.differ, differ]);
            }
        }
        found
    }

    /// Those of some goals that hold in every sample after as many without a violation, each relying on the others. Where
    /// invariants that were only suggested make it long, they are left out.
    fn attempt(&mut self, mut goals: Vec<usize>, conflicts: u64) -> Vec<usize> {
        let most = self.conflicts().saturating_add(conflicts);
        let main = self.question.goals.len();
        let mut rounds = (WORK / (self.unrolled.sat.graph.len() + 1)).clamp(8, 400);
        while !goals.is_empty() {
            let held: Vec<Literal> = goals.iter().map(|&goal| self.holds[goal]).collect();
            let fail: Vec<Literal> = goals.iter().map(|&goal| self.fails(goal)).collect();
            let left = most.saturating_sub(self.conflicts());
            let any = self.unrolled.sat.graph.any(fail.iter().copied());
            let question = |flag: Literal| [&[flag], held.as_slice()].concat();
            rounds = rounds.saturating_sub(1);
            match self.unrolled.sat.ask(&question(any), left) {
                Answer::No => break,
                Answer::Yes => {
                    let values = self.unrolled.sat.values();
                    let failed: Vec<usize> =
                        goals.iter().zip(&fail).filter(|(_, fail)| values.of(**fail)).map(|(&goal, _)| goal).collect();
                    goals.retain(|goal| !failed.contains(goal) || *goal < main && self.separate(&values, *goal));
                    goals.retain(|goal| rounds > 0 || *goal < main);
                }
                Answer::Open if goals.iter().any(|&goal| goal >= main) => goals.retain(|&goal| goal < main),
                // One by one: what cannot be shown so is left out.
                Answer::Open => {
                    let each = (conflicts / (goals.len() as u64 + 1)).max(100);
                    let mut flags = fail.iter();
                    let before = goals.len();
                    goals.retain(|_| {
                        let flag = flags.next().copied().unwrap_or(Literal::TRUE);
                        self.unrolled.sat.ask(&question(flag), each) == Answer::No
                    });
                    if goals.len() == before {
                        break;
                    }
                }
            }
        }
        goals
    }
}

impl Search<'_, '_> {
    /// Tries an induction over one sample more, of those goals whose first samples are known to be free of violations.
    pub(super) fn induce(&mut self, first_free: usize, conflicts: u64) {
        let depth = self.induction.depth();
        if self.guard.reached().is_some() {
            return;
        }
        if !self.induction.push() {
            self.contradiction = Some((first_free + depth) as u64);
            return;
        }
        let ready: Vec<usize> = self.open().filter(|&goal| self.goals[goal].clean >= first_free + depth).collect();
        let proved = self.induction.attempt(ready.clone(), conflicts);
        for goal in ready.into_iter().filter(|goal| *goal >= self.main && depth >= DEEPEST && !proved.contains(goal)) {
            self.goals[goal].verdict = Some(Verdict::Unknown { clean: 0 });
        }
        if !proved.is_empty() {
            self.batches.push(Batch { depth, goals: proved.clone() });
        }
        for goal in proved {
            self.goals[goal].verdict = Some(Verdict::Proved { depth });
            self.induction.proved[goal] = true;
            never(&mut self.induction.unrolled.sat, &self.induction.unrolled.frames, goal);
            never(&mut self.bounded.sat, &self.bounded.frames, goal);
        }
    }
}
