//! A first look at a whole program: is it right, and how wide must the machine be?

use std::io::BufRead;

use stepwave_models::program::{Moves, Size};

use super::ProgramFailure;
use super::stream::{Item, Preparation, Stream};

/// What a program needs.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Survey {
    /// What the registers must hold.
    pub size: Size,
    /// Moves of the tool.
    pub moves: u64,
}

impl Survey {
    /// Reads the program once from its beginning to its end.
    ///
    /// # Errors
    /// The program is wrong, or nothing in it moves the machine.
    pub fn of<R: BufRead>(
        text: R,
        moves: &'static dyn Moves,
        preparation: &Preparation,
    ) -> Result<Survey, ProgramFailure> {
        let mut survey = Survey::default();
        for item in Stream::new(text, moves, preparation)? {
            let Item::Move(_, blocks) = item? else { continue };
            survey.moves += 1;
            for block in &blocks {
                survey.size.add(moves.crossing(), block);
            }
        }
        if survey.moves == 0 { Err(ProgramFailure::NoPulses) } else { Ok(survey) }
    }
}
