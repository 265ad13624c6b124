//! What cannot be simulated on one clock is refused in a sentence with the cell, its name and its line.

use serde_json::{Value, json};

use super::{cell, imported, module, name, port};

fn refused(ports: Value, cells: Value, names: Value) -> String {
    imported(&module(ports, cells, names)).expect_err("a refusal").to_string()
}

fn register(clock: u32, q: u32) -> Value {
    cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [clock], "D": ["1"], "Q": [q] }))
}

#[test]
fn two_clocks_are_refused_with_both_names_and_a_register_of_each() {
    let ports =
        json!({ "a": port("input", [2]), "b": port("input", [3]), "p": port("output", [4]), "q": port("output", [5]) });
    let names = json!({ "a": name([2]), "b": name([3]), "p": name([4]), "q": name([5]) });
    let said = refused(ports, json!({ "x": register(2, 4), "y": register(3, 5) }), names);
    assert_eq!(
        said,
        "two clocks: the rising edge of 'a' of $dff 'p' (t.v:7), and the rising edge of 'b' of $dff 'q' (t.v:7); a design \
         is simulated on one edge of one clock"
    );
}

#[test]
fn a_clock_that_a_cell_computes_is_refused() {
    let gate = cell("$and", &[], json!({ "A": [2], "B": [3], "Y": [6] }));
    let ports = json!({ "a": port("input", [2]), "b": port("input", [3]), "q": port("output", [5]) });
    let names = json!({ "gated": name([6]), "q": name([5]) });
    let said = refused(ports, json!({ "g": gate, "x": register(6, 5) }), names);
    assert!(said.starts_with("the clock 'gated' of $dff 'q' (t.v:7) is driven by $and 'gated' (t.v:7)"), "{said}");
}

#[test]
fn a_clock_that_is_read_as_data_is_refused() {
    let ports = json!({ "clk": port("input", [2]), "q": port("output", [5]), "copy": port("output", [2]) });
    let said = refused(ports, json!({ "x": register(2, 5) }), json!({ "clk": name([2]) }));
    assert!(said.starts_with("the clock 'clk' is read as data by output 'copy'"), "{said}");
}

#[test]
fn latches_tristate_and_unknown_cells_are_refused_by_name_and_line() {
    for (kind, why) in
        [("$dlatch", "a latch"), ("$tribuf", "a tristate"), ("$nonsense", "not known"), ("adder", "not defined")]
    {
        let pins = if kind == "$dlatch" { json!({ "D": [3], "Q": [4] }) } else { json!({ "A": [3], "Y": [4] }) };
        let cells = json!({ "c": cell(kind, &[], pins) });
        let ports = json!({ "a": port("input", [3]), "y": port("output", [4]) });
        let said = refused(ports, cells, json!({ "y": name([4]) }));
        assert!(said.starts_with(&format!("{kind} 'y' (t.v:7): ")) && said.contains(why), "{said}");
    }
}

#[test]
fn a_loop_is_refused_with_every_cell_of_it() {
    let cells = json!({
        "a": cell("$not", &[], json!({ "A": [4], "Y": [3] })),
        "b": cell("$not", &[], json!({ "A": [3], "Y": [4] })),
    });
    let said = refused(json!({ "y": port("output", [4]) }), cells, json!({ "p": name([3]), "q": name([4]) }));
    assert_eq!(said, "a combinational loop through $not 'q' (t.v:7), then $not 'p' (t.v:7)");
}

#[test]
fn what_is_no_json_of_yosys_and_a_module_that_is_not_there_are_refused() {
    assert!(imported("{").expect_err("no JSON").to_string().starts_with("not the JSON that Yosys writes"));
    let text = module(json!({}), json!({}), json!({}));
    let options = stepwave::import::Options { top: Some("u".to_owned()), ..Default::default() };
    let said = stepwave::import::import(&text, &options).expect_err("no module").to_string();
    assert_eq!(said, "there is not module 'u'; the modules there are: t");
}

#[test]
fn two_drivers_of_a_net_are_refused() {
    let cells = json!({
        "a": cell("$not", &[], json!({ "A": [3], "Y": [4] })),
        "b": cell("$not", &[], json!({ "A": [3], "Y": [4] })),
    });
    let ports = json!({ "x": port("input", [3]), "y": port("output", [4]) });
    let said = refused(ports, cells, json!({ "y": name([4]) }));
    assert_eq!(said, "net 'y' is driven by $not 'y' (t.v:7) and by $not 'y' (t.v:7)");
}
