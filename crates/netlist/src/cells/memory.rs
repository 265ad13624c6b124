//! Memories: words that cells read by an address, and ports that write them at an edge.

use super::{Net, ScopeId};
use crate::bits::Width;

/// An array of words. A cell [`Op::Read`](super::Op::Read) reads its present contents; its write ports change them at an
/// edge, all from the values before it, in order: a later port wins.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Memory {
    /// Scope that the name is in.
    pub scope: ScopeId,
    /// The name, unique in its scope.
    pub name: String,
    /// Width of a word.
    pub width: Width,
    /// Number of words: 1 to [`MOST_WORDS`](Memory::MOST_WORDS).
    pub size: u64,
    /// Words before the first edge, from address 0 on; those that are not given are 0.
    pub initial: Vec<u64>,
    /// What writes it. Like the next value of a register these nets may come after the cells that read.
    pub writes: Vec<WritePort>,
}

/// A port that writes one word at an edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct WritePort {
    /// 1 bit: writes at the edge.
    pub enable: Net,
    /// Unsigned, of any width; a word outside of the memory is not written.
    pub address: Net,
    /// As wide as a word.
    pub data: Net,
    /// As wide as a word: bits that are 1 are written; all where there is none.
    pub mask: Option<Net>,
}

impl Memory {
    /// The greatest number of words: 2^24.
    pub const MOST_WORDS: u64 = 1 << 24;

    /// All words before the first edge.
    #[must_use]
    pub fn first_contents(&self) -> Vec<u64> {
        let mut words = self.initial.clone();
        words.resize(usize::try_from(self.size).unwrap_or(usize::MAX), 0);
        words
    }
}

impl WritePort {
    /// The same port on other nets. This is the only list of its nets.
    #[must_use]
    pub fn map(self, mut go: impl FnMut(Net) -> Net) -> WritePort {
        let WritePort { enable, address, data, mask } = self;
        WritePort { enable: go(enable), address: go(address), data: go(data), mask: mask.map(go) }
    }

    /// All nets of the port.
    #[must_use]
    pub fn nets(self) -> Vec<Net> {
        let mut nets = Vec::with_capacity(4);
        let _ = self.map(|net| {
            nets.push(net);
            net
        });
        nets
    }

    /// What the port makes of a word, given the values of its nets.
    #[must_use]
    pub fn written(self, old: u64, value: impl Fn(Net) -> u64) -> u64 {
        let mask = self.mask.map_or(u64::MAX, &value);
        old & !mask | value(self.data) & mask
    }
}

/// A design with memories was given to a tool that takes none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{tool} cannot take the memory {memory}: give a design without memories")]
pub struct HasMemories {
    /// What was to be done with the design.
    pub tool: &'static str,
    /// Path of the first memory.
    pub memory: String,
}
