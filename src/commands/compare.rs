//! `stepwave compare`: every method on one curve, side by side.

use std::time::Instant;

use crate::engine::{EngineKind, Rows};
use crate::models::{CurveKind, Millionths, Model, ModelError, Options, Preset, installed};
use crate::nc::Curve;
use crate::report::RelativeSpeed;
use crate::testbench::{Ending, Observer, ObserverError, PathWatch, SpeedWatch, Step, Testbench};

use super::columns::{aligned, markdown};
use super::geometry;
use super::progress::Progress;
use crate::Error;
use crate::cli::CompareArgs;
use crate::output;
use crate::own::is_netlist;

/// Prints one row for each model that takes the curve, by default and in its other common forms.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Error> {
    let geometry = &args.geometry;
    let sized = geometry.drawn().and_then(|drawn| CurveKind::ALL.into_iter().find(|kind| kind.has(drawn)));
    let kind = if let Some(kind) = sized {
        kind
    } else if geometry.cw || geometry.ccw {
        CurveKind::Move
    } else {
        CurveKind::Line { max_axes: 6 }
    };
    let curve = geometry::curve("compare", kind, geometry, args.tolerance.map_or(0.0, Millionths::units))?;
    let mut rows = vec![HEADING.map(str::to_owned)];
    let models = models(args)?;
    let models = models.into_iter().filter(|model| model.curve().fits(&curve));
    let runs: Vec<_> =
        models.flat_map(|model| forms(model, &curve).into_iter().map(move |form| (model, form))).collect();
    if runs.is_empty() {
        let curve = curve.description().drawn.noun();
        return Err(Error::Invalid(format!("none of these models takes {curve}: name others, or none for all")));
    }
    let progress = Progress::of(runs.len() as u64, "machines");
    let mut left_out = Vec::new();
    for (model, (form, choices)) in runs {
        match row(model, &form, &curve, &choices, args)? {
            Ok(row) => rows.push(row),
            Err(reason) => left_out.push(format!("\nLeft out: {}{form}: {reason}\n", model.name)),
        }
        progress.add(1);
    }
    progress.finish();
    let note = geometry::moved_center(&curve, geometry).unwrap_or_default();
    let table = if args.markdown { markdown(&rows, &NUMBERS) } else { aligned(&rows, &NUMBERS) };
    output::print(&(note + &table + &left_out.concat()))
}

const HEADING: [&str; 8] = [
    "model",
    "steps",
    "clocks",
    "greatest error (BLU)",
    "v/v_max, mean (least to greatest)",
    "ripple",
    "widest register",
    "end point",
];
/// Its columns of numbers.
const NUMBERS: [usize; 5] = [1, 2, 3, 4, 5];

/// The models to compare: those that are named; all, and netlists of one's own, where no model of the catalogue is.
fn models(args: &CompareArgs) -> Result<Vec<&'static Model>, Error> {
    let named = args.models.iter().map(|word| args.bench.model(word)).collect::<Result<Vec<_>, _>>()?;
    let all = args.models.iter().all(|word| is_netlist(word));
    let catalogue = installed().iter().filter(|_| all);
    Ok(catalogue.chain(named).collect())
}

/// The forms of a model whose path or clocks differ: its default, and one for each of the common options.
fn forms(model: &Model, curve: &Curve) -> Vec<(String, Options)> {
    let own = model.plan(curve, &Options::at_1_mhz()).ok();
    let has_half = own.is_some_and(|hardware| hardware.presets.iter().all(|preset| *preset == Preset::Half));
    let presets: [&str; 2] =
        if has_half { [" --preset zero", " --normalize"] } else { [" --preset half", " --preset half --normalize"] };
    let words = ["", " --beats 1", presets[0], presets[1], " --system 7360", " --radix 10", " --adder serial"];
    let form = |words: &str| {
        let given = Options::parse(words.split_whitespace()).ok()?;
        let takes = given.given().iter().all(|value| model.takes(value.option()));
        takes.then(|| (words.to_owned(), given.at_clock(1e6)))
    };
    words.into_iter().filter_map(form).collect()
}

/// What a form of a model comes to; or why it cannot be built for this curve.
fn row(
    model: &Model,
    form: &str,
    curve: &Curve,
    choices: &Options,
    args: &CompareArgs,
) -> Result<Result<[String; 8], ModelError>, Error> {
    let bench = match Testbench::new(model, curve, choices) {
        Ok(bench) => bench.limited(args.max_clocks),
        Err(error @ (ModelError::TooWide { .. } | ModelError::Widths(_))) => return Ok(Err(error)),
        Err(error) => return Err(error.into()),
    };
    let mut path = PathWatch::new(&bench, curve);
    let mut deadline = Deadline { begun: Instant::now(), seconds: args.max_seconds, clocks: 0, steps: 0 };
    let mut speed = SpeedWatch::new(&bench);
    let mut observers: [&mut dyn Observer; 3] = [&mut path, &mut speed, &mut deadline];
    let (steps, clocks, end) = match bench.run(EngineKind::Compiled, &mut observers) {
        Ok(outcome) => {
            let end = match outcome.ending {
                Ending::Done if outcome.ends(curve) => "exact",
                Ending::Done => "missed",
                Ending::Trapped => "overflow",
                Ending::Stalled { .. } => "stalled",
                Ending::Endless { .. } => "endless",
                Ending::Limit => "given up at --max-clocks",
            };
            (outcome.steps, outcome.clocks, end)
        }
        Err(error) if error.is::<OutOfTime>() => (deadline.steps, deadline.clocks, "given up at --max-seconds"),
        Err(error) => return Err(error.into()),
    };
    // Positions are as wide as the travel, for every method.
    let hardware = bench.hardware();
    let length = ["exact", "missed"].contains(&end).then(|| curve.length());
    let clocks_of_step = hardware.clocks_of_step();
    let speeds = speed.finish().zip(clocks_of_step).map(|(speed, step)| RelativeSpeed::new(&speed, step, length));
    let own = hardware.widths.iter().filter(|(name, _)| !hardware.letters().contains(name));
    let widest = own.max_by_key(|(name, width)| (width.get(), std::cmp::Reverse(*name)));
    Ok(Ok([
        format!("{}{form}", model.name),
        steps.to_string(),
        clocks.to_string(),
        path.worst.map_or_else(String::new, |worst| format!("{:.3}", worst.error)),
        speeds.map_or_else(String::new, |of| {
            let mean = of.mean.map_or_else(|| "-".to_owned(), |mean| format!("{mean:.4}"));
            format!("{mean} ({:.4} to {:.4})", of.least.0, of.greatest.0)
        }),
        speeds.and_then(|of| of.ripple()).map_or_else(String::new, |ripple| format!("{:.2} %", 100.0 * ripple)),
        widest.map_or_else(String::new, |(name, width)| format!("{name} {width}")),
        end.to_owned(),
    ]))
}

/// Ends a run that takes too long.
struct Deadline {
    begun: Instant,
    seconds: u64,
    clocks: u64,
    steps: u64,
}

/// The run took too long.
#[derive(Debug, thiserror::Error)]
#[error("out of time")]
struct OutOfTime;

impl Observer for Deadline {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.steps = step.number;
        Ok(())
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        self.clocks = rows.first_clock() + (rows.len() as u64).saturating_sub(1);
        if self.begun.elapsed().as_secs() >= self.seconds { Err(OutOfTime.into()) } else { Ok(()) }
    }
}
