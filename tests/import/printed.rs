//! Texts that a source prints: at its edge, with the numbers of the sample before it.

use serde_json::{Value, json};
use stepwave::netlist::cells::Claim;
use stepwave::netlist::{elaborate, text};
use stepwave::own::{Sim, Stimulus};

use super::{cell, module, name, port};
use crate::cli::Folder;

/// A counter q of 4 bits that counts while en is 1, and a cell that prints.
fn counter(print: Value) -> String {
    let cells = json!({
        "sum": cell("$add", &[], json!({ "A": [10, 11, 12, 13], "B": ["1"], "Y": [20, 21, 22, 23] })),
        "q": cell("$dffe", &["CLK_POLARITY", "EN_POLARITY"], json!({ "CLK": [2], "EN": [3], "D": [20, 21, 22, 23], "Q": [10, 11, 12, 13] })),
        "print": print,
    });
    let ports = json!({ "clk": port("input", [2]), "en": port("input", [3]), "q": port("output", 10..14) });
    module(ports, cells, json!({ "clk": name([2]), "en": name([3]), "q": name(10..14) }))
}

fn print(format: &str, trigger: &[u32], pins: Value) -> Value {
    let mut print = cell("$print", &["TRG_ENABLE", "TRG_POLARITY"], pins);
    print["parameters"]["FORMAT"] = json!(format);
    print["connections"]["TRG"] = json!(trigger);
    print
}

fn printed(source: &str, clocks: u64) -> String {
    let design = super::design(source);
    let stimulus = Stimulus::constants(&design, [("en", "1")]).expect("a value");
    let mut shown = Vec::new();
    Sim::new(design, stimulus, clocks).run_printing(&mut shown).expect("a run");
    String::from_utf8(shown).expect("text")
}

#[test]
fn a_text_is_printed_at_each_edge_with_the_numbers_before_it() {
    let pins = json!({ "EN": [3], "ARGS": [10, 11, 12, 13, 13] });
    let source = counter(print("q={4:> 2d-u} high {1:>01h-u} at {0:> 5t}\n", &[2], pins));
    // Three edges: the sample after the last one prints nothing.
    assert_eq!(printed(&source, 3), "q= 0 high 0 at    10\nq= 1 high 0 at    20\nq= 2 high 0 at    30\n");
    assert_eq!(printed(&source, 300).lines().count(), 300);
    assert_eq!(printed(&source, 10).lines().last(), Some("q= 9 high 1 at   100"));
}

#[test]
fn a_text_of_the_beginning_is_printed_once() {
    let source = counter(print("hello\n", &[], json!({ "EN": ["1"], "ARGS": [] })));
    assert_eq!(printed(&source, 100), "hello\n");
}

#[test]
fn a_text_at_another_edge_is_noted() {
    let source = counter(print("x", &[3], json!({ "EN": ["1"], "ARGS": [] })));
    let imported = super::imported(&source).expect("an import");
    let [open, note] = &imported.notes[..] else { panic!("{:?}", imported.notes) };
    assert_eq!(note, "print at t.v:7 is not looked at: it is not printed at the edge of the clock");
    assert!(open.starts_with("1 register has no initial value"), "{open}");
}

#[test]
fn the_text_form_has_what_is_printed() {
    let pins = json!({ "EN": [3], "ARGS": [10, 11, 12, 13] });
    let source = counter(print("{{\"{4:> 2d-u}\"}}\n", &[2], pins));
    let design = super::design(&source);
    let form = design.netlist().to_string();
    let again = elaborate(text::parse(&form).expect("the form")).expect("a netlist");
    assert_eq!(again.netlist().properties, design.netlist().properties);
    let is_print = |claim: &Claim| matches!(claim, Claim::Print { once: false, .. });
    assert!(again.netlist().properties.iter().any(|property| is_print(&property.claim)), "{form}");
    // Another number of bits than the text shows.
    let wrong = elaborate(text::parse(&form.replace("{4:>", "{5:>")).expect("the form")).expect_err("widths");
    assert!(wrong.to_string().contains("the text shows other widths than its numbers have"), "{wrong}");
}

#[test]
fn sim_prints_before_its_report_and_not_into_a_file() {
    let pins = json!({ "EN": [3], "ARGS": [10, 11, 12, 13] });
    let folder = Folder::new();
    folder.write("t.json", &counter(print("q {4:> 0d-u}\n", &[2], pins)));
    folder.good("import --json t.json -o t.net");
    assert_eq!(folder.good("sim t.net --set en=1 --clocks 2"), "q 0\nq 1\n2 clocks; no property was violated\n");
    let to_file = folder.run("sim t.net --set en=1 --clocks 2 --json -");
    assert_eq!((to_file.code, to_file.err.as_str()), (0, "q 0\nq 1\n"));
    assert!(serde_json::from_str::<Value>(&to_file.out).is_ok(), "{}", to_file.out);
}

#[test]
fn a_cell_of_a_flattened_module_has_its_own_line() {
    let places = |src: &str| {
        let mut sum = cell("$add", &[], json!({ "A": [10, 11], "B": ["1"], "Y": [20, 21] }));
        sum["attributes"]["src"] = json!(src);
        let cells = json!({ "sum": sum, "q": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": [20, 21], "Q": [10, 11] })) });
        let ports = json!({ "clk": port("input", [2]), "q": port("output", 10..12) });
        let design = super::design(&module(ports, cells, json!({ "clk": name([2]), "q": name(10..12) })));
        let netlist = design.netlist();
        netlist.properties.iter().find_map(|property| netlist.line_of(property.never)).expect("an overflow")
    };
    // As Yosys 0.23 joins the places of a cell and of the instances around it, in modules one, two and three deep.
    assert_eq!(places("t.v:4.1-4.2"), "t.v:4");
    assert_eq!(places("t.v:9.1-9.2|t.v:4.1-4.2"), "t.v:4");
    assert_eq!(places("t.v:12.6-12.19|t.v:4.1-4.2|t.v:6.8-6.20"), "t.v:4");
    assert_eq!(places("t.v:4.1-4.2|t.v:0.0-0.0"), "t.v:4");
}
