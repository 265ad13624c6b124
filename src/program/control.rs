//! The control: reads a program and feeds the machine with its blocks, one ahead.

use std::collections::VecDeque;
use std::io::BufRead;

use stepwave_models::program::Moves;
use stepwave_nc::{PulseBlock, ToolMove};

use super::feed::Pace;
use super::planner::{Planned, Planner};
use super::stream::{Item, Stream};
use super::tally::{CutWords, LeftOut};
use crate::testbench::{Feeder, Next, ObserverError, Part, Testbench};

/// The control of a machine that runs a program.
pub struct Control<'a, R> {
    stream: Stream<R>,
    machine: &'static dyn Moves,
    bench: &'a Testbench,
    pace: Pace,
    planner: Planner<'a, Part>,
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
        let planner = Planner::new(machine, bench.hardware(), pace);
        Control { stream, machine, bench, pace, planner, ready, moves: 0, left_out, cut }
    }

    /// Takes the next item of the program.
    fn prepare(&mut self) -> Result<(), ObserverError> {
        match self.stream.next().transpose()? {
            None => self.rest(Some(Next::End))?,
            Some(Item::Stop(_)) => self.rest(None)?,
            Some(Item::LeftOut(of, apart)) => self.left_out.take(apart, of.place.line),
            Some(Item::Dwell(_, seconds)) => {
                // Beyond all that can be simulated the cast saturates.
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let clocks = self.pace.dwell(seconds) as u64;
                self.rest(Some(Next::Wait(clocks)))?;
            }
            Some(Item::Move(of, blocks)) => {
                self.take(of, &blocks)?;
                self.give()?;
            }
        }
        Ok(())
    }

    fn take(&mut self, of: ToolMove, blocks: &[PulseBlock]) -> Result<(), ObserverError> {
        self.moves += 1;
        let (index, chords) = (self.moves, self.stream.chord_limit());
        let (machine, hardware) = (self.machine, self.bench.hardware());
        self.planner.push(&of, blocks, |pacer, block, is_first| Part {
            length: if is_first { block.length() } else { 0.0 },
            commanded: pacer.speed,
            promise: machine.promise(hardware, block),
            chords,
            ..Part::new(index, block.clone())
        })?;
        Ok(())
    }

    /// The machine comes to rest, and then does this.
    fn rest(&mut self, next: Option<Next>) -> Result<(), ObserverError> {
        self.planner.stop();
        self.give()?;
        self.ready.extend(next);
        Ok(())
    }

    /// Gives out the blocks whose words are known.
    fn give(&mut self) -> Result<(), ObserverError> {
        while let Some(Planned { block, source, limited, of, .. }) = self.planner.next() {
            let loaded = self.bench.load(&[block.words])?;
            self.cut.take(of.block.of.place.line, &loaded.cut);
            let part = Part { source_hz: source.map(|(_, hz)| hz), limited, ..of };
            let given = |words| Next::Block(words, Some(Box::new(part.clone())));
            self.ready.extend(loaded.blocks.into_iter().map(given));
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
