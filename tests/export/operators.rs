//! Every operator, as exact as the netlist has it.

use stepwave_netlist::{elaborate, text as netlist_text};

use super::{design, text};

/// The line that declares a net, without its declaration.
fn value(text: &str, name: &str) -> String {
    let found = text.lines().find_map(|line| line.split_once(&format!(" {name} = ")));
    found.unwrap_or_else(|| panic!("no {name} in\n{text}")).1.to_owned()
}

/// The netlist of one named operator on the inputs a, b (4 bits) and s (1 bit), f and g (4 bits, two's complement).
fn of(operator: &str, width: u32) -> String {
    let netlist = format!(
        "netlist m\n%0:4 = input\n%1:4 = input\n%2:1 = input\n%3:4 = input\n%4:4 = input\n%5:{width} = {operator}\n\
         name %0 in 0 \"a\" unsigned\nname %1 in 0 \"b\" unsigned\nname %2 in 0 \"s\" unsigned\n\
         name %3 in 0 \"f\" signed\nname %4 in 0 \"g\" signed\nname %5 in 0 \"out\" unsigned\n"
    );
    let text = text(&elaborate(netlist_text::parse(&netlist).unwrap()).unwrap());
    let sum = text.lines().find(|line| line.contains("_sum5 ="));
    let sum = sum.map(|line| format!("{} ", line.trim())).unwrap_or_default();
    sum + &value(&text, "out")
}

#[test]
fn every_operator_is_written_in_exactly_its_width() {
    for (operator, width, expected) in [
        ("const 0x9", 4, "4'd9;"),
        ("not %0", 4, "~a;"),
        ("and %0 %1", 4, "a & b;"),
        ("or %0 %1", 4, "a | b;"),
        ("xor %0 %1", 4, "a ^ b;"),
        ("mux %2 %0 %1", 4, "s ? a : b;"),
        ("add %0 %1", 4, "a + b;"),
        ("sub %0 %1", 4, "a - b;"),
        ("mul %0 %1", 4, "a * b;"),
        ("div %0 %1", 4, "{b == 4'd0 ? 4'd0 : a / b};"),
        ("rem %3 %4", 4, "{$unsigned(g) == 4'd0 ? 4'd0 : $unsigned(f) % $unsigned(g)};"),
        ("div %2 %2", 1, "s & s;"),
        ("rem %2 %2", 1, "1'd0;"),
        ("shift-left %0 %1", 4, "a << b;"),
        ("shift-left %0 %2", 4, "a << s;"),
        ("shift-right %3 %4", 4, "f >> $unsigned(g);"),
        ("shift-arithmetic %0 %1", 4, "{$signed(a) >>> b};"),
        ("shift-arithmetic %3 %2", 4, "{f >>> s};"),
        ("carry %0 %1", 1, "wire [4:0] _sum5 = {1'b0, a} + {1'b0, b}; _sum5[4];"),
        ("carry %3 %4", 1, "wire [4:0] _sum5 = {1'b0, f} + {1'b0, g}; _sum5[4];"),
        ("borrow %0 %1", 1, "a < b;"),
        ("borrow %3 %4", 1, "$unsigned(f) < $unsigned(g);"),
        ("borrow %3 %0", 1, "f < a;"),
        ("add-overflow %0 %1", 1, "wire [4:0] _sum5 = {a[3], a} + {b[3], b}; _sum5[4] ^ _sum5[3];"),
        ("sub-overflow %2 %2", 1, "wire [1:0] _sum5 = {s, s} - {s, s}; _sum5[1] ^ _sum5[0];"),
        ("equal %0 %1", 1, "a == b;"),
        ("less-signed %0 %1", 1, "$signed(a) < $signed(b);"),
        ("less-signed %3 %0", 1, "$signed(f) < $signed(a);"),
        ("less-signed %3 %4", 1, "f < g;"),
        ("slice %0 1", 2, "a[2:1];"),
        ("slice %0 3", 1, "a[3];"),
        ("slice %3 0", 4, "$unsigned(f);"),
        ("concat %0 %2", 5, "{a, s};"),
        ("zero-extend %0", 64, "{60'd0, a};"),
        ("zero-extend %0", 4, "a;"),
        ("sign-extend %0", 5, "{a[3], a};"),
        ("sign-extend %0", 64, "{{60{a[3]}}, a};"),
        ("sign-extend %2", 3, "{{2{s}}, s};"),
    ] {
        assert_eq!(of(operator, width), expected, "{operator}");
    }
}

#[test]
fn a_memory_is_an_array_with_its_first_words_and_ports() {
    let text = text(&design("m", |m| {
        let ram = m.scope("core").memory("ram", 2, 5).initial([0, 3]);
        let [enable, address, data] = [("we", 1), ("a", 3), ("d", 2)].map(|(name, bits)| m.input(name, bits));
        m.name("out", ram.read(address));
        ram.write(enable, address, data, None);
        ram.write(enable & data.bit(0), m.lit(64, 4), !data, Some(data));
    }));
    assert!(text.contains("    reg [1:0] core_ram [0:4];\n"), "{text}");
    assert_eq!(value(&text, "out"), "{a < 3'd5 ? core_ram[a] : 2'd0};");
    let initial = "    initial begin\n        for (i = 0; i < 5; i = i + 1) core_ram[i] = 2'd0;\n        core_ram[1] = 2'd3;\n    end\n";
    assert!(text.contains(initial), "{text}");
    let ports = "    always @(posedge clk)
        if (!rst) begin
            if ((we) && a < 3'd5) core_ram[a] <= d;
            if ((we & d[0]) && 64'd4 < 64'd5) begin
                if (d[0]) core_ram[64'd4][0] <= _n7[0];
                if (d[1]) core_ram[64'd4][1] <= _n7[1];
            end
        end
";
    assert!(text.contains(ports), "{text}");
}

#[test]
fn full_width_constants_and_carries_have_all_their_bits() {
    let text = text(&design("m", |m| {
        let a = m.input("a", 64);
        let (carry, sum) = a.carrying_add(m.lit(64, u64::MAX));
        m.name("carry", carry);
        m.name("sum", sum);
    }));
    assert!(text.contains("wire [64:0] _sum2 = {1'b0, a} + 65'd18446744073709551615;"), "{text}");
    assert_eq!(value(&text, "carry"), "_sum2[64];");
    assert_eq!(value(&text, "sum"), "_sum2[63:0];");
}

#[test]
fn what_is_used_once_is_written_in_place_and_what_is_used_twice_is_a_wire() {
    let text = text(&design("m", |m| {
        let [a, b, c] = ["a", "b", "c"].map(|name| m.input(name, 4));
        let shared = a.wrapping_add(b);
        m.name("once", (a ^ b) & !c);
        m.name("twice", shared.wrapping_sub(c));
        m.name("again", c.wrapping_sub(shared));
        m.name("bits", (a | b).slice(1, 2));
        m.name("unequal", !a.equals(b));
    }));
    assert_eq!(value(&text, "once"), "(a ^ b) & ~c;");
    assert!(text.contains("wire [3:0] _n3 = a + b;"), "{text}");
    assert_eq!(value(&text, "twice"), "_n3 - c;");
    assert_eq!(value(&text, "again"), "c - _n3;");
    let cut = value(&text, "bits");
    assert!(cut.starts_with("_n") && cut.ends_with("[2:1];"), "{cut}");
    assert_eq!(value(&text, "unequal"), "a != b;");
}

#[test]
fn a_chain_of_conditions_is_a_chain_of_ifs_and_holding_is_left_out() {
    let text = text(&design("m", |m| {
        let [load, step] = ["load", "step"].map(|name| m.input(name, 1));
        let count = m.reg_signed("count", 4).reset(9);
        count
            .when(load, m.lit(4, 3).as_signed())
            .when(m.lit(1, 0), m.lit(4, 4).as_signed())
            .when(step, count.q.wrapping_sub(m.lit(4, 1)))
            .else_hold();
    }));
    assert!(text.contains("reg signed [3:0] count;"), "{text}");
    assert!(text.contains("initial begin\n        count = 4'd9;\n"), "{text}");
    let chain =
        "            if (load) count <= 4'd3;\n            else if (step) count <= count - 4'd1;\n        end\n";
    assert!(text.contains(chain), "{text}");
}
