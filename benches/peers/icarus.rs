//! Icarus Verilog: the test bench that `stepwave export` writes, and a second top module that prints the result.

use std::fs;
use std::path::Path;

use stepwave::testbench::Testbench;

use crate::Fallible;
use crate::contender::{Wave, shell};
use crate::measure::Job;
use crate::unit::Unit;

fn compile(unit: &Unit, bench: &Testbench, dir: &Path) -> Fallible<String> {
    fs::create_dir_all(dir)?;
    fs::write(dir.join("model.v"), unit.verilog())?;
    fs::write(dir.join("model_tb.v"), unit.testbench(bench)?)?;
    Ok(format!("iverilog -g2005 -s {}_tb -s result -o model.vvp model_tb.v model.v", unit.name()))
}

/// The result among what the simulator says.
fn says(text: &str) -> Fallible<String> {
    let result = text.lines().find(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    Ok(result.ok_or_else(|| format!("no result: {text}"))?.to_owned())
}

/// A job that runs the block of a test bench, compiled already.
pub(crate) fn run(unit: &Unit, bench: &Testbench, dir: &Path, wave: Wave) -> Fallible<Job> {
    shell(dir, &compile(unit, bench, dir)?)?;
    let format = match wave {
        Wave::None => "-none",
        Wave::Vcd => "-vcd",
        Wave::Fst => "-fst",
    };
    Ok(Job::new("Icarus", dir, &["vvp", "-n", "model.vvp", format]).says(says))
}

/// A job from the source to the wave.
pub(crate) fn first_wave(unit: &Unit, bench: &Testbench, dir: &Path) -> Fallible<Job> {
    let all = format!("{} && vvp -n model.vvp", compile(unit, bench, dir)?);
    Ok(Job::new("Icarus", dir, &["sh", "-c", &all]).says(says))
}
