//! All names are kept, and added names never collide with them.

use stepwave_export::{Options, verilog};
use stepwave_netlist::cells::Format;

use super::{design, text};

#[test]
fn reserved_words_are_escaped_and_keep_their_names() {
    let text = text(&design("module", |m| {
        let wire = m.input("wire", 2);
        let inner = m.scope("begin");
        let logic = inner.reg("logic", 2);
        logic.set(wire);
        m.name("bit", logic.q.bit(1));
    }));
    assert!(text.contains("module \\module (\n"), "{text}");
    assert!(text.contains("    input wire [1:0] \\wire ,\n"), "{text}");
    assert!(text.contains("if (1) begin : \\begin\n"), "{text}");
    assert!(text.contains("reg [1:0] \\logic ;"), "{text}");
    assert!(text.contains("\\logic  <= \\wire ;"), "{text}");
    // Not every tool takes an escaped name after a dot.
    assert!(text.contains("            wire [1:0] _n1 = \\logic ;\n"), "{text}");
    assert!(text.contains("wire \\bit  = \\begin ._n1[1];"), "{text}");
}

#[test]
fn made_up_names_avoid_given_ones() {
    let text = text(&design("m", |m| {
        let [clk, rst, own] = ["clk", "rst", "_n4"].map(|name| m.input(name, 4));
        let block = m.scope("block");
        let load = block.input("load", 4);
        m.name("block_load", load);
        let shared = clk.wrapping_add(rst);
        m.name("one", shared ^ own);
        m.name("two", shared & load);
        let count = m.reg("count", 4);
        count.set(count.q);
    }));
    assert!(text.contains("input wire clk_1,"), "{text}");
    assert!(text.contains("input wire rst_1,"), "{text}");
    assert!(text.contains("input wire [3:0] clk,"), "{text}");
    assert!(text.contains("input wire [3:0] block_load_1\n"), "{text}");
    assert!(text.contains("wire [3:0] __n4 = clk + rst;"), "{text}");
    assert!(text.contains("always @(posedge clk_1)"), "{text}");
    assert!(text.contains("wire [3:0] load = block_load_1;"), "{text}");
    assert!(text.contains("wire [3:0] block_load = block.load;"), "{text}");
}

#[test]
fn a_net_whose_name_is_hidden_by_a_nearer_one_is_reached_by_another() {
    let text = text(&design("m", |m| {
        let x = m.input("x", 4);
        let [left, right] = ["left", "right"].map(|name| m.scope(name));
        let inner = left.input("x", 4);
        left.name("both", x & inner);
        let far = right.input("y", 4);
        left.scope("right").name("other", far);
        left.name("here", far);
    }));
    assert!(text.contains("wire [3:0] _n0 = x;"), "{text}");
    assert!(text.contains("wire [3:0] both = _n0 & x;"), "{text}");
    assert!(text.contains("wire [3:0] _n3 = right.y;"), "{text}");
    assert!(text.contains("wire [3:0] other = _n3;"), "{text}");
}

#[test]
fn all_names_of_a_net_are_there_with_their_readings() {
    let text = text(&design("m", |m| {
        let f = m.input("f", 4);
        m.show("as_number", f, Format::Signed);
        m.scope("x").name("again", f);
    }));
    assert!(text.contains("    input wire [3:0] f,\n"), "{text}");
    assert!(text.contains("    wire signed [3:0] as_number = f;\n"), "{text}");
    assert!(text.contains("            wire [3:0] again = f;\n"), "{text}");
}

#[test]
fn outputs_are_ports_once_each_under_their_own_names_or_their_paths() {
    let mut nets = Vec::new();
    let design = design("m", |m| {
        let a = m.input("a", 4);
        let count = m.reg("count", 4);
        count.set(a);
        let sum = m.name("sum", count.q.wrapping_add(a));
        let inner = m.scope("x").name("inner", sum ^ a);
        nets = [a, count.q, sum, inner, !inner, sum].map(|signal| signal.net()).to_vec();
    });
    let text = verilog(&design, &Options { comment: &[], outputs: &nets });
    for line in [
        "    input wire [3:0] a,\n    output reg [3:0] count,\n    output wire [3:0] sum,\n",
        "    output wire [3:0] a_1,\n    output wire [3:0] x_inner,\n    output wire [3:0] n4\n",
        "    assign sum = count + a;\n",
        "    assign a_1 = a;\n",
        "    assign x_inner = x.inner;\n",
        "    assign n4 = ~x.inner;\n",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
}
