//! What is gathered while lanes run, as vector instructions.

use super::assembler::{GREATEST_32, GREATEST_SIGNED_32, LEAST_32, LEAST_SIGNED_32, Opcode};
use super::flow::{Value, bits};
use super::operations::Operations;
use crate::lanes::code::{LaneOp, Slot};

impl Operations {
    /// What is gathered while a lane runs.
    pub(super) fn accumulator(&mut self, what: LaneOp<Slot>) -> Option<Value> {
        Some(match what {
            LaneOp::Count(sum, a) => {
                let (sum, counted, one) = (self.plain(sum), self.is_set(a), self.number(1));
                if counted.inverted {
                    // Less ones where it is zero: one more, and one less there.
                    let sum = self.add(sum, one);
                    self.add(sum, counted.value)
                } else {
                    self.sub(sum, counted.value)
                }
            }
            LaneOp::Idle(clocks, a, b) => {
                let (clocks, one) = (self.plain(clocks), self.number(1));
                let clocks = self.add(clocks, one);
                let (a, b) = (self.is_set(a), self.is_set(b));
                let alive = self.flow.or(a, b);
                self.flow.and(bits(clocks), alive.not()).value
            }
            LaneOp::Since(since, a) => {
                let (since, one, set) = (self.at(since), self.number(1), self.is_set(a));
                let since = self.flow.and(since, set.not());
                let since = self.flow.plain(since);
                self.add(since, one)
            }
            LaneOp::Sum(sum, a, width) => {
                let (sum, a) = (self.plain(sum), self.plain(a));
                let number = self.right(a, self.bits - width);
                self.add(sum, number)
            }
            LaneOp::Least(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.extreme(LEAST_32, a, b)
            }
            LaneOp::Greatest(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.extreme(GREATEST_32, a, b)
            }
            LaneOp::LeastSigned(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.extreme(LEAST_SIGNED_32, a, b)
            }
            LaneOp::GreatestSigned(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.extreme(GREATEST_SIGNED_32, a, b)
            }
            LaneOp::LeastWhere(least, a, at) => {
                let (least, a, set) = (self.plain(least), self.at(a), self.is_set(at));
                let a = self.flow.or(a, set.not());
                let a = self.flow.plain(a);
                self.extreme(LEAST_32, least, a)
            }
            LaneOp::GreatestWhere(greatest, a, at) => {
                let (greatest, a, set) = (self.plain(greatest), self.at(a), self.is_set(at));
                let a = self.flow.and(a, set);
                let a = self.flow.plain(a);
                self.extreme(GREATEST_SIGNED_32, greatest, a)
            }
            _ => return self.each(what),
        })
    }

    /// The least or greatest, named by the instruction for words of 32 bits.
    fn extreme(&mut self, opcode: Opcode, a: Value, b: Value) -> Value {
        if self.bits == 32 {
            return self.flow.two(opcode, a, b);
        }
        let signed = opcode == LEAST_SIGNED_32 || opcode == GREATEST_SIGNED_32;
        let less = if signed { self.less_signed(a, b) } else { self.less(a, b) };
        let least = opcode == LEAST_32 || opcode == LEAST_SIGNED_32;
        let (high, low) = if least { (a, b) } else { (b, a) };
        self.select(less, bits(high), bits(low)).value
    }
}
