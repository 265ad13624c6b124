//! What cells do; `.ci/cells.py` compares all of them with Icarus.

use serde_json::json;
use stepwave::netlist::cells::Op;

use super::{cell, design, imported, module, name, port, samples};

#[test]
fn a_register_with_an_asynchronous_reset_shows_it_in_the_same_sample() {
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": [4, 5], "B": ["1", "0"], "Y": [6, 7] })),
        "ff": { "type": "$adff", "parameters": { "ARST_VALUE": "10", "ARST_POLARITY": "0", "CLK_POLARITY": "1" },
                "connections": { "CLK": [2], "ARST": [3], "D": [6, 7], "Q": [4, 5] } },
    });
    let ports = json!({ "clk": port("input", [2]), "rst_n": port("input", [3]), "q": port("output", [4, 5]) });
    let names = json!({ "clk": name([2]), "rst_n": name([3]), "q": name([4, 5]) });
    let design = design(&module(ports, cells, names));
    let (high, low) = (&[("rst_n", 1)][..], &[("rst_n", 0)][..]);
    let rows = samples(&design, &["q"], &[high, high, high, low, low, high, high]);
    let values: Vec<u64> = rows.into_iter().flatten().collect();
    assert_eq!(values, [0, 1, 2, 2, 2, 2, 3]);
}

/// A counter of 87 or more bits that begins with this many low ones.
fn counter(bits: u32, ones: usize) -> stepwave::netlist::Design {
    let (a, y): (Vec<u32>, Vec<u32>) = ((10..10 + bits).collect(), (300..300 + bits).collect());
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": a, "B": ["1"], "Y": y })),
        "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": y, "Q": a })),
    });
    let init = format!("{}{}", "0".repeat(bits as usize - ones), "1".repeat(ones));
    let wide = json!({ "hide_name": 0, "bits": a, "attributes": { "init": init } });
    let ports = json!({ "clk": port("input", [2]), "acc": { "direction": "output", "bits": a } });
    design(&module(ports, cells, json!({ "clk": name([2]), "acc": wide })))
}

#[test]
fn wide_words_add_with_the_carry_from_part_to_part() {
    let rows = samples(&counter(87, 64), &["acc"], &[&[], &[], &[]]);
    assert_eq!(rows, [[u64::MAX, 0], [0, 1], [1, 1]]);
    // The carry goes through a part that is all ones.
    let rows = samples(&counter(130, 128), &["acc"], &[&[], &[], &[]]);
    assert_eq!(rows, [[u64::MAX, u64::MAX, 0], [0, 0, 1], [1, 0, 1]]);
}

#[test]
fn a_word_that_depends_on_itself_bit_by_bit_is_no_loop() {
    // Gray code to binary: b = g ^ (b >> 1).
    let cells = json!({ "xor": cell("$xor", &[], json!({ "A": [3, 4, 5], "B": [7, 8, "0"], "Y": [6, 7, 8] })) });
    let ports = json!({ "g": port("input", [3, 4, 5]), "b": port("output", [6, 7, 8]) });
    let design = design(&module(ports, cells, json!({ "g": name([3, 4, 5]), "b": name([6, 7, 8]) })));
    let inputs: Vec<[(&str, u64); 1]> = (0..8).map(|n: u64| [("g", n ^ n >> 1)]).collect();
    let rows: Vec<&[(&str, u64)]> = inputs.iter().map(<[_; 1]>::as_slice).collect();
    let values: Vec<u64> = samples(&design, &["b"], &rows).into_iter().flatten().collect();
    assert_eq!(values, [0, 1, 2, 3, 4, 5, 6, 7]);
}

#[test]
fn a_sum_that_depends_on_its_lower_bits_alone_is_no_loop() {
    // y = 2 * y + a is -a; what comes after it is not taken apart.
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": ["0", 6, 7], "B": [3, 4, 5], "Y": [6, 7, 8] })),
        "after": cell("$add", &[], json!({ "A": [6, 7, 8], "B": [3, 4, 5], "Y": [9, 10, 11] })),
    });
    let ports =
        json!({ "a": port("input", [3, 4, 5]), "y": port("output", [6, 7, 8]), "z": port("output", [9, 10, 11]) });
    let names = json!({ "a": name([3, 4, 5]), "y": name([6, 7, 8]), "z": name([9, 10, 11]) });
    let design = design(&module(ports, cells, names));
    let inputs: Vec<[(&str, u64); 1]> = (0..8).map(|n: u64| [("a", n)]).collect();
    let rows: Vec<&[(&str, u64)]> = inputs.iter().map(<[_; 1]>::as_slice).collect();
    let rows = samples(&design, &["y", "z"], &rows);
    assert_eq!(rows, (0..8).map(|n| [(8 - n) % 8, 0]).collect::<Vec<_>>());
    // Three bits of the one, and the other whole; what is looked at for overflow is wider.
    let sums = design.netlist().cells.iter().filter(|cell| matches!(cell.op, Op::Add(..)) && cell.width.get() <= 3);
    assert_eq!(sums.count(), 4, "{}", design.netlist());
}

#[test]
fn a_bit_of_a_sum_waits_for_every_bit_below() {
    // y = a + 2 * !y[0]: the highest bit depends on the lowest by the carry alone.
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": ["0", 9, "0"], "B": [3, 4, 5], "Y": [6, 7, 8] })),
        "not": cell("$not", &[], json!({ "A": [6], "Y": [9] })),
    });
    let ports = json!({ "a": port("input", [3, 4, 5]), "y": port("output", [6, 7, 8]) });
    let design = design(&module(ports, cells, json!({ "a": name([3, 4, 5]), "y": name([6, 7, 8]) })));
    let inputs: Vec<[(&str, u64); 1]> = (0..8).map(|n: u64| [("a", n)]).collect();
    let rows: Vec<&[(&str, u64)]> = inputs.iter().map(<[_; 1]>::as_slice).collect();
    let values = samples(&design, &["y"], &rows).concat();
    assert_eq!(values, (0..8).map(|a| (a + 2 * (1 - a % 2)) % 8).collect::<Vec<u64>>());
}

#[test]
fn a_memory_is_written_at_the_edge_and_read_in_the_sample_after_it() {
    let zero = "00000000000000000000000000000000";
    let number = |bits: &str| format!("{}{bits}", &zero[bits.len()..]);
    let parameters = json!({
        "ABITS": number("10"), "WIDTH": number("100"), "SIZE": number("11"), "OFFSET": zero, "INIT": "xxxx00010011",
        "RD_PORTS": number("1"), "RD_CLK_ENABLE": "0", "WR_PORTS": number("1"), "WR_CLK_ENABLE": "1", "WR_CLK_POLARITY": "1",
    });
    let pins = json!({
        "RD_ADDR": [3, 4], "RD_DATA": [5, 6, 7, 8], "RD_EN": ["1"], "RD_CLK": ["x"], "RD_ARST": ["0"], "RD_SRST": ["0"],
        "WR_ADDR": [3, 4], "WR_DATA": ["1", "0", "1", "0"], "WR_EN": [9, 9, 9, 9], "WR_CLK": [2],
    });
    let cells = json!({ "mem": { "type": "$mem_v2", "parameters": parameters, "connections": pins } });
    let ports = json!({ "clk": port("input", [2]), "at": port("input", [3, 4]), "en": port("input", [9]), "q": port("output", 5..9) });
    let names = json!({ "clk": name([2]), "at": name([3, 4]), "en": name([9]), "q": name(5..9) });
    let design = design(&module(ports, cells, names));
    let rows = samples(
        &design,
        &["q"],
        &[
            &[("at", 0), ("en", 0)],
            &[("at", 1)],
            // Outside of the memory.
            &[("at", 3), ("en", 1)],
            &[("at", 1), ("en", 1)],
            &[("en", 0)],
            &[("at", 0)],
        ],
    );
    let values: Vec<u64> = rows.into_iter().flatten().collect();
    assert_eq!(values, [3, 1, 0, 1, 5, 3]);
}

#[test]
fn names_keep_their_scopes_and_sign_and_cells_their_line() {
    let cells = json!({ "not": cell("$not", &[], json!({ "A": [3], "Y": [4] })) });
    let names = json!({
        "a": name([3]),
        "core.u1.y": { "hide_name": 0, "bits": [4], "signed": 1, "attributes": {} },
        "$auto$1": { "hide_name": 1, "bits": [4], "attributes": {} },
    });
    let ports = json!({ "a": port("input", [3]), "y": port("output", [4]) });
    let netlist = imported(&module(ports, cells, names)).expect("an import").netlist;
    let paths: Vec<String> = netlist.names.iter().map(|named| netlist.path(named)).collect();
    assert_eq!(paths, ["t.a", "t.core.u1.y"]);
    assert!(netlist.names[1].format.is_signed());
    let text = netlist.to_string();
    assert!(text.contains("= not %0 at \"t.v\" 7 3"), "{text}");
    assert_eq!(stepwave::netlist::text::parse(&text).expect("the same"), netlist);
}
