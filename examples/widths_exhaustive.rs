//! Compares the ranges that `stepwave widths` reports with those of single runs of one engine over every geometry of a
//! box: `cargo run --release --example widths_exhaustive -- MODEL K [word|compiled|gates]`. Exit code 1 where they differ.
//!
//! All lines from the origin and all arcs inside a quadrant are run up to K = 8, all conics too, but for `dda-conic` up to
//! 6, and all helices up to 4; of more bits the extreme ones are compared, and the line says so.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for a terminal")]

use std::process::ExitCode;
use std::time::Instant;

use stepwave::engine::EngineKind;
use stepwave::models::{Options, find};
use stepwave::study::widths::{ranges_alone, simulated};
use stepwave::study::{Extent, Geometries};
use stepwave::testbench::Testbench;

fn compare(model: &str, k: &str, engine: EngineKind) -> Result<bool, Box<dyn std::error::Error>> {
    let (model, choices, extent) = (find(model)?, Options::default(), k.parse::<Extent>()?);
    let start = Instant::now();
    let own = Geometries::of(model, &choices, &extent)?;
    let found = simulated(model, &choices, &extent, own.clone(), &|_| {})?;
    let lanes = start.elapsed();
    let bench = Testbench::of_hardware(model, own.hardware)?;
    let start = Instant::now();
    let alone = ranges_alone(model, &bench, &own.curves, engine)?;
    let (runs, many) = (own.curves.len(), if own.all { "all" } else { "some" });
    let mut same = true;
    for register in &found.registers {
        if alone.get(&register.name) != Some(&register.range) {
            same = false;
            println!(
                "{}: {} is {:?} alone, {:?} in lanes",
                model.name,
                register.name,
                alone.get(&register.name),
                register.range
            );
        }
    }
    let word = if same { "the same ranges" } else { "other ranges" };
    let (lanes, single) = (lanes.as_secs_f64(), start.elapsed().as_secs_f64());
    let (name, registers, faults) = (model.name, found.registers.len(), found.faults);
    println!(
        "{name} {k}: {runs} runs, {many} of the box, {registers} registers, {faults} faults: {word}; lanes and proof {lanes:.1} s, single runs {single:.1} s"
    );
    Ok(same)
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (engine, words) = match words.as_slice() {
        [model, k] => (EngineKind::Compiled, [model, k]),
        [model, k, engine] if engine == "compiled" => (EngineKind::Compiled, [model, k]),
        [model, k, engine] if engine == "word" => (EngineKind::Word, [model, k]),
        [model, k, engine] if engine == "gates" => (EngineKind::Gates, [model, k]),
        _ => {
            eprintln!("usage: widths_exhaustive MODEL K [compiled|word|gates]");
            return ExitCode::from(2);
        }
    };
    match compare(words[0], words[1], engine) {
        Ok(same) => ExitCode::from(u8::from(!same)),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}
