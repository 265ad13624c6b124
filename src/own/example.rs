//! A counterexample: what every input is in every sample, replayed by the simulator and freed of changes that do not matter.

use std::ops::Range;

use crate::engine::{Engine, EngineKind, Rows, Watch};
use crate::netlist::Net;
use crate::prove::sat::{Inputs, Question};

/// Clocks that are simulated to find changes that do not matter.
const EFFORT: u64 = 3_000_000;

/// Values of inputs that violate a property.
pub(super) struct Example<'q> {
    question: &'q Question<'q>,
    never: Net,
    clock: u64,
    /// For each sample the value of each input of the design.
    rows: Vec<Vec<u64>>,
    /// Clocks that may still be simulated.
    effort: u64,
}

impl<'q> Example<'q> {
    /// Of the inputs that were found; those that are missing do not matter.
    pub(super) fn new(question: &'q Question<'q>, never: Net, clock: u64, found: &[Vec<(Net, u64)>]) -> Example<'q> {
        let Question { design, inputs, .. } = question;
        let rows = found.iter().enumerate().map(|(sample, found)| {
            let given = fixed(inputs, sample);
            let of =
                |net: Net| given.iter().chain(found).find(|(other, _)| *other == net).map_or(0, |(_, value)| *value);
            design.inputs().iter().map(|&net| of(net)).collect()
        });
        Example { question, never, clock, rows: rows.collect(), effort: EFFORT }
    }

    /// Runs it: the property is violated in its clock and in none before, and every assumption holds up to it.
    pub(super) fn is_shown_by(&self, engine: &mut dyn Engine) -> bool {
        let Question { design, assumptions, .. } = self.question;
        let properties = &design.netlist().properties;
        let mut rows = Rows::new(0, 1);
        for (sample, row) in self.rows.iter().enumerate() {
            design.inputs().iter().zip(row).for_each(|(&net, &value)| engine.set_input(net, value));
            if sample == 0 {
                engine.reset(&mut rows)
            } else {
                _ = engine.run(1, &mut rows)
            }
            let violated = engine.value(self.never) == 1;
            if violated != (sample as u64 == self.clock)
                || assumptions.iter().any(|&index| engine.value(properties[index].never) == 1)
            {
                return false;
            }
        }
        true
    }

    /// Inputs are 0 where nothing is lost by it, and keep their values as long as they can.
    pub(super) fn simplify(&mut self) {
        let mut engine = EngineKind::Word.build(self.question.design, &Watch::default());
        let mut hold =
            |example: &mut Self, input, from, to, value| example.try_holding(engine.as_mut(), input, from..to, value);
        for input in 0..self.question.design.inputs().len() {
            if self.rows.iter().all(|row| row[input] == 0) || hold(self, input, 0, self.rows.len(), 0) {
                continue;
            }
            let mut ranges = vec![(1usize, self.rows.len())];
            while let Some((from, to)) = ranges.pop() {
                let before = self.rows.get(from.wrapping_sub(1)).map_or(0, |row| row[input]);
                let is_held = |row: &Vec<u64>| row[input] == before;
                if from >= to || self.rows[from..to].iter().all(is_held) || hold(self, input, from, to, before) {
                    continue;
                }
                if to - from > 1 {
                    let middle = from.midpoint(to);
                    // The earlier half first: the later one begins with what comes of it.
                    ranges.extend([(middle, to), (from, middle)]);
                }
            }
        }
    }

    /// Gives an input a value in some samples in which it is free, and keeps that if the violation stays.
    fn try_holding(&mut self, engine: &mut dyn Engine, input: usize, samples: Range<usize>, value: u64) -> bool {
        let Some(left) = self.effort.checked_sub(self.clock + 1) else { return false };
        self.effort = left;
        let net = self.question.design.inputs()[input];
        let column: Vec<u64> = self.rows.iter().map(|row| row[input]).collect();
        for (sample, row) in self.rows.iter_mut().enumerate().take(samples.end).skip(samples.start) {
            if fixed(&self.question.inputs, sample).iter().all(|(other, _)| *other != net) {
                row[input] = value;
            }
        }
        let shown = self.is_shown_by(engine);
        if !shown {
            self.rows.iter_mut().zip(column).for_each(|(row, before)| row[input] = before);
        }
        shown
    }

    /// The values as CSV, of inputs given by their nets, the lowest first, and names.
    pub(super) fn table(&self, inputs: &[(Vec<Net>, String)]) -> String {
        let all = self.question.design.inputs();
        let line = |words: Vec<String>| words.join(",") + "\n";
        let head = line(inputs.iter().map(|(_, name)| name.clone()).collect());
        let rows = self.rows.iter().map(|row| {
            let of = |net: &Net| all.iter().position(|other| other == net).map_or(0, |index| row[index]);
            let value = |nets: &[Net]| match nets {
                [net] => of(net).to_string(),
                nets => nets.iter().rev().fold("0x".to_owned(), |text, net| text + &format!("{:016x}", of(net))),
            };
            line(inputs.iter().map(|(nets, _)| value(nets)).collect())
        });
        head + &rows.collect::<String>()
    }
}

/// Inputs that are fixed in a sample.
fn fixed(inputs: &Inputs, sample: usize) -> &[(Net, u64)] {
    inputs.rows.get(sample).unwrap_or(&inputs.later)
}
