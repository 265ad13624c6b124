//! `stepwave run`.

use std::io::Write;
use std::path::Path;

use stepwave::kernel::trace::gtkw::{View, side_files};
use stepwave::kernel::trace::probe::{Probe, Selection};
use stepwave::kernel::trace::timescale::ClockTime;
use stepwave::kernel::trace::vcd::VcdHeader;
use stepwave::models::{CurveKind, Model, find};
use stepwave::nc::{Arc, Curve, Direction, Line};
use stepwave::report::plot::Plot;
use stepwave::report::{self, CsvTable, Report, TEXTBOOK_STEPS, TextbookTable};
use stepwave::testbench::{
    Observer, ObserverError, OverflowWatch, PathWatch, RangeWatch, Step, Testbench, Trigger, WaveWriter, Window,
};

use super::progress::Progress;
use crate::cli::{GeometryArgs, RunArgs, TraceArgs};
use crate::failure::Failure;
use crate::output::{self, Outputs, Sink};

/// Runs a model and writes what was asked for.
pub(crate) fn run(args: &RunArgs) -> Result<(), Failure> {
    let mut outputs = Outputs::default();
    let finished = simulate(args, &mut outputs)?;
    let quiet = outputs.uses_stdout();
    outputs.commit()?;
    if !quiet {
        output::print(&finished.text)?;
    }
    if finished.failures.is_empty() { Ok(()) } else { Err(Failure::Check(finished.failures)) }
}

/// A run whose outputs are staged.
pub(crate) struct Finished {
    /// Step table and summary for the terminal.
    pub(crate) text: String,
    /// What is wrong with the simulated hardware.
    pub(crate) failures: Vec<String>,
}

/// Simulates and stages every output.
///
/// # Errors
/// Bad input, or an output cannot be written; nothing stands under a final name.
pub(crate) fn simulate(args: &RunArgs, outputs: &mut Outputs) -> Result<Finished, Failure> {
    let model = find(&args.model)?;
    let curve = curve(model, &args.geometry)?;
    let bench = Testbench::new(model, &curve, &args.hardware.choices())?;
    let time = ClockTime::from_hz(args.hardware.clock_hz)?;
    let title = report::title(model, bench.hardware(), &curve);

    let mut wave = args.trace.vcd.as_deref().map(|path| Wave::new(&bench, &args.trace, path, time, &title, outputs));
    let mut wave = wave.take().transpose()?;
    let mut csv = match &args.outputs.steps {
        Some(path) => Some(CsvTable::new(&bench, outputs.open(path)?)?),
        None => None,
    };
    let mut json = args.outputs.json.as_deref().map(|path| outputs.open(path)).transpose()?;
    let mut picture = match &args.outputs.plot {
        Some(path) => Some((Picture(Plot::new(&curve)), outputs.open(path)?)),
        None => None,
    };
    let (mut overflow, mut ranges) = (OverflowWatch::new(&bench), RangeWatch::new(&bench));
    let (mut path, mut table) = (PathWatch::new(&curve), TextbookTable::new(&bench, args.outputs.bits));
    let mut progress = Progress::new();

    let mut observers: Vec<&mut dyn Observer> = vec![&mut overflow, &mut ranges, &mut path, &mut table, &mut progress];
    observers.extend(wave.as_mut().map(|wave| &mut wave.writer as &mut dyn Observer));
    observers.extend(csv.as_mut().map(|csv| csv as &mut dyn Observer));
    observers.extend(picture.as_mut().map(|(picture, _)| picture as &mut dyn Observer));
    let outcome = bench.run(args.hardware.engine, &mut observers)?;
    drop(observers);
    progress.finish();

    let report = Report {
        model,
        curve: &curve,
        hardware: bench.hardware(),
        engine: args.hardware.engine,
        outcome,
        ranges: ranges.finish(),
        worst: path.worst,
        overflows: overflow.events,
        overflow_count: overflow.count,
        clock_hz: args.hardware.clock_hz,
        blu_mm: args.hardware.blu,
    };
    if let Some(wave) = wave {
        wave.finish(&report, outputs)?;
    }
    if let Some(csv) = csv {
        csv.finish()?;
    }
    if let Some(sink) = &mut json {
        writeln!(sink, "{:#}", report.json())?;
        sink.flush()?;
    }
    if let Some((Picture(mut plot), mut sink)) = picture {
        if let Some(event) = report.overflows.first() {
            plot.mark(&format!("overflow of {}", event.component()));
        }
        sink.write_all(plot.svg(&title_of_picture(&report)).as_bytes())?;
        sink.flush()?;
    }
    Ok(Finished { text: text(&report, &table), failures: report.failures() })
}

fn title_of_picture(report: &Report<'_>) -> String {
    format!("{}: {}", report.model.name, report::geometry(report.curve))
}

fn text(report: &Report<'_>, table: &TextbookTable) -> String {
    let table = table.render().unwrap_or_else(|| {
        format!("more than {TEXTBOOK_STEPS} steps: --steps FILE writes the step table, --plot FILE draws the path\n")
    });
    format!("{table}\n{}", report.summary())
}

/// The curve that the options give.
fn curve(model: &Model, args: &GeometryArgs) -> Result<Curve, Failure> {
    let trouble = |sentence: String| Err(Failure::Trouble(sentence));
    let Some(to) = &args.to else {
        return trouble(format!("the end point is missing: {} takes {}", model.name, model.curve.describe()));
    };
    let direction = match (args.cw, args.ccw) {
        (true, _) => Some(Direction::Clockwise),
        (_, true) => Some(Direction::CounterClockwise),
        _ => None,
    };
    let origin = |axes: usize| vec![0; axes];
    match model.curve {
        CurveKind::Line { .. } => {
            if direction.is_some() || args.center.is_some() {
                let what = if args.center.is_some() { "--center" } else { "--cw or --ccw" };
                return trouble(format!("{} interpolates lines, which have no {what}: leave it out", model.name));
            }
            let from = args.from.as_ref().map_or_else(|| origin(to.0.len()), |from| from.0.clone());
            Ok(Curve::Line(Line::new(from, to.0.clone())?))
        }
        CurveKind::Arc => {
            let Some(direction) = direction else {
                return trouble(format!("the direction of the arc is missing: give {} --cw or --ccw", model.name));
            };
            let plane = |name: &str, point: &[i64]| match *point {
                [x, y] => Ok([x, y]),
                _ => Err(Failure::Trouble(format!(
                    "{name} of an arc has {} coordinates, but {} works in the plane: give X,Y",
                    point.len(),
                    model.name
                ))),
            };
            let given = |name: &str, point: &Option<_>| match point {
                Some(crate::cli::Point(point)) => plane(name, point),
                None => Ok([0, 0]),
            };
            let (from, center) = (given("--from", &args.from)?, given("--center", &args.center)?);
            Ok(Curve::Arc(Arc::new(from, plane("--to", &to.0)?, center, direction)?))
        }
    }
}

/// A wave that is being written.
struct Wave<'a> {
    writer: WaveWriter<Sink>,
    probes: Vec<Probe>,
    path: &'a Path,
    clk: bool,
    time: ClockTime,
}

impl<'a> Wave<'a> {
    fn new(
        bench: &Testbench,
        args: &TraceArgs,
        path: &'a Path,
        time: ClockTime,
        title: &str,
        outputs: &mut Outputs,
    ) -> Result<Wave<'a>, Failure> {
        let depth = args.trace_depth.map(|depth| usize::try_from(depth).unwrap_or(usize::MAX));
        let selection = Selection::new(&args.trace, &args.trace_exclude, depth)?;
        let probes = selection.probes(bench.design(), bench.columns().nets())?;
        let trigger = match &args.trace_on {
            Some(name) => Trigger::Column(flag_column(bench, name)?),
            None => Trigger::Immediately,
        };
        let window = Window { from: args.trace_from, to: args.trace_to, trigger };
        let header = VcdHeader { comment: title, probes: &probes, time, clk: !args.no_clk };
        let writer = WaveWriter::new(header.write(outputs.open(path)?)?, window);
        Ok(Wave { writer, probes, path, clk: !args.no_clk, time })
    }

    /// Ends the wave and stages the files beside it.
    fn finish(self, report: &Report<'_>, outputs: &mut Outputs) -> Result<(), Failure> {
        let Some((first_clock, last_clock)) = self.writer.written else {
            return Err(Failure::Trouble(format!(
                "the wave would be empty: no clock from 0 to {} of this run falls into its window",
                report.outcome.clocks
            )));
        };
        self.writer.finish()?;
        if self.path == Path::new("-") {
            return Ok(());
        }
        let text = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        let marks: Vec<(u64, String)> = report
            .overflows
            .iter()
            .filter(|event| (first_clock..=last_clock).contains(&event.clock()))
            .take(1)
            .map(|event| (event.clock(), "overflow".to_owned()))
            .collect();
        let view = View {
            dump_name: &text(self.path.file_name()),
            stem: &text(self.path.file_stem()),
            probes: &self.probes,
            clk: self.clk,
            time: self.time,
            last_clock,
            marks: &marks,
        };
        for file in side_files(&view) {
            outputs.write(&self.path.with_file_name(&file.name), &file.text)?;
        }
        Ok(())
    }
}

/// Column of a 1-bit net.
fn flag_column(bench: &Testbench, name: &str) -> Result<usize, Failure> {
    let netlist = bench.design().netlist();
    let Some(named) = netlist.find(name) else {
        return Err(Failure::Trouble(format!("--trace-on: there is no signal '{name}' in this netlist")));
    };
    if netlist.width(named.net).get() != 1 {
        let width = netlist.width(named.net);
        return Err(Failure::Trouble(format!("--trace-on: {name} has {width}, but a trigger is 1 bit wide")));
    }
    Ok(bench.columns().index(named.net))
}

/// Hands every position to the picture.
struct Picture(Plot);

impl Observer for Picture {
    fn step(&mut self, step: &Step) -> Result<(), ObserverError> {
        self.0.point(&step.position);
        Ok(())
    }
}
