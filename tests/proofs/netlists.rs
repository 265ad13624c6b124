//! `stepwave prove F.net` as its users meet it: verdicts, the counterexample again in the simulator, and what is refused.

use std::fs;

use stepwave::export::{Checking, btor2, smt2};
use stepwave::netlist::dsl::Module;
use stepwave::netlist::{elaborate, text};

use crate::cli::{Folder, Ran};

/// A counter from 0 to 9 and back, in some bits, that counts while `go` is 1 and is cleared by `rst`.
fn decade(bits: u32) -> Folder {
    let module = Module::new("decade");
    let m = module.top();
    let (go, rst) = (m.input("go", 1), m.input("rst", 1));
    let count = m.reg("count", bits).reset(1);
    let ends = count.q.extend(5).equals(m.lit(5, 9));
    let next = count.q.strict_add(m.lit(bits, 1), go & !ends & !rst);
    count.when(rst | go & ends, m.lit(bits, 0)).when(go, next).else_hold();
    m.invariant("below_ten", count.q.extend(5).less_than(m.lit(5, 10)));
    let folder = Folder::new();
    fs::write(folder.path("t.net"), module.finish().expect("described").to_string()).expect("written");
    folder
}

fn prove(folder: &Folder, args: &[&str]) -> Ran {
    folder.run_words(&[&["prove", "t.net"], args].concat())
}

#[test]
fn a_width_that_is_enough_is_proved_and_one_bit_less_is_refuted() {
    let ran = prove(&decade(4), &[]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    assert_eq!(
        ran.out,
        "decade: every run from reset on; free inputs: go, rst\n\
         PROVED at these widths: decade.count does not overflow (by induction over 1 clock)\n\
         PROVED at these widths: decade.below_ten holds (by induction over 1 clock)\n"
    );
    let ran = prove(&decade(3), &[]);
    let event =
        "overflow of decade.count at clock 6: 7 + 1 = 8 does not fit in its 3 bits (0 to 7); 4 bits would hold it";
    assert_eq!((ran.code, ran.err), (1, format!("stepwave: {event}\n")));
    assert!(ran.out.contains(&format!("\nCOUNTEREXAMPLE: {event}\n  clock 0: go = 1, rst = 0\n")), "{}", ran.out);
    assert!(ran.out.contains("\nPROVED at these widths: decade.below_ten holds (in any state)\n"), "{}", ran.out);
}

#[test]
fn a_counterexample_is_run_again_from_its_stimulus_and_has_a_wave() {
    let folder = decade(3);
    let ran = prove(&folder, &["--stimulus-out", "found.csv", "--vcd", "found.vcd"]);
    assert_eq!(ran.code, 1);
    let csv = fs::read_to_string(folder.path("found.csv")).expect("a stimulus");
    assert_eq!(csv, "go,rst\n1,0\n1,0\n1,0\n1,0\n1,0\n1,0\n1,0\n");
    assert!(folder.path("found.vcd").exists() && folder.path("found.gtkw").exists());
    let ran = folder.run_words(&["sim", "t.net", "--stimulus", "found.csv", "--clocks", "6"]);
    assert!(ran.out.contains("overflow of decade.count at clock 6: 7 + 1 = 8 does not fit"), "{}", ran.out);
    // Nothing is refuted: no file.
    let ran = prove(&folder, &["--set", "go=0", "--stimulus-out", "none.csv"]);
    assert_eq!((ran.code, folder.path("none.csv").exists()), (0, false));
}

#[test]
fn the_verdicts_are_written_as_json() {
    let folder = decade(3);
    fs::write(folder.path("in.csv"), "rst\n0\n").expect("written");
    let ran = prove(&folder, &["--stimulus", "in.csv", "--hold", "rst", "--json", "-"]);
    assert_eq!(ran.code, 1);
    let json: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON alone");
    let event =
        "overflow of decade.count at clock 6: 7 + 1 = 8 does not fit in its 3 bits (0 to 7); 4 bits would hold it";
    let rows = vec![serde_json::json!([1, 0]); 7];
    assert_eq!(
        json,
        serde_json::json!({
            "schema": 1, "design": "decade", "verdict": "counterexample", "bound": 6, "induction": 5, "limit": null,
            "free": ["go"], "assumptions": [], "bench": null, "solver": null,
            "goals": [
                {
                    "name": "decade.count", "claim": "decade.count does not overflow", "source": null,
                    "verdict": "counterexample", "clock": 6, "text": event,
                    "event": {
                        "component": "decade.count", "clock": 6, "width": 3, "signed": false, "operation": "add",
                        "left": 7, "right": 1, "exact": 8, "needed_width": 4
                    },
                    "stimulus": { "inputs": ["go", "rst"], "rows": rows },
                },
                {
                    "name": "decade.below_ten", "claim": "decade.below_ten holds", "source": null, "verdict": "proved",
                    "induction": 0
                },
            ],
            "failures": [event],
        })
    );
    let ran = prove(&folder, &["--bound", "4", "--goal", "*.count", "--json", "out.json"]);
    assert_eq!(ran.code, 1);
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path("out.json")).expect("written")).expect("JSON");
    let [verdict, bound, limit, goal] = [&json["verdict"], &json["bound"], &json["limit"], &json["goals"][0]["bound"]];
    assert_eq!((verdict, bound, limit, goal), (&"unknown".into(), &4.into(), &"bound".into(), &4.into()));
    let ran = folder.run_words(&["prove", "ppc-line", "--json", "out.json"]);
    assert!(ran.err.contains("--json is of a netlist, such as F.net, and ppc-line is a model"), "{}", ran.err);
}

#[cfg(unix)]
#[test]
fn a_solver_that_disagrees_with_a_verdict_is_reported() {
    let folder = decade(4);
    let solver = super::command::solver;
    let command = solver(&folder, "unsat");
    let ran = prove(&folder, &["--solver", &command, "--json", "out.json"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let last = ran.out.lines().last().unwrap_or_default();
    assert!(last.starts_with(&format!("{command} agrees: ")), "{}", ran.out);
    let json = fs::read_to_string(folder.path("out.json")).expect("written");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((&json["solver"]["differs"], &json["solver"]["command"]), (&serde_json::json!([]), &command.into()));
    // One that does not know has not answered: the verdicts are our own.
    for (said, language) in [("unknown", &[][..]), ("c a solver\ns UNKNOWN", &["--dimacs"])] {
        let command = solver(&folder, said);
        let ran = prove(&folder, &[&["--solver", &command], language].concat());
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{}", ran.out);
        let last = ran.out.lines().last().unwrap_or_default();
        assert!(last.starts_with(&format!("{command} agrees in 0 of ")) && last.contains("has not answered"), "{last}");
    }
    let command = solver(&folder, "c a solver\nc\ns UNSATISFIABLE");
    let ran = prove(&folder, &["--solver", &command, "--dimacs"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{}", ran.out);
    let command = solver(&folder, "c a solver\ns SATISFIABLE");
    let ran = prove(&folder, &["--solver", &command, "--dimacs"]);
    assert!(ran.code == 1 && ran.err.contains(" disagrees (no violation in the first "), "{}", ran.err);
    let command = solver(&folder, "sat");
    let ran = prove(&folder, &["--solver", &command]);
    assert_eq!(ran.code, 1);
    assert!(
        ran.err.starts_with(&format!("stepwave: {command} disagrees (no violation, word by word; ")),
        "{}",
        ran.err
    );
    let ran = prove(&folder, &["--solver", "sleep 300", "--solver-seconds", "1", "--goal", "*.count"]);
    assert_eq!(ran.code, 0);
    let last = ran.out.lines().last().unwrap_or_default();
    assert_eq!(last, "sleep 300 agrees in 0 of 3 questions, and has not answered 3");
}

#[test]
fn inputs_are_fixed_in_the_rows_of_a_stimulus_and_free_after_them_unless_held() {
    let folder = decade(3);
    fs::write(folder.path("in.csv"), "go,rst\n0,1\n0,1\n0,0\n").expect("written");
    // Cleared at the edges 1 and 2, then 0, and counting from sample 3 on.
    let ran = prove(&folder, &["--stimulus", "in.csv"]);
    assert!(ran.err.contains("overflow of decade.count at clock 10"), "{}", ran.err);
    assert!(ran.out.starts_with("decade: every run from reset on; free inputs: go, rst\n"), "{}", ran.out);
    assert!(ran.out.contains("\n  clock 0: go = 0, rst = 1\n  clock 2: rst = 0\n  clock 3: go = 1\n"), "{}", ran.out);
    let ran = prove(&folder, &["--stimulus", "in.csv", "--hold", "go"]);
    assert_eq!(ran.code, 0);
    assert!(ran.out.starts_with("decade: every run from reset on; free inputs: rst\n"), "{}", ran.out);
    let ran = prove(&folder, &["--stimulus", "in.csv", "--hold", "ena"]);
    assert_eq!((ran.code, ran.out.as_str()), (2, ""));
    assert!(ran.err.contains("--hold ena matches no input of --stimulus"), "{}", ran.err);
}

#[test]
fn what_a_bound_leaves_open_is_unknown_with_the_clock_that_was_reached() {
    let ran = prove(&decade(3), &["--bound", "4", "--goal", "*.count"]);
    assert_eq!(ran.code, 1);
    assert!(
        ran.out.ends_with("\nUNKNOWN: decade.count does not overflow (no violation up to clock 4)\n"),
        "{}",
        ran.out
    );
    assert!(
        ran.err.starts_with("stepwave: not decided: decade.count does not overflow; stopped at clock 4; induction"),
        "{}",
        ran.err
    );
}

#[test]
fn a_bench_file_says_which_runs_are_looked_at() {
    let folder = decade(3);
    let bench = |text: &str| fs::write(folder.path("t.toml"), text).expect("written");
    bench("reset = { port = \"rst\", clocks = 2 }\n");
    let ran = prove(&folder, &[]);
    assert!(
        ran.out.starts_with(
            "decade: every run from reset on; free inputs: go\nbench file t.toml: rst = 1 up to clock 1, then 0\n"
        ),
        "{}",
        ran.out
    );
    // Cleared at the edges 1 and 2.
    assert!(ran.err.contains("overflow of decade.count at clock 9"), "{}", ran.err);
    // Inputs of the command line are not those of the bench file.
    let ran = prove(&folder, &["--set", "rst=0"]);
    assert!(ran.out.contains("\nbench file t.toml: it fixes no input\n"), "{}", ran.out);
    assert!(ran.err.contains("overflow of decade.count at clock 6"), "{}", ran.err);
    fs::write(folder.path("in.csv"), "go\n0\n0\n0\n0\n1\n").expect("written");
    let ran = prove(&folder, &["--stimulus", "in.csv"]);
    assert!(ran.err.contains("overflow of decade.count at clock 11"), "{}", ran.err);
    fs::write(folder.path("in.csv"), "go\n1\n").expect("written");
    let ran = prove(&folder, &["--stimulus", "in.csv", "--hold", "go", "--goal", "*.count"]);
    assert!(ran.err.contains("overflow of decade.count at clock 9"), "{}", ran.err);
    let ran = prove(&folder, &["--no-bench"]);
    assert!(ran.out.starts_with("decade: every run from reset on; free inputs: go, rst\nCOUNTER"), "{}", ran.out);
    // Constants, assumptions of either sense, and carries that may be lost.
    bench("set = { go = 0 }\n");
    let ran = prove(&folder, &["--json", "-"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let json: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(json["bench"], serde_json::json!({ "file": "t.toml", "says": ["go = 0"] }));
    for assumption in ["!go", "rst"] {
        bench(&format!("assume = [\"{assumption}\"]\n"));
        let ran = prove(&folder, &[]);
        assert_eq!(ran.code, 0, "{}", ran.err);
        let said = format!("\nassumed in every clock: assume {assumption}\nPROVED");
        assert!(ran.out.contains(&said), "{}", ran.out);
    }
    for (text, said) in [
        ("assume = [\"gone\"]", "t.toml:1: assume: there is no signal 'gone'"),
        ("assume = [\"count\"]", "t.toml:1: assume: 'count' has 3 bits where a signal of 1 bit is needed"),
        ("wraps = [\"gone\"]", "wraps = [\"gone\"]: it matches no property"),
        ("reset = { port = \"go\" }\nset = { go = 1 }", "the input 'go' is driven by `reset` already"),
    ] {
        bench(text);
        let ran = prove(&folder, &[]);
        assert!(ran.code == 2 && ran.err.contains(said), "{text}: {}", ran.err);
    }
    let ran = prove(&folder, &["--bench", "none.toml"]);
    assert!(ran.code == 2 && ran.err.contains("cannot read none.toml"), "{}", ran.err);
}

#[test]
fn options_of_models_and_of_netlists_are_not_mixed() {
    let folder = decade(4);
    for (args, said) in [
        (["prove", "t.net", "--bits", "3"].as_slice(), "--bits is of a model, and t.net is a netlist"),
        (&["prove", "t.net", "--width", "8"], "--width is of a model, and t.net is a netlist"),
        (&["prove", "ppc-line", "--bound", "8"], "--bound is of a netlist, such as F.net, and ppc-line is a model"),
        (
            &["prove", "t.net", "--goal", "acc"],
            "--goal acc: it matches no property that it can be of; there are: decade.count, ",
        ),
        (&["prove", "t.net", "--set", "g=1"], "--set g=1: there is no input 'g'"),
        (&["prove", "none/t.net"], "cannot read none/t.net"),
    ] {
        let ran = folder.run_words(args);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{args:?}");
        assert!(ran.err.contains(said), "{args:?}: {}", ran.err);
    }
}

/// A counter that steps where an input says so; it may not come to 6, and the source assumes that it makes no step at 5.
const ASSUMED: &str = "netlist t\n%0:1 = input\n%1:3 = register reset 0x0 next %3\n%2:3 = zero-extend %0\n\
    %3:3 = add %1 %2\n%4:3 = const 0x6\n%5:1 = equal %1 %4\n%6:3 = const 0x5\n%7:1 = equal %1 %6\n%8:1 = and %7 %0\n\
    %9:3 = const 0x4\n%10:1 = equal %1 %9\nname %0 in 0 \"step\" unsigned\nname %1 in 0 \"count\" unsigned\n\
    property \"assert at t.v:7\" never %5 invariant\nproperty \"assume at t.v:8\" never %8 assumption\n\
    property \"cover at t.v:9\" never %10 cover\n";

#[test]
fn runs_that_violate_an_assumption_are_not_looked_at_and_reported_by_sim() {
    let folder = Folder::new();
    let write = |text: &str| fs::write(folder.path("t.net"), text).expect("written");
    write(ASSUMED);
    let ran = prove(&folder, &[]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{}", ran.out);
    assert!(
        ran.out.contains("\nassumed in every clock: assume at t.v:8\nPROVED at these widths: assert at t.v:7 holds")
    );
    let ran = folder.run_words(&["sim", "t.net", "--set", "step=1", "--clocks", "5"]);
    assert_eq!(ran.code, 0);
    assert!(
        ran.out.starts_with("5 clocks; no property was violated\nnote: assume at t.v:8 does not hold at clock 5: ")
    );
    assert!(ran.out.ends_with("\nnote: cover at t.v:9 is reached at clock 4\n"), "{}", ran.out);
    // A stimulus may be asked to end where it does what the source excludes; a cover ends nothing.
    let ran = folder.run_words(&["sim", "t.net", "--set", "step=1", "--clocks", "9", "--strict", "assume*"]);
    assert!(ran.out.starts_with("5 clocks; "), "{}", ran.out);
    let ran = folder.run_words(&["sim", "t.net", "--clocks", "5", "--strict", "cover*"]);
    assert!(ran.code == 2 && ran.err.contains("it matches no property that it can be of"), "{}", ran.err);
    let ran = folder.run_words(&["sim", "t.net", "--clocks", "5"]);
    assert_eq!(ran.out, "5 clocks; no property was violated\nnote: cover at t.v:9 is never reached\n");
    write(&ASSUMED.replace("%8 assumption", "%8 cover"));
    let ran = prove(&folder, &[]);
    assert_eq!(ran.err, "stepwave: invariant assert at t.v:7 does not hold at clock 6\n");
    // At 6 it is too late.
    write(&ASSUMED.replace("and %7 %0", "and %5 %0"));
    assert_eq!(prove(&folder, &[]).code, 1);
    // Assumptions that no run meets after clock 0: it steps, and does not come to 1.
    let none = ASSUMED.replace("and %7 %0", "not %0").replace("const 0x4", "const 0x1");
    write(&none.replace("%10 cover", "%10 assumption"));
    let ran = prove(&folder, &[]);
    assert_eq!(ran.code, 1);
    assert!(
        ran.err.contains("no run meets the assumptions up to clock 1, so that nothing later can be said"),
        "{}",
        ran.err
    );
}

#[test]
fn exports_have_assumptions_as_constraints_and_no_cover() {
    let netlist = text::parse(ASSUMED).expect("text");
    assert_eq!(text::print(&netlist), ASSUMED);
    let design = elaborate(netlist).expect("a netlist");
    let checking = Checking { comment: &[], held: &[] };
    let model = btor2(&design, &checking).expect("no memory");
    let lines = |word: &str| model.lines().filter(|line| line.split(' ').nth(1) == Some(word)).count();
    assert_eq!([lines("bad"), lines("constraint")], [1, 1], "{model}");
    let script = smt2(&design, &checking, 3).expect("no memory");
    // Of every clock from 0 to 3.
    assert_eq!(script.lines().filter(|line| line.starts_with("(assert (= ")).count(), 4, "{script}");
}

#[test]
fn exports_claim_nothing_of_a_carry_that_is_announced_to_be_lost() {
    let text = "netlist t\n%0:2 = input\n%1:2 = register reset 0x0 next %2\n%2:2 = add %1 %0\n%3:1 = carry %1 %0\n\
                name %1 in 0 \"phase\" unsigned\nproperty \"t.phase\" never %3 fits 2 unsigned add %1 unsigned %0 unsigned";
    for (end, claims) in [("\n", 1), (" wraps\n", 0)] {
        let design = elaborate(text::parse(&format!("{text}{end}")).expect("text")).expect("a netlist");
        let model = btor2(&design, &Checking::default()).expect("no memory");
        assert_eq!(model.matches(" bad ").count(), claims, "{model}");
        let script = smt2(&design, &Checking::default(), 1).expect("no memory");
        assert_eq!(script.matches("; never.t.phase").count(), claims, "{script}");
    }
}
