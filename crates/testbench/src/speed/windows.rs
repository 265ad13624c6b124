//! Windows over the last rows of a step table, row by row: exact, whatever the distances of the rows.

use serde::{Deserialize, Serialize};

use super::Window;
use crate::checkpoint::GREATEST;

/// Steps of a window.
pub(super) const WINDOW: usize = 32;

/// The rows so far, and the slowest and the fastest window of them.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub(crate) struct Windows {
    /// Number of the last row; `None` before row 0.
    pub(super) row: Option<u64>,
    /// Clock of row 0.
    first: u64,
    /// Places and clocks of the last rows, those of row r in slot r modulo [`WINDOW`]; of a place a number for each axis.
    places: Vec<i64>,
    clocks: Vec<u64>,
    /// The first slowest window and the first fastest one.
    pub(super) least: Option<Window>,
    pub(super) greatest: Option<Window>,
}

impl Windows {
    /// Before row 0, of this many axes.
    pub(crate) fn new(axes: usize) -> Windows {
        let (places, clocks) = (vec![0; axes * WINDOW], vec![0; WINDOW]);
        Windows { row: None, first: 0, places, clocks, least: None, greatest: None }
    }

    /// With row 0.
    pub(crate) fn begun(place: &[i64], clock: u64) -> Windows {
        let mut windows = Windows::new(place.len());
        windows.row(place, clock);
        windows
    }

    /// The slot of a row.
    fn slot(row: u64) -> usize {
        // Less than `WINDOW`.
        usize::try_from(row % WINDOW as u64).unwrap_or(0)
    }

    /// Numbers of the place in a slot.
    fn numbers(&self, slot: usize) -> std::ops::Range<usize> {
        let axes = self.places.len() / WINDOW;
        slot * axes..(slot + 1) * axes
    }

    /// Takes the next row: where the tool is after it, and its clock. Gives the window that ends with it.
    pub(crate) fn row(&mut self, place: &[i64], clock: u64) -> Option<Window> {
        let row = self.row.map_or(0, |row| row + 1);
        if row == 0 {
            self.first = clock;
        }
        let slot = Windows::slot(row);
        let window = (row >= WINDOW as u64).then(|| {
            let square = square(place, &self.places[self.numbers(slot)]);
            Window { square, clocks: clock - self.clocks[slot], step: row }
        });
        if let Some(window) = window {
            self.see(window);
        }
        self.put(row, place, clock);
        self.row = Some(row);
        window
    }

    /// A window is slower or faster than every one before.
    pub(super) fn is_extreme(&self, window: Window) -> bool {
        self.least.is_none_or(|least| window.is_slower(least))
            || self.greatest.is_none_or(|greatest| greatest.is_slower(window))
    }

    /// Takes a window, if it is slower or faster than every one before.
    pub(super) fn see(&mut self, window: Window) {
        if self.least.is_none_or(|least| window.is_slower(least)) {
            self.least = Some(window);
        }
        if self.greatest.is_none_or(|greatest| greatest.is_slower(window)) {
            self.greatest = Some(window);
        }
    }

    /// Place and clock of a row that is one of the last [`WINDOW`].
    pub(super) fn at(&self, row: u64) -> (&[i64], u64) {
        let slot = Windows::slot(row);
        (&self.places[self.numbers(slot)], self.clocks[slot])
    }

    /// Sets place and clock of one of the last rows.
    pub(super) fn put(&mut self, row: u64, place: &[i64], clock: u64) {
        let slot = Windows::slot(row);
        let numbers = self.numbers(slot);
        self.places[numbers].copy_from_slice(place);
        self.clocks[slot] = clock;
    }

    /// Clocks from row 0 to the last row.
    pub(super) fn elapsed(&self) -> u64 {
        self.row.map_or(0, |row| self.at(row).1 - self.first)
    }

    /// The slowest and the fastest window; of less than [`WINDOW`] steps there is one, which is all of them. `None`
    /// without a step.
    pub(super) fn extremes(&self) -> Option<[Window; 2]> {
        let step = self.row.filter(|&row| row > 0)?;
        if let (Some(least), Some(greatest)) = (self.least, self.greatest) {
            return Some([least, greatest]);
        }
        let square = square(self.at(step).0, self.at(0).0);
        Some([Window { square, clocks: self.elapsed(), step }; 2])
    }

    /// What was written down, with the place of the tool, may be continued: rows follow each other, and no number is beyond
    /// all measure.
    pub(super) fn is_sound(&self, axes: usize, place: &[i64]) -> bool {
        let sizes = self.clocks.len() == WINDOW && self.places.len() == axes * WINDOW && place.len() == axes;
        let mut places = self.places.iter().chain(place);
        let kept = self.row.map_or(0..0, |row| (row + 1).saturating_sub(WINDOW as u64)..row + 1);
        sizes
            && places.all(|place| place.unsigned_abs() <= GREATEST)
            && self.row.is_none_or(|row| row <= GREATEST && self.at(row).1 <= GREATEST)
            && kept.clone().all(|row| self.at(row).1 >= self.first)
            && kept.clone().zip(kept.skip(1)).all(|(row, next)| self.at(row).1 < self.at(next).1)
            && self.least.is_some() == self.greatest.is_some()
            && self.least.iter().chain(&self.greatest).all(|window| window.clocks > 0)
    }
}

/// The square of the distance of two places, in BLU²; the greatest number for one that is beyond it.
fn square(a: &[i64], b: &[i64]) -> u128 {
    let squares = a.iter().zip(b).map(|(a, b)| {
        let apart = u128::from(a.abs_diff(*b));
        apart.saturating_mul(apart)
    });
    squares.fold(0, u128::saturating_add)
}
