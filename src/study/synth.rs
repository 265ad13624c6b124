//! What hardware costs in an FPGA: lookup tables and flip-flops by Yosys, the highest clock by nextpnr, both from the
//! exported Verilog.
//!
//! One device and, where that can be routed, one seed for all, so that numbers can be compared; other seeds place otherwise
//! and come some per cent above or below. The router of nextpnr goes round in circles for some placements (issues 179 and
//! 1341 of its project): such a run is ended by what it prints, not by a time, and the next seed is taken.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use crate::export::{self, Options};
use crate::output::temporary::{self, Folder};
use crate::testbench::Testbench;

/// The device as nextpnr is asked for it, the greatest of its family.
const DEVICE: [&str; 3] = ["--hx8k", "--package", "ct256"];
/// Its logic cells, each a lookup table of four inputs with a carry and a flip-flop.
const LOGIC_CELLS: u64 = 7680;
/// The seed of the placement, and the last that is tried.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=16;
/// Lines of the router's table, of 1000 arcs each, without progress after which it is given up.
const STALLED_LINES: usize = 12;
/// Time between two looks at a tool.
const INTERVAL: Duration = Duration::from_millis(20);
/// Lines of a tool that fails which are shown.
const LAST: usize = 4;

/// Yosys: counts of the machine alone.
const COUNT: &str = "read_verilog machine.v
synth_ice40 -json machine.json
";
/// Then a netlist of the harness with the machine in it.
const HARNESS: &str = "design -reset
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
    /// The device holds it.
    pub fits: bool,
    /// The seed with which it could be routed: 1, or where that does not lead to an end the next that does, up to 16.
    pub seed: Option<u64>,
    /// The highest clock in Hz between registers, those of the harness too; `None` where it was not routed.
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
        format!("iCE40 {} {}, seed {}", DEVICE[0].trim_start_matches('-'), DEVICE[2], SEEDS.start())
    }

    /// What the machine of a model, in a bench, costs, without the flags of its properties: they are for the simulator, and widths that
    /// are known to be enough raise none. Takes seconds; ends its tools when this process is ended by a signal.
    ///
    /// # Errors
    /// A tool fails.
    pub fn cost(&self, model: &str, bench: &Testbench) -> Result<Cost, SynthError> {
        self.cost_within(model, bench, *SEEDS.end())
    }

    /// The same, but no more than this many seeds are tried; with 0 the machine is not placed, and its clock not known.
    ///
    /// # Errors
    /// A tool fails.
    pub fn cost_within(&self, model: &str, bench: &Testbench, seeds: u64) -> Result<Cost, SynthError> {
        let folder = Folder::new()?;
        let at = |name: &str| folder.path().join(name);
        let outputs = bench.ports();
        let options = Options { comment: &[], outputs: &outputs };
        std::fs::write(at("machine.v"), export::verilog(bench.design(), &options))?;
        std::fs::write(at("harness.v"), export::harness(bench.design(), &options))?;
        let script = if seeds == 0 { COUNT.to_owned() } else { [COUNT, HARNESS].concat() };
        std::fs::write(at("script.ys"), script)?;
        run(YOSYS, &["-q", "-s", "script.ys"], model, folder.path(), |_| false)?;
        let unread = |tool, what| SynthError::Unread { tool, model: model.to_owned(), what };
        let read = |tool, name: &str| {
            let text = std::fs::read_to_string(at(name)).map_err(|error| unread(tool, error.to_string()))?;
            serde_json::from_str::<Value>(&text).map_err(|error| unread(tool, error.to_string()))
        };
        let cost = counted(&read(YOSYS, "machine.json")?);
        if cost.luts == 0 {
            return Err(unread(YOSYS, "it has no lookup table".to_owned()));
        }
        let whole = if seeds == 0 { cost } else { counted(&read(YOSYS, "harness.json")?) };
        if [whole.luts, whole.flip_flops, whole.carries].iter().any(|count| *count > LOGIC_CELLS) {
            return Ok(Cost { fits: false, ..cost });
        }
        for seed in SEEDS.take_while(|seed| *seed <= seeds) {
            let seed_word = seed.to_string();
            let place =
                ["--seed", &seed_word, "--json", "harness.json", "--report", "report.json", "--timing-allow-fail"];
            if run(NEXTPNR, &[&DEVICE[..], &place[..]].concat(), model, folder.path(), router_loops)? {
                let clock_hz = highest(&read(NEXTPNR, "report.json")?);
                return Ok(Cost { clock_hz, seed: Some(seed), ..cost });
            }
        }
        Ok(cost)
    }
}

/// The router does what it has done before: in many lines of its table in a row no arc was added without another being
/// torn out, and as many remain.
fn router_loops(log: &str) -> bool {
    // Iterations; arcs with and without such; those of them in this line; remaining; and times.
    let line = |line: &str| -> Option<(bool, u64)> {
        let mut fields = line.strip_prefix("Info:")?.split('|').skip(2);
        let without = fields.next()?.split_whitespace().nth(1)?.parse::<u64>().ok()?;
        Some((without == 0, fields.next()?.trim().parse().ok()?))
    };
    let (mut longest, mut length, mut before) = (0, 0, None);
    for (stays, remaining) in log.lines().filter_map(line) {
        length = if stays && before == Some(remaining) { length + 1 } else { 0 };
        longest = longest.max(length);
        before = Some(remaining);
    }
    longest >= STALLED_LINES
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
        fits: true,
        seed: None,
        clock_hz: None,
    }
}

/// The highest clock in Hz of a report of nextpnr, which has MHz for each clock.
fn highest(report: &Value) -> Option<f64> {
    let clocks = report["fmax"].as_object().into_iter().flatten();
    let achieved = clocks.filter_map(|(_, clock)| clock["achieved"].as_f64()).reduce(f64::min);
    achieved.map(|mhz| mhz * 1e6)
}

/// Runs a tool to its end in a folder, true, or until what it has printed is such that it is given up, false; nothing of
/// that is kept unless it fails.
fn run(
    tool: &'static str,
    words: &[&str],
    model: &str,
    folder: &Path,
    is_given_up: impl Fn(&str) -> bool,
) -> Result<bool, SynthError> {
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
        running.extend(child.as_ref().ok().map(Child::id));
    });
    let started = spawned.unwrap_or_else(|| Err(std::io::ErrorKind::Interrupted.into()));
    let mut child = started.map_err(|error| SynthError::NoTool { tool, error })?;
    let said = || std::fs::read(&log).map(|said| String::from_utf8_lossy(&said).into_owned());
    while !is_over(&mut child) {
        std::thread::sleep(INTERVAL);
        if said().is_ok_and(|said| is_given_up(&said)) {
            // One that has gone needs no end.
            let _ = child.kill();
        }
    }
    temporary::attend(&mut |running| running.retain(|number| *number != child.id()));
    let (status, said) = (child.wait()?, said()?);
    // Whether it was given up does not depend on when that was looked at.
    match is_given_up(&said) {
        true => Ok(false),
        false if status.success() => Ok(true),
        false => Err(SynthError::Failed { tool, model: model.to_owned(), last: last(&said) }),
    }
}

/// A process has ended. Its number is kept from others: once it was waited for, that may be another's.
#[cfg(unix)]
fn is_over(child: &mut Child) -> bool {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let number = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    number.is_none_or(|number| match waitid(WaitId::Pid(number), options) {
        Ok(status) => status.is_some(),
        Err(error) => error != rustix::io::Errno::INTR,
    })
}

#[cfg(not(unix))]
fn is_over(child: &mut Child) -> bool {
    !matches!(child.try_wait(), Ok(None))
}

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
        let wanted = Cost { luts: 3, flip_flops: 3, carries: 1, rams: 1, fits: true, seed: None, clock_hz: None };
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
    fn a_router_that_router_loops_is_seen_in_its_table() {
        let head = "Info:            |   (re-)routed arcs  |   delta    | remaining|       time spent     |\n\
                    Info:    IterCnt |  w/ripup   wo/ripup |  w/r  wo/r |      arcs| batch(sec) total(sec)|\n\
                    Info:       1000 |       26        973 |   26   973 |      2103|       0.50       0.50|\n";
        let round = "Info:       2000 |     1026        973 | 1000     0 |      2103|       0.53       1.03|\n";
        let on = "Info:       3000 |     1926       1073 |  900   100 |      2003|       0.53       1.03|\n";
        assert!(!router_loops(head) && !router_loops(&(head.to_owned() + &round.repeat(STALLED_LINES - 1))));
        assert!(router_loops(&(head.to_owned() + &round.repeat(STALLED_LINES))));
        assert!(router_loops(&(head.to_owned() + &round.repeat(STALLED_LINES) + on)));
        assert!(!router_loops(&(head.to_owned() + &(round.repeat(STALLED_LINES - 1) + on).repeat(9))));
    }

    #[test]
    fn the_last_lines_of_a_tool_are_one_sentence() {
        assert_eq!(last("1\n2\n\n3\n4\n  ERROR: no such cell\n"), "2 / 3 / 4 / ERROR: no such cell");
        assert_eq!(last("\n"), "it says nothing");
    }
}
