//! Moves by the machine's own zero: G28 and G53.

use std::collections::VecDeque;

use super::block::{BlockWords, Distance, Motion};
use super::error::{Fault, ProgramErrorKind};
use super::modal::{AXES, Modal, OTHER_AXES};
use super::words::Word;
use super::{Event, Reading};
use crate::{Feed, Others, Place, Segment, SegmentShape, Side};

impl Modal {
    /// What a coordinate counts from, in BLU.
    pub(super) fn origin(&self, block: &BlockWords<'_>, letter: char, at: f64, reading: &Reading) -> f64 {
        match (block.machine, self.distance) {
            (Some(_), _) => AXES.iter().position(|axis| *axis == letter).map_or(0.0, |axis| zero(reading)[axis]),
            (None, Distance::Absolute) => 0.0,
            (None, Distance::Incremental) => at,
        }
    }

    /// Checks that G53 may move.
    pub(super) fn by_machine(&self, word: Word<'_>) -> Result<(), Fault> {
        if self.side != Side::On {
            return Err(word.fault(|word| ProgramErrorKind::HomeUnderCompensation { word }));
        }
        match self.motion {
            Some(Motion::Rapid | Motion::Line) => Ok(()),
            _ => Err(word.fault(|word| ProgramErrorKind::MachineMove { word })),
        }
    }

    /// G28: a rapid move to the place given, and from there along the same axes to the machine's zero.
    pub(super) fn go_home(
        &mut self,
        block: &BlockWords<'_>,
        place: Place,
        reading: &Reading,
        events: &mut VecDeque<Event>,
    ) -> Result<(), Fault> {
        let Some(((), word)) = block.home else { return Ok(()) };
        if self.side != Side::On {
            return Err(word.fault(|word| ProgramErrorKind::HomeUnderCompensation { word }));
        }
        if let Some(((), machine)) = block.machine {
            let first = word.name();
            return Err(machine.fault(|word| ProgramErrorKind::SameGroup { word, first }));
        }
        let others = if block.times() { "IJKR" } else { "IJKRP" };
        if let Some(other) = block.any(others) {
            return Err(other.fault(|word| ProgramErrorKind::Unused { word, owner: "G02 or G03" }));
        }
        let all = block.any("XYZABCUVW").is_none();
        let (mut over, mut home) = ((self.position, self.others), (self.position, self.others));
        let places = over.0.iter_mut().zip(&mut home.0).chain(over.1.iter_mut().zip(&mut home.1));
        let letters = AXES.into_iter().chain(OTHER_AXES);
        for ((over, home), (axis, letter)) in places.zip(letters.enumerate()) {
            let word = block.word(letter);
            if let Some(word) = word {
                *over = self.coordinate(block, word, *over, reading)?;
                *home = *over;
            }
            if all || word.is_some() {
                *home = zero(reading).get(axis).copied().unwrap_or(0.0);
            }
        }
        if reading.home.is_none() {
            return Ok(());
        }
        for to in [over, home] {
            let segment = Segment { from: self.position, to: to.0, shape: SegmentShape::Line };
            let others = Others { from: self.others, to: to.1 };
            (self.position, self.others) = to;
            self.moves((segment, others), 1, Feed::Rapid, place, events);
        }
        Ok(())
    }
}

/// The machine's zero in the program, in BLU.
fn zero(reading: &Reading) -> [f64; 3] {
    reading.home.unwrap_or_default().map(|c| c / reading.blu)
}
