//! Free curves of a program: G05 and G05.1, whole or as chords, and the NURBS between G05.2 and G05.3 as chords.

use std::collections::VecDeque;

use super::block::{BlockWords, Halt, Motion};
use super::error::{Fault, ProgramErrorKind};
use super::modal::{AXES, Modal, within};
use super::words::Word;
use super::{Event, Reading};
use crate::nurbs::{NURBS_DEGREE, NURBS_POINTS, Piece, pieces};
use crate::{Controls, Feed, FeedAxes, Move, Others, Place, Plane, Point, Segment, SegmentShape, Side, nurbs};

/// The order of a NURBS without L, and the least one.
const USUAL_ORDER: usize = 3;
/// Most chords of a curve.
const CHORDS_LIMIT: usize = 1 << 20;

/// What free curves leave to the blocks after them.
#[derive(Debug, Default)]
pub(super) struct Curves {
    /// From the end of the last G05 to its second control point, in BLU, where the block before was one.
    handle: Option<[f64; 2]>,
    /// Between G05.2 and G05.3.
    open: Option<Open>,
}

/// A NURBS that is being given.
#[derive(Debug)]
struct Open {
    /// Its G05.2.
    word: String,
    order: usize,
    /// Along both axes of the plane, in BLU, and the weight.
    points: Vec<[f64; 3]>,
}

impl Curves {
    /// The block is not a G05: the next one has nothing to continue.
    pub(super) fn interrupted(&mut self) {
        self.handle = None;
    }

    /// Checks that a NURBS is not left open by a block, or by the end of the program.
    pub(super) fn check(&self, block: Option<&BlockWords<'_>>) -> Result<(), Fault> {
        let Some(open) = &self.open else { return Ok(()) };
        let odd = |word: Option<Word<'_>>| {
            let column = word.map_or(1, |word| word.column);
            Err(Fault { column, kind: ProgramErrorKind::NurbsOpen { word: open.word.clone() } })
        };
        let Some(block) = block else { return odd(None) };
        let motion = block.motion.filter(|(motion, _)| *motion != Motion::Nurbs).map(|(_, word)| word);
        let others = [block.plane.map(|slot| slot.1), block.compensation.map(|slot| slot.1)];
        let moves = [block.home, block.machine, block.cycles_off].map(|slot| slot.map(|slot| slot.1));
        let ends = block.halt.filter(|(halt, _)| *halt == Halt::End).map(|(_, word)| word);
        let word =
            motion.into_iter().chain(others.into_iter().flatten()).chain(moves.into_iter().flatten()).chain(ends);
        match word.min_by_key(|word| word.column) {
            Some(word) => odd(Some(word)),
            None => Ok(()),
        }
    }
}

impl Modal {
    /// Runs the free curve of a block, if it has one.
    pub(super) fn curve(
        &mut self,
        block: &BlockWords<'_>,
        place: Place,
        feed: Option<f64>,
        reading: &Reading,
        events: &mut VecDeque<Event>,
    ) -> Result<bool, Fault> {
        let free = matches!(self.motion, Some(Motion::Nurbs | Motion::Cubic | Motion::Quadratic));
        if let (true, Some(word)) = (free || block.nurbs_end.is_some(), block.any("ABCUVW")) {
            return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner: "G00 to G03" }));
        }
        let pieces = match (block.nurbs_end, self.motion) {
            (Some(((), word)), _) => self.nurbs_end(block, word)?,
            (None, Some(Motion::Nurbs)) => {
                self.curves.interrupted();
                self.nurbs_block(block, reading)?;
                return Ok(true);
            }
            (None, Some(motion @ (Motion::Cubic | Motion::Quadratic))) => {
                let letters = match (block.times(), block.blends()) {
                    (_, true) => "XYZIJKR",
                    (true, false) => "XYZIJKRQ",
                    (false, false) => "XYZIJKRQP",
                };
                let Some(first) = block.motion.map(|(_, word)| word).or(block.any(letters)) else {
                    return Ok(false);
                };
                if let Some(((), word)) = block.machine {
                    self.by_machine(word)?;
                }
                let segment = self.bezier(block, first, motion, reading)?;
                let Some(curve) = segment.bezier() else { return Ok(false) };
                if reading.whole {
                    let feed = self.feed_of_move(block, feed, FeedAxes::Linear)?;
                    if !curve.is_point() {
                        self.moves((segment, Others::at(self.others)), 1, feed, place, events);
                        self.position = segment.to;
                    }
                    return Ok(true);
                }
                vec![curve.piece()]
            }
            _ => {
                if block.motion.is_some() || block.home.is_some() {
                    self.curves.interrupted();
                }
                return Ok(false);
            }
        };
        let feed = self.feed_of_move(block, feed, FeedAxes::Linear)?;
        let column = block.nurbs_end.map(|slot| slot.1).or(block.motion.map(|slot| slot.1)).or(block.any("XYPQ"));
        let column = column.map_or(1, |word| word.column);
        let ends = self.ends_of_chords(&pieces, column, reading)?;
        self.draw(&ends, feed, place, events);
        if block.nurbs_end.is_some() {
            self.motion = None;
        }
        Ok(true)
    }

    /// The curve of G05 or G05.1.
    fn bezier(
        &mut self,
        block: &BlockWords<'_>,
        first: Word<'_>,
        motion: Motion,
        reading: &Reading,
    ) -> Result<Segment, Fault> {
        let name = if motion == Motion::Cubic { "G05" } else { "G05.1" };
        if self.plane != Plane::Xy {
            return Err(first.fault(|word| ProgramErrorKind::SplinePlane { word, name }));
        }
        if self.side != Side::On || self.compensated {
            return Err(first.fault(|word| ProgramErrorKind::SplineUnderCompensation { word }));
        }
        let cubic = motion == Motion::Cubic;
        let own = |letter, others: bool| block.word(letter).filter(|_| !cubic && !others);
        if let Some(word) = block.any("ZKR").or(own('P', block.times())).or(own('Q', block.blends())) {
            return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner: "G02 or G03" }));
        }
        if let Some(word) = block.word('P').filter(|_| cubic && block.times()) {
            return Err(word.fault(|word| ProgramErrorKind::TwoOwners { word }));
        }
        if block.any("XY").is_none() {
            return Err(first.fault(|word| ProgramErrorKind::SplineEnd { word, name }));
        }
        let offset = |letter: char| block.word(letter).map(|word| self.length(word, reading)).transpose();
        let [[x, y, _], end] = [self.position, self.ends(block, reading)?];
        let (from, to) = ([x, y], [end[0], end[1]]);
        let [i, j] = [offset('I')?, offset('J')?];
        let by = |at: [f64; 2], offset: [f64; 2]| [at[0] + offset[0], at[1] + offset[1]];
        let controls = if motion == Motion::Quadratic {
            let handle = [i.unwrap_or(0.0), j.unwrap_or(0.0)];
            if handle == [0.0; 2] {
                return Err(first.fault(|word| ProgramErrorKind::SplineHandle { word, name }));
            }
            self.curves.interrupted();
            Controls::One(by(from, handle))
        } else {
            let start = match ([i, j], self.curves.handle) {
                ([Some(i), Some(j)], _) => [i, j],
                ([None, None], Some([p, q])) => [-p, -q],
                _ => return Err(first.fault(|word| ProgramErrorKind::SplineHandle { word, name })),
            };
            let [Some(p), Some(q)] = [offset('P')?, offset('Q')?] else {
                return Err(first.fault(|word| ProgramErrorKind::SplineEndHandle { word }));
            };
            self.curves.handle = Some([p, q]);
            Controls::Two([by(from, start), by(to, [p, q])])
        };
        Ok(Segment { from: self.position, to: end, shape: SegmentShape::Bezier(controls) })
    }

    /// The place that the words X, Y and Z give.
    fn ends(&self, block: &BlockWords<'_>, reading: &Reading) -> Result<Point, Fault> {
        let mut to = self.position;
        for (coordinate, letter) in to.iter_mut().zip(AXES) {
            if let Some(word) = block.word(letter) {
                let start = self.origin(block, letter, *coordinate, reading);
                *coordinate = within(start + self.length(word, reading)?, word.column, || letter.to_string())?;
            }
        }
        Ok(to)
    }

    /// A block with a control point of a NURBS, or its beginning.
    fn nurbs_block(&mut self, block: &BlockWords<'_>, reading: &Reading) -> Result<(), Fault> {
        let Some(first) = block.motion.map(|(_, word)| word).or(block.any("XYZPLIJKQR")) else { return Ok(()) };
        if self.side != Side::On || self.compensated {
            return Err(first.fault(|word| ProgramErrorKind::SplineUnderCompensation { word }));
        }
        let [one, other, third] = self.plane.axes().map(|axis| AXES[axis]);
        let odd = block.any("IJKQR").or(block.word(third));
        if let Some(word) = odd {
            return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner: "G01, G02 or G03" }));
        }
        let weight = block.word('P').filter(|_| !block.times()).map(|word| weight(word)).transpose()?;
        let order = block.word('L').map(order).transpose()?;
        let given = [one, other].map(|letter| block.word(letter).is_some());
        if given[0] != given[1] {
            return Err(first.fault(|word| ProgramErrorKind::NurbsHalfPoint { word, axes: [one, other] }));
        }
        let to = self.plane.of(self.ends(block, reading)?);
        let start = self.plane.of(self.position);
        let opens = self.curves.open.is_none();
        let open = self.curves.open.get_or_insert_with(|| {
            let weight = weight.filter(|_| !given[0]).unwrap_or(1.0);
            Open { word: first.name(), order: USUAL_ORDER, points: vec![homogeneous(start, weight)] }
        });
        open.order = order.unwrap_or(open.order);
        if given[0] {
            if open.points.len() == NURBS_POINTS {
                return Err(first.fault(|word| ProgramErrorKind::NurbsTooMany { word }));
            }
            open.points.push(homogeneous(to, weight.unwrap_or(1.0)));
        } else if weight.is_some() && !opens {
            return Err(first.fault(|word| ProgramErrorKind::NurbsWeightAlone { word, axes: [one, other] }));
        }
        Ok(())
    }

    /// The curve that a G05.3 ends.
    fn nurbs_end(&mut self, block: &BlockWords<'_>, word: Word<'_>) -> Result<Vec<Piece<2>>, Fault> {
        if let Some(odd) = block.any("XYZIJKRQL").or(block.word('P').filter(|_| !block.times())) {
            return Err(odd.fault(|word| ProgramErrorKind::Unused { word, owner: "G05.2" }));
        }
        self.curves.interrupted();
        let Some(open) = self.curves.open.take() else {
            return Err(word.fault(|word| ProgramErrorKind::NurbsNotOpen { word }));
        };
        let (count, order) = (open.points.len(), open.order);
        if count < order {
            return Err(word.fault(|word| ProgramErrorKind::NurbsTooFew { word, count, order }));
        }
        let degree = order - 1;
        let last = count - degree;
        // NURBS_POINTS at most.
        let knots: Vec<f64> = (0..=count + degree).map(|index| index.saturating_sub(degree).min(last) as f64).collect();
        Ok(pieces(degree, &open.points, &knots))
    }

    /// The ends of the chords of a curve.
    fn ends_of_chords(&self, pieces: &[Piece<2>], column: u64, reading: &Reading) -> Result<Vec<Point>, Fault> {
        let plane = self.plane;
        let [.., third] = plane.of(self.position);
        let mut ends: Vec<Point> = Vec::new();
        for piece in pieces {
            piece.chords(reading.chords, CHORDS_LIMIT, &mut |[a, b]| ends.push(plane.point([a, b, third])));
            if ends.len() >= CHORDS_LIMIT {
                return Err(Fault { column, kind: ProgramErrorKind::TooManyChords { limit: CHORDS_LIMIT } });
            }
        }
        Ok(ends)
    }

    /// The chords, each a move; under G93 each has its share of the time.
    fn draw(&mut self, ends: &[Point], feed: Feed, place: Place, events: &mut VecDeque<Event>) {
        let starts = std::iter::once(self.position).chain(ends.iter().copied());
        let pairs = starts.zip(ends.iter().copied()).filter(|(from, to)| from != to);
        let chords: Vec<Segment> = pairs.map(|(from, to)| Segment { from, to, shape: SegmentShape::Line }).collect();
        let length: f64 = chords.iter().map(Segment::length).sum();
        for segment in chords {
            let feed = match feed {
                Feed::Inverse(number) => Feed::Inverse(number * length / segment.length()),
                other => other,
            };
            events.push_back(Event::Move(Move {
                place,
                segment,
                feed,
                plane: self.plane,
                side: Side::On,
                path: self.path,
                others: Others::at(self.others),
                chord: true,
            }));
        }
        self.position = ends.last().copied().unwrap_or(self.position);
    }

    /// Checks that L and Q belong to the motion in force.
    pub(super) fn check_curve_words(&self, block: &BlockWords<'_>) -> Result<(), Fault> {
        let ends = block.nurbs_end.is_some();
        let owners = [
            ('L', self.motion == Some(Motion::Nurbs), "G05.2"),
            ('Q', block.blends() || self.motion == Some(Motion::Cubic), "G05 or G64"),
        ];
        for (letter, used, owner) in owners {
            if let Some(word) = block.word(letter).filter(|_| !used && !ends) {
                return Err(word.fault(|word| ProgramErrorKind::Unused { word, owner }));
            }
        }
        Ok(())
    }
}

fn homogeneous([a, b, _]: [f64; 3], weight: f64) -> [f64; 3] {
    [a * weight, b * weight, weight]
}

/// The weight of a control point.
fn weight(word: Word<'_>) -> Result<f64, Fault> {
    let most = nurbs::NURBS_MOST as f64;
    let right = word.value > 0.0 && word.value <= most && word.value >= 1.0 / most;
    if right { Ok(word.value) } else { Err(word.fault(|word| ProgramErrorKind::NurbsPointWeight { word })) }
}

/// The order of a NURBS: its degree and 1.
fn order(word: Word<'_>) -> Result<usize, Fault> {
    let order = word.count().ok().and_then(|order| usize::try_from(order).ok());
    let most = NURBS_DEGREE + 1;
    let order = order.filter(|order| (USUAL_ORDER..=most).contains(order));
    order.ok_or_else(|| word.fault(|word| ProgramErrorKind::NurbsOrder { word, least: USUAL_ORDER, most }))
}
