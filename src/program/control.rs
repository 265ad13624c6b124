//! The control: reads a program and feeds the machine with its blocks, one ahead.

use std::collections::VecDeque;
use std::io::BufRead;

use stepwave_models::Words;
use stepwave_models::parts::PULSE_RATE;
use stepwave_models::program::{HardwareBlock, Moves, PROGRAM_WORDS, Pacing};
use stepwave_nc::{PulseBlock, ToolMove};

use super::ProgramFailure;
use super::feed::{Pace, Rate, commanded, frequency, own_speed, rate, shown_feed};
use super::stream::{Item, Stream};
use super::tally::{CutWords, LeftOut};
use crate::testbench::{Feeder, Next, ObserverError, Part, Testbench};

/// The control of a machine that runs a program.
pub struct Control<'a, R> {
    stream: Stream<R>,
    machine: &'static dyn Moves,
    bench: &'a Testbench,
    pace: Pace,
    /// What waits to be asked for.
    ready: VecDeque<Next>,
    speed: Option<f64>,
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
        Control { stream, machine, bench, pace, ready, speed: None, moves: 0, left_out, cut }
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
                let clocks = (seconds * self.pace.clock_hz).round() as u64;
                self.ready.push_back(Next::Wait(clocks));
            }
            Some(Item::Move(of, blocks)) => self.move_by(of, blocks)?,
        }
        Ok(())
    }

    fn move_by(&mut self, of: ToolMove, blocks: Vec<PulseBlock>) -> Result<(), ObserverError> {
        self.moves += 1;
        let whole: f64 = blocks.iter().map(|block| block.curve.length()).sum();
        if let Some(first) = blocks.first() {
            self.speed = commanded(self.pace, first, whole, self.speed);
        }
        for block in blocks {
            let mut length = block.curve.length();
            let speed = own_speed(self.pace, self.speed);
            let refused = |error| ProgramFailure::Block { line: of.place.line, error };
            for part in self.machine.words(self.bench.hardware(), &block, speed.word).map_err(refused)? {
                let (words, source_hz, limited) = self.paced(&block, part, speed);
                let loaded = self.bench.load(&[words])?;
                self.cut.take(of.place.line, &loaded.cut);
                let part = Part {
                    length: std::mem::take(&mut length),
                    commanded: self.speed,
                    source_hz,
                    limited,
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

    /// All words of a block of the machine, the frequency of our pulse source in Hz, and whether the feed is out of reach.
    fn paced(&self, block: &PulseBlock, part: HardwareBlock, speed: Rate) -> (Words, Option<f64>, bool) {
        if let Pacing::Hardware { reads_speed } = self.machine.pacing() {
            return (part.words, None, reads_speed && speed.limited);
        }
        let rate = rate(self.pace, self.machine, block, &part, self.speed);
        let source_hz = frequency(self.pace, rate.word);
        let feed = shown_feed(self.pace, self.speed, &part, source_hz);
        let place = block.place();
        let [shown, speed] = PROGRAM_WORDS;
        let words = part.words.set(PULSE_RATE, rate.word).set(shown, place.number.unwrap_or(place.line));
        (words.set(speed, feed), Some(source_hz), rate.limited)
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
