//! The control: reads a program and feeds the machine with its blocks, one ahead.

use std::collections::VecDeque;
use std::io::BufRead;

use stepwave_models::program::Moves;
use stepwave_nc::{PulseBlock, ToolMove};

use super::feed::{Pace, Pacer};
use super::stream::{Item, Stream};
use super::tally::{CutWords, LeftOut};
use crate::testbench::{Feeder, Next, ObserverError, Part, Testbench};

/// The control of a machine that runs a program.
pub struct Control<'a, R> {
    stream: Stream<R>,
    machine: &'static dyn Moves,
    bench: &'a Testbench,
    pace: Pace,
    pacer: Pacer<'a>,
    /// What waits to be asked for.
    ready: VecDeque<Next>,
    moves: u64,
    /// Moves that the machine was not given, so far.
    pub left_out: LeftOut,
    /// Words that it was given and has no room for, so far.
    pub cut: CutWords,
}

impl<'a, R: BufRead> Control<'a, R> {
    /// A control that reads its blocks from a stream.
    #[must_use]
    pub fn new(stream: Stream<R>, machine: &'static dyn Moves, bench: &'a Testbench, pace: Pace) -> Control<'a, R> {
        let (ready, left_out, cut) = (VecDeque::new(), LeftOut::default(), CutWords::default());
        let pacer = Pacer::new(machine, bench.hardware(), pace);
        Control { stream, machine, bench, pace, pacer, ready, moves: 0, left_out, cut }
    }

    /// Makes the words of the next move.
    fn prepare(&mut self) -> Result<(), ObserverError> {
        match self.stream.next().transpose()? {
            None => self.ready.push_back(Next::End),
            Some(Item::Stop(_)) => {}
            Some(Item::LeftOut(of, apart)) => self.left_out.take(apart, of.place.line),
            Some(Item::Dwell(_, seconds)) => {
                // Beyond all that can be simulated the cast saturates.
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let clocks = self.pace.dwell(seconds) as u64;
                self.ready.push_back(Next::Wait(clocks));
            }
            Some(Item::Move(of, blocks)) => self.move_by(of, blocks)?,
        }
        Ok(())
    }

    fn move_by(&mut self, of: ToolMove, blocks: Vec<PulseBlock>) -> Result<(), ObserverError> {
        self.moves += 1;
        self.pacer.begin(&blocks);
        for block in blocks {
            let mut length = block.curve.length();
            for paced in self.pacer.blocks(&block)? {
                let loaded = self.bench.load(&[paced.block.words])?;
                self.cut.take(of.place.line, &loaded.cut);
                let part = Part {
                    length: std::mem::take(&mut length),
                    commanded: self.pacer.speed,
                    source_hz: paced.source.map(|(_, hz)| hz),
                    limited: paced.limited,
                    promise: self.machine.promise(self.bench.hardware(), &block),
                    chords: self.stream.chord_limit(),
                    ..Part::new(self.moves, block.clone())
                };
                self.ready
                    .extend(loaded.blocks.into_iter().map(|words| Next::Block(words, Some(Box::new(part.clone())))));
            }
        }
        Ok(())
    }
}

impl<R: BufRead> Feeder for Control<'_, R> {
    fn next(&mut self) -> Result<Next, ObserverError> {
        loop {
            if let Some(next) = self.ready.pop_front() {
                return Ok(next);
            }
            self.prepare()?;
        }
    }

    fn cut_words(&self) -> u64 {
        self.cut.count
    }
}
