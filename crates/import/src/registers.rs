//! Registers: every kind of flip-flop that Yosys has, on one clock.
//!
//! A register with an asynchronous control is a register and a multiplexer after it: the output has the value of the
//! control in the very sample, and the register takes it at the edge.

use stepwave_netlist::Net;
use stepwave_netlist::cells::Op;

use crate::cells::is_register;
use crate::design::{Design, Node, Part, is_asynchronous};
use crate::json::{Cell, Wire};
use crate::word::Word;
use crate::{ImportError, Unknown};

/// A register whose next value is still to be written.
pub(crate) struct Pending<'a> {
    pub(crate) cell: &'a Cell,
    /// What the clock changes.
    pub(crate) state: Word,
}

impl<'a> Design<'a> {
    /// All registers, without their next values. Those without an asynchronous control drive their nets.
    pub(crate) fn registers(&mut self) -> Result<Vec<Pending<'a>>, ImportError> {
        let initial: std::collections::HashMap<u32, char> = self.initial();
        let mut pending = Vec::new();
        let mut open = 0u32;
        for (name, cell) in self.module.cells.iter().filter(|(_, cell)| is_register(&cell.kind)) {
            self.at(cell);
            let q = cell.pin("Q");
            open += u32::from(q.iter().any(|wire| matches!(wire, Wire::Net(net) if !initial.contains_key(net))));
            let digits: Vec<bool> = q
                .iter()
                .map(|wire| match wire {
                    Wire::Net(net) => self.digit(initial.get(net).copied().unwrap_or('x')),
                    Wire::Constant(_) => false,
                })
                .collect();
            let resets = crate::memory::values(&digits);
            let width = u32::try_from(q.len()).unwrap_or(u32::MAX);
            let state = self.builder.each(width, |part| Op::Register { next: None, reset: resets[part] });
            if is_asynchronous(cell) {
                self.states.insert(name.clone(), state.clone());
            } else {
                for (wire, bit) in q.iter().zip(state.bits()) {
                    let Wire::Net(net) = wire else { continue };
                    if self.values.insert(*net, bit).is_some() {
                        return Err(ImportError::TwoDrivers {
                            net: self.net_name(*net),
                            first: "an input or a register".to_owned(),
                            second: self.place(name, cell).to_string(),
                        });
                    }
                }
            }
            pending.push(Pending { cell, state });
        }
        if open > 0 && self.options.unknown == Unknown::Zero {
            let (what, begins) = match open {
                1 => ("1 register has".to_owned(), "begins"),
                count => (format!("{count} registers have"), "begin"),
            };
            self.notes.push(format!(
                "{what} no initial value and {begins} with 0, in proofs too: --x 1 and --x random:SEED begin otherwise"
            ));
        }
        Ok(pending)
    }

    /// Initial values of numbered nets.
    fn initial(&self) -> std::collections::HashMap<u32, char> {
        let names = self.module.netnames.values();
        let all =
            names.flat_map(|name| name.bits.iter().zip(name.init()).filter(|(_, digit)| matches!(digit, '0' | '1')));
        all.filter_map(|(wire, digit)| match wire {
            Wire::Net(net) => Some((*net, digit)),
            Wire::Constant(_) => None,
        })
        .collect()
    }

    /// A control of one bit, 1 where it is active; `None` where the cell has no such pin.
    pub(crate) fn control(&mut self, cell: &Cell, pin: &str) -> Option<Net> {
        let wires = cell.pin(pin);
        if wires.is_empty() {
            return None;
        }
        let net = self.word(wires).parts[0];
        Some(if cell.polarity(&format!("{pin}_POLARITY")) { net } else { self.builder.invert(net) })
    }

    /// A control a bit of the register.
    fn controls(&mut self, cell: &Cell, pin: &str) -> Word {
        let word = self.word(cell.pin(pin));
        if cell.polarity(&format!("{pin}_POLARITY")) { word } else { self.builder.not(&word) }
    }

    /// A value of a parameter, as a word as wide as the register.
    fn value(&mut self, cell: &Cell, parameter: &str, width: u32) -> Word {
        let mut digits = cell.bits(parameter);
        digits.resize(width as usize, '0');
        let wires: Vec<Wire> = digits.into_iter().map(|digit| Wire::Constant(digit.to_string())).collect();
        self.word(&wires)
    }

    /// What an asynchronous control makes of a word: of the state for the output, of the next value at the edge.
    fn controlled(&mut self, cell: &Cell, word: &Word) -> Word {
        match cell.kind.as_str() {
            "$adff" | "$adffe" => {
                let value = self.value(cell, "ARST_VALUE", word.width);
                match self.control(cell, "ARST") {
                    Some(reset) => self.builder.mux(reset, &value, word),
                    None => word.clone(),
                }
            }
            "$aldff" | "$aldffe" => {
                let value = self.word(cell.pin("AD"));
                match self.control(cell, "ALOAD") {
                    Some(load) => self.builder.mux(load, &value, word),
                    None => word.clone(),
                }
            }
            // Clear wins over set.
            "$dffsr" | "$dffsre" => {
                let (set, clear) = (self.controls(cell, "SET"), self.controls(cell, "CLR"));
                let kept = self.builder.not(&clear);
                let word = self.builder.bitwise(word, &set, Op::Or);
                self.builder.bitwise(&word, &kept, Op::And)
            }
            _ => word.clone(),
        }
    }

    /// The output of a register with an asynchronous control.
    pub(crate) fn output(&mut self, node: &Node<'_>) -> Word {
        assert_eq!(node.part, Part::Output);
        match self.states.get(node.name).cloned() {
            Some(state) => self.controlled(node.cell, &state),
            None => self.word(node.cell.pin("D")),
        }
    }

    /// Writes the next value of a register.
    pub(crate) fn clocked(&mut self, pending: &Pending<'_>) {
        let (cell, state) = (pending.cell, &pending.state);
        self.at(cell);
        let data = self.word(cell.pin("D"));
        let enable = self.control(cell, "EN");
        let enabled = |this: &mut Self, data: &Word| match enable {
            Some(enable) => this.builder.mux(enable, data, state),
            None => data.clone(),
        };
        let next = match cell.kind.as_str() {
            "$sdff" | "$sdffe" | "$sdffce" => {
                let value = self.value(cell, "SRST_VALUE", state.width);
                let reset = self.control(cell, "SRST");
                let reset = |this: &mut Self, data: Word| match reset {
                    Some(reset) => this.builder.mux(reset, &value, &data),
                    None => data,
                };
                if cell.kind == "$sdffce" {
                    let data = reset(self, data);
                    enabled(self, &data)
                } else {
                    let data = enabled(self, &data);
                    reset(self, data)
                }
            }
            _ => {
                let data = enabled(self, &data);
                self.controlled(cell, &data)
            }
        };
        self.next_of(state, &next);
    }
}
