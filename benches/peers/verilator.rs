//! Verilator: a C++ main that holds the clock loop around its model.

use std::fs;
use std::path::Path;

use crate::Fallible;
use crate::contender::{Wave, shell};
use crate::measure::Job;
use crate::rtl::Rtl;

const MAIN: &str = include_str!("verilator.cpp");

/// Optimised as its manual advises for speed.
const FAST: &str = "-O3 -march=native -flto";
/// Built soonest.
const SOON: &str = "-O0";
/// Cells from which a model is cut into files and functions, as its manual advises where a C++ compiler takes too long, and
/// linked without a look across them.
const LARGE: usize = 50_000;
const SPLIT: &str = "--output-split 5000 --output-split-cfuncs 500";
const FAST_LARGE: &str = "-O2 -march=native";

/// The commands that build `obj/Vmodel` from `model.v`; `split` cuts it up.
fn commands(rtl: &Rtl, wave: Wave, optimise: &str, split: &str) -> String {
    let (trace, define) = match wave {
        Wave::None => ("", ""),
        Wave::Vcd => ("--trace", "-CFLAGS -DWAVE_VCD"),
        Wave::Fst => ("--trace-fst", "-CFLAGS -DWAVE_FST"),
    };
    format!(
        "rm -rf obj && verilator --cc --exe -O3 --x-assign fast --x-initial fast --noassert -Wno-fatal \
         --timescale 100ns/100ns --top-module {} --prefix Vmodel --Mdir obj {split} {trace} {define} -CFLAGS -I.. \
         -LDFLAGS '{optimise}' main.cpp model.v >verilator.log 2>&1 && \
         make -j -C obj -f Vmodel.mk OPT_FAST='{optimise}' OPT_SLOW='{optimise}' OPT_GLOBAL='{optimise}' \
         >>verilator.log 2>&1",
        rtl.name
    )
}

fn write(rtl: &Rtl, dir: &Path, blocks: &str) -> Fallible<()> {
    rtl.write(dir, "Vmodel", str::to_owned)?;
    fs::write(dir.join("main.cpp"), MAIN)?;
    Ok(fs::write(dir.join("blocks"), blocks)?)
}

/// A job that runs blocks in a model that has been built.
pub(crate) fn run(rtl: &Rtl, dir: &Path, wave: Wave, blocks: &str) -> Fallible<Job> {
    write(rtl, dir, blocks)?;
    shell(dir, &commands(rtl, wave, FAST, ""))?;
    Ok(Job::new("Verilator", dir, &["obj/Vmodel", "blocks", "wave.vcd"]))
}

/// The same without a wave, or an error where it cannot be built within this time.
pub(crate) fn run_within(rtl: &Rtl, cells: usize, dir: &Path, blocks: &str, seconds: u64) -> Fallible<Job> {
    write(rtl, dir, blocks)?;
    let (optimise, split) = if cells < LARGE { (FAST, "") } else { (FAST_LARGE, SPLIT) };
    fs::write(dir.join("build.sh"), commands(rtl, Wave::None, optimise, split))?;
    shell(dir, &format!("timeout {seconds} sh build.sh"))?;
    Ok(Job::new("Verilator", dir, &["obj/Vmodel", "blocks", "wave.vcd"]))
}

/// A job from the source to the wave.
pub(crate) fn first_wave(rtl: &Rtl, dir: &Path, blocks: &str) -> Fallible<Job> {
    write(rtl, dir, blocks)?;
    let all = format!("{} && obj/Vmodel blocks wave.vcd", commands(rtl, Wave::Vcd, SOON, ""));
    Ok(Job::new("Verilator", dir, &["sh", "-c", &all]))
}
