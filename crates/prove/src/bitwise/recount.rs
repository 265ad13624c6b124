//! The second opinion on a block whose coefficients are unknown: its pulses counted one by one, each by the one bit of
//! a coefficient that lets it through.
//!
//! It shares nothing with `follow` but the question. The netlist runs in three-valued logic (`three_valued`): with all
//! coefficients unknown, which shows when the block ends and which pulses are sure to come or to stay away; and once
//! more for each bit of a coefficient, with that bit 0 and with it 1, all others unknown. A pulse that is absent in one
//! case and present in the other is that bit's, regardless of the others. Last, the counter of each axis is cut out
//! after its pulse: from every place that the pulses so far can lead to, it must count one pulse as one, and nothing
//! may overflow.

use super::follow::{Followed, LoadWord, Lost, Sum};
use super::three_valued::{Bit, ThreeValued};
use crate::Strobes;
use stepwave_netlist::Design;
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Op};

/// Nets of an axis.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AxisNets {
    /// Register, 2 bits, signed: the pulse with which the position changed.
    pub pulse: Net,
    /// Register, signed: the place of the axis in BLU.
    pub position: Net,
}

/// Bits that are examined in one run: two lanes each, and one in which nothing is.
const AT_ONCE: usize = 31;
/// The lane in which all are unknown.
const NONE: u64 = 1 << 63;

/// What lets a pulse through.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Cause {
    /// It is not there.
    Never,
    /// It comes for all coefficients.
    Always(i8),
    /// It comes where this unknown bit is 1.
    Bit(usize, i8),
    /// That is not known yet.
    Open,
}

/// One axis over a block.
#[derive(Clone, Debug, Default)]
struct Axis {
    /// Its place after the load.
    start: Option<i128>,
    /// By clock, from 2 on.
    pulses: Vec<Cause>,
}

/// Follows a block as [`follow`](super::follow) does, by counting the pulses of its axes. `ends` are their places in
/// the end.
///
/// # Errors
/// See [`Lost`].
pub fn recount(
    design: &Design,
    strobes: Strobes,
    words: &[(Net, LoadWord)],
    axes: &[AxisNets],
    limit: u64,
) -> Result<Followed, Lost> {
    let netlist = design.netlist();
    let unknown = words.iter().filter(|(_, word)| *word == LoadWord::Unknown);
    let unknowns: usize = unknown.map(|(net, _)| netlist.width(*net).get() as usize).sum();
    let mut block =
        Recount { design, strobes, words, nets: axes, open: vec![false; netlist.properties.len()], seen: None };
    let mut found = vec![Axis::default(); axes.len()];
    let mut clocks = 0;
    for first in (0..unknowns.max(1)).step_by(AT_ONCE) {
        clocks = block.run(first, limit, &mut found)?;
    }
    let mut ends = Vec::new();
    for (axis, nets) in found.iter().zip(axes) {
        let sum = axis.sum(unknowns)?;
        block.counts(nets, axis)?;
        ends.push(Some(sum));
    }
    match block.open.iter().position(|open| *open) {
        None => Ok(Followed { clocks, ends }),
        Some(claim) => Err(Lost::Claim { claim: netlist.properties[claim].name.clone(), clock: clocks }),
    }
}

impl Axis {
    /// Its place in the end.
    fn sum(&self, unknowns: usize) -> Result<Sum, Lost> {
        let mut sum = Sum { constant: self.start.ok_or(Lost::Start)?, factors: vec![0; unknowns] };
        for (clock, cause) in (2..).zip(&self.pulses) {
            match *cause {
                Cause::Never => {}
                Cause::Always(sign) => sum.constant += i128::from(sign),
                Cause::Bit(bit, sign) => sum.factors[bit] += i128::from(sign),
                Cause::Open => return Err(Lost::Pulse { clock }),
            }
        }
        Ok(sum)
    }

    /// Pulses forwards and backwards, at most.
    fn most(&self) -> [i128; 2] {
        let is = |wanted: i8| {
            let mine = |cause: &&Cause| matches!(**cause, Cause::Always(sign) | Cause::Bit(_, sign) if sign == wanted);
            i128::try_from(self.pulses.iter().filter(mine).count()).unwrap_or(i128::MAX)
        };
        [is(1), is(-1)]
    }
}

struct Recount<'b> {
    design: &'b Design,
    strobes: Strobes,
    words: &'b [(Net, LoadWord)],
    nets: &'b [AxisNets],
    /// Claims that are not known to hold for all places of the axes.
    open: Vec<bool>,
    /// What registers may hold in any sample after the load.
    seen: Option<ThreeValued<'b>>,
}

impl<'b> Recount<'b> {
    /// One run that examines the unknown bits from `first` on; returns its clocks.
    fn run(&mut self, first: usize, limit: u64, axes: &mut [Axis]) -> Result<u64, Lost> {
        let netlist = self.design.netlist();
        let mut sample = ThreeValued::new(self.design);
        let mut place = 0;
        for (net, word) in self.words {
            match *word {
                LoadWord::Known(word) => sample.set(*net, word),
                LoadWord::Unknown => {
                    for bit in sample.of_mut(*net) {
                        if let Some(lane) = (first..first + AT_ONCE).position(|examined| examined == place) {
                            let [is_zero, is_one] = [1 << (2 * lane), 2 << (2 * lane)];
                            *bit = Bit { zero: !is_one, one: !is_zero };
                        }
                        place += 1;
                    }
                }
            }
        }
        self.strobes(&mut sample, 1);
        for clock in 0..=limit {
            sample.settle(None);
            for (property, open) in netlist.properties.iter().zip(&mut self.open) {
                let never = sample.of(property.never)[0];
                if clock == 0 && never.is_zero() & NONE == 0 {
                    return Err(Lost::Claim { claim: property.name.clone(), clock });
                }
                *open |= never.is_zero() & NONE == 0;
            }
            if clock > 0 {
                self.see(&sample);
                self.pulses(&sample, clock, first, axes);
                let done = sample.of(self.strobes.done)[0];
                if done.is_one() & NONE != 0 {
                    return Ok(clock);
                }
                if done.is_zero() & NONE == 0 {
                    return Err(Lost::End { clock });
                }
            }
            sample.edge();
            if clock == 0 {
                // After the load the words may be anything.
                self.design.inputs().iter().for_each(|input| sample.of_mut(*input).fill(Bit::X));
                self.strobes(&mut sample, 0);
            }
        }
        Err(Lost::Endless { clocks: limit })
    }

    fn strobes(&self, sample: &mut ThreeValued<'_>, value: u64) {
        for strobe in [self.strobes.load, self.strobes.preset_position] {
            sample.set(strobe, value);
        }
    }

    /// Widens what was seen by a sample.
    fn see(&mut self, sample: &ThreeValued<'b>) {
        let none = Bit { zero: 0, one: 0 };
        let seen = self.seen.get_or_insert_with(|| {
            let mut nothing = ThreeValued::new(self.design);
            self.design.registers().iter().for_each(|register| nothing.of_mut(*register).fill(none));
            nothing
        });
        for register in self.design.registers() {
            let new = sample.of(*register).iter().map(|bit| bit.everywhere(NONE));
            seen.of_mut(*register).iter_mut().zip(new).for_each(|(bit, new)| *bit = bit.or_as(new));
        }
    }

    /// Puts down the pulses with which the places came to this sample.
    fn pulses(&self, sample: &ThreeValued<'_>, clock: u64, first: usize, axes: &mut [Axis]) {
        for (axis, nets) in axes.iter_mut().zip(self.nets) {
            if clock == 1 {
                axis.start = number(sample.of(nets.position), NONE);
                continue;
            }
            let [low, high] = [0, 1].map(|place| sample.of(nets.pulse)[place]);
            let never = low.is_zero() & high.is_zero();
            let signs = [(1, low.is_one() & high.is_zero()), (-1, low.is_one() & high.is_one())];
            let index = usize::try_from(clock - 2).unwrap_or(usize::MAX);
            if index == axis.pulses.len() {
                let sure = signs.iter().find(|(_, lanes)| lanes & NONE != 0);
                let open = if never & NONE != 0 { Cause::Never } else { Cause::Open };
                axis.pulses.push(sure.map_or(open, |(sign, _)| Cause::Always(*sign)));
            }
            if axis.pulses.get(index) == Some(&Cause::Open) {
                // Not with the bit 0, which is an even lane, and with it 1, the lane above.
                let deciding_bit =
                    |lanes: u64| (lanes >> 1 & never & 0x5555_5555_5555_5555 & !NONE).trailing_zeros() as usize / 2;
                if let Some((sign, lanes)) = signs.iter().find(|(_, lanes)| deciding_bit(*lanes) < AT_ONCE) {
                    axis.pulses[index] = Cause::Bit(first + deciding_bit(*lanes), *sign);
                }
            }
        }
    }

    /// The counter of an axis, cut out after its pulse, counts each as one from any value it may have, and no claim
    /// about it is violated: these claims are open no more.
    fn counts(&mut self, nets: &AxisNets, axis: &Axis) -> Result<(), Lost> {
        let netlist = self.design.netlist();
        let wrong = || Lost::Counter { position: netlist.describe(nets.position) };
        let [Some(pulse), Some(position)] =
            [nets.pulse, nets.position].map(|register| match netlist.cell(register).op {
                Op::Register { next, .. } => next,
                _ => None,
            })
        else {
            return Err(wrong());
        };
        // Its lowest bit is that there is a pulse.
        let mut cut = pulse;
        while let Op::Concat { low, .. } = netlist.cell(cut).op {
            cut = low;
        }
        let (Some(start), Some(mut sample), [forwards, backwards]) = (axis.start, self.seen.clone(), axis.most())
        else {
            return Err(wrong());
        };
        if netlist.width(cut).get() != 1 || forwards > 0 && backwards > 0 {
            return Err(wrong());
        }
        let sign = if backwards > 0 { -1 } else { 1 };
        let most = forwards + backwards;
        // From every place without a pulse, and with one from all but the last.
        let states: Vec<(i128, bool)> =
            (0..=most).map(|ahead| (ahead, false)).chain((0..most).map(|ahead| (ahead, true))).collect();
        let mut closed = self.open.clone();
        self.design.inputs().iter().for_each(|input| sample.of_mut(*input).fill(Bit::X));
        self.strobes(&mut sample, 0);
        for states in states.chunks(64) {
            let place = |(ahead, _): &(i128, bool)| start + sign * ahead;
            let lanes = |is: &dyn Fn(&(i128, bool)) -> bool| {
                let all = states.iter().enumerate();
                all.fold(0_u64, |lanes, (lane, state)| lanes | u64::from(is(state)) << lane)
            };
            let all = lanes(&|_| true);
            for (bit, held) in sample.of_mut(nets.position).iter_mut().enumerate() {
                *held = Bit::known(lanes(&|state| place(state) >> bit & 1 == 1));
            }
            sample.of_mut(cut)[0] = Bit::known(lanes(&|state| state.1));
            sample.settle(Some(cut));
            let width = netlist.width(nets.position);
            for (lane, state) in states.iter().enumerate() {
                let [stepped, moved] = [pulse, position].map(|net| number(sample.of(net), 1 << lane));
                let expected = if state.1 { sign } else { 0 };
                if stepped != Some(expected) || moved != Some(place(state) + expected) || !holds(width, place(state)) {
                    return Err(wrong());
                }
            }
            for (property, open) in netlist.properties.iter().zip(&mut closed) {
                *open &= sample.of(property.never)[0].is_zero() & all == all;
            }
        }
        self.open.iter_mut().zip(closed).for_each(|(open, closed)| *open &= !closed);
        Ok(())
    }
}

/// A register of this width holds this number, in two's complement.
fn holds(width: Width, number: i128) -> bool {
    let (least, most) = width.range(true);
    (least..=most).contains(&number)
}

/// The number of these bits in a lane, in two's complement, if all are known.
fn number(bits: &[Bit], lane: u64) -> Option<i128> {
    let mut number = 0;
    for (place, bit) in bits.iter().enumerate() {
        let is_one = bit.is_one() & lane != 0;
        if !is_one && bit.is_zero() & lane == 0 {
            return None;
        }
        let weight = if place + 1 == bits.len() { -(1_i128 << place) } else { 1 << place };
        number += if is_one { weight } else { 0 };
    }
    Some(number)
}
