//! Every run of a small netlist, sample by sample, on the `gates` engine.

use std::collections::HashSet;

use stepwave::engine::{EngineKind, Rows, Watch, contents};
use stepwave::netlist::Net;
use stepwave::prove::sat::Question;

/// What all runs that meet the assumptions come to.
pub(super) struct Explored {
    /// Of each goal the first clock of a violation.
    pub(super) first: Vec<Option<u64>>,
    /// The first clock up to which no run meets the assumptions, within some samples.
    pub(super) contradiction: Option<u64>,
}

/// Registers and memories.
type State = (Vec<u64>, Vec<Vec<u64>>);

/// Samples after which assumptions are not looked at any more.
const MOST: usize = 90;

pub(super) fn explore(question: &Question<'_>) -> Explored {
    let design = question.design;
    let never = |index: &usize| design.netlist().properties[*index].never;
    let mut engine = EngineKind::Gates.build(design, &Watch::default());
    let mut rows = Rows::new(0, 1);
    engine.reset(&mut rows);
    let state = |engine: &dyn stepwave::engine::Engine| -> State {
        (design.registers().iter().map(|&net| engine.value(net)).collect(), contents(engine, design))
    };
    let mut level = HashSet::from([state(engine.as_ref())]);
    let mut all: HashSet<State> = HashSet::new();
    let mut explored = Explored { first: vec![None; question.goals.len()], contradiction: None };
    for sample in 0.. {
        let fixed = question.inputs.rows.get(sample).unwrap_or(&question.inputs.later);
        let free = sample >= question.inputs.rows.len();
        let mut next = HashSet::new();
        let mut meets = false;
        for (registers, memories) in &level {
            for inputs in values(design.inputs(), fixed, &|net| design.netlist().width(net).mask()) {
                engine.restore(0, registers, &inputs, memories);
                if question.assumptions.iter().any(|index| engine.value(never(index)) == 1) {
                    continue;
                }
                meets = true;
                for (goal, first) in question.goals.iter().zip(&mut explored.first) {
                    if engine.value(never(goal)) == 1 {
                        first.get_or_insert(sample as u64);
                    }
                }
                engine.run(1, &mut rows);
                next.insert(state(engine.as_ref()));
            }
        }
        if !meets {
            explored.contradiction = Some(sample as u64);
            return explored;
        }
        let known = all.len();
        if free {
            all.extend(level);
        }
        level = next;
        if sample >= MOST && free && all.len() == known {
            return explored;
        }
    }
    explored
}

/// All values of the inputs, some of which are fixed.
fn values(inputs: &[Net], fixed: &[(Net, u64)], mask: &dyn Fn(Net) -> u64) -> Vec<Vec<u64>> {
    inputs.iter().fold(vec![Vec::new()], |rows, &net| {
        let given = fixed.iter().find(|(input, _)| *input == net).map(|&(_, value)| value);
        let choices = given.map_or_else(|| (0..=mask(net)).collect::<Vec<_>>(), |value| vec![value]);
        let longer = |row: &Vec<u64>| -> Vec<Vec<u64>> {
            choices.iter().map(|&value| [row.as_slice(), &[value]].concat()).collect()
        };
        rows.iter().flat_map(longer).collect()
    })
}
