//! Native code of a single cell. One-bit nets are bytes of 0 or 1, wider ones words of 64 bits (or of 32, where the code
//! is [narrow](Generator::narrow) and they fit) with zeros above the width.

use std::cmp::Ordering;

use cranelift_codegen::ir::condcodes::{CondCode, IntCC};
use cranelift_codegen::ir::{InstBuilder, InstructionData, Type, Value, types};

use super::codegen::{Generator, immediate};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Cell, Net, Netlist, Op};

impl Generator<'_, '_> {
    /// The value of a combinational cell or a constant.
    pub(super) fn operation(&mut self, netlist: &Netlist, cell: &Cell, at: impl Fn(Net) -> Value) -> Value {
        let width_of = |net: Net| netlist.width(net);
        let width = cell.width;
        let kind = self.kind(width);
        match cell.op {
            // Inputs and registers are given before; nothing else is without operands but a constant.
            Op::Input | Op::Register { .. } => self.f.ins().iconst(kind, 0),
            Op::Read { memory, address } => {
                let changes = !netlist.memories[memory as usize].writes.is_empty();
                self.read(memory as usize, changes, (at(address), width_of(address)), width)
            }
            Op::Const(value) => self.f.ins().iconst(kind, immediate(value)),
            Op::Not(a) if width == Width::ONE => self.opposite(at(a)),
            Op::Not(a) => {
                let ones = self.f.ins().iconst(kind, immediate(width.mask()));
                self.f.ins().bxor(at(a), ones)
            }
            Op::And(a, b) => self.f.ins().band(at(a), at(b)),
            Op::Or(a, b) => self.f.ins().bor(at(a), at(b)),
            Op::Xor(a, b) => self.f.ins().bxor(at(a), at(b)),
            Op::Mux { select, high, low } => self.f.ins().select(at(select), at(high), at(low)),
            Op::Add(a, b) => {
                let sum = self.sum(at(a), at(b));
                self.masked(sum, width)
            }
            Op::Sub(a, b) => {
                let difference = self.f.ins().isub(at(a), at(b));
                self.masked(difference, width)
            }
            Op::Mul(a, b) | Op::Div(a, b) if width == Width::ONE => self.f.ins().band(at(a), at(b)),
            Op::Rem(..) if width == Width::ONE => self.f.ins().iconst(types::I8, 0),
            Op::Mul(a, b) => {
                let product = self.f.ins().imul(at(a), at(b));
                self.masked(product, width)
            }
            Op::Div(a, b) | Op::Rem(a, b) => self.divide(cell.op, at(a), at(b)),
            Op::ShiftLeft(a, by) | Op::ShiftRight(a, by) | Op::ShiftArithmetic(a, by) => {
                self.shift(cell.op, at(a), at(by), width)
            }
            Op::Carry(a, b) => self.carry(at(a), at(b), width_of(a)),
            Op::Borrow(a, b) => self.f.ins().icmp(IntCC::UnsignedLessThan, at(a), at(b)),
            Op::AddOverflow(a, b) => {
                // The sign of the sum differs from both operands'.
                let sum = self.sum(at(a), at(b));
                let sum = self.masked(sum, width_of(a));
                let (x, y) = (self.f.ins().bxor(at(a), sum), self.f.ins().bxor(at(b), sum));
                self.sign_of_and(x, y, width_of(a))
            }
            Op::SubOverflow(a, b) => {
                let difference = self.f.ins().isub(at(a), at(b));
                let difference = self.masked(difference, width_of(a));
                let (x, y) = (self.f.ins().bxor(at(a), at(b)), self.f.ins().bxor(at(a), difference));
                self.sign_of_and(x, y, width_of(a))
            }
            Op::Equal(a, b) => self.f.ins().icmp(IntCC::Equal, at(a), at(b)),
            Op::LessSigned(a, b) => {
                let (x, y) = (self.signed(at(a), width_of(a)), self.signed(at(b), width_of(b)));
                self.f.ins().icmp(IntCC::SignedLessThan, x, y)
            }
            Op::Slice { of, low } => {
                let whole = at(of);
                let shifted = if low == 0 { whole } else { self.f.ins().ushr_imm(whole, i64::from(low)) };
                let part = self.converted(shifted, kind);
                let is_top = u32::from(low) + width.get() == width_of(of).get();
                if is_top { part } else { self.masked(part, width) }
            }
            Op::Concat { high, low } => {
                let above = self.converted(at(high), kind);
                let above = self.f.ins().ishl_imm(above, i64::from(width_of(low).get()));
                if netlist.cell(low).op == Op::Const(0) {
                    return above;
                }
                let below = self.converted(at(low), kind);
                self.f.ins().bor(above, below)
            }
            Op::ZeroExtend(a) => self.converted(at(a), kind),
            Op::SignExtend(a) if width == Width::ONE => at(a),
            Op::SignExtend(a) => {
                let value = self.converted(at(a), kind);
                let signed = self.signed(value, width_of(a));
                self.masked(signed, width)
            }
        }
    }

    /// The low bits of a value, or zeros above it.
    pub(super) fn converted(&mut self, value: Value, kind: Type) -> Value {
        let from = self.f.func.dfg.value_type(value);
        if let Some(&word) = self.words.get(&value).filter(|word| self.f.func.dfg.value_type(**word) == kind) {
            return word;
        }
        match from.bits().cmp(&kind.bits()) {
            Ordering::Less => self.f.ins().uextend(kind, value),
            Ordering::Equal => value,
            Ordering::Greater => self.f.ins().ireduce(kind, value),
        }
    }

    fn masked(&mut self, value: Value, width: Width) -> Value {
        let kind = self.f.func.dfg.value_type(value);
        if width.get() == kind.bits() {
            return value;
        }
        let mask = self.f.ins().iconst(kind, immediate(width.mask()));
        self.f.ins().band(value, mask)
    }

    /// 1 for 0, and 0 for 1: of a comparison, the opposite one.
    fn opposite(&mut self, bit: Value) -> Value {
        let dfg = &self.f.func.dfg;
        let made_by = dfg.value_def(bit).inst().map(|inst| dfg.insts[inst]);
        match made_by {
            Some(InstructionData::IntCompare { args: [a, b], cond, .. }) => self.f.ins().icmp(cond.complement(), a, b),
            _ => self.f.ins().bxor_imm(bit, 1),
        }
    }

    /// The sum of words, which an adder and its carry share; in other than narrow code the optimiser sees to that.
    fn sum(&mut self, a: Value, b: Value) -> Value {
        if !self.narrow {
            return self.f.ins().iadd(a, b);
        }
        let f = &mut *self.f;
        *self.sums.entry([a, b]).or_insert_with(|| f.ins().iadd(a, b))
    }

    /// Quotient or remainder of words. Native code takes no divisor of 0.
    fn divide(&mut self, op: Op, a: Value, b: Value) -> Value {
        let kind = self.f.func.dfg.value_type(a);
        let [zero, one] = [0, 1].map(|number| self.f.ins().iconst(kind, number));
        let none = self.f.ins().icmp_imm(IntCC::Equal, b, 0);
        let divisor = self.f.ins().select(none, one, b);
        if matches!(op, Op::Rem(..)) {
            // 0 for a divisor of 1, too.
            return self.f.ins().urem(a, divisor);
        }
        let quotient = self.f.ins().udiv(a, divisor);
        self.f.ins().select(none, zero, quotient)
    }

    /// A shift by an amount of any width. Native code takes an amount modulo that of the word.
    fn shift(&mut self, op: Op, a: Value, by: Value, width: Width) -> Value {
        let by = self.wide(by);
        let kind = self.kind(width);
        let zero = self.f.ins().iconst(kind, 0);
        match op {
            Op::ShiftArithmetic(..) if width == Width::ONE => a,
            Op::ShiftArithmetic(..) => {
                let all = self.f.ins().iconst(types::I64, i64::from(kind.bits()) - 1);
                let by = self.f.ins().umin(by, all);
                let signed = self.signed(a, width);
                let shifted = self.f.ins().sshr(signed, by);
                self.masked(shifted, width)
            }
            _ if width == Width::ONE => {
                let stays = self.f.ins().icmp_imm(IntCC::Equal, by, 0);
                self.f.ins().select(stays, a, zero)
            }
            _ => {
                let left = matches!(op, Op::ShiftLeft(..));
                let shifted = if left { self.f.ins().ishl(a, by) } else { self.f.ins().ushr(a, by) };
                let shifted = if left { self.masked(shifted, width) } else { shifted };
                let inside = self.f.ins().icmp_imm(IntCC::UnsignedLessThan, by, i64::from(width.get()));
                self.f.ins().select(inside, shifted, zero)
            }
        }
    }

    fn carry(&mut self, a: Value, b: Value, width: Width) -> Value {
        let kind = self.f.func.dfg.value_type(a);
        if width == Width::ONE {
            return self.f.ins().band(a, b);
        }
        let sum = self.sum(a, b);
        if width.get() == kind.bits() {
            return self.f.ins().icmp(IntCC::UnsignedLessThan, sum, a);
        }
        let carry = self.f.ins().ushr_imm(sum, i64::from(width.get()));
        let bit = self.f.ins().ireduce(types::I8, carry);
        self.words.insert(bit, carry);
        bit
    }

    /// The sign bit of `x & y`, which are zero above their width, as a byte.
    fn sign_of_and(&mut self, x: Value, y: Value, width: Width) -> Value {
        let both = self.f.ins().band(x, y);
        if width == Width::ONE {
            return both;
        }
        let shifted = self.f.ins().ushr_imm(both, i64::from(width.get()) - 1);
        self.f.ins().ireduce(types::I8, shifted)
    }

    /// The number in two's complement of all bits of a word; of a bit, of 64.
    fn signed(&mut self, value: Value, width: Width) -> Value {
        let value = if width == Width::ONE && !self.is_word(value) { self.wide(value) } else { value };
        let unused = i64::from(self.f.func.dfg.value_type(value).bits()) - i64::from(width.get());
        if unused == 0 {
            return value;
        }
        let top = self.f.ins().ishl_imm(value, unused);
        self.f.ins().sshr_imm(top, unused)
    }

    fn is_word(&self, value: Value) -> bool {
        self.f.func.dfg.value_type(value) != types::I8
    }
}
