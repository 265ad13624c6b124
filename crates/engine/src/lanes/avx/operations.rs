//! The operations of lanes as vector instructions: each gives, word by word, what `lane_machine::perform` does.

use super::assembler::{
    ADD_32, ADD_64, AND, EQUAL_32, EQUAL_64, GREATER_32, GREATER_64, GREATEST_32, LEFT_32, LEFT_64,
};
use super::assembler::{LEFT_EACH_32, LEFT_EACH_64, MUL_32, Opcode, RIGHT_32, RIGHT_64, RIGHT_EACH_32, RIGHT_EACH_64};
use super::assembler::{RIGHT_SIGNED_32, RIGHT_SIGNED_EACH_32, SUB_32, SUB_64, Shift, XOR};
use super::flow::{Bits, Flow, Maker, Value, bits};
use super::reals;
use crate::lanes::code::{Code, LaneOp, Slot};

/// Lowers operations in their order; words are of 32 or of 64 bits.
pub(super) struct Operations {
    pub(super) flow: Flow,
    pub(super) bits: u32,
    /// What each row holds.
    slots: Vec<Option<Bits>>,
    /// Rows whose words are all ones or all zeros.
    single: Vec<bool>,
}

impl Operations {
    /// The rows that have their meaning from sample to sample, in the cells of the same index.
    pub(super) fn new(code: &Code, bits: u32) -> Operations {
        let flow = Flow::new(code.rows);
        let (slots, single) = (vec![None; code.rows], vec![false; code.rows]);
        let mut operations = Operations { flow, bits, slots, single };
        for &(row, pattern) in &code.constants {
            let value = operations.pattern(pattern);
            operations.set(row, value);
            operations.single[row] = pattern == 0 || pattern == u64::MAX;
        }
        for register in &code.registers {
            operations.single[register.row] = register.width.get() == 1;
        }
        let registers = code.registers.iter().map(|register| register.row);
        let kept = registers.chain(code.accumulators.iter().copied()).chain(code.inputs.iter().map(|&(_, row)| row));
        for row in kept {
            let value = operations.flow.make(Maker::Cell(row));
            operations.set(row, value);
        }
        operations
    }

    fn set(&mut self, row: Slot, value: Value) {
        self.slots[row] = Some(bits(value));
    }

    /// All operations; `None` where there are no instructions for one.
    pub(super) fn all(&mut self, code: &Code) -> Option<()> {
        for operation in &code.operations {
            let value = self.perform(operation.what)?;
            self.single[operation.target] = operation.what.gives_single(|row| self.single[row]);
            self.slots[operation.target] = Some(value);
        }
        Some(())
    }

    /// What a row holds.
    pub(super) fn at(&mut self, row: Slot) -> Bits {
        match self.slots[row] {
            Some(value) => value,
            // Operands come before their users.
            None => bits(self.pattern(0)),
        }
    }

    /// What a row holds, as it is.
    pub(super) fn plain(&mut self, row: Slot) -> Value {
        let value = self.at(row);
        self.flow.plain(value)
    }

    /// The top bits of a pattern in all lanes.
    fn pattern(&mut self, pattern: u64) -> Value {
        self.number(pattern >> (64 - self.bits))
    }

    /// A word in all lanes.
    pub(super) fn number(&mut self, word: u64) -> Value {
        self.flow.constant(if self.bits == 32 { word << 32 | word } else { word })
    }

    pub(super) fn choose(&self, narrow: Opcode, wide: Opcode) -> Opcode {
        if self.bits == 32 { narrow } else { wide }
    }

    pub(super) fn add(&mut self, a: Value, b: Value) -> Value {
        let opcode = self.choose(ADD_32, ADD_64);
        self.flow.two(opcode, a, b)
    }

    pub(super) fn sub(&mut self, a: Value, b: Value) -> Value {
        let opcode = self.choose(SUB_32, SUB_64);
        self.flow.two(opcode, a, b)
    }

    fn equal(&mut self, a: Value, b: Value) -> Bits {
        let opcode = self.choose(EQUAL_32, EQUAL_64);
        bits(self.flow.two(opcode, a, b))
    }

    fn masked(&mut self, value: Bits, pattern: u64) -> Bits {
        if pattern >> (64 - self.bits) == u64::MAX >> (64 - self.bits) {
            return value;
        }
        let mask = self.pattern(pattern);
        self.flow.and(value, bits(mask))
    }

    fn masked_plain(&mut self, value: Bits, pattern: u64) -> Value {
        let masked = self.masked(value, pattern);
        self.flow.plain(masked)
    }

    pub(super) fn less_signed(&mut self, a: Value, b: Value) -> Bits {
        let opcode = self.choose(GREATER_32, GREATER_64);
        bits(self.flow.two(opcode, b, a))
    }

    /// a < b, unsigned.
    pub(super) fn less(&mut self, a: Value, b: Value) -> Bits {
        if self.bits == 32 {
            let greatest = self.flow.two(GREATEST_32, a, b);
            return self.equal(greatest, a).not();
        }
        let top = self.pattern(1 << 63);
        let (a, b) = (self.flow.two(XOR, a, top), self.flow.two(XOR, b, top));
        self.less_signed(a, b)
    }

    pub(super) fn select(&mut self, condition: Bits, high: Bits, low: Bits) -> Bits {
        let (high, low) = if condition.inverted { (low, high) } else { (high, low) };
        let (high, low, inverted) = if high.inverted && low.inverted {
            (high.value, low.value, true)
        } else {
            (self.flow.plain(high), self.flow.plain(low), false)
        };
        Bits { value: self.flow.make(Maker::Blend(condition.value, high, low)), inverted }
    }

    fn left(&mut self, value: Value, by: u32) -> Value {
        let shift = if self.bits == 32 { LEFT_32 } else { LEFT_64 };
        self.shift(shift, value, by)
    }

    pub(super) fn right(&mut self, value: Value, by: u32) -> Value {
        let shift = if self.bits == 32 { RIGHT_32 } else { RIGHT_64 };
        self.shift(shift, value, by)
    }

    fn right_signed(&mut self, value: Value, by: u32) -> Value {
        if self.bits == 32 {
            return self.shift(RIGHT_SIGNED_32, value, by);
        }
        if by == 63 {
            let zero = self.pattern(0);
            return self.less_signed(value, zero).value;
        }
        // The sign is where a logical shift puts it; to repeat it above, it is taken away twice.
        let (moved, sign) = (self.shift(RIGHT_64, value, by), self.number(1 << (63 - by)));
        let flipped = self.flow.two(XOR, moved, sign);
        self.sub(flipped, sign)
    }

    fn shift(&mut self, shift: Shift, value: Value, by: u32) -> Value {
        match u8::try_from(by) {
            Ok(by) if by > 0 => self.flow.make(Maker::Shift(shift, value, by)),
            _ => value,
        }
    }

    /// Ones where a row is not zero.
    pub(super) fn is_set(&mut self, row: Slot) -> Bits {
        if self.single[row] {
            return self.at(row);
        }
        let (value, zero) = (self.plain(row), self.pattern(0));
        self.equal(value, zero).not()
    }

    fn equals(&mut self, row: Slot, pattern: u64) -> Bits {
        let (value, pattern) = (self.plain(row), self.pattern(pattern));
        self.equal(value, pattern)
    }

    /// Ones where the top `by` + 1 bits of a row are equal.
    fn fits(&mut self, row: Slot, by: u32) -> Bits {
        let value = self.plain(row);
        let cut = self.left(value, by);
        let cut = self.right_signed(cut, by);
        self.equal(cut, value)
    }

    /// The result of an operation.
    fn perform(&mut self, what: LaneOp<Slot>) -> Option<Bits> {
        Some(match what {
            LaneOp::Copy(a) => self.at(a),
            LaneOp::Invert(a, u64::MAX) => self.at(a).not(),
            LaneOp::Invert(a, p) => {
                let (a, p) = (self.at(a), bits(self.pattern(p)));
                self.flow.xor(a, p)
            }
            LaneOp::Mask(a, p) => {
                let a = self.at(a);
                self.masked(a, p)
            }
            LaneOp::And(a, b) => {
                let (a, b) = (self.at(a), self.at(b));
                self.flow.and(a, b)
            }
            LaneOp::AndNot(a, b) => {
                let (a, b) = (self.at(a), self.at(b).not());
                self.flow.and(a, b)
            }
            LaneOp::Or(a, b) => {
                let (a, b) = (self.at(a), self.at(b));
                self.flow.or(a, b)
            }
            LaneOp::Xor(a, b) => {
                let (a, b) = (self.at(a), self.at(b));
                self.flow.xor(a, b)
            }
            LaneOp::Select(select, high, low) => {
                let [select, high, low] = [select, high, low].map(|row| self.at(row));
                self.select(select, high, low)
            }
            LaneOp::Left(a, by, p) => {
                let a = self.plain(a);
                let moved = self.left(a, by);
                self.masked(bits(moved), p)
            }
            LaneOp::Right(a, by) => {
                let a = self.plain(a);
                bits(self.right(a, by))
            }
            LaneOp::RightSigned(a, by) => {
                let a = self.plain(a);
                bits(self.right_signed(a, by))
            }
            LaneOp::Bit(a, by) => {
                let a = self.plain(a);
                let moved = self.left(a, by);
                bits(self.right_signed(moved, self.bits - 1))
            }
            LaneOp::Concat(high, low, by, p, q) => {
                let (high, low) = (self.at(high), self.plain(low));
                let low = self.right(low, by);
                let (high, low) = (self.masked(high, p), self.masked(bits(low), q));
                self.flow.or(high, low)
            }
            _ => return self.sum(what),
        })
    }

    /// Sums, differences, and what flags them.
    fn sum(&mut self, what: LaneOp<Slot>) -> Option<Bits> {
        let value = match what {
            LaneOp::Add(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.add(a, b)
            }
            LaneOp::Sub(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.sub(a, b)
            }
            LaneOp::AddWhere(a, condition, p) => {
                let (a, condition) = (self.plain(a), self.at(condition));
                let b = self.masked_plain(condition, p);
                self.add(a, b)
            }
            LaneOp::AddEither(a, b, p, c, q) => {
                let [b, c] = [b, c].map(|row| self.at(row));
                let (b, c) = (self.masked_plain(b, p), self.masked_plain(c, q));
                let a = self.plain(a);
                let a = self.add(a, b);
                self.add(a, c)
            }
            LaneOp::AddIf(a, b, condition) => {
                let b = self.both(b, condition);
                let a = self.plain(a);
                self.add(a, b)
            }
            LaneOp::SubIf(a, b, condition) => {
                let b = self.both(b, condition);
                let a = self.plain(a);
                self.sub(a, b)
            }
            LaneOp::AddOverflow(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                let sum = self.add(a, b);
                let (a, b) = (self.flow.two(XOR, a, sum), self.flow.two(XOR, b, sum));
                let sign = self.flow.two(AND, a, b);
                self.right_signed(sign, self.bits - 1)
            }
            LaneOp::SubOverflow(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                let difference = self.sub(a, b);
                let (b, difference) = (self.flow.two(XOR, a, b), self.flow.two(XOR, a, difference));
                let sign = self.flow.two(AND, b, difference);
                self.right_signed(sign, self.bits - 1)
            }
            _ => return self.comparison(what),
        };
        Some(bits(value))
    }

    /// Both of two rows.
    fn both(&mut self, a: Slot, b: Slot) -> Value {
        let both = self.perform_and(a, b);
        self.flow.plain(both)
    }

    fn perform_and(&mut self, a: Slot, b: Slot) -> Bits {
        let (a, b) = (self.at(a), self.at(b));
        self.flow.and(a, b)
    }

    fn comparison(&mut self, what: LaneOp<Slot>) -> Option<Bits> {
        Some(match what {
            LaneOp::Carry(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                let sum = self.add(a, b);
                self.less(sum, a)
            }
            LaneOp::Less(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.less(a, b)
            }
            LaneOp::LessSigned(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.less_signed(a, b)
            }
            LaneOp::LessIf(a, b, condition) => {
                let (a, b) = (self.plain(a), self.both(b, condition));
                self.less(a, b)
            }
            LaneOp::Equal(a, b) => {
                let (a, b) = (self.plain(a), self.plain(b));
                self.equal(a, b)
            }
            LaneOp::EqualTo(a, p) => self.equals(a, p),
            LaneOp::EqualIf(a, p, condition) => {
                let (equal, condition) = (self.equals(a, p), self.at(condition));
                self.flow.and(equal, condition)
            }
            LaneOp::EqualIfOr(a, p, condition, or) => {
                let (equal, condition, or) = (self.equals(a, p), self.at(condition), self.at(or));
                let equal = self.flow.and(equal, condition);
                self.flow.or(equal, or)
            }
            LaneOp::EqualEitherOr(a, [(p, first), (q, second)], or) => {
                let (one, first) = (self.equals(a, p), self.at(first));
                let one = self.flow.and(one, first);
                let (other, second) = (self.equals(a, q), self.at(second));
                let other = self.flow.and(other, second);
                let either = self.flow.or(one, other);
                let or = self.at(or);
                self.flow.or(either, or)
            }
            LaneOp::Fits(a, by) => self.fits(a, by),
            LaneOp::UnfitIfOr(a, by, condition, or) => {
                let (fits, condition, or) = (self.fits(a, by), self.at(condition), self.at(or));
                let unfit = self.flow.and(condition, fits.not());
                self.flow.or(unfit, or)
            }
            _ => return self.accumulator(what).map(bits),
        })
    }

    /// Products, and shifts by a number of each lane.
    pub(super) fn each(&mut self, what: LaneOp<Slot>) -> Option<Value> {
        Some(match what {
            LaneOp::Mul(a, b, width) if self.bits == 32 => {
                let (a, b) = (self.plain(a), self.plain(b));
                let b = self.right(b, self.bits - width);
                self.flow.two(MUL_32, a, b)
            }
            LaneOp::Div(a, b, width) if self.bits == 32 => {
                let (quotient, _) = self.divided(a, b);
                self.left(quotient, self.bits - width)
            }
            LaneOp::Rem(a, b) if self.bits == 32 => self.divided(a, b).1,
            // A shift by as many bits as a word has, or more, gives zeros, and signs where signs are repeated.
            LaneOp::ShiftLeft(a, by, width) => {
                let (a, by) = (self.plain(a), self.amount(by, width));
                let opcode = self.choose(LEFT_EACH_32, LEFT_EACH_64);
                self.flow.two(opcode, a, by)
            }
            LaneOp::ShiftRight(a, by, width, p) => {
                let (a, by) = (self.plain(a), self.amount(by, width));
                let opcode = self.choose(RIGHT_EACH_32, RIGHT_EACH_64);
                let moved = self.flow.two(opcode, a, by);
                self.masked_plain(bits(moved), p)
            }
            LaneOp::ShiftArithmetic(a, by, width, p) if self.bits == 32 => {
                let (a, by) = (self.plain(a), self.amount(by, width));
                let moved = self.flow.two(RIGHT_SIGNED_EACH_32, a, by);
                self.masked_plain(bits(moved), p)
            }
            LaneOp::RootGaps(sum, [(base, p), (offset, q)]) if self.bits == 32 || p.max(q) <= reals::MOST_BITS => {
                let (base, offset) = (self.plain(base), self.plain(offset));
                let (base, offset) = (self.right(base, self.bits - p), self.right_signed(offset, self.bits - q));
                let gaps = if self.bits == 32 {
                    reals::root_gaps_narrow(&mut self.flow, base, offset)
                } else {
                    reals::root_gaps(&mut self.flow, base, offset)
                };
                let sum = self.plain(sum);
                self.add(sum, gaps)
            }
            _ => return None,
        })
    }

    /// Quotient and remainder of words of 32 bits; 0 where the divisor is 0.
    fn divided(&mut self, a: Slot, b: Slot) -> (Value, Value) {
        let (a, b, zero) = (self.plain(a), self.plain(b), self.pattern(0));
        let divides = self.equal(b, zero).not();
        let quotient = reals::quotients_narrow(&mut self.flow, a, b);
        let quotient = self.flow.and(divides, bits(quotient)).value;
        let whole = self.flow.two(MUL_32, quotient, b);
        let rest = self.sub(a, whole);
        (quotient, self.flow.and(divides, bits(rest)).value)
    }

    /// The number of a row of this many bits.
    fn amount(&mut self, by: Slot, width: u32) -> Value {
        let by = self.plain(by);
        self.right(by, self.bits - width)
    }
}
