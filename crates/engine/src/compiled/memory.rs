//! Native code of memories: loads where cells read, stores at the edge.

use rustc_hash::FxHashMap as HashMap;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{InstBuilder, Value, types};

use super::codegen::{Generator, offset, trusted};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Netlist, WritePort};

impl Generator<'_, '_> {
    /// The word at an address. Outside it is the word after the last, which is always 0.
    pub(super) fn read(&mut self, memory: usize, changes: bool, address: (Value, Width), width: Width) -> Value {
        let place = self.plan.memories[memory];
        let (address, bits) = address;
        let mut inside = self.wide(address);
        if bits.mask() >= place.size {
            let last = self.f.ins().iconst(types::I64, place.size.cast_signed());
            inside = self.f.ins().umin(inside, last);
        }
        let at = self.word_at(inside);
        let flags = if changes { trusted() } else { trusted().with_readonly().with_can_move() };
        let word = self.f.ins().load(types::I64, flags, at, offset(place.first));
        self.converted(word, self.kind(width))
    }

    /// All ports write, one after another, what their nets were before the edge.
    pub(super) fn write_memories(&mut self, netlist: &Netlist, values: &HashMap<Net, Value>) {
        for (memory, of) in netlist.memories.iter().enumerate() {
            for port in &of.writes {
                self.write(memory, *port, |net| values[&net]);
            }
        }
    }

    /// A port writes, if its enable is 1 and its address inside of the memory.
    pub(super) fn write(&mut self, memory: usize, port: WritePort, value: impl Fn(Net) -> Value) {
        let size = self.plan.memories[memory].size.cast_signed();
        let address = self.wide(value(port.address));
        let inside = self.f.ins().icmp_imm(IntCC::UnsignedLessThan, address, size);
        let writes = self.f.ins().band(value(port.enable), inside);
        let (write, after) = (self.f.create_block(), self.f.create_block());
        self.f.ins().brif(writes, write, &[], after, &[]);
        self.f.switch_to_block(write);
        let (at, place) = (self.word_at(address), offset(self.plan.memories[memory].first));
        let mut word = self.wide(value(port.data));
        if let Some(mask) = port.mask {
            let mask = self.wide(value(mask));
            let old = self.f.ins().load(types::I64, trusted(), at, place);
            let changed = self.f.ins().bxor(old, word);
            let changed = self.f.ins().band(changed, mask);
            word = self.f.ins().bxor(old, changed);
        }
        self.f.ins().store(trusted(), word, at, place);
        self.f.ins().jump(after, &[]);
        self.f.switch_to_block(after);
    }

    /// Where the word of this index is, counted from the first of all words.
    fn word_at(&mut self, index: Value) -> Value {
        let bytes = self.f.ins().ishl_imm(index, 3);
        self.f.ins().iadd(self.memories, bytes)
    }
}
