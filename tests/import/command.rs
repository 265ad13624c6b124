//! `stepwave import --json`, `check` and `sim` as their users meet them.

use std::fs;

use serde_json::json;
use stepwave::engine::{EngineKind, Rows, Watch};
use stepwave::netlist::cells::Claim;

use super::{cell, module, name, port};
use crate::cli::{Folder, Ran};

/// A counter of 3 bits whose sum has 3 bits, in a file.
fn counter() -> Folder {
    let folder = Folder::new();
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": [4, 5, 6], "B": ["1"], "Y": [7, 8, 9] })),
        "ff": cell("$dffe", &["CLK_POLARITY", "EN_POLARITY"], json!({ "CLK": [2], "EN": [3], "D": [7, 8, 9], "Q": [4, 5, 6] })),
    });
    let ports = json!({ "clk": port("input", [2]), "en": port("input", [3]), "q": port("output", [4, 5, 6]) });
    let names = json!({ "clk": name([2]), "en": name([3]), "q": name([4, 5, 6]) });
    fs::write(folder.path("t.json"), module(ports, cells, names)).expect("written");
    let ran = folder.run_words(&["import", "--json", "t.json", "-o", "t.net"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let note = "note: 1 register has no initial value and begins with 0, in proofs too: --x 1 and --x random:SEED begin otherwise\n";
    assert!(ran.out.ends_with(&format!("clock: the rising edge of clk\n{note}")), "{}", ran.out);
    folder
}

fn sim(folder: &Folder, args: &[&str]) -> Ran {
    folder.run_words(&[&["sim", "t.net"], args].concat())
}

#[test]
fn an_imported_netlist_is_checked_and_run() {
    let folder = counter();
    let checked = folder.run_words(&["check", "t.net"]);
    assert_eq!(checked.code, 0);
    assert!(
        checked.out.starts_with("t: ") && checked.out.contains("1 registers of 3 bits together, 1 inputs"),
        "{checked:?}"
    );
    let ran = sim(&folder, &["--set", "en=1", "--clocks", "20", "--vcd", "t.vcd", "--json", "t.report.json"]);
    assert_eq!(ran.code, 0);
    assert!(
        ran.out.contains("t.v:7: overflow of t.q at clock 7: 7 + 1 = 8 does not fit in its 3 bits (0 to 7)"),
        "{}",
        ran.out
    );
    assert!(ran.out.contains("(2 times, 4 bits would hold all)"), "{}", ran.out);
    let report: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path("t.report.json")).expect("a report")).expect("JSON");
    assert_eq!((&report["last"]["t.q"], &report["events"][0]["count"]), (&json!("100"), &json!(2)));
    assert!(folder.path("t.vcd").exists() && folder.path("t.gtkw").exists());
}

#[test]
fn a_strict_property_ends_the_run_with_code_1_and_an_announced_one_is_none() {
    let folder = counter();
    let strict = sim(&folder, &["--set", "en=1", "--clocks", "20", "--strict", "q"]);
    assert_eq!(strict.code, 1);
    assert!(strict.out.starts_with("7 clocks; 1 property was violated"), "{}", strict.out);
    assert!(strict.err.starts_with("stepwave: t.v:7: overflow of t.q at clock 7"), "{}", strict.err);
    let wraps = sim(&folder, &["--set", "en=1", "--clocks", "20", "--wraps", "t.*"]);
    assert_eq!((wraps.code, wraps.out.as_str()), (0, "20 clocks; no property was violated\n"));
    let nothing = sim(&folder, &["--clocks", "20", "--strict", "acc"]);
    assert_eq!(
        (nothing.code, nothing.err.as_str()),
        (2, "stepwave: --strict acc: it matches no property that it can be of; there are: t.q\n")
    );
}

#[test]
fn rows_of_a_stimulus_are_taken_from_the_edge_before_and_the_last_is_held() {
    let folder = counter();
    // Edge k + 1 samples row k.
    fs::write(folder.path("in.csv"), "en\n1\n0\n0b1\n0\n").expect("written");
    let ran = sim(&folder, &["--stimulus", "in.csv", "--clocks", "9", "--json", "-"]);
    let report: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(report["last"]["t.q"], json!("010"));
}

#[test]
fn a_stimulus_that_does_not_fit_is_refused_with_its_line() {
    let folder = counter();
    let refused = |text: &str, said: &str| {
        fs::write(folder.path("in.csv"), text).expect("written");
        let ran = sim(&folder, &["--stimulus", "in.csv", "--clocks", "3"]);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{text}");
        assert!(ran.err.contains(said), "{text}: {}", ran.err);
    };
    refused("ena\n1\n", "in.csv: line 1: there is no input 'ena'");
    refused("en\n1,0\n", "line 2 has 2 values where the first line names 1 inputs");
    refused("en\n2\n", "line 2: 2 does not fit in 'en', which has 1 bits");
    refused("en\n+1\n", "line 2: '+1' is not a value for 'en'");
    refused("en,en\n1,1\n", "line 1: input 'en' is given twice");
    refused("", "the first line must name inputs");
    let both = sim(&folder, &["--set", "en=1", "--set", "en=0", "--clocks", "3"]);
    assert!(both.code == 2 && both.err.contains("--set en=0: input 'en' is given twice"), "{}", both.err);
}

#[test]
fn a_netlist_with_mistakes_is_refused_and_check_lists_all_of_them() {
    let folder = counter();
    fs::write(folder.path("bad.net"), "netlist m\n%0:3 = input\n%1:4 = not %0\n%2:4 = register reset 0x0\n")
        .expect("written");
    let checked = folder.run_words(&["check", "bad.net"]);
    assert_eq!((checked.code, checked.err.lines().count()), (2, 2), "{}", checked.err);
    let ran = folder.run_words(&["sim", "bad.net", "--clocks", "1"]);
    assert!(
        ran.code == 2 && ran.err.contains("bad.net is not a netlist: ") && ran.err.contains("one other mistake"),
        "{}",
        ran.err
    );
    let none = folder.run_words(&["sim", "none.net", "--clocks", "1"]);
    assert!(none.code == 2 && none.err.starts_with("stepwave: cannot read none.net: "), "{}", none.err);
}

#[test]
fn a_model_in_the_text_form_runs_as_its_netlist() {
    let folder = Folder::new();
    let ran = folder.run_words(&["export", "dda-line", "--to", "8,6", "--width", "4", "--netlist", "line.net"]);
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
    let ran = folder.run_words(&["sim", "line.net", "--clocks", "5", "--set", "block.load=0"]);
    assert_eq!((ran.code, ran.out.as_str()), (0, "5 clocks; no property was violated\n"));
}

#[test]
fn a_property_that_is_strict_and_announced_is_refused_and_so_is_an_announcement_of_an_assertion() {
    let folder = counter();
    let both = sim(&folder, &["--set", "en=1", "--clocks", "20", "--strict", "q", "--wraps", "q"]);
    assert_eq!((both.code, both.out.as_str()), (2, ""));
    assert!(both.err.contains("--strict q: t.q is announced to lose its carry"), "{}", both.err);
    let text = folder.read("t.net") + "property \"t.sure\" never %0 invariant\n";
    folder.write("t.net", &text);
    let none = sim(&folder, &["--clocks", "2", "--wraps", "sure"]);
    assert!(
        none.code == 2 && none.err.contains("--wraps sure: it matches no property that it can be of; there are: t.q"),
        "{}",
        none.err
    );
    // Both are violated in one clock; the one that is strict ends the run, and the assertion fails it anyway.
    let ran = sim(&folder, &["--set", "en=1", "--clocks", "20", "--strict", "sure"]);
    assert_eq!((ran.code, ran.err.as_str()), (1, "stepwave: invariant t.sure does not hold at clock 0\n"));
}

#[test]
fn a_trap_names_the_strict_property_and_not_one_that_came_before() {
    let folder = counter();
    let text = folder.read("t.net");
    let never = text.lines().find_map(|line| line.split_once("\"t.q\" never ")).expect("a property").1;
    // A second property of the same net: it is violated in the same clock.
    folder.write("t.net", &format!("{text}property \"t.another\" never {never}\n"));
    for strict in ["q", "another"] {
        let ran = sim(&folder, &["--set", "en=1", "--clocks", "20", "--strict", strict]);
        assert_eq!(ran.code, 1);
        assert!(
            ran.err.contains(&format!("overflow of t.{strict} at clock 7")) && ran.err.lines().count() == 1,
            "{}",
            ran.err
        );
    }
}

#[test]
fn the_netlist_of_the_page_on_the_text_form_is_one() {
    let page = include_str!("../../docs/netlist.md");
    let text = page.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a netlist");
    let folder = Folder::new();
    folder.write("counter.net", text);
    let checked = folder.good("check counter.net");
    assert!(checked.starts_with("counter: 6 cells, 1 registers of 4 bits together"), "{checked}");
}

#[test]
fn assertions_assumptions_and_covers_become_properties() {
    let check = |flavour: &str, condition: u32| {
        let pins = json!({ "A": [condition], "EN": [5] });
        let mut check = cell("$check", &[], pins);
        check["parameters"]["FLAVOR"] = json!(flavour);
        check
    };
    let cells = json!({
        "a": cell("$assume", &[], json!({ "A": [3], "EN": [5] })),
        "b": cell("$cover", &[], json!({ "A": [4], "EN": [5] })),
        "c": check("assume ", 4),
        "d": check("assert", 3),
    });
    let ports = json!({ "a": port("input", [3]), "b": port("input", [4]), "e": port("input", [5]) });
    let design = super::design(&module(ports, cells, json!({ "a": name([3]), "b": name([4]), "e": name([5]) })));
    let claims: Vec<_> =
        design.netlist().properties.iter().map(|property| (property.name.as_str(), &property.claim)).collect();
    let (assumption, cover) = (&Claim::Assumption, &Claim::Cover);
    assert_eq!(
        claims,
        [
            ("assume at t.v:7", assumption),
            ("cover at t.v:7", cover),
            ("assume at t.v:7", assumption),
            ("assert at t.v:7", &Claim::Invariant)
        ]
    );
    // Enabled with a = 1, b = 0: the first assumption holds, the second does not, and the cover is not reached.
    let flags: Vec<_> = design.netlist().properties.iter().map(|property| property.never).collect();
    let mut engine = EngineKind::Gates.build(&design, &Watch::default());
    let set = |name: &str| design.netlist().find(name).expect("an input").net;
    engine.set_input(set("a"), 1);
    engine.set_input(set("e"), 1);
    engine.reset(&mut Rows::new(0, 1));
    assert_eq!(flags.iter().map(|&net| engine.value(net)).collect::<Vec<_>>(), [0, 0, 1, 0]);
}
