//! The recipe of a proof about a netlist at its own widths: netlist and inputs in; a verdict for every property out.

mod report;
mod second;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::Error;
use crate::engine::{EngineKind, Watch};
use crate::netlist::cells::{Claim, Property};
use crate::netlist::{Design, Net, elaborate};
use crate::output::Outputs;
use crate::prove::sat::{self, Decision, Inputs, Limit, Limits, Question};
use crate::trace::pattern::{fits, glob};
use crate::waves::WaveOptions;

use report::{claimed, clocks};

use second::Solver;

pub use report::{BenchReport, Counterexample, Goal, ProveReport, Verdict};
pub use second::{SecondOpinion, SolverLanguage};

use super::bench::{Conditions, Fixed};
use super::example::Example;
use super::stimulus::inputs;
use super::{Sim, Stimulus, announce, matching};

/// What is to be proved of a netlist: that none of its properties is ever violated, whatever its inputs do.
///
/// ```
/// use stepwave::netlist::{elaborate, text};
/// use stepwave::own::{Prove, Verdict};
///
/// // A counter of two bits that may not be 3: the input `step` makes it count.
/// let text = "netlist t\n%0:1 = input\n%1:2 = register reset 0x0 next %3\n%2:2 = zero-extend %0\n%3:2 = add %1 %2\n\
///             %4:2 = const 0x3\n%5:1 = equal %1 %4\nname %0 in 0 \"step\" unsigned\nname %1 in 0 \"count\" unsigned\n\
///             property \"never_3\" never %5 invariant\n";
/// let design = elaborate(text::parse(text)?)?;
/// let report = Prove::new(design).run()?;
/// let Verdict::Counterexample(example) = &report.goals[0].verdict else { panic!("{report:?}") };
/// assert_eq!((example.clock, example.stimulus.as_str()), (3, "step\n1\n1\n1\n1\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is proved before `run`"]
pub struct Prove {
    design: Design,
    stimulus: Stimulus,
    hold: Vec<String>,
    goals: Vec<String>,
    limits: Limits,
    waves: WaveOptions,
    csv: Option<PathBuf>,
    json: Option<PathBuf>,
    solver: Option<Solver>,
    bench: Option<(PathBuf, Vec<Fixed>, Vec<String>)>,
}

impl Prove {
    /// Of this netlist, with all inputs free, within a minute and 4 GiB.
    pub fn new(design: Design) -> Prove {
        let limits = Limits { time: Duration::from_secs(60), memory: 4 << 30, clock: None };
        let stimulus = Stimulus::default();
        Prove {
            design,
            stimulus,
            hold: Vec::new(),
            goals: Vec::new(),
            limits,
            waves: WaveOptions::default(),
            csv: None,
            json: None,
            solver: None,
            bench: None,
        }
    }

    /// With inputs that are constant, and a table whose inputs have its values in its rows and are free after the last.
    pub fn stimulus(self, stimulus: Stimulus) -> Prove {
        Prove { stimulus, ..self }
    }

    /// Inputs of the table that match one of these globs keep the values of its last row.
    pub fn hold(self, globs: Vec<String>) -> Prove {
        Prove { hold: globs, ..self }
    }

    /// Of the properties alone whose path matches one of these globs.
    pub fn goals(self, globs: Vec<String>) -> Prove {
        Prove { goals: globs, ..self }
    }

    /// What the operators lose whose path matches one of these globs is announced, and no goal.
    ///
    /// # Errors
    /// A glob matches none of them.
    pub fn wraps(self, globs: &[String]) -> Result<Prove, Error> {
        let mut netlist = self.design.netlist().clone();
        announce(&mut netlist, globs).map_err(|(glob, why)| Error::Invalid(format!("--wraps {glob}: {why}")))?;
        Ok(Prove { design: elaborate(netlist)?, ..self })
    }

    /// Within these limits of time, memory and clocks.
    pub fn limits(self, limits: Limits) -> Prove {
        Prove { limits, ..self }
    }

    /// With the wave of the first counterexample as VCD in this file.
    pub fn vcd(self, path: Option<PathBuf>) -> Prove {
        Prove { waves: WaveOptions { vcd: path, ..self.waves }, ..self }
    }

    /// With the wave of the first counterexample in these files, of these signals and for this viewer.
    pub fn waves(self, waves: WaveOptions) -> Prove {
        Prove { waves, ..self }
    }

    /// With the inputs of the first counterexample as CSV in this file, a [stimulus](Stimulus::table).
    pub fn csv(self, path: Option<PathBuf>) -> Prove {
        Prove { csv: path, ..self }
    }

    /// Of the runs that a bench file allows: its reset, its constants and its assumptions hold, and what its `wraps` names
    /// is not a goal. Inputs that the stimulus has are not the bench file's.
    ///
    /// # Errors
    /// The file cannot be read, or what it says does not fit the netlist.
    pub fn bench(self, file: &Path) -> Result<Prove, Error> {
        let Conditions { netlist, fixed, wraps } = Conditions::read(self.design.netlist(), file)?;
        Ok(Prove { design: elaborate(netlist)?, bench: Some((file.to_owned(), fixed, wraps)), ..self })
    }

    /// With a second opinion of another solver, whose command reads this language from its input, within this time for
    /// each question.
    pub fn solver(self, command: &str, language: SolverLanguage, limit: Duration) -> Prove {
        Prove { solver: Some(Solver { command: command.to_owned(), language, limit }), ..self }
    }

    /// With the report as JSON in this file.
    pub fn json(self, path: Option<PathBuf>) -> Prove {
        Prove { json: path, ..self }
    }

    /// Decides what the limits allow, and writes every file that is asked for.
    ///
    /// # Errors
    /// A glob matches nothing, the goals depend on memories that are too large, or a file cannot be written.
    pub fn run(&self) -> Result<ProveReport, Error> {
        let mut outputs = Outputs::default();
        let report = self.staged(&mut outputs, &mut |_| {})?;
        outputs.commit()?;
        Ok(report)
    }

    pub(crate) fn staged(
        &self,
        outputs: &mut Outputs,
        progress: &mut dyn FnMut(sat::Progress),
    ) -> Result<ProveReport, Error> {
        let (goals, inputs) = (self.asked()?, self.inputs()?);
        let netlist = self.design.netlist();
        let assumptions = netlist.properties.iter().enumerate();
        let assumptions = assumptions.filter(|(_, property)| property.claim == Claim::Assumption);
        let assumptions: Vec<usize> = assumptions.map(|(index, _)| index).collect();
        let question = Question { design: &self.design, goals, assumptions, inputs };
        let (decision, second) = match &self.solver {
            None => (sat::decide(&question, &self.limits, progress)?, None),
            Some(solver) => {
                let (decision, queries) = sat::decide_with_queries(&question, &self.limits, progress)?;
                let second = solver.ask(&question, &decision, &queries)?;
                (decision, Some(second))
            }
        };
        let assumed = question.assumptions.iter().map(|&index| netlist.properties[index].name.clone()).collect();
        let (free, open) = (self.free(&question), self.open(&decision));
        let bench = self.bench_report();
        let Decision { depth: induction, limit, clock: bound, .. } = decision;
        let design = netlist.scopes[0].name.clone();
        let mut report =
            ProveReport { design, goals: Vec::new(), free, assumed, bound, induction, limit, open, second, bench };
        for (&index, verdict) in question.goals.iter().zip(&decision.verdicts) {
            let property = &netlist.properties[index];
            let verdict = match verdict {
                sat::Verdict::Proved { depth } => Verdict::Proved { induction: *depth },
                sat::Verdict::Unknown { clean } => Verdict::Unknown { clean: clean.checked_sub(1) },
                sat::Verdict::Violated { clock, inputs } => {
                    let example = Example::new(&question, property.never, *clock, inputs);
                    Verdict::Counterexample(self.replayed(property, *clock, example)?)
                }
            };
            let source = netlist.line_of(property.never);
            report.goals.push(Goal { name: property.name.clone(), claim: claimed(property), source, verdict });
        }
        self.write(&report, outputs)?;
        Ok(report)
    }

    /// The properties that are to be proved.
    fn asked(&self) -> Result<Vec<usize>, Error> {
        let netlist = self.design.netlist();
        let all = || netlist.properties.iter().filter(|property| property.claim.is_goal());
        let mut globs = Vec::new();
        for text in &self.goals {
            let wrong = |why: String| Error::Invalid(format!("--goal {text}: {why}"));
            matching(text, all()).map_err(wrong)?;
            globs.push(glob(text).map_err(wrong)?);
        }
        let wanted = |name: &str| globs.is_empty() || globs.iter().any(|glob| fits(glob, name));
        let numbered = netlist.properties.iter().enumerate();
        let wanted = numbered.filter(|(_, property)| property.claim.is_goal() && wanted(&property.name));
        let goals: Vec<usize> = wanted.map(|(index, _)| index).collect();
        if goals.is_empty() {
            let name = &netlist.scopes[0].name;
            return Err(Error::Invalid(format!(
                "{name} has nothing to prove: no operator that could lose a carry unannounced, and no assertion"
            )));
        }
        Ok(goals)
    }

    /// Values of inputs, sample by sample.
    fn inputs(&self) -> Result<Inputs, Error> {
        let names = self.named_inputs();
        let is_named = |net: &Net| names.iter().any(|(nets, _)| nets.contains(net));
        if let Some(net) = self.design.inputs().iter().find(|net| !is_named(net)) {
            return Err(Error::Invalid(format!("the input {net} has no name: give it one, so that it can be shown")));
        }
        let constant = || self.stimulus.held();
        let given = self.stimulus.rows();
        let last: Vec<_> = self.stimulus.row(given.wrapping_sub(1)).collect();
        let mut later: Vec<_> = constant().collect();
        for text in &self.hold {
            let glob = glob(text).map_err(|why| Error::Invalid(format!("--hold {text}: {why}")))?;
            let named = |(net, _): &&(Net, u64)| names.iter().any(|(own, name)| own.contains(net) && fits(&glob, name));
            let found: Vec<_> = last.iter().filter(named).copied().collect();
            if found.is_empty() {
                return Err(Error::Invalid(format!(
                    "--hold {text} matches no input of --stimulus, whose last row has the value to hold"
                )));
            }
            later.extend(found.into_iter().filter(|input| !constant().any(|other| other == *input)));
        }
        // What the bench file fixes, too, and in how many clocks one of them has not its last value.
        let first = self.fixed().map(|fixed| usize::try_from(fixed.clocks).unwrap_or(usize::MAX)).max().unwrap_or(0);
        let row = |row: usize| {
            let own = self.fixed().flat_map(|fixed| fixed.values((row as u64) < fixed.clocks));
            match row < given {
                true => constant().chain(self.stimulus.row(row)).chain(own).collect(),
                false => later.iter().copied().chain(own).collect(),
            }
        };
        let rows: Vec<Vec<_>> = (0..given.max(first)).map(row).collect();
        later.extend(self.fixed().flat_map(|fixed| fixed.values(false)));
        Ok(Inputs { rows, later })
    }

    /// What the bench file fixes of inputs that the stimulus does not have.
    fn fixed(&self) -> impl Iterator<Item = &Fixed> {
        let all = self.bench.iter().flat_map(|(_, fixed, _)| fixed);
        all.filter(|fixed| !self.stimulus.inputs().any(|net| fixed.has(net)))
    }

    /// The bench file, and what it says in words.
    fn bench_report(&self) -> Option<BenchReport> {
        let (file, _, wraps) = self.bench.as_ref()?;
        let wraps = wraps.iter().map(|glob| format!("{glob} may lose carries"));
        let says = self.fixed().map(|fixed| fixed.about.clone()).chain(wraps).collect();
        Some(BenchReport { file: file.display().to_string(), says })
    }

    /// The inputs with their nets, the lowest first, and their names.
    fn named_inputs(&self) -> Vec<(Vec<Net>, String)> {
        inputs(&self.design).into_iter().map(|(named, name)| (named.nets().collect(), name)).collect()
    }

    /// Names of the inputs that are free after the last row.
    fn free(&self, question: &Question<'_>) -> Vec<String> {
        let fixed = |net: &Net| question.inputs.later.iter().any(|(other, _)| other == net);
        self.named_inputs().into_iter().filter(|(nets, _)| !nets.iter().all(fixed)).map(|(_, name)| name).collect()
    }

    /// Why goals are open.
    fn open(&self, decision: &Decision) -> Option<String> {
        let tried = decision.depth.map_or_else(
            || "no induction was tried".to_owned(),
            |depth| format!("induction was tried over up to {}", clocks(depth as u64)),
        );
        if let Some(clock) = decision.contradiction {
            return Some(format!(
                "no run meets the assumptions up to clock {clock}, so that nothing later can be said"
            ));
        }
        Some(match decision.limit? {
            Limit::Time => {
                let seconds = self.limits.time.as_secs_f64();
                format!("stopped after {seconds} s; {tried}: give more --time, or name fewer goals with --goal")
            }
            Limit::Memory => {
                let most = self.limits.memory >> 20;
                format!("stopped at {most} MB of memory; {tried}: give more --memory, or name fewer goals with --goal")
            }
            Limit::Clock => {
                let bound = self.limits.clock.unwrap_or(0);
                format!("stopped at clock {bound}; {tried}: give a greater --bound")
            }
        })
    }

    /// Runs a counterexample in the simulator, before it is reported.
    fn replayed(&self, property: &Property, clock: u64, mut example: Example<'_>) -> Result<Counterexample, Error> {
        let mut gates = EngineKind::Gates.build(&self.design, &Watch::default());
        let found = example.is_shown_by(gates.as_mut());
        example.simplify();
        let shown = found && example.is_shown_by(gates.as_mut());
        let stimulus = example.table(&self.named_inputs());
        let table = Stimulus::default().table(&self.design, &stimulus)?;
        // Of this property alone, so that it is the one reported.
        let mut alone = self.design.netlist().clone();
        alone.properties = vec![property.clone()];
        let report = Sim::new(elaborate(alone)?, table, clock).run()?;
        match report.tallies.first() {
            Some(tally) if shown && tally.first.clock() == clock => {
                let (event, violation) = (tally.first.to_string(), tally.first.clone());
                Ok(Counterexample { clock, event, violation, stimulus })
            }
            _ => Err(Error::Invalid(format!(
                "a mistake of stepwave itself: the simulator does not show the violation of {} at clock {clock}; please \
                 report it with the netlist",
                property.name
            ))),
        }
    }

    /// Writes the report, and the inputs and the wave of the first counterexample.
    fn write(&self, report: &ProveReport, outputs: &mut Outputs) -> Result<(), Error> {
        if let Some(path) = &self.json {
            let mut sink = outputs.open(path)?;
            writeln!(sink, "{:#}", report.json())?;
            sink.flush()?;
        }
        let Some(example) = report.counterexamples().next() else { return Ok(()) };
        if let Some(path) = &self.csv {
            let mut sink = outputs.open(path)?;
            sink.write_all(example.stimulus.as_bytes())?;
            sink.flush()?;
        }
        if self.waves.wanted() {
            let table = Stimulus::default().table(&self.design, &example.stimulus)?;
            let waves = self.waves.clone();
            Sim::new(self.design.clone(), table, example.clock).waves(waves).staged(outputs, &mut std::io::sink())?;
        }
        Ok(())
    }
}
