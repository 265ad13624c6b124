//! `stepwave prove F.net --box …`: a netlist with a bench file, or a model whose author claims nothing, over all geometries of
//! a box.

use super::{Progress, open_wave, tell};
use crate::cli::ProveArgs;
use crate::models::{CurveKind, Model, Options};
use crate::nc::Curve;
use crate::output::Outputs;
use crate::own::is_netlist;
use crate::report::run_command;
use crate::study::Extent;
use crate::study::exhausted::{Exhausted, exhausted};
use crate::{Error, Simulation};

/// Runs every geometry of the box.
pub(super) fn prove(args: &ProveArgs, name: &str, extent: &Extent) -> Result<(), Error> {
    if let Some(option) = args.netlist.given().or_else(|| args.of_proofs()) {
        return Err(Error::Invalid(format!(
            "{option} does not go with the geometries of a box, which are simulated: leave one of them out"
        )));
    }
    let model = args.bench.model(name)?;
    if model.curve() == CurveKind::Nurbs {
        return Err(Error::Invalid(format!(
            "no box of {name} is simulated whole, so that it proves nothing: `stepwave widths {name} --box 4` samples one"
        )));
    }
    let files = args.bench.files([&name.to_owned()]);
    if let Some(vcd) = &args.vcd {
        Outputs::reading(&files).claim(vcd)?;
    }
    let options = args.hardware.choices();
    let progress = Progress::new("geometries");
    let found = exhausted(model, &options, extent, &|more| progress.add(more));
    progress.finish();
    let Exhausted { simulated, all, example, why } = found.map_err(|error| args.hardware.explain_study(error))?;
    let what = model.curve().in_box();
    // Of a netlist no option changes the hardware.
    let choices = if is_netlist(name) { Vec::new() } else { options.words() };
    let of = match extent {
        Extent::Bits(_) => format!("with coordinates of {extent}"),
        Extent::Grid(grid) => format!("of the box {grid}"),
    };
    // The widths of a model follow from what it is planned for; those of a netlist do not.
    let planned = if is_netlist(name) { "" } else { ", on the one hardware that serves them all" };
    let hardware = format!("{}: {what}, {of}{planned}\n", [vec![model.name.to_owned()], choices].concat().join(" "));
    let Some(example) = example else {
        let what = "no operator loses a carry that is not announced, no assertion is violated, every end point is reached exactly";
        return if all {
            tell(args, &format!("{hardware}PROVED at these widths: {what} ({simulated} geometries, exhausted)\n"))
        } else {
            tell(args, &format!("{hardware}UNKNOWN: {simulated} extreme geometries were simulated\n"))?;
            let sentence = "not proved: the box has too many geometries to simulate all: give a smaller one";
            Err(Error::Check(vec![sentence.to_owned()]))
        };
    };
    let (sentences, wave) = shown(args, model, &options, (&example, &why), &files)?;
    let command = run_command(model, &example, &options);
    tell(args, &format!("{hardware}COUNTEREXAMPLE: {command}{wave}\n"))?;
    open_wave(args)?;
    Err(Error::Check(sentences))
}

/// What a run of a geometry says of it, with its wave if one is wanted.
fn shown(
    args: &ProveArgs,
    model: &'static Model,
    options: &Options,
    (example, why): (&Curve, &str),
    files: &[std::path::PathBuf],
) -> Result<(Vec<String>, String), Error> {
    let simulation = Simulation::new(model, example.clone()).options(options.clone()).waves(args.waves());
    let mut outputs = Outputs::reading(files);
    let report = simulation.run_on(simulation.prepare()?.bench, &mut outputs, |_, _| Ok(()))?.report;
    outputs.commit()?;
    let mut sentences = report.failures();
    sentences.extend(report.warnings());
    if sentences.is_empty() {
        // The hardware of the run is as wide as this geometry alone needs.
        sentences.push(format!("on the hardware of the whole box, which the run above does not have: {why}"));
    }
    let wave = args.vcd.as_ref().map_or_else(String::new, |path| format!(" --vcd {}", path.display()));
    Ok((sentences, wave))
}
