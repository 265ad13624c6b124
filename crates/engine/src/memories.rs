//! The words of all memories of a design, in one array that native code shares.

use stepwave_netlist::Netlist;
use stepwave_netlist::cells::{Memory, Net};

/// Where a memory is in the array. The word after its last is always 0: it is what a cell reads outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Index of its first word.
    pub(super) first: usize,
    /// Number of words.
    pub(super) size: u64,
}

impl Place {
    /// Index of the word at an address, or of the word that is always 0.
    #[inline]
    pub(super) fn index(self, address: u64) -> usize {
        // A memory has at most `Memory::MOST_WORDS` words.
        self.first + usize::try_from(address.min(self.size)).unwrap_or(0)
    }
}

/// The contents of all memories.
pub(super) struct Memories {
    words: Vec<u64>,
    places: Vec<Place>,
}

impl Memories {
    /// Memories with their first words.
    pub(super) fn new(netlist: &Netlist) -> Memories {
        let mut next = 0;
        let place = |memory: &Memory| {
            let place = Place { first: next, size: memory.size };
            next = place.index(memory.size) + 1;
            place
        };
        let places = netlist.memories.iter().map(place).collect();
        let mut memories = Memories { words: vec![0; next], places };
        memories.fill(netlist, &[]);
        memories
    }

    /// Takes these contents, and where there are none the first words.
    pub(super) fn fill(&mut self, netlist: &Netlist, contents: &[Vec<u64>]) {
        for (index, (place, memory)) in self.places.iter().zip(&netlist.memories).enumerate() {
            let given = contents.get(index).unwrap_or(&memory.initial).iter().copied();
            let words = &mut self.words[place.first..place.index(place.size)];
            for (word, given) in words.iter_mut().zip(given.chain(std::iter::repeat(0))) {
                *word = given;
            }
        }
    }

    /// The word at an address; 0 outside.
    #[inline]
    pub(super) fn word(&self, memory: usize, address: u64) -> u64 {
        self.words[self.places[memory].index(address)]
    }

    /// All ports write, given the values of nets before the edge.
    #[inline]
    pub(super) fn edge(&mut self, netlist: &Netlist, value: impl Fn(Net) -> u64) {
        for (place, memory) in self.places.iter().zip(&netlist.memories) {
            for port in memory.writes.iter().filter(|port| value(port.enable) == 1) {
                let address = value(port.address);
                if address < place.size {
                    let word = &mut self.words[place.index(address)];
                    *word = port.written(*word, &value);
                }
            }
        }
    }
}

/// What native code needs.
#[cfg(feature = "jit")]
impl Memories {
    /// Where each memory is.
    pub(super) fn places(&self) -> &[Place] {
        &self.places
    }

    /// All words.
    pub(super) fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }
}
