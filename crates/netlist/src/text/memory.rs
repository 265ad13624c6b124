//! Memories in the text form: a line for each, then lines of its first words and of its write ports.

use std::fmt;

use super::words::{Words, digits};
use super::{Expected, Parser};
use crate::bits::Width;
use crate::cells::{Memory, ScopeId, WritePort};

/// Runs of equal words in a line.
const IN_A_LINE: usize = 16;

/// The lines of the memory of this index.
pub(super) fn print(index: usize, memory: &Memory, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let Memory { scope, name, width, size, initial, writes } = memory;
    writeln!(f, "memory {index} in {} {name:?} width {} words {size}", scope.0, width.get())?;
    let runs: Vec<&[u64]> = initial.chunk_by(|a, b| a == b).collect();
    for line in runs.chunks(IN_A_LINE) {
        write!(f, "initial {index}")?;
        for run in line {
            match run.len() {
                1 => write!(f, " {:#x}", run[0])?,
                many => write!(f, " {:#x}*{many}", run[0])?,
            }
        }
        writeln!(f)?;
    }
    for WritePort { enable, address, data, mask } in writes {
        write!(f, "write {index} enable {enable} address {address} data {data}")?;
        match mask {
            Some(mask) => writeln!(f, " mask {mask}")?,
            None => writeln!(f)?,
        }
    }
    Ok(())
}

impl Parser {
    pub(super) fn memory(&mut self, words: &mut Words<'_>) -> Result<(), Expected> {
        let next = self.netlist.memories.len();
        if words.number::<usize>()? != next {
            return Err(format!("memory {next}"));
        }
        words.keyword("in")?;
        let scope = ScopeId(words.number()?);
        let name = words.quoted()?;
        words.keyword("width")?;
        let width = Width::new(words.number()?).map_err(|error| format!("a width of 1 to 64 bits ({error})"))?;
        words.keyword("words")?;
        let size = words.number()?;
        let (initial, writes) = (Vec::new(), Vec::new());
        self.netlist.memories.push(Memory { scope, name, width, size, initial, writes });
        Ok(())
    }

    /// The memory whose number comes next.
    fn of(&mut self, words: &mut Words<'_>) -> Result<&mut Memory, Expected> {
        let index: usize = words.number()?;
        self.netlist.memories.get_mut(index).ok_or_else(|| "a memory that comes before".to_owned())
    }

    /// Further first words of a memory.
    pub(super) fn initial(&mut self, words: &mut Words<'_>) -> Result<(), Expected> {
        let memory = self.of(words)?;
        while !words.rest.is_empty() {
            let word = words.word()?;
            let (word, many) = word.split_once('*').unwrap_or((word, "1"));
            let word = word.strip_prefix("0x").and_then(|word| digits(word, 16));
            let (Some(word), Some(many)) = (word, digits(many, 10)) else {
                return Err("words such as 0x1f or 0x0*16".to_owned());
            };
            let filled = many.saturating_add(memory.initial.len() as u64);
            if filled > memory.size.min(Memory::MOST_WORDS) {
                return Err(format!("at most {} words", memory.size.min(Memory::MOST_WORDS)));
            }
            memory.initial.extend((0..many).map(|_| word));
        }
        Ok(())
    }

    /// A write port of a memory.
    pub(super) fn write(&mut self, words: &mut Words<'_>) -> Result<(), Expected> {
        let memory = self.of(words)?;
        words.keyword("enable")?;
        let enable = words.net()?;
        words.keyword("address")?;
        let address = words.net()?;
        words.keyword("data")?;
        let data = words.net()?;
        let mask = if words.rest.is_empty() {
            None
        } else {
            words.keyword("mask")?;
            Some(words.net()?)
        };
        memory.writes.push(WritePort { enable, address, data, mask });
        Ok(())
    }
}
