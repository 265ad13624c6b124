//! stepwave against Verilator, CXXRTL (Yosys) and Icarus Verilog on the Verilog that it exports, in one run.
//!
//! `cargo bench --bench peers [-- [--quick] [SECTION…]]` prints tables in Markdown; `.ci/bench-tools` installs the
//! peers on Debian. Sections: `first-wave`, `no-trace`, `waves`, `lanes`, `growth`, `cores`, the last after `.ci/import`, which
//! fetches the sources of the cores.
//!
//! All contenders load the same block, run it to its end, and must come to the same clock and the same place; the waves
//! of short runs are compared signal by signal. They take turns, round by round, and medians are reported. One core is
//! left to each, another one every round, except where more are named; rates count processor time, which other programs
//! on the machine hardly disturb, of the whole process.
// Like a test, it stops at anything unexpected.
#![allow(clippy::print_stdout, clippy::print_stderr)]

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
mod measure;
#[cfg(target_os = "linux")]
mod own;
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

/// Any failure.
type Fallible<T> = Result<T, Box<dyn std::error::Error + Send + Sync>>;

#[cfg(target_os = "linux")]
fn main() -> Fallible<()> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    match words.first().map(String::as_str) {
        Some("--measure") => measure::child(&words[1..]),
        Some(kind @ ("--engine" | "--cells" | "--core" | "--lanes" | "--bare-lanes")) => {
            print!("{}", own::as_child(kind, &words[1..])?);
            Ok(())
        }
        _ => sections::all(&words),
    }
}

#[cfg(not(target_os = "linux"))]
fn main() {
    println!("processor time and memory of other programs are read the Linux way");
}
