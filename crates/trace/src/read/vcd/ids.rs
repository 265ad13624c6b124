//! The id codes of a VCD file.

use std::collections::HashMap;

/// The place of each id code. Those of up to three characters, nearly all, are looked up without hashing.
#[derive(Default)]
pub(super) struct Ids {
    /// The place and one; 0 for none.
    short: Vec<u32>,
    long: HashMap<Box<[u8]>, usize>,
}

impl Ids {
    fn index(id: &[u8]) -> Option<usize> {
        let digit = |byte: &u8| byte.checked_sub(b' ').filter(|digit| *digit < 95).map(usize::from);
        (id.len() <= 3).then_some(())?;
        id.iter().try_fold(0, |index, byte| Some(index * 95 + digit(byte)?))
    }

    /// Gives an id code its place.
    pub(super) fn insert(&mut self, id: &[u8], place: usize) {
        match (Self::index(id), u32::try_from(place + 1)) {
            (Some(index), Ok(place)) => {
                self.short.resize(self.short.len().max(index + 1), 0);
                self.short[index] = place;
            }
            _ => drop(self.long.insert(id.into(), place)),
        }
    }

    /// The place of an id code, if it has one.
    pub(super) fn get(&self, id: &[u8]) -> Option<usize> {
        let short = Self::index(id).and_then(|index| self.short.get(index)?.checked_sub(1));
        short.map(|place| place as usize).or_else(|| self.long.get(id).copied())
    }
}
