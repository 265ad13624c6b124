//! Recorded samples: a block with a column for each net, filled by an engine, read by observers, and used again.
//!
//! Column by column, because a search for a change, a least value or a flag reads one net over many clocks. Rows may
//! be sparse: then each has its own clock, and of the samples between them only extremes are kept.

use std::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, u64x8};

/// What the values of a column came to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Extremes {
    /// The least.
    pub least: u64,
    /// The greatest.
    pub greatest: u64,
    /// The first.
    pub first: u64,
    /// Bits in which one of them was not as the first.
    pub toggled: u64,
}

impl Extremes {
    /// Those of these values and of later ones.
    #[inline]
    #[must_use]
    pub fn and(self, later: Extremes) -> Extremes {
        Extremes {
            least: self.least.min(later.least),
            greatest: self.greatest.max(later.greatest),
            first: self.first,
            toggled: self.toggled | later.toggled | self.first ^ later.first,
        }
    }
}

/// Rows of equally many values, one row a sample, with room for a fixed number.
#[derive(Clone, Debug)]
pub struct Rows {
    columns: usize,
    capacity: usize,
    /// From one column to the next.
    stride: usize,
    len: usize,
    first_clock: u64,
    /// Column `c` begins at `c * stride`. After the last one come the clocks of sparse rows.
    values: Vec<u64>,
    /// Columns whose whole room holds one value, and that value; may be empty where there is none.
    still: Vec<Option<u64>>,
    sparse: bool,
    /// What columns came to in samples that were passed over.
    passed: Vec<(usize, Extremes)>,
    level: Level,
}

impl Rows {
    /// Room for `capacity` rows of `columns` values.
    #[must_use]
    pub fn new(columns: usize, capacity: usize) -> Rows {
        // A line of the cache more, so that the columns of one row do not all fall into the same set of it.
        let stride = capacity + 8;
        let values = vec![0; columns * stride];
        let level = Level::new();
        let (still, passed) = (Vec::new(), Vec::new());
        Rows { columns, capacity, stride, len: 0, first_clock: 0, values, still, sparse: false, passed, level }
    }

    /// As [`new`](Self::new), for an engine that passes over idle samples.
    #[must_use]
    pub fn sparse(columns: usize, capacity: usize) -> Rows {
        let rows = Rows::new(columns, capacity);
        Rows { values: vec![0; (columns + 1) * rows.stride], sparse: true, ..rows }
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

    /// Clock of a row.
    ///
    /// # Panics
    /// If there is no such row.
    #[inline]
    #[must_use]
    pub fn clock(&self, row: usize) -> u64 {
        assert!(row < self.len, "row {row} of {}", self.len);
        if self.sparse { self.values[self.columns * self.stride + row] } else { self.first_clock + row as u64 }
    }

    /// Number of rows before the sample of a clock.
    #[must_use]
    pub fn before(&self, clock: u64) -> usize {
        if self.sparse {
            return self.values[self.columns * self.stride..][..self.len].partition_point(|&of| of < clock);
        }
        // A clock beyond the block is after its last row, for any size of a usize.
        usize::try_from(clock.saturating_sub(self.first_clock)).map_or(self.len, |rows| rows.min(self.len))
    }

    /// Number of values of a row.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The values of a column, one a row held.
    ///
    /// # Panics
    /// If there is no such column.
    #[inline]
    #[must_use]
    pub fn column(&self, column: usize) -> &[u64] {
        assert!(column < self.columns, "column {column} of {}", self.columns);
        &self.values[column * self.stride..][..self.len]
    }

    /// One of the values of a column is not 0.
    ///
    /// # Panics
    /// If there is no such column.
    #[must_use]
    pub fn any(&self, column: usize) -> bool {
        if let Some(value) = self.still(column) {
            return value != 0 && !self.is_empty();
        }
        self.column(column).iter().fold(0, |seen, value| seen | value) != 0
    }

    /// A bit for each of the next 64 rows from `first` on, or of those there are, the first the lowest: 1 where the
    /// value of a column is not 0.
    ///
    /// # Panics
    /// If there is no such column.
    #[inline]
    #[must_use]
    pub fn nonzero(&self, column: usize, first: usize) -> u64 {
        let values = self.column(column).get(first..).unwrap_or_default();
        dispatch!(self.level, simd => nonzero(simd, &values[..values.len().min(64)]))
    }

    /// The extremes of a column, those of skipped samples included, with the bits of `turned` inverted in every value;
    /// `None` without a sample. With the sign bit inverted, two's complement sorts as unsigned numbers do; a register
    /// that runs on while samples are skipped is unsigned.
    ///
    /// # Panics
    /// If there is no such column.
    #[must_use]
    pub fn extremes(&self, column: usize, turned: u64) -> Option<Extremes> {
        let recorded = self.extremes_within(column, 0..self.len, turned);
        let passed = self.passed.iter().filter(|(passed, _)| *passed == column).map(|(_, extremes)| *extremes);
        passed.chain(recorded).reduce(Extremes::and)
    }

    /// The same of some rows alone, without what was skipped.
    ///
    /// # Panics
    /// If the column or one of these rows does not exist.
    #[must_use]
    pub fn extremes_within(&self, column: usize, rows: Range<usize>, turned: u64) -> Option<Extremes> {
        let values = &self.column(column)[rows];
        let first = values.first()? ^ turned;
        if self.still(column).is_some() {
            return Some(Extremes { least: first, greatest: first, first, toggled: 0 });
        }
        let (least, greatest, toggled) = dispatch!(self.level, _simd => extremes(values, turned, first));
        Some(Extremes { least, greatest, first, toggled })
    }

    /// The value of a column in every row, where it is known to be one: a search for changes can be spared.
    #[inline]
    #[must_use]
    pub fn still(&self, column: usize) -> Option<u64> {
        self.still.get(column).copied().flatten()
    }

    /// The value of a column in a row.
    ///
    /// # Panics
    /// If there is no such column, or no such row.
    #[inline]
    #[must_use]
    pub fn value(&self, column: usize, row: usize) -> u64 {
        assert!(row < self.len, "row {row} of {}", self.len);
        self.values[column * self.stride + row]
    }

    /// Where the value of a column in a row is among [all](Self::values); that of the next row comes after it.
    ///
    /// # Panics
    /// If there is no such column, or no such row.
    #[inline]
    #[must_use]
    pub fn place(&self, column: usize, row: usize) -> usize {
        assert!(
            row < self.len && column < self.columns,
            "row {row} of {}, column {column} of {}",
            self.len,
            self.columns
        );
        column * self.stride + row
    }

    /// All values, for loops that have looked up their [places](Self::place).
    #[must_use]
    pub fn values(&self) -> &[u64] {
        &self.values
    }

    /// The clocks of some rows, if samples between them may be left out; else nothing.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn clocks(&self, rows: Range<usize>) -> &[u64] {
        if self.sparse { &self.values[self.columns * self.stride..][..self.len][rows] } else { &[] }
    }

    /// The values of a row, in the order of the columns; gathered one by one, so not for hot loops.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn row(&self, index: usize) -> Vec<u64> {
        assert!(index < self.len, "row {index} of {}", self.len);
        (0..self.columns).map(|column| self.values[column * self.stride + index]).collect()
    }

    /// Every row with its clock, as [`row`](Self::row).
    pub fn iter(&self) -> impl Iterator<Item = (u64, Vec<u64>)> {
        (0..self.len).map(|index| (self.clock(index), self.row(index)))
    }

    /// Forgets the rows; the room stays.
    pub fn clear(&mut self) {
        self.len = 0;
        self.passed.clear();
    }

    /// Samples between the rows may be left out.
    pub fn is_sparse(&self) -> bool {
        self.sparse
    }

    /// Takes what a column came to in samples that were passed over.
    pub fn pass(&mut self, column: usize, later: Extremes) {
        match self.passed.iter_mut().find(|(passed, _)| *passed == column) {
            Some((_, extremes)) => *extremes = extremes.and(later),
            None => self.passed.push((column, later)),
        }
    }

    /// From one column to the next, in values.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Number of rows that still fit.
    pub fn room(&self) -> u64 {
        (self.capacity - self.len) as u64
    }

    /// All values, and the index of the next row, to be filled by native code but for the `resting` columns, in rising
    /// order, which it leaves as they are.
    pub fn spare(&mut self, resting: &[usize]) -> (&mut [u64], usize) {
        let mut resting = resting.iter().peekable();
        for (column, still) in self.still.iter_mut().enumerate() {
            if resting.next_if(|&&rests| rests == column).is_none() {
                *still = None;
            }
        }
        (&mut self.values, self.len)
    }

    /// Gives a column the same value in the next `rows` rows, which fit.
    pub fn fill(&mut self, column: usize, rows: u64, value: u64) {
        if self.still(column) == Some(value) {
            return;
        }
        let place = &mut self.values[column * self.stride..][..self.capacity];
        let (held, room) = place.split_at_mut(self.len);
        self.still.resize(self.columns, None);
        if held.iter().all(|&before| before == value) {
            room.fill(value);
            self.still[column] = Some(value);
        } else {
            // No more than `room`, which is a usize.
            room[..usize::try_from(rows).unwrap_or(0)].fill(value);
            self.still[column] = None;
        }
    }

    /// Counts `rows` more as held, which native code has filled; the first is the sample of `clock`.
    pub fn grow(&mut self, clock: u64, rows: u64) {
        if self.columns == 0 || rows == 0 {
            return;
        }
        if self.len == 0 {
            self.first_clock = clock;
        }
        debug_assert!(self.sparse || self.first_clock + self.len as u64 == clock, "a row of another time");
        // No more than `room`, which is a usize.
        self.len += usize::try_from(rows).unwrap_or(0);
    }

    /// Records the sample of `clock`, if there is room and something to record: `value` gives that of each column.
    #[inline]
    pub fn push(&mut self, clock: u64, value: impl Fn(usize) -> u64) {
        if self.len == self.capacity || self.columns == 0 {
            return;
        }
        if self.len == 0 {
            self.first_clock = clock;
        }
        debug_assert!(self.sparse || self.first_clock + self.len as u64 == clock, "a row of another time");
        if self.sparse {
            self.values[self.columns * self.stride + self.len] = clock;
        }
        for (column, place) in self.values[self.len..].iter_mut().step_by(self.stride).take(self.columns).enumerate() {
            let value = value(column);
            *place = value;
            if let Some(still) = self.still.get_mut(column).filter(|still| **still != Some(value)) {
                *still = None;
            }
        }
        self.len += 1;
    }
}

/// Least and greatest of the values with the bits of `turned` turned over, and the bits in which one differs from
/// `first`.
#[inline(always)]
fn extremes(values: &[u64], turned: u64, first: u64) -> (u64, u64, u64) {
    // Vector units compare signed numbers; with the highest bit turned over they are in the order of the unsigned ones.
    const HIGHEST: u64 = 1 << 63;
    let turn = |value: &u64| (value ^ turned ^ HIGHEST).cast_signed();
    let first = (first ^ HIGHEST).cast_signed();
    let start = (i64::MAX, i64::MIN, 0);
    let (least, greatest, toggled) = values.iter().map(turn).fold(start, |(least, greatest, toggled), value| {
        (least.min(value), greatest.max(value), toggled | value ^ first)
    });
    (least.cast_unsigned() ^ HIGHEST, greatest.cast_unsigned() ^ HIGHEST, toggled.cast_unsigned())
}

/// A bit for each of at most 64 values that is not 0, the first the lowest.
#[inline(always)]
fn nonzero<S: Simd>(simd: S, values: &[u64]) -> u64 {
    let (octets, rest) = values.as_chunks::<8>();
    let mut bits = 0;
    for (index, octet) in octets.iter().enumerate() {
        let zero = u64x8::from_slice(simd, octet).simd_eq(u64x8::splat(simd, 0)).to_bitmask();
        bits |= (zero ^ 0xff) << (8 * index);
    }
    for (index, value) in (8 * octets.len()..).zip(rest) {
        bits |= u64::from(*value != 0) << index;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_those_of_all_values_and_of_all_their_bits() {
        let mut rows = Rows::new(1, 300);
        assert_eq!(rows.extremes(0, 0), None);
        for (clock, value) in (0..).zip([0b0110, 0b0111, 0b1110].repeat(100)) {
            rows.push(clock, |_| value);
        }
        let all = Extremes { least: 6, greatest: 14, first: 6, toggled: 0b1001 };
        assert_eq!(rows.extremes(0, 0), Some(all));
        // In four bits of two's complement: 6, 7 and -2, with 8 added to each.
        let signed = Extremes { least: 6, greatest: 15, first: 14, toggled: 0b1001 };
        assert_eq!(rows.extremes(0, 0b1000), Some(signed));
        let later = Extremes { least: 3, greatest: 4, first: 4, toggled: 0b0111 };
        assert_eq!(all.and(later), Extremes { least: 3, greatest: 14, first: 6, toggled: 0b1111 });
        let same = Extremes { least: 4, greatest: 4, first: 4, toggled: 0 };
        assert_eq!(all.and(same).toggled, 0b1011);
    }

    #[test]
    fn a_column_that_rests_keeps_its_value_until_something_else_is_recorded() {
        let mut rows = Rows::new(3, 4);
        let call = |rows: &mut Rows, resting: &[usize], value: u64, count: u64| {
            let (values, first) = rows.spare(resting);
            // What native code does: the last column changes.
            values[2 * 12 + first..][..4 - first].fill(100);
            resting.iter().for_each(|&column| rows.fill(column, count, value + column as u64));
            rows.grow(7, count);
            let seen = [0, 1, 2].map(|column| rows.extremes(column, 0).map(|seen| (seen.least, seen.greatest)));
            let any = rows.any(0);
            (seen, [0, 1, 2].map(|column| rows.still(column)), any)
        };
        let whole = |value: u64| [Some((value, value)), Some((value + 1, value + 1)), Some((100, 100))];
        assert_eq!(call(&mut rows, &[0, 1], 5, 4), (whole(5), [Some(5), Some(6), None], true));
        rows.clear();
        // Fewer rows of the same value, then others of another one.
        assert_eq!(call(&mut rows, &[0, 1], 5, 3), (whole(5), [Some(5), Some(6), None], true));
        rows.clear();
        assert_eq!(call(&mut rows, &[0, 1], 0, 3), (whole(0), [Some(0), Some(1), None], false));
        rows.clear();
        assert_eq!(call(&mut rows, &[0, 1], 0, 4), (whole(0), [Some(0), Some(1), None], false));
        rows.clear();
        // A loop that writes column 1 too.
        assert_eq!(call(&mut rows, &[0], 0, 4).1, [Some(0), None, None]);
        rows.clear();
        // Samples that are recorded one by one: the same value, and another.
        rows.push(9, |_| 0);
        assert_eq!([0, 1, 2].map(|column| rows.still(column)), [Some(0), None, None]);
        rows.push(10, |_| 3);
        assert_eq!([0, 1, 2].map(|column| rows.still(column)), [None; 3]);
        assert_eq!(rows.extremes(0, 0).map(|seen| (seen.least, seen.greatest)), Some((0, 3)));
        // What was recorded before is not of the value that the others rest at, and after it is.
        rows.spare(&[0, 1]);
        rows.fill(0, 1, 3);
        rows.fill(1, 2, 5);
        rows.grow(11, 1);
        assert_eq!(rows.still(0), None);
        assert_eq!(rows.column(0), [0, 3, 3]);
        rows.clear();
        rows.push(12, |column| column as u64);
        rows.spare(&[0, 1]);
        (0..2).for_each(|column| rows.fill(column, 2, column as u64));
        rows.grow(13, 2);
        rows.push(15, |_| 1);
        assert_eq!([0, 1].map(|column| rows.still(column)), [None, Some(1)]);
        assert_eq!([0, 1].map(|column| rows.column(column).to_vec()), [vec![0, 0, 0, 1], vec![1; 4]]);
    }

    #[test]
    fn rows_before_a_clock_are_counted_with_samples_passed_over_and_without() {
        let (mut all, mut some) = (Rows::new(1, 10), Rows::sparse(1, 10));
        (5..9).for_each(|clock| all.push(clock, |_| clock));
        [5, 6, 20, 31].into_iter().for_each(|clock| some.push(clock, |_| clock));
        let before = |rows: &Rows| [0, 5, 6, 8, 9, 20, 21, 31, 32, u64::MAX].map(|clock| rows.before(clock));
        assert_eq!(before(&all), [0, 0, 1, 3, 4, 4, 4, 4, 4, 4]);
        assert_eq!(before(&some), [0, 0, 1, 2, 2, 2, 3, 3, 4, 4]);
    }

    #[test]
    fn every_row_whose_value_is_not_0_has_its_bit() {
        let value = |clock: u64| [0, 1, u64::MAX, 1 << 63][usize::try_from(clock * clock % 11 % 4).unwrap()];
        let mut rows = Rows::new(2, 150);
        for clock in 7..137 {
            rows.push(clock, |column| if column == 0 { clock } else { value(clock) });
        }
        for first in [0, 1, 63, 64, 66, 129, 130, 200] {
            let bits = rows.nonzero(1, first);
            for index in 0..64 {
                let row = first + index;
                let expected = row < rows.len() && value(7 + row as u64) != 0;
                assert_eq!(bits >> index & 1 == 1, expected, "row {row}");
            }
        }
    }
}
