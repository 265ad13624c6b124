//! The extreme geometries of a box: where registers come to their least and greatest values, by construction.
//!
//! Lines and arcs have their ends at the corners of the box, on its axes, next to both, and at parts of its sides where a
//! line of such a slope brings a deviation to its extreme within a few steps. Arcs have both ends on one circle: (x, y)
//! and (y, x) are on one for any x and y, up to the corner itself; and there are multiples of the circles with many points.

use stepwave_nc::{Arc, Curve, Direction};

use super::line;

/// The coordinates of an axis: from the least to the greatest at equal distances.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Reach {
    /// The least, in BLU.
    pub least: i64,
    /// None is beyond this, in BLU.
    pub greatest: i64,
    /// Their distance, at least 1.
    pub step: u64,
}

/// Radii whose circles have more points than those on the axes.
const RICH: [i64; 3] = [5, 25, 65];

impl Reach {
    /// Every coordinate of magnitude up to this.
    #[must_use]
    pub fn within(greatest: i64) -> Reach {
        Reach { least: -greatest, greatest, step: 1 }
    }

    fn holds(self, place: i64) -> bool {
        let step = self.step.max(1);
        (self.least..=self.greatest).contains(&place) && place.abs_diff(self.least).is_multiple_of(step)
    }

    /// The coordinate at or below this place, and up to `around` of its neighbours on either side.
    fn near(self, place: i64, around: i64, marks: &mut Vec<i64>) {
        let place = place.clamp(self.least, self.greatest);
        let below =
            self.least.saturating_add_unsigned(place.abs_diff(self.least) / self.step.max(1) * self.step.max(1));
        let neighbours = (-around..=around).map(|by| {
            let offset = self.step.max(1).saturating_mul(by.unsigned_abs());
            if by < 0 { below.saturating_sub_unsigned(offset) } else { below.saturating_add_unsigned(offset) }
        });
        marks.extend(neighbours.filter(|place| self.holds(*place)));
    }

    /// The coordinates at and next to its ends, 0, and quarters, thirds and powers of two of its ends.
    #[must_use]
    pub fn marks(self) -> Vec<i64> {
        let mut marks = Vec::new();
        self.near(self.least, 2, &mut marks);
        self.near(self.greatest, 2, &mut marks);
        self.near(0, 3, &mut marks);
        for end in [self.least, self.greatest] {
            for part in [end / 4, end / 3, end / 2, end - end / 4] {
                self.near(part, 1, &mut marks);
            }
            let power = 1_i64 << end.unsigned_abs().max(1).ilog2().min(61);
            self.near(power * end.signum(), 1, &mut marks);
        }
        marks.sort_unstable();
        marks.dedup();
        marks
    }
}

/// Lines from the origin to the extreme points of a box, in as many axes as it has sides.
#[must_use]
pub fn points(sides: &[Reach]) -> Vec<Vec<i64>> {
    // Of many axes the corners and a few more: all of them at once would be too many.
    let marks = |side: &Reach| match sides.len() {
        0..=2 => side.marks(),
        3 => some(side.marks(), 9),
        _ => some(side.marks(), 4),
    };
    let mut points = vec![Vec::new()];
    for side in sides {
        let marks = marks(side);
        points = points
            .into_iter()
            .flat_map(|point: Vec<i64>| marks.iter().map(move |mark| [&point[..], &[*mark]].concat()))
            .collect();
    }
    points
}

/// The first, the last and others between them.
fn some(marks: Vec<i64>, most: usize) -> Vec<i64> {
    let last = marks.len().saturating_sub(1);
    let mut places: Vec<usize> = (0..most).map(|place| place * last / (most - 1)).collect();
    places.dedup();
    places.into_iter().filter_map(|place| marks.get(place).copied()).collect()
}

/// Lines from the origin to the extreme points of a box of two axes.
pub(super) fn lines(sides: [Reach; 2]) -> impl Iterator<Item = Curve> {
    points(&sides).into_iter().filter_map(|point| line::to([point[0], point[1]]))
}

/// The extreme arcs about the origin with both ends in a box, on one circle and inside one quadrant, each both ways round.
#[must_use]
pub fn arcs([x, y]: [Reach; 2]) -> Vec<[[i64; 2]; 2]> {
    let holds = |point: [i64; 2]| x.holds(point[0]) && y.holds(point[1]);
    let mut pairs: Vec<[[i64; 2]; 2]> = Vec::new();
    let signs = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
    let mut add = |from: [i64; 2], to: [i64; 2]| {
        if from != to && holds(from) && holds(to) {
            pairs.extend([[from, to], [to, from]]);
        }
    };
    // (u, v) and (v, u), in every quadrant.
    let mut sides = [x.marks(), y.marks()].concat();
    sides.iter_mut().for_each(|side| *side = side.saturating_abs());
    sides.sort_unstable();
    sides.dedup();
    for (place, u) in sides.iter().enumerate() {
        for v in &sides[place + 1..] {
            signs.iter().for_each(|[sx, sy]| add([sx * u, sy * v], [sx * v, sy * u]));
        }
    }
    let farthest = sides.last().copied().unwrap_or(0);
    for radius in RICH {
        let times = farthest / radius;
        for times in [times, times.saturating_sub(1)].into_iter().filter(|times| *times > 0) {
            let on = (0..=radius).filter_map(|u| {
                let square = radius * radius - u * u;
                let v = square.isqrt();
                (v * v == square).then_some([u * times, v * times])
            });
            let on: Vec<[i64; 2]> = on.collect();
            for (place, from) in on.iter().enumerate() {
                for to in &on[place + 1..] {
                    signs.iter().for_each(|[sx, sy]| {
                        add([sx * from[0], sy * from[1]], [sx * to[0], sy * to[1]]);
                    });
                }
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The arc between two points of one quadrant and one circle that stays in that quadrant.
#[must_use]
pub fn inside([from, to]: [[i64; 2]; 2]) -> Option<Curve> {
    let turn = i128::from(from[0]) * i128::from(to[1]) - i128::from(from[1]) * i128::from(to[0]);
    let direction = if turn > 0 { Direction::CounterClockwise } else { Direction::Clockwise };
    Arc::new(from, to, [0, 0], direction).ok().map(Curve::Arc)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_hold_the_ends_zero_and_their_neighbours_and_nothing_that_is_not_there() {
        let marks = Reach::within(1000).marks();
        for wanted in [-1000, -999, -1, 0, 1, 511, 512, 513, 750, 998, 999, 1000] {
            assert!(marks.contains(&wanted), "{wanted}");
        }
        let marks = Reach { least: 3, greatest: 99, step: 7 }.marks();
        assert!(marks.contains(&3) && marks.contains(&94) && marks.iter().all(|mark| (mark - 3) % 7 == 0), "{marks:?}");
        let (least, greatest) = (i64::MIN, i64::MAX);
        assert!(Reach { least, greatest, step: u64::MAX }.marks().contains(&least));
    }

    #[test]
    fn arcs_reach_the_corner_the_axes_and_the_points_next_to_them_in_both_directions() {
        let most = (1 << 20) - 1;
        let arcs = arcs([Reach::within(most); 2]);
        for [from, to] in [
            [[most, 0], [0, most]],
            [[0, -most], [most, 0]],
            [[most, 1], [1, most]],
            [[-most, most - 1], [1 - most, most]],
            [[most / 65 * 65, 0], [most / 65 * 33, most / 65 * 56]],
        ] {
            assert!(arcs.contains(&[from, to]) && arcs.contains(&[to, from]), "{from:?} {to:?}");
        }
        for pair in &arcs {
            let square = |[x, y]: [i64; 2]| i128::from(x).pow(2) + i128::from(y).pow(2);
            assert_eq!(square(pair[0]), square(pair[1]));
        }
    }
}
