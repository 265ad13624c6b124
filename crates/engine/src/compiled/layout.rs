//! Where the code of a digest puts what is wanted, and what of it follows from the logic alone.

use std::collections::BTreeSet;

use rustc_hash::FxHashSet as HashSet;

use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Netlist, Op};

/// Rounds of a digest, at least: as many as make the values of a lane fill a good part of the nearest cache.
pub(super) const ROUNDS: usize = 2048;
/// Samples of a digest are a multiple of this, so that it ends where a block of recorded samples would.
pub(super) const CLOCKS: usize = 256;
/// Widest value of a narrow lane, in bits.
pub(super) const NARROW: u32 = 32;

/// Bits of a counter that may come to the end of its range in each digest, so that its extremes are not looked for at their ends.
pub(super) const SMALL_COUNTER: u32 = 15;

/// Where the extremes of a register come from.
#[derive(Clone, Debug)]
pub(super) enum RangeFrom {
    /// It has these values and no others, or where there are none, it rests.
    Values(BTreeSet<u64>),
    /// It counts one by one in one direction, up or down, and comes to no end of its range.
    Counter { up: bool },
    /// It is 0, or this value where the train says so.
    Train { train: usize, value: u64 },
    /// Narrow lanes.
    Narrow(Vec<usize>),
    /// Wide lanes.
    Wide(Vec<usize>),
}

/// Where the words of a train come from.
#[derive(Clone, Copy, Debug)]
pub(super) enum TrainFrom {
    /// All are the same.
    Pattern(u64),
    /// The n-th of the words stored.
    Stored(usize),
    /// It is not 0 where a counter is another than in the sample before, which is in a narrow lane. Where `register` is
    /// some, the code does not know what the train's own net, a register, comes to: 0, or this value.
    Moved { counter: Net, lane: usize, register: Option<(usize, u64)> },
    /// Those of an earlier train with these bits inverted.
    Inverted { of: usize, bits: u64 },
}

/// Where the values of a form come from.
#[derive(Clone, Debug)]
pub(super) enum FormFrom {
    /// The two terms of it, from pairs of narrow lanes.
    Pairs(Vec<[usize; 2]>),
    /// Wide lanes.
    Wide(Vec<usize>),
}

/// Where the code puts what is wanted.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// Samples of a word, rounds of a word, words of a train.
    pub(super) span: usize,
    pub(super) rounds: usize,
    pub(super) words: usize,
    pub(super) ranges: Vec<RangeFrom>,
    pub(super) trains: Vec<TrainFrom>,
    pub(super) forms: Vec<FormFrom>,
    /// Lanes: of each, a value a round.
    pub(super) narrow: usize,
    pub(super) wide: usize,
    /// Words stored for each word of a train.
    pub(super) stored: usize,
}

impl Layout {
    /// Values of a lane.
    pub(super) fn records(&self) -> usize {
        self.words * self.rounds
    }

    /// From one lane to the next, in values: a line of the cache more, so that the values of a round do not all fall into
    /// the same set of it.
    pub(super) fn region(&self) -> usize {
        self.records() + 16
    }

    /// Values of all narrow lanes, of all wide ones, and words, of a digest.
    pub(super) fn room(&self) -> [usize; 3] {
        [self.region() * self.narrow, self.region() * self.wide, self.words * self.stored]
    }

    /// Samples of a digest.
    pub(super) fn clocks(&self) -> u64 {
        (self.words * self.span) as u64
    }
}

/// A net is 1 in every sample.
pub(super) fn is_const_one(netlist: &Netlist, net: Net) -> bool {
    is_one(netlist, net) && !matches!(netlist.cell(net).op, Op::ZeroExtend(_))
}

/// A net is 0 or 1.
pub(super) fn is_one(netlist: &Netlist, net: Net) -> bool {
    match netlist.cell(net).op {
        Op::Const(1) => true,
        Op::ZeroExtend(bit) => netlist.width(bit) == Width::ONE,
        // As extended from a width in which it is not the sign.
        Op::SignExtend(of) => matches!(netlist.cell(of).op, Op::Const(1)) && netlist.width(of) > Width::ONE,
        _ => false,
    }
}

/// The bit that a net is 0 without, and one value with.
pub(super) fn bit_of(netlist: &Netlist, net: Net) -> Option<Net> {
    match netlist.cell(net).op {
        _ if netlist.width(net) == Width::ONE => Some(net),
        Op::ZeroExtend(of) => bit_of(netlist, of),
        Op::Concat { high, low } if high == low => bit_of(netlist, low),
        Op::Concat { high, low } => match [netlist.cell(high).op, netlist.cell(low).op] {
            [Op::Const(0), _] => bit_of(netlist, low),
            [_, Op::Const(0)] => bit_of(netlist, high),
            _ => None,
        },
        _ => None,
    }
}

/// A register moves by one, in one direction, where this bit is 1 and in no other sample.
pub(super) fn moves_with(netlist: &Netlist, register: Net, next: Net, bit: Net) -> bool {
    let is_bit = |net: Net| matches!(netlist.cell(net).op, Op::ZeroExtend(of) if of == bit);
    match netlist.cell(next).op {
        Op::Add(a, b) => a == register && is_bit(b) || b == register && is_bit(a),
        Op::Sub(a, b) => a == register && is_bit(b),
        Op::Mux { select, high, low } if select == bit && low == register => match netlist.cell(high).op {
            Op::Add(a, b) => a == register && is_const_one(netlist, b) || b == register && is_const_one(netlist, a),
            Op::Sub(a, b) => a == register && is_const_one(netlist, b),
            _ => false,
        },
        _ => false,
    }
}

/// The only value but 0 that a net may have; 0 where it has none, `None` where it may have several.
pub(super) fn only_value(netlist: &Netlist, net: Net) -> Option<u64> {
    match netlist.cell(net).op {
        Op::Const(value) => Some(value),
        _ if netlist.width(net) == Width::ONE => Some(1),
        Op::ZeroExtend(of) => only_value(netlist, of),
        Op::Concat { high, low } => {
            let shift = netlist.width(low).get();
            match [only_value(netlist, high)?, only_value(netlist, low)?] {
                [0, value] => Some(value),
                [value, 0] => Some(value << shift),
                [above, below] => (high == low).then_some(above << shift | below),
            }
        }
        Op::Mux { high, low, .. } => match [only_value(netlist, high)?, only_value(netlist, low)?] {
            [0, value] | [value, 0] => Some(value),
            [a, b] => (a == b).then_some(a),
        },
        _ => None,
    }
}

/// The sums and differences by which a register counts.
pub(super) fn counting(netlist: &Netlist, register: Net, next: Net, found: &mut HashSet<Net>) {
    match netlist.cell(next).op {
        Op::Mux { high, low, .. } => [high, low].into_iter().for_each(|arm| counting(netlist, register, arm, found)),
        Op::Add(a, b) | Op::Sub(a, b) if a == register || b == register => {
            found.insert(next);
        }
        _ => {}
    }
}

/// The directions in which a register moves, down and up, by at most one at a time; `None` where it may do anything.
pub(super) fn moves(netlist: &Netlist, register: Net, next: Net) -> Option<[bool; 2]> {
    if next == register {
        return Some([false, false]);
    }
    let one = |net: Net| is_one(netlist, net);
    match netlist.cell(next).op {
        Op::Mux { high, low, .. } => {
            let [high, low] = [moves(netlist, register, high)?, moves(netlist, register, low)?];
            Some([high[0] | low[0], high[1] | low[1]])
        }
        Op::Add(a, b) if a == register && one(b) || b == register && one(a) => Some([false, true]),
        Op::Sub(a, b) if a == register && one(b) => Some([true, false]),
        _ => None,
    }
}
