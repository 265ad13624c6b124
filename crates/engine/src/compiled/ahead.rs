//! Looking ahead: native loops that record nothing, and what a digest is put together from.

use fearless_simd::Level;

use super::Compiled;
use super::codegen::Plan;
use super::layout::{FormFrom, RangeFrom, TrainFrom};
use super::native::Digester;
use super::scan::{self, Found, Operand};
use super::specialise::{END, Specialised};
use crate::digest::{Digest, Form, Term};
use crate::{Ahead, Engine, Extremes};
use stepwave_netlist::cells::{Net, Netlist};

/// Vector units compare signed numbers; with the highest bit inverted they are in the order of the unsigned ones.
const HIGHEST: u64 = 1 << 63;

/// The loops of a variant that make digests.
pub(super) struct Digests {
    specialised: Specialised,
    /// Counters that are to be greater than [`END`] in all samples.
    far: Vec<Net>,
    /// That which begins after each phase; `None` before it is compiled.
    loops: Vec<Option<DigestLoop>>,
    /// None can be compiled.
    unavailable: bool,
}

/// A digest whose last registers are in the state.
pub(super) struct LookedAt {
    variant: usize,
    clocks: u64,
}

/// A loop and how its lanes are looked at.
struct DigestLoop {
    digester: Digester,
    level: Level,
}

impl Digests {
    /// Those of a variant; a net of `never` that is 1 ends a digest.
    pub(super) fn of(
        mut specialised: Specialised,
        netlist: &Netlist,
        registers: &[(Net, Net)],
        never: &[Net],
    ) -> Digests {
        let far = specialised.settle(netlist, registers, never);
        let loops = specialised.phases.iter().map(|_| None).collect();
        Digests { specialised, far, loops, unavailable: false }
    }
}

impl DigestLoop {
    /// Extremes of values that are compared as unsigned numbers with the bits of `turned` inverted.
    fn narrow(&self, lane: usize, turned: u64) -> Found<u64> {
        // No bit of a register of a narrow lane is above the 32nd.
        let turned = u32::try_from(turned).unwrap_or(0);
        let found = scan::extremes(self.level, self.digester.narrow(lane), turned);
        Found {
            least: found.least.into(),
            greatest: found.greatest.into(),
            any: found.any.into(),
            all: found.all.into(),
        }
    }

    fn wide(&self, lane: usize, turned: u64) -> Found<u64> {
        let found = scan::extremes(self.level, self.digester.wide(lane), (turned ^ HIGHEST).cast_signed());
        let unsigned = |value: i64| value.cast_unsigned() ^ HIGHEST;
        // Where the highest bit is inverted, it was 1 in any value where it was not 1 in all inverted ones.
        let mixed = |low: i64, high: i64| low.cast_unsigned() & !HIGHEST | !high.cast_unsigned() & HIGHEST;
        Found {
            least: unsigned(found.least),
            greatest: unsigned(found.greatest),
            any: mixed(found.any, found.all),
            all: mixed(found.all, found.any),
        }
    }

    /// Extremes of a register that was `before` in the sample before the digest and is `after` in its last.
    fn range(&self, from: &RangeFrom, turned: u64, [before, after]: [u64; 2], trains: &[Vec<u64>]) -> Extremes {
        let first = before ^ turned;
        let found = |least: u64, greatest: u64, any: u64, all: u64| Extremes {
            least: least.min(first),
            greatest: greatest.max(first),
            first,
            toggled: any & !first | !all & first,
        };
        let start = found(first, first, first, first);
        match from {
            RangeFrom::Values(values) => values
                .iter()
                .map(|value| value ^ turned)
                .map(|value| found(value, value, value, value))
                .fold(start, Extremes::and),
            RangeFrom::Train { train, value } => {
                let full = u64::MAX >> (64 - self.digester.layout.span);
                let is_set = trains[*train].iter().any(|&word| word != 0);
                let is_clear = trains[*train].iter().any(|&word| word != full);
                let seen = [(is_set, value ^ turned), (is_clear, turned)].into_iter().filter(|(seen, _)| *seen);
                let each = seen.map(|(_, value)| found(value, value, value, value));
                each.fold(start, Extremes::and)
            }
            RangeFrom::Counter { .. } => {
                let last = after ^ turned;
                // It takes every value between the two: all bits up to the highest that differs change.
                let toggled = (first ^ last).checked_ilog2().map_or(0, |bit| u64::MAX >> (63 - bit));
                Extremes { least: first.min(last), greatest: first.max(last), first, toggled }
            }
            RangeFrom::Narrow(lanes) => {
                let each = lanes.iter().map(|&lane| self.narrow(lane, turned));
                each.fold(start, |all, of| all.and(found(of.least, of.greatest, of.any, of.all)))
            }
            RangeFrom::Wide(lanes) => {
                let each = lanes.iter().map(|&lane| self.wide(lane, turned));
                each.fold(start, |all, of| all.and(found(of.least, of.greatest, of.any, of.all)))
            }
        }
    }

    /// Puts the trains of the last call into a digest; `before` is what a net was in the sample before. The first sample is
    /// the highest bit of a word that the code stores.
    fn trains(&self, digest: &mut Digest, before: impl Fn(Net) -> u64) {
        let (layout, words) = (&self.digester.layout, self.digester.words());
        digest.span = layout.span;
        digest.trains.resize(layout.trains.len(), Vec::new());
        for (index, from) in layout.trains.iter().enumerate() {
            let (earlier, rest) = digest.trains.split_at_mut(index);
            let train = &mut rest[0];
            train.clear();
            match *from {
                TrainFrom::Pattern(word) => train.resize(layout.words, word),
                TrainFrom::Inverted { of, bits } => train.extend(earlier[of].iter().map(|word| word ^ bits)),
                TrainFrom::Stored(index) => {
                    train.resize(layout.words, 0);
                    scan::turned_over(self.level, &words[index..], layout.stored, 64 - layout.span, train);
                }
                TrainFrom::Moved { counter, lane, .. } => {
                    // A counter of a narrow lane.
                    let mut before = u32::try_from(before(counter)).unwrap_or(0);
                    train.extend(self.digester.narrow(lane).as_chunks::<64>().0.iter().map(|values| {
                        let word = scan::changes(self.level, values, before);
                        before = values[63];
                        word
                    }));
                }
            }
        }
    }

    /// The extremes of a form of these terms.
    fn form(&self, form: &Form, from: &FormFrom, netlist: &Netlist) -> [i64; 2] {
        let both = |[least, greatest]: [i64; 2], [less, more]: [i64; 2]| [least.min(less), greatest.max(more)];
        let none = [i64::MAX, i64::MIN];
        match (from, form.terms()) {
            (FormFrom::Pairs(pairs), [a, b]) => {
                let operand = |term: &Term, lane: usize| Operand {
                    values: self.digester.narrow(lane),
                    bits: netlist.width(term.net).get(),
                    linear: i32::try_from(term.linear).unwrap_or(0),
                    squared: term.square != 0,
                };
                let each = pairs.iter().map(|&[x, y]| scan::form(self.level, [operand(a, x), operand(b, y)]));
                each.fold(none, both)
            }
            (FormFrom::Wide(lanes), _) => {
                let each = lanes.iter().map(|&lane| scan::extremes(self.level, self.digester.wide(lane), 0));
                each.fold(none, |ends, of| both(ends, [of.least, of.greatest]))
            }
            (FormFrom::Pairs(_), _) => none,
        }
    }
}

impl Compiled {
    /// The variant that can make a digest from the present sample on, and the phase of that sample.
    fn digesting_variant(&self) -> Option<(usize, usize)> {
        let mut usable = self.variants.iter().enumerate().filter(|(_, variant)| {
            variant.clocks >= self.warm_up && !variant.is_poor(self.patience) && self.holds(&variant.inputs)
        });
        usable.find_map(|(index, variant)| {
            let digests = variant.digests.as_ref().filter(|digests| !digests.unavailable)?;
            let phase = digests.specialised.phases.iter().position(|phase| self.holds(&phase.fixed))?;
            Some((index, phase))
        })
    }

    /// Compiles the loop of a variant that begins after a phase.
    fn compile_digests(&mut self, variant: usize, phase: usize) {
        let (Some(wanted), Some(digests)) = (&self.wanted, &mut self.variants[variant].digests) else { return };
        let memories = self.word.memories().places().to_vec();
        let first = (phase + 1) % digests.specialised.phases.len();
        digests.specialised.phases.rotate_left(first);
        let plan = Plan {
            entry: &digests.specialised.entry,
            phases: &digests.specialised.phases,
            registers: &self.registers,
            memories: &memories,
            inputs: self.design.inputs(),
            columns: &[],
            stride: 0,
            stops: &self.watch.stops,
            running: &[],
            flags: &[],
            branches: None,
        };
        let digester = Digester::compile(&plan, wanted);
        digests.specialised.phases.rotate_right(first);
        digests.unavailable = digester.is_none();
        digests.loops[phase] = digester.map(|digester| DigestLoop { digester, level: Level::new() });
    }

    /// What the next samples come to.
    pub(super) fn digest(&mut self, clocks: u64, digest: &mut Digest) -> Ahead {
        self.ahead = None;
        if self.word.input_pending() || self.idle.is_some() {
            return Ahead::NotNow;
        }
        let Some((variant, phase)) = self.digesting_variant() else { return Ahead::NotNow };
        if self.variants[variant].digests.as_ref().is_some_and(|digests| digests.loops[phase].is_none()) {
            self.compile_digests(variant, phase);
        }
        self.load_state();
        let (Some(wanted), Some(digests)) = (&self.wanted, &mut self.variants[variant].digests) else {
            return Ahead::NotNow;
        };
        let Some(native) = &mut digests.loops[phase] else { return Ahead::NotNow };
        let length = native.digester.layout.clocks();
        if clocks < length {
            return Ahead::NotNow;
        }
        let word = &mut self.word;
        let is_near = digests.far.iter().any(|&counter| word.value(counter) <= length + END);
        let mut ranges = wanted.ranges.iter().zip(&native.digester.layout.ranges);
        let ends = ranges.any(|(&(net, turned), from)| match *from {
            RangeFrom::Counter { up } => {
                let (now, most) = (word.value(net) ^ turned, self.design.netlist().width(net).mask());
                // At the end of its range its flag may be 1 in that very sample.
                length >= if up { most - now } else { now }
            }
            _ => false,
        });
        if is_near || ends || !native.digester.call(&mut self.state, word.memories().words_mut()) {
            return Ahead::Eventful;
        }
        (digest.first_clock, digest.clocks) = (word.clock() + 1, length);
        self.ahead = Some(LookedAt { variant, clocks: length });
        self.fill(variant, phase, digest);
        Ahead::Digest
    }

    fn fill(&mut self, variant: usize, phase: usize, digest: &mut Digest) {
        let (Some(wanted), Some(digests)) = (&self.wanted, &mut self.variants[variant].digests) else { return };
        let Some(native) = &mut digests.loops[phase] else { return };
        native.trains(digest, |net| self.word.value(net));
        for (train, from) in digest.trains.iter().zip(&native.digester.layout.trains) {
            // What the code did not carry.
            if let TrainFrom::Moved { register: Some((place, value)), .. } = *from {
                let is_set = train.last().is_some_and(|word| word >> 63 == 1);
                self.state[place] = if is_set { value } else { 0 };
            }
        }
        digest.ranges.clear();
        for (&(net, turned), from) in wanted.ranges.iter().zip(&native.digester.layout.ranges) {
            let before = self.word.value(net);
            let place = self.registers.iter().position(|&(register, _)| register == net);
            let after = place.map_or(before, |place| self.state[place]);
            digest.ranges.push(native.range(from, turned, [before, after], &digest.trains));
        }
        let forms = wanted.forms.iter().zip(&native.digester.layout.forms);
        digest.forms.clear();
        digest.forms.extend(forms.map(|(form, from)| native.form(form, from, self.design.netlist())));
    }

    /// Continues to the last sample of the digest.
    pub(super) fn accept(&mut self) {
        let Some(LookedAt { variant, clocks }) = self.ahead.take() else { return };
        self.word.continue_from(clocks, &self.state[..self.registers.len()]);
        self.variants[variant].clocks += clocks;
    }
}
