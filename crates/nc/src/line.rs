//! Straight lines in one to nine axes.

use crate::exact::cross;
use crate::limit::check_coordinates;
use crate::{AXES_MAX, AXES_MIN, GeometryError};

/// A straight line from one point to another, in one to nine axes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Line {
    from: Vec<i64>,
    to: Vec<i64>,
}

impl Line {
    /// The line between two points, coordinates in BLU and in the order x, y, z, a, b, c, u, v, w.
    ///
    /// # Errors
    /// If the points have different numbers of axes, none or more than nine, if a coordinate is beyond
    /// [`COORDINATE_LIMIT`](crate::COORDINATE_LIMIT), or if both points are the same.
    ///
    /// ```
    /// use stepwave_nc::{GeometryError, Line};
    ///
    /// let line = Line::new(vec![-1, 1], vec![-4, 2])?;
    /// assert_eq!(line.delta(), [-3, 1]);
    /// assert_eq!(Line::new(vec![], vec![]), Err(GeometryError::AxisCount { axes: 0 }));
    /// # Ok::<(), GeometryError>(())
    /// ```
    pub fn new(from: Vec<i64>, to: Vec<i64>) -> Result<Line, GeometryError> {
        if from.len() != to.len() {
            return Err(GeometryError::AxisMismatch { from: from.len(), to: to.len() });
        }
        if !(AXES_MIN..=AXES_MAX).contains(&from.len()) {
            return Err(GeometryError::AxisCount { axes: from.len() });
        }
        check_coordinates(&from)?;
        check_coordinates(&to)?;
        if from == to {
            return Err(GeometryError::ZeroLength);
        }
        Ok(Line { from, to })
    }

    /// The start point, in BLU.
    #[must_use]
    pub fn from(&self) -> &[i64] {
        &self.from
    }

    /// The end point, in BLU.
    #[must_use]
    pub fn to(&self) -> &[i64] {
        &self.to
    }

    /// The signed travel of each axis from start to end, in BLU.
    #[must_use]
    pub fn delta(&self) -> Vec<i64> {
        self.to.iter().zip(&self.from).map(|(to, from)| to - from).collect()
    }

    /// The number of axes, 1 to 9.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.from.len()
    }

    /// The length, in BLU.
    #[must_use]
    pub fn length(&self) -> f64 {
        let squared: u128 = self.delta().iter().map(|offset| u128::from(offset.unsigned_abs()).pow(2)).sum();
        (squared as f64).sqrt()
    }

    /// The distance of a position from the infinite ideal line, in BLU.
    ///
    /// The position has the axes of the line; further coordinates are ignored, and with too few there is no distance
    /// (NaN). Accurate to a few parts in 2^53 for any position, as it is the norm of the exact cross products of all
    /// pairs of axes.
    ///
    /// ```
    /// use stepwave_nc::Line;
    ///
    /// let line = Line::new(vec![0, 0], vec![4, 3])?;
    /// assert_eq!(line.deviation(&[0, 5]), 4.0);
    /// assert_eq!(line.deviation(&[8, 6]), 0.0); // beyond the end, but on the line
    /// # Ok::<(), stepwave_nc::GeometryError>(())
    /// ```
    #[must_use]
    pub fn deviation(&self, position: &[i64]) -> f64 {
        if position.len() < self.axes() {
            return f64::NAN;
        }
        let axes: Vec<_> = self.offsets(position).collect();
        let mut norm = 0.0_f64;
        for (place, &(di, pi)) in axes.iter().enumerate() {
            for &(dj, pj) in axes.iter().skip(place + 1) {
                norm = norm.hypot(cross([di, dj], [pi, pj]) as f64);
            }
        }
        norm / self.length()
    }

    /// The distance of a position from the line with its side, in BLU: positive on the left of a two-axis line.
    ///
    /// A line of more axes has no left: there it equals [`deviation`](Line::deviation), which it equals in magnitude
    /// always.
    #[must_use]
    pub fn signed_deviation(&self, position: &[i64]) -> f64 {
        let distance = self.deviation(position);
        let mut offsets = self.offsets(position);
        match (offsets.next(), offsets.next(), offsets.next()) {
            (Some((dx, px)), Some((dy, py)), None) if cross([dx, dy], [px, py]) < 0 => -distance,
            _ => distance,
        }
    }

    /// The two ends of the line in its first two axes, in BLU, for drawing.
    #[must_use]
    pub fn outline(&self) -> Vec<[f64; 2]> {
        let plane = |point: &[i64]| match *point {
            [x, y, ..] => Some([x as f64, y as f64]),
            _ => None,
        };
        [&self.from, &self.to].into_iter().filter_map(|point| plane(point)).collect()
    }

    /// Per axis: the travel of the line, and the offset of a position from the line's start.
    fn offsets(&self, position: &[i64]) -> impl Iterator<Item = (i128, i128)> {
        let ends = self.from.iter().zip(&self.to).zip(position);
        ends.map(|((&from, &to), &at)| (i128::from(to) - i128::from(from), i128::from(at) - i128::from(from)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::COORDINATE_LIMIT as L;

    type Outcome = Result<(), GeometryError>;

    #[test]
    fn a_line_takes_one_to_nine_axes_and_both_points_the_same() {
        for axes in 0..=11 {
            let line = Line::new(vec![0; axes], vec![1; axes]);
            assert_eq!(line.map(|line| line.axes()).ok(), (1..=9).contains(&axes).then_some(axes));
        }
        let unequal = Line::new(vec![0; 2], vec![1; 3]);
        assert_eq!(unequal, Err(GeometryError::AxisMismatch { from: 2, to: 3 }));
    }

    #[test]
    fn a_line_of_length_zero_is_refused() {
        assert_eq!(Line::new(vec![3, -3], vec![3, -3]), Err(GeometryError::ZeroLength));
    }

    #[test]
    fn left_is_positive_in_every_direction() -> Outcome {
        for (to, left) in [([5, 0], [2, 1]), ([0, 5], [-1, 2]), ([-5, 0], [-2, -1]), ([0, -5], [1, -2])] {
            let line = Line::new(vec![0, 0], to.to_vec())?;
            assert_eq!(line.signed_deviation(&left), 1.0);
            assert_eq!(line.signed_deviation(&left.map(|c: i64| -c)), -1.0);
        }
        Ok(())
    }

    #[test]
    fn the_deviation_of_the_longest_line_keeps_every_digit() -> Outcome {
        let line = Line::new(vec![-L, -L], vec![L, L - 1])?;
        // One BLU off the end point of a line whose products reach 2^107.
        let expected = 1.0 / 2.0_f64.sqrt();
        assert!((line.signed_deviation(&[L, L]) - expected).abs() < 1e-15);
        assert_eq!(line.deviation(&[L, L - 1]), 0.0);

        let space = Line::new(vec![0, 0, 0], vec![L, L, L])?;
        let expected = (2.0_f64 / 3.0).sqrt();
        assert!((space.deviation(&[L, L - 1, L]) - expected).abs() < 1e-15);
        Ok(())
    }

    #[test]
    fn any_position_has_a_deviation_without_overflow() -> Outcome {
        let line = Line::new(vec![-L; 6], vec![L, -L, L, -L, L, -L])?;
        for position in [[i64::MAX; 6], [i64::MIN; 6]] {
            assert!(line.deviation(&position).is_finite());
        }
        assert!(line.deviation(&[0; 5]).is_nan());
        assert_eq!(line.deviation(&[-L; 7]), 0.0);
        Ok(())
    }

    #[test]
    fn lengths_and_outlines_are_in_blu() -> Outcome {
        let line = Line::new(vec![1, 2, 3], vec![3, 5, 9])?;
        assert_eq!(line.length(), 7.0);
        assert_eq!(line.outline(), [[1.0, 2.0], [3.0, 5.0]]);
        Ok(())
    }
}
