//! Pulse trains: how far apart the pulses of each axis are, and how far each axis is off a uniform rate.

use fearless_simd::{Level, dispatch};
use serde_json::json;
use stepwave_engine::{Digest, Rows, Wanted};
use stepwave_nc::Curve;

use super::ahead::{self, StepTrains};
use super::checkpoint::{GREATEST, Memory, recalled};
use super::{Observer, ObserverError, StepColumns, Testbench};
use reach::Reach;
use totals::Totals;

mod reach;
mod totals;

/// Samples looked at together.
const SPAN: usize = 64;

/// The pulses of one axis in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct PulseTrain {
    /// Least and greatest distance of a pulse from the one before it, in clocks; `None` with less than two pulses.
    pub spacing: Option<[u64; 2]>,
    /// The distance in clocks, were the pulses evenly spread over the clocks of the run: of lines whose steps are
    /// known.
    pub ideal_spacing: Option<f64>,
    /// How far the axis was off a uniform rate: of lines whose steps are known.
    pub deviation: Option<RateDeviation>,
}

/// The greatest distance of an axis from where a uniform rate would have brought it after the same step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateDeviation {
    /// abs(p - t·M/T) in pulses, where p of the M pulses of a line were made in t of its T steps.
    pub pulses: f64,
    /// The first step t after which it was so great.
    pub step: u64,
}

/// What is known of an axis so far.
#[derive(Clone, Debug)]
struct Train {
    /// Steps of the line and travel of the axis, which is not longer; `None` where the axis has no constant rate.
    rate: Option<(i64, i64)>,
    /// Pulses so far.
    pulses: u64,
    /// Clock of the last pulse.
    last: Option<u64>,
    /// Least and greatest distance, in this order once there was one.
    spacing: [u64; 2],
    /// Distances less than the least, and up to the greatest.
    closer: Reach,
    usual: Reach,
    /// The first pulses and steps with which the axis was farthest off, and how far, as [`off`](Train::off) says.
    worst: (u64, u64),
    greatest: u128,
    /// What eight samples make of it that complete a step each, by the bits of their pulses; empty where the numbers are
    /// too large for it, or the axis has no constant rate.
    octets: Vec<Octet>,
}

/// How far eight steps move an axis off the uniform rate, as [`Train::off`] counts: in all, and at least and at most right
/// before one of their pulses.
#[derive(Clone, Copy, Debug)]
struct Octet {
    least: i64,
    greatest: i64,
    all: i64,
}

/// Steps of a line up to which octets are used: eight words of them stay below [`NO_PULSE`].
const OCTET_STEPS: i64 = 1 << 48;
/// What an octet without a pulse has as its least number.
const NO_PULSE: i64 = 1 << 60;

/// The octets of an axis, by the bits of its pulses.
fn octets(rate: Option<(i64, i64)>) -> Vec<Octet> {
    let Some((all, travel)) = rate.filter(|(all, _)| *all <= OCTET_STEPS) else { return Vec::new() };
    let octet = |pulses: u32| {
        let (least, greatest, end) = (0..8).fold((NO_PULSE, -NO_PULSE, 0), |(least, greatest, off), sample| {
            let is_pulse = pulses >> sample & 1 == 1;
            let ends = if is_pulse { (off.min(least), off.max(greatest)) } else { (least, greatest) };
            (ends.0, ends.1, off + if is_pulse { all - travel } else { -travel })
        });
        Octet { least, greatest, all: end }
    };
    (0..256).map(octet).collect()
}

impl Train {
    fn new(rate: Option<(i64, i64)>, octets: Vec<Octet>) -> Train {
        let spacing = [u64::MAX, 0];
        let [closer, usual] = [spacing[0] - 1, spacing[1]].map(Reach::up_to);
        Train { rate, pulses: 0, last: None, spacing, closer, usual, worst: (0, 0), greatest: 0, octets }
    }

    /// How far off the uniform rate the axis is after these pulses and steps, times the steps of the line.
    fn off(&self, pulses: u64, steps: u64) -> i128 {
        let (all, travel) = self.rate.unwrap_or_default();
        i128::from(pulses) * i128::from(all) - i128::from(travel) * i128::from(steps)
    }

    fn compare_at(&mut self, pulses: u64, steps: u64) {
        let off = self.off(pulses, steps).unsigned_abs();
        if off > self.greatest {
            (self.greatest, self.worst) = (off, (pulses, steps));
        }
    }

    /// The distances of pulses, a bit each, in the samples from a clock on.
    #[inline(always)]
    fn space(&mut self, pulses: u64, clock: u64) {
        let at = |index: u32| clock + u64::from(index);
        if let Some(last) = self.last {
            self.apart(at(pulses.trailing_zeros()).saturating_sub(last));
        }
        self.last = Some(at(pulses.ilog2()));
        let later = pulses & (pulses - 1);
        // Most samples hold no distance that is new.
        if later & (self.closer.of(pulses) | !self.usual.of(pulses)) != 0 {
            let (mut before, mut rest) = (pulses.trailing_zeros(), later);
            while rest != 0 {
                let index = rest.trailing_zeros();
                self.apart(u64::from(index - before));
                (before, rest) = (index, rest & (rest - 1));
            }
        }
    }

    #[inline(always)]
    fn apart(&mut self, clocks: u64) {
        let [least, greatest] = self.spacing;
        if clocks < least || clocks > greatest {
            self.set_spacing([least.min(clocks), greatest.max(clocks)]);
        }
    }

    fn set_spacing(&mut self, spacing: [u64; 2]) {
        (self.spacing, self.closer, self.usual) =
            (spacing, Reach::up_to(spacing[0].saturating_sub(1)), Reach::up_to(spacing[1]));
    }

    /// Measures the axis right before each of these pulses, a bit each, and right after it: only there can it be
    /// farther off than ever. `stepped` has a bit for each sample that completes a step, `steps` are those before.
    #[inline(always)]
    fn measure(&mut self, pulses: u64, stepped: u64, steps: u64) {
        let Some((all, travel)) = self.rate else { return };
        let done = |index: u32| u64::from((stepped & !(u64::MAX << index)).count_ones());
        let before = self.off(self.pulses, steps);
        let [least, greatest] = self.ends(pulses, stepped, (all, travel));
        let (least, greatest) = (before + i128::from(least), before + i128::from(greatest + all - travel));
        if least.unsigned_abs().max(greatest.unsigned_abs()) > self.greatest {
            let (mut count, mut rest) = (self.pulses, pulses);
            while rest != 0 {
                let steps = steps + done(rest.trailing_zeros());
                self.compare_at(count, steps);
                self.compare_at(count + 1, steps + 1);
                (count, rest) = (count + 1, rest & (rest - 1));
            }
        }
    }

    /// How far the axis is off right before one of these pulses, at least and at most, beyond what it was off before them.
    #[inline(always)]
    fn ends(&self, pulses: u64, stepped: u64, (all, travel): (i64, i64)) -> [i64; 2] {
        if let Some(octets) = self.octets.first_chunk::<256>() {
            if stepped == u64::MAX {
                return through(octets, &pulses.to_le_bytes(), 0);
            }
            if let Some((rounds, stepped_before)) = rounds(pulses, stepped) {
                let off = if stepped_before { -travel } else { 0 };
                return through(octets, &rounds.to_le_bytes(), off);
            }
        }
        let done = |index: u32| u64::from((stepped & !(u64::MAX << index)).count_ones());
        // Both are far below 2^63: all of a line, at most 2^56, in each of 64 samples.
        let (mut least, mut greatest, mut made, mut rest) = (i64::MAX, i64::MIN, 0, pulses);
        while rest != 0 {
            let off = made - travel * done(rest.trailing_zeros()).cast_signed();
            (least, greatest, made) = (least.min(off), greatest.max(off), made + all);
            rest &= rest - 1;
        }
        [least, greatest]
    }

    /// Takes words of samples, `span` to a word, from a clock on: a bit for each in which the axis pulses, or which completes a
    /// step; `steps` are those before. `measured`: nobody knows yet that the axis is not farther off the uniform rate than
    /// it was.
    #[inline(always)]
    fn take(&mut self, [pulses, stepped]: [&[u64]; 2], (clock, span): (u64, usize), steps: u64, measured: bool) {
        if span == SPAN && self.is_as_before(pulses, clock) {
            self.last = last(pulses, (clock, span)).or(self.last);
        } else {
            let words = pulses.iter().zip((clock..).step_by(span)).filter(|(word, _)| **word != 0);
            words.for_each(|(word, clock)| self.space(*word, clock));
        }
        if measured && self.rate.is_some() && !self.is_no_farther([pulses, stepped], steps) {
            let mut steps = steps;
            for (&pulses, &stepped) in pulses.iter().zip(stepped) {
                if pulses != 0 {
                    self.measure(pulses, stepped, steps);
                }
                self.pulses += u64::from(pulses.count_ones());
                steps += u64::from(stepped.count_ones());
            }
        } else {
            self.pulses += ahead::count(pulses);
        }
    }

    /// In these words, at most [`SPAN`] of them, each sample completes a step, and the axis is nowhere farther off the uniform
    /// rate than it was; `steps` are those before. False where that is not known.
    #[inline(always)]
    fn is_no_farther(&self, [pulses, stepped]: [&[u64]; 2], steps: u64) -> bool {
        let (Some((all, travel)), Some(octets)) = (self.rate, self.octets.first_chunk::<256>()) else { return false };
        let begun = i64::try_from(self.off(self.pulses, steps)).ok().filter(|off| off.unsigned_abs() < 1 << 60);
        let Some(mut off) = begun.filter(|_| pulses.len() <= SPAN) else { return false };
        // No more than 2^60 is added to it.
        let (mut least, mut greatest, mut every) = (i64::MAX, i64::MIN, u64::MAX);
        for (word, stepped) in pulses.iter().zip(stepped) {
            every &= stepped;
            for octet in word.to_le_bytes() {
                let octet = octets[usize::from(octet)];
                least = least.min(off.wrapping_add(octet.least));
                greatest = greatest.max(off.wrapping_add(octet.greatest));
                off = off.wrapping_add(octet.all);
            }
        }
        let after = greatest.wrapping_add(all - travel);
        every == u64::MAX && u128::from(least.unsigned_abs().max(after.unsigned_abs())) <= self.greatest
    }

    /// No distance of pulses in these words, the first of which begins with this clock, is new.
    #[inline(always)]
    fn is_as_before(&self, words: &[u64], clock: u64) -> bool {
        let Some((&first, _)) = words.split_first() else { return true };
        let after =
            self.last.and_then(|last| clock.checked_sub(last)).filter(|after| (1..=SPAN as u64).contains(after));
        let Some(after) = after else { return false };
        let odd = |before: u64, word: u64| word & (self.closer.after(before, word) | !self.usual.after(before, word));
        let mut all = odd(1 << (SPAN as u64 - after), first);
        for (&before, &word) in words.iter().zip(&words[1..]) {
            all |= odd(before, word);
        }
        all == 0
    }

    // Counts of clocks and pulses are far below 2^53.
    #[allow(clippy::cast_precision_loss)]
    fn finish(&self, steps: u64, clocks: u64) -> PulseTrain {
        let rate = self.rate.map(|(all, travel)| (all as f64, travel as f64));
        let even = rate.filter(|&(_, travel)| travel > 0.0 && steps > 0);
        PulseTrain {
            spacing: (self.spacing[0] <= self.spacing[1]).then_some(self.spacing),
            ideal_spacing: even.map(|(all, travel)| clocks as f64 * all / (steps as f64 * travel)),
            deviation: rate.map(|(all, _)| RateDeviation { pulses: self.greatest as f64 / all, step: self.worst.1 }),
        }
    }
}

/// Watches the pulses of every axis.
pub struct SpacingWatch {
    columns: StepColumns,
    /// Where a digest has them.
    digested: StepTrains,
    seen: Seen,
    /// Clock after which the first block was loaded.
    loaded: Option<u64>,
    totals: Option<Totals>,
    level: Level,
    /// Pulses of each axis in the samples that are looked at.
    pulses: Vec<u64>,
}

/// What was seen of all axes.
struct Seen {
    trains: Vec<Train>,
    /// Steps completed.
    steps: u64,
    /// Clock after which the last step was completed.
    stepped: u64,
}

impl Seen {
    /// Takes words of samples, `span` to a word, from a clock on.
    #[inline(always)]
    fn take<'w>(
        &mut self,
        pulses: impl Fn(usize) -> &'w [u64],
        stepped: &[u64],
        (clock, span): (u64, usize),
        measured: bool,
    ) {
        for (axis, train) in self.trains.iter_mut().enumerate() {
            train.take([pulses(axis), stepped], (clock, span), self.steps, measured);
        }
        self.steps += ahead::count(stepped);
        self.stepped = last(stepped, (clock, span)).unwrap_or(self.stepped);
    }
}

impl SpacingWatch {
    /// Of a machine on this curve.
    #[must_use]
    pub fn new(bench: &Testbench, curve: &Curve) -> SpacingWatch {
        let ends = curve.from().iter().zip(curve.to());
        let travels: Vec<u64> = ends.map(|(from, to)| to.abs_diff(*from)).collect();
        // A line of more steps comes to no end.
        let steps = bench.hardware().steps(&travels).and_then(|steps| i64::try_from(steps).ok());
        let steps = steps.filter(|steps| (1..=1 << 56).contains(steps));
        let train = |&travel: &u64| {
            let rate = steps.zip(i64::try_from(travel).ok()).filter(|(steps, travel)| travel <= steps);
            Train::new(rate, octets(rate))
        };
        SpacingWatch {
            columns: StepColumns::of(bench),
            digested: StepTrains::default(),
            seen: Seen { trains: travels.iter().map(train).collect(), steps: 0, stepped: 0 },
            loaded: None,
            totals: Totals::of(bench, curve),
            level: Level::new(),
            pulses: vec![0; travels.len()],
        }
    }

    /// The pulses seen so far, axis by axis.
    #[must_use]
    pub fn finish(mut self) -> Vec<PulseTrain> {
        let Seen { trains, steps, stepped } = &mut self.seen;
        let clocks = stepped.saturating_sub(self.loaded.unwrap_or(0));
        trains.iter_mut().for_each(|train| train.compare_at(train.pulses, *steps));
        trains.iter().map(|train| train.finish(*steps, clocks)).collect()
    }
}

/// The clock of the last bit in words of samples, `span` to a word, from a clock on.
#[inline(always)]
fn last(words: &[u64], (clock, span): (u64, usize)) -> Option<u64> {
    let index = words.iter().rposition(|&word| word != 0)?;
    Some(clock + (index * span) as u64 + u64::from(words[index].ilog2()))
}

/// The ends of octets one after another, from so far off on.
#[inline(always)]
fn through(octets: &[Octet; 256], pulses: &[u8], mut off: i64) -> [i64; 2] {
    let (mut least, mut greatest) = (i64::MAX, i64::MIN);
    for &pulses in pulses {
        let octet = octets[usize::from(pulses)];
        (least, greatest) = (least.min(off + octet.least), greatest.max(off + octet.greatest));
        off += octet.all;
    }
    [least, greatest]
}

/// Where one sample in four completes a step, and there are pulses in one of four only: a bit for each of these 16, and
/// whether the step of the same round is complete before it.
#[inline(always)]
fn rounds(pulses: u64, stepped: u64) -> Option<(u16, bool)> {
    const FIRST: u64 = 0x1111_1111_1111_1111;
    let (step, pulse) = (stepped.trailing_zeros() % 4, pulses.trailing_zeros() % 4);
    if stepped != FIRST << step || pulses & !(FIRST << pulse) != 0 {
        return None;
    }
    // Four bits into each 16, and these side by side.
    let mut bits = pulses >> pulse;
    bits = (bits | bits >> 3) & 0x0303_0303_0303_0303;
    bits = (bits | bits >> 6) & 0x000f_000f_000f_000f;
    bits = (bits | bits >> 12) & 0x0000_00ff_0000_00ff;
    bits = (bits | bits >> 24) & 0xffff;
    Some((u16::try_from(bits).ok()?, step < pulse))
}

/// What a train writes down: pulses, clock of the last, spacing, and the worst pulses and steps.
type Gathered = (u64, Option<u64>, [u64; 2], (u64, u64));

impl Observer for SpacingWatch {
    fn wants_steps(&self) -> bool {
        false
    }

    fn remember(&self, memory: &mut Memory) {
        let Seen { trains, steps, stepped } = &self.seen;
        let trains = trains.iter().map(|train| (train.pulses, train.last, train.spacing, train.worst));
        let trains: Vec<Gathered> = trains.collect();
        memory.insert("spacing".to_owned(), json!((steps, self.loaded, stepped, trains)));
    }

    fn recall(&mut self, memory: &Memory) {
        let gathered: Option<(u64, Option<u64>, u64, Vec<Gathered>)> = recalled(memory, "spacing");
        let Some((steps, loaded, stepped, trains)) = gathered else { return };
        let fits = |&(pulses, last, _, (worst, step)): &Gathered| {
            [pulses, last.unwrap_or(0), worst, step].iter().all(|&count| count <= GREATEST)
        };
        if trains.len() != self.seen.trains.len() || steps.max(stepped) > GREATEST || !trains.iter().all(fits) {
            return;
        }
        (self.seen.steps, self.loaded, self.seen.stepped) = (steps, loaded, stepped);
        for (train, gathered) in self.seen.trains.iter_mut().zip(trains) {
            (train.pulses, train.last, _, train.worst) = gathered;
            train.set_spacing(gathered.2);
            train.greatest = train.off(train.worst.0, train.worst.1).unsigned_abs();
        }
    }

    fn want(&mut self, bench: &Testbench, wanted: &mut Wanted) -> bool {
        self.digested = StepTrains::want(bench, wanted);
        if let Some(totals) = &mut self.totals {
            totals.want(bench, wanted, &self.digested);
        }
        true
    }

    fn suffices(&self, _: &Digest) -> bool {
        self.loaded.is_some()
    }

    fn digest(&mut self, digest: &Digest, last: &[u64]) {
        let Seen { trains, steps, .. } = &self.seen;
        let greatest = trains.iter().map(|train| train.greatest).min().unwrap_or(0);
        let begun = [*steps, trains[0].pulses, trains.get(1).map_or(0, |train| train.pulses)];
        let known = self.totals.as_ref().is_some_and(|totals| totals.are_no_farther(digest, last, begun, greatest));
        let place = (digest.first_clock, digest.span);
        let SpacingWatch { seen, digested, .. } = self;
        let pulses = |axis: usize| &digest.trains[digested.pulses[axis]][..];
        dispatch!(self.level, _simd => seen.take(pulses, &digest.trains[digested.stepped], place, !known));
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        for first in (0..rows.len()).step_by(SPAN) {
            if self.loaded.is_none() {
                let loaded = rows.nonzero(self.columns.loaded, first);
                let clock = |row: u32| rows.first_clock() + first as u64 + u64::from(row);
                self.loaded = (loaded != 0).then(|| clock(loaded.trailing_zeros()));
            }
            let stepped = rows.nonzero(self.columns.stepped, first);
            for (pulses, &column) in self.pulses.iter_mut().zip(&self.columns.pulses) {
                *pulses = rows.nonzero(column, first);
            }
            let clock = rows.first_clock() + first as u64;
            let SpacingWatch { seen, pulses, .. } = self;
            let pulses = |axis: usize| &pulses[axis..=axis];
            dispatch!(self.level, _simd => seen.take(pulses, &[stepped], (clock, SPAN), true));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octets_say_what_a_look_at_each_pulse_says() {
        let (all, travel) = (1_000_003, 618_034);
        let train = |octets: Vec<Octet>| Train::new(Some((all, travel)), octets);
        let (fast, plain) = (train(octets(Some((all, travel)))), train(Vec::new()));
        let mut random = 1_u64;
        for index in 0..4000 {
            random = random.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
            let bits = random ^ random >> 33;
            let [pulse, step] = [index % 4, index / 4 % 4];
            let one_in_four = |phase: u64| 0x1111_1111_1111_1111 << phase;
            // A step a sample; one in four, with pulses of one phase or of several; anything.
            for (pulses, stepped) in [
                (bits, u64::MAX),
                (bits & one_in_four(pulse), one_in_four(step)),
                (bits, one_in_four(step)),
                (bits & one_in_four(pulse), bits.rotate_left(17)),
            ] {
                let ends = |train: &Train| train.ends(pulses, stepped, (all, travel));
                assert!(pulses == 0 || ends(&fast) == ends(&plain), "{pulses:x} {stepped:x}");
            }
        }
    }
}
