//! Memories in lanes: a copy for each lane of those that are written, one copy of the others for all.

use super::code::{Code, PortRows};
use super::lane::{LANES, Lane, LaneRow};
use stepwave_netlist::cells::Memory;

/// Bytes that the copies of all lanes on all threads may take.
const MOST_BYTES: u64 = 1 << 29;

/// Threads and lanes on each of them, where a lane takes this many bytes: as many as there are, or as fit; at least one.
pub(super) fn fitting(threads: usize, bytes: u64) -> (usize, usize) {
    let most = MOST_BYTES.checked_div(bytes).map_or(usize::MAX, |most| usize::try_from(most).unwrap_or(usize::MAX));
    let threads = threads.min(most).max(1);
    (threads, (most / threads).clamp(1, LANES))
}

/// Words that each lane has for itself, of some memories.
pub(super) fn own_words<'m>(memories: impl Iterator<Item = &'m Memory>) -> u64 {
    memories.filter(|memory| !memory.writes.is_empty()).map(|memory| memory.size).sum()
}

/// One memory of all lanes. Words are as in a row.
struct Copies<T> {
    /// All words before the first edge: they are the memory, if nothing writes it.
    first: Vec<T>,
    /// Otherwise the words of every copy, one copy after another.
    own: Vec<T>,
}

impl<T: Lane> Copies<T> {
    fn words(&self, copy: usize) -> &[T] {
        if self.own.is_empty() { &self.first } else { &self.own[copy * self.first.len()..][..self.first.len()] }
    }
}

/// All memories of a block of lanes, by their index in the netlist; those that nothing needs have no words.
pub(super) struct LaneMemories<T> {
    memories: Vec<Copies<T>>,
    /// The copy that each lane has.
    copies: Vec<usize>,
}

/// The memories, and which copy the lanes of some rows have.
#[derive(Clone, Copy)]
pub(super) struct View<'a, T> {
    memories: &'a [Copies<T>],
    copies: &'a [usize],
}

impl<T: Lane> View<'_, T> {
    /// The word at an address of this many bits, in a lane; 0 outside.
    #[inline(always)]
    pub(super) fn word(&self, memory: usize, lane: usize, address: T, bits: u32) -> T {
        let words = self.memories[memory].words(self.copies[lane]);
        words.get(index(address, bits)).copied().unwrap_or_default()
    }
}

#[inline(always)]
fn index<T: Lane>(address: T, bits: u32) -> usize {
    usize::try_from(address.right(T::BITS - bits).get()).unwrap_or(usize::MAX)
}

impl<T: Lane> LaneMemories<T> {
    /// Memories for `lanes` lanes; `None` is one that nothing needs.
    pub(super) fn new<'m>(memories: impl Iterator<Item = Option<&'m Memory>>, lanes: usize) -> LaneMemories<T> {
        let copies = |memory: Option<&Memory>| {
            let words = memory.map(|memory| (memory, memory.first_contents()));
            let encoded = |(memory, words): (&Memory, Vec<u64>)| -> Vec<T> {
                words.into_iter().map(|word| T::encode(memory.width, word)).collect()
            };
            let first = words.map(encoded).unwrap_or_default();
            let written = memory.is_some_and(|memory| !memory.writes.is_empty());
            let own = if written { vec![T::default(); first.len() * lanes] } else { Vec::new() };
            Copies { first, own }
        };
        let memories = memories.map(copies).collect();
        // Lanes that never have a job compute, too, and nobody looks.
        let copies = (0..LANES).map(|lane| if lane < lanes { lane } else { 0 }).collect();
        LaneMemories { memories, copies }
    }

    /// As the rows of all lanes see them.
    pub(super) fn all(&self) -> View<'_, T> {
        View { memories: &self.memories, copies: &self.copies }
    }

    /// As rows see them in which these copies are.
    pub(super) fn of<'a>(&'a self, copies: &'a [usize]) -> View<'a, T> {
        View { memories: &self.memories, copies }
    }

    /// The copies of some lanes, filled up to a whole row.
    pub(super) fn copies(&self, lanes: &[usize]) -> [usize; LANES] {
        let mut copies = [0; LANES];
        for (copy, &lane) in copies.iter_mut().zip(lanes) {
            *copy = self.copies[lane];
        }
        copies
    }

    /// A lane has the first words again.
    pub(super) fn reset(&mut self, lane: usize) {
        let copy = self.copies[lane];
        for Copies { first, own } in self.memories.iter_mut().filter(|memory| !memory.own.is_empty()) {
            own[copy * first.len()..][..first.len()].copy_from_slice(first);
        }
    }

    /// Two lanes change places.
    pub(super) fn swap(&mut self, a: usize, b: usize) {
        self.copies.swap(a, b);
    }

    /// All ports write in the first `lanes` lanes, which have these copies, or their own where there are none.
    #[inline(always)]
    pub(super) fn edge(&mut self, code: &Code, rows: &[Box<LaneRow<T>>], lanes: usize, copies: Option<&[usize]>) {
        for port in &code.writes {
            let Copies { first, own } = &mut self.memories[port.memory];
            for (lane, &copy) in copies.unwrap_or(&self.copies).iter().enumerate().take(lanes) {
                let words = &mut own[copy * first.len()..][..first.len()];
                if let Some((index, word)) = written(port, rows, lane, words) {
                    words[index] = word;
                }
            }
        }
    }

    /// A port changes a word of a lane at the edge.
    pub(super) fn changes(&self, code: &Code, rows: &[Box<LaneRow<T>>], lane: usize) -> bool {
        code.writes.iter().any(|port| {
            let words = self.memories[port.memory].words(self.copies[lane]);
            written(port, rows, lane, words).is_some_and(|(index, word)| words[index] != word)
        })
    }
}

/// Where a port writes in a lane, and what the word becomes; nothing where it does not write.
#[inline(always)]
fn written<T: Lane>(port: &PortRows, rows: &[Box<LaneRow<T>>], lane: usize, words: &[T]) -> Option<(usize, T)> {
    if rows[port.enable].get(lane) == T::default() {
        return None;
    }
    let index = index(rows[port.address].get(lane), port.bits);
    let (old, data) = (*words.get(index)?, rows[port.data].get(lane));
    let mask = port.mask.map_or(T::ONES, |mask| rows[mask].get(lane));
    Some((index, old.and(mask.not()).or(data.and(mask))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_become_fewer_before_threads_do_and_one_is_left() {
        assert_eq!(fitting(4, 0), (4, LANES));
        assert_eq!(fitting(4, 1 << 19), (4, LANES));
        assert_eq!(fitting(4, 1 << 20), (4, 128));
        assert_eq!(fitting(4, 1 << 27), (4, 1));
        assert_eq!(fitting(4, 1 << 28), (2, 1));
        assert_eq!(fitting(4, 1 << 40), (1, 1));
    }
}
