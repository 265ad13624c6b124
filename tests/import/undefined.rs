//! Events of operations without a result: divisions by 0, addresses outside of a memory.

use serde_json::{Value, json};

use super::{cell, design, module, name, port, samples};
use crate::cli::{Folder, Ran};

/// A register of 3 bits that takes a quotient or remainder while it is enabled.
fn divider(kind: &str, signs: &[&str]) -> String {
    let cells = json!({
        "div": cell(kind, signs, json!({ "A": [10, 11, 12], "B": [13, 14, 15], "Y": [16, 17, 18] })),
        "ff": cell("$dffe", &["CLK_POLARITY", "EN_POLARITY"], json!({ "CLK": [2], "EN": [3], "D": [16, 17, 18], "Q": [4, 5, 6] })),
    });
    let ports = json!({
        "clk": port("input", [2]), "en": port("input", [3]), "a": port("input", 10..13), "b": port("input", 13..16),
        "q": port("output", 4..7),
    });
    let names = json!({ "clk": name([2]), "en": name([3]), "a": name(10..13), "b": name(13..16), "q": name(4..7) });
    module(ports, cells, names)
}

/// A memory of this many words of 4 bits with an address of 2, whose lowest is `from`; it is read in every clock.
fn memory(words: u32, from: u32) -> String {
    let number = |number: u32| format!("{number:032b}");
    let parameters = json!({
        "ABITS": number(2), "WIDTH": number(4), "SIZE": number(words), "OFFSET": number(from), "INIT": "",
        "RD_PORTS": number(1), "RD_CLK_ENABLE": "0", "WR_PORTS": number(1), "WR_CLK_ENABLE": "1", "WR_CLK_POLARITY": "1",
    });
    let pins = json!({
        "RD_ADDR": [3, 4], "RD_DATA": [5, 6, 7, 8], "RD_EN": ["1"], "RD_CLK": ["x"], "RD_ARST": ["0"], "RD_SRST": ["0"],
        "WR_ADDR": [3, 4], "WR_DATA": ["1", "0", "1", "0"], "WR_EN": [9, 9, 9, 9], "WR_CLK": [2],
    });
    let memory: Value = json!({
        "type": "$mem_v2", "attributes": { "src": "t.v:4.3-4.9" }, "parameters": parameters, "connections": pins,
    });
    // The word is taken while `en` is 0.
    let cells = json!({
        "mem": memory,
        "mux": cell("$mux", &[], json!({ "A": [5, 6, 7, 8], "B": ["0", "0", "0", "0"], "S": [9], "Y": [20, 21, 22, 23] })),
    });
    let ports = json!({ "clk": port("input", [2]), "at": port("input", [3, 4]), "en": port("input", [9]), "q": port("output", 20..24) });
    let names = json!({ "clk": name([2]), "at": name([3, 4]), "en": name([9]), "q": name(20..24) });
    module(ports, cells, names)
}

fn imported(text: &str) -> Folder {
    let folder = Folder::new();
    folder.write("t.json", text);
    folder.good("import --json t.json -o t.net");
    folder
}

fn sim(folder: &Folder, args: &[&str]) -> Ran {
    folder.run_words(&[&["sim", "t.net", "--stimulus", "in.csv", "--clocks", "8"], args].concat())
}

#[test]
fn a_division_by_zero_is_an_event_only_where_its_result_is_taken() {
    for (kind, signs, said) in [
        ("$div", &[][..], "t.v:7: division by zero of t.q at clock 2: 6 / 0 (2 times)"),
        ("$mod", &["A_SIGNED", "B_SIGNED"][..], "t.v:7: division by zero of t.q at clock 2: -2 % 0 (2 times)"),
    ] {
        let text = divider(kind, signs);
        let rows = samples(
            &design(&text),
            &["t.undefined.q"],
            &[&[("en", 1), ("a", 6), ("b", 3)], &[("b", 0), ("en", 0)], &[("en", 1)], &[], &[("b", 7)]],
        );
        assert_eq!(rows.concat(), [0, 0, 1, 1, 0], "{kind}");
        let folder = imported(&text);
        folder.write("in.csv", "en,a,b\n1,6,3\n0,6,0\n1,6,0\n1,5,0\n1,1,1\n");
        let ran = sim(&folder, &["--json", "r.json"]);
        assert!(ran.code == 0 && ran.out.contains(said), "{}", ran.out);
        let report: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
        let first = &report["events"][0]["first"];
        assert_eq!(
            (&first["clock"], &first["right"], &report["events"][0]["count"]),
            (&json!(2), &json!(0), &json!(2))
        );
        let strict = sim(&folder, &["--strict", "q"]);
        assert!(strict.code == 1 && strict.out.starts_with("2 clocks"), "{strict:?}");
        assert!(strict.err.contains("division by zero of t.q at clock 2"), "{}", strict.err);
        let wraps = sim(&folder, &["--wraps", "q"]);
        let said = "--wraps q: t.q is watched for a division by zero, which has no carry to lose: leave it out";
        assert!(wraps.code == 2 && wraps.err.contains(said), "{}", wraps.err);
    }
}

#[test]
fn a_divisor_that_is_never_zero_has_no_event() {
    let text = divider("$div", &[]).replace("\"B\":[13,14,15]", "\"B\":[\"1\",14,15]");
    assert!(design(&text).netlist().properties.is_empty());
}

#[test]
fn an_address_outside_of_a_memory_is_an_event_where_its_word_is_taken_or_written() {
    let folder = imported(&memory(3, 0));
    folder.write("in.csv", "at,en\n0,0\n3,1\n3,0\n3,0\n2,1\n");
    let ran = sim(&folder, &["--vcd", "t.vcd"]);
    for said in [
        "t.v:4: read outside of t.mem at clock 2: address 3; it has 3 words (0 to 2) (2 times)",
        "t.v:4: write outside of t.mem at clock 1: address 3; it has 3 words (0 to 2) (once)",
    ] {
        assert!(ran.code == 0 && ran.out.contains(said), "{}", ran.out);
    }
    let wave = crate::waves::read(&std::fs::read(folder.path("t.vcd")).expect("a wave"));
    let flags: Vec<String> = (0..6)
        .map(|clock| {
            ["mem", "mem_2"]
                .map(|flag| wave.variables[&format!("t.undefined.{flag}")].at(10 * clock).unwrap_or("-"))
                .concat()
        })
        .collect();
    assert_eq!(flags, ["00", "01", "10", "10", "00", "00"]);
    let text = design(&memory(3, 0)).netlist().to_string();
    assert!(
        text.contains(" read %0 unsigned words 3 from 0\n") && text.contains(" write %0 unsigned words 3 from 0\n"),
        "{text}"
    );
    assert_eq!(stepwave::netlist::text::parse(&text).expect("the same"), *design(&memory(3, 0)).netlist());
}

#[test]
fn a_memory_that_holds_every_address_has_no_event_and_one_that_begins_later_has() {
    assert!(design(&memory(4, 0)).netlist().properties.is_empty());
    let folder = imported(&memory(3, 1));
    folder.write("in.csv", "at,en\n1,0\n0,0\n3,0\n");
    let ran = sim(&folder, &[]);
    assert!(
        ran.out.contains("read outside of t.mem at clock 1: address 0; it has 3 words (1 to 3) (once)"),
        "{}",
        ran.out
    );
}
