//! Events of operations that have no result in the source: divisions by 0, and addresses outside of a memory.
//!
//! As with overflows only what is taken counts: a quotient or a word that a multiplexer or an enable leaves out is not an event,
//! nor is a write that is not enabled. A memory that holds every address that its ports can have has none.

use stepwave_netlist::Net;
use stepwave_netlist::cells::Word as Operand;
use stepwave_netlist::cells::{Claim, Op, Property, Undefined};

use crate::design::Design;
use crate::json::{Cell, Wire};
use crate::memory::{flag, is_memory, of_port, size};
use crate::names::Scopes;
use crate::overflow::Readers;
use crate::word::Word;

/// A port of a memory.
struct Port {
    index: usize,
    writes: bool,
}

impl<'a> Design<'a> {
    /// A property for every division that may be one by 0, and for every port that may leave its memory.
    pub(crate) fn undefined(&mut self, scopes: &mut Scopes, readers: &mut Readers<'a>) {
        let module = self.module;
        let mut flags: Vec<(String, Net)> = Vec::new();
        for (name, cell) in &module.cells {
            self.at(cell);
            if let Some((path, never, claim)) = self.divided_by_zero(name, cell, readers) {
                self.add_undefined(&mut flags, path, never, claim);
            }
            if !is_memory(cell) {
                continue;
            }
            for (writes, ports) in [(false, "RD_PORTS"), (true, "WR_PORTS")] {
                for index in 0..size(cell, ports) {
                    if let Some((path, never, claim)) = self.outside_of(name, cell, &Port { index, writes }, readers) {
                        self.add_undefined(&mut flags, path, never, claim);
                    }
                }
            }
        }
        self.show_flags(scopes, "undefined", flags);
    }

    fn add_undefined(&mut self, flags: &mut Vec<(String, Net)>, path: String, never: Net, claim: Claim) {
        let name = format!("{}.{path}", self.builder.netlist.scopes[0].name);
        flags.push((path, never));
        self.builder.netlist.properties.push(Property { name, never, claim });
    }

    /// A bit of its own, with the line of the source, which is 1 where both are.
    fn both(&mut self, a: Net, b: Net) -> Net {
        self.builder.push(Op::And(a, b), 1)
    }

    /// When a division by 0 is taken: what takes it, the bit, what is claimed.
    fn divided_by_zero(
        &mut self,
        name: &'a str,
        cell: &'a Cell,
        readers: &mut Readers<'a>,
    ) -> Option<(String, Net, Claim)> {
        let undefined = match cell.kind.as_str() {
            "$div" | "$divfloor" => Undefined::Quotient,
            "$mod" | "$modfloor" => Undefined::Remainder,
            _ => return None,
        };
        let (a, b, y) = (cell.pin("A"), cell.pin("B"), cell.pin("Y"));
        let kept = y.iter().rposition(|wire| readers.is_read(wire)).map_or(0, |last| last + 1);
        let is_one = |wire: &Wire| *wire == Wire::Constant("1".to_owned());
        if kept == 0 || a.is_empty() || b.iter().any(is_one) {
            return None;
        }
        let (dividend, divisor) = (self.word(a), self.word(b));
        let some = self.builder.any(&divisor);
        let (zero, taken) = (self.builder.invert(some), self.cell_taken(name, cell, readers));
        let never = self.both(zero, taken);
        let mut path = self.target(name, &y[..kept], readers).name;
        if path.is_empty() {
            let place = cell.short_line().unwrap_or_else(|| name.to_owned());
            path = format!("{place} {}", cell.kind.trim_start_matches('$'));
        }
        let signed = cell.flag("A_SIGNED") && cell.flag("B_SIGNED");
        Some((path, never, Claim::Defined { undefined, operand: Operand { nets: dividend.parts, signed } }))
    }

    /// When a port reads or writes outside of its memory: the memory, the bit, what is claimed; `None` where it never can.
    fn outside_of(
        &mut self,
        name: &'a str,
        cell: &'a Cell,
        port: &Port,
        readers: &mut Readers<'a>,
    ) -> Option<(String, Net, Claim)> {
        let pin = if port.writes { "WR_ADDR" } else { "RD_ADDR" };
        let wires = of_port(cell.pin(pin), cell.number("ABITS"), port.index);
        let (first, words) = (size(cell, "OFFSET") as u64, size(cell, "SIZE") as u64);
        let end = first.checked_add(words)?;
        if let Some([least, greatest]) = self.numbers(wires, false)
            && least >= i128::from(first)
            && greatest < i128::from(end)
        {
            return None;
        }
        let address = self.word(wires);
        let below = self.is_below(&address, first);
        let inside = self.is_below(&address, end);
        let beyond = self.builder.invert(inside);
        let outside = self.builder.or(below, beyond);
        let taken = self.port_taken(name, cell, port, readers);
        let never = self.both(outside, taken);
        let undefined = if port.writes { Undefined::Write { first, words } } else { Undefined::Read { first, words } };
        let path = self.memory.get(name)?.path.clone();
        Some((path, never, Claim::Defined { undefined, operand: Operand { nets: address.parts, signed: false } }))
    }

    /// An unsigned word is less than a number.
    fn is_below(&mut self, word: &Word, number: u64) -> Net {
        let bits = word.width.max(u64::BITS - number.leading_zeros()).max(1);
        let (word, number) = (self.builder.fit(word, bits, false), self.builder.number(number, bits));
        self.builder.less(&word, &number, false)
    }

    /// When a port writes, or what it reads is taken.
    fn port_taken(&mut self, name: &'a str, cell: &'a Cell, port: &Port, readers: &mut Readers<'a>) -> Net {
        let width = cell.number("WIDTH");
        if port.writes {
            let enables = self.word(of_port(cell.pin("WR_EN"), width, port.index));
            return self.builder.any(&enables);
        }
        if !flag(cell, "RD_CLK_ENABLE", port.index) {
            return self.bits_taken((name, port.index), of_port(cell.pin("RD_DATA"), width, port.index), readers);
        }
        let enable = self.port_control(cell, "RD_EN", port.index);
        let resets = ["RD_SRST", "RD_ARST"].map(|pin| self.port_control(cell, pin, port.index));
        let reset = self.builder.or(resets[0], resets[1]);
        let running = self.builder.invert(reset);
        self.builder.and(enable, running)
    }
}
