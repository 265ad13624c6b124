//! A piece of a circle or of an even spiral in real numbers, and how far two of them are apart.

use std::f64::consts::TAU;

use crate::Direction;

/// An arc about a centre whose radius goes evenly with the angle; all lengths in BLU.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bow {
    center: [f64; 2],
    /// Radius at the start, and after the whole turn.
    radii: [f64; 2],
    /// Angle of the start in radians, and the turn from there: more than 0, up to 2π.
    first: f64,
    turn: f64,
    /// -1 clockwise.
    sign: f64,
    /// The end; of a commanded arc up to one BLU off the circle.
    end: [f64; 2],
}

/// Even parts of an arc whose ends are looked at next to the places that are worst in theory.
const EVEN: u32 = 24;

impl Bow {
    /// From one point to another, its radius going evenly from that of the start to that of the end.
    pub(super) fn spiral(ends: [[f64; 2]; 2], center: [f64; 2], turn: f64, direction: Direction) -> Bow {
        let [start, end] = ends.map(|point| between(center, point));
        let sign = if direction == Direction::Clockwise { -1.0 } else { 1.0 };
        let radii = [length(start), length(end)];
        Bow { center, radii, first: start[1].atan2(start[0]), turn, sign, end: ends[1] }
    }

    /// From one point about a centre on the circle through it, and then to the end.
    pub(super) fn circle(ends: [[f64; 2]; 2], center: [f64; 2], turn: f64, direction: Direction) -> Bow {
        let bow = Bow::spiral(ends, center, turn, direction);
        Bow { radii: [bow.radii[0]; 2], ..bow }
    }

    /// The point after a part of the turn, in radians.
    pub(super) fn after(&self, turn: f64) -> [f64; 2] {
        let (sin, cos) = (self.first + self.sign * turn).sin_cos();
        let radius = self.radius(turn);
        [self.center[0] + radius * cos, self.center[1] + radius * sin]
    }

    /// The angle from the start to the end, in radians.
    pub(super) fn turn(&self) -> f64 {
        self.turn
    }

    /// Radius at the start, in BLU.
    pub(super) fn radius_at_start(&self) -> f64 {
        self.radii[0]
    }

    fn radius(&self, turn: f64) -> f64 {
        let [first, last] = self.radii;
        first + (last - first) * turn / self.turn
    }

    /// The turn from the start to the direction of a vector from the centre, in radians, 0 to 2π.
    fn turn_to(&self, [x, y]: [f64; 2]) -> f64 {
        (self.sign * (y.atan2(x) - self.first)).rem_euclid(TAU)
    }

    /// The start, where the turn ends, and the end.
    fn ends(&self) -> [[f64; 2]; 3] {
        [self.after(0.0), self.after(self.turn), self.end]
    }

    /// The distance of a point.
    pub(super) fn distance(&self, point: [f64; 2]) -> f64 {
        let to_ends = self.ends().map(|end| length(between(end, point)));
        let arm = between(self.center, point);
        let turn = self.turn_to(arm);
        let aside = if turn <= self.turn { (length(arm) - self.radius(turn)).abs() } else { f64::INFINITY };
        to_ends.into_iter().fold(aside, f64::min)
    }

    /// The greatest distance of a point of this one from the other: it is at an end, where the distance from a part of
    /// the other is greatest, or where another part of it becomes the nearest.
    fn beyond(&self, other: &Bow) -> f64 {
        let ends = other.ends();
        let [start, ..] = ends;
        let bisector = |end: [f64; 2]| {
            let chord = between(start, end);
            ([0, 1].map(|axis| (start[axis] + end[axis]) / 2.0), [-chord[1], chord[0]])
        };
        let lines = [(other.center, between(other.center, self.center)), bisector(ends[1]), bisector(ends[2])];
        let of_ends = ends
            .into_iter()
            .flat_map(|end| [(end, between(end, self.center)), (other.center, between(other.center, end))]);
        let places = lines.into_iter().chain(of_ends);
        let critical = places.flat_map(|(through, along)| self.cut(through, along));
        let even = (0..=EVEN).map(|part| self.turn * f64::from(part) / f64::from(EVEN));
        let points = critical.chain(even).filter(|turn| *turn <= self.turn).map(|turn| self.after(turn));
        points.chain([self.end]).map(|point| other.distance(point)).fold(0.0, f64::max)
    }

    /// Where a straight line cuts the circle through the start: turns in radians, also such as are not on the arc.
    fn cut(&self, through: [f64; 2], along: [f64; 2]) -> impl Iterator<Item = f64> + use<> {
        let size = length(along);
        let along = along.map(|c| c / size);
        let arm = between(self.center, through);
        let (ahead, aside) = (arm[0] * along[0] + arm[1] * along[1], arm[0] * along[1] - arm[1] * along[0]);
        let half = (self.radii[0].powi(2) - aside.powi(2)).sqrt();
        let bow = *self;
        // No number where the line does not exist or does not meet the circle.
        [half, -half]
            .into_iter()
            .filter(|half| half.is_finite())
            .map(move |half| bow.turn_to([0, 1].map(|axis| arm[axis] + (half - ahead) * along[axis])))
    }

    /// The two-sided distance of two arcs: no point of either is farther from the other.
    pub(super) fn apart(&self, other: &Bow) -> f64 {
        self.beyond(other).max(other.beyond(self))
    }

    /// The two-sided distance from the straight line between two points.
    pub(super) fn apart_from_line(&self, [start, end]: [[f64; 2]; 2]) -> f64 {
        let chord = between(start, end);
        let square = chord[0].powi(2) + chord[1].powi(2);
        let on_chord = |part: f64| [0, 1].map(|axis| start[axis] + chord[axis] * part);
        let off_chord = |point: [f64; 2]| {
            let arm = between(start, point);
            let part = (arm[0] * chord[0] + arm[1] * chord[1]) / square;
            length(between(on_chord(if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }), point))
        };
        let across = self.cut(self.center, [-chord[1], chord[0]]);
        let to_ends = [start, end].map(|point| self.cut(self.center, between(self.center, point)));
        let even = (0..=EVEN).map(|part| self.turn * f64::from(part) / f64::from(EVEN));
        let turns = across.chain(to_ends.into_iter().flatten()).chain(even).filter(|turn| *turn <= self.turn);
        let there = turns.map(|turn| off_chord(self.after(turn))).fold(0.0, f64::max);
        (0..=8).map(|part| self.distance(on_chord(f64::from(part) / 8.0))).fold(there, f64::max)
    }
}

pub(super) fn between(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [to[0] - from[0], to[1] - from[1]]
}

pub(super) fn length([x, y]: [f64; 2]) -> f64 {
    f64::hypot(x, y)
}
