//! What lanes run and report: jobs in, ends out.

use super::lane::Lane;
use stepwave_netlist::cells::Net;

/// A number that is gathered while a lane runs, over every sample from 0 to the last, or is read at its end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Observe {
    /// The value in the last sample.
    Last(Net),
    /// The least value, in two's complement if `signed`.
    Min {
        /// The net.
        net: Net,
        /// Two's complement.
        signed: bool,
    },
    /// The greatest value, in two's complement if `signed`.
    Max {
        /// The net.
        net: Net,
        /// Two's complement.
        signed: bool,
    },
    /// Number of samples in which one of the nets is not 0.
    Count(Vec<Net>),
    /// Sum of the values, unsigned.
    Sum {
        /// The net.
        net: Net,
        /// Bits that hold every sum; 64 at most. A sum that needs more is given modulo 2^64 or 2^32.
        bits: u32,
    },
    /// Sum of [`root_gap`] over all samples.
    RootGaps {
        /// The square that all others are compared with, unsigned.
        base: Net,
        /// How much more a square is, in two's complement; with `base` never below 0.
        offset: Net,
        /// As of [`Observe::Sum`].
        bits: u32,
    },
    /// Fewest clocks between a sample in which the net is not 0 and the next such sample; 0 with fewer than two.
    LeastGap(Net),
    /// Most clocks between a sample in which the net is not 0 and the next such sample; 0 with fewer than two.
    GreatestGap(Net),
    /// Clocks from the last sample in which the net was not 0 to the end; [`u64::MAX`] where it never was.
    Since(Net),
}

impl Observe {
    /// The nets that are observed.
    pub fn nets(&self) -> impl Iterator<Item = Net> + '_ {
        let (one, two, many): (Option<Net>, Option<Net>, &[Net]) = match self {
            Observe::Last(net) | Observe::Min { net, .. } | Observe::Max { net, .. } => (Some(*net), None, &[]),
            Observe::Sum { net, .. } | Observe::LeastGap(net) | Observe::GreatestGap(net) | Observe::Since(net) => {
                (Some(*net), None, &[])
            }
            Observe::RootGaps { base, offset, .. } => (Some(*base), Some(*offset), &[]),
            Observe::Count(nets) => (None, None, nets),
        };
        one.into_iter().chain(two).chain(many.iter().copied())
    }
}

/// Units of [`root_gap`] in 1.
pub const ROOT_GAP_UNIT: f64 = 65536.0;

/// |√(base + offset) - √base| in units of 2^-16, to the nearest: the distance of two circles, from their squares. Below
/// 2^36 units it is right to the last; 0 where both numbers are 0.
#[inline(always)]
#[must_use]
pub fn root_gap(base: f64, offset: f64) -> u64 {
    /// What is added to a number below it leaves the number, rounded, in the low bits.
    const WHOLE: f64 = (1u64 << 52) as f64;
    let roots = ((base + offset).sqrt() + base.sqrt()).max(f64::MIN_POSITIVE);
    (offset.abs() / roots * ROOT_GAP_UNIT + WHOLE).to_bits() & ((1 << 52) - 1)
}

/// How an accumulator takes a sample.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Reduce {
    Count,
    Idle,
    Least {
        signed: bool,
    },
    Greatest {
        signed: bool,
    },
    Sum,
    RootGaps,
    /// Of the accumulator `since` with this index.
    LeastGap {
        since: usize,
    },
    GreatestGap {
        since: usize,
    },
    /// Clocks since the net was not 0, negative where it never was.
    Since,
}

impl Reduce {
    /// The word from which any first sample gives the right one.
    pub(super) fn start<T: Lane>(self) -> T {
        match self {
            Reduce::Count | Reduce::Sum | Reduce::RootGaps | Reduce::GreatestGap { .. } => T::number(0),
            Reduce::Greatest { signed: false } => T::number(0),
            Reduce::Idle | Reduce::LeastGap { .. } | Reduce::Least { signed: false } => T::ONES,
            Reduce::Least { signed: true } => T::ONES.right(1),
            Reduce::Greatest { signed: true } | Reduce::Since => T::ONES.right(1).not(),
        }
    }
}

/// When a lane in which nothing happens any more is given up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quiet {
    /// Nets that are not 0 as long as something happens.
    pub nets: Vec<Net>,
    /// This many clocks with all of them 0 are allowed, as long as registers change.
    pub clocks: u64,
    /// A lane is looked at in the samples whose clock plus 1 is a multiple of this; at least 1. With all of the nets 0
    /// for as many clocks it is given up if no register changes at the next edge. (A register that nothing observed
    /// depends on does not count.)
    pub every: u64,
}

/// What is to be observed and what ends a run, fixed before a program is built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneWatch {
    /// 1 bit: 1 in a sample ends a block.
    pub done: Net,
    /// 1 bit each: 1 in a sample ends the job, unless `done` is 1 too.
    pub traps: Vec<Net>,
    /// Inputs that have the same value during every run, and only while a block is loaded another.
    pub rest: Vec<(Net, u64)>,
    /// Numbers that every job gives.
    pub observe: Vec<Observe>,
    /// Gives up lanes that have come to rest.
    pub quiet: Option<Quiet>,
    /// A job ends at the first sample of a run whose clock is at least this.
    pub limit: u64,
}

impl LaneWatch {
    /// Runs until `done`, observes nothing, and ends at clock 2^32 - 2 at the latest.
    #[must_use]
    pub fn new(done: Net) -> LaneWatch {
        let limit = u64::from(u32::MAX) - 1;
        LaneWatch { done, traps: Vec::new(), rest: Vec::new(), observe: Vec::new(), quiet: None, limit }
    }
}

/// What one lane is to do: blocks, one after another, each a list of inputs and their values. An input keeps its value
/// until a block changes it; before that it is 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Job {
    /// Inputs of each block; bits above an input's width are ignored.
    pub blocks: Vec<Vec<(Net, u64)>>,
}

/// Why a job ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LaneStop {
    /// The last block was done.
    Done,
    /// The net `LaneWatch::traps[_]` of this index was 1, the first of those that were.
    Trap(usize),
    /// Nothing happened for this many clocks.
    Quiet {
        /// Clocks since one of the nets was not 0.
        clocks: u64,
    },
    /// The limit was reached.
    Limit,
}

/// How a job ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LaneEnd {
    /// Why.
    pub stop: LaneStop,
    /// Clock of the last sample.
    pub clock: u64,
    /// The numbers asked for, in the order of `LaneWatch::observe`.
    pub values: Vec<u64>,
}
