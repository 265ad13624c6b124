//! Random netlists for another simulator: `random_verilog DIR COUNT` writes, for each, the Verilog module `N.v`, its
//! test bench `N_tb.v` and the wave `N.vcd` of the engine `gates`. Always the same ones.
// The recipe of random netlists is test code.
#![allow(clippy::unwrap_used)]

#[path = "../tests/kernel/random/recipe.rs"]
mod recipe;

use std::error::Error;
use std::fs::{self, File};
use std::path::PathBuf;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngSeed, TestRunner};
use stepwave::kernel::engine::{EngineKind, Rows, Watch};
use stepwave::kernel::export::{self, Options, Step, Stimulus};
use stepwave::kernel::trace::probe::Selection;
use stepwave::kernel::trace::timescale::ClockTime;
use stepwave::kernel::trace::vcd::VcdHeader;
use stepwave::kernel::{Design, Net, elaborate};

/// Changes of the inputs.
const STEPS: usize = 24;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let dir = PathBuf::from(words.next().ok_or("give a folder")?);
    let count: u64 = words.next().ok_or("give a number of netlists")?.parse()?;
    fs::create_dir_all(&dir)?;
    let config = Config { rng_seed: RngSeed::Fixed(0x57e9), failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new(config);
    for number in 0..count {
        let netlist = recipe::build(&draw(&recipe::recipe(), &mut runner)?);
        let design = elaborate(netlist)?;
        let stimulus = stimulus(&design, &mut runner)?;
        let time = ClockTime::from_hz(1e6)?;
        let outputs: Vec<Net> = design.netlist().properties.iter().map(|property| property.never).collect();
        let options = Options { comment: &[format!("random netlist {number}")], outputs: &outputs };
        let file = |ending: &str| dir.join(format!("{number}{ending}"));
        fs::write(file(".v"), export::verilog(&design, &options))?;
        let bench = export::testbench(&design, &options, &stimulus, time, &format!("{number}_tb.vcd"));
        fs::write(file("_tb.v"), bench)?;
        wave(&design, &stimulus, time, File::create(file(".vcd"))?)?;
    }
    Ok(())
}

fn draw<S: Strategy>(strategy: &S, runner: &mut TestRunner) -> Result<S::Value, Box<dyn Error>> {
    let tree = strategy.new_tree(runner).map_err(|reason| reason.message().to_owned())?;
    Ok(tree.current())
}

/// Random values on random inputs, each for a few clocks.
fn stimulus(design: &Design, runner: &mut TestRunner) -> Result<Stimulus, Box<dyn Error>> {
    let mut steps = Vec::new();
    for index in 0..STEPS {
        let mut set = Vec::new();
        for &input in design.inputs() {
            let (value, changes) = draw(&(recipe::value(), 0u8..3), runner)?;
            if index == 0 || changes > 0 {
                set.push((input, value & design.netlist().width(input).mask()));
            }
        }
        steps.push(Step { set, clocks: Some(draw(&(1u64..4), runner)?) });
    }
    Ok(Stimulus { steps, done: None, never: Vec::new(), stall: None })
}

fn wave(design: &Design, stimulus: &Stimulus, time: ClockTime, out: File) -> Result<(), Box<dyn Error>> {
    let mut columns: Vec<Net> = design.netlist().names.iter().map(|named| named.net).collect();
    columns.sort_unstable();
    columns.dedup();
    let probes = Selection::default().probes(design, &columns)?;
    let mut body = VcdHeader { comment: "random netlist", probes: &probes, time, clk: true }.write(out)?;
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
    body.rows(&rows, 0..rows.len())?;
    body.finish()?;
    Ok(())
}
