//! Directions of rotation and the four quadrants.

use std::fmt;

/// The direction of rotation of an arc, seen from above the plane (G02 and G03).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// With the clock (G02; textbooks write SR).
    Clockwise,
    /// Against the clock (G03; textbooks write NR).
    CounterClockwise,
}

impl Direction {
    /// The opposite direction.
    #[must_use]
    pub fn reversed(self) -> Direction {
        match self {
            Direction::Clockwise => Direction::CounterClockwise,
            Direction::CounterClockwise => Direction::Clockwise,
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Direction::Clockwise => "clockwise",
            Direction::CounterClockwise => "counter-clockwise",
        })
    }
}

/// A quadrant of the plane about an arc's centre; displays as `Q1` … `Q4`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quadrant {
    /// x and y positive.
    I,
    /// x negative, y positive.
    II,
    /// x and y negative.
    III,
    /// x positive, y negative.
    IV,
}

impl Quadrant {
    /// All four, by [`index`](Quadrant::index).
    pub const ALL: [Quadrant; 4] = [Quadrant::I, Quadrant::II, Quadrant::III, Quadrant::IV];

    /// The number of the quadrant less one: 0 for Q1 to 3 for Q4.
    #[must_use]
    pub fn index(self) -> u8 {
        match self {
            Quadrant::I => 0,
            Quadrant::II => 1,
            Quadrant::III => 2,
            Quadrant::IV => 3,
        }
    }

    /// The quadrant that motion in this direction enters after this one.
    #[must_use]
    pub fn next(self, direction: Direction) -> Quadrant {
        match (self, direction) {
            (Quadrant::IV, Direction::CounterClockwise) | (Quadrant::II, Direction::Clockwise) => Quadrant::I,
            (Quadrant::I, Direction::CounterClockwise) | (Quadrant::III, Direction::Clockwise) => Quadrant::II,
            (Quadrant::II, Direction::CounterClockwise) | (Quadrant::IV, Direction::Clockwise) => Quadrant::III,
            (Quadrant::III, Direction::CounterClockwise) | (Quadrant::I, Direction::Clockwise) => Quadrant::IV,
        }
    }

    /// The signs (+1 or -1) of x and y inside the quadrant.
    #[must_use]
    pub fn signs(self) -> [i64; 2] {
        match self {
            Quadrant::I => [1, 1],
            Quadrant::II => [-1, 1],
            Quadrant::III => [-1, -1],
            Quadrant::IV => [1, -1],
        }
    }

    /// The axis (0 is x, 1 is y) whose coordinate grows in magnitude on an arc through the quadrant; the other shrinks.
    #[must_use]
    pub fn growing_axis(self, direction: Direction) -> usize {
        match (self, direction) {
            (Quadrant::I | Quadrant::III, Direction::Clockwise) => 0,
            (Quadrant::II | Quadrant::IV, Direction::CounterClockwise) => 0,
            (Quadrant::I | Quadrant::III, Direction::CounterClockwise) => 1,
            (Quadrant::II | Quadrant::IV, Direction::Clockwise) => 1,
        }
    }

    /// The signs (+1 or -1) of the motion in x and in y on an arc through the quadrant.
    ///
    /// ```
    /// use stepwave_nc::{Direction, Quadrant};
    ///
    /// assert_eq!(Quadrant::I.motion(Direction::Clockwise), [1, -1]);
    /// assert_eq!(Quadrant::I.motion(Direction::CounterClockwise), [-1, 1]);
    /// ```
    #[must_use]
    pub fn motion(self, direction: Direction) -> [i64; 2] {
        let [x, y] = self.signs();
        if self.growing_axis(direction) == 0 { [x, -y] } else { [-x, y] }
    }

    /// The quadrant that motion in this direction enters from a point other than the origin.
    ///
    /// The quadrant that it leaves on reaching the point is the one that the reverse motion enters.
    pub(crate) fn entered([x, y]: [i64; 2], direction: Direction) -> Quadrant {
        match direction {
            Direction::CounterClockwise if x > 0 && y >= 0 => Quadrant::I,
            Direction::CounterClockwise if x <= 0 && y > 0 => Quadrant::II,
            Direction::CounterClockwise if x < 0 => Quadrant::III,
            Direction::CounterClockwise => Quadrant::IV,
            Direction::Clockwise if x >= 0 && y > 0 => Quadrant::I,
            Direction::Clockwise if x < 0 && y >= 0 => Quadrant::II,
            Direction::Clockwise if y < 0 && x <= 0 => Quadrant::III,
            Direction::Clockwise => Quadrant::IV,
        }
    }
}

impl fmt::Display for Quadrant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Quadrant::I => "Q1",
            Quadrant::II => "Q2",
            Quadrant::III => "Q3",
            Quadrant::IV => "Q4",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Direction::{Clockwise, CounterClockwise};
    use super::Quadrant::{I, II, III, IV};
    use super::*;

    #[test]
    fn four_turns_come_back_and_a_reverse_turn_undoes_one() {
        for quadrant in Quadrant::ALL {
            for direction in [Clockwise, CounterClockwise] {
                let next = quadrant.next(direction);
                assert_eq!(next.next(direction.reversed()), quadrant);
                assert_eq!(next.next(direction).next(direction).next(direction), quadrant);
            }
            assert_eq!((quadrant.index() + 1) % 4, quadrant.next(CounterClockwise).index());
        }
    }

    #[test]
    fn directions_of_motion_are_those_of_the_textbooks_table() {
        let table = |direction| Quadrant::ALL.map(|quadrant| quadrant.motion(direction));
        assert_eq!(table(Clockwise), [[1, -1], [1, 1], [-1, 1], [-1, -1]]);
        assert_eq!(table(CounterClockwise), [[-1, 1], [-1, -1], [1, -1], [1, 1]]);
    }

    #[test]
    fn a_point_on_an_axis_belongs_to_the_quadrant_that_the_motion_enters() {
        let axes = [[7, 0], [0, 7], [-7, 0], [0, -7]];
        assert_eq!(axes.map(|point| Quadrant::entered(point, CounterClockwise)), [I, II, III, IV]);
        assert_eq!(axes.map(|point| Quadrant::entered(point, Clockwise)), [IV, I, II, III]);
        for quadrant in Quadrant::ALL {
            for direction in [Clockwise, CounterClockwise] {
                assert_eq!(Quadrant::entered(quadrant.signs(), direction), quadrant);
            }
        }
    }

    #[test]
    fn quadrants_and_directions_display_as_people_write_them() {
        assert_eq!(Quadrant::ALL.map(|quadrant| quadrant.to_string()), ["Q1", "Q2", "Q3", "Q4"]);
        assert_eq!(format!("{Clockwise}, {CounterClockwise}"), "clockwise, counter-clockwise");
    }
}
