//! Verilog-2001, readable and synthesizable, of any design.
//!
//! One module. A scope of the design is a named generate block, so that names and their paths are those of a wave. An
//! input or output of an inner scope has a port of the top module next to it. A register has its reset value
//! from the beginning (`initial`), and takes it at an edge where `rst` is 1. All logic between registers is continuous
//! assignments; every scope with registers has one `always` block.

mod expression;
mod layout;
mod memory;
pub(super) mod names;

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt::Write as _;

use self::expression::{Writer, literal};
use self::layout::{Form, Layout};
use self::names::Names;
use super::Options;
use stepwave_netlist::Design;
use stepwave_netlist::cells::{Net, Op, ScopeId};

/// The head of both kinds of file.
pub(super) fn header(comment: &[String]) -> String {
    let line = |line: &str| {
        // A comment that begins with the word is a directive to Verilator; one that ends in a backslash continues.
        let mark = if line.trim_start().to_lowercase().starts_with("verilator") { ": " } else { "" };
        format!("// {mark}{}\n", line.trim_end_matches('\\'))
    };
    comment.iter().flat_map(|text| text.lines()).map(line).collect()
}

/// `signed [3:0] ` or so, between the kind of a net and its name.
pub(super) fn vector(bits: u32, signed: bool) -> String {
    let sign = if signed { "signed " } else { "" };
    let range = if bits > 1 { format!("[{}:0] ", bits - 1) } else { String::new() };
    format!("{sign}{range}")
}

/// The design as one Verilog module. The same design gives the same text.
#[must_use]
pub fn verilog(design: &Design, options: &Options<'_>) -> String {
    let netlist = design.netlist();
    let names = Names::new(netlist, options);
    let layout = Layout::new(design, &names);
    let writer = Writer { netlist, names: &names, layout: &layout, hidden: RefCell::new(BTreeSet::new()) };
    let module = Module { design, names: &names, layout: &layout, writer };
    let body = module.scope(ScopeId::TOP, 1);
    let mut text = header(options.comment);
    _ = writeln!(
        text,
        "// Registers have their reset values from the beginning, and again after an edge with {} = 1.",
        names.rst
    );
    if names.hide_others() {
        text += "// A signal may have the name of a scope further out, as in the wave.\n/* verilator lint_off VARHIDDEN */\n";
    }
    text += &format!("\n{}", module.head());
    for &net in module.writer.hidden.borrow().iter() {
        let entry = names.first(net).unwrap_or_default();
        let path = module.writer.name(net, ScopeId::TOP);
        let vector = vector(netlist.width(net).get(), netlist.names[entry].format.is_signed());
        _ = writeln!(text, "    wire {vector}{} = {path};", names.unnamed(net));
    }
    text + &module.arrays() + &body + "endmodule\n"
}

/// Writing to a string cannot fail, so results of `writeln!` are dropped.
struct Module<'a> {
    design: &'a Design,
    names: &'a Names,
    layout: &'a Layout,
    writer: Writer<'a>,
}

fn indented(depth: usize, line: &str) -> String {
    format!("{:1$}{line}\n", "", depth * 4)
}

impl Module<'_> {
    /// The list of ports. Those that no scope shows are kept out of Verilator's waves.
    fn head(&self) -> String {
        let netlist = self.design.netlist();
        let mut shown = vec![format!("input wire {}", self.names.clk)];
        let mut hidden = vec![format!("input wire {}", self.names.rst)];
        let inputs = self.names.inputs.iter().map(|port| ("input wire", port));
        let outputs = self.names.outputs.iter().map(|port| {
            let register = matches!(netlist.cell(port.net).op, Op::Register { .. });
            (if register && port.own { "output reg" } else { "output wire" }, port)
        });
        for (kind, port) in inputs.chain(outputs) {
            let entry = port.word.as_ref().map(|word| word.entry).or(self.names.first(port.net));
            let signed = entry.is_some_and(|entry| netlist.names[entry].format.is_signed());
            let (bits, name) = match &port.word {
                // The lowest part declares the word.
                Some(word) if word.low > 0 => continue,
                Some(word) => (netlist.bits(netlist.names[word.entry].nets()), &word.name),
                None => (netlist.width(port.net).get(), &port.name),
            };
            let line = format!("{kind} {}{name}", vector(bits, signed));
            if port.own { shown.push(line) } else { hidden.push(line) }
        }
        // An escaped name brings the blank that ends it.
        let lines = |ports: &[String]| ports.iter().map(|port| format!("    {port}")).collect::<Vec<_>>().join(",\n");
        format!(
            "module {}(\n{},\n    /* verilator tracing_off */\n{}\n    /* verilator tracing_on */\n);\n",
            self.names.module,
            lines(&shown),
            lines(&hidden)
        )
    }

    /// Declarations, logic and inner scopes of a scope.
    fn scope(&self, scope: ScopeId, depth: usize) -> String {
        let netlist = self.design.netlist();
        let mut text = String::new();
        let own_port = |net: Net| self.names.outputs.iter().any(|port| port.net == net && port.own);
        let mut registers = Vec::new();
        for &net in self.design.registers() {
            if self.layout.places[net.index()] == scope {
                registers.push(net);
                if !own_port(net) {
                    text += &indented(depth, &format!("reg {};", self.declared(net)));
                }
            }
        }
        for net in netlist.nets() {
            if let Some((_, wide)) =
                self.layout.wide_before(net).filter(|(at, _)| self.layout.wide_places[*at] == scope)
            {
                let top = netlist.width(wide.left).get();
                let value = self.writer.wide(wide, scope);
                text += &indented(depth, &format!("wire [{top}:0] {} = {value};", self.names.wide(wide.of)));
            }
            let is_register = matches!(netlist.cell(net).op, Op::Register { .. });
            let declared = matches!(self.layout.forms[net.index()], Form::Named | Form::Unnamed);
            if is_register || !declared || self.layout.places[net.index()] != scope {
                continue;
            }
            let value = match self.names.inputs.iter().find(|port| port.net == net) {
                Some(port) if port.own && port.word.is_none() => continue,
                Some(port) => port.name.clone(),
                None => self.writer.value(net, scope).text,
            };
            let declaration = self.declared(net);
            text += &match own_port(net) {
                true => indented(depth, &format!("assign {} = {value};", self.writer.name(net, scope))),
                false => indented(depth, &format!("wire {declaration} = {value};")),
            };
        }
        text += &self.further_names(scope, depth);
        text += &self.joined_ports(scope, depth);
        text += &self.clocked(&registers, scope, depth);
        text += &self.memories(scope, depth);
        text + &self.inner_scopes(scope, depth)
    }

    /// Vector and name of a declared net.
    fn declared(&self, net: Net) -> String {
        let netlist = self.design.netlist();
        let width = netlist.width(net).get();
        match self.names.first(net) {
            Some(entry) => vector(width, netlist.names[entry].format.is_signed()) + &self.names.named[entry],
            None => vector(width, false) + &self.names.unnamed(net),
        }
    }

    /// Names of nets that have one already, and plain ones for those whose name is a reserved word.
    fn further_names(&self, scope: ScopeId, depth: usize) -> String {
        let netlist = self.design.netlist();
        let mut text = String::new();
        for (index, entry) in netlist.names.iter().enumerate() {
            let port = scope == ScopeId::TOP && self.names.is_own_port(index);
            if entry.scope == scope && entry.is_wide() && !port {
                let vector = vector(netlist.bits(entry.nets()), entry.format.is_signed());
                let parts: Vec<String> = entry.nets().rev().map(|net| self.writer.read(net, scope).text).collect();
                let (name, parts) = (&self.names.named[index], parts.join(", "));
                text += &indented(depth, &format!("wire {vector}{name} = {{{parts}}};"));
            } else if entry.scope == scope && !entry.is_wide() && self.names.first(entry.net) != Some(index) {
                let vector = vector(netlist.width(entry.net).get(), entry.format.is_signed());
                let value = self.writer.name(entry.net, scope);
                text += &indented(depth, &format!("wire {vector}{} = {value};", self.names.named[index]));
            } else if entry.scope == scope && !entry.is_wide() && scope != ScopeId::TOP && self.names.is_escaped(index)
            {
                let vector = vector(netlist.width(entry.net).get(), entry.format.is_signed());
                let (further, value) = (self.names.unnamed(entry.net), self.writer.name(entry.net, scope));
                text += &indented(depth, &format!("wire {vector}{further} = {value};"));
            }
        }
        text
    }

    /// Outputs that are nets of inner scopes or have no name.
    fn joined_ports(&self, scope: ScopeId, depth: usize) -> String {
        if scope != ScopeId::TOP {
            return String::new();
        }
        let joined = self.names.outputs.iter().filter(|port| !port.own);
        joined
            .map(|port| {
                let value = self.writer.read(port.net, scope).text;
                indented(depth, &format!("assign {} = {value};", port.name))
            })
            .collect()
    }

    /// The registers of a scope.
    fn clocked(&self, registers: &[Net], scope: ScopeId, depth: usize) -> String {
        if registers.is_empty() {
            return String::new();
        }
        let reset = |operator: &str, depth: usize| -> String {
            let line = |&net: &Net| match self.design.netlist().cell(net).op {
                Op::Register { reset, .. } => {
                    let value = literal(self.design.netlist().width(net), reset);
                    indented(depth, &format!("{} {operator} {value};", self.writer.name(net, scope)))
                }
                _ => String::new(),
            };
            registers.iter().map(line).collect()
        };
        let mut text = indented(depth, "initial begin") + &reset("=", depth + 1) + &indented(depth, "end");
        text += &indented(depth, &format!("always @(posedge {})", self.names.clk));
        text += &indented(depth + 1, &format!("if ({}) begin", self.names.rst));
        text += &reset("<=", depth + 2);
        text += &indented(depth + 1, "end else begin");
        for &net in registers {
            text += &self.next(net, scope, depth + 2);
        }
        text + &indented(depth + 1, "end")
    }

    /// What a register takes at an edge: its chain of multiplexers as `if`s.
    fn next(&self, register: Net, scope: ScopeId, depth: usize) -> String {
        let netlist = self.design.netlist();
        let Op::Register { next: Some(mut next), .. } = netlist.cell(register).op else { return String::new() };
        let target = self.writer.name(register, scope);
        let mut text = String::new();
        let mut word = "";
        while let (Form::Arm, Op::Mux { select, high, low }) = (self.layout.forms[next.index()], netlist.cell(next).op)
        {
            if self.layout.known(select) == Some(0) {
                next = low;
                continue;
            }
            let select = self.writer.read(select, scope).text;
            let high = self.writer.read(high, scope).text;
            text += &indented(depth, &format!("{word}if ({select}) {target} <= {high};"));
            word = "else ";
            next = low;
        }
        if next != register {
            let value = self.writer.read(next, scope).text;
            text += &indented(depth, &format!("{word}{target} <= {value};"));
        }
        text
    }

    fn inner_scopes(&self, scope: ScopeId, depth: usize) -> String {
        let netlist = self.design.netlist();
        let mut text = String::new();
        // `generate` and `endgenerate` enclose only the outermost blocks.
        let depth = if scope == ScopeId::TOP { depth + 1 } else { depth };
        for (index, inner) in (0u32..).map(ScopeId).zip(&netlist.scopes) {
            if inner.parent == Some(scope) {
                let name = &self.names.scopes[index.index()];
                text += &indented(depth, &format!("if (1) begin : {}", name.trim_end()));
                text += &self.scope(index, depth + 1);
                text += &indented(depth, "end");
            }
        }
        if scope == ScopeId::TOP && !text.is_empty() {
            text = indented(1, "generate") + &text + &indented(1, "endgenerate");
        }
        text
    }
}
