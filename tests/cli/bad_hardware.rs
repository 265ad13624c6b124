//! Options of hardware that cannot be are refused, and what a model does not take is never ignored.

use super::{Folder, refused, refused_words, run_refused};

#[test]
fn a_width_that_is_no_number_from_1_to_64_is_refused() {
    for (width, hint) in
        [("0", "0 bits"), ("65", "65 bits"), ("f=0", "0 bits"), ("18446744073709551615", "bits is not possible")]
    {
        run_refused(&format!("ppc-line --to 6,4 --width {width}"), &[hint, "1 to 64 bits"]);
    }
    for width in ["abc", "f=", "=5", "f=x", "3.5", "f=3,", ",", "1e1", "99999999999999999999"] {
        run_refused(&format!("ppc-line --to 6,4 --width {width}"), &["--width"]);
    }
    run_refused("ppc-line --to 6,4 --width abc", &["invalid width 'abc'", "such as 8 or f=9"]);
    refused_words(&["run", "ppc-line", "--to", "6,4", "--width", ""], &["invalid width ''"]);
    refused_words(&["run", "ppc-line", "--to", "6,4", "--width=-3"], &["invalid width '-3'"]);
}

#[test]
fn a_register_that_the_model_does_not_have_is_refused_with_those_it_has() {
    run_refused("ppc-line --to 6,4 --width jr=4", &["no register 'jr'", "--width", "xe, ye, f, e, x, y"]);
    run_refused("dda-line --to 8,6 --width f=9", &["no register 'f'", "jvx, jrx, jvy, jry, e, x, y"]);
    run_refused("dda-line --to 8,6 --preset jrz=1", &["no register 'jrz'", "--preset", "jrx, jry"]);
    // The counters of the scheme that is not chosen do not exist.
    run_refused("ppc-line --to 6,4 --width ex=4", &["no register 'ex'"]);
    run_refused("ppc-line --to 6,4 --width ez=4 --end-point per-axis", &["no register 'ez'", "ex, ey"]);
}

#[test]
fn a_width_too_narrow_for_the_geometry_is_refused_with_the_width_that_would_hold_it() {
    for (words, hints) in [
        ("ppc-line --to 6,4 --width 2", ["xe = 6", "2 bits", "3 bits would hold it", "--width xe=3"]),
        ("ppc-line --to 6,4 --width e=3", ["e = 10", "3 bits", "4 bits would hold it", "--width e=4"]),
        ("ppc-line --to -6,4 --form signed --width 2", ["xe = -6", "3 bits", "4 bits would hold it", "--width xe=4"]),
        ("ppc-line --from 9,0 --to 6,4 --width x=4", ["x = 9", "4 bits", "5 bits would hold it", "--width x=5"]),
        ("dda-line --to 8,6 --width 3", ["jvx = 8", "3 bits", "4 bits would hold it", "--width 4"]),
        ("dda-line --to 8,6 --width jv=3", ["jvx = 8", "3 bits", "4 bits would hold it", "--width jvx=4"]),
        ("dda-line --to 8,6 --preset jry=16", ["jry = 16", "4 bits", "5 bits would hold it", "--width 5"]),
        ("dda-line --to 8,6 --preset 99", ["jrx = 99", "4 bits", "7 bits would hold it", "--width 7"]),
        ("dda-arc --from 5,0 --to 0,5 --ccw --width 2", ["jvy = 5", "2 bits", "3 bits would hold it", "--width 3"]),
        // The first sector begins at (6, 6), the second at (0, 8): the advice is for both.
        ("dda-arc --from 6,6 --to -6,6 --ccw --width 2", ["jvx = 8", "2 bits", "4 bits would hold it", "--width 4"]),
        // Whole digits; a fraction is not counted.
        ("dda-line --to 12,6 --radix 10 --width 4", ["jvx = 12", "4 bits", "8 bits would hold it", "--width 8"]),
        ("dda-line --to 9,6 --radix 10 --preset 10", ["jrx = 10", "4 bits", "8 bits would hold it", "--width 8"]),
        (
            "dda-helix --from 5,0,0 --to 5,0,-200 --ccw --width 4",
            ["jvz = 8149", "12 bits", "13 bits would hold it", "--width 5"],
        ),
        (
            "dda-conic --ellipse 6,4 --from 6,0 --to 0,4 --ccw --width 6",
            ["jvy = 96", "6 bits", "7 bits would hold it", "--width 7"],
        ),
        ("ppc-line --to 6,4 --width xe=2", ["xe = 6", "2 bits", "3 bits would hold it", "--width xe=3"]),
        (
            "ppc-arc --from 5,0 --to 0,5 --ccw --width xi=2,yi=3",
            ["xi = 5", "2 bits", "3 bits would hold it", "--width xi=3"],
        ),
    ] {
        run_refused(words, &hints);
    }
}

#[test]
fn the_width_that_a_message_advises_is_taken() {
    for (words, width) in [
        ("ppc-line --to 6,4", "2"),
        ("ppc-line --to 6,4", "xe=2"),
        ("ppc-line --to -6,4 --form signed", "ye=1"),
        ("ppc-line --to 6,4", "f=3"),
        ("ppc-arc --from 5,0 --to 0,5 --ccw", "xi=2,yi=3"),
        ("dda-line --to 8,6", "3"),
        ("dda-line --to 8,6", "jv=3"),
        ("dda-line --to 8,6 --normalize", "3"),
        ("dda-line --to 8,6 --preset jry=16", "4"),
        ("dda-line --to 8,6,3 --preset 99 --end-point per-axis", "4"),
        ("dpm-line --to 37,5", "4"),
        ("dpm-line --to 37,5", "m=7"),
        ("dpm-line --to 37,5", "q=5"),
        ("dpm-line --to 37,5 --cascade 4", "4"),
        ("dpm-line --to 37,5 --cascade 4", "9"),
        ("dpm-line --to 37,5 --cascade 4", "my=9"),
        ("dpm-line --to 37,5 --cascade 4", "q2=3"),
        ("dpm-line --to 37,5 --radix 10", "4"),
        ("dpm-line --to 37,5 --radix 10", "6"),
        ("dda-arc --from 6,6 --to -6,6 --ccw", "2"),
        ("dda-arc --from 4,3 --to 0,5 --ccw", "jvx=2"),
        ("dda-arc --from 6,2 --to 2,6 --ccw --preset 3", "jv=2,jr=3"),
        ("dda-line --to 12,100 --radix 10", "4"),
        ("dda-line --to 12,100 --radix 10", "jv=4,jr=12"),
        ("dda-line --to 12,7 --adder serial", "3"),
        ("dda-conic --ellipse 6,4 --from 6,0 --to 6,0 --ccw --normalize", "5"),
        ("dda-conic --ellipse 6,4 --from 6,0 --to 6,0 --ccw", "ux=3"),
        ("dda-helix --from 5,0,0 --to 5,0,-200 --cw --preset half", "3"),
        ("dda-helix --from 5,0,0 --to 0,5,9 --ccw --preset jrx=1,jrz=9999", "4"),
    ] {
        let refused = Folder::new().run(&format!("run {words} --width {width}"));
        assert!(refused.code > 0, "{words} --width {width}: {refused:?}");
        let (_, advice) = refused.err.split_once("give --width ").unwrap_or_else(|| panic!("no advice: {refused:?}"));
        let advice = advice.split([',', '\n']).next().unwrap();
        let taken = Folder::new().run(&format!("run {words} --width {advice}"));
        assert_eq!((taken.code, taken.err.as_str()), (0, ""), "{words} --width {width}, then {advice}");
    }
}

#[test]
fn a_register_of_the_model_wider_than_64_bits_is_refused() {
    // n + 1 bits of F, 2^n iterations.
    run_refused("ppc-line --to 6,4 --width 64", &["register f would be 65 bits wide", "1 to 64 bits"]);
    run_refused("dda-line --to 8,6 --width 64", &["register e would be 65 bits wide"]);
}

#[test]
fn integrators_that_do_not_fit_each_other_are_refused() {
    run_refused("dda-line --to 8,6 --width jr=3", &["jvx of 4 bits", "jrx of 3 bits", "--width"]);
    run_refused("dda-line --to 8,6 --width jrx=5", &["jry of 4 bits and jrx of 5 bits", "same width"]);
    for form in ["--normalize", "--adder serial"] {
        let words = format!("dda-line --to 8,6 {form} --width jr=6,e=7");
        run_refused(&words, &["jvx of 4 bits", "jrx of 6 bits", "as wide as"]);
    }
    run_refused(
        "dda-helix --from 5,0,0 --to 0,5,3 --ccw --width jrz=2,jvz=2",
        &["jrz of 2 bits is narrower than jrx of 3 bits", "fraction of jvz"],
    );
}

#[test]
fn decimal_integrators_hold_whole_digits_and_are_not_normalised() {
    for width in ["6", "jv=3,jr=4", "jv=4,jr=6"] {
        let words = format!("dda-line --to 8,6 --radix 10 --width {width}");
        run_refused(&words, &["hold no whole decimal digits of 4 bits", "multiple of 4"]);
    }
    run_refused(
        "dda-line --to 8,6 --radix 10 --normalize",
        &["does not take --normalize with --radix 10", "whole digits", "leave one of both out"],
    );
}

#[test]
fn units_of_a_pulse_multiplier_that_do_not_go_together_are_refused() {
    run_refused("dpm-line --to 37,5 --radix 10 --cascade 4", &["--cascade 4", "leave --cascade or --radix 10 out"]);
    run_refused("dpm-line --to 37,5 --cascade 5 --width 12", &["--width 12", "units of 5 bits", "give --width 15"]);
    run_refused("dpm-line --to 37,5 --width 8,my=7", &["my of 7 bits, but the counter has 8", "give --width 8"]);
    let wide = "dpm-line --to 1000000000000,3 --cascade 33";
    run_refused(wide, &["--cascade 33", "66 bits", "1 to 64 bits", "units of fewer bits"]);
    for percent in ["0", "100", "-5", "x"] {
        run_refused(&format!("dpm-line --to 5,3 --override={percent}"), &[percent, "percentage from 1 to 99"]);
    }
}

#[test]
fn an_unknown_model_is_refused_with_those_there_are() {
    for model in ["nope", "PPC-LINE", "ppc_line", "ppc-"] {
        let hint = format!("there is no model '{model}'");
        run_refused(
            &format!("{model} --to 6,4"),
            &[&hint, "; the models are ", "ppc-line", "ppc-arc", "dda-line", "dda-arc"],
        );
    }
    run_refused("--ppc-line --to 6,4", &["'--ppc-line'"]);
    refused_words(&["run", "", "--to", "6,4"], &["there is no model ''"]);
    refused("run --to 6,4", &["<MODEL>"]);
}

#[test]
fn a_choice_that_the_model_does_not_take_is_refused_with_those_it_takes() {
    let [ppc_line, ppc_arc] =
        ["--width, --form, --end-point, --beats, --on-overflow", "--width, --end-point, --beats, --on-overflow"];
    let dda_line = "--width, --preset, --normalize, --radix, --adder, --end-point, --on-overflow";
    let dda = "--width, --preset, --normalize, --end-point, --on-overflow";
    for (model, options, takes) in [
        ("ppc-line --to 6,4", ["--preset half", "--normalize"].as_slice(), ppc_line),
        ("ppc-arc --from 5,0 --to 0,5 --cw", &["--preset 0", "--normalize", "--form signed"], ppc_arc),
        ("dda-line --to 8,6", &["--beats 1", "--beats 4", "--form signed", "--form magnitude"], dda_line),
        ("dda-arc --from 5,0 --to 0,5 --ccw", &["--beats 4", "--form signed", "--radix 10", "--adder serial"], dda),
        ("dda-conic --parabola 4 --to 4,4", &["--beats 4", "--radix 10", "--adder serial"], dda),
        (
            "dda-helix --from 5,0,0 --to 0,5,3 --ccw",
            &["--normalize", "--end-point total", "--radix 10"],
            "--width, --preset, --on-overflow",
        ),
    ] {
        for option in options {
            let [name, option_name] = [model, option].map(|words| words.split(' ').next().unwrap());
            let hint = format!("{name} does not take {option_name}; it takes {takes}");
            run_refused(&format!("{model} {option}"), &[&hint]);
        }
    }
}

#[test]
fn an_end_point_scheme_that_the_model_does_not_have_is_refused_with_the_reason() {
    run_refused(
        "ppc-line --to 6,4 --end-point iterations",
        &["no iterations next to its pulses", "total, per-axis, longest"],
    );
    for (model, taken) in [("ppc-arc", "total, per-axis"), ("dda-arc", "per-axis, total")] {
        for scheme in ["longest", "iterations"] {
            let refusal = format!("{model} does not take --end-point {scheme}: ");
            let reason = "the longest axis of an arc may arrive while the other still has steps to go";
            let words = format!("{model} --from 5,0 --to 0,5 --ccw --end-point {scheme}");
            run_refused(&words, &[&refusal, reason, &format!("it takes {taken}")]);
        }
    }
    run_refused(
        "dda-conic --ellipse 6,4 --from 6,0 --to 0,4 --ccw --end-point longest",
        &["dda-conic does not take --end-point longest: ", "it takes per-axis, total"],
    );
}

#[test]
fn a_value_outside_a_list_is_refused_with_the_list() {
    for (option, values) in [
        ("--end-point", "total, per-axis, longest, iterations"),
        ("--form", "magnitude, signed"),
        ("--beats", "4, 1"),
        ("--on-overflow", "trap, saturate, wrap"),
        ("--engine", "auto, "),
    ] {
        for value in ["wat", "2", "Total", "TRAP"] {
            let quoted = format!("'{value}'");
            run_refused(
                &format!("ppc-line --to 6,4 {option} {value}"),
                &[&quoted, option, &format!("possible values: {values}")],
            );
        }
        refused_words(&["run", "ppc-line", "--to", "6,4", option, ""], &[option, values]);
    }
}

#[test]
fn a_preset_that_is_none_is_refused() {
    for preset in ["nope", "1.5", "0x3", "Half", "jrx=", "jrx=nope", "99999999999999999999", "1,", "1;2"] {
        run_refused(
            &format!("dda-line --to 8,6 --preset {preset}"),
            &["invalid preset", "give zero, half, full or a number from 0 on"],
        );
    }
    run_refused("dda-line --to 8,6 --preset=-1", &["invalid preset '-1'"]);
    run_refused("dda-line --to 8,6 --preset -1", &["-1"]);
}

#[test]
fn a_clock_that_no_wave_can_carry_is_refused() {
    for clock in ["0", "-0", "nan", "inf", "1e30", "1e-9", "1e15", "-5"] {
        run_refused(
            &format!("dda-line --to 8,6 --clock-hz={clock}"),
            &["a clock of ", "give a frequency from 1e-3 to 1e14 Hz"],
        );
    }
    for clock in ["abc", "1MHz", "1,000", "0x10"] {
        run_refused(&format!("dda-line --to 8,6 --clock-hz {clock}"), &[clock, "invalid frequency", "give Hz"]);
    }
    refused_words(&["run", "dda-line", "--to", "8,6", "--clock-hz", ""], &["invalid frequency ''"]);
    // The limits themselves are possible.
    for clock in ["1e-3", "1e14"] {
        Folder::new().good(&format!("run dda-line --to 8,6 --clock-hz {clock} --vcd w.vcd"));
    }
}

#[test]
fn a_blu_that_is_no_length_is_refused() {
    for blu in ["0", "0mm", "1", "mm", "-1mm", "nanmm", "infmm", "1e400mm", "1cm", "abc", "1 2mm", "0um", "1e-400in"] {
        let words = ["run", "dda-line", "--to", "8,6", &format!("--blu={blu}"), "--json", "r.json"];
        refused_words(
            &words,
            &[&format!("invalid length '{blu}': give one above 0, such as 0.001mm, 1um or 0.0001in")],
        );
    }
    refused_words(&["run", "dda-line", "--to", "8,6", "--blu", ""], &["invalid length ''"]);
}

#[test]
fn a_subcommand_or_option_that_does_not_exist_is_refused_and_the_help_named() {
    refused("frob", &["'frob'", "(see `stepwave --help`)"]);
    refused("--frob", &["'--frob'", "(see `stepwave --help`)"]);
    refused("run ppc-line --to 6,4 --frob", &["'--frob'", "(see `stepwave run --help`)"]);
    refused("run ppc-line --to 6,4 extra", &["'extra'", "(see `stepwave run --help`)"]);
    refused("run ppc-line --to 6,4 --to 5,3", &["--to", "(see `stepwave run --help`)"]);
    refused("list --frob", &["'--frob'", "(see `stepwave list --help`)"]);
    refused("completions tcsh", &["'tcsh'", "bash"]);
    refused("diff one.vcd", &["<B>"]);
    refused("golden frob", &["'frob'", "(see `stepwave golden --help`)"]);
}

#[test]
fn a_message_is_one_line_whatever_the_words_that_it_quotes() {
    refused_words(&["run", "a\nb\u{1b}[31m", "--to", "6,4"], &["there is no model 'a b\\x1b[31m'"]);
    refused_words(&["run", "ppc-line", "--to", "6\n7,4"], &["invalid coordinate"]);
    refused_words(
        &["run", "ppc-line", "--to", "6,4", "--vcd", "w.vcd", "--trace", "x\ny"],
        &["no signal is called 'x y'"],
    );
    refused_words(&["fr\nob"], &["unrecognized subcommand"]);
}

#[test]
fn without_a_command_the_help_is_shown_and_the_exit_code_is_2() {
    for (words, usage) in [("", "Usage: stepwave <COMMAND>"), ("golden", "Usage: stepwave golden <COMMAND>")] {
        let ran = Folder::new().run(words);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{words}");
        assert!(ran.err.contains(usage) && ran.err.contains("Commands:"), "{ran:?}");
    }
    let help = Folder::new().good("--help");
    assert_eq!(Folder::new().run("").err, help, "what is shown is the help");
}

#[test]
fn presets_of_a_program_are_those_of_the_registers_that_are_there() {
    let folder = Folder::new();
    folder.write("part.ngc", "G21 G90 F300\nG1 X0.005 Y0.003\nM2\n");
    let program = |preset: &str| folder.run(&format!("program part.ngc --method dda --preset {preset} --steps -"));
    // The third axis follows the pulses of the plane.
    let ran = program("jrz=1");
    assert!(ran.code == 2 && ran.err.contains("no register 'jrz'") && ran.err.contains("jrx, jry"), "{ran:?}");
    let (zero, other) = (program("zero"), program("zero,jrx=7"));
    assert_eq!((zero.code, other.code), (0, 0), "{} {}", zero.err, other.err);
    assert_ne!(zero.out, other.out);
}

#[test]
fn two_values_for_one_register_tool_or_time_are_refused() {
    for (words, hint) in [
        ("ppc-line --to 6,4 --width f=5,f=6", "--width gives 'f' two values"),
        ("ppc-line --to 6,4 --width f=5 --width f=6", "--width gives 'f' two values"),
        ("ppc-line --to 6,4 --width 5,6", "--width gives all registers two values"),
        ("dda-line --to 6,4 --preset half --preset zero", "--preset gives all registers two values"),
        ("dda-line --to 6,4 --preset jrx=1,jrx=2", "--preset gives 'jrx' two values"),
        ("stepgen --to 6,4 --timing length=2,space=2,length=3", "'length' is given two times"),
    ] {
        run_refused(words, &[hint, "leave one of them out"]);
    }
    refused("prove ppc-arc --narrower f=1,f=2", &["--narrower gives 'f' two values, 1 and 2"]);
    let folder = Folder::new();
    folder.write("part.ngc", "G21 G90 F300\nG1 X1\nM2\n");
    let ran = folder.run("program part.ngc --method cim --tool 1=2mm --tool D1=3mm");
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("--tool gives D1 two radii, 2 mm and 3 mm"), "{}", ran.err);
    // What does not contradict itself is taken.
    assert_eq!(folder.run("run ppc-line --to 6,4 --width 5,f=7 --width e=9").code, 0);
}

#[test]
fn options_of_the_printed_table_are_refused_where_a_file_is_printed_in_its_place() {
    for (words, option) in [
        ("dda-arc --from 5,0 --to 0,5 --ccw --textbook --steps -", "--textbook"),
        ("dda-arc --from 5,0 --to 0,5 --ccw --textbook --json -", "--textbook"),
        ("ppc-line --to 6,4 --bits --vcd -", "--bits"),
    ] {
        refused(&format!("run {words}"), &[option, "is for the printed table", "standard output"]);
    }
}
