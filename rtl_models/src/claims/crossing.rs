//! Arcs about the origin from one quadrant into others, with both ends on the same circle: over one axis up to four.

use stepwave_nc::{Arc, Crossing, Curve, Direction};
use stepwave_netlist::formula::{ByMode, Clause, Formula, name};

use super::arc::{DIRECTIONS, QUADRANTS, arc, x_grows};
use super::extremes::{self, Reach};
use super::{Claims, Kind, Region, coordinate, spread};
use crate::hardware::Hardware;
use crate::options::{END_POINT, EndPoint};
use crate::parts::{POSITION, QUAD, growing, shrinking};

/// The name of |x| or |y| where the path crosses an axis, in BLU; see [`Crossing::axis`].
const AXIS: &str = "axis";

/// Most bits of coordinates of which all arcs are listed; of more, some of the extreme ones.
pub(super) const WHOLE: u32 = 6;

/// What a model of arcs claims that crosses axes by itself. In a quadrant that the path comes to a second time other things hold.
pub(crate) const CLAIMS: Claims = Claims { modes: &[QUAD], counts_changes: true, ..Claims::of(Region::QuadrantArcs) };

/// Every arc, of hardware that crosses the axes there. With a counter for each axis the loader splits an arc at the axes.
pub(crate) fn every_arc(hardware: &Hardware, crossing: Crossing) -> Option<Region> {
    (hardware.get(&END_POINT) == EndPoint::Total).then_some(Region::Arcs(crossing))
}

/// An arc that crosses an axis does so at one place of each.
pub(crate) fn places(kind: &Kind) -> Vec<Clause> {
    if kind.symbols.iter().all(|symbol| symbol.name != AXIS) {
        return Vec::new();
    }
    vec![
        Clause::at_least_zero("no coordinate is beyond it", name(AXIS) - growing()),
        Clause::either("it is reached with the axis", [shrinking() - 1, growing() - name(AXIS), -growing()]),
    ]
}

/// What arcs of one kind have in common.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Course {
    word: &'static str,
    direction: Direction,
    /// The quadrant of the start, 0 to 3.
    first: usize,
    /// Axes that are crossed, 1 to 4.
    axes: usize,
}

impl Course {
    fn all() -> impl Iterator<Item = Course> {
        DIRECTIONS.into_iter().flat_map(|(word, direction)| {
            (0..QUADRANTS.len()).flat_map(move |first| (1..=4).map(move |axes| Course { word, direction, first, axes }))
        })
    }

    fn of(arc: &Arc) -> Option<Course> {
        let (word, direction) = DIRECTIONS.into_iter().find(|(_, direction)| *direction == arc.direction())?;
        let axes = arc.crossings();
        (axes > 0).then_some(Course { word, direction, first: arc.start_quadrant().index().into(), axes })
    }

    fn name(self) -> String {
        let Course { word, first, axes, .. } = self;
        format!("{word}{} over {axes} {}", first + 1, if axes == 1 { "axis" } else { "axes" })
    }

    /// The quadrant of the end.
    fn last(self) -> usize {
        match self.direction {
            Direction::CounterClockwise => (self.first + self.axes) % 4,
            Direction::Clockwise => (self.first + 4 - self.axes % 4) % 4,
        }
    }

    /// The coordinate that shrinks and the one that grows in a quadrant, of these two.
    fn roles<T>(self, quadrant: usize, [x, y]: [T; 2]) -> [T; 2] {
        if x_grows(quadrant, self.direction) { [y, x] } else { [x, y] }
    }

    fn premises(self, crossing: Crossing) -> Vec<Clause> {
        let square = |x: &str, y: &str| name(x) * name(x) + name(y) * name(y);
        let [shrinks, grows] = self.roles(self.first, [name("xs"), name("ys")]);
        let [end_shrinks, end_grows] = self.roles(self.last(), [name("xt"), name("yt")]);
        let (axis, radius) = (|| name(AXIS), || square("xs", "ys"));
        let mut premises = Clause::zero("both ends are on one circle", radius() - square("xt", "yt")).to_vec();
        premises.extend([
            Clause::at_least_zero("it starts inside", shrinks.clone() - 1),
            Clause::at_least_zero("it ends inside", end_grows.clone() - 1),
            Clause::at_least_zero("an axis is crossed off the centre", axis() - 1),
        ]);
        premises.extend(match crossing {
            // The least number from 1 on whose square is R² - 1 or more.
            Crossing::PathExtreme => [
                Clause::at_least_zero("an axis is crossed from outside", axis() * axis() - radius() + 1),
                Clause::either(
                    "an axis is crossed as soon as that",
                    [radius() - 2 - (axis() - 1) * (axis() - 1), -axis() + 1],
                ),
            ],
            // The number nearest to R: R² is between (A - 1/2)² and (A + 1/2)².
            Crossing::RoundedRadius => [
                Clause::at_least_zero("an axis is crossed no farther in", axis() * axis() + axis() - radius()),
                Clause::at_least_zero("an axis is crossed no farther out", radius() - axis() * axis() + axis() - 1),
            ],
        });
        // So it is by these: no coordinate is beyond R, nor is a whole number between the place and R.
        premises
            .extend(["xs", "ys", "xt", "yt"].map(|end| Clause::at_least_zero("no end is beyond", axis() - name(end))));
        if self.axes == 4 {
            premises.extend([
                Clause::at_least_zero("the end is not ahead of the start", grows - end_grows),
                Clause::at_least_zero("the end is not ahead of the start", end_shrinks - shrinks),
            ]);
        }
        premises
    }

    fn kind(self, crossing: Crossing) -> Kind {
        let [x, y] = QUADRANTS[self.last()].map(i128::from);
        let end = |what: &str, axis: usize, at: Formula| Clause::zero(what, POSITION.of(axis).value() - at);
        let growing = (0..QUADRANTS.len()).map(|quadrant| i128::from(x_grows(quadrant, self.direction)));
        Kind {
            name: self.name(),
            symbols: symbol_names().map(coordinate).to_vec(),
            constants: Vec::new(),
            by_mode: vec![ByMode {
                name: "x_grows".to_owned(),
                register: QUAD.name().to_owned(),
                values: growing.collect(),
            }],
            premises: self.premises(crossing),
            goals: [end("x ends", 0, x * name("xt")), end("y ends", 1, y * name("yt"))].concat(),
        }
    }

    /// Arcs between points of these magnitudes on one circle, each with what its symbols are: first those whose ends differ
    /// in more than signs and order.
    fn between(self, crossing: Crossing, circles: &[Vec<[i64; 2]>]) -> Vec<(Curve, Vec<i128>)> {
        let sorted = |[x, y]: [i64; 2]| [x.min(y), x.max(y)];
        let (mut apart, mut alike) = (Vec::new(), Vec::new());
        for circle in circles {
            let starts = circle.iter().copied().filter(|start| self.roles(self.first, *start)[0] > 0);
            for start in starts {
                let ends = circle.iter().copied().filter(|end| self.roles(self.last(), *end)[1] > 0);
                // With four axes the end is not ahead.
                let ends = ends
                    .filter(|end| self.axes < 4 || self.roles(self.first, *end)[1] <= self.roles(self.first, start)[1]);
                for end in ends {
                    let own = if sorted(start) == sorted(end) { &mut alike } else { &mut apart };
                    own.push((start, end));
                }
            }
        }
        let signed = |quadrant: usize, [x, y]: [i64; 2]| [QUADRANTS[quadrant][0] * x, QUADRANTS[quadrant][1] * y];
        let of = |(start, end): ([i64; 2], [i64; 2])| {
            let curve = arc(signed(self.first, start), signed(self.last(), end), self.direction)?;
            Some((curve, numbers(crossing, start, end)))
        };
        apart.into_iter().chain(alike).filter_map(of).collect()
    }
}

fn symbol_names() -> [&'static str; 5] {
    ["xs", "ys", "xt", "yt", AXIS]
}

/// What the symbols of an arc are, by the magnitudes of its ends.
fn numbers(crossing: Crossing, start: [i64; 2], end: [i64; 2]) -> Vec<i128> {
    let axis = crossing.axis(square(start));
    [start, end].concat().into_iter().map(i128::from).chain(i128::try_from(axis)).collect()
}

/// The squared distance from the centre, in BLU².
fn square([x, y]: [i64; 2]) -> u128 {
    u128::from(x.unsigned_abs()).pow(2) + u128::from(y.unsigned_abs()).pow(2)
}

pub(super) fn kinds(crossing: Crossing) -> Vec<Kind> {
    Course::all().map(|course| course.kind(crossing)).collect()
}

pub(super) fn symbols(crossing: Crossing, kind: &str, curve: &Curve) -> Option<Vec<i128>> {
    let Curve::Arc(arc) = curve else { return None };
    let own = Course::of(arc)?.name() == kind && arc.center() == [0, 0];
    let magnitude = |point: [i64; 2]| point.map(i64::abs);
    own.then(|| numbers(crossing, magnitude(arc.from()), magnitude(arc.to())))
}

/// The full circle of this radius.
pub(super) fn whole(radius: i64) -> Option<Curve> {
    arc([radius, 0], [radius, 0], Direction::CounterClockwise)
}

/// The points of every circle with coordinates of k bits, where it crosses the axes too, by their magnitudes.
fn circles(crossing: Crossing, k: u32) -> Vec<Vec<[i64; 2]>> {
    let greatest = (1_i64 << k.min(52)) - 1;
    let mut points: Vec<[i64; 2]> = if k > WHOLE {
        extremes::arcs([Reach { least: 0, greatest, step: 1 }; 2]).concat()
    } else {
        (0..=greatest).flat_map(|x| (0..=greatest).map(move |y| [x, y])).collect()
    };
    points.retain(|point| *point != [0, 0] && crossing.axis(square(*point)) <= u128::from(greatest.unsigned_abs()));
    points.sort_unstable_by_key(|point| (square(*point), *point));
    points.dedup();
    points.chunk_by(|a, b| square(*a) == square(*b)).map(<[_]>::to_vec).collect()
}

/// Arcs of a kind with what its symbols are: all, or of large coordinates some of the extreme ones.
pub(super) fn curves_of(crossing: Crossing, kind: &str, k: u32) -> Vec<(Curve, Vec<i128>)> {
    let course = Course::all().find(|course| course.name() == kind);
    course.map(|course| course.between(crossing, &circles(crossing, k))).unwrap_or_default()
}

pub(super) fn curves(crossing: Crossing, k: u32, most: usize) -> Vec<Curve> {
    let circles = circles(crossing, k);
    let all = Course::all().flat_map(|course| course.between(crossing, &circles)).map(|(curve, _)| curve).collect();
    spread(all, most)
}
