//! Overflow events of imported hardware: which results count, and when.

use serde_json::{Value, json};
use stepwave::netlist::cells::Claim;

use super::{cell, design, module, name, port, samples};

/// A counter of 2 bits that counts while it is enabled; what it adds to, and its names, are given.
fn counter(add: Value, names: Value) -> String {
    let cells = json!({
        "add": add,
        "ff": cell("$dffe", &["CLK_POLARITY", "EN_POLARITY"], json!({ "CLK": [2], "EN": [3], "D": [6, 7], "Q": [4, 5] })),
    });
    let ports = json!({ "clk": port("input", [2]), "en": port("input", [3]), "q": port("output", [4, 5]) });
    module(ports, cells, names)
}

fn names() -> Value {
    json!({ "clk": name([2]), "en": name([3]), "q": name([4, 5]) })
}

#[test]
fn a_carry_that_nobody_reads_is_an_event_only_where_the_register_takes_the_result() {
    let add = cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": [6, 7] }));
    let design = design(&counter(add, names()));
    let netlist = design.netlist();
    let [property] = netlist.properties.as_slice() else { panic!("{netlist}") };
    assert_eq!(property.name, "t.q");
    let (on, off) = (&[("en", 1)][..], &[("en", 0)][..]);
    let rows = samples(&design, &["t.q", "t.overflow.q"], &[on, on, on, off, on, on]);
    // 3 is there in clocks 3 and 4; only in clock 4 is 4 taken.
    assert_eq!(rows, [[0, 0], [1, 0], [2, 0], [3, 0], [3, 1], [0, 0]]);
}

#[test]
fn a_carry_that_is_read_elsewhere_is_kept() {
    let add = cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": [6, 7, 8] }));
    let text = counter(add, names()).replace(
        r#""q":{"bits":[4,5],"direction""#,
        r#""c":{"bits":[8],"direction":"output"},"q":{"bits":[4,5],"direction""#,
    );
    assert!(text.contains("[8]"), "{text}");
    assert!(design(&text).netlist().properties.is_empty());
}

#[test]
fn a_result_that_always_fits_has_no_event() {
    let add = cell("$add", &[], json!({ "A": [4, "0"], "B": ["1"], "Y": [6, 7] }));
    assert!(design(&counter(add, names())).netlist().properties.is_empty());
}

#[test]
fn a_multiplexer_that_takes_another_value_takes_no_overflow() {
    // q == 3 ? 0 : q + 1
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": [6, 7] })),
        "eq": cell("$eq", &[], json!({ "A": [4, 5], "B": ["1", "1"], "Y": [8] })),
        "mux": cell("$mux", &[], json!({ "A": [6, 7], "B": ["0", "0"], "S": [8], "Y": [9, 10] })),
        "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": [9, 10], "Q": [4, 5] })),
    });
    let ports = json!({ "clk": port("input", [2]), "q": port("output", [4, 5]) });
    let design = design(&module(ports, cells, json!({ "clk": name([2]), "q": name([4, 5]) })));
    let rows = samples(&design, &["t.q", "t.overflow.q"], &[&[][..]; 9]);
    assert!(rows.iter().all(|row| row[1] == 0), "{rows:?}");
    assert_eq!(rows[4], [0, 0]);
}

#[test]
fn the_sign_of_the_register_and_a_sign_extension_by_hand_decide_what_fits() {
    // A signed register, and an operand whose upper bits are copies of one net: -2 + -1 does not fit in 2 bits.
    let add = cell("$add", &[], json!({ "A": [4, 5], "B": ["1", "1"], "Y": [6, 7] }));
    let mut signed = names();
    signed["q"]["signed"] = json!(1);
    let design = design(&counter(add, signed));
    let Claim::Fits { left, right, signed, .. } = &design.netlist().properties[0].claim else { panic!() };
    // A constant of leading ones is read as signed, the register as the cell has it.
    assert_eq!((left.signed, right.signed, *signed), (false, true, true));
}

#[test]
fn a_power_is_an_event_where_its_exact_result_does_not_fit() {
    let (x, y, q): (Vec<u32>, Vec<u32>, Vec<u32>) = ((10..14).collect(), (20..28).collect(), (30..38).collect());
    for (signed, exponent) in
        [(false, 3), (true, 3), (false, 2), (true, 2), (true, 8), (true, 101), (false, 100), (true, 1)]
    {
        let ones: &[&str] = if signed { &["A_SIGNED"] } else { &[] };
        let constant: Vec<String> = (0..7).map(|bit| (exponent >> bit & 1).to_string()).collect();
        let cells = json!({
            "pow": cell("$pow", ones, json!({ "A": x, "B": constant, "Y": y })),
            "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": y, "Q": q })),
        });
        let ports = json!({ "clk": port("input", [2]), "x": port("input", x.clone()), "q": port("output", q.clone()) });
        let mut names = json!({ "clk": name([2]), "x": name(x.clone()), "q": name(q.clone()) });
        names["q"]["signed"] = json!(i32::from(signed));
        let design = design(&module(ports, cells, names));
        let fits = |x: u64| {
            let x = if signed && x > 7 { i128::from(x) - 16 } else { i128::from(x) };
            let exact = x.checked_pow(exponent);
            exact.is_some_and(|exact| if signed { (-128..128).contains(&exact) } else { (0..256).contains(&exact) })
        };
        let [property] = design.netlist().properties.as_slice() else {
            assert!((0..16).all(fits), "{signed} {exponent}");
            continue;
        };
        let Claim::Fits { operator, .. } = &property.claim else { panic!() };
        assert_eq!(operator.sign(), "**");
        let inputs: Vec<[(&str, u64); 1]> = (0..16).map(|x| [("t.x", x)]).collect();
        let inputs: Vec<&[(&str, u64)]> = inputs.iter().map(|row| row.as_slice()).collect();
        for (x, row) in (0..16).zip(samples(&design, &["t.overflow.q"], &inputs)) {
            assert_eq!(row[0] == 0, fits(x), "{signed} {x} ** {exponent}");
        }
    }
}

#[test]
fn an_attribute_of_the_register_announces_that_it_wraps() {
    let add = cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": [6, 7] }));
    let mut wraps = names();
    wraps["q"]["attributes"]["stepwave_wraps"] = json!("1");
    let text = design(&counter(add, wraps)).netlist().to_string();
    let property = text.lines().find(|line| line.starts_with("property")).expect("a property");
    assert!(property.ends_with(" wraps") && property.contains("fits 2 unsigned add"), "{property}");
}

#[test]
fn bits_that_nothing_reads_are_not_kept() {
    // 8 bits of q + 1, through a multiplexer, into a register of 2.
    let (y, m): (Vec<u32>, Vec<u32>) = ((20..28).collect(), (30..38).collect());
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": y })),
        "mux": cell("$mux", &[], json!({ "A": ["0", "0", "0", "0", "0", "0", "0", "0"], "B": y, "S": [3], "Y": m })),
        "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": m[..2], "Q": [4, 5] })),
    });
    let ports = json!({ "clk": port("input", [2]), "en": port("input", [3]), "q": port("output", [4, 5]) });
    let design = design(&module(ports, cells, names()));
    let Claim::Fits { bits, .. } = &design.netlist().properties[0].claim else { panic!() };
    assert_eq!((*bits, design.netlist().properties[0].name.as_str()), (2, "t.q"));
    let rows = samples(&design, &["t.q", "t.overflow.q"], &[&[("en", 1)], &[], &[], &[], &[("en", 0)]]);
    assert_eq!(rows, [[0, 0], [1, 0], [2, 0], [3, 1], [0, 0]]);
}

/// A counter of this many bits that begins two below its greatest value, with its netlist's properties as text.
fn wide_counter(bits: u32) -> (stepwave::netlist::Design, Vec<String>) {
    let (q, y): (Vec<u32>, Vec<u32>) = ((10..10 + bits).collect(), (200..200 + bits).collect());
    let cells = json!({
        "add": cell("$add", &[], json!({ "A": q, "B": ["1"], "Y": y })),
        "ff": cell("$dff", &["CLK_POLARITY"], json!({ "CLK": [2], "D": y, "Q": q })),
    });
    let init = format!("{}01", "1".repeat(bits as usize - 2));
    let names = json!({ "clk": name([2]), "q": { "hide_name": 0, "bits": q, "attributes": { "init": init } } });
    let ports = json!({ "clk": port("input", [2]), "q": { "direction": "output", "bits": q } });
    let design = design(&module(ports, cells, names));
    let properties = design.netlist().to_string();
    let properties = properties.lines().filter(|line| line.starts_with("property")).map(str::to_owned).collect();
    (design, properties)
}

#[test]
fn a_carry_out_of_63_64_65_and_87_bits_is_an_event_in_its_clock() {
    for (bits, claim) in [
        (63, " fits 63 unsigned add"),
        (64, " fits 64 unsigned add"),
        (65, " fits 65 unsigned add %0 %1 unsigned "),
        (87, " fits 87 unsigned add %0 %1 unsigned "),
    ] {
        let (design, properties) = wide_counter(bits);
        assert!(properties.len() == 1 && properties[0].contains(claim), "{properties:?}");
        let flags: Vec<u64> = samples(&design, &["t.overflow.q"], &[&[][..]; 6]).into_iter().flatten().collect();
        assert_eq!(flags, [0, 0, 1, 0, 0, 0], "{bits} bits");
        let text = design.netlist().to_string();
        assert_eq!(&stepwave::netlist::text::parse(&text).expect("the same"), design.netlist());
    }
}

/// An enabled register of the sum of a product of two inputs of 2 bits, named as given; all cells are signed or not.
fn product_and_sum(signed: bool, enabled_by: u32) -> stepwave::netlist::Design {
    let signs: &[&str] = if signed { &["A_SIGNED", "B_SIGNED"] } else { &[] };
    let cells = json!({
        "mul": cell("$mul", signs, json!({ "A": [4, 5], "B": [6, 7], "Y": [10, 11, 12, 13] })),
        "add": cell("$add", signs, json!({ "A": [14, 15, 16, 17], "B": [10, 11, 12, 13], "Y": [20, 21, 22, 23] })),
        "ff": cell("$dffe", &["CLK_POLARITY", "EN_POLARITY"],
            json!({ "CLK": [2], "EN": [enabled_by], "D": [20, 21, 22, 23], "Q": [14, 15, 16, 17] })),
    });
    let inputs = json!({ "clk": port("input", [2]), "en": port("input", [3]), "a": port("input", [4, 5]), "b": port("input", [6, 7]) });
    let mut ports = inputs.clone();
    ports["q"] = port("output", [14, 15, 16, 17]);
    let mut names =
        json!({ "clk": name([2]), "en": name([3]), "a": name([4, 5]), "b": name([6, 7]), "q": name([14, 15, 16, 17]) });
    for net in ["a", "b", "q"] {
        names[net]["signed"] = json!(u8::from(signed));
    }
    design(&module(ports, cells, names))
}

#[test]
fn a_part_of_a_signed_expression_that_nobody_has_named_is_signed() {
    let design = product_and_sum(true, 3);
    let paths: Vec<&str> = design.netlist().properties.iter().map(|property| property.name.as_str()).collect();
    // -2 * -2 = 4 has 4 bits as a signed number, whatever the operands are.
    assert_eq!(paths, ["t.q"]);
    // q + a * b with -1 and 1, a negative product, in each clock.
    let row = &[("en", 1), ("a", 3), ("b", 1)][..];
    let rows = samples(&design, &["t.q", "t.overflow.q"], &[row; 6]);
    assert!(rows.iter().all(|row| row[1] == 0), "{rows:?}");
    assert_eq!(rows[3][0], 13);
}

#[test]
fn what_other_logic_makes_of_a_result_is_taken_where_the_logic_is() {
    // a * b of 4 bits is added to q; the sum is taken only while `en` is 1.
    let cells = json!({
        "inner": cell("$add", &[], json!({ "A": [4, 5], "B": [6, 7], "Y": [10, 11] })),
        "not": cell("$not", &[], json!({ "A": [10, 11], "Y": [20, 21] })),
        "ff": cell("$dffe", &["CLK_POLARITY", "EN_POLARITY"], json!({ "CLK": [2], "EN": [3], "D": [20, 21], "Q": [14, 15] })),
    });
    let ports = json!({ "clk": port("input", [2]), "en": port("input", [3]), "a": port("input", [4, 5]), "b": port("input", [6, 7]),
        "q": port("output", [14, 15]) });
    let names = json!({ "clk": name([2]), "en": name([3]), "a": name([4, 5]), "b": name([6, 7]), "q": name([14, 15]) });
    let design = design(&module(ports, cells, names));
    let flag = design.netlist().names.iter().find(|named| named.name.contains("add")).expect("a flag");
    let path = design.netlist().path(flag);
    let (on, off) = (&[("en", 1), ("a", 3), ("b", 3)][..], &[("en", 0), ("a", 3), ("b", 3)][..]);
    let rows = samples(&design, &[&path], &[off, off, on, on, off]);
    assert_eq!(rows, [[0], [0], [1], [1], [0]]);
}

#[test]
fn what_yosys_makes_of_an_index_is_not_an_operator_of_the_author() {
    let mut text = counter(cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": [6, 7] })), names());
    text = text.replace(r#""add":{"#, r#""$add$t.v:0$7":{"#);
    assert!(text.contains("$add$t.v:0$7"));
    assert!(design(&text).netlist().properties.is_empty());
}

#[test]
fn a_result_has_the_name_of_its_own_scope_and_not_of_a_word_that_it_is_a_part_of() {
    let add = cell("$add", &[], json!({ "A": [4, 5], "B": ["1"], "Y": [6, 7] }));
    let mut all = names();
    all["dbg"] = name([4, 5, 3]);
    all["outer"] = name([4, 5]);
    all["s2.x"] = name([4, 5]);
    all["s2.x"]["signed"] = json!(1);
    let text = counter(add, all).replace(r#""add":{"#, r#""$flatten\\s2.$add$t.v:7$3":{"#);
    let design = design(&text);
    let property = &design.netlist().properties[0];
    assert_eq!(property.name, "t.s2.x");
    assert!(matches!(property.claim, Claim::Fits { signed: true, .. }));
}
