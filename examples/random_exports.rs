//! Random netlists for other tools, always the same ones: `random_exports DIR COUNT verilog|models` writes, for each,
//!
//! - `verilog`: the module `N.v`, its test bench `N_tb.v` and the wave `N.vcd` of the engine `gates`;
//! - `models`: `N.btor2` and `N.smt2` of the netlist with a loader that sets its inputs, what the engine makes of every
//!   named net as the table `N.csv` and as two questions to a solver, `N.same`, of which the first is to be answered with
//!   `sat` and the second with `unsat`, and in `N.first` the first clock in which a property is violated.
// The recipe of random netlists is test code.
#![allow(clippy::unwrap_used)]

#[path = "../tests/engine/random/recipe.rs"]
mod recipe;

use std::error::Error;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngSeed, TestRunner};
use stepwave::engine::{EngineKind, Rows, Watch};
use stepwave::export::{self, Checking, Options, Step, Stimulus};
use stepwave::netlist::cells::NamedNet;
use stepwave::netlist::{Bits, Design, Net, elaborate};
use stepwave::trace::WaveBody;
use stepwave::trace::probe::Selection;
use stepwave::trace::timescale::ClockTime;
use stepwave::trace::vcd::VcdHeader;

/// Changes of the inputs.
const STEPS: usize = 24;
/// The same for solvers, which copy the whole netlist for every clock.
const FEW_STEPS: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [dir, count, kind] = &words[..] else {
        return Err("give a folder, a number of netlists, verilog or models".into());
    };
    let (dir, count): (PathBuf, u64) = (PathBuf::from(dir), count.parse()?);
    let (write, steps): (Writer, usize) = match kind.as_str() {
        "verilog" => (verilog, STEPS),
        "models" => (models, FEW_STEPS),
        _ => return Err("give verilog or models".into()),
    };
    fs::create_dir_all(&dir)?;
    let config = Config { rng_seed: RngSeed::Fixed(0x57e9), failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new(config);
    for number in 0..count {
        // Model checkers and solvers take no memories.
        let design = loop {
            let design = elaborate(recipe::build(&draw(&recipe::recipe(), &mut runner)?))?;
            if kind == "verilog" || design.netlist().memories.is_empty() {
                break design;
            }
        };
        let stimulus = stimulus(&design, steps, &mut runner)?;
        write(&dir, number, &design, &stimulus)?;
    }
    Ok(())
}

/// Writes a design and what a stimulus makes of it.
type Writer = fn(&Path, u64, &Design, &Stimulus) -> Result<(), Box<dyn Error>>;

fn verilog(dir: &Path, number: u64, design: &Design, stimulus: &Stimulus) -> Result<(), Box<dyn Error>> {
    let time = ClockTime::from_hz(1e6)?;
    let outputs: Vec<Net> = design.netlist().properties.iter().map(|property| property.never).collect();
    let options = Options { comment: &[format!("random netlist {number}")], outputs: &outputs };
    let file = |ending: &str| dir.join(format!("{number}{ending}"));
    fs::write(file(".v"), export::verilog(design, &options))?;
    let bench = export::testbench(design, &options, stimulus, time, &format!("{number}_tb.vcd"));
    fs::write(file("_tb.v"), bench)?;
    wave(design, stimulus, time, File::create(file(".vcd"))?)
}

fn models(dir: &Path, number: u64, design: &Design, stimulus: &Stimulus) -> Result<(), Box<dyn Error>> {
    let netlist = design.netlist();
    let file = |ending: &str| dir.join(format!("{number}{ending}"));
    let driven = export::driven(design, stimulus, &[])?.design;
    let rows = run(design, stimulus, netlist.nets().collect());
    let checking = Checking { comment: &[format!("random netlist {number}")], held: &[] };
    fs::write(file(".btor2"), export::btor2(&driven, &checking)?)?;
    fs::write(file(".smt2"), export::smt2(&driven, &checking, rows.len() as u64 - 1)?)?;

    // A word of more than 64 bits has no term of its own there.
    let narrow = || netlist.names.iter().filter(|named| !named.is_wide());
    let mut table = narrow().map(|named| netlist.path(named)).collect::<Vec<_>>().join(",") + "\n";
    let mut equal = String::new();
    for (clock, row) in rows.iter() {
        let values: Vec<_> = narrow().map(|named| row[named.net.index()].to_string()).collect();
        table += &(values.join(",") + "\n");
        for named in netlist.names.iter().filter(|named| netlist.name_of(named.net) == Some(named)) {
            let value = Bits::truncated(netlist.width(named.net), row[named.net.index()]);
            equal += &format!(" (= {}@{clock} #b{value})", netlist.path(named));
        }
    }
    fs::write(file(".csv"), table)?;
    fs::write(file(".same"), format!("(check-sat)\n(assert (not (and{equal} true)))\n(check-sat)\n"))?;
    let violated = |row: &Vec<u64>| netlist.properties.iter().any(|property| row[property.never.index()] == 1);
    let first = rows.iter().find(|(_, row)| violated(row)).map_or("none".to_owned(), |(clock, _)| clock.to_string());
    fs::write(file(".first"), first + "\n")?;
    Ok(())
}

fn draw<S: Strategy>(strategy: &S, runner: &mut TestRunner) -> Result<S::Value, Box<dyn Error>> {
    let tree = strategy.new_tree(runner).map_err(|reason| reason.message().to_owned())?;
    Ok(tree.current())
}

/// Random values on random inputs, each for a few clocks.
fn stimulus(design: &Design, count: usize, runner: &mut TestRunner) -> Result<Stimulus, Box<dyn Error>> {
    let mut steps = Vec::new();
    for index in 0..count {
        let mut set = Vec::new();
        for &input in design.inputs() {
            let (value, changes) = draw(&(recipe::value(), 0u8..3), runner)?;
            if index == 0 || changes > 0 {
                set.push((input, value & design.netlist().width(input).mask()));
            }
        }
        steps.push(Step { set, clocks: Some(draw(&(1u64..4), runner)?) });
    }
    Ok(Stimulus { steps, done: Vec::new(), never: Vec::new(), always: false, stall: None })
}

fn wave(design: &Design, stimulus: &Stimulus, time: ClockTime, out: File) -> Result<(), Box<dyn Error>> {
    let mut columns: Vec<Net> = design.netlist().names.iter().flat_map(NamedNet::nets).collect();
    columns.sort_unstable();
    columns.dedup();
    let probes = Selection::default().probes(design, &columns)?;
    let mut body =
        VcdHeader { comment: "random netlist", probes: &probes, time, clk: true, states: false }.write(out)?;
    let rows = run(design, stimulus, columns);
    body.rows(&rows, 0..rows.len())?;
    body.finish()?;
    Ok(())
}

/// Every sample of these nets, from the engine that is the judge of all others.
fn run(design: &Design, stimulus: &Stimulus, columns: Vec<Net>) -> Rows {
    let mut rows = Rows::new(columns.len(), 4 * STEPS);
    let mut engine = EngineKind::Gates.build(design, &Watch { columns, stops: Vec::new() });
    for (index, step) in stimulus.steps.iter().enumerate() {
        for &(input, value) in &step.set {
            engine.set_input(input, value);
        }
        let clocks = step.clocks.unwrap_or(1);
        if index == 0 {
            engine.reset(&mut rows);
        }
        engine.run(if index == 0 { clocks - 1 } else { clocks }, &mut rows);
    }
    rows
}
