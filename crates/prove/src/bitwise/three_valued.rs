//! Three-valued simulation: every bit of a netlist is 0, 1 or X, which is either, gate by gate, in 64 lanes at once.
//!
//! Sums are chains of full adders, so it shares no arithmetic with what it is to check. A bit may be X that need not
//! be, never the reverse: what is known here is certain.

use stepwave_netlist::Design;
use stepwave_netlist::cells::{Net, Op};

/// The lanes in which a bit may be 0, and those in which it may be 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Bit {
    pub(super) zero: u64,
    pub(super) one: u64,
}

impl Bit {
    pub(super) const X: Bit = Bit { zero: !0, one: !0 };

    /// 1 in these lanes, 0 in the others.
    pub(super) fn known(ones: u64) -> Bit {
        Bit { zero: !ones, one: ones }
    }

    pub(super) fn all(is: bool) -> Bit {
        Bit::known(if is { !0 } else { 0 })
    }

    /// Lanes in which it is 1.
    pub(super) fn is_one(self) -> u64 {
        self.one & !self.zero
    }

    /// Lanes in which it is 0.
    pub(super) fn is_zero(self) -> u64 {
        self.zero & !self.one
    }

    /// In every lane what it may be in this one.
    pub(super) fn everywhere(self, lane: u64) -> Bit {
        let spread = |lanes: u64| if lanes & lane == 0 { 0 } else { !0 };
        Bit { zero: spread(self.zero), one: spread(self.one) }
    }

    /// Any value of either.
    pub(super) fn or_as(self, other: Bit) -> Bit {
        Bit { zero: self.zero | other.zero, one: self.one | other.one }
    }

    fn not(self) -> Bit {
        Bit { zero: self.one, one: self.zero }
    }

    fn and(self, other: Bit) -> Bit {
        Bit { zero: self.zero | other.zero, one: self.one & other.one }
    }

    fn or(self, other: Bit) -> Bit {
        self.not().and(other.not()).not()
    }

    fn xor(self, other: Bit) -> Bit {
        Bit { zero: self.zero & other.zero | self.one & other.one, one: self.zero & other.one | self.one & other.zero }
    }

    fn choose(self, high: Bit, low: Bit) -> Bit {
        Bit { zero: self.one & high.zero | self.zero & low.zero, one: self.one & high.one | self.zero & low.one }
    }
}

/// Sum and carry of three bits.
fn full_adder(a: Bit, b: Bit, carry: Bit) -> (Bit, Bit) {
    (a.xor(b).xor(carry), a.and(b).or(carry.and(a.or(b))))
}

/// Puts the sum of a, b and a carry in `sum`; gives the carries into the highest bit and out of it.
fn ripple(a: &[Bit], b: impl Iterator<Item = Bit>, carry: Bit, mut sum: impl FnMut(usize, Bit)) -> (Bit, Bit) {
    let (mut into_highest, mut carry) = (carry, carry);
    for (place, (a, b)) in a.iter().zip(b).enumerate() {
        into_highest = carry;
        let (bit, out) = full_adder(*a, b, carry);
        sum(place, bit);
        carry = out;
    }
    (into_highest, carry)
}

/// The product: a, shifted under each bit of b, where that bit is 1.
fn product(a: &[Bit], b: &[Bit]) -> Vec<Bit> {
    let mut sum = vec![Bit::all(false); a.len()];
    for (place, bit) in b.iter().enumerate() {
        let shifted =
            (0..a.len()).map(|index| if index >= place { a[index - place].and(*bit) } else { Bit::all(false) });
        let old = sum.clone();
        ripple(&old, shifted, Bit::all(false), |place, bit| sum[place] = bit);
    }
    sum
}

/// Quotient and remainder by restoring division, both 0 where b is 0.
fn quotient(a: &[Bit], b: &[Bit]) -> [Vec<Bit>; 2] {
    let mut quotient = vec![Bit::all(false); a.len()];
    let mut rest = vec![Bit::all(false); b.len() + 1];
    for place in (0..a.len()).rev() {
        rest.rotate_right(1);
        rest[0] = a[place];
        let wide = b.iter().copied().chain([Bit::all(false)]).map(Bit::not);
        let mut difference = rest.clone();
        let (_, fits) = ripple(&rest, wide, Bit::all(true), |place, bit| difference[place] = bit);
        quotient[place] = fits;
        rest.iter_mut().zip(&difference).for_each(|(rest, less)| *rest = fits.choose(*less, *rest));
    }
    rest.pop();
    let divisible = b.iter().fold(Bit::all(false), |any, bit| any.or(*bit));
    [quotient, rest].map(|bits| bits.into_iter().map(|bit| bit.and(divisible)).collect())
}

/// One stage of multiplexers for each bit of the amount. `fill` enters.
fn shifted(a: &[Bit], by: &[Bit], left: bool, fill: Bit) -> Vec<Bit> {
    let mut shifted = a.to_vec();
    for (stage, select) in by.iter().enumerate() {
        let distance = if stage < 7 { 1 << stage } else { a.len() };
        let from = |place: usize| if left { place.checked_sub(distance) } else { Some(place + distance) };
        let bit = |place: usize| from(place).and_then(|from| shifted.get(from)).copied().unwrap_or(fill);
        shifted = (0..a.len()).map(|place| select.choose(bit(place), shifted[place])).collect();
    }
    shifted
}

/// A netlist in one sample.
#[derive(Clone, Debug)]
pub(super) struct ThreeValued<'d> {
    design: &'d Design,
    /// First bit of each net, and one more.
    places: Vec<usize>,
    bits: Vec<Bit>,
    /// Registers at the next edge.
    taken: Vec<Bit>,
}

impl<'d> ThreeValued<'d> {
    /// Every bit may be anything.
    pub(super) fn new(design: &'d Design) -> ThreeValued<'d> {
        let netlist = design.netlist();
        let mut places = vec![0];
        for net in netlist.nets() {
            places.push(places[net.index()] + netlist.width(net).get() as usize);
        }
        let bits = vec![Bit::X; places[netlist.cells.len()]];
        ThreeValued { design, places, bits, taken: Vec::new() }
    }

    /// The bits of a net, the lowest first.
    pub(super) fn of(&self, net: Net) -> &[Bit] {
        &self.bits[self.places[net.index()]..self.places[net.index() + 1]]
    }

    /// They, to be set: of inputs, registers, and nets that are cut off from what drives them.
    pub(super) fn of_mut(&mut self, net: Net) -> &mut [Bit] {
        &mut self.bits[self.places[net.index()]..self.places[net.index() + 1]]
    }

    /// The same word in every lane.
    pub(super) fn set(&mut self, net: Net, word: u64) {
        for (place, bit) in self.of_mut(net).iter_mut().enumerate() {
            *bit = Bit::all(word >> place & 1 == 1);
        }
    }

    /// All nets but inputs, registers and what is `cut` off; creation order is evaluation order.
    pub(super) fn settle(&mut self, cut: Option<Net>) {
        let netlist = self.design.netlist();
        for net in netlist.nets().filter(|net| Some(*net) != cut) {
            let op = netlist.cell(net).op;
            let (known, rest) = self.bits.split_at_mut(self.places[net.index()]);
            let own = &mut rest[..self.places[net.index() + 1] - self.places[net.index()]];
            let held = |net: Net| &known[self.places[net.index()]..self.places[net.index() + 1]];
            work_out(op, own, held);
        }
    }

    /// All registers take their next values at once.
    pub(super) fn edge(&mut self) {
        let netlist = self.design.netlist();
        self.taken.clear();
        for register in self.design.registers() {
            match netlist.cell(*register).op {
                Op::Register { next: Some(next), .. } => {
                    let (first, beyond) = (self.places[next.index()], self.places[next.index() + 1]);
                    self.taken.extend(&self.bits[first..beyond]);
                }
                _ => self.taken.extend(std::iter::repeat_n(Bit::X, netlist.width(*register).get() as usize)),
            }
        }
        let mut taken = self.taken.iter();
        for register in self.design.registers() {
            let (first, beyond) = (self.places[register.index()], self.places[register.index() + 1]);
            self.bits[first..beyond].iter_mut().zip(&mut taken).for_each(|(bit, next)| *bit = *next);
        }
    }
}

/// The bits of a cell by those of its operands.
fn work_out<'b>(op: Op, own: &mut [Bit], held: impl Fn(Net) -> &'b [Bit]) {
    let nothing = |_: usize, _: Bit| {};
    let complement = |b: Net| held(b).iter().map(|bit| bit.not());
    let mut gate = |a: Net, b: Net, of: fn(Bit, Bit) -> Bit| {
        own.iter_mut().zip(held(a).iter().zip(held(b))).for_each(|(bit, (a, b))| *bit = of(*a, *b));
    };
    match op {
        Op::Input | Op::Register { .. } => {}
        Op::Read { .. } => own.fill(Bit::X),
        Op::And(a, b) => gate(a, b, Bit::and),
        Op::Or(a, b) => gate(a, b, Bit::or),
        Op::Xor(a, b) => gate(a, b, Bit::xor),
        Op::Const(word) => {
            own.iter_mut().enumerate().for_each(|(place, bit)| *bit = Bit::all(word >> place & 1 == 1));
        }
        Op::Not(a) => own.iter_mut().zip(held(a)).for_each(|(bit, a)| *bit = a.not()),
        Op::Mux { select, high, low } => {
            let select = held(select)[0];
            let both = held(high).iter().zip(held(low));
            own.iter_mut().zip(both).for_each(|(bit, (high, low))| *bit = select.choose(*high, *low));
        }
        Op::Add(a, b) => _ = ripple(held(a), held(b).iter().copied(), Bit::all(false), |place, bit| own[place] = bit),
        Op::Sub(a, b) => _ = ripple(held(a), complement(b), Bit::all(true), |place, bit| own[place] = bit),
        Op::Mul(a, b) => own.copy_from_slice(&product(held(a), held(b))),
        Op::Div(a, b) => own.copy_from_slice(&quotient(held(a), held(b))[0]),
        Op::Rem(a, b) => own.copy_from_slice(&quotient(held(a), held(b))[1]),
        Op::ShiftLeft(a, by) => own.copy_from_slice(&shifted(held(a), held(by), true, Bit::all(false))),
        Op::ShiftRight(a, by) => own.copy_from_slice(&shifted(held(a), held(by), false, Bit::all(false))),
        Op::ShiftArithmetic(a, by) => {
            own.copy_from_slice(&shifted(held(a), held(by), false, held(a)[held(a).len() - 1]));
        }
        Op::Carry(a, b) => own[0] = ripple(held(a), held(b).iter().copied(), Bit::all(false), nothing).1,
        Op::Borrow(a, b) => own[0] = ripple(held(a), complement(b), Bit::all(true), nothing).1.not(),
        Op::AddOverflow(a, b) => {
            let (into, out) = ripple(held(a), held(b).iter().copied(), Bit::all(false), nothing);
            own[0] = into.xor(out);
        }
        Op::SubOverflow(a, b) => {
            let (into, out) = ripple(held(a), complement(b), Bit::all(true), nothing);
            own[0] = into.xor(out);
        }
        Op::LessSigned(a, b) => {
            let mut sign = Bit::X;
            let (into, out) = ripple(held(a), complement(b), Bit::all(true), |_, bit| sign = bit);
            own[0] = sign.xor(into.xor(out));
        }
        Op::Equal(a, b) => {
            let both = held(a).iter().zip(held(b));
            own[0] = both.fold(Bit::all(true), |same, (a, b)| same.and(a.xor(*b).not()));
        }
        Op::Slice { of, low } => own.copy_from_slice(&held(of)[usize::from(low)..][..own.len()]),
        Op::Concat { high, low } => {
            let parts = held(low).iter().chain(held(high));
            own.iter_mut().zip(parts).for_each(|(bit, part)| *bit = *part);
        }
        Op::ZeroExtend(a) => {
            let all = held(a).iter().copied().chain(std::iter::repeat(Bit::all(false)));
            own.iter_mut().zip(all).for_each(|(bit, a)| *bit = a);
        }
        Op::SignExtend(a) => {
            let all = held(a).iter().chain(std::iter::repeat(&held(a)[held(a).len() - 1]));
            own.iter_mut().zip(all).for_each(|(bit, a)| *bit = *a);
        }
    }
}

#[cfg(test)]
mod tests;
