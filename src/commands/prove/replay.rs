//! Counterexamples, and counterexamples to induction: shown by the simulator before they are told.

use std::borrow::Cow;
use std::ffi::OsString;
use std::fmt::Write as _;

use crate::models::{Model, Options};
use crate::nc::Curve;
use crate::report::{self, run_command};
use crate::study::proof::{Counterexample, CounterexampleToInduction, Fault};
use crate::testbench::{Observer, OverflowWatch, Testbench};
use crate::trace::timescale::ClockTime;
use clap::Parser;

use super::super::run::{Finished, simulate};
use super::tell;
use crate::Error;
use crate::cli::{Cli, Command, ProveArgs, RunArgs};
use crate::output::Outputs;
use crate::waves::{Sinks, Waves};

/// The run of a geometry, with its wave if one is wanted, and the command that repeats it.
fn replayed(
    args: &ProveArgs,
    model: &Model,
    curve: &Curve,
    choices: &Options,
) -> Result<(String, Box<RunArgs>), Error> {
    let mut command = run_command(model, curve, choices);
    // No word of it holds a blank.
    let mut words: Vec<OsString> = command.split(' ').map(OsString::from).collect();
    if let Some(path) = &args.vcd {
        words.extend(["--vcd".into(), path.into()]);
        let path = path.display().to_string();
        command += &format!(" --vcd {}", shlex::try_quote(&path).unwrap_or(Cow::Borrowed(&path)));
    }
    match Cli::try_parse_from(words) {
        Ok(Cli { command: Command::Run(run) }) => Ok((command, run)),
        _ => Err(Error::Invalid(format!("what was found cannot be replayed: {command}"))),
    }
}

/// Runs a counterexample as its command does, with its wave if one is wanted, and tells it.
pub(super) fn refuted(args: &ProveArgs, model: &Model, example: &Counterexample) -> Result<(), Error> {
    refuted_with(args, model, example, "")
}

/// The same, with a note after what it shows.
pub(super) fn refuted_with(args: &ProveArgs, model: &Model, example: &Counterexample, note: &str) -> Result<(), Error> {
    let Counterexample { k, curve, choices, fault } = example;
    let (command, run) = replayed(args, model, curve, choices)?;
    let mut outputs = Outputs::default();
    let shown = match simulate(&run, &mut outputs) {
        // With wrap and saturate a run goes on after an overflow or a load word that was cut, and may reach its end all the
        // same.
        Ok(Finished { failures, text, .. })
            if failures.is_empty() && matches!(fault, Fault::Overflow | Fault::Refused) =>
        {
            text.lines().filter_map(|line| line.strip_prefix("warning: ")).collect::<Vec<_>>().join("; ")
        }
        Ok(Finished { failures, .. }) => failures.join("; "),
        // A geometry that is refused comes to no output; where one was begun, it cannot be written.
        Err(refused) if *fault == Fault::Refused && outputs.are_unopened() => {
            refused.to_string().trim_start_matches("stepwave: ").to_owned()
        }
        Err(trouble) => return Err(trouble),
    };
    if shown.is_empty() {
        return Err(Error::Invalid(format!("the lanes and a single run differ: {command}")));
    }
    outputs.commit()?;
    tell(args, &format!("COUNTEREXAMPLE at k = {k}: {command}\n"))?;
    Err(Error::Check(vec![format!("refuted at k = {k}: {shown}{note}")]))
}

/// Shows a step that keeps a proof from being one, with its wave if one is wanted, and tells it.
pub(super) fn not_inductive(
    args: &ProveArgs,
    model: &Model,
    step: &CounterexampleToInduction,
    choices: &Options,
) -> Result<String, Error> {
    let CounterexampleToInduction { k, kind, curve, hardware, start, clocks, wrong, state } = step;
    let (_, run) = replayed(args, model, curve, choices)?;
    let bench = Testbench::of_hardware(model, hardware.clone())?;
    let title = format!("{}, from a state that may be unreachable", report::title(model, bench.hardware(), curve));
    let mut outputs = Outputs::default();
    let time = ClockTime::from_hz(run.clock.clock_hz)?;
    let options = run.trace.options();
    let sinks = Sinks::open(&options, &mut outputs)?;
    let mut waves = sinks.map(|sinks| Waves::new(&bench, &options, sinks, time, &title)).transpose()?;
    let mut overflow = OverflowWatch::new(&bench);
    let mut observers: Vec<&mut dyn Observer> = vec![&mut overflow];
    observers.extend(waves.iter_mut().flat_map(Waves::observers));
    bench.show(start, *clocks, &mut observers)?;
    if let Some(waves) = waves {
        waves.finish(&overflow.events(), *clocks, &mut outputs)?;
    }
    outputs.commit()?;
    let mut text = format!("NOT INDUCTIVE at k = {k}, {kind}: {wrong}\n");
    let held: Vec<String> = state.iter().map(|(register, number)| format!("{register} = {number}")).collect();
    // Writing to a string cannot fail.
    let _ =
        writeln!(text, "  clock 0, a state that the invariants allow and that may be unreachable: {}", held.join(", "));
    let _ = writeln!(
        text,
        "  clock {clocks}, the end of the step; the inputs are those of {}",
        run_command(model, curve, choices)
    );
    if let Some(event) = overflow.events().first() {
        let _ = writeln!(text, "  {event}");
    }
    Ok(text)
}
