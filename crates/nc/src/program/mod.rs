//! NC programs: text in the language RS-274/NGC, read block by block into moves.
//!
//! A program starts at (0, 0, 0) with G17 G21 G40 G90 G91.1 G94 in force and no motion mode. Blanks and tabs count
//! nowhere, not even inside a number, and upper and lower case are the same. What is not known is an error, never
//! skipped.
//!
//! | words | meaning |
//! |---|---|
//! | G00, G01, G02, G03 | rapid move, line, arc with the clock, arc against it; in force until the next of them |
//! | G05 X Y I J P Q | cubic curve: I J from the start to the first control point, P Q from the end to the second; without I J it continues as the G05 before it ended |
//! | G05.1 X Y I J | quadratic curve: I J from the start to its control point, 0 where one is missing |
//! | G05.2 X Y P L | control point of a NURBS with its weight P (1 without it), and its order L, degree and 1 (3 without it); the first is where the tool is, with the weight P of a block without X and Y |
//! | G05.3 | the NURBS ends: its moves are made |
//! | G04 P | dwell, in seconds |
//! | G28 X Y Z | rapid move over the place given to the machine's home, along the axes given; without any along all |
//! | G53 X Y Z | with G00 or G01: move to a place in the machine's own coordinates |
//! | G43 H | tool length: the path is that of the tool's tip, whatever its length |
//! | G17, G18, G19 | plane: xy, zx, yz |
//! | G20, G21 | inch (25.4 mm), mm |
//! | G40, G41 D, G42 D | tool radius compensation: off, left, right by the radius of tool D; D0 is radius 0 |
//! | G41.1 D, G42.1 D | the same with the tool's diameter as D |
//! | G90, G91 | coordinates are absolute, or increments |
//! | G90.1, G91.1 | centres (I J K) are absolute, or relative to the start of the arc |
//! | G93, G94 | F is the inverse of the block's time in minutes, or a feed in units per minute; a change clears F |
//! | F, S, T, N | feed, spindle speed, tool, number of the block (the first word of it) |
//! | A B C | end point of the rotary axes, in degrees (G20 too) |
//! | U V W | end point of the axes parallel to X, Y and Z |
//! | X Y Z, I J K, R | end point, centre of an arc, radius of an arc (negative: more than half a turn) |
//! | P of an arc | turns of which the last may be a part, 1 without it; each is a move of its own |
//! | M00, M01 | stop, optional stop |
//! | M02, M30 | end; what follows in the file is not read |
//! | M03 to M09 | spindle with the clock, against it, off; tool change; mist, flood, coolant off |
//! | `(…)`, `;…` | comments, the second to the end of the line |
//! | `%` | alone in its line: before the first block it is skipped, after it, it ends the program |
//! | `/` | first in a line: the block could be switched off; here it is run |
//! | `O1234` | number of the program, alone in front of the first block; passed |
//!
//! These words are accepted because they do not change the path of this machine:
//!
//! | words | reason |
//! |---|---|
//! | G49 | the path is that of the tool's tip before and after |
//! | G54 | the first coordinate system, and the only one: its zero is the zero of the program |
//! | G61, G61.1 | exact stop: where the machine accelerates, a block ends at the speed at which an axis can stop |
//! | G64 P Q | continuous, from the start of a program on; with P corners are passed as if the path could be left by P, though it never is |
//! | G80 | there are no canned cycles to be ended; no motion mode is in force after it, unless G00 to G03 stand next to it |
//! | G98, G99 | where canned cycles retract to |
//!
//! Words of a block are executed in the order of RS-274: feed mode, F, S, T, tool change, spindle, coolant, dwell,
//! plane, units, compensation, distance modes, motion, stop. So an F word in a block with G20 or G21 is still in the
//! units that were in force in front of the block. A coordinate without G word continues the motion that is in force,
//! and a motion word without coordinate, centre or radius only changes what is in force. A line that ends where it
//! starts is not a move, but its words stay in force, and an arc that does so (and has I J K) is a full circle; ends
//! within 0.001 BLU along every axis are the same point. A program may end without M02 or M30.
//!
//! An arc whose end is not on its circle, or whose R is less than half of its chord, is allowed within 2 BLU, 0.005 mm
//! (what rounding to 0.001 mm or 0.0001 inch makes) or 0.1 % of its radius, whichever is most, the last at most 0.5 mm;
//! but never by more than half of its radius; [`Reading::tolerance`] allows more. Such an R makes half a turn about the
//! middle of the chord. The third of the words I, J and K may be given as 0.
//!
//! F of G94 is along the path of x, y and z where one of them moves, else along that of u, v and w, else, where only rotary axes
//! move, in degrees per minute; all other axes arrive at the same time.
//!
//! A free curve becomes chords, no farther off it than [`Reading::chords`]; each is a move of the same block. With [`Reading::whole`] one of
//! G05 or G05.1 is one move. These are in the plane XY, a NURBS is in the plane that is chosen. Under G91 a control point counts from where the tool is, as the
//! end of every other curve does. No compensation is taken, and between G05.2 and G05.3 no other motion, plane or end. All this is
//! as LinuxCNC documents it.
//!
//! What is in comments may be text of any code; outside of them it is UTF-8.

use std::collections::{BTreeMap, VecDeque};
use std::io::{BufRead, Read};

use crate::{Move, Place};

use block::BlockWords;
use error::Fault;
use modal::Modal;
use words::{LINE_LIMIT, Words};

pub use error::{ProgramError, ProgramErrorKind, ReadingError};

mod arc;
mod block;
mod error;
mod home;
mod modal;
mod spline;
#[cfg(test)]
mod tests;
mod words;

/// The largest magnitude of a coordinate, a centre or a radius in a program, in BLU, and of every other number that is
/// not a code.
pub const PROGRAM_LIMIT: i64 = 1 << 40;

/// The most turns of an arc: each is a move of its own.
const TURNS_LIMIT: u64 = 10_000;

/// The tolerance of radii in words, for messages.
const CENTER_TOLERANCE: &str = "the largest of 2 BLU, 0.005 mm and 0.1 % of the radius, the last at most 0.5 mm";

/// What a coordinate without decimal point means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Integers {
    /// Millimetres or inches, like every other number: the rule of RS-274.
    #[default]
    Units,
    /// BLU, whatever the unit in force is: the rule of textbooks. Holds for X Y Z I J K R; F is never in pulses.
    Pulses,
}

/// How a program is to be read.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The BLU in mm, more than 0.
    pub blu: f64,
    /// One BLU of a rotary axis (A, B, C) in degrees, more than 0.
    pub degrees: f64,
    /// What a coordinate without decimal point means.
    pub integers: Integers,
    /// The radius of the tool of every D number, in mm, at least 0. Tool tables of RS-274 machines hold the diameter,
    /// twice as much.
    pub tools: BTreeMap<u64, f64>,
    /// How far the radii of the two ends of an arc may differ beyond what is always allowed, in BLU, at least 0.
    pub tolerance: f64,
    /// How far a chord may be off a free curve, in BLU, more than 0.
    pub chords: f64,
    /// The curves of G05 and G05.1 stay whole.
    pub whole: bool,
    /// Where the machine's zero is in the program, in mm, which G28 and G53 move by; `None` where they do not move.
    pub home: Option<[f64; 3]>,
}

/// What the spindle does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Spindle {
    /// M03.
    Clockwise,
    /// M04.
    CounterClockwise,
    /// M05.
    Off,
}

/// What the coolant does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Coolant {
    /// M07.
    Mist,
    /// M08.
    Flood,
    /// M09.
    Off,
}

/// What a block switches in addition to its motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Auxiliary {
    /// S: the speed of the spindle, in turns per minute.
    Speed(f64),
    /// T: the tool that is made ready.
    Tool(u64),
    /// M06.
    ToolChange,
    /// M03 to M05.
    Spindle(Spindle),
    /// M07 to M09.
    Coolant(Coolant),
}

/// What a program does next.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(clippy::large_enum_variant)] // nearly all are moves
pub enum Event {
    /// The tool moves.
    Move(Move),
    /// G04: nothing moves.
    Dwell {
        /// The block.
        place: Place,
        /// For how long.
        seconds: f64,
    },
    /// Something other than the motion is switched.
    Auxiliary {
        /// The block.
        place: Place,
        /// What.
        function: Auxiliary,
    },
    /// M00 and M01: the operator starts the machine again.
    Stop {
        /// The block.
        place: Place,
        /// M01: only if the operator has chosen so.
        optional: bool,
    },
    /// The program ends; always the last event, and there is always one.
    End {
        /// The block with M02 or M30, or else the last line.
        place: Place,
    },
}

/// An NC program as a stream of events. It holds one line at a time.
///
/// After an error nothing more is read.
///
/// ```
/// use stepwave_nc::{Event, Integers, Program, Reading};
///
/// let reading = Reading { blu: 0.001, degrees: 0.001, integers: Integers::Units, tools: Default::default(), tolerance: 0.0, home: None,
/// chords: 0.5, whole: false }; let mut program = Program::new("N10 G01 X1.5 F100\nN20 X[2]".as_bytes(), reading)?; let
/// Some(Ok(Event::Move(first))) = program.next() else { panic!() }; assert_eq!(first.segment.to, [1500.0, 0.0, 0.0]);
/// let Some(Err(error)) = program.next() else { panic!() }; assert_eq!(
///     error.to_string(),
///     "line 2, column 5: expressions ([ ]) are not supported: write the number itself"
/// );
/// # Ok::<(), stepwave_nc::ReadingError>(())
/// ```
#[derive(Debug)]
pub struct Program<R> {
    text: R,
    reading: Reading,
    modal: Modal,
    line: Vec<u8>,
    lines: u64,
    /// What the last line made and was not yet asked for.
    events: VecDeque<Event>,
    /// Whether no block was yet, so that an O word may be the program's number, and whether a % was.
    head: bool,
    opened: bool,
    moved: bool,
    ended: bool,
}

impl<R: BufRead> Program<R> {
    /// A program that is read from `text`.
    ///
    /// # Errors
    ///
    /// If a BLU, the tolerance, the distance of chords or the radius of a tool is not a length, or the home is beyond all coordinates.
    pub fn new(text: R, reading: Reading) -> Result<Program<R>, ReadingError> {
        let blu = reading.blu;
        if !(blu.is_finite() && blu > 0.0) {
            return Err(ReadingError::Blu { blu });
        }
        let degrees = reading.degrees;
        if !(degrees.is_finite() && degrees > 0.0) {
            return Err(ReadingError::Degrees { degrees });
        }
        if let Some((&number, &radius)) =
            reading.tools.iter().find(|&(_, &radius)| !(radius.is_finite() && radius >= 0.0))
        {
            return Err(ReadingError::ToolRadius { number, radius });
        }
        if !(reading.tolerance.is_finite() && reading.tolerance >= 0.0) {
            return Err(ReadingError::Tolerance { tolerance: reading.tolerance });
        }
        if !(reading.chords.is_finite() && reading.chords > 0.0) {
            return Err(ReadingError::Chords { chords: reading.chords });
        }
        let far = |c: &f64| !c.is_finite() || c.abs() / blu > PROGRAM_LIMIT as f64;
        if let Some(home) = reading.home.filter(|home| home.iter().any(far)) {
            return Err(ReadingError::Home { home });
        }
        Ok(Program {
            text,
            reading,
            modal: Modal::default(),
            line: Vec::new(),
            lines: 0,
            events: VecDeque::new(),
            head: true,
            opened: false,
            moved: false,
            ended: false,
        })
    }

    /// Reads the next line without its end; false where there is none.
    fn fill(&mut self) -> Result<bool, Fault> {
        let fault = |kind| Fault { column: 1, kind };
        self.line.clear();
        let limit = LINE_LIMIT as u64 + 1;
        let count = self.text.by_ref().take(limit).read_until(b'\n', &mut self.line);
        if !matches!(count, Ok(0)) {
            self.lines += 1;
        }
        let count = count.map_err(|error| fault(ProgramErrorKind::Read(error)))?;
        if self.line.pop_if(|last| *last == b'\n').is_some() {
            self.line.pop_if(|last| *last == b'\r');
        } else if count > LINE_LIMIT {
            return Err(fault(ProgramErrorKind::Overlong));
        }
        Ok(count > 0)
    }

    /// Reads the next line and queues what it makes.
    fn advance(&mut self) -> Result<(), Fault> {
        if !self.fill()? {
            return self.end(Place { line: self.lines.max(1), number: None });
        }
        let mark = if self.lines == 1 { "\u{feff}".as_bytes() } else { &[] };
        let line = words::text(self.line.strip_prefix(mark).unwrap_or(&self.line))?;
        let mut words = Words::new(&line);
        if words.sign('%') {
            if let Some(column) = words.left()? {
                return Err(Fault { column, kind: ProgramErrorKind::PercentInBlock });
            }
            if self.head && !self.opened {
                self.opened = true;
                return Ok(());
            }
            return self.end(Place { line: self.lines, number: None });
        }
        words.sign('/');
        if words.left()?.is_none() {
            return Ok(());
        }
        let block = BlockWords::read(words, self.head)?;
        self.head = false;
        let place = Place { line: self.lines, number: block.number };
        let ends = self.modal.run(&block, place, &self.reading, &mut self.events)?;
        self.moved |= self.events.iter().any(|event| matches!(event, Event::Move(_)));
        if ends { self.end(place) } else { Ok(()) }
    }

    fn end(&mut self, place: Place) -> Result<(), Fault> {
        self.ended = true;
        self.modal.curves.check(None)?;
        if !self.moved {
            return Err(Fault { column: 1, kind: ProgramErrorKind::Empty });
        }
        self.events.push_back(Event::End { place });
        Ok(())
    }
}

impl<R: BufRead> Iterator for Program<R> {
    type Item = Result<Event, ProgramError>;

    fn next(&mut self) -> Option<Result<Event, ProgramError>> {
        while self.events.is_empty() && !self.ended {
            if let Err(Fault { column, kind }) = self.advance() {
                self.ended = true;
                self.events.clear();
                return Some(Err(ProgramError { line: self.lines.max(1), column, kind }));
            }
        }
        self.events.pop_front().map(Ok)
    }
}
