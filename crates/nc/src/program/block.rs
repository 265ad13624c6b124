//! The words of a line, sorted into modal groups.

use super::error::{Fault, ProgramErrorKind};
use super::words::{Word, Words};
use super::{Coolant, Spindle};
use crate::{Direction, Plane};

/// How an axis word is meant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Distance {
    Absolute,
    Incremental,
}

/// G93 and G94.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FeedMode {
    InverseTime,
    PerMinute,
}

/// G00 to G03, and G05 to G05.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Motion {
    Rapid,
    Line,
    Arc(Direction),
    /// G05.
    Cubic,
    /// G05.1.
    Quadratic,
    /// G05.2.
    Nurbs,
}

/// G40 to G42.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Compensation {
    Off,
    /// D is a number of the table.
    Tool(Hand),
    /// D is the diameter.
    Diameter(Hand),
}

/// On which side of the contour the tool passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hand {
    Left,
    Right,
}

/// M00, M01, M02 and M30.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Halt {
    Stop,
    OptionalStop,
    End,
}

/// The word of a modal group with its meaning.
pub(super) type Slot<'l, T> = Option<(T, Word<'l>)>;

/// A block: of every modal group and every letter at most one word.
#[derive(Debug, Default)]
pub(super) struct BlockWords<'l> {
    pub(super) number: Option<u64>,
    pub(super) feed_mode: Slot<'l, FeedMode>,
    pub(super) tool_change: Slot<'l, ()>,
    pub(super) spindle: Slot<'l, Spindle>,
    pub(super) coolant: Slot<'l, Coolant>,
    pub(super) dwell: Slot<'l, ()>,
    pub(super) plane: Slot<'l, Plane>,
    /// Millimetres in a unit.
    pub(super) unit: Slot<'l, f64>,
    pub(super) compensation: Slot<'l, Compensation>,
    /// G43 and G49; true under G43.
    pub(super) length_offset: Slot<'l, bool>,
    /// G53.
    pub(super) machine: Slot<'l, ()>,
    /// G28.
    pub(super) home: Slot<'l, ()>,
    pub(super) coordinates: Slot<'l, ()>,
    pub(super) path_control: Slot<'l, bool>,
    pub(super) distance: Slot<'l, Distance>,
    pub(super) centers: Slot<'l, Distance>,
    pub(super) return_level: Slot<'l, ()>,
    /// G80, which may come with a word of motion.
    pub(super) cycles_off: Slot<'l, ()>,
    pub(super) motion: Slot<'l, Motion>,
    /// G05.3.
    pub(super) nurbs_end: Slot<'l, ()>,
    pub(super) halt: Slot<'l, Halt>,
    letters: [Option<Word<'l>>; 26],
}

fn put<'l, T>(slot: &mut Slot<'l, T>, value: T, word: Word<'l>) -> Result<(), Fault> {
    if let Some((_, first)) = slot {
        let first = first.name();
        return Err(word.fault(|word| ProgramErrorKind::SameGroup { word, first }));
    }
    *slot = Some((value, word));
    Ok(())
}

fn place(letter: char) -> usize {
    usize::from(u8::try_from(letter).unwrap_or_default().saturating_sub(b'A')).min(25)
}

impl<'l> BlockWords<'l> {
    /// Sorts the words; `head` where no block was in front, so that an O word may be the number of the program.
    pub(super) fn read(mut words: Words<'l>, head: bool) -> Result<BlockWords<'l>, Fault> {
        let mut block = BlockWords::default();
        let mut first = true;
        while let Some(word) = words.next()? {
            match word.letter {
                'N' if first => block.number = Some(word.count()?),
                'N' => return Err(word.fault(|word| ProgramErrorKind::NumberNotFirst { word })),
                'O' if head
                    && first
                    && word.count().is_ok()
                    && words.clone().next().is_ok_and(|next| next.is_none()) => {}
                'O' => return Err(word.fault(|word| ProgramErrorKind::FlowControl { word })),
                'G' => block.g(word)?,
                'M' => block.m(word)?,
                'A'..='D' | 'F' | 'H'..='L' | 'P'..='Z' => {
                    let slot = &mut block.letters[place(word.letter)];
                    if let Some(first) = slot {
                        let first = first.name();
                        return Err(word.fault(|word| ProgramErrorKind::Repeated { word, first }));
                    }
                    *slot = Some(word);
                }
                _ => return Err(word.fault(|word| ProgramErrorKind::Unsupported { word })),
            }
            first = false;
        }
        block.check_owners()?;
        Ok(block)
    }

    /// The word of a letter other than G, M, N and O.
    pub(super) fn word(&self, letter: char) -> Option<Word<'l>> {
        self.letters[place(letter)]
    }

    /// The first of these letters, in this order, that the block has.
    pub(super) fn any(&self, letters: &str) -> Option<Word<'l>> {
        letters.chars().find_map(|letter| self.word(letter))
    }

    fn g(&mut self, word: Word<'l>) -> Result<(), Fault> {
        use Hand::{Left, Right};
        match tenths(word) {
            Some(0) => put(&mut self.motion, Motion::Rapid, word),
            Some(10) => put(&mut self.motion, Motion::Line, word),
            Some(20) => put(&mut self.motion, Motion::Arc(Direction::Clockwise), word),
            Some(30) => put(&mut self.motion, Motion::Arc(Direction::CounterClockwise), word),
            Some(50) => put(&mut self.motion, Motion::Cubic, word),
            Some(51) => put(&mut self.motion, Motion::Quadratic, word),
            Some(52) => put(&mut self.motion, Motion::Nurbs, word),
            Some(53) => put(&mut self.nurbs_end, (), word),
            Some(800) => put(&mut self.cycles_off, (), word),
            Some(40) => put(&mut self.dwell, (), word),
            Some(170) => put(&mut self.plane, Plane::Xy, word),
            Some(180) => put(&mut self.plane, Plane::Zx, word),
            Some(190) => put(&mut self.plane, Plane::Yz, word),
            Some(200) => put(&mut self.unit, 25.4, word),
            Some(210) => put(&mut self.unit, 1.0, word),
            Some(400) => put(&mut self.compensation, Compensation::Off, word),
            Some(410) => put(&mut self.compensation, Compensation::Tool(Left), word),
            Some(420) => put(&mut self.compensation, Compensation::Tool(Right), word),
            Some(411) => put(&mut self.compensation, Compensation::Diameter(Left), word),
            Some(421) => put(&mut self.compensation, Compensation::Diameter(Right), word),
            Some(280) => put(&mut self.home, (), word),
            Some(430) => put(&mut self.length_offset, true, word),
            Some(490) => put(&mut self.length_offset, false, word),
            Some(530) => put(&mut self.machine, (), word),
            Some(540) => put(&mut self.coordinates, (), word),
            Some(610 | 611) => put(&mut self.path_control, false, word),
            Some(640) => put(&mut self.path_control, true, word),
            Some(900) => put(&mut self.distance, Distance::Absolute, word),
            Some(910) => put(&mut self.distance, Distance::Incremental, word),
            Some(901) => put(&mut self.centers, Distance::Absolute, word),
            Some(911) => put(&mut self.centers, Distance::Incremental, word),
            Some(930) => put(&mut self.feed_mode, FeedMode::InverseTime, word),
            Some(940) => put(&mut self.feed_mode, FeedMode::PerMinute, word),
            Some(980 | 990) => put(&mut self.return_level, (), word),
            _ => Err(word.fault(|word| ProgramErrorKind::Unsupported { word })),
        }
    }

    fn m(&mut self, word: Word<'l>) -> Result<(), Fault> {
        match tenths(word) {
            Some(0) => put(&mut self.halt, Halt::Stop, word),
            Some(10) => put(&mut self.halt, Halt::OptionalStop, word),
            Some(20 | 300) => put(&mut self.halt, Halt::End, word),
            Some(30) => put(&mut self.spindle, Spindle::Clockwise, word),
            Some(40) => put(&mut self.spindle, Spindle::CounterClockwise, word),
            Some(50) => put(&mut self.spindle, Spindle::Off, word),
            Some(60) => put(&mut self.tool_change, (), word),
            Some(70) => put(&mut self.coolant, Coolant::Mist, word),
            Some(80) => put(&mut self.coolant, Coolant::Flood, word),
            Some(90) => put(&mut self.coolant, Coolant::Off, word),
            _ => Err(word.fault(|word| ProgramErrorKind::Unsupported { word })),
        }
    }

    /// Whether Q belongs to G64, and not to a curve.
    pub(super) fn blends(&self) -> bool {
        matches!(self.path_control, Some((true, _)))
    }

    /// Whether P belongs to G04 or G64, and not to an arc.
    pub(super) fn times(&self) -> bool {
        self.dwell.is_some() || self.blends()
    }

    /// Checks that D and H belong to something in the block; I, J, K, L, P, Q and R are up to the motion in force.
    fn check_owners(&self) -> Result<(), Fault> {
        let compensates = self.compensation.is_some_and(|(compensation, _)| compensation != Compensation::Off);
        for (letter, used, owner) in
            [('D', compensates, "G41 or G42"), ('H', matches!(self.length_offset, Some((true, _))), "G43")]
        {
            if let (Some(word), false) = (self.word(letter), used) {
                return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner }));
            }
        }
        Ok(())
    }
}

/// The number of a G or M word in tenths, so that G91.1 is 911; nothing where it has more decimals or is out of range.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 and 9999")]
fn tenths(word: Word<'_>) -> Option<u32> {
    let tenths = word.value * 10.0;
    let whole = tenths.round();
    ((0.0..=9999.0).contains(&whole) && (tenths - whole).abs() < 1e-9).then_some(whole as u32)
}
