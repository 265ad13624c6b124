//! From the text of a program to the blocks of a machine: read, compensated, rounded; one line at a time.

use std::collections::{BTreeMap, VecDeque};
use std::io::BufRead;

use stepwave_models::program::Moves;
use stepwave_nc::{
    Compensator, Corner, Event, Integers, Place, Program, PulseBlock, Reading, Rounder, Scheme, ToolMove,
};

use super::ProgramFailure;

/// How a program becomes blocks.
#[derive(Clone, PartialEq, Debug)]
pub struct Preparation {
    /// How it is read.
    pub reading: Reading,
    /// How corners are compensated.
    pub scheme: Scheme,
    /// How an outside corner is gone round.
    pub corner: Corner,
}

/// mm by RS-274, scheme C, straight corners, and chords up to half a BLU off their curve, or off their arc where the machine
/// draws lines only or cannot follow a steep helix. Curves of G5 and G5.1 stay whole where the machine takes them.
impl Default for Preparation {
    fn default() -> Preparation {
        let (integers, tools, home) = (Integers::Units, BTreeMap::new(), Some([0.0; 3]));
        let reading =
            Reading { blu: 1e-3, degrees: 1e-3, integers, tools, tolerance: 0.0, chords: 0.5, whole: true, home };
        Preparation { reading, scheme: Scheme::C, corner: Corner::Straight }
    }
}

/// What the machine does next.
#[derive(Clone, PartialEq, Debug)]
pub enum Item {
    /// It moves; one or more blocks of one move.
    Move(ToolMove, Vec<PulseBlock>),
    /// A move to which standing still is nearer than any pulse, and how far it goes from there, in BLU.
    LeftOut(ToolMove, f64),
    /// It rests for this many seconds.
    Dwell(Place, f64),
    /// It rests until the operator starts it again: M00 or M01, which a simulation continues after at once.
    Stop(Place),
}

/// The blocks of a program, in order.
pub struct Stream<R> {
    program: Program<R>,
    compensator: Compensator,
    rounder: Rounder,
    machine: &'static dyn Moves,
    chords: f64,
    moves: Vec<ToolMove>,
    items: VecDeque<Item>,
    ended: bool,
}

impl<R: BufRead> Stream<R> {
    /// The blocks of the program in `text` for this machine.
    ///
    /// # Errors
    /// The BLU or the radius of a tool is not a length.
    pub fn new(text: R, machine: &'static dyn Moves, preparation: &Preparation) -> Result<Stream<R>, ProgramFailure> {
        let (mut reading, chords) = (preparation.reading.clone(), preparation.reading.chords);
        reading.whole &= machine.curves();
        Ok(Stream {
            program: Program::new(text, reading)?,
            compensator: Compensator::new(preparation.scheme, preparation.corner),
            rounder: Rounder::new((!machine.arcs()).then_some(chords)),
            machine,
            chords,
            moves: Vec::new(),
            items: VecDeque::new(),
            ended: false,
        })
    }

    /// How far a chord may be off its curve, in BLU.
    pub(super) fn chord_limit(&self) -> f64 {
        self.chords
    }

    /// Reads on until something is to be done.
    fn advance(&mut self) -> Result<(), ProgramFailure> {
        let event = match self.program.next() {
            Some(event) => event?,
            None => {
                self.ended = true;
                return Ok(());
            }
        };
        match event {
            Event::Move(block) => self.compensator.push(block, &mut self.moves)?,
            Event::Dwell { place, seconds } => {
                self.settle()?;
                self.items.push_back(Item::Dwell(place, seconds));
            }
            Event::Stop { place, .. } => {
                self.settle()?;
                self.items.push_back(Item::Stop(place));
            }
            Event::Auxiliary { .. } => {}
            Event::End { .. } => self.settle()?,
        }
        self.round()
    }

    /// Lets go of the block that compensation holds back.
    fn settle(&mut self) -> Result<(), ProgramFailure> {
        self.compensator.flush(&mut self.moves)?;
        self.round()
    }

    fn round(&mut self) -> Result<(), ProgramFailure> {
        for of in self.moves.drain(..) {
            let mut blocks = Vec::new();
            let line = of.place.line;
            let failed = |error| ProgramFailure::Geometry { line, error };
            let before = self.rounder.clone();
            let mut apart = self.rounder.blocks(&of, &mut blocks).map_err(failed)?;
            if !blocks.iter().all(|block| self.machine.takes(block)) {
                self.rounder = before;
                blocks.clear();
                apart = self.rounder.chords(&of, self.chords, &mut blocks).map_err(failed)?;
            }
            let refused = |error| ProgramFailure::Block { line, error };
            blocks.iter().try_for_each(|block| self.machine.check(block)).map_err(refused)?;
            self.items.push_back(if blocks.is_empty() { Item::LeftOut(of, apart) } else { Item::Move(of, blocks) });
        }
        Ok(())
    }
}

impl<R: BufRead> Iterator for Stream<R> {
    type Item = Result<Item, ProgramFailure>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.items.is_empty() && !self.ended {
            if let Err(failure) = self.advance() {
                self.ended = true;
                return Some(Err(failure));
            }
        }
        self.items.pop_front().map(Ok)
    }
}
