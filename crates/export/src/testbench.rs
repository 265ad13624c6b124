//! A Verilog test bench: it sets inputs right after clock edges, as an engine's caller does, and dumps every named net,
//! so that its wave is the engine's wave, clock by clock.
//!
//! "After an edge" means at the edge, without blocking: the edge itself still sees the old values. Between two edges
//! the nets are settled; there the bench looks whether the run is over, so that no edge follows the last sample.

use std::collections::HashSet;
use std::fmt::Write as _;

use super::Options;
use super::verilog::names::{Names, Port, claim, escaped};
use super::verilog::{header, vector};
use stepwave_netlist::Design;
use stepwave_netlist::bits::Bits;
use stepwave_netlist::cells::{Net, Netlist};
use stepwave_trace::timescale::ClockTime;

/// Inputs that are set together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Step {
    /// Inputs and their new values; the others keep theirs. Before the first step all are 0.
    pub set: Vec<(Net, u64)>,
    /// Samples until the next step, at least 1; `None`: until one of `Stimulus::done` is 1, from the second sample on.
    pub clocks: Option<u64>,
}

/// Nets that have been 0 for so long that they will stay so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stall {
    /// A sample in which one of them is not 0 is a sign of life.
    pub nets: Vec<Net>,
    /// Samples without one after which the run is over.
    pub clocks: u64,
}

/// What is to be done to a design, from sample 0 on. The nets that it looks at are to be among [`Options::outputs`];
/// one that is not counts as 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stimulus {
    /// One after another; the run ends with the last.
    pub steps: Vec<Step>,
    /// 1 bit each: where one is 1, a step without a number of clocks ends.
    pub done: Vec<Net>,
    /// 1 bit each: where one is 1 in a step without a number of clocks, the run is over.
    pub never: Vec<Net>,
    /// They count in every sample: the design runs while its inputs are set.
    pub always: bool,
    /// What else ends such a step, and the run.
    pub stall: Option<Stall>,
}

/// Names in the test bench.
struct Bench<'a> {
    netlist: &'a Netlist,
    names: Names,
    /// Of the instance: that of the design.
    instance: String,
    module: String,
    clk: String,
    /// Of each input and output, in the order of the ports.
    inputs: Vec<(Net, String)>,
    outputs: Vec<(Net, String)>,
    step: String,
    age: String,
    clocks: String,
    over: String,
    quiet: String,
}

impl Bench<'_> {
    fn new<'a>(netlist: &'a Netlist, options: &Options<'_>) -> Bench<'a> {
        let names = Names::new(netlist, options);
        let mut taken = HashSet::new();
        let plain = |name: &str| name.trim_start_matches('\\').trim_end().to_owned();
        let instance = plain(&names.module);
        taken.insert(instance.clone());
        let module = claim(&mut taken, &format!("{instance}_tb"));
        let clk = claim(&mut taken, "clk");
        let mut of_port = |net: Net, port: &str| (net, escaped(&claim(&mut taken, &plain(port))));
        let inputs = names.inputs.iter().map(|port| of_port(port.net, &port.name)).collect();
        let outputs = names.outputs.iter().map(|port| of_port(port.net, &port.name)).collect();
        let own = ["tb_step", "tb_age", "tb_clocks", "tb_over", "tb_quiet"];
        let [step, age, clocks, over, quiet] = own.map(|name| claim(&mut taken, name));
        let instance = escaped(&instance);
        Bench { netlist, names, instance, module, clk, inputs, outputs, step, age, clocks, over, quiet }
    }

    /// The signal of an output.
    fn output(&self, net: Net) -> &str {
        self.outputs.iter().find(|(output, _)| *output == net).map_or("1'b0", |(_, name)| name)
    }

    fn any(&self, nets: &[Net]) -> String {
        let each = |net: &Net| {
            let wide = self.netlist.width(*net).get() > 1;
            if wide { format!("|{}", self.output(*net)) } else { self.output(*net).to_owned() }
        };
        if nets.is_empty() { "1'b0".to_owned() } else { nets.iter().map(each).collect::<Vec<_>>().join(" || ") }
    }

    /// Assignments of a step.
    fn set(&self, step: &Step, operator: &str, depth: usize) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            _ = writeln!(text, "{:1$}{name} {operator} {value};", "", depth * 4);
        };
        for &(net, value) in &step.set {
            if let Some((_, name)) = self.inputs.iter().find(|(input, _)| *input == net) {
                let bits = Bits::truncated(self.netlist.width(net), value);
                line(name, format!("{}'d{}", bits.width().get(), bits.value()));
            }
        }
        line(&self.clocks, format!("64'd{}", step.clocks.map_or(0, |clocks| clocks.max(1))));
        text
    }

    /// Dumps every named net by its name, so that nothing else is in the wave.
    fn dump(&self, file: &str) -> String {
        let mut text = String::new();
        let fit = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' };
        _ = writeln!(text, "        $dumpfile(\"{}\");", file.chars().map(fit).collect::<String>());
        _ = writeln!(text, "        $dumpvars(0, {}.{});", self.instance, self.names.clk);
        for entry in 0..self.netlist.names.len() {
            _ = writeln!(text, "        $dumpvars(0, {}.{});", self.instance, self.names.path(self.netlist, entry));
        }
        text
    }
}

/// A test bench for what [`verilog`](super::verilog) writes with the same options. It writes its wave into the file
/// `dump`, in the working folder.
#[must_use]
pub fn testbench(design: &Design, options: &Options<'_>, stimulus: &Stimulus, time: ClockTime, dump: &str) -> String {
    let bench = Bench::new(design.netlist(), options);
    let mut text = header(options.comment);
    text += "// With Icarus Verilog: iverilog -g2001 -o bench.vvp BENCH.v MODULE.v && vvp bench.vvp\n";
    text += "// With Verilator 5: verilator --binary --trace -Wno-fatal BENCH.v MODULE.v\n\n";
    _ = writeln!(text, "`timescale {time} / {time}\n");
    text += "/* verilator tracing_off */\n";
    _ = writeln!(text, "module {};", bench.module);
    text += &declarations(&bench);
    text += &instance(&bench);
    let half = time.ticks() / 2;
    _ = writeln!(text, "    always #{half} {0} = ~{0};\n", bench.clk);
    text += &process(&bench, stimulus);
    text += "\n    initial begin\n";
    text += &bench.dump(dump);
    text += "    end\n";
    text += &ending(&bench, stimulus);
    text + "endmodule\n/* verilator tracing_on */\n"
}

fn declarations(bench: &Bench<'_>) -> String {
    let mut text = format!("    reg {};\n", bench.clk);
    for (net, name) in &bench.inputs {
        _ = writeln!(text, "    reg {}{name};", vector(bench.netlist.width(*net).get(), false));
    }
    for (net, name) in &bench.outputs {
        _ = writeln!(text, "    wire {}{name};", vector(bench.netlist.width(*net).get(), false));
    }
    let Bench { step, age, clocks, quiet, .. } = bench;
    _ = writeln!(
        text,
        "    // Index of the step; samples since its inputs were set; its length in samples, 0: until it is done."
    );
    _ = writeln!(text, "    integer {step};\n    reg [63:0] {age};\n    reg [63:0] {clocks};");
    _ = writeln!(text, "    // Samples in which nothing has moved.\n    reg [63:0] {quiet};\n");
    text
}

fn instance(bench: &Bench<'_>) -> String {
    let outside = bench.inputs.iter().chain(&bench.outputs).map(|(_, name)| name.as_str());
    let ports = connections(&bench.names, [&bench.clk, "1'b0"], outside).join(",\n        ");
    format!(
        "    /* verilator tracing_on */\n    {} {} (\n        {ports}\n    );\n    /* verilator tracing_off */\n\n",
        bench.names.module, bench.instance
    )
}

/// The ports of an instance: clock and reset, then inputs and outputs in their order, each with what is joined to it.
pub(super) fn connections<'a>(
    names: &Names,
    [clk, rst]: [&str; 2],
    outside: impl Iterator<Item = &'a str>,
) -> Vec<String> {
    let mut ports = vec![format!(".{}({clk})", names.clk), format!(".{}({rst})", names.rst)];
    let pairs: Vec<_> = names.inputs.iter().chain(&names.outputs).zip(outside).collect();
    for (port, name) in &pairs {
        match &port.word {
            None => ports.push(format!(".{}({name})", port.name)),
            Some(word) if word.low > 0 => {}
            Some(word) => {
                // The highest part first.
                let of_word = |other: &Port| other.word.as_ref().is_some_and(|other| other.entry == word.entry);
                let parts = pairs.iter().rev().filter(|(port, _)| of_word(port)).map(|(_, name)| *name);
                ports.push(format!(".{}({{{}}})", word.name, parts.collect::<Vec<_>>().join(", ")));
            }
        }
    }
    ports
}

/// The inputs, step by step.
fn process(bench: &Bench<'_>, stimulus: &Stimulus) -> String {
    let Bench { step, age, clocks, over, clk, .. } = bench;
    let done = bench.any(&stimulus.done);
    let done = if stimulus.done.len() > 1 { format!("({done})") } else { done };
    let counted = format!("{clocks} != 64'd0 ? {age} + 64'd1 == {clocks}");
    let mut text = format!("    wire {over} = {counted} : {age} != 64'd0 && {done};\n\n");
    text += "    initial begin\n";
    _ = writeln!(text, "        {clk} = 1'b0;\n        {step} = 0;\n        {age} = 64'd0;");
    _ = writeln!(text, "        {} = 64'd0;", bench.quiet);
    for (net, name) in &bench.inputs {
        _ = writeln!(text, "        {name} = {}'d0;", bench.netlist.width(*net).get());
    }
    if let Some(first) = stimulus.steps.first() {
        text += &bench.set(first, "=", 2);
    }
    text += "    end\n\n";
    _ = writeln!(text, "    always @(posedge {clk})\n        if ({over}) begin");
    _ = writeln!(text, "            {step} <= {step} + 1;\n            {age} <= 64'd0;\n            case ({step} + 1)");
    for (index, next) in stimulus.steps.iter().enumerate().skip(1) {
        _ = writeln!(text, "                {index}: begin");
        text += &bench.set(next, "<=", 5);
        text += "                end\n";
    }
    text += "                default: ;\n            endcase\n        end else begin\n";
    _ = writeln!(text, "            {age} <= {age} + 64'd1;\n        end");
    text
}

/// The end of the run, while all nets are settled.
fn ending(bench: &Bench<'_>, stimulus: &Stimulus) -> String {
    let Bench { step, clocks, over, clk, quiet, .. } = bench;
    let last = stimulus.steps.len().saturating_sub(1);
    let mut text = format!("\n    always @(negedge {clk}) begin\n");
    if let Some(stall) = &stimulus.stall {
        _ = writeln!(text, "        {quiet} = {} ? 64'd0 : {quiet} + 64'd1;", bench.any(&stall.nets));
    }
    let mut never = String::new();
    for &net in &stimulus.never {
        let name = bench.output(net);
        let path = bench.netlist.name_of(net).map_or_else(|| name.to_owned(), |named| bench.netlist.path(named));
        _ = writeln!(never, "            if ({name}) $display(\"%0t: {path} is 1\", $time);");
    }
    let any = bench.any(&stimulus.never);
    if stimulus.always {
        _ = writeln!(text, "        if ({any}) begin\n{never}            $finish;\n        end");
        text += "        else ";
    } else {
        text += "        ";
    }
    _ = writeln!(text, "if ({over}) begin\n            if ({step} == {last}) $finish;\n        end");
    _ = writeln!(text, "        else if ({clocks} == 64'd0) begin");
    if !stimulus.always {
        _ = writeln!(text, "{never}            if ({any}) $finish;");
    }
    if let Some(stall) = &stimulus.stall {
        let or = if stimulus.always { "" } else { "else " };
        _ = writeln!(text, "            {or}if ({quiet} > 64'd{}) begin", stall.clocks);
        text +=
            "                $display(\"%0t: no sign of life\", $time);\n                $finish;\n            end\n";
    }
    text + "        end\n    end\n"
}
