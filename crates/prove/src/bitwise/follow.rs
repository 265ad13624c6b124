//! One block followed clock by clock, with the bits of some load words unknown: a proof at one width for a machine
//! whose counters run by themselves.
//!
//! Registers hold anything when the block is loaded. From then on every net is known, an unknown bit, or a sum of
//! unknown bits with whole factors; any other value counts as unknown. So what is found of a net holds for all values
//! of the unknown bits, and the only condition on the netlist is that its clocks do not depend on them.

use std::rc::Rc;

use crate::Strobes;
use stepwave_netlist::Design;
use stepwave_netlist::bits::{self, Width};
use stepwave_netlist::cells::{Net, Netlist, Op};
use stepwave_netlist::passes::constant;

/// The value of an input while the block is loaded.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LoadWord {
    /// These bits.
    Known(u64),
    /// Any bits: each is an unknown.
    Unknown,
}

/// A whole number: a constant, plus a factor for each unknown bit that is 1.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sum {
    /// Where all unknown bits are 0.
    pub constant: i128,
    /// What each unknown bit adds.
    pub factors: Vec<i128>,
}

/// What a block comes to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Followed {
    /// Clocks from the load to the end.
    pub clocks: u64,
    /// The final values of the nets asked for, in two's complement; `None` where a value is not such a sum.
    pub ends: Vec<Option<Sum>>,
}

/// Why nothing can be said of a block.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum Lost {
    /// A claim of the netlist is violated, or may be.
    #[error("{claim} may overflow at clock {clock}")]
    Claim {
        /// The component that it is about.
        claim: String,
        /// Clocks since the load.
        clock: u64,
    },
    /// Whether the block has ended depends on what is unknown.
    #[error("whether the block ends at clock {clock} depends on what was loaded")]
    End {
        /// Clocks since the load.
        clock: u64,
    },
    /// The place of an axis after the load is not known.
    #[error("the load does not preset the positions")]
    Start,
    /// No one bit says whether there is a pulse.
    #[error("whether there is a pulse at clock {clock} depends on more than one bit of what was loaded")]
    Pulse {
        /// Clocks since the load.
        clock: u64,
    },
    /// A position does not count its pulses.
    #[error("{position} does not count every pulse of its axis as one")]
    Counter {
        /// The register.
        position: String,
    },
    /// It does not end within the limit.
    #[error("the block does not end within {clocks} clocks")]
    Endless {
        /// Clocks that were followed.
        clocks: u64,
    },
}

/// What is known of the bits of a net.
#[derive(Clone, PartialEq, Debug)]
enum Value {
    /// Nothing.
    Any,
    Known(u64),
    /// An unknown bit, or its complement: 1 bit.
    Bit {
        unknown: usize,
        negated: bool,
    },
    /// Its bits are the unknowns from this one on.
    Bits {
        first: usize,
    },
    /// Read in two's complement they are exactly this number.
    Sum(Rc<Sum>),
}

impl Sum {
    fn of(constant: i64, unknowns: usize) -> Sum {
        Sum { constant: i128::from(constant), factors: vec![0; unknowns] }
    }

    /// Least and greatest value.
    fn range(&self) -> (i128, i128) {
        let all = self.factors.iter();
        all.fold((self.constant, self.constant), |(least, most), factor| {
            (least + factor.min(&0), most + factor.max(&0))
        })
    }

    fn plus(&self, other: &Sum, sign: i128) -> Sum {
        let factors = self.factors.iter().zip(&other.factors).map(|(a, b)| a + sign * b).collect();
        Sum { constant: self.constant + sign * other.constant, factors }
    }

    /// The same of an unknown bit.
    fn given(&self, unknown: usize, is: bool) -> Sum {
        let mut sum = self.clone();
        let factor = std::mem::take(&mut sum.factors[unknown]);
        sum.constant += if is { factor } else { 0 };
        sum
    }

    /// Its value where the unknown bits are these.
    #[must_use]
    pub fn at(&self, unknowns: &[bool]) -> i128 {
        let set = self.factors.iter().zip(unknowns).filter(|(_, is)| **is);
        self.constant + set.map(|(factor, _)| factor).sum::<i128>()
    }
}

/// What is known of every net in one sample.
#[derive(Debug)]
pub struct KnownSample<'d> {
    netlist: &'d Netlist,
    values: &'d [Value],
}

impl KnownSample<'_> {
    /// The bits of a net where the unknown bits are these; `None` where nothing is known.
    #[must_use]
    pub fn value(&self, net: Net, unknowns: &[bool]) -> Option<u64> {
        let width = self.netlist.width(net);
        match &self.values[net.index()] {
            Value::Any => None,
            Value::Known(value) => Some(*value),
            Value::Bit { unknown, negated } => unknowns.get(*unknown).map(|bit| u64::from(bit != negated)),
            Value::Bits { first } => {
                let own = unknowns.iter().skip(*first).take(width.get() as usize);
                Some(own.enumerate().fold(0, |word, (place, bit)| word | u64::from(*bit) << place))
            }
            Value::Sum(sum) => bits::Bits::exact(width, sum.at(unknowns), true).map(bits::Bits::value),
        }
    }
}

/// Follows a block from its load, for at most `limit` clocks. Unknown bits are numbered word by word, from the lowest
/// bit on. `seen` gets every sample after the load. `ends` are the nets whose final values are returned.
///
/// # Errors
/// See [`Lost`].
pub fn follow(
    design: &Design,
    strobes: Strobes,
    words: &[(Net, LoadWord)],
    ends: &[Net],
    limit: u64,
    mut seen: impl FnMut(u64, &KnownSample<'_>),
) -> Result<Followed, Lost> {
    let netlist = design.netlist();
    let mut values = vec![Value::Any; netlist.cells.len()];
    let mut unknowns = 0;
    for (input, word) in words {
        values[input.index()] = match word {
            LoadWord::Known(bits) => Value::Known(*bits),
            LoadWord::Unknown => Value::Bits { first: unknowns },
        };
        if *word == LoadWord::Unknown {
            unknowns += netlist.width(*input).get() as usize;
        }
    }
    for strobe in [strobes.load, strobes.preset_position] {
        values[strobe.index()] = Value::Known(1);
    }
    let machine = Follower { netlist, unknowns };
    for clock in 0..=limit {
        machine.settle(&mut values);
        for property in &netlist.properties {
            if values[property.never.index()] != Value::Known(0) {
                return Err(Lost::Claim { claim: property.name.clone(), clock });
            }
        }
        if clock > 0 {
            seen(clock, &KnownSample { netlist, values: &values });
            match values[strobes.done.index()] {
                Value::Known(0) => {}
                Value::Known(_) => {
                    let ends = ends.iter().map(|net| machine.sum(&values, *net)).collect();
                    return Ok(Followed { clocks: clock, ends });
                }
                _ => return Err(Lost::End { clock }),
            }
        }
        machine.edge(design, &mut values);
        if clock == 0 {
            // After the load the words may be anything.
            design.inputs().iter().for_each(|input| values[input.index()] = Value::Any);
            for strobe in [strobes.load, strobes.preset_position] {
                values[strobe.index()] = Value::Known(0);
            }
        }
    }
    Err(Lost::Endless { clocks: limit })
}

struct Follower<'d> {
    netlist: &'d Netlist,
    unknowns: usize,
}

impl Follower<'_> {
    /// All nets but registers and inputs; creation order is evaluation order.
    fn settle(&self, values: &mut [Value]) {
        for net in self.netlist.nets() {
            let cell = self.netlist.cell(net);
            if !matches!(cell.op, Op::Input | Op::Register { .. }) {
                values[net.index()] = self.work_out(cell.op, cell.width, values);
            }
        }
    }

    fn edge(&self, design: &Design, values: &mut [Value]) {
        let next = |register: &Net| match self.netlist.cell(*register).op {
            Op::Register { next: Some(next), .. } => values[next.index()].clone(),
            _ => Value::Any,
        };
        let taken: Vec<Value> = design.registers().iter().map(next).collect();
        for (register, value) in design.registers().iter().zip(taken) {
            values[register.index()] = value;
        }
    }

    fn work_out(&self, op: Op, width: Width, values: &[Value]) -> Value {
        let known = |net: Net| match values[net.index()] {
            Value::Known(value) => Some((value, self.netlist.width(net))),
            _ => None,
        };
        if let Some(value) = constant::value(op, width, known) {
            return Value::Known(value);
        }
        let held = |net: Net| &values[net.index()];
        match op {
            Op::Not(a) => complement(held(a)),
            Op::And(a, b) => gate(held(a), held(b), 0, width.mask()),
            Op::Or(a, b) => gate(held(a), held(b), width.mask(), 0),
            Op::Xor(a, b) => match (held(a), held(b)) {
                (Value::Known(0), other) | (other, Value::Known(0)) => other.clone(),
                (Value::Known(1), other) | (other, Value::Known(1)) if width.get() == 1 => complement(other),
                _ => Value::Any,
            },
            Op::Mux { select, high, low } => match *held(select) {
                Value::Known(select) => held(if select == 1 { high } else { low }).clone(),
                _ if held(high) == held(low) => held(high).clone(),
                Value::Bit { unknown, negated: false } => self.chosen(unknown, high, low, values),
                Value::Bit { unknown, negated: true } => self.chosen(unknown, low, high, values),
                _ => Value::Any,
            },
            Op::Add(a, b) => self.count(a, b, 1, values),
            Op::Sub(a, b) => self.count(a, b, -1, values),
            Op::AddOverflow(a, b) => self.leaves(a, b, 1, values),
            Op::SubOverflow(a, b) => self.leaves(a, b, -1, values),
            Op::SignExtend(a) => match held(a) {
                Value::Sum(sum) => Value::Sum(Rc::clone(sum)),
                _ => Value::Any,
            },
            Op::Slice { of, low } => match *held(of) {
                Value::Bits { first } if width.get() == 1 => {
                    Value::Bit { unknown: first + usize::from(low), negated: false }
                }
                Value::Bits { first } => Value::Bits { first: first + usize::from(low) },
                _ => Value::Any,
            },
            _ => Value::Any,
        }
    }

    /// What a net holds, as a number in two's complement.
    fn sum(&self, values: &[Value], net: Net) -> Option<Sum> {
        match &values[net.index()] {
            Value::Known(value) => Some(Sum::of(bits::to_signed(self.netlist.width(net), *value), self.unknowns)),
            Value::Sum(sum) => Some(Sum::clone(sum)),
            _ => None,
        }
    }

    /// Sum or difference of two nets.
    fn exact(&self, a: Net, b: Net, sign: i128, values: &[Value]) -> Option<Sum> {
        Some(self.sum(values, a)?.plus(&self.sum(values, b)?, sign))
    }

    /// The sum, if it lies in the range of the operands for all values of the unknown bits.
    fn count(&self, a: Net, b: Net, sign: i128, values: &[Value]) -> Value {
        let (least, most) = self.netlist.width(a).range(true);
        let sum = self.exact(a, b, sign, values).filter(|sum| least <= sum.range().0 && sum.range().1 <= most);
        sum.map_or(Value::Any, |sum| Value::Sum(Rc::new(sum)))
    }

    fn leaves(&self, a: Net, b: Net, sign: i128, values: &[Value]) -> Value {
        match self.count(a, b, sign, values) {
            Value::Sum(_) => Value::Known(0),
            _ => Value::Any,
        }
    }

    /// One net where an unknown bit is 1, another where it is 0.
    fn chosen(&self, unknown: usize, one: Net, zero: Net, values: &[Value]) -> Value {
        let (Some(one), Some(zero)) = (self.sum(values, one), self.sum(values, zero)) else { return Value::Any };
        let (one, mut sum) = (one.given(unknown, true), zero.given(unknown, false));
        if one.factors != sum.factors {
            return Value::Any;
        }
        sum.factors[unknown] = one.constant - sum.constant;
        Value::Sum(Rc::new(sum))
    }
}

fn complement(value: &Value) -> Value {
    match *value {
        Value::Bit { unknown, negated } => Value::Bit { unknown, negated: !negated },
        _ => Value::Any,
    }
}

/// And, or: `wins` decides regardless of the other, `yields` leaves the other as it is.
fn gate(a: &Value, b: &Value, wins: u64, yields: u64) -> Value {
    match (a, b) {
        (Value::Known(own), other) | (other, Value::Known(own)) => {
            if *own == wins {
                Value::Known(wins)
            } else if *own == yields {
                other.clone()
            } else {
                Value::Any
            }
        }
        (a, b) if a == b => a.clone(),
        _ => Value::Any,
    }
}
