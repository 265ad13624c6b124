//! Looking ahead: where nobody has to see each sample, the run takes what many of them come to.
//!
//! Reports do not depend on it. So samples are taken together only where a look at each of them would neither find nor
//! end anything: no stop net and no flag is 1, every observer says that the digest is enough, the pulses are close enough
//! that the machine cannot have stalled, and it cannot have come back to the state of the anchor.

use fearless_simd::{Level, dispatch};
use stepwave_engine::{self as engine, Ahead, Digest, Engine, Wanted};
use stepwave_netlist::Net;

use super::run::{Anchor, Run};
use super::steps::StepReader;
use super::{CHUNK, Observer, Testbench};

/// Indices of the trains of a digest that count steps and pulses.
#[derive(Clone, Debug, Default)]
pub(super) struct StepTrains {
    /// Of each axis.
    pub(super) pulses: Vec<usize>,
    /// Completed steps.
    pub(super) stepped: usize,
}

impl StepTrains {
    /// Those of a machine.
    pub(super) fn want(bench: &Testbench, wanted: &mut Wanted) -> StepTrains {
        let machine = bench.machine();
        StepTrains {
            pulses: machine.pulses.iter().map(|port| wanted.train(port.net)).collect(),
            stepped: wanted.train(machine.stepped.net),
        }
    }
}

/// How many samples of a train have their bit.
pub(super) fn count(train: &[u64]) -> u64 {
    dispatch!(Level::new(), _simd => ones(train))
}

#[inline(always)]
fn ones(train: &[u64]) -> u64 {
    train.iter().map(|word| u64::from(word.count_ones())).sum()
}

/// What looking ahead needs.
pub(super) struct Lookout {
    digest: Digest,
    trains: StepTrains,
    /// Nets of the ranges in a digest, and the bits inverted in them, and their places among the registers of the design.
    ranges: Vec<(Option<usize>, u64)>,
    /// Columns of the last sample.
    last: Vec<u64>,
    /// Clock before which it would hardly pay to look.
    not_before: u64,
}

impl Lookout {
    /// What all observers can do with; `None` where one has to see every sample.
    pub(super) fn of(
        bench: &Testbench,
        steps: &mut StepReader<'_>,
        observers: &mut [&mut dyn Observer],
    ) -> Option<(Lookout, Wanted)> {
        let machine = bench.machine();
        if machine.buffer.is_some() || observers.is_empty() || !bench.events.is_empty() {
            return None;
        }
        let mut wanted = Wanted::default();
        wanted.never.push(machine.loaded.net);
        wanted.never.extend(bench.design().netlist().properties.iter().map(|property| property.never));
        let trains = StepTrains::want(bench, &mut wanted);
        steps.want(trains.clone());
        if !observers.iter_mut().all(|observer| observer.want(bench, &mut wanted)) {
            return None;
        }
        let registers = bench.design().registers();
        let place = |net: Net| registers.iter().position(|&register| register == net);
        let ranges = wanted.ranges.iter().map(|&(net, turned)| (place(net), turned)).collect();
        let last = vec![0; bench.columns().nets().len()];
        Some((Lookout { digest: Digest::default(), trains, ranges, last, not_before: 0 }, wanted))
    }

    /// Clocks without a pulse at the end; `None` where, at the end of a block of samples as others see them, they are more
    /// than a machine may pause. `quiet` clocks are without one before.
    fn is_lively(&self, quiet: u64, pause: u64) -> Option<u64> {
        let Digest { span, clocks, .. } = self.digest;
        let pulses = |word: usize| self.trains.pulses.iter().fold(0, |any, &axis| any | self.digest.trains[axis][word]);
        let mut last = None;
        for end in (CHUNK as u64..=clocks).step_by(CHUNK) {
            // Those of the block whose last sample is `end - 1`.
            let [first, end] = [end - CHUNK as u64, end].map(|sample| usize::try_from(sample).unwrap_or(usize::MAX));
            let words = (first / span..=(end - 1) / span).rev();
            let mut within = words.map(|word| {
                let later = (end - word * span).min(64);
                (word * span, pulses(word) & u64::MAX >> (64 - later))
            });
            let found = within.find(|(_, pulses)| *pulses != 0);
            last = found.map(|(base, pulses)| (base as u64) + u64::from(pulses.ilog2())).or(last);
            let now = last.map_or(quiet + end as u64, |last| end as u64 - 1 - last);
            if now > pause {
                return None;
            }
            if end as u64 == clocks {
                return Some(now);
            }
        }
        None
    }

    /// Some register was in no sample what it is in the anchor, and the anchor would not have moved on.
    fn is_away(&self, anchor: &Anchor) -> bool {
        let last = self.digest.first_clock + self.digest.clocks - 1;
        let apart = |(range, &(place, turned)): (usize, &(Option<usize>, u64))| {
            let Some(then) = place.and_then(|place| anchor.registers.get(place)) else { return false };
            let (seen, then) = (self.digest.ranges[range], then ^ turned);
            then < seen.least || then > seen.greatest
        };
        last / 2 < anchor.clock && self.ranges.iter().enumerate().any(apart)
    }
}

impl Run<'_, '_> {
    /// Takes many samples at once, if that is as good as a look at each; all before have been shown.
    pub(super) fn look_ahead(&mut self) -> bool {
        let (clock, left) = (self.engine.clock(), self.left());
        let Some(lookout) = &mut self.lookout else { return false };
        if clock < lookout.not_before || self.wants_steps || self.account.is_kept() || !self.steps.has_row() {
            return false;
        }
        let Some(anchor) = &self.anchor else { return false };
        match self.engine.look_ahead(left, &mut lookout.digest) {
            Ahead::NotNow => return false,
            Ahead::Eventful => {
                lookout.not_before = clock + CHUNK as u64;
                return false;
            }
            Ahead::Digest => {}
        }
        let digest = &lookout.digest;
        let quiet = clock - self.steps.last_pulse;
        let pause = self.bench.hardware().stall_clocks;
        let quiet = lookout.is_lively(quiet, pause).filter(|_| lookout.is_away(anchor));
        let enough = self.observers.iter().all(|observer| observer.suffices(digest));
        let Some(quiet) = quiet.filter(|_| enough) else {
            lookout.not_before = clock + digest.clocks;
            return false;
        };
        if !skip(self.engine.as_mut(), self.bench, quiet) {
            lookout.not_before = u64::MAX;
            return false;
        }
        for (value, &net) in lookout.last.iter_mut().zip(self.bench.columns().nets()) {
            *value = self.engine.value(net);
        }
        self.steps.digest(digest, &lookout.last);
        for observer in self.observers.iter_mut() {
            observer.digest(digest, &lookout.last);
        }
        true
    }
}

/// Continues to the last sample of the digest, unless the machine is at rest there after `quiet` clocks without a pulse:
/// when that began, a look at each sample would have found it.
fn skip(engine: &mut dyn Engine, bench: &Testbench, quiet: u64) -> bool {
    if quiet < CHUNK as u64 {
        engine.skip_ahead();
        return true;
    }
    let design = bench.design();
    let values = |engine: &dyn Engine, nets: &[Net]| nets.iter().map(|&net| engine.value(net)).collect::<Vec<_>>();
    let (clock, before) = (engine.clock(), values(engine, design.registers()));
    let inputs = values(engine, design.inputs());
    let memories = engine::contents(engine, design);
    engine.skip_ahead();
    let rests = engine::at_rest(engine, design, &[]);
    if rests {
        engine.restore(clock, &before, &inputs, &memories);
    }
    !rests
}
