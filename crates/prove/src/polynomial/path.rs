//! What a netlist does over a few clocks, along one path of decisions: every net as a polynomial of what the registers
//! held at first.
//!
//! A net of w bits is held as a polynomial that equals its bits modulo 2^w. Where an operator needs the number itself
//! (a carry, a comparison, a sign), the path decides where the polynomial lies; where both are possible, the path
//! forks. So multiplexers are resolved, and the rest is linear as long as the hardware is.
//!
//! Nets are worked out on demand, through registers back to the first clock: what nobody asks for decides nothing.

use super::decisions::{Decisions, Stop};
use super::family::{Bits, Family};
use super::poly::Poly;
use super::variables::Variables;
use stepwave_netlist::cells::{Net, Op};

/// A path from a state over some clocks.
pub(crate) struct Path<'p, 'o> {
    family: &'p Family,
    pub(crate) variables: Variables,
    /// What registers and inputs hold at the first clock, by net.
    first: &'p [Poly],
    /// What inputs hold after the first clock, where it is something else.
    later: &'p [(Net, u64)],
    decisions: &'p mut Decisions<'o>,
    /// What each net holds modulo 2^width, by clock.
    held: Vec<Vec<Option<Poly>>>,
    /// Only what is decided already counts.
    peeking: bool,
}

impl<'p, 'o> Path<'p, 'o> {
    pub(crate) fn new(
        family: &'p Family,
        variables: &Variables,
        first: &'p [Poly],
        later: &'p [(Net, u64)],
        decisions: &'p mut Decisions<'o>,
    ) -> Path<'p, 'o> {
        Path { family, variables: variables.clone(), first, later, decisions, held: Vec::new(), peeking: false }
    }

    /// The conditions that the path has taken on, each 0 or more.
    pub(crate) fn facts(&self) -> &[Poly] {
        self.decisions.facts()
    }

    /// All decisions so far, for obligations on the path.
    pub(crate) fn decisions(&mut self) -> (&mut Decisions<'o>, &Variables) {
        (self.decisions, &self.variables)
    }

    /// A net of one bit at a clock.
    pub(crate) fn truth(&mut self, net: Net, clock: usize) -> Result<bool, Stop> {
        if let Some(known) = self.memo(net, clock).and_then(|poly| poly.constant()) {
            return Ok(known != 0);
        }
        let truth = self.work_out_truth(net, clock)?;
        self.keep(net, clock, Poly::from(i128::from(truth)));
        Ok(truth)
    }

    fn work_out_truth(&mut self, net: Net, clock: usize) -> Result<bool, Stop> {
        let netlist = self.family.netlist();
        match netlist.cell(net).op {
            Op::Register { next: Some(next), .. } if clock > 0 => self.truth(next, clock - 1),
            Op::Input | Op::Register { .. } => {
                let held = self.source(net, clock)?;
                Ok(!self.is_zero(&held)?)
            }
            Op::Const(value) => Ok(value != 0),
            Op::Not(a) => Ok(!self.truth(a, clock)?),
            Op::And(a, b) | Op::Mul(a, b) => self.either(a, b, clock, false),
            Op::Or(a, b) => self.either(a, b, clock, true),
            Op::Xor(a, b) | Op::Add(a, b) | Op::Sub(a, b) => Ok(self.truth(a, clock)? != self.truth(b, clock)?),
            Op::Mux { select, high, low } => {
                let taken = if self.truth(select, clock)? { high } else { low };
                self.truth(taken, clock)
            }
            Op::ZeroExtend(a) | Op::SignExtend(a) => self.truth(a, clock),
            Op::Carry(a, b) => {
                let sum = self.unsigned(a, clock)?.plus(&self.unsigned(b, clock)?);
                let modulus = self.modulus(a);
                self.at_least_zero(&sum.minus(&modulus))
            }
            Op::Borrow(a, b) => {
                let gap = self.unsigned(b, clock)?.minus(&self.unsigned(a, clock)?);
                self.at_least_zero(&gap.plus_number(-1))
            }
            Op::LessSigned(a, b) => {
                let gap = self.signed(b, clock)?.minus(&self.signed(a, clock)?);
                self.at_least_zero(&gap.plus_number(-1))
            }
            Op::AddOverflow(a, b) => {
                let sum = self.signed(a, clock)?.plus(&self.signed(b, clock)?);
                self.leaves_signed_range(a, &sum)
            }
            Op::SubOverflow(a, b) => {
                let difference = self.signed(a, clock)?.minus(&self.signed(b, clock)?);
                self.leaves_signed_range(a, &difference)
            }
            Op::Equal(a, b) => {
                if self.is_bit(a) {
                    return Ok(self.truth(a, clock)? == self.truth(b, clock)?);
                }
                self.equal(a, b, clock)
            }
            Op::Slice { of, .. } => {
                let low = self.family.low(net);
                let top = Bits { fixed: low.fixed + 1, grows: low.grows };
                if top == self.family.width(of) {
                    // The sign.
                    let number = self.signed(of, clock)?;
                    return Ok(!self.at_least_zero(&number)?);
                }
                let bit = self.slice(net, of, clock)?;
                Ok(!self.is_zero(&bit)?)
            }
            Op::Concat { .. } => Err(Stop::Unsupported("a concatenation of one bit".to_owned())),
            Op::Div(..) | Op::Rem(..) => Err(divided()),
            Op::ShiftLeft(..) | Op::ShiftRight(..) | Op::ShiftArithmetic(..) => Err(shifted()),
            Op::Read { .. } => Err(Stop::Unsupported("a word of a memory".to_owned())),
        }
    }

    /// An And (`absorbing` = false) or an Or: decided by either operand, whichever is known.
    fn either(&mut self, a: Net, b: Net, clock: usize, absorbing: bool) -> Result<bool, Stop> {
        if self.peek(a, clock) == Some(absorbing) || self.peek(b, clock) == Some(absorbing) {
            return Ok(absorbing);
        }
        if self.truth(a, clock)? == absorbing {
            return Ok(absorbing);
        }
        self.truth(b, clock)
    }

    /// A bit, if it needs no further decision.
    fn peek(&mut self, net: Net, clock: usize) -> Option<bool> {
        let before = std::mem::replace(&mut self.peeking, true);
        let known = self.truth(net, clock).ok();
        self.peeking = before;
        known
    }

    /// What a net holds, modulo 2 to its width.
    fn residue(&mut self, net: Net, clock: usize) -> Result<Poly, Stop> {
        if self.is_bit(net) {
            return Ok(Poly::from(i128::from(self.truth(net, clock)?)));
        }
        if let Some(known) = self.memo(net, clock) {
            return Ok(known.clone());
        }
        let poly = self.work_out(net, clock)?;
        self.keep(net, clock, poly.clone());
        Ok(poly)
    }

    fn work_out(&mut self, net: Net, clock: usize) -> Result<Poly, Stop> {
        match self.family.netlist().cell(net).op {
            Op::Register { next: Some(next), .. } if clock > 0 => self.residue(next, clock - 1),
            Op::Input | Op::Register { .. } => self.source(net, clock),
            Op::Const(_) => Ok(self.family.number(net)),
            Op::Not(a) => Ok(self.residue(a, clock)?.negated().plus_number(-1)),
            Op::Add(a, b) => Ok(self.residue(a, clock)?.plus(&self.residue(b, clock)?)),
            Op::Sub(a, b) => Ok(self.residue(a, clock)?.minus(&self.residue(b, clock)?)),
            Op::Mul(a, b) => Ok(self.residue(a, clock)?.times(&self.residue(b, clock)?)),
            Op::Div(..) | Op::Rem(..) => Err(divided()),
            Op::ShiftLeft(..) | Op::ShiftRight(..) | Op::ShiftArithmetic(..) => Err(shifted()),
            Op::Read { .. } => Err(Stop::Unsupported("a word of a memory".to_owned())),
            Op::Mux { select, high, low } => {
                let taken = if self.truth(select, clock)? { high } else { low };
                self.residue(taken, clock)
            }
            Op::And(a, b) => self.bitwise(net, [a, b], clock, |a, b| a & b),
            Op::Or(a, b) => self.bitwise(net, [a, b], clock, |a, b| a | b),
            Op::Xor(a, b) => self.bitwise(net, [a, b], clock, |a, b| a ^ b),
            Op::ZeroExtend(a) => self.unsigned(a, clock),
            Op::SignExtend(a) => self.signed(a, clock),
            Op::Slice { of, .. } => {
                if (self.family.low(net)) == (Bits { fixed: 0, grows: false }) {
                    return self.residue(of, clock);
                }
                self.slice(net, of, clock)
            }
            Op::Concat { high, low } => {
                let above = self.residue(high, clock)?;
                let below = self.unsigned(low, clock)?;
                Ok(above.times(&self.modulus(low)).plus(&below))
            }
            Op::Carry(..)
            | Op::Borrow(..)
            | Op::AddOverflow(..)
            | Op::SubOverflow(..)
            | Op::Equal(..)
            | Op::LessSigned(..) => Err(Stop::Unsupported("a yes-or-no cell of several bits".to_owned())),
        }
    }

    /// A bitwise operator on several bits: of numbers that are known, else of one unknown.
    fn bitwise(&mut self, net: Net, [a, b]: [Net; 2], clock: usize, of: fn(i128, i128) -> i128) -> Result<Poly, Stop> {
        let (a, b) = (self.unsigned(a, clock)?, self.unsigned(b, clock)?);
        if let (Some(a), Some(b)) = (a.constant(), b.constant()) {
            return Ok(Poly::from(of(a, b)));
        }
        let greatest = self.modulus(net).plus_number(-1);
        self.fresh("bits", greatest)
    }

    /// Bits from the middle of a net: the number is split into what lies above, in and below.
    fn slice(&mut self, net: Net, of: Net, clock: usize) -> Result<Poly, Stop> {
        let number = self.unsigned(of, clock)?;
        let (low, width) = (self.family.low(net), self.family.width(net));
        let below_modulus = self.family.power(low);
        let own_modulus = self.family.power(width);
        if let (Some(number), Some(below), Some(own)) =
            (number.constant(), below_modulus.constant(), own_modulus.constant())
        {
            return Ok(Poly::from(number / below % own));
        }
        if let (Some(below), Some(own)) = (below_modulus.constant(), own_modulus.constant())
            && let Some(bits) = self.variables.bits_of(&number, below, own)
        {
            return Ok(bits);
        }
        let above_modulus = self.modulus(of);
        let inside = self.fresh("bits", own_modulus.plus_number(-1))?;
        let below = self.fresh("below", below_modulus.plus_number(-1))?;
        let above = self.fresh("above", above_modulus)?;
        let whole = above.times(&own_modulus).plus(&inside).times(&below_modulus).plus(&below);
        let gap = whole.minus(&number);
        self.decisions.assume(gap.clone());
        self.decisions.assume(gap.negated());
        Ok(inside)
    }

    /// The number that the bits of a net mean, unsigned.
    pub(crate) fn unsigned(&mut self, net: Net, clock: usize) -> Result<Poly, Stop> {
        let number = self.residue(net, clock)?;
        let modulus = self.modulus(net);
        self.within(number, &Poly::from(0), &modulus)
    }

    /// The number that the bits of a net mean in two's complement.
    pub(crate) fn signed(&mut self, net: Net, clock: usize) -> Result<Poly, Stop> {
        let number = self.residue(net, clock)?;
        let width = self.family.width(net);
        let half = self.family.power(Bits { fixed: width.fixed - 1, ..width });
        self.within(number, &half.negated(), &self.modulus(net))
    }

    /// The number that equals this one modulo `modulus` and lies in `least .. least + modulus`.
    fn within(&mut self, number: Poly, least: &Poly, modulus: &Poly) -> Result<Poly, Stop> {
        let beyond = least.plus(modulus);
        let mut number = number;
        // Sums of a few numbers of the width wrap a few times at most.
        for _ in 0..4 {
            if !self.at_least_zero(&number.minus(least))? {
                number = number.plus(modulus);
            } else if self.at_least_zero(&number.minus(&beyond))? {
                number = number.minus(modulus);
            } else {
                return Ok(number);
            }
        }
        Err(Stop::Unsupported("a sum that goes round its register more than four times".to_owned()))
    }

    fn leaves_signed_range(&mut self, operand: Net, number: &Poly) -> Result<bool, Stop> {
        let width = self.family.width(operand);
        let half = self.family.power(Bits { fixed: width.fixed - 1, ..width });
        Ok(self.at_least_zero(&number.minus(&half))? || !self.at_least_zero(&number.plus(&half))?)
    }

    fn equal(&mut self, a: Net, b: Net, clock: usize) -> Result<bool, Stop> {
        let gap = self.residue(a, clock)?.minus(&self.residue(b, clock)?);
        let modulus = self.modulus(a);
        if self.variables.is_between(&gap, &modulus) {
            return self.is_zero(&gap);
        }
        let gap = self.unsigned(a, clock)?.minus(&self.unsigned(b, clock)?);
        self.is_zero(&gap)
    }

    /// A polynomial is 0 or more: known, or decided here.
    fn at_least_zero(&mut self, poly: &Poly) -> Result<bool, Stop> {
        if poly.is_lost() {
            return Err(Stop::Unsupported("numbers beyond 128 bits".to_owned()));
        }
        if let Some(known) = self.variables.sign(poly) {
            return Ok(known);
        }
        let not = poly.negated().plus_number(-1);
        let options = [vec![poly.clone()], vec![not]];
        Ok(self.decisions.decide(&options, &self.variables, self.peeking)? == 0)
    }

    /// A polynomial is 0: known, or decided here.
    fn is_zero(&mut self, poly: &Poly) -> Result<bool, Stop> {
        if poly.is_lost() {
            return Err(Stop::Unsupported("numbers beyond 128 bits".to_owned()));
        }
        if let Some(number) = poly.constant() {
            return Ok(number == 0);
        }
        if self.variables.sign(&poly.plus_number(-1)) == Some(true)
            || self.variables.sign(&poly.negated().plus_number(-1)) == Some(true)
        {
            return Ok(false);
        }
        let (more, less) = (poly.plus_number(-1), poly.negated().plus_number(-1));
        let options = [vec![poly.clone(), poly.negated()], vec![more], vec![less]];
        Ok(self.decisions.decide(&options, &self.variables, self.peeking)? == 0)
    }

    /// A new unknown from 0 to `greatest`.
    fn fresh(&mut self, name: &str, greatest: Poly) -> Result<Poly, Stop> {
        if self.peeking {
            return Err(Stop::Undecided);
        }
        self.variables.fresh(name, greatest).map(Poly::from).ok_or(Stop::TooLarge)
    }

    /// What an input or a register of the first clock holds. An input that may change at any clock, of which no number is
    /// known, is an unknown of its own at each.
    fn source(&mut self, net: Net, clock: usize) -> Result<Poly, Stop> {
        if clock > 0
            && let Some((_, value)) = self.later.iter().find(|(input, _)| *input == net)
        {
            return Ok(Poly::from(i128::from(*value)));
        }
        let first = &self.first[net.index()];
        if first.is_lost() {
            let greatest = self.modulus(net).plus_number(-1);
            return self.fresh("free", greatest);
        }
        Ok(first.clone())
    }

    fn is_bit(&self, net: Net) -> bool {
        self.family.width(net) == Bits { fixed: 1, grows: false }
    }

    fn modulus(&self, net: Net) -> Poly {
        self.family.power(self.family.width(net))
    }

    fn memo(&self, net: Net, clock: usize) -> Option<&Poly> {
        self.held.get(clock)?[net.index()].as_ref()
    }

    fn keep(&mut self, net: Net, clock: usize, poly: Poly) {
        let cells = self.family.netlist().cells.len();
        while self.held.len() <= clock {
            self.held.push(vec![None; cells]);
        }
        self.held[clock][net.index()] = Some(poly);
    }
}

fn divided() -> Stop {
    Stop::Unsupported("a quotient or remainder of two nets".to_owned())
}

fn shifted() -> Stop {
    Stop::Unsupported("a shift by a net".to_owned())
}

#[cfg(test)]
mod tests;
