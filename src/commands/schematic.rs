//! `stepwave export --schematic`: a netlist as a block diagram.

use std::path::Path;

use crate::Error;
use crate::cli::ExportArgs;
use crate::netlist::{Design, Net};
use crate::output::{self, Outputs};
use crate::own::{is_netlist, read_netlist};
use crate::schematic::{self, Part};

use super::export::source_files;
use super::geometry;

/// The netlist that is to be drawn as it is, without a bench file that says what it does: where nothing else is asked for.
pub(super) fn alone(args: &ExportArgs) -> Option<&Path> {
    let ExportArgs { netlist, verilog, testbench, harness, btor2, smt2, .. } = args;
    let others = [netlist, verilog, testbench, harness, btor2, smt2].iter().any(|file| file.is_some());
    let described = args.bench.bench.is_some() || geometry::given(&args.geometry).is_some();
    let file = args.model.as_deref().filter(|model| is_netlist(model) && !others && !described)?;
    args.schematic.as_ref().map(|_| Path::new(file))
}

/// Draws a netlist of which nothing else is known: what its top does not read is an output.
pub(super) fn of_netlist(args: &ExportArgs, file: &Path) -> Result<(), Error> {
    if let Some(option) = args.hardware.first_given() {
        return Err(Error::Invalid(format!(
            "{} is drawn as it is: leave --{option} out, or give a geometry for its bench file",
            file.display()
        )));
    }
    let design = read_netlist(file)?;
    let mut files = Outputs::reading(source_files(&design).iter().chain([&file.to_path_buf()]));
    let outputs = schematic::outputs(design.netlist());
    let Some(path) = &args.schematic else { return Ok(()) };
    let notes = crate::own::summary(&design) + "\n" + &draw(args, &design, &outputs, path, &mut files)?;
    let quiet = args.by_ending.quiet || files.uses_stdout();
    files.commit()?;
    if quiet { Ok(()) } else { output::print(&notes) }
}

/// Writes the drawing; what is to be said of it.
pub(super) fn draw(
    args: &ExportArgs,
    design: &Design,
    outputs: &[Net],
    path: &Path,
    files: &mut Outputs,
) -> Result<String, Error> {
    let part = Part { scope: args.scope.clone(), depth: args.levels, most: None };
    let drawn = schematic::draw(design.netlist(), outputs, &part)?;
    files.write(path, &drawn.svg)?;
    let closed = drawn.closed().map_or_else(String::new, |closed| format!(", {closed}"));
    let symbols = if drawn.symbols == 1 { "symbol" } else { "symbols" };
    Ok(format!("the block diagram has {} {symbols}{closed}\n", drawn.symbols))
}
