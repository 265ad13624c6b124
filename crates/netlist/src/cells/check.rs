//! The rule of widths, and nets in the words of a message.

use super::{Cell, Memory, Net, Netlist, Op};
use crate::bits::Width;
use crate::diag::Code;

impl Netlist {
    /// The rule of widths for a cell whose operands exist: the one place where they are checked.
    ///
    /// # Errors
    /// The broken rule, with the widths concerned.
    pub fn check_cell(&self, cell: &Cell) -> Result<(), (Code, String)> {
        let w = |net: Net| self.width(net);
        let equal = |a: Net, b: Net| {
            if w(a) == w(b) {
                Ok(())
            } else {
                let message = format!("{} and {} are not equally wide", self.describe(a), self.describe(b));
                Err((Code::WidthMismatch, message))
            }
        };
        let is = |net: Net, width: Width| {
            if w(net) == width {
                Ok(())
            } else {
                let message = format!("{} is given where {width} are needed", self.describe(net));
                Err((Code::WidthMismatch, message))
            }
        };
        let one_bit = |width: Width| {
            if width == Width::ONE {
                Ok(())
            } else {
                Err((Code::NotOneBit, format!("a yes-or-no result is 1 bit wide, not {width}")))
            }
        };
        match cell.op {
            Op::Input => Ok(()),
            Op::Const(value) | Op::Register { reset: value, .. } if value > cell.width.mask() => {
                Err((Code::ValueTooWide, format!("the value {value} does not fit in {}", cell.width)))
            }
            Op::Const(_) | Op::Register { next: None, .. } => Ok(()),
            Op::Register { next: Some(next), .. } => is(next, cell.width),
            Op::Not(a) => is(a, cell.width),
            Op::ShiftLeft(a, _) | Op::ShiftRight(a, _) | Op::ShiftArithmetic(a, _) => is(a, cell.width),
            Op::And(a, b)
            | Op::Or(a, b)
            | Op::Xor(a, b)
            | Op::Add(a, b)
            | Op::Sub(a, b)
            | Op::Mul(a, b)
            | Op::Div(a, b)
            | Op::Rem(a, b) => {
                equal(a, b)?;
                is(a, cell.width)
            }
            Op::Mux { select, high, low } => {
                if w(select) != Width::ONE {
                    return Err((Code::NotOneBit, format!("{} selects, so it must be 1 bit", self.describe(select))));
                }
                equal(high, low)?;
                is(high, cell.width)
            }
            Op::Carry(a, b)
            | Op::Borrow(a, b)
            | Op::AddOverflow(a, b)
            | Op::SubOverflow(a, b)
            | Op::Equal(a, b)
            | Op::LessSigned(a, b) => {
                equal(a, b)?;
                one_bit(cell.width)
            }
            Op::Slice { of, low } => {
                if u32::from(low) + cell.width.get() <= w(of).get() {
                    Ok(())
                } else {
                    let what = format!("{} from bit {low} of {}", cell.width, self.describe(of));
                    Err((Code::OutOfRange, format!("a slice of {what} reaches past its top")))
                }
            }
            Op::Concat { high, low } => {
                if w(high).get() + w(low).get() == cell.width.get() {
                    Ok(())
                } else {
                    let parts = format!("{} above {}", self.describe(high), self.describe(low));
                    Err((Code::WidthMismatch, format!("{parts} do not make {}", cell.width)))
                }
            }
            Op::Read { memory, .. } => match self.memories.get(memory as usize) {
                None => Err((Code::OutOfRange, format!("there is no memory {memory}"))),
                Some(memory) if memory.width == cell.width => Ok(()),
                Some(memory) => {
                    let path = self.memory_path(memory);
                    Err((Code::WidthMismatch, format!("a word of {path} has {}, not {}", memory.width, cell.width)))
                }
            },
            Op::ZeroExtend(a) | Op::SignExtend(a) => {
                if w(a) <= cell.width {
                    Ok(())
                } else {
                    let message = format!("{} cannot be extended to {}", self.describe(a), cell.width);
                    Err((Code::OutOfRange, message))
                }
            }
        }
    }

    /// What is wrong with a memory whose nets and scope exist: its size, its first words, the widths of its ports.
    #[must_use]
    pub fn memory_mistakes(&self, memory: &Memory) -> Vec<(Code, String)> {
        let path = self.memory_path(memory);
        let mut found = Vec::new();
        let (size, most) = (memory.size, Memory::MOST_WORDS);
        if !(1..=most).contains(&size) {
            found.push((Code::OutOfRange, format!("the memory {path} of {size} words is not possible: 1 to {most}")));
        }
        let given = memory.initial.len();
        if given as u64 > size {
            found.push((Code::OutOfRange, format!("{given} words are given to the memory {path} of {size}")));
        }
        if let Some(word) = memory.initial.iter().find(|word| **word > memory.width.mask()) {
            let message = format!("the word {word} does not fit in the {} of the memory {path}", memory.width);
            found.push((Code::ValueTooWide, message));
        }
        for port in &memory.writes {
            if self.width(port.enable) != Width::ONE {
                let message = format!("{} enables a write of {path}, so it must be 1 bit", self.describe(port.enable));
                found.push((Code::NotOneBit, message));
            }
            for net in [Some(port.data), port.mask].into_iter().flatten() {
                if self.width(net) != memory.width {
                    let message =
                        format!("{} is written to {path}, whose words have {}", self.describe(net), memory.width);
                    found.push((Code::WidthMismatch, message));
                }
            }
        }
        found
    }

    /// A net in words: path and width.
    #[must_use]
    pub fn describe(&self, net: Net) -> String {
        let name = self.name_of(net).map_or_else(|| format!("net %{}", net.0), |named| self.path(named));
        format!("{name} ({})", self.width(net))
    }
}
