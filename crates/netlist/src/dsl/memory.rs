//! Memories in a description.

use super::{Scope, Signal};
use crate::bits::Width;
use crate::cells::{self, Op, WritePort};
use crate::diag::Code;

/// A memory of a module.
#[derive(Clone, Copy, Debug)]
pub struct Memory<'m> {
    scope: Scope<'m>,
    index: u32,
    width: Width,
}

impl<'m> Scope<'m> {
    /// A memory of `words` words of `bits` bits, all 0 before the first edge.
    #[track_caller]
    pub fn memory(self, name: &str, bits: u32, words: u64) -> Memory<'m> {
        self.claim_name(name);
        let width = match Width::new(u64::from(bits)) {
            Ok(width) => width,
            Err(error) => {
                self.module.report(Code::BadWidth, format!("{name}: {error}"));
                Width::ONE
            }
        };
        let (initial, writes) = (Vec::new(), Vec::new());
        let memory = cells::Memory { scope: self.id, name: name.to_owned(), width, size: words, initial, writes };
        let memories = &mut self.module.state.borrow_mut().netlist.memories;
        memories.push(memory);
        Memory { scope: self, index: u32::try_from(memories.len() - 1).unwrap_or(u32::MAX), width }
    }
}

impl<'m> Memory<'m> {
    /// Changes the memory; what is wrong with it then, and was not before, is reported.
    #[track_caller]
    fn change(self, change: impl FnOnce(&mut cells::Memory)) {
        let index = self.index as usize;
        let mistakes = {
            let netlist = &mut self.scope.module.state.borrow_mut().netlist;
            let before = netlist.memory_mistakes(&netlist.memories[index]).len();
            change(&mut netlist.memories[index]);
            netlist.memory_mistakes(&netlist.memories[index]).into_iter().skip(before).collect::<Vec<_>>()
        };
        for (code, message) in mistakes {
            self.scope.module.report(code, message);
        }
    }

    /// Words before the first edge, from address 0 on; the others are 0.
    #[track_caller]
    pub fn initial(self, words: impl IntoIterator<Item = u64>) -> Memory<'m> {
        self.change(|memory| memory.initial = words.into_iter().collect());
        self
    }

    /// The word at an unsigned address of any width, in the present contents; 0 outside of the memory.
    #[track_caller]
    #[must_use]
    pub fn read(self, address: Signal<'m>) -> Signal<'m> {
        let address = self.scope.own(address).net();
        self.scope.new_signal(Op::Read { memory: self.index, address }, self.width.get(), false)
    }

    /// Where `enable` (1 bit) is 1 at an edge, the word at `address` becomes `data`, or the bits of it for which `mask`
    /// is 1. Of two ports that write one bit the later wins.
    #[track_caller]
    pub fn write(self, enable: Signal<'m>, address: Signal<'m>, data: Signal<'m>, mask: Option<Signal<'m>>) {
        let [enable, address, data] = [enable, address, data].map(|signal| self.scope.own(signal));
        let mask = mask.map(|mask| self.scope.own(mask));
        if [Some(enable), Some(address), Some(data), mask].into_iter().flatten().any(Signal::is_guess) {
            // Its mistake has been reported.
            return;
        }
        let port =
            WritePort { enable: enable.net(), address: address.net(), data: data.net(), mask: mask.map(Signal::net) };
        self.change(|memory| memory.writes.push(port));
    }
}
