//! What hardware costs in an FPGA: lookup tables and flip-flops by Yosys, the highest clock by nextpnr, both from the
//! exported Verilog.
//!
//! One device and one seed for all, so that numbers can be compared; other seeds place otherwise and come some per cent
//! above or below.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::export::{self, Options};
use crate::output::temporary::{self, Folder};
use crate::testbench::Testbench;

/// The device as nextpnr is asked for it, the greatest of its family.
const DEVICE: [&str; 3] = ["--hx8k", "--package", "ct256"];
/// Its logic cells, each a lookup table of four inputs with a carry and a flip-flop.
const LOGIC_CELLS: u64 = 7680;
/// The seed of the placement.
const SEED: &str = "1";
/// Lines of a tool that fails which are shown.
const LAST: usize = 4;

/// Yosys: counts of the machine alone, then a netlist of the harness with the machine in it.
const SCRIPT: &str = "read_verilog machine.v
synth_ice40 -json machine.json
design -reset
read_verilog machine.v harness.v
synth_ice40 -json harness.json
";

/// Why a cost is not known.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SynthError {
    /// A tool is not there.
    #[error(
        "--synth ice40 needs Yosys and nextpnr for iCE40, and {tool} cannot be started ({error}): install the Debian \
         packages yosys and nextpnr-ice40"
    )]
    NoTool {
        /// Its command.
        tool: &'static str,
        /// Why.
        error: std::io::Error,
    },
    /// A tool ended with an error.
    #[error("{tool} fails at {model}: {last}")]
    Failed {
        /// Its command.
        tool: &'static str,
        /// Whose hardware it had.
        model: String,
        /// The last lines that it printed.
        last: String,
    },
    /// A file of a tool is not what it should be.
    #[error("{tool} writes something that cannot be read for {model}: {what}")]
    Unread {
        /// Its command.
        tool: &'static str,
        /// Whose hardware it had.
        model: String,
        /// What is wrong with it.
        what: String,
    },
    /// A temporary file cannot be written or read.
    #[error("cannot hand files to Yosys: {0}")]
    Io(#[from] std::io::Error),
}

/// The two tools, as they are installed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tools {
    /// Version of Yosys, as it says it.
    pub yosys: String,
    /// Version of nextpnr.
    pub nextpnr: String,
}

/// What a machine costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Lookup tables of four inputs (`SB_LUT4`).
    pub luts: u64,
    /// Flip-flops (`SB_DFF…`).
    pub flip_flops: u64,
    /// Carries of adders (`SB_CARRY`).
    pub carries: u64,
    /// Block memories (`SB_RAM40_4K`).
    pub rams: u64,
    /// The highest clock in Hz between registers, those of the harness too; `None` where the device does not hold it, or
    /// where there is nothing between registers.
    pub clock_hz: Option<f64>,
}

const YOSYS: &str = "yosys";
const NEXTPNR: &str = "nextpnr-ice40";

impl Tools {
    /// Asks both for their versions.
    ///
    /// # Errors
    /// One of them cannot be started.
    pub fn find() -> Result<Tools, SynthError> {
        let ask = |tool: &'static str, option: &str| -> Result<String, SynthError> {
            let said = Command::new(tool).arg(option).stdin(Stdio::null()).output();
            let said = said.map_err(|error| SynthError::NoTool { tool, error })?;
            Ok(version(&String::from_utf8_lossy(&[said.stdout, said.stderr].concat())))
        };
        Ok(Tools { yosys: ask(YOSYS, "-V")?, nextpnr: ask(NEXTPNR, "--version")? })
    }

    /// Device, package and seed in words.
    #[must_use]
    pub fn device() -> String {
        format!("iCE40 {} {}, seed {SEED}", DEVICE[0].trim_start_matches('-'), DEVICE[2])
    }

    /// What the machine of a model, in a bench, costs, without the flags of its properties: they are for the simulator, and widths that
    /// are known to be enough raise none. Takes seconds; ends its tools when this process is ended by a signal.
    ///
    /// # Errors
    /// A tool fails.
    pub fn cost(&self, model: &str, bench: &Testbench) -> Result<Cost, SynthError> {
        let folder = Folder::new()?;
        let at = |name: &str| folder.path().join(name);
        let outputs = bench.ports();
        let options = Options { comment: &[], outputs: &outputs };
        std::fs::write(at("machine.v"), export::verilog(bench.design(), &options))?;
        std::fs::write(at("harness.v"), export::harness(bench.design(), &options))?;
        std::fs::write(at("script.ys"), SCRIPT)?;
        run(YOSYS, &["-q", "-s", "script.ys"], model, folder.path())?;
        let unread = |tool, what| SynthError::Unread { tool, model: model.to_owned(), what };
        let read = |tool, name: &str| {
            let text = std::fs::read_to_string(at(name)).map_err(|error| unread(tool, error.to_string()))?;
            serde_json::from_str::<Value>(&text).map_err(|error| unread(tool, error.to_string()))
        };
        let cost = counted(&read(YOSYS, "machine.json")?);
        let whole = counted(&read(YOSYS, "harness.json")?);
        if cost.luts == 0 {
            return Err(unread(YOSYS, "there is no lookup table in it".to_owned()));
        }
        if [whole.luts, whole.flip_flops, whole.carries].iter().any(|count| *count > LOGIC_CELLS) {
            return Ok(cost);
        }
        let place = [&DEVICE[..], &["--seed", SEED, "--json", "harness.json", "--report", "report.json"]].concat();
        run(NEXTPNR, &[&place[..], &["--timing-allow-fail", "-q"]].concat(), model, folder.path())?;
        Ok(Cost { clock_hz: highest(&read(NEXTPNR, "report.json")?), ..cost })
    }
}

/// The version that a tool says: the word after `Yosys`, or what follows `Version`.
fn version(said: &str) -> String {
    let after = |word: &str| {
        let rest = said.split_once(word)?.1.trim_start();
        rest.split([' ', ')', '\n']).next().map(str::to_owned)
    };
    after("(Version ").or_else(|| after("Yosys ")).unwrap_or_else(|| "of unknown version".to_owned())
}

/// Cells of a netlist that Yosys wrote, by kind.
fn counted(netlist: &Value) -> Cost {
    let modules = netlist["modules"].as_object().into_iter().flatten();
    // Cells of the library are modules too, without anything in them.
    let cells = modules.flat_map(|(_, module)| module["cells"].as_object().into_iter().flatten());
    let mut counts = BTreeMap::new();
    for kind in cells.filter_map(|(_, cell)| cell["type"].as_str()) {
        *counts.entry(kind).or_insert(0u64) += 1;
    }
    let of = |prefix: &str| counts.iter().filter(|(kind, _)| kind.starts_with(prefix)).map(|(_, count)| count).sum();
    Cost {
        luts: of("SB_LUT4"),
        flip_flops: of("SB_DFF"),
        carries: of("SB_CARRY"),
        rams: of("SB_RAM40"),
        clock_hz: None,
    }
}

/// The highest clock in Hz of a report of nextpnr, which has MHz for each clock.
fn highest(report: &Value) -> Option<f64> {
    let clocks = report["fmax"].as_object().into_iter().flatten();
    let achieved = clocks.filter_map(|(_, clock)| clock["achieved"].as_f64()).reduce(f64::min);
    achieved.map(|mhz| mhz * 1e6)
}

/// Runs a tool to its end in a folder; nothing of what it prints is kept unless it fails.
fn run(tool: &'static str, words: &[&str], model: &str, folder: &Path) -> Result<(), SynthError> {
    let log = folder.join("log");
    let out = std::fs::File::create(&log)?;
    let mut command = Command::new(tool);
    command.args(words).current_dir(folder).stdin(Stdio::null()).stderr(out.try_clone()?).stdout(out);
    // A group of its own, which ends as a whole.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    let mut spawned = None;
    temporary::attend(&mut |running| {
        let child = spawned.insert(command.spawn());
        running.extend(child.as_ref().ok().map(std::process::Child::id));
    });
    let started = spawned.unwrap_or_else(|| Err(std::io::ErrorKind::Interrupted.into()));
    let mut child = started.map_err(|error| SynthError::NoTool { tool, error })?;
    ended(&child);
    temporary::attend(&mut |running| running.retain(|number| *number != child.id()));
    if child.wait()?.success() {
        return Ok(());
    }
    let mut said = Vec::new();
    std::fs::File::open(&log)?.read_to_end(&mut said)?;
    Err(SynthError::Failed { tool, model: model.to_owned(), last: last(&String::from_utf8_lossy(&said)) })
}

/// Waits until a process has ended, and keeps its number from others: once it was waited for, that may be another's.
#[cfg(unix)]
fn ended(child: &std::process::Child) {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let number = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
    if let Some(number) = number {
        let asked = || waitid(WaitId::Pid(number), WaitIdOptions::EXITED | WaitIdOptions::NOWAIT);
        while matches!(asked(), Err(rustix::io::Errno::INTR)) {}
    }
}

#[cfg(not(unix))]
fn ended(_: &std::process::Child) {}

/// The last lines that are not empty, in one.
fn last(said: &str) -> String {
    let lines: Vec<&str> = said.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    match &lines[lines.len().saturating_sub(LAST)..] {
        [] => "it says nothing".to_owned(),
        lines => lines.join(" / "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_those_that_the_tools_say() {
        assert_eq!(version("Yosys 0.23 (git sha1 7ce5011c24b)\n"), "0.23");
        let nextpnr = "\"nextpnr-ice40\" -- Next Generation Place and Route (Version 0.4-1+b1)\n";
        assert_eq!(version(nextpnr), "0.4-1+b1");
        assert_eq!(version("Yosys 0.52\n"), "0.52");
        assert_eq!(version("hello"), "of unknown version");
    }

    #[test]
    fn cells_are_counted_by_kind() {
        let cell = |kind: &str| serde_json::json!({ "hide_name": 1, "type": kind, "connections": { "O": [5] } });
        let netlist = serde_json::json!({ "creator": "Yosys 0.23", "modules": {
            "SB_DFF": { "attributes": { "blackbox": 1 }, "cells": {} },
            "ppc_line": { "cells": {
                "a": cell("SB_DFFESR"), "b": cell("SB_DFFSR"), "c": cell("SB_LUT4"), "d": cell("SB_LUT4"),
                "e": cell("SB_LUT4"), "f": cell("SB_CARRY"), "g": cell("SB_RAM40_4K"), "h": cell("SB_DFF"),
            } },
        } });
        let wanted = Cost { luts: 3, flip_flops: 3, carries: 1, rams: 1, clock_hz: None };
        assert_eq!(counted(&netlist), wanted);
    }

    #[test]
    fn the_highest_clock_is_that_of_the_slowest_domain() {
        let report = r#"{"critical_paths": [], "fmax": {"clk$SB_IO_IN_$glb_clk": {"achieved": 102.5, "constraint": 12}},
            "utilization": {"ICESTORM_LC": {"available": 7680, "used": 612}}}"#;
        assert_eq!(highest(&serde_json::from_str(report).unwrap()), Some(102.5e6));
        assert_eq!(highest(&serde_json::json!({ "fmax": {} })), None);
    }

    #[test]
    fn the_last_lines_of_a_tool_are_one_sentence() {
        assert_eq!(last("1\n2\n\n3\n4\n  ERROR: no such cell\n"), "2 / 3 / 4 / ERROR: no such cell");
        assert_eq!(last("\n"), "it says nothing");
    }
}
