//! Waves of programs: idle samples are passed over, and nothing that is shown is lost by it.

use std::collections::BTreeSet;

use super::Folder;
use super::written::read;

/// Lines, an arc, all axes, a dwell; slow, so that most clocks are idle, and rates that come round and that do not.
const PROGRAM: &str = "G21 G90 G1 X0.03 Y0.009 F30\nX0.009 Y0.036 F500\nG4 P0.01\nG2 X0.024 Y0.021 I0.015 J0\n\
                       G1 X0 Y0 Z0.003\nG0 X0.01\n";
/// What is left out by default, and the same wave from every sample.
const WHOLE: &str = "--every-clock --no-clk --trace-exclude pulse_source.phase --trace-exclude pulse_source.sum";

/// The text of a wave without the line that says what it is without.
fn changes(folder: &Folder, name: &str) -> String {
    folder.read(name).lines().filter(|line| !line.starts_with("$comment")).map(|line| format!("{line}\n")).collect()
}

/// Runs a program with the wave as it is by default, and from every sample.
fn same_as_whole(folder: &Folder, options: &str) {
    let [short, whole] = [("s", ""), ("w", WHOLE)].map(|(name, more)| {
        let ran = folder.run(&format!("program p.ngc {options} {more} --vcd {name}.vcd --fst {name}.fst"));
        assert!(ran.code <= 1, "{options}: {ran:?}");
        ran.code
    });
    assert_eq!(short, whole, "{options}");
    assert!(changes(folder, "s.vcd") == changes(folder, "w.vcd"), "{options}");
    let [short, whole] = ["s.fst", "w.fst"].map(|name| read(&std::fs::read(folder.path(name)).unwrap()));
    assert_eq!(short.last_time, whole.last_time, "{options}");
    let paths = |shown: &super::Shown| shown.variables.keys().cloned().collect::<BTreeSet<String>>();
    assert_eq!(paths(&short), paths(&whole), "{options}");
    for (path, variable) in &short.variables {
        assert_eq!(variable.changes, whole.variables[path].changes, "{options}: {path}");
    }
}

#[test]
fn waves_without_the_phase_are_those_from_every_sample_by_every_family() {
    let folder = Folder::new();
    folder.write("p.ngc", PROGRAM);
    for family in ["ppc", "dda", "cim", "mindev", "dpm", "stepgen", "bresenham"] {
        for options in ["", "--trace-steps --trace-from 30000", "--trace-from 20001 --trace-to 40000"] {
            same_as_whole(&folder, &format!("--method {family} {options}"));
        }
    }
    same_as_whole(&folder, "--method dda --normalize");
}

/// With acceleration after the interpolator its period and its fine lines run too.
#[test]
fn waves_without_what_runs_after_the_interpolator_are_those_from_every_sample() {
    let folder = Folder::new();
    folder.write("p.ngc", PROGRAM);
    let running = ["period.sample_clock", "period.spread", "*.frx", "*.fry", "*.frz"];
    let without: String = running.iter().map(|name| format!(" --trace-exclude {name}")).collect();
    let families = [("ppc", "sum=4 --period 1000"), ("dda", "exp=2 --period 40"), ("stepgen", "sum=3 --period 16")];
    for (family, filter) in
        families.into_iter().chain([("dpm", "exp=4 --period 2"), ("bresenham", "sum=64 --period 100")])
    {
        let options = format!("--method {family} --ramp after --smooth {filter}");
        let windows = ["--trace-steps --trace-from 30000", "", "--trace-from 20001 --trace-to 40000"];
        for window in if family == "ppc" { &windows[..] } else { &windows[2..] } {
            let [short, whole] = [("s", String::new()), ("w", format!("{WHOLE}{without}"))].map(|(name, more)| {
                folder.good(&format!("program p.ngc {options} {window} {more} --vcd {name}.vcd"));
                changes(&folder, &format!("{name}.vcd"))
            });
            assert!(short == whole, "{options} {window}");
            assert!(short.contains("x_out") && !short.contains(" frx "), "{options}");
        }
    }
}

#[test]
fn windows_begin_and_end_in_samples_that_are_passed_over() {
    let folder = Folder::new();
    // A pulse every 20 000 clocks.
    folder.write("p.ngc", "G21 G90 G1 X0.003 Y0.002 F3\nX0.005\n");
    for family in ["ppc", "stepgen"] {
        for options in [
            "--trace-from 47000",
            "--trace-from 47000 --trace-to 47000",
            "--trace-from 47001 --trace-to 47005",
            "--trace-to 47000",
            "--trace-on busy --trace-from 47000",
            "--trace-on done --trace-from 47000",
            "--trace-on tick --trace-from 47000",
            "--trace-on tick --trace-from 47000 --trace-to 200000",
            "--trace-steps --trace-from 47000",
            "--trace tick --trace-from 100",
            "--trace ?x --trace-from 50",
            "--max-clocks 47010",
            "--max-clocks 47010 --trace-from 47010",
            "--max-clocks 47010 --trace-from 47000 --trace-to 99999",
        ] {
            same_as_whole(&folder, &format!("--method {family} {options}"));
        }
    }
}

#[test]
fn an_overflow_is_shown_with_its_operands_though_samples_are_passed_over() {
    let folder = Folder::new();
    folder.write("p.ngc", PROGRAM);
    for mode in ["trap", "wrap", "saturate"] {
        same_as_whole(&folder, &format!("--method ppc --width f=4 --on-overflow {mode}"));
        assert_eq!(folder.read("s.vcd").contains(" trap "), mode == "trap", "{mode}");
        assert!(folder.read("s.gtkw").contains("overflow\n"), "{mode}");
    }
}

#[test]
fn a_wave_of_a_program_says_what_it_is_without_and_shows_it_if_asked() {
    let folder = Folder::new();
    folder.write("p.ngc", "G21 G90 G1 X0.003 Y0.002 F60\n");
    let run = |options: &str| {
        folder.good(&format!("program p.ngc --method ppc --vcd w.vcd {options}"));
        let shown = read(folder.read("w.vcd").as_bytes());
        let inner = |path: &String| path.trim_start_matches("ppc_machine.").to_owned();
        let names: BTreeSet<String> = shown.variables.keys().map(inner).collect();
        let has = |name: &str| names.contains(name);
        (["clk", "pulse_source.phase", "pulse_source.sum", "pulse_source.rate"].map(has), names.len())
    };
    let text = |name: &str| folder.read(name);
    let (shown, count) = run("");
    assert_eq!(shown, [false, false, false, true]);
    let said = "; without clk, pulse_source.phase, pulse_source.sum, which --every-clock shows $end\n";
    assert!(text("w.vcd").contains(said), "{}", text("w.vcd"));
    assert!(text("w.gtkw").contains("\n@200\n-without clk, phase, sum\n"), "{}", text("w.gtkw"));
    assert!(!text("w.gtkw").contains(".clk\n") && !text("w.gtkw").contains(".phase["));
    assert_eq!(run("--every-clock"), ([true; 4], count + 3));
    assert!(!text("w.vcd").contains("; without") && !text("w.gtkw").contains("-without"));
    assert!(text("w.gtkw").contains("ppc_machine.clk\n"));
    // A name shows it, a pattern that fits much else does not, and one that fits nothing else does.
    assert_eq!(run("--trace phase --trace x"), ([false, true, false, false], 2));
    assert!(text("w.gtkw").contains("-without clk, sum\n"), "{}", text("w.gtkw"));
    assert_eq!(run("--trace pulse_source.*").0, [false, false, false, true]);
    assert_eq!(run("--trace pha*"), ([false, true, false, false], 1));
}

#[test]
fn waves_of_programs_have_no_clock_and_are_compared_by_time() {
    let folder = Folder::new();
    folder.write("p.ngc", "G21 G90 G1 X0.003 Y0.002 F60\n");
    folder.good("program p.ngc --method ppc --vcd a.vcd --fst b.fst");
    let said = folder.good("diff a.vcd b.fst --by time");
    assert!(said.starts_with("same"), "{said}");
    folder.write("p.ngc", "G21 G90 G1 X0.003 Y0.001 F60\n");
    folder.good("program p.ngc --method ppc --vcd c.vcd");
    assert_eq!(folder.run("diff a.vcd c.vcd --by time").code, 1);
    let ran = folder.run("diff a.vcd c.vcd");
    assert!(ran.code == 2 && ran.err.contains("--by time"), "{ran:?}");
}
