//! `stepwave machine`: what a machine of a given size takes by each method, side by side.

mod json;
mod pareto;
mod text;

use std::collections::BTreeSet;

use rayon::prelude::*;

use self::pareto::Beaten;
use super::progress::Progress;
use crate::Error;
use crate::cli::{BenchArgs, MachineArgs};
use crate::models::{Model, Options, installed};
use crate::nc::COORDINATE_LIMIT;
use crate::output;
use crate::study::machine::{Dimensions, Size, dimensions, takes};
use crate::study::proof::ProofError;
use crate::study::ramp::{Ramped, machine_of, ramped, whole};
use crate::study::synth::{Cost, Tools};

/// Seeds that are tried for machines that run programs.
const MOST_SEEDS: u64 = 2;

/// A machine by one method, with what it costs where that is asked for.
struct Row {
    found: Dimensions,
    cost: Option<Cost>,
    /// Of methods that run programs: the machine with pulse source and buffer, for lines and arcs.
    whole: Option<Whole>,
    /// Of methods that run programs.
    ramp: Option<Ramped>,
}

impl Row {
    /// Least and greatest feed at the corners in mm/min with a clock; that of data sampling follows from its period and
    /// not from the clock.
    fn feeds(&self, size: &Size, clock_hz: f64) -> Option<[f64; 2]> {
        let clock = self.found.sampled_at.unwrap_or(clock_hz);
        Some(self.found.speeds()?.map(|speed| size.feed_of(speed * clock)))
    }
}

/// What the machine costs that runs programs by a method.
#[derive(Clone, Copy)]
struct Whole {
    machine: &'static Model,
    cost: Cost,
}

impl Whole {
    /// The family interpolates free curves too, by integrators that a machine for lines and arcs is built without.
    fn lacks_curves(&self) -> bool {
        self.machine.moves().is_ok_and(|moves| moves.curves())
    }
}

/// What the ramp costs, which is the same for all: a machine without it and with it.
struct RampCost {
    machine: &'static Model,
    without: Cost,
    with: Cost,
}

/// What there is to say of a machine.
struct Answer {
    size: Size,
    rows: Vec<Row>,
    /// Methods that cannot be had, and why.
    left_out: LeftOut,
    /// Acceleration and jerk as they were given, and the clock in Hz of the ramps.
    accelerates: Option<(String, f64)>,
    /// What costs come from.
    tools: Option<Tools>,
    /// With costs and an acceleration.
    ramp_cost: Option<RampCost>,
    /// Rows that others beat, where they are left out.
    beaten: Option<Vec<Beaten>>,
}

/// Prints a row for each method, and what its registers need.
pub(crate) fn run(args: &MachineArgs) -> Result<(), Error> {
    let size = size(args)?;
    let models = models(args, &size.travel)?;
    // Before the long work, for one of them may be missing.
    let tools = args.synth.map(|_| Tools::find()).transpose()?;
    let (found, left_out) = found(args, &size, models)?;
    let options = ramp_options(args)?;
    let ramps = options.as_ref().map(|options| ramps(args, &size, options, &found)).transpose()?;
    let costs = tools.as_ref().map(|tools| costs(tools, args, &size, &found)).transpose()?;
    let (mut costs, mut ramps) = (costs.into_iter().flatten(), ramps.into_iter().flatten());
    let row = |found| {
        let (cost, whole) = costs.next().map_or((None, None), |(cost, whole)| (Some(cost), whole));
        Row { cost, whole, ramp: ramps.next().flatten(), found }
    };
    let rows: Vec<Row> = found.into_iter().map(row).collect();
    let ramp_cost = match (&tools, &options) {
        (Some(tools), Some(options)) => ramp_cost(tools, args, &size, options, &rows)?,
        _ => None,
    };
    let accelerates = args.accel.as_ref().map(|accel| {
        let jerk = args.jerk.as_ref().map_or_else(String::new, |jerk| format!(" --jerk {jerk}"));
        (format!("--accel {accel}{jerk}"), args.clock_hz)
    });
    let mut answer = Answer { size, rows, left_out, accelerates, tools, ramp_cost, beaten: None };
    if args.pareto {
        pareto::keep_unbeaten(&mut answer);
    }
    match args.json {
        true => output::print_data(&json::all(&answer)),
        false => output::print(&text::all(&answer, args.markdown)),
    }
}

/// Methods that cannot be had, and why.
type LeftOut = Vec<(&'static str, String)>;

/// The dimensions of every method.
fn found(args: &MachineArgs, size: &Size, models: Vec<&'static Model>) -> Result<(Vec<Dimensions>, LeftOut), Error> {
    let progress = Progress::new("geometries");
    let tick = |more| progress.add(more);
    let one = |model: &'static Model| (model, dimensions(model, &size.travel, size.feed, args.clock_hz, &tick));
    let all: Vec<_> = models.into_par_iter().map(one).collect();
    let (mut rows, mut left_out) = (Vec::new(), Vec::new());
    for (model, found) in all {
        match found {
            Ok(found) => rows.push(found),
            Err(error @ (ProofError::Model(_) | ProofError::Box(_))) => left_out.push((model.name, error.to_string())),
            Err(error) => return Err(error.into()),
        }
    }
    progress.finish();
    match left_out.first().filter(|_| rows.is_empty()) {
        Some((_, reason)) => {
            Err(Error::Invalid(format!("no method can be had for such a machine; the first: {reason}")))
        }
        None => Ok((rows, left_out)),
    }
}

/// The options of a machine that accelerates, if it does.
fn ramp_options(args: &MachineArgs) -> Result<Option<Options>, Error> {
    let Some(accel) = &args.accel else { return Ok(None) };
    let jerk = args.jerk.iter().flat_map(|jerk| ["--jerk", jerk]);
    let options = Options::parse(["--accel", accel].into_iter().chain(jerk));
    Ok(Some(options.map_err(|error| Error::Invalid(error.to_string()))?))
}

/// A move by each of them, run as a program; one after another on each core.
fn ramps(
    args: &MachineArgs,
    size: &Size,
    options: &Options,
    found: &[Dimensions],
) -> Result<Vec<Option<Ramped>>, Error> {
    let progress = Progress::of(found.len() as u64, "moves");
    let ramp = |found: &Dimensions| {
        let ramp = ramped(found, size, options, args.clock_hz)?;
        progress.add(1);
        Ok(ramp)
    };
    found.par_iter().map(ramp).collect()
}

/// What each of them costs, alone and in the machine that runs programs by it. Tools take one core each: two of them at a
/// time.
fn costs(
    tools: &Tools,
    args: &MachineArgs,
    size: &Size,
    found: &[Dimensions],
) -> Result<Vec<(Cost, Option<Whole>)>, Error> {
    let families = families(found);
    let progress = Progress::of((found.len() + families.len()) as u64, "methods placed");
    let alone = |found: &Dimensions| {
        let cost = tools.cost(found.model.name, &found.bench()?)?;
        progress.add(1);
        Ok(cost)
    };
    let program = |found: &&Dimensions| {
        let Some((machine, bench)) = whole(found, size, &Options::default(), args.clock_hz)? else { return Ok(None) };
        let cost = tools.cost_within(machine.name, &bench, MOST_SEEDS)?;
        progress.add(1);
        Ok(Some(Whole { machine, cost }))
    };
    let two = rayon::ThreadPoolBuilder::new().num_threads(2).build()?;
    let (costs, wholes) = two.install(|| {
        let costs: Result<Vec<Cost>, Error> = found.par_iter().map(alone).collect();
        let wholes: Result<Vec<Option<Whole>>, Error> = families.par_iter().map(program).collect();
        (costs, wholes)
    });
    let wholes: Vec<Whole> = wholes?.into_iter().flatten().collect();
    let of = |found: &Dimensions| {
        let machine = machine_of(found.model)?;
        wholes.iter().find(|whole| whole.machine.name == machine.name).copied()
    };
    Ok(costs?.into_iter().zip(found).map(|(cost, found)| (cost, of(found))).collect())
}

/// The first method of each family that has a machine for programs: that of lines, which are as long as the travel.
fn families(found: &[Dimensions]) -> Vec<&Dimensions> {
    let mut seen = BTreeSet::new();
    found.iter().filter(|found| machine_of(found.model).is_some_and(|machine| seen.insert(machine.name))).collect()
}

/// What a ramp costs, by the smallest machine that runs programs; its multipliers keep Yosys busy for a minute or more, and nothing is
/// placed.
fn ramp_cost(
    tools: &Tools,
    args: &MachineArgs,
    size: &Size,
    options: &Options,
    rows: &[Row],
) -> Result<Option<RampCost>, Error> {
    let wholes = rows.iter().filter_map(|row| Some((&row.found, row.whole.as_ref()?)));
    let Some((found, Whole { machine, cost })) = wholes.min_by_key(|(_, whole)| whole.cost.luts) else {
        return Ok(None);
    };
    let Some((_, bench)) = whole(found, size, options, args.clock_hz)? else { return Ok(None) };
    let with = tools.cost_within(machine.name, &bench, 0)?;
    Ok(Some(RampCost { machine, without: *cost, with }))
}

/// The travel in whole BLU, rounded up, so that the machine is never too small.
#[allow(clippy::cast_possible_truncation)]
fn size(args: &MachineArgs) -> Result<Size, Error> {
    let blu = |mm: &f64| {
        // What a quotient of decimal numbers is too much.
        let units = (mm / args.blu - 1e-6).ceil().max(1.0);
        if units > COORDINATE_LIMIT as f64 {
            let sentence = format!("a travel of {mm} mm is {units} BLU, beyond 2^52: give a greater --blu");
            return Err(Error::Invalid(sentence));
        }
        Ok(units as i64)
    };
    let clock = args.clock_hz;
    if !(1e-3..=1e15).contains(&clock) {
        return Err(Error::Invalid(format!("--clock-hz {clock} is not a clock: give 0.001 to 1e15 Hz, such as 1e6")));
    }
    if !(1e-6..=1e9).contains(&args.feed) {
        return Err(Error::Invalid(format!("a feed of {} mm/min is out of range: give 1e-6 to 1e9 mm/min", args.feed)));
    }
    let travel: Vec<i64> = args.travel.0.iter().map(blu).collect::<Result<_, _>>()?;
    Ok(Size { travel, feed: args.feed / 60.0 / args.blu, blu_mm: args.blu })
}

/// The methods that are named, or all that take such a travel.
fn models(args: &MachineArgs, travel: &[i64]) -> Result<Vec<&'static Model>, Error> {
    if args.models.is_empty() {
        return Ok(installed().iter().filter(|model| takes(model, travel)).collect());
    }
    let bench = BenchArgs::default();
    let mut named = args.models.iter().map(|word| bench.model(word)).collect::<Result<Vec<_>, _>>()?;
    let mut seen = BTreeSet::new();
    named.retain(|model| seen.insert(model.name));
    match named.iter().find(|model| !takes(model, travel)) {
        Some(model) => Err(Error::Invalid(format!(
            "{} is not a method of lines of {} axes or of arcs alone: leave it out",
            model.name,
            travel.len()
        ))),
        None => Ok(named),
    }
}
