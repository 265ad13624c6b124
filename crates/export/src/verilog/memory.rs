//! Memories: arrays of the top scope, whose names are their paths.

use super::{Module, indented, literal, vector};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Memory, ScopeId, WritePort};

impl Module<'_> {
    /// First words and write ports of all memories, in the top scope. Arrays are declared before all that reads them.
    pub(super) fn memories(&self, scope: ScopeId, depth: usize) -> String {
        let memories = &self.design.netlist().memories;
        if scope != ScopeId::TOP || memories.is_empty() {
            return String::new();
        }
        let i = &self.names.index;
        let mut text = indented(depth, &format!("integer {i};"));
        for (index, memory) in memories.iter().enumerate() {
            let (name, size) = (&self.names.memories[index], memory.size);
            let word = |value| literal(memory.width, value);
            text += &indented(depth, "initial begin");
            let all = format!("for ({i} = 0; {i} < {size}; {i} = {i} + 1) {name}[{i}] = {};", word(0));
            text += &indented(depth + 1, &all);
            for (address, value) in memory.initial.iter().enumerate().filter(|(_, value)| **value != 0) {
                text += &indented(depth + 1, &format!("{name}[{address}] = {};", word(*value)));
            }
            text += &indented(depth, "end");
            text += &self.written(index, memory, depth);
        }
        text
    }

    /// The declarations of all memories.
    pub(super) fn arrays(&self) -> String {
        let memories = self.design.netlist().memories.iter().zip(&self.names.memories);
        let array = |(memory, name): (&Memory, &String)| {
            indented(1, &format!("reg {}{name} [0:{}];", vector(memory.width.get(), false), memory.size - 1))
        };
        memories.map(array).collect()
    }

    /// All write ports of a memory: the later of two assignments to a bit wins.
    fn written(&self, index: usize, memory: &Memory, depth: usize) -> String {
        if memory.writes.is_empty() {
            return String::new();
        }
        let mut text = indented(depth, &format!("always @(posedge {})", self.names.clk));
        text += &indented(depth + 1, &format!("if (!{}) begin", self.names.rst));
        for port in memory.writes.iter().filter(|port| !self.writer.is_outside(index, port.address)) {
            text += &self.port(index, memory.width, *port, depth + 2);
        }
        text + &indented(depth + 1, "end")
    }

    fn port(&self, index: usize, width: Width, port: WritePort, depth: usize) -> String {
        let (place, writer) = (ScopeId::TOP, &self.writer);
        let word = writer.word(index, port.address, place);
        let inside = writer.inside(index, port.address, place).map(|inside| format!(" && {inside}"));
        let when = format!("if (({}){})", writer.read(port.enable, place).text, inside.unwrap_or_default());
        let data = writer.read(port.data, place).text;
        match port.mask {
            None => indented(depth, &format!("{when} {word} <= {data};")),
            Some(mask) if width == Width::ONE => {
                let mask = writer.read(mask, place).text;
                indented(depth, &format!("{when} if ({mask}) {word} <= {data};"))
            }
            Some(mask) => {
                let bit = |bit: u32| {
                    let [mask, data] = [mask, port.data].map(|net| writer.part(net, bit, 1, place));
                    indented(depth + 1, &format!("if ({mask}) {word}[{bit}] <= {data};"))
                };
                let bits: String = (0..width.get()).map(bit).collect();
                indented(depth, &format!("{when} begin")) + &bits + &indented(depth, "end")
            }
        }
    }
}
