//! `stepwave import`, `check` and `sim`: hardware of one's own.

use std::io::Write as _;
use std::path::Path;

use super::view::View;
use crate::Error;
use crate::cli::{CheckArgs, ImportArgs, SimArgs};
use crate::netlist::cells::{Cell, Op};
use crate::netlist::elaborate;
use crate::output::{self, Outputs};
use crate::own::{
    Sim, Source, checked, loaded_then_assigned, read_netlist, read_stimulus, read_text, summary, yosys_json,
};

/// Most bytes of JSON.
const MOST_JSON: u64 = 1 << 31;

/// Writes the netlist of a design.
pub(crate) fn import(args: &ImportArgs) -> Result<(), Error> {
    let mut outputs = Outputs::reading(args.files.iter().chain(&args.json));
    let text = match &args.json {
        Some(path) => read_text(path, MOST_JSON)?,
        None => yosys_json(&Source {
            files: args.files.clone(),
            top: args.top.clone().unwrap_or_default(),
            parameters: args.param.clone(),
            include: args.include.clone(),
            define: args.define.clone(),
            trim: args.trim,
            yosys: args.yosys.clone(),
            ghdl: args.ghdl.clone(),
        })?,
    };
    // The module that Yosys marks as top has its parameters in its name.
    let top = args.json.as_ref().and(args.top.clone());
    let imported = stepwave_import::import(&text, &stepwave_import::Options { top, unknown: args.x })?;
    let design = elaborate(imported.netlist)?;
    let is_given = |cell: &Cell| matches!(cell.op, Op::Input | Op::Const(_));
    if args.trim && design.netlist().cells.iter().all(is_given) {
        let name = &design.netlist().scopes[0].name;
        return Err(Error::Invalid(format!(
            "--trim leaves nothing of {name}: no output depends on a register or an operator; leave --trim out"
        )));
    }
    outputs.write(&args.output, &design.netlist().to_string())?;
    let quiet = outputs.uses_stdout();
    outputs.commit()?;
    if quiet {
        return Ok(());
    }
    let mut text = summary(&design) + "\n";
    if let Some(clock) = imported.clock {
        let edge = if clock.rising { "rising" } else { "falling" };
        text += &format!("clock: the {edge} edge of {}\n", clock.name);
    }
    let texts = args.files.iter().filter_map(|file| std::fs::read_to_string(file).ok());
    let loads: Vec<String> = texts.flat_map(|text| loaded_then_assigned(&text)).collect();
    for note in imported.notes.into_iter().chain(loads) {
        text += &format!("note: {note}\n");
    }
    output::print(&text)
}

/// Lists the mistakes of a netlist.
pub(crate) fn check(args: &CheckArgs) -> Result<(), Error> {
    match checked(&args.file)? {
        Ok(design) => output::print(&(summary(&design) + "\n")),
        Err(mistakes) => {
            let file = args.file.display();
            Err(Error::Extract(mistakes.iter().map(|mistake| format!("{file}: {mistake}\n")).collect()))
        }
    }
}

/// Runs a netlist by a stimulus.
pub(crate) fn sim(args: &SimArgs) -> Result<(), Error> {
    if args.trace.steps {
        let file = args.file.display();
        return Err(Error::Invalid(format!(
            "--trace-steps: {file} has no steps, as it is not an interpolator; leave it out"
        )));
    }
    let design = read_netlist(&args.file)?;
    let stimulus = read_stimulus(&design, &args.set, args.stimulus.as_deref())?;
    let mut outputs = Outputs::reading([&args.file].into_iter().chain(&args.stimulus));
    let sim = Sim::new(design, stimulus, args.clocks)
        .engine(args.engine)
        .clock_hz(args.clock.clock_hz)
        .strict(args.strict.clone())
        .wraps(&args.wraps)?
        .waves(args.trace.clone())
        .json(args.json.clone());
    // What the hardware prints must not be mixed with a file.
    let files = [&args.trace.vcd, &args.trace.fst, &args.json];
    let view = View::new(&args.by_ending, &args.trace, None)?;
    let quiet = view.quiet || files.into_iter().flatten().any(|file| file == Path::new("-"));
    let mut screen = output::Screen::new(quiet);
    let report = sim.staged(&mut outputs, &mut screen)?;
    screen.flush()?;
    outputs.commit()?;
    if !quiet {
        output::print(&report.summary())?;
    }
    view.show()?;
    let failures = report.failures();
    if failures.is_empty() { Ok(()) } else { Err(Error::Check(failures)) }
}
