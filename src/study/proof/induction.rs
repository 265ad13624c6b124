//! Steps that keep a proof from being one: from a state that the invariants allow, the machine itself overflows, misses its
//! end, or comes to a state that they do not allow. Whether any run comes to such a state is not known.

use rayon::prelude::*;
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_models::{Hardware, Kind, Machine};
use stepwave_nc::Curve;
use stepwave_netlist::Net;
use stepwave_prove::{Certificate, InvariantStates, Row};

use super::learning::rows;
use super::{ProofError, Subject, number};
use crate::testbench::Start;

/// A step that keeps a proof from being one.
#[derive(Clone, Debug)]
pub struct CounterexampleToInduction {
    /// Bits of coordinates.
    pub k: u32,
    /// The kind of geometry.
    pub kind: String,
    /// The geometry whose words stand on the inputs.
    pub curve: Curve,
    /// The hardware, which takes every geometry of these coordinates.
    pub hardware: Hardware,
    /// Where the step begins.
    pub start: Start,
    /// Clocks that show it.
    pub clocks: u64,
    /// What is wrong with it.
    pub wrong: String,
    /// What each register on which something depends means in the beginning.
    pub state: Vec<(String, i128)>,
}

/// What was looked for, and what was found.
#[derive(Clone, Debug, Default)]
pub struct InductionSearch {
    /// The first such step.
    pub found: Option<CounterexampleToInduction>,
    /// States that were tried.
    pub tried: u64,
}

/// Bits of coordinates whose states are tried.
pub const INDUCTION_KS: [u32; 2] = [3, 4];
/// States of each kind of geometry that are tried at most, at each of these.
const MOST: u64 = 200_000;
/// Clocks of a step at most.
const LONGEST_STEP: u64 = 8;

impl Subject {
    /// Looks for a step from a state that these invariants allow, after which they prove nothing. Kinds in their order,
    /// small geometries first.
    ///
    /// # Errors
    /// See [`ProofError`].
    pub fn counterexample_to_induction(
        &self,
        attempts: &[(&Kind, &Certificate)],
    ) -> Result<InductionSearch, ProofError> {
        let each = attempts.par_iter().map(|(kind, certificate)| self.in_kind(kind, certificate));
        let each: Vec<InductionSearch> = each.collect::<Result<_, _>>()?;
        let tried = each.iter().map(|search| search.tried).sum();
        Ok(InductionSearch { found: each.into_iter().find_map(|search| search.found), tried })
    }

    fn in_kind(&self, kind: &Kind, certificate: &Certificate) -> Result<InductionSearch, ProofError> {
        let (case, _) = self.case(kind)?;
        let allowed = InvariantStates::new(&self.family, self.strobes, &case, certificate)?;
        let mut search = InductionSearch::default();
        for k in INDUCTION_KS {
            let curves: Vec<_> =
                self.curves(kind).into_iter().filter(|(member, ..)| self.members[*member].0 == k).collect();
            for (place, (member, curve, symbols)) in curves.iter().enumerate() {
                let Some((words, symbols)) = self.loaded(place, *member, curve, symbols)? else { continue };
                let (_, hardware, machine) = &self.members[*member];
                let Some(usual) = rows(k, &symbols, machine, &words).into_iter().next() else { continue };
                let mut stepper = Stepper::new(machine, &words);
                let most = (MOST / curves.len() as u64).max(1);
                let mut found = None;
                search.tried += allowed.states(&usual, most, |before| {
                    found = stepper.step(&before.registers).and_then(|Stepped { clocks, after, done, wrong }| {
                        let after = Row { registers: after, steps: before.steps + 1, ..before.clone() };
                        let judged = || allowed.judge(before, &after, done);
                        Some((before.registers.clone(), clocks, wrong.or_else(judged)?))
                    });
                    found.is_some()
                });
                let Some((registers, clocks, wrong)) = found else { continue };
                search.found = Some(CounterexampleToInduction {
                    k,
                    kind: kind.name.clone(),
                    curve: curve.clone(),
                    hardware: hardware.clone(),
                    start: stepper.start(&registers),
                    clocks,
                    wrong,
                    state: stepper.names(&registers, |register| allowed.matters(register)),
                });
                return Ok(search);
            }
        }
        Ok(search)
    }
}

/// What came of one step.
struct Stepped {
    clocks: u64,
    /// What each register means after it.
    after: Vec<i128>,
    /// The block has ended with it.
    done: bool,
    /// What is wrong whatever the state after it is.
    wrong: Option<String>,
}

/// Runs steps of a machine from any states, its inputs those of a block that runs.
struct Stepper<'m> {
    machine: &'m Machine,
    engine: Box<dyn stepwave_engine::Engine>,
    rows: Rows,
    inputs: Vec<u64>,
}

impl<'m> Stepper<'m> {
    fn new(machine: &'m Machine, words: &[(Net, u64)]) -> Stepper<'m> {
        let word = |input: &Net| words.iter().find(|(net, _)| net == input).map_or(0, |(_, value)| *value);
        let strobes = [machine.load.net, machine.preset_position.net];
        let inputs = machine.design.inputs().iter();
        Stepper {
            machine,
            engine: EngineKind::Word.build(&machine.design, &Watch::default()),
            rows: Rows::new(0, 0),
            inputs: inputs.map(|input| if strobes.contains(input) { 0 } else { word(input) }).collect(),
        }
    }

    fn start(&self, registers: &[i128]) -> Start {
        let netlist = self.machine.design.netlist();
        let held = self.machine.design.registers().iter().zip(registers);
        Start {
            // Only the bits of the register count.
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "two's complement")]
            registers: held.map(|(net, number)| *number as u64 & netlist.width(*net).mask()).collect(),
            inputs: self.inputs.clone(),
        }
    }

    fn names(&self, registers: &[i128], matters: impl Fn(Net) -> bool) -> Vec<(String, i128)> {
        let netlist = self.machine.design.netlist();
        let held = self.machine.design.registers().iter().zip(registers).filter(|(register, _)| matters(**register));
        held.filter_map(|(net, number)| Some((netlist.name_of(*net)?.name.clone(), *number))).collect()
    }

    /// The component that overflows in the present sample.
    fn overflow(&self) -> Option<String> {
        let mut properties = self.machine.design.netlist().properties.iter();
        let violated = properties.find(|property| self.engine.value(property.never) == 1);
        violated.map(|property| format!("{} overflows", property.name))
    }

    /// One step; `None` where the state is not one between two steps.
    fn step(&mut self, registers: &[i128]) -> Option<Stepped> {
        let start = self.start(registers);
        self.engine.restore(0, &start.registers, &start.inputs, &[]);
        let wrong =
            |clocks, wrong: String| Some(Stepped { clocks, after: Vec::new(), done: false, wrong: Some(wrong) });
        if self.engine.value(self.machine.done.net) == 1 {
            return None;
        }
        if let Some(overflow) = self.overflow() {
            return wrong(1, overflow);
        }
        for clocks in 1..=LONGEST_STEP {
            self.engine.run(1, &mut self.rows);
            let stepped = self.engine.value(self.machine.stepped.net) == 1;
            let done = self.engine.value(self.machine.done.net) == 1;
            if (!stepped || done)
                && let Some(overflow) = self.overflow()
            {
                return wrong(clocks, overflow);
            }
            if stepped {
                let engine = &self.engine;
                let after = |net: &Net| number(self.machine, *net, engine.value(*net));
                let after = self.machine.design.registers().iter().map(after).collect();
                return Some(Stepped { clocks, after, done, wrong: None });
            }
        }
        wrong(LONGEST_STEP, "no step is completed".to_owned())
    }
}
