use clap::Parser;

use super::*;
use crate::cli::{Cli, Command, ProgramArgs, Titled};
use crate::commands::program;
use crate::output::Outputs;

/// Rates of the pulse source that come round and that do not, moves of all kinds.
const TEXT: &str = "G21 G90 G1 X3 Y0.9 F300\nX0.9 Y3.6 F500\nG2 X2.4 Y2.1 I1.5 J0\nG1 X0 Y0 Z0.3\nG0 X1\n";

fn args(words: &str) -> Box<Titled<ProgramArgs>> {
    match Cli::try_parse_from(words.split(' ')).expect("a command").command {
        Command::Program(args) => args,
        other => panic!("{other:?}"),
    }
}

/// What is expected of the waves of a program.
fn expected(args: &ProgramArgs) -> [f64; 2] {
    let simulation = program::asked(args).expect("options");
    let bench = simulation.lean(simulation.prepare().expect("a machine").bench);
    let estimate = simulation.estimate(&bench).expect("a program").expect("an estimate");
    let time = ClockTime::from_hz(args.clock.clock_hz).expect("a clock");
    Size::of(&bench, &args.trace, time).expect("a size").bytes(&args.trace, None, &estimate)
}

#[test]
fn waves_take_about_what_is_expected_of_every_family_and_option() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(at("p.ngc"), TEXT).expect("a program");
    let mut wrong = Vec::new();
    for method in ["ppc", "dda", "dpm", "cim", "mindev", "stepgen", "bresenham"] {
        for options in [
            "",
            " --trace-steps",
            " --every-clock",
            " --every-clock --trace-steps",
            " --every-clock --no-clk",
            " --trace-from 2000 --trace-to 20000",
            " --ramp after --period 40",
            " --ramp after --period 200 --smooth exp=3",
            " --ramp after --period 40 --every-clock",
            " --ramp after --period 40 --trace-steps",
        ] {
            let (file, vcd, fst) = (at("p.ngc"), at("w.vcd"), at("w.fst"));
            let own = format!("--method {method} --blu 0.01mm --clock-hz 20000 --vcd {vcd} --fst {fst}{options}");
            let args = args(&format!("stepwave program {file} {own}"));
            let mut outputs = Outputs::default();
            program::simulate(&args, &mut outputs).expect("a run");
            outputs.commit().expect("waves");
            for (expected, file) in expected(&args).into_iter().zip([vcd, fst]) {
                let share = expected / std::fs::metadata(&file).expect("a wave").len() as f64;
                // Of FST one knows less: how well the samples of a program pack, to a factor of four or so; and where
                // steps alone take bytes, how many of them fall into a window.
                let uneven = options.contains("--trace-from") && !options.contains("--every-clock");
                let near = match (file.ends_with("vcd"), uneven) {
                    (true, false) => 0.65..2.0,
                    (true, true) => 0.3..5.0,
                    (false, _) => 0.2..5.0,
                };
                if !near.contains(&share) {
                    wrong.push(format!("{method}{options}: {share:.2} of {file}"));
                }
            }
        }
    }
    assert_eq!(wrong, [""; 0]);
}
