//! CXXRTL, the simulator that Yosys writes as C++: a C++ main that holds the clock loop around its model.

use std::fs;
use std::path::Path;

use crate::Fallible;
use crate::contender::{Wave, shell};
use crate::measure::Job;
use crate::rtl::Rtl;

const MAIN: &str = include_str!("cxxrtl.cpp");

const FAST: &str = "-O3 -march=native";
const SOON: &str = "-O0";

/// The commands that build `model` from `model.v`.
fn commands(rtl: &Rtl, wave: Wave, optimise: &str) -> String {
    let (debug, define) = if wave == Wave::Vcd { ("", "-DWAVE_VCD") } else { ("-g0", "") };
    format!(
        "yosys -q -p 'read_verilog model.v; hierarchy -top {}; write_cxxrtl {debug} model.cc' && \
         g++ -std=c++14 {optimise} {define} -I. -I$(yosys-config --datdir)/include -o model main.cpp",
        rtl.name
    )
}

fn write(rtl: &Rtl, dir: &Path, blocks: &str) -> Fallible<()> {
    let mangled = |name: &str| format!("p_{}", name.replace('_', "__").replace('.', "_2e_"));
    rtl.write(dir, &format!("cxxrtl_design::{}", mangled(&rtl.name)), mangled)?;
    fs::write(dir.join("main.cpp"), MAIN)?;
    Ok(fs::write(dir.join("blocks"), blocks)?)
}

/// A job that runs blocks in a model that has been built.
pub(crate) fn run(rtl: &Rtl, dir: &Path, wave: Wave, blocks: &str) -> Fallible<Job> {
    write(rtl, dir, blocks)?;
    shell(dir, &commands(rtl, wave, FAST))?;
    Ok(Job::new("CXXRTL", dir, &["./model", "blocks", "wave.vcd"]))
}

/// A job from the source to the wave.
pub(crate) fn first_wave(rtl: &Rtl, dir: &Path, blocks: &str) -> Fallible<Job> {
    write(rtl, dir, blocks)?;
    let all = format!("{} && ./model blocks wave.vcd", commands(rtl, Wave::Vcd, SOON));
    Ok(Job::new("CXXRTL", dir, &["sh", "-c", &all]))
}
