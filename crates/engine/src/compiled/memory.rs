//! Native code of memories: loads where cells read, stores at the edge.

use std::collections::HashMap;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};

use super::codegen::{Generator, kind, offset, trusted};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Netlist, WritePort};

impl Generator<'_, '_> {
    /// The word at an address. Outside it is the word after the last, which is always 0.
    pub(super) fn read(&mut self, memory: usize, changes: bool, address: Value, width: Width) -> Value {
        let place = self.plan.memories[memory];
        let address = self.wide(address);
        let last = self.f.ins().iconst(types::I64, place.size.cast_signed());
        let inside = self.f.ins().umin(address, last);
        let at = self.word_at(inside);
        let flags = if changes { trusted() } else { trusted().with_readonly().with_can_move() };
        let word = self.f.ins().load(types::I64, flags, at, offset(place.first));
        if kind(width) == types::I8 { self.f.ins().ireduce(types::I8, word) } else { word }
    }

    /// All ports write, one after another, what their nets were before the edge.
    pub(super) fn write_memories(&mut self, netlist: &Netlist, values: &HashMap<Net, Value>) {
        for (memory, size) in netlist.memories.iter().enumerate().map(|(index, memory)| (index, memory.size)) {
            for port in &netlist.memories[memory].writes {
                let address = self.wide(values[&port.address]);
                let inside = self.f.ins().icmp_imm(IntCC::UnsignedLessThan, address, size.cast_signed());
                let writes = self.f.ins().band(values[&port.enable], inside);
                let (write, after) = (self.f.create_block(), self.f.create_block());
                self.f.ins().brif(writes, write, &[], after, &[]);
                self.f.switch_to_block(write);
                self.write(memory, *port, address, values);
                self.f.ins().jump(after, &[]);
                self.f.switch_to_block(after);
            }
        }
    }

    /// A port writes a word inside of the memory.
    fn write(&mut self, memory: usize, port: WritePort, address: Value, values: &HashMap<Net, Value>) {
        let (at, place) = (self.word_at(address), offset(self.plan.memories[memory].first));
        let mut word = self.wide(values[&port.data]);
        if let Some(mask) = port.mask {
            let mask = self.wide(values[&mask]);
            let old = self.f.ins().load(types::I64, trusted(), at, place);
            let changed = self.f.ins().bxor(old, word);
            let changed = self.f.ins().band(changed, mask);
            word = self.f.ins().bxor(old, changed);
        }
        self.f.ins().store(trusted(), word, at, place);
    }

    /// Where the word of this index is, counted from the first of all words.
    fn word_at(&mut self, index: Value) -> Value {
        let bytes = self.f.ins().ishl_imm(index, 3);
        self.f.ins().iadd(self.memories, bytes)
    }
}
