//! Memories (`$mem_v2`): one of the netlist's own for every 64 bits of a word.
//!
//! Outside of the memory a read gives 0 and a write does nothing. Of several ports that write one bit the last wins. A
//! clocked read port that sees a write at the same edge takes the old word, unless it is transparent to that port.

use stepwave_netlist::Net;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Memory, Op, WritePort};

use crate::ImportError;
use crate::design::{Design, MOST_BITS, Node};
use crate::json::{Cell, Wire};
use crate::names::Scopes;
use crate::word::Word;

/// Bits of a memory of the netlist.
const PART: usize = 64;

/// The bits of a port among those of all ports, each of this many bits.
pub(crate) fn of_port(wires: &[Wire], bits: Option<i64>, port: usize) -> &[Wire] {
    let bits = bits.and_then(|bits| usize::try_from(bits).ok()).unwrap_or(0);
    wires.get(port * bits..(port + 1) * bits).unwrap_or(&[])
}

/// The numbers of 64 bits that make up a word, least significant first.
pub(crate) fn values(bits: &[bool]) -> Vec<u64> {
    let number = |part: &[bool]| part.iter().rev().fold(0, |value, bit| value << 1 | u64::from(*bit));
    bits.chunks(64).map(number).collect()
}

/// What a memory has become: memories of the netlist from a first one on, one for each part of a word, and the registers of
/// its clocked read ports.
#[derive(Debug)]
pub(crate) struct Parts {
    first: u32,
    /// Path of the memory without the name of the design.
    pub(crate) path: String,
    reads: Vec<Option<Word>>,
}

/// What a parameter says that is a number from 0 on.
pub(crate) fn size(cell: &Cell, parameter: &str) -> usize {
    cell.number(parameter).and_then(|number| usize::try_from(number).ok()).unwrap_or(0)
}

pub(crate) fn is_memory(cell: &Cell) -> bool {
    cell.kind == "$mem_v2"
}

/// A bit of a parameter that has one for each port.
pub(crate) fn flag(cell: &Cell, parameter: &str, port: usize) -> bool {
    cell.bits(parameter).get(port) == Some(&'1')
}

impl Design<'_> {
    /// Every memory, without its write ports, and the registers of clocked read ports, without their next values.
    pub(crate) fn memories(&mut self, scopes: &mut Scopes) -> Result<(), ImportError> {
        let module = self.module;
        for (name, cell) in module.cells.iter().filter(|(_, cell)| is_memory(cell)) {
            self.at(cell);
            let (words, width) = (size(cell, "SIZE"), size(cell, "WIDTH"));
            if words as u64 > Memory::MOST_WORDS || words == 0 || width == 0 || width > MOST_BITS {
                let why = format!(
                    "a memory of {words} words of {width} bits: 1 to {} words of 1 to {MOST_BITS} bits are imported",
                    Memory::MOST_WORDS
                );
                return Err(self.wrong(name, cell, why));
            }
            let mut initial = cell.bits("INIT");
            initial.resize(words * width, 'x');
            let initial: Vec<bool> = initial.into_iter().map(|digit| self.digit(digit)).collect();
            let first = u32::try_from(self.builder.netlist.memories.len()).unwrap_or(u32::MAX);
            let (scope, own) = scopes.place(&mut self.builder.netlist.scopes, name);
            for low in (0..width).step_by(PART) {
                let high = (low + PART).min(width);
                let contents = initial.chunks(width).map(|word| values(&word[low..high])[0]).collect();
                let name = match width {
                    0..=PART => own.clone(),
                    _ => scopes.fresh(scope, &format!("{own}_{}_{low}", high - 1)),
                };
                let bits = Width::new((high - low) as u64).unwrap_or(Width::MAX);
                let memory =
                    Memory { scope, name, width: bits, size: words as u64, initial: contents, writes: Vec::new() };
                self.builder.netlist.memories.push(memory);
            }
            let mut reads = Vec::new();
            for port in 0..size(cell, "RD_PORTS") {
                if !flag(cell, "RD_CLK_ENABLE", port) {
                    reads.push(None);
                    continue;
                }
                let all = cell.bits("RD_INIT_VALUE");
                let mut digits: Vec<char> = all.into_iter().skip(port * width).take(width).collect();
                digits.resize(width, 'x');
                reads.push(Some(self.held(&digits)));
            }
            let path = format!("{}.{own}", self.builder.netlist.scope_path(scope));
            let path = path.split_once('.').map_or(path.as_str(), |(_, inner)| inner).to_owned();
            self.memory.insert(name.clone(), Parts { first, path, reads });
        }
        Ok(())
    }

    /// A register with these initial digits, least significant first.
    fn held(&mut self, digits: &[char]) -> Word {
        let digits: Vec<bool> = digits.iter().map(|&digit| self.digit(digit)).collect();
        let resets = values(&digits);
        let width = u32::try_from(digits.len()).unwrap_or(u32::MAX);
        self.builder.each(width, |part| Op::Register { next: None, reset: resets[part] })
    }

    /// What a read port shows: the word at its address, or the register of a clocked port.
    pub(crate) fn read(&mut self, node: &Node<'_>, port: usize) -> Word {
        let (cell, width) = (node.cell, size(node.cell, "WIDTH"));
        let held = self.memory.get(node.name).and_then(|memory| memory.reads.get(port).cloned().flatten());
        match held {
            None => self.word_at(node.name, cell, of_port(cell.pin("RD_ADDR"), cell.number("ABITS"), port)),
            Some(held) => {
                let reset = self.port_control(cell, "RD_ARST", port);
                let value = self.port_value(cell, "RD_ARST_VALUE", port, width);
                self.builder.mux(reset, &value, &held)
            }
        }
    }

    pub(crate) fn port_control(&mut self, cell: &Cell, pin: &str, port: usize) -> Net {
        match cell.pin(pin).get(port) {
            Some(wire) => self.word(std::slice::from_ref(wire)).parts[0],
            None => self.builder.number(0, 1).parts[0],
        }
    }

    fn port_value(&mut self, cell: &Cell, parameter: &str, port: usize, width: usize) -> Word {
        let digits = cell.bits(parameter);
        let digits = digits.iter().skip(port * width).chain(std::iter::repeat(&'x')).take(width);
        let wires: Vec<Wire> = digits.map(|digit| Wire::Constant(digit.to_string())).collect();
        self.word(&wires)
    }

    /// The address of a port in the memory itself, wide enough to tell addresses below and beyond it.
    fn inner_address(&mut self, cell: &Cell, address: &[Wire]) -> Word {
        let address = self.word(address);
        let offset = size(cell, "OFFSET") as u64;
        if offset == 0 {
            return address;
        }
        // Below the memory the difference is negative, and so beyond it as an unsigned number.
        let bits = (address.width + 1).min(64);
        let (address, offset) = (self.builder.fit(&address, bits, false), self.builder.number(offset, bits));
        self.builder.sub(&address, &offset)
    }

    /// The word at an address; 0 outside of the memory.
    fn word_at(&mut self, name: &str, cell: &Cell, address: &[Wire]) -> Word {
        let address = self.inner_address(cell, address).parts[0];
        let first = self.memory.get(name).map_or(0, |memory| memory.first);
        let width = u32::try_from(size(cell, "WIDTH")).unwrap_or(u32::MAX);
        self.builder.each(width, |part| Op::Read { memory: first + u32::try_from(part).unwrap_or(u32::MAX), address })
    }

    /// Writes the write ports of every memory, and the next values of clocked read ports.
    pub(crate) fn clock_memories(&mut self) {
        let module = self.module;
        for (name, cell) in module.cells.iter().filter(|(_, cell)| is_memory(cell)) {
            self.at(cell);
            let Some(first) = self.memory.get(name).map(|memory| memory.first) else { continue };
            for port in 0..size(cell, "WR_PORTS") {
                let address = of_port(cell.pin("WR_ADDR"), cell.number("ABITS"), port).to_vec();
                let address = self.inner_address(cell, &address).parts[0];
                let data = self.word(of_port(cell.pin("WR_DATA"), cell.number("WIDTH"), port));
                let mask = self.word(of_port(cell.pin("WR_EN"), cell.number("WIDTH"), port));
                for (part, (&data, &mask)) in data.parts.iter().zip(&mask.parts).enumerate() {
                    let bits = self.builder.netlist.width(mask).get();
                    let enable = self.builder.any(&Word { parts: vec![mask], width: bits });
                    let port = WritePort { enable, address, data, mask: Some(mask) };
                    self.builder.netlist.memories[first as usize + part].writes.push(port);
                }
            }
            for port in 0..size(cell, "RD_PORTS") {
                let held = self.memory[name].reads[port].clone();
                if let Some(held) = held {
                    let next = self.read_next(name, cell, port, &held);
                    self.next_of(&held, &next);
                }
            }
        }
    }

    /// A word after a write port where the port is at it.
    fn written(&mut self, cell: &Cell, port: usize, hit: Net, word: &Word) -> Word {
        let width = cell.number("WIDTH");
        let data = self.word(of_port(cell.pin("WR_DATA"), width, port));
        let enables = of_port(cell.pin("WR_EN"), width, port);
        if enables.windows(2).all(|pair| pair[0] == pair[1]) {
            let enable = self.word(&enables[..1]).parts[0];
            let enable = self.builder.and(enable, hit);
            return self.builder.mux(enable, &data, word);
        }
        let mask = self.word(enables);
        let kept = self.builder.not(&mask);
        let (new, old) = (self.builder.bitwise(&data, &mask, Op::And), self.builder.bitwise(word, &kept, Op::And));
        let merged = self.builder.bitwise(&new, &old, Op::Or);
        self.builder.mux(hit, &merged, word)
    }

    /// The next value of a clocked read port.
    fn read_next(&mut self, name: &str, cell: &Cell, port: usize, held: &Word) -> Word {
        let address = of_port(cell.pin("RD_ADDR"), cell.number("ABITS"), port).to_vec();
        let mut data = self.word_at(name, cell, &address);
        let ports = size(cell, "WR_PORTS");
        let transparent = cell.bits("RD_TRANSPARENCY_MASK");
        for other in (0..ports).filter(|other| transparent.get(port * ports + other) == Some(&'1')) {
            let own = self.word(&address);
            let to = self.word(of_port(cell.pin("WR_ADDR"), cell.number("ABITS"), other));
            let hit = self.builder.equal(&own, &to);
            data = self.written(cell, other, hit, &data);
        }
        let width = held.width as usize;
        let (enable, reset) = (self.port_control(cell, "RD_EN", port), self.port_control(cell, "RD_SRST", port));
        let value = self.port_value(cell, "RD_SRST_VALUE", port, width);
        let next = if flag(cell, "RD_CE_OVER_SRST", port) {
            let data = self.builder.mux(reset, &value, &data);
            self.builder.mux(enable, &data, held)
        } else {
            let data = self.builder.mux(enable, &data, held);
            self.builder.mux(reset, &value, &data)
        };
        let (reset, value) =
            (self.port_control(cell, "RD_ARST", port), self.port_value(cell, "RD_ARST_VALUE", port, width));
        self.builder.mux(reset, &value, &next)
    }

    /// Gives a register its next value.
    pub(crate) fn next_of(&mut self, register: &Word, next: &Word) {
        for (&register, &next) in register.parts.iter().zip(&next.parts) {
            if let Op::Register { next: slot, .. } = &mut self.builder.netlist.cells[register.index()].op {
                *slot = Some(next);
            }
        }
    }
}
