//! `stepwave export`.

use std::path::Path;

use crate::export::{self, Checking, Options};
use crate::models::find;
use crate::netlist::{Design, Net};
use crate::report;
use crate::testbench::Testbench;
use crate::trace::timescale::ClockTime;

use super::geometry::{self, curve};
use crate::Error;
use crate::cli::ExportArgs;
use crate::output::{self, Outputs};

/// Last clock of a question to a solver where nothing is said and the run is longer.
const DEEPEST: u64 = 1000;

/// Writes a machine for other tools.
pub(crate) fn run(args: &ExportArgs) -> Result<(), Error> {
    let model = find(&args.model)?;
    let time = ClockTime::from_hz(args.clock.clock_hz)?;
    let curve = curve(model.name, model.curve(), &args.geometry, args.hardware.radii())?;
    let choices = geometry::choices(model, &curve, &args.hardware, args.clock.clock_hz);
    let bench = Testbench::loading(model, &curve, &choices).map_err(|error| args.hardware.told(error))?;
    let comment = [
        report::title(model, bench.hardware(), &curve),
        format!("Written by stepwave {}; the geometry gives the widths.", env!("CARGO_PKG_VERSION")),
    ];
    let outputs = bench.outputs();
    let options = Options { comment: &comment, outputs: &outputs };
    let mut files = Outputs::default();
    if let Some(path) = &args.verilog {
        files.write(path, &export::verilog(bench.design(), &options))?;
    }
    if let Some(path) = &args.testbench {
        let dump = dump_name(path, &bench.design().netlist().scopes[0].name);
        files.write(path, &export::testbench(bench.design(), &options, &bench.stimulus(), time, &dump))?;
    }
    let (design, held) = driven(&bench, &args.any_geometry)?;
    let checking = Checking { comment: &comment, held: &held };
    if let Some(path) = &args.btor2 {
        files.write(path, &export::btor2(&design, &checking))?;
    }
    let mut text = geometry::moved_center(&curve, &args.geometry).unwrap_or_default() + &summary(&bench);
    for word in bench.cut_words() {
        text += &format!("warning: {word}\n");
    }
    if let Some(path) = &args.smt2 {
        let depth = args.depth.or_else(|| bench.clocks_within(DEEPEST)).unwrap_or(DEEPEST);
        files.write(path, &export::smt2(&design, &checking, depth))?;
        text += &format!("asked is whether a property is violated in one of the clocks 0 to {depth}\n");
    }
    let quiet = files.uses_stdout();
    files.commit()?;
    if quiet { Ok(()) } else { output::print(&text) }
}

/// The machine with a loader, and the load words that are left open.
fn driven(bench: &Testbench, any: &[String]) -> Result<(Design, Vec<Net>), Error> {
    if any.is_empty() {
        return Ok((bench.driven()?, Vec::new()));
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

fn summary(bench: &Testbench) -> String {
    let (netlist, registers) = (bench.design().netlist(), bench.design().registers());
    let bits: u32 = registers.iter().map(|&register| netlist.width(register).get()).sum();
    format!(
        "{}: {} registers of {bits} bits together, {} inputs, {} outputs\n",
        netlist.scopes[0].name,
        registers.len(),
        bench.design().inputs().len(),
        bench.outputs().len()
    )
}
