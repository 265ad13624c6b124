//! How many axes and how large a coordinate a block may have, and the checks that hold every block to it.

use crate::GeometryError;

/// The largest magnitude of a coordinate, in BLU.
///
/// Within it, differences and sums of coordinates fit `i64`, their squares and products fit `i128`, and a coordinate or
/// a difference of two converts to `f64` exactly.
pub const COORDINATE_LIMIT: i64 = 1 << 52;

/// The largest semi-axis of a [`Conic`](crate::Conic), and the largest coordinate of its points relative to its centre
/// or vertex, in BLU.
///
/// Within it the products a²b², b²x² and a²y² are at most 2^104, so that their sums fit `i128` with room to spare.
pub const CONIC_LIMIT: i64 = 1 << 26;

/// The largest parameter c of a parabola y² = cx, in BLU.
pub const PARABOLA_LIMIT: i64 = 1 << 40;

/// The least number of axes of a line.
pub const AXES_MIN: usize = 1;

/// The greatest number of axes of a line.
pub const AXES_MAX: usize = 9;

/// The letters of the axes in the order of a point's coordinates: x, y and z; a, b and c, which turn about them; u, v and w, which
/// are parallel to them.
pub const AXIS_LETTERS: [char; AXES_MAX] = ['x', 'y', 'z', 'a', 'b', 'c', 'u', 'v', 'w'];

/// Checks that every coordinate of a point of at most nine axes lies within [`COORDINATE_LIMIT`].
pub(crate) fn check_coordinates(point: &[i64]) -> Result<(), GeometryError> {
    for (&value, axis) in point.iter().zip(AXIS_LETTERS) {
        if value.unsigned_abs() > COORDINATE_LIMIT.unsigned_abs() {
            return Err(GeometryError::CoordinateBeyondLimit { axis, value });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_itself_is_allowed_and_one_more_is_not() {
        assert_eq!(check_coordinates(&[COORDINATE_LIMIT, -COORDINATE_LIMIT]), Ok(()));
        for value in [COORDINATE_LIMIT + 1, -COORDINATE_LIMIT - 1, i64::MAX, i64::MIN] {
            for (place, axis) in AXIS_LETTERS.into_iter().enumerate() {
                let mut point = [0; AXES_MAX];
                point[place] = value;
                assert_eq!(check_coordinates(&point), Err(GeometryError::CoordinateBeyondLimit { axis, value }));
            }
        }
    }
}
