//! stepwave against Verilator, CXXRTL (Yosys) and Icarus Verilog in one run, on the Verilog that it exports and on lean
//! RTL written by hand (`lean`).
//!
//! `cargo bench --bench peers [-- [--quick] [SECTION…] [MODEL…]]` prints tables in Markdown, `-- --help` what there is;
//! `.ci/bench-tools` installs the peers on Debian.
//!
//! All contenders load the same block, run it to its end, and must come to the same clock and the same place; the waves
//! of short runs are compared signal by signal. They take turns, round by round, and medians are reported. One core is
//! left to each, another one every round, except where more are named; rates count processor time, which other programs
//! on the machine hardly disturb, of the whole process.
// Like a test, it stops at anything unexpected.
#![allow(clippy::print_stdout, clippy::print_stderr)]

#[cfg(target_os = "linux")]
mod choice;
#[cfg(target_os = "linux")]
mod contender;
#[cfg(target_os = "linux")]
mod cores;
#[cfg(target_os = "linux")]
mod cxxrtl;
#[cfg(target_os = "linux")]
mod growth;
#[cfg(target_os = "linux")]
mod icarus;
#[cfg(target_os = "linux")]
mod lean;
#[cfg(target_os = "linux")]
mod measure;
#[cfg(target_os = "linux")]
mod own;
#[cfg(target_os = "linux")]
mod plot;
#[cfg(target_os = "linux")]
mod rtl;
#[cfg(target_os = "linux")]
mod sections;
#[cfg(target_os = "linux")]
mod synthetic;
#[cfg(target_os = "linux")]
mod table;
#[cfg(target_os = "linux")]
mod unit;
#[cfg(target_os = "linux")]
mod verilator;

use std::process::ExitCode;

/// Any failure.
type Fallible<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

#[cfg(target_os = "linux")]
fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let done = match words.first().map(String::as_str) {
        Some("--measure") => measure::child(&words[1..]),
        Some(kind @ ("--engine" | "--cells" | "--core" | "--lanes" | "--bare-lanes")) => {
            own::as_child(kind, &words[1..]).map(|text| print!("{text}"))
        }
        _ if words.iter().any(|word| word == "--help" || word == "-h") => {
            print!("{}", choice::help());
            Ok(())
        }
        _ => sections::all(&words),
    };
    if let Err(error) = done {
        eprintln!("peers: {error}");
        return ExitCode::from(2);
    }
    ExitCode::SUCCESS
}

#[cfg(not(target_os = "linux"))]
fn main() -> ExitCode {
    println!("processor time and memory of other programs are read the Linux way");
    ExitCode::SUCCESS
}
