//! The control: gives the machine its blocks, one ahead, and keeps the account of every move.

use std::collections::VecDeque;
use std::io::BufRead;

use stepwave_models::program::Family;
use stepwave_nc::{PulseBlock, ToolMove};

use super::feed::{Pace, commanded, frequency, rate, shown_feed};
use super::stream::{Item, Stream};
use super::tally::{MoveReport, Totals};
use crate::testbench::{Host, Next, ObserverError, Sample, Testbench};

/// A place of the machine, in BLU.
pub type Place3 = [i64; 3];

/// Looks on while a program runs.
pub trait Onlooker {
    /// A row of the step table: `number` 0 behind the loading of a move, then each of its steps.
    ///
    /// # Errors
    /// Whatever keeps it from its work; the run ends.
    fn row(&mut self, of: &ToolMove, number: u64, sample: &Sample<'_>) -> Result<(), ObserverError> {
        let _ = (of, number, sample);
        Ok(())
    }

    /// A move has ended.
    ///
    /// # Errors
    /// As [`row`](Self::row).
    fn moved(&mut self, report: &MoveReport) -> Result<(), ObserverError> {
        let _ = report;
        Ok(())
    }
}

/// A block of the machine that waits or runs.
struct Given {
    /// Number of the move.
    index: u64,
    of: ToolMove,
    block: PulseBlock,
    commanded: Option<f64>,
    source_hz: f64,
    limited: bool,
    /// The length of the block of the program, with its first block of the machine; 0 with the others.
    length: f64,
}

/// The control of a machine that runs a program.
pub struct Control<'a, R> {
    stream: Stream<R>,
    family: &'static Family,
    bench: &'a Testbench,
    pace: Pace,
    /// Words that wait to be asked for.
    ready: VecDeque<(Next, Option<Given>)>,
    /// Blocks that the machine has been given and has not begun with.
    given: VecDeque<Given>,
    running: Option<(Given, MoveReport)>,
    onlookers: Vec<&'a mut dyn Onlooker>,
    speed: Option<f64>,
    moves: u64,
    position: Place3,
    /// The account so far.
    pub totals: Totals,
}

impl<'a, R: BufRead> Control<'a, R> {
    /// A control that reads its blocks from a stream.
    #[must_use]
    pub fn new(
        stream: Stream<R>,
        family: &'static Family,
        bench: &'a Testbench,
        pace: Pace,
        onlookers: Vec<&'a mut dyn Onlooker>,
    ) -> Control<'a, R> {
        Control {
            stream,
            family,
            bench,
            pace,
            ready: VecDeque::new(),
            given: VecDeque::new(),
            running: None,
            onlookers,
            speed: None,
            moves: 0,
            position: [0; 3],
            totals: Totals::default(),
        }
    }

    /// The line of the program whose block runs, or ran last; 0 before the first.
    #[must_use]
    pub fn line(&self) -> u64 {
        self.running.as_ref().map_or(0, |(given, _)| given.of.place.line)
    }

    /// Ends the account of the last move.
    ///
    /// # Errors
    /// An onlooker fails.
    pub fn finish(&mut self) -> Result<(), ObserverError> {
        if let Some((_, report)) = self.running.take() {
            self.totals.add(&report);
            for onlooker in &mut self.onlookers {
                onlooker.moved(&report)?;
            }
        }
        Ok(())
    }

    /// Makes the words of the next move.
    fn prepare(&mut self) -> Result<(), ObserverError> {
        match self.stream.next().transpose()? {
            None => self.ready.push_back((Next::End, None)),
            Some(Item::Stop(_)) => {}
            Some(Item::LeftOut(of, apart)) => self.totals.leave_out(apart, of.place.line),
            Some(Item::Dwell(_, seconds)) => {
                // Beyond all that can be simulated the cast saturates.
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let clocks = (seconds * self.pace.clock_hz).round() as u64;
                self.ready.push_back((Next::Wait(clocks), None));
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
            for part in self.family.words(self.bench.hardware(), &block) {
                let rate = rate(self.pace, self.family, &block, &part, self.speed);
                let source_hz = frequency(self.pace, rate.word);
                let feed = shown_feed(self.pace, self.speed, &part, source_hz);
                let number = of.place.number.unwrap_or(of.place.line);
                let mut words = part.words;
                words.extend([("rate", rate.word.into()), ("block", number.into()), ("feed", feed.into())]);
                let loaded = self.bench.load(&[words])?;
                self.totals.cut(of.place.line, &loaded.cut);
                let given = Given {
                    index: self.moves,
                    of,
                    block: block.clone(),
                    commanded: self.speed,
                    source_hz,
                    limited: rate.limited,
                    length: std::mem::take(&mut length),
                };
                self.ready.extend(loaded.blocks.into_iter().map(|words| (Next::Block(words), None)));
                if let Some((_, of)) = self.ready.back_mut() {
                    *of = Some(given);
                }
            }
        }
        Ok(())
    }
}

impl<R: BufRead> Host for Control<'_, R> {
    fn next(&mut self) -> Result<Next, ObserverError> {
        loop {
            if let Some((next, given)) = self.ready.pop_front() {
                self.given.extend(given);
                return Ok(next);
            }
            self.prepare()?;
        }
    }

    fn cut_words(&self) -> u64 {
        self.totals.cut_words
    }

    fn begun(&mut self, sample: &Sample<'_>) -> Result<(), ObserverError> {
        let Some(given) = self.given.pop_front() else { return Ok(()) };
        let goes_on = self.running.as_ref().is_some_and(|(running, _)| running.index == given.index);
        let mut report = match self.running.take() {
            Some((_, report)) if goes_on => report,
            before => {
                self.running = before;
                self.finish()?;
                MoveReport::new(given.of, sample.clock(), self.position)
            }
        };
        report.wanted = given.block.to;
        report.length += given.length;
        report.commanded = given.commanded;
        report.source_hz = report.source_hz.max(given.source_hz);
        report.limited |= given.limited;
        let promise = self.family.promise(self.bench.hardware(), &given.block);
        report.keep(&given.block, promise, self.stream.chord_limit());
        if !goes_on {
            for onlooker in &mut self.onlookers {
                onlooker.row(&given.of, 0, sample)?;
            }
        }
        self.running = Some((given, report));
        Ok(())
    }

    fn stepped(&mut self, sample: &Sample<'_>) -> Result<(), ObserverError> {
        let Some((given, report)) = &mut self.running else { return Ok(()) };
        self.position = sample.position();
        report.step(&given.block, sample.clock(), sample.pulses(), self.position);
        for onlooker in &mut self.onlookers {
            onlooker.row(&given.of, report.steps, sample)?;
        }
        Ok(())
    }
}
