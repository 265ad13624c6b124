//! What is in force in a program, and what a block makes of it.

use std::collections::VecDeque;

use super::arc;
use super::block::{BlockWords, Compensation, Distance, FeedMode, Halt, Hand, Motion};
use super::error::{Fault, ProgramErrorKind};
use super::spline::Curves;
use super::words::Word;
use super::{Auxiliary, Event, Integers, PROGRAM_LIMIT, Reading};
use crate::{
    Direction, Feed, FeedAxes, Move, OTHERS, Others, PathControl, Place, Plane, Point, Segment, SegmentShape, Side,
};

/// The words that stay in force, and where the tool is.
#[derive(Debug)]
pub(super) struct Modal {
    pub(super) position: Point,
    /// The axes other than x, y and z.
    pub(super) others: [f64; OTHERS],
    pub(super) plane: Plane,
    /// Millimetres in a unit.
    unit: f64,
    pub(super) distance: Distance,
    centers: Distance,
    feed_mode: FeedMode,
    /// F as it was given, and millimetres in its unit; none under G93.
    feed: Option<(f64, f64)>,
    pub(super) side: Side,
    /// The move before is compensated, so that the next one ends that.
    pub(super) compensated: bool,
    pub(super) path: PathControl,
    pub(super) motion: Option<Motion>,
    pub(super) curves: Curves,
}

impl Default for Modal {
    /// G17 G21 G40 G90 G91.1 G94 at the origin.
    fn default() -> Modal {
        Modal {
            position: [0.0; 3],
            others: [0.0; OTHERS],
            plane: Plane::Xy,
            unit: 1.0,
            distance: Distance::Absolute,
            centers: Distance::Incremental,
            feed_mode: FeedMode::PerMinute,
            feed: None,
            side: Side::On,
            compensated: false,
            path: PathControl::default(),
            motion: None,
            curves: Curves::default(),
        }
    }
}

/// The words of a move.
const MOVING: &str = "XYZABCUVWIJKR";
/// The letters of axes and of the centre, axis by axis.
pub(super) const AXES: [char; 3] = ['X', 'Y', 'Z'];
pub(super) const OTHER_AXES: [char; OTHERS] = ['A', 'B', 'C', 'U', 'V', 'W'];
const CENTERS: [char; 3] = ['I', 'J', 'K'];

/// Ends that are no further apart along the axes are one point: rounding of increments and inches has parted
/// them. In BLU.
const SAME_POINT: f64 = 1e-3;

/// What the words of a plane are called.
fn center_words(plane: Plane) -> (&'static str, &'static str) {
    match plane {
        Plane::Xy => ("G17", "I and J"),
        Plane::Zx => ("G18", "I and K"),
        Plane::Yz => ("G19", "J and K"),
    }
}

pub(super) fn within(value: f64, column: u64, name: impl FnOnce() -> String) -> Result<f64, Fault> {
    if value.abs() <= PROGRAM_LIMIT as f64 {
        Ok(value)
    } else {
        Err(Fault { column, kind: ProgramErrorKind::BeyondLimit { name: name(), value } })
    }
}

impl Modal {
    /// Runs a block in the order of RS-274, and returns whether the program ends with it.
    pub(super) fn run(
        &mut self,
        block: &BlockWords<'_>,
        place: Place,
        reading: &Reading,
        events: &mut VecDeque<Event>,
    ) -> Result<bool, Fault> {
        self.curves.check(Some(block))?;
        let feed = self.feed(block)?;
        auxiliaries(block, place, events)?;
        if let Some(((), word)) = block.dwell {
            let Some(time) = block.word('P') else {
                return Err(word.fault(|word| ProgramErrorKind::NoDwellTime { word }));
            };
            events.push_back(Event::Dwell { place, seconds: not_negative(time)? });
        }
        if let Some((plane, word)) = block.plane {
            if plane != self.plane && self.side != Side::On {
                return Err(word.fault(|word| ProgramErrorKind::PlaneUnderCompensation { word }));
            }
            self.plane = plane;
        }
        self.unit = block.unit.map_or(self.unit, |(unit, _)| unit);
        if let Some((compensation, word)) = block.compensation {
            self.side = self.side(compensation, word, block.word('D'), reading)?;
        }
        self.path = self.path_control(block, reading)?;
        self.distance = block.distance.map_or(self.distance, |(distance, _)| distance);
        self.centers = block.centers.map_or(self.centers, |(distance, _)| distance);
        self.motion = match (block.motion, block.cycles_off) {
            (Some((motion, _)), _) => Some(motion),
            (None, Some(_)) => None,
            (None, None) => self.motion,
        };
        self.check_curve_words(block)?;
        if block.home.is_some() {
            self.go_home(block, place, reading, events)?;
        } else if self.curve(block, place, feed, reading, events)? {
            // It has made its moves.
        } else if let Some((segment, others)) = self.segment(block, reading)? {
            let turns = self.turns(block)?;
            let feed = self.feed_of_move(block, feed, FeedAxes::of(&segment, &others))?;
            if block.machine.is_none() || reading.home.is_some() {
                (self.position, self.others) = (segment.to, others.to);
                self.moves((segment, others), turns, feed, place, events);
            }
        } else if let Some(word) = block.word('P').filter(|_| !block.times()) {
            return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner: arc::TURNS_OWNER }));
        }
        match block.halt {
            None => {}
            Some((Halt::Stop, _)) => events.push_back(Event::Stop { place, optional: false }),
            Some((Halt::OptionalStop, _)) => events.push_back(Event::Stop { place, optional: true }),
            Some((Halt::End, _)) => return Ok(true),
        }
        Ok(false)
    }

    /// The turns that an arc takes, 1 where nothing is said.
    fn turns(&self, block: &BlockWords<'_>) -> Result<u64, Fault> {
        match (block.word('P').filter(|_| !block.times()), self.motion) {
            (None, _) => Ok(1),
            (Some(word), Some(Motion::Arc(_))) => {
                let turns = word.count().unwrap_or(0);
                let right = (1..=super::TURNS_LIMIT).contains(&turns);
                if right { Ok(turns) } else { Err(word.fault(|word| ProgramErrorKind::Turns { word })) }
            }
            (Some(word), _) => Err(word.fault(|word| ProgramErrorKind::Unused { word, owner: arc::TURNS_OWNER })),
        }
    }

    /// The moves of a segment: one, but of an arc of several turns each turn is one.
    pub(super) fn moves(
        &mut self,
        (segment, others): (Segment, Others),
        turns: u64,
        feed: Feed,
        place: Place,
        events: &mut VecDeque<Event>,
    ) {
        if segment.from == segment.to && segment.shape == SegmentShape::Line && others.rest() {
            return;
        }
        let of = |(segment, [from, to]): (Segment, [f64; 2])| {
            let feed = if let Feed::Inverse(number) = feed { Feed::Inverse(number / (to - from)) } else { feed };
            let others = Others { from: others.after(from), to: others.after(to) };
            Event::Move(Move {
                place,
                segment,
                feed,
                plane: self.plane,
                side: self.side,
                path: self.path,
                others,
                chord: false,
            })
        };
        events.extend(arc::turns(segment, turns).map(of));
        self.compensated = self.side != Side::On;
    }

    /// Takes the feed mode and the F word, and returns the block's own F number.
    fn feed(&mut self, block: &BlockWords<'_>) -> Result<Option<f64>, Fault> {
        if let Some((mode, _)) = block.feed_mode
            && mode != self.feed_mode
        {
            self.feed_mode = mode;
            self.feed = None;
        }
        let Some(word) = block.word('F') else {
            return Ok(None);
        };
        let number = word.limited()?;
        if number <= 0.0 {
            return Err(word.fault(|word| ProgramErrorKind::FeedNotPositive { word }));
        }
        if self.feed_mode == FeedMode::PerMinute {
            self.feed = Some((number, self.unit));
        }
        Ok(Some(number))
    }

    /// The feed of a block that moves along these axes, whose own F number is known.
    pub(super) fn feed_of_move(
        &self,
        block: &BlockWords<'_>,
        number: Option<f64>,
        along: FeedAxes,
    ) -> Result<Feed, Fault> {
        // Degrees are not scaled.
        let per_minute = |(feed, unit): (f64, f64)| if along == FeedAxes::Rotary { feed } else { feed * unit };
        let (feed, missing) = match (self.motion, self.feed_mode) {
            (Some(Motion::Rapid), _) => return Ok(Feed::Rapid),
            (_, FeedMode::PerMinute) => (self.feed.map(per_minute).map(Feed::PerMinute), ProgramErrorKind::NoFeed),
            (_, FeedMode::InverseTime) => (number.map(Feed::Inverse), ProgramErrorKind::NoInverseTime),
        };
        let column = || block.motion.map(|(_, word)| word).or(block.any(MOVING)).map_or(1, |word| word.column);
        feed.ok_or_else(|| Fault { column: column(), kind: missing })
    }

    /// How ends of blocks are passed from this one on.
    fn path_control(&self, block: &BlockWords<'_>, reading: &Reading) -> Result<PathControl, Fault> {
        match block.path_control {
            None => Ok(self.path),
            Some((false, _)) => Ok(PathControl::Exact),
            Some((true, _)) => match block.word('P').filter(|_| block.dwell.is_none()) {
                None => Ok(PathControl::Continuous),
                Some(word) => {
                    not_negative(word)?;
                    Ok(PathControl::Within(self.length(word, reading)?))
                }
            },
        }
    }

    fn side(
        &self,
        compensation: Compensation,
        word: Word<'_>,
        tool: Option<Word<'_>>,
        reading: &Reading,
    ) -> Result<Side, Fault> {
        let (hand, by_table) = match compensation {
            Compensation::Off => return Ok(Side::On),
            Compensation::Tool(hand) => (hand, true),
            Compensation::Diameter(hand) => (hand, false),
        };
        let Some(tool) = tool else {
            return Err(word.fault(|word| ProgramErrorKind::NoTool { word }));
        };
        let radius = if by_table {
            let number = tool.count()?;
            let radius = reading.tools.get(&number).copied().or((number == 0).then_some(0.0));
            radius.ok_or_else(|| tool.fault(|_| ProgramErrorKind::UnknownTool { number }))? / reading.blu
        } else {
            not_negative(tool)? * self.unit / 2.0 / reading.blu
        };
        let radius = within(radius, tool.column, || format!("the tool radius of {}", tool.name()))?;
        Ok(match hand {
            Hand::Left => Side::Left(radius),
            Hand::Right => Side::Right(radius),
        })
    }

    /// A length word in BLU, or the angle of a rotary axis.
    pub(super) fn length(&self, word: Word<'_>, reading: &Reading) -> Result<f64, Fault> {
        let value = match reading.integers {
            Integers::Pulses if word.integer => word.value,
            _ if matches!(word.letter, 'A'..='C') => word.value / reading.degrees,
            _ => word.value * self.unit / reading.blu,
        };
        within(value, word.column, || word.letter.to_string())
    }

    /// Where a coordinate word leads, of an axis that is here now, in BLU.
    pub(super) fn coordinate(
        &self,
        block: &BlockWords<'_>,
        word: Word<'_>,
        at: f64,
        reading: &Reading,
    ) -> Result<f64, Fault> {
        let length = self.length(word, reading)?;
        within(self.origin(block, word.letter, at, reading) + length, word.column, || word.letter.to_string())
    }

    /// Where the axes other than x, y and z go; one that hardly moves rests.
    fn others(&self, block: &BlockWords<'_>, reading: &Reading) -> Result<Others, Fault> {
        let mut others = Others::at(self.others);
        for (to, letter) in others.to.iter_mut().zip(OTHER_AXES) {
            if let Some(word) = block.word(letter) {
                let wanted = self.coordinate(block, word, *to, reading)?;
                *to = if (wanted - *to).abs() <= SAME_POINT { *to } else { wanted };
            }
        }
        Ok(others)
    }

    /// The segment of the block, of any length, and the other axes; nothing where it has no word that moves.
    fn segment(&self, block: &BlockWords<'_>, reading: &Reading) -> Result<Option<(Segment, Others)>, Fault> {
        let Some(first) = block.any(MOVING) else {
            return Ok(None);
        };
        let Some(motion) = self.motion else {
            return Err(first.fault(|word| ProgramErrorKind::NoMotion { word }));
        };
        if let Some(((), word)) = block.machine {
            self.by_machine(word)?;
        }
        let from = self.position;
        let mut to = from;
        for (coordinate, letter) in to.iter_mut().zip(AXES) {
            if let Some(word) = block.word(letter) {
                *coordinate = self.coordinate(block, word, *coordinate, reading)?;
            }
        }
        let others = self.others(block, reading)?;
        let mut still = [0, 1, 2].map(|axis| (to[axis] - from[axis]).abs() <= SAME_POINT);
        match motion {
            Motion::Arc(_) => {
                let [first, second, _] = self.plane.axes();
                [still[first], still[second]] = [still[first] && still[second]; 2];
            }
            _ => still = [still == [true; 3]; 3],
        }
        for axis in [0, 1, 2] {
            if still[axis] {
                to[axis] = from[axis];
            }
        }
        let shape = match (motion, block.any("IJKR")) {
            (Motion::Arc(direction), _) => self.arc(block, from, to, direction, reading)?,
            (_, None) => SegmentShape::Line,
            (_, Some(word)) => return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner: "G02 or G03" })),
        };
        Ok(Some((Segment { from, to, shape }, others)))
    }

    fn arc(
        &self,
        block: &BlockWords<'_>,
        from: Point,
        to: Point,
        direction: Direction,
        reading: &Reading,
    ) -> Result<SegmentShape, Fault> {
        let plane = self.plane;
        let (name, words) = center_words(plane);
        let [first, second, third] = plane.axes();
        let [start_first, start_second, _] = plane.of(from);
        let [end_first, end_second, _] = plane.of(to);
        let (start, end) = ([start_first, start_second], [end_first, end_second]);
        if let Some(word) = block.word(CENTERS[third]).filter(|word| word.value != 0.0) {
            return Err(word.fault(|word| ProgramErrorKind::CenterOffPlane { word, plane: name, words }));
        }
        // Where the arc as a whole is wrong: the first word that says so.
        let column = block.any("RIJK").or(block.motion.map(|(_, word)| word)).or(block.any(MOVING));
        let column = column.map_or(1, |word| word.column);
        let fault = |kind| Fault { column, kind };
        let given = [first, second].map(|axis| block.word(CENTERS[axis]));
        let center = match (block.word('R'), given) {
            (Some(word), [None, None]) => {
                let radius = self.length(word, reading)?;
                if radius == 0.0 {
                    return Err(fault(ProgramErrorKind::ZeroRadius));
                }
                if start == end {
                    return Err(word.fault(|word| ProgramErrorKind::CircleByRadius { word }));
                }
                arc::center(start, end, radius, direction, reading).map_err(fault)?
            }
            (Some(word), _) => return Err(word.fault(|word| ProgramErrorKind::RadiusAndCenter { word })),
            (None, [None, None]) => return Err(fault(ProgramErrorKind::NoCenter { words })),
            (None, given) => {
                let mut center = start;
                for (coordinate, word) in center.iter_mut().zip(given) {
                    let length = word.map(|word| self.length(word, reading)).transpose()?;
                    *coordinate = match (self.centers, length) {
                        (Distance::Incremental, length) => *coordinate + length.unwrap_or(0.0),
                        (Distance::Absolute, Some(length)) => length,
                        (Distance::Absolute, None) => return Err(fault(ProgramErrorKind::HalfCenter { words })),
                    };
                }
                arc::check(start, end, center, reading).map_err(fault)?;
                center
            }
        };
        for (value, axis) in center.into_iter().zip([first, second]) {
            within(value, column, || format!("the centre in {}", AXES[axis]))?;
        }
        Ok(SegmentShape::Arc { plane, center, direction })
    }
}

fn not_negative(word: Word<'_>) -> Result<f64, Fault> {
    let value = word.limited()?;
    if value < 0.0 { Err(word.fault(|word| ProgramErrorKind::Negative { word })) } else { Ok(value) }
}

/// What a block switches next to the motion, in the order of RS-274.
fn auxiliaries(block: &BlockWords<'_>, place: Place, events: &mut VecDeque<Event>) -> Result<(), Fault> {
    let mut auxiliary = |function| events.push_back(Event::Auxiliary { place, function });
    if let Some(word) = block.word('S') {
        auxiliary(Auxiliary::Speed(not_negative(word)?));
    }
    if let Some(word) = block.word('T') {
        auxiliary(Auxiliary::Tool(word.count()?));
    }
    // The length of a tool is counted as 0, but its number is one.
    block.word('H').map(|word| word.count()).transpose()?;
    if block.tool_change.is_some() {
        auxiliary(Auxiliary::ToolChange);
    }
    if let Some((spindle, _)) = block.spindle {
        auxiliary(Auxiliary::Spindle(spindle));
    }
    if let Some((coolant, _)) = block.coolant {
        auxiliary(Auxiliary::Coolant(coolant));
    }
    Ok(())
}
