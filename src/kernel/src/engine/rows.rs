//! Recorded samples: a flat block of rows that is filled by an engine, read by observers, and used again.

use std::ops::Range;

/// Rows of equally many values, one row a sample, with room for a fixed number. The clocks of the rows follow one
/// another without a gap.
#[derive(Clone, Debug)]
pub struct Rows {
    columns: usize,
    capacity: usize,
    len: usize,
    first_clock: u64,
    values: Vec<u64>,
}

impl Rows {
    /// Room for `capacity` rows of `columns` values.
    #[must_use]
    pub fn new(columns: usize, capacity: usize) -> Rows {
        Rows { columns, capacity, len: 0, first_clock: 0, values: vec![0; columns * capacity] }
    }

    /// Number of rows held.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// No row is held.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// No further row fits.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.len == self.capacity
    }

    /// Clock of row 0.
    #[must_use]
    pub fn first_clock(&self) -> u64 {
        self.first_clock
    }

    /// The values of a row, in the order of the columns.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn row(&self, index: usize) -> &[u64] {
        assert!(index < self.len, "row {index} of {}", self.len);
        &self.values[index * self.columns..(index + 1) * self.columns]
    }

    /// Every row with its clock.
    pub fn iter(&self) -> impl Iterator<Item = (u64, &[u64])> {
        (0..self.len).map(|index| (self.first_clock + index as u64, self.row(index)))
    }

    /// The values of a column in some of the rows.
    ///
    /// # Panics
    /// If there is no such column, or a row of `rows` is not held.
    #[inline]
    pub fn column(&self, column: usize, rows: Range<usize>) -> impl Iterator<Item = u64> {
        assert!(column < self.columns && rows.end <= self.len, "column {column}, rows {rows:?} of {}", self.len);
        let held = &self.values[rows.start * self.columns..rows.end * self.columns];
        held.get(column..).unwrap_or_default().iter().step_by(self.columns).copied()
    }

    /// Forgets the rows; the room stays.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Number of rows that still fit.
    pub(super) fn room(&self) -> u64 {
        (self.capacity - self.len) as u64
    }

    /// The values of the rows that still fit, to be filled by native code.
    pub(super) fn spare(&mut self) -> &mut [u64] {
        &mut self.values[self.len * self.columns..]
    }

    /// Counts `rows` more as held, which native code has filled; the first is the sample of `clock`.
    pub(super) fn grow(&mut self, clock: u64, rows: u64) {
        if self.columns == 0 || rows == 0 {
            return;
        }
        if self.len == 0 {
            self.first_clock = clock;
        }
        debug_assert_eq!(self.first_clock + self.len as u64, clock, "a row of another time");
        // No more than `room`, which is a usize.
        self.len += usize::try_from(rows).unwrap_or(0);
    }

    /// Room for the sample of `clock`, to be filled by the engine; `None` if full.
    #[inline]
    pub(super) fn push(&mut self, clock: u64) -> Option<&mut [u64]> {
        if self.len == self.capacity {
            return None;
        }
        if self.len == 0 {
            self.first_clock = clock;
        }
        debug_assert_eq!(self.first_clock + self.len as u64, clock, "a row of another time");
        let start = self.len * self.columns;
        self.len += 1;
        Some(&mut self.values[start..start + self.columns])
    }
}
