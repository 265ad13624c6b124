//! A block of changes: values at its begin, the changes of every signal, where they are, and the time table.

use std::collections::HashMap;
use std::ops::Range;

use miniz_oxide::deflate::compress_to_vec_zlib;

use super::chain::{Chain, Press};
use crate::numbers::{push, push_signed, push_u64};

/// Type of a block of changes in which a signal may refer to the changes of another.
const CHANGES: u8 = 8;
/// The changes of signals are packed by LZ4.
const LZ4: u8 = b'4';
/// Bytes by which changes that may be the same are found.
const ENDING: usize = 64;
/// How hard the frame and the time table are packed, from 1 to 9.
const EFFORT: u8 = 3;

/// The times at which something may change: steps, the first from 0 on.
#[derive(Default)]
pub(super) struct Times {
    steps: Vec<u8>,
    count: u32,
    last: u64,
}

impl Times {
    /// Appends a time, later than those before.
    pub(super) fn push(&mut self, time: u64) {
        let from = if self.count == 0 { 0 } else { self.last };
        push(time - from, &mut self.steps);
        self.count += 1;
        self.last = time;
    }

    /// Number of times.
    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// The last time.
    pub(super) fn last(&self) -> u64 {
        self.last
    }

    /// Bytes that they take.
    pub(super) fn length(&self) -> usize {
        self.steps.len()
    }
}

/// Appends bytes, packed where that makes them fewer; returns how many it appended.
fn push_packed(bytes: &[u8], out: &mut Vec<u8>) -> usize {
    let packed = compress_to_vec_zlib(bytes, EFFORT);
    let shorter = if packed.len() < bytes.len() { &packed } else { bytes };
    out.extend_from_slice(shorter);
    shorter.len()
}

/// The block, from the changes since `begin`; forgets them. `frame` is the values then, a digit a byte.
pub(super) fn block(begin: u64, frame: &[u8], times: &mut Times, chains: &mut [Chain], press: &mut Press) -> Vec<u8> {
    let mut out = vec![CHANGES];
    push_u64(0, &mut out);
    push_u64(begin, &mut out);
    push_u64(times.last, &mut out);
    push_u64(chains.iter().map(|chain| chain.length() as u64).sum(), &mut out);
    let mut packed = Vec::new();
    push_packed(frame, &mut packed);
    push(frame.len() as u64, &mut out);
    push(packed.len() as u64, &mut out);
    push(chains.len() as u64, &mut out);
    out.append(&mut packed);
    push(chains.len() as u64, &mut out);
    let places = push_chains(chains, press, &mut out);
    out.extend_from_slice(&places);
    push_u64(places.len() as u64, &mut out);
    let packed = push_packed(&times.steps, &mut out);
    for size in [times.steps.len() as u64, packed as u64, u64::from(times.count)] {
        push_u64(size, &mut out);
    }
    // The length counts itself, not the type before it.
    let length = (out.len() as u64 - 1).to_be_bytes();
    out[1..9].copy_from_slice(&length);
    times.steps.clear();
    times.count = 0;
    out
}

/// The changes that a section has so far, to find those that are the same.
#[derive(Default)]
struct Known {
    /// By length before packing and last bytes.
    found: HashMap<(usize, Vec<u8>), Vec<Written>>,
}

/// A signal, and where its changes are in the block.
type Written = (usize, Range<usize>);

impl Known {
    /// The signal whose changes are the same as those of `signal`, which are the last bytes of `out` from `at` on.
    fn same(&mut self, signal: usize, length: usize, out: &[u8], at: usize) -> Option<usize> {
        let ending = &out[at.max(out.len().saturating_sub(ENDING))..];
        let others = self.found.entry((length, ending.to_vec())).or_default();
        let same = others.iter().find(|(_, range)| out[range.clone()] == out[at..]).map(|(other, _)| *other);
        if same.is_none() {
            others.push((signal, at..out.len()));
        }
        same
    }
}

/// Appends the changes of every signal; returns the table of their places.
fn push_chains(chains: &mut [Chain], press: &mut Press, out: &mut Vec<u8>) -> Vec<u8> {
    let start = out.len();
    out.push(LZ4);
    let mut places = Vec::new();
    let mut known = Known::default();
    // Signals without a change since the last entry, the place of the last changes, the last one referred to.
    let (mut silent, mut before, mut referred) = (0, start, None);
    for (signal, chain) in chains.iter_mut().enumerate() {
        let length = chain.length();
        if length == 0 {
            silent += 1;
            continue;
        }
        if silent > 0 {
            push(silent << 1, &mut places);
            silent = 0;
        }
        let at = out.len();
        chain.end(press, out);
        let number = if let Some(other) = known.same(signal, length, out, at) {
            out.truncate(at);
            // Minus the handle, or 0 for the same as before.
            let again = referred.replace(other) == Some(other);
            if again { 0 } else { -(other as i64) - 1 }
        } else {
            (at - std::mem::replace(&mut before, at)) as i64
        };
        push_signed(number << 1 | 1, &mut places);
    }
    if silent > 0 {
        push(silent << 1, &mut places);
    }
    places
}
