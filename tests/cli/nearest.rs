//! An unknown name is refused with the one that was probably meant.

use super::Folder;

#[test]
fn a_slip_of_the_pen_is_answered_with_the_nearest_name() {
    let sweep = "sweep dda-line --to-grid 1..3x1..3 --csv s.csv";
    for (words, hint) in [
        ("swep", "unrecognized subcommand 'swep'; a similar subcommand exists: 'sweep'"),
        ("golden chek", "a similar subcommand exists: 'check'"),
        ("run dda-line --to 8,6 --vcdd x", "unexpected argument '--vcdd' found; a similar argument exists: '--vcd'"),
        ("run dda-line --to 8,6 --engine wrd", "a similar value exists: 'word'"),
        ("run ppc-lien --to 8,6", "there is no model 'ppc-lien' (did you mean 'ppc-line'?); the models are ppc-line,"),
        ("run PPC_ARC --from 5,0 --to 0,5 --ccw", "(did you mean 'ppc-arc'?)"),
        ("prove dda-lin", "(did you mean 'dda-line'?)"),
        ("run dda-line --to 8,6 --width jxr=4", "no register 'jxr' here for --width (did you mean 'jrx'?)"),
        ("run dda-line --to 8,6 --preset jyr=4", "no register 'jyr' here for --preset (did you mean 'jry'?)"),
        ("prove ppc-line --narrower fx=1", "no register fx with a width to choose (did you mean 'f'?)"),
        ("run dda-line --to 8,6 --vcd w.vcd --trace jxr", "no signal is called 'jxr' (did you mean 'jrx'?)"),
        ("run dda-line --to 8,6 --vcd w.vcd --trace x --trace jvz", "no signal is called 'jvz' (did you mean 'jv"),
        (
            "run dda-line --to 8,6 --vcd w.vcd --trace-on don",
            "there is no signal 'don' in this netlist (did you mean 'done'?)",
        ),
        (&format!("{sweep} --width jxr=3"), "no register 'jxr' here for --width (did you mean 'jrx'?)"),
        (&format!("{sweep} --preset zro,half"), "invalid value 'zro' of --preset (did you mean 'zero'?)"),
        (&format!("{sweep} --adder paralel"), "invalid value 'paralel' of --adder (did you mean 'parallel'?)"),
        (&format!("{sweep} --heat eror_max --plot p.svg"), "there is no column 'eror_max' (did you mean 'error_max'?)"),
    ] {
        let folder = Folder::new();
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
        assert_eq!(folder.files(), [""; 0], "{words}");
    }
}

#[test]
fn diff_names_the_signal_that_was_probably_meant() {
    let folder = Folder::new();
    folder.good("run dda-line --to 8,6 --vcd w.vcd");
    for (options, hint) in [
        ("--map dda_lin.axis_x=a", "no such signal or scope (did you mean 'dda_line.axis_x'?)"),
        ("--signals jxr", "no signal is left to compare (did you mean 'jrx'?)"),
    ] {
        let ran = folder.run(&format!("diff w.vcd w.vcd {options}"));
        assert!(ran.code == 2 && ran.err.contains(hint), "{options}: {ran:?}");
    }
}

#[test]
fn registers_that_a_model_has_by_kind_or_number_are_swept() {
    for words in [
        "sweep dda-line --to-grid 1..3x1..3 --width 4,jr=4..5",
        "sweep dda-line --to-grid 1..3x1..3 --preset jrx=0..1",
        "sweep stepgen --to-grid 1..3x1..3 --width acc=12..13",
        "sweep ppc-line --to-grid 1..3x1..3 --width ex=4 --end-point per-axis",
    ] {
        Folder::new().good(words);
    }
}

#[test]
fn a_mistake_in_cases_toml_is_shown_with_its_line() {
    let folder = Folder::new();
    folder.write("cases.toml", "[[case]]\nname = \"line\"\nargs = [\"ppc-line\", 6]\nsource = \"\"\n");
    let ran = folder.run("golden check .");
    assert_eq!(ran.code, 2);
    let lines: Vec<&str> = ran.err.lines().collect();
    assert!(lines[0].starts_with("stepwave: cannot read ./cases.toml: TOML parse error at line 3, column"), "{ran:?}");
    assert!(lines.contains(&"3 | args = [\"ppc-line\", 6]") && lines.len() >= 4, "{ran:?}");
}
