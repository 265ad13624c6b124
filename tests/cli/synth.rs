//! `stepwave machine --synth ice40` with tools that say what was recorded (the real ones are in `.ci/synth`), and `--pareto`.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{Folder, Ran, good, machine};

const SMALL: &str = "machine ppc-line mindev-line --travel 0.02mm,0.015mm --blu 1um --feed 30mm/min";

/// As Yosys writes a netlist, cut down to what is counted: three LUTs and two flip-flops for a machine of this many inputs.
const YOSYS: &str = r#"case "$1" in -V) echo "Yosys 0.23 (git sha1 7ce5011c24b)"; exit;; esac
grep -q '^module .*_harness($' harness.v && ! grep -q _overflow harness.v || exit 7
more=; grep -q pulse_source machine.v && more='"g": { "type": "SB_LUT4" },'
grep -q decel machine.v && more="$more \"h\": { \"type\": \"SB_DFF\" },"
for top in machine harness; do
cat >$top.json <<JSON
{ "creator": "Yosys 0.23", "modules": { "SB_LUT4": { "cells": {} }, "top": { "cells": { $more
"a": { "type": "SB_LUT4" }, "b": { "type": "SB_LUT4" }, "c": { "type": "SB_LUT4" },
"d": { "type": "SB_DFFESR" }, "e": { "type": "SB_DFF" }, "f": { "type": "SB_CARRY" } } } } }
JSON
done"#;
const NEXTPNR: &str = r#"case "$1" in --version) echo '"nextpnr-ice40" -- Next Generation Place and Route (Version 0.4-1+b1)' >&2; exit;; esac
echo '{"fmax": {"clk$SB_IO_IN_$glb_clk": {"achieved": 102.5, "constraint": 12.0}}}' >report.json"#;

/// A folder with tools of these scripts in its folder `bin`, and an empty folder `tmp` for temporary files.
fn tools(scripts: &[(&str, &str)]) -> Folder {
    let folder = Folder::new();
    folder.make("bin");
    folder.make("tmp");
    for (name, script) in scripts {
        let path = format!("bin/{name}");
        folder.write(&path, &format!("#!/bin/sh\n{script}\n"));
        fs::set_permissions(folder.path(&path), fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}

/// The program, for which there are no other tools than those in `bin`, and what their scripts call.
fn command(folder: &Folder, words: &str) -> Command {
    let mut command = folder.command();
    command.args(words.split(' ')).env("TMPDIR", folder.path("tmp"));
    let bin = folder.path("bin");
    for tool in ["cat", "grep", "sleep"] {
        let found =
            ["/usr/bin", "/bin"].map(|place| Path::new(place).join(tool)).into_iter().find(|path| path.exists());
        // Once is enough.
        let _ = std::os::unix::fs::symlink(found.unwrap(), bin.join(tool));
    }
    command.env("PATH", bin);
    command
}

fn ran(folder: &Folder, words: &str) -> Ran {
    let ran = Ran::new(command(folder, words).output().unwrap());
    assert_eq!(fs::read_dir(folder.path("tmp")).unwrap().count(), 0, "{words}: {ran:?}");
    ran
}

#[test]
fn costs_are_counted_in_the_netlist_and_read_from_the_report() {
    let folder = tools(&[("yosys", YOSYS), ("nextpnr-ice40", NEXTPNR)]);
    let text = ran(&folder, &format!("{SMALL} --synth ice40"));
    assert_eq!((text.code, text.err.as_str()), (0, ""), "{text:?}");
    assert!(text.out.contains("by Yosys 0.23, highest clock by nextpnr 0.4-1+b1 in an iCE40 hx8k ct256, seed 1\n"));
    let row = text.out.lines().find(|line| line.starts_with("ppc-line ")).unwrap();
    let cells: Vec<&str> = row.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    assert_eq!(cells[6..9], ["3", "2", "102.500 MHz"], "{row}");
    // With the pulse source there is a lookup table more, with a ramp a flip-flop too.
    assert_eq!(cells[10..], ["4", "2", "102.500 MHz"], "{row}");
    let ramp = ran(&folder, &format!("{SMALL} --synth ice40 --accel 500mm/s2"));
    let wanted = "\nthe ramp takes 0 LUTs and 1 flip-flops more, in ppc-machine: 4 and 3 with it\n";
    assert!(ramp.out.contains(wanted), "{ramp:?}");
    let all = ran(&folder, &format!("{SMALL} --synth ice40 --accel 500mm/s2 --json")).out;
    let all: Value = serde_json::from_str(&all).unwrap();
    let count = |which: &str| all["ramp_cost"][which]["flip_flops"].as_u64();
    assert_eq!([count("without"), count("with")], [Some(2), Some(3)]);
    let markdown = ran(&folder, &format!("{SMALL} --synth ice40 --markdown"));
    assert!(markdown.out.contains(
        " | LUTs | flip-flops | highest clock | feed at the highest clock, mm/min | LUTs with pulse source | "
    ));
    assert!(markdown.out.contains(" | 3 | 2 | 102.500 MHz | "), "{markdown:?}");
    let all: Value = serde_json::from_str(&ran(&folder, &format!("{SMALL} --synth ice40 --json")).out).unwrap();
    assert_eq!(all["synth"]["device"], "iCE40 hx8k ct256, seed 1");
    for machine in all["machines"].as_array().unwrap() {
        let cost = &machine["cost"];
        let counts = ["luts", "flip_flops", "carries", "block_rams"].map(|field| cost[field].as_u64().unwrap());
        assert_eq!((counts, cost["clock_hz"].as_f64()), ([3, 2, 1, 0], Some(102.5e6)), "{machine}");
        let whole = &machine["program_cost"];
        let name = machine["model"].as_str().unwrap().replace("-line", "-machine");
        assert_eq!((whole["machine"].as_str(), whole["luts"].as_u64()), (Some(&*name), Some(4)), "{machine}");
        // A feed goes with the clock.
        for end in ["least", "greatest"] {
            let wanted = machine["feed"][end].as_f64().unwrap() * 102.5e6 / machine["clock_hz"].as_f64().unwrap();
            let feed = cost["feed"][end].as_f64().unwrap();
            assert!((feed / wanted - 1.0).abs() < 1e-12, "{feed} {wanted}");
        }
        let export = cost["export"].as_str().unwrap().strip_prefix("stepwave ").unwrap();
        let bits = format!("registers of {} bits together", machine["register_bits"]);
        let printed = good(&format!("{export} --verilog f.v"));
        assert!(printed.contains(&bits), "{printed} {bits}");
    }
}

#[test]
fn of_a_family_with_free_curves_it_is_said_that_their_integrators_are_not_counted() {
    let folder = tools(&[("yosys", YOSYS), ("nextpnr-ice40", NEXTPNR)]);
    let words = "machine dda-line dda-arc ppc-line --travel 0.02mm,0.015mm --feed 30 --synth ice40";
    let sentence =
        "\ndda-machine is counted without the integrators of free curves, which a program with G5 or G5.1 adds\n";
    for more in ["", " --markdown"] {
        let text = ran(&folder, &format!("{words}{more}")).out;
        assert!(text.matches(sentence).count() == 1 && text.matches("is counted without").count() == 1, "{text}");
    }
    let all: Value = serde_json::from_str(&ran(&folder, &format!("{words} --json")).out).unwrap();
    let of = |row: usize| all["machines"][row]["program_cost"]["not_counted"].to_string();
    assert_eq!([of(0), of(1), of(2)], [r#"["integrators of free curves"]"#, r#"["integrators of free curves"]"#, "[]"]);
    // Without costs there is nothing to be left out.
    let text = ran(&folder, words.trim_end_matches(" --synth ice40")).out;
    assert!(!text.contains("is counted without"), "{text}");
}

#[test]
fn what_the_device_does_not_hold_has_no_clock() {
    let many = (0..7681).map(|lut| format!("\"{lut}\": {{ \"type\": \"SB_LUT4\" }}")).collect::<Vec<_>>().join(",");
    let json = format!("{{ \"modules\": {{ \"top\": {{ \"cells\": {{ {many} }} }} }} }}");
    let script = "[ \"$1\" = -V ] && exit\ncat ../../many.json >machine.json; cat ../../many.json >harness.json";
    let folder = tools(&[("yosys", script), ("nextpnr-ice40", "[ \"$1\" = --version ]")]);
    folder.write("many.json", &json);
    let text = ran(&folder, "machine ppc-line --travel 0.02mm,0.015mm --feed 30 --synth ice40");
    assert_eq!(text.code, 0, "{text:?}");
    assert!(text.out.contains("\nppc-line does not fit into the device: its highest clock is not known\n"), "{text:?}");
    assert!(text.out.replace(' ', "").contains("µm76810--76810-\n"), "{text:?}");
}

#[test]
fn where_the_router_goes_round_the_next_seed_is_taken() {
    // For ever with seed 1; with seed 2 it ends, but after as many lines without progress; seed 3 is good.
    let script = r#"case "$1" in --version) exit;; esac
case "$*" in *"--seed 3 "*) exec /bin/sh ../../good;; esac
line() { echo "Info:  2000 |  1026   973 | 1000   0 |   2103|   0.53   1.03|"; }
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14; do line; done
case "$*" in *"--seed 2 "*) exec /bin/sh ../../good;; esac
exec sleep 300"#;
    let folder = tools(&[("yosys", YOSYS), ("nextpnr-ice40", script)]);
    folder.write("good", r#"echo '{"fmax": {"clk": {"achieved": 50.0, "constraint": 12.0}}}' >report.json"#);
    let words = "machine ppc-line --travel 0.02mm,0.015mm --feed 30 --synth ice40";
    let all: Value = serde_json::from_str(&ran(&folder, &format!("{words} --json")).out).unwrap();
    let cost = &all["machines"][0]["cost"];
    assert_eq!((cost["seed"].as_u64(), cost["clock_hz"].as_f64()), (Some(3), Some(50e6)), "{cost}");
    let text = ran(&folder, words).out;
    assert!(text.contains("\nppc-line is placed with seed 3: before it the router comes to no end\n"), "{text}");
}

#[test]
fn without_the_tools_the_packages_are_named_before_any_work() {
    let begun = Instant::now();
    let words = "machine --travel 300mm,200mm --blu 1um --feed 2400mm/min --synth ice40";
    for (folder, missing) in [(tools(&[]), "yosys"), (tools(&[("yosys", YOSYS)]), "nextpnr-ice40")] {
        let ran = ran(&folder, words);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{ran:?}");
        let starts =
            format!("stepwave: --synth ice40 needs Yosys and nextpnr for iCE40, and {missing} cannot be started");
        let ends = "install the Debian packages yosys and nextpnr-ice40\n";
        assert!(ran.err.starts_with(&starts) && ran.err.ends_with(ends) && ran.err.lines().count() == 1, "{ran:?}");
    }
    assert!(begun.elapsed() < Duration::from_secs(20));
    super::refused("machine --travel 1mm,1mm --feed 600 --synth ecp5", &["--synth", "ecp5", "ice40"]);
}

#[test]
fn a_tool_that_fails_is_reported_with_its_last_lines() {
    let yosys =
        "[ \"$1\" = -V ] && exit\necho one; echo two; echo three; echo four; echo ERROR: no such cell >&2; exit 1";
    let ran_with = |yosys: &str, nextpnr: &str| {
        let ran = ran(&tools(&[("yosys", yosys), ("nextpnr-ice40", nextpnr)]), &format!("{SMALL} --synth ice40"));
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{ran:?}");
        ran.err
    };
    let err = ran_with(yosys, NEXTPNR);
    assert!(err.contains("yosys fails at ") && err.contains(": two / three / four / ERROR: no such cell\n"), "{err}");
    let err = ran_with(YOSYS, "[ \"$1\" = --version ] || { echo ERROR: unable to route; exit 3; }");
    assert!(err.contains("nextpnr-ice40 fails at ") && err.contains(": ERROR: unable to route\n"), "{err}");
    let err = ran_with(YOSYS, "[ \"$1\" = --version ] || echo nonsense >report.json");
    assert!(err.contains("nextpnr-ice40 writes something that cannot be read for "), "{err}");
    let err = ran_with("true", NEXTPNR);
    assert!(err.contains("yosys writes something that cannot be read for "), "{err}");
}

#[test]
fn a_signal_ends_the_tools_and_takes_their_files_away() {
    let slow = "[ \"$1\" = --version ] && exit\necho $$ >../../running.$$\nsleep 300";
    let folder = tools(&[("yosys", YOSYS), ("nextpnr-ice40", slow)]);
    let mut command = command(&folder, &format!("{SMALL} --synth ice40"));
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let running = || folder.files().into_iter().filter(|name| name.starts_with("running."));
    let begun = Instant::now();
    // Two at a time.
    while running().count() < 2 {
        assert!(begun.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(Command::new("kill").arg(child.id().to_string()).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(143));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "stepwave: stopped by SIGTERM: no output was written\n");
    assert_eq!(fs::read_dir(folder.path("tmp")).unwrap().count(), 0);
    for name in running() {
        let number = name.strip_prefix("running.").unwrap().to_owned();
        while Path::new("/proc").join(&number).join("cwd").read_link().is_ok() {
            assert!(begun.elapsed() < Duration::from_secs(120), "{number} still runs");
            std::thread::sleep(Duration::from_millis(10));
        }
    }
}

/// Clock, error and bits of a machine: less is better.
fn merit(machine: &Value) -> [f64; 3] {
    [&machine["clock_hz"], &machine["path_error"]["greatest"], &machine["register_bits"]]
        .map(|field| field.as_f64().unwrap())
}

#[test]
fn pareto_leaves_out_what_a_kept_row_of_the_same_curve_beats_and_nothing_else() {
    let kept: Value = serde_json::from_str(&good(&format!("{} --json --pareto", machine::SMALL))).unwrap();
    let all = &*machine::ALL;
    let list = |all: &Value| all["machines"].as_array().unwrap().clone();
    let name = |machine: &Value| machine["model"].as_str().unwrap().to_owned();
    let is_arc = |machine: &Value| name(machine).ends_with("arc");
    let beats = |one: &Value, other: &Value| {
        let (own, others) = (merit(one), merit(other));
        let nowhere_worse = (0..3).all(|index| own[index] <= others[index]);
        is_arc(one) == is_arc(other) && nowhere_worse && own != others
    };
    let (all, beaten) = (list(all), kept["beaten"].as_array().unwrap().clone());
    let kept: Vec<String> = list(&kept).iter().map(name).collect();
    assert!(kept.len() > 2 && beaten.len() > 2 && kept.len() + beaten.len() == all.len(), "{kept:?} {beaten:?}");
    for machine in &all {
        let better: Vec<String> = all.iter().filter(|other| beats(other, machine)).map(name).collect();
        assert_eq!(better.is_empty(), kept.contains(&name(machine)), "{} {better:?}", name(machine));
        if let Some(row) = beaten.iter().find(|row| row["model"] == machine["model"]) {
            let by = row["by"].as_str().unwrap().to_owned();
            assert!(better.contains(&by) && kept.contains(&by), "{row}");
        }
    }
    let text = good(&format!("{} --pareto", machine::SMALL));
    assert!(text.contains(&format!("\nleft out by --pareto: {} of {}\n", beaten.len(), all.len())), "{text}");
    let first = &beaten[0];
    let line = format!("\n  {}, beaten by {}\n", first["model"].as_str().unwrap(), first["by"].as_str().unwrap());
    assert!(text.contains(&line), "{text}");
}
