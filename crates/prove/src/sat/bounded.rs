//! Bounded model checking: violations with the fewest clocks.

use stepwave_netlist::Net;

use super::aig::Literal;
use super::solver::{Answer, Values};
use super::{Search, Verdict, assume, never};

impl Search<'_, '_> {
    /// Looks for violations in a sample of those goals that are not violated before it.
    pub(super) fn look(&mut self, sample: usize, conflicts: u64) {
        let goals = self.goals.len();
        let mut pending: Vec<usize> = self.open().filter(|&goal| self.goals[goal].clean == sample).collect();
        if pending.is_empty() || self.contradiction.is_some() || self.guard.reached().is_some() {
            return;
        }
        while self.bounded.frames.len() <= sample {
            let frame = self.bounded.frames.len();
            self.bounded.push(self.question.inputs.at(frame));
            for goal in 0..goals {
                if matches!(self.goals[goal].verdict, Some(Verdict::Proved { .. })) {
                    never(&mut self.bounded.sat, &self.bounded.frames[frame..], goal);
                }
            }
            if !assume(&mut self.bounded, frame, goals) {
                self.contradiction = Some(frame as u64);
                return;
            }
        }
        // All at once first: mostly none is violated.
        while !pending.is_empty() {
            let flags: Vec<Literal> = pending.iter().map(|&goal| self.flag(goal, sample)).collect();
            let any = self.bounded.sat.graph.any(flags);
            match self.bounded.sat.ask(&[any], conflicts) {
                Answer::Yes => self.violated(&mut pending, sample),
                Answer::No => {
                    pending.drain(..).for_each(|goal| self.clean(goal, sample));
                }
                Answer::Open => break,
            }
        }
        while let Some(goal) = pending.pop() {
            let flag = self.flag(goal, sample);
            match self.bounded.sat.ask(&[flag], conflicts) {
                Answer::Yes => {
                    pending.push(goal);
                    self.violated(&mut pending, sample);
                }
                Answer::No => self.clean(goal, sample),
                // An invariant that is hard to look at is of no help.
                Answer::Open if goal >= self.main => self.goals[goal].verdict = Some(Verdict::Unknown { clean: 0 }),
                Answer::Open => {}
            }
        }
    }

    fn flag(&self, goal: usize, sample: usize) -> Literal {
        self.bounded.frames[sample].roots[goal]
    }

    fn clean(&mut self, goal: usize, sample: usize) {
        self.goals[goal].clean = sample + 1;
        let flag = self.flag(goal, sample);
        self.bounded.sat.require(&[!flag]);
    }

    /// Takes those goals out that the values found violate.
    fn violated(&mut self, pending: &mut Vec<usize>, sample: usize) {
        let values = self.bounded.sat.values();
        let (violated, others) = pending.iter().partition(|&&goal| values.of(self.flag(goal, sample)));
        *pending = others;
        let violated: Vec<usize> = violated;
        let found: Vec<Vec<(Net, u64)>> = match violated.iter().any(|&goal| goal < self.main) {
            true => (0..=sample).map(|at| self.inputs(&values, at)).collect(),
            false => Vec::new(),
        };
        for goal in violated {
            let inputs = if goal < self.main { found.clone() } else { Vec::new() };
            let clock = sample as u64;
            self.goals[goal].verdict = Some(Verdict::Violated { clock, inputs });
        }
    }

    /// The inputs of a sample.
    fn inputs(&self, values: &Values, sample: usize) -> Vec<(Net, u64)> {
        let mut bits = self.bounded.frames[sample].inputs.iter();
        let word = |(net, word): &(Net, Vec<Literal>)| {
            let bits = bits.by_ref().take(word.len()).enumerate();
            (*net, bits.fold(0, |value, (place, &bit)| value | u64::from(values.of(bit)) << place))
        };
        self.template.inputs.iter().map(word).collect()
    }
}
