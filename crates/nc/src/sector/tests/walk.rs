//! Point-by-point comparison of an arc, written down from the move table of the method alone.

use crate::Direction;

/// The path of the recurrence about the origin.
pub(super) struct Walk {
    /// Per quadrant: the move where F >= 0, the move where F < 0.
    table: [[[i64; 2]; 2]; 4],
    /// Per quadrant: the one that follows it.
    next: [usize; 4],
    quadrant: usize,
    pub(super) position: [i64; 2],
    pub(super) f: i64,
    /// Where the path has gone from one quadrant into the next.
    pub(super) crossed_at: Vec<[i64; 2]>,
}

impl Walk {
    pub(super) fn new(start: [i64; 2], quadrant: u8, direction: Direction) -> Walk {
        let (table, next) = match direction {
            Direction::Clockwise => {
                ([[[0, -1], [1, 0]], [[1, 0], [0, 1]], [[0, 1], [-1, 0]], [[-1, 0], [0, -1]]], [3, 0, 1, 2])
            }
            Direction::CounterClockwise => {
                ([[[-1, 0], [0, 1]], [[0, -1], [-1, 0]], [[1, 0], [0, -1]], [[0, 1], [1, 0]]], [1, 2, 3, 0])
            }
        };
        let quadrant = quadrant.into();
        Walk { table, next, quadrant, position: start, f: 0, crossed_at: Vec::new() }
    }

    pub(super) fn step(&mut self) {
        let [inward, outward] = self.table[self.quadrant];
        let shrinking = usize::from(inward[0] == 0);
        let growing = 1 - shrinking;
        if self.f >= 0 {
            self.f -= 2 * self.position[shrinking].abs() - 1;
            self.position[shrinking] += inward[shrinking];
        } else {
            self.f += 2 * self.position[growing].abs() + 1;
            self.position[growing] += outward[growing];
        }
        // The magnitude counter is at 0: the next quadrant. At the centre the old one is held.
        if self.position[shrinking] == 0 && self.position[growing] != 0 {
            self.quadrant = self.next[self.quadrant];
            self.crossed_at.push(self.position);
        }
    }
}
