//! `stepwave compare`: every method on one curve, side by side.

use std::io::Write as _;
use std::time::Instant;

use crate::engine::{EngineKind, Rows};
use crate::models::{CurveKind, Millionths, Model, ModelError, Options, Preset, installed};
use crate::nc::{Curve, Nurbs, SplineForm};
use crate::report::page::{self, Comparison, Facts, Limit, Packed, RunRecord};
use crate::report::{RelativeSpeed, geometry as geometry_of, title};
use crate::testbench::{
    Ending, Observer, ObserverError, Outcome, OverflowWatch, PathWatch, Speed, SpeedWatch, Step, Testbench, WorstError,
};

use super::columns::{aligned, markdown};
use super::geometry;
use super::progress::Progress;
use crate::Error;
use crate::cli::CompareArgs;
use crate::output::{self, Outputs};
use crate::own::is_netlist;
use crate::waves::WaveOptions;

/// What a page may hold of each of several runs.
const OF_SEVERAL: Limit = Limit { bytes: 1 << 26, remedy: "compare fewer models on it, or a shorter curve" };

/// Prints one row for each model that takes the curve, by default and in its other common forms.
pub(crate) fn run(args: &CompareArgs) -> Result<(), Error> {
    let curve = curve(args)?;
    let models = models(args)?;
    let curves = [Some(curve.clone()), as_nurbs(&curve)];
    let curve_of = |model: &Model| curves.iter().flatten().find(|curve| model.curve().fits(curve));
    let models = models.into_iter().filter_map(|model| Some((model, curve_of(model)?)));
    let runs: Vec<_> = models
        .flat_map(|(model, curve)| forms(model, curve).into_iter().map(move |form| (model, curve, form)))
        .collect();
    if runs.is_empty() {
        let curve = curve.description().drawn.noun();
        return Err(Error::Invalid(format!("none of these models takes {curve}: name others, or none for all")));
    }
    let mut outputs = Outputs::reading(args.bench.files(&args.models).into_iter().chain(args.geometry.file()));
    let page = args.html.as_deref().map(|path| outputs.open(path)).transpose()?;
    let progress = Progress::of(runs.len() as u64, "machines");
    let (mut rows, mut left_out, mut pages) = (vec![HEADING.map(str::to_owned)], Vec::new(), Vec::new());
    for (model, curve, (form, choices)) in runs {
        match row(model, &form, curve, &choices, args)? {
            Ok((row, run)) => {
                rows.push(row);
                pages.extend(run);
            }
            Err(reason) => left_out.push(format!("\nLeft out: {}{form}: {reason}\n", model.name)),
        }
        progress.add(1);
    }
    progress.finish();
    if let Some(mut out) = page {
        let [heading, rows @ ..] = &rows[..] else { return Ok(()) };
        let title = geometry_of(&curve);
        let rows = rows.iter().map(|row| row.to_vec()).collect();
        let comparison = Comparison { title: title.clone(), heading: heading.to_vec(), rows };
        page::write_all(&mut out, &title, &pages, Some(&comparison))?;
        out.flush()?;
    }
    let quiet = outputs.uses_stdout();
    outputs.commit()?;
    if quiet {
        return Ok(());
    }
    let note = geometry::moved_center(&curve, &args.geometry).unwrap_or_default();
    let table = if args.markdown { markdown(&rows, &NUMBERS) } else { aligned(&rows, &NUMBERS) };
    output::print(&(note + &table + &left_out.concat()))
}

/// The curve that all of them run.
fn curve(args: &CompareArgs) -> Result<Curve, Error> {
    let geometry = &args.geometry;
    let sized = geometry.drawn().and_then(|drawn| CurveKind::ALL.into_iter().find(|kind| kind.has(drawn)));
    let kind = if let Some(kind) = sized {
        kind
    } else if geometry.cw || geometry.ccw {
        CurveKind::Move
    } else {
        CurveKind::Line { max_axes: 6 }
    };
    geometry::curve("compare", kind, geometry, args.tolerance.map_or(0.0, Millionths::units))
}

/// The NURBS of all weights 1 that a Bezier curve is.
fn as_nurbs(curve: &Curve) -> Option<Curve> {
    let Curve::Spline(spline) = curve else { return None };
    let of = (spline.form() == SplineForm::Bezier).then(|| Nurbs::bezier(spline.points()))?;
    Some(of.ok()?.into())
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

/// A row of the table, and the run for a page where one is asked for.
type Row = ([String; 8], Option<Packed>);

/// What a form of a model comes to; or why it cannot be built for this curve.
fn row(
    model: &Model,
    form: &str,
    curve: &Curve,
    choices: &Options,
    args: &CompareArgs,
) -> Result<Result<Row, ModelError>, Error> {
    let bench = match Testbench::new(model, curve, choices) {
        Ok(bench) => bench.limited(args.max_clocks),
        Err(error @ (ModelError::TooWide { .. } | ModelError::Widths(_))) => return Ok(Err(error)),
        Err(error) => return Err(error.into()),
    };
    let mut path = PathWatch::new(&bench, curve);
    let mut deadline = Deadline { begun: Instant::now(), seconds: args.max_seconds, clocks: 0, steps: 0 };
    let mut speed = SpeedWatch::new(&bench);
    let recorded = || RunRecord::of_bench(&bench, &WaveOptions::default(), [1e6, 1e-3, 1e-3], OF_SEVERAL);
    let mut record = args.html.as_ref().map(|_| recorded()).transpose()?;
    let mut overflow = OverflowWatch::new(&bench);
    let mut observers: Vec<&mut dyn Observer> = vec![&mut path, &mut speed, &mut deadline];
    if let Some(record) = &mut record {
        observers.extend([record as &mut dyn Observer, &mut overflow]);
    }
    let outcome = bench.run(EngineKind::Compiled, &mut observers);
    drop(observers);
    let (steps, clocks, end) = match outcome {
        Ok(outcome) => (outcome.steps, outcome.clocks, end_of(&outcome, curve)),
        Err(error) if error.is::<OutOfTime>() => (deadline.steps, deadline.clocks, "given up at --max-seconds"),
        Err(error) => return Err(error.into()),
    };
    let worst = path.worst;
    let cells =
        cells(format!("{}{form}", model.name), &bench, curve, (steps, clocks, end), worst.as_ref(), speed.finish());
    let facts = |row: &[String; 8]| Facts {
        headline: row[0].clone(),
        title: title(model, bench.hardware(), curve),
        summary: HEADING.iter().zip(row).map(|(name, cell)| format!("{name}: {cell}\n")).collect(),
        failures: if end == "exact" { Vec::new() } else { vec![end.to_owned()] },
        clock_hz: 1e6,
        blu_mm: 1e-3,
        clocks,
        events: overflow.events(),
        worst,
        outline: Facts::of_curve(curve),
        ..Facts::default()
    };
    let run = record.map(|record| record.finish(&facts(&cells))).transpose()?;
    Ok(Ok((cells, run)))
}

/// How a run ended, in a word.
fn end_of(outcome: &Outcome, curve: &Curve) -> &'static str {
    match outcome.ending {
        Ending::Done if outcome.ends(curve) => "exact",
        Ending::Done => "missed",
        Ending::Trapped => "overflow",
        Ending::Stalled { .. } => "stalled",
        Ending::Endless { .. } => "endless",
        Ending::Limit => "given up at --max-clocks",
    }
}

/// The cells of a row.
fn cells(
    name: String,
    bench: &Testbench,
    curve: &Curve,
    (steps, clocks, end): (u64, u64, &str),
    worst: Option<&WorstError>,
    speed: Option<Speed>,
) -> [String; 8] {
    // Positions are as wide as the travel, for every method.
    let hardware = bench.hardware();
    let length = (end == "exact").then(|| curve.length());
    let clocks_of_step = hardware.clocks_of_step();
    let speeds = speed.zip(clocks_of_step).map(|(speed, step)| RelativeSpeed::new(&speed, step, length));
    let own = hardware.widths.iter().filter(|(name, _)| !hardware.letters().contains(name));
    let widest = own.max_by_key(|(name, width)| (width.get(), std::cmp::Reverse(*name)));
    [
        name,
        steps.to_string(),
        clocks.to_string(),
        worst.map_or_else(String::new, |worst| format!("{:.3}", worst.error)),
        speeds.map_or_else(String::new, |of| {
            let mean = of.mean.map_or_else(|| "-".to_owned(), |mean| format!("{mean:.4}"));
            format!("{mean} ({:.4} to {:.4})", of.least.0, of.greatest.0)
        }),
        speeds.and_then(|of| of.ripple()).map_or_else(String::new, |ripple| format!("{:.2} %", 100.0 * ripple)),
        widest.map_or_else(String::new, |(name, width)| format!("{name} {width}")),
        end.to_owned(),
    ]
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
