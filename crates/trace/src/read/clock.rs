//! The clock of a wave and the cycles it cuts time into.

use super::{Signal, Value, ValueKind, Wave};
use std::cmp::Reverse;
use std::collections::HashSet;

/// The clock that samples a wave.
///
/// Unless named, it is the 1-bit signal called `clk` or `clock`, in any case, at the least depth of scopes; of several
/// there, the first in the file.
#[derive(Clone, Debug)]
pub struct Clock {
    signal: usize,
    edges: Vec<u32>,
    cycle_of: Vec<u32>,
}

/// Why a wave cannot be sampled by a clock.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the message says what the fields are")]
pub enum ClockError {
    /// It may have been written without.
    #[error("{name}: no 1-bit signal named clk or clock{}", shown(candidates))]
    None {
        name: String,
        /// The 1-bit signals with the most rising edges, best first, and how many.
        candidates: Vec<(String, usize)>,
    },
    /// A typing mistake.
    #[error("{name}: no signal `{wanted}` to use as the clock")]
    Unknown { name: String, wanted: String },
    /// A vector, real or text.
    #[error("{name}: `{path}` cannot be the clock: it is not one bit")]
    NotOneBit { name: String, path: String },
    /// Values change, but there would be one single sample.
    #[error("{name}: the clock `{path}` never rises")]
    Flat { name: String, path: String },
}

/// Signals that a message proposes as clocks.
const CANDIDATES: usize = 5;

fn shown(candidates: &[(String, usize)]) -> String {
    let mut shown: Vec<String> = Vec::new();
    for (path, edges) in candidates {
        shown.push(format!("{path} ({edges} rising edge{})", if *edges == 1 { "" } else { "s" }));
    }
    if shown.is_empty() { String::new() } else { format!("; those that rise most are {}", shown.join(", ")) }
}

impl Clock {
    pub(super) fn found(wave: &Wave) -> Result<Self, ClockError> {
        let is_clock = |signal: &Signal| ["clk", "clock"].iter().any(|name| signal.leaf().eq_ignore_ascii_case(name));
        let one_bit = |signal: &Signal| is_bit(signal) && is_clock(signal);
        let signal = shallowest(wave, one_bit)
            .ok_or_else(|| ClockError::None { name: wave.name.clone(), candidates: Self::candidates(wave) })?;
        Self::new(wave, signal)
    }

    pub(super) fn named(wave: &Wave, wanted: &str) -> Result<Self, ClockError> {
        let ends = |path: &str| path.strip_suffix(wanted).is_some_and(|scopes| scopes.ends_with('.'));
        let signal = wave
            .find(wanted)
            .or_else(|| shallowest(wave, |signal| ends(&signal.path)))
            .ok_or_else(|| ClockError::Unknown { name: wave.name.clone(), wanted: wanted.into() })?;
        if !is_bit(&wave.signals[signal]) {
            return Err(ClockError::NotOneBit { name: wave.name.clone(), path: wave.signals[signal].path.clone() });
        }
        Self::new(wave, signal)
    }

    /// The 1-bit signals that rise most often, by the number of their edges, then by their order; another name of one
    /// does not count.
    fn candidates(wave: &Wave) -> Vec<(String, usize)> {
        let mut seen = HashSet::new();
        let new = wave.signals.iter().filter(|signal| is_bit(signal) && seen.insert(signal.stored));
        let mut all: Vec<(&Signal, usize)> = new.map(|signal| (signal, rising(wave, signal).len())).collect();
        all.retain(|(_, edges)| *edges > 0);
        all.sort_by_key(|(_, edges)| Reverse(*edges));
        all.truncate(CANDIDATES);
        all.into_iter().map(|(signal, edges)| (signal.path.clone(), edges)).collect()
    }

    fn new(wave: &Wave, signal: usize) -> Result<Self, ClockError> {
        let clock = &wave.signals[signal];
        let edges = rising(wave, clock);
        // A wave of one cycle holds no edge after its beginning: only the clock falls in it.
        let others = || wave.signals.iter().enumerate().filter(|(index, _)| *index != signal);
        let changes = || others().any(|(_, signal)| wave.change_times(signal).last() > Some(&0));
        if edges.is_empty() && changes() {
            return Err(ClockError::Flat { name: wave.name.clone(), path: clock.path.clone() });
        }
        let mut cycle_of = Vec::with_capacity(wave.times.len());
        for (cycle, edge) in (0..).zip(edges.iter()) {
            cycle_of.resize(*edge as usize, cycle);
        }
        cycle_of.resize(wave.times.len(), u32::try_from(edges.len()).unwrap_or(u32::MAX));
        Ok(Self { signal, edges, cycle_of })
    }

    /// Its index in [`Wave::signals`].
    #[must_use]
    pub fn signal(&self) -> usize {
        self.signal
    }

    /// The rising edges as indices of [`Wave::times`]: the first begins cycle 1.
    #[must_use]
    pub fn edges(&self) -> &[u32] {
        &self.edges
    }

    /// The cycle in which a change at a time index shows.
    pub(crate) fn cycle_of(&self, time_index: u32) -> u32 {
        self.cycle_of[time_index as usize]
    }
}

/// The time indices at which a bit rises.
fn rising(wave: &Wave, signal: &Signal) -> Vec<u32> {
    let times = wave.change_times(signal);
    let mut edges = Vec::new();
    let mut high_before = true;
    for (change, time) in times.iter().enumerate() {
        if times.get(change + 1) != Some(time) {
            let high = matches!(wave.value(signal, change), Value::Bits(bits) if bits.to_u128() == Some(1));
            if high && !high_before {
                edges.push(*time);
            }
            high_before = high;
        }
    }
    edges
}

fn is_bit(signal: &Signal) -> bool {
    signal.width == 1 && matches!(signal.kind, ValueKind::Unsigned | ValueKind::Signed)
}

fn shallowest(wave: &Wave, fits: impl Fn(&Signal) -> bool) -> Option<usize> {
    let depth = |index: &usize| wave.signals[*index].path.matches('.').count();
    (0..wave.signals.len()).filter(|index| fits(&wave.signals[*index])).min_by_key(depth)
}
