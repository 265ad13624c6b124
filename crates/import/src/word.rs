//! Words of any width, as cells of at most 64 bits: the least significant part first, all but the last 64 bits wide.

use std::collections::HashMap;

use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Cell, Net, Netlist, Op, Source};

/// Bits of a part.
const PART: u32 = 64;

/// A word of the source: its parts and its width.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Word {
    pub(crate) parts: Vec<Net>,
    pub(crate) width: u32,
}

/// A bit of a word: a constant, or a bit of a net.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Bit {
    Constant(bool),
    Of(Net, u32),
}

impl Word {
    /// Its bits, least significant first.
    pub(crate) fn bits(&self) -> impl Iterator<Item = Bit> + '_ {
        (0..self.width).map(|bit| Bit::Of(self.parts[(bit / PART) as usize], bit % PART))
    }

    fn is_single(&self) -> bool {
        self.parts.len() == 1
    }
}

/// Writes cells; a cell that is there already is not written again.
#[derive(Debug)]
pub(crate) struct Builder {
    pub(crate) netlist: Netlist,
    same: HashMap<Cell, Net>,
    /// The line of the source that cells are written for.
    pub(crate) source: Option<Source>,
}

fn width(bits: u32) -> Width {
    Width::new(u64::from(bits)).unwrap_or(Width::MAX)
}

/// Width of each part of a word.
fn widths(bits: u32) -> impl Iterator<Item = u32> {
    (0..bits.div_ceil(PART)).map(move |part| (bits - part * PART).min(PART))
}

impl Builder {
    pub(crate) fn new(netlist: Netlist) -> Builder {
        Builder { netlist, same: HashMap::new(), source: None }
    }

    /// A cell of its own.
    pub(crate) fn push(&mut self, op: Op, bits: u32) -> Net {
        let net = Net(u32::try_from(self.netlist.cells.len()).unwrap_or(u32::MAX));
        self.netlist.cells.push(Cell { op, width: width(bits) });
        self.netlist.sources.push(self.source.clone());
        net
    }

    /// A combinational cell.
    fn cell(&mut self, op: Op, bits: u32) -> Net {
        let cell = Cell { op, width: width(bits) };
        if let Some(&net) = self.same.get(&cell) {
            return net;
        }
        let net = self.push(op, bits);
        self.same.insert(cell, net);
        net
    }

    /// A word of cells of its own, part by part.
    pub(crate) fn each(&mut self, bits: u32, mut op: impl FnMut(usize) -> Op) -> Word {
        let parts = widths(bits).enumerate().map(|(part, bits)| self.push(op(part), bits)).collect();
        Word { parts, width: bits }
    }

    pub(crate) fn number(&mut self, value: u64, bits: u32) -> Word {
        let parts = widths(bits).enumerate().map(|(part, bits)| {
            let value = if part == 0 { value & width(bits).mask() } else { 0 };
            self.cell(Op::Const(value), bits)
        });
        Word { parts: parts.collect(), width: bits }
    }

    /// A word of these bits, least significant first; runs of one net are taken as they are.
    pub(crate) fn assemble(&mut self, bits: &[Bit]) -> Word {
        let parts = bits.chunks(PART as usize).map(|chunk| self.part(chunk)).collect();
        Word { parts, width: u32::try_from(bits.len()).unwrap_or(u32::MAX) }
    }

    fn part(&mut self, bits: &[Bit]) -> Net {
        let mut whole: Option<(Net, u32)> = None;
        let mut at = 0;
        while at < bits.len() {
            let end = (at + 1..bits.len()).find(|&end| !follows(bits[end - 1], bits[end])).unwrap_or(bits.len());
            let run = self.run(&bits[at..end]);
            whole = Some(match whole {
                None => run,
                Some((low, bits)) => (self.cell(Op::Concat { high: run.0, low }, bits + run.1), bits + run.1),
            });
            at = end;
        }
        whole.map_or(Net(0), |(net, _)| net)
    }

    /// Bits of one net, or constants.
    fn run(&mut self, bits: &[Bit]) -> (Net, u32) {
        let count = u32::try_from(bits.len()).unwrap_or(PART);
        let net = match bits[0] {
            Bit::Constant(_) => {
                let value = bits.iter().rev().fold(0, |value, bit| value << 1 | u64::from(*bit == Bit::Constant(true)));
                self.cell(Op::Const(value), count)
            }
            Bit::Of(net, low) if low == 0 && self.netlist.width(net).get() == count => net,
            Bit::Of(of, low) => self.cell(Op::Slice { of, low: u8::try_from(low).unwrap_or(0) }, count),
        };
        (net, count)
    }

    /// The word cut or extended to a width.
    pub(crate) fn fit(&mut self, word: &Word, bits: u32, signed: bool) -> Word {
        if word.width == bits {
            return word.clone();
        }
        if word.is_single() && bits <= PART && bits > word.width {
            let op = if signed { Op::SignExtend(word.parts[0]) } else { Op::ZeroExtend(word.parts[0]) };
            return Word { parts: vec![self.cell(op, bits)], width: bits };
        }
        let fill = match word.bits().last() {
            Some(sign) if signed => sign,
            _ => Bit::Constant(false),
        };
        let all: Vec<Bit> = word.bits().chain(std::iter::repeat(fill)).take(bits as usize).collect();
        self.assemble(&all)
    }

    /// The sign bit, or any bit.
    pub(crate) fn bit(&mut self, word: &Word, bit: u32) -> Net {
        self.part(&[Bit::Of(word.parts[(bit / PART) as usize], bit % PART)])
    }

    pub(crate) fn not(&mut self, a: &Word) -> Word {
        self.map(a, |_, a| Op::Not(a))
    }

    fn map(&mut self, a: &Word, op: impl Fn(usize, Net) -> Op) -> Word {
        let parts =
            widths(a.width).zip(&a.parts).enumerate().map(|(part, (bits, &net))| self.cell(op(part, net), bits));
        Word { parts: parts.collect(), width: a.width }
    }

    /// A bitwise operator of two words of one width.
    pub(crate) fn bitwise(&mut self, a: &Word, b: &Word, op: fn(Net, Net) -> Op) -> Word {
        self.map(a, |part, a| op(a, b.parts[part]))
    }

    pub(crate) fn and(&mut self, a: Net, b: Net) -> Net {
        self.cell(Op::And(a, b), 1)
    }

    pub(crate) fn or(&mut self, a: Net, b: Net) -> Net {
        self.cell(Op::Or(a, b), 1)
    }

    pub(crate) fn invert(&mut self, a: Net) -> Net {
        self.cell(Op::Not(a), 1)
    }

    pub(crate) fn mux(&mut self, select: Net, high: &Word, low: &Word) -> Word {
        if high == low {
            return low.clone();
        }
        self.map(high, |part, high| Op::Mux { select, high, low: low.parts[part] })
    }

    /// The sum of two words of one width and a carry, modulo 2^width, and the carry out.
    pub(crate) fn add(&mut self, a: &Word, b: &Word, carry: Option<Net>) -> (Word, Net) {
        let mut carry = carry;
        let mut parts = Vec::with_capacity(a.parts.len());
        let mut out = Net(0);
        for ((bits, &x), &y) in widths(a.width).zip(&a.parts).zip(&b.parts) {
            let mut sum = self.cell(Op::Add(x, y), bits);
            out = self.cell(Op::Carry(x, y), 1);
            if let Some(carry) = carry {
                let carry = if bits == 1 { carry } else { self.cell(Op::ZeroExtend(carry), bits) };
                let over = self.cell(Op::Carry(sum, carry), 1);
                sum = self.cell(Op::Add(sum, carry), bits);
                out = self.or(out, over);
            }
            carry = Some(out);
            parts.push(sum);
        }
        (Word { parts, width: a.width }, out)
    }

    /// The difference of two words of one width.
    pub(crate) fn sub(&mut self, a: &Word, b: &Word) -> Word {
        if a.is_single() {
            return self.bitwise(a, b, Op::Sub);
        }
        let (b, one) = (self.not(b), self.cell(Op::Const(1), 1));
        self.add(a, &b, Some(one)).0
    }

    pub(crate) fn negate(&mut self, a: &Word) -> Word {
        let zero = self.number(0, a.width);
        self.sub(&zero, a)
    }

    pub(crate) fn equal(&mut self, a: &Word, b: &Word) -> Net {
        let parts: Vec<Net> = a.parts.iter().zip(&b.parts).map(|(&a, &b)| self.cell(Op::Equal(a, b), 1)).collect();
        parts.into_iter().reduce(|a, b| self.and(a, b)).unwrap_or(Net(0))
    }

    /// a < b of two words of one width.
    pub(crate) fn less(&mut self, a: &Word, b: &Word, signed: bool) -> Net {
        let last = a.parts.len() - 1;
        let mut less: Option<Net> = None;
        for (part, (&a, &b)) in a.parts.iter().zip(&b.parts).enumerate() {
            let op = if signed && part == last { Op::LessSigned(a, b) } else { Op::Borrow(a, b) };
            let own = self.cell(op, 1);
            less = Some(match less {
                None => own,
                Some(below) => {
                    let equal = self.cell(Op::Equal(a, b), 1);
                    let through = self.and(equal, below);
                    self.or(own, through)
                }
            });
        }
        less.unwrap_or(Net(0))
    }

    /// Any bit is 1.
    pub(crate) fn any(&mut self, a: &Word) -> Net {
        let zero = self.number(0, a.width);
        let none = self.equal(a, &zero);
        self.invert(none)
    }

    /// Every bit is 1.
    pub(crate) fn every(&mut self, a: &Word) -> Net {
        let flipped = self.not(a);
        let any = self.any(&flipped);
        self.invert(any)
    }

    /// An odd number of bits is 1.
    pub(crate) fn parity(&mut self, a: &Word) -> Net {
        let mut bits: Vec<Bit> = a.bits().collect();
        while bits.len() > 1 {
            let half = bits.len().div_ceil(2);
            let (low, high) = (self.assemble(&bits[..half]), self.assemble(&bits[half..]));
            let high = self.fit(&high, low.width, false);
            bits = self.bitwise(&low, &high, Op::Xor).bits().collect();
        }
        self.part(&bits)
    }

    /// The product of two words of one width, modulo 2^width.
    pub(crate) fn mul(&mut self, a: &Word, b: &Word) -> Word {
        if a.is_single() {
            return self.bitwise(a, b, Op::Mul);
        }
        // Digits of 32 bits: their product fits in a part.
        let digits = |word: &Word| word.bits().collect::<Vec<_>>().chunks(32).map(<[Bit]>::to_vec).collect::<Vec<_>>();
        let (x, y) = (digits(a), digits(b));
        let mut sum = self.number(0, a.width);
        for (i, x) in x.iter().enumerate() {
            for (j, y) in y.iter().enumerate().take_while(|(j, _)| 32 * (i + j) < a.width as usize) {
                let [x, y] = [x, y].map(|digit| {
                    let digit = self.assemble(digit);
                    self.fit(&digit, PART, false)
                });
                let product = self.bitwise(&x, &y, Op::Mul);
                let zeros = std::iter::repeat_n(Bit::Constant(false), 32 * (i + j));
                let bits: Vec<Bit> = zeros.chain(product.bits()).collect();
                let shifted = self.assemble(&bits);
                let shifted = self.fit(&shifted, a.width, false);
                sum = self.add(&sum, &shifted, None).0;
            }
        }
        sum
    }

    /// Quotient and remainder of unsigned words of one width; 0 and 0 where the divisor is 0.
    fn divided(&mut self, a: &Word, b: &Word) -> (Word, Word) {
        if a.is_single() {
            return (self.bitwise(a, b, Op::Div), self.bitwise(a, b, Op::Rem));
        }
        let bits: Vec<Bit> = a.bits().collect();
        let divisor = self.fit(b, b.width + 1, false);
        let mut rest = self.number(0, a.width + 1);
        let mut quotient = Vec::with_capacity(bits.len());
        for &bit in bits.iter().rev() {
            let shifted: Vec<Bit> = std::iter::once(bit).chain(rest.bits()).take(a.width as usize + 1).collect();
            let shifted = self.assemble(&shifted);
            let small = self.less(&shifted, &divisor, false);
            let less = self.sub(&shifted, &divisor);
            rest = self.mux(small, &shifted, &less);
            quotient.insert(0, Bit::Of(self.invert(small), 0));
        }
        let (quotient, rest) = (self.assemble(&quotient), self.fit(&rest, a.width, false));
        let (some, none) = (self.any(b), self.number(0, a.width));
        (self.mux(some, &quotient, &none), self.mux(some, &rest, &none))
    }

    /// Quotient and remainder, towards 0 or towards minus infinity.
    pub(crate) fn divide(&mut self, a: &Word, b: &Word, signed: bool, floor: bool) -> (Word, Word) {
        if !signed {
            return self.divided(a, b);
        }
        let (a_negative, b_negative) = (self.bit(a, a.width - 1), self.bit(b, b.width - 1));
        let [x, y] = [(a, a_negative), (b, b_negative)].map(|(word, negative)| {
            let flipped = self.negate(word);
            self.mux(negative, &flipped, word)
        });
        let (quotient, rest) = self.divided(&x, &y);
        let differ = self.cell(Op::Xor(a_negative, b_negative), 1);
        let (less, back) = (self.negate(&quotient), self.negate(&rest));
        let (quotient, rest) = (self.mux(differ, &less, &quotient), self.mux(a_negative, &back, &rest));
        if !floor {
            return (quotient, rest);
        }
        // Towards minus infinity: one less, and the divisor more, where the signs differ and something is left.
        let left = self.any(&rest);
        let lower = self.and(differ, left);
        let one = self.number(1, a.width);
        let (below, above) = (self.sub(&quotient, &one), self.add(&rest, b, None).0);
        (self.mux(lower, &below, &quotient), self.mux(lower, &above, &rest))
    }

    /// The word shifted by an unsigned amount: what enters is 0, or the sign.
    pub(crate) fn shift(&mut self, a: &Word, amount: &Word, left: bool, signed: bool) -> Word {
        if a.is_single() && amount.is_single() {
            let amount = amount.parts[0];
            return self.map(a, |_, a| match (left, signed) {
                (true, _) => Op::ShiftLeft(a, amount),
                (false, false) => Op::ShiftRight(a, amount),
                (false, true) => Op::ShiftArithmetic(a, amount),
            });
        }
        let fill = if signed && !left { Bit::Of(self.bit(a, a.width - 1), 0) } else { Bit::Constant(false) };
        let filled: Vec<Bit> = std::iter::repeat_n(fill, a.width as usize).collect();
        let (filled, mut result) = (self.assemble(&filled), a.clone());
        for stage in 0..amount.width {
            let select = self.bit(amount, stage);
            let by = 1u32.checked_shl(stage).filter(|_| stage < 31).unwrap_or(u32::MAX).min(a.width) as usize;
            let moved: Vec<Bit> = if left {
                filled.bits().take(by).chain(result.bits()).take(a.width as usize).collect()
            } else {
                result.bits().skip(by).chain(filled.bits()).take(a.width as usize).collect()
            };
            let moved = self.assemble(&moved);
            result = self.mux(select, &moved, &result);
        }
        result
    }
}

/// The second bit comes right after the first in one net, or both are constants.
fn follows(first: Bit, second: Bit) -> bool {
    match (first, second) {
        (Bit::Constant(_), Bit::Constant(_)) => true,
        (Bit::Of(a, low), Bit::Of(b, high)) => a == b && low + 1 == high,
        _ => false,
    }
}
