//! `stepwave prove F.net`: every property of a netlist, at its own widths.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use super::{Progress, open_wave};
use crate::Error;
use crate::cli::ProveArgs;
use crate::models::options::WRAPS;
use crate::output::{self, Outputs};
use crate::own::{
    BenchReport, Counterexample, Prove, ProveReport, SolverLanguage, Verdict, next_to, read_netlist, read_stimulus,
};
use crate::prove::sat::Limits;

/// Rows of a counterexample that are shown.
const SHOWN: usize = 12;

/// Proves what can be proved of a netlist, and reports it.
pub(super) fn prove(args: &ProveArgs, path: &Path) -> Result<(), Error> {
    if let Some(option) = args.of_models() {
        let path = path.display();
        return Err(Error::Invalid(format!("{option} is of a model, and {path} is a netlist: leave it out")));
    }
    let own = &args.netlist;
    let bench = args.bench.bench.clone().or_else(|| Some(next_to(path)).filter(|file| !own.no_bench && file.exists()));
    let design = read_netlist(path)?;
    let name = design.netlist().scopes[0].name.clone();
    let stimulus = read_stimulus(&design, &own.set, own.stimulus.as_deref())?;
    let time = Duration::from_secs(own.time.unwrap_or(60));
    let limits = Limits { time, memory: own.memory.unwrap_or(4096) << 20, clock: own.bound };
    let mut proof = Prove::new(design).stimulus(stimulus).hold(own.hold.clone());
    if let Some(bench) = &bench {
        proof = proof.bench(bench)?;
    }
    proof = proof
        .wraps(&args.hardware.choices().value(&WRAPS))?
        .goals(own.goal.clone())
        .limits(limits)
        .csv(own.stimulus_out.clone())
        .waves(args.waves())
        .json(own.json.clone());
    if let Some(command) = &args.solver {
        let language = if own.dimacs { SolverLanguage::Dimacs } else { SolverLanguage::Smt2 };
        proof = proof.solver(command, language, Duration::from_secs(args.solver_seconds));
    }
    let outputs = || Outputs::reading([path].into_iter().chain(own.stimulus.as_deref()).chain(bench.as_deref()));
    // Both are tried before anything is attempted.
    let mut tried = outputs();
    own.stimulus_out.iter().chain(&args.vcd).chain(&own.json).try_for_each(|path| tried.claim(path).map(drop))?;
    let mut outputs = outputs();
    let progress = Progress::new("clocks");
    let report = proof.staged(&mut outputs, &mut |at| progress.set(at.clock))?;
    drop(progress);
    let quiet = args.by_ending.outputs.quiet || outputs.uses_stdout();
    outputs.commit()?;
    let refuted = report.goals.iter().any(|goal| matches!(goal.verdict, Verdict::Counterexample(_)));
    if !quiet {
        let mut text = shown(&name, &report);
        if !refuted {
            for path in own.stimulus_out.iter().chain(&args.vcd) {
                let _ = writeln!(text, "{} is not written: there is no counterexample", path.display());
            }
        }
        output::print(&text)?;
    }
    if refuted {
        open_wave(args)?;
    }
    let failures = report.failures();
    if failures.is_empty() { Ok(()) } else { Err(Error::Check(failures)) }
}

/// The verdicts, a line each, with the inputs of counterexamples.
fn shown(name: &str, report: &ProveReport) -> String {
    let free = if report.free.is_empty() { "none".to_owned() } else { report.free.join(", ") };
    let mut text = format!("{name}: every run from reset on; free inputs: {free}\n");
    if let Some(BenchReport { file, says }) = &report.bench {
        let says = if says.is_empty() { "it fixes no input".to_owned() } else { says.join("; ") };
        let _ = writeln!(text, "bench file {file}: {says}");
    }
    if !report.assumed.is_empty() {
        let _ = writeln!(text, "assumed in every clock: {}", report.assumed.join(", "));
    }
    for goal in &report.goals {
        let _ = writeln!(text, "{}", goal.line());
        if let Verdict::Counterexample(example) = &goal.verdict {
            text += &inputs(example);
        }
    }
    if let Some(second) = &report.second {
        let _ = writeln!(text, "{}", second.line());
    }
    text
}

/// What the inputs of a counterexample are, and in which clocks they change.
fn inputs(example: &Counterexample) -> String {
    let mut lines = example.stimulus.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap_or_default();
    let mut before: Vec<&str> = Vec::new();
    let (mut text, mut left) = (String::new(), 0);
    for (clock, row) in lines.enumerate() {
        let pairs = names.iter().zip(&row).enumerate();
        let changed = pairs.filter(|(index, (_, value))| before.get(*index) != Some(value));
        let changed: Vec<String> = changed.map(|(_, (name, value))| format!("{name} = {value}")).collect();
        before = row;
        if changed.is_empty() || names == [""] {
            continue;
        }
        if text.lines().count() < SHOWN {
            let _ = writeln!(text, "  clock {clock}: {}", changed.join(", "));
        } else {
            left += 1;
        }
    }
    if left > 0 {
        let _ = writeln!(text, "  and {left} more changes: --stimulus-out FILE writes them");
    }
    text
}
