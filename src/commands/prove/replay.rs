//! Counterexamples, and counterexamples to induction: shown by the simulator before they are reported.

use std::borrow::Cow;
use std::fmt::Write as _;

use crate::models::{Model, Options};
use crate::report::{self, run_command};
use crate::study::Extent;
use crate::study::proof::{Counterexample, CounterexampleToInduction, Fault, Proposition};
use crate::testbench::{Observer, OverflowWatch, Testbench};
use crate::trace::timescale::ClockTime;

use super::{open_wave, tell};
use crate::cli::ProveArgs;
use crate::output::Outputs;
use crate::waves::{Sinks, Waves};
use crate::{Error, Simulation};

/// The clock of `run` where none is given.
const CLOCK_HZ: f64 = 1e6;

/// Runs a counterexample as its command does, with its wave if one is wanted, and reports it.
pub(super) fn refuted(args: &ProveArgs, proposition: &Proposition, example: &Counterexample) -> Result<(), Error> {
    let Counterexample { k, curve, choices, fault } = example;
    let model = proposition.model;
    let mut command = run_command(model, curve, choices);
    if let Some(path) = &args.vcd {
        let path = path.display().to_string();
        command += &format!(" --vcd {}", shlex::try_quote(&path).unwrap_or(Cow::Borrowed(&path)));
    }
    let options = choices.clone().at_clock(CLOCK_HZ);
    let simulation = Simulation::new(model, curve.clone()).options(options).clock_hz(CLOCK_HZ).waves(args.waves());
    let mut outputs = Outputs::default();
    let ran = simulation
        .prepare()
        .map_err(Error::from)
        .and_then(|made| simulation.run_on(made.bench, &mut outputs, |_, _| Ok(())));
    let shown = match ran {
        Ok(ran) => match ran.report.failures() {
            // With wrap and saturate a run continues after an overflow or a load word that was cut, and may reach its end all
            // the same.
            none if none.is_empty() && matches!(fault, Fault::Overflow | Fault::Refused) => {
                let summary = ran.report.summary().to_string();
                summary.lines().filter_map(|line| line.strip_prefix("warning: ")).collect::<Vec<_>>().join("; ")
            }
            failures => failures.join("; "),
        },
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
    open_wave(args)?;
    Err(Error::Check(vec![format!("refuted at k = {k}: {shown}{}", of_smaller(proposition, *k))]))
}

/// Where registers of given widths have no box: what to ask of coordinates that are smaller than those of a counterexample.
fn of_smaller(proposition: &Proposition, k: u32) -> String {
    if !proposition.is_fixed() || proposition.bounds().is_some() || k < 2 {
        return String::new();
    }
    let words = proposition.clone().extent(Extent::Bits(k - 1)).words().join(" ");
    format!("; of smaller coordinates see `stepwave prove {} {words}`", proposition.model.name)
}

/// Shows a step that keeps a proof from being one, with its wave if one is wanted.
pub(super) fn not_inductive(
    args: &ProveArgs,
    model: &Model,
    step: &CounterexampleToInduction,
    options: &Options,
) -> Result<String, Error> {
    let CounterexampleToInduction { k, kind, curve, hardware, start, clocks, wrong, state } = step;
    let bench = Testbench::of_hardware(model, hardware.clone())?;
    let title = format!("{}, from a state that may be unreachable", report::title(model, bench.hardware(), curve));
    let mut outputs = Outputs::default();
    let time = ClockTime::from_hz(CLOCK_HZ)?;
    let wave = args.waves();
    let sinks = Sinks::open(&wave, &mut outputs)?;
    let mut waves = sinks.map(|sinks| Waves::new(&bench, &wave, sinks, time, &title, None)).transpose()?;
    let mut overflow = OverflowWatch::new(&bench);
    let mut observers: Vec<&mut dyn Observer> = vec![&mut overflow];
    observers.extend(waves.iter_mut().flat_map(Waves::observers));
    bench.show(start, *clocks, &mut observers)?;
    if let Some(waves) = waves {
        waves.finish(&overflow.events(), *clocks, &mut outputs)?;
    }
    outputs.commit()?;
    open_wave(args)?;
    let mut text = format!("NOT INDUCTIVE at k = {k}, {kind}: {wrong}\n");
    let held: Vec<String> = state.iter().map(|(register, number)| format!("{register} = {number}")).collect();
    // Writing to a string cannot fail.
    let _ =
        writeln!(text, "  clock 0, a state that the invariants allow and that may be unreachable: {}", held.join(", "));
    let _ = writeln!(
        text,
        "  clock {clocks}, the end of the step; the inputs are those of {}",
        run_command(model, curve, options)
    );
    if let Some(event) = overflow.events().first() {
        let _ = writeln!(text, "  {event}");
    }
    Ok(text)
}
