//! Arcs about the origin inside one quadrant, with both ends on the same circle.

use stepwave_nc::{Arc, Curve, Direction};
use stepwave_netlist::formula::{Clause, name};

use super::extremes::{self, Reach};
use super::{Kind, coordinate, spread};
use crate::parts::POSITION;

/// Quadrants by the signs of their coordinates.
pub(super) const QUADRANTS: [[i64; 2]; 4] = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
pub(super) const DIRECTIONS: [(&str, Direction); 2] =
    [("SR", Direction::Clockwise), ("NR", Direction::CounterClockwise)];

/// Most bits of coordinates of which all arcs are listed; of more, the extreme ones.
pub(super) const WHOLE: u32 = 8;

/// |x| grows in this quadrant, 0 to 3: clockwise in Q1 and Q3.
pub(super) fn x_grows(quadrant: usize, direction: Direction) -> bool {
    (direction == Direction::Clockwise) == quadrant.is_multiple_of(2)
}

pub(super) fn kinds() -> Vec<Kind> {
    let mut kinds = Vec::new();
    let squares = |x: &str, y: &str| name(x) * name(x) + name(y) * name(y);
    for (word, direction) in DIRECTIONS {
        for (quadrant, [x, y]) in QUADRANTS.into_iter().enumerate() {
            let [x, y] = [x, y].map(i128::from);
            // From the shrinking coordinate, which is not 0 at first, to the growing one, which is not 0 in the end.
            let (grown, shrunk, first, last) = if x_grows(quadrant, direction) {
                (name("xt") - name("xs"), name("ys") - name("yt"), name("ys"), name("xt"))
            } else {
                (name("yt") - name("ys"), name("xs") - name("xt"), name("xs"), name("yt"))
            };
            let mut premises =
                Clause::zero("both ends are on one circle", squares("xs", "ys") - squares("xt", "yt")).to_vec();
            premises.extend([
                Clause::at_least_zero("one coordinate grows", grown - 1),
                Clause::at_least_zero("the other shrinks", shrunk - 1),
                Clause::at_least_zero("it starts inside", first - 1),
                Clause::at_least_zero("it ends inside", last - 1),
            ]);
            let ends = [
                Clause::zero("x ends", POSITION.of(0).value() - x * name("xt")),
                Clause::zero("y ends", POSITION.of(1).value() - y * name("yt")),
            ];
            kinds.push(Kind {
                name: format!("{word}{}", quadrant + 1),
                symbols: ["xs", "ys", "xt", "yt"].map(coordinate).to_vec(),
                constants: vec![("x_grows".to_owned(), i128::from(x_grows(quadrant, direction)))],
                by_mode: Vec::new(),
                premises,
                goals: ends.into_iter().flatten().collect(),
            });
        }
    }
    kinds
}

pub(super) fn symbols(kind: &str, curve: &Curve) -> Option<Vec<i128>> {
    let Curve::Arc(arc) = curve else { return None };
    let (word, _) = DIRECTIONS.into_iter().find(|(_, direction)| *direction == arc.direction())?;
    let sectors = arc.sectors(stepwave_nc::Crossing::RoundedRadius);
    let [sector] = sectors[..] else { return None };
    let own = format!("{word}{}", sector.quadrant.index() + 1) == kind;
    let magnitude = |point: [i64; 2]| point.map(|coordinate| i128::from(coordinate).abs());
    let [[xs, ys], [xt, yt]] = [magnitude(arc.from()), magnitude(arc.to())];
    (own && arc.center() == [0, 0]).then(|| vec![xs, ys, xt, yt])
}

pub(super) fn arc(from: [i64; 2], to: [i64; 2], direction: Direction) -> Option<Curve> {
    Arc::new(from, to, [0, 0], direction).ok().map(Curve::Arc)
}

/// The quarter circle of this radius in the first quadrant.
pub(super) fn quarter(radius: i64) -> Option<Curve> {
    arc([radius, 0], [0, radius], Direction::CounterClockwise)
}

pub(super) fn curves(k: u32, most: usize) -> Vec<Curve> {
    let greatest = (1_i64 << k.min(52)) - 1;
    if k > WHOLE {
        let pairs = extremes::arcs([Reach::within(greatest); 2]);
        return spread(pairs, most).into_iter().filter_map(extremes::inside).collect();
    }
    let mut points: Vec<(i64, [i64; 2])> =
        (0..=greatest).flat_map(|x| (0..=greatest).map(move |y| (x * x + y * y, [x, y]))).collect();
    points.sort_unstable();
    let mut all = Vec::new();
    for circle in points.chunk_by(|a, b| a.0 == b.0) {
        for (_, from) in circle {
            for (_, to) in circle.iter().filter(|(_, to)| to != from) {
                // x grows: clockwise in the first quadrant.
                let grows = to[0] > from[0];
                for (quadrant, signs) in QUADRANTS.into_iter().enumerate() {
                    let direction =
                        DIRECTIONS.into_iter().find(|(_, direction)| x_grows(quadrant, *direction) == grows);
                    let signed = |point: &[i64; 2]| [signs[0] * point[0], signs[1] * point[1]];
                    all.extend(direction.map(|(_, direction)| (signed(from), signed(to), direction)));
                }
            }
        }
    }
    spread(all, most).into_iter().filter_map(|(from, to, direction)| arc(from, to, direction)).collect()
}
