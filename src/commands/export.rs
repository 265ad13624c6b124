//! `stepwave export`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::export::{self, Checking, Options, Stimulus};
use crate::models::CutWord;
use crate::netlist::cells::Source;
use crate::netlist::{Design, Net};
use crate::simulation::Simulation;
use crate::testbench::Testbench;
use crate::trace::timescale::ClockTime;

use super::geometry::{self, curve};
use super::schematic;
use crate::Error;
use crate::cli::ExportArgs;
use crate::output::{self, Outputs};

/// Last clock of a question to a solver where nothing is said and the run is longer.
const DEEPEST: u64 = 1000;

/// Writes a machine for other tools.
pub(crate) fn run(args: &ExportArgs) -> Result<(), Error> {
    if let Some(file) = schematic::alone(args) {
        return schematic::of_netlist(args, file);
    }
    let time = ClockTime::from_hz(args.clock.clock_hz)?;
    let (simulation, widths_by, moved) = match args.program.as_deref().zip(args.method.as_ref()) {
        Some((file, method)) => {
            let model = args.bench.machine(method)?;
            let ExportArgs { text, hardware, clock, .. } = args;
            (super::program::simulation(file, model, text, hardware, clock.clock_hz)?, "program", None)
        }
        None => {
            let (simulation, moved) = geometry(args)?;
            (simulation, "geometry", moved)
        }
    };
    let bench = simulation.prepare().map_err(|error| args.hardware.explain(error))?.bench;
    if let Some(option) = args.program.as_ref().and_then(|_| geometry::given(&args.geometry)) {
        return Err(Error::Invalid(format!("--program has the geometry: leave {option} out")));
    }
    let (title, stimulus, cut) = stimulus(&simulation, &bench)?;
    let outputs = if args.no_flags { bench.ports() } else { bench.outputs() };
    let mut notes = moved.unwrap_or_default() + &summary(&bench, outputs.len()) + &cut;
    let version = env!("CARGO_PKG_VERSION");
    let comment = [title, format!("Written by stepwave {version}; the {widths_by} gives the widths.")];
    let options = Options { comment: &comment, outputs: &outputs };
    let own = [args.bench.files(&args.model), args.bench.files_of(args.method.as_ref())].concat();
    let sources = source_files(bench.design());
    let mut files = Outputs::reading(args.program.iter().chain(&args.geometry.file()).chain(&own).chain(&sources));
    if let Some(path) = &args.netlist {
        files.write(path, &bench.design().netlist().to_string())?;
    }
    if let Some(path) = &args.verilog {
        files.write(path, &export::verilog(bench.design(), &options))?;
    }
    if let Some(path) = &args.harness {
        files.write(path, &export::harness(bench.design(), &options))?;
    }
    if let Some(path) = &args.testbench {
        let dump = dump_name(path, &bench.design().netlist().scopes[0].name);
        files.write(path, &export::testbench(bench.design(), &options, &stimulus, time, &dump))?;
    }
    if let Some(path) = &args.schematic {
        notes += &schematic::draw(args, bench.design(), &bench.ports(), path, &mut files)?;
    }
    let (design, held) = driven(&bench, &stimulus, &args.any_geometry)?;
    let checking = Checking { comment: &comment, held: &held };
    if let Some(path) = &args.btor2 {
        files.write(path, &export::btor2(&design, &checking)?)?;
    }
    if let Some(path) = &args.smt2 {
        let run = || match simulation.control(&bench)? {
            None => Ok::<_, Error>(bench.clocks_within(DEEPEST)),
            Some(mut control) => Ok(bench.clocks_within_fed(DEEPEST, &mut control)),
        };
        let depth = match args.depth {
            Some(depth) => depth,
            None => run()?.unwrap_or(DEEPEST),
        };
        files.write(path, &export::smt2(&design, &checking, depth)?)?;
        notes += &format!("asked is whether a property is violated in one of the clocks 0 to {depth}\n");
    }
    let quiet = args.by_ending.quiet || files.uses_stdout();
    files.commit()?;
    if quiet { Ok(()) } else { output::print(&notes) }
}

/// The files that hardware of one's own was imported from.
pub(super) fn source_files(design: &Design) -> BTreeSet<PathBuf> {
    let sources = design.netlist().sources.iter().flatten();
    let files = sources.filter_map(|source| match source {
        Source::File { file, .. } => Some(PathBuf::from(&**file)),
        Source::Rust { .. } => None,
    });
    files.collect()
}

/// A model with a geometry, and what is to be said of that.
fn geometry(args: &ExportArgs) -> Result<(Simulation, Option<String>), Error> {
    let model = args.bench.model(args.model.as_deref().unwrap_or_default())?;
    let curve = curve(model.name, model.curve(), &args.geometry, args.hardware.radii())?;
    let choices = geometry::choices(model, &curve, &args.hardware, args.clock.clock_hz);
    let moved = geometry::moved_center(&curve, &args.geometry);
    Ok((Simulation::new(model, curve).options(choices), moved))
}

/// The title of what is exported, what is to be done to the machine, and warnings about load words.
fn stimulus(simulation: &Simulation, bench: &Testbench) -> Result<(String, Stimulus, String), Error> {
    let mut report = simulation.report(bench);
    let stimulus = match simulation.control(bench)? {
        None => bench.stimulus(),
        Some(mut control) => {
            let stimulus = bench.stimulus_fed(&mut control)?;
            report.cut = control.cut;
            stimulus
        }
    };
    let warning = |(line, word): &(u64, CutWord)| match line {
        0 => format!("warning: {word}\n"),
        line => format!("warning: line {line}: {word}\n"),
    };
    Ok((report.title(), stimulus, report.cut.first.iter().map(warning).collect()))
}

/// The machine with a loader, and the load words that are left open.
fn driven(bench: &Testbench, stimulus: &Stimulus, any: &[String]) -> Result<(Design, Vec<Net>), Error> {
    if any.is_empty() {
        return Ok((bench.driven_by(stimulus)?, Vec::new()));
    }
    let known: Vec<String> = bench.load_words().map(str::to_owned).collect();
    if any == ["all"] {
        return Ok(bench.driven_by_any(&known)?);
    }
    match any.iter().find(|word| !known.contains(word)) {
        None => Ok(bench.driven_by_any(any)?),
        Some(word) => {
            let known = known.join(", ");
            Err(Error::Invalid(format!("--any-geometry={word}: there is no such load word; there are all, {known}")))
        }
    }
}

/// The wave that a test bench writes is named after it.
fn dump_name(testbench: &Path, design: &str) -> String {
    let stem = testbench.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let stem = stem.filter(|stem| stem != "-").unwrap_or_else(|| format!("{design}_tb"));
    format!("{stem}.vcd")
}

fn summary(bench: &Testbench, outputs: usize) -> String {
    let design = bench.design();
    format!(
        "{}: {} registers of {} bits together, {} inputs, {} outputs\n",
        design.netlist().scopes[0].name,
        design.registers().len(),
        design.register_bits(),
        design.inputs().len(),
        outputs
    )
}
