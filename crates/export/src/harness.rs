//! A module with four pins around a machine, for place and route: a package has fewer pins than a machine has ports.
//!
//! ```text
//!   si ──► shift register ──► inputs of the machine      outputs ──► xor ──► signature register ──► so
//!                                                                     ▲──── shifted by one ────┤
//! ```
//!
//! Every path of the machine then begins and ends at a register, and nothing of it can be left out. A path from an output
//! has one more lookup table than in the machine alone, as it would have on the way into any other register.

use std::fmt::Write as _;

use super::Options;
use super::testbench::connections;
use super::verilog::header;
use super::verilog::names::Names;
use stepwave_netlist::Design;
use stepwave_netlist::cells::Net;

/// The top module `NAME_harness` around what [`verilog`](super::verilog) writes with the same options: inputs `clk`, `rst` and
/// `si`, output `so`. It has a register for each bit of the inputs and outputs of the machine.
#[must_use]
pub fn harness(design: &Design, options: &Options<'_>) -> String {
    let names = Names::new(design.netlist(), options);
    let slices = |word: &str, nets: &mut dyn Iterator<Item = Net>| -> (u32, Vec<String>) {
        let mut low = 0;
        let slice = |net: Net| {
            let (first, width) = (low, design.netlist().width(net).get());
            low += width;
            format!("{word}[{}:{first}]", first + width - 1)
        };
        let slices = nets.map(slice).collect();
        (low, slices)
    };
    let (ins, inputs) = slices("in", &mut names.inputs.iter().map(|port| port.net));
    let (outs, outputs) = slices("out", &mut names.outputs.iter().map(|port| port.net));
    let outside = inputs.iter().chain(&outputs).map(String::as_str);
    let ports = connections(&names, ["clk", "rst"], outside).join(",\n        ");
    let (top_in, top_out) = (ins.max(1) - 1, outs.max(1) - 1);
    let mut text = header(options.comment);
    text += "// Inputs come from a shift register, outputs go into a signature register: for place and route.\n\n";
    let name = names.module.trim_start_matches('\\').trim_end();
    _ = writeln!(text, "module {name}_harness(");
    text += "    input wire clk,\n    input wire rst,\n    input wire si,\n    output wire so\n);\n";
    _ = writeln!(text, "    reg [{top_in}:0] in;\n    wire [{top_out}:0] out;\n    reg [{top_out}:0] signature;");
    text += "    always @(posedge clk) begin\n";
    text += "        in <= {in, si};\n        signature <= {signature, 1'b0} ^ out;\n    end\n";
    _ = writeln!(
        text,
        "    assign so = signature[{top_out}];\n    {} machine (\n        {ports}\n    );",
        names.module
    );
    text + "endmodule\n"
}
